"""Strata that no rational functions parametrise: each task has a checked answer there, however small the limits are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import symobs
from symobs.exact import Scalar
from symobs.exact import ideals as ideal
from symobs.pages.formats.json import result_object
from tests.kit import tabled, tables, text_of

pytestmark = pytest.mark.slow


TASKS: dict[str, dict[str, Any]] = tables(Path(__file__))["tasks"]
#: Plants that change on a curve.
CURVES: dict[str, tuple[str, str, str]] = tables(Path(__file__))["curves"]


def verdicts(told: dict[str, Any]) -> list[str]:
    return [told["verdict"], *(verdict for case in told["cases"] for verdict in verdicts({"cases": [], **case}))]


@tabled
def test_every_task_is_decided_on_the_curve_and_its_page_holds(name: str, task: str) -> None:
    """The page is checked when it is written; no case is undecided, however deep."""
    plant = symobs.StateSpace(*CURVES[name])
    keywords = dict(TASKS[task])
    poles = ", ".join(str(-k) for k in range(1, plant.order + 1))
    asked = {"observer": {"poles": poles}, "both": {"control_poles": poles, "observer_poles": poles}}
    keywords = asked.get(keywords.get("roots", ""), keywords)
    found = getattr(symobs, task)(plant, **keywords)
    assert "undecided" not in verdicts(result_object(found))
    assert found.to("text")


def test_functions_of_time_where_several_parameters_vanish() -> None:
    """det 𝒪 = −(a² − a b + b²) is 0 for real a and b at a = b = 0 only; the page holds with such a case."""
    plant = symobs.StateSpace("[0 1; -1 -1]", None, "[a b]")
    found: Any = symobs.gramian(plant)
    assert {str(r) for case in found.cases for r in case.when} == {"Eq(a, 0)", "Eq(b, 0)"}
    assert found.to("text")


def test_the_page_of_a_case_alone_says_where_it_is() -> None:
    found = symobs.observability(symobs.StateSpace("[0 1; 0 0]", None, "[a^2+b^2-25 1]"))
    (case,) = found.case_tree
    assert case.result is not None
    page = case.result.to("text")
    assert "Here we consider the case a² + b² - 25 = 0." in page
    assert "Here we consider" not in found.to("text")


def test_a_rank_that_drops_at_a_point_of_a_curve_is_said_outside_it() -> None:
    # O = [C; CA] has the rows [a 0], [b 0], [0 a], [0 b]: its rank is 2 on b² = a³, but for the cusp.
    plant = symobs.StateSpace("[0 1; 0 0]", None, "[a 0; b 0]").restricted(
        [Scalar.symbol("b") ** 2 - Scalar.symbol("a") ** 3]
    )
    page = text_of(symobs.observability(plant))
    assert "Here we consider the case a³ = b²." in page
    assert "What follows holds for a ≠ 0. Since rank 𝒪 = 2" in page


SMALL = [
    symobs.StateSpace("[2 0; c c]", "[b; -1]", "[c 0]"),
    symobs.StateSpace("[0 a; 1 2]", "[a-1; -1]", "[0 a-1; 1 b]"),
    symobs.StateSpace("[a b 0; 0 1 c; 0 0 a+b]", "[1; 0; b]", "[a-1 b 1]"),
]


@pytest.mark.parametrize("limit", [2, 12])
@pytest.mark.parametrize("plant", SMALL)
def test_no_exception_of_the_kernel_reaches_a_caller(
    plant: symobs.StateSpace, limit: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With limits that almost everything exceeds every task still answers; what it cannot decide it says."""
    monkeypatch.setattr(ideal, "TERMS", limit)
    monkeypatch.setattr(ideal, "LIMITS", (limit, 3 * limit, 200))
    for task in ("observability", "controllability", "detectability", "stabilizability", "pbh", "transfer_function"):
        ideal._ideal.cache_clear()  # what was found with other limits
        found = getattr(symobs, task)(plant)
        assert found.verdict in {"yes", "no", "conditional", "undecided"}
        assert len(result_object(found)["cases"]) == len(found.case_tree)
