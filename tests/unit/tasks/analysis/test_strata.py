"""Strata that no rational functions parametrise: each task has a checked answer there, held to points of the curve.

At rational points of the curves SymPy computes ranks, fixed modes and transfer functions of the plant with numbers; what a
task says of the whole curve must be that.
"""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import sympy

import symobs
from symobs.exact import Scalar
from symobs.exact import ideals as ideal
from symobs.pages.formats.json import result_object
from tests.kit import tabled, tables, text_of

pytestmark = pytest.mark.slow

s = sympy.Symbol("s")


class Curve(NamedTuple):
    """A plant, the equation of the curve on which it changes, and rational points of it."""

    A: str
    B: str
    C: str
    equation: str
    points: tuple[dict[str, Fraction], ...]


def points(text: str) -> tuple[dict[str, Fraction], ...]:
    return tuple({pair[0]: Fraction(pair[2:]) for pair in line.split()} for line in text.split(";"))


CURVES = {
    "circle": Curve(
        "[0 1 0; 0 0 1; -1 -2 -3]",
        "[0; 0; 1]",
        "[a^2+b^2-2 0 0]",
        "a**2 + b**2 - 2",
        points("a=1 b=1; a=7/5 b=1/5; a=-1/5 b=7/5"),
    ),
    "cusp": Curve("[1 0; 0 -2]", "[1; 1]", "[a^2-2*b^3 1]", "a**2 - 2*b**3", points("a=4 b=2; a=-4 b=2; a=1/2 b=1/2")),
    "cone": Curve(
        "[0 1; c^2+1 0]",
        "[1; 1]",
        "[a b]",
        "a**2 - b**2*c**2 - b**2",
        points("a=5/4 b=1 c=3/4; a=-5 b=4 c=3/4; a=5 b=3 c=4/3"),
    ),
    "input": Curve(
        "[-1 0; 0 2]", "[a^2+b^2-2; 1]", "[1 1]", "a**2 + b**2 - 2", points("a=1 b=1; a=7/5 b=1/5; a=-1/5 b=7/5")
    ),
}


def plant_of(curve: Curve) -> symobs.StateSpace:
    return symobs.StateSpace(curve.A, curve.B, curve.C)


def on(curve: Curve, found: Any) -> Any:
    """Return the one case whose only equation is that of the curve."""
    (case,) = [
        case for case in found.cases if [str(r.lhs) for r in case.when if isinstance(r, sympy.Eq)] == [curve.equation]
    ]
    assert case.result is not None
    return case.result


def at(value: Any, point: dict[str, Fraction]) -> Any:
    return sympy.simplify(
        value.subs({sympy.Symbol(k): sympy.Rational(v.numerator, v.denominator) for k, v in point.items()})
    )


def numbers(curve: Curve, point: dict[str, Fraction]) -> tuple[sympy.Matrix, sympy.Matrix, sympy.Matrix]:
    plant = plant_of(curve)
    A, B, C = (sympy.Matrix(at(part, point)) for part in (plant.A, plant.B, plant.C))
    return A, B, C


def stack(A: sympy.Matrix, C: sympy.Matrix) -> sympy.Matrix:
    return sympy.Matrix.vstack(*(C * A**k for k in range(A.shape[0])))


def fixed(A: sympy.Matrix, C: sympy.Matrix) -> sympy.Expr:
    """Return det(sI − X) for A on ker 𝒪."""
    kernel = stack(A, C).nullspace()
    if not kernel:
        return sympy.Integer(1)
    N = sympy.Matrix.hstack(*kernel)
    X = (N.T * N).inv() * N.T * A * N
    return X.charpoly(s).as_expr()


@pytest.mark.parametrize("name", CURVES)
def test_detectability_on_a_curve(name: str) -> None:
    curve = CURVES[name]
    moving = name == "input"
    result = on(curve, getattr(symobs, "stabilizability" if moving else "detectability")(plant_of(curve)))
    for point in curve.points:
        A, B, C = numbers(curve, point)
        wanted = fixed(A.T, B.T) if moving else fixed(A, C)
        assert sympy.expand(at(result.fixed_polynomial, point) - wanted) == 0
        stable = all(sympy.re(root) < 0 for root in sympy.roots(wanted, s))
        said = (
            result.verdict
            if result.verdict != "conditional"
            else {True: "yes", False: "no"}[all(bool(at(condition, point)) for condition in result.conditions)]
        )
        assert said == ("yes" if stable else "no")


@pytest.mark.parametrize("name", CURVES)
def test_the_decomposition_on_a_curve(name: str) -> None:
    curve = CURVES[name]
    result = on(curve, symobs.decomposition(plant_of(curve)))
    for point in curve.points:
        A, B, C = numbers(curve, point)
        R, O = stack(A.T, B.T).T, stack(A, C)
        seen = (O * R).rank()
        assert result.sizes == {
            "co": seen,
            "c_no": R.rank() - seen,
            "nc_o": O.rank() - seen,
            "nc_no": A.shape[0] - R.rank() - O.rank() + seen,
        }
        wanted = (C * (s * sympy.eye(A.shape[0]) - A).inv() * B)[0]
        assert sympy.simplify(at(result.transfer_function, point) - wanted) == 0
        T = sympy.Matrix(at(result.T, point))
        assert sympy.Matrix(at(result.A, point)) * T == T * A
        order = result.minimal_order
        degree = sympy.degree(sympy.fraction(sympy.cancel(wanted))[1], s) if wanted != 0 else 0
        assert order == degree


TASKS: dict[str, dict[str, Any]] = tables(Path(__file__))["tasks"]


def verdicts(told: dict[str, Any]) -> list[str]:
    return [told["verdict"], *(verdict for case in told["cases"] for verdict in verdicts({"cases": [], **case}))]


@tabled
def test_every_task_is_decided_on_the_curve_and_its_page_holds(name: str, task: str) -> None:
    """The page is checked when it is written; no case is undecided, however deep."""
    plant = plant_of(CURVES[name])
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
