"""The audit of the five sources: every erratum that concerns a value, a size or an equation, and no false alarm.

What is right, and why, was written down by hand from the list of errata; the audit has to say the same.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from symobs.applications.audit import audit
from symobs.problem import read
from tests.kit import tables
from tests.support.tools.command_line import EXAMPLES

if TYPE_CHECKING:
    from symobs.applications.audit import Audited, Finding

PRINTED = [path for path in EXAMPLES if "[[printed]]" in path.read_text("utf-8")]

# Erratum → (right equations, one word of the reason for each).  An empty equation: nothing of these sizes is right.
MATHEMATICAL = tables(Path(__file__))["mathematical"]
# Slips of notation and caveats that show as a wrong equation too.
OTHERS = tables(Path(__file__))["others"]
EXPECTED = MATHEMATICAL | OTHERS


@cache
def audited() -> tuple[Audited, ...]:
    return tuple(audit(read(path.read_text("utf-8"))) for path in PRINTED)


def found(erratum: str) -> list[Finding]:
    return [each for one in audited() for each in one.findings if each.erratum == erratum]


@pytest.mark.slow
@pytest.mark.parametrize("erratum", EXPECTED)
def test_an_erratum_is_found_with_what_is_right_and_why(erratum: str) -> None:
    assert {each.right for each in found(erratum)} == {right for right, _ in EXPECTED[erratum]}
    for right, reason in EXPECTED[erratum]:
        assert [each for each in found(erratum) if each.right == right and reason in each.reason]


@pytest.mark.slow
def test_what_is_printed_right_is_not_reported() -> None:
    assert {each.erratum for one in audited() for each in one.findings} == set(EXPECTED)


def test_there_is_much_that_is_printed_right() -> None:
    wrong = sum(len(one.findings) for one in audited())
    assert wrong == sum(map(len, EXPECTED.values()))
    assert sum(one.checked for one in audited()) - wrong >= 100


def test_the_truncated_gain_is_told_entry_by_entry() -> None:
    (gain,), (matrix,) = found("E2.4"), found("E2.5")
    assert gain.reason.count("truncated") == 2  # -80539/49 = -1643.65..., -832340/49 = -16986.5...
    assert "entry (1, 1) is -1.644e+003, not -1.643e+003" in gain.reason
    assert "entry (3, 3) is -6e+001, not -600e+001" in matrix.reason


def test_the_last_equation_of_the_unit_mass_lacks_the_measurement() -> None:
    (equation,) = found("E1.13")
    assert "the term [3; 2] y is missing" in equation.reason
    assert "in the coefficient of u entry (1, 1) is 0, not 3" in equation.reason
