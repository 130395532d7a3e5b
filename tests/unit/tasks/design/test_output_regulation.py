"""Output regulation against the linear equations of the entries in floating point, ranks at eigenvalues, and simulation."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs.ground.errors import InputError
from tests.kit import SERVO, tabled, text_of


def test_a_parameter_says_where_a_zero_blocks() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[z 1]")  # a zero at -z
    found: Any = symobs.output_regulation(plant, S="[sigma]", reference="[1]", poles="-2, -3")
    assert found.verdict == "conditional"
    assert {str(condition) for condition in found.conditions} == {"Ne(sigma + z, 0)"}
    (case,) = found.cases
    assert (case.result.verdict, case.result.solvable) == ("no", False)
    assert found.at(sigma=1, z=-1).solvable is False
    assert [str(mode) for mode in found.at(sigma=1, z=-1).blocked_modes] == ["1"]
    assert [str(entry) for entry in found.at(sigma=1, z=2).Pi] == ["1/3", "1/3"]  # x2 = sigma x1, z x1 + x2 = w


def test_an_exosystem_that_the_output_does_not_show_has_no_observer() -> None:
    plant = SERVO
    asked = {"S": "[0 2; -2 0]", "reference": "[1 0]", "poles": "-2, -3"}
    found: Any = symobs.output_regulation(plant, **asked, observer_poles="-1, -2, -3, -4")
    assert (found.verdict, found.solvable, found.L) == ("no", True, None)
    assert {str(mode) for mode in found.fixed_modes} == {"2*I", "-2*I"}


@tabled
def test_what_does_not_fit_is_refused(asked: dict[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.output_regulation(SERVO, poles="-1, -2", **asked)


def test_a_case_keeps_a_gain_of_several_outputs_as_it_was() -> None:
    plant = symobs.StateSpace("[b b^2; a+1 -1]", "[b; a]", "[b -1; 0 b]", dt=True, symbols={"a": "real", "b": "real"})
    asked = {"S": "[0 1; -1 0]", "reference": "[0 0; 0 0]", "E": "[0 0; 0 a]", "poles": "0, 1/2"}
    found: Any = symobs.output_regulation(plant, **asked, observer_poles="0, 1/2, -1/2, 1/3")
    assert "The gain is not unique" in text_of(found)
