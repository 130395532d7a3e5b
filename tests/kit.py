"""What the tests share."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.expression import parse_scalar
from symobs.system import StateSpace
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T", bound="Callable[..., None]")


@cache
def tables(path: Path) -> dict[str, Any]:
    """Return the tables of cases of a file of tests: they stand in the TOML file beside it."""
    text = path.with_suffix(".toml").read_text(encoding="utf-8")
    return tomllib.loads(text.replace("{worked_examples}", str(ROOT / "worked_examples")))


def tabled(test: T) -> T:
    """Run a test with each row of the table that has its name in the TOML file beside it."""
    table = tables(Path(test.__code__.co_filename))[test.__name__]
    rows = _as_tuples(table["rows"]) if table.get("tuples") else table["rows"]
    marked: T = pytest.mark.parametrize(", ".join(table["names"]), rows)(test)
    return marked


def _as_tuples(value: Any) -> Any:
    return tuple(map(_as_tuples, value)) if isinstance(value, list) else value


#: A servo with the output y = x₁.
SERVO = StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")


def text_of(result: Any) -> str:
    """Return the page of a result as text, its lines joined."""
    return " ".join(str(result.to("text")).split())


def scalar(text: str | int) -> Scalar:
    """Read an exact value of a table."""
    return parse_scalar(str(text))


def scalars(texts: list[Any]) -> list[Scalar]:
    """Read exact values of a table."""
    return list(map(scalar, texts))


def member(part: Any) -> Any:
    """Read a member of a relation of a table, or leave its operator as it is."""
    if isinstance(part, list):
        return Matrix.of([scalars(row) for row in part])
    return part if str(part) in {"=", "!=", "<", "<=", ">", ">="} else scalar(part)
