"""Check of plots against the polynomial they are drawn for, to within visible accuracy (trusted).

The points of a picture are rational and lie near what they stand for; how near is a fixed part of the window.
"""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Scalar, product_of
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.formula.figures.plot import LinePicture, PoleMap, RegionPicture, TimeResponse
from symobs.formula.tree import Exact, evaluate
from symobs.proof.certificate.claims import EVALUATION_ERRORS, as_scalar
from symobs.proof.derivation.facts.properties import polynomial_of
from symobs.proof.derivation.figures.plot_points import ALLOWS, Stability
from symobs.proof.derivation.figures.region_plot_check import faults_of_region
from symobs.proof.derivation.figures.root_locus_check import faults_of_poles

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.formula.figures.plot import End, Picture
    from symobs.formula.tree import Environment, Formula, Relation

#: The part of a window that is near a place or an end.
_NEAR = Fraction(1, 500)
#: The last pictures in which nothing was false, and of what: a page asks before it shows one, and again when it is
#: checked.  A picture cannot be changed, so the same one shows the same; another one of equal parts is looked at anew.
_FAITHFUL: deque[tuple[Picture, tuple[object, ...]]] = deque(maxlen=4)


def relations_of(picture: Picture) -> tuple[Relation, ...]:
    """Return the equations that are written into a picture."""
    return tuple(curve.equation for curve in picture.curves) if isinstance(picture, RegionPicture) else ()


def faults(picture: Picture, subject: Formula, environment: Environment, *, discrete: bool) -> Iterator[str]:
    """Yield the faults of a plot."""
    if isinstance(picture, TimeResponse):
        from symobs.proof.derivation.figures.time_response_check import faults_of_response  # noqa: PLC0415 - only pages with one pay for it

        if picture.discrete == discrete:
            yield from faults_of_response(picture, subject, environment)
        else:
            yield "another time"
        return
    numbers = dict(picture.drawn_for)
    for name, value in numbers.items():
        if not value.is_constant or not ALLOWS[environment.signs.get(name, "real")](value.fraction()):
            yield f"{name} = {value}"
    variable = environment.variable
    value = as_scalar(evaluate(subject, environment, Exact(environment)))
    polynomial = polynomial_of(value, environment).substitute(numbers)
    axes = (picture.moved,) if isinstance(picture, PoleMap) else _axes(picture)
    if not polynomial.names <= {variable, *axes}:
        yield f"the polynomial {polynomial} depends on {', '.join(axes)} alone"
        return
    equations = {relation: _difference(relation, environment, numbers) for relation in relations_of(picture)}
    of = polynomial, variable, discrete, dict(environment.signs), equations
    if any(seen is picture and held == of for seen, held in _FAITHFUL):
        return
    is_rejected = False
    signs = tuple(environment.signs.get(name, "real") for name in axes)
    test = Stability(polynomial, variable, axes, signs, discrete)
    match picture:
        case RegionPicture():
            found = faults_of_region(picture, equations, test)
        case LinePicture():
            found = _of_line(picture, test)
        case _:
            found = faults_of_poles(picture, polynomial, variable, discrete=discrete)
    for fault in found:
        is_rejected = True
        yield fault
    if not is_rejected:
        _FAITHFUL.append((picture, of))


def is_faithful(picture: Picture, subject: Formula, environment: Environment, *, discrete: bool) -> bool:
    """Return whether nothing that a picture shows is false."""
    try:
        return next(faults(picture, subject, environment, discrete=discrete), None) is None
    except EVALUATION_ERRORS:
        return False


def _axes(picture: RegionPicture | LinePicture) -> tuple[str, ...]:
    return picture.axes if isinstance(picture, RegionPicture) else (picture.axis,)


def _difference(relation: Relation, environment: Environment, numbers: dict[str, Scalar]) -> Scalar:
    """Return a polynomial that vanishes where the equation holds, each factor once; 1 where there is no equation."""
    if relation.operators != ("=",):
        return Scalar.of(1)
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
    factors = (left - right).substitute(numbers).numerator.factors()[1]
    return product_of(factor for factor, _ in factors)


# -- intervals --------------------------------------------------------------------------------------------------------


def _of_line(picture: LinePicture, test: Stability) -> Iterator[str]:
    low, high = picture.window
    near = (high - low) * _NEAR
    if near <= 0:
        yield "the window is empty"
        return
    drawn = [(a.place if a else low, b.place if b else high) for a, b in picture.pieces]
    borders = [low, *(part for piece in drawn for part in piece), high]
    if borders != sorted(borders):
        yield "the pieces follow one another"
    for a, b in drawn:
        yield from (f"{x} is stable" for x in _between(a, b) if not test.is_stable(x))
    for a, b in zip(borders[::2], borders[1::2], strict=True):
        if b - a > 2 * near:
            yield from (f"{x} is not stable" for x in _between(a, b) if test.is_stable(x))
    for (begin, end), (a, b) in zip(picture.pieces, drawn, strict=True):
        inward = min(near, (b - a) / 3)
        for found, step in ((begin, inward), (end, -inward)):
            if found is not None:
                yield from _of_end(found, step, near, dict(picture.drawn_for), test)
    for place, kind in picture.marks:
        around = [(place - near,), (place + near,)]
        is_stable = test.is_stable(place)
        agrees = {"stable": is_stable, "unstable": not is_stable, "excluded": test.is_excluded((place,), around)}
        if not agrees.get(kind):
            yield f"{place} is {kind}"


def _of_end(end: End, inward: Fraction, near: Fraction, numbers: dict[str, Scalar], test: Stability) -> Iterator[str]:
    """Yield the faults of an end: stable on the inner side, on the outer not, unless the end alone is taken out."""
    outward = end.place - near if inward > 0 else end.place + near
    is_taken_out = test.is_excluded((end.place,), [(end.place - near,), (end.place + near,)])
    if not test.is_stable(end.place + inward) or (test.is_stable(outward) and not is_taken_out):
        yield f"{end.place} is an end"
    if not _is_labelled(end, near, numbers):
        yield f"{end.label} = {end.place}"


def _between(a: Fraction, b: Fraction) -> Iterator[Fraction]:
    return (a + (b - a) * Fraction(k, 8) for k in range(1, 8))


def _is_labelled(end: End, near: Fraction, numbers: dict[str, Scalar]) -> bool:
    """Return whether the label at an end is its place, to visible accuracy."""
    if isinstance(end.label, str):
        try:
            value = Scalar.of(Fraction(end.label.strip("≈… ").replace("−", "-")))
        except ValueError:
            return False
    else:
        value = end.label.substitute(numbers)
    above, below = value - (end.place - near), (end.place + near) - value
    return all(
        difference.fraction() >= 0 if difference.is_constant else sign_of_number(difference) == "positive"
        for difference in (above, below)
    )
