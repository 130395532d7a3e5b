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
from tests.kit import member, scalar, tabled
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


def test_a_matrix_has_the_property_of_all_its_entries() -> None:
    table = Matrix.of([[1 / (s + 1), 1 / (s + 2)]])
    assert subjects("strictly_proper", table, "s") == (1 / (s + 1), 1 / (s + 2))
    for name in ("stable", "unstable"):
        (value,) = subjects(name, table, "s")
        assert value in {(s + 1) * (s + 2), -(s + 1) * (s + 2)}
        for constant in (Matrix.identity(2), Matrix.of([[1 / c, 1]]), Matrix.of([[s, s + 1]])):
            with pytest.raises(TypeError, match=f"{name} is no property of this matrix"):
                subjects(name, constant, "s")
    for name in ("polynomial", "not_polynomial", "never_zero", "marginal", "beyond", "no_stable_compensator"):
        with pytest.raises(TypeError, match="is no property of this matrix"):
            subjects(name, table, "s")
    assert subjects("stable", Matrix.of([[1 / (s + 1), 2 / (s + 1)]]), "s") in {(s + 1,), (-s - 1,)}
    for one in (s + 1, Matrix.of([[s + 1]])):
        assert subjects("stable", one, "s") == (s + 1,)
    entries = subjects("strictly_proper", Matrix.of([[1, s], [2, 3]]), "s")
    assert entries == (Scalar.of(1), s, Scalar.of(2), Scalar.of(3))
    for other in (Matrix.of([[s + 1], [s + 2]]), Matrix.of([[s + 1, s + 2]])):
        with pytest.raises(TypeError, match="never_zero is no property of this matrix"):
            subjects("never_zero", other, "s")
    with pytest.raises(TypeError, match="str is not a scalar"):
        subjects("stable", "text", "s")


def test_the_criterion_is_said_whole_and_up_to_positive_factors() -> None:
    polynomial = s**2 + h * s + k

    def says(*values: Scalar, name: str = "stable") -> bool:
        return is_criterion(name, polynomial, values, IN_S, discrete=False)

    for right in ((h, k), (k, h), (a * h, k), (h, -b * k), (h, k, 2 * h)):
        assert says(*right)
    for wrong in (
        (),
        (h,),
        (k,),
        (h, -k),
        (-h, k),
        (h, b * k),
        (h, c * k),
        (h, m * k),
        (h, k, c),
        (h, k - 1),
        (h, k, 1 / h),
    ):
        assert not says(*wrong)
    assert not says(h, k, name="unstable")
    assert not is_criterion("stable", s + a, (a,), IN_S, discrete=False)
    assert not is_criterion("stable", s + h, (), IN_S, discrete=False)
    assert is_criterion("stable", z + h, needed("stable", z + h, IN_Z, discrete=True), IN_Z, discrete=True)
    assert not is_criterion("stable", z + h, needed("stable", z + h, IN_Z, discrete=True), IN_Z, discrete=False)


# -- exactly where ------------------------------------------------------------------------------------------------------


def exactly(polynomial: Scalar, *where: Relation, name: str = "stable", known: Environment = IN_S, **more: Any) -> bool:
    fact = HoldsExactlyWhere(Predicate(name, Letter("chi")), where)
    return is_exactly(fact, polynomial, known, discrete=more.get("discrete", False))


@tabled
def test_two_inequalities_for_two_coefficients(where: list[list[Any]], *, expected: bool) -> None:
    assert exactly(s**2 + h * s + k, *(said(*map(member, parts)) for parts in where)) is expected


def test_with_more_parameters_the_lists_are_compared_and_proved() -> None:
    polynomial = s**3 + h * s**2 + k * s + Scalar.symbol("l")
    last = Scalar.symbol("l")
    assert exactly(polynomial, said(h, ">", 0), said(h * k, ">", last), said(last, ">", 0))
    assert exactly(polynomial, said(k, ">", 0), said(h * k, ">", last), said(last, ">", 0)), "another list, proved"
    assert not exactly(polynomial, said(h, ">", 0), said(k, ">", 0), said(last, ">", 0))
    assert not exactly(polynomial, said(h, ">", 0), said(h * k, ">", last))
    assert not exactly(polynomial, said(h, ">", 0), said(h * k, "<", last), said(last, ">", 0))
    assert not exactly(polynomial)
    assert not exactly(s + a), "nothing is said"
    for operators in ((">",), (">", ">", ">")):
        with pytest.raises(ValueError, match="zip"):
            exactly(s + h, replace(said(h, ">", 0, ">", -1), operators=operators))


def test_where_one_point_is_left_out() -> None:
    """s² + s + h² is stable where h is not 0."""
    assert exactly(s**2 + s + h**2, said(h, "!=", 0))
    assert not exactly(s**2 + s + h**2, said(h, ">", 0))
    assert not exactly(s**2 + s + h**2, said(h, "!=", 1))
    cut = s**2 + s + (h - 1) ** 2 * (2 - h)
    assert exactly(cut, said(h, "<", 2), said(h, "!=", 1)), "no list says it, but the region does"
    assert not exactly(cut, said(h, "<", 2))
    assert not exactly(cut, said(h, "<", 2), said(h, ">", 1))
    assert not exactly(cut, said(h, "<", 2), said(h, "!=", 0))
    assert exactly(s**2 + s + h**2 * a, said(h, "!=", 0))
    assert not exactly(s**2 + s + h**2 * a, said(h, "!=", 1))


def test_limits_of_stability_are_not_strict() -> None:
    assert exactly(s + h, said(h, ">=", 0), name="marginal")
    assert exactly(s + h, said(0, "<=", h), name="marginal")
    for wrong in (said(h, ">", 0), said(h, "<=", 0), said(0, "<", h), said(h, "!=", 0), said(h, ">=", 1)):
        assert not exactly(s + h, wrong, name="marginal")
    assert not exactly(s + h, name="marginal")
    assert not exactly(s + h, said(h, ">=", 0))
    assert exactly(s + h, said(h, ">", 0))
    for name in ("unstable", "beyond"):
        for operator in (">", ">=", "<"):
            assert not exactly(s + h, said(h, operator, 0), name=name)
    assert exactly(z + h, said(h, ">=", -1), said(h, "<=", 1), name="marginal", known=IN_Z, discrete=True)
    assert not exactly(z + h, said(h, ">=", 0), name="marginal", known=IN_Z, discrete=True)


def test_what_is_above_zero_here_has_a_sign() -> None:
    """Where h > 0, s² + h s + k is stable exactly where k > 0; and so where −h < 0."""
    polynomial = s**2 + h * s + k

    def where(*cases: Relation) -> Environment:
        return reduce(lambda known, case: on_stratum(case, {}, known), cases, IN_S)

    for cases in ((said(h, ">", 0),), (said(c, ">", 0), said(h, ">", 0)), (said(0, "<", h),)):
        assert exactly(polynomial, said(k, ">", 0), known=where(*cases))
    assert exactly(s**2 - h * s + k, said(k, ">", 0), known=where(said(h, "<", 0)))
    for case in (said(h, "<", 0), said(h, ">", -1), said(2 * h + c, ">", 0)):
        assert not exactly(polynomial, said(k, ">", 0), known=where(case))


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
