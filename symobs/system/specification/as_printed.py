"""A specification as books and lectures print it, in the notation of problem files.

Each rewriting is of what has one meaning: the letter of what is given anyway (x(0) = …, T = …), units, words, weights made of
the identity or of the plant's matrices.  What may have two meanings is left as it is, to be refused with its place.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from symobs.formula.expression import right_side, without_latex, without_pole_names
from symobs.ground.errors import InputError
from symobs.system.reading import read_scalar
from symobs.system.specification.keywords import CHOICES

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system import StateSpace

#: The words of books for what there is, by keyword.
_OF_BOOKS = {
    "kind": {"diagonal": "modal", "jordan": "modal", "controller": "controllable", "observer": "observable"},
    "observer": {"reduced": "minimal", "reduced order": "minimal", "full order": "full", "minimal order": "minimal"},
    "method": {"bass gura": "canonical_form", "ackermann": "ackermann"},
}
_FORM = re.compile(r"( canonical)? form$")
#: The left side that a keyword has anyway; of any other one the text says something else.
_INSTANT = r"\(\s{0,9}%s\s{0,9}\)"
_LEFT = {
    "initial": rf"x(?:_?\{{?0\}}?|{_INSTANT % '(?:0|t_?0)'})",
    "final": rf"x(?:_[fT1]|{_INSTANT % '(?!0)[A-Za-z0-9_.]{1,9}'})",
    "output": rf"y(?:{_INSTANT % '[tk]'})?",
    "input": rf"u(?:{_INSTANT % '[tk]'})?",
    "horizon": "T|t_?[1f]",
    "sampling_period": "T(?:_?[sa])?|h|Δt",
    "at_time": "t|T",
} | {letter: letter for letter in ("Q", "R", "N", "W", "V", "G", "E", "S", "P", "K", "L")}
#: Samples by their instants: "y(0) = 1, y(1) = 3".
_SAMPLE = re.compile(r"(?:^|(?<=[,;\[]))\s{0,9}([uy])\(\s{0,9}([0-9]{1,3})\s{0,9}\)\s{0,9}=(?!=)")
#: What matrices of the plant may make.
_OF_PLANT = {"Q", "R", "W", "V", "G", "E", "N"}
_UNIT = re.compile(r"(?<=[0-9.)])\s{0,9}(?:s|sec|seconds?|rad/s(?:ec)?)\s{0,9}$")
_MARGIN = re.compile(r"\s*Re\s*\(?\s*(?:s|λ|lambda)\s*\)?\s*(?:<|<=|≤)\s*[-−]\s*")
#: The unit step of books, 1(t): a product of 1 and t is written by nobody so.
_STEP = re.compile(r"(?<![\w.])1\s?\(\s?[tk]\s?\)")
_LATER_STEP = re.compile(r"(?<![\w.])1\s?\(\s?[tk]\s?[-+−]")
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
        case "PolynomialText" | "TransferFunctionText":
            return right_side(value)
        case "Intensity" | "MatrixText" | "GainText":
            return _of_letters(name, _without_left(name, value), kind, plant)
        case "SignalText" | "TimeFunctions":
            samples = _SAMPLE.findall(value)
            if samples and samples == [
                (name[:1].replace("o", "y").replace("i", "u"), str(k)) for k in range(len(samples))
            ]:
                value = _SAMPLE.sub("", value)
            if _LATER_STEP.search(value):
                message = "a step that begins later is no sum of exponentials"
                raise InputError(
                    message, where=f"specification.{name}", repair="solve it piece by piece, from each step on"
                )
            return _STEP.sub("1", _without_left(name, value))
        case "Horizon" | "Quantity":
            return _without_unit(_without_left(name, _MARGIN.sub("", value, count=1) if name == "margin" else value))
        case _:
            return value


#: Longer texts are no lines of a book.
_LONGEST = 2_000


def _meant_word(keyword: str, word: str) -> str:
    """Return the word of a keyword that one of a book stands for, any other as it is."""
    spoken = _FORM.sub("", re.sub(r"[ _-]+", " ", word.strip().lower()))
    known = _OF_BOOKS.get(keyword, {})
    return known.get(spoken, spoken if spoken in CHOICES.get(keyword, ()) else word)


def _without_left(name: str, value: str) -> str:
    """Return the right side of x(0) = …, T = … and the like."""
    found = re.match(rf"\s{{0,9}}(?:{_LEFT[name]})\s{{0,9}}=(?!=)", value) if name in _LEFT else None
    return value[found.end() :] if found else value


def _without_unit(value: str) -> str:
    """Return a number without the seconds or radians per second behind it."""
    return _UNIT.sub("", value)


def _of_letters(name: str, value: str, kind: str, plant: StateSpace | None) -> Any:
    """Return a matrix that is written by I, or by matrices of the plant, such as C'C; a multiple of I as its factor."""
    declared = plant.symbols.signs if plant is not None else {}
    multiple = _IDENTITY.search(value) if kind == "Intensity" and "I" not in declared and "[" not in value else None
    if multiple is not None:
        factor = _factor(value, multiple.start())
        return value if factor is None else factor or "1"
    if (
        plant is None
        or name not in _OF_PLANT
        or not (found := _SQUARE.search(value) or _LETTER.fullmatch(value))
        or found[1] in declared
    ):
        return value
    of_plant: Matrix | None = getattr(plant.matrices, found[1])
    if of_plant is None or not of_plant.shape[1]:
        return value
    if found.re is _LETTER:
        return _written(of_plant)
    factor = _factor(value, found.start())
    if bool(found[2]) == bool(found[3]) or factor is None:
        return value
    product = of_plant.T @ of_plant if found[2] else of_plant @ of_plant.T
    return _written(product * read_scalar(factor, plant.symbols, "specification") if factor else product)


def _factor(value: str, end: int) -> str | None:
    """Return what stands before the last part of a product; None where that is no product."""
    before = value[:end].rstrip(" *·")
    return None if re.search(r"[-+−/\[]\s*$|(?<=[^\s*/^(])\s*[-+−]|\[", before) else before


def _written(value: Matrix) -> str:
    return f"[{'; '.join(', '.join(map(str, row)) for row in value.rows)}]"
