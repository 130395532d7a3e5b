"""Poles with square roots: their product is multiplied out, and has to lie in the field of the data."""

from __future__ import annotations

import pytest
import sympy

import symobs as so
from tests.kit import tabled

s, zeta = sympy.symbols("s zeta")
PLANT = so.StateSpace("[0 1; 20 0]", "[0; 1]", "[1 0]")


@tabled
def test_the_polynomial_is_multiplied_out(poles: str, text: str) -> None:
    """The desired polynomials are worked out by hand: (s + 2)² + 12, and so on."""
    polynomial = sympy.sympify(text, locals={"zeta": zeta})  # noqa: TID251 - texts of this file
    found = so.observer(PLANT, poles=poles)
    assert sympy.expand(found.polynomial - polynomial) == 0
    assert found.verdict == "yes"
    chi = (PLANT.A - found.L * PLANT.C).charpoly(s).as_expr()
    assert sympy.expand(sympy.expand(chi) - polynomial) == 0
    assert "as required" in found.to("text")


@tabled
@pytest.mark.parametrize("as_text", [False, True], ids=["objects", "texts"])
def test_advised_poles_go_into_the_observer(order: int, as_text: bool) -> None:  # noqa: FBT001 - a parameter
    """Butterworth's poles: φ(s) φ(−s) = ω₀^(2n) + (−1)ⁿ s^(2n)."""
    rows = "; ".join(" ".join("1" if j == i + 1 else "0" for j in range(order)) for i in range(order))
    plant = so.StateSpace(
        f"[{rows}]", f"[{'; '.join(['0'] * (order - 1) + ['1'])}]", f"[{' '.join(['1'] + ['0'] * (order - 1))}]"
    )
    advised = so.pole_advice(plant, radius="omega_0").poles
    found = so.observer(plant, poles=[str(pole) for pole in advised] if as_text else list(advised))
    phi, radius = found.polynomial, sympy.Symbol("omega_0")
    assert sympy.expand(phi * phi.subs(s, -s)).subs(radius, 1).simplify() == 1 + (-1) ** order * s ** (2 * order)


@tabled
def test_what_is_no_polynomial_of_the_data_is_refused(poles: str, reason: str) -> None:
    with pytest.raises(so.InputError, match=reason):
        so.observer(PLANT, poles=poles)
