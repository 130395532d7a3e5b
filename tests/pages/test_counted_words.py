"""Sentences about roots say mode or modes, is or are, as there are one or several; sketches are told as they are drawn."""

from __future__ import annotations

import re

from symobs.formula.phrases import PHRASES
from symobs.problem import read


def test_every_choice_of_words_is_one_between_two() -> None:
    for phrase in PHRASES.values():
        assert re.sub(r"<[^<|>]*\|[^<|>]*>", "", phrase).count("<") == 0


def test_a_sketch_in_characters_speaks_of_no_dots_and_dashes() -> None:
    problem = read(
        'task = "stability_region"\n[plant]\nA = "[0 1; -2 -3]"\nC = "[1 0]"\n'
        '[specification]\nL = "[h1; h2]"\nparameters = "h1, h2"\n'
    )
    (result,) = problem.solve()
    text, page = result.to("text"), result.to("html")
    assert isinstance(text, str)
    assert isinstance(page, str)
    assert "Shaded: stable values of" in text
    assert not re.search("[Dd]ots|[Dd]ashe", text)
    assert "ashed" in page
