"""The parts of an answer: what each task asks for, and which fields are inputs of others."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from symobs.tasks.result import Result

#: Letters that a derivation keeps for the plant, also where an answer has parts of these names.
OF_THE_PLANT = ("A", "B", "C", "D")


def asked_of(result: Result) -> tuple[str, ...]:
    """Return the fields that a task asks for; the verdict where there is nothing else to be found."""
    there = tuple(name for name in result.answered_by if exists(result, name))
    return there or ("verdict",)


def field_called(result: Result, name: str) -> str:
    """Return the field that a page writes x(t), y(t) or exp(A t); another name as it is."""
    return result.functions_of_time.get(re.sub(r"[\s*]", "", name), name)


def is_of_time(results: Iterable[Result], name: str) -> bool:
    """Return whether a name is that of a function of time, such as x(t), in one of the results."""
    return any(field_called(result, name) != name for result in results)


def exists(result: Result, name: str) -> bool:
    """Return whether a field has a value, or is the verdict."""
    return name in {"verdict", "conditions"} or result.fields.get(name) is not None
