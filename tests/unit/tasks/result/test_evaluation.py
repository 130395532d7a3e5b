"""Fields at arrays of points: the values of SymPy's lambdify, and nan or the case's formula where a condition fails."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy
from scipy.linalg import expm  # type: ignore[import-untyped]

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled

HIDDEN = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 c]")


def exactly(matrix: Any, **values: float) -> Any:
    """The value of a SymPy matrix at the shortest decimals of doubles, rounded at the end."""
    numbers = {name: sympy.Rational(repr(value)) for name, value in values.items()}
    return np.array(matrix.subs(numbers)).astype(float)


def test_beside_a_condition_the_value_is_exact() -> None:
    result = symobs.observer(HIDDEN, poles="-1, -5")
    for places in range(8, 17):
        c = float(f"0.5{'0' * (places - 2)}1")
        tolerance = 1e-15 if places > 12 else 10 ** (places - 15.0)
        np.testing.assert_allclose(result.evaluate({"c": c})["L"], exactly(result.L, c=c), rtol=tolerance)


@tabled
def test_refusals(points: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        symobs.observer(HIDDEN, poles="-k, -5").evaluate(points)


@pytest.mark.parametrize(
    "result",
    [
        symobs.response(symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", "[1 0]"), input="1"),
        symobs.matrix_exponential(symobs.StateSpace("[0 1; 0 -1]")),
        symobs.matrix_exponential(symobs.StateSpace("[0 1; 0 2]", dt=True)),
    ],
    ids=lambda result: f"{result.task} of {result.argument}",
)
@tabled
def test_functions_of_time_alone_are_refused(result: Any, points: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=f"has no field of numbers: its answers are functions of {result.argument}"):
        result.evaluate(points)


def test_sums_over_roots_have_values_at_points() -> None:
    """The cubic factor of A has no roots in radicals: the entries are sums over them, with e^(λ T) as terms."""
    A = [[0, 1, 0], [0, 0, 1], [-5, -2, -3]]
    found = symobs.zero_order_hold(symobs.StateSpace(A, [0, 0, 1]), sampling_period="T").evaluate({"T": [0.25, 2.0]})
    for index, period in enumerate([0.25, 2.0]):
        np.testing.assert_allclose(found["A"][index], expm(np.array(A) * period), rtol=1e-12)


def test_the_ends_of_the_interval_are_no_parameters() -> None:
    plant = symobs.StateSpace("[0 a; 0 b]", "[t; 0]", "[1 0]")
    found = symobs.time_varying_observability(plant).evaluate({"a": [1.0, 0.0], "b": [2.0, 2.0]})
    assert found["rank"].tolist() == [2, 1]
