"""Closed forms for a time-varying plant: Φ, the Gramian, the unobservable subspace, the initial state."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise, product
from typing import TYPE_CHECKING, TypedDict

from symobs.exact import Matrix, Scalar, independent_rows, kernel, rank
from symobs.exact.core.generators import derivative, function_named, identities, substitute, symbols_in
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, Undecided
from symobs.system.conditions import never_zero, sign_of, vanishing_factors
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


# Intervals of time: where a plant has no pole, and an instant at which a function of t is not 0.


#: The end of the interval where none is given.
END = "t1"
_ORDERS_UP_TO = 8
_HALVINGS = 60
_NEW = "u"


def reject_sizes_and_names(plant: StateSpace) -> None:
    """Refuse names that stand for instants, and orders whose stack would not end."""
    taken = sorted({START, END} & plant.field.position.keys())
    if taken:
        message = f"{taken[0]} is the name of an instant and cannot be a parameter of the plant"
        raise InputError(message, where="plant", repair="give the parameter another name")
    if plant.order > _ORDERS_UP_TO:
        message = f"the plant has {plant.order} states, more than {_ORDERS_UP_TO}"
        raise InputError(message, where="plant.A", repair="ask for a smaller plant")


def reject_poles(plant: StateSpace, ends: tuple[Scalar, Scalar]) -> None:
    """Raise `InputError` where a denominator of the plant certainly vanishes in the interval."""
    m, signs = plant.matrices, plant.symbols.signs
    for factor in vanishing_factors([part.common_denominator() for part in (m.A, m.B, m.C, m.D)], signs):
        if TIME not in symbols_in(factor):
            continue
        if has_functions(factor) and not _is_bounded_away(factor):
            message = f"time_varying_observability is undecided: whether {factor} vanishes in the interval is not decided here"
            raise Undecided(message)
        if has_functions(factor):
            continue
        first, last = (factor.substitute({TIME: end}) for end in ends)
        opposite = sign_of(first * last, signs) in {"zero", "negative", "nonpositive"}
        numeric = factor.names == {TIME} and all(end.is_constant for end in ends)
        if opposite or (numeric and _vanishes_between(factor, *ends)):
            message = f"{factor} vanishes in the interval, and there the plant has a pole"
            raise InputError(message, where="specification.interval", repair="choose an interval without the pole")


def _is_bounded_away(factor: Scalar) -> bool:
    """Return whether the constant of a polynomial in cosines and sines is larger than its other coefficients together."""
    waves = all(f is not None and f.kind in {"cos", "sin"} for f in map(function_named, factor.names))
    parts = [(abs(Fraction(number)), bool(powers)) for number, powers in factor.numerator.terms()]
    return waves and 2 * sum(size for size, moves in parts if not moves) > sum(size for size, _ in parts)


def _vanishes_between(factor: Scalar, first: Scalar, last: Scalar, halvings: int = _HALVINGS) -> bool:
    """Return whether an irreducible polynomial in t with numbers for coefficients has a root in (first, last).

    By Descartes' rule for t = (first + last u)/(1 + u), u > 0: no change of sign, no root; one, one root; else halve.
    """
    u = Scalar.symbol(_NEW)
    moved = factor.substitute({TIME: (first + last * u) / (u + 1)}).numerator
    signs = [c.fraction() > 0 for c in moved.coefficients(_NEW) if not c.is_zero]
    changes = sum(a != b for a, b in pairwise(signs))
    if changes < 2 or not halvings:
        return changes > 0
    middle = (first + last) / 2
    if factor.substitute({TIME: middle}).is_zero:
        return True
    return any(_vanishes_between(factor, *part, halvings - 1) for part in ((first, middle), (middle, last)))


def instant_where_not_zero(plant: StateSpace, interval: tuple[Scalar, Scalar] | None, minor: Matrix) -> Scalar | None:
    """Return an instant of the interval at which a minor is certainly not 0 and no pole lies, None where none is found."""
    if not minor.shape[0]:
        return None
    value, signs = plant.simplified(minor.determinant()), plant.symbols.signs
    if interval is None:
        tried = [Scalar.of(k) for k in (0, 1, -1, 2, -2, 3)]
    else:
        start, end = interval
        tried = [end, start, *((start * (k - 1) + end) / k for k in range(2, 6))]
    for instant in tried:
        try:
            for part in (plant.matrices.A, plant.matrices.C):
                part.substitute({TIME: instant})
            there = value.substitute({TIME: instant})
            if not has_functions(there) and never_zero(there, signs):
                return instant
        except ZeroDivisionError:
            continue
    return None


@dataclass
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


class StateOfOutput(TypedDict):
    """The forced part of the state, x₀, the state whose output is another one, and ∫ Φᵀ Cᵀ ξ."""

    forced: Matrix | None
    x0: Matrix | None
    candidate: Matrix | None
    moment: Matrix | None


class ClosedForms(StateOfOutput):
    """Φ, the states that are never seen, the Gramian, also as a function of its end; None where there is no closed form."""

    transition_matrix: Matrix | None
    kernel: Matrix | None
    gramian: Matrix | None
    gramian_in_time: Matrix | None


def closed_form(plant: StateSpace, asked: TimeVaryingRequest, stack: Matrix, hidden: Matrix) -> ClosedForms:
    """Return Φ with what follows from it and the rank test, None for each that has no closed form here."""
    answer: ClosedForms = {
        "transition_matrix": None,
        "kernel": None,
        "gramian": None,
        "gramian_in_time": None,
        "forced": None,
        "x0": None,
        "candidate": None,
        "moment": None,
    }
    try:
        found = transition(plant.matrices.A, plant.symbols.signs)
    except OpenIntegral:
        return answer
    if found is None:
        return answer
    try:
        Phi = substitute(found.matrix, {START: asked.start})
        seen = tidied(plant.matrices.C @ Phi)
        kernel_at_start = _moving_kernel(hidden, asked) if has_functions(seen) else _constant_kernel(seen)
    except ZeroDivisionError:  # the interval begins or ends where A has a pole
        return {**answer, "transition_matrix": found.matrix}
    if kernel_at_start is None:
        return answer
    answer |= {"transition_matrix": found.matrix, "kernel": kernel_at_start}
    answer["gramian_in_time"] = G = antiderivative_since(tidied(seen.T @ seen), asked.start)
    answer["gramian"] = None if G is None else tidied(substitute(G, {TIME: asked.end}))
    if asked.output is not None:
        back = substitute(found.matrix, {TIME: asked.start, START: Scalar.symbol(TIME)})
        answer = {**answer, **_initial_state(plant, asked, (Phi, back, seen), answer["gramian"], stack)}
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
) -> StateOfOutput:
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
    found: StateOfOutput = {"forced": forced, "x0": None, "candidate": None, "moment": None}
    if xi is None or gramian is None or gramian.determinant().is_zero:
        return found
    xi = tidied(xi)
    moment = antiderivative_since(tidied(seen.T @ xi), asked.start)
    if moment is None:
        return found
    if has_functions(seen) or has_functions(xi):
        state = _from_derivatives(xi, stack, asked)
        explained = state is not None and tidied(seen @ state - xi).is_zero
        return {**found, "x0": state, "moment": moment} if explained else found
    x0 = gramian.solve(substitute(moment, {TIME: asked.end})).normal()
    if (seen @ x0 - xi).is_zero:
        return {**found, "x0": x0}
    return {**found, "candidate": x0, "moment": moment}


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
