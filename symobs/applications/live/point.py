"""A point of a stability region: the exact verdict there, the polynomial, and its roots in enclosing decimals."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.live.request import FieldError
from symobs.exact import Scalar
from symobs.exact.algebraic.rational_points import value_at
from symobs.exact.algebraic.root_location import root_boxes
from symobs.formula.figures.plot import LinePicture, PoleMap, RegionPicture
from symobs.formula.tree import Letter, Literal, Relation
from symobs.ground.errors import InputError
from symobs.pages.cards import Card
from symobs.pages.drawings.plot_file import is_shown
from symobs.pages.drawings.svg import svg, svg_scene
from symobs.pages.page.narrator import printer_for
from symobs.pages.printers.text_printer import TextPrinter
from symobs.system import Symbols, read_scalar
from symobs.tasks.result import Document

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.phrases.languages import Language
    from symobs.pages.cards import CardPrinter

_PLACES = 4


def numbers(at: Mapping[str, str]) -> dict[str, Fraction]:
    """Return the rational numbers of a point."""
    found = {}
    for name, text in at.items():
        value = read_scalar(text, Symbols.of({}), f"at.{name}")
        if value.names:
            raise FieldError("said_no_rational", f"at.{name}")
        found[name] = value.fraction()
    return found


def point_object(region: Any, at: Mapping[str, str], printer: CardPrinter) -> dict[str, Any]:
    """Return what is true at a point; `region` is a `StabilityRegion`."""
    critical, place = region.critical, numbers(at)
    boundary = critical.boundary
    missing = sorted((critical.polynomial.names | boundary.names) - {boundary.variable} - place.keys())
    if missing:
        raise InputError(f"a value is missing for {', '.join(missing)}", where="at", repair="give it in at")
    if boundary.names:
        values = {name: Scalar.of(place[name]) for name in boundary.names}
        critical = type(critical)(critical.polynomial, boundary.substitute(values), critical.signs)
    if value_at(critical.denominator, place) == 0:
        return {"verdict": "undefined", "roots": []}
    allowed = critical.allows({name: place[name] for name in critical.signs if name in place})
    chi = critical.polynomial.substitute({name: Scalar.of(value) for name, value in place.items()})
    stable = critical.is_stable(place)
    card = Card("polynomial", Relation((Letter("chi_p"), Literal(chi)), ("=",)), chi)
    vanishing = [factor for factor in critical.proper if factor.names <= place.keys() and not value_at(factor, place)]
    zero = Literal(Scalar.of(0))
    boundaries = [Card("boundary", Relation((Literal(factor), zero), ("=",)), factor) for factor in vanishing]
    on_edge = bool(vanishing) and not stable
    verdict = "stable" if stable and allowed else "boundary" if on_edge else "unstable" if allowed else "excluded"
    return {
        "verdict": verdict,
        "cards": [card_object(card, printer)],
        "boundary": [card_object(found, printer) for found in boundaries] if on_edge else [],
        "roots": [_root(box, power) for box, power in root_boxes(_coefficients(chi, boundary.variable), _PLACES)],
    }


def _coefficients(chi: Scalar, variable: str) -> list[Fraction]:
    return [coefficient.fraction() for coefficient in chi.coefficients(variable)]


def _root(box: tuple[Fraction, ...], multiplicity: int) -> dict[str, Any]:
    re_low, re_high, im_low, im_high = (_decimal(part) for part in box)
    return {"re": [re_low, re_high], "im": [im_low, im_high], "multiplicity": multiplicity}


def _decimal(value: Fraction) -> str:
    """Return a decimal of a few places; exact, since it was rounded to them before."""
    whole = abs(value * 10**_PLACES)
    digits = str(int(whole)).rjust(_PLACES + 1, "0")
    return f"{'-' if value < 0 else ''}{digits[:-_PLACES]}.{digits[-_PLACES:]}"


def card_object(card: Card, printer: CardPrinter) -> dict[str, str]:
    """Return a card in every form."""
    return {"name": card.name, "mathml": printer.mathml(card), "latex": printer.latex(card), "says": printer.says(card)}


# -- the picture ------------------------------------------------------------------------------------------------------


def region_object(result: Any, language: Language) -> dict[str, Any]:
    """Return the checked picture of a region, where its plane lies in it, and a point to begin with."""
    picture = result.picture
    parameters = list(result.question.parameters)
    if picture is None or not is_shown(picture, result):
        return {"svg": "", "parameters": parameters, "handle": None}
    printer = printer_for(Document("", "", (result,), language=language.code), TextPrinter)
    scene = svg_scene(picture, printer)
    frame = scene.frame
    found: dict[str, Any] = {
        "svg": svg(scene, printer),
        "box": [
            scene.whole.left,
            -scene.whole.top,
            scene.whole.right - scene.whole.left,
            scene.whole.top - scene.whole.bottom,
        ],
        "frame": [frame.left, -frame.top, frame.right - frame.left, frame.top - frame.bottom],
        "drawn_for": {name: str(value) for name, value in picture.drawn_for},
        "parameters": parameters,
    }
    match picture:
        case RegionPicture():
            stable = [mark.place for mark in picture.marks if mark.kind == "stable"]
            (left, right), (bottom, top) = picture.window
            x, y = stable[0] if stable else ((left + right) / 2, (bottom + top) / 2)
            return found | {
                "kind": "plane",
                "parameters": list(picture.axes),
                "window": [[str(low), str(high)] for low, high in picture.window],
                "handle": [_near(x, (left, right)), _near(y, (bottom, top))],
            }
        case PoleMap():
            samples = list(result.fields.get("sample_points", []))
            low, high = picture.values
            return found | {
                "kind": "locus",
                "window": [[str(a), str(b)] for a, b in picture.window],
                "values": [str(low), str(high)],
                "handle": [_sample(samples, parameters[0], (low, high))],
            }
        case LinePicture():
            low, high = picture.window
            inside = [place for place, kind in picture.marks if kind == "stable"]
            return found | {
                "kind": "line",
                "window": [[str(low), str(high)]],
                "values": [str(low), str(high)],
                "handle": [_near((inside or [(low + high) / 2])[0], (low, high))],
            }
    return found


def _sample(samples: list[Any], name: str, interval: tuple[Fraction, Fraction]) -> str:
    values = [Fraction(str(sample[name])) for sample in samples if isinstance(sample, dict) and name in sample]
    return _near((values or [(interval[0] + interval[1]) / 2])[0], interval)


def _near(value: Fraction, interval: tuple[Fraction, Fraction]) -> str:
    """Return a short number near a value, on a grid of twentieths where the window is wide enough."""
    width = interval[1] - interval[0]
    step = Fraction(1, 20)
    while step * 40 > width:
        step /= 10
    return str(round(value / step) * step)
