"""Strata that pass through points where the data have no value: nothing is said of those points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import symobs
from symobs import StateSpace, compensator, controllability, state_feedback
from symobs.exact import Scalar
from symobs.exact.core.generators import square_root
from symobs.proof.certificate.pointwise import never_together_zero
from tests.kit import tabled

if TYPE_CHECKING:
    from collections.abc import Iterator

k, m = (Scalar.symbol(name) for name in "km")
CURVE = k**2 - k * m**2 - m**2  # without a rational parametrisation, and through k = m = 0


def test_what_vanishes_only_where_the_data_mean_nothing_does_not_vanish() -> None:
    assert not never_together_zero([-k, m], (CURVE,), {})
    assert never_together_zero([-k, m], (CURVE,), {}, (m,))
    assert never_together_zero([m**2 * k], (CURVE,), {}, (m,)), "k = 0 gives m = 0"
    assert not never_together_zero([k - 3], (CURVE,), {}, (m,)), "k = 3 and m = 3/2"


def test_a_product_of_what_does_not_vanish_does_not_vanish() -> None:
    # With c = cos t and s = sin t, b^4 - 1 + c^2 = (b^2 + s)(b^2 - s), which no factor shows before it is reduced.
    b, c, s = (Scalar.symbol(name) for name in "bcs")
    circle = (c**2 + s**2 - 1,)
    assert never_together_zero([b**4 - 1 + c**2], circle, {}, (b**2 + s, b**2 - s))
    assert not never_together_zero([b**4 - 1 + c**2], circle, {}, (b**2 + s,))


def test_the_page_of_a_gain_holds_on_such_a_curve() -> None:
    plant = StateSpace("[0 1; 1 m]", "[1; k/m]", "[-3 -2]")
    assert "k**2" in str(state_feedback(plant, poles=[-1, -2]).conditions)
    state_feedback(plant, poles=[-1, -2]).derivation.check()
    compensator(plant, control_poles=[-3, -1], observer_poles=[-3], observer="minimal").derivation.check()


def test_the_page_of_a_long_stratum_holds() -> None:
    """There the kernel of the controllability matrix vanishes at some points, the matrix of rank 2 at none."""
    A = "[2, omega^2, 0; 0.1, a, omega^2; 1/2, 1/a, 1/2]"
    plant = StateSpace(A, "[1; -3; -3]", "[0.1, -1, 0]", symbols={"a": "positive", "omega": "real"})
    controllability(plant).derivation.check()


def test_what_a_page_says_of_the_other_root_proves_nothing() -> None:
    # sqrt(q) and sqrt(-q) both real leave no point, and every inequality was true: 1 != 1 among them.
    q = m**2 - k**2 / 4
    roots = tuple((square_root(value) ** 2 - value).numerator for value in (q, -q))
    known = (square_root(q),)
    assert not never_together_zero([Scalar.of(0)], roots, {}, known)
    assert not never_together_zero([k - 3], roots, {}, known)
    assert never_together_zero([square_root(q) ** 2 - q + 1], roots, {}, known), "its own root is known"


@tabled
def test_an_answer_with_cases_has_a_page(task: str, plant: dict[str, Any], asked: dict[str, Any]) -> None:
    result = getattr(symobs, task)(StateSpace(**plant, symbols={"a": "real", "b": "real"}), **asked)
    assert result.to_json()
    assert result.to_latex()
    assert not list(_impossible(result))


def _impossible(result: Any, known: tuple[Any, ...] = ()) -> Iterator[Any]:
    """Yield nested cases whose single equation is what a case around them excludes."""
    for case in result.case_tree:
        if len(case.when) == 1 and case.when[0].operator == "==" and case.when[0].expression in known:
            yield case
        excluded = (c.expression.substitute(case.substitution).numerator for c in case.when if c.operator == "!=")
        if case.result is not None:
            yield from _impossible(case.result, (*known, *excluded))


def test_an_output_that_vanishes_still_needs_observability() -> None:
    """x₀ = 0 explains y = 0 always, and alone exactly where the pair is observable: det 𝒪 = −(a + 1)·1."""
    plant = symobs.StateSpace("[0 0; 0 -1]", C="[a+1 -1]")
    found = symobs.initial_state(plant, output="0")
    assert found.verdict == "conditional"
    assert [str(condition) for condition in found.conditions] == ["T > 0", "Ne(a + 1, 0)"]
    (case,) = found.cases
    assert [str(condition) for condition in case.when] == ["Eq(a + 1, 0)"]
    assert (case.result.verdict, case.result.kernel) == ("no", ((1, 0),))
