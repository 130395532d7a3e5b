"""Margins of a loop with a dead time T: gain, phase, distance from −1, and what is counted, every digit certain."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.exact.algebraic.dead_time_margins import (
    exact_value,
    interval_around_one,
    landmarks_of,
    loop_with,
    unstable_after,
    unstable_before,
)
from symobs.exact.algebraic.loop_distances import MARGIN_DIGITS
from symobs.exact.algebraic.root_loci import LOCUS_DIGITS, frequency
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Statement
from symobs.stability.frequency_plots import bode_picture, nyquist_picture
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.stability_region.delayed_region import (
    DelayedLoopResult,
    LoopPolynomials,
    delayed_loop,
    rounded,
    tell,
    write_delayed_loop,
)
from symobs.tasks.analysis.stability_region.margins import MARGINS, NO_MARGINS, MarginNumbers
from symobs.tasks.design.margins.margins import Margins, MarginsAnswer
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace


class DelayedMarginsAnswer(MarginsAnswer, LoopPolynomials):
    """P and N, in the place of P + N and P."""


@dataclass
class DelayedMargins(DelayedLoopResult, Margins):
    """The margins of N/P e^{−sT}; none where the closed loop is not stable."""

    answer: DelayedMarginsAnswer

    @classmethod
    def of_loop(cls, plant: StateSpace, controller: object) -> Self:
        """Return the margins of the loop of a plant with a dead time and a controller; raises `InputError`."""
        plant, written, loop = delayed_loop(plant, controller, None)
        assert plant.delay is not None  # noqa: S101 - the caller has looked
        answer: DelayedMarginsAnswer = {
            **loop,
            **_margins(loop, plant.delay),
            "closed": None,
            "opened": None,
            "open": None,
        }
        return cls(plant, "boundary", answer, None, written)

    def claims(self) -> Iterator[Claim | Statement]:
        """Yield what P and N are, how many poles are unstable, and the margins."""
        yield from self.claims_of_loop()
        yield Statement(
            "the unstable poles", lambda: "the argument principle, by enclosures" if self.told("counts") else ""
        )
        found = {name: self.answer[name] for name in MARGINS}
        how = "interval arithmetic"
        yield Statement("angle, distance and peak", lambda: how if found == _margins(self.answer, self.delay) else "")

    @property
    def is_stable(self) -> bool:
        """Whether the closed loop is stable."""
        return unstable_after(self.distances.loop) == 0

    @property
    def verdict(self) -> str:
        """`no` where the closed loop is not stable."""
        return "yes" if self.is_stable else "no"

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The margins, the counts, and the crossings of the real axis up to those that decide the gain margin."""
        distances = self.distances
        loop = distances.loop
        before, after = unstable_before(loop), unstable_after(loop)
        found: dict[str, Any] = {name: self.answer[name] for name in MARGINS}
        found |= {"characteristic_function": self.function, "open_loop_polynomial": self.answer["P"]}
        found |= {"open_loop_unstable": before, "closed_loop_unstable": after}
        found["encirclements"] = None if after is None else before - after
        crossings = sorted(loop.decided[1], key=lambda crossing: crossing.low)
        places = [landmarks_of(crossing) for crossing in crossings]
        found["axis_crossings"] = [{name: place[name] for name in ("omega", "value")} for place in places]
        found["phase_crossover"] = [str(p["omega"]) for p, c in zip(places, crossings, strict=True) if c.side > 0]
        found["gain_crossover"] = [frequency(x).text("x") for x in distances.crossovers]
        found["delay_margin"] = distances.delay_margin(LOCUS_DIGITS)
        return found


def _margins(loop: LoopPolynomials, delay: Scalar) -> MarginNumbers:
    """Return the margins of N/P e^{−sT} by name, None of a loop that is not stable; the slowest pole is not sought."""
    distances = loop_with(loop["P"], loop["N"], delay)
    if unstable_after(distances.loop) != 0:
        return NO_MARGINS
    low, high = interval_around_one(distances.loop)
    return {
        "gain_down": exact_value(low),
        "gain_up": exact_value(high),
        "phase_deg": distances.phase(MARGIN_DIGITS),
        "modulus": distances.modulus(MARGIN_DIGITS),
        "peak": distances.peak(MARGIN_DIGITS),
        "slowest": None,
    }


@page_of(DelayedMargins)
def write_delayed_margins(page: Builder, result: DelayedMargins) -> None:
    """Write the whole page."""
    given(page)
    with page.section("margins"):
        write_delayed_loop(page, result)
        (counts,) = result.told("counts")
        page.remark("dead_time_counts" if "around" in counts else "dead_time_on_axis", **counts)
        tell(page, result, "axis")
        tell(page, result, "level")
        _pictures(page, result)
        if not result.is_stable:
            page.remark("dead_time_no_margins")
            return
        tell(page, result, "ends")
        (told,) = result.told("margins")
        page.remark("dead_time_margins" if "phase" in told else "dead_time_any_phase", **rounded(page, told))
        for told in result.told("delay"):
            page.remark("dead_time_delay" if told else "dead_time_any_delay", **rounded(page, told))


def _pictures(page: Builder, result: DelayedMargins) -> None:
    """Draw the Bode and the Nyquist picture."""
    N, P, subject, delay = result.answer["N"], result.answer["P"], page("q / chi_o"), result.delay.fraction()
    loop = N / P
    page.plot(bode_picture(loop.numerator, loop.denominator, page.plant.variable, delay), subject)
    crossed = [float(told["value"]) for told in result.told("axis")]
    page.plot(nyquist_picture(loop.numerator, loop.denominator, page.plant.variable, crossed, delay), subject)
