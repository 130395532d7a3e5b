"""The gains k of a loop with a dead time T at the input of the plant for which the closed loop is stable.

P is the denominator of F(s)G(s) without any cancelling, k N its numerator; the poles of the closed loop are the roots of
P(s) + k N(s) e^{−sT}, of which finitely many are unstable.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Scalar
from symobs.exact.algebraic.dead_time import DelayedLoop
from symobs.exact.algebraic.dead_time_margins import (
    crossings_of_sign,
    digits_of,
    exact_value,
    landmarks_of,
    loop_with,
    told_of_dead_time,
)
from symobs.exact.core.generators import function
from symobs.formula.tree import Decimals, Environment, HoldsExactlyWhere, SymbolList
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Statement
from symobs.proof.derivation import Inequalities, RegionSummary
from symobs.proof.derivation.builder import predicate, sentence
from symobs.proof.derivation.region_check import delayed_intervals
from symobs.stability.frequency_plots import nyquist_picture
from symobs.system.specification import read_names
from symobs.system.transfer_function_text import read_transfer_function
from symobs.tasks.analysis.page_parts import factored_form, given
from symobs.tasks.analysis.stability_region.loop_polynomials import Parameters, loop_polynomials, monic
from symobs.tasks.result import Result, holds, page_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact.algebraic.dead_time import Edge
    from symobs.exact.algebraic.dead_time_margins import Distances
    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.transfer_function_text import WrittenTransferFunction

#: Where a controller stands in a file.
_WHERE = "specification.controller"


class DelayedLoopResult:
    """What the tasks about a loop with a dead time share: P and N, and what is told of them."""

    if TYPE_CHECKING:
        plant: StateSpace
        answer: Mapping[str, Any]
        written: Any
    gain = ""

    def claims_of_loop(self) -> Iterator[Claim]:
        """Yield what P and N are."""
        m, answer = self.plant.matrices, self.answer
        values: dict[str, Any] = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "F": self.written.value}
        values |= {"f": monic(self.written)[1], "chi_o": answer["P"], "q": answer["N"]}
        e = Environment(variable=self.plant.variable, values=values)
        k = Scalar.symbol(self.gain) if self.gain else Scalar.of(1)
        yield holds(e, "chi_o = {whole} f", whole=e["A"].pencil.apply("det"))
        yield holds(e, "{k} q I = chi_o F (C pencil(A)^-1 B + D)", k=k)

    @property
    def delay(self) -> Scalar:
        """The dead time T."""
        assert self.plant.delay is not None  # noqa: S101 - there is no such result without it
        return self.plant.delay

    @property
    def distances(self) -> Distances:
        """The loop N/P e^{−sT}."""
        return loop_with(self.answer["P"], self.answer["N"], self.delay)

    @property
    def function(self) -> str:
        """The characteristic function as SymPy writes it."""
        k = f"{self.gain}*" if self.gain else ""
        return f"{self.answer['P']} + {k}({self.answer['N']})*exp(-({self.delay})*{self.plant.variable})"

    @property
    def sign(self) -> str:
        """The declared sign of k."""
        return self.plant.symbols.signs.get(self.gain, "real")

    def told(self, kind: str) -> list[dict[str, str]]:
        """Return what sentences of a kind tell."""
        return told_of_dead_time(kind, self.answer["P"], self.answer["N"], self.delay, self.sign)


def delayed_loop(
    plant: StateSpace, controller: object, gain: str | None
) -> tuple[StateSpace, WrittenTransferFunction, dict[str, Scalar]]:
    """Return the plant with the names of the controller, the controller, and P and N; `gain` is the name of k, if there is one.

    Raises `InputError` where the loop is not strictly proper, where it has other symbols, and where k is no factor of it.
    """
    plant = plant.knowing(controller)
    plant.require("B", "C", task="the controller")
    written = read_transfer_function(controller, plant.symbols, plant.variable, _WHERE)
    opened, moved = loop_polynomials(plant, written)
    if gain is not None:
        rest = moved / Scalar.symbol(gain)
        if gain in opened.names or gain in rest.names:
            message = f"{gain} is no factor of the loop, and with a dead time the gains of one factor are found"
            repair = f'write the controller as {gain} times a function without it: "{gain}*(1 + 1/s)"'
            raise InputError(message, where=_WHERE, repair=repair)
        moved = rest
    assert plant.delay is not None  # noqa: S101 - the caller has looked
    names = sorted((opened.names | moved.names | plant.delay.names) - {plant.variable})
    if names:
        message = f"the loop has a dead time and the symbol {names[0]}"
        raise InputError(message, where=f"symbols.{names[0]}", repair="write its value in its place")
    if moved.is_zero or opened.degree(plant.variable) <= moved.degree(plant.variable):
        what = "is 0" if moved.is_zero else "is not strictly proper: infinitely many poles lie near a vertical line"
        raise InputError(f"the loop with a dead time {what}", where=_WHERE, repair="give a controller with a pole more")
    return plant, written, {"P": opened, "N": moved}


class _Region:
    """The task, which is not that of loops with a dead time alone."""

    task: ClassVar[str] = "stability_region"


@dataclass
class DelayedRegion(DelayedLoopResult, _Region, Result):
    """The gains k for which all roots of P + k N e^{−sT} have negative real part."""

    written: WrittenTransferFunction
    gain: str

    answered_by = ("stable_if",)

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what P and N are, and that the intervals are those with stable roots."""
        yield from self.claims_of_loop()
        how = "crossings isolated by enclosures, every interval by the argument principle at a point of it"
        yield Statement(f"stable exactly where {self.stable_if[0]}", lambda: how if self._is_region else "")

    @property
    def _is_region(self) -> bool:
        """Whether no root is unstable at the points of the intervals, and some is between them, found anew."""
        loop = DelayedLoop(self.answer["P"], self.answer["N"], self.delay.fraction())
        anew = loop.intervals(self.sign)
        return [tuple(map(exact_value, part[:2])) for part in anew] == [
            tuple(map(exact_value, p[:2])) for p in self.intervals
        ]

    @property
    def question(self) -> Parameters:
        """What is asked for."""
        return Parameters((self.gain,))

    @property
    def verdict(self) -> str:
        """`no` where no gain is stable."""
        return "conditional" if self.intervals else "no"

    @cached_property
    def intervals(self) -> list[tuple[Edge, Edge, Fraction]]:
        """The open intervals with a point of each; all of them are bounded."""
        return self.distances.loop.intervals(self.sign)

    @property
    def stable_if(self) -> list[str]:
        """Bounds of k: of a single interval its ends, exactly or rounded to twelve digits after the point."""
        parts = [self._ends(low, high) for low, high, _ in self.intervals]
        if len(parts) > 1:
            return [" or ".join(f"({' and '.join(part)})" for part in parts)]
        return parts[0] if parts else ["False"]

    def _ends(self, low: Edge, high: Edge) -> list[str]:
        found = [f"{self.gain} > {exact_value(low)}", f"{self.gain} < {exact_value(high)}"]
        implied = {"positive": 0, "negative": 1}.get(self.sign)
        return [text for side, text in enumerate(found) if side != implied or (low, high)[side] != 0]

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The gains with stability, and where roots cross the imaginary axis."""
        found, crossings = self.intervals, crossings_of_sign(self.distances.loop, self.sign)
        return {
            "characteristic_function": self.function,
            "parameters": [self.gain],
            "stable_if": self.stable_if,
            "empty": not found,
            "bounded": True,
            "intervals": [[str(exact_value(low)), str(exact_value(high))] for low, high, _ in found],
            "intervals_decimal": [[digits_of(low), digits_of(high)] for low, high, _ in found],
            "excluded_points": [],
            "sample_points": [{self.gain: str(sample)} for *_, sample in found],
            "crossings": [{name: place[name] for name in ("k", "omega")} for place in map(landmarks_of, crossings)],
        }


def delayed_region(
    plant: StateSpace, controller: object, parameters: object, others: Mapping[str, object]
) -> DelayedRegion:
    """Return the region of one gain; raises `InputError` for gains K and L, margins, and more parameters than one."""
    for name, value in others.items():
        if value is not None:
            message = f"{name} is given, and the plant has a dead time"
            raise InputError(message, where=f"specification.{name}", repair="leave it out, or give pade = 2")
    known = plant.knowing(controller)
    written = read_transfer_function(controller, known.symbols, known.variable, _WHERE)
    free = sorted((written.value.names | known.matrices.symbols) - {known.variable})
    names = free if parameters is None else read_names(parameters, "parameters")
    if len(names) != 1:
        message = f"the region of {len(names)} parameters is asked for, and the plant has a dead time"
        repair = 'ask for one gain: controller = "k", parameters = ["k"]; or give pade = 2'
        raise InputError(message, where="specification.parameters", repair=repair)
    moved, written, loop = delayed_loop(plant, controller, names[0])
    return DelayedRegion(moved, "crossings", loop, written, names[0])


# -- the page --------------------------------------------------------------------------------------------------------------


@page_of(DelayedRegion)
def write_delayed_region(page: Builder, result: DelayedRegion) -> None:
    """Write the whole page."""
    given(page)
    with page.section("stability_region"):
        write_delayed_loop(page, result)
        page.remark("dead_time_moves")
        tell(page, result, "crossing")
        tell(page, result, "bound")
        if not result.intervals:
            page.remark("dead_time_never", gain=SymbolList((result.gain,)))
        else:
            _region(page)
        _picture(page, result)


def _region(page: Builder) -> None:
    """Write the intervals, of a single one its ends."""
    chi, parts = page["chi_cl"], delayed_intervals(page["chi_cl"].scalar, page.environment)
    ends = [part.members[place] for (part,) in parts for place in (0, 2)]
    say = sentence("dead_time_rounded" if any(isinstance(end, Decimals) for end in ends) else "region_is", {})
    if len(parts) == 1:
        page.steps.append(Inequalities(HoldsExactlyWhere(predicate("stable", chi), parts[0]), say, answer=True))
    else:
        page.steps.append(RegionSummary(chi.formula, (), (), parts, say))


def _picture(page: Builder, result: DelayedRegion) -> None:
    """Draw the Nyquist picture of the loop for k = 1."""
    loop, gain = result.answer["N"] / result.answer["P"], SymbolList((result.gain,))
    crossed = [float(told["value"]) for told in result.told("axis")]
    picture = nyquist_picture(loop.numerator, loop.denominator, page.plant.variable, crossed, result.delay.fraction())
    page.plot(picture, page("q / chi_o"), say="dead_time_response", gain=gain)


def write_delayed_loop(page: Builder, result: DelayedLoopResult) -> None:
    """Write P, N and the function whose roots are the poles of the closed loop."""
    below = monic(result.written)[1]
    page.define("F", factored_form(page, result.written.value), say="margins_controller", closing=False)
    opened = page["det(pencil(A))"]
    opened = opened if below.is_one else opened @ page.value(below)
    page.define("chi_o", opened, page.value(result.answer["P"]), say="margins_cut_input", closing=False)
    response = page["C pencil(A)^-1 B"]
    response = response + page["D"] if page.plant.matrices.has_feedthrough else response
    loop = page("chi_o F {response}", response=response)
    k = page.value(Scalar.symbol(result.gain)) if result.gain else None
    page.define(
        "q", loop if k is None else loop / k, page.value(result.answer["N"]), say="dead_time_numerator", closing=False
    )
    lag = function("exp", -result.delay * Scalar.symbol(page.plant.variable))
    lagging = page["q"] * page.value(lag)
    closed = page["chi_o"] + (lagging if k is None else k * lagging)
    page.define("chi_cl", closed, page.value(closed.scalar), say="dead_time_closed", closing=False)
    page.remark("dead_time_poles")


def tell(page: Builder, result: DelayedLoopResult, kind: str) -> None:
    """Write each sentence of a kind, its numbers rounded."""
    gain = {"gain": SymbolList((result.gain,))} if result.gain else {}
    for told in result.told(kind):
        page.remark(f"dead_time_{kind}", **rounded(page, told), **gain)


def rounded(page: Builder, told: Mapping[str, str]) -> dict[str, Term]:
    """Return rounded numbers as terms."""
    return {name: page.term(Decimals(Scalar.of(Fraction(text)))) for name, text in told.items()}
