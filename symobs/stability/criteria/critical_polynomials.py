"""Critical polynomials: where roots of a polynomial with parameters can cross the stability boundary.

Let a₀ wⁿ + … + aₙ have its roots in Re w < 0 exactly where the given polynomial is stable.  As the parameters move, a root
crosses the imaginary axis only where aₙ = 0 or the Hurwitz determinant Δₙ₋₁ = 0, since aₙ = ± a₀ ∏ rᵢ and
Δₙ₋₁ = ± a₀ⁿ⁻¹ ∏ (rᵢ + rⱼ) (Orlando 1911), and one comes from infinity only where a₀ = 0.  Off the set where their product
vanishes stability is constant on connected pieces, and on it nothing is stable.
"""

from __future__ import annotations

from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.root_location import all_to_the_left, sign_at, value_at
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import bilinear, hurwitz_matrix, lienard_chipart

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from fractions import Fraction


@dataclass
class StabilityBoundary:
    """The stability boundary: Re s < −margin, or in discrete time |z| < radius."""

    variable: str
    discrete: bool = False
    margin: Scalar = Scalar.of(0)
    radius: Scalar = Scalar.of(1)

    @property
    def is_usual(self) -> bool:
        """Whether this is the imaginary axis, or the unit circle."""
        return self.margin.is_zero and self.radius.is_one

    @property
    def names(self) -> frozenset[str]:
        """The names in margin and radius."""
        return self.margin.names | self.radius.names

    def substitute(self, values: Mapping[str, Scalar]) -> StabilityBoundary:
        """Return the boundary with symbols substituted."""
        return replace(self, margin=self.margin.substitute(values), radius=self.radius.substitute(values))

    def moved(self, polynomial: Scalar) -> Scalar:
        """Return χ(s − margin), or χ(radius z), which is stable in the usual sense where χ is in this one."""
        if self.is_usual:
            return polynomial
        variable = Scalar.symbol(self.variable)
        return polynomial.substitute(
            {self.variable: variable * self.radius if self.discrete else variable - self.margin}
        )


@dataclass
class CriticalPolynomials:
    """The polynomial a₀ wⁿ + … + aₙ without denominators, and its critical polynomials.

    asked   the names of a region, whose signs bound it also where they do not stand in the polynomial
    """

    polynomial: Scalar
    boundary: StabilityBoundary
    signs: Mapping[str, str] = field(default_factory=dict, hash=False)
    asked: tuple[str, ...] = ()

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """The names in the coefficients."""
        return tuple(sorted(self.polynomial.names - {self.boundary.variable}))

    @cached_property
    def denominator(self) -> Scalar:
        """The denominator of the polynomial, which is undefined where it vanishes."""
        return self.polynomial.denominator

    @cached_property
    def written(self) -> tuple[Scalar, ...]:
        """The first coefficients of the Routh array: of the shifted polynomial, in discrete time without denominators."""
        found = self.boundary.moved(self.polynomial).coefficients(self.boundary.variable)
        return tuple(c * self.scale for c in bilinear(found)) if self.boundary.discrete else found

    @cached_property
    def headed(self) -> tuple[Scalar, ...]:
        """The coefficients from the first nonzero one on: in discrete time a fixed root z = 1 lowers the degree."""
        first = next(k for k, coefficient in enumerate(self.written) if not coefficient.is_zero)
        return self.written[first:]

    @cached_property
    def scale(self) -> Scalar:
        """The factor that clears the denominators of the shifted polynomial."""
        return self.boundary.moved(self.polynomial).denominator

    @cached_property
    def coefficients(self) -> tuple[Scalar, ...]:
        """a₀ … aₙ without denominators."""
        return self.written if self.boundary.discrete else tuple(c * self.scale for c in self.written)

    @property
    def order(self) -> int:
        """The degree n."""
        return len(self.coefficients) - 1

    @cached_property
    def values(self) -> tuple[Scalar, ...]:
        """The distinct ones of a₀, aₙ and Δₙ₋₁."""
        hurwitz = hurwitz_matrix(self.coefficients)
        last = max(self.order - 1, 0)
        found = [self.coefficients[0], self.coefficients[-1]]
        if last:
            found.append(hurwitz.select(range(last), range(last)).determinant())
        return tuple(dict.fromkeys(found))

    @property
    def never(self) -> bool:
        """Whether one of them vanishes identically, so that a root always lies on the boundary or beyond."""
        return any(value.is_zero for value in self.values)

    @cached_property
    def proper(self) -> tuple[Scalar, ...]:
        """The distinct irreducible factors of the critical polynomials and of the denominator."""
        return irreducible([*self.values, self.denominator])

    @cached_property
    def factors(self) -> tuple[Scalar, ...]:
        """The proper factors, and the parameters of declared sign."""
        names = sorted({*self.parameters, *self.asked})
        signed = [Scalar.symbol(name) for name in names if self.signs.get(name, "real") != "real"]
        return tuple(dict.fromkeys([*self.proper, *signed]))

    def allows(self, point: Mapping[str, Fraction]) -> bool:
        """Return whether the declared signs allow a rational point off the critical set."""
        up, down = {"positive", "nonnegative"}, {"negative", "nonpositive"}
        return all(
            value < 0 if self.signs.get(name) in down else value > 0
            for name, value in point.items()
            if self.signs.get(name) in up | down
        )

    def is_stable(self, point: Mapping[str, Fraction]) -> bool:
        """Return whether the polynomial is stable at a rational point, by the Routh array; False where it is undefined."""
        return sign_at(self.denominator, point) != 0 and all_to_the_left(self.at(point))

    @cached_property
    def conditions(self) -> tuple[Scalar, ...]:
        """The polynomials that are positive if and only if χ is stable (Liénard and Chipart 1914), for either sign of a₀."""
        a = self.coefficients
        found = [*lienard_chipart([a[0] * c for c in a]), *lienard_chipart([a[0] * c for c in a], others=True)]
        return tuple(dict.fromkeys(found))

    def at(self, point: Mapping[str, Fraction]) -> tuple[Fraction, ...]:
        """Return the coefficients at a point; a cell is found, and then checked, at the same one."""
        key = tuple(point.items())
        if key not in self._known:
            self._known[key] = tuple(value_at(c, point) for c in self.coefficients)
        return self._known[key]

    @cached_property
    def _known(self) -> dict[tuple[tuple[str, Fraction], ...], tuple[Fraction, ...]]:
        return {}


def irreducible(values: Iterable[Scalar]) -> tuple[Scalar, ...]:
    """Return the distinct nonconstant irreducible factors."""
    found = {f: None for value in values if not value.is_constant for f, _ in value.numerator.factors()[1]}
    return tuple(found)
