"""Nonlinear plants: their linearisation against SymPy's derivatives, and what is refused."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import pytest
import sympy as sp

import symobs
from symobs.ground.errors import InputError
from symobs.problem import validate
from symobs.problem.file_tables import parse
from tests.kit import tabled, tables

PENDULUM = """
task = "observer"
[symbols]
g = "positive"
l = "positive"
[plant]
f = "[omega; -g/l*sin(theta) + u]"
h = "theta"
states = "theta, omega"
inputs = "u"
equilibrium = {point}
[specification]
poles = "-3, -4"
"""
x1 = sp.Symbol("x1", positive=True)
x2, u, a, c = sp.symbols("x2 u a c", real=True)
TERMS = [
    x1 * x2,
    x2**2,
    sp.sin(x1),
    sp.cos(x1 + x2),
    sp.exp(-x2),
    sp.sqrt(x1),
    1 / x1,
    u * x1**2,
    a * x2**3,
    sp.sinh(u),
    sp.sin(2 * x1),
]


@pytest.mark.parametrize("seed", range(12))
def test_the_matrices_are_the_partial_derivatives_that_sympy_finds(seed: int) -> None:
    random = Random(seed)  # noqa: S311 - test problems, no secrets
    point: dict[Any, Any] = {x1: random.choice([4, 9]), x2: random.choice([0, 1, c]), u: random.choice([0, 2])}
    rows = [sum(random.randint(1, 3) * term for term in random.sample(TERMS, 4)) for _ in "123"]
    f = [row - row.subs(point) for row in rows[:2]]  # it vanishes at the point
    plant = symobs.linearize(f, rows[2], states=[x1, x2], inputs=[u], equilibrium=point)
    for found, functions, by in (
        (plant.A, f, [x1, x2]),
        (plant.B, f, [u]),
        (plant.C, rows[2:], [x1, x2]),
        (plant.D, rows[2:], [u]),
    ):
        expected = sp.Matrix(functions).jacobian(by).subs(point)
        difference = (found - expected).subs({a: sp.Rational(7, 5), c: sp.Rational(3, 7)})
        assert all(abs(sp.N(entry, 30)) < 1e-25 for entry in difference)


def test_a_file_is_linearised_and_its_page_derives_the_matrices() -> None:
    (result,) = validate(parse(PENDULUM.replace("{point}", '{ theta = "pi", omega = 0, u = 0 }'), "problem")).solve()
    assert str(result.L.T) == "Matrix([[7, (g + 12*l)/l]])"  # s^2 + L1 s + L2 - g/l is s^2 + 7 s + 12
    page = result.to("text")
    assert "f(π, 0, 0) = 0" in page
    assert "[∂f/∂θ  ∂f/∂ω]" in page
    assert "f(π, 0, 0) = 0" in result.at(g=10, l=2).to("text")
    assert sp.Matrix([7, 17]) == result.at(g=10, l=2).L


def test_in_discrete_time_the_states_keep_their_values() -> None:
    f = "[x1 + x2^3; x1*x2 + u]"
    plant = symobs.linearize(f, "x1", states="x1 x2", inputs="u", equilibrium={"x1": 2, "x2": 0, "u": 0}, dt=True)
    assert sp.Matrix([[1, 0], [0, 2]]) == plant.A
    with pytest.raises(InputError, match=r"f\(x, u\) - x is \[1; 0\] there"):
        symobs.linearize(f, "x1", states="x1 x2", inputs="u", equilibrium={"x1": 2, "x2": 1, "u": -1}, dt=True)


@tabled
def test_what_is_no_equilibrium_is_refused_with_the_reason(changes: dict[str, Any], reason: str) -> None:
    given: dict[str, Any] = {
        "f": "[omega; -g/l*sin(theta) + u]",
        "h": "theta",
        "states": "theta, omega",
        "inputs": "u",
        "equilibrium": {"theta": 0, "omega": 0, "u": 0},
    }
    with pytest.raises(InputError, match=reason):
        symobs.linearize(**{**given, **changes})


#: f, the state's name, its equilibrium, the input there: roots, powers and functions of a state, by hand at rest.
SCALAR = tables(Path(__file__))["scalar"]


@pytest.mark.parametrize(("f", "at", "there"), SCALAR)
def test_roots_and_functions_of_a_state_have_their_derivative_and_pages(f: str, at: str, there: str) -> None:
    signs = dict.fromkeys("ckmg", "positive")
    point = {"x": at, "u": there}
    plant = symobs.linearize(f, "x", states="x", inputs="u", equilibrium=point, symbols=signs)
    values = {name: sp.Rational(k, 3) for k, name in enumerate("ckmg", 4)}
    x = sp.Symbol("x")
    read = partial(sp.sympify, rational=True)  # noqa: TID251 - texts of this file
    rest = {name: read(value.replace("^", "**")).subs(values) for name, value in point.items()}
    slope = sp.diff(read(f.replace("^", "**")), x).subs(values).subs(rest)
    assert abs(sp.N(plant.A[0].subs(values) - slope, 30)) < 1e-20
    for result in (
        symobs.observer(plant, poles="-2"),
        symobs.transfer_function(plant),
        symobs.matrix_exponential(plant),
    ):
        assert result.to("text")


def test_a_root_of_what_may_be_negative_asks_for_signs() -> None:
    with pytest.raises(InputError, match=r"sqrt\(c\) has no exact value here: it may not be real; declare signs"):
        symobs.linearize("u - sqrt(x)", "x", states="x", inputs="u", equilibrium={"x": "c", "u": "sqrt(c)"})


def test_a_magnetic_levitator_has_the_root_of_its_balance_of_forces() -> None:
    """m v' = m g - K i²/y²: at rest i = y √(m g/K), so that ∂v'/∂y = 2 g/y and ∂v'/∂i = -2 √(K g/m)/y."""
    signs = dict.fromkeys(("K", "g", "m", "r", "L", "h"), "positive")
    point = {"y": "h", "v": 0, "c": "h*sqrt(m*g/K)", "u": "r*h*sqrt(m*g/K)"}
    f = "[v; g - K/m*c^2/y^2; (u - r*c)/L]"
    plant = symobs.linearize(f, "y", states="y, v, c", inputs="u", equilibrium=point, symbols=signs)
    K, g, m, h = sp.symbols("K g m h", positive=True)
    found = plant.A.subs({sp.Symbol(str(name)): name for name in (K, g, m, h)})
    assert sp.simplify(found[1, 0] - 2 * g / h) == sp.simplify(found[1, 2] + 2 * sp.sqrt(K * g / m) / h) == 0
    assert symobs.controllability(plant).verdict == "yes"
    assert symobs.observer(plant, poles="-1, -2, -3").to("text")


@tabled
def test_rounded_values_are_told_the_equilibrium_they_round(f: str, point: dict[str, Any], exact: str) -> None:
    """The exact point is a zero of f by hand, and is taken; where none is simple, none is named."""
    given: dict[str, Any] = {"f": f, "states": ", ".join(name for name in point if name != "u")}
    given["inputs"] = "u" if "u" in point else ""
    with pytest.raises(InputError) as refused:
        symobs.linearize(**given, equilibrium=point)
    assert ("rounded ones" in refused.value.repair) == bool(exact)
    assert exact in refused.value.repair
    if exact:
        named = dict(entry.split(" = ") for entry in exact.strip("{} ").split(", "))
        symobs.linearize(**given, equilibrium={name: value.strip('"') for name, value in named.items()})
