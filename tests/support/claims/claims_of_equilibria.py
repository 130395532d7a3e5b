"""What equilibria claim of a linear plant ẋ = A x, in plain fractions: A x = 0, and all of the kernel."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import multiply, rank_of, value_at

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold each point that there is at these values to A x = 0, and the largest family to the dimension of the kernel."""
    free = -1
    for point in result.found.points:
        chosen = {name: Fraction(place + 2) for place, name in enumerate(point.free)}
        if not all(_is_so(condition, {**at.point, **chosen}) for condition in point.conditions):
            continue
        x = [[value_at(value, {**at.point, **chosen})] for value in point.values.values()]
        assert not any(map(any, multiply(at.A, x)))
        free = max(free, len(point.free))
    assert result.fields["complete"]
    assert free == len(at.A) - rank_of(at.A)


def _is_so(condition: Any, point: Any) -> bool:
    value = value_at(condition.expression, point)
    return bool({"==": value == 0, "!=": value != 0, ">": value > 0, ">=": value >= 0}[condition.operator])
