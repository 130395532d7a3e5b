"""What pages say in words is so for plants that are not the usual ones, and is said of them in whole sentences."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs.formula import phrases
from tests.kit import tabled, text_of


@tabled
def test_a_page_says_what_is_so(
    task: str, plant: dict[str, Any], asked: dict[str, Any], says: list[str], silent: list[str]
) -> None:
    about = [symobs.StateSpace(**plant)] if plant else []
    text = text_of(getattr(symobs, task)(*about, **asked))
    assert [words for words in says if words not in text] == []
    assert [words for words in silent if words in text] == []


def test_a_reference_that_stays_in_0_is_refused() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(symobs.InputError, match="reference_start is 0"):
        symobs.tracking(plant, control_poles=[-1, -2], observer_poles=[-3], reference_start="[0; 0]")


def test_what_is_demanded_of_phrases_is_demanded_of_phrases_that_exist() -> None:
    for listed in (
        phrases.ASSERTS,
        phrases.RESTS_ON,
        phrases.NAMING,
        phrases.OPENS,
        phrases.EXPLAINS,
        phrases.SPELLS_OUT,
    ):
        assert set(listed) <= phrases.PHRASES.keys()


def test_where_two_decays_are_equal_the_kernel_of_the_gramian_is_told() -> None:
    """With A = diag(−a, −b) and C = [1 1] the difference of the states is unseen at a = b, and (C; CA)(−1, 1)ᵀ = 0 there."""
    plant = symobs.StateSpace("[-a 0; 0 -b]", C="[1 1]", symbols={"a": "positive", "b": "positive"})
    _, _, sums = str(symobs.gramian(plant, horizon="inf").to("text")).partition("2. Finite sum")
    _, _, equal = sums.partition("Case a = b.")
    lines = "\n".join(line.strip() for line in equal.splitlines())
    assert "have the same kernel. For" in lines
    assert "v = ⎡-1⎤\n⎣ 1⎦" in lines
    assert "W v = 0,    M v = 0" in lines
