"""Modes where eigenvalues meet: what is told of each is true at every point, computed anew in SymPy's rational matrices.

Plants are drawn so that their eigenvalues are simple in the parameters, and points so that many of them meet.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Scalar
from symobs.formula.tree import Conjunction
from symobs.ground.errors import CertificateRejected, DerivationRejected
from symobs.proof.derivation import CaseStep, Derivation, Section
from tests.kit import tabled, text_of
from tests.programs.campaign.points import answer_at
from tests.support.algebra import holds
from tests.support.problems.strategies import unimodular
from tests.support.sampling import tried

pytestmark = pytest.mark.slow

s = sympy.Symbol("s")
NAMES = ("a", "b")


@st.composite
def hidden_plants(draw: st.DrawFn) -> tuple[Any, Any]:
    """Triangular matrices, or with a pair ± √(q r) on the diagonal, in other coordinates; C sees some states, or none."""
    n = draw(st.integers(2, 3))
    a, b = sympy.symbols(NAMES)
    numbers = [sympy.Integer(k) for k in (0, 0, 1, -1, 2)]
    entry = st.sampled_from([*numbers, a, b, a + b, 1 - a, a * b, a - 1])
    A = sympy.zeros(n, n)
    for i, j in product(range(n), repeat=2):
        if i <= j:
            A[i, j] = draw(entry)
    if draw(st.booleans()):
        A[1, 1], A[1, 0] = A[0, 0], draw(entry)
    seen = draw(st.integers(0, n - 1))
    C = sympy.Matrix(1, n, lambda _, j: draw(entry) if j >= n - seen else 0)
    T, inverse = draw(unimodular(n))
    return sympy.Matrix(T) * A * sympy.Matrix(inverse), C * sympy.Matrix(inverse)


def told(task: str, A: Any, C: Any, **specification: str) -> dict[str, Any]:
    """Return the JSON of an answer about (C, A), or about its dual."""
    plant = symobs.StateSpace(A, None, C) if task in {"pbh", "detectability"} else symobs.StateSpace(A.T, C.T)
    found: dict[str, Any] = json.loads(getattr(symobs, task)(plant, **specification).to_json())["results"][0]
    return found


def at_point(matrix: Any, point: dict[str, Fraction]) -> Any:
    return matrix.subs({name: sympy.Rational(v.numerator, v.denominator) for name, v in point.items()})


def hidden_map(A: Any, C: Any) -> Any:
    """Return A on ker 𝒪."""
    basis = sympy.Matrix.vstack(*(C * A**k for k in range(A.shape[0]))).nullspace()
    if not basis:
        return sympy.zeros(0, 0)
    N = sympy.Matrix.hstack(*basis)
    return (N.T * N).inv() * N.T * A * N


def number(text: str, point: dict[str, Fraction]) -> Any:
    """Read an expression at a point: a number, or a polynomial in s."""
    values = {name: sympy.Rational(v.numerator, v.denominator) for name, v in point.items()}
    return sympy.sympify(text, locals={"s": s}).subs(values)  # noqa: TID251 - what the kernel wrote, never a user's


def check_modes(answer: dict[str, Any], A: Any, C: Any, point: dict[str, Fraction]) -> None:
    """Hold what an answer says of every mode at a point against matrices of numbers."""
    branch = answer_at(answer, point)
    assert branch is not None
    if branch["verdict"] == "undecided":
        return
    A, C = at_point(A, point), at_point(C, point)
    n, seen = A.shape[0], "observable" if "observable" in branch["modes"][0] else "controllable"
    fixed = number(branch["fixed_polynomial"], point)
    X = hidden_map(A, C)
    assert sympy.expand(fixed - (X.charpoly(s).as_expr() if X.shape[0] else 1)) == 0
    values: list[Any] = []
    for mode in branch["modes"]:
        values.append(number(mode["eigenvalue"], point))
        assert mode["conditions"] is not None
        assert all(holds(condition, point) for condition in mode["conditions"]), (mode, point)
        if values[-1].is_rational:
            rank = sympy.Matrix.vstack(A - values[-1] * sympy.eye(n), C).rank()
            assert (mode["rank"], mode[seen]) == (rank, rank == n), (mode, point)
    if all(value.is_rational for value in values):
        assert Counter(values) == Counter(sympy.roots(A.charpoly(s).as_expr(), s, multiple=True))


POINTS = [dict(zip(NAMES, map(Fraction, pair), strict=True)) for pair in product((-1, 0, 1, 2), repeat=2)]


@given(hidden_plants(), st.sampled_from(["pbh", "detectability", "stabilizability"]))
@settings(max_examples=tried(25))
def test_what_is_told_of_a_mode_is_true_at_every_point(plant: tuple[Any, Any], task: str) -> None:
    A, C = plant
    answer = told(task, A, C)
    for point in POINTS:
        check_modes(answer, A, C, point)


@given(hidden_plants())
@settings(max_examples=tried(20))
def test_the_weaker_reading_is_decided_at_every_point(plant: tuple[Any, Any]) -> None:
    """Stable in the sense of Lyapunov: no hidden eigenvalue beyond the axis, and as many eigenvectors on it as roots."""
    A, C = plant
    answer = told("detectability", A, C, meaning="lyapunov")
    for point in POINTS:
        branch = answer_at(answer, point)
        assert branch is not None
        if branch["verdict"] == "undecided":
            continue
        X = hidden_map(at_point(A, point), at_point(C, point))
        roots = sympy.roots(X.charpoly(s).as_expr(), s) if X.shape[0] else {}
        bounded = all(
            sympy.re(root) < 0
            or (sympy.re(root) == 0 and (X - root * sympy.eye(X.shape[0])).rank() == X.shape[0] - count)
            for root, count in roots.items()
        )
        assert (branch["verdict"] == "yes") == bounded, (point, branch["verdict"])


# -- named plants --------------------------------------------------------------------------------------------------------


@tabled
def test_where_eigenvalues_meet_is_a_case(
    A: str, C: str, ranks: dict[str, int], meeting: list[str], there: dict[str, int]
) -> None:
    found = symobs.pbh(symobs.StateSpace(A, None, C))
    answer = json.loads(found.to_json())["results"][0]
    assert {mode["eigenvalue"]: mode["rank"] for mode in answer["modes"]} == ranks
    (case,) = answer["cases"]
    assert case["when"] == meeting
    assert {mode["eigenvalue"]: mode["rank"] for mode in case["modes"]} == there
    assert all(not mode["conditions"] for mode in case["modes"])
    assert "In this case a rank drops below its generic value." in found.to("text").replace("\n    ", " ")
    assert "In this case a rank drops below its generic value." in found.to("latex").replace("\n", " ")


# -- the weaker reading --------------------------------------------------------------------------------------------------


def test_an_integrator_grows_where_a_chain_holds_it() -> None:
    # It was said not to be detectable whatever a is.
    found = symobs.detectability(symobs.StateSpace("[0 a; 0 0]", None, "[0 0]"), meaning="lyapunov")
    assert (found.verdict, [str(c) for c in found.holds_where]) == ("conditional", ["a == 0"])
    (case,) = found.case_tree
    assert case.result is not None
    assert case.result.verdict == "yes"
    assert "Hence the pair (C, A) is detectable." in text_of(found)


def test_two_oscillators_in_a_chain_grow_where_they_meet() -> None:
    # They were said to be detectable whatever their frequencies are.
    A = "[0 1 0 0; -w^2 0 1 0; 0 0 0 1; 0 0 -v^2 0]"
    signs = {"w": "positive", "v": "positive"}
    found = symobs.detectability(symobs.StateSpace(A, None, "[0 0 0 0]", symbols=signs), meaning="lyapunov")
    assert (found.verdict, [str(c) for c in found.holds_where]) == ("conditional", ["v - w != 0"])
    (case,) = found.case_tree
    assert case.result is not None
    assert case.result.verdict == "no"
    assert "The modes on the boundary are distinct provided that v ≠ w." in text_of(found)


def test_a_drop_on_several_equations_is_excluded_as_one() -> None:
    # The first of them alone was given as the condition: a ≠ 0, though (0, b) sees the mode as well.
    found = symobs.detectability(symobs.StateSpace("[1]", None, "[a; b]"))
    assert [str(c) for c in found.holds_where] == ["a != 0 or b != 0"]


# -- the claims ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "lie",
    [{"systems": ()}, {"systems": ((Scalar.of(0),),)}, {"systems": ((),)}, {"minors": (((), ()),)}],
    ids=["no condition", "never met", "always met", "minors of another order"],
)
def test_a_rank_told_with_other_conditions_is_rejected(lie: dict[str, Any]) -> None:
    found = symobs.detectability(symobs.StateSpace("[1-a 0; 0 -1]", None, "[0 0]"))
    with pytest.raises(CertificateRejected):
        found.with_answer("constancy", tuple(replace(where, **lie) for where in found.answer["constancy"]))


def _with_cases(steps: tuple[Any, ...], change: Any) -> tuple[Any, ...]:
    """Return steps with the conditions of cases changed."""
    found: list[Any] = []
    for step in steps:
        if isinstance(step, Section):
            found.append(replace(step, steps=_with_cases(step.steps, change)))
        elif isinstance(step, CaseStep):
            found.append(replace(step, when=change(step.when)))
        else:
            found.append(step)
    return tuple(found)


def test_a_page_that_tells_a_rank_without_its_condition_is_rejected() -> None:
    written: Derivation = symobs.pbh(symobs.StateSpace("[a 0; 0 -1]", None, "[1 0]")).derivation

    def silenced(when: Any) -> Any:
        return when.relations[0] if isinstance(when, Conjunction) else when

    steps = _with_cases(written.steps, silenced)
    assert steps != written.steps
    with pytest.raises(DerivationRejected, match="rank"):
        Derivation(steps, written.start, written.symbols, written.discrete).check()
