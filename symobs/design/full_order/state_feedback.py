"""State feedback  u = −K x,  closed loop  ẋ = (A − BK) x."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs._dataclass import dataclass
from symobs.analysis.page_parts import given
from symobs.analysis.rank.observability import Controllability
from symobs.design.gain.gain_design import GainDesign, require_one
from symobs.design.gain.gain_methods_page import write_companion, write_matching
from symobs.design.gain.gain_page import write_ackermann, write_canonical, write_gain, write_member, write_reduction
from symobs.design.gain.gain_request import designed
from symobs.design.gain.page_style import page_style
from symobs.design.gain.placement_problem import FEEDBACK
from symobs.design.pole_placement.canonical_form_gain import canonical_gain, companion_gain
from symobs.design.pole_placement.coefficient_matching import matched_gain
from symobs.design.pole_placement.multiple_outputs import pair_of
from symobs.design.pole_placement.row_reduction import reduced_gain
from symobs.design.pole_placement.sylvester import SYLVESTER
from symobs.formula.term import Term, letter
from symobs.result import Result, method, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.analysis.rank.rank_test import RankResult
    from symobs.derivation.builder import Page
    from symobs.design.pole_placement.single_output import Pair
    from symobs.exact import Matrix
    from symobs.formula import Environment
    from symobs.specification import DesiredPolynomial, Entries, GainText, Name, Poles, PolynomialText
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
        return pair_of(plant.matrices.A.T, plant.matrices.B.T, plant.variable, plant.equations)

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
            write_gain(page, self, FEEDBACK, page_style(self.page_method, self.plant, several=self.plant.inputs > 1))


@method(
    "state_feedback/canonical_form",
    source="S0, Examples 4.1 and 4.2 (controllable canonical form)",
    page=write_canonical,
)
def canonical_form(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = (differences of coefficients, constant first) · V⁻¹, V = 𝒞 · Hankel matrix of χ."""
    return StateFeedbackDesign.by_column(plant, desired, "canonical_form", canonical_gain)


@method("state_feedback/ackermann", source="Ackermann 1972, Regelungstechnik 20, 297-300", page=write_ackermann)
def ackermann(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = eₙᵀ 𝒞⁻¹ φ(A)."""
    require_one(plant.inputs, "input", "ackermann")
    return StateFeedbackDesign.of(plant, desired, "ackermann")


@method("state_feedback/sylvester", source=SYLVESTER, page=write_member)
def sylvester(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = G X⁻¹ with AX − XF = BG, F the companion matrix of φ: every G for which X is regular."""
    return StateFeedbackDesign.of(plant, desired, "sylvester")


@method(
    "state_feedback/coefficient_matching",
    source="S2, the exact route to its gains; S3 (other ways to the gain)",
    page=write_matching,
)
def coefficient_matching(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """Unknown entries of K: det(sI − A + BK) = φ(s), equal coefficients, a linear system."""
    return StateFeedbackDesign.by_column(plant, desired, "coefficient_matching", matched_gain)


@method("state_feedback/row_reduced_echelon", source="S3, (7)-(10)", page=write_reduction)
def row_reduced_echelon(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = f Ψ⁻¹ with null vectors [ψ; f] of [λI − A : B], one for each pole, read off its row-reduced form."""
    return StateFeedbackDesign.by_method(plant, desired, "row_reduced_echelon", reduced_gain)


@method("state_feedback/companion_form", source="S1, the double integrator at 16:01", page=write_companion)
def companion_form(plant: StateSpace, desired: DesiredPolynomial) -> StateFeedbackDesign:
    """K = (differences of coefficients, constant first) T, where T brings the pair to companion form."""
    return StateFeedbackDesign.by_column(plant, desired, "companion_form", companion_gain)


@task
def state_feedback(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    K: GainText = None,
    zero: Entries = None,
    member: Name = "simple",
    method: Name = "auto",
) -> Result:
    """Design state feedback  u = −K x  with det(sI − A + BK) = φ(s).

    plant         n states, m inputs; C may be missing
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n; or
    K             a given m×n gain, whose polynomial, poles and stability are reported
    zero          entries of K that are to vanish: "(1, 2), (3, 1)" or "[* 0 *; * * 0]"
    member        "simple" (short numbers) or "decoupled" (each input drives a part of its own)
    Returns K (m×n), polynomial, closed_loop_matrix (A − BK); where K is not unique, because there are several inputs
    or (A, B) is not controllable, the `family` of all gains (parameters, K with them, dimension; F, G, X of
    AX − XF = BG and the shift K₀), whose scope is cyclic A − BK; verdict `no` with the fixed modes where φ cannot be
    assigned, or where no gain has zeros as asked for.  Raises `InputError` for wrong poles, shapes or entries.
    Source: S0, Example 4.2 and the pole assignment theorem.
    """
    return designed(
        StateFeedbackDesign, plant, poles=poles, polynomial=polynomial, given=K, zero=zero, member=member, method=method
    )
