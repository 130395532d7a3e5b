"""The full-order (Luenberger) observer  x̂' = A x̂ + B u + L (y − C x̂ − D u),  error  ė = (A − LC) e."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Matrix
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.ground.dataclass import dataclass
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.page_parts import given, letters_apart_from_data
from symobs.tasks.analysis.rank.observability import Observability
from symobs.tasks.design.block_diagrams import draw_collected, draw_copy
from symobs.tasks.design.components import write_components
from symobs.tasks.design.error_plots import plot_error
from symobs.tasks.design.full_order.placement_methods import register_methods
from symobs.tasks.design.gain.gain_design import OBSERVER, GainDesign, design_gain, page_style
from symobs.tasks.design.gain.gain_page import write_cases, write_gain
from symobs.tasks.design.pole_placement.multiple_outputs import pair_of
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names
from symobs.tasks.result import Case, Result, task
from symobs.tasks.result.control_systems import Controller, observer_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.system import StateSpace
    from symobs.system.specification import Entries, GainText, Name, Poles, PolynomialText
    from symobs.tasks.analysis.rank.rank_test import RankResult
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


# The observer from its task: x̂' = F x̂ + G u + H y with nothing known of F, G, H but that the error is to vanish.


def write_ansatz(page: Builder, gain: Matrix) -> None:
    """Write the error of the ansatz, and the choice of F and G that frees it of x and u."""
    m = page.plant.matrices
    undetermined(page, "F_x", "f_", (m.A - gain @ m.C).normal())
    undetermined(page, "H_x", "h_", gain)
    if m.has_input:
        undetermined(page, "G_x", "g_", (m.B - gain @ m.D).normal() if m.has_feedthrough else m.B)
    model = page["F_x x_hat"]
    if m.has_input:
        model = page("{model} + G_x u", model=model)
    page.dynamics("x_hat", model + page["H_x y"], say="existence_ansatz")
    page.signal("e", "x - x_hat", silent=True)
    moving = page["(A - H_x C) x - F_x x_hat"]
    choice = [page.line("F_x = A - H_x C")]
    if m.has_input:
        wanted: Term = page["B - H_x D"] if m.has_feedthrough else page["B"]
        moving = page("{moving} + ({wanted} - G_x) u", moving=moving, wanted=wanted)
        choice.insert(0, relation(page["G_x"], wanted))
    page.equal(
        page.line("e' = {moving}", moving=moving),
        say="existence_error",
        error=page.line("e = x - x_hat"),
    )
    page.equal(*choice, say="existence_choice")
    page.equal("e' = (A - H_x C) e", say="existence_left")


def write_found(page: Builder) -> None:
    """Write the observer with the matrices found."""
    m = page.plant.matrices
    page.conclude_silently("H_x = L")
    closed = page["A - L C"]
    collected, numbers = page["(A - L C) x_hat"], letters_apart_from_data(page, closed.value) @ page["x_hat"]
    if m.has_input:
        driven = page["B - L D"] if m.has_feedthrough else page["B"]
        collected, numbers = collected + driven @ page["u"], numbers + driven.as_value @ page["u"]
    page.equal(
        page.line("x_hat' = {collected} + L y = {numbers} + #L y", collected=collected, numbers=numbers),
        say="existence_observer",
        answer=True,
    )


def undetermined(page: Builder, name: str, stem: str, value: Matrix) -> None:
    """Establish a matrix of letters, which stand for what will be chosen."""
    names = iter(fresh_names(stem, len(value.entries), taken_names(page)))
    page.set(name, Matrix.of([[page.name_coefficient(next(names), entry) for entry in row] for row in value.rows]))


@dataclass
class ObserverDesign(GainDesign):
    """An observer gain: det(sI − A + LC) = φ(s)."""

    task: ClassVar[str] = "observer"
    answered_by = ("L",)
    answered_where_given = ("polynomial",)
    gains = ("L",)
    shows_gain = "A"
    letters = {
        "L": "L",
        "polynomial": "chi_L",
        "A": "A - L C",
        "B_u": "B - L D",
        "poles": "chi_L",
    }
    panels = ("plane", "responses")
    cards = ("L", "polynomial", "A")
    letter: ClassVar[str] = "L"
    rank_test: ClassVar[type[RankResult]] = Observability

    @staticmethod
    def dual_pair(plant: StateSpace) -> ObserverPair:
        """Return (A, C)."""
        return pair_of(plant.matrices.A, plant.matrices.C, plant.variable, plant.equations)

    @staticmethod
    def transpose_for_task(gain: Matrix) -> Matrix:
        """Return the column itself."""
        return gain

    @staticmethod
    def gain_term(environment: Environment) -> Term:
        """Return LC."""
        return environment["L"] @ environment["C"]

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The design on the strata where modes, gain, or whether there is one are others than in general."""
        from symobs.tasks.design.gain.gain_cases import cases_of_gain  # noqa: PLC0415 - of many in a loop none is asked

        return cases_of_gain(self)

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

    @property
    def printed_method(self) -> str:
        """The method of the page: by default the most readable one for small plants."""
        if self.desired is None or self.answer["L"] is None or not self.fixed_polynomial.is_one:
            return super().printed_method
        return page_style(self.page_method, self.plant, several=self.plant.outputs > 1)

    @property
    def systems(self) -> Mapping[str, Realisation]:
        """The plant, and the observer (u, y) → x̂."""
        m, L = self.plant.matrices, self.answer["L"]
        if L is None:
            return super().systems
        driven = Matrix.block([[m.B - L @ m.D, L]]) if m.has_input else L
        rest = Matrix.zeros(self.plant.order, driven.shape[1])
        own = Realisation((m.A - L @ m.C).normal(), driven.normal(), Matrix.identity(self.plant.order), rest)
        return {**super().systems, "observer": own}

    @property
    def controller(self) -> Controller | None:
        """(u, y) → x̂."""
        return observer_of(self)

    def write(self, page: Builder) -> None:
        """Write data, gain, and the observer with its error equation."""
        given(page, ("observer", self.desired))
        by_ansatz = self.page_method == "existence" and self.answer["L"] is not None
        if by_ansatz:
            with page.section("existence"):
                write_ansatz(page, self.answer["L"])
        with page.section("observer"):
            style = "auto" if self.page_method == "existence" else self.page_method
            style = page_style(style, self.plant, several=self.plant.outputs > 1)
            write_gain(page, self, OBSERVER, style, cases=False)
            if by_ansatz:
                write_found(page)
            elif self.answer["L"] is not None:
                write_observer(page, drawn=True)
            if self.answer["L"] is not None:
                draw_collected(page)
                plot_error(page, "e", page["A - L C"])
            write_cases(page, self, OBSERVER)


