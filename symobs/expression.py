"""Text to exact values: the only way from what a user wrote into the field.

Three steps.  `_Tokeniser` cuts the text, decides what each name means and writes out what was left unsaid (the product
of two neighbours, the comma MATLAB reads from a space inside brackets).  lark's LALR parser orders the tokens, by a
grammar that knows nothing of spaces.  `_Evaluator` computes, and asks before every operation how large its result can
get.  Nothing is run as a program and nothing recurses on the depth of a text, so any text at all ends in an exact
value or in one of symobs's errors, soon.
"""

from __future__ import annotations

import keyword
import numbers
import operator
import re
import unicodedata
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction
from functools import cache
from math import comb, isqrt
from typing import TYPE_CHECKING, Any, NoReturn, TypeAlias

from lark import Lark, Token, UnexpectedToken, v_args
from lark.exceptions import VisitError
from lark.lexer import Lexer
from lark.visitors import Transformer_NonRecursive

from symobs.errors import BudgetExceeded, ExpressionError, InexactInput, InputError, ShapeMismatch, UnknownName
from symobs.exact import Complex, Matrix, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

Names: TypeAlias = "Mapping[str, object] | None"
Number: TypeAlias = Scalar | Complex

FUNCTIONS = ("sqrt", "exp", "sin", "cos", "sinh", "cosh")
RESERVED = ("I", "oo", "inf", "nan", "pi")
IMAGINARY = ("i", "j", "I")

MOST_CHARACTERS = 10_000
MOST_NESTING = 100
MOST_DIGITS = 1_000
MOST_EXPONENT = 1_000
MOST_NAMES = 400
LONGEST_NAME = 64
#: Bounds on a value: a coefficient of 10,000 bits still prints, and a degree of 10,000 still lists its coefficients.
MOST_BITS = 10_000
MOST_DEGREE = 10_000
MOST_TERMS = 20_000
#: Machine words which all operations of one text together may write, about a second's work at worst.
MOST_WORDS = 3_000_000
#: What an error shows of a text.
MOST_SHOWN = 60


# -- the faces ----------------------------------------------------------------------------------------------------


def parse_scalar(value: object, names: Names = None, *, variable: str | None = None, where: str = "") -> Scalar:
    """Return the real value of a text (or of an int or a Fraction).

    `names` are the declared names, None for any; `variable` (s or z) is known besides them.
    Raises ExpressionError, InexactInput for floats, InputError for other types.
    """
    return _real(_entry(value, _Scope.of(names, variable, where), where), where)


def parse_matrix(value: object, names: Names = None, *, where: str = "") -> Matrix:
    """Return the matrix of a MATLAB-style text (`[1 0; 0 1]`) or of nested lists of int, Fraction and text.

    Raises as `parse_scalar` does, and ShapeMismatch where rows differ in length or there is no entry.
    """
    scope = _Scope.of(names, None, where)
    rows = _rows_of_text(value, scope, where) if isinstance(value, str) else _rows_of_lists(value, scope, where)
    _require_rectangle(rows, where)
    real = [[_real(entry, _cell(where, i, j)) for j, entry in enumerate(row)] for i, row in enumerate(rows)]
    _require_common_denominator([entry for row in real for entry in row], where)
    return Matrix.of(real)


def parse_poles(value: object, names: Names = None, *, where: str = "") -> tuple[Complex, ...]:
    """Return the poles of a comma-separated text (`-20+20i, -20-20i`) or of a list of numbers and texts."""
    scope = _Scope.of(names, None, where)
    if isinstance(value, str):
        entries = _read(value, scope, where)
        if len(entries) == 1 and isinstance(entries[0], _Grid) and 1 in entries[0].shape:
            entries = [entry for row in entries[0].rows for entry in row]
        return tuple(Complex.of(_single(entry, where)) for entry in entries)
    listed = _as_list(value)
    if listed is None:
        raise InputError(
            f"a list of poles is expected, {_kind(value)} came", where=where, repair='write [-1, -2] or "-1, -2"'
        )
    return tuple(Complex.of(_entry(entry, scope, f"{where}[{k}]")) for k, entry in enumerate(listed))


