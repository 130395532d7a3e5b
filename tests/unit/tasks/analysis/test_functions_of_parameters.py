"""Functions of parameters beside hidden modes, in equations of cases, and in desired poles: a page for every answer."""

from __future__ import annotations

from typing import Any

import symobs
from tests.kit import tabled


@tabled
def test_conditions_cases_and_page(
    task: str, data: dict[str, Any], asked: Any, conditions: list[str], cases: list[str]
) -> None:
    result = getattr(symobs, task)(symobs.StateSpace(**data), **asked)
    assert [str(relation.lhs) for relation in result.conditions] == conditions
    assert not cases or [str(case.when[0].lhs) for case in result.cases] == cases
    assert result.to("latex")
    assert result.to_json()


def test_a_rank_that_drops_where_a_cosine_vanishes_has_a_page() -> None:
    """Where cos b = 0 the sine is 1 or -1: two cases, of which the page has to know that they are all."""
    found = symobs.observability(symobs.StateSpace("[a 0; b*exp(a) 0]", C="[cos(b) 0; 1-exp(b) -1]"))
    assert [[str(relation.lhs) for relation in case.when] for case in found.cases] == [
        ["cos(b)", f"sin(b) {sign} 1", "a*exp(b) - a + b*exp(a)"] for sign in "+-"
    ]
    assert found.to("text").count("Case ") == 2
