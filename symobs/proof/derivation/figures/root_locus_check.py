"""Check of a root locus against its polynomial, to within visible accuracy (trusted).

That a root z₀ lies near z follows from p(z + w) = Σ cₖ wᵏ, of degree n: ±cₖ/c₀ is a sum of C(n, k) products of k
reciprocals of z₀ − z, so one root has |z₀ − z|ᵏ ≤ C(n, k) |c₀/cₖ|.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from itertools import dropwhile
from math import comb
from typing import TYPE_CHECKING

from symobs.exact.algebraic.rational_points import shifted, value_at
from symobs.proof.derivation.figures.plot_points import within, written

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.exact import Scalar
    from symobs.formula.figures.plot import Place, PoleMap

#: How far a pole may lie from its path, as a part of the window.
_NEAR_POLE = Fraction(1, 200)


def faults_of_poles(picture: PoleMap, polynomial: Scalar, variable: str, *, discrete: bool) -> Iterator[str]:
    """Yield the faults of a root locus."""
    if (picture.variable, picture.discrete) != (variable, discrete):
        yield f"the poles are those in {picture.variable}"
    degree = polynomial.degree(variable)
    if len(picture.paths) != degree or len(picture.along) != degree:
        yield f"there are {len(picture.paths)} poles"
        return
    begin, end = picture.values
    if any(not within(place, picture.window) for path in picture.paths for place in path):
        yield "the poles do not leave the window"
    near = min(high - low for low, high in picture.window) * _NEAR_POLE
    for path, along in zip(picture.paths, picture.along, strict=True):
        falling = sorted(along, reverse=begin > end)
        if len(path) != len(along) or (along[0], along[-1]) != (begin, end) or list(along) != falling:
            yield f"{picture.moved} goes from {begin} to {end}"
            return
        for place, value in zip(path, along, strict=True):
            if not is_pole(polynomial, picture.moved, value, place, variable, near):
                yield f"{written(place)} is a pole at {picture.moved} = {value}"
    if not any(_are_all(picture, polynomial, variable, at) for at in _common(picture)):
        yield "these are all poles"


def is_pole(polynomial: Scalar, moved: str, value: Fraction, place: Place, variable: str, near: Fraction) -> bool:
    """Return whether a root of a polynomial surely lies near a place where the parameter that is moved has this value."""
    return _has_root_near(_shifted(polynomial, moved, value, place, variable), near)


def _shifted(polynomial: Scalar, moved: str, value: Fraction, place: Place, variable: str) -> list[Place]:
    """Return c₀, …, cₙ of a multiple of p(z + w) = Σ cₖ wᵏ."""
    below, coefficients = _parts(polynomial, variable)
    if value_at(below, {moved: value}) == 0:
        raise ZeroDivisionError
    found = [value_at(c, {moved: value}) for c in coefficients]
    return shifted(list(dropwhile(lambda c: c == 0, found)), place)


@lru_cache(maxsize=4)
def _parts(polynomial: Scalar, variable: str) -> tuple[Scalar, tuple[Scalar, ...]]:
    """Return the denominator of a polynomial and the coefficients of its numerator, highest first."""
    return polynomial.denominator, polynomial.numerator.coefficients(variable)


def _has_root_near(around: Sequence[Place], distance: Fraction) -> bool:
    """Return whether some root surely has |w| ≤ distance."""
    degree = len(around) - 1
    constant = _square(around[0])
    return any(
        comb(degree, k) ** 2 * constant <= distance ** (2 * k) * _square(c) and _square(c) != 0
        for k, c in enumerate(around)
        if k
    )


def _square(value: Place) -> Fraction:
    """Return the square of the modulus."""
    real, imaginary = value
    return real * real + imaginary * imaginary


def _common(picture: PoleMap) -> Iterator[int]:
    """Yield the indices at which all paths stand at the same value of the parameter, from the middle on."""
    shortest = min(map(len, picture.along))
    for index in sorted(range(shortest), key=lambda index: abs(2 * index - shortest)):
        if len({along[index] for along in picture.along}) == 1:
            yield index


def _are_all(picture: PoleMap, polynomial: Scalar, variable: str, index: int) -> bool:
    """Return whether discs that hold a root each lie apart from one another, as many as there are different roots."""
    different = sum(factor.degree(variable) for factor, _ in polynomial.numerator.factors()[1])
    apart: list[tuple[Place, Fraction]] = []
    for path, along in zip(picture.paths, picture.along, strict=True):
        around = _shifted(polynomial, picture.moved, along[index], path[index], variable)
        constant, slope = _square(around[0]), _square(around[1])
        if constant and not slope:
            continue
        radius = (len(around) - 1) ** 2 * constant / slope if constant else Fraction(0)
        if all(_distance(path[index], place) > 2 * (radius + other) for place, other in apart):
            apart.append((path[index], radius))
    return len(apart) >= different


def _distance(a: Place, b: Place) -> Fraction:
    """Return the square of the distance."""
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2
