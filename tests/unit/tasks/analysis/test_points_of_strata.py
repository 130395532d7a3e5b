"""Finitely many points: those that no coordinate tells apart, those that are not real, those where there is no plant."""

from __future__ import annotations

import symobs
from symobs.exact import Scalar
from symobs.pages.formats.json import result_object
from symobs.tasks.analysis.strata.loci import Region, loci

a, b = (Scalar.symbol(name) for name in "ab")
REAL = {"a": "real", "b": "real"}


def found(*equations: Scalar, region: Region | None = None) -> set[frozenset[str]]:
    return {frozenset(map(str, locus.equations)) for locus in loci(equations, region or Region(REAL))}


def test_points_that_no_coordinate_tells_apart_are_two_loci() -> None:
    assert found(a**2 - 2, b**2 - 2) == {frozenset({"a + b", "b**2 - 2"}), frozenset({"a - b", "b**2 - 2"})}
    assert found(a**2 - 2, b**2 - 3) == {frozenset({"a**2 - 2", "b**2 - 3"})}  # conjugate to each other, all four


def test_points_that_are_not_real_are_none() -> None:
    assert found(a**2 - 2, b**2 + a**2 + 1) == set()
    # With a real the other cube roots of 2 are not; of the nine points one is real.
    assert found(a**3 - 2, b**3 - 2) == {frozenset({"a - b", "b**3 - 2"})}
    assert found(a**3 - 2, a**2 + a * b + b**2) == set()
    # Two different fifth roots of 2: their sum may be real, the one and twice the other never are in sum.
    assert found(a**5 - 2, a**4 + a**3 * b + a**2 * b**2 + a * b**3 + b**4) == set()


def test_where_a_denominator_vanishes_there_is_no_stratum() -> None:
    plant = Region(REAL, frozenset({a + b}))
    assert found(a - 1, b + 1, region=plant) == set()
    assert found(a - 1, b - 1, region=plant) == {frozenset({"a - 1", "b - 1"})}


def test_different_irreducible_polynomials_in_one_name_have_no_zero_in_common() -> None:
    # Every product has a+1 or a-1; with its other factors there are ten thousand systems, and no common zero.
    products = [(a + 1 - 2 * (k % 2)) * (a**3 + k * a + 1) * (a**5 - k * a - 7) for k in range(1, 12)]
    region = Region(REAL)
    assert found(*products, region=region) == set()
    assert region.work.left > 0


def test_a_curve_where_all_is_as_in_general_is_no_condition_of_a_transfer_function() -> None:
    A = "[a a^2-1 a-1; -a a -a; 0 1 a]"
    plant = symobs.StateSpace(A, "[a^2-1 0; -a a; -a a]", "[a^2-1 a -a]", symbols={"a": "real"})
    answer = result_object(symobs.transfer_function(plant))
    alone = {case["when"][0].removesuffix(" == 0") for case in answer["cases"] if len(case["when"]) == 1}
    assert {text.removesuffix(" != 0") for text in answer["conditions"]} == alone
    assert "a + 1" not in alone
