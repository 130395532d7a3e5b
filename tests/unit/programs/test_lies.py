"""A slice of the lies about random designs: `python -m tests.programs.lies --designs 1000` tries more of them."""

from __future__ import annotations

import pytest

from tests.programs.lies import ASKED, KINDS, drawn, tried
from tests.support.tampering.lies import Count

pytestmark = pytest.mark.slow


def test_no_lie_about_a_random_design_survives() -> None:
    answers, lines, designs = Count(), Count(), 0
    for _, of_answers, of_lines in tried(range(40), most_lines=25):
        designs += 1
        for count, more in ((answers, of_answers), (lines, of_lines)):
            count.tried += more.tried
            count.rejected += more.rejected
            count.true += more.true
            count.lies += more.lies
    assert designs >= 35
    for count in (answers, lines):
        assert count.lies == []
        assert count.tried == count.rejected + count.true
        assert count.tried > 500
        assert count.rejected > 0.8 * count.tried


def test_designs_are_of_all_kinds_and_the_same_in_every_run() -> None:
    designs = [drawn(number) for number in range(len(KINDS) * len(ASKED))]
    assert {design["task"] for design in designs} == set(ASKED)
    assert drawn(5) == designs[5]
