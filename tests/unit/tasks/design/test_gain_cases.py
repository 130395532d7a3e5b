"""Where a rank drops below the generic one: gains, fixed modes and Gramians say what is true there, at every point."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Conclude, Section
from tests.kit import tabled, text_of
from tests.programs.campaign.points import answer_at
from tests.support.algebra import evaluated as value
from tests.support.problems.strategies import unimodular
from tests.unit.tasks.analysis.test_repeated_eigenvalues import NAMES, at_point, hidden_map

s = sympy.Symbol("s")
POINTS = [dict(zip(NAMES, map(Fraction, pair), strict=True)) for pair in product((-2, -1, 0, 1), repeat=2)]


@st.composite
def partly_seen(draw: st.DrawFn) -> tuple[Any, Any]:
    """Diagonal plants with modes −1, −2, −3 in other coordinates, seen through rows of parameters and zeros."""
    a, b = sympy.symbols(NAMES)
    n, outputs = draw(st.integers(2, 3)), draw(st.integers(1, 2))
    entry = st.sampled_from([sympy.Integer(0), sympy.Integer(0), sympy.Integer(1), a, b, a - b, a + 1])
    C = sympy.Matrix(outputs, n, lambda *_: draw(entry))
    C[:, n - 1] = sympy.zeros(outputs, 1)
    T, inverse = draw(unimodular(n))
    return sympy.Matrix(T) * sympy.diag(-1, -2, -3).extract(range(n), range(n)) * sympy.Matrix(
        inverse
    ), C * sympy.Matrix(inverse)


def told(task: str, A: Any, C: Any, **specification: Any) -> dict[str, Any]:
    plant = symobs.StateSpace(A, None, C) if task == "observer" else symobs.StateSpace(A.T, C.T)
    found: dict[str, Any] = json.loads(getattr(symobs, task)(plant, **specification).to_json())["results"][0]
    return found


def at(table: list[list[str]], point: dict[str, Fraction]) -> Any:
    rows = [[value(entry, point) for entry in row] for row in table]
    return sympy.Matrix([[sympy.Rational(x.numerator, x.denominator) for x in row] for row in rows])


@given(partly_seen(), st.sampled_from(["observer", "state_feedback"]), st.data())
@settings(max_examples=25)
def test_gains_and_fixed_modes_are_told_at_every_point(plant: tuple[Any, Any], task: str, data: st.DataObject) -> None:
    A, C = plant
    n = A.shape[0]
    poles = [*data.draw(st.lists(st.sampled_from([-1, -2, -3, -4]), min_size=n - 1, max_size=n - 1)), -n]
    answer = told(task, A, C, poles=poles)
    phi = sympy.Poly(sympy.prod(s - pole for pole in poles), s)
    for point in POINTS:
        branch = answer_at(answer, point)
        assert branch is not None
        here = at_point(C, point)
        X = hidden_map(A, here)
        fixed = X.charpoly(s) if X.shape[0] else sympy.Poly(1, s)
        assert branch["verdict"] == ("yes" if sympy.rem(phi, fixed).is_zero else "no"), point
        assert sympy.Poly(sympy.prod(s - int(mode) for mode in branch["fixed_modes"]), s) == fixed, point
        if branch["verdict"] == "yes":
            L = at(branch["L"], point) if task == "observer" else at(branch["K"], point).T
            assert (A - L * here).charpoly(s) == phi, point


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


def test_an_integral_over_all_time_exists_where_what_grows_is_not_seen() -> None:
    # The answer was no, whatever a is.
    found = symobs.gramian(symobs.StateSpace("[1 0; 0 -1]", None, "[a 1]"), horizon="inf")
    assert (found.verdict, [str(c) for c in found.holds_where]) == ("conditional", ["a == 0"])
    (case,) = found.case_tree
    assert case.result is not None
    assert case.result.verdict == "yes"
    assert str(case.result.fields["matrix"]) == "[0 0; 0 1/2]"
    assert found.derivation.check() is not None


def test_a_mode_that_the_input_does_not_move_may_grow() -> None:
    # The page called the whole characteristic polynomial stable, which its own check refused.
    found = symobs.gramian(symobs.StateSpace("[1 0; 0 -2]", "[0; 1]"), horizon="inf", of="controllability")
    assert str(found.fields["matrix"]) == "[0 0; 0 1/4]"
    assert "since all controllable modes decay" in text_of(found)


def test_a_rank_that_drops_somewhere_is_told_in_general() -> None:
    plant = symobs.StateSpace("[-1 0; 0 -2]", None, "[a 0]")
    found = symobs.observability(plant)
    page = text_of(found)
    assert "For generic parameter values rank 𝒪 = 1 < 2, and for no values is it larger" in page
    assert "Case a ≠ 0. The pair becomes observable if state 2 is also measured." in page
    everywhere = symobs.observability(symobs.StateSpace("[-1 0; 0 -2]", None, "[a^2+1 0]"))
    assert "Here rank 𝒪 = 1 < 2" in everywhere.to("text")


def test_a_page_that_tells_the_rank_in_general_as_that_of_all_parameters_is_rejected() -> None:
    written = symobs.observability(symobs.StateSpace("[-1 0; 0 -2]", None, "[a 0]")).derivation
    said: list[str] = []

    def silent(step: Any) -> Any:
        if isinstance(step, Section):
            return replace(step, steps=tuple(map(silent, step.steps)))
        if (
            isinstance(step, Conclude)
            and step.sentence is not None
            and step.sentence.key == "generic_low_observability"
        ):
            said.append(step.sentence.key)
            return replace(step, sentence=replace(step.sentence, key="no_observability"))
        return step

    changed = replace(written, steps=tuple(map(silent, written.steps)))
    assert said
    with pytest.raises(DerivationRejected, match="no_observability"):
        changed.check()


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
