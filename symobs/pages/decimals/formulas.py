"""Exact formulas and relations, written in decimals: polynomials with decimal coefficients, monic denominators.

Every decimal is read from the exact number that stands there, never from another decimal.
"""

from __future__ import annotations

from dataclasses import replace
from math import prod
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, is_written_exactly, significant
from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.exact.algebraic.root_parts import in_modes
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import function_named, roots_in, square_root
from symobs.formula.tree import (
    Block,
    Decimals,
    Environment,
    Exact,
    Formula,
    Integral,
    Letter,
    Literal,
    Negative,
    Numeral,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    children,
    evaluate,
    exact_meaning,
    is_rounded,
    with_children,
)
from symobs.pages.printers.rational_formula import human_order, is_leaf, product, sum_of
from symobs.pages.printers.scalar_formula import is_time_function, separate_formula

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_ONE = Scalar.of(1)


class InDecimals:
    """Exact mathematics in decimals of so many significant digits; `variable` is that of polynomials."""

    def __init__(self, variable: str, digits: int) -> None:
        """Write numbers with `digits` significant digits."""
        self.variable = variable
        self.digits = digits

    def relation(self, relation: Relation) -> Relation:
        """Return a chain with `≈` for `=` beside a number that is rounded; in a comparison its exact value comes first."""
        shown = tuple(map(self.formula, relation.members))
        rounded = tuple(map(is_rounded, shown))
        signs = [
            "≈" if operator == "=" and (rounded[place] or rounded[place + 1]) else operator
            for place, operator in enumerate(relation.operators)
        ]
        members: list[Formula] = []
        operators: list[str] = []
        for place, member in enumerate(shown):
            if rounded[place] and "≈" not in (beside := signs[max(place - 1, 0) : place + 1]) and beside:
                members.append(relation.members[place])
                operators.append("≈")
            members.append(member)
            operators += signs[place : place + 1]
        return Relation(tuple(members), tuple(operators))

    def formula(self, formula: Formula) -> Formula:
        """Return a formula with the decimals of its numbers."""
        match formula:
            case Literal(Scalar() as value):
                return self.scalar(value)
            case Literal(Matrix() as value):
                return self.matrix(value)
            case Letter() | Decimals():
                return formula
            case Integral(integrand):
                return replace(formula, integrand=self.formula(integrand))
            case Product(factors) if any(map(_is_sum_over_roots, factors)):  # times a matrix, e^{At} mode by mode
                return Product(tuple(each if _is_sum_over_roots(each) else self.formula(each) for each in factors))
        parts = self._parts(formula)
        if parts is not None:
            number, rest = parts
            return self._with_front(number, rest)
        return with_children(formula, tuple(map(self.formula, children(formula))))

    def matrix(self, matrix: Matrix) -> Formula:
        """Return a matrix entry by entry; one of letters and short whole numbers as it is."""
        rows = tuple(tuple(map(self.scalar, row)) for row in matrix.rows)
        is_plain = all(isinstance(entry, Literal) for row in rows for entry in row)
        is_plain = is_plain or all(
            isinstance(entry.operand if isinstance(entry, Negative) else entry, Literal)
            for row in rows
            for entry in row
        )
        return Literal(matrix) if is_plain or not rows or not rows[0] else Block(rows)

    def scalar(self, value: Scalar) -> Formula:
        """Return a number, a polynomial or a rational function."""
        if value.is_constant or is_number(value):
            return self.number(value)
        if (modes := in_modes(value, self.digits)) is not None:
            return self._numbers_of(separate_formula(modes))
        if is_leaf(value):
            return Literal(value)
        if any(is_time_function(name) for name in value.names):
            return self._numbers_of(separate_formula(value))
        return self._rational(value)

    def number(self, value: Scalar) -> Formula:
        """Return a number: a whole one that is written in full as before, the minus sign in front."""
        is_negative = value.fraction() < 0 if value.is_constant else sign_of_number(value) == "negative"
        size = -value if is_negative else value
        text = significant(size, self.digits)
        if text is None:  # an exact number that no approximation tells from its neighbours
            return Literal(value)
        shown = Literal(size) if text.isdigit() and is_written_exactly(size, text) else Numeral(size, text)
        return Negative(shown) if is_negative else shown

    # -- polynomials and rational functions ------------------------------------------------------------------------------

    def _rational(self, value: Scalar) -> Formula:
        """Return numerator / denominator, the denominator with the leading coefficient 1."""
        above, below = value.numerator, value.denominator
        lead = self._lead(below)
        if below.is_constant:
            return self._polynomial(value)
        top = self._polynomial(above / lead)
        bottom = self._polynomial(below / lead)
        first = top.terms[0] if isinstance(top, Sum) else top
        if isinstance(first, Negative):
            return Negative(Quotient(self._polynomial(-above / lead), bottom))
        return Quotient(top, bottom)

    def _lead(self, value: Scalar) -> Scalar:
        """Return the number in front of the first term of a polynomial."""
        while value.degree(self.variable) > 0:
            value = value.coefficients(self.variable)[0]
        return value if is_number(value) else Scalar.of(human_order(value.numerator.terms())[0][0]) / value.denominator

    def _polynomial(self, value: Scalar) -> Formula:
        """Return a polynomial: powers of the variable descending, each with its coefficient."""
        degree = value.degree(self.variable)
        if degree <= 0:
            return sum_of(self._terms(value))
        terms: list[Formula] = []
        for place, coefficient in enumerate(value.coefficients(self.variable)):
            if not coefficient.is_zero:
                terms += self._times(coefficient, self._power(self.variable, degree - place))
        return sum_of(terms)

    def _times(self, coefficient: Scalar, power: Formula | None) -> list[Formula]:
        """Return the terms of coefficient · power."""
        terms = self._terms(coefficient)
        if power is None:
            return terms
        if len(terms) > 1:
            turned = tuple(term.operand for term in terms if isinstance(term, Negative))
            if len(turned) == len(terms):
                return [Negative(product((Sum(turned), power)))]
            return [product((Sum(tuple(terms)), power))]
        (term,) = terms
        body = term.operand if isinstance(term, Negative) else term
        whole = power if body == Literal(_ONE) else product((body, power))
        return [Negative(whole) if isinstance(term, Negative) else whole]

    def _terms(self, value: Scalar) -> list[Formula]:
        """Return the terms of what does not contain the variable: of a number one."""
        if value.is_constant or is_number(value):
            return [self.number(value)]
        if not value.denominator.is_constant:
            return [self._rational(value)]
        below = value.denominator
        found: list[Formula] = []
        for coefficient, powers in human_order(value.numerator.terms()):
            number = self.number(Scalar.of(coefficient) / below)
            body = number.operand if isinstance(number, Negative) else number
            names = [power for name, exponent in powers if (power := self._power(name, exponent))]
            whole = product([*([body] if body != Literal(_ONE) or not names else []), *names])
            found.append(Negative(whole) if isinstance(number, Negative) else whole)
        return found

    def _power(self, name: str, exponent: int) -> Formula | None:
        base = Literal(Scalar.symbol(name))
        return None if exponent == 0 else base if exponent == 1 else Power(base, exponent)

    # -- products of values ----------------------------------------------------------------------------------------------

    def _parts(self, formula: Formula) -> tuple[Scalar, Formula | None] | None:
        """Return (number, rest) of a product or fraction of values, every factor with the leading coefficient 1.

        None for what is no such product; the rest is None where it is 1.
        """
        match formula:
            case Product(factors):
                found = [self._parts(factor) for factor in factors]
                if not all(found) or sum(isinstance(part[1], Quotient) for part in found if part) > 1:
                    return None
                parts = [part for part in found if part is not None]
                rests = [rest for _, rest in parts if rest is not None]
                return prod((number for number, _ in parts), start=_ONE), product(rests) if rests else None
            case Quotient(above, below):
                top, bottom = self._parts(above), self._parts(below)
                if top is None or bottom is None:
                    return None
                rest = top[1] if bottom[1] is None else Quotient(top[1] or Literal(_ONE), bottom[1])
                return top[0] / bottom[0], rest
            case Negative(operand):
                inner = self._parts(operand)
                return None if inner is None else (-inner[0], inner[1])
            case Power(base, exponent):
                inner = self._parts(base)
                if inner is None:
                    return None
                rest = None if inner[1] is None else inner[1] if exponent == 1 else Power(inner[1], exponent)
                return inner[0] ** exponent, rest
            case Sum():
                return (_ONE, Sum(tuple(map(self._term, formula.terms)))) if self._is_value(formula) else None
            case Literal(Scalar() as value) if not any(is_time_function(name) for name in value.names):
                if value.is_constant or is_number(value):
                    return value, None
                lead = self._lead(value.numerator) / self._lead(value.denominator)
                return lead, self.scalar(value / lead)
            case Letter("s"):
                return _ONE, formula
        return None

    def _is_value(self, formula: Formula) -> bool:
        return formula == Letter("s") or (
            not isinstance(formula, Letter)
            and not (isinstance(formula, Literal) and isinstance(formula.value, Matrix))
            and isinstance(formula, (Literal, Sum, Product, Quotient, Negative, Power))
            and all(map(self._is_value, children(formula)))
        )

    def _term(self, formula: Formula) -> Formula:
        """Return a term; a number that is subtracted stays so: 9 - (-20.6), 3.6 - 0."""
        if isinstance(formula, Negative) and isinstance(formula.operand, Literal):
            return Negative(self.formula(formula.operand))
        return self.formula(formula)

    def _with_front(self, number: Scalar, rest: Formula | None) -> Formula:
        """Return number · rest, in the numerator of a fraction."""
        if rest is None:
            return self.number(number)
        expanded = self._expanded(number, rest)
        if expanded is not None:
            return expanded
        front = self.number(number)
        is_negative = isinstance(front, Negative)
        body = front.operand if isinstance(front, Negative) else front
        if body == Literal(_ONE):
            whole = rest
        elif isinstance(rest, Quotient):
            above = body if rest.numerator == Literal(_ONE) else product((body, rest.numerator))
            whole = Quotient(above, rest.denominator)
        else:
            whole = product((body, rest))
        return Negative(whole) if is_negative else whole

    def _expanded(self, number: Scalar, rest: Formula) -> Formula | None:
        """Return number · polynomial multiplied out, None where several factors stand in the numerator."""
        above = rest.numerator if isinstance(rest, Quotient) else rest
        if not isinstance(above, Sum) or number.is_one:
            return None
        start = Environment(variable=self.variable)
        shown = self.scalar(evaluate(exact_meaning(above), start, Exact(start)) * number)
        if isinstance(rest, Quotient) and isinstance(shown, Negative):
            return Negative(Quotient(shown.operand, rest.denominator))
        return Quotient(shown, rest.denominator) if isinstance(rest, Quotient) else shown

    # -- functions of time -----------------------------------------------------------------------------------------------

    def _numbers_of(self, formula: Formula) -> Formula:
        """Return a formula with its numbers in decimals, each as large a part as is a number."""
        value = _number_in(formula)
        if value is not None:
            return self.number(value)
        if isinstance(formula, Product):
            return self._product(formula.factors)
        if isinstance(formula, Quotient) and (below := _number_in(formula.denominator)) is not None:
            return self._product((Literal(_ONE / below), formula.numerator))
        return with_children(formula, tuple(map(self._numbers_of, children(formula))))

    def _product(self, factors: Sequence[Formula]) -> Formula:
        """Return a product with all its numbers in front, as one."""
        number, others = _ONE, list[Formula]()
        for factor in _flat(factors):
            value = _number_in(factor)
            if value is None:
                others.append(self._numbers_of(factor))
            else:
                number = number * value
        front = self.number(number)
        body = front.operand if isinstance(front, Negative) else front
        whole = product([*([body] if body != Literal(_ONE) or not others else []), *others])
        return Negative(whole) if isinstance(front, Negative) else whole


