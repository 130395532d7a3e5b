"""Transfer functions of several inputs and outputs, their poles and zeros."""

from __future__ import annotations

import pytest
import sympy

import symobs

s = sympy.Symbol("s")


def test_poles_and_zeros_are_those_of_smith_and_mcmillan() -> None:
    """Skogestad and Postlethwaite, Multivariable Feedback Control, examples on poles and zeros from minors."""
    no_zeros = symobs.StateSpace("[-1 0; 0 -2]", "[-8/5 -4/5; 12/5 8/5]", "[1 1; 3 2]")
    found = symobs.transfer_function(no_zeros)
    expected = sympy.Matrix([[s - 1, s], [-6, s - 2]]) * sympy.Rational(4, 5) / ((s + 1) * (s + 2))
    assert (found.transfer_function - expected).applyfunc(sympy.simplify).is_zero_matrix
    assert sorted(found.poles) == [-2, -1]
    assert found.zeros == ()
    with_zero = symobs.transfer_function(symobs.StateSpace("-2", "[-3 4]", "[1; -3/2]", "[1 0; 0 2]"))
    expected = sympy.Matrix([[s - 1, 4], [sympy.Rational(9, 2), 2 * (s - 1)]]) / (s + 2)
    assert (with_zero.transfer_function - expected).applyfunc(sympy.simplify).is_zero_matrix
    assert with_zero.poles == (-2,)
    assert with_zero.zeros == (4,)


def test_a_zero_that_no_entry_has() -> None:
    """With a parameter: [1/(s+1), 1/(s+2); 1/(s+1), 1/(s+a)] loses rank nowhere but where a = 2."""
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 -a]", "[1 0; 0 1; 0 1]", "[1 1 0; 1 0 1]")
    found = symobs.transfer_function(plant)
    a = sympy.Symbol("a")
    assert sorted(found.poles, key=str) == sorted([-1, -2, -a], key=str)
    assert found.zeros == ()
    assert "matrix" in found.to("text")


@pytest.mark.parametrize(
    ("text", "lost"),
    [
        ("[(s+k)/((s+1)(s+2)(s+3)(s+4)) 0; 0 1/(s+1)]", {1, 2, 3, 4}),
        ("[k/(s+1) 1/(s+2); 1/(s+3) 1/((s+4)(s+5)(s+6))]", {0}),
        ("[k/(s+1) 1/(s+2); 1/(s+3) 1/(s+k)]", {0, 2, 3}),
    ],
)
def test_a_large_matrix_says_where_its_order_drops(text: str, lost: set[int]) -> None:
    """The order there is that of the plant at the number, which has no parameter."""
    found = symobs.transfer_function(symobs.StateSpace.from_transfer_function(text))
    excluded = {value for relation in found.conditions for value in sympy.solve(relation.lhs)}
    assert lost <= excluded
    for value in range(6):
        there = symobs.transfer_function(symobs.StateSpace.from_transfer_function(text.replace("k", str(value))))
        assert (len(there.poles) < len(found.poles)) is (value in lost)
