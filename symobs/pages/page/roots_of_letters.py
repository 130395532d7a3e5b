"""Roots of positive letters as a book prints them: √(q/r) for √(qr)/r, √(2/b) ∜(q/r) for √(2br√(qr))/(br).

A term is a product of powers of letters with exponents in quarters: what is whole stands in front, halves stand under a
square root, quarters under a fourth root.  Each spelling is held against its value: with fourth powers for the letters
such roots are rational, and both have to agree.
"""

from __future__ import annotations

from dataclasses import fields, replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import KINDS, Function, function_named, generator, square_root
from symobs.formula.tree import At, Formula, Literal, children, with_children
from symobs.pages.printers.rational_formula import size
from symobs.pages.printers.scalar_formula import formula_of
from symobs.proof.derivation.steps import WITH_PARTS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.proof.derivation import Derivation

#: Longer values are not spelled anew.
_TERMS_UP_TO = 40


def of_derivation(part: Any, derivation: Derivation) -> Any:
    """Return the steps of a derivation, or a part of them, with its roots of positive letters as a book prints them."""
    return in_roots_of_letters(part, positive_letters(derivation.start.signs), frozenset(derivation.symbols))


def positive_letters(signs: Mapping[str, str]) -> frozenset[str]:
    """Return the letters that are declared to be positive."""
    return frozenset(name for name, sign in signs.items() if sign == "positive" and function_named(name) is None)


def in_roots_of_letters(part: Any, positive: frozenset[str], kept: frozenset[str] = frozenset()) -> Any:
    """Return steps, or a part of them, in which the roots of positive letters are spelled anew; those in `kept` have names."""
    if not positive:
        return part
    if isinstance(part, Literal):
        return Literal(_spelled(part.value, positive, kept))
    if isinstance(part, At):
        part = replace(part, instant=_of_scalar(part.instant, positive, kept))
    if isinstance(part, Formula):
        inner = tuple(in_roots_of_letters(child, positive, kept) for child in children(part))
        return with_children(part, inner) if inner != children(part) else part
    if isinstance(part, tuple):
        return tuple(in_roots_of_letters(each, positive, kept) for each in part)
    if isinstance(part, WITH_PARTS):
        parts = {field.name: getattr(part, field.name) for field in fields(part)}
        changed = {name: in_roots_of_letters(each, positive, kept) for name, each in parts.items()}
        return replace(part, **changed) if changed != parts else part
    return part


def _spelled(value: Scalar | Matrix, positive: frozenset[str], kept: frozenset[str]) -> Scalar | Matrix:
    if not value.field.functions:
        return value
    if isinstance(value, Matrix):
        return Matrix.of([[_of_scalar(entry, positive, kept) for entry in row] for row in value.rows], value.shape[1])
    return _of_scalar(value, positive, kept)


