"""Unknown-input observers held to signals: the error of a simulation does not depend on d; where there is none, and why."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import symobs
from symobs.exact import Matrix
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import tabled, text_of


def test_conditions_and_cases_are_those_of_the_rank_and_of_the_zeros() -> None:
    """C E = a, and the zero is -3 - b/a: it is a desired pole for b = 0 and for b = -a, and for E = 0 there is none."""
    plant = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 0]")
    found = symobs.unknown_input_observer(plant, E="[a; b]", poles="-2, -3")
    a, b = sympy.symbols("a b")
    assert (found.verdict, found.conditions) == ("no", (sympy.Ne(a, 0),))
    verdicts = {frozenset(case.when): case.result.verdict for case in found.cases}
    assert verdicts == {
        frozenset({sympy.Eq(a, 0)}): "no",
        frozenset({sympy.Eq(b, 0), sympy.Ne(a, 0)}): "yes",
        frozenset({sympy.Eq(a + b, 0), sympy.Ne(a, 0)}): "yes",
    }
    ((when, undisturbed),) = found.cases[0].result.cases
    assert (when, undisturbed.verdict, undisturbed.H) == ((sympy.Eq(b, 0),), "yes", sympy.zeros(2, 1))
    assert found.at(a=1, b=-1).verdict == "yes"
    assert found.at(a=0, b=1).solvable is False
    assert "b = 0, a ≠ 0 " in found.to("text")


@tabled
def test_why_there_is_no_observer_is_said(C: str, poles: str, said: str) -> None:
    found = symobs.unknown_input_observer(symobs.StateSpace("[0 1; -2 -3]", C=C), E="[0; 1]", poles=poles)
    assert found.verdict == "no"
    assert said in text_of(found)


def test_a_direction_that_is_seen_is_no_reason_for_a_no() -> None:
    design = symobs.unknown_input_observer(symobs.StateSpace("[0 1; 0 0]", C="[1 0]"), E="[0; 1]", poles="-1, -2")
    with pytest.raises(CertificateRejected):
        design.with_answer("w", Matrix.zeros(1, 1))


@pytest.mark.parametrize(
    ("E", "said"),
    [(None, "E is missing"), ("[1; 0; 0]", "E has 3 rows, A has 2"), ("[s; 1]", "stands for the time"), ("[1", "E")],
)
def test_a_wrong_disturbance_input_is_refused(E: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.unknown_input_observer(symobs.StateSpace("[0 1; 0 0]", C="[1 0]"), E=E, poles="-1, -2")


def test_many_special_cases_are_the_rows_of_one_table() -> None:
    """C E = (a, b): the zeros at b = 0 are -1/a; H, T and A₁ stand on the page once, in general."""
    plant = symobs.StateSpace("[-1 1 0; -a 0 0; 0 -b -1]", "[0; 1; 0]", "[1 0 0; 0 0 1]")
    found = symobs.unknown_input_observer(plant, E="[a; 1; b]", poles="-2, -3, -4")
    page = text_of(found)
    assert page.count("A₁ = T A") == page.count("H = E") == page.count("Such an observer requires") == 1
    table = page[page.index("Special cases") : page.index("References")]
    for row in (
        "a = 0, b = 0 │ – │ none",
        "b = 0, a = 1/2 │ -2 │ for example",
        "a = -1 │ 1 │ none",
        "a = 0, b ≠ 0 │ – │",
    ):
        assert row in table
    assert "Case" not in page


LETTERS = dict.fromkeys(("a", "b", "p"), "real")


@tabled
def test_a_page_has_all_cases(A: str, C: str, E: str, poles: str) -> None:
    """Beside a gain in letters, on strata of several equations, and where an outer case has lost F."""
    plant = symobs.StateSpace(A, C=C, symbols=LETTERS)
    assert "not decided here" not in text_of(symobs.unknown_input_observer(plant, E=E, poles=poles))


def test_a_row_inside_a_case_does_not_repeat_what_the_case_assumes() -> None:
    plant = symobs.StateSpace("[0]", C="[b]", symbols=LETTERS)
    page = text_of(symobs.unknown_input_observer(plant, E="[a]", poles="-1"))
    table = page[page.index("Special cases") : page.index("References")]
    for row in ("a = 0, b ≠ 0 │ –", "a = 0, b = 0 │ 0", "b = 0 │ – │ none, since"):
        assert row in table
    assert "b ≠ 0, b = 0" not in table
    assert table.count("a = 0") == 2


def test_the_gain_of_several_outputs_follows_from_its_equations() -> None:
    """(s + 3) and (s + 2)(s + 4)(s + 5) = s³ + 11s² + 38s + 40, by hand."""
    plant = symobs.StateSpace("[0 1 0 0; -2 -1 2 0; 0 0 0 1; 1 0 -1 -1]", "[0; 1; 0; 0]", "[1 0 0 0; 0 0 0 1]")
    page = text_of(symobs.unknown_input_observer(plant, E="[0; 0; 0; 1]", poles="-2, -3, -4, -5"))
    assert "l₄ = 3, l₁ + 1 = 11, l₁ + l₂ + 2 = 38, 2l₃ = 40" in page
