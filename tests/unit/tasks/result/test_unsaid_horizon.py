"""Values of parameters where the horizon is not said and symbols are declared."""

from __future__ import annotations

import pytest
import sympy

import symobs

PLANT = symobs.StateSpace("-k", "1", "1", symbols={"k": "positive"})


@pytest.mark.parametrize(
    ("task", "asked"),
    [("gramian", {}), ("minimum_energy_input", {"final": "[1]"}), ("initial_state", {"output": "exp(-k*t)"})],
)
def test_an_unsaid_horizon_is_no_undeclared_name(task: str, asked: dict[str, str]) -> None:
    result = getattr(symobs, task)(PLANT, **asked)
    there = result.at(k=2)
    assert "k" not in {str(symbol) for symbol in there.plant.A.free_symbols}


def test_the_unsaid_horizon_may_be_given() -> None:
    """∫ e^{-4 t} dt from 0 to 1."""
    found = symobs.gramian(PLANT).at(k=2, T=1).matrix
    assert sympy.simplify(found[0, 0] - (1 - sympy.exp(-4)) / 4) == 0
