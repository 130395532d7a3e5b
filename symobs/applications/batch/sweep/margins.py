"""The margins of the loop of each point of a sweep, as cells of its table."""

from __future__ import annotations

import signal
from contextlib import contextmanager, suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.sweep.program import MARGINS_STATUS, Program
from symobs.exact import Matrix, RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import nearest_double
from symobs.exact.core.generators import substitute
from symobs.ground.errors import BudgetExceeded, UsageError
from symobs.tasks.analysis.stability_region.margins import NotRational, margins_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence


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
    found = margins_of(closed, opened, plant.variable, plant.dt)
    if found["gain_up"] is None:
        return {"slowest": found["slowest"], MARGINS_STATUS: "unstable"}
    return {**found, MARGINS_STATUS: "done"}


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
    with suppress(_TimeOver, NotRational, BudgetExceeded), _within(_SECONDS):
        found = margins_at(program, point, gains)
    if not found or None in found.values():
        return {MARGINS_STATUS: "undecided"}, {}
    numbers = {name: value for name, value in found.items() if isinstance(value, RealNumber)}
    doubles = {name: nearest_double(value) for name, value in numbers.items() if not value.is_rational}
    return {name: value.text() if name in numbers else value for name, value in found.items()}, doubles


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
