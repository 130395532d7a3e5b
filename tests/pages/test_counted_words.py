"""Sentences about roots say mode or modes, is or are, as there are one or several; sketches are told as they are drawn."""

from __future__ import annotations

import re

import symobs
from symobs.formula.phrases import PHRASES
from symobs.problem import read
from tests.kit import tabled, text_of


@tabled
def test_hidden_modes_are_counted(A: str, C: str, poles: list[int], sentence: str) -> None:
    assert sentence in text_of(symobs.observer(symobs.StateSpace(A, C=C), poles=poles))


def test_the_fixed_modes_of_a_case_are_counted() -> None:
    # c = 0 hides the states whose eigenvalues are -2, or -2 and -4.
    one = symobs.observer(symobs.StateSpace("[-1 0; 0 -2]", C="[1 c]"), poles=[-2, -3])
    assert "but its fixed mode -2 is among the desired poles" in text_of(one)
    two = symobs.observer(symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 -4]", C="[1 c c]"), poles=[-2, -3, -5])
    assert (
        "-2, -4 are unobservable, hence poles for every gain; not all of them are among the desired poles"
        in text_of(two)
    )


def test_the_only_root_and_several_of_them() -> None:
    assert "Its only root is -3." in text_of(symobs.characteristic_polynomial(symobs.StateSpace("[-3]")))
    assert "Its roots are -3, -4." in text_of(symobs.characteristic_polynomial(symobs.StateSpace("[-3 0; 0 -4]")))
    text = text_of(symobs.transfer_function(symobs.StateSpace.from_transfer_function("(s + 1)/((s + 2)(s + 3))")))
    assert "The poles are -2, -3. The only zero is -1." in text


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
