"""`evaluate` is `at` at every point, or nan: also on the curves of conditions and cases, and beyond their inequalities."""

from __future__ import annotations

import random
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy

import symobs
from symobs.ground.errors import InputError, OutOfBudget
from symobs.tasks.result import tasks
from tests.kit import tables
from tests.support.problems.random_plants import plant_of, specification_of
from tests.support.sampling import FULL

S = symobs.StateSpace
#: The letters of random plants that stand in their specification alone.
VALUES = {"T": Fraction(1), "p": Fraction(2), "q": Fraction(3)}
#: Results with parameters, with conditions and cases of every kind.
RESULTS: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = tables(Path(__file__))["results"]


def points_of(result: Any, draw: random.Random, count: int) -> list[dict[str, Fraction]]:
    """Random points, a third of them on a curve of a condition or a case where one is solved for."""

    def number() -> Fraction:
        return Fraction(draw.randint(-8, 8), draw.choice([1, 2, 4]))

    def equations(one: Any) -> Any:
        yield from (relation.lhs - relation.rhs for relation in one.conditions if isinstance(relation, sympy.Rel))
        for case in one.cases:
            yield from (relation.lhs - relation.rhs for relation in case.when)
            if case.result is not None:
                yield from equations(case.result)

    curves = [e for e in dict.fromkeys(equations(result)) if e.free_symbols <= {*sympy.symbols("a b")}]
    found: list[dict[str, Fraction]] = []
    while len(found) < count:
        point = {"a": number(), "b": number()}
        if curves and len(found) % 3 == 0:
            name, other = draw.sample(["a", "b"], 2)
            roots = sympy.solve(draw.choice(curves).subs(other, sympy.Rational(point[other])), sympy.Symbol(name))
            rational = [root for root in roots if root.is_Rational and abs(root) < 100]
            point[name] = Fraction(*rational[0].as_numer_denom()) if rational else point[name]
        if all(Fraction(repr(float(value))) == value for value in point.values()):
            found.append(point)
    return found


def numbers(value: Any) -> Any:
    """A field as an array of doubles, by SymPy."""
    return np.array(sympy.Matrix(value).evalf() if hasattr(value, "shape") else sympy.N(value)).astype(float)


def compare(result: Any, points: list[dict[str, Fraction]], name: str) -> int:
    """Hold `evaluate` to `at` at the points; return the number of values that were compared."""
    found = (
        result.evaluate({letter: np.array([float(point[letter]) for point in points]) for letter in points[0]})
        if points[0]
        else {}
    )
    seen = 0
    for index, point in enumerate(points):
        try:
            there = symobs.bounded(partial(result.at, **point), timeout=10)
        except OutOfBudget:
            continue
        except InputError:
            assert all(np.isnan(array[index]).all() for array in found.values()), (name, point)
            continue
        for field, array in found.items():
            own, expected = array[index], getattr(there, field, None)
            if expected is None:
                assert np.isnan(own).all(), (name, field, point)
            elif not np.isnan(own).any():
                seen += 1
                np.testing.assert_allclose(
                    own, numbers(expected), rtol=1e-9, atol=1e-9, err_msg=f"{name} {field} {point}"
                )
    return seen


@pytest.mark.parametrize("name", RESULTS)
def test_every_point_is_what_at_finds_or_nan(name: str) -> None:
    task, plant, asked = RESULTS[name]
    result = getattr(symobs, task)(S(**plant), **asked)
    points = points_of(result, random.Random(name), 24 if FULL else 9)  # noqa: S311
    assert compare(result, points, name) > len(points) / 2


#: An answer at a point takes seconds; they are held at points by the tests of their own.
LONG = {"kalman", "lqr", "margins", "output_regulation"}


@pytest.mark.slow
def test_every_point_of_random_plants_is_what_at_finds_or_nan() -> None:
    names, seen = sorted(tasks().keys() - LONG), 0
    for seed in range(700 if FULL else len(names)):
        chance, name = random.Random(seed), names[seed % len(names)]  # noqa: S311 - repeats
        plant = plant_of(chance)
        try:
            solve = partial(tasks()[name].function, plant, **specification_of(name, plant, chance))
            result = symobs.bounded(solve, timeout=5)
            points = points_of(result, chance, 12 if FULL else 6)
            result.evaluate(dict.fromkeys(result.symbols, 0.5))
        except (InputError, OutOfBudget, NotImplementedError):  # refused, too long, a curve that SymPy does not solve
            continue
        others = {letter: VALUES[letter] for letter in result.symbols if letter in VALUES}
        own = [{k: v for k, v in point.items() if k in result.symbols} | others for point in points]
        seen += compare(result, own, f"{seed} {name}") if own[0] else 0
    assert seen


def test_a_point_in_a_case_of_inequalities_has_its_value_without_a_warning() -> None:
    """x'' = x: the hold has cosh 1 and sinh 1."""
    found = symobs.zero_order_hold(S("[0 1; -k 0]", "[0; 1]"), sampling_period="1").evaluate({"k": [-1.0, 4.0]})
    np.testing.assert_allclose(found["A"][0], [[np.cosh(1), np.sinh(1)], [np.sinh(1), np.cosh(1)]])
    np.testing.assert_allclose(found["A"][1], [[np.cos(2), np.sin(2) / 2], [-2 * np.sin(2), np.cos(2)]])
