"""State feedback  u = −K x,  closed loop  ẋ = (A − BK) x."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.analysis.observability import Controllability
from symobs.analysis.pages import given
from symobs.design.assignment import Pair
from symobs.design.canonical import canonical_gain
from symobs.design.gain import GainDesign, require_single
from symobs.design.gain_pages import FEEDBACK, write_gain
from symobs.design.observer import page_style
from symobs.formula.term import Term, letter
from symobs.method import Result, choose, method, task
from symobs.specification import (
    DesiredPolynomial,
    GainText,
    Name,
    Poles,
    PolynomialText,
    desired_polynomial,
    read_gain,
    reject_both,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.analysis.rank_result import RankResult
    from symobs.exact import Matrix
    from symobs.formula import Environment
    from symobs.page import Page
    from symobs.system import StateSpace


@dataclass(frozen=True, eq=False, repr=False)
class StateFeedbackDesign(GainDesign):
    """A feedback gain: det(sI − A + BK) = φ(s)."""

    task: ClassVar[str] = "state_feedback"
    letter: ClassVar[str] = "K"
    rank_test: ClassVar[type[RankResult]] = Controllability

    @staticmethod
    def pair(plant: StateSpace) -> Pair:
        """Return (Aᵀ, Bᵀ)."""
        return Pair(plant.matrices.A.T, plant.matrices.B.T, plant.variable, plant.equations)

    @staticmethod
    def oriented(gain: Matrix) -> Matrix:
        """Return the row."""
        return gain.T

    @staticmethod
    def moved(environment: Environment) -> Term:
        """Return BK."""
        return letter("B", environment) @ letter("K", environment)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """K, φ and the closed-loop matrix A − BK."""
        m, K = self.plant.matrices, self.answer["K"]
        return {
            "K": K,
            "polynomial": self.answer["polynomial"],
            "closed_loop_matrix": None if K is None else m.A - m.B @ K,
            **self.report,
        }

    def write(self, page: Page) -> None:
        """Write data and gain."""
        given(page, ("control", self.desired))
        with page.section("state_feedback"):
            write_gain(page, self, FEEDBACK, page_style(self.page_method, self.plant))


@method("state_feedback/canonical_form", source="S0, Examples 4.1 and 4.2 (controllable canonical form)")
def canonical_form(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = (differences of coefficients, constant first) · V⁻¹, V = 𝒞 · Hankel matrix of χ."""
    pair = StateFeedbackDesign.pair(plant)
    if not pair.is_observable:
        return StateFeedbackDesign.of(plant, desired, "canonical_form")
    answer = {"K": canonical_gain(pair, desired).T, "polynomial": desired.polynomial}
    return StateFeedbackDesign(plant, "canonical_form", answer, desired)


@method("state_feedback/ackermann", source="Ackermann 1972, Regelungstechnik 20, 297-300")
def ackermann(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = eₙᵀ 𝒞⁻¹ φ(A)."""
    return StateFeedbackDesign.of(plant, desired, "ackermann")


@task
def state_feedback(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    K: GainText = None,
    method: Name = "auto",
) -> Result:
    """Design state feedback  u = −K x  with det(sI − A + BK) = φ(s).

    plant         n states, one input; C may be missing
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n; or
    K             a given 1×n gain, whose polynomial, poles and stability are reported
    Returns K (1×n), polynomial, closed_loop_matrix (A − BK); where (A, B) is not controllable either the family of
    gains or verdict `no` with the fixed modes.  Raises `InputError` for wrong poles or shapes.
    Source: S0, Example 4.2 and the pole assignment theorem.
    """
    plant = plant.knowing(poles, polynomial, K)
    plant.require("B", task="state_feedback")
    require_single(plant.inputs, "input", "state_feedback")
    reject_both("K", K, poles, polynomial)
    if K is not None:
        return StateFeedbackDesign.of_given(plant, read_gain(K, plant, "K", (plant.inputs, plant.order)))
    desired = desired_polynomial(plant, poles, polynomial)
    assert desired is not None  # noqa: S101 - required
    return choose("state_feedback", method, "ackermann").solve(plant, desired).asked(method)
