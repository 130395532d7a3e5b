"""Intervals of time: where a plant has no pole, and an instant at which a function of t is not 0."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.ground.errors import InputError
from symobs.system.conditions import never_zero, sign_of, vanishing_factors
from symobs.tasks.analysis.time_varying.transition_matrix import START, TIME

if TYPE_CHECKING:
    from symobs.system import StateSpace

#: The end of the interval where none is given.
END = "t1"
_ORDERS_UP_TO = 8
_HALVINGS = 60
_NEW = "u"


def reject_sizes_and_names(plant: StateSpace) -> None:
    """Refuse names that stand for instants, and orders whose stack would not end."""
    taken = sorted({START, END} & plant.field.position.keys())
    if taken:
        message = f"{taken[0]} is the name of an instant and cannot be a parameter of the plant"
        raise InputError(message, where="plant", repair="give the parameter another name")
    if plant.order > _ORDERS_UP_TO:
        message = f"the plant has {plant.order} states, more than {_ORDERS_UP_TO}"
        raise InputError(message, where="plant.A", repair="ask for a smaller plant")


def reject_poles(plant: StateSpace, ends: tuple[Scalar, Scalar]) -> None:
    """Raise `InputError` where a denominator of the plant certainly vanishes in the interval."""
    m, signs = plant.matrices, plant.symbols.signs
    for factor in vanishing_factors([part.common_denominator() for part in (m.A, m.B, m.C, m.D)], signs):
        if TIME not in factor.names:
            continue
        first, last = (factor.substitute({TIME: end}) for end in ends)
        opposite = sign_of(first * last, signs) in {"zero", "negative", "nonpositive"}
        numeric = factor.names == {TIME} and all(end.is_constant for end in ends)
        if opposite or (numeric and _vanishes_between(factor, *ends)):
            message = f"{factor} vanishes in the interval, and there the plant has a pole"
            raise InputError(message, where="specification.interval", repair="choose an interval without the pole")


def _vanishes_between(factor: Scalar, first: Scalar, last: Scalar, halvings: int = _HALVINGS) -> bool:
    """Return whether an irreducible polynomial in t with numbers for coefficients has a root in (first, last).

    By Descartes' rule for t = (first + last u)/(1 + u), u > 0: no change of sign, no root; one, one root; else halve.
    """
    u = Scalar.symbol(_NEW)
    moved = factor.substitute({TIME: (first + last * u) / (u + 1)}).numerator
    signs = [c.fraction() > 0 for c in moved.coefficients(_NEW) if not c.is_zero]
    changes = sum(a != b for a, b in pairwise(signs))
    if changes < 2 or not halvings:
        return changes > 0
    middle = (first + last) / 2
    if factor.substitute({TIME: middle}).is_zero:
        return True
    return any(_vanishes_between(factor, *part, halvings - 1) for part in ((first, middle), (middle, last)))


def instant_where_not_zero(plant: StateSpace, interval: tuple[Scalar, Scalar] | None, minor: Matrix) -> Scalar | None:
    """Return an instant of the interval at which a minor is certainly not 0 and no pole lies, None where none is found."""
    if not minor.shape[0]:
        return None
    value, signs = minor.determinant(), plant.symbols.signs
    if interval is None:
        tried = [Scalar.of(k) for k in (0, 1, -1, 2, -2, 3)]
    else:
        start, end = interval
        tried = [end, start, *((start * (k - 1) + end) / k for k in range(2, 6))]
    for instant in tried:
        try:
            for part in (plant.matrices.A, plant.matrices.C):
                part.substitute({TIME: instant})
            if never_zero(value.substitute({TIME: instant}), signs):
                return instant
        except ZeroDivisionError:
            continue
    return None
