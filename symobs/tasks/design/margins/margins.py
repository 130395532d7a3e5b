"""Margins of a loop of one input and one output: how far gain and phase may move, and how near to −1 it comes.

The loop is K(sI − A)⁻¹B of a state feedback, C(sI − A)⁻¹L of an observer, F(s)G(s) of a compensator or a controller F, with
negative feedback.  P is its denominator without any cancelling, P + N the characteristic polynomial of the closed loop.
"""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import Factored, Matrix, RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, Loop, slowest_root
from symobs.exact.algebraic.nyquist import nyquist, told_of
from symobs.exact.numerals.written_digits import in_digits as matrix_in_digits
from symobs.formula.tree import Decimals, Environment
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, InputError
from symobs.ground.later import Later
from symobs.proof.certificate.claims import Certificate, Claim, Statement
from symobs.proof.derivation.builder import Builder, predicate
from symobs.stability.frequency_plots import bode_picture, nyquist_picture
from symobs.system.specification import desired_polynomial, in_common_field, read_gain, reject_both
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.stability_region.loop_polynomials import loop_polynomials, monic
from symobs.tasks.analysis.stability_region.margins import (
    MARGINS,
    NO_MARGINS,
    MarginNumbers,
    NotRational,
    gains_of,
    margins_of,
    numbers,
)
from symobs.tasks.analysis.stability_region.stability_region import stability_region
from symobs.tasks.analysis.stability_region.stability_region_page import write_line, write_loop
from symobs.tasks.design.compensator.compensator import observer_based, observer_order
from symobs.tasks.design.full_order.observer import ObserverDesign
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_cases import design_of
from symobs.tasks.result import Result, choose, equality, holds, method, page_of, poles_of, task
from symobs.tasks.result.answers import named_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree.term import Term
    from symobs.system import StateSpace
    from symobs.system.specification import GainText, Name, Poles, PolynomialText, TransferFunctionText
    from symobs.system.transfer_function_text import WrittenTransferFunction
    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion


#: The margins of loops with a dead time are of the type below, and imported where there is one.
_dead_time = Later("symobs.tasks.design.margins.delayed_margins")
#: The polynomial of the closed loop, the matrix of what is added to the plant, and where the loop is cut.
_LOOPS = {
    "state_feedback": ("polynomial", None, "inputs"),
    "lqr": ("polynomial", None, "inputs"),
    "observer": ("polynomial", None, "outputs"),
    "kalman": ("polynomial", None, "outputs"),
    "compensator": ("closed_loop_polynomial", "compensator_matrix", "inputs"),
}


class MarginsAnswer(MarginNumbers):
    """P + N and P, None where there is no design or they are no polynomials; `open` says why no margins are found."""

    closed: Scalar | None
    opened: Scalar | None
    open: str | None


