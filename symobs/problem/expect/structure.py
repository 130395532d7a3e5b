"""Comparison of structured values: tables by the expected keys, lists by entries, down to expressions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from symobs.exact import Factored, Matrix, Scalar, product_of
from symobs.exact.algebraic.rounded_decimals import decimals_in, rounds_to, written_out
from symobs.exact.core.generators import symbols_in
from symobs.formula.expression import parse_matrix, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, SymobsError
from symobs.problem.expect.time_functions import agrees, functions_agree

RELATION = re.compile(r"^(.*?)(!=|==|>=|<=|>|<)(.*)$", re.DOTALL)


def agree(found: Any, expected: Any, names: Any, where: str) -> bool:
    """Return whether a value equals the expected one; tables are compared in the given keys."""
    if isinstance(found, Mapping):
        alike = isinstance(expected, Mapping) and set(expected) <= set(found)
        return alike and all(agree(found[key], entry, names, f"{where}.{key}") for key, entry in expected.items())
    if isinstance(found, (list, tuple)):
        if not isinstance(expected, list) or len(expected) != len(found):
            return False
        pairs = enumerate(zip(found, expected, strict=True))
        return all(agree(entry, wanted, names, f"{where}[{i}]") for i, (entry, wanted) in pairs)
    if found is None or isinstance(found, bool) or expected is None or isinstance(expected, (bool, list, Mapping)):
        if isinstance(found, Matrix) and isinstance(expected, list):
            return agrees(parse_matrix(expected, _knowing(names, found), where=where, rounding=True), found)
        return type(found) is type(expected) and bool(found == expected)
    if isinstance(found, Matrix):
        if not isinstance(expected, str):
            return False
        return agrees(parse_matrix(expected, _knowing(names, found), where=where, rounding=True), found)
    if isinstance(found, (Scalar, Factored, int)):
        value = found.value if isinstance(found, Factored) else Scalar.of(found) if isinstance(found, int) else found
        known = _knowing(names, value)
        return functions_agree(parse_scalar(expected, known, where=where, functions=True, rounding=True), value)
    return str(found) == str(expected) or _agree_as_mathematics(str(found), str(expected), names, where)


def relation(text: Any, names: Any, where: str) -> tuple[Scalar, str]:
    """Return a relation as (expression compared with 0, up to a factor, operator)."""
    if text == "False":
        return Scalar.of(0), ">"
    match = RELATION.match(str(text))
    if match is None:
        message = f'"{shown(str(text))}" is not a relation'
        raise InputError(message, where=where, repair='write for example "2*c - 1 != 0"')
    left, operator, right = match.groups()
    difference, subtracted = (
        parse_scalar(side, names, where=where, functions=True, rounding=True) for side in (left, right)
    )
    difference = difference - subtracted
    if operator in {"<", "<="}:
        difference, operator = -difference, operator.replace("<", ">")
    if difference.is_zero or decimals_in(difference):
        return difference, operator
    if operator == "!=":
        factors = (difference.numerator * difference.denominator).factors()[1]
        return product_of(factor for factor, _ in factors), operator
    if operator == ">":  # a/b > 0 says the same as a b > 0
        difference = difference.numerator * difference.denominator
    unit, factors = difference.factors()
    if operator == ">" and unit.fraction() > 0 and all(power % 2 == 0 for _, power in factors):
        return product_of(factor for factor, _ in factors), "!="
    return difference / (unit if operator in {"!=", "=="} else Scalar.of(abs(unit.fraction()))), operator


def relations_agree(expected: tuple[Scalar, str], found: tuple[Scalar, str]) -> bool:
    """Return whether a relation equals the one found up to a factor; its decimals may be rounded."""
    (printed, operator), (exact, other) = expected, found
    if not decimals_in(printed) or exact.is_zero or operator != other:
        return expected == found
    coefficient, powers = exact.terms()[0]
    decimals = decimals_in(printed)
    leads = [
        product_of([Scalar.of(number), *(Scalar.symbol(name) ** power for name, power in each if name in decimals)])
        for number, each in printed.numerator.terms()
        if tuple(pair for pair in each if pair[0] not in decimals) == powers
    ]
    lead = sum(leads, Scalar.of(0))
    same = written_out(lead) * coefficient
    if same.is_zero or (operator in {">", ">="} and same.fraction() < 0):
        return False
    return rounds_to(printed.numerator / lead, exact / Scalar.of(coefficient))


def factors_agree(found: list[tuple[Scalar, int]], expected: list[Any], names: Any, where: str) -> bool:
    """Return whether the factors with their powers equal the expected ones, in any order."""
    read: list[tuple[Scalar, int]] = []
    for i, pair in enumerate(expected):
        if not isinstance(pair, list) or len(pair) != 2 or type(pair[1]) is not int:
            return False
        known = names
        for factor, _ in found:
            known = _knowing(known, factor)
        read.append((parse_scalar(pair[0], known, where=f"{where}[{i}][0]", rounding=True), pair[1]))
    return len(read) == len(found) and all(
        any(power == other and agrees(value, factor) for value, other in read) for factor, power in found
    )


def factored_table(found: Any) -> Matrix | None:
    """Return the matrix of a table of factored entries, None for any other value."""
    if not isinstance(found, tuple) or not found or not all(isinstance(row, tuple) and row for row in found):
        return None
    if not all(isinstance(entry, Factored) for row in found for entry in row):
        return None
    return Matrix.of([[entry.value for entry in row] for row in found])


def _knowing(names: Any, value: Scalar | Matrix) -> Any:
    """Return the names with those of an answer added: its variable, free parameters."""
    return None if names is None else {**dict.fromkeys(sorted(symbols_in(value)), "real"), **names}


def _agree_as_mathematics(found: str, expected: str, names: Any, where: str) -> bool:
    """Return whether two texts are equal as expressions, or literally if they are not expressions."""
    try:
        if RELATION.match(found) or RELATION.match(expected):
            return relations_agree(relation(expected, names, where), relation(found, names, where))
        left, right = (
            parse_scalar(text, names, where=where, functions=True, rounding=text == expected)
            for text in (expected, found)
        )
    except SymobsError:
        return False
    return functions_agree(left, right)
