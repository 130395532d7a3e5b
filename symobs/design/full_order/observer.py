"""The full-order (Luenberger) observer  x̂' = A x̂ + B u + L (y − C x̂ − D u),  error  ė = (A − LC) e."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs._dataclass import dataclass
from symobs.analysis.page_parts import given
from symobs.analysis.rank.observability import Observability
from symobs.derivation.builder import Page, relation
from symobs.design.full_order.observer_existence_page import write_ansatz, write_found
from symobs.design.gain.gain_design import GainDesign, require_one
from symobs.design.gain.gain_methods_page import write_companion, write_matching
from symobs.design.gain.gain_page import write_ackermann, write_canonical, write_gain, write_member, write_reduction
from symobs.design.gain.gain_request import designed
from symobs.design.gain.page_style import page_style
from symobs.design.gain.placement_problem import OBSERVER
from symobs.design.page_parts.block_diagrams import draw_collected, draw_copy
from symobs.design.page_parts.component_equations import write_components
from symobs.design.page_parts.time_responses import plot_error
from symobs.design.pole_placement.canonical_form_gain import canonical_gain, companion_gain
from symobs.design.pole_placement.coefficient_matching import matched_gain
from symobs.design.pole_placement.multiple_outputs import pair_of
from symobs.design.pole_placement.row_reduction import reduced_gain
from symobs.design.pole_placement.sylvester import SYLVESTER
from symobs.exact import Matrix
from symobs.formula.term import Term, letter
from symobs.result import Result, method, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.analysis.rank.rank_test import RankResult
    from symobs.design.pole_placement.single_output import Pair
    from symobs.formula import Environment
    from symobs.specification import DesiredPolynomial, Entries, GainText, Name, Poles, PolynomialText
    from symobs.system import StateSpace


@dataclass(frozen=True, eq=False, repr=False)
class ObserverDesign(GainDesign):
    """An observer gain: det(sI − A + LC) = φ(s)."""

    task: ClassVar[str] = "observer"
    letter: ClassVar[str] = "L"
    rank_test: ClassVar[type[RankResult]] = Observability

    @staticmethod
    def pair(plant: StateSpace) -> Pair:
        """Return (A, C)."""
        return pair_of(plant.matrices.A, plant.matrices.C, plant.variable, plant.equations)

    @staticmethod
    def oriented(gain: Matrix) -> Matrix:
        """Return the column itself."""
        return gain

    @staticmethod
    def moved(environment: Environment) -> Term:
        """Return LC."""
        return letter("L", environment) @ letter("C", environment)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """L, φ, and the observer x̂' = A x̂ + B_u u + B_y y."""
        m, L = self.plant.matrices, self.answer["L"]
        return {
            "L": L,
            "polynomial": self.answer["polynomial"],
            "A": None if L is None else m.A - L @ m.C,
            "B_u": None if L is None or not m.has_input else m.B - L @ m.D,
            "B_y": L,
            **self.report,
        }

    def write(self, page: Page) -> None:
        """Write data, gain, and the observer with its error equation."""
        given(page, ("observer", self.desired))
        by_ansatz = self.page_method == "existence" and self.answer["L"] is not None
        if by_ansatz:
            with page.section("existence"):
                write_ansatz(page, self.answer["L"])
        with page.section("observer"):
            style = "auto" if self.page_method == "existence" else self.page_method
            write_gain(page, self, OBSERVER, page_style(style, self.plant, several=self.plant.outputs > 1))
            if by_ansatz:
                write_found(page)
            elif self.answer["L"] is not None:
                write_observer(page, drawn=True)
            if self.answer["L"] is not None:
                draw_collected(page)
                plot_error(page, "e", page["A"] - page["L"] @ page["C"])


def write_observer(page: Page, *, drawn: bool = False) -> None:
    """Write the observer in both forms and its error equation, each line checked on signals."""
    m = page.plant.matrices
    A, C, L, x_hat, y = (page[name] for name in ("A", "C", "L", "x_hat", "y"))
    model, predicted = A @ x_hat, C @ x_hat
    if m.has_input:
        model = model + page["B"] @ page["u"]
    innovation = y - predicted - page["D"] @ page["u"] if m.has_feedthrough else y - predicted
    page.dynamics("x_hat", model + L @ innovation, say="observer_equation")
    if drawn:
        draw_copy(page)
    page.signal("e", page["x"] - page["x_hat"], silent=True)
    closed = A - L @ C
    rate = A @ page["x"] + page["B"] @ page["u"] if m.has_input else A @ page["x"]
    if m.has_feedthrough:
        page.equal(relation(innovation, C @ page["e"]), say="feedthrough_cancels")
    page.equal(
        relation(page["e"].derivative, rate - (model + L @ innovation), closed @ page["e"], closed.shown @ page["e"]),
        say="error_equation",
        error=relation(page["e"], page["x"] - page["x_hat"]),
    )
    _say_deadbeat(page, closed)
    collected, numbers, driven = closed @ x_hat, closed.shown @ x_hat, None
    if m.has_input:
        driven = page["B"] - L @ page["D"] if m.has_feedthrough else page["B"]
        collected, numbers = collected + driven @ page["u"], numbers + driven.shown @ page["u"]
    page.equal(
        relation(x_hat.derivative, collected + L @ y, numbers + L.shown @ y),
        say="observer_collected_with_feedthrough" if m.has_feedthrough else "observer_collected",
        answer=True,
    )
    write_components(page, driven)


