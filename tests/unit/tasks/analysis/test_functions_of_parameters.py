"""Functions of parameters beside hidden modes, in equations of cases, and in desired poles: a page for every answer."""

from __future__ import annotations

from typing import Any

import pytest

import symobs

S = symobs.StateSpace
B_AND_EXP = ("[b 0; 0 -exp(b)]", "[1; 1]", "[1 1]")


@pytest.mark.parametrize(
    ("task", "data", "asked", "conditions", "cases"),
    [
        ("transfer_function", ("[1 1-exp(-T); 0 exp(-T)]", "[0; 1]", "[1 0]"), {}, ["exp(T) - 1"], ["exp(T) - 1"]),
        ("transfer_function", B_AND_EXP, {}, ["b + exp(b)"], ["b + exp(b)"]),
        ("decomposition", B_AND_EXP, {}, ["b + exp(b)"], ["b + exp(b)"]),
        ("gramian", B_AND_EXP, {}, ["T", "b"], ["b + exp(b)", "b"]),
        ("observer", B_AND_EXP, {"poles": "-1, -2"}, ["b + exp(b)"], ["b + exp(b)"]),
        ("reduced_order_observer", ("[0 1; 0 -b]", None, "[1 exp(b)]"), {"poles": "-1"}, ["b*exp(b) - 1"], ["b*exp(b) - 1"]),
        ("state_feedback", ("[-1 0; 0 -2]", "[1; b]"), {"poles": "-exp(b), -1"}, ["b"], ["b"]),
        ("pbh", ("[cos(th) 0; 0 -1]", None, "[0 1]"), {}, [], ["sin(th)"]),
        ("detectability", ("[cos(th) 0; 0 -1]", None, "[0 1]"), {}, ["-cos(th)"], ["sin(th)"]),
        ("stabilizability", ("[cos(th) 0; 0 -1]", "[0; 1]"), {}, ["-cos(th)"], ["sin(th)"]),
        ("detectability", ("[0 1 0; sin(th) -1 0; 0 0 -2]", None, "[0 0 1]"), {}, ["-sin(th)"], None),
        ("detectability", ("[1-exp(b) 0; 0 -2]", None, "[b 1]"), {}, ["b"], ["b", "exp(b) - 3"]),
    ],
)  # fmt: skip
def test_conditions_cases_and_page(
    task: str, data: tuple[str | None, ...], asked: Any, conditions: list[str], cases: list[str] | None
) -> None:
    result = getattr(symobs, task)(S(*data), **asked)
    assert [str(relation.lhs) for relation in result.conditions] == conditions
    assert cases is None or [str(case.when[0].lhs) for case in result.cases] == cases
    assert result.to("latex")
    assert result.to_json()


def test_a_rank_that_drops_where_a_cosine_vanishes_has_a_page() -> None:
    """Where cos b = 0 the sine is 1 or -1: two cases, of which the page has to know that they are all."""
    found = symobs.observability(symobs.StateSpace("[a 0; b*exp(a) 0]", C="[cos(b) 0; 1-exp(b) -1]"))
    assert [[str(relation.lhs) for relation in case.when] for case in found.cases] == [
        ["cos(b)", f"sin(b) {sign} 1", "a*exp(b) - a + b*exp(a)"] for sign in "+-"
    ]
    assert found.to("text").count("Case ") == 2
