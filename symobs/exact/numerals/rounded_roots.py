"""Roots of a polynomial in decimals: the test that the texts of a page are correct roundings (trusted).

A root is written as (real part, imaginary part, whether a part is rounded), the parts as `-0.36896`; that of a real root is
empty.  Roots with a closed form are held against it; the others, all roots of their factor, against boxes that enclose them.
"""

from __future__ import annotations

import re
from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.algebraic.root_location import root_boxes
from symobs.exact.core.generators import generator
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.algebraic.polynomial_roots import Root


# Significant digits of exact numbers: the test that a text is the correct rounding of one (trusted).
#
# A text is `0.3676`, `16987` or `1.2346e-7`, always of a number that is not negative. Either it is exactly the number,
# or it has as many significant digits as were asked for, trailing zeros among them, and is the multiple of the unit of
# its last place that is nearest to the number; of two that are equally near the even one.


_WRITTEN = re.compile(r"(?P<whole>0|[1-9][0-9]*)(?:\.(?P<places>[0-9]+))?(?:e(?P<power>-?[1-9][0-9]*))?")


def is_correctly_written(exact: Scalar, text: str, digits: int) -> bool:
    """Return whether a text is the number itself, or its correct rounding to so many significant digits."""
    found = _WRITTEN.fullmatch(text)
    if found is None:
        return False
    places = found["places"] or ""
    units = int(found["whole"] + places)
    unit = Fraction(10) ** (int(found["power"] or 0) - len(places))
    shown = units * unit
    if exact.is_constant and exact.fraction() == shown:
        return True
    if len(str(units)) != digits or units == 0:
        return False
    is_below = exact.fraction() < shown if exact.is_constant else sign_of_number(shown - exact) == "positive"
    if is_below and units == 10 ** (digits - 1):  # below a power of ten the digits stand one place further
        units, unit = 10 * units, unit / 10
    if exact.is_constant:
        off = abs(exact.fraction() - shown)
        return 2 * off < unit or (2 * off == unit and units % 2 == 0)
    return all(sign_of_number(unit / 2 + off) == "positive" for off in (exact - shown, shown - exact))


def is_written_exactly(exact: Scalar, text: str) -> bool:
    """Return whether a text is exactly the number."""
    return exact.is_constant and Fraction(text) == exact.fraction()


RootText: TypeAlias = tuple[str, str, bool]
#: A part of a root as an enclosure: a number with itself, or bounds of it.
Bounds: TypeAlias = tuple[Scalar, Scalar]
_ZERO = Scalar.of(0)
#: Places after the point, beyond the digits asked for, of the boxes around roots without a closed form.
_MORE_PLACES = 40


def are_rounded_roots(roots: Sequence[Root], texts: Sequence[RootText], digits: int) -> bool:
    """Return whether these are the correct roundings of the roots, each as often as its root."""
    parts = root_parts(roots, digits)
    if parts is None or len(parts) != len(texts):
        return False
    return all(_is_right(part, text, digits) for part, text in zip(parts, texts, strict=True))


def _is_right(part: tuple[Bounds, Bounds], text: RootText, digits: int) -> bool:
    real, imaginary = part
    first, second, is_rounded = text
    if not _is_correct(real, first, digits):
        return False
    if not second:
        return is_zero(imaginary) and is_rounded != is_exact(real, first)
    exact = is_exact(real, first) and is_exact(imaginary, second)
    return not is_zero(imaginary) and _is_correct(imaginary, second, digits) and is_rounded != exact


def _is_correct(bounds: Bounds, text: str, digits: int) -> bool:
    """Return whether a signed text is the correct rounding of every number between the bounds."""
    size = text.removeprefix("-")
    if text.startswith("-"):
        bounds = (-bounds[1], -bounds[0])
    if bounds[0] == bounds[1] and bounds[0].is_zero:
        return text == "0"
    if not all(sign_of_number(end) == "positive" for end in bounds):
        return False
    return all(is_correctly_written(end, size, digits) for end in bounds)


def is_exact(bounds: Bounds, text: str) -> bool:
    """Return whether a text is exactly the number that the bounds enclose."""
    return bounds[0] == bounds[1] and is_written_exactly(bounds[0], text)


def is_zero(bounds: Bounds) -> bool:
    """Return whether the bounds enclose 0 alone."""
    return bounds[0].is_zero and bounds[1].is_zero


def root_parts(roots: Sequence[Root], digits: int) -> list[tuple[Bounds, Bounds]] | None:
    """Return bounds of the real and the imaginary part of each root, None where there are none."""
    boxes = _boxes(roots, digits)
    if boxes is None:
        return None
    found: list[tuple[Bounds, Bounds]] = []
    for root in roots:
        if not root.is_closed:
            found.append(boxes[root.factor].pop(0))
        elif not is_number(root.centre) or not root.radicand.is_constant:
            return None
        else:
            found.append(_closed(root))
    return found


def _closed(root: Root) -> tuple[Bounds, Bounds]:
    """Return the parts of centre ± √radicand."""
    centre = root.centre
    if root.radicand.is_zero:
        return (centre, centre), (_ZERO, _ZERO)
    outside, inside, imaginary = root.surd()
    radical = Scalar.of(1) if inside == 1 else generator("sqrt", Scalar.of(inside))
    distance = radical * (outside * root.sign)
    if imaginary:
        return (centre, centre), (distance, distance)
    return (centre + distance, centre + distance), (_ZERO, _ZERO)


def _boxes(roots: Sequence[Root], digits: int) -> dict[Scalar, list[tuple[Bounds, Bounds]]] | None:
    """Return boxes around all roots of each factor without closed ones; None where some of them are missing."""
    found: dict[Scalar, list[tuple[Bounds, Bounds]]] = {}
    counted = Counter((root.factor, root.index) for root in roots if not root.is_closed)
    for factor in {root.factor: None for root in roots if not root.is_closed}:
        coefficients = factor.coefficients(_variable(roots, factor))
        powers = {counted[factor, index] for index in range(len(coefficients) - 1)}
        if len(powers) != 1 or not all(coefficient.is_constant for coefficient in coefficients):
            return None
        boxes = root_boxes([coefficient.fraction() for coefficient in coefficients], digits + _MORE_PLACES)
        found[factor] = [_bounds(box) for box, _ in sorted(boxes) for _ in range(max(powers))]
    return found


def _variable(roots: Sequence[Root], factor: Scalar) -> str:
    return next(root.variable for root in roots if root.factor == factor)


def _bounds(box: tuple[Fraction, ...]) -> tuple[Bounds, Bounds]:
    left, right, below, above = map(Scalar.of, box)
    return (left, right), (below, above)
