"""A result at values where one of its printed cases applies, though the question itself would be refused there."""

from __future__ import annotations

import pytest
import sympy

import symobs
from symobs.ground.errors import InputError

S = symobs.StateSpace
THIRD_ORDER = "[0 1 0; 0 0 1; -1 -2 -3]"


def test_a_transfer_function_whose_only_pole_cancels_is_its_printed_case() -> None:
    """(s + 1)/(s + 1) = 1: the realisation keeps its state."""
    result = symobs.transfer_function(S.from_transfer_function("(s+a)/(s+b)"))
    there = result.at(a=1, b=1)
    assert there.transfer_function == result.cases[0].result.transfer_function == 1
    assert sympy.Matrix([[-1]]) == there.plant.A
    assert "P(s)" in there.to("text")
    s = sympy.Symbol("s")
    assert sympy.simplify(result.at(a=2, b=1).transfer_function - (s + 2) / (s + 1)) == 0


@pytest.mark.parametrize(("signal", "own"), [("c^k", [1, 0, 0, 0]), ("3*c^k + 2^k", [4, 2, 4, 8])])
def test_a_power_of_zero_is_an_impulse(signal: str, own: list[int]) -> None:
    """x(k + 1) = x(k)/2 + u(k) from 0, step by step, with 0⁰ = 1."""
    there = symobs.response(S("[1/2]", "[1]", "[1]", dt=True), input=signal).at(c=0)
    state = sympy.Integer(0)
    for step, number in enumerate(own):
        found = there.output[0].subs(dict.fromkeys(there.output.free_symbols, step))
        assert sympy.simplify(found - state) == 0, step
        state = state / 2 + number


@pytest.mark.parametrize("asked", [{"poles": "-p"}, {"poles": "-p", "T": "[1 0 0; 0 a 0; 0 0 1]"}])
def test_dependent_outputs_at_values_are_the_printed_no(asked: dict[str, str]) -> None:
    result = symobs.reduced_order_observer(S(THIRD_ORDER, None, "[1 0 0; 0 a 0]"), **asked)
    there = result.at(a=0, p=3)
    assert there.verdict == "no"
    assert str(there.answer["w"]) == "[0 1]"
    assert there.L is None
    assert there.all_certificates
    assert "no such observer exists" in " ".join(there.to("text").split())
    assert result.at(a=1, p=3).L is not None


def test_dependent_outputs_of_a_plant_are_refused_as_before() -> None:
    with pytest.raises(InputError, match="depend on each other"):
        symobs.reduced_order_observer(S(THIRD_ORDER, None, "[1 0 0; 0 0 0]"), poles="-3")
