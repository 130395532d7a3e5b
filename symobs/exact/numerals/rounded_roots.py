"""Roots of a polynomial in decimals: the test that the texts of a page are correct roundings (trusted).

A root is written as (real part, imaginary part, whether a part is rounded), the parts as `-0.36896`; that of a real root is
empty.  Roots with a closed form are held against it; the others, all roots of their factor, against boxes that enclose them.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.algebraic.root_location import root_boxes
from symobs.exact.core.generators import generator
from symobs.exact.core.scalar import Scalar
from symobs.exact.numerals.significant_digits import is_correctly_written, is_written_exactly

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.algebraic.polynomial_roots import Root

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
