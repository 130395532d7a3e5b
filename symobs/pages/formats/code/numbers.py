"""The answers of a document alone: exact, or as doubles."""

from __future__ import annotations

from collections import Counter
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import symbols_in
from symobs.exact.floating.doubles import nearest_double
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, UsageError
from symobs.tasks.result.control_systems import require_numbers
from symobs.tasks.result.conversions import to_json
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from symobs.tasks.result import Document, Result


class Answer(NamedTuple):
    """An answer of a task; `value` is None where it does not exist."""

    task: str
    name: str
    value: Any


def chosen_answers(document: Document) -> list[Answer]:
    """Return the requested answers in the document's convention; raises `UsageError` for unknown names.

    Where several results have a name, it is that of each of them.
    """
    every = [answer for result in document.results for answer in _answers(result, document)]
    known = dict.fromkeys(answer.name for answer in every)
    for name in document.printed:
        if name not in known:
            near = get_close_matches(name, known, 1)
            named = dict.fromkeys(answer.name for answer in every if answer.value is not None)
            repair = f"did you mean {near[0]}?" if near else f"use {', '.join(named)}"
            raise UsageError(f"there is no answer {shown(name, 40)}", where="--print", repair=repair)
    printed = dict.fromkeys(document.printed)
    return [answer for name in printed for answer in every if answer.name == name]


def _answers(result: Result, document: Document) -> list[Answer]:
    """Return what --print may name: the fields of a result, its verdict, and its conditions."""
    fields = ResultInConvention(result, document.convention).fields
    named = {**fields, "verdict": result.verdict, "conditions": result.holds_where}
    return [Answer(result.task, name, value) for name, value in named.items()]


def _told_apart(answers: list[Answer], mark: str) -> list[Answer]:
    """Return the answers, those of equal names named after their tasks, too."""
    number = Counter(answer.name for answer in answers)
    return [
        answer._replace(name=f"{answer.task}{mark}{answer.name}") if number[answer.name] > 1 else answer
        for answer in answers
    ]


def exact_answers(document: Document) -> str:
    """Return the answers as exact texts, NAME = VALUE; of one that does not exist the verdict and the fixed modes."""
    verdicts = {}
    for result in document.results:
        fixed = result.fields.get("fixed_modes")
        verdicts[result.task] = result.verdict + (f", fixed_modes = {_text(fixed)}" if fixed else "")
    return "".join(
        f"{answer.name} = {_text(answer.value)}\n"
        if answer.value is not None
        else f"{answer.name}: none, verdict = {verdicts[answer.task]}\n"
        for answer in _told_apart(chosen_answers(document), ".")
    )


def _text(value: Any) -> str:
    if isinstance(value, Matrix):
        return str(value)
    plain = to_json(value)
    return plain if isinstance(plain, str) else str(plain).replace("'", "")


def number_rows(document: Document, wanted: str) -> dict[str, list[list[str]]]:
    """Return the rows of the requested numeric answers, in the shortest decimals of their doubles.

    Raises `InputError` where one that is asked for has letters without a value, and where none is made of numbers;
    `UsageError` where one named is no number.
    """
    variables = {result.plant.variable for result in document.results} | {"t"}
    if document.printed:
        found = [answer for answer in chosen_answers(document) if answer.value is not None]
        for _, name, value in found:
            if not _is_table(value) or symbols_in(_matrix(value)) & variables:
                message = f"{name} is not made of numbers"
                raise UsageError(message, where="--print", repair="leave --format out, or write --format text")
    else:
        found = [Answer(r.task, *field) for r in document.results for field in r.fields.items() if _is_table(field[1])]
        inside = [symbols_in(_matrix(answer.value)) & variables for answer in found]
        left_out = [answer.name for answer, letters in zip(found, inside, strict=True) if letters]
        found = [answer for answer, letters in zip(found, inside, strict=True) if not letters]
        if not found:
            listed = f"{', '.join(left_out)} contain{'s' if len(left_out) == 1 else ''}"
            said = f"{listed} {' and '.join(sorted(set().union(*inside)))}" if left_out else "no answer is made of them"
            repair = "write --format text for exact expressions"
            raise InputError(f"{wanted} needs numbers, and {said}", where="--format", repair=repair)
    tables = {answer.name: _matrix(answer.value) for answer in _told_apart(found, "_")}
    require_numbers(tables.values(), wanted)
    return {
        name: [[repr(nearest_double(entry)) for entry in row] for row in table.rows] for name, table in tables.items()
    }


def _is_table(value: Any) -> bool:
    return isinstance(value, (Matrix, Scalar)) or (isinstance(value, int) and not isinstance(value, bool))


def _matrix(value: Any) -> Matrix:
    return value if isinstance(value, Matrix) else Matrix.of([[Scalar.of(value)]])
