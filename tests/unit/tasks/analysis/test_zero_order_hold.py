"""The plant behind a zero-order hold: textbooks, python-control, designs for the sampled plant, what is refused."""

from __future__ import annotations

from typing import Any

import pytest
import sympy
from sympy import exp

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import tabled

T, a, omega = sympy.symbols("T a omega")

#: K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed., ch. 2 and Table 2.1; G. F. Franklin, J. D. Powell
#: and M. Workman, Digital Control of Dynamic Systems, 3rd ed., sec. 4.3: A, B and the sampled matrices.


@tabled
def test_sampled_plants_of_textbooks(A: str, B: str, A_d: Any, B_d: Any) -> None:
    signs = {"a": "positive", "omega": "positive", "T": "positive"}
    found = symobs.zero_order_hold(StateSpace(A, B, symbols=signs), sampling_period="T")
    assert found.verdict == "yes"
    wanted = StateSpace(A_d, B_d, symbols=signs)
    assert sympy.simplify(found.A - wanted.A) == sympy.zeros(*found.A.shape)
    assert sympy.simplify(found.B - wanted.B) == sympy.zeros(*found.B.shape)
    found.derivation.check()


def test_what_vanishes_is_a_case_and_values_go_in() -> None:
    found = symobs.zero_order_hold(StateSpace("[-a]", "[1]"), sampling_period="T")
    (case,) = found.cases
    assert case.when == (sympy.Eq(a, 0),)
    assert (sympy.Matrix([[1]]), sympy.Matrix([[T]])) == (case.result.A, case.result.B)
    there = found.at(a=2, T="1/2")
    assert sympy.Matrix([[(1 - exp(-1)) / 2]]) == there.B
    assert there.sampled.dt == sympy.Rational(1, 2)


def test_a_plant_that_depends_on_an_open_sign_is_not_taken_for_one() -> None:
    found = symobs.zero_order_hold(StateSpace("[0 1; -a -2]", "[0; 1]"), sampling_period=1)
    assert found.verdict == "conditional"
    with pytest.raises(InputError, match="the sampled plant is another one for each sign of"):
        _ = found.sampled
    assert found.at(a=1).sampled.order == 2
    cubic = symobs.zero_order_hold(StateSpace("[0 1 0; 0 0 1; -a -1 -3]", "[0; 0; 1]"))
    assert (cubic.verdict, cubic.A) == ("undecided", None)
    with pytest.raises(InputError, match="no sampled plant in closed form: what is open is the roots of"):
        _ = cubic.sampled
    for language, said in (("en", "the sampled plant is not given"), ("de", "die abgetastete Strecke nicht angegeben")):
        assert said in " ".join(cubic.to("text", language=language).split())


@tabled
def test_what_cannot_be_sampled_is_refused(plant: dict[str, Any], period: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.zero_order_hold(StateSpace(**plant), sampling_period=period)
