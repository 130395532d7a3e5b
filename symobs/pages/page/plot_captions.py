"""Captions of plots, and the choice of the curves drawn."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, decimal_places
from symobs.formula.convention import STANDARD
from symobs.formula.figures import (
    BodePicture,
    BranchPicture,
    LinePicture,
    NyquistPicture,
    PoleMap,
    RegionPicture,
    SweepCurves,
    SweepMap,
    TimeResponse,
)
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import (
    Apply,
    At,
    Conjunction,
    Decimals,
    Formula,
    Letter,
    Literal,
    Relation,
    children,
    with_children,
)
from symobs.pages.page.prose import filled, joined
from symobs.proof.derivation import Sentence

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures import Curve, Drawn, PlottedResponse
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Fact
    from symobs.pages.page.blocks import Inline, Inlines

#: With more equations than this, curves that are no boundary are left out.
_MOST_DIVIDERS = 4
_UNSKETCHED = {"picture_samples", "picture_stable", "picture_unstable", "picture_dashed"}


def caption(picture: Drawn, language: Language = ENGLISH, *, sketched: bool = False, decimals: bool = False) -> Inlines:
    """Return the caption of a plot; plots in characters have neither samples nor dashes.

    With `decimals` numbers are decimals where these end.
    """
    sentences = [said for said in _sentences(picture) if not (sketched and said.key in _UNSKETCHED)]
    if drawn_for := getattr(picture, "drawn_for", ()):
        values = tuple(_equation(name, value) for name, value in drawn_for)
        sentences.append(caption_sentence("drawn_for", values=Conjunction(values)))
    words: list[Inline] = []
    for sentence in map(_in_decimals, sentences) if decimals else sentences:
        words += [" "] if words else []
        words += filled(sentence, STANDARD, language)
    return joined(words)


def _in_decimals(part: Any) -> Any:
    """Return a sentence, or a part of it, with the decimals of its numbers, 10.5 for 21/2."""
    match part:
        case Literal(Scalar() as value) if decimal_places(value):
            return Decimals(value)
        case tuple():
            return tuple(map(_in_decimals, part))
        case Relation(members, operators):
            return Relation(_in_decimals(members), operators)
        case Conjunction(relations):
            return Conjunction(_in_decimals(relations))
        case Sentence(key, slots):
            return Sentence(key, _in_decimals(slots))
    return with_children(part, _in_decimals(children(part))) if isinstance(part, Formula) else part


def drawn(picture: RegionPicture) -> tuple[Curve, ...]:
    """Return the curves to draw: the boundaries, and the others if they are few."""
    others = {curve.equation for curve in picture.curves if not curve.boundary}
    return tuple(curve for curve in picture.curves if curve.boundary or len(others) <= _MOST_DIVIDERS)


def symbol(name: str) -> Formula:
    """Return a parameter as a formula."""
    return Literal(Scalar.symbol(name))


def number(value: Scalar | Fraction | int) -> Formula:
    """Return a number as a formula."""
    return Literal(Scalar.of(value))


def part(name: str) -> Formula:
    """Return the real part `Re` or the imaginary part `Im` of the variable."""
    return Apply(name, Letter("s"))


def name_of(response: PlottedResponse) -> Formula:
    """Return the name of a response: the letter of its signal, with the index of its component."""
    return Letter(f"{response.signal}[{response.component}" if response.component else response.signal)


def time_axis(picture: TimeResponse) -> str:
    """Return the name of the time axis."""
    return "k" if picture.discrete else "t"


def _equation(name: str, value: Scalar) -> Relation:
    return Relation((symbol(name), number(value)), ("=",))


def caption_sentence(key: str, **slots: Formula | Fact | str) -> Sentence:
    """Return the sentence of a caption, its slots filled."""
    return Sentence(f"picture_{key}", tuple(slots.items()))


def _sentences(picture: Drawn) -> Iterator[Sentence]:
    match picture:
        case RegionPicture(axes=(first, second)):
            yield caption_sentence(f"region{_extent(picture)}", first=symbol(first), second=symbol(second))
            if any(mark.kind == "excluded" for mark in picture.marks):
                yield caption_sentence("excluded")
            if any(not curve.boundary for curve in drawn(picture)):
                yield caption_sentence("dashed")
        case LinePicture(axis=axis):
            yield caption_sentence(f"line{_length(picture)}", parameter=symbol(axis))
            yield from (caption_sentence(kind) for kind in _kinds(kind for _, kind in picture.marks))
        case PoleMap(moved=moved, values=(begin, end)):
            key = "poles" if picture.zeros is None else "locus"
            yield caption_sentence(key, parameter=symbol(moved), begin=number(begin), end=number(end))
            if picture.discrete:
                yield caption_sentence("disc", radius=number(radius_of(picture)))
            else:
                edge = number(-(picture.margin or 0))
                yield caption_sentence("half_plane", where=Relation((part("Re"), edge), ("<",)))
        case TimeResponse(states=states, starts=starts):
            begun = tuple(_beginning(*state) for state in zip(states, starts, strict=True))
            yield caption_sentence("response", start=Conjunction(begun))
            if picture.discrete:
                yield caption_sentence("samples_only")
        case NyquistPicture(indented=indented):
            yield caption_sentence("nyquist")
            if indented:
                yield caption_sentence("indented")
        case BodePicture(discrete=discrete):
            yield caption_sentence("bode_discrete" if discrete else "bode")
            if picture.asymptotes:
                yield caption_sentence("bode_asymptotes")
            if picture.gain_margin or picture.phase_margin:
                yield caption_sentence("bode_margins")
        case BranchPicture(axes=(parameter, state)):
            yield caption_sentence("branches", parameter=symbol(parameter), state=symbol(state))
            if values := tuple(dict.fromkeys(_equation(parameter, value) for _, value in picture.marks)):
                yield caption_sentence("branch_points", values=Conjunction(values))
        case SweepCurves(points=count, columns=columns, infinite=infinite):
            yield caption_sentence("sweep", count=number(count))
            for column in infinite:
                yield caption_sentence("infinite", column=column)
            if any(gaps for _, _, gaps in columns):
                yield caption_sentence("gaps")
        case SweepMap(column=column, points=count, gaps=gaps):
            yield caption_sentence("map", column=column, count=number(count))
            if gaps:
                yield caption_sentence("gaps")


def _beginning(name: str, start: Sequence[Fraction]) -> Relation:
    values = Matrix.of([[part] for part in start])
    value = values[0, 0] if len(start) == 1 else values
    return Relation((At(Letter(name), "t", Scalar.of(0)), Literal(value)), ("=",))


def radius_of(picture: PoleMap) -> Fraction:
    """Return the radius of the disc of stable poles."""
    return Fraction(1) if picture.radius is None else picture.radius


def _extent(picture: RegionPicture) -> str:
    if not picture.areas:
        return "_nowhere"
    return "" if any(curve.boundary for curve in picture.curves) else "_everywhere"


def _length(picture: LinePicture) -> str:
    if not picture.pieces:
        return "_nowhere"
    if picture.pieces == ((None, None),):
        return "_everywhere"
    return "_one" if len(picture.pieces) == 1 else ""


def _kinds(kinds: Iterator[str]) -> list[str]:
    """Return the explanation of the marks that occur."""
    found = set(kinds)
    samples = ["samples"] if {"stable", "unstable"} <= found else sorted(found - {"excluded"})
    return [*samples, *(found & {"excluded"})]
