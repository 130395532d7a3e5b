"""Equations of motion as they are typed; what is wrong with them has a message with its place and what to do."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import sympy as sp

import symobs
from symobs.ground.errors import InputError
from tests.kit import tables

TABLES = tables(Path(__file__))


@pytest.mark.parametrize(("changes", "reason"), TABLES["faults"]["rows"])
def test_faults_of_equations_are_told(changes: dict[str, Any], reason: str) -> None:
    given: dict[str, Any] = {"coordinates": ["x"], "inputs": ["F"], "equations": ["m*x'' = F"], "equilibrium": {"F": 0}}
    with pytest.raises(InputError, match=reason):
        symobs.linearize(**{**given, **changes}, symbols={"m": "positive"})


@pytest.mark.parametrize(("changes", "reason"), TABLES["energies"]["rows"])
def test_faults_of_energies_are_told(changes: dict[str, Any], reason: str) -> None:
    given: dict[str, Any] = {
        "coordinates": ["x"],
        "inputs": ["F"],
        "kinetic": "m/2*x'^2",
        "potential": "k/2*x^2",
        "forces": {"x": "F"},
    }
    with pytest.raises(InputError, match=reason):
        symobs.linearize(**{**given, **changes}, symbols={"m": "positive", "k": "positive"})


@pytest.mark.parametrize("text", [row[0] for row in TABLES["written"]["rows"]])
def test_derivatives_are_read_as_they_are_written(text: str) -> None:
    m, b, g, l = sp.symbols("m b g l")
    signs = dict.fromkeys("mbgl", "positive")
    plant = symobs.linearize(
        coordinates="theta", inputs="u", equations=[text], equilibrium={"theta": "pi"}, symbols=signs
    )
    assert sp.simplify(plant.A - sp.Matrix([[0, 1], [g / l, -b / (m * l**2)]])) == sp.zeros(2)
    assert sp.simplify(plant.B - sp.Matrix([0, 1 / (m * l**2)])) == sp.zeros(2, 1)


def test_a_condition_of_the_equilibrium_is_one_of_every_answer() -> None:
    """The bead stays outside of the lowest point where the hoop turns fast enough."""
    signs = dict.fromkeys(("m", "R", "g", "omega"), "positive")
    energies: dict[str, Any] = {
        "kinetic": "m/2*(R^2*theta'^2 + omega^2*R^2*sin(theta)^2)",
        "potential": "-m*g*R*cos(theta)",
    }
    plant = symobs.linearize(
        coordinates="theta", **energies, equilibrium={"theta": "acos(g/(R*omega^2))"}, symbols=signs
    )
    R, g, omega = sp.symbols("R g omega")
    assert symobs.observability(plant).conditions == (R * omega**2 - g > 0,)
    assert symobs.observability(plant).at(R=1, g=1, omega=2).verdict == "yes"


def test_states_have_the_order_that_is_asked_for() -> None:
    given: dict[str, Any] = {"coordinates": ["x", "y"], "equations": ["x'' = -x + y", "y' = -y"], "equilibrium": {}}
    plant = symobs.linearize(**given, states=["y", "x", "x'"])
    assert sp.Matrix([[-1, 0, 0], [0, 0, 1], [1, -1, 0]]) == plant.A
    assert plant.nonlinear is not None
    assert plant.nonlinear.states == ("y", "x", "x_dot")


def test_a_coordinate_that_is_free_is_a_parameter_where_the_linearisation_depends_on_it() -> None:
    signs = dict.fromkeys("gl", "positive")
    plant = symobs.linearize(coordinates="phi", inputs="u", equations=["l*phi'' + g*sin(phi) = u"], symbols=signs)
    g, l, phi_0 = sp.symbols("g l phi_0")
    assert plant.A[1, 0] == -g * sp.cos(phi_0) / l
    assert "φ₀" in symobs.observability(plant).to("text")


def test_a_rocket_with_air_resistance_flies_on() -> None:
    """M. Herber, problem 2.7, with b = m = g = 1: at v = sqrt(2) the thrust is 3, and the slope of v^2 is 2 sqrt(2)."""
    plant = symobs.linearize(
        "[-sign(v)*v^2 + T - 1]", "v", states="v", inputs="T", equilibrium={"v": "sqrt(2)", "T": 3}
    )
    assert sp.Matrix([-2 * sp.sqrt(2)]) == plant.A
    assert "sgn" in symobs.characteristic_polynomial(plant).to("text")


@pytest.mark.parametrize(
    ("radicand", "repair"), [("r - 1", "put r = 1 + d with d positive"), ("2 - r", "put r = 2 - d with d positive")]
)
def test_a_root_of_open_sign_says_which_letter_to_shift(radicand: str, repair: str) -> None:
    with pytest.raises(InputError, match=re.escape(repair)):
        symobs.linearize(
            f"[y; -x*y - x + sqrt({radicand})*x + u]",
            states="x, y",
            inputs="u",
            equilibrium={"x": 0, "y": 0, "u": 0},
            symbols={"r": "positive"},
        )