@dataclass
class Margins(Result):
    """The margins of the loop with the polynomials P and P + N, of a design or of a controller; none where it is not stable."""

    answer: MarginsAnswer
    design: Result | None
    written: WrittenTransferFunction | None

    task: ClassVar[str] = "margins"
    answered_by = ("gain_down", "gain_up", "phase_deg")

    @classmethod
    def of(
        cls,
        plant: StateSpace,
        design: Result | None,
        controller: WrittenTransferFunction | None,
        loop: tuple[Scalar, Scalar] | None,
        method_name: str = "boundary",
    ) -> Self:
        """Return the margins of the loop P + N, P; those of no loop where the design does not exist."""
        found, question = NO_MARGINS, None
        closed, opened = loop or (None, None)
        if closed is not None and opened is not None:
            try:
                found = margins_of(closed, opened, plant.variable, plant.dt)
            except NotRational as error:
                question = f"{error} is no rational number"
            if None in found.values() and found["slowest"] is not None and found["gain_up"]:
                found, question = NO_MARGINS, "the digits of the margins are not certain"
        answer: MarginsAnswer = {"closed": closed, "opened": opened, "open": question, **found}
        if question is None and "k" in plant.symbols.signs and "k" not in plant.field.names:
            # k multiplies the gain on the page, whatever sign a name of the data has that does not occur in them
            signs = {name: sign for name, sign in plant.symbols.signs.items() if name != "k"}
            plant = plant.with_symbols(replace(plant.symbols, signs=signs))
        return cls(plant, method_name, answer, design, controller)

    @property
    def free_signals(self) -> Mapping[str, int]:
        """Those of the page of the design."""
        return {} if self.design is None else self.design.free_signals

    @property
    def loop(self) -> tuple[Scalar, Scalar] | None:
        """P + N and P."""
        closed, opened = self.answer["closed"], self.answer["opened"]
        return None if closed is None or opened is None else (closed, opened)

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what P and P + N are, the slowest root, the ends of the gain, and the digits of the rest."""
        answer, plant = self.answer, self.plant
        if self.loop is None:
            if named_found({**answer, "open": None}):
                raise CertificateRejected("there are no margins, and no polynomials, without a loop")
            return
        m, (closed, opened) = plant.matrices, self.loop
        values: dict[str, Any] = {"A": m.A, "chi_o": opened, "chi_cl": closed}
        own = None if self.design is None else _LOOPS[self.design.task][1]
        if self.design is not None and own is not None:
            values["A_c"] = self.design.fields[own]
        if self.written is not None:
            values |= {"B": m.B, "C": m.C, "D": m.D, "F": self.written.value, "q": monic(self.written)[1]}
        e = Environment(variable=plant.variable, values=values)
        whole = e["A"].pencil.apply("det")
        if self.design is not None:
            if own is not None:
                inner = e["A_c"].pencil
                whole = whole @ inner.apply("det")
            yield holds(e, "chi_o = {whole}", "P = det(s*I - A), times that of the compensator", whole=whole)
            yield equality(closed, _plain(self.design.fields[_LOOPS[self.design.task][0]]), e, "P + N of the design")
        else:
            yield holds(e, "chi_o = {whole} q", whole=whole)
            yield holds(e, "chi_cl I = chi_o (I + F (C pencil(A)^-1 B + D))")
        if answer["slowest"] is not None:
            yield Statement("the slowest root", lambda: "exact" if self._slowest == answer["slowest"] else "")
        if answer["modulus"] is not None:
            how = "every interval by the roots at a point of it"
            ends = answer["gain_down"], answer["gain_up"]
            yield Statement(
                "the ends of the gains around 1",
                lambda: how if gains_of(self._coefficients[0], self._coefficients[1], plant.dt) == ends else "",
            )
            yield Statement("angle, distance and peak", lambda: "interval arithmetic" if self._are_certain else "")

    @property
    def _coefficients(self) -> list[list[Fraction]]:
        return [[*numbers(polynomial, self.plant.variable)] for polynomial in self.loop or ()]

    @property
    def _is_rational(self) -> bool:
        entries = (c for polynomial in self.loop or () for c in polynomial.coefficients(self.plant.variable))
        return all(entry.is_constant for entry in entries)

    @property
    def _slowest(self) -> RealNumber:
        return slowest_root(self._coefficients[0], discrete=self.plant.is_discrete)

    @property
    def _are_certain(self) -> bool:
        """Whether angle, distance and peak round as they are written, by enclosures with twice the digits."""
        loop = Loop.of(*self._coefficients, discrete=self.plant.is_discrete)
        answer, unit = self.answer, Decimal(1).scaleb(-MARGIN_DIGITS)
        written = answer["phase_deg"], answer["modulus"], answer["peak"]
        for told, value in zip(written, (loop.phase, loop.modulus, loop.peak), strict=True):
            finer = value(2 * MARGIN_DIGITS)
            if INFINITE in (told, finer):
                if told != finer:
                    return False
            elif told is None or finer is None or abs(Decimal(told) - Decimal(finer)) > unit / 2 + unit / 1000:
                return False
        return True

    @property
    def verdict(self) -> str:
        """`no` where there is no design or it is not stable; `undecided` where margins are not found."""
        if self.answer["open"]:
            return "undecided"
        return "no" if self.answer["modulus"] is None else super().verdict

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the design and of the margins."""
        return (*(() if self.design is None else self.design.all_certificates), *self.certificates)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The margins: ends and slowest exactly, the others as decimals in texts; and the polynomials."""
        found: dict[str, Any] = {name: _written(self.answer[name]) for name in MARGINS}
        closed, opened = self.loop or (None, None)
        found |= {"closed_loop_polynomial": closed, "open_loop_polynomial": opened}
        if self.loop is not None and self._is_rational:
            found |= nyquist(*self.loop, self.plant.variable)
        return found | ({"question": question} if (question := self.answer["open"]) else {})

    def __getattr__(self, name: str) -> Any:
        """Return a margin as a number of SymPy or a decimal, any other answer as usual."""
        if name in MARGINS and (found := {margin: self.answer[margin] for margin in MARGINS}[name]) is not None:
            return public(found)
        return super().__getattr__(name)

    def keys(self) -> tuple[str, ...]:
        """The names of the margins, by which they are looked up, too: `found["gain_up"]`, `dict(found)`."""
        return MARGINS

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the margins."""
        return iter(MARGINS)

    def __getitem__(self, name: str) -> Any:
        """Return a margin by its name."""
        if name not in MARGINS:
            raise KeyError(name)
        return getattr(self, name)

    def items(self) -> tuple[tuple[str, Any], ...]:
        """Return the margins with their names."""
        return tuple((name, self[name]) for name in MARGINS)

    @cached_property
    def region(self) -> StabilityRegion | None:
        """Where P + kN is stable as k moves; None where k does not stand in it."""
        if self.loop is None:
            return None
        closed, opened = self.loop
        moved = opened + Scalar.symbol("k") * (closed - opened)
        if "k" not in moved.names:
            return None
        found: Any = stability_region(moved, dt=self.plant.dt, parameters="k")
        return found  # type: ignore[no-any-return]


