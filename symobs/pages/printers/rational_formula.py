"""Rational functions as formulas, whose leaves are whole numbers and single symbols.

Powers of the variable descend and their coefficients are collected; sums begin with a positive term where they have
one; a coefficient is factored where that is shorter.  The spelling always has the scalar's value.
"""

from __future__ import annotations

from functools import lru_cache
from math import gcd, prod
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.core.generators import Function, function_named
from symobs.exact.core.ring import number_of
from symobs.formula.tree import Formula, Literal, Negative, Power, Product, Quotient, Sum

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

#: Beyond this many terms a polynomial is not factored for the sake of its looks.
FACTORED_UP_TO = 120

_BITS_AT_ONCE = 10_000
_CLEARLY = 0.85
#: A sum of fractions is easier to read than one fraction over all of it.
_PATIENCE = 1.25
_PARENTHESES = 0.4

Monomial = tuple[int, tuple[tuple[str, int], ...]]


def is_leaf(value: Scalar) -> bool:
    """Return whether a scalar is printed as one glyph: a nonnegative integer, or a symbol."""
    above = value.numerator_part
    if len(above) > 1 or not value.denominator_part.is_one():
        return False
    if above.is_constant():
        return number_of(above) >= 0
    ((coefficient, powers),) = value.terms()
    return coefficient == 1 and len(powers) == 1 and powers[0][1] == 1


def is_negative(value: Scalar) -> bool:
    """Return whether a rational number is negative."""
    return number_of(value.numerator_part) < 0


@lru_cache(maxsize=4096)
def rational_formula(value: Scalar, variable: str) -> Formula:
    """Return the formula of a rational function; square roots and other numbers in it are symbols like parameters."""
    if is_leaf(value):
        return Literal(value)
    if value.denominator.degree(variable) > 0:
        return _rational_function(value, variable)
    if value.degree(variable) > 0:
        return _polynomial(value, variable)
    return _constant(value)


# -- with the variable ------------------------------------------------------------------------------------------------


def _rational_function(value: Scalar, variable: str) -> Formula:
    """Return numerator / denominator, both collected; the minus of a leading coefficient stands before the fraction."""
    above, below = value.numerator, value.denominator
    negative = _leads_with_minus(above, variable)
    fraction = Quotient(rational_formula(-above if negative else above, variable), _denominator(below, variable))
    return Negative(fraction) if negative else fraction


def _leads_with_minus(value: Scalar, variable: str) -> bool:
    return isinstance(_terms_of(rational_formula(value, variable))[0], Negative)


def _denominator(value: Scalar, variable: str) -> Formula:
    """Return a denominator with the integer content in front: 2(s² + s + 2)."""
    content = gcd(*(coefficient for coefficient, _ in value.terms()))
    collected = rational_formula(value, variable)
    if content == 1 or not isinstance(collected, Sum):
        return collected
    return Product((Literal(Scalar.of(content)), rational_formula(value / content, variable)))


def _polynomial(value: Scalar, variable: str) -> Formula:
    """Return descending powers, over one denominator where that is clearly shorter."""
    coefficients = value.coefficients(variable)
    separate = _collected(coefficients, variable)
    if value.denominator.is_one:
        return _with_content(value, coefficients, separate, variable)
    whole = Quotient(_collected(value.numerator.coefficients(variable), variable), _constant(value.denominator))
    is_gentle = coefficients[0].denominator.is_one or value.denominator.is_constant
    patience = 1.5 if is_gentle else 1.0
    if size(separate) <= patience * size(whole):
        return separate
    first = _terms_of(whole.numerator)[0]
    if isinstance(first, Negative):
        opposite = _collected((-value.numerator).coefficients(variable), variable)
        return Negative(Quotient(opposite, whole.denominator))
    return whole


def _with_content(value: Scalar, coefficients: Sequence[Scalar], separate: Formula, variable: str) -> Formula:
    """Return the polynomial with its content in the parameters in front, where that is clearly shorter."""
    content = common_divisor([coefficient for coefficient in coefficients if not coefficient.is_zero])
    if content.is_constant or content == value:
        return separate
    rest = _collected((value / content).coefficients(variable), variable)
    front = product((_constant(content), rest))
    return front if size(front) < _CLEARLY * size(separate) else separate


def common_divisor(values: Sequence[Scalar]) -> Scalar:
    """Return the greatest common divisor of polynomials; 1 as soon as it is a number."""
    divisor = values[0]
    for value in values[1:]:
        if divisor.is_constant:
            return Scalar.of(1)
        divisor = divisor / (divisor / value).numerator
    return divisor


def _collected(coefficients: Sequence[Scalar], variable: str) -> Formula:
    degree = len(coefficients) - 1
    terms: list[Formula] = []
    for index, coefficient in enumerate(coefficients):
        if not coefficient.is_zero:
            terms += _times_power(coefficient, _power(Literal(_symbol(variable)), degree - index))
    return sum_of(terms)


