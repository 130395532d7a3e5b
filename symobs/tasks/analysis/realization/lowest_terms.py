"""Parameter values at which the order, the poles or the zeros of a transfer function change.

C adj(sI − A) B + D det(sI − A) over det(sI − A) stays true at every parameter, but what cancels in it, and how many
zeros there are, can change.  In general it is b/a: the poles are the roots of a wherever b and a have no root in common,
and the zeros do not change in number as long as the leading coefficient of b does not vanish.  Of a matrix the same is
said of its minors (Smith and McMillan): with rank 𝒪𝒞 = ν the least common denominator of degree ν stays what it is, and
above it the largest minors are the polynomial of the zeros times polynomials without a common root.
"""

from __future__ import annotations

from itertools import combinations, islice, product
from math import comb
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Matrix, Scalar, independent_rows, modulo, pole_and_zero_polynomial, resultant
from symobs.exact.linear_algebra.smith_mcmillan import minors
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.analysis.realization.coordinates import basis
from symobs.tasks.analysis.realization.coordinates import transfer_matrix as reduced

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from symobs.system import StateSpace

#: Polynomials in the parameters that must not vanish together.
System: TypeAlias = tuple[Scalar, ...]

#: The most minors of 𝒪𝒞 that are looked at: a subset of them vanishes together on more than the true locus, never less.
_MINORS = 40
#: What the numbers of a combination of minors are called; no parameter's name begins so.
_NUMBER = "_t"


def on_stratum(plant: StateSpace) -> Scalar | Matrix:
    """Return the transfer function in lowest terms where equations of the parameters hold: that of the minimal part."""
    m = plant.matrices
    S, sizes = basis(m.A, m.B, m.C, plant.ideal)
    T, first = S.inverse(), range(sizes[0])
    A, B, C = (modulo(value.normal(), plant.ideal) for value in (T @ m.A @ S, T @ m.B, m.C @ S))
    part = A.select(first, first), B.select(first, range(plant.inputs)), C.select(range(plant.outputs), first)
    P = modulo(reduced(*part, m.D, plant.variable), plant.ideal)
    return P[0, 0] if P.shape == (1, 1) else P


def order_of(P: Scalar | Matrix, variable: str) -> int:
    """Return the degree of the least common denominator of all minors: the order of a smallest realisation."""
    below = pole_and_zero_polynomial(P, variable)[0] if isinstance(P, Matrix) else P.denominator
    return max(below.degree(variable), 0)


def hankel(plant: StateSpace) -> Matrix:
    """Return 𝒪𝒞, whose rank is the order of a smallest realisation."""
    m = plant.matrices
    return (power_rows(m.A, m.C) @ power_rows(m.A.T, m.B.T).T).normal()


def decisive(P: Scalar | Matrix, plant: StateSpace) -> tuple[System, ...]:
    """Return systems of polynomials in the parameters: where none of them vanishes, poles and zeros are the generic ones."""
    if not plant.field.names:
        return ()
    found = _of_matrix(P, plant) if isinstance(P, Matrix) else _of_function(P, plant.variable)
    return tuple(dict.fromkeys(system for system in found if not any(value.is_constant for value in system)))


def _of_function(P: Scalar, variable: str) -> list[System]:
    """Return the resultant of numerator and denominator, and the leading coefficient of the numerator."""
    above, below = P.numerator, P.denominator
    if not P or below.degree(variable) < 1:
        return []
    return [(resultant(above, below, variable),), (above.coefficients(variable)[0],)]


def _of_matrix(P: Matrix, plant: StateSpace) -> list[System]:
    """Return minors of 𝒪𝒞 of its rank, the zeros' leading coefficient, and what gives the largest minors a root in common."""
    variable = plant.variable
    poles, zeros = pole_and_zero_polynomial(P, variable)
    largest = next((found for order in range(min(P.shape), 0, -1) if (found := list(minors(P, order)))), [])
    if not largest:
        return []
    rest = [(minor * poles / zeros).numerator for minor in largest]
    return [
        _minors_of(hankel(plant), order_of(P, variable)),
        _together(rest, variable),
        (zeros.numerator.coefficients(variable)[0],),
    ]


def _minors_of(matrix: Matrix, order: int) -> System:
    """Return minors of the order of the rank that are not 0; (1) of order 0.

    Where there are too many to look at all of them, they are one that elimination finds and its neighbours.
    """
    if not order:
        return (Scalar.of(1),)
    height, width = matrix.shape
    if comb(height, order) * comb(width, order) <= _MINORS * _MINORS:
        pairs: Iterable[tuple[Sequence[int], Sequence[int]]] = product(
            combinations(range(height), order), combinations(range(width), order)
        )
    else:
        rows = independent_rows(matrix)
        columns = independent_rows(matrix.select(rows, range(width)).T)
        beside = [(other, columns) for other in _exchanged(rows, height)]
        beside += [(rows, other) for other in _exchanged(columns, width)]
        pairs = [(rows, columns), *beside]
    chosen = (matrix.select(*pair).determinant() for pair in pairs)
    return tuple(islice((minor.numerator for minor in chosen if minor), _MINORS))


def _exchanged(chosen: Sequence[int], size: int) -> Iterator[tuple[int, ...]]:
    """Yield the choices with one index in place of another."""
    for place, new in product(range(len(chosen)), range(size)):
        if new not in chosen:
            yield (*chosen[:place], new, *chosen[place + 1 :])


def _together(polynomials: list[Scalar], variable: str) -> System:
    """Return polynomials that vanish together wherever some polynomials without a common factor have a common root.

    They are the coefficients of the resultant of the first and Σ tₖ pₖ of the others, in the tₖ.
    """
    first, *others = sorted(polynomials, key=lambda p: p.degree(variable))
    if first.degree(variable) < 1:
        return tuple(p for p in polynomials if p.degree(variable) < 1)
    numbers = [Scalar.symbol(f"{_NUMBER}{k}") for k in range(len(others))]
    mixed = sum((t * p for t, p in zip(numbers, others, strict=True)), Scalar.of(0))
    found = [resultant(first, mixed, variable)]
    for t in numbers:
        (name,) = t.names
        found = [c for value in found for c in value.coefficients(name) if c]
    return tuple(value.numerator for value in found)
