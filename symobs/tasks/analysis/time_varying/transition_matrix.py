"""Transition matrices in closed form: Φ' = A(t) Φ, Φ(t₀, t₀) = I.

Four classes are solved.  *nilpotent*: the Peano-Baker series I + ∫A + ∫A∫A + … ends (strictly triangular A(t), A(t) that
commutes with a nilpotent integral, nilpotent constant A).  *commuting*: A(t) = Σ αᵢ(t) Mᵢ with constant matrices that
commute, where Φ = Π e^{Mᵢ ∫αᵢ}.  *direction*: A(t) = α(t) K with K constant and rational powers of what ∫α is the
logarithm of.  *triangular*: row by row, by variation of constants.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, antiderivative, exponential_of_integral, roots_of
from symobs.exact.core.generators import function_named, functions_in, substitute, symbols_in, symbols_named
from symobs.exact.time_functions.antiderivative import collected
from symobs.exact.time_functions.matrix_exponential import NoClosedForm, OpenBranch, exponential
from symobs.ground.dataclass import dataclass
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

TIME, START = "t", "t0"
#: A series or a solution whose terms grow beyond this is given up: it would be read by nobody.
TERMS_UP_TO = 2_000
#: The same with exponentials, cosines and sines, whose dependences are looked through in every check.
_WITH_FUNCTIONS_UP_TO = 300


@dataclass
class Transition:
    """Φ(t, t₀), the class that it was found in, and the terms of the series where that ended."""

    matrix: Matrix
    kind: str
    terms: tuple[Matrix, ...] = ()


class OpenIntegral(ArithmeticError):
    """The equations can be solved one after the other, but for an integral without closed form."""

    def __init__(self, integrand: Scalar) -> None:
        """Keep the integrand."""
        super().__init__(str(integrand))
        self.integrand = integrand


def transition(A: Matrix, signs: Mapping[str, str]) -> Transition | None:
    """Return Φ(t, t₀) where one of the classes holds, None otherwise; raises `OpenIntegral`."""
    return _series(A) or _commuting(A, signs) or _direction(A) or _triangular(A)


def antiderivative_since(value: Matrix, start: Scalar) -> Matrix | None:
    """Return the antiderivative in t that is 0 at `start`, None where none is found (or it is too large)."""
    found = antiderivative(value, TIME)
    if found is None or found.size > (_WITH_FUNCTIONS_UP_TO if functions_in([found]) else TERMS_UP_TO):
        return None
    try:
        return tidied(found - substitute(found, {TIME: start}))
    except ZeroDivisionError:
        return None


def tidied(value: Matrix) -> Matrix:
    """Return a matrix with its functions collected."""
    return Matrix.of([[collected(entry) for entry in row] for row in value.normal().rows], value.shape[1])


def _series(A: Matrix) -> Transition | None:
    """Sum the Peano-Baker series; n products of a nilpotent algebra of n×n matrices vanish, so it ends by then or never."""
    order = A.shape[0]
    term = total = Matrix.identity(order)
    terms: list[Matrix] = []
    for _ in range(order):
        found = antiderivative_since((A @ term).normal(), Scalar.symbol(START))
        if found is None:
            return None
        if found.is_zero:
            return Transition(total, "nilpotent", tuple(terms))
        term, total = found, (total + found).normal()
        terms.append(term)
    return None


def _order(A: Matrix) -> list[int] | None:
    """Return the states so that each depends on itself and on those before it only; None where there is a cycle."""
    waiting, ordered = list(range(A.shape[0])), list[int]()
    while waiting:
        ready = [i for i in waiting if all(A[i, j].is_zero for j in waiting if j != i)]
        if not ready:
            return None
        ordered += ready
        waiting = [i for i in waiting if i not in ready]
    return ordered


def _triangular(A: Matrix) -> Transition | None:
    """Solve state after state: φᵢⱼ = ρᵢ ∫ ρᵢ⁻¹ Σₖ aᵢₖ φₖⱼ with ρᵢ' = aᵢᵢ ρᵢ."""
    ordered = _order(A)
    if ordered is None:
        return None
    own = [exponential_of_integral(A[i, i], TIME) for i in range(A.shape[0])]
    scales = [scale for scale in own if scale is not None]
    if len(scales) < len(own):
        return None
    start = {TIME: Scalar.symbol(START)}
    entries = [[Scalar.of(0)] * len(own) for _ in own]
    for place, j in enumerate(ordered):
        entries[j][j] = scales[j] / substitute(scales[j], start)
        for i in ordered[place + 1 :]:
            driven = _sum(A[i, k] * entries[k][j] for k in ordered[place:] if k != i)
            driven = collected(driven / scales[i])
            found = antiderivative(driven, TIME)
            if found is None:
                raise OpenIntegral(collected(driven * substitute(scales[j], start)))
            if found.size > TERMS_UP_TO:
                return None
            entries[i][j] = scales[i] * (found - substitute(found, start))
    return Transition(tidied(Matrix.of(entries)), "triangular")


