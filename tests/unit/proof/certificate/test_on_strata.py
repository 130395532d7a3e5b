"""Claims where equations hold: what is true in general is shown there, if everything in it has a meaning on the stratum."""

from __future__ import annotations

from typing import Any

import pytest

from symobs.exact import Matrix, Scalar, apart_from_zero
from symobs.formula.tree import Environment, Identity, Literal, Power, Product, Quotient, Relation
from symobs.proof.certificate import claims
from symobs.proof.certificate.claims import verify
from symobs.proof.certificate.pointwise import never_together_zero
from tests.support.problems.steps import a, b

REAL = {"a": "real", "b": "real", "c": "real"}


@pytest.fixture(params=[60, -1], ids=["short", "long"])
def checked(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Check claims where a polynomial vanishes, as short ones are and as long ones are."""
    monkeypatch.setattr(claims, "EXACT_UP_TO", request.param)
    way = "exact" if request.param > 0 else "at "

    def check(relation: Relation, *vanishing: Scalar) -> str:
        how, _ = verify(relation, Environment(relations=vanishing, signs=REAL))
        return "in general" if how.startswith(way) and how else how

    return check


def equal(left: Any, right: Any) -> Relation:
    return Relation((left, right), ("=",))


def matrix(*rows: list[Any]) -> Literal:
    return Literal(Matrix.of([[Scalar.of(entry) for entry in row] for row in rows]))


def test_what_holds_in_general_holds_on_a_stratum(checked: Any) -> None:
    square = equal(Product((Literal(a + b), Literal(a + b))), Literal(a**2 + 2 * a * b + b**2))
    assert checked(square, a**2 + b**3 - 1) == "in general"
    assert checked(equal(Product((Power(matrix([a]), -1), matrix([a]))), Identity(1)), b - 1) == "in general"


def test_nothing_is_divided_by_what_vanishes_on_the_stratum(checked: Any) -> None:
    inverse = equal(Product((Power(matrix([a, 1], [b, 1]), -1), matrix([a, 1], [b, 1]))), Identity(2))
    assert checked(inverse, a - 1) == "in general"
    assert not checked(inverse, a - b)
    quotient = equal(Quotient(Literal(a**2 - a * b), Literal(a - b)), Literal(a))
    assert checked(quotient, a - 1) == "in general"
    assert not checked(quotient, a - b)


def test_values_meet_a_curve_at_points_that_are_not_real_only() -> None:
    # Where a, b and a + b are not 0 the value vanishes for b = -1 alone, and there the curve is a⁴ − a³ + a² − a + 1 = 0,
    # whose roots are roots of unity of order ten.
    apart = [apart_from_zero(value) for value in (a, b, a + b)]
    curve = a**4 - a**3 * b - 2 * a**3 - 2 * a**2 * b**2 - 2 * a**2 * b + a**2 - a * b**3 + 2 * a * b + b**2
    assert never_together_zero([a * b * (b + 1)], [*apart, curve], REAL)
    assert not never_together_zero(
        [a * b * (b - 1)], [*apart, curve], REAL
    )  # there a⁴ − 3a³ − 3a² + a + 1 = 0 has real roots


def test_points_on_a_locus_are_left_out_one_locus_at_a_time() -> None:
    # a = b and a² = b³ meet at 0 and at 1; each is left out by its distance, and neither alone leaves nothing.
    values, curve = [a - b], a**2 - b**3
    zero, unit = apart_from_zero(a**2 + b**2), apart_from_zero((a - 1) ** 2 + (b - 1) ** 2)
    assert never_together_zero(values, [zero, unit, curve], REAL)
    assert not never_together_zero(values, [zero, curve], REAL)
    assert not never_together_zero(values, [unit, curve], REAL)
