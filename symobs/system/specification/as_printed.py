"""A specification as books and lectures print it, in the notation of problem files.

Each rewriting is of what has one meaning: the letter of what is given anyway (x(0) = …, T = …), units, words, weights made of
the identity or of the plant's matrices.  What may have two meanings is left as it is, to be refused with its place.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from symobs.formula.expression import without_latex, without_pole_names
from symobs.system.reading import read_scalar

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system import StateSpace

#: The words of books for what there is, by keyword.
_OF_BOOKS = {
    "kind": {"diagonal": "modal", "jordan": "modal", "companion": "controllable", "controller": "controllable"}
    | {"observer": "observable"},
    "observer": {"reduced": "minimal", "reduced order": "minimal", "full order": "full", "minimal order": "minimal"},
    "method": {"bass gura": "canonical_form", "ackermann": "ackermann"},
}
_FORM = re.compile(r"( canonical)? form$")
_NAME = r"[^\W\d]\w{0,30}(?:_\{\w{1,9}\})?"
#: "x(0) = …", "T = …"; several samples, "y(0) = 1, y(1) = 3".
_LEFT = re.compile(rf"\s*{_NAME}\s*(?:\(\s*[\w.]*\s*\))?\s*=(?!=)")
_SAMPLE = re.compile(rf"(?:^|(?<=[,;\[]))\s*{_NAME}\s*\(\s*([0-9]+)\s*\)\s*=(?!=)")
_UNIT = re.compile(r"(?<=[0-9.)])\s*(?:s|sec|seconds?|rad/s(?:ec)?)\s*$")
_MARGIN = re.compile(r"\s*Re\s*\(?\s*(?:s|λ|lambda)\s*\)?\s*(?:<|<=|≤)\s*[-−]\s*")
#: The unit step of books, 1(t): a product of 1 and t is written by nobody so.
_STEP = re.compile(r"(?<![\w.])1\s*\(\s*[tk]\s*\)")
_IDENTITY = re.compile(r"(?<![A-Za-z_])I(?:_(?:n|m|p|[0-9]{1,2})|[₀-₉ₙ]{1,2})?\s*$")
_TURNED = r"(?:'|\^\{?T\}?|ᵀ)"
#: C'C and B B' at the end of a text, behind a factor; a letter alone.
_SQUARE = re.compile(rf"(?<!\w)([A-D])({_TURNED})?\s*[*·]?\s*\1({_TURNED})?\s*$")
_LETTER = re.compile(r"\s*([A-D])\s*")


def as_typed(name: str, kind: str, value: Any, plant: StateSpace | None) -> Any:
    """Return the value of a keyword in the notation of problem files, as it is where it is no text."""
    if isinstance(value, Mapping) and kind == "Poles":
        return {key: _without_unit(part) if isinstance(part, str) else part for key, part in value.items()}
    if not isinstance(value, str):
        return value
    if kind == "Name":
        return _meant_word(name, value)
    if len(value) > _LONGEST:
        return value
    value = without_latex(without_pole_names(value) if kind == "Poles" else value)
    match kind:
        case "Poles":
            return ", ".join(map(_without_unit, value.split(","))) if "=" in value else value
        case "Intensity" | "MatrixText" | "GainText":
            return _of_letters(_LEFT.sub("", value, count=1), kind, plant)
        case "SignalText" | "TimeFunctions":
            places = [int(place) for place in _SAMPLE.findall(value)]
            value = _SAMPLE.sub("", value) if places == list(range(len(places))) else value
            return _STEP.sub("1", _LEFT.sub("", value, count=1))
        case "Horizon" | "Quantity":
            return _without_unit(_LEFT.sub("", _MARGIN.sub("", value, count=1) if name == "margin" else value, count=1))
        case _:
            return value


#: Longer texts are no lines of a book.
_LONGEST = 2_000


def _meant_word(keyword: str, word: str) -> str:
    """Return the word of a keyword that one of a book stands for, any other as it is."""
    spoken = _FORM.sub("", re.sub(r"[ _-]+", " ", word.strip().lower()))
    known = _OF_BOOKS.get(keyword, {})
    return known.get(spoken, spoken if keyword == "kind" and spoken != word else word)


def _without_unit(value: str) -> str:
    """Return a number without the seconds or radians per second behind it."""
    return _UNIT.sub("", value)


def _of_letters(value: str, kind: str, plant: StateSpace | None) -> Any:
    """Return a matrix that is written by I, or by matrices of the plant, such as C'C; a multiple of I as its factor."""
    declared = plant.symbols.signs if plant is not None else {}
    multiple = _IDENTITY.search(value) if kind == "Intensity" and "I" not in declared and "[" not in value else None
    if multiple is not None:
        return _factor(value, multiple.start()) or "1"
    if plant is None or not (found := _SQUARE.search(value) or _LETTER.fullmatch(value)) or found[1] in declared:
        return value
    of_plant: Matrix | None = getattr(plant.matrices, found[1])
    if of_plant is None or not of_plant.shape[1]:
        return value
    if found.re is _LETTER:
        return _written(of_plant)
    factor = _factor(value, found.start())
    if bool(found[2]) == bool(found[3]) or "[" in factor:
        return value
    product = of_plant.T @ of_plant if found[2] else of_plant @ of_plant.T
    return _written(product * read_scalar(factor, plant.symbols, "specification") if factor else product)


def _factor(value: str, end: int) -> str:
    """Return what stands before the last part of a product."""
    return value[:end].rstrip(" *·")


def _written(value: Matrix) -> str:
    return f"[{'; '.join(', '.join(map(str, row)) for row in value.rows)}]"