def model_and_innovation(page: Builder) -> tuple[Term, Term]:
    """Return A x̂ + B u and y − C x̂ − D u: the observer is the first and L times the second."""
    m = page.plant.matrices
    A, C, x_hat, y = (page[name] for name in ("A", "C", "x_hat", "y"))
    model, predicted = A @ x_hat, C @ x_hat
    if m.has_input:
        model = page("{model} + B u", model=model)
    return model, page["y - C x_hat - D u"] if m.has_feedthrough else y - predicted


def write_observer(page: Builder, *, drawn: bool = False, alone: bool = True) -> None:
    """Write the observer in both forms and its error equation, each line checked on signals.

    `alone`, it is the answer, and its components are written out; else it is a part of a compensator.
    """
    m = page.plant.matrices
    L, x_hat = page["L"], page["x_hat"]
    model, innovation = model_and_innovation(page)
    page.dynamics("x_hat", model + L @ innovation, say="observer_equation")
    if drawn:
        draw_copy(page)
    page.signal("e", "x - x_hat", silent=True)
    closed = page["A - L C"]
    rate = page["A x + B u"] if m.has_input else page["A x"]
    if m.has_feedthrough:
        page.equal(page.line("{innovation} = C e", innovation=innovation), say="feedthrough_cancels")
    is_collected = alone or m.has_feedthrough  # then A − LC is written out there
    members = [rate - (model + L @ innovation), page["(A - L C) e"]]
    members += [] if is_collected else [letters_apart_from_data(page, closed.value) @ page["e"]]
    error = page.line("e = x - x_hat")
    page.equal(relation(page["e'"], *members), say="error_equation", error=error)
    _say_deadbeat(page, closed)
    collected, numbers, driven = closed @ x_hat, letters_apart_from_data(page, closed.value) @ x_hat, None
    if m.has_input:
        driven = page["B - L D"] if m.has_feedthrough else page["B"]
        collected, numbers = collected + driven @ page["u"], numbers + driven.as_value @ page["u"]
    whole = page.line("x_hat' = {collected} + L y = {numbers} + #L y", collected=collected, numbers=numbers)
    if not is_collected:
        page.conclude_silently(whole)
        return
    said = "observer_collected_with_feedthrough" if m.has_feedthrough else "observer_collected"
    page.equal(whole, say=said, answer=alone)
    if alone:
        write_components(page, driven)


def _say_deadbeat(page: Builder, closed: Term) -> None:
    """Say after how many steps the error is gone, in discrete time with all poles at 0."""
    if not page.plant.is_discrete:
        return
    powers = (closed**steps for steps in range(1, page.plant.order + 1))
    gone = next((power for power in powers if power.value.normal().is_zero), None)
    if gone is not None:
        zero = Matrix.zeros(*gone.value.shape)
        page.conclude("deadbeat_error", gone=relation(gone, zero))


register_methods(ObserverDesign)


@task
def observer(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    L: GainText = None,
    zero: Entries = None,
    member: Name = "simple",
    choose: Name = "auto",
    method: Name = "auto",
) -> Result:
    """Design the full-order observer  x̂' = (A − LC) x̂ + (B − LD) u + L y  with det(sI − A + LC) = φ(s).

    plant         n states, p outputs; B may be missing
    poles         n desired poles, closed under conjugation; or
    polynomial    φ, monic of degree n; or
    L             a given n×p gain, whose polynomial, poles and stability are reported
    zero          entries of L that are to vanish: "(1, 2), (3, 1)" or "[* 0; * *; 0 *]"
    member        "simple" (short numbers) or "decoupled" (each output obeys an equation of its own)
    choose        "simple" (short numbers) or "small" (largest entry at most 1.5 times that of the best conditioned
                  placement); left out, small for numbers where the simple one is more than 3 times as large as that one
    Returns L (n×p), polynomial, A (A − LC), B_u (B − LD), B_y (L); where L is not unique, because there are several
    outputs or (C, A) is not observable, the `family` of all gains (parameters, L with them, dimension; F, G, X of
    AᵀX − XF = CᵀG and the shift L₀), whose scope is cyclic A − LC; verdict `no` with the fixed modes where φ cannot
    be assigned, or where no gain has zeros as asked for.  Raises `InputError` for wrong poles, shapes or entries.
    Source: D. G. Luenberger (1964, 1971).
    """
    return design_gain(
        ObserverDesign,
        plant,
        poles=poles,
        polynomial=polynomial,
        given=L,
        zero=zero,
        member=member,
        choose=choose,
        method=method,
    )