def _written(value: Any) -> Any:
    """Return a number with its closed form, a text where it has none."""
    closed = value.closed_form() if isinstance(value, RealNumber) else None
    return closed if closed is not None or value is None else str(value)


def public(value: Any) -> Any:
    """Return an exact number as SymPy has it, a rounded one as a decimal."""
    from symobs.exact.sympy_bridge.conversion import real_to_sympy, scalar_to_sympy  # noqa: PLC0415 - Python's face
    from symobs.exact.sympy_bridge.sympy_import import sympy  # noqa: PLC0415

    if value == INFINITE:
        return sympy.oo
    if isinstance(value, Scalar):
        return scalar_to_sympy(value)
    return real_to_sympy(value) if isinstance(value, RealNumber) else Decimal(value)


def has_loop(design: Any) -> bool:
    """Return whether this is a design with one loop."""
    kind = getattr(design, "task", "")
    return kind in _LOOPS and design.verdict != "no" and getattr(design.plant, _LOOPS[kind][2]) == 1


def loop_of(design: Any) -> tuple[Scalar, Scalar]:
    """Return P + N and P of a design; raises `InputError` where it has no such loop."""
    if not has_loop(design):
        message = (
            "margins are those of one loop: a state feedback, an observer or a compensator with one input or output"
        )
        raise InputError(message, where="design", repair="give a design with numbers for a plant with one")
    name, own, _ = _LOOPS[design.task]
    plant, fields = design.plant, design.fields
    opened = plant.matrices.A.characteristic_polynomial(plant.variable)
    if own is not None:
        opened *= fields[own].characteristic_polynomial(plant.variable)
        through: Matrix | None = fields.get("direct_term")
        if through is not None and not through.is_zero and plant.matrices.has_feedthrough:
            raise _not_proper("design", 'take a compensator with observer = "full"')
    return _plain(fields[name]), opened


