"""Margins of a design, or the task `margins`, as Python calls both."""

from __future__ import annotations

from typing import Any

from symobs.ground.errors import InputError
from symobs.tasks.design.margins.margins import Margins, has_loop, in_digits, loop_of
from symobs.tasks.design.margins.margins import margins as margins_task
from symobs.tasks.result import Result


def margins(design: Any, **asked: Any) -> Result:
    """Return how far a loop is from instability: of a state feedback, an observer, a compensator, `lqr` or `kalman`.

    The loop is K(sI − A)⁻¹B, C(sI − A)⁻¹L, or F(s)G(s) cut at the input of the plant; it has one input and one output,
    numbers, of which irrational ones are rounded to 15 digits, and a stable closed loop.
    Returns gain_down and gain_up, the ends of the interval around 1 of gains that keep the loop stable;
    phase_deg, the smallest angle in degrees, either way, that does not;
    modulus, the smallest distance from −1 on the boundary of stability; peak, the largest value of |1/(1 + loop)| there;
    slowest, the largest real part (in discrete time modulus) of the poles.  Ends and slowest are exact, oo where there is
    no end; angle, distance and peak are rounded to six certain digits after the point.  Raises `InputError` otherwise.
    Of a plant, with poles or a controller, it is the task `margins`.
    Source: S. Skogestad and I. Postlethwaite, Multivariable Feedback Control, 2nd ed., ch. 2.
    """
    if asked or (isinstance(design, Result) and design.as_plant is not None):
        return margins_task(design, **asked)
    closed, opened = loop_of(design := in_digits(design) if has_loop(design) else design)
    found = Margins.of(design.plant, design, None, (closed, opened))
    if found.answer["open"]:
        message = f"margins are those of loops with rational numbers: {found.answer['open']}"
        raise InputError(message, where="design", repair="give numbers, for example by design.at(k=4)")
    if found.answer["modulus"] is None:
        message = "the closed loop is not stable, so it has no margins"
        raise InputError(message, where="design", repair="place the poles where they are stable")
    return found


margins.kinds = margins_task.kinds  # type: ignore[attr-defined]  # asked anew at values, as every task
