"""Each value that the catalogue of sources gives for a row on design stands on the page of an example of that row."""

from __future__ import annotations

import tomllib
from dataclasses import fields, replace
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.expression import parse_matrix, parse_scalar
from symobs.formula.tree import Evaluated, Exact, Formula, Literal, Relation, evaluate
from symobs.formula.tree.nodes import children
from symobs.tasks.result import render
from tests.pages.test_worked_examples import solved
from tests.support.examples import EXAMPLES as FILES
from tests.support.paths import ROOT
from tests.support.tampering.mutations import lines_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from symobs.formula.tree import Environment
    from symobs.proof.derivation import Derivation

VALUES: dict[str, list[str]] = tomllib.loads((ROOT / "tests/support/problems/catalogue_values.toml").read_text("utf-8"))
pytestmark = pytest.mark.slow

LINE = "line: "


class Told(NamedTuple):
    """What a page tells: the values of all that is written in its lines, and its text without line breaks."""

    values: frozenset[str]
    text: str


@cache
def page(path: Path) -> Told:
    found, results = solved(path)
    document = found.document(results)
    values = frozenset(plain(value) for derivation in document.derivations for value in written(derivation))
    return Told(values, " ".join(str(render(document, "text")).split()))


def written(derivation: Derivation) -> Iterator[Matrix | Scalar]:
    """The values of the members of all lines that are shown, and of the parts of these."""
    for line in lines_of(derivation):
        if getattr(line.step, "silent", False):
            continue
        after = replace(derivation, steps=(line.step,), start=line.start).check()
        for relation in relations(line.step):
            for member in relation.members:
                yield from parts(member, after)


def relations(item: Any) -> Iterator[Relation]:
    if isinstance(item, Relation):
        yield item
    elif isinstance(item, Evaluated):
        yield Relation((item.formula, item.value), ("=",))
    elif isinstance(item, tuple):
        for part in item:
            yield from relations(part)
    elif hasattr(item, "__dataclass_fields__") and not isinstance(item, Formula):
        for field in fields(item):
            yield from relations(getattr(item, field.name))


def plain(value: Matrix | Scalar) -> str:
    """The value in canonical text."""
    return str(value.normal() if isinstance(value, Matrix) else value)


def parts(formula: Formula, environment: Environment) -> Iterator[Matrix | Scalar]:
    if isinstance(formula, Literal):
        yield formula.value  # as it is written, unknown entries by their names
    try:
        value = evaluate(formula, environment, Exact(environment))
    except (ArithmeticError, KeyError, TypeError, ValueError):  # a part that means nothing by itself
        value = None
    if isinstance(value, Matrix | Scalar):
        yield value
    for part in children(formula):
        yield from parts(part, environment)


def is_told(entry: str, pages: list[Told]) -> bool:
    if entry.startswith(LINE):
        return any(" ".join(entry.removeprefix(LINE).split()) in told.text for told in pages)
    read = parse_matrix if entry.startswith("[") else parse_scalar
    return any(plain(read(entry, functions=True)) in told.values for told in pages)


@pytest.mark.parametrize("row", VALUES)
def test_every_value_of_the_row_is_told(row: str) -> None:
    pages = [page(path) for path in FILES if row in solved(path)[0].ids]
    assert [entry for entry in VALUES[row] if not is_told(entry, pages)] == []


def test_what_no_source_says_is_not_told() -> None:
    pages = [page(path) for path in FILES if "S0-Ex4.2" in solved(path)[0].ids]
    for entry in (
        "[4 7]",
        "(319 s + 401)/(s^2 + 23 s + 161)",
        "[2 1; -4 2]",
        "line: u = -K x - K e",
        "line: -2, -10, -2",
    ):
        assert not is_told(entry, pages), entry
