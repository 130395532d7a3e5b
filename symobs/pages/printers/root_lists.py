"""Roots of a polynomial in a sentence: `-2, -2`, `-20 ± 20i`, `-1 ± √2`, or the equation of those without a form."""

from __future__ import annotations

from dataclasses import replace
from math import isqrt
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar
from symobs.exact.core.generators import function_named
from symobs.formula.tree import Letter, Literal, Numeral, Relation, RoundedRoots
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.exact.algebraic.polynomial_roots import Root
    from symobs.exact.numerals.rounded_roots import RootText
    from symobs.formula.tree import Formula, Roots
    from symobs.pages.printers.printer import Printer


#: What a number of a list stands for is said by the list.
_NOTHING = Scalar.of(0)


@dataclass
class RootGlyphs:
    """The interface of a format for roots; `among` writes the roots of an equation."""

    square_root: Callable[[str], str]
    plus_minus: str
    among: Callable[[str, str], str]
    number: Callable[[int], str] = str
    minus: str = "-"
    plus: str = "+"
    imaginary: str = "i"
    space: str = " "
    about: str = "≈ "
    fraction: Callable[[str], str] = str
    written: Callable[[Any, Formula | Relation], str] = lambda printer, item: printer.inline(item)


LATEX = RootGlyphs(
    lambda inside: rf"\sqrt{{{inside}}}",
    r"\pm ",
    lambda s, equation: rf"\{{{s}:{equation}\}}",
    about=r"\approx ",
    space=r"\,",
)
TEXT = RootGlyphs(
    lambda inside: f"√{inside}" if inside.isdecimal() or len(inside) == 1 else f"√({inside})",
    " ± ",
    lambda s, equation: f"{{{s}: {equation}}}",
    fraction="({})".format,
)


def listed(roots: Roots, printer: Printer[Any], glyphs: RootGlyphs) -> list[str]:
    """Return the roots one after the other, a pair as one item."""
    if isinstance(roots, RoundedRoots):
        return [_in_decimals(*text, paired, printer, glyphs) for text, paired in _paired(roots.texts)]
    return [_written(root, paired, printer, glyphs) for root, paired in _grouped(roots.values)]


def in_a_row(roots: Roots, printer: Printer[Any], glyphs: RootGlyphs, wrapped: Callable[[str], str]) -> str:
    """Return the roots as one text; exact ones beside rounded ones come first, `0 and, rounded, -0.3695 ± 0.88597i`."""
    found = listed(roots, printer, glyphs)
    exact = [wrapped(root) for root in found if not root.startswith(glyphs.about)]
    rounded = [root.removeprefix(glyphs.about) for root in found if root.startswith(glyphs.about)]
    if not exact or not rounded:
        return ", ".join(map(wrapped, found))
    return f"{', '.join(exact)}{printer.language.words['rounded']}{', '.join(map(wrapped, rounded))}"


def _grouped(values: tuple[Root, ...]) -> Iterator[tuple[Root, bool]]:
    """Yield each root with whether it stands for a pair; the open roots of a factor are one group."""
    remaining = list(values)
    while remaining:
        root = remaining.pop(0)
        if not root.is_closed:
            group = [other for other in remaining if other.factor == root.factor and other.index != root.index]
            for index in {other.index for other in group}:
                remaining.remove(next(other for other in group if other.index == index))
            yield root, False
            continue
        partner = replace(root, sign=-root.sign)
        is_pair = not root.radicand.is_zero and partner in remaining
        if is_pair:
            remaining.remove(partner)
        yield root, is_pair


def _paired(texts: tuple[RootText, ...]) -> Iterator[tuple[RootText, bool]]:
    """Yield each root in decimals with whether it stands for a conjugate pair, or for a real one with its negative."""
    remaining = list(texts)
    while remaining:
        real, imaginary, is_rounded = text = remaining.pop(0)
        partner = (real, _opposite(imaginary), is_rounded) if imaginary else (_opposite(real), "", is_rounded)
        is_pair = partner != text and partner in remaining
        if is_pair:
            remaining.remove(partner)
        yield text, is_pair


def _opposite(text: str) -> str:
    return text[1:] if text.startswith("-") else text if text == "0" else f"-{text}"