def _times_power(coefficient: Scalar, power: Formula | None) -> list[Formula]:
    """Return the terms of coefficient · power: one, or those of a constant coefficient."""
    body = _constant(coefficient)
    if power is None:
        return list(_terms_of(body))
    if coefficient.is_one:
        return [power]
    if (-coefficient).is_one:
        return [Negative(power)]
    if isinstance(body, Sum) and all(isinstance(term, Negative) for term in body.terms):
        return [Negative(product((_constant_positive(body), power)))]
    if isinstance(body, Negative):
        return [Negative(product((body.operand, power)))]
    return [product((body, power))]


def _constant_positive(body: Sum) -> Sum:
    return Sum(tuple(term.operand if isinstance(term, Negative) else Negative(term) for term in body.terms))


# -- without the variable ---------------------------------------------------------------------------------------------


def _constant(value: Scalar) -> Formula:
    """Return a number or an expression in parameters, as sum, product or fraction, whichever is shortest."""
    if is_leaf(value):
        return Literal(value)
    if value.is_constant:
        return _number(value)
    if value.denominator.is_one:
        return _shortest(value)
    whole, separate = _fraction(value), _term_by_term(value)
    return separate if separate is not None and size(separate) < _PATIENCE * size(whole) else whole


def _fraction(value: Scalar) -> Formula:
    """Return numerator / denominator, without a minus in front where reversing both avoids it."""
    above, below = value.numerator, value.denominator
    top, bottom = _shortest(above), _shortest(below)
    if isinstance(_terms_of(top)[0], Negative):
        turned = _shortest(-below)
        if not isinstance(_terms_of(turned)[0], Negative):
            return Quotient(_shortest(-above), turned)
        return Negative(Quotient(_shortest(-above), bottom))
    return Quotient(top, bottom)


