"""Strata are right at every point: what an answer with parameters says there is the answer of the plant there."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Ideal, Scalar
from symobs.problem import validate
from symobs.problem.file_tables import parse
from tests.kit import tabled
from tests.programs.campaign.solving import solved
from tests.programs.strata_oracle.__main__ import Found, drawn, examine, judged
from tests.programs.strata_oracle.answers import Branch, Contradiction, branches, hold, relations
from tests.programs.strata_oracle.points import points_on

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.slow

a, b = Scalar.symbol("a"), Scalar.symbol("b")


def told(result: Any) -> dict[str, Any]:
    """Return the JSON object of a result."""
    found: dict[str, Any] = json.loads(result.to_json())["results"][0]
    return found


# -- points that were contradicted ---------------------------------------------------------------------------------------


@tabled
def test_what_was_once_wrong_at_a_point_is_the_answer_of_the_plant_there(
    problem: dict[str, Any], point: dict[str, str], verdict: str
) -> None:
    whole, at = {"symbols": {}, "specification": {}, **problem}, {name: Fraction(n) for name, n in point.items()}
    answer = solved(whole, 600)
    assert isinstance(answer, dict), answer
    assert list(judged(whole, answer, at, 600)) == [("points", "")]
    assert {branch.verdict for branch in branches(answer, at) or ()} == {verdict}


def test_cases_are_polynomials_and_points_are_points() -> None:
    found = symobs.reduced_order_observer(
        symobs.StateSpace(
            "[0 a^2+b^2 a^2+b^2; a^2+b^2 a*b 0; b^2-a 0 a]",
            "[-a; 0; 0]",
            "[a-b b 1; 0 b a^2]",
            "[1; 0]",
            dt=True,
            symbols={"a": "real", "b": "positive"},
        ),
        poles=[-1],
    )
    assert not [text for text in relations(told(found)) if "/" in text]
    # b² − a = 0 and A₂₂ = −1 at (−1, 1): in the row space of C the inner pair has the fixed mode −1 there
    assert ["a + 1 == 0", "b - 1 == 0"] in [case["when"] for case in told(found)["cases"]]
    for case in told(found)["cases"]:
        equations = [text for text in case["when"] if "==" in text]
        assert len(equations) < 6 or case["verdict"] == "undecided"


def test_no_case_of_the_advice_is_where_a_positive_radius_would_be_0() -> None:
    # The integrator is not moved, and no pole at distance r > 0 is at 0.
    plant = symobs.StateSpace("[0 1 0; b 0 0; 0 0 0]", "[0; 1; 0]", "[1 0 0]", symbols={"r": "positive", "b": "real"})
    found = symobs.pole_advice(plant, radius="r")
    assert not [case for case in found.case_tree if any("r" in c.expression.names for c in case.when)]


# -- finitely many points ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("equations", "dimension", "of_a", "of_b"),
    [
        ((a**2 - 2, b - a), 2, a**2 - 2, b**2 - 2),
        (((a - 1) * (a - 2), (b - a) * (b - 3)), 4, a**2 - 3 * a + 2, b**3 - 6 * b**2 + 11 * b - 6),
        (((a - 1) ** 2, b * (a - 1), b**3), 4, a**2 - 2 * a + 1, b**3),
        ((a * b - 1, a + b - 2), 2, a**2 - 2 * a + 1, b**2 - 2 * b + 1),
    ],
)
def test_coordinates_of_finitely_many_points(
    equations: tuple[Scalar, ...], dimension: int, of_a: Scalar, of_b: Scalar
) -> None:
    ideal = Ideal.of(equations)
    assert (ideal.is_finite, ideal.dimension) == (True, dimension)
    assert ideal.quotient is not None
    assert (ideal.quotient.minimal_polynomial(a, "a"), ideal.quotient.minimal_polynomial(b, "b")) == (of_a, of_b)


def test_infinitely_many_points_are_not_counted() -> None:
    ideal = Ideal.of((a * b,))
    assert (ideal.is_finite, ideal.dimension, ideal.by_coordinate) == (False, None, None)


# -- the oracle itself ---------------------------------------------------------------------------------------------------


def test_points_lie_on_the_curves_and_on_their_singular_points() -> None:
    real = {"a": "real", "b": "real"}
    cusp = [(point["a"], point["b"]) for point in points_on(["a**2 - b**3", "a - b"], real, 8)]
    assert (Fraction(0), Fraction(0)) in cusp  # the cusp lies on both
    assert (Fraction(1), Fraction(1)) in cusp  # they cross there
    positive = points_on(["a**2 - b**3"], {"a": "negative", "b": "real"}, 8)
    assert all(point["a"] < 0 for point in positive)


def test_a_wrong_verdict_and_a_wrong_field_are_seen() -> None:
    problem = {"task": "observability", "plant": {"A": "[0 1; 0 0]", "C": "[1 0]"}, "specification": {}}
    there = told(symobs.observability(symobs.StateSpace("[0 1; 0 0]", None, "[1 0]")))
    hold(problem, {}, Branch(there, "yes", ()), there)
    with pytest.raises(Contradiction, match="the verdict is yes, not no"):
        hold(problem, {}, Branch(there, "no", ()), there)
    with pytest.raises(Contradiction, match="rank is 2, not 1"):
        hold(problem, {}, Branch(there | {"rank": 1}, "yes", ()), there)


def test_a_point_that_no_branch_covers_is_seen() -> None:
    answer = {"verdict": "conditional", "conditions": ["a != 0"], "condition_kinds": ["existence"], "cases": []}
    assert branches(answer, {"a": Fraction(0)}) == []
    assert [branch.verdict for branch in branches(answer, {"a": Fraction(1)}) or ()] == ["yes"]
    with pytest.raises(Contradiction, match="a fraction without a value"):
        branches(answer | {"conditions": ["1/a != 0"]}, {"a": Fraction(0)})


#: Plants of order two whose answers come at once.
SAMPLE = [2, 7, 8, 9, 16, 20, 24, 35, 56, 68, 116]


def test_a_sample_of_plants_is_right_at_points_of_its_strata() -> None:
    found = Found()
    for seed in SAMPLE:
        examine(seed, found, seconds=600, most=5)
    assert not found.wrong, found.table()
    assert sum(found.counted[task, "points"] for task, _ in [*found.counted]) > 0
    assert {drawn(seed)["task"] for seed in SAMPLE} >= {"gramian", "pbh", "disturbance_observer"}


def strata(answer: dict[str, Any]) -> Iterator[bool]:
    """Yield for each case, and each case of a case, whether it is decided."""
    for case in answer.get("cases", []):
        yield case["verdict"] != "undecided"
        yield from strata(case)


@tabled
def test_plants_of_several_inputs_and_outputs_are_decided_on_all_strata_and_have_pages(
    task: str, plant: tuple[str, str, str], least: int
) -> None:
    """Curves of degree five and nine meet on them, gains have poles on some of the curves, and points lie on long ones."""
    both = {"control_poles": "-1, -2, -3", "observer_poles": "-4, -5, -6"}
    asked = both if task == "compensator" else {"poles": "-4, -5"}
    result = getattr(symobs, task)(symobs.StateSpace(*plant), **asked)
    decided = list(strata(told(result)))
    assert len(decided) >= least
    assert all(decided)
    assert result.derivation.steps


@pytest.mark.parametrize(
    ("task", "signs", "plant", "given"),
    [
        (
            "state_feedback",
            'a = "real"\nb = "nonzero"\nc = "negative"',
            'A = "[0 1 2; 0 c 2; -1 -1 2]"\nB = "[b^2-a; 0; 1]"\nC = "[0 -1 -1]"',
            'poles = "-3+1*I, -4, -3-1*I"',
        ),
        (
            "gramian",
            'omega = "positive"\nb = "nonnegative"\nT = "positive"',
            'A = "[0 1; -omega^2 -b]"\nC = "[0 1]"',
            'horizon = "T"',
        ),
    ],
    ids=["a kernel on a curve", "the sign of a discriminant"],
)
def test_a_case_has_a_page_of_its_own(task: str, signs: str, plant: str, given: str) -> None:
    """A kernel on a curve, and the signs of a discriminant: both are what the page of the case alone has to rest on."""
    text = f'task = "{task}"\n[symbols]\n{signs}\n[plant]\n{plant}\n[specification]\n{given}\n'
    (result,) = validate(parse(text, "problem")).solve()
    first = result.case_tree[0].result
    assert first is not None
    assert first.derivation.steps


def test_a_handful_of_random_plants_with_functions() -> None:
    found = Found()
    for seed in range(8):
        examine(seed, found, seconds=600, most=5, functions=True)
    assert not found.wrong, "\n".join(found.wrong)
    assert sum(count for (_, kind), count in found.counted.items() if kind == "points") > 10
