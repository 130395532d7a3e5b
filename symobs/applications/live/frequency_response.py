"""The frequency response of a loop as whole numbers over `parts`, for Bode and Nyquist, and its margins."""

from __future__ import annotations

from math import ceil, floor, log10
from typing import TYPE_CHECKING, Any

from symobs.exact import RealNumber
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, Loop, slowest_root
from symobs.exact.floating.loop_on_boundary import loop_on_boundary
from symobs.ground.errors import InputError
from symobs.tasks.analysis.stability_region.margins import NotRational, gains_of, numbers
from symobs.tasks.design.margins.margins import Margins, has_loop, loop_of

if TYPE_CHECKING:
    from fractions import Fraction

    from symobs.formula.phrases.languages import Language
    from symobs.tasks.result import Result

_PARTS, _POINTS = 1000, 160
#: The plane of Nyquist shows at least and at most so far from 0; ends of the gain have so many digits after the point.
_LEAST, _MOST, _DIGITS, _SHORT = 1.2, 2.0, 4, 9
#: Loops whose coefficients are farther from 1, to a power of their count, have no curves in floating point.
_FARTHEST = 10**30


def shows_loop(result: Result) -> bool:
    """Return whether a result is about one loop."""
    return isinstance(result, Margins) or has_loop(result)


def _coefficients(result: Result) -> tuple[list[Fraction], list[Fraction]] | None:
    """Return P + N and P of the loop N/P of a result; None where there is none, or its numbers are not rational."""
    plant = result.plant
    if not shows_loop(result) or not all(map(is_number, plant.matrices.A.entries)):
        return None
    try:
        found = result.loop if isinstance(result, Margins) else loop_of(result)
        if found is None or found[0] == found[1]:
            return None
        above, below = (list(numbers(part, plant.variable)) for part in found)
    except (InputError, NotRational):
        return None
    within = all(not x or _FARTHEST ** -len(above) < abs(x) < _FARTHEST ** len(above) for x in (*above, *below))
    return (above, below) if within else None


def phase_margin(result: Result) -> str | None:
    """Return the phase margin in degrees; None where there is none, or the closed loop is not stable."""
    found, discrete = _coefficients(result), result.plant.is_discrete
    if found is None or not slowest_root(found[0], discrete=discrete) < RealNumber.of(int(discrete)):
        return None
    return Loop.of(*found, discrete=discrete).phase(MARGIN_DIGITS)


def frequency_response(result: Result, language: Language, *, moving: bool) -> dict[str, Any] | None:
    """Return magnitude, phase and locus, and the margins in a sentence, while poles move without the ends of the gain."""
    found, plant, said = _coefficients(result), result.plant, language.phrases
    if found is None:
        return None
    drawn, phase = _curves(*found, discrete=plant.is_discrete), phase_margin(result)
    if phase is None:
        return drawn | {"says": said["said_no_margins"]}
    told = {"phase": "∞" if phase == INFINITE else f"≈ {language.decimal(phase)}°"}
    if not moving:
        ends = gains_of(*found, plant.dt)
        told |= {name: language.decimal(_end(end)) for name, end in zip(("gain_down", "gain_up"), ends, strict=True)}
    return drawn | {"says": said["said_phase_margin" if moving else "said_margins"].format(**told)}


def _end(value: RealNumber | str) -> str:
    """Return an end of the gain: itself where it is a short fraction, else rounded to certain digits."""
    if isinstance(value, str):
        return "∞"
    return str(value.fraction) if value.is_rational and len(str(value.fraction)) <= _SHORT else value.decimal(_DIGITS)


def _curves(above: list[Fraction], below: list[Fraction], *, discrete: bool) -> dict[str, Any]:
    """Return the loop on the boundary of stability in whole parts, with windows."""
    found = loop_on_boundary(above, below, _POINTS, _PARTS, discrete=discrete)
    reach = max((abs(part) for point in found.locus for part in point if part is not None), default=0) / _PARTS
    ends = [str(log10(end)) for end in found.frequencies]
    return {
        "magnitude": _picture(found.magnitude, ends, "dB", 20),
        "phase": _picture(found.phase, ends, "°", 45),
        "locus": [[None if p is None or abs(p) > 2 * _MOST * _PARTS else p for p in point] for point in found.locus],
        "reach": f"{min(max(reach, _LEAST), _MOST):.3g}",
        "parts": _PARTS,
    }


def _picture(heights: list[int | None], ends: list[str], signal: str, unit: int) -> dict[str, Any]:
    """Return one curve over the logarithm of the frequency, with a window of whole units around it."""
    known = [height for height in heights if height is not None]
    low, high = (f(g(known) / (unit * _PARTS)) * unit for f, g in ((floor, min), (ceil, max)))
    high += unit * (low == high)
    every = unit * max(1, ceil((high - low) / (7 * unit)))
    line = {"signal": signal, "component": 0, "dashed": False, "heights": heights}
    rules = [*range(-(-low // every) * every, high + 1, every)]
    return {"parts": _PARTS, "window": [ends, [str(low), str(high)]], "lines": [line], "rules": rules}
