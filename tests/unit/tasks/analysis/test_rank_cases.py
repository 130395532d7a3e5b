"""Rank with cases: the exact exception sets of named plants, and ranks at a thousand points of each by plain fractions.

Expected strata are those of the literature and of hand computation; points on every stratum are found by formulas
written here, and the rank at every point by elimination of fractions.
"""

from __future__ import annotations

import itertools
from copy import copy
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Ideal, Scalar, TooLarge
from symobs.formula.expression import parse_scalar
from symobs.ground.errors import CertificateRejected
from symobs.tasks.analysis.rank import rank_test as missing_measurements
from symobs.tasks.analysis.rank.rank_test import RankResult
from symobs.tasks.analysis.strata.loci import Locus, Region, loci, maximal
from tests.kit import tabled, tables, text_of
from tests.support.algebra import (
    has_sign,
    matrix_at,
    observability_rows,
    random_fraction,
    rank_of,
    seeded,
    value_at,
)
from tests.support.claims.claims import Setting, applicable, conditions_hold, rank_holds
from tests.support.sampling import FULL

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

pytestmark = pytest.mark.slow


POINTS, ON_EACH = (1_000, 25) if FULL else (100, 5)
Point = dict[str, Fraction]


@dataclass(frozen=True)
class Plant:
    """A plant, the signs of its parameters, its exceptions (equations → rank) and ways onto each of them."""

    A: str
    C: str
    signs: Mapping[str, str]
    rank: int
    exceptions: Mapping[str, int] = field(default_factory=dict)
    onto: Sequence[Mapping[str, str]] = ()


def real(names: str) -> dict[str, str]:
    return dict.fromkeys(names.split(), "real")


PLANTS = {name: Plant(**table) for name, table in tables(Path(__file__))["plants"].items()}
every_plant = pytest.mark.parametrize("name", PLANTS)


@cache
def result(name: str) -> RankResult:
    plant = PLANTS[name]
    found = symobs.observability(symobs.StateSpace(plant.A, None, plant.C, symbols=plant.signs))
    assert isinstance(found, RankResult)
    return found


def points(name: str) -> Iterator[Point]:
    """Yield random points, small integers too, then points on every stratum; all respect the declared signs."""
    plant, generator = PLANTS[name], seeded(name)
    for count in range(POINTS):
        if count % 2:
            yield {n: random_fraction(generator, sign) for n, sign in plant.signs.items()}
        else:
            least = {"positive": 1, "nonnegative": 0}
            yield {n: Fraction(generator.randint(least.get(sign, -2), 2)) for n, sign in plant.signs.items()}
    for onto in plant.onto:
        for _ in range(ON_EACH):
            point = {n: random_fraction(generator, sign) for n, sign in plant.signs.items()}
            moved = {**point, **{n: value_at(parse_scalar(text, plant.signs), point) for n, text in onto.items()}}
            if all(has_sign(value, plant.signs[n]) for n, value in moved.items()):
                yield moved


@every_plant
def test_the_exceptions_are_the_expected_ones(name: str) -> None:
    plant, found = PLANTS[name], result(name)
    assert found.fields["rank"] == plant.rank
    expected = {
        (ideal_of([parse_scalar(text, plant.signs) for text in texts.split(",")]), rank)
        for texts, rank in plant.exceptions.items()
    }
    told = {
        (ideal_of([c.expression for c in case.when if c.operator == "=="]), case.result.fields["rank"])
        for case in found.case_tree
        if case.result is not None
    }
    assert told == expected
    assert len(found.case_tree) == len(expected)
    drops = any(rank < plant.rank for rank in plant.exceptions.values())
    full = plant.rank == found.plant.order
    assert found.verdict == ("no" if not full else "conditional" if drops else "yes")
    assert not [c for c in found.holds_where if c.kind == "existence"] or (full and drops)


def ideal_of(equations: list[Scalar]) -> frozenset[str]:
    """Return what two systems of equations have in common exactly when they generate the same ideal."""
    signless = (g if g.factors()[0].fraction() > 0 else -g for g in Ideal.of(equations).generators)
    return frozenset(map(str, signless))


