"""What a disturbance observer claims, in plain fractions: its poles, or that plant and exosystem have no such observer."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import (
    assignable,
    characteristic,
    matrix_at,
    multiply,
    subtract,
)

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold [A EV; 0 S] − [L_x; L_w] [C 0] to φ and to what is reported of it."""
    E, S, V = (matrix_at(part, at.point) for part in result.exosystem)
    A = [[*row, *more] for row, more in zip(at.A, multiply(E, V), strict=True)]
    A += [[*([Fraction(0)] * len(at.A)), *row] for row in S]
    C = [[*row, *([Fraction(0)] * len(S))] for row in at.C]
    if result.fields["L_x"] is None:
        assert not assignable(A, C, at.wanted[""])
        return
    L = [*matrix_at(result.fields["L_x"], at.point), *matrix_at(result.fields["L_w"], at.point)]
    closed = subtract(A, multiply(L, C))
    assert characteristic(closed) == at.wanted[""]
    assert matrix_at(result.fields["A"], at.point) == closed
    assert matrix_at(result.fields["B_y"], at.point) == L