def _sum(values: Iterable[Scalar]) -> Scalar:
    total = Scalar.of(0)
    for value in values:
        total = total + value
    return total


def commuting_parts(A: Matrix) -> list[tuple[Scalar, Matrix]]:
    """Return (α, M) with A(t) = Σ α M, the M constant: A by its powers of t and functions, or A = α K; [] for neither."""
    below = A.common_denominator()
    if TIME not in symbols_in(below):
        parts: dict[Scalar, Matrix] = {}
        for place, entry in enumerate((A * below).entries):
            for alpha, c in in_time(entry).items():
                unit = Matrix.unit(len(A.entries), place) * (c / below)
                parts[alpha] = parts[alpha] + unit if alpha in parts else unit
        shaped = {alpha: Matrix.of(_rows(M.entries, A.shape[1])) for alpha, M in parts.items()}
        return [(alpha, M.normal()) for alpha, M in shaped.items() if not M.is_zero]
    direction = constant_direction(A)
    return [] if direction is None else [direction]


def _rows(entries: Sequence[Scalar], width: int) -> list[list[Scalar]]:
    return [list(entries[k : k + width]) for k in range(0, len(entries), width)]


def in_time(value: Scalar) -> dict[Scalar, Scalar]:
    """Return a polynomial in t and functions of t as coefficients by their monomials."""
    found: dict[Scalar, Scalar] = {}
    for number, powers in value.numerator.terms():
        alpha, c = Scalar.of(1), Scalar.of(number) / value.denominator
        for name, power in powers:
            factor = Scalar.symbol(name) ** power
            alpha, c = (alpha * factor, c) if TIME in symbols_named(name) else (alpha, c * factor)
        found[alpha] = found[alpha] + c if alpha in found else c
    return {alpha: c for alpha, c in found.items() if not c.is_zero}


def _commuting(A: Matrix, signs: Mapping[str, str]) -> Transition | None:
    """Return Π e^{M ∫α} over the commuting parts, where each has a closed form."""
    parts, total = commuting_parts(A), Matrix.identity(A.shape[0])
    if any(not (M @ N - N @ M).is_zero for (_, M), (_, N) in combinations(parts, 2)):
        return None
    for alpha, M in parts:
        since = antiderivative_since(Matrix.of([[alpha]]), Scalar.symbol(START))
        if since is None or any(map(function_named, since.names)):  # cos(sin(t)) is treated nowhere
            return None
        try:
            found = exponential(M, "s", lambda delta: sign_of(delta, signs))
        except (NoClosedForm, OpenBranch):
            return None
        total = total @ found.matrix(since[0, 0])
    return Transition(tidied(total), "commuting") if parts else None


def constant_direction(A: Matrix) -> tuple[Scalar, Matrix] | None:
    """Return (α, K) with A(t) = α(t) K and K constant, None where A is not of this form."""
    alpha = next((entry for entry in A.entries if not entry.is_zero), None)
    if alpha is None:
        return None
    K = (A * (1 / alpha)).normal()
    return None if TIME in symbols_in(K) else (alpha, K)


def _direction(A: Matrix) -> Transition | None:
    """Return Σ ρ_λ(t)/ρ_λ(t₀) E_λ with ρ_λ' = λ α ρ_λ, E_λ the projections on K's eigenspaces; K must have them all."""
    found = constant_direction(A)
    if found is None:
        return None
    alpha, K = found
    roots = roots_of(K.characteristic_polynomial("s"), "s")
    if any(not root.is_closed or not root.radicand.is_zero for root in roots):
        return None
    eigenvalues = list(dict.fromkeys(root.centre for root in roots))
    order, total = A.shape[0], Matrix.zeros(*A.shape)
    whole, start = Matrix.identity(order), {TIME: Scalar.symbol(START)}
    for own in eigenvalues:
        scale = exponential_of_integral(alpha * own, TIME)
        if scale is None:
            return None
        projection = Matrix.identity(order)
        for other in eigenvalues:
            if other != own:
                projection = (projection @ (K - whole * other)) * (1 / (own - other))
        if not (K @ projection - projection * own).is_zero:
            return None
        total = total + projection * (scale / substitute(scale, start))
    return Transition(total.normal(), "direction")