def _is_sum_over_roots(formula: Formula) -> bool:
    """Return whether a formula is a single sum over roots."""
    is_value = isinstance(formula, Literal) and isinstance(formula.value, Scalar) and is_leaf(formula.value)
    return is_value and any(isinstance(function_named(name), RootSum) for name in formula.value.names)  # type: ignore[union-attr]


def _flat(factors: Sequence[Formula]) -> Iterator[Formula]:
    """Yield the factors of products, numbers before the fractions that they divide."""
    for factor in factors:
        match factor:
            case Product(inner):
                yield from _flat(inner)
            case Quotient(above, below) if _number_in(below) is not None:
                yield from _flat((Literal(_ONE / _number_in(below)), above))  # type: ignore[operator]
            case _:
                yield factor


def _number_in(formula: Formula) -> Scalar | None:
    """Return the number that a formula of values is, None for another one."""
    match formula:
        case Literal(Scalar() as value):
            return _of_primes(value) if _is_plain_number(value) else None
        case Negative(operand):
            number = _number_in(operand)
            return None if number is None else -number
        case Quotient(above, below):
            top, bottom = _number_in(above), _number_in(below)
            return None if top is None or bottom is None else top / bottom
        case Product(parts) | Sum(parts):
            numbers = [number for part in parts if (number := _number_in(part)) is not None]
            if len(numbers) < len(parts):
                return None
            return sum(numbers, _ONE * 0) if isinstance(formula, Sum) else prod(numbers, start=_ONE)
    return None


def _of_primes(value: Scalar) -> Scalar:
    """Return a number whose roots are those of the exact page: √15, one root for print, is √3 √5 there."""
    roots: dict[str, Scalar] = {root.name: square_root(root.argument) for root in roots_in(value)}
    return value.substitute(roots) if roots else value


def _is_plain_number(value: Scalar) -> bool:
    """Return whether a value is a number without exponentials, which stay as they are among functions of time."""
    found = [function_named(name) for name in value.names]
    return is_number(value) and all(f is not None and f.kind in {"sqrt", "CRootOf", "RootPart"} for f in found)
