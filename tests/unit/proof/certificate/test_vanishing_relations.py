"""Claims where polynomials are known to vanish: true on the stratum, and only there."""

from __future__ import annotations

import pytest

from symobs.exact import EIGENVALUE, Ideal, Matrix, Scalar, TooLarge
from symobs.formula.tree import Apply, Environment, Letter, Literal, Power, Product, Relation
from symobs.proof.certificate.claims import verify
from symobs.proof.certificate.pointwise import never_together_zero
from tests.support.algebra import seeded

a, b, c, d = (Scalar.symbol(name) for name in "abcd")


def said(left: Scalar | Matrix, operator: str, right: Scalar | Matrix) -> Relation:
    return Relation((Literal(left), Literal(right)), (operator,))


def holds(relation: Relation, *relations: Scalar, **signs: str) -> bool:
    return verify(relation, Environment(relations=relations, signs=signs))[0] == "exact"


def test_an_equation_holds_where_its_difference_lies_in_the_ideal() -> None:
    circle = a**2 + b**2 - 1
    assert holds(said(a**4 - b**4, "=", 1 - 2 * b**2), circle)
    assert not holds(said(a**4 - b**4, "=", 1 - b**2), circle)
    assert not holds(said(a**4 - b**4, "=", 1 - 2 * b**2))
    assert holds(said(Matrix.of([[a, b], [0, a]]), "=", Matrix.of([[b, b], [0, b]])), a - b)


def test_an_inequation_holds_where_there_is_no_common_zero() -> None:
    assert holds(said(a, "!=", b), a * b - 1, a - b - 1)
    assert not holds(said(a, "!=", b), a * b - 1)  # a = b = 1
    assert not holds(said(a, "!=", Scalar.of(0)), a**2 - b)
    assert holds(said(a**2, "!=", Scalar.of(0)), a**2 - b - c, b="positive", c="nonnegative")
    assert holds(said(a, "!==", b), a * b - 1)
    assert not holds(said(a, "!==", b), a - b)


def test_nothing_is_divided_by_what_vanishes() -> None:
    one = Literal(Scalar.of(1))
    over = Product((Literal(a - b), Power(Literal(a - b), -1)))
    assert not holds(Relation((over, one), ("=",)), a - b)
    assert holds(Relation((over, one), ("=",)), a - c)
    assert not holds(said(c / (a - b), "=", c / (a - b)), a - b)
    singular = Environment(values={"X": Matrix.of([[a - b, 0], [0, 1]])}, relations=(a - b,))
    identity = Literal(Matrix.identity(2))
    assert verify(Relation((Product((Letter("X"), Power(Letter("X"), -1))), identity), ("=",)), singular)[0] == ""


def test_a_basis_beyond_the_limits_leaves_the_question_open() -> None:
    generator = seeded(3)
    names = [Scalar.symbol(name) for name in "abcdefgh"]
    dense = [
        sum((Scalar.of(generator.randint(-99, 99)) * x**3 * y**2 * z for x in names for y in names for z in names), -d)
        for _ in range(4)
    ]
    with pytest.raises(TooLarge):
        Ideal.of(dense)
    assert verify(said(dense[0], "=", Scalar.of(0)), Environment(relations=tuple(dense)))[0] == ""


def test_a_rank_is_that_of_every_point() -> None:
    row, zero = Matrix.of([[a, b]]), Matrix.of([[a - b, 0]])

    def ranked(matrix: Matrix, order: int, *relations: Scalar, **signs: str) -> bool:
        return holds(Relation((Apply("rank", Literal(matrix)), Literal(Scalar.of(order))), ("=",)), *relations, **signs)

    assert ranked(row, 1, a + b - 1)  # not both are 0
    assert not ranked(row, 1, a - b)  # at a = b = 0 the rank is 0
    assert ranked(row, 1, a - b, a="positive")
    assert ranked(zero, 0, a - b)
    assert not ranked(zero, 1, a - b)
    assert not ranked(zero, 1, a - b * c)
    assert ranked(row, 1, 1 - c * (a**2 + b**2))


def test_an_eigenvalue_may_be_complex() -> None:
    eigenvalue = Scalar.symbol(EIGENVALUE)
    assert not never_together_zero([a], (eigenvalue**2 + 1,), {})
    assert not holds(said(a, "!=", Scalar.of(0)), eigenvalue**2 + 1)
    assert not holds(said(Scalar.of(1), "=", Scalar.of(2)), eigenvalue**2 + 1)
    assert not holds(said(a, "!=", a), eigenvalue**2 + 1)
    assert not holds(
        Relation((Apply("rank", Literal(Matrix.of([[a]]))), Literal(Scalar.of(1))), ("=",)), a**2 + 1 - b
    ), "b - 1 = a**2 may be 0"
    rank = Apply("rank", Literal(Matrix.of([[eigenvalue, -1], [1, eigenvalue]])))  # singular at both roots ±i
    assert holds(Relation((rank, Literal(Scalar.of(1))), ("=",)), eigenvalue**2 + 1)
    assert not holds(Relation((rank, Literal(Scalar.of(2))), ("=",)), eigenvalue**2 + 1)
    assert holds(said(eigenvalue, "!=", Scalar.of(1)), eigenvalue**2 + 1)
    assert never_together_zero([a], (a**2 + 1,), {}), "a parameter is real"


def test_rows_span_the_same_space_on_the_stratum_and_not_only_in_general() -> None:
    general, whole = Matrix.of([[a, 1], [0, 1]]), Matrix.identity(2)
    assert not holds(said(general, "~", whole), a)
    assert holds(said(general, "~", whole), a - 1)
    assert holds(said(Matrix.of([[1, a]]), "~", Matrix.of([[1, 0]])), a)
    assert not holds(said(Matrix.of([[1, a]]), "~", Matrix.of([[1, 0]])))
