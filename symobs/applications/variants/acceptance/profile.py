"""The profile of a solved problem: what a student has to work out, read off the values of its derivation."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.formula.tree.nodes import Literal
from symobs.proof.derivation.steps import CaseStep, Define, Equal, Given, Section, Tabulate

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from symobs.proof.derivation import Derivation
    from symobs.tasks.result import Result

_SIGN, _BAR = 2, 3
UNLIKE = "another structure"


def profile(results: Iterable[Result], derivations: Iterable[Derivation]) -> dict[str, Any]:
    """Return structure, load and peak of solved problems.

    load   the sum over all numbers of max(1, digits) + 2 for a sign + 3 for a fraction bar
    peak   the digits of the longest number
    """
    results, derivations = tuple(results), tuple(derivations)
    values = [value for each in derivations for value in _values(each.steps)]
    numbers = [number for value in values for number in numbers_of(value)]
    steps = [_kind(step) for each in derivations for step in _each_step(each.steps)]
    return {
        "load": sum(_load(number) for number in numbers),
        "peak": max((_longest(value) for value in values), default=0),
        "fractions": sum(number.denominator != 1 for number in numbers),
        "lines": sum(len(_relations(step)) for each in derivations for step in _each_step(each.steps)),
        "structure": {
            "tasks": [[result.task, result.method, result.verdict, len(result.case_tree)] for result in results],
            "steps": steps,
        },
    }


def _longest(value: object) -> int:
    """Return the digits of the longest number of a value, which may stand over one common denominator or be reduced."""
    if isinstance(value, Matrix):
        return max((_longest(entry) for entry in value.entries), default=0)
    if not isinstance(value, Scalar):
        return 0
    parts = (value.numerator, value.denominator)
    return max((len(str(abs(factor))) for part in parts for factor, _ in part.terms()), default=1)


def _load(number: Fraction) -> int:
    digits = len(str(abs(number.numerator))) + (len(str(number.denominator)) if number.denominator != 1 else 0)
    return digits + _SIGN * (number < 0) + _BAR * (number.denominator != 1)


def numbers_of(value: object) -> Iterator[Fraction]:
    """Yield the numbers in which a value is written: entries, coefficients; the bar of a quotient is no fraction."""
    if isinstance(value, Matrix):
        for entry in value.entries:
            yield from numbers_of(entry)
    elif isinstance(value, Scalar):
        top, bottom = value.numerator, value.denominator
        if not bottom.names:  # of names it is a quotient, whose coefficients are whole
            constant = bottom.fraction()
            yield from (Fraction(factor) / constant for factor, _ in top.terms()) if top.terms() else (Fraction(0),)
            return
        for part in (top, bottom):
            yield from (Fraction(factor) for factor, _ in part.terms())


def _values(node: object) -> Iterator[object]:
    """Yield every value that is written out in steps."""
    if isinstance(node, Literal):
        yield node.value
    elif isinstance(node, (tuple, list)):
        for each in node:
            yield from _values(each)
    elif isinstance(node, Tabulate):
        yield from (entry for row in node.table.rows for entry in row.entries)
    elif is_dataclass(node) and not isinstance(node, type) and not getattr(node, "silent", False):
        for part in fields(node):
            yield from _values(getattr(node, part.name))


def _each_step(steps: Iterable[Any]) -> Iterator[Any]:
    for step in steps:
        yield step
        if isinstance(step, (Section, CaseStep)):
            yield from _each_step(step.steps)


def _relations(step: Any) -> tuple[Any, ...]:
    if isinstance(step, (Given, Equal)):
        return () if getattr(step, "silent", False) else step.relations
    return (step.relation,) if isinstance(step, Define) and not step.silent else ()


def _kind(step: Any) -> str:
    title = step.title.key if isinstance(step, Section) else ""
    return f"{type(step).__name__} {title}".strip()


# -- what is alike ----------------------------------------------------------------------------------------------------


def unlike(found: Mapping[str, Any], other: Mapping[str, Any], load: Fraction, *, same_peak: bool) -> str | None:
    """Return in what a profile differs from the one it is to be like, None where it is like it."""
    if found["structure"] != other["structure"]:
        return UNLIKE
    if abs(found["load"] - other["load"]) > load * other["load"]:
        return "another load"
    if found["peak"] > other["peak"] + (0 if same_peak else 1) or (same_peak and found["peak"] != other["peak"]):
        return "another longest number"
    return None
