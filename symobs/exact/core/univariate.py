"""Coefficients of a multivariate polynomial in one generator."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flint import fmpz, fmpz_mpoly

    from symobs.exact.core.field import Field


def coefficients_in(polynomial: fmpz_mpoly, index: int, source: Field, target: Field) -> list[fmpz_mpoly]:
    """Return the coefficients of the powers of the generator `index` of `source`, highest first, in `target`.

    The target must contain the other generators that occur.
    """
    degree = int(polynomial.degrees()[index])
    if degree == 1:
        lead = polynomial.derivative(index)
        return [target.lift(part, source) for part in (lead, polynomial - lead * source.context.gen(index))]
    places = [target.position.get(name, -1) for name in source.names]
    collected: list[dict[tuple[int, ...], fmpz]] = [{} for _ in range(degree + 1)]
    for powers, coefficient in polynomial.terms():
        monomial = [0] * len(target.names)
        for i, power in enumerate(powers):
            if power and i != index:
                monomial[places[i]] = power
        collected[degree - int(powers[index])][tuple(monomial)] = coefficient
    return [target.context.from_dict(terms) for terms in collected]
