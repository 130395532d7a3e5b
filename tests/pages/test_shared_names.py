"""A parameter named like a letter of the theory, the inductance L beside the gain L, is told from it on the page."""

from __future__ import annotations

import re

import pytest

import symobs

A = "[0 1/L; -1/C -R/L]"
SIGNS = {"L": "positive", "C": "positive", "R": "positive"}


def test_an_inductance_is_no_gain() -> None:
    """No serifs on the parameters, as on the page said; R is no letter of the theory and stays as it is."""
    found = symobs.observer(symobs.StateSpace(A, None, "[1 0]", symbols=SIGNS), poles="-1, -2")
    page = str(found.to("fragment"))
    data = page[page.index(r"\textbf{Given.}") : page.index("Throughout")]
    assert not re.search(r"(?<![a-z{])[LC](?![a-z])", data.replace(r"\mathsf{L}", "").replace(r"\mathsf{C}", ""))
    assert r"-\dfrac{R}{\mathsf{L}}" in data
    assert r"The sans-serif $\mathsf{L}$ denotes a symbol of the data" in page
    assert r"\det(sI-A+LC)=s^2+3s+2" in page
    text = str(found.to("text"))
    assert "-R/\U0001d5ab" in text
    assert "A - L C" in text


def test_a_way_of_writing_that_was_declared_stays() -> None:
    signs = {**SIGNS, "L": {"sign": "positive", "latex": r"\ell"}}
    page = str(symobs.observer(symobs.StateSpace(A, None, "[1 0]", symbols=signs), poles="-1, -2").to("fragment"))
    assert r"\dfrac{1}{\ell}" in page
    assert r"\mathsf{L}" not in page


def test_names_that_are_no_letters_stay() -> None:
    plant = symobs.StateSpace("[0 1; -k -d]", None, "[1 0]", symbols={"k": "positive", "d": "positive"})
    assert "serifs" not in str(symobs.observer(plant, poles="-1, -2").to("fragment"))


def test_a_letter_that_stands_in_the_specification_only_is_a_parameter_too() -> None:
    """Poles at −K and −2K ask for the gain [2K² 3K], which is no equation for the gain."""
    found = symobs.state_feedback(symobs.StateSpace("[0 1; 0 0]", "[0; 1]"), poles="-K, -2*K")
    page = str(found.to("fragment"))
    assert r"The sans-serif $\mathsf{K}$ denotes a symbol of the data" in page
    assert r"2\mathsf{K}^{2}" in page.replace(" ", "") or r"2\mathsf{K}^2" in page.replace(" ", "")
    assert re.search(r"\d ?K", page) is None
    assert "+BK)" in page.replace(" ", "")


@pytest.mark.parametrize("name", ["x", "L"])
def test_a_pole_is_named_like_a_state_or_an_observer(name: str) -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", None, "[1 0]", symbols={name: "positive"})
    page = str(symobs.observer(plant, poles=f"-{name}, -2*{name}").to("fragment"))
    assert rf"The sans-serif $\mathsf{{{name}}}$ denotes a symbol of the data" in page
    assert re.search(rf"3 ?{name}(?![a-z])", page) is None
    assert rf"3\mathsf{{{name}}}" in page.replace(" ", "")
