"""Finitely many points: SymPy's lexicographic Gröbner bases are the independent computation."""

from __future__ import annotations

import sympy
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from symobs.exact import Ideal, Scalar
from symobs.exact.ideals import conjugate_points
from symobs.formula.expression import parse_scalar
from tests.kit import tabled

a, b, c = (Scalar.symbol(name) for name in "abc")


def in_sympy(value: Scalar) -> sympy.Expr:
    return sympy.Poly.from_dict(
        {tuple(dict(monomial).get(name, 0) for name in "abc"): k for k, monomial in value.each_term()},
        *sympy.symbols("a b c"),
    ).as_expr()


def basis(equations: list[Scalar], *names: str) -> set[sympy.Expr]:
    found = sympy.groebner([in_sympy(e) for e in equations], *map(sympy.Symbol, names), order="lex")
    return {sympy.Poly(each, *map(sympy.Symbol, names)).monic().as_expr() for each in found.exprs}


def monic(equations: tuple[Scalar, ...], *names: str) -> set[sympy.Expr]:
    return {sympy.Poly(in_sympy(e), *map(sympy.Symbol, names)).monic().as_expr() for e in equations}


@st.composite
def curves(draw: st.DrawFn) -> Scalar:
    found = Scalar.of(0)
    for i, j in draw(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 2)), min_size=2, max_size=4, unique=True)):
        found += draw(st.sampled_from([-2, -1, 1, 2, 3])) * a**i * b**j
    return found


@settings(max_examples=60)
@given(curves(), curves())
def test_parts_of_the_points_where_two_curves_meet(one: Scalar, other: Scalar) -> None:
    ideal = Ideal.of((one, other))
    quotient = ideal.quotient if not ideal.is_whole and ideal.field.names == ("a", "b") else None
    assume(quotient is not None and 1 < quotient.dimension <= 9)
    assert quotient is not None
    minimal = quotient.minimal_polynomial(b, "b")
    for factor, _ in minimal.factors()[1]:
        wanted = basis([one, other, factor], "a", "b")
        found = quotient.by_coordinate("b", factor, minimal)
        if found is None:
            assert len(wanted) != 2 or max(sympy.degree(each, sympy.Symbol("a")) for each in wanted) > 1
        else:
            assert monic(found, "a", "b") == wanted


@tabled
def test_systems_that_one_coordinate_solves(texts: list[str]) -> None:
    equations = [parse_scalar(text) for text in texts]
    found = conjugate_points(equations)
    assert found is not None
    assert found[0] == "b"
    names = sorted({name for equation in equations for name in equation.names} - {"b"})
    assert monic(found[1], *names, "b") == basis(equations, *names, "b")


@tabled
def test_other_systems_are_left_alone(texts: list[str]) -> None:
    assert conjugate_points([parse_scalar(text) for text in texts]) is None


def test_no_point_is_no_function() -> None:
    assert Ideal.of((a * b - 1, a)).dimension == 0
    assert Ideal.of((b**9 - 2, a - b, a**2 + 1)).is_whole


@settings(max_examples=10)
@given(curves(), curves(), curves())
@example(a**2 + b, a**3 * b + a**2 - 2, 3 * a * b**2 - a**3 + 1)
@example(2 * b**2 + 3 * a**2 * b**2 + a, -2 * a**2 - 2 * a**2 * b - a**3 * b**2, a + 3 * b**2 - a**3)
def test_a_basis_is_the_reduced_one(one: Scalar, other: Scalar, third: Scalar) -> None:
    ideal = Ideal.of((one, other, third))
    assume(ideal.coordinate is None and not ideal.is_whole)
    symbols = [sympy.Symbol(name) for name in ideal.field.names]
    found = sympy.groebner([in_sympy(each) for each in (one, other, third)], *symbols, order="grevlex")
    wanted = {sympy.Poly(each, *symbols).monic().as_expr() for each in found.exprs}
    assert monic(ideal.generators, *ideal.field.names) == wanted
