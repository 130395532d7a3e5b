"""The stabilising solution of Riccati's equation in numbers: the sign of the Hamiltonian matrix, then Newton's method.

What is found is an `Enclosure`, which `riccati_check` proves; the precision is doubled until it does.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

from flint import arb, arb_mat

from symobs.exact.core.matrix import Matrix
from symobs.exact.core.ring import Precision
from symobs.exact.floating.riccati_check import (
    Regulator,
    balls,
    correction,
    gain,
    is_proved,
    number,
    solution_near,
)

#: Bits that are tried in turn, and the significant digits that are written.
_BITS, _DIGITS = (128, 256, 512, 1024), 15
#: An enclosure has this share of the bits of the work for its digits.
_BITS_A_DIGIT = 8
#: The sign converges quadratically, from a scaled matrix in about ten steps; near the boundary it takes more.
_STEPS = 60


class Uncertain(ArithmeticError):
    """An enclosure is too wide for one digit."""


class Enclosure(NamedTuple):
    """A rational matrix, how far the solution is from it at most in each entry, and the digits of P and of the gain."""

    centre: Matrix
    radius: Fraction
    P: tuple[tuple[str, ...], ...]
    K: tuple[tuple[str, ...], ...]
    bits: int

    def is_proved(self, regulator: Regulator) -> bool:
        """Return whether every digit is certain, to half a unit of the last place."""
        P, K = ([[(Fraction(text), _half_unit(text)) for text in row] for row in table] for table in (self.P, self.K))
        return is_proved(regulator, self.centre, self.radius, P, K, self.bits)


def _half_unit(text: str) -> Fraction:
    return Fraction(1, 2 * 10 ** len(text.partition(".")[2]))


def enclosed_solution(regulator: Regulator, digits: int = _DIGITS) -> Enclosure | None:
    """Return so many digits of P and K that can be proved; None where no precision that is tried suffices."""
    for bits in (tried + _BITS_A_DIGIT * (digits - _DIGITS) for tried in _BITS):
        with Precision(bits):
            try:
                found = _found(regulator, bits, digits)
            except (Uncertain, ZeroDivisionError):
                continue
        if found is not None:
            return found
    return None


def digits_after_measurement(found: Enclosure, C: Matrix, V: Matrix, digits: int = _DIGITS) -> tuple[Any, Any] | None:
    """Return the digits of P Cᵀ(C P Cᵀ + V)⁻¹ and of P − P Cᵀ(C P Cᵀ + V)⁻¹ C P; None where they are not certain."""
    with Precision(found.bits):
        middle, radius = balls(found.centre), arb(0, number(found.radius).upper())
        size = middle.nrows()
        P = arb_mat([[middle[i, j] + radius for j in range(size)] for i in range(size)])
        c, v = balls(C), balls(V)
        try:
            gain_after = (c * P * c.transpose() + v).solve(c * P).transpose()
            return _written(gain_after, digits), _written(P - gain_after * c * P, digits)
        except (Uncertain, ZeroDivisionError):
            return None


def _found(regulator: Regulator, bits: int, digits: int) -> Enclosure | None:
    X = _symmetric(_start(regulator, bits))
    nothing = arb_mat(X.nrows(), X.nrows())
    size = float(_largest(X)) or 1.0
    for _ in range(_STEPS):
        step = correction(regulator, X, nothing)
        X = _symmetric(X + step)
        if _largest(step) < arb(2) ** (-bits // 2) * size:
            break
    error = _largest(correction(regulator, X, nothing)).upper()
    radius = max(error * 4, arb(2) ** (-3 * bits // 5) * size, key=float).mid()
    P = solution_near(regulator, X, radius)
    if P is None:
        return None
    return Enclosure(
        Matrix.of([[_rational(X[i, j]) for j in range(X.ncols())] for i in range(X.nrows())]),
        _rational(radius),
        _written(P, digits),
        _written(gain(regulator, P), digits),
        bits,
    )


def hamiltonian(regulator: Regulator) -> Matrix:
    """Return [A −S; −Q −Aᵀ]; in discrete time (M + L)⁻¹(M − L), M = [A 0; −Q I], L = [I S; 0 Aᵀ], in w = (z − 1)/(z + 1)."""
    A, S, Q = regulator.uncrossed
    if not regulator.discrete:
        return Matrix.block([[A, -S], [-Q, -A.T]])
    zero, one = Matrix.zeros(*A.shape), Matrix.identity(A.shape[0])
    M, L = Matrix.block([[A, zero], [-Q, one]]), Matrix.block([[one, S], [zero, A.T]])
    return (M + L).solve(M - L).normal()


def _start(regulator: Regulator, bits: int) -> arb_mat:
    """Return an approximate solution: [I; P] spans the stable subspace, on which the sign of the matrix is −1."""
    n, Z = regulator.A.shape[0], balls(hamiltonian(regulator)).mid()
    for _ in range(_STEPS):
        inverse = Z.inv().mid()
        scale = arb(abs(Z.det()).mid()) ** (arb(-1) / (2 * n))
        moved = ((Z * scale.mid() + inverse * (1 / scale).mid()) * arb(0.5)).mid()
        change, Z = _largest(moved - Z), moved
        if change < arb(2) ** (-bits // 2) * _largest(Z):
            break
    sign = Z + balls(Matrix.identity(2 * n))
    right = arb_mat([[-sign[i, j] for j in range(n)] for i in range(2 * n)])
    left = arb_mat([[sign[i, n + j] for j in range(n)] for i in range(2 * n)])
    normal = left.transpose()
    return (normal * left).mid().solve((normal * right).mid()).mid()


def _symmetric(matrix: arb_mat) -> arb_mat:
    n = matrix.nrows()
    return arb_mat([[matrix[min(i, j), max(i, j)].mid() for j in range(n)] for i in range(n)])


def _largest(matrix: arb_mat) -> arb:
    return max((abs(matrix[i, j]).upper() for i in range(matrix.nrows()) for j in range(matrix.ncols())), key=float)


def _rational(value: arb) -> Fraction:
    found = value.mid().fmpq()
    return Fraction(int(found.p), int(found.q))


def _written(value: arb_mat, digits: int) -> tuple[tuple[str, ...], ...]:
    """Return the entries in decimals, with as many digits as are certain, and no more than these."""
    entries = [value[i, j] for i in range(value.nrows()) for j in range(value.ncols())]
    largest = max((float(abs(entry).upper()) for entry in entries if not entry.contains(0)), default=1.0)
    rows = ([value[i, j] for j in range(value.ncols())] for i in range(value.nrows()))
    return tuple(tuple(_decimal(entry, largest, digits) for entry in row) for row in rows)


def _decimal(value: arb, largest: float, most: int) -> str:
    size = Fraction(float(abs(value).upper()) if not value.contains(0) else largest)
    places = most
    while size < 1:
        size, places = size * 10, places + 1
    while size >= 10:
        size, places = size / 10, places - 1
    for count in range(max(places - 1, 0), -1, -1):
        units = round(_rational(value) * 10**count)
        if abs(value - number(Fraction(units, 10**count))) <= number(Fraction(1, 2 * 10**count)):
            digits = str(abs(units)).rjust(count + 1, "0")
            text = f"{digits[:-count]}.{digits[-count:]}" if count else digits
            return f"-{text}" if units < 0 else text
    raise Uncertain
