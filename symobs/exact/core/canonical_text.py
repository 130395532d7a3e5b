"""Canonical text of exact values in SymPy's syntax: `19*s/4 + omega**2`, `(s + 1)/(s**2 + b*s)`."""

from __future__ import annotations

from functools import lru_cache
from math import gcd
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from fractions import Fraction

    from flint import fmpz_mpoly

    from symobs.exact.core.field import Field


#: From so many terms on the kernel's own text is taken, but for its powers: it is fast, and its binding never frees it.
_LONG = 40


class RationalFunction(Protocol):
    """A reduced fraction of polynomials with integer coefficients, of which a scalar is one."""

    field: Field
    numerator_part: fmpz_mpoly
    denominator_part: fmpz_mpoly

    @property
    def numerator(self) -> RationalFunction:
        """The numerator."""

    @property
    def denominator(self) -> RationalFunction:
        """The denominator."""

    @property
    def is_constant(self) -> bool:
        """Whether no generator occurs."""

    def fraction(self) -> Fraction:
        """Return a constant as a `Fraction`."""

    def terms(self) -> list[tuple[int, tuple[tuple[str, int], ...]]]:
        """Return the numerator's terms as (integer coefficient, ((name, exponent), …)), highest first."""

    def __hash__(self) -> int:
        """Return equal numbers for equal values."""


def _monomial(coefficient: int, divisor: int, powers: tuple[tuple[str, int], ...]) -> str:
    """Return |coefficient| / divisor times the powers."""
    common = gcd(coefficient, divisor)
    top, bottom = abs(coefficient) // common, divisor // common
    factors = [name if power == 1 else f"{name}**{power}" for name, power in powers]
    if top != 1 or not factors:
        factors.insert(0, str(top))
    text = "*".join(factors)
    return text if bottom == 1 else f"{text}/{bottom}"


def _sum(value: RationalFunction, divisor: int) -> str:
    if divisor == 1 and len(value.numerator_part) > _LONG and all(map(str.isidentifier, value.field.names)):
        return str(value.numerator_part.str()).replace("^", "**")
    pieces: list[str] = []
    for coefficient, powers in value.terms():
        text = _monomial(coefficient, divisor, powers)
        if not pieces:
            pieces.append(f"-{text}" if coefficient < 0 else text)
        else:
            pieces.append(f" - {text}" if coefficient < 0 else f" + {text}")
    return "".join(pieces) or "0"


@lru_cache(maxsize=16)
def _denominator(value: RationalFunction) -> str:
    """Return the text of a denominator: the entries of a matrix share theirs."""
    return _sum(value, 1)


def scalar_text(value: RationalFunction) -> str:
    """Return the canonical text of a scalar."""
    below = value.denominator
    if below.is_constant:
        return _sum(value.numerator, int(below.fraction()))
    above = value.numerator
    top, bottom = _sum(above, 1), _denominator(below)
    if len(above.numerator_part) > 1:
        top = f"({top})"
    is_single_name = len(below.numerator_part) == 1 and "*" not in bottom
    return f"{top}/{bottom}" if is_single_name else f"{top}/({bottom})"
