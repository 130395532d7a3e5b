"""How the conditions of a region are written: solved for a parameter, as a box, in cases by signs."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import pytest

from symobs.exact import Scalar
from symobs.stability.criteria.stability_conditions import is_stable_where, stable_where
from symobs.stability.inequalities.decision import sign_cases
from symobs.stability.inequalities.simplify import solved
from tests.kit import scalars, tabled
from tests.support.algebra import has_sign, value_at
from tests.unit.stability.test_region_proofs import points, positive_at

if TYPE_CHECKING:
    from collections.abc import Callable

s, x, y, z, a, b, c = (Scalar.symbol(name) for name in ("s", "x", "y", "z", "a", "b", "c"))
h1, h2 = Scalar.symbol("h1"), Scalar.symbol("h2")
AB = {"a": "positive", "b": "positive"}


@tabled
def test_conditions_solved_for_a_parameter(conditions: list[str], signs: dict[str, str], expected: list[str]) -> None:
    found = solved(scalars(conditions), signs, ["h1", "h2"])
    assert [f"{left} {operator} {right}" for left, operator, right in found] == expected


@pytest.mark.slow
@tabled
def test_cases_by_signs_cover_all_and_say_the_same(conditions: list[str], signs: dict[str, str], count: int) -> None:
    given = scalars(conditions)
    cases = sign_cases(given, ["h1", "h2"], signs)
    assert len(cases) == count
    relations: dict[str, Callable[[Fraction], bool]] = {
        ">": lambda v: v > 0,
        "<": lambda v: v < 0,
        "==": lambda v: v == 0,
    }
    for point in points(signs, 300):
        less = {**point, "a": point["b"] - 1}
        for here in (point, {**point, "c": point["b"]}, {**point, "a": point["b"]}, {**point, "x": Fraction(0)}, less):
            if not all(has_sign(value, signs.get(name, "real")) for name, value in here.items()):
                continue
            met = [c for c in cases if all(relations[o](value_at(v, here)) for v, o in c.when)]
            assert len(met) == 1
            (case,) = met
            assert positive_at(case.conditions.positive, here) == positive_at(given, here)
            assert all(value_at(value, here) == here[name] for name, value in case.substitution.items())
            for left, operator, right in solved(case.conditions.positive, case.signs, ["h1", "h2"], case.assumed):
                difference = value_at(left - right, here)
                told = difference > 0 if operator == ">" else difference < 0
                assert told or not positive_at(given, here)


def test_what_was_declared_of_a_symbol_is_kept_where_it_is_replaced() -> None:
    above, below, equal = sign_cases([(a - b + 1) * h1 - h2], ["h1"], AB)
    assert (above.assumed, below.assumed) == ((a - b + 1,), (b - a - 1,))
    assert equal.substitution == {"a": b - 1}
    assert equal.assumed == (b - 1,)


def test_a_region_said_otherwise_is_proved_or_refused() -> None:
    quartic = s**4 + 3 * s**3 + h1 * s**2 + h2 * s + 1
    bound = h1 - (h2**2 + 9) / (3 * h2)
    assert is_stable_where(quartic, "s", [h2, bound], {})
    assert not is_stable_where(quartic, "s", [h1, bound], {})
    assert not is_stable_where(quartic, "s", [h2], {})
    assert not is_stable_where(quartic, "s", [h2, bound, h2 + 1], {})
    found = stable_where(quartic, "s", {})
    assert is_stable_where(quartic, "s", found.positive, {}, proof=found.equivalence)
    assert not is_stable_where(quartic + s, "s", found.positive, {}, proof=found.equivalence)
    assert not is_stable_where(quartic, "s", [h2], {}, proof=found.equivalence)
    assert not is_stable_where(quartic, "s", found.positive, {}, proof=replace(found.equivalence, forward=()))
