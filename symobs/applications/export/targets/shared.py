"""What several platforms share: the files of an export, the grader as one module, refusals."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.export.questions import placed
from symobs.applications.grader import claims, values
from symobs.ground.errors import InputError, ProblemErrors

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.exact import Scalar

    #: File names, relative to the target, and contents.
    Files = dict[str, str | bytes]

#: The grader that goes with a question; another version of it would have another name, since courses keep modules.
CLAIMS = "symobs_claims_1.py"
_BEGIN = "# -- matrices of numbers"
#: Integers up to this size are exact in double precision, and so are their sums and products on the way.
MOST_EXACT = 10**15


def claims_module() -> str:
    """Return the grader as one module of the standard library: its values, then its claims."""
    head, tail = (Path(str(module.__file__)).read_text("utf-8") for module in (values, claims))
    return f"{head.rstrip()}\n\n\n{tail[tail.index(_BEGIN) :]}"


def as_json(data: Any) -> str:
    """Return data as JSON that is the same everywhere."""
    return json.dumps(data, indent=1, sort_keys=True, ensure_ascii=True) + "\n"


def refuse(exercises: Sequence[ExerciseSet], why: Callable[[Exercise, ExportedPart], tuple[str, str] | None]) -> None:
    """Raise `ProblemErrors` with every part that a platform cannot hold: `why` says the reason and the repair.

    Of the variants of one question the first that is refused for a reason stands for all.
    """
    found: dict[tuple[int, str, str, str], InputError] = {}
    for number, exercise in ((number, each) for number, group in enumerate(exercises) for each in group.variants):
        for part in exercise.parts:
            told = why(exercise, part)
            if told is not None:
                where = placed(exercise.file, part.part)
                found.setdefault((number, part.part, *told), InputError(told[0], where=where, repair=told[1]))
    if found:
        raise ProblemErrors(tuple(found.values()))


def terminating(value: Scalar) -> str | None:
    """Return a number as an integer or a decimal that ends, None where it does not end or is too long to be exact."""
    number = value.fraction()
    places, below = 0, number.denominator
    while below % 10 == 0 or below % 5 == 0 or below % 2 == 0:
        below, places = (below // 10 if below % 10 == 0 else below // 5 if below % 5 == 0 else below // 2), places + 1
    if below != 1 or abs(number) * 10**places >= MOST_EXACT:
        return None
    digits = str(abs(number.numerator) * 10**places // number.denominator).rjust(places + 1, "0")
    text = f"{digits[:-places]}.{digits[-places:]}" if places else digits
    return f"-{text}" if number < 0 else text


def unique_number(part: ExportedPart) -> tuple[str, str] | None:
    """Return why a platform that compares numbers, cell by cell, cannot hold a part."""
    if part.kind == "word":
        return None
    if part.free:
        plural = "s" if part.free > 1 else ""
        why = f"it is not unique here: {part.free} free parameter{plural}"
        return why, "export to stack, prairielearn or ipynb"
    if part.numbers is None:
        why = "its entries hold symbols" if part.data["symbolic"] else "an expression is no number"
        return why, "export to stack, prairielearn or ipynb, or leave it out with --asked"
    if any(terminating(entry) is None for row in part.numbers for entry in row):
        return "a fraction is no number of this platform", "take variants with integer answers"
    return None
