"""Routh's table: against tables worked by hand, a second making in SymPy, and roots found by PARI, never against itself."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from hypothesis import example, given, settings
from hypothesis import strategies as st

from symobs.exact import Scalar, from_coefficients
from symobs.formula.phrases.languages import ENGLISH, Counted
from symobs.formula.tree import Environment, Letter, Sum
from symobs.formula.tree.plain_text import plain_relation
from symobs.proof.derivation import CaseStep, Define, Derivation, Sentence, Tabulate
from symobs.proof.derivation.routh_check import findings_of
from symobs.stability.criteria.routh_table import (
    RouthRow,
    RouthTable,
    imaginary_axis_roots,
    is_routh_table,
    right_half_plane_roots,
    routh_table,
    sign_changes,
)
from tests.kit import scalars, tabled, tables
from tests.support.algebra import value_at
from tests.support.problems.steps import checked, literal, refused, said
from tests.support.sampling import tried
from tests.support.second_reader import changes, expression, located, rows_of
from tests.support.tampering.mutations import changes as changes_of
from tests.support.tampering.mutations import lines_of

if TYPE_CHECKING:
    from collections.abc import Sequence

s, w = Scalar.symbol("s"), Scalar.symbol("w")
h1, h2, h3, h4, b, omega, small = (Scalar.symbol(name) for name in ("h1", "h2", "h3", "h4", "b", "omega", "epsilon"))
CHI = Letter("chi")

#: Where ε does not count right, found by search: standing in two places, or beside two roots on the imaginary axis.
MISCOUNTED_TWICE = tables(Path(__file__))["miscounted_twice"]
MISCOUNTED = tables(Path(__file__))["miscounted"]


def whole(numbers: Sequence[int | Fraction | Scalar]) -> list[Scalar]:
    return [Scalar.of(number) for number in numbers]


def entries(table: RouthTable) -> list[list[Scalar]]:
    return [list(row.entries) for row in table.rows]


def origins(table: RouthTable) -> str:
    """The first letters of how the rows came about."""
    return "".join(row.origin[0] for row in table.rows)


# -- tables worked by hand ----------------------------------------------------------------------------------------------

#: With what came of every row, and of roots on the right and on the axis.


@tabled
def test_tables_with_zeros_worked_by_hand(
    texts: list[Any], expected: list[list[Any]], made: str, where: list[int]
) -> None:
    coefficients = scalars(texts)
    table = routh_table(coefficients)
    assert entries(table) == [scalars(row) for row in expected]
    assert origins(table) == made
    assert not table.is_regular
    assert is_routh_table(table, coefficients)
    assert [right_half_plane_roots(coefficients), imaginary_axis_roots(coefficients)] == where
    assert sign_changes(table) == where[0]


def test_zero_means_identically_zero() -> None:
    """s⁴ + b s³ + 2ω² s² + b ω² s + ω⁴ = (s² + ω²)(s² + b s + ω²)."""
    table = routh_table([Scalar.of(1), b, 2 * omega**2, b * omega**2, omega**4])
    assert origins(table) == "ccrar"
    assert entries(table)[2:] == [[omega**2, omega**4], [2 * omega**2], [omega**4]]
    assert routh_table([Scalar.of(1), b, h1, b * h1 + h2]).is_regular


def test_a_polynomial_has_a_first_coefficient() -> None:
    for refusing in (routh_table, right_half_plane_roots, imaginary_axis_roots):
        for none in ([], whole([0, 1])):
            with pytest.raises(ValueError, match="not zero"):
                refusing(none)
    with pytest.raises(ValueError, match="rational"):
        right_half_plane_roots([Scalar.of(1), b])
    assert not is_routh_table(RouthTable((RouthRow(0, (Scalar.of(0),), "coefficients"),)), whole([0]))


# -- against a second making, Hurwitz and the roots themselves -----------------------------------------------------------

integers = st.lists(st.integers(-4, 4), min_size=2, max_size=8).filter(lambda found: found[0] != 0)
positive = st.lists(st.integers(1, 9), min_size=2, max_size=8)
quadratic = st.sampled_from([[1, 0, 1], [1, 0, 4], [1, 0, -1], [1, 1, 1], [1, -1, 2], [1, 0], [1, 2], [2, -1]])


@st.composite
def with_symmetric_roots(draw: st.DrawFn) -> list[int]:
    """A product of small factors, many of them with roots on the imaginary axis."""
    x = sympy.Symbol("x")
    factors = [sympy.Poly(draw(quadratic), x) for _ in range(draw(st.integers(1, 4)))]
    return [int(c) for c in sympy.prod(factors).all_coeffs()]


@pytest.mark.slow
@given(integers | positive | with_symmetric_roots())
@example([1, 1, 2, 2, 3])
@example([1, 0, 3, 0, 3, 0, 1])
@settings(max_examples=tried(120))
def test_every_row_and_every_count_is_found_again(coefficients: list[int]) -> None:
    table = routh_table(whole(coefficients))
    expected = rows_of([sympy.Integer(c) for c in coefficients], sympy.Symbol("epsilon"))
    assert [(row.power, row.origin) for row in table.rows] == [(row.power, row.origin) for row in expected]
    point = {"epsilon": Fraction(1, 10**9 + 7)}
    for row, (_, again, _) in zip(table.rows, expected, strict=True):
        numbers = [sympy.Rational(expression(e).subs("epsilon", sympy.Rational(1, 10**9 + 7))) for e in again]
        assert [value_at(e, point) for e in row.entries] == [Fraction(int(n.p), int(n.q)) for n in numbers]
    assert is_routh_table(table, whole(coefficients))
    assert sign_changes(table) == changes(expected, sympy.Symbol("epsilon"))
    right, axis = located(coefficients)
    assert (right_half_plane_roots(whole(coefficients)), imaginary_axis_roots(whole(coefficients))) == (right, axis)
    if (axis == 0 and origins(table).count("e") < 2) or table.epsilon == "":
        assert sign_changes(table) == right


# -- the check ------------------------------------------------------------------------------------------------------------

LETTERED = [*map(scalars, tables(Path(__file__))["lettered"]), *map(whole, [*MISCOUNTED, MISCOUNTED_TWICE[0]])]


@pytest.mark.parametrize("coefficients", LETTERED)
def test_every_change_of_a_table_is_seen(coefficients: list[Any]) -> None:
    table = routh_table(whole(coefficients))
    found = list(changes_of(table))
    assert len(found) > 3 * len(coefficients)
    for change in found:
        assert not is_routh_table(change.value, whole(coefficients)), change.where
    for changed in changes_of(tuple(whole(coefficients))):
        if changed.value[0]:
            assert not is_routh_table(table, list(changed.value)), changed.where


def test_epsilon_stands_only_where_it_must() -> None:
    first, second, third = routh_table(whole([1, 2, 3, 1])).rows[:3]
    fourth = RouthRow(0, (Scalar.of(1),), "recurrence")
    for row in (
        replace(third, origin="epsilon"),
        RouthRow(1, (small,), "epsilon"),
        RouthRow(1, (small,), "recurrence"),
    ):
        for name in ("", "epsilon"):
            assert not is_routh_table(RouthTable((first, second, row, fourth), name), whole([1, 2, 3, 1]))
    table = routh_table(whole([1, 0, 3, 2]))
    assert not is_routh_table(replace(table, epsilon=""), whole([1, 0, 3, 2]))
    assert not is_routh_table(replace(table, epsilon="delta"), whole([1, 0, 3, 2]))
    regular = routh_table(whole([1, 2, 3, 1]))
    assert not is_routh_table(replace(regular, epsilon="epsilon"), whole([1, 2, 3, 1]))
    zero_row = routh_table(whole([1, 0, 1]))
    instead = RouthTable((zero_row.rows[0], RouthRow(1, (small,), "epsilon"), zero_row.rows[2]), "epsilon")
    assert not is_routh_table(instead, whole([1, 0, 1]))


def test_a_zero_in_the_first_column_is_no_table() -> None:
    """Cross-multiplied, the row below a zero could be anything."""
    rows = [(3, (1, 3), "coefficients"), (2, (0, 2), "coefficients"), (1, (7,), "recurrence"), (0, (2,), "recurrence")]
    table = RouthTable(tuple(RouthRow(power, tuple(whole(found)), origin) for power, found, origin in rows))
    assert not is_routh_table(table, whole([1, 0, 3, 2]))


def test_an_epsilon_of_the_polynomial_is_not_that_of_the_table() -> None:
    """s³ + ε s + 2, whose table would be made of one ε that is a number and of one that is as small as we like."""
    table = routh_table(whole([1, 0, 3, 2]))
    mixed = routh_table([Scalar.of(1), Scalar.of(0), h1, Scalar.of(2)])
    rows = (replace(row, entries=tuple(e.substitute({"h1": small}) for e in row.entries)) for row in mixed.rows)
    assert not is_routh_table(replace(mixed, rows=tuple(rows)), [Scalar.of(1), Scalar.of(0), small, Scalar.of(2)])
    with_it = replace(table, rows=(RouthRow(3, (Scalar.of(1), small), "coefficients"), *table.rows[1:]))
    assert not is_routh_table(with_it, [Scalar.of(1), Scalar.of(0), small, Scalar.of(2)])


# -- the step -------------------------------------------------------------------------------------------------------------


def shown(
    coefficients: Sequence[Any], signs: dict[str, str] | None = None, variable: str = "s"
) -> tuple[Define, Tabulate]:
    """A polynomial, and its table with all it says."""
    numbers = whole(coefficients)
    table = routh_table(numbers)
    findings = findings_of(table, numbers, variable, signs or {})
    return Define(said(CHI, from_coefficients(numbers, variable))), Tabulate(CHI, table, variable, findings=findings)


SIGNS = {"b": "positive", "omega": "positive"}
START = Environment(signs=SIGNS)


@pytest.mark.parametrize("coefficients", LETTERED)
def test_no_lie_about_a_table_survives(coefficients: list[Any]) -> None:
    derivation = Derivation(shown(coefficients, SIGNS), START)
    _, line = lines_of(derivation)
    tried = 0
    for change in changes_of(line.step):
        refused(change.value, start=line.start)
        tried += 1
    assert tried > 20


def test_what_is_said_is_among_the_findings() -> None:
    define, table = shown([1, 2, 24, 48, -25, -50])
    checked(define, table)
    for finding in table.findings:
        checked(define, replace(table, findings=(finding,)))
    regular = shown([1, 2, 3, 1])
    for steps, key in (
        ((define, table), "routh_positive"),
        ((define, table), "routh_criterion_positive"),
        (regular, "routh_zero_row"),
    ):
        refused(steps[0], replace(steps[1], findings=(Sentence(key),)))


def test_the_table_is_that_of_a_polynomial() -> None:
    define, table = shown([1, 2, 3, 1])
    refused(define, replace(table, polynomial=Sum((CHI, CHI))))
    refused(define, replace(table, variable="w"))
    refused(Define(said(CHI, 1 / (s + 1))), Tabulate(CHI, routh_table(whole([1, 1])), "s"))
    one = 1 / (s + 2)
    refused(Define(said(CHI, (s + 1) * one)), Tabulate(CHI, routh_table([one, one]), "s"))
    refused(Define(said(CHI, 7)), Tabulate(CHI, routh_table(whole([7])), "s"))


def test_nothing_is_divided_by_what_is_known_to_be_zero() -> None:
    steps = shown([1, h1 * h2 - 1, 3, 2])
    checked(*steps)
    refused(*steps, start=Environment(relations=(h1 * h2 - 1,)))
    define, table = steps
    case = CaseStep(said(h1, 0), (("h1", Scalar.of(0)),), (table,))
    refused(define, case)
    there = Tabulate(CHI, routh_table(whole([1, -1, 3, 2])), "s")
    checked(define, replace(case, steps=(there,)))
    checked(*steps, start=Environment(relations=(h1 - 2,)))


@tabled
def test_what_is_said_of_a_table(coefficients: list[Any], signs: dict[str, str], key: str) -> None:
    numbers = scalars(coefficients)
    *_, last = findings_of(routh_table(numbers), numbers, "s", signs)
    assert last.key == key


def test_a_leading_coefficient_that_may_vanish_forbids_a_verdict() -> None:
    """h s³ + s + 1 has a zero in the first column, and at h = 0 its only root is −1."""
    numbers = whole([h1, 0, 1, 1])
    assert located([1, 1]) == (0, 0)
    assert "routh_not_stable" not in {f.key for f in findings_of(routh_table(numbers), numbers, "s", {})}


def test_what_is_said_of_numbers_of_roots_and_of_the_leading_coefficient() -> None:
    def told(coefficients: Sequence[Any]) -> list[str]:
        numbers = whole(coefficients)
        *_, last = findings_of(routh_table(numbers), numbers, "s", {})
        slots = [slot for _, slot in last.slots]
        return [ENGLISH.put(slot) if isinstance(slot, Counted) else plain_relation(slot, "s") for slot in slots]  # type: ignore[arg-type]

    assert told([1, 2, 3, 4, 5]) == ["changes sign twice", "two roots lie"]
    assert told([1, 0, 1]) == ["does not change sign", "no root lies", "two roots lie"]
    assert told([b, 1, omega]) == ["b != 0"]


def test_the_first_auxiliary_polynomial_divides_and_no_other() -> None:
    numbers = whole([1, 0, 2, 0, 1])
    table = routh_table(numbers)
    assert origins(table) == "carar"
    divides = Sentence("routh_divides", (("auxiliary", literal((s**2 + 1) ** 2)),))
    assert divides in findings_of(table, numbers, "s", {})
    assert divides not in findings_of(table, whole([1, 0, 3, 0, 1]), "s", {})
