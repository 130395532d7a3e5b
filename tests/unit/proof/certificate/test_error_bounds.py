"""The bounds of degree and height that a certificate's probability rests on are bounds.

A formula is evaluated as numerators over one denominator, integer polynomials with nothing cancelled, by the rules the
arithmetic modulo a prime follows; degrees and the integers at the point are compared with what `Bounds` says.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

from hypothesis import given
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar
from symobs.exact.core.modular import Point, VanishingDenominator
from symobs.formula.tree import (
    Apply,
    Block,
    Environment,
    Letter,
    Literal,
    Modular,
    Negative,
    Power,
    Product,
    Quotient,
    Sum,
    Transpose,
    evaluate,
)
from symobs.proof.certificate.pointwise import Bounds, SizeBound

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.tree import Formula

ONE = Scalar.of(1)
NAMES = ("s", "a", "b", "c")


class Unreduced:
    """Values as (numerators, denominator), both of them polynomials with integer coefficients."""

    def __init__(self, coefficients: Mapping[str, Scalar]) -> None:
        self.coefficients = coefficients

    def leaf(self, value: Scalar | Matrix) -> tuple[Any, Scalar]:
        """Bring in a value; named coefficients are put in and what they are divided by is multiplied out."""
        below: Scalar = value.common_denominator()
        above: Any = value * below
        for name, meaning in reversed(list(self.coefficients.items())):
            entries = above.entries if isinstance(above, Matrix) else (above,)
            clearing = meaning.denominator ** max(0, *(entry.degree(name) for entry in (*entries, below)))
            above = above.substitute({name: meaning}) * clearing
            below = below.substitute({name: meaning}) * clearing
        return above, below

    def shape(self, value: tuple[Any, Scalar]) -> tuple[int, int] | None:
        return value[0].shape if isinstance(value[0], Matrix) else None

    def entry(self, value: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        return value[0][0, 0], value[1]

    def add(self, left: tuple[Any, Scalar], right: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        return left[0] * right[1] + right[0] * left[1], left[1] * right[1]

    def scale(self, value: tuple[Any, Scalar], factor: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        return value[0] * factor[0], value[1] * factor[1]

    def matmul(self, left: tuple[Any, Scalar], right: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        return left[0] @ right[0], left[1] * right[1]

    def invert(self, value: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        if not isinstance(value[0], Matrix):
            return value[1], value[0]
        return value[0].adjugate() * value[1], value[0].determinant()

    def transpose(self, value: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        return value[0].T, value[1]

    def apply(self, function: str, value: tuple[Any, Scalar]) -> tuple[Any, Scalar]:
        order = value[0].shape[0]
        if function == "det":
            return value[0].determinant(), value[1] ** order
        return value[0].adjugate(), value[1] ** (order - 1)

    def block(self, rows: list[list[tuple[Any, Scalar]]]) -> tuple[Any, Scalar]:
        below = ONE
        for row in rows:
            for part in row:
                below = below * part[1]
        scaled = [[(part[0] * (below / part[1])) for part in row] for row in rows]
        return Matrix.block([[p if isinstance(p, Matrix) else Matrix.of([[p]]) for p in row] for row in scaled]), below

    def equal(self, left: Any, right: Any) -> bool:
        return bool(left == right)


def degree(polynomial: Scalar) -> int:
    assert polynomial.denominator == ONE
    return max((sum(power for _, power in powers) for _, powers in polynomial.terms()), default=0)


def size_at(polynomial: Scalar, point: Mapping[str, int]) -> int:
    """Return the length in bits of the integer that a polynomial is at a point."""
    total = 0
    for coefficient, powers in polynomial.terms():
        term = coefficient
        for name, exponent in powers:
            term *= point[name] ** exponent
        total += term
    return abs(total).bit_length()


def entries_of(above: Scalar | Matrix) -> tuple[Scalar, ...]:
    return above.entries if isinstance(above, Matrix) else (above,)


def hold(formula: Formula, environment: Environment) -> None:
    """Assert that the bounds of a formula bound it."""
    try:
        arithmetic = Modular(environment, Point(NAMES, random.Random(0)))  # noqa: S311 - any point will do
        evaluate(formula, environment, arithmetic)
        above, below = evaluate(formula, environment, Unreduced(environment.coefficients))
    except (VanishingDenominator, ZeroDivisionError):
        return
    point = {name: value for name, value in arithmetic.point.values.items() if name not in environment.coefficients}
    bound: SizeBound = evaluate(formula, environment, Bounds(environment, arithmetic))
    assert max(map(degree, entries_of(above))) <= bound.above
    assert degree(below) <= bound.below
    assert max(size_at(entry, point) for entry in entries_of(above)) <= bound.above_bits + 1e-6
    assert size_at(below, point) <= bound.below_bits + 1e-6
    assert bound.shape == (above.shape if isinstance(above, Matrix) else None)


# -- random formulas ----------------------------------------------------------------------------------------------------

monomials = st.tuples(st.integers(-9, 9), st.sampled_from(NAMES), st.integers(0, 2))
polynomials = st.lists(monomials, min_size=1, max_size=3).map(
    lambda terms: sum((k * Scalar.symbol(name) ** power for k, name, power in terms), Scalar.of(0))
)
scalars = st.tuples(polynomials, polynomials).map(lambda pair: pair[0] / pair[1] if pair[1] else pair[0])
matrices = st.lists(st.lists(scalars, min_size=2, max_size=2), min_size=2, max_size=2).map(Matrix.of)
scalar_formulas = scalars.map(Literal)
matrix_formulas = st.recursive(
    matrices.map(Literal) | st.just(Letter("A")),
    lambda inner: (
        st.tuples(inner, inner).map(Sum)
        | st.tuples(inner, inner).map(Product)
        | st.tuples(scalar_formulas, inner).map(Product)
        | inner.map(Negative)
        | inner.map(Transpose)
        | st.builds(Power, inner, st.sampled_from((2, -1)))
        | st.builds(Apply, st.just("adj"), inner)
    ),
    max_leaves=3,
)
formulas = (
    matrix_formulas
    | st.builds(Apply, st.just("det"), matrix_formulas)
    | st.tuples(scalar_formulas, scalar_formulas).map(Sum)
    | st.builds(Quotient, scalar_formulas, scalar_formulas)
    | st.tuples(matrix_formulas, matrix_formulas).map(lambda row: Block((row,)))
    | st.tuples(scalar_formulas, scalar_formulas).map(lambda pair: Block(((pair[0],), (pair[1],))))
)
A = Matrix.of([[Scalar.symbol("a"), 1], [Scalar.rational(1, 3), Scalar.symbol("b") / 7]])


@given(formulas)
def test_what_a_formula_evaluates_to_is_bounded(formula: Formula) -> None:
    hold(formula, Environment(values={"A": A}))


@given(
    formulas, scalars.filter(lambda value: not value.names & {"b", "c"}), scalars.filter(lambda v: "c" not in v.names)
)
def test_it_is_bounded_with_named_coefficients_too(formula: Formula, first: Scalar, second: Scalar) -> None:
    hold(formula, Environment(values={"A": A}, coefficients={"b": first, "c": second}))


def test_several_named_coefficients_with_denominators_of_their_own() -> None:
    s, a, b, c = (Scalar.symbol(name) for name in NAMES)
    named = {"a": 1 / (s**2 + 1), "b": 1 / (s**2 + 2), "c": 1 / (s**2 + 3)}
    hold(Literal(a + b + c), Environment(coefficients=named))
