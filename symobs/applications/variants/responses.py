"""What the answers of a class say of variants: whether one of them was harder, or easier, than the others."""

from __future__ import annotations

import json
from fractions import Fraction
from statistics import median
from typing import NamedTuple

from symobs.applications.checking.report.data import decimal
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError

SCHEMA = "symobs-check-summary/1"
#: A mean that is off by more standard errors than these is no accident.
ERRORS = 3
#: So many marks more than variants are needed for the spread of the marks to be known.
FEWEST = 10


class AnsweredVariant(NamedTuple):
    """How a variant was answered: how many have marks, their mean, and how it stands to the others: easier, harder or same."""

    name: str
    students: int
    mean: Fraction
    compared: str = "same"


def responses_of(text: str, where: str) -> tuple[AnsweredVariant, ...]:
    """Return how each variant of a class was answered, from the `summary.json` of `symobs check`.

    A variant with n marks of mean m, N being those of the others, M the median of all means and s² the variance of marks within
    variants, is off where (m − M)² > 9 s² (1/n + 1/N), which fractions decide.  Raises `InputError` where the text is no such
    summary or its marks are too few.
    """
    found = _read(text, where)
    students = sum(count for count, _, _ in found.values())
    if len(found) < 2 or students - len(found) < FEWEST:
        message = f"{students} marks of {len(found)} variants are too few to compare"
        raise InputError(message, where=where, repair=f"{FEWEST} marks more than variants are needed, and two variants")
    usual = median(mean for _, mean, _ in found.values())
    variance = sum((squares for _, _, squares in found.values()), Fraction(0)) / (students - len(found))
    listed = []
    for name, (count, mean, _) in found.items():
        bound = ERRORS**2 * variance * (Fraction(1, count) + Fraction(1, students - count))
        word = "easier" if mean > usual else "harder"
        listed.append(AnsweredVariant(name, count, mean, word if (mean - usual) ** 2 > bound else "same"))
    return tuple(listed)


def _read(text: str, where: str) -> dict[str, tuple[int, Fraction, Fraction]]:
    """Return of each variant its marks: how many, their mean, and the sum of the squared differences from it."""
    found: dict[str, tuple[int, Fraction, Fraction]] = {}
    try:
        data = json.loads(text)
        found = {
            shown(str(name), 40): (int(each["students"]), Fraction(each["mean"]), Fraction(each["squares"]))
            for name, each in data["variants"].items()
        }
        usable = data["schema"] == SCHEMA and all(count > 0 for count, _, _ in found.values())
    except (ValueError, RecursionError, LookupError, TypeError, AttributeError, ZeroDivisionError):
        usable = False
    if not usable:
        repair = "name the summary.json that `symobs check --submissions ... --variants ...` wrote"
        raise InputError("this is no summary of a class", where=where, repair=repair)
    return found


def as_text(listed: tuple[AnsweredVariant, ...]) -> str:
    """Return the table: a line a variant."""
    width = max(len(each.name) for each in listed)
    off = [each for each in listed if each.compared != "same"]
    lines = [
        f"{each.name:<{width}}  {each.students:4} students  {decimal(each.mean):>8} marks"
        + (f"  {each.compared} than the others" if each in off else "")
        for each in listed
    ]
    said = f"{len(off)} of {len(listed)} variants" if off else "no variant"
    verb = "differ" if len(off) > 1 else "differs"
    return "\n".join([*lines, f"{said} {verb} from the others by more than {ERRORS} standard errors", ""])
