"""Landmarks of root loci as books and students tell them; the numbers are those of Ogata's examples and of SymPy's roots."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs.applications.checking import check
from symobs.problem import validate
from symobs.problem.expect import met

THIRD = "1/(s*(s+1)*(s+2))"
FOURTH = "1/(s*(s+4)*(s^2+4*s+20))"


def locus(loop: str) -> Any:
    return symobs.root_locus(symobs.StateSpace.from_transfer_function(loop))


@pytest.mark.parametrize(
    ("loop", "name", "expected", "is_met"),
    [
        (THIRD, "breakaway", [{"s": "-0.423", "k": "0.385"}], True),
        (THIRD, "breakaway", ["-1 + 1/sqrt(3)"], True),
        (THIRD, "breakaway", ["-0.43"], False),
        (THIRD, "breakaway", [], False),
        (THIRD, "breakaway", [{"s": "-0.423", "k": "0.39"}], False),
        (THIRD, "crossings", [{"k": 6, "omega": "sqrt(2)"}], True),
        (THIRD, "crossings", [{"s": "-1.414j", "K": "6"}], True),
        (THIRD, "crossings", [{"k": 5, "omega": "sqrt(2)"}], False),
        (FOURTH, "breakaway", ["-2+2.45j", "-2"], True),
        (FOURTH, "breakaway", ["-2", "-2+2.45j", "-2-2.45j"], True),
        (FOURTH, "breakaway", ["-2"], False),
        (FOURTH, "departure", ["270"], True),
        (FOURTH, "departure", [{"s": "-2-4j", "angle": "90"}], True),
        (FOURTH, "departure", [{"s": "-2-4j", "angle": "-90"}], False),
        ("(s+3)/(s*(s+1)*(s+2)*(s+4))", "crossings", [{"k": "9.65", "omega": "1.59"}], True),
        ("(s+1)/(s^2*(s+12))", "breakaway", ["-2.314", "-5.186"], True),
    ],
)
def test_landmarks_are_held_against_a_list(loop: str, name: str, expected: Any, is_met: bool) -> None:  # noqa: FBT001
    assert met(locus(loop), name, expected, name) is is_met


@pytest.mark.parametrize(
    ("lines", "right"),
    [
        ("breakaway points: s = -0.423 at k = 0.385\ncrossings: ±1.414i at k = 6\nk < 6", 3),
        ("breakaway = -0.4226\ncrossings = [{k = 6, omega = sqrt(2)}]", 2),
        ("Verzweigungspunkte: s = -0.423\nSchnittpunkte mit: k = 6", 1),
        ("breakaway = -0.5\ncrossings: k = 6, omega = 2\nk < 6", 1),
    ],
)
def test_landmarks_of_a_student_are_read(lines: str, right: int) -> None:
    data = {"task": "root_locus", "plant": {"transfer_function": THIRD}, "symbols": {"k": "positive"}}
    report = check(validate(data), lines)
    assert sum(part.verdict == "right" for part in report.parts) == right
