"""Properties that no equation states, and where they hold: what is said of them is decided, and nothing else is accepted."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment, HoldsExactlyWhere, Letter, Predicate
from symobs.proof.derivation.facts import (
    PREDICATES,
    is_criterion,
    is_exactly,
    needed,
    on_stratum,
    polynomial_of,
    subjects,
)
from tests.kit import member, scalar, scalars, tabled
from tests.support.problems.steps import said

if TYPE_CHECKING:
    from symobs.formula.tree import Relation

s, z, a, b, c, h, k, m = (Scalar.symbol(name) for name in "szabchkm")
SIGNS = {"a": "positive", "b": "negative", "c": "real", "m": "nonnegative"}
IN_S, IN_Z = Environment(signs=SIGNS), Environment(variable="z", signs=SIGNS)


def has(name: str, value: Scalar, *, discrete: bool = False) -> bool:
    return PREDICATES[name](value, IN_Z if discrete else IN_S, discrete)


@tabled
def test_a_property_is_decided(name: str, value: str, *, discrete: bool, expected: bool) -> None:
    assert has(name, scalar(value), discrete=discrete) is expected


@tabled
def test_a_matrix_has_the_property_of_all_its_entries(name: str, rows: list[list[str]], found: list[str]) -> None:
    """Stability is that of a common denominator, whose sign is free; what is found of none is no property of it."""
    table = Matrix.of([scalars(row) for row in rows])
    if not found:
        with pytest.raises(TypeError, match=f"{name} is no property of this matrix"):
            subjects(name, table, "s")
        return
    wanted = tuple(scalars(found))
    assert subjects(name, table, "s") in {wanted, tuple(-value for value in wanted)}


def test_only_values_have_properties() -> None:
    assert subjects("stable", s + 1, "s") == (s + 1,)
    with pytest.raises(TypeError, match="str is not a scalar"):
        subjects("stable", "text", "s")


@tabled
def test_the_criterion_is_said_whole_and_up_to_positive_factors(
    name: str, polynomial: str, values: list[str], *, expected: bool
) -> None:
    assert is_criterion(name, scalar(polynomial), scalars(values), IN_S, discrete=False) is expected


def test_a_criterion_is_that_of_its_time() -> None:
    found = needed("stable", z + h, IN_Z, discrete=True)
    assert is_criterion("stable", z + h, found, IN_Z, discrete=True)
    assert not is_criterion("stable", z + h, found, IN_Z, discrete=False)


# -- exactly where ------------------------------------------------------------------------------------------------------


def relations(rows: list[list[Any]]) -> list[Relation]:
    return [said(*map(member, parts)) for parts in rows]


def exactly(polynomial: Scalar, *where: Relation, name: str = "stable", known: Environment = IN_S, **more: Any) -> bool:
    fact = HoldsExactlyWhere(Predicate(name, Letter("chi")), where)
    return is_exactly(fact, polynomial, known, discrete=more.get("discrete", False))


@tabled
def test_two_inequalities_for_two_coefficients(where: list[list[Any]], *, expected: bool) -> None:
    assert exactly(s**2 + h * s + k, *relations(where)) is expected


@tabled
def test_where_a_property_holds(
    name: str, polynomial: str, where: list[list[Any]], here: list[list[Any]], *, expected: bool
) -> None:
    """No list says a hole, but the region does; limits of stability are not strict; where h > 0 is known it is not said."""
    discrete = "z" in polynomial
    known = reduce(lambda known, case: on_stratum(case, {}, known), relations(here), IN_Z if discrete else IN_S)
    found = exactly(scalar(polynomial), *relations(where), name=name, known=known, discrete=discrete)
    assert found is expected


@pytest.mark.parametrize("operators", [(">",), (">", ">", ">")])
def test_a_chain_has_an_operator_for_every_link(operators: tuple[str, ...]) -> None:
    with pytest.raises(ValueError, match="zip"):
        exactly(s + h, replace(said(h, ">", 0, ">", -1), operators=operators))


def test_roots_on_the_axis_may_not_meet() -> None:
    d = Scalar.symbol("d")
    known = Environment(signs={"a": "positive", "d": "positive"})
    pairs = (s**2 + a) * (s**2 + d)
    is_marginal = PREDICATES["marginal"]
    assert is_marginal(pairs, known, False) is False  # noqa: FBT003 - positional there
    for where in ("nonzero", "domain"):
        conditions: dict[str, Any] = {where: (a - d,)}
        assert is_marginal(pairs, replace(known, **conditions), False) is True  # noqa: FBT003 - positional there


def test_a_coefficient_that_vanishes_where_the_relations_hold_is_no_part_of_a_polynomial() -> None:
    there = replace(IN_S, relations=(c**2 - 3 * c + 2,))
    discrete = IN_S.variable == "z"
    marginal = s**2 + s + (c**2 - 3 * c + 2)  # a root is 0 where c is 1 or 2
    assert PREDICATES["unstable"](marginal, there, discrete)
    assert not PREDICATES["unstable"](marginal, IN_S, discrete)
    assert not PREDICATES["stable"](marginal, there, discrete)
    assert not PREDICATES["unstable"](marginal + 1, there, discrete)
    assert polynomial_of((c**2 - 3 * c + 2) * s**2 + s + 1, there) == s + 1