def in_digits(design: Any) -> Any:
    """Return a design of numbers with its irrational data and gains rounded; itself where it is rational, or has letters."""
    fields = design.numbers
    gains = {letter: matrix_in_digits(fields[letter]) for letter in "KL" if fields.get(letter) is not None}
    plant, is_same = design.plant.in_digits(), all(gains[letter] == design.answer.get(letter) for letter in gains)
    if None in gains.values() or (is_same and plant is design.plant):
        return design
    plant = plant.with_rounding()
    if design.task != "compensator":
        kind: Any = StateFeedbackDesign if "K" in gains else ObserverDesign
        return kind.of_given(plant, *gains.values())
    observer, nothing = "minimal" if design.has_reduced_observer else "full", (None, None)
    given_gains = gains["K"], gains["L"]
    return observer_based(
        plant, task="margins", control=nothing, estimate=nothing, observer=observer, gains=given_gains
    )


def _not_proper(where: str, repair: str) -> InputError:
    message = "the loop has a gain at infinity: neither the plant nor the compensator is strictly proper"
    return InputError(message, where=where, repair=repair)


def _plain(value: Any) -> Scalar:
    found: Scalar = value.value if isinstance(value, Factored) else value
    return found


def loop_of_controller(
    plant: StateSpace, controller: WrittenTransferFunction, *, proper: bool = False
) -> tuple[Scalar, Scalar]:
    """Return P + N and P of F G; raises `InputError` where that is not strictly proper, or with `proper` not proper."""
    opened, moved = loop_polynomials(plant, controller)
    if not proper and not moved.is_zero and moved.degree(plant.variable) == opened.degree(plant.variable):
        raise _not_proper("specification.controller", "give a controller with a pole more")
    return opened + moved, opened


@method("margins/boundary", source="skogestad2005, ch. 2")
def boundary(
    plant: StateSpace,
    design: Result | None,
    controller: WrittenTransferFunction | None,
    loop: tuple[Scalar, Scalar] | None,
) -> Margins:
    """Find where roots meet the boundary of stability, and enclose |1 + loop| on it."""
    return Margins.of(plant, design, controller, loop)


@task
@poles_of(observer_poles=observer_order)
def margins(
    plant: StateSpace,
    *,
    poles: Poles = None,
    polynomial: PolynomialText = None,
    K: GainText = None,
    control_poles: Poles = None,
    control_polynomial: PolynomialText = None,
    observer_poles: Poles = None,
    observer_polynomial: PolynomialText = None,
    L: GainText = None,
    observer: Name = "full",
    controller: TransferFunctionText = None,
    method: Name = "auto",
) -> Result:
    """Return how far a loop of one input and one output is from instability: gain, phase, distance from −1, sensitivity.

    plant                                   n states, numbers without roots
    poles or polynomial, or K               of A − BK: the loop K(sI − A)⁻¹B; of A − LC where the plant has no input
    control_poles or control_polynomial     the same; together with an observer the loop is F(s)G(s)
    observer_poles or observer_polynomial   alone: the loop C(sI − A)⁻¹L, and L a given gain
    observer                                `full` or `minimal`
    controller                              F(s), a rational function: the loop is F(s)G(s), with negative feedback
    Returns gain_down and gain_up, the ends of the interval around 1 of the gains that keep the loop stable, and slowest, the
    largest real part (modulus) of its poles, exactly; phase_deg, the smallest change of phase either way that does not,
    modulus, the smallest distance from −1, and peak, the largest |1/(1 + loop)|, to six certain digits after the point.
    Of a plant with a dead time the loop is that of a controller; what has no closed form has twelve certain digits.
    Where it is unstable, too: open_loop_unstable, encirclements (of −1, counterclockwise) and closed_loop_unstable,
    axis_crossings (omega, value), gain_crossover, phase_crossover, and delay_margin, the least φ/ω.
    The verdict is `no` where the closed loop is not stable, `undecided` with symbols.  Raises `InputError` for several
    inputs or outputs, and for a loop with a gain at infinity.
    Source: S. Skogestad and I. Postlethwaite, Multivariable Feedback Control, 2nd ed., ch. 2.
    """
    asked = {"poles": poles, "polynomial": polynomial, "K": K}
    asked |= {"control_poles": control_poles, "control_polynomial": control_polynomial}
    asked |= {"observer_poles": observer_poles, "observer_polynomial": observer_polynomial, "L": L}
    chosen = choose("margins", method, "boundary")
    if controller is not None:
        plant = plant.knowing(controller)
        for name, value in asked.items():
            reject_both("controller", controller, value, None, other=name)
        plant.require("B", "C", task="margins")
        plant = plant.in_digits()
        if plant.delay is not None:
            delayed: Result = _dead_time.DelayedMargins.of_loop(plant, controller)
            return delayed.asked(method)
        written = read_transfer_function(controller, plant.symbols, plant.variable, "specification.controller")
        found: Result = chosen.solve(plant, None, written, loop_of_controller(plant, written))
        return found.asked(method)
    design = in_digits(_design(plant.knowing(*asked.values()), asked, observer))
    loop = None if design.verdict == "no" else loop_of(design)
    found = chosen.solve(design.plant, design, None, loop)
    return found.asked(method)


