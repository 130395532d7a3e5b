"""Expected roots and numbers: a + b sqrt(c), CRootOf(polynomial, index), sums of square roots."""

from __future__ import annotations

import re
from typing import Any

from symobs.exact import Complex, Root, Scalar, root_of_pole
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.exact.algebraic.rounded_decimals import decimals_in, polynomial_of, rounds_to
from symobs.formula.expression import parse_poles, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError
from symobs.problem.expect.time_functions import functions_agree

COUNTED = re.compile(r"\s*CRootOf\((.*),\s*([0-9]+)\)\s*", re.DOTALL)


def key_of(root: Root) -> Any:
    """Return a key independent of the form of a root."""
    exact: Complex | None = root.exact()
    return exact if exact is not None else (root.centre, root.radicand, root.sign, root.factor, root.index)


def read_roots(expected: list[Any], names: Any, variable: str, where: str) -> list[Root]:
    """Return the roots of texts: numbers, a + b sqrt(c), CRootOf(polynomial, index)."""
    roots: list[Root] = []
    for i, entry in enumerate(expected):
        place = f"{where}[{i}]" if len(expected) > 1 else where
        counted = COUNTED.fullmatch(entry) if isinstance(entry, str) else None
        if counted is not None:
            factor, zero = parse_scalar(counted[1], names, variable=variable, where=place), Scalar.of(0)
            roots.append(Root(factor, variable, zero, zero, 1, int(counted[2])))
        elif isinstance(entry, str) and "sqrt" in entry:
            roots += [_surd(part, names, variable, place) for part in entry.strip(" []").split(",")]
        else:
            read = parse_poles(entry if isinstance(entry, str) else [entry], names, where=place)
            roots += [root_of_pole(pole, variable) for pole in read]
    return roots


def rounded_roots(expected: list[Any], names: Any, where: str) -> tuple[Complex, ...]:
    """Return the numbers of a list with decimals, nothing for a list without."""
    if any(isinstance(entry, str) and "CRootOf" in entry for entry in expected):
        return ()
    texts = ", ".join(str(entry).strip(" []") for entry in expected)
    read = parse_poles(texts, names, where=where, functions=True, rounding=True) if "." in texts else ()
    return read if any(decimals_in(root.real) or decimals_in(root.imaginary) for root in read) else ()


def roots_round_to(printed: tuple[Complex, ...], found: list[Root], variable: str) -> bool:
    """Return whether the roots found round to the printed decimals."""
    exact = polynomial_of_roots(variable, tuple(found))
    try:
        return exact is not None and rounds_to(polynomial_of(printed, variable), exact)
    except ValueError:  # one lacks its conjugate
        return False


def root_rounds_to(printed: Complex, found: Root) -> bool:
    """Return whether a root with a closed form rounds to the decimals of a printed number."""
    return found.is_closed and is_number(parse_poles(str(found), functions=True)[0], printed)


def _surd(text: str, names: Any, variable: str, where: str) -> Root:
    """Return the root a + b sqrt(c) or a + b sqrt(c) I: sqrt(c) is read as a new name q, with q**2 = c."""
    before, _, behind = text.partition("sqrt")
    end = depth = 0
    while end < len(behind) and (depth or not end):
        depth += (behind[end] == "(") - (behind[end] == ")")
        end += 1
    q = "sqrt_"
    while names is not None and q in names:
        q += "_"
    known = None if names is None else {**names, q: "real"}
    value = parse_poles(before + q + behind[end:], known, where=where)[0]
    square = parse_scalar(behind[:end], names, where=where)
    real, imaginary = (_in_powers(part, q, text, where) for part in (value.real, value.imaginary))
    if not imaginary[0].is_zero or not (real[1] * imaginary[1]).is_zero:
        raise _no_surd(text, where)
    slope = real[1] + imaginary[1]
    radicand = slope**2 * (square if imaginary[1].is_zero else -square)
    sign = -1 if not slope.is_zero and slope.factors()[0].fraction() < 0 else 1
    return Root((Scalar.symbol(variable) - real[0]) ** 2 - radicand, variable, real[0], radicand, sign)


def _in_powers(value: Scalar, q: str, text: str, where: str) -> tuple[Scalar, Scalar]:
    """Return (a, b) with value = a + b q."""
    if not value.is_polynomial_in(q) or value.degree(q) > 1:
        raise _no_surd(text, where)
    *slope, constant = value.coefficients(q) or (Scalar.of(0),)
    return constant, slope[0] if slope else Scalar.of(0)


def _no_surd(text: str, where: str) -> InputError:
    return InputError(f'"{shown(text)}" is not of the form a + b sqrt(c)', where=where, repair="leave it out")


def numbers_agree(found: list[Any], expected: list[Any], names: Any, where: str) -> bool:
    """Return whether complex numbers with square roots, and roots without closed form, are the expected ones."""
    waiting = list(found)
    for i, entry in enumerate(expected):
        counted = isinstance(entry, str) and "CRootOf" in entry
        read = [] if counted else parse_poles([entry], names, where=f"{where}[{i}]", functions=True, rounding=True)
        match = next((n for n in waiting if (str(n) == entry if counted else is_number(n, read[0]))), None)
        if match is None:
            return False
        waiting.remove(match)
    return not waiting


def is_number(found: Complex | Root, expected: Complex) -> bool:
    """Return whether a complex number equals the expected one as a function of its symbols."""
    if isinstance(found, Root):
        return False
    return functions_agree(expected.real, found.real) and functions_agree(expected.imaginary, found.imaginary)
