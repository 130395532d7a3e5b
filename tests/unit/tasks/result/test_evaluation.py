"""Fields at arrays of points: the values of SymPy's lambdify, and nan or the case's formula where a condition fails."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled

HIDDEN = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 c]")
CART = symobs.StateSpace("[0 1 0 0; 0 0 -m*g/M 0; 0 0 0 1; 0 0 (M+m)*g/(M*l) 0]", "[0; 1/M; 0; -1/(M*l)]", "[1 0 0 0]")


def exactly(matrix: Any, **values: float) -> Any:
    """The value of a SymPy matrix at the shortest decimals of doubles, rounded at the end."""
    numbers = {name: sympy.Rational(repr(value)) for name, value in values.items()}
    return np.array(matrix.subs(numbers)).astype(float)


def test_gains_beside_lambdify_at_many_points() -> None:
    result = symobs.state_feedback(CART, poles="-1, -2, -3, -p")
    chosen = np.random.default_rng(2)
    points = {name: chosen.uniform(1, 2, 40_000) for name in ("M", "m", "g", "l", "p")}
    found = result.evaluate(points)
    assert found["K"].shape == (40_000, 1, 4)
    entries = list(result.K)
    expected = sympy.lambdify(sympy.symbols("M m g l p"), entries)(*points.values())  # noqa: TID251 - our own expressions
    for index, values in enumerate(expected):
        np.testing.assert_allclose(found["K"][:, 0, index], values, rtol=1e-11)


def test_arrays_are_broadcast_and_matrices_stand_behind() -> None:
    result = symobs.observer(HIDDEN, poles="-k, -5")
    c, k = np.array([[0.25], [3.0]]), np.array([2.0, 3.0, 4.0])
    found = result.evaluate({"c": c, "k": k})
    assert {name: array.shape for name, array in found.items()} == {
        "L": (2, 3, 2, 1), "A": (2, 3, 2, 2), "B_u": (2, 3, 2, 1), "B_y": (2, 3, 2, 1)
    }  # fmt: skip
    for i in range(2):
        for j in range(3):
            np.testing.assert_allclose(found["L"][i, j], exactly(result.L, c=float(c[i, 0]), k=float(k[j])), rtol=1e-12)
    alone = result.evaluate({sympy.Symbol("c"): 3, "k": 2})
    assert alone["L"].shape == (2, 1)
    np.testing.assert_array_equal(alone["L"], found["L"][1, 0])


def test_where_a_condition_fails_there_stands_what_holds_in_that_case() -> None:
    """At c = 1/2 the mode −2 is unobservable, at c = 1 the mode −1: with k = 2, or k = 1, it is among the desired poles."""
    result = symobs.observer(HIDDEN, poles="-k, -5")
    found = result.evaluate({"c": [0.5, 0.5, 1, 1, 0.1], "k": [7, 2, 7, 1, 3]})["L"][..., 0]
    assert np.isnan(found[[0, 2]]).all()
    for index, (c, k) in {1: ("1/2", 2), 3: (1, 1), 4: ("1/10", 3)}.items():
        np.testing.assert_allclose(found[index], np.array(result.at(c=c, k=k).L).astype(float)[:, 0], rtol=1e-12)


def test_every_point_is_what_at_finds() -> None:
    result = symobs.observer(HIDDEN, poles="-k, -5")
    grid = [0.25 * i for i in range(-4, 9)]
    c, k = np.meshgrid(grid, grid, indexing="ij")
    found = result.evaluate({"c": c, "k": k})["L"]
    missing = 0
    for index in np.ndindex(c.shape):
        there = result.at(c=Fraction(float(c[index])), k=Fraction(float(k[index])))
        if there.answer["L"] is None:
            assert np.isnan(found[index]).all()
            missing += 1
        else:
            np.testing.assert_allclose(found[index], np.array(there.L).astype(float), rtol=1e-12, atol=1e-14)
    assert missing == 2 * (len(grid) - 1)  # on two lines, but where k is the unobservable mode


def test_beside_a_condition_the_value_is_exact() -> None:
    result = symobs.observer(HIDDEN, poles="-1, -5")
    for places in range(8, 17):
        c = float(f"0.5{'0' * (places - 2)}1")
        tolerance = 1e-15 if places > 12 else 10 ** (places - 15.0)
        np.testing.assert_allclose(result.evaluate({"c": c})["L"], exactly(result.L, c=c), rtol=tolerance)


def test_a_sign_that_is_not_the_declared_one_is_nan() -> None:
    plant = symobs.StateSpace("[0 1; -k/m 0]", None, "[1 0]", symbols={"k": "positive", "m": "nonzero"})
    found = symobs.observer(plant, poles="-1, -2").evaluate(
        {"k": [1, -1, 0, 1, np.inf, np.nan], "m": [2, 2, 2, 0, 2, 2]}
    )
    assert np.isnan(found["L"][:, 0, 0]).tolist() == [False, True, True, True, True, True]


def test_ranks_and_functions_of_parameters() -> None:
    found = symobs.observability(HIDDEN).evaluate({"c": [0.25, 0.5, 1, 2]})
    assert found["rank"].tolist() == [2, 1, 1, 2]
    gramian = symobs.gramian(symobs.StateSpace("[-a]", None, "[1]", symbols={"a": "positive"}))
    a, T = np.array([0.5, 1, 3]), np.array([1, 2, 0.25])
    found = gramian.evaluate({"a": a, "T": T})
    np.testing.assert_allclose(found["matrix"][:, 0, 0], (1 - np.exp(-2 * a * T)) / (2 * a), rtol=1e-12)


@tabled
def test_refusals(points: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        symobs.observer(HIDDEN, poles="-k, -5").evaluate(points)


@pytest.mark.parametrize(
    "result",
    [
        symobs.response(symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", "[1 0]"), input="1"),
        symobs.matrix_exponential(symobs.StateSpace("[0 1; 0 -1]")),
    ],
    ids=lambda result: result.task,
)
@pytest.mark.parametrize("points", [{}, {"t": [1, 2]}])
def test_functions_of_time_alone_are_refused(result: Any, points: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="has no field of numbers: its answers are functions of t"):
        result.evaluate(points)
