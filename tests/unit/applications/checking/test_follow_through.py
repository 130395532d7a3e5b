"""Follow-through outside gains: a later part that is rightly computed from a wrong earlier one earns its credit."""

from __future__ import annotations

from symobs.applications.checking import Checked
from tests.kit import tabled
from tests.unit.applications.checking.test_equations_of_tasks import EQUATIONS


@tabled
def test_a_later_part_follows_from_a_wrong_one(problem: str, answer: str, expected: dict[str, str]) -> None:
    report = Checked.of(EQUATIONS[problem]["problem"]).report(answer)
    found = {part.part.partition(".")[2]: part for part in report.parts if part.verdict != "missing"}
    assert {name: part.verdict for name, part in found.items()} == expected
    assert all(part.credit == 1 for part in found.values() if part.verdict == "follows" and part.weight)
