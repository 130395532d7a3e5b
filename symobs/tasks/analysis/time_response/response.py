"""The task `response`: what is given, and the response of a plant in closed form, in time or in steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import function_named, functions_in, symbols_in
from symobs.exact.time_functions.matrix_power import PowerOf
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.system.specification import parse_in_steps, read_gain
from symobs.tasks.analysis.time_response.horizons import read_functions, read_horizon
from symobs.tasks.analysis.time_response.initial_state import MOST_SAMPLES
from symobs.tasks.analysis.time_response.matrix_exponential import require_continuous, require_no_instant
from symobs.tasks.analysis.time_response.response_in_steps import ResponseInSteps
from symobs.tasks.analysis.time_response.response_in_time import Response
from symobs.tasks.result import Result, choose, method, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace
    from symobs.system.specification import MatrixText, Name, Quantity, TimeFunctions


@method("response/superposition", source="kailath1980, ch. 2; ogata2010, ch. 9")
def superposition(plant: StateSpace, asked: Mapping[str, Any]) -> Response:
    """Add e^{At} x₀ and the motion from rest, ∫₀ᵗ e^{A(t−s)} B u(s) ds."""
    return Response.of(plant, "superposition", asked, {})


@task
def response(
    plant: StateSpace,
    *,
    initial: MatrixText = None,
    input: TimeFunctions = None,  # noqa: A002 - the specification's word
    impulse: MatrixText = None,
    at_time: Quantity = None,
    method: Name = "auto",
) -> Result:
    """Return the response x(t) = e^{At} x₀ + ∫₀ᵗ e^{A(t−s)} B u(s) ds and y = C x + D u to an initial state and an input.

    plant    n states; B where an input is given, C where the output is asked for
    initial  x₀; 0 where it is left out
    input    u(t) for t ≥ 0: sums of exponentials, sines and cosines times powers of t, one for each input, such as 1 for
             a step and t for a ramp; none where it is left out
             In discrete time an expression in k, "1 + k*(1/2)^k", or a sequence "1, 0, 2", which is 0 behind its end.
    impulse  the strength v of an impulse v δ(t), one for each input, which moves the state to x₀ + B v at t = 0
    at_time  a positive instant at which the output is asked for, or the state of a plant without C: a number or "T", a
             number of steps in discrete time
    Returns state, output, in t (in k), and with at_time the value then.  Where the sign of a discriminant decides between
    oscillation and none, and where an input is in resonance, conditions hold the branch that is shown and cases the others;
    undecided where the modes have no closed form.
    Raises `InputError` where nothing is given, for other functions of t, for a value at infinity, and where the impulse goes
    through to the output; `ShapeMismatch`.
    Source: T. Kailath, Linear Systems, ch. 2; K. Ogata, Modern Control Engineering, 5th ed., ch. 9.
    """
    plant = plant.knowing(initial, input, impulse, at_time)
    if not plant.is_discrete:
        require_continuous(plant, "response")
    if initial is None and input is None and impulse is None:
        message = "nothing moves the plant: neither an initial state nor an input is given"
        raise InputError(message, where="specification.input", repair='give input = "1" for a step, or initial')
    instant = None if at_time is None else read_horizon(plant, at_time, "at_time")
    if isinstance(instant, str):
        message = "the value at infinity is a limit"
        raise InputError(
            message, where="specification.at_time", repair="give an instant; the limit is seen in the output"
        )
    if plant.is_discrete:
        choose("response", method, "superposition")
        return response_in_steps(plant, initial, input, impulse, instant).asked(method)
    size = (plant.order, 1)
    start = Matrix.zeros(*size) if initial is None else read_gain(initial, plant, "initial", size)
    v = None
    if impulse is not None:
        plant.require("B", task="response")
        v = read_gain(impulse, plant, "impulse", (plant.inputs, 1))
        if plant.matrices.has_feedthrough and not (plant.matrices.D @ v).is_zero:
            message = "the impulse goes through D to the output, which is then no function of t"
            raise InputError(
                message, where="specification.impulse", repair="leave C and D out: the state is a function of t"
            )
    u = None
    if input is not None:
        plant.require("B", task="response")
        u, _ = read_functions(input, plant, "input", plant.inputs)
    return choose("response", method, "superposition").solve(
        plant, {"initial": start, "input": u, "impulse": v, "at_time": instant}
    )


def response_in_steps(
    plant: StateSpace, initial: object, given_input: object, impulse: object, instant: Scalar | None
) -> ResponseInSteps:
    """Return the response to an initial state and an input; raises `InputError`, `ShapeMismatch`."""
    require_no_instant(plant)
    if impulse is not None:
        message = "an impulse in discrete time is an input"
        raise InputError(message, where="specification.impulse", repair='write the sequence input = "1, 0"')
    size = (plant.order, 1)
    start = Matrix.zeros(*size) if initial is None else read_gain(initial, plant, "initial", size)
    if "k" in start.names:
        message = "the initial state does not depend on the instant k"
        raise InputError(message, where="specification.initial", repair="give the values at k = 0")
    u = None
    if given_input is not None:
        plant.require("B", task="response")
        u = _read_input(given_input, plant)
    asked = {"initial": start, "input": u, "at_time": instant}
    return ResponseInSteps.of(plant, "superposition", asked, {})


def _read_input(value: object, plant: StateSpace) -> Matrix:
    """Return the inputs as functions of k: a sequence, which is 0 behind its end, or an expression for each."""
    where = "specification.input"
    table = parse_in_steps(value, plant.symbols, where)
    if table.shape == (1, plant.inputs) or (plant.inputs == 1 and table.shape[1] == 1):
        table = table.T
    if table.shape[0] != plant.inputs or table.shape[1] > MOST_SAMPLES:
        message = f"{table.shape[0]}×{table.shape[1]} entries of the input, for {plant.inputs} inputs"
        raise ShapeMismatch(message, where=where, repair="write an expression in k, or a sequence, for each input")
    if table.shape[1] > 1:
        impulses = [PowerOf.of("KroneckerDelta", Scalar.of(at)) for at in range(table.shape[1])]
        moving = "k" in symbols_in(table)
        table = (table @ Matrix.column(impulses)).normal()
        if moving:
            raise InputError(
                "the entries of a sequence depend on k", where=where, repair="give numbers, or one expression"
            )
    _require_sums(table, where)
    return table


def _require_sums(table: Matrix, where: str) -> None:
    """Raise `InputError` for other functions of k than sums of powers of k times λᵏ."""
    for entry in table.entries:
        several = any(
            sum(power for name, power in powers if isinstance(function_named(name), PowerOf)) > 1
            for _, powers in entry.numerator.terms()
        )
        moving = [f for f in functions_in([entry]) if "k" in f.symbols and not isinstance(f, PowerOf)]
        below = any(name == "k" or isinstance(function_named(name), PowerOf) for name in entry.denominator.names)
        if (
            several
            or below
            or moving
            or any("k" in f.base.names for f in functions_in([entry]) if isinstance(f, PowerOf))
        ):
            message = f"the input {entry} is no sum of powers of k times powers of numbers to the k"
            raise InputError(message, where=where, repair='write for example "1 + k*(1/2)^k", or a sequence "1, 0, 2"')
