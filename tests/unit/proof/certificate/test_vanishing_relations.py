"""Claims where polynomials are known to vanish: true on the stratum, and only there."""

from __future__ import annotations

import pytest

from symobs.exact import EIGENVALUE, Ideal, Matrix, Scalar, TooLarge
from symobs.formula.tree import Apply, Environment, Literal, Relation
from symobs.proof.certificate.claims import verify
from symobs.proof.certificate.pointwise import never_together_zero
from tests.support.algebra import seeded

a, b, d = (Scalar.symbol(name) for name in "abd")


def said(left: Scalar | Matrix, operator: str, right: Scalar | Matrix) -> Relation:
    return Relation((Literal(left), Literal(right)), (operator,))


def holds(relation: Relation, *relations: Scalar, **signs: str) -> bool:
    return verify(relation, Environment(relations=relations, signs=signs))[0] == "exact"


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
