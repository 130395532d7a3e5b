"""A region of stability to be found: a polynomial, its parameters, and what is known of the region.

`region` is the set as relations worked out by hand (Routh, Jury, or the roots themselves); None where the set has no
description short enough for that.  It is held against the roots at thousands of points by `test_region_points`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.regions.region_algebra import (
    Polynomial,
    bilinear,
    scaled,
    shifted,
    stable_where,
)
from tests.support.regions.region_texts import polynomial

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from tests.support.regions.region_algebra import Formula


@dataclass(frozen=True)
class Problem:
    """A polynomial, its parameters, and what is known of the region: components, bounded, holes, relations."""

    name: str
    text: str
    parameters: tuple[str, ...] = ("h1", "h2")
    region: str | None = None
    components: int | None = None
    bounded: bool | None = None
    symbols: Mapping[str, str] = field(default_factory=dict)
    margin: str = "0"
    radius: str = "1"
    excluded: tuple[tuple[str, ...], ...] = ()
    window: int = 6

    @property
    def discrete(self) -> bool:
        return "z" in polynomial(self.text).names

    @property
    def variable(self) -> str:
        return "z" if self.discrete else "s"

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters and the symbols that stand beside them."""
        return *self.parameters, *self.symbols

    @property
    def empty(self) -> bool | None:
        return None if self.components is None else self.components == 0

    @property
    def keywords(self) -> dict[str, Any]:
        """What `symobs.stability_region` is called with beside the polynomial."""
        found: dict[str, Any] = {"parameters": list(self.parameters)}
        if self.symbols:
            found["symbols"] = dict(self.symbols)
        if self.discrete:
            found["dt"] = True
        if self.margin != "0":
            found["margin"] = self.margin
        if self.radius != "1":
            found["radius"] = self.radius
        return found

    def coefficients(self) -> list[Polynomial]:
        """Return the coefficients, the highest power first, moved so that Re < 0 or |z| < 1 is asked."""
        found = polynomial(self.text).coefficients(self.variable)
        return scaled(found, Fraction(self.radius)) if self.discrete else shifted(found, Fraction(self.margin))

    def stable(self, form: str = "even") -> Formula:
        """Return the region by Liénard and Chipart, or by Hurwitz."""
        found = self.coefficients()
        return stable_where(bilinear(found) if self.discrete else found, form)


def characteristic(A: Sequence[Sequence[str]], L: Sequence[str], C: Sequence[str], variable: str = "s") -> str:
    """Return det(λI − A + LC), by minors of the rows, as a text."""
    order = len(A)
    gains, output = [polynomial(text) for text in L], [polynomial(text) for text in C]
    total: dict[tuple[int, ...], Polynomial] = {(): Polynomial.of(1)}
    for i in range(order):
        row = [gains[i] * output[j] - polynomial(A[i][j]) for j in range(order)]
        row[i] = row[i] + Polynomial.symbol(variable)
        larger: dict[tuple[int, ...], Polynomial] = {}
        for columns, minor in total.items():
            for j in set(range(order)) - set(columns):
                key = tuple(sorted((*columns, j)))
                term = row[j] * minor
                odd = sum(column > j for column in columns) % 2
                larger[key] = larger.get(key, Polynomial.of(0)) + (-term if odd else term)
        total = larger
    return total[tuple(range(order))].text("*")