@lru_cache(maxsize=1024)
def _of_scalar(value: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    """Return a value with its roots of positive letters spelled anew, itself where nothing is gained."""
    functions = [f for name in value.names if (f := function_named(name)) is not None and name not in kept]
    if not (_has_root(functions) or any(f.kind in KINDS for f in functions)) or value.size > _TERMS_UP_TO:
        return value
    inside = {f.name: _argument(f, positive, kept) for f in functions if f.kind in KINDS}
    moved = value.substitute({name: to for name, to in inside.items() if Scalar.symbol(name) != to})
    ways = (_by_terms, _by_factors, _above) if len(value.terms()) > 1 else (_by_terms,)
    forms = [way(moved, positive, kept) for way in ways] if _has_root(functions) else []
    spelled = min((*forms, moved), key=lambda each: size(formula_of(each, "")))
    return spelled if _are_equal(value, spelled, positive) else value


def _has_root(functions: Iterable[Function]) -> bool:
    return any(f.kind == "sqrt" for f in functions)


def _argument(f: Function, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    return generator(f.kind, _of_scalar(f.argument, positive, kept))


def _by_factors(value: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    """Return the product of the value's single factors, spelled, and of its sums."""
    single, sums = value.factors()[0], Scalar.of(1)
    if not single.is_constant:  # a number with roots
        return value
    for factor, power in value.factors()[1]:
        if len(factor.terms()) == 1:
            single = single * factor**power
        else:
            sums = sums * factor**power
    return _product(single, positive, kept) * sums


def _by_terms(value: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    """Return the sum of the terms over the denominator, each spelled; what is no product in the denominator stays below."""
    below, factors = value.denominator.factors()
    if not below.is_constant:  # a number with roots
        return value
    for factor, power in factors:
        below = below * factor**power if len(factor.terms()) == 1 else below
    return _sum(value.numerator, below, positive, kept) * below / value.denominator


def _above(value: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    """Return the numerator, its terms spelled, over the denominator."""
    return _sum(value.numerator, Scalar.of(1), positive, kept) / value.denominator


def _sum(above: Scalar, below: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    total = Scalar.of(0)
    for coefficient, powers in above.terms():
        term = Scalar.of(coefficient)
        for name, power in powers:
            term = term * Scalar.symbol(name) ** power
        total = total + _product(term / below, positive, kept)
    return total


def _product(term: Scalar, positive: frozenset[str], kept: frozenset[str]) -> Scalar:
    """Return a product of powers, its roots opened and put together again; itself where it has none of letters."""
    number, powers = _powers(term)
    opened = _opened(number, powers, positive, kept)
    if opened is None:
        return term
    whole, half, quarter = Scalar.of(1 if number > 0 else -1), Scalar.of(1), Scalar.of(1)
    for base, exponent in opened:
        outside = int(exponent)
        inside = 4 * (exponent - outside)
        whole = whole * base**outside
        if inside % 2:
            quarter = quarter * base ** int(inside)
        else:
            half = half * base ** int(inside / 2)
    for radicand, degree in ((half, 2), (quarter, 4)):
        below = radicand.numerator.is_one and not radicand.is_one
        if not radicand.is_one:
            root = _root(1 / radicand if below else radicand, degree, positive)
            whole = whole / root if below else whole * root
    return whole


def _root(radicand: Scalar, degree: int, positive: frozenset[str]) -> Scalar:
    """Return the square root, or the fourth."""
    return square_root(radicand, positive) if degree == 2 else generator("sqrt", generator("sqrt", radicand))


def _powers(term: Scalar) -> tuple[Fraction, dict[str, Fraction]]:
    """Return the number and the powers of a product."""
    ((coefficient, above),), ((divisor, below),) = term.numerator.terms(), term.denominator.terms()
    powers = {name: Fraction(power) for name, power in above}
    return Fraction(coefficient, divisor), {**powers, **{name: Fraction(-power) for name, power in below}}


def _opened(
    number: Fraction, powers: Mapping[str, Fraction], positive: frozenset[str], kept: frozenset[str]
) -> list[tuple[Scalar, Fraction]] | None:
    """Return the bases of a product and their exponents, roots opened; `None` where there is no root to open."""
    found: dict[str, Fraction] = {}
    numbers: dict[int, Fraction] = {}
    for name, power in powers.items():
        inside = None if name in kept else _under(name, positive, kept)
        for base, exponent in [(name, Fraction(1))] if inside is None else inside[1].items():
            found[base] = found.get(base, Fraction(0)) + power * exponent
        for each, exponent in ({} if inside is None else inside[0]).items():
            numbers[each] = numbers.get(each, Fraction(0)) + power * exponent
    if not any(function_named(name) is not None and name not in found for name in powers):
        return None
    front = abs(number)
    bases = [(Scalar.symbol(name), exponent) for name, exponent in found.items()]
    for each, exponent in numbers.items():
        count = _times(front.numerator, each) - _times(front.denominator, each)
        front = front / Fraction(each) ** count
        bases.append((Scalar.of(each), exponent + count))
    return [(Scalar.of(front), Fraction(1)), *bases]


def _under(
    name: str, positive: frozenset[str], kept: frozenset[str]
) -> tuple[dict[int, Fraction], dict[str, Fraction]] | None:
    """Return the numbers and the positive letters that a root is made of, with exponents in quarters; else `None`."""
    root = function_named(name)
    if root is None or root.kind != "sqrt" or len(root.argument.terms()) != 1:
        return None
    if len(root.argument.denominator.terms()) != 1:
        return None
    number, powers = _powers(root.argument)
    if number < 0:
        return None
    halves = ((number.numerator, Fraction(1, 2)), (number.denominator, Fraction(-1, 2)))
    numbers = {each: exponent for each, exponent in halves if each > 1}
    letters: dict[str, Fraction] = {}
    for base, power in powers.items():
        inside = (
            ({}, {base: Fraction(1)}) if base in positive else None if base in kept else _under(base, positive, kept)
        )
        if inside is None:
            return None
        for each, exponent in inside[0].items():
            numbers[each] = numbers.get(each, Fraction(0)) + power * exponent / 2
        for letter, exponent in inside[1].items():
            letters[letter] = letters.get(letter, Fraction(0)) + power * exponent / 2
    exponents = (*numbers.values(), *letters.values())
    return (numbers, letters) if all(4 % each.denominator == 0 for each in exponents) else None


def _times(number: int, divisor: int) -> int:
    """Return how often a number greater than 1 divides another one."""
    times = 0
    while number % divisor == 0:
        number, times = number // divisor, times + 1
    return times


def _are_equal(value: Scalar, spelled: Scalar, positive: frozenset[str]) -> bool:
    """Return whether both are the same for positive letters: with x⁴ for each the opened roots are rational."""
    fourth = {name: Scalar.symbol(name) ** 4 for name in positive}
    return value.substitute(fourth) == spelled.substitute(fourth)
