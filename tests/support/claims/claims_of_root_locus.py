"""What a root locus claims, in plain fractions: p and q by the closed loop u = −y, stability at some gains."""

from __future__ import annotations

from fractions import Fraction
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

from tests.support.algebra import characteristic, coefficients_at, multiply, subtract
from tests.support.regions.region_answers import holds as relations_hold

if TYPE_CHECKING:
    from tests.support.algebra import Polynomial
    from tests.support.claims.claims import Setting

_GAINS = (Fraction(1, 3), Fraction(1), Fraction(7))


def holds(result: Any, at: Setting) -> None:
    """Hold p + k q to det(sI − A + B k C), and the gains with stability to Routh's or Jury's test at some of them."""
    p, q = (coefficients_at(result.answer[name], result.plant.variable, at.point) for name in ("p", "q"))
    assert not any(map(any, at.D))
    names = sorted(at.point.keys() - {"k"})
    for k in _GAINS:
        moved = _sum(p, q, k)
        assert moved == characteristic(subtract(at.A, multiply([[k * b for b in row] for row in at.B], at.C)))
        inside = relations_hold(result.stable_if, [*names, "k"])([*(at.point[name] for name in names), k])
        assert inside == at.is_stable(moved)


def _sum(p: Polynomial, q: Polynomial, k: Fraction) -> Polynomial:
    pairs = zip_longest(reversed(p), reversed(q), fillvalue=Fraction(0))
    return [a + k * b for a, b in pairs][::-1]
