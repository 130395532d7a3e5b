"""Transfer functions with parameters: lowest terms, poles and zeros at every point, special ones included.

SymPy cancels the fraction with the numbers put in; what the result says of that point must be the same.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import sympy

import symobs
from symobs.exact import Scalar
from tests.kit import tables
from tests.support.claims.claims import applicable

pytestmark = pytest.mark.slow

s = sympy.Symbol("s")
VALUES = tuple(map(Fraction, (-2, -1, 0, 1, 3)))

PLANTS: dict[str, tuple[str, str, str, str]] = tables(Path(__file__))["plants"]


def at(entry: Any, point: dict[str, Fraction]) -> Any:
    return entry.subs({sympy.Symbol(k): sympy.Rational(str(v)) for k, v in point.items()})


def monic(polynomial: Any) -> Any:
    found = sympy.Poly(polynomial, s, domain="QQ")
    return found.monic() if found else found


def polynomial_at(value: Scalar, point: dict[str, Fraction]) -> Any:
    put = value.substitute({name: Scalar.of(number) for name, number in point.items()})
    return sympy.Poly([sympy.Rational(str(c.fraction())) for c in put.coefficients("s")], s, domain="QQ")


def said(result: Any, point: dict[str, Fraction]) -> list[Any]:
    return list(applicable(result, point))


def in_lowest_terms(A: Any, B: Any, C: Any, D: Any) -> tuple[Any, Any]:
    """Return the monic polynomials of poles and zeros, from all minors."""
    order = A.shape[0]
    P = (C * (s * sympy.eye(order) - A).inv() * B + D).applyfunc(sympy.cancel)
    listed = [
        [m for r in itertools.combinations(range(P.rows), k) for c in itertools.combinations(range(P.cols), k)
         if (m := sympy.cancel(P.extract(list(r), list(c)).det())) != 0]
        for k in range(1, min(P.shape) + 1)
    ]  # fmt: skip
    below = sympy.Poly(1, s, domain="QQ")
    for minor in itertools.chain(*listed):
        below = sympy.lcm(below, sympy.Poly(sympy.fraction(minor)[1], s))
    largest: list[Any] = next((found for found in reversed(listed) if found), [])
    above = sympy.Poly(0, s, domain="QQ") if largest else sympy.Poly(1, s, domain="QQ")
    for minor in largest:
        above = sympy.gcd(above, sympy.Poly(sympy.cancel(minor * below.as_expr()), s))
    return monic(below), monic(above)


def assert_right_everywhere(A: str, B: str, C: str, D: str, names: list[str]) -> int:
    plant = symobs.StateSpace(A, B, C, D)
    result, met = symobs.transfer_function(plant), 0
    assert result.derivation is not None
    for values in itertools.product(VALUES, repeat=len(names)):
        point = dict(zip(names, values, strict=True))
        numbers = (sympy.Matrix(at(part, point)) for part in (plant.A, plant.B, plant.C, plant.D))
        below, above = in_lowest_terms(*numbers)
        found = said(result, point)
        assert found
        for part in found:
            assert part is not result or not result.conditions or all(bool(at(c, point)) for c in result.conditions)
            assert monic(polynomial_at(part.polynomials[0], point)) == below
            zeros = polynomial_at(part.polynomials[1], point)
            assert (monic(zeros) if zeros else sympy.Poly(1, s, domain="QQ")) == above
        if (plant.inputs, plant.outputs) == (1, 1) and found[0] is not result:
            assert not all(bool(at(condition, point)) for condition in result.conditions)
        met += found[0] is not result
    return met


@pytest.mark.parametrize("name", PLANTS)
def test_every_point_of_a_grid_has_its_own_lowest_terms(name: str) -> None:
    names = sorted({c for part in PLANTS[name] for c in part if c.isalpha()})
    assert assert_right_everywhere(*PLANTS[name], names) > 0


def test_a_curve_without_a_parametrisation() -> None:
    result = symobs.transfer_function(symobs.StateSpace("[-1 0; 0 -2]", "[a^2+b^2-2; 1]", "[1 1]"))
    for point in ({"a": Fraction(7, 5), "b": Fraction(1, 5)}, {"a": Fraction(-1), "b": Fraction(1)}):
        (there,) = said(result, point)
        assert there.order == 1
        assert str(there.transfer_function) == "1/(s + 2)"
    assert "a² + b² - 2 = 0" in result.to("text")
