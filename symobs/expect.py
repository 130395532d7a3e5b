"""Holding results against expected answers: compared as mathematics, never as text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from symobs.conditions import Condition
from symobs.errors import CertificateRejected, InputError, ProblemErrors, SymobsError
from symobs.exact import Complex, Factored, Matrix, Root, Scalar, rank, root_of_pole
from symobs.expression import parse_matrix, parse_poles, parse_scalar
from symobs.expression.source import shown

if TYPE_CHECKING:
    from symobs.method import Result

_RELATION = re.compile(r"^(.*?)(!=|==|>=|<=|>|<)(.*)$", re.DOTALL)
_MOST_SHOWN = 200


def mismatches(results: Sequence[Result], expect: Mapping[str, Any]) -> list[str]:
    """Return one line for each expected answer that is not met; raises `ProblemErrors` for what cannot be read.

    `[expect.TASK]` belongs to one task; other keys belong to every task that has the field, and at least one must.
    """
    lines: list[str] = []
    errors: list[SymobsError] = []
    for result in results:
        expected = {key: (entry, f"expect.{key}") for key, entry in expect.items() if key in _available(result)}
        own = expect.get(result.task)
        if isinstance(own, Mapping):
            expected |= {key: (entry, f"expect.{result.task}.{key}") for key, entry in own.items()}
        lines += _held_against(result, expected, errors)
    known = sorted({name for result in results for name in _available(result)})
    for key in expect.keys() - applicable(results, expect).keys():
        errors.append(_no_field(f"expect.{shown(key, 40)}", "no task of this file", known))
    if errors:
        raise ProblemErrors(tuple(errors))
    return lines


def applicable(results: Sequence[Result], expect: Mapping[str, Any]) -> dict[str, Any]:
    """Return those expected answers that belong to one of these results."""
    tasks = {result.task for result in results}
    fields = {name for result in results for name in _available(result)}
    return {
        key: entry
        for key, entry in expect.items()
        if key in fields or (key in tasks and isinstance(entry, Mapping))
    }


def _held_against(result: Result, expected: Mapping[str, tuple[Any, str]], errors: list[SymobsError]) -> list[str]:
    """Return the lines for one result; of answers that are not unique, the others are held against the one expected."""
    lines: list[str] = []
    chosen = result
    for name in expected.keys() & result.answer.keys():
        chosen = _with_member(chosen, name, *expected[name])
    for name, (entry, where) in expected.items():
        if name not in _available(result):
            errors.append(_no_field(where, f"the task {result.task}", _available(result)))
            continue
        try:
            if not met(chosen, name, entry, where):
                found = _shown(_found(result, name))
                lines.append(f"{where}: expected {shown(_shown(entry), _MOST_SHOWN)}, found {shown(found, _MOST_SHOWN)}")
        except SymobsError as error:
            errors.append(error)
    return lines


def _no_field(where: str, who: str, known: Sequence[str]) -> InputError:
    return InputError(f"{who} has such a field", where=where, repair=f"known fields are {', '.join(known)}")
