"""Plot of a region with further symbols: drawn at sample values of them, its curves labelled in general."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials
from symobs.stability.plots.region_plot import equation_of, oriented, picture_of_line, picture_of_plane
from symobs.stability.regions.interval_region import LineRegion
from symobs.stability.regions.region_for import exact_region

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.figures.plot import Picture
    from symobs.formula.tree import Relation

#: Small numbers that are tried for the symbols, so that no two curves coincide by chance.
_VALUES = ((1, 1, 1), (1, 2, 3), (2, 1, 3), (3, 1, 2))


def picture_with_symbols(
    critical: CriticalPolynomials, parameters: Sequence[str], symbols: Sequence[str]
) -> Picture | None:
    """Return the plot of a region of one or two parameters at values of the symbols, None if it is empty."""
    if not symbols or not 1 <= len(parameters) <= 2 or critical.never:
        return None
    for values in _choices(symbols, critical.signs):
        found = _drawn(critical, parameters, values)
        if found is not None:
            return found
    return None


def _choices(symbols: Sequence[str], signs: Mapping[str, str]) -> Iterator[dict[str, Scalar]]:
    down = {"negative", "nonpositive"}
    for numbers in _VALUES:
        yield {
            name: Scalar.of(numbers[k % 3] * (-1 if signs.get(name) in down else 1)) for k, name in enumerate(symbols)
        }


def _drawn(critical: CriticalPolynomials, parameters: Sequence[str], values: dict[str, Scalar]) -> Picture | None:
    """Return the plot at these values, None if the region is empty there."""
    try:
        there = CriticalPolynomials(
            critical.polynomial.substitute(values), critical.boundary.substitute(values), critical.signs
        )
    except ZeroDivisionError:
        return None
    if there.never or there.parameters != tuple(sorted(parameters)):
        return None
    drawn_for = tuple(values.items())
    region = exact_region(there, tuple(parameters))
    if region is None or region.empty:
        return None
    if isinstance(region, LineRegion):
        return replace(picture_of_line(region), drawn_for=drawn_for)
    picture = oriented(picture_of_plane(region), parameters)
    labels = {equation_of(factor): _general(factor, values, critical, parameters) for factor in there.factors}
    curves = tuple(replace(curve, equation=labels[curve.equation]) for curve in picture.curves)
    return replace(picture, curves=curves, drawn_for=drawn_for)


def _general(
    factor: Scalar, values: Mapping[str, Scalar], critical: CriticalPolynomials, parameters: Sequence[str]
) -> Relation:
    """Return the equation with symbols that specialises to this factor."""
    for polynomial in critical.proper:
        there = polynomial.substitute(values)
        if not there.is_constant and (there / factor).is_constant:
            return equation_of(polynomial, parameters)
    return equation_of(factor)
