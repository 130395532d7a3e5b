"""Factorisation of the conditions of a list, with the proof steps in both directions."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import Scalar, product_of
from symobs.exact.algebraic.rational_points import value_at
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.proof import Combined, Step
from symobs.stability.inequalities.proof_steps import UNIT, by_signs, is_product, is_quotient
from symobs.stability.inequalities.prover import prove, prove_by_opposite
from symobs.stability.inequalities.sample_points import find_points
from symobs.system.conditions import FACTORED_UP_TO, sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


def cleared(value: Scalar) -> Scalar:
    """Return a polynomial of the same sign as a rational function."""
    return value.numerator * value.denominator


@dataclass(frozen=True)
class InequalitySystem:
    """A list of conditions, the steps from it to the original list, and the steps from the original list to it."""

    current: tuple[Scalar, ...]
    forward: tuple[Step, ...] = ()
    backward: tuple[Step, ...] = ()

    def replaced(
        self, old: Scalar, new: Sequence[Scalar], forward: Sequence[Step], backward: Sequence[Step] = ()
    ) -> InequalitySystem:
        """Replace one value: `forward` leads back to it from the new list, `backward` from it to the new values."""
        place = self.current.index(old)
        current = dict.fromkeys((*self.current[:place], *new, *self.current[place + 1 :]))
        return replace(
            self,
            current=tuple(current),
            forward=(*forward, *self.forward),
            backward=(*self.backward, *backward),
        )

    def without(self, value: Scalar) -> tuple[Scalar, ...]:
        """Return the other conditions."""
        return tuple(other for other in self.current if other != value)


def split_into_factors(state: InequalitySystem, value: Scalar, signs: Mapping[str, str]) -> InequalitySystem:
    """Replace a value by its factors of uncertain sign, without squares and factors that are never negative."""
    if sign_of(value, signs) == "positive":
        return state.replaced(value, (), (by_signs(value),))
    if value.is_constant or value.size > FACTORED_UP_TO:
        return state
    unit, factors = value.factors()
    odd, even, weak = Scalar.of(1 if sign_of(unit, {}) == "positive" else -1), list[Scalar](), list[Scalar]()
    forward, known = list[Step](), list[Scalar]()
    for factor, power in factors:
        sign = sign_of(factor, signs)
        if sign in {"negative", "nonpositive"} and power % 2:
            odd = -odd
        if sign in {"positive", "negative"} or (power % 2 == 0 and sign == "nonzero"):
            continue
        if sign in {"nonnegative", "nonpositive"}:
            weak.append(factor if sign == "nonnegative" else -factor)
            known += [weak[-1]] * power
        elif power % 2:
            odd = odd * factor
            known += [factor**2] * (power // 2)
        else:
            even.append(factor**2)
            known += [factor**2] * (power // 2)
    for square in {factor for factor in known if factor not in even and factor not in weak}:
        rest = odd * odd / square
        forward.append(Combined(square, ((rest, ()),), ((Scalar.of(1), (odd, odd)),)))
    above = () if odd.is_one else (odd,)
    certain = value / product_of([*known, *above])
    forward.append(Combined(value, UNIT, ((certain, (*known, *above)),)))
    backward = [is_quotient(odd, value, (), value / odd)] if above else []
    backward += [is_quotient(part, value, above, value / odd / part) for part in [*even, *weak]]
    new = (*above, *even, *weak)
    return state if new == (value,) else state.replaced(value, new, forward, backward)


def _odd_factors(value: Scalar) -> tuple[Scalar, ...]:
    """Return the odd factors of a product; nothing for a square or a long polynomial."""
    if value.size > FACTORED_UP_TO:
        return ()
    factors = value.factors()[1]
    return tuple(factor for factor, _ in factors) if all(power == 1 for _, power in factors) else ()


def split_products(state: InequalitySystem, signs: Mapping[str, str], given: Sequence[Scalar] = ()) -> InequalitySystem:
    """Split products as long as the other conditions imply the sign of a factor."""
    waiting = _products(state, given)
    while waiting:
        split = _split_one(state, waiting.pop(), signs)
        if split is not None:
            state, waiting = split, _products(split, given)
    return state


def _products(state: InequalitySystem, given: Sequence[Scalar]) -> list[Scalar]:
    return [value for value in state.current if value not in given and len(_odd_factors(value)) > 1]


def _split_one(state: InequalitySystem, value: Scalar, signs: Mapping[str, str]) -> InequalitySystem | None:
    others, points = state.without(value), find_points(state.current, signs)
    either = [sign * factor for factor in _odd_factors(value) for sign in (1, -1)]
    oriented = [factor for factor in either if all(value_at(factor, point) > 0 for point in points)]
    for factor in oriented:
        lemma = prove(factor, others, signs)
        if lemma is not None:
            rest = value / factor
            forward = (*lemma, is_product(value, (factor, rest)))
            return state.replaced(value, (rest,), forward, (*lemma, is_quotient(rest, value, (factor,))))
    for factor in oriented:
        lemma = prove_by_opposite(factor, value, others, signs)
        if lemma is not None:
            rest = value / factor
            backward = (*lemma, is_quotient(rest, value, (factor,)))
            return state.replaced(value, (factor, rest), (is_product(value, (factor, rest)),), backward)
    return None
