"""Functions of parameters and roots as data, held to SymPy's and NumPy's arithmetic at values of the parameters."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
import sympy

import symobs
from symobs.ground.errors import InputError
from symobs.problem import validate
from symobs.problem.expect import mismatches
from symobs.problem.file_tables import parse
from tests.kit import tabled, tables

SIGNS = {"theta": "real", "k": "positive", "T": "positive"}
PLANTS = tables(Path(__file__))["plants"]


def plant(name: str) -> symobs.StateSpace:
    A, B, C = PLANTS[name]
    return symobs.StateSpace(A, B, C, symbols=SIGNS)


def numbers(value: Any, point: dict[str, float]) -> Any:
    return np.array(value.subs(point).evalf(), dtype=float)


def points(seed: str) -> list[dict[str, float]]:
    random = Random(seed)  # noqa: S311 - test data
    return [{name: random.uniform(0.3, 1.2) for name in SIGNS} for _ in range(4)]


@pytest.mark.parametrize("name", PLANTS)
def test_gains_place_the_poles_at_values_of_the_parameters(name: str) -> None:
    given, design = plant(name), symobs.compensator(plant(name), control_poles=[-1, -2], observer_poles=[-3, -4])
    for point in points(name):
        A, B, C, K, L = (numbers(value, point) for value in (given.A, given.B, given.C, design.K, design.L))
        assert np.poly(A - B @ K) == pytest.approx([1, 3, 2], abs=1e-6)
        assert np.poly(A - L @ C) == pytest.approx([1, 7, 12], abs=1e-6)


def test_what_the_functions_are_decides() -> None:
    rotation = symobs.StateSpace("[0 1; -1 0]", None, "[cos(theta) sin(theta)]")
    assert (symobs.observability(rotation).verdict, symobs.observability(rotation).determinant) == ("yes", 1)
    tilted = symobs.observability(plant("tilted sensor"))  # cos² θ + k sin² θ, k > 0
    assert (tilted.verdict, tilted.cases) == ("yes", ())
    assert symobs.observability(plant("sampled")).verdict == "yes"  # 1 - e⁻ᵀ > 0 for T > 0


def test_the_case_is_where_the_function_vanishes() -> None:
    found = symobs.controllability(plant("pendulum"))  # cos 2θ = 0
    sine = sympy.sin(sympy.Symbol("theta"))
    assert [condition.lhs for condition in found.conditions] == [2 * sine**2 - 1]
    assert [case.result.verdict for case in found.cases] == ["no", "no"]
    for case in found.cases:
        left = [
            equation.lhs.subs("theta", angle) for equation in case.when for angle in (sympy.pi / 4, 3 * sympy.pi / 4)
        ]
        assert left.count(0) == 3  # sin² θ = 1/2 at both, sin θ = ± cos θ at one of them


def test_values_go_into_the_functions() -> None:
    design = symobs.observer(plant("pendulum"), poles=[-2, -3])
    assert sympy.Matrix([4, 1]) == design.at(theta="pi/3", k=2).L
    assert sympy.Matrix([[0, 1], [-1, 0]]) == symobs.StateSpace("[0 1; -cos(theta) 0]").substitute({"theta": 0}).A
    grid = design.evaluate({"theta": np.array([0.5, 1.0]), "k": np.array([1.0, 2.0])})["L"]
    assert grid[:, 1, 0] == pytest.approx([2 - np.cos(0.5), 2 - 2 * np.cos(1.0)])


def test_constants_of_a_file_are_functions_or_roots() -> None:
    text = """
        task = "observer"
        [symbols]
        theta = "real"
        [constants]
        c = "cos(theta)"
        q = "sin(theta)"
        w = "CRootOf(x^3 - x - 1, 0)"
        [plant]
        A = "[0 1; -1 -w]"
        C = "[c q]"
        [specification]
        poles = [-2, -3]
    """
    (design,) = validate(parse(text, "problem")).solve()
    assert set(design.symbols) == {"theta"}
    for angle in (0.2, 0.9):
        A, C, L = (numbers(value, {"theta": angle}) for value in (design.plant.A, design.plant.C, design.L))
        assert np.poly(A - L @ C) == pytest.approx([1, 5, 6], abs=1e-6)


@tabled
def test_expected_answers_are_read_with_functions(entry: str, missed: list[str]) -> None:
    text = f"""
        task = "observer"
        symbols = {{ omega = "positive", d = "real", theta = "real" }}
        [plant]
        A = "[0 1; -omega^2*cos(theta) -d]"
        C = "[1 0]"
        [specification]
        poles = "-3*omega, -3*omega"
        [expect]
        L = "[6*omega - d; {entry}]"
    """  # s² + (d + l₁)s + ω² cos θ + d l₁ + l₂ = (s + 3ω)²
    problem = validate(parse(text, "problem"))
    assert [each.split(":")[0] for each in mismatches(problem.solve(), problem.expect)] == missed


@tabled
def test_what_has_no_meaning_is_refused(entry: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        symobs.StateSpace(f"[0 1; {entry} -1]")


def test_a_region_is_of_polynomials() -> None:
    with pytest.raises(InputError, match="no polynomial"):
        symobs.stability_region(plant("pendulum"), parameters=["k"])


@tabled
def test_a_constant_that_is_none_is_refused(value: str, reason: str) -> None:
    text = (
        f'task = "observability"\n[symbols]\ntheta = "real"\n[constants]\nc = "{value}"\n[plant]\nA = "[c]"\nC = "[1]"'
    )
    with pytest.raises(InputError, match=reason):
        validate(parse(text, "problem"))


def test_roots_of_what_has_symbols_are_no_constants() -> None:
    with pytest.raises(InputError, match="has no exact value"):
        validate(
            parse(
                'task = "observability"\n[symbols]\na = "real"\n[constants]\nc = "sqrt(a)"\n[plant]\nA = "[c]"\nC = "[1]"',
                "p",
            )
        )


def test_roots_of_positive_expressions_are_data_with_their_relation() -> None:
    """√(x² + 1) > x always; √k = k and √k = 1 at k = 1 alone.  Roots of which a product is a square are no letters."""
    x, k = sympy.symbols("x k")
    double = sympy.Matrix([[0, 1], [0, 0]])
    always = symobs.observability(symobs.StateSpace(double, None, sympy.Matrix([[sympy.sqrt(x**2 + 1) - x, 0]])))
    assert (always.verdict, always.conditions, always.cases) == ("yes", (), ())
    for entry in ("sqrt(k) - k", "sqrt(k) - 1"):
        plant = symobs.StateSpace(double, None, f"[{entry} 0]", symbols={"k": "positive"})
        found = symobs.observability(plant)
        assert (found.conditions, [case.result.verdict for case in found.cases]) == ((sympy.Ne(k - 1, 0),), ["no"])
        assert list(found.evaluate({"k": [1.0, 4.0]})["rank"]) == [0, 2]
        assert found.to("text")
    signs = {"a": "positive", "b": "positive"}
    for A in ("[sqrt(a) sqrt(b); sqrt(a*b) 0]", "[sqrt(2*a) sqrt(a); sqrt(2) 0]"):
        with pytest.raises(InputError, match="roots that depend on each other"):
            symobs.StateSpace(A, symbols=signs)


def test_a_value_without_a_cosine_in_roots_is_refused() -> None:
    with pytest.raises(InputError, match="not written with square roots"):
        symobs.observability(plant("pendulum")).at(theta="pi/7")
