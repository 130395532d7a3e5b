"""Transfer functions with parameters: where a pole meets a zero, or a zero goes to infinity, it is said."""

from __future__ import annotations

import sympy

import symobs
from symobs import StateSpace
from tests.kit import text_of

c = sympy.Symbol("c")

#: Found by the campaign of random designs, with Octave's and python-control's minimal realisations as judges.
CANCELLING = StateSpace("[0 0; -c 1]", "[-1; 1]", "[-c^2 -2]", dt=True)


def test_a_cancellation_is_a_case() -> None:
    found = symobs.transfer_function(CANCELLING)
    assert found.verdict == "conditional"
    assert {sympy.factor(condition.lhs) for condition in found.conditions} == {c, c + 1, c + 2, c**2 - 2}
    cases = {case.when[0].lhs: case.result for case in found.cases}
    assert {(where, cases[where].poles) for where in (c, c + 1, c + 2)} == {(c, (1,)), (c + 1, (0,)), (c + 2, (1,))}
    there = cases[c**2 - 2]  # over a field with a root of 2: the zero has gone to infinity
    assert (set(there.poles), there.zeros) == ({0, 1}, ())
    assert "poles and zeros provided that" in text_of(found)