def _design(plant: StateSpace, asked: Mapping[str, Any], observer: str) -> Result:
    """Return the design that is asked for; raises `InputError` where nothing is, or too much."""
    of_loops = {prefix: (f"{prefix}poles", f"{prefix}polynomial") for prefix in ("", "control_", "observer_")}
    given = {prefix: any(asked[name] is not None for name in names) for prefix, names in of_loops.items()}
    by_state, by_estimate = given["control_"] or asked["K"] is not None, given["observer_"] or asked["L"] is not None
    if given[""]:
        for name in ("control_poles", "control_polynomial", "observer_poles", "observer_polynomial", "K", "L"):
            reject_both(name, asked[name], asked["poles"], asked["polynomial"])
        by_state, by_estimate = plant.matrices.has_input, not plant.matrices.has_input
    elif not by_state and not by_estimate:
        message, repair = "nothing says which loop it is", "give poles, control_poles, observer_poles or a controller"
        raise InputError(message, where="specification", repair=repair)
    if by_state and by_estimate:
        control, estimate = (tuple(asked[name] for name in of_loops[prefix]) for prefix in ("control_", "observer_"))
        gains = asked["K"], asked["L"]
        return observer_based(plant, task="margins", control=control, estimate=estimate, observer=observer, gains=gains)
    kind: type[StateFeedbackDesign | ObserverDesign] = StateFeedbackDesign if by_state else ObserverDesign
    names = of_loops["" if given[""] else "control_" if by_state else "observer_"]
    plant.require("B" if by_state else "C", task="margins")
    gain = asked[kind.letter]
    if gain is not None:
        reject_both(kind.letter, gain, asked[names[0]], asked[names[1]], other=names[0])
        shape = (plant.inputs, plant.order) if by_state else (plant.order, plant.outputs)
        return kind.of_given(plant, read_gain(gain, plant, kind.letter, shape))
    desired = desired_polynomial(plant, asked[names[0]], asked[names[1]], names=names)
    assert desired is not None  # noqa: S101 - required
    plant, (desired,) = in_common_field(plant, desired)
    return design_of(kind, plant, desired)


# The page: the design, P and P + N, the gains that keep the loop stable, the rest.


@page_of(Margins)
def write_margins(page: Builder, result: Margins) -> None:
    """Write the whole page."""
    if result.design is not None:
        result.design.write(page)
    else:
        given(page)
    answer, loop = result.answer, result.loop
    if loop is None:
        return
    with page.section("margins"):
        _polynomials(page, result, *loop)
        if question := answer["open"]:
            page.remark("margins_open", question=question)
            return
        _frequency_response(page, result, loop)
        if answer["modulus"] is None:
            page.conclude("margins_none", predicate("unstable", page["chi_cl"]))
            return
        page.conclude("margins_stable", predicate("stable", page["chi_cl"]))
        _gains(page, result)
        phase = None if answer["phase_deg"] == INFINITE else answer["phase_deg"]
        told = named_found({"modulus": answer["modulus"], "peak": answer["peak"], "phase": phase})
        page.remark("margins_are" if "phase" in told else "margins_any_phase", **_rounded(page, told))
        _delay(page, loop)


