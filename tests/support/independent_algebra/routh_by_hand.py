"""Routh's table a second time, in SymPy, by determinants; where roots lie, by their numeric values; what sentences say.

Nothing of `symobs.stability` takes part.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import sympy

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"]
TIMES = ["does not change sign", "changes sign once", "changes sign twice"]
TIMES += [f"changes sign {number} times" for number in NUMBERS[3:]]
LIE = [f"{number} root{'' if k < 2 else 's'} lie{'s' if k < 2 else ''}" for k, number in enumerate(NUMBERS)]


class Row(NamedTuple):
    power: int
    entries: list[Any]
    origin: str


def rows_of(coefficients: Sequence[Any], small: Any) -> list[Row]:
    """Return the rows from the highest power down to 0, by the determinants of the rows above each."""
    order = len(coefficients) - 1
    rows = [Row(order, list(coefficients[0::2]), "coefficients")]
    for power in range(order - 1, -1, -1):
        if power == order - 1:
            found, origin = list(coefficients[1::2]), "coefficients"
        else:
            p, q = ([*row.entries, *[sympy.Integer(0)] * order] for row in rows[-2:])
            minors = [sympy.Matrix([[p[0], p[k + 1]], [q[0], q[k + 1]]]).det() for k in range(power // 2 + 1)]
            found, origin = [sympy.cancel(-minor / q[0]) for minor in minors], "recurrence"
        if found[0] == 0 and any(entry != 0 for entry in found):
            found, origin = [small, *found[1:]], "epsilon"
        elif found[0] == 0:
            found, origin = derivative(rows[-1]), "auxiliary"
        rows.append(Row(power, found, origin))
    return rows


def derivative(row: Row) -> list[Any]:
    """Return every other coefficient of the derivative of Σ entry · xᵖᵒʷᵉʳ⁻²ᵏ."""
    x = sympy.Symbol("x")
    whole = sympy.Poly(sum(entry * x ** (row.power - 2 * k) for k, entry in enumerate(row.entries)), x)
    return list(whole.diff(x).all_coeffs()[0::2])


def located(coefficients: Sequence[Any]) -> tuple[int, int]:
    """Return how many roots have a positive real part, and how many one that is 0, to fifty digits."""
    right = axis = 0
    for factor, power in sympy.Poly(list(coefficients), sympy.Symbol("x")).sqf_list()[1]:
        for root in factor.nroots(n=50, maxsteps=1000):
            real = sympy.re(root)
            if abs(real) < sympy.Float(10) ** -30:
                axis += power
            elif real > 0:
                right += power
    return right, axis


def expression(number: Any) -> Any:
    """Return a number or an expression as an expression."""
    return sympy.Integer(0) + number


def changes(rows: Sequence[Row], small: Any) -> int:
    """Return the changes of sign in the first column, where ε is 10⁻⁶⁰."""
    column = [sympy.sign(expression(row.entries[0]).subs(small, sympy.Rational(1, 10**60))) for row in rows]
    assert set(column) <= {1, -1}
    return sum(a != b for a, b in pairwise(column))


def is_so(
    key: str, slots: Mapping[str, Any], rows: Sequence[Row], coefficients: Sequence[Any], points: Iterable[Any]
) -> bool:
    """Tell whether a sentence about a table is true: at points of the parameters where it speaks of all."""
    small = sympy.Symbol("epsilon")
    origins = [row.origin for row in rows]
    match key:
        case "routh_epsilon":
            return "epsilon" in origins and slots["epsilon"] == (small, ">", 0)
        case "routh_zero_row":
            return "auxiliary" in origins
        case "routh_divides":
            x = sympy.Symbol("s")
            whole, part = sympy.Poly(list(coefficients), x), sympy.Poly(slots["auxiliary"], x)
            is_symmetric = sympy.expand(slots["auxiliary"].subs(x, -x) ** 2 - slots["auxiliary"] ** 2) == 0
            return is_symmetric and bool(whole.rem(part).is_zero)
        case "routh_changes" | "routh_changes_axis" | "routh_misleads":
            right, axis = located(coefficients)
            told = slots["right"] == LIE[right] and slots.get("axis", LIE[0]) == LIE[axis]
            if key == "routh_misleads":
                return told and changes(rows, small) != right and slots["epsilon"] == small
            return told and slots["changes"] == TIMES[changes(rows, small)] and changes(rows, small) == right
    return all(_at_a_point(key, slots, rows, coefficients, point) for point in points)


def _at_a_point(
    key: str, slots: Mapping[str, Any], rows: Sequence[Row], coefficients: Sequence[Any], point: Any
) -> bool:
    numbers = [expression(c).subs(point) for c in coefficients]
    if key == "routh_criterion_where":
        (left, operator, right) = slots["leading"]
        if operator != "!=" or right != 0 or (left - coefficients[0]) != 0:
            return False
        if numbers[0] == 0:
            return True
    stable = located(numbers) == (0, 0)
    if key == "routh_not_stable":
        return not stable
    column = [expression(row.entries[0]).subs(point) for row in rows]
    told = {
        sign: all(entry.is_finite and (entry > 0) == (sign == "positive") and entry != 0 for entry in column)
        for sign in ("positive", "negative")
    }
    match key:
        case "routh_positive" | "routh_negative":
            return stable and told[key.removeprefix("routh_")]
        case "routh_criterion_positive" | "routh_criterion_negative":
            return stable == told[key.removeprefix("routh_criterion_")]
        case "routh_criterion_where":
            return stable == any(told.values())
    raise AssertionError(key)