def _term_by_term(value: Scalar) -> Formula | None:
    """Return 3p − b/J − R/H for (3HJp − bH − JR)/(HJ): a sum over a single product of letters, each term in lowest terms.

    Over a number l + 1/10 for (10l + 1)/10: some term with letters has to lose its denominator.
    """
    below, terms = value.denominator.terms(), value.numerator.terms()
    if len(below) > 1 or not 1 < len(terms) <= FACTORED_UP_TO:
        return None
    ((divisor, under),) = below
    if len(terms) == 2 if under else not any(powers and coefficient % divisor == 0 for coefficient, powers in terms):
        return None
    parts: list[Formula] = []
    for coefficient, powers in human_order(terms):
        common = gcd(coefficient, divisor)
        rest = dict(powers)
        for name, power in under:
            rest[name] = rest.get(name, 0) - power
        top = _monomial(abs(coefficient) // common, [(name, power) for name, power in rest.items() if power > 0])
        bottom = _monomial(divisor // common, [(name, -power) for name, power in rest.items() if power < 0])
        is_whole = isinstance(bottom, Literal) and bottom.value == Scalar.of(1)
        part = top if is_whole else Quotient(top, bottom)
        parts.append(Negative(part) if coefficient < 0 else part)
    return sum_of(parts)


def _number(value: Scalar) -> Formula:
    """Return a rational number: a whole one or a fraction, its minus in front."""
    negative = is_negative(value)
    above: Formula = Literal(-value.numerator if negative else value.numerator)
    size = above if value.denominator_part.is_one() else Quotient(above, Literal(value.denominator))
    return Negative(size) if negative else size


def _shortest(value: Scalar) -> Formula:
    """Return an integer polynomial in parameters: expanded, or factored where that is shorter."""
    expanded = _expanded(value.terms())
    if not isinstance(expanded, Sum) or len(expanded.terms) > FACTORED_UP_TO:
        return expanded
    if not value.factors()[0].is_constant:  # a number with roots in front of the factors
        return expanded
    factored = _factored(value)
    is_sign_only = isinstance(factored, Negative) and isinstance(factored.operand, Sum)
    return factored if size(factored) < size(expanded) and not is_sign_only else expanded


def _expanded(terms: Sequence[Monomial]) -> Formula:
    return sum_of([_monomial(*term) for term in human_order(terms)])


def human_order(terms: Iterable[Monomial]) -> list[Monomial]:
    """Order by descending degree, then by the alphabet; the first positive term leads."""
    ordered = sorted(terms, key=_rank)
    lead = next((index for index, (coefficient, _) in enumerate(ordered) if coefficient > 0), 0)
    return [ordered[lead], *ordered[:lead], *ordered[lead + 1 :]] if ordered else []


def _rank(term: Monomial) -> tuple[int, list[tuple[str, int]]]:
    powers = sorted(term[1], key=lambda item: (item[0].lower(), item[0]))
    return -sum(power for _, power in powers), [(name.lower(), -power) for name, power in powers]


def _monomial(coefficient: int, powers: Sequence[tuple[str, int]]) -> Formula:
    factors = [
        _power(Literal(_symbol(name)), exponent) for name, exponent in sorted(_roots_together(powers), key=_place)
    ]
    parts = [factor for factor in factors if factor is not None]
    if abs(coefficient) != 1 or not parts:
        parts.insert(0, Literal(Scalar.of(abs(coefficient))))
    whole = product(parts)
    return Negative(whole) if coefficient < 0 else whole


def _place(power: tuple[str, int]) -> tuple[int, str]:
    """Return the sort key of a symbol: roots of numbers, symbols by the alphabet, other roots, the time."""
    name, root = power[0], function_named(power[0])
    if root is not None:
        return (0 if root.argument.is_constant else 2), name
    return (3 if name in {"t", "T"} else 1), name.lower()


def _roots_together(powers: Sequence[tuple[str, int]]) -> Sequence[tuple[str, int]]:
    """Write √3 √5 as √15."""
    roots = {
        name: f.argument for name, e in powers if e == 1 and (f := function_named(name)) and f.argument.is_constant
    }
    if len(roots) < 2:
        return powers
    together = Function("sqrt", prod(roots.values(), start=Scalar.of(1))).name
    return [*((name, e) for name, e in powers if name not in roots), (together, 1)]


def _factored(value: Scalar) -> Formula:
    """Return number · symbols · sums; a minus is absorbed by reversing a sum of odd power."""
    unit, factors = value.factors()
    number = int(unit.fraction())
    symbols: list[tuple[str, int]] = []
    sums: list[tuple[Scalar, int]] = []
    for factor, power in factors:
        terms = factor.terms()
        if len(terms) == 1:
            symbols.append((terms[0][1][0][0], power))
        else:
            sums.append((factor, power))
    for index, (factor, power) in enumerate(sums):
        if number < 0 and power % 2 and any(coefficient < 0 for coefficient, _ in factor.terms()):
            sums[index], number = (-factor, power), -number
    brackets = [_power(_expanded(factor.terms()), power) for factor, power in sums]
    head = _monomial(abs(number), symbols)
    parts = [] if isinstance(head, Literal) and head.value == Scalar.of(1) and brackets else [head]
    whole = product([*parts, *(bracket for bracket in brackets if bracket is not None)])
    return Negative(whole) if number < 0 else whole


# -- small builders ---------------------------------------------------------------------------------------------------


@lru_cache(maxsize=1024)
def _symbol(name: str) -> Scalar:
    return Scalar.symbol(name)


def _power(base: Formula, exponent: int) -> Formula | None:
    if exponent == 0:
        return None
    return base if exponent == 1 else Power(base, exponent)


def product(factors: Iterable[Formula]) -> Formula:
    """Return a product, products among the factors opened."""
    flat: list[Formula] = []
    for factor in factors:
        flat += factor.factors if isinstance(factor, Product) else (factor,)
    return flat[0] if len(flat) == 1 else Product(tuple(flat))


def _terms_of(formula: Formula) -> tuple[Formula, ...]:
    return formula.terms if isinstance(formula, Sum) else (formula,)


def sum_of(terms: Sequence[Formula]) -> Formula:
    """Return a sum; of one term the term, of none 0."""
    if not terms:
        return Literal(Scalar.of(0))
    return terms[0] if len(terms) == 1 else Sum(tuple(terms))


def digits_of(whole: Scalar) -> str:
    """Return the digits of a whole number."""
    return decimal(int(number_of(whole.numerator_part)))


def decimal(number: int) -> str:
    """Return the digits of an integer of any size; `str` is limited to some thousands of them."""
    if number.bit_length() < _BITS_AT_ONCE:
        return str(number)
    low = number.bit_length() * 3 // 20
    front, back = divmod(number, 10**low)
    return decimal(front) + decimal(back).zfill(low)


def size(formula: Formula) -> float:
    """Return the approximate number of glyphs of a formula."""
    match formula:
        case Literal(Scalar() as value):
            return len(digits_of(value)) if value.is_constant else _size_of_symbol(value)
        case Sum(terms):
            return sum(size(term) for term in terms) + (len(terms) - 1) / 2
        case Negative(Sum() as operand):
            return size(operand) + 0.5 + _PARENTHESES
        case Negative(operand):
            return size(operand) + 0.5
        case Product(factors):
            return sum(size(factor) + _PARENTHESES * isinstance(factor, Sum) for factor in factors)
        case Power(base, _):
            return size(base) + _PARENTHESES * isinstance(base, Sum) + 0.5
        case Quotient(above, below):
            return size(above) + size(below) + 1
        case _:
            return 1.0


def _size_of_symbol(value: Scalar) -> float:
    """Return a symbol, or a function with its argument; a root of a root is a fourth root."""
    function = function_named(next(iter(value.names)))
    if function is not None and function.kind == "sqrt" and is_leaf(function.argument) and function.argument.names:
        return max(_size_of_symbol(function.argument), 2.0)
    return 1.0 if function is None else 1.0 + size(rational_formula(function.argument, ""))
