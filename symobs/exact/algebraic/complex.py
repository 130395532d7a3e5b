"""Complex numbers with exact real and imaginary part, for poles and roots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from fractions import Fraction


@dataclass(frozen=True)
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
