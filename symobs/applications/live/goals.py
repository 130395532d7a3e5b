"""Goals of a design: settling time and overshoot of its poles, its largest gain, the phase margin of its loop.

Settling and overshoot are those of every mode alone, which are lines in the plane of the poles.
"""

from __future__ import annotations

from math import exp, inf, log, pi
from typing import TYPE_CHECKING, Any

from symobs.applications.live.frequency_response import phase_margin
from symobs.applications.live.request import FieldError
from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.algebraic.loop_distances import INFINITE
from symobs.exact.time_functions.matrix_exponential import fraction_near
from symobs.system import Symbols, read_scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from fractions import Fraction

    from symobs.tasks.result import Result

#: Two values that are relatively closer are not told apart: their own errors are smaller; what was read off has three digits.
_TOLD_APART, _ROUNDED = 1e-6, 5e-3


def goals_of(
    result: Result,
    poles: Iterable[tuple[Fraction, Fraction]],
    asked: Mapping[str, str],
    responses: Mapping[str, Any] | None = None,
) -> dict[str, dict[str, Any]]:
    """Return for each goal whether it is met (None: undecided), the value there, and the line in the plane.

    Settling and overshoot are those of the outputs after a step of the reference, where these are shown; that they end at
    the reference is a goal of its own then.
    """
    after_step = responses["lines"] if responses and responses["step"] else ()
    placed, found = list(poles), dict[str, dict[str, Any]]()
    limits = {name: _positive(text, name) for name, text in asked.items()}
    if not result.plant.is_discrete and placed:
        slowest = min(-real for real, _ in placed)
        if (limit := limits.get("settling")) is not None:
            needed = log(50) / limit
            value = log(50) / slowest if slowest > 0 else inf
            found["settling"] = {"met": _within(value, float(limit)), "value": _digits(value), "re": f"{-needed:.6g}"}
        if (limit := limits.get("overshoot")) is not None:
            pairs = (100 * exp(pi * float(re / abs(im))) for re, im in placed if im)
            most = max(pairs, default=0.0) if slowest > 0 else inf
            line = {"slope": f"{pi / log(100 / limit):.6g}"} if limit < 100 else {}
            found["overshoot"] = {"met": _within(most, float(limit)), "value": _digits(most), **line}
        for name in found if after_step and slowest > 0 else ():  # where a mode grows no step response settles
            found[name] |= _after_step(name, after_step, float(limits[name]))
    if (limit := limits.get("gain")) is not None:
        entries = [entry for name in result.gains or "KL" for entry in _entries(result.fields.get(name))]
        signs = [
            sign_of_number(side) if not side.is_zero else "zero" for e in entries for side in (limit - e, limit + e)
        ]
        if entries:
            met = False if "negative" in signs else None if "real" in signs else True
            numbers = [abs(fraction_near(entry)) for entry in entries if is_number(entry)]
            found["gain"] = {"met": met, "value": _digits(float(max(numbers))) if len(numbers) == len(entries) else ""}
    if (limit := limits.get("phase")) is not None and (margin := phase_margin(result)) is not None:
        value = inf if margin == INFINITE else float(margin)
        found["phase"] = {"met": value == inf or _within(float(limit), value), "value": _digits(value)}
    told = {name: found.get(name, {"met": None, "value": ""}) for name in limits}
    if responses and responses["step"]:
        told["reference"] = {"met": responses["follows"], "value": "; ".join(responses["ends"])}
    return told


def _after_step(name: str, lines: Sequence[Mapping[str, Any]], limit: float) -> dict[str, Any]:
    """Return whether the outputs settle in time, or do not overshoot too far, and how far; None where it is not read off.

    What a response overshoots by is known where it has settled, and where its peak is on the side of its final value.
    """
    key = "settles" if name == "settling" else "overshoot"
    if not all("settles" in line and key in line for line in lines):
        return {"met": None, "value": "", "of": "step"}
    most = max(float(line[key]) for line in lines)
    return {"met": _within(most, limit, _ROUNDED), "value": _digits(most), "of": "step"}


def _positive(text: str, name: str) -> Fraction:
    value = read_scalar(text, Symbols.of({}), f"goal.{name}")
    if value.names or value.fraction() <= 0:
        raise FieldError("said_no_goal", f"goal.{name}")
    return value.fraction()


def _entries(gain: object) -> tuple[Scalar, ...]:
    return tuple(gain.entries) if isinstance(gain, Matrix) else (gain,) if isinstance(gain, Scalar) else ()


def _within(value: float, limit: float, apart: float = _TOLD_APART) -> bool | None:
    return None if abs(value - limit) <= apart * limit else value < limit


def _digits(value: float) -> str:
    return "∞" if value == inf else f"{value:.3g}" if 1e-3 <= value < 1e6 else "0" if value < 1e-3 else f"{value:.0f}"