def parse_polynomial(value: object, variable: str, names: Names = None, *, where: str = "") -> Scalar:
    """Return a real polynomial of degree at least 1 in `variable` (s, or z in discrete time)."""
    polynomial = _entry(value, _Scope.of(names, variable, where), where)
    if isinstance(polynomial, Complex):
        message = f"the polynomial in {variable} has complex coefficients"
        raise ExpressionError(message, where=where, repair="add the conjugate factors")
    if not polynomial.is_polynomial_in(variable):
        message = f"a polynomial in {variable} is expected, but {variable} stands in a denominator"
        raise ExpressionError(message, where=where, repair="multiply it out")
    if polynomial.degree(variable) < 1:
        message = f"a polynomial of degree at least 1 in {variable} is expected, but it does not contain {variable}"
        raise ExpressionError(message, where=where, repair=f"write for example {variable}^2 + 3 {variable} + 2")
    return polynomial


def declared_name(name: object, where: str = "") -> str:
    """Return `name` if a symbol may be called so; raises ExpressionError where it may not."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        shown = _shown(name) if isinstance(name, str) else _kind(name)
        repair = "begin with a letter A-Z or a-z, go on with letters, digits and _"
        raise ExpressionError(f'"{shown}" is not a name', where=where, repair=repair)
    refusal = _refusal(name)
    if refusal:
        message, repair = refusal
        raise ExpressionError(message, where=where, repair=repair)
    return name


# -- what comes in ------------------------------------------------------------------------------------------------


def _entry(value: object, scope: _Scope, where: str) -> Number:
    """Return the one number that a text or an exact Python number stands for."""
    if not isinstance(value, str):
        return _exact(value, where)
    entries = _read(value, scope, where)
    if len(entries) > 1:
        message = f'one expression is expected, but "{_shown(value)}" holds {len(entries)}, set apart by commas'
        raise ExpressionError(message, where=where, repair="write decimals with a point")
    return _single(entries[0], where)


def _single(entry: Number | _Grid, where: str) -> Number:
    if isinstance(entry, _Grid):
        rows, columns = entry.shape
        raise ExpressionError(f"one number is expected, but a {rows}×{columns} matrix came", where=where)
    return entry


def _exact(value: object, where: str) -> Number:
    """Return an exact Python number; floats are refused with the fraction to write instead."""
    if isinstance(value, (Scalar, Complex)):
        return value
    if isinstance(value, numbers.Rational) and not isinstance(value, bool):
        above, below = int(value.numerator), int(value.denominator)
        if max(abs(above), below) >= 10**MOST_DIGITS:
            raise BudgetExceeded(f"a number has more than {MOST_DIGITS:,} digits".replace(",", " "), where=where)
        return Scalar.rational(above, below)
    if isinstance(value, numbers.Complex) and not isinstance(value, bool):
        repair = f'write an exact value such as "{_exact_text(value)}"'
        raise InexactInput(f"{value} is a float", where=where, repair=repair)
    repair = 'give an int, a Fraction or a text such as "1/10"'
    raise InputError(f"{_kind(value)} is not an exact number", where=where, repair=repair)


def _exact_text(value: numbers.Complex) -> str:
    """Return what the shortest decimals of a float stand for, in a few characters."""
    try:
        text = str(Fraction(str(value)))
    except ValueError:  # not finite, or complex
        text = str(value).strip("()") if isinstance(value, complex) else "1/10"
    return text if len(text) <= 30 else str(value)


def _real(value: Number, where: str) -> Scalar:
    if isinstance(value, Complex):
        raise ExpressionError(f"a real value is expected, but {_shown(str(value))} came", where=where)
    return value


def _as_list(value: object) -> Sequence[object] | None:
    """Return a list, a tuple or an array as a sequence, None for anything else."""
    listed = value.tolist() if hasattr(value, "tolist") else value
    return listed if isinstance(listed, (list, tuple)) else None


def _kind(value: object) -> str:
    return f"a {type(value).__name__}"


def _cell(where: str, row: int, column: int) -> str:
    return f"{where}[{row}][{column}]"


def _rows_of_lists(value: object, scope: _Scope, where: str) -> list[list[Number]]:
    rows = _as_list(value)
    if rows is None:
        repair = 'write nested lists or a text such as "[1 0; 0 1]"'
        raise InputError(f"a matrix is expected, {_kind(value)} came", where=where, repair=repair)
    entries: list[list[Number]] = []
    for i, row in enumerate(rows):
        cells = _as_list(row)
        if cells is None:
            repair = "write [[1, 2]] for one row, [[1], [2]] for one column"
            raise ShapeMismatch(f"row {i + 1} of the matrix is not a list of entries", where=where, repair=repair)
        entries.append([_entry(cell, scope, _cell(where, i, j)) for j, cell in enumerate(cells)])
    return entries


def _rows_of_text(text: str, scope: _Scope, where: str) -> Sequence[Sequence[Number]]:
    entries = _read(text, scope, where)
    if len(entries) > 1:
        repair = "write the rows inside brackets: [1 0; 0 1]"
        raise ExpressionError(f'"{_shown(text)}" is not one matrix', where=where, repair=repair)
    entry = entries[0]
    return entry.rows if isinstance(entry, _Grid) else [[entry]]


def _require_rectangle(rows: Sequence[Sequence[Number]], where: str) -> None:
    if not rows or not rows[0]:
        raise ShapeMismatch("the matrix has no entry", where=where)
    for index, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            message = f"row {index} has {_entries(len(row))}, but row 1 has {len(rows[0])}"
            raise ShapeMismatch(message, where=where, row=index, length=len(row), expected=len(rows[0]))


def _entries(count: int) -> str:
    return "1 entry" if count == 1 else f"{count} entries"


# -- the steps ----------------------------------------------------------------------------------------------------

GRAMMAR = r"""
row: sum (_COMMA sum)*
?sum: product | sum ADD product -> binary
?product: signed | product MULTIPLY signed -> binary
?signed: power | ADD signed -> sign
?power: atom | atom POWER signed -> power
?atom: VALUE | _OPEN sum _CLOSE | LEFT row (_END row)* _RIGHT -> brackets | FUNCTION _OPEN sum _CLOSE -> call
%declare VALUE FUNCTION ADD MULTIPLY POWER LEFT _RIGHT _OPEN _CLOSE _COMMA _END
"""


class _TokenStream(Lexer):
    """Hands lark the tokens that are already made."""

    def __init__(self, _: object) -> None:
        pass

    def lex(self, tokens: Any) -> Iterator[Token]:  # type: ignore[override]  # noqa: ANN401 - lark's one-argument form
        return iter(tokens)


@cache
def _parser() -> Lark:
    return Lark(GRAMMAR, parser="lalr", lexer=_TokenStream, start="row", maybe_placeholders=False)


def _read(text: str, scope: _Scope, where: str) -> list[Number | _Grid]:
    """Return the entries of a text, set apart by commas; every error leaves here with its place."""
    if len(text) > MOST_CHARACTERS:
        message = f"the expression has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise BudgetExceeded(message, where=where)
    try:
        tokens = _Tokeniser(text, scope).run()
        return _Evaluator().transform(_parser().parse(tokens))
    except _Trouble as trouble:
        raise trouble.at(text, where) from None
    except UnexpectedToken as found:
        raise _missing_operand(found.token, text).at(text, where) from None
    except VisitError as wrapped:
        if isinstance(wrapped.orig_exc, _Trouble):
            raise wrapped.orig_exc.at(text, where) from None
        raise
