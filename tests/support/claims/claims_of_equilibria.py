"""What equilibria claim: f = 0 by SymPy's numbers, of a linear plant A x = 0 and all of the kernel, in plain fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import sympy as sp

from symobs.tasks.result.output_methods import to_sympy
from tests.support.algebra import multiply, rank_of, value_at

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold each point that there is at these values to f = 0; of a linear plant the largest family to the kernel, too."""
    if result.plant.nonlinear is not None:
        _holds_of_nonlinear(result, at)
        return
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


def _holds_of_nonlinear(result: Any, at: Setting) -> None:
    """Hold each point without free values, as its users get it, to f = 0 wherever it is real."""
    given, numbers = result.given, {sp.Symbol(name): sp.Rational(value) for name, value in at.point.items()}
    f = to_sympy(given.f, {})
    for point, named in zip(result.found.points, result.fields["points"], strict=True):
        if point.within is not None or point.free:
            continue
        values = to_sympy([*named.values()], {})
        there = dict(zip(map(sp.Symbol, (*given.states, *given.inputs)), values, strict=True))
        moved = f.subs(there).subs(numbers)
        if all(value.subs(numbers).evalf(30).is_real for value in values):
            assert max(abs(entry.evalf(30)) for entry in moved) < sp.Float("1e-20")


def _is_so(condition: Any, point: Any) -> bool:
    value = value_at(condition.expression, point)
    return bool({"==": value == 0, "!=": value != 0, ">": value > 0, ">=": value >= 0}[condition.operator])
