"""The page of a root locus names the controller of its loop, and none where there is none."""

from __future__ import annotations

import pytest

from symobs.problem import read
from symobs.tasks.result import render

LOOP = 'task = "root_locus"\nlanguage = "{language}"\n[plant]\nA = "[0 1; -2 -2]"\nB = "[0; 1]"\nC = "[1 0]"\n{more}'
SAID = {"en": "The loop is closed by the gain k.", "de": "Den Kreis schließt die Verstärkung k."}


@pytest.mark.parametrize("language", SAID)
def test_a_page_has_a_controller_where_one_is_given(language: str) -> None:
    def page(more: str) -> str:
        problem = read(LOOP.format(language=language, more=more))
        return " ".join(str(render(problem.document(problem.solve()), "text")).split())

    alone = page("")
    assert "F(s)" not in alone
    assert SAID[language] in alone
    both = page('[specification]\ncontroller = "2/(s+3)"\n')
    assert "F(s) = 2/(s + 3)" in both
    assert SAID[language] not in both
