"""Conditions and cases on a page: what may be said under them, and what is refused, worked out by hand."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest

from symobs.formula.expression import parse_matrix
from symobs.formula.tree import Conjunction, Environment, Letter
from symobs.proof.derivation import CaseStep, Define, Equal, Given
from tests.kit import scalar, tabled
from tests.support.problems.steps import C_IS, checked, refused, said

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.proof.derivation import Step

OPERATORS = ("=", "!=", ">=", "<=", ">", "<", "!==", "~")
ON = Environment(signs={"a": "positive", "b": "real", "c": "real", "h": "real", "k": "real"})


def relation(text: str) -> Relation:
    """Read a relation; capitals are letters of the page."""

    def part(word: str) -> Any:
        if word in OPERATORS:
            return word
        if word.isupper():
            return Letter(word)
        return parse_matrix(word) if word.startswith("[") else scalar(word)

    return said(*map(part, re.split(f" ({'|'.join(OPERATORS)}) ", text)))


def step(row: dict[str, Any]) -> Step:
    """Read a step: one of relations, or a case with its equations, what is put in there, and its own steps."""
    if "case" not in row:
        ((kind, texts),) = row.items()
        relations = tuple(map(relation, texts))
        if kind == "define":
            return Define(*relations)  # type: ignore[arg-type]
        return Given(relations) if kind == "given" else Equal(relations)
    when = row["case"]
    return CaseStep(
        relation(when) if isinstance(when, str) else Conjunction(tuple(map(relation, when))),
        tuple((name, scalar(value)) for name, value in row.get("put", {}).items()),
        tuple(map(step, row.get("steps", []))),
        anew=tuple(row.get("anew", [])),
    )


@tabled
def test_what_may_be_said(steps: list[dict[str, Any]]) -> None:
    checked(*map(step, steps), start=ON)


@tabled
def test_what_may_not_be_said(steps: list[dict[str, Any]], why: str) -> None:
    refused(*map(step, steps), start=ON, match=why or None)


def test_nothing_of_a_case_stays() -> None:
    known = checked(C_IS, step({"case": "c = 1", "put": {"c": "1"}, "steps": [{"define": ["F = 1"]}]}))
    assert "F" not in known.values
    assert str(known.values["C"]) == "[1 c]"


@pytest.mark.parametrize("operator", ["<=", ">=", "!==", "~"])
def test_a_case_is_of_equations_inequations_and_signs(operator: str) -> None:
    refused(step({"case": f"c {operator} 1"}), start=ON)
