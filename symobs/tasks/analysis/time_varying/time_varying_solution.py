"""Closed forms for a time-varying plant: Φ, the Gramian, the unobservable subspace, the initial state."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, independent_rows, kernel, rank
from symobs.exact.core.generators import derivative, function_named, identities, substitute
from symobs.ground.dataclass import dataclass
from symobs.tasks.analysis.time_varying.time_interval import END
from symobs.tasks.analysis.time_varying.transition_matrix import (
    START,
    TIME,
    OpenIntegral,
    antiderivative_since,
    tidied,
    transition,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.system import StateSpace


@dataclass(frozen=True)
class TimeVaryingRequest:
    """The specification beside the plant: interval, measured output and input."""

    interval: tuple[Scalar, Scalar] | None = None
    output: Matrix | None = None
    input: Matrix | None = None

    @property
    def start(self) -> Scalar:
        """The initial instant; t₀ where no interval is given."""
        return self.interval[0] if self.interval else Scalar.symbol(START)

    @property
    def end(self) -> Scalar:
        """The last instant; t₁ where no interval is given."""
        return self.interval[1] if self.interval else Scalar.symbol(END)

    def substitute(self, values: Mapping[str, Scalar]) -> TimeVaryingRequest:
        """Return the same with parameters replaced."""
        interval = (self.start.substitute(values), self.end.substitute(values)) if self.interval else None
        output = None if self.output is None else substitute(self.output, values)
        return TimeVaryingRequest(interval, output, None if self.input is None else substitute(self.input, values))


def dependences(
    values: Iterable[Matrix | Scalar], asked: TimeVaryingRequest, dummy: str = ""
) -> tuple[dict[str, Scalar], tuple[Scalar, ...]]:
    """Return how the functions in values, also at the instants that are put in for t and t₀, depend on each other."""
    new = Scalar.symbol(dummy) if dummy else asked.start
    instants = dict.fromkeys((asked.start, asked.end, Scalar.symbol(START), Scalar.symbol(TIME), new))
    found = _functions(values)
    for _ in range(2 if found else 0):  # the second time for the functions in which the first ones are written
        meanings, _ = identities(found)
        found = _functions((*found, *meanings.values()))
        found = _functions(_moved(f, one, other) for f in found for one, other in product(instants, instants))
    return identities(found) if found else ({}, ())


def _functions(values: Iterable[Matrix | Scalar]) -> list[Scalar]:
    """Return the functions that occur in values."""
    names = {name for value in values for name in value.names if function_named(name)}
    return [Scalar.symbol(name) for name in sorted(names)]


def _moved(value: Scalar, one: Scalar, other: Scalar) -> Scalar:
    """Return a function at other instants, as it stands where it has a pole there."""
    try:
        return substitute(value, {TIME: one, START: other})
    except ZeroDivisionError:
        return value


def has_functions(value: Matrix | Scalar) -> bool:
    """Return whether exponentials, cosines or the like occur."""
    return any(function_named(name) for name in value.names)


def closed_form(plant: StateSpace, asked: TimeVaryingRequest, test: Mapping[str, Any]) -> dict[str, Any]:
    """Return Φ with what follows from it and the rank test, None for each that has no closed form here."""
    names = ("transition_matrix", "kernel", "gramian", "gramian_in_time", "forced", "x0", "candidate", "moment")
    answer: dict[str, Any] = dict.fromkeys(names)
    try:
        found = transition(plant.matrices.A, plant.symbols.signs)
    except OpenIntegral:
        return answer
    if found is None:
        return answer
    try:
        Phi = substitute(found.matrix, {START: asked.start})
        seen = tidied(plant.matrices.C @ Phi)
        kernel_at_start = _moving_kernel(test["hidden"], asked) if has_functions(Phi) else _constant_kernel(seen)
    except ZeroDivisionError:  # the interval begins or ends where A has a pole
        return answer | {"transition_matrix": found.matrix}
    if kernel_at_start is None:
        return answer
    answer |= {"transition_matrix": found.matrix, "kernel": kernel_at_start}
    answer["gramian_in_time"] = G = antiderivative_since(tidied(seen.T @ seen), asked.start)
    answer["gramian"] = None if G is None else tidied(substitute(G, {TIME: asked.end}))
    if asked.output is not None:
        back = substitute(found.matrix, {TIME: asked.start, START: Scalar.symbol(TIME)})
        answer |= _initial_state(plant, asked, (Phi, back, seen), answer["gramian"], test["matrix"])
    return answer


def _moving_kernel(hidden: Matrix, asked: TimeVaryingRequest) -> Matrix | None:
    """Return the hidden states at the start, None where their basis has none or is dependent there."""
    for basis in (hidden, hidden * hidden.common_denominator()):
        try:
            found = substitute(basis, {TIME: asked.start})
        except ZeroDivisionError:
            continue
        if rank(found) == hidden.shape[1]:
            return found
    return None


def _constant_kernel(seen: Matrix) -> Matrix:
    """Return a basis of the constant v with C Φ v = 0: the coefficients of all powers of t vanish."""
    numerator = seen * seen.common_denominator()
    rows: list[list[Scalar]] = []
    for row in numerator.rows:
        height = max(entry.degree(TIME) for entry in row) + 1
        table = [[*([Scalar.of(0)] * height), *entry.coefficients(TIME)][-height:] for entry in row]
        rows += [list(line) for line in zip(*table, strict=True)]
    return kernel(Matrix.of(rows, seen.shape[1]))


def _initial_state(
    plant: StateSpace,
    asked: TimeVaryingRequest,
    motion: tuple[Matrix, Matrix, Matrix],
    gramian: Matrix | None,
    stack: Matrix,
) -> dict[str, Matrix | None]:
    """Return the forced part f of the state and x₀ = W⁻¹ ∫ Φᵀ Cᵀ ξ with ξ = y − C f − D u; where y is not its output, why.

    With functions in it the quotient would not reduce: there x₀ follows from the derivatives of ξ at the start.
    """
    m, n = plant.matrices, plant.order
    Phi, back, seen = motion
    forced: Matrix | None = Matrix.zeros(n, 1)
    xi = asked.output
    assert xi is not None  # noqa: S101 - asked by the caller
    if asked.input is not None:
        driven = antiderivative_since(tidied(back @ m.B @ asked.input), asked.start)
        forced = None if driven is None else tidied(Phi @ driven)
        xi = None if forced is None else xi - m.C @ forced - m.D @ asked.input
    if xi is None or gramian is None or gramian.determinant().is_zero:
        return {"forced": forced}
    xi = tidied(xi)
    moment = antiderivative_since(tidied(seen.T @ xi), asked.start)
    if moment is None:
        return {"forced": forced}
    if has_functions(seen) or has_functions(xi):
        state = _from_derivatives(xi, stack, asked)
        explained = state is not None and tidied(seen @ state - xi).is_zero
        return {"forced": forced, "x0": state, "moment": moment} if explained else {"forced": forced}
    x0 = gramian.solve(substitute(moment, {TIME: asked.end})).normal()
    if (seen @ x0 - xi).is_zero:
        return {"forced": forced, "x0": x0}
    return {"forced": forced, "candidate": x0, "moment": moment}


def _from_derivatives(xi: Matrix, stack: Matrix, asked: TimeVaryingRequest) -> Matrix | None:
    """Return x₀ with N_k(start) x₀ = ξ⁽ᵏ⁾(start), None where the stack loses rank there."""
    rates = [xi]
    for _ in range(stack.shape[1] - 1):
        rates.append(derivative(rates[-1], TIME))
    there = {TIME: asked.start}
    try:
        O = substitute(stack, there)
        right = substitute(Matrix.block([[rate] for rate in rates]), there)
    except ZeroDivisionError:
        return None
    rows = independent_rows(O)
    if len(rows) < stack.shape[1]:
        return None
    return tidied(O.select(rows, range(stack.shape[1])).solve(right.select(rows, [0])))
