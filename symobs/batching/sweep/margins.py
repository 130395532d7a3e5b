"""How far the loop of a point is from instability: ends of the gain exactly, phase and modulus with certain digits.

For K the loop is K(sI − A)⁻¹B, for L it is C(sI − A)⁻¹L, for a compensator F(s)G(s); P is its denominator without any
cancelling, P + N the characteristic polynomial of the closed loop, and k the gain that it is multiplied by.
"""

from __future__ import annotations

import signal
from contextlib import contextmanager, suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.analysis.stability_region.stability_region import stability_region
from symobs.batching.sweep.program import MARGINS_STATUS
from symobs.errors import BudgetExceeded, UsageError
from symobs.exact import Matrix, RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import INFINITE, Loop, nearest_double, slowest_root
from symobs.exact.core.generators import substitute

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.batching.sweep.program import Program

_DIGITS = 6
#: Seconds of the processor that a point is allowed.
_SECONDS = 2.0


def require_one_loop(program: Program) -> None:
    """Raise `UsageError` for a problem whose loop is no single one."""
    at, count = ("output", program.p) if program.gains == ("L",) else ("input", program.m)
    if count != 1:
        message = f"margins are those of a loop with one {at}, and there are {count}"
        raise UsageError(message, where="--columns", repair="leave the margins out, or take a plant with one")


def margins_at(program: Program, point: Sequence[Fraction], gains: Mapping[str, Matrix]) -> dict[str, Any]:
    """Return the margins of a point by column, exact numbers as real numbers, certain decimals as texts."""
    values = dict(zip(program.names, map(Scalar.of, point), strict=True))
    plant = program.problem.plant
    closed, opened = _polynomials(program, values, gains)
    slowest = slowest_root(_numbers(closed, plant.variable), discrete=plant.is_discrete)
    found: dict[str, Any] = {"slowest": slowest, MARGINS_STATUS: "done"}
    if not slowest < RealNumber.of(int(plant.is_discrete)):
        return found | {MARGINS_STATUS: "unstable"}
    loop = Loop.of(*(_numbers(p, plant.variable) for p in (closed, opened)), discrete=plant.is_discrete)
    found |= {"phase_deg": loop.phase(_DIGITS), "modulus": loop.modulus(_DIGITS)}
    found["gain_down"], found["gain_up"] = _gains(closed, opened, plant.dt)
    return found


def _polynomials(program: Program, values: Mapping[str, Scalar], gains: Mapping[str, Matrix]) -> tuple[Scalar, Scalar]:
    """Return P + N and P at a point."""
    m, s = program.problem.plant.matrices, program.variable
    there = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_input and m.has_output}
    at = {name: substitute(getattr(m, name), values) for name, is_there in there.items() if is_there}
    A = at["A"]
    moved = [A - at["B"] @ gains["K"]] if "K" in gains else []
    moved += [A - gains["L"] @ at["C"]] if "L" in gains else []
    closed, opened = Scalar.of(1), A.characteristic_polynomial(s)
    for matrix in moved:
        closed *= matrix.characteristic_polynomial(s)
    if len(moved) == 2:
        K, L = gains["K"], gains["L"]
        own = moved[0] - L @ at["C"] + L @ at["D"] @ K
        opened *= own.characteristic_polynomial(s)
    return closed, opened


def _numbers(polynomial: Scalar, variable: str) -> list[Fraction]:
    found = polynomial.coefficients(variable)
    if not all(entry.is_constant for entry in found):
        raise _NotRational(str(polynomial))
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


# -- cells ------------------------------------------------------------------------------------------------------------


def cells_at(
    program: Program, point: Sequence[Fraction], texts: Mapping[str, str]
) -> tuple[dict[str, str], dict[str, float]]:
    """Return the cells of a point, given those of its gains, and the binary numbers nearest to what is no fraction."""
    try:
        entries = {name: Fraction(text) for name, text in texts.items()}
    except ValueError:  # margins are those of loops with rational numbers
        return {MARGINS_STATUS: "undecided"}, {}
    shapes = {"K": (program.m, program.n), "L": (program.n, program.p)}
    gains = {
        gain: Matrix.of([[entries[f"{gain}[{i + 1},{j + 1}]"] for j in range(width)] for i in range(height)])
        for gain, (height, width) in shapes.items()
        if gain in program.gains
    }
    found: dict[str, Any] = {}
    with suppress(_TimeOver, _NotRational, BudgetExceeded), _within(_SECONDS):
        found = margins_at(program, point, gains)
    if not found or None in found.values():
        return {MARGINS_STATUS: "undecided"}, {}
    numbers = {name: value for name, value in found.items() if isinstance(value, RealNumber)}
    doubles = {name: nearest_double(value) for name, value in numbers.items() if not value.is_rational}
    return {name: value.text() if name in numbers else value for name, value in found.items()}, doubles


class _NotRational(ValueError):
    """Raised for a loop with other than rational numbers."""


class _TimeOver(BaseException):
    """Raised by the alarm; a BaseException so that `except Exception` cannot swallow it."""


@contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Raise `_TimeOver` when so much time of the processor is used; without a limit where the system has no such alarm."""

    def leave(_: int, __: object) -> None:
        raise _TimeOver

    try:
        before = signal.signal(signal.SIGVTALRM, leave)
    except (AttributeError, ValueError):  # Windows, or a thread: that has no limits
        yield
        return
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
