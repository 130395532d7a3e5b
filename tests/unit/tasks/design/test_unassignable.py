"""Pages that say that no gain places the desired poles: they say it of every point of the parameters, or of no point."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.steps import Section
from tests.kit import text_of

if TYPE_CHECKING:
    from symobs.proof.derivation import Derivation, Step


def solved(task: str, A: str, *, B: str | None = None, C: str | None = None, **asked: Any) -> Any:
    return getattr(symobs, task)(symobs.StateSpace(A, B, C), **asked)


#: The mode a is beyond every gain, and among the desired poles where a = −1 or a = −2 (a = −1).
PLANTS = {
    "observer": solved("observer", "[a 0; 0 1]", C="[0 1]", poles="-1, -2"),
    "state_feedback": solved("state_feedback", "[a 0; 0 1]", B="[0; 1]", poles="-1, -2"),
    "reduced_order_observer": solved("reduced_order_observer", "[1 0; 0 a]", C="[1 0]", poles="-1"),
    "integral_action": solved("integral_action", "[a 0; 0 1]", B="[0; 1]", C="[0 1]", poles="-1, -2, -3"),
}


def said_of_all(derivation: Derivation) -> Derivation:
    """Return the page without the words that except the cases with a gain."""

    def without(steps: tuple[Step, ...]) -> tuple[Step, ...]:
        kept: list[Step] = []
        for step in steps:
            if isinstance(step, Section):
                kept.append(replace(step, steps=without(step.steps)))
            elif isinstance(step, CaseStep) and any("!=" in r.operators for r in getattr(step.when, "relations", ())):
                kept += step.steps
            elif not isinstance(step, CaseStep):
                kept.append(step)
        return tuple(kept)

    return replace(derivation, steps=without(derivation.steps))


@pytest.mark.parametrize("task", PLANTS)
def test_what_is_not_so_at_some_points_is_said_outside_them_and_nowhere_else(task: str) -> None:
    with pytest.raises(DerivationRejected, match="not_polynomial"):
        said_of_all(PLANTS[task].derivation).check()
    assert "a ≠ -1" in text_of(PLANTS[task])


def test_where_two_equations_have_to_hold_the_remainder_is_told() -> None:
    page = text_of(solved("state_feedback", "[a 1 0; 0 b 0; 0 0 1]", B="[0; 0; 1]", poles="-1, -2, -3"))
    # (s + 1)(s + 2)(s + 3) = (s + a + b + 6)(s − a)(s − b) + r, by hand
    rest = "(a² + a b + b² + 6a + 6b + 11)s + 6 - a² b - a b² - 6a b"
    assert f"leaves the remainder {rest}: these poles can be assigned only where" in page
    assert "does not divide" not in page


def test_a_case_of_dependent_outputs_is_told_on_the_page_of_tracking() -> None:
    asked = {"control_poles": "1/4, 1/4", "observer_poles": "0", "reference_matrix": "[1 -1; 0 -1]"}
    plant = symobs.StateSpace("[-1 0; 2 a*b]", "[b+1; 1]", "[0 a*b]", dt=True, symbols={"a": "nonzero", "b": "real"})
    (found,) = [case.result for case in symobs.tracking(plant, **asked).cases if "Eq(b, 0)" in str(case.when)]
    assert "no such observer exists" in text_of(found)


def test_modes_of_plant_and_integrator_are_told_where_their_basis_is_one() -> None:
    """The basis of the uncontrollable modes has a lower rank at b = 1, which lies within the case 2a + 1 = 0."""
    given = "[b 0 0; 0 0 1; 0 -a -a]", "[-a; -1; 1]", "[2 0 0; a^2-1 0 0]"
    plant = symobs.StateSpace(*given, dt=True, symbols={"a": "real", "b": "real"})
    page = text_of(symobs.integral_action(plant, poles="1/4, 1/2+3*I, -1/3, 1/2, 1/2-3*I"))
    assert "Case a = -1/2, b ≠ -1/2." in page
    assert "Case b ≠ 1. The roots of z² - 2z + 1 are uncontrollable modes" in page
