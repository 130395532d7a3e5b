"""Roots and factored forms of polynomials."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import isqrt
from typing import TYPE_CHECKING

from symobs.exact.core.generators import leads_with_minus, normal_form, roots_in
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping


# Complex numbers with exact real and imaginary part, for poles and roots.


@dataclass
class Complex:
    """real + imaginary·i."""

    real: Scalar
    imaginary: Scalar

    @staticmethod
    def of(value: Complex | Scalar | int | Fraction) -> Complex:
        """Return the complex number equal to a real one."""
        return value if isinstance(value, Complex) else Complex(Scalar.of(value), Scalar.of(0))

    @property
    def is_real(self) -> bool:
        """Whether the imaginary part is 0."""
        return self.imaginary.is_zero

    @property
    def names(self) -> frozenset[str]:
        """The symbols of both parts."""
        return self.real.names | self.imaginary.names

    def conjugate(self) -> Complex:
        """Return real − imaginary·i."""
        return Complex(self.real, -self.imaginary)

    def __add__(self, other: Complex) -> Complex:
        return Complex(self.real + other.real, self.imaginary + other.imaginary)

    def __neg__(self) -> Complex:
        return Complex(-self.real, -self.imaginary)

    def __sub__(self, other: Complex) -> Complex:
        return self + (-other)

    def __mul__(self, other: Complex) -> Complex:
        return Complex(
            self.real * other.real - self.imaginary * other.imaginary,
            self.real * other.imaginary + self.imaginary * other.real,
        )

    def __truediv__(self, other: Complex) -> Complex:
        square = other.real * other.real + other.imaginary * other.imaginary
        product = self * other.conjugate()
        return Complex(product.real / square, product.imaginary / square)

    def __pow__(self, exponent: int) -> Complex:
        if exponent < 0:
            return Complex.of(1) / self**-exponent
        power, base = Complex.of(1), self
        while exponent:
            if exponent % 2:
                power = power * base
            base, exponent = base * base, exponent // 2
        return power

    def __str__(self) -> str:
        if self.is_real:
            return str(self.real)
        size = self.imaginary
        negative = str(size).startswith("-")
        text = str(-size if negative else size)
        unit = imaginary_unit(self.real, self.imaginary)
        part = unit if text == "1" else f"{text}*{unit}" if _is_atom(text) else f"({text})*{unit}"
        if self.real.is_zero:
            return f"-{part}" if negative else part
        return f"{self.real} {'-' if negative else '+'} {part}"


def imaginary_unit(*beside: Scalar) -> str:
    """Return i as a text beside these values, of which one may contain a symbol I."""
    return "sqrt(-1)" if any("I" in value.names for value in beside) else "I"


def _is_atom(text: str) -> bool:
    return " " not in text


@dataclass
class Factored:
    """unit · Π factorᵏ; factors with negative multiplicity form the denominator."""

    unit: Scalar
    factors: tuple[tuple[Scalar, int], ...]

    @property
    def value(self) -> Scalar:
        """The product, multiplied out."""
        product = self.unit
        for factor, power in self.factors:
            product = product * factor**power
        return product

    @property
    def names(self) -> frozenset[str]:
        """The generators that occur."""
        return self.unit.names.union(*(factor.names for factor, _ in self.factors))

    def __str__(self) -> str:
        above = [_power_text(f, p) for f, p in self.factors if p > 0]
        below = [_power_text(f, -p) for f, p in self.factors if p < 0]
        unit = str(self.unit)
        if unit != "1" or not above:
            above.insert(0, unit if " " not in unit and "/" not in unit else f"({unit})")
        top = "*".join(above)
        if len(above) == 1 and below:
            bare = str(self.factors[0][0]) if unit == "1" and self.factors[0][1] == 1 else ""
            top = f"({bare})" if " " in bare else top
        if not below:
            return _unwrapped(above[0]) if len(above) == 1 else top
        return f"{top}/{below[0]}" if len(below) == 1 else f"{top}/({'*'.join(below)})"

    def substitute(self, values: Mapping[str, Scalar]) -> Factored:
        """Return the form with generators replaced."""
        return Factored(self.unit.substitute(values), tuple((f.substitute(values), p) for f, p in self.factors))


def _power_text(factor: Scalar, power: int) -> str:
    text = str(factor)
    text = text if text.isidentifier() else f"({text})"
    return text if power == 1 else f"{text}**{power}"


def _unwrapped(text: str) -> str:
    return text[1:-1] if text.startswith("(") and text.endswith(")") and text.count("(") == 1 else text


def factored(value: Scalar, variable: str, *, monic: bool = True) -> Factored:
    """Return the factored form of a rational function in the variable; the other factors form the unit.

    Factors are made monic; with `monic` False their coefficients are whole, without a common divisor.
    """
    unit, factors = value.factors()
    kept: list[tuple[Scalar, int]] = []
    for factor, power in factors:
        if factor.degree(variable) <= 0:
            unit = unit * factor**power
            continue
        lead = factor.coefficients(variable)[0] if monic else Scalar.of(1)
        unit = unit * lead**power
        kept.append((factor / lead, power))
    kept.sort(key=lambda item: (item[0].degree(variable), item[0].size))
    return Factored(unit, tuple(kept))


@dataclass
class Root:
    """One root of a monic irreducible factor.

    Degree 1 and 2: centre + sign·√radicand.  Beyond, `index` counts the roots of the factor as SymPy's `CRootOf` does.
    """

    factor: Scalar
    variable: str
    centre: Scalar
    radicand: Scalar
    sign: int
    index: int = -1

    @property
    def is_closed(self) -> bool:
        """Whether the root has a closed form: centre ± √radicand."""
        return self.index < 0

    @property
    def names(self) -> frozenset[str]:
        """The symbols of the factor."""
        return self.factor.names - {self.variable}

    def exact(self) -> Complex | None:
        """Return the root as a complex number with rational parts, where it is one."""
        if not self.is_closed:
            return None
        if self.radicand.is_zero:
            return Complex.of(self.centre)
        if not self.radicand.is_constant:
            return None
        square = self.radicand.fraction()
        size = rational_sqrt(abs(square))
        if size is None:
            return None
        part = Scalar.of(self.sign * size)
        return Complex(self.centre + part, Scalar.of(0)) if square > 0 else Complex(self.centre, part)

    def surd(self) -> tuple[Fraction, Fraction, bool]:
        """Return (a, r, imaginary) with √radicand = a √r (· i), r square-free; for a numeric radicand."""
        square = self.radicand.fraction()
        outside, inside = _square_part(abs(square.numerator) * square.denominator)
        return Fraction(outside, square.denominator), Fraction(inside), square < 0

    def __str__(self) -> str:
        if not self.is_closed:
            return f"CRootOf({self.factor}, {self.index})"
        known = self.exact()
        if known is not None:
            return str(known)
        if self.radicand.is_constant:
            outside, inside, imaginary = self.surd()
            text = f"sqrt({inside})" + f"*{imaginary_unit(self.centre)}" * imaginary
            if outside.numerator != 1:
                text = f"{outside.numerator}*{text}"
            if outside.denominator != 1:
                text = f"{text}/{outside.denominator}"
        else:
            text = f"sqrt({self.radicand})"
        sign = "-" if self.sign < 0 else "+"
        if self.centre.is_zero:
            return text if self.sign > 0 else f"-{text}"
        return f"{self.centre} {sign} {text}"


@dataclass
class Shifted:
    """value − root: an entry of A − λI on the diagonal, λ an algebraic number."""

    value: Scalar
    root: Root

    @property
    def names(self) -> frozenset[str]:
        """The symbols of both."""
        return self.value.names | self.root.names

    @property
    def closed(self) -> Root | None:
        """The same as one root in closed form, where it has one."""
        r = self.root
        return replace(r, centre=self.value - r.centre, sign=-r.sign) if r.is_closed else None

    def __str__(self) -> str:
        if self.closed is not None:
            return str(self.closed)
        return f"-{self.root}" if self.value.is_zero else f"{self.value} - {self.root}"


def rational_sqrt(value: Fraction) -> Fraction | None:
    """Return the square root of a nonnegative fraction where it is rational."""
    top, bottom = isqrt(value.numerator), isqrt(value.denominator)
    return Fraction(top, bottom) if top * top == value.numerator and bottom * bottom == value.denominator else None


def _square_part(number: int) -> tuple[int, int]:
    """Return (a, b) with number = a² b, small square factors taken out."""
    outside, divisor = 1, 2
    while divisor * divisor <= number and divisor < 10_000:
        while number % (divisor * divisor) == 0:
            number //= divisor * divisor
            outside *= divisor
        divisor += 1
    root = isqrt(number)
    return (outside * root, 1) if root * root == number else (outside, number)


def roots_of(polynomial: Scalar, variable: str) -> tuple[Root, ...]:
    """Return the roots of a polynomial with multiplicity, those of factors of lower degree first."""
    roots: list[Root] = []
    for factor, power in factored(polynomial, variable).factors:
        for _ in range(power):
            roots += _roots_of_factor(factor, variable)
    return tuple(roots)


def _roots_of_factor(factor: Scalar, variable: str) -> list[Root]:
    coefficients = factor.coefficients(variable)
    zero = Scalar.of(0)
    if len(coefficients) == 2:
        return [Root(factor, variable, -coefficients[1], zero, 1)]
    if len(coefficients) == 3:
        centre = -coefficients[1] / 2
        radicand = centre * centre - coefficients[2]
        return [Root(factor, variable, centre, radicand, sign) for sign in (1, -1)]
    return [Root(factor, variable, zero, zero, 1, index) for index in range(len(coefficients) - 1)]


def polynomial_of_roots(variable: str, roots: tuple[Root, ...]) -> Scalar | None:
    """Return Π (s − root), expanded; None if conjugate roots are missing."""
    s = Scalar.symbol(variable)
    waiting, product = list(roots), Scalar.of(1)
    while waiting:
        root = waiting.pop()
        if not root.is_closed:
            same = [r for r in waiting if r.factor == root.factor and r.index != root.index]
            partners = {r.index: r for r in same}
            if len(partners) + 1 != root.factor.degree(variable):
                return None
            for partner in partners.values():
                waiting.remove(partner)
            product = product * root.factor
        elif root.radicand.is_zero:
            product = product * (s - root.centre)
        else:
            partner = Root(root.factor, variable, root.centre, root.radicand, -root.sign)
            if partner not in waiting:
                return None
            waiting.remove(partner)
            product = product * ((s - root.centre) ** 2 - root.radicand)
    return product


def root_of_pole(pole: Complex, variable: str) -> Root:
    """Return a given pole as a root of its real factor."""
    s, centre, offset, turned = Scalar.symbol(variable), pole.real, pole.imaginary, -1
    if pole.is_real:
        formal = [root for root in roots_in(centre) if not root.square]
        if not formal:
            return Root(s - centre, variable, centre, Scalar.of(0), 1)
        centre, turned = centre.substitute(dict.fromkeys((root.name for root in formal), Scalar.of(0))), 1
        offset = pole.real - centre
    square = normal_form(offset**2) * turned
    return Root((s - centre) ** 2 - square, variable, centre, square, -1 if leads_with_minus(offset) else 1)
