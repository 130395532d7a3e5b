"""Lines on the way to a linearisation are held against the equations of motion, whichever of their forms is written."""

from __future__ import annotations

from symobs.applications.checking import check
from tests.kit import tabled
from tests.support.paths import ROOT

CRANE = str(ROOT / "worked_examples" / "trolley_with_load.toml")


@tabled
def test_a_line_of_motion_is_true_or_false(line: str, verdict: str, reason: str) -> None:
    report = check(CRANE, line)
    assert [(found.verdict, found.reason) for found in report.lines] == [(verdict, reason)]
    assert {part.verdict for part in report.parts} == {"missing"}


def test_other_lines_keep_their_places() -> None:
    report = check(CRANE, "theta'' = -(x''*cos(theta) + g*sin(theta))/l\n\nA = [0 1; 0 0]\nrank C = 4")
    assert next((line.where, line.verdict) for line in report.lines) == ("line 1", "true")
    assert {line.where for line in report.lines} >= {"line 1", "line 3"}
