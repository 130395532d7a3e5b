"""Notation of books and lectures: what is typed as printed means what is typed for the program."""

from __future__ import annotations

from typing import Any

import pytest

from symobs.ground.errors import ProblemErrors, SymobsError
from symobs.problem.validation import validate
from tests.kit import tabled

PLANT = {"A": "[0 1; -2 -3]", "B": "[0; 1]", "C": "[1 0]"}


def answers(task: str, plant: dict[str, Any], specification: dict[str, Any], symbols: dict[str, str]) -> list[Any]:
    """The answers of a file of one task."""
    file = {"title": "x", "tasks": [task], "symbols": symbols, "plant": plant, "specification": specification}
    return [(result.verdict, dict(result.fields)) for result in validate(file).solve()]


@tabled
def test_what_is_typed_as_printed_means_what_is_typed_plainly(
    task: str, printed: dict[str, Any], plain: dict[str, Any]
) -> None:
    symbols = printed.pop("symbols", {})
    found, expected = (
        answers(task, {**PLANT, **given.pop("plant", {})}, given, dict(symbols)) for given in (printed, plain)
    )
    assert found == expected


@tabled
def test_what_has_two_readings_is_refused(task: str, printed: dict[str, Any], said: str) -> None:
    with pytest.raises((SymobsError, ProblemErrors), match=said):
        answers(task, PLANT | printed.pop("plant", {}), printed, printed.pop("symbols", {}))