def _in_decimals(
    real: str,
    imaginary: str,
    is_rounded: bool,  # noqa: FBT001 - as the texts have it
    paired: bool,  # noqa: FBT001
    printer: Printer[Any],
    glyphs: RootGlyphs,
) -> str:
    """Return a root in decimals, or a pair, behind a sign that it is rounded."""

    def size(text: str) -> str:
        return glyphs.written(printer, Numeral(_NOTHING, text.removeprefix("-")))

    moved = imaginary or real
    sign = glyphs.plus_minus if paired else glyphs.minus if moved.startswith("-") else glyphs.plus * bool(imaginary)
    if not imaginary:
        written = f"{sign}{size(real)}"
    else:
        centre = "" if real == "0" else f"{glyphs.minus * real.startswith('-')}{size(real)}"
        sign = sign if centre or paired or moved.startswith("-") else ""
        written = f"{centre}{sign}{size(imaginary) if moved.removeprefix('-') != '1' else ''}{glyphs.imaginary}"
    return f"{glyphs.about * is_rounded}{written.strip()}"


def _written(root: Root, paired: bool, printer: Printer[Any], glyphs: RootGlyphs) -> str:  # noqa: FBT001
    if not root.is_closed:
        equation = Relation((Literal(root.factor), Literal(Scalar.of(0))), ("=",))
        return glyphs.among(glyphs.written(printer, Letter("s")), glyphs.written(printer, equation))
    if root.radicand.is_zero:
        return glyphs.written(printer, Literal(root.centre))
    centre = "" if root.centre.is_zero else glyphs.written(printer, Literal(root.centre))
    distance = _distance(root, printer, glyphs, paired=paired)
    if paired:
        return f"{centre}{glyphs.plus_minus}{distance}".strip()
    sign = glyphs.minus if root.sign < 0 else glyphs.plus * bool(centre)
    return f"{centre}{sign}{distance}"


def _size_of_imaginary(radicand: Scalar) -> Scalar | None:
    """Return a product r of symbols and a whole number with r² = −radicand, so that ±√radicand is ±r i; else nothing."""
    unit, factors = (-radicand).factors()
    if not unit.is_constant:
        return None
    number = unit.fraction()
    outside = isqrt(number.numerator) if number > 0 else 0
    size = Scalar.of(outside)
    for factor, power in factors:
        size = size * factor ** (power // 2) if power > 0 else Scalar.of(0)
    return size if size**2 == -radicand and len(tuple(size.terms())) == 1 else None


def _outside(radicand: Scalar) -> Scalar:
    """Return the product of the letters whose squares divide a polynomial."""
    outside = Scalar.of(1)
    for factor, power in radicand.numerator.factors()[1] if radicand.denominator.is_constant else ():
        if len(factor.terms()) == 1 and not function_named(factor.terms()[0][1][0][0]):
            outside = outside * factor ** (power // 2)
    return outside


def _distance(root: Root, printer: Printer[Any], glyphs: RootGlyphs, *, paired: bool) -> str:
    """Return √radicand, its square factors before the root, i behind it: a pair ±√(−2k) is ±√(2k) i, whatever k is."""
    if not root.radicand.is_constant:
        size = _size_of_imaginary(root.radicand)
        if size is not None:
            # p i, not pi, which is another number
            return glyphs.written(printer, Literal(size)) + glyphs.space + glyphs.imaginary
        square = _outside(root.radicand) if paired else Scalar.of(1)
        if not square.is_one:  # ±√(ω²ζ² − ω²) is ±ω √(ζ² − 1), whatever the sign of ω is
            inner = replace(root, radicand=root.radicand / square**2)
            return (
                glyphs.written(printer, Literal(square)) + glyphs.space + _distance(inner, printer, glyphs, paired=True)
            )
        whole, below = root.radicand, root.radicand.denominator
        half = isqrt(below.fraction().numerator) if below.is_constant else 0
        if half > 1 and half**2 == below.fraction():
            front, whole = glyphs.fraction(glyphs.written(printer, Literal(Scalar.of(1) / half))), whole * below
        else:
            front = ""
        is_turned = paired and all(coefficient < 0 for coefficient, _ in whole.terms())
        behind = glyphs.space + glyphs.imaginary if is_turned else ""
        return front + glyphs.square_root(glyphs.written(printer, Literal(-whole if is_turned else whole))) + behind
    outside, inside, imaginary = root.surd()
    under = "" if inside == 1 else glyphs.square_root(glyphs.number(int(inside)))
    unit = under + glyphs.imaginary * imaginary
    if outside.denominator == 1:
        return glyphs.number(outside.numerator) * (outside != 1 or not unit) + unit
    above = Scalar.of(outside.numerator)
    front = glyphs.written(printer, Literal(above / outside.denominator))
    return glyphs.fraction(front) + unit
