"""The answers of a document alone: exact, or as doubles."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import symbols_in
from symobs.exact.floating.doubles import nearest_double
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, UsageError
from symobs.tasks.result.control_systems import require_numbers
from symobs.tasks.result.conversions import to_json
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from symobs.tasks.result import Document


def chosen_answers(document: Document) -> dict[str, Any]:
    """Return the requested answers by name, in the document's convention; raises `UsageError` for unknown names."""
    views = [ResultInConvention(result, document.convention) for result in document.results]
    known = {name: value for view in reversed(views) for name, value in view.fields.items() if value is not None}
    for name in document.printed:
        if name not in known:
            near = get_close_matches(name, known, 1)
            repair = f"did you mean {near[0]}?" if near else f"use {', '.join(known)}"
            raise UsageError(f"there is no answer {shown(name, 40)}", where="--print", repair=repair)
    return {name: known[name] for name in document.printed}


def exact_answers(document: Document) -> str:
    """Return the answers as exact texts, NAME = VALUE."""
    found = chosen_answers(document)
    return "".join(
        f"{name} = {value if isinstance(value, Matrix) else _text(value)}\n" for name, value in found.items()
    )


def _text(value: Any) -> str:
    plain = to_json(value)
    return plain if isinstance(plain, str) else str(plain).replace("'", "")


def number_rows(document: Document, wanted: str) -> dict[str, list[list[str]]]:
    """Return the rows of the requested numeric answers, in the shortest decimals of their doubles.

    Raises `InputError` where one that is asked for has letters without a value, and where none is made of numbers;
    `UsageError` where one named is no number.
    """
    variables = {result.plant.variable for result in document.results} | {"t"}
    if document.printed:
        found = chosen_answers(document)
        for name, value in found.items():
            if not _is_table(value) or symbols_in(_matrix(value)) & variables:
                message = f"{name} is not made of numbers"
                raise UsageError(message, where="--print", repair="leave --format out, or write --format text")
    else:
        found = {
            name: value for r in reversed(document.results) for name, value in r.fields.items() if _is_table(value)
        }
        inside = {name: symbols_in(_matrix(value)) & variables for name, value in found.items()}
        left_out = [name for name, letters in inside.items() if letters]
        found = {name: value for name, value in found.items() if name not in left_out}
        if not found:
            listed = f"{', '.join(left_out)} contain{'s' if len(left_out) == 1 else ''}"
            said = (
                f"{listed} {' and '.join(sorted(set().union(*inside.values())))}"
                if left_out
                else "no answer is made of them"
            )
            repair = "write --format text for exact expressions"
            raise InputError(f"{wanted} needs numbers, and {said}", where="--format", repair=repair)
    tables = {name: _matrix(value) for name, value in found.items()}
    require_numbers(tables.values(), wanted)
    return {
        name: [[repr(nearest_double(entry)) for entry in row] for row in table.rows] for name, table in tables.items()
    }


def _is_table(value: Any) -> bool:
    return isinstance(value, (Matrix, Scalar)) or (isinstance(value, int) and not isinstance(value, bool))


def _matrix(value: Any) -> Matrix:
    return value if isinstance(value, Matrix) else Matrix.of([[Scalar.of(value)]])
