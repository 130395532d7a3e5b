"""What the tests share."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T", bound="Callable[..., None]")


@cache
def tables(path: Path) -> dict[str, Any]:
    """Return the tables of cases of a file of tests: they stand in the TOML file beside it."""
    return tomllib.loads(path.with_suffix(".toml").read_text(encoding="utf-8"))


def tabled(test: T) -> T:
    """Run a test with each row of the table that has its name in the TOML file beside it."""
    table = tables(Path(test.__code__.co_filename))[test.__name__]
    rows = _as_tuples(table["rows"]) if table.get("tuples") else table["rows"]
    marked: T = pytest.mark.parametrize(", ".join(table["names"]), rows)(test)
    return marked


def _as_tuples(value: Any) -> Any:
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value
