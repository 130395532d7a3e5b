"""Decimals of answers: whether their digits are right, and whether the loop of a rounded gain is stable.

A decimal is right if it is the right number, correctly rounded, and has enough digits to say anything: as many as the
marking scheme demands, else three; with fewer it is the number that it is.  Of the sixteen digits that programs print
the last ones are no claim.
"""

from __future__ import annotations

import re
from fractions import Fraction
from math import floor, log10
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers import DECIMAL
from symobs.exact import Matrix, Scalar, TooLarge
from symobs.exact.algebraic.enclosure import is_number, near
from symobs.exact.algebraic.root_location import complex_roots
from symobs.exact.algebraic.rounded_decimals import PrintedDecimal, decimals_in, rounds_to, written_out
from symobs.formula.expression import parse_matrix, parse_poles, parse_scalar
from symobs.problem.agreement import agrees
from symobs.problem.expect import digits_of
from symobs.stability.criteria.stability import stability
from symobs.tasks.design.optimal.optimal_gain import OptimalGain

if TYPE_CHECKING:
    from symobs.system import StateSpace
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention

#: Significant digits below which a decimal rounds nothing, where the marking scheme says nothing.
FEWEST = 3
#: Texts of so many digits come from programs that compute in doubles: so many of them are held against the right ones.
_OF_DOUBLES, _HELD = (15, 16, 17), 12
#: The bits of approximations, and digits beyond which they do not serve.
_BITS, _MOST_DIGITS = 1024, 250
#: Poles are found to so many digits.
_DIGITS_OF_POLES = 11


def in_enough_digits(value: Any, digits: int | None) -> Any:
    """Return a value in which decimals of too few digits are written as the fractions that they are."""
    if isinstance(value, list):
        return [in_enough_digits(entry, digits) for entry in value]

    def kept(found: re.Match[str]) -> str:
        figures = re.sub(r"[eE].*|\.", "", found[0]).lstrip("0")
        return found[0] if len(figures) >= (digits or FEWEST) else f"({Fraction(found[0])})"

    return DECIMAL.sub(kept, value) if isinstance(value, str) else value


def entries_are_right(
    view: ResultInConvention, letter: str, given: Any, right: Matrix | Scalar | None, names: Any, digits: int | None
) -> bool:
    """Return whether a matrix or a number of decimals is the right one to its digits, both in the student's convention.

    `right` is None where there is no closed form.  Raises what reading raises, and `TooLarge` where it is open.
    """
    told = in_enough_digits(given, digits)
    read = parse_scalar if isinstance(right, Scalar) else parse_matrix
    variable = (
        None if right is None or not {view.argument} & right.names or view.argument in (names or {}) else view.argument
    )
    printed = read(told, names, variable=variable, functions=True, rounding=True)
    found = digits_of(view, letter, 2 * len(str(given)) + 20) if right is None else right
    if found is None:
        return False
    if isinstance(printed, Scalar) and isinstance(found, Scalar):
        return _is_right(printed, found, digits, is_exact=True)
    if not isinstance(printed, Matrix) or not isinstance(found, Matrix) or printed.shape != found.shape:
        return False
    pairs = zip(printed.entries, found.entries, strict=True)
    return all(_is_right(mine, its, digits, is_exact=right is not None) for mine, its in pairs)


def _is_right(printed: Scalar, right: Scalar, digits: int | None, *, is_exact: bool) -> bool:
    decimals = decimals_in(printed)
    if not is_number(right):
        return agrees(printed, right)
    if not decimals:
        return agrees(printed, right) if is_exact else _is_near_number(printed, right)
    (name, decimal), *others = decimals.items()
    sign = next((sign for sign in (1, -1) if printed == Scalar.symbol(name) * sign), 0)
    value = near(right, _BITS)
    if others or not sign or value is None:
        return rounds_to(printed, right if value is None else Scalar.of(value))
    return has_digits(decimal if sign > 0 else -decimal, value, digits)


