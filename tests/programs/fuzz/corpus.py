"""Where mutated inputs begin: the worked examples, and what stands in them."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import TYPE_CHECKING, Any

from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    Table = dict[str, Any]

EXAMPLES = sorted((ROOT / "worked_examples").rglob("*.toml"))
PROFILES = sorted((ROOT / "symobs" / "formula" / "convention" / "profiles").glob("*.toml"))


@cache
def example_texts() -> tuple[str, ...]:
    """The worked examples."""
    return tuple(path.read_text(encoding="utf-8") for path in EXAMPLES)


@cache
def example_tables() -> tuple[Table, ...]:
    """The worked examples, read."""
    return tuple(tomllib.loads(text) for text in example_texts())


@cache
def profile_texts() -> tuple[str, ...]:
    """The conventions of the package."""
    return tuple(path.read_text(encoding="utf-8") for path in PROFILES)


@cache
def expressions() -> tuple[str, ...]:
    """Every text below [plant], [specification] and [expect] of the examples, and of what they print."""
    tables = [table.get(key) for table in example_tables() for key in ("plant", "specification", "expect")]
    return tuple(dict.fromkeys(text for text in _texts(tables) if text and len(text) < 2000))


@cache
def relations() -> tuple[str, ...]:
    """Every printed equation."""
    printed = [entry for table in example_tables() for entry in table.get("printed", [])]
    found = [entry["relation"] for entry in printed if "relation" in entry]
    found += [text for entry in printed for text in entry.get("let", {}).values()]
    return tuple(dict.fromkeys([*found, "A - L C = [-19 1; -81 -1]", "u = -K x_hat", "det(s I - A) = s^2 + s"]))


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _texts(each)
    elif isinstance(value, list):
        for each in value:
            yield from _texts(each)
