"""Where a rank drops below the generic one: gains, fixed modes and Gramians say what is true there, at every point."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from tests.kit import tabled, text_of
from tests.support.claims.claims import HOLDS, Setting, applicable
from tests.support.problems.strategies import unimodular
from tests.support.sampling import tried

s = sympy.Symbol("s")
POINTS = [dict(zip("ab", map(Fraction, pair), strict=True)) for pair in product((-2, -1, 0, 1), repeat=2)]


@st.composite
def partly_seen(draw: st.DrawFn) -> tuple[Any, Any]:
    """Diagonal plants with modes −1, −2, −3 in other coordinates, seen through rows of parameters and zeros."""
    a, b = sympy.symbols("a b")
    n, outputs = draw(st.integers(2, 3)), draw(st.integers(1, 2))
    entry = st.sampled_from([sympy.Integer(0), sympy.Integer(0), sympy.Integer(1), a, b, a - b, a + 1])
    C = sympy.Matrix(outputs, n, lambda *_: draw(entry))
    C[:, n - 1] = sympy.zeros(outputs, 1)
    T, inverse = draw(unimodular(n))
    return sympy.Matrix(T) * sympy.diag(-1, -2, -3).extract(range(n), range(n)) * sympy.Matrix(
        inverse
    ), C * sympy.Matrix(inverse)


@pytest.mark.slow
@given(partly_seen(), st.sampled_from(["observer", "state_feedback"]), st.data())
@settings(max_examples=tried(25))
def test_gains_are_told_at_every_point(plant: tuple[Any, Any], task: str, data: st.DataObject) -> None:
    A, C = plant
    n = A.shape[0]
    poles = [*data.draw(st.lists(st.sampled_from([-1, -2, -3, -4]), min_size=n - 1, max_size=n - 1)), -n]
    given_plant = symobs.StateSpace(A, None, C) if task == "observer" else symobs.StateSpace(A.T, C.T)
    answer = getattr(symobs, task)(given_plant, poles=poles)
    for point in POINTS:
        found = list(applicable(answer, point))
        assert found
        for part in found:
            HOLDS[task](part, Setting.of(given_plant, {"poles": poles}, point))


@tabled
def test_modes_that_are_hidden_at_some_parameters_are_named_there(C: str, poles: str, verdict: str, there: str) -> None:
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 -3]", None, C)
    found = symobs.observer(plant, poles=poles)
    assert found.verdict == verdict
    assert [str(mode) for mode in found.fields["fixed_modes"]] == ["-2", "-3"]
    (case,) = found.case_tree
    assert [str(condition) for condition in case.when] == ["a == 0"]
    assert case.result is not None
    assert case.result.verdict == there
    assert [str(mode) for mode in case.result.fields["fixed_modes"]] == ["-1", "-2", "-3"]
    assert found.derivation.check() is not None


def test_another_input_serves_where_the_first_fails() -> None:
    # K = 3/a was told for a ≠ 0 only, though the second column of B moves the mode as well.
    found = symobs.state_feedback(symobs.StateSpace("[-1 0; 0 -2]", "[a b; 0 0]"), poles="-4, -2")
    verdicts = {tuple(map(str, case.when)): case.result.verdict for case in found.case_tree if case.result is not None}
    assert verdicts == {("a == 0", "b == 0"): "no", ("a == 0",): "conditional"}


def test_a_rank_that_drops_somewhere_is_told_in_general() -> None:
    plant = symobs.StateSpace("[-1 0; 0 -2]", None, "[a 0]")
    found = symobs.observability(plant)
    page = text_of(found)
    assert "For generic parameter values rank 𝒪 = 1 < 2, and for no values is it larger" in page
    assert "Case a ≠ 0. The pair becomes observable if state 2 is also measured." in page
    everywhere = symobs.observability(symobs.StateSpace("[-1 0; 0 -2]", None, "[a^2+1 0]"))
    assert "Here rank 𝒪 = 1 < 2" in everywhere.to("text")


def test_a_page_says_where_within_a_stratum_a_fixed_mode_is_wanted() -> None:
    """Where (a − b) c = 1 the mode b is fixed: there is a gain for b = −1 and b = −2 alone."""
    plant = symobs.StateSpace("[b 0; 1 a]", "[0; 1]", "[c 1]")
    found = symobs.observer(plant, poles=[-1, -2])
    (case,) = found.cases
    a, b, c, s = sympy.symbols("a b c s")
    for inner in case.result.cases:
        (mode,) = sympy.solve(inner.when[0].lhs, b)
        there = {b: mode, a: mode + 1 / c}
        error = sympy.Matrix([[b, 0], [1, a]]).subs(there) - inner.result.L * sympy.Matrix([[c, 1]])
        assert sympy.simplify(error.charpoly(s).as_expr() - (s + 1) * (s + 2)) == 0
    assert len(case.result.cases) == 2
    page = " ".join(found.to("text").replace("│", "").split())
    assert "a c - b c - 1 = 0, b none b ≠ -1, b ≠ -2" in page


def test_a_family_says_where_none_of_its_members_has_a_value() -> None:
    """At p = w = 0 every denominator vanishes for all free letters: held to it by SymPy."""
    plant = symobs.StateSpace("[0 w; -w 0]", "[0; 2]", "[1 0; 1 c]")
    family = symobs.unknown_input_observer(plant, E="[0 1; 0 1]", poles="-2*p, -p").family
    assert family["scope"].endswith("none of them has a value where p == 0 and w == 0")
    names = sympy.symbols("p w")
    for point, is_lost in (((0, 0), True), ((0, 1), False), ((1, 0), False), ((3, 2), False)):
        under = [sympy.fraction(sympy.together(entry))[1].subs(zip(names, point, strict=True)) for entry in family["L"]]
        assert (sympy.expand(sympy.prod(under)) == 0) is is_lost
