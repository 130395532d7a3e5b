"""Check of statements about a stability region against the region of the polynomial (trusted)."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.real_algebraic import real_roots, roots_of_scalar
from symobs.exact.core.generators import function_named, stands_inside
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Conjunction, Decimals, Literal, Relation, SymbolList
from symobs.proof.derivation.steps import Sentence
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary, irreducible
from symobs.stability.criteria.stability_conditions import is_stable_where, stable_where
from symobs.stability.inequalities.simplify import box
from symobs.stability.regions.description import are_whole, between, parts, relations_of
from symobs.stability.regions.region import LineRegion, RegionInequality, exact_region, short_list
from symobs.stability.regions.region_check import are_parts, is_region

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.exact import RealNumber
    from symobs.exact.algebraic.dead_time import Edge
    from symobs.formula.tree import Environment, Formula
    from symobs.proof.derivation.steps import RegionSummary
    from symobs.stability.regions.region import PlaneRegion

#: So many zeros are listed in a sentence.
MOST_ZEROS = 5


def is_survey(step: RegionSummary, value: Scalar, environment: Environment, *, discrete: bool) -> bool:
    """Return whether the statement of a step about a region is true."""
    if stands_inside(environment.variable, value):
        return not step.findings and step.parts == delayed_intervals(value, environment)
    region = region_of(value, environment, discrete=discrete, names=step.names)
    if region is None and not step.parts:
        found = findings_of_conditions(value, environment, step.names, discrete=discrete)
        return bool(step.findings) and set(step.findings) <= set(found)
    if region is None or not is_region(region, None if region.empty else short_list(region)):
        return False
    if not set(step.findings) <= set(findings_of_region(region)):
        return False
    if not step.parts:
        return True
    if isinstance(region, LineRegion):
        return step.parts == tuple(interval_relations(region))
    return are_the_parts(region, step.parts)


def findings_of_conditions(
    polynomial: Scalar, environment: Environment, names: tuple[str, ...], *, discrete: bool
) -> tuple[Sentence, ...]:
    """Return the findings on a region given by inequalities: empty, or a product of intervals."""
    signs = environment.signs
    found = stable_where(polynomial, environment.variable, signs, discrete=discrete)
    said = found.positive
    if not is_stable_where(polynomial, environment.variable, said, signs, discrete=discrete, proof=found.equivalence):
        return ()
    if found.verdict == "no":
        return (Sentence("region_empty"),)
    limits = box(said, names, signs)
    if limits is None or limits.needs or not said:
        return ()
    return (Sentence("box_bounded" if limits.bounded else "box_unbounded"),)


def findings_of_region(region: LineRegion | PlaneRegion) -> tuple[Sentence, ...]:
    """Return the findings on a region: its origin, its number of pieces, its holes."""
    if region.empty:
        return (Sentence("region_empty"),)
    if isinstance(region, LineRegion):
        return (*_of_line(region), *_of_everything(region, (region.name,)))
    whole = tuple(_of_everything(region, region.names))
    return (*_how_plane(region), *(whole or _of_plane(region)))


def _of_everything(region: LineRegion | PlaneRegion, names: tuple[str, ...]) -> Iterator[Sentence]:
    """Yield that no value is left out, where it is so."""
    if all(sample.stable for sample in region.samples(())) and is_region(region, ()):
        yield Sentence("region_everywhere", (("names", SymbolList(names)),))


def _of_line(region: LineRegion) -> Iterator[Sentence]:
    inner = [piece.low for piece in region.pieces[1:] if piece.low is not None]
    if inner:
        pieces, intervals = len(region.pieces), len(region.intervals)
        counts = ("intervals", Counted("interval", pieces)), ("stable", Counted("on_interval", intervals, pieces))
        values = irreducible(region.critical.values)
        are_zeros = {root for factor in values for root in roots_of_scalar(factor, region.name)}.issuperset(inner)
        symbol = Literal(Scalar.symbol(region.name))
        zeros = Conjunction(tuple(Relation((symbol, Literal(x.scalar(region.name))), ("=",)) for x in inner))
        if are_zeros and len(inner) <= MOST_ZEROS:
            yield Sentence("zeros_decide" if len(inner) > 1 else "zero_decides", (("zeros", zeros), *counts))
        else:
            yield Sentence("values_decide", counts)
    for point in region.cuts:
        number = Literal(point.scalar(region.name))
        yield Sentence("point_missing", (("name", Literal(Scalar.symbol(region.name))), ("point", number)))
    yield from _numbers([end for piece in region.intervals for end in (piece.low, piece.high)], region.name)


def _how_plane(region: PlaneRegion) -> Iterator[Sentence]:
    allowed = [cell for cell in region.cells if cell.allowed]
    if len(allowed) > 1:
        stable = sum(cell.stable for cell in allowed)
        counts = {
            "plane": Counted("plane", len(region.cells) - len(allowed)),
            "cells": Counted("cell", len(allowed)),
            "stable": Counted("stable_cell", stable, len(allowed)),
        }
        key = "cells_decide_discrete" if region.critical.boundary.discrete else "cells_decide"
        yield Sentence(key, (("lines", Literal(Scalar.symbol(region.plane.names[0]))), *counts.items()))


def _of_plane(region: PlaneRegion) -> Iterator[Sentence]:
    count, bounded = len(region.components), sum(component.bounded for component in region.components)
    if count == 1:
        yield Sentence("connected_bounded" if bounded else "connected_unbounded")
    else:
        slots = {"count": Counted("piece", count), "bounded": Counted("of_them", bounded, count)}
        yield Sentence("pieces", tuple(slots.items()))
    x, y = region.names
    for hole in region.holes:
        if hole.y is not None:
            place = (("x", Literal(hole.x.scalar(x))), ("y", Literal(hole.y.scalar(y))))
            yield Sentence(
                "hole", (*place, ("first", Literal(Scalar.symbol(x))), ("second", Literal(Scalar.symbol(y))))
            )
    for factor in region.surrounded():
        yield Sentence("curve_missing", (("curve", Relation((Literal(factor), Literal(Scalar.of(0))), ("=",))),))
    yield from _numbers([end for part in parts(region) for end in (part.low, part.high)], x)


def _numbers(ends: Iterable[RealNumber | None], name: str) -> Iterator[Sentence]:
    """Yield which roots the numbers without a closed form are, two that are only ones together."""
    numbers = list(dict.fromkeys(end for end in ends if end is not None and end.closed_form() is None))
    only = [number for number in numbers if len(real_roots(number.polynomial)) == 1]

    def told(number: RealNumber, *slots: str) -> tuple[tuple[str, Formula | Relation], ...]:
        equation = Relation((Literal(number.minimal_polynomial(name)), Literal(Scalar.of(0))), ("=",))
        return tuple(zip(slots, (Literal(number.scalar(name)), equation), strict=True))

    if len(numbers) == len(only) == 2:
        yield Sentence("numbers_are_roots", (*told(only[0], "number", "equation"), *told(only[1], "other", "another")))
        return
    for number in numbers:
        which = Counted("only_real_root" if number in only else "real_root", number.index + 1)
        yield Sentence("number_is_root", (*told(number, "number", "equation"), ("which", which)))


def region_of(
    polynomial: Scalar, environment: Environment, *, discrete: bool, names: tuple[str, ...] = ()
) -> LineRegion | PlaneRegion | None:
    """Return the proved region of a polynomial with one or two parameters, None where it has others or is too large."""
    return _region_of(polynomial, environment.variable, tuple(sorted(environment.signs.items())), discrete, names)


@lru_cache(maxsize=64)
def _region_of(
    polynomial: Scalar,
    variable: str,
    signs: tuple[tuple[str, str], ...],
    discrete: bool,  # noqa: FBT001 - what is cached is called by position
    names: tuple[str, ...],
) -> LineRegion | PlaneRegion | None:
    critical = CriticalPolynomials(polynomial, StabilityBoundary(variable, discrete), dict(signs))
    if names and (variable in names or not set(critical.parameters) <= set(names)):
        return None
    return exact_region(critical, names or critical.parameters)


def holds_exactly(region: LineRegion | PlaneRegion, where: tuple[tuple[Scalar, str], ...]) -> bool:
    """Return whether a polynomial is stable exactly where these values are > 0 (or ≠ 0)."""
    if isinstance(region, LineRegion) and len(region.intervals) == 1:
        (piece,) = region.intervals
        symbol = Scalar.symbol(region.name)
        ends = [(symbol - piece.low.scalar(region.name), ">")] if piece.low is not None else []
        ends += [(piece.high.scalar(region.name) - symbol, ">")] if piece.high is not None else []
        if set(where).difference(_declared(region)) == set(ends).difference(_declared(region)):
            return is_region(region, short_list(region))
    names = {name for value, _ in where for name in value.names}
    if not names <= set(region.critical.parameters):
        return False
    return is_region(
        region, tuple(RegionInequality(value.numerator * value.denominator, operator) for value, operator in where)
    )


def _declared(region: LineRegion) -> list[tuple[Scalar, str]]:
    """Return the inequality that the declared sign of the parameter states already."""
    symbol = Scalar.symbol(region.name)
    sign = region.critical.signs.get(region.name)
    return [(symbol, ">")] if sign == "positive" else [(-symbol, ">")] if sign == "negative" else []


def are_the_parts(region: PlaneRegion, said: tuple[tuple[Relation, ...], ...]) -> bool:
    """Return whether these are the relations of the parts of a region, one after the other."""
    found = parts(region)
    return (
        are_parts(region, found)
        and are_whole(region, found)
        and said == tuple(relations_of(part, region.names) for part in found)
    )


def delayed_intervals(value: Scalar, environment: Environment) -> tuple[tuple[Relation, ...], ...]:
    """Return low < k < high for every interval of k with stable roots of P + k N e^{−sT}, none for another function.

    An end without a closed form is rounded to six digits after the point.
    """
    s, lags = environment.variable, [name for name in value.names if function_named(name) is not None]
    if len(lags) != 1 or value.degree(lags[0]) != 1 or not value.denominator.is_constant:
        return ()
    moved, opened = value.coefficients(lags[0])
    (lag,), names = map(function_named, lags), moved.names - {s}
    if lag is None or lag.kind != "exp" or len(names) != 1 or not opened.names <= {s}:
        return ()
    from symobs.exact.algebraic.dead_time_margins import digits_of, exact_value, loop_with  # noqa: PLC0415 - dead times alone

    (k,) = names
    N, T = moved / Scalar.symbol(k), -lag.argument / Scalar.symbol(s)
    if k in N.names or not T.is_constant or T.fraction() <= 0 or opened.degree(s) <= N.degree(s):
        return ()

    def end(edge: Edge) -> Formula:
        value = exact_value(edge)
        return Decimals(Scalar.of(Fraction(digits_of(edge)))) if isinstance(value, str) else Literal(value)

    found = loop_with(opened, N, T).loop.intervals(environment.signs.get(k, "real"))
    return tuple((Relation((end(low), Literal(Scalar.symbol(k)), end(high)), ("<", "<")),) for low, high, _ in found)


def interval_relations(region: LineRegion) -> list[tuple[Relation, ...]]:
    """Return low < name < high for every interval."""
    found: list[tuple[Relation, ...]] = []
    for piece in region.intervals:
        ends = [None if number is None else number.scalar(region.name) for number in (piece.low, piece.high)]
        written = between(region.name, ends[0], ends[1])
        found.append(() if written is None else (written,))
    return found
