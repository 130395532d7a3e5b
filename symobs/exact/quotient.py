"""What a polynomial is worth at the common zeros of equations that are finitely many: the eigenvalues of a matrix.

Modulo the ideal of the equations every polynomial is a combination of finitely many monomials b; v b = M b there, so at
every common zero, complex ones too, v is an eigenvalue of M.
"""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from flint import arb, arb_mat, ctx

from symobs.exact.ideal import Ideal, TooLarge
from symobs.exact.matrix import Matrix
from symobs.exact.scalar import Scalar
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.real import RealNumber

#: The most common zeros, counted with multiplicity, of equations that are looked at.
MOST = 60
_BITS = 512
#: The most bits of an equation: the basis of longer ones grows beyond what can be waited for.
_LONGEST = 48


@dataclass(frozen=True)
class Quotient:
    """Monomials b, the first of them 1, the matrix M with v b = M b, and what each unknown is in the monomials."""

    monomials: Matrix
    matrix: Matrix
    unknowns: tuple[Matrix, ...]


def quotient(equations: Sequence[Scalar], value: Scalar, names: Sequence[str]) -> Quotient:
    """Return the monomials and the matrix of a value; raises `TooLarge` where the common zeros are too many."""
    if max(equation.lengths()[0] for equation in equations) > _LONGEST:
        message = "the equations have too many digits"
        raise TooLarge(message)
    ideal = Ideal.of(equations)
    exponents = _standard([next(iter(p.terms()))[0] for p in ideal.basis], len(ideal.field.names))
    monomials = [prod(map(_power, ideal.field.names, powers), start=Scalar.of(1)) for powers in exponents]
    rows = [_row(ideal, exponents, value * monomial) for monomial in monomials]
    unknowns = tuple(Matrix.of([_row(ideal, exponents, Scalar.symbol(name))]) for name in names)
    return Quotient(Matrix.column(monomials), Matrix.of(rows), unknowns)


def _power(name: str, exponent: int) -> Scalar:
    return Scalar.symbol(name) ** exponent


def _standard(leading: Sequence[tuple[int, ...]], count: int) -> list[tuple[int, ...]]:
    """Return the exponents of the monomials that no leading monomial divides."""
    found = [(0,) * count]
    seen = set(found)
    for powers in found:  # grows while it is walked through
        for place in range(count):
            raised = (*powers[:place], powers[place] + 1, *powers[place + 1 :])
            if raised in seen or any(all(a <= b for a, b in zip(low, raised, strict=True)) for low in leading):
                continue
            seen.add(raised)
            found.append(raised)
            if len(found) > MOST:
                message = "the equations have too many common zeros"
                raise TooLarge(message)
    return found


def _row(ideal: Ideal, exponents: Sequence[tuple[int, ...]], value: Scalar) -> list[Scalar]:
    """Return the coefficients of a polynomial in the monomials."""
    reduced, one = ideal.reduced_column([value, Scalar.of(1)])
    places = {powers: place for place, powers in enumerate(exponents)}
    row = [Scalar.of(0)] * len(exponents)
    for coefficient, powers in reduced.terms():
        raised = dict(powers)
        row[places[tuple(raised.get(name, 0) for name in ideal.field.names)]] = Scalar.of(coefficient) / one
    return [Scalar.of(entry.fraction()) for entry in row]


def near_zero(found: Quotient, root: RealNumber) -> list[float] | None:
    """Return the unknowns nearly at the common zero where the value is a simple eigenvalue; None where it is none."""
    before, ctx.prec = ctx.prec, _BITS
    try:
        size, value = found.matrix.shape[0], root.ball(_BITS)
        table = [
            [_arb(entry) - (value if i == j else 0) for j, entry in enumerate(row)]
            for i, row in enumerate(found.matrix.rows)
        ]
        right = arb_mat([[-row[0]] for row in table])
        transposed = arb_mat([[row[j].mid() for j in range(1, size)] for row in table])
        solved = (transposed.transpose() * transposed).solve(transposed.transpose() * right)
        monomials = [arb(1), *(solved[i, 0] for i in range(size - 1))]
        return [
            float(sum((_arb(c) * m for c, m in zip(way.entries, monomials, strict=True)), arb(0)).mid())
            for way in found.unknowns
        ]
    except ZeroDivisionError:
        return None
    finally:
        ctx.prec = before


def _arb(value: Scalar) -> arb:
    number = value.fraction()
    return arb(number.numerator) / number.denominator
