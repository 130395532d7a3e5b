"""How far the loop of a design is from instability: ends of the gain exactly, phase, distance and peak with certain digits.

For K the loop is K(sI − A)⁻¹B, for L it is C(sI − A)⁻¹L, for a compensator F(s)G(s); P is its denominator without any
cancelling, P + N the characteristic polynomial of the closed loop, and k the gain that it is multiplied by.
"""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import INFINITE, Loop, slowest_root
from symobs.ground.errors import InputError
from symobs.tasks.analysis.stability_region.stability_region import stability_region

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    from symobs.exact import Matrix
    from symobs.tasks.result import Result

_DIGITS = 6
_SHOWN = ("gain_down", "gain_up", "phase_deg", "modulus", "peak", "slowest")
#: The polynomial of the closed loop, the matrix of what is added to the plant, and where the loop is cut.
_LOOPS = {
    "state_feedback": ("polynomial", None, "inputs"),
    "observer": ("polynomial", None, "outputs"),
    "compensator": ("closed_loop_polynomial", "compensator_matrix", "inputs"),
}


class NotRational(ValueError):
    """Raised for a loop with other than rational numbers."""


def margins_of(closed: Scalar, opened: Scalar, variable: str, dt: object) -> dict[str, Any]:
    """Return the margins of the loop with the polynomials P + N and P; the slowest root alone where it is not stable.

    Exact numbers are real numbers, certain decimals texts.  Raises `NotRational`.
    """
    discrete = variable == "z"
    above, below = ([*_numbers(polynomial, variable)] for polynomial in (closed, opened))
    slowest = slowest_root(above, discrete=discrete)
    if not slowest < RealNumber.of(int(discrete)):
        return {"slowest": slowest}
    loop = Loop.of(above, below, discrete=discrete)
    found: dict[str, Any] = {"slowest": slowest, "phase_deg": loop.phase(_DIGITS), "modulus": loop.modulus(_DIGITS)}
    found["peak"] = loop.peak(_DIGITS)
    found["gain_down"], found["gain_up"] = _gains(closed, opened, dt)
    return found


def _numbers(polynomial: Scalar, variable: str) -> Sequence[Fraction]:
    found = polynomial.coefficients(variable)
    if not all(entry.is_constant for entry in found):
        raise NotRational(str(polynomial))
    return [entry.fraction() for entry in found]


def _gains(closed: Scalar, opened: Scalar, dt: object) -> tuple[RealNumber | str, RealNumber | str]:
    """Return the ends of the interval around 1 of the gains k > 0 for which P + kN is stable."""
    if closed == opened:
        return RealNumber.of(0), INFINITE
    moved = opened + Scalar.symbol("k") * (closed - opened)
    region: Any = stability_region(moved, symbols={"k": "positive"}, dt=dt, parameters="k")
    one = RealNumber.of(1)
    for piece in region.region.intervals:
        low, high = piece.low or RealNumber.of(0), piece.high
        if low < one and (high is None or one < high):
            return low, INFINITE if high is None else high
    raise AssertionError(region.stable_if)


def margins(design: Result) -> Mapping[str, Any]:
    """Return how far the loop of a state feedback, an observer or a compensator is from instability.

    The loop is K(sI − A)⁻¹B, C(sI − A)⁻¹L, or F(s)G(s) cut at the input of the plant; it has one input and one output,
    numbers without roots, and a stable closed loop.  Returns by name: gain_down and gain_up, the ends of the interval
    around 1 of gains that keep the loop stable; phase_deg, the smallest angle in degrees, either way, that does not;
    modulus, the smallest distance from −1 on the boundary of stability; peak, the largest value of |1/(1 + loop)| there;
    slowest, the largest real part (in discrete time modulus) of the poles.  Ends and slowest are exact, oo where there is
    no end; angle, distance and peak are rounded to six certain digits after the point.  Raises `InputError` otherwise.
    Source: S. Skogestad and I. Postlethwaite, Multivariable Feedback Control, 2nd ed., ch. 2.
    """
    task = str(getattr(design, "task", type(design).__name__))
    if task not in _LOOPS or design.verdict == "no" or _is_many(design):
        message = (
            "margins are those of one loop: a state feedback, an observer or a compensator with one input or output"
        )
        raise InputError(message, where="design", repair="give a design with numbers for a plant with one")
    name, own, _ = _LOOPS[task]
    plant, fields = design.plant, design.fields
    closed, opened = _plain(fields[name]), plant.matrices.A.characteristic_polynomial(plant.variable)
    if own is not None:
        opened *= fields[own].characteristic_polynomial(plant.variable)
        _require_proper(design)
    try:
        found = margins_of(closed, opened, plant.variable, plant.dt)
    except NotRational as error:
        message = f"margins are those of loops with rational numbers, and {error} holds another"
        raise InputError(message, where="design", repair="give numbers, for example by design.at(k=4)") from None
    if len(found) == 1:
        message = "the closed loop is not stable, so it has no margins"
        raise InputError(message, where="design", repair="place the poles where they are stable")
    if None in found.values():
        message = "the digits of the margins are not certain"
        raise InputError(message, where="design", repair="give other poles")
    return {name: _public(found[name]) for name in _SHOWN}


def _plain(value: Any) -> Scalar:
    found: Scalar = value.value if isinstance(value, Factored) else value
    return found


def _is_many(design: Result) -> bool:
    return bool(getattr(design.plant, _LOOPS[design.task][2]) != 1)


def _require_proper(design: Result) -> None:
    """Raise `InputError` where the gain of the loop at infinity changes the leading coefficient of its polynomial."""
    through: Matrix | None = design.fields.get("direct_term")
    if through is not None and not through.is_zero and design.plant.matrices.has_feedthrough:
        message = "the loop has a gain at infinity: neither the plant nor the compensator is strictly proper"
        raise InputError(message, where="design", repair='take a compensator with observer = "full"')


def _public(value: Any) -> Any:
    """Return an exact number as SymPy has it, a rounded one as a decimal."""
    from symobs.exact.sympy_bridge.conversion import real_to_sympy  # noqa: PLC0415 - only who asks in Python pays
    from symobs.exact.sympy_bridge.sympy_import import sympy  # noqa: PLC0415

    if value == INFINITE:
        return sympy.oo
    return real_to_sympy(value) if isinstance(value, RealNumber) else Decimal(value)
