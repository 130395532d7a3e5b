"""Proofs that values are positive, and the checker by products and comparison (trusted).

What is known is a set of values > 0 and the declared signs.  A step adds one value:

- `Combined`: value · Σ cᵢ πᵢ = Σ dⱼ ρⱼ, where the coefficients cᵢ and dⱼ are never negative by the declared signs, the
  products πᵢ and ρⱼ are of values known to be positive, and some dⱼ is surely positive.  The right side is then above 0
  and the sum on the left is not below it, so the value is positive.
- `Opposite`: were the value negative, 0 > 0 would follow; and it is not 0, since a multiple of it is positive.
- `ProvedByZ3`: z3 found no real point where the value is not positive.  The checker asks again.

The value 0 among what is known is a contradiction: everything follows from it, by 0 · anything = 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias, assert_never

from symobs.exact import Scalar, product_of
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.z3_backend import none_by_z3
from symobs.system.conditions import never_zero, sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

ZERO, ONE = Scalar.of(0), Scalar.of(1)
#: A coefficient, and values known to be positive which are multiplied with it.
Product: TypeAlias = tuple[Scalar, tuple[Scalar, ...]]


@dataclass
class Combined:
    """value · (sum of `multiplier`) = sum of `total`."""

    value: Scalar
    multiplier: tuple[Product, ...]
    total: tuple[Product, ...]


@dataclass
class Opposite:
    """`steps` lead from −value > 0 to 0 > 0, and `multiple`, a polynomial multiple of the value, is positive."""

    value: Scalar
    multiple: Scalar
    steps: tuple[Step, ...]


@dataclass
class ProvedByZ3:
    """A verdict of z3: the value is positive wherever the values of `given` are."""

    value: Scalar
    given: tuple[Scalar, ...]


Step: TypeAlias = Combined | Opposite | ProvedByZ3


@dataclass
class Equivalence:
    """Two equivalent lists: `forward` leads from `kept` to `raw`, `backward` back."""

    raw: tuple[Scalar, ...]
    kept: tuple[Scalar, ...]
    forward: tuple[Step, ...]
    backward: tuple[Step, ...]

    def holds(self, signs: Mapping[str, str]) -> bool:
        """Check both directions."""
        return proves(self.forward, self.kept, self.raw, signs) and proves(self.backward, self.raw, self.kept, signs)


def proves(steps: Sequence[Step], known: Sequence[Scalar], goals: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether the steps, each checked, lead from `known` > 0 to every goal > 0."""
    found = set(known)
    for step in steps:
        if not _follows(step, found, signs):
            return False
        found.add(step.value)
    return found.issuperset(goals)


def refutes(steps: Sequence[Step], known: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether the steps prove that the known values are nowhere all positive."""
    return proves(steps, known, (ZERO,), signs)


def _follows(step: Step, known: set[Scalar], signs: Mapping[str, str]) -> bool:
    match step:
        case Combined(value, multiplier, total):
            terms = (*multiplier, *total)
            if not all(known.issuperset(factors) for _, factors in terms):
                return False
            if not all(_is_never_negative(c, signs) for c, _ in terms):
                return False
            return any(sign_of(c, signs) == "positive" for c, _ in total) and value * _sum(multiplier) == _sum(total)
        case Opposite(value, multiple, steps):
            divides = multiple in known and not value.is_zero and (multiple / value).denominator.is_constant
            return divides and refutes(steps, (*known, -value), signs)
        case ProvedByZ3(value, given):
            return known.issuperset(given) and none_by_z3((*given,), signs, not_above=value)
        case _:
            assert_never(step)


def _is_never_negative(coefficient: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether a coefficient is everywhere defined and nonnegative."""
    weak = {"positive", "nonnegative", "zero"}
    return sign_of(coefficient, signs) in weak and never_zero(coefficient.denominator, signs)


def _sum(products: Sequence[Product]) -> Scalar:
    total = ZERO
    for coefficient, factors in products:
        total = total + coefficient * product_of(factors)
    return total


def asks_z3(proof: Equivalence | None) -> bool:
    """Return whether a proof depends on z3."""
    steps = (*proof.forward, *proof.backward) if proof is not None else ()
    return any(_asks(step) for step in steps)


def _asks(step: Step) -> bool:
    return isinstance(step, ProvedByZ3) or (isinstance(step, Opposite) and any(map(_asks, step.steps)))