def _frequency_response(page: Builder, result: Margins, loop: tuple[Scalar, Scalar]) -> None:
    """Write how often the frequency response surrounds −1, and where it meets the real axis and the unit circle."""
    if not result._is_rational:  # noqa: SLF001 - its own page
        return
    clock = "_discrete" if page.plant.is_discrete else ""
    (counts,) = told_of("counts", *loop, page.plant.variable)
    page.remark("margins_counts" if result.fields["encirclements"] is not None else "margins_on_boundary", **counts)
    if result.fields["closed_loop_polynomial"] == result.fields["open_loop_polynomial"]:
        return
    for kind in ("axis", "level"):
        for told in told_of(kind, *loop, page.plant.variable):
            page.remark(f"margins_{kind}{clock}", **_rounded(page, told))
    _pictures(page, *loop)


def _pictures(page: Builder, closed: Scalar, opened: Scalar) -> None:
    """Draw the Bode and the Nyquist picture."""
    variable = page.plant.variable
    loop = (closed - opened) / opened
    N, P = loop.numerator, loop.denominator
    subject = page("(chi_cl - chi_o) / chi_o")
    page.plot(bode_picture(N, P, variable), subject)
    crossed = [float(told["value"]) for told in told_of("axis", closed, opened, variable)]
    page.plot(nyquist_picture(N, P, variable, crossed), subject)


def _delay(page: Builder, loop: tuple[Scalar, Scalar]) -> None:
    """Write the delay margin of a stable loop."""
    clock = "_discrete" if page.plant.is_discrete else ""
    for told in told_of("delay", *loop, page.plant.variable):
        page.remark(f"margins_delay{clock}" if told else "margins_no_delay", **_rounded(page, told))


def _rounded(page: Builder, told: Mapping[str, str]) -> dict[str, Term]:
    return {name: page.term(Decimals(Scalar.of(Fraction(value)))) for name, value in told.items()}


def _polynomials(page: Builder, result: Margins, whole: Scalar, cut: Scalar) -> None:
    """Write P and P + N."""
    if result.design is None:
        assert result.written is not None  # noqa: S101 - the other way to a loop
        write_loop(page, result.written, whole)
        return
    kind, opened = result.design.task, page["det(pencil(A))"]
    closed: list[Term] = []
    if kind == "state_feedback":
        closed = [page["det(pencil(A) + B K)"]]
    elif kind == "observer":
        closed = [page["det(pencil(A) + L C)"]]
    elif kind == "compensator":
        own = page["A_c"] if page.defines("A_c") else page.set("A_c", result.design.fields["compensator_matrix"])
        opened = opened @ own.pencil.apply("det")
    place = "output" if kind == "observer" else "input"
    page.define("chi_o", opened, page.value(cut), say=f"margins_cut_{place}", closing=False)
    if not closed:
        response = page["C pencil(A)^-1 B"]
        response = response + page["D"] if page.plant.matrices.has_feedthrough else response
        closed = [page("chi_o (1 + F {response})", response=response)]
    page.define("chi_cl", *closed, page.value(whole), say="margins_closed", closing=False)


def _gains(page: Builder, result: Margins) -> None:
    """Write for which gains the loop stays stable."""
    if result.region is None:
        page.remark("margins_no_loop")
        return
    k = page.value(Scalar.symbol("k"))
    moved = page("chi_o + {k} (chi_cl - chi_o)", k=k)
    page.define("chi_p", moved, page.value(result.region.answer["polynomial"]), say="margins_gain", closing=False)
    write_line(page, result.region, "chi_p")
