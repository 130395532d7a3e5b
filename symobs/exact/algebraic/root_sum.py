"""Sums over the roots of a square-free polynomial q: φⱼ(t) = Σ λʲ e^{λt} / q′(λ).

Every symmetric sum Σ g(λ) e^{λt} is a combination of φ₀, …, φ_{d−1} with coefficients from the field of q.  Differentiating
multiplies the summand by λ, and at t = 0 the sum is the trace of λʲ / q′(λ) in the field of a root: 0 for j < d − 1, else 1.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from flint import acb, acb_poly, ctx, fmpq, fmpq_poly

from symobs.exact.algebraic.extension import AlgebraicExtension
from symobs.exact.core.field import EIGENVALUE
from symobs.exact.core.generators import Function, derivative, function, partial, substitute, symbols_in
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

    from flint import arb

#: The name of the root in texts; `lambda` itself is a keyword where they are read.
BOUND = "lam"


@dataclass
class RootSum(Function):
    """Σ λᵖ e^{λ·argument} / q′(λ) over the roots λ of q, a polynomial in the generator of eigenvalues."""

    polynomial: Scalar
    power: int

    @staticmethod
    def of(polynomial: Scalar, power: int, time: Scalar) -> Scalar:
        """Return the sum, `power` less than the degree."""
        return RootSum("RootSum", time, polynomial, power).value

    @property
    def summand(self) -> Scalar:
        """The summand."""
        return self.numerator * function("exp", Scalar.symbol(EIGENVALUE) * self.argument) / self.slope

    @property
    def numerator(self) -> Scalar:
        """What stands over q′(λ) beside the exponential."""
        return Scalar.symbol(EIGENVALUE) ** self.power

    @property
    def is_rational(self) -> bool:
        """Whether q has rational coefficients."""
        return self.polynomial.names == {EIGENVALUE}

    @property
    def slope(self) -> Scalar:
        """The derivative q′(λ)."""
        return partial(self.polynomial, EIGENVALUE)

    @property
    def discriminant(self) -> Scalar:
        """The product of q′ over all roots, which vanishes exactly where two roots coincide."""
        return AlgebraicExtension(self.polynomial, EIGENVALUE).norm(self.slope).numerator

    @property
    def bound(self) -> str:
        """The name of the root in the text, different from every parameter."""
        taken = self.polynomial.names | self.argument.names
        return next(name for name in (BOUND + "_" * k for k in range(len(taken) + 1)) if name not in taken)

    @property
    def text(self) -> str:
        """SymPy's text; the variable is named where there are parameters."""
        root = Scalar.symbol(self.bound)
        q, below = _texts(self.polynomial, self.bound)
        named = f", {self.bound}" if len(self.polynomial.names) > 1 else ""
        above = self.numerator.substitute({EIGENVALUE: root})
        above_in_product = f"({above})" if len(above.terms()) > 1 else str(above)
        return f"RootSum({q}, Lambda({self.bound}, {above_in_product}*exp({root * self.argument})/({below})){named})"

    @property
    def symbols(self) -> frozenset[str]:
        """The time and the parameters of q."""
        return symbols_in(self.argument) | symbols_in(self.polynomial) - {EIGENVALUE}

    def enclosed(self, time: arb) -> arb:
        """Return an enclosure where q has rational coefficients, from disjoint enclosures of all its roots."""
        coefficients = tuple(c.fraction() for c in reversed(self.polynomial.coefficients(EIGENVALUE)))
        total = acb(0)
        for root, slope in roots_and_slopes(coefficients, ctx.prec):
            total = total + root**self.power * (root * time).exp() / slope
        return total.real

    def rate(self, time: str) -> Scalar:
        """Return d/dt: the summand times λ, its power reduced by q."""
        lower, speed = AlgebraicExtension(self.polynomial, EIGENVALUE).coefficients[1:], derivative(self.argument, time)
        if self.power + 1 < len(lower):
            return speed * RootSum.of(self.polynomial, self.power + 1, self.argument)
        total = Scalar.of(0)
        for power, c in enumerate(reversed(lower)):
            if not c.is_zero:
                total = total - c * RootSum.of(self.polynomial, power, self.argument)
        return total * speed

    def moved(self, values: Mapping[str, Scalar]) -> Scalar:
        """Return the sum with symbols substituted; at time 0, Σ λᵖ / q′(λ) is 1 for p = d − 1 and 0 below (Euler)."""
        argument, q = substitute(self.argument, values), substitute(self.polynomial, values)
        if q != self.polynomial:
            AlgebraicExtension(q, EIGENVALUE).inverse(partial(q, EIGENVALUE))  # raises where two roots are equal
        if not argument.is_zero:
            return replace(self, argument=argument, polynomial=q).value
        lead, *lower = q.coefficients(EIGENVALUE)
        return 1 / lead if self.power == len(lower) - 1 else Scalar.of(0)


@dataclass
class JoinedSum(RootSum):
    """Σ n(λ) e^{λ·argument} / q′(λ), a combination of several sums as it is printed; nothing is calculated with it."""

    above: Scalar

    @property
    def numerator(self) -> Scalar:
        """The polynomial n(λ)."""
        return self.above


@lru_cache(maxsize=256)
def _texts(q: Scalar, name: str) -> tuple[str, str]:
    """Return the texts of q and q′ in a name for the root."""
    root = {EIGENVALUE: Scalar.symbol(name)}
    return str(q.substitute(root)), str(partial(q, EIGENVALUE).substitute(root))


@lru_cache(maxsize=256)
def roots_and_slopes(coefficients: tuple[Fraction, ...], bits: int) -> list[tuple[acb, acb]]:
    """Return enclosures of the roots of a polynomial without multiple ones, lowest coefficient first, and of its slopes."""
    q = fmpq_poly([fmpq(c.numerator, c.denominator) for c in coefficients])
    slope = acb_poly(q.derivative())
    with Precision(bits):
        roots: Any = q.complex_roots()
        return [(root, slope(root)) for root, _ in roots]
