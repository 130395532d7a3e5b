"""State feedback  u = −K x,  closed loop  ẋ = (A − BK) x."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.ground.dataclass import dataclass
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.rank.observability import Controllability
from symobs.tasks.design.full_order.placement_methods import register_methods
from symobs.tasks.design.gain.gain_design import FEEDBACK, GainDesign, design_gain, page_style
from symobs.tasks.design.gain.gain_page import write_gain
from symobs.tasks.design.pole_placement.multiple_outputs import pair_of
from symobs.tasks.result import Case, Result, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Matrix
    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Entries, GainText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.rank.rank_test import RankResult
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


@dataclass
class StateFeedbackDesign(GainDesign):
    """A feedback gain: det(sI − A + BK) = φ(s)."""

    task: ClassVar[str] = "state_feedback"
    answered_by = ("K",)
    answered_where_given = ("polynomial",)
    gains = ("K",)
    letters = {
        "K": "K",
        "polynomial": "chi_K",
        "closed_loop_matrix": "A - B K",
        "poles": "chi_K",
    }
    panels = ("plane", "responses")
    cards = ("K", "polynomial", "closed_loop_matrix")
    letter: ClassVar[str] = "K"
    rank_test: ClassVar[type[RankResult]] = Controllability

    @staticmethod
    def dual_pair(plant: StateSpace) -> ObserverPair:
        """Return (Aᵀ, Bᵀ)."""
        return pair_of(plant.matrices.A.T, plant.matrices.B.T, plant.variable, plant.equations)

    @staticmethod
    def transpose_for_task(gain: Matrix) -> Matrix:
        """Return the row."""
        return gain.T

    @staticmethod
    def gain_term(environment: Environment) -> Term:
        """Return BK."""
        return environment["B"] @ environment["K"]

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The design on the strata where modes, gain, or whether there is one are others than in general."""
        from symobs.tasks.design.gain.gain_cases import cases_of_gain  # noqa: PLC0415 - of many in a loop none is asked

        return cases_of_gain(self)

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

    @property
    def printed_method(self) -> str:
        """The method of the page: by default the most readable one for small plants."""
        if self.desired is None or self.answer["K"] is None or not self.fixed_polynomial.is_one:
            return super().printed_method
        return page_style(self.page_method, self.plant, several=self.plant.inputs > 1)

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the loop with u = v − K x."""
        m, K = self.plant.matrices, self.answer["K"]
        if K is None or not m.has_output:
            return super().systems
        loop = Realisation((m.A - m.B @ K).normal(), m.B, (m.C - m.D @ K).normal(), m.D)
        return {**super().systems, "closed_loop": loop}

    def write(self, page: Builder) -> None:
        """Write data and gain."""
        given(page, ("control", self.desired))
        with page.section("state_feedback"):
            write_gain(page, self, FEEDBACK, page_style(self.page_method, self.plant, several=self.plant.inputs > 1))


register_methods(StateFeedbackDesign)


@task
def state_feedback(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    K: GainText = None,
    zero: Entries = None,
    member: Name = "simple",
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Design state feedback  u = −K x  with det(sI − A + BK) = φ(s).

    plant         n states, m inputs; C may be missing
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n; or
    K             a given m×n gain, whose polynomial, poles and stability are reported
    zero          entries of K that are to vanish: "(1, 2), (3, 1)" or "[* 0 *; * * 0]"
    member        "simple" (short numbers) or "decoupled" (each input drives a part of its own)
    choose        "simple" (short numbers) or "small" (largest entry at most 1.5 times that of the best conditioned
                  placement); left out, small for numbers where the simple one is more than 3 times as large as that one
    Returns K (m×n), polynomial, closed_loop_matrix (A − BK); where K is not unique, because there are several inputs
    or (A, B) is not controllable, the `family` of all gains (parameters, K with them, dimension; F, G, X of
    AX − XF = BG and the shift K₀), whose scope is cyclic A − BK; verdict `no` with the fixed modes where φ cannot be
    assigned, or where no gain has zeros as asked for.  Raises `InputError` for wrong poles, shapes or entries.
    Source: W. M. Wonham (1967).
    """
    return design_gain(
        StateFeedbackDesign,
        plant,
        poles=poles,
        polynomial=polynomial,
        given=K,
        zero=zero,
        member=member,
        choose=choose,
        method=method,
    )