def has_digits(decimal: PrintedDecimal, right: Fraction, digits: int | None) -> bool:
    """Return whether a decimal has the right digits: so many, else all that are written."""
    written = len(str(abs(decimal.units)))
    count = digits or (_HELD if written in _OF_DOUBLES else 0)
    if not count:
        return decimal.agrees(right)
    return is_near(decimal.units * decimal.unit, right, count)


def is_near(value: Fraction, right: Fraction, digits: int) -> bool:
    """Return whether a value is right to so many significant digits; beside 0 to so many places."""
    size, power = abs(right), 0
    while size and size >= 10:
        size, power = size / 10, power + 1
    while size and size < 1 and power > -_MOST_DIGITS:
        size, power = size * 10, power - 1
    return abs(value - right) <= Fraction(10) ** (power + 1 - digits) / 2


def _is_near_number(printed: Scalar, right: Scalar) -> bool:
    """Return False for a number that is not the one of which digits are known; raises `TooLarge` for any other."""
    value = near(printed, _BITS)
    if value is not None and not is_near(value, right.fraction(), FEWEST):
        return False
    raise TooLarge("whether the two numbers are equal is not decided: one of them has no closed form")


# Gains.


def poles_are_right(design: GainDesign, value: Matrix, digits: int) -> bool:
    """Return whether a gain of numbers places poles that are right to so many digits."""
    right, polynomial, variable = design.answer[design.letter], design.answer["polynomial"], design.plant.variable
    if (
        right is None
        or value.shape != right.shape
        or value.names
        or right.names
        or polynomial.names - {variable}
        or digits > _DIGITS_OF_POLES
    ):
        return False
    placed = _roots(type(design).of_given(design.plant, value).answer["polynomial"], variable)
    for pole in _roots(polynomial, variable):
        nearest = min(placed, key=lambda root: abs(root - pole))
        power = floor(log10(abs(pole))) if pole else 0
        if abs(nearest - pole) > 10.0 ** (power + 1 - digits) / 2:
            return False
        placed.remove(nearest)
    return True


def rounds_a_root(text: str, polynomial: Scalar, variable: str) -> bool:
    """Return whether a number with decimals rounds a root of a polynomial with rational coefficients."""
    if polynomial.names != {variable}:
        return False
    (printed, *_) = parse_poles(in_enough_digits(text, None), functions=True, rounding=True)
    decimals = [decimal for part in (printed.real, printed.imaginary) for decimal in decimals_in(part).values()]
    plain = complex(*(float(near(written_out(part)) or 0) for part in (printed.real, printed.imaginary)))
    within = max((float(decimal.unit) / 2 for decimal in decimals), default=0)
    roots = _roots(polynomial, variable)
    return any(max(abs(root.real - plain.real), abs(root.imag - plain.imag)) <= within for root in roots)


def _roots(polynomial: Scalar, variable: str) -> list[complex]:
    found = complex_roots([entry.fraction() for entry in polynomial.coefficients(variable)])
    return [complex(float(real), float(imaginary)) for real, imaginary in found]


def is_as_stable(result: Result, name: str, value: Matrix, digits: Matrix | None = None) -> bool:
    """Return whether the loop of a rounded gain is stable where that of the right one, known by its `digits` at least, is."""
    there: GainDesign | OptimalGain
    if name in result.gains:
        there = result.design_of(name)
    elif isinstance(result, OptimalGain) and name == result.letter:
        there = result
    else:
        return True
    right = there.gain if digits is None else digits
    if right is None or right.shape != value.shape:
        return True
    loops = [_of_loop(there.plant, there.letter, gain) for gain in (value, right)]
    return loops[0] == "yes" or loops[1] != "yes"


def _of_loop(plant: StateSpace, letter: str, gain: Matrix) -> str:
    """Return whether A − BK, or A − LC, is stable."""
    m = plant.matrices
    loop = m.A - (m.B @ gain if letter == "K" else gain @ m.C)
    polynomial = loop.normal().characteristic_polynomial(plant.variable)
    return stability(polynomial, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict
