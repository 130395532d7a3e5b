"""Conditions of stability in many parameters: against roots, against answers from elsewhere, against other deciders.

At rational points the lists are held against Routh's scheme and the recursion of Schur and Cohn, written without the
kernel, and against isolated roots; whole regions against regions known from other programs, by z3 where it is there.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from flint import fmpz_poly
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import Scalar, from_coefficients
from symobs.formula.expression import parse_scalar
from symobs.stability.criteria.stability_conditions import condition_lists, stable_where
from tests.kit import tabled, tables
from tests.support.algebra import (
    coefficients_at,
    has_sign,
    is_hurwitz,
    random_fraction,
    seeded,
    value_at,
)
from tests.support.sampling import tried
from tests.unit.stability.test_region_proofs import positive_at

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from symobs.stability.inequalities.simplify import Simplified

s = Scalar.symbol("s")
a, b, h1, h2, h3 = (Scalar.symbol(name) for name in ("a", "b", "h1", "h2", "h3"))
NAMES = ["a", "b", "omega", "rho", "J", "L", "R", "K", "M", "m", "l", "g", "t1", "t2", "t3"]
NAMES += [f"{letter}{k}" for letter in "hk" for k in range(1, 8)]


def read(text: str) -> Scalar:
    return parse_scalar(text, dict.fromkeys(NAMES))


def polynomial(text: str) -> Scalar:
    return from_coefficients([read(part) for part in text.split(",")], "s")


def points(names: Iterable[str], signs: Mapping[str, str], count: int, seed: object) -> list[dict[str, Fraction]]:
    generator, names = seeded(seed), sorted(names)
    return [{n: random_fraction(generator, signs.get(n, "real")) / 4 for n in names} for _ in range(count)]


# -- answers known from elsewhere --------------------------------------------------------------------------------------

#: Coefficients, signs, and the conditions found by QEPCAD, z3 or by hand; each must be > 0.

IN_DISCRETE_TIME = tables(Path(__file__))["in_discrete_time"]


def holds_the_same(found: Simplified, expected: Sequence[Scalar], signs: Mapping[str, str]) -> None:
    """The same at rational points, and by z3, asked here in its own way, at all points."""
    names = set().union(*(value.names for value in (*found.positive, *expected)))
    for point in points(names, signs, 150, names):
        assert positive_at(found.positive, point) == positive_at(expected, point), point
    z3 = pytest.importorskip("z3")
    solver, symbols = z3.Solver(), {name: z3.Real(name) for name in names}
    solver.set("timeout", 20_000)
    solver.add(*(symbols[name] > 0 for name in names if signs.get(name) == "positive"))
    sides = []
    for values in (found.positive, expected):
        sums = [
            z3.Sum([c * z3.Product([symbols[n] ** e for n, e in powers] or [z3.RealVal(1)]) for c, powers in v.terms()])
            for v in values
        ]
        sides.append(z3.And([total > 0 for total in sums]))
    solver.add(sides[0] != sides[1])
    assert str(solver.check()) == "unsat"


@tabled
def test_known_regions(text: str, signs: dict[str, str], expected: list[str]) -> None:
    found = stable_where(polynomial(text), "s", signs)
    assert found.equivalence.holds(signs)
    assert found.verdict == ("conditional" if expected else "yes")
    assert len(found.positive) <= len(expected)
    assert found.irredundant
    holds_the_same(found, [read(part) for part in expected], signs)
    for value, point in found.witnesses:
        assert all(has_sign(number, signs.get(n, "real")) for n, number in point.items())
        assert not value_at(value, point) > 0
        assert positive_at([other for other in found.positive if other != value], point)


@pytest.mark.parametrize("name", IN_DISCRETE_TIME)
def test_known_regions_in_discrete_time(name: str) -> None:
    text, expected = IN_DISCRETE_TIME[name]
    found = stable_where(polynomial(text), "s", {}, discrete=True)
    assert found.equivalence.holds({})
    holds_the_same(found, [read(part) for part in expected], {})


@tabled
def test_empty_regions(text: str) -> None:
    found = stable_where(polynomial(text), "s", {})
    assert found.verdict == "no"
    assert found.positive == (Scalar.of(0),)
    assert found.equivalence.holds({})


def test_the_leading_coefficient_may_vanish() -> None:
    assert set(stable_where(a * s + b, "s", {}).positive) == {a * b}
    assert set(stable_where(a * b * s + b, "s", {}).positive) == {a, b**2}  # at b = 0 there is no polynomial
    found = stable_where(a * s**2 + h1 * s + h2, "s", {})
    for point in points(["a", "h1", "h2"], {}, 200, "lead"):
        for value in (point["a"], Fraction(0)):
            here = {**point, "a": value}
            stable = value != 0 and is_hurwitz(coefficients_at(a * s**2 + h1 * s + h2, "s", here))
            assert stable == positive_at(found.positive, here)
    assert stable_where((s + h1) / (1 + a**2), "s", {}).positive == (h1,)
    assert stable_where((a * s + h1) / a, "s", {"a": "negative"}).positive == (-h1,)


# -- roots at random points --------------------------------------------------------------------------------------------


def roots_are_inside(coefficients: list[Fraction], *, discrete: bool) -> bool | None:
    """Whether all isolated roots lie inside; None where an enclosure touches the boundary."""
    common = lcm(*(c.denominator for c in coefficients))
    found: Any = fmpz_poly([int(c * common) for c in reversed(coefficients)]).complex_roots()
    sizes = [(1 - abs(root)) if discrete else -root.real for root, _ in found]
    if any(size.contains(0) for size in sizes):
        return None
    return all(size > 0 for size in sizes)


atoms = st.sampled_from([h1, h2, h3, a, b, a * h1, h1 * h2, h1 + 1, h2 + b, a * (1 - h1), h1**2, h2 * h3])
entries = st.builds(
    lambda number, k, atom: number + k * atom, st.integers(-2, 6), st.sampled_from([1, 1, 2, -1]), atoms
)
declared = st.fixed_dictionaries({"a": st.sampled_from(["positive", "nonzero", "real", "nonnegative"])})


@pytest.mark.slow
@given(st.lists(entries, min_size=1, max_size=4), declared, st.booleans(), st.integers(0, 10**6))
@settings(max_examples=tried(60))
def test_the_simplified_list_the_raw_lists_and_the_roots_agree(
    tail: list[Scalar],
    signs: dict[str, str],
    discrete: bool,  # noqa: FBT001 - drawn
    seed: int,
) -> None:
    about = from_coefficients([Scalar.of(1), *tail], "s")
    signs = {**signs, "b": "positive"}
    found = stable_where(about, "s", signs, discrete=discrete)
    assert found.equivalence.holds(signs)
    raws = condition_lists(about, "s", signs, discrete=discrete)
    for point in points(["a", "b", "h1", "h2", "h3"], signs, 12, seed):
        stable = roots_are_inside(coefficients_at(about, "s", point), discrete=discrete)
        if stable is not None:
            assert [positive_at(list_, point) for list_ in (found.positive, *raws)] == [stable] * 3, point
    for value, point in found.witnesses:
        assert all(has_sign(number, signs.get(name, "real")) for name, number in point.items())
        assert positive_at([other for other in found.positive if other != value], point)
        assert not positive_at([value], point)
    if found.point is not None:
        filled = {**dict.fromkeys(["a", "b", "h1", "h2", "h3"], Fraction(1)), **found.point}
        assert roots_are_inside(coefficients_at(about, "s", filled), discrete=discrete) is not False
