"""Poles with square roots: their product is multiplied out, and has to lie in the field of the data."""

from __future__ import annotations

import pytest
import sympy

import symobs as so
from tests.kit import tabled

s, zeta, omega, a = sympy.symbols("s zeta omega a")
PLANT = so.StateSpace("[0 1; 20 0]", "[0; 1]", "[1 0]")

# The desired polynomials are worked out by hand: (s + 2)² + 12, and so on.
_POLES = {
    "-2 + 2*sqrt(3)*i, -2 - 2*sqrt(3)*i": s**2 + 4 * s + 16,
    "-1 + sqrt(-3), -1 - sqrt(-3)": s**2 + 2 * s + 4,
    "-2 + sqrt(3), -2 - sqrt(3)": s**2 + 4 * s + 1,
    "-sqrt(2), -1": s**2 + (1 + sympy.sqrt(2)) * s + sympy.sqrt(2),
    "-zeta*omega + omega*sqrt(zeta^2 - 1), -zeta*omega - omega*sqrt(zeta^2 - 1)": s**2
    + 2 * zeta * omega * s
    + omega**2,
    "-zeta*omega + omega*sqrt(1 - zeta^2)*j, -zeta*omega - omega*sqrt(1 - zeta^2)*j": s**2
    + 2 * zeta * omega * s
    + omega**2,
    "omega*(-1 + sqrt(3)*j)/2, omega*(-1 - sqrt(3)*j)/2": s**2 + omega * s + omega**2,
    "-1 + sqrt(a)*i, -1 - sqrt(a)*i": s**2 + 2 * s + 1 + a,
}


@pytest.mark.parametrize(("poles", "polynomial"), _POLES.items(), ids=list(_POLES))
def test_the_polynomial_is_multiplied_out(poles: str, polynomial: sympy.Expr) -> None:
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
