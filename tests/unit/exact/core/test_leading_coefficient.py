"""The leading coefficient of a polynomial, against its terms, and its time against that of the kernel."""

from __future__ import annotations

import random
from time import process_time
from timeit import repeat
from typing import Any

import pytest
from flint import Ordering, fmpz_mpoly_ctx

from symobs.exact.core.ring import leading_coefficient


def by_terms(polynomial: Any, foreign: list[int]) -> Any:
    """Return the coefficient of the highest powers of these generators, by sorting the terms."""
    highest = max(tuple(powers[i] for i in foreign) for powers, _ in polynomial.terms())
    found = {
        tuple(0 if i in foreign else power for i, power in enumerate(powers)): c
        for powers, c in polynomial.terms()
        if tuple(powers[i] for i in foreign) == highest
    }
    return polynomial.context().from_dict(found)


@pytest.mark.parametrize("order", [Ordering.lex, Ordering.deglex, Ordering.degrevlex])
def test_the_leading_coefficient_is_that_of_the_terms(order: Ordering) -> None:
    chance = random.Random(1)  # noqa: S311 - repeats
    context = fmpz_mpoly_ctx.get(tuple("abcde"), order)
    for _ in range(100):
        powers = [tuple(chance.choice([0, 0, 1, 2, 3, 5000]) for _ in range(5)) for _ in range(chance.randint(1, 30))]
        polynomial = context.from_dict({each: chance.randint(1, 9) for each in powers})
        foreign = sorted(chance.sample(range(5), chance.randint(0, 5)))
        assert leading_coefficient(polynomial, foreign) == by_terms(polynomial, foreign)


def test_the_leading_coefficient_takes_the_time_of_the_kernel() -> None:
    """The ratio to the kernel's own division, in one process: 1, and more than 100 for a loop over the terms in Python."""
    context = fmpz_mpoly_ctx.get(tuple("abcdefgh"), Ordering.lex)
    sums = [sum(context.gens()[k:], context.constant(k)) for k in range(4)]
    polynomial, last = sums[0] ** 4 * sums[1] ** 2 * sums[2], context.gen(7)
    alone = min(repeat(lambda: polynomial // last**7, number=10, repeat=5, timer=process_time))
    assert (
        min(repeat(lambda: leading_coefficient(polynomial, [7]), number=10, repeat=5, timer=process_time)) < 4 * alone
    )