@every_plant
def test_rank_and_kernel_at_every_point(name: str) -> None:
    """At each point exactly what applies there is right, and `conditions` hold exactly where the rank is n."""
    found, special = result(name), 0
    for point in points(name):
        at = Setting.of(found.plant, {}, point)
        rank = rank_of(observability_rows(at.A, at.C))
        parts = list(applicable(found, point))
        here = [case for case in found.case_tree if conditions_hold(case.when, point)]
        if rank < PLANTS[name].rank:
            assert here, point
        special += bool(here)
        for part in parts:
            rank_holds(part, at)
            assert matrix_at(part.plant.matrices.A, point) == at.A
        if found.verdict == "conditional":
            assert conditions_hold(found.holds_where, point) == (rank == len(at.A))
        assert parts or rank < len(at.A)
    assert special >= (ON_EACH if PLANTS[name].onto else 0) // 2


@every_plant
def test_what_is_missing_repairs_it(name: str) -> None:
    """With a set of states measured too the rank is n at random points of the case; no smaller set does it there."""
    found = result(name)
    for point in itertools.islice(points(name), POINTS - 20, None):
        at = Setting.of(found.plant, {}, point)
        for part in applicable(found, point):
            sets = part.fields["missing_measurements"]
            order = len(at.A)
            assert bool(sets) == (part.fields["rank"] < order)
            for numbers in sets:
                rows = [[Fraction(int(i + 1 == number)) for i in range(order)] for number in numbers]
                assert rank_of(observability_rows(at.A, [*at.C, *rows])) == order


# -- nothing else is accepted -------------------------------------------------------------------------------------------


def test_a_minor_must_not_vanish_anywhere_on_its_stratum() -> None:
    """On a = c of diag(a, b, c) the rank is 2 only where b ≠ c: without that inequation the claim is refused."""
    (part,) = (c.result for c in result("diag(a, b, c)").case_tree if str(c.when[0]) == "a - b == 0")
    with pytest.raises(CertificateRejected):
        replace(part, piece=replace(part.piece, conditions=()))  # type: ignore[type-var, union-attr]


# -- limits --------------------------------------------------------------------------------------------------------------


def generic(order: int) -> symobs.StateSpace:
    A = [[f"a{i}{j}" for j in range(order)] for i in range(order)]
    return symobs.StateSpace(A, None, [[f"c{j}" for j in range(order)]])


def test_what_cannot_be_written_down_is_undecided() -> None:
    found: Any = symobs.observability(generic(5))
    assert (found.verdict, found.fields["rank"], found.fields["determinant"]) == ("undecided", 5, None)
    assert found.holds_where == ()
    assert "too long to display" in text_of(found)


# -- loci -----------------------------------------------------------------------------------------------------------------


@tabled
def test_loci(equations: list[str], signs: dict[str, str], expected: list[str]) -> None:
    names = real("a b c") | signs
    found = loci([parse_scalar(text, names) for text in equations], Region(names))
    wanted = {ideal_of([parse_scalar(text, names) for text in texts.split(",")]) for texts in expected}
    assert {ideal_of(list(locus.equations)) for locus in found} == wanted


# -- searches that give up -------------------------------------------------------------------------------------------------


def too_large(*_: Any) -> Any:
    raise TooLarge("too large")


def test_a_set_of_measurements_is_not_refused_because_of_minors_that_were_not_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first minor with states 1 and 2 is k; the next is 1."""
    plant = symobs.StateSpace("[0 0 k; 0 0 1; 0 0 0]", C="[0 0 0]")
    assert symobs.observability(plant).fields["missing_measurements"] == [[1, 2]]
    monkeypatch.setattr(missing_measurements, "_MINORS", (1, 1))
    assert symobs.observability(symobs.StateSpace(plant.A, C=plant.C)).fields["missing_measurements"] is None


def test_a_locus_of_which_it_is_not_decided_leaves_the_rank_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    class Long(Ideal):
        __contains__ = too_large

    locus, other = (Locus.of(Ideal.of([Scalar.symbol(name)])) for name in "ab")
    assert not locus.lies_in(other)
    long = copy(locus.ideal)
    object.__setattr__(long, "__class__", Long)
    with pytest.raises(TooLarge):
        Locus(locus.equations, long).lies_in(other)
    square, wide = ("[a 0; 0 b]", None, "[c d]"), ("[a 0; 0 b]", None, "[c d; c c]")
    known = symobs.observability(symobs.StateSpace(*square)).conditions
    monkeypatch.setattr(Locus, "lies_in", too_large)
    assert maximal([locus, other]) == (locus, other)
    found = symobs.observability(symobs.StateSpace(*square))
    assert (found.verdict, set(found.conditions)) == ("conditional", set(known))  # where det O = c d (b − a) is not 0
    assert symobs.observability(symobs.StateSpace(*wide)).verdict == "undecided"