def _say_deadbeat(page: Page, closed: Term) -> None:
    """In discrete time with all poles at 0: after how many steps the error is gone."""
    if not page.plant.is_discrete:
        return
    powers = (closed**steps for steps in range(1, page.plant.order + 1))
    gone = next((power for power in powers if power.value.normal().is_zero), None)
    if gone is not None:
        zero = Matrix.zeros(*gone.value.shape)
        page.conclude("deadbeat_error", gone=relation(gone, zero))


@method(
    "observer/canonical_form",
    source="S0, Example 4.1 (pole placement by the canonical form of the dual pair)",
    page=write_canonical,
)
def canonical_form(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """Lᵀ = (differences of coefficients, constant first) · V⁻¹, V = 𝒞(Aᵀ, Cᵀ) · Hankel matrix of χ."""
    return ObserverDesign.by_column(plant, desired, "canonical_form", canonical_gain)


@method("observer/ackermann", source="Ackermann 1972, Regelungstechnik 20, 297-300; dual form", page=write_ackermann)
def ackermann(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """L = φ(A) 𝒪⁻¹ eₙ."""
    require_one(plant.outputs, "output", "ackermann")
    return ObserverDesign.of(plant, desired, "ackermann")


@method("observer/existence", source="S4, existence of an asymptotic observer")
def existence(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """x̂' = F x̂ + G u + H y with undetermined F, G, H: the error is free of x and u for G = B, F = A − HC alone."""
    return ObserverDesign.of(plant, desired, "existence")


@method("observer/sylvester", source=SYLVESTER, page=write_member)
def sylvester(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """L = (G X⁻¹)ᵀ with AᵀX − XF = CᵀG, F the companion matrix of φ: every G for which X is regular."""
    return ObserverDesign.of(plant, desired, "sylvester")


@method(
    "observer/coefficient_matching",
    source="S2, the exact route to its gains; S3 (other ways to the gain)",
    page=write_matching,
)
def coefficient_matching(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """Unknown entries of L: det(sI − A + LC) = φ(s), equal coefficients, a linear system."""
    return ObserverDesign.by_column(plant, desired, "coefficient_matching", matched_gain)


@method("observer/row_reduced_echelon", source="S3, (7)-(10)", page=write_reduction)
def row_reduced_echelon(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """Lᵀ = f Ψ⁻¹ with null vectors [ψ; f] of [λI − Aᵀ : Cᵀ], one for each pole, read off its row-reduced form."""
    return ObserverDesign.by_method(plant, desired, "row_reduced_echelon", reduced_gain)


@method("observer/companion_form", source="S1, the double integrator at 16:01", page=write_companion)
def companion_form(plant: StateSpace, desired: DesiredPolynomial) -> ObserverDesign:
    """Lᵀ = (differences of coefficients, constant first) T, where T brings the pair to companion form."""
    return ObserverDesign.by_column(plant, desired, "companion_form", companion_gain)


@task
def observer(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    L: GainText = None,
    zero: Entries = None,
    member: Name = "simple",
    method: Name = "auto",
) -> Result:
    """Design the full-order observer  x̂' = (A − LC) x̂ + (B − LD) u + L y  with det(sI − A + LC) = φ(s).

    plant         n states, p outputs; B may be missing
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n; or
    L             a given n×p gain, whose polynomial, poles and stability are reported
    zero          entries of L that are to vanish: "(1, 2), (3, 1)" or "[* 0; * *; 0 *]"
    member        "simple" (short numbers) or "decoupled" (each output obeys an equation of its own)
    Returns L (n×p), polynomial, A (A − LC), B_u (B − LD), B_y (L); where L is not unique, because there are several
    outputs or (C, A) is not observable, the `family` of all gains (parameters, L with them, dimension; F, G, X of
    AᵀX − XF = CᵀG and the shift L₀), whose scope is cyclic A − LC; verdict `no` with the fixed modes where φ cannot
    be assigned, or where no gain has zeros as asked for.  Raises `InputError` for wrong poles, shapes or entries.
    Source: S0, (4.18)-(4.20) and Theorem 4.4.
    """
    return designed(
        ObserverDesign, plant, poles=poles, polynomial=polynomial, given=L, zero=zero, member=member, method=method
    )
