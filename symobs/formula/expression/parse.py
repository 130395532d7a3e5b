"""Parsing of expressions: from the text of a user to exact values.

Three steps.  `tokens` cuts the text, decides what each name means and writes out what was left unsaid.  `parser` makes the
syntax tree, the same for problem files and printed equations, and `evaluation` computes with exact values; `budget` asks
before every operation how large its result can get.  Nothing is run as a program and nothing recurses on the depth of a
text, so any text ends, soon, in an exact value or in one of symobs's errors.
"""

from __future__ import annotations

import numbers
import re
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from math import lcm
from typing import TYPE_CHECKING

from symobs.exact import Complex, Matrix, Scalar, matrix_of_numbers
from symobs.formula.expression.evaluation import MOST_CHARACTERS, MatrixRows, plain_rows, read
from symobs.formula.expression.latex import without_latex
from symobs.formula.expression.names import Names, Scope, declared_name, pairs
from symobs.formula.expression.source import common_denominator_excess, shown
from symobs.formula.expression.syntax import EQUAL_ROWS, unequal_row
from symobs.formula.expression.tokenizer import MOST_DIGITS, sharing
from symobs.ground.errors import BudgetExceeded, ExpressionError, InexactInput, InputError, ShapeMismatch

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import TypeGuard

    from symobs.formula.expression.source import Number

__all__ = [
    "Names",
    "comma_between_digits",
    "declared_name",
    "parse_matrix",
    "parse_poles",
    "parse_polynomial",
    "parse_scalar",
    "right_side",
    "without_comma",
    "without_pole_names",
]

#: Rows in brackets of their own, as NumPy, SymPy and JSON print a matrix; [[1]; [2]] is a matrix of blocks.
ROWS = re.compile(r"\[\s*(\[[^][;]*\](?:[\s,]*\[[^][;]*\])*)[\s,]*\]")
ROW = re.compile(r"\[([^]]*)\]")
_LONGEST_REPAIR = 30
#: Numbers up to this many bits need no budget.
_NUMBERS, _SMALL = {int, Fraction}, 128
#: What else to do about floats.
FLOATS = ', or give the plant or the task floats="decimal"'
_PLAIN = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:/[0-9]+)?"
#: Numbers with nothing but a blank and a sign between them.
_SIGNED_APART = re.compile(rf"\s*[-+]?{_PLAIN}(?:\s+[-+]{_PLAIN})+\s*")
#: Beyond it a float stands for several integers.
_WHOLE_UP_TO = 2**53
_KINDS = {bool: "a truth value (bool)", dict: "a table (dict)", int: "a number", list: "a list", str: "a text"}


def parse_scalar(
    value: object,
    names: Names = None,
    *,
    variable: str | None = None,
    where: str = "",
    functions: bool = False,
    rounding: bool = False,
    nonlinear: bool = False,
) -> Scalar:
    """Return the real value of a text, an int, a Fraction or a Decimal.

    `names` are the declared names, None for any; `variable` (s, z or t) is known besides them; with `functions`, exp,
    sin, cos, sinh, cosh and sqrt of real arguments are read as generators, with `nonlinear` log, asin, acos, atan, abs and
    sign, too; with `rounding` decimals are (`exact.as_printed`).
    Raises ExpressionError for what is no expression, UnknownName, BudgetExceeded, InexactInput for a float, and
    InputError for any other type; all name the place `where`.
    """
    scope = Scope.of(names, variable, where, functions=functions, rounding=rounding)
    scope = replace(scope, nonlinear=nonlinear)
    return _real(_entry(value, scope, where), where)


def parse_matrix(
    value: object,
    names: Names = None,
    *,
    variable: str | None = None,
    where: str = "",
    functions: bool = False,
    rounding: bool = False,
    nonlinear: bool = False,
    beside: Sequence[object] = (),
) -> Matrix:
    """Return the matrix of a MATLAB-style text (`[1 0; 0 1]`) or of nested lists of int, Fraction and text.

    The values stand in one context with those of the texts `beside` it, which need not be carried over then.  In a
    `nonlinear` plant log, asin, acos, atan, abs and sign are read.
    Raises as `parse_scalar` does, and ShapeMismatch where rows differ in length or no entry is there.
    """
    scope = Scope.of(names, variable, where, functions=functions, rounding=rounding)
    scope = replace(scope, nonlinear=nonlinear)
    if _is_of_numbers(value):
        return matrix_of_numbers(value)
    if beside:
        scope = sharing(scope, beside)
    rows = _rows_of_text(value, scope, where) if isinstance(value, str) else _rows_of_lists(value, scope, where)
    real = [
        [entry if isinstance(entry, Scalar) else _real(entry, _cell(where, i, j)) for j, entry in enumerate(row)]
        for i, row in enumerate(rows)
    ]
    excess = common_denominator_excess([entry for row in real for entry in row])
    if excess:
        raise BudgetExceeded(f"the common denominator of the matrix would build {excess}", where=where)
    return Matrix.of(real)


def parse_poles(
    value: object,
    names: Names = None,
    *,
    variable: str | None = None,
    where: str = "",
    functions: bool = False,
    rounding: bool = False,
    roots: bool = False,
    letters: Iterable[str] = (),
) -> tuple[Complex, ...]:
    """Return the poles of a text with commas or semicolons between them, `-20+20i, -20-20i`, or of a list of numbers and texts.

    Semicolons and a comma between digits, `-1,5; -2`, are an error: its writer means a decimal, which has a point.
    i and j directly before a number are the imaginary unit, unless that name is declared; an error if the name is one of
    the `letters` that are in use.  `-1 ± 2i` is two poles; a row or a column of lists is its entries.
    With `functions`, or with `roots` alone, square roots are read as generators; where there are names, the values stand in
    one context with `variable`, that of the polynomial to be made of them.  Raises as `parse_scalar` does.
    """
    scope = Scope.of(names, None, where, functions=functions, rounding=rounding, roots=roots)
    scope = replace(scope, poles=True, letters=frozenset(letters))
    if isinstance(value, str):
        value = ",".join(str(one) for pole in _with_commas(value, where).split(",") for one in pairs(pole))
        scope = sharing(scope, [value], variable)
        return tuple(Complex.of(pole) for pole in _numbers_of_text(value, scope, where))
    listed = _as_list(value)
    if listed is None:
        repair = 'write [-1, -2] or "-1, -2"'
        raise InputError(f"a list of poles is expected, but {_kind(value)} came", where=where, repair=repair)
    rows = [pole for pole in listed if isinstance(pole, (list, tuple))]
    if rows and len(rows) == len(listed) and 1 in (len(rows), max(map(len, rows))):  # a row or a column of NumPy
        listed = [pole for row in rows for pole in row]
    listed = [one for pole in listed for one in pairs(pole)]
    scope = sharing(scope, listed, variable)
    texts = [pole for pole in listed if isinstance(pole, str)]
    for text in texts:
        _refuse_blanks_for_commas(text, where)
    plain = plain_rows(",".join(texts), scope) if len(texts) == len(listed) else None
    if plain is not None and len(plain[0][0]) == len(listed):
        return tuple(map(Complex.of, plain[0][0]))
    return tuple(Complex.of(_entry(pole, scope, f"{where}[{index}]")) for index, pole in enumerate(listed))


def comma_between_digits(value: object) -> str:
    """Return the first number of a text that has a decimal comma, or the two that a comma without a space sets apart."""
    found = re.search(r"(?<![0-9])[0-9]+,[0-9]+", value) if isinstance(value, str) else None
    return found[0] if found else ""


def without_comma(comma: str) -> str:
    """Return what to write in place of a number with a comma: 1.5; of 1,500, which may be thousands, both readings."""
    point = f"{comma.replace(',', '.')} with a decimal point"
    whole, _, behind = comma.partition(",")
    is_of_thousands = len(behind) == _THOUSANDS and whole != "0" and len(whole) <= _THOUSANDS
    return f"{point}, or {whole}{behind} if the comma sets thousands apart" if is_of_thousands else point


_THOUSANDS = 3


def _with_commas(text: str, where: str) -> str:
    """Return a text of numbers with commas in place of the semicolons between them."""
    if ";" not in text or "[" in text:
        return text
    comma = comma_between_digits(text)
    if comma:
        message = f'"{comma}" has a comma between its digits, and semicolons set the numbers apart'
        raise InputError(message, where=where, repair=f"write {without_comma(comma)}")
    return text.replace(";", ",")


def parse_polynomial(
    value: object, variable: str, names: Names = None, *, where: str = "", functions: bool = False
) -> Scalar:
    """Return a real polynomial of degree at least 1 in `variable` (s, or z in discrete time).

    `functions` and what is raised are as for `parse_scalar`.
    """
    if hasattr(value, "__len__") and not isinstance(value, str):  # NumPy's arrays and its poly1d, too
        message = "a polynomial is written out, but a list of coefficients came"
        raise InputError(message, where=where, repair=f'write for example "{variable}^2 + 9 {variable} + 20"')
    value = right_side(value) if isinstance(value, str) else value
    scope = replace(Scope.of(names, variable, where, functions=functions), polynomial=True)
    polynomial = _entry(value, scope, where)
    if isinstance(polynomial, Complex):
        message, repair = f"the polynomial in {variable} has complex coefficients", "write the conjugate factors too"
    elif not polynomial.is_polynomial_in(variable):
        message = f"a polynomial in {variable} is expected, but {variable} stands in a denominator"
        repair = "write the numerator and the denominator as polynomials of their own"
    elif polynomial.degree(variable) < 1:
        message = f"a polynomial in {variable} is expected, but its degree in {variable} is 0"
        repair = f"write for example {variable}^2 + 3 {variable} + 2"
    else:
        return polynomial
    raise ExpressionError(message, where=where, repair=repair)


#: "p(s) = …", "χ(λ) = …", "Y(s)/U(s) = G(s) = …"; "… = 0"; and the input behind a transfer function, "Y(s) = … U(s)".
_OF = r"{}[\w]{{0,20}}\s{{0,9}}\(\s{{0,9}}(?:s|z|p|lambda|lam|λ)\s{{0,9}}\)\s{{0,9}}"
_QUOTIENT = rf"{_OF.format('[YXCZ]')}/\s{{0,9}}{_OF.format('[URFVW]')}"
_FUNCTION_OF = re.compile(rf"\s{{0,9}}(?:(?:{_QUOTIENT}|{_OF.format('[^0-9]')})=\s{{0,9}})+(?!0\s{{0,9}}$)")
_INPUT = re.compile(r"(?<=[)\d])\s{0,9}[*·]?\s{0,9}[UVRW]\(\s{0,9}[szp]\s{0,9}\)\s{0,9}$")


def right_side(text: str) -> str:
    """Return the expression of "p(s) = s^2 + 1", "s^2 + 1 = 0", "Y(s)/U(s) = 1/s" and "Y(s) = 1/s U(s)"."""
    if len(text) > MOST_CHARACTERS:
        return text
    text = without_latex(text)
    left = _FUNCTION_OF.match(text)
    if left is not None:
        text = _INPUT.sub("", text[left.end() :])
    above, sign, right = text.rpartition("=")
    return above if sign and right.strip() == "0" else text


#: Poles as a set: {-1, -2}.
_SET = re.compile(r"^\s*\{([^{}]*)\}\s*$")
#: A pole by its name: s = …, λ1 = …, p_{1,2} = …
_POLE_NAME = r"(?:lambda|lam|mu|[szpλμσ])(?:_?[0-9]{1,2}|_?\{[0-9, ]{1,20}\}|[₀-₉]{1,2})?"
_NAMED_POLE = re.compile(rf"\s*((?:{_POLE_NAME}\s*=\s*)+)(.*)", re.DOTALL)
_COMMA_OUTSIDE = re.compile(r",(?![^{}]*\})")
_TIMES = {"double": 2, "twice": 2, "doppelt": 2, "zweifach": 2, "triple": 3, "dreifach": 3}
_MULTIPLE = re.compile(rf"\(\s*({'|'.join(_TIMES)})\s*\)\s*$")


#: Longer texts are no lists of poles by name.
_LONGEST_LIST = 2_000


def without_pole_names(text: str) -> str:
    """Return the poles of "{-1, -2}", "s = -1, -2", "λ1 = λ2 = -5", "p_{1,2} = -1 ± j" and "-5 (double)" one by one."""
    text = text if len(text) > _LONGEST_LIST else _SET.sub(r"\1", text)
    if ("=" not in text and "(" not in text) or len(text) > _LONGEST_LIST:
        return text
    found: list[str] = []
    pieces = _COMMA_OUTSIDE.split(text)
    for place, piece in enumerate(pieces):
        pole, count = piece, 1
        if named := _NAMED_POLE.fullmatch(pole):
            pole = named[2]
            count = sum(len(name.split(",")) for name in named[1].split("=")[:-1])
            behind = pieces[place + 1 : place + count]
            if len(pairs(pole)) > 1:
                count = max(1, count // 2)
            elif count > 1 and len(behind) == count - 1 and not any("=" in each for each in behind):
                count = 1  # a value for each index follows
        if multiple := _MULTIPLE.search(pole):
            pole, count = pole[: multiple.start()], count * _TIMES[multiple[1]]
        found += [pole.strip()] * count
    return ", ".join(found)


# -- one number ---------------------------------------------------------------------------------------------------


def _entry(value: object, scope: Scope, where: str) -> Number:
    """Return the number of a text or an exact Python number."""
    if not isinstance(value, str):
        return _exact(value, where)
    entries = read(value, scope, where)
    if len(entries) > 1:
        message = f'one expression is expected, but "{shown(value)}" holds {len(entries)}, set apart by commas'
        comma = comma_between_digits(value)
        repair = f"write {without_comma(comma)}" if comma else "write a decimal number with a point"
        raise ExpressionError(message, where=where, repair=repair)
    return _single(entries[0], where)


def _single(entry: Number | MatrixRows, where: str) -> Number:
    if isinstance(entry, MatrixRows):
        rows, columns = entry.shape
        repair = "write one expression without brackets around it"
        raise ExpressionError(f"one number is expected, but a {rows}×{columns} matrix came", where=where, repair=repair)
    return entry


def _exact(value: object, where: str) -> Number:
    """Return an exact Python number; raises InexactInput for a float, with the fraction to write instead."""
    if isinstance(value, (Scalar, Complex)):
        return value
    if isinstance(value, Decimal) and value.is_finite():
        return _rational(Fraction(value) if _is_short(value) else 10**MOST_DIGITS, where)
    if isinstance(value, bool) or not isinstance(value, numbers.Complex):
        repair = 'write an integer or a text such as "1/10"'
        raise InputError(f"{_kind(value)} is not an exact number", where=where, repair=repair)
    if not isinstance(value, numbers.Rational):
        number = complex(value)
        if not isinstance(value, numbers.Real) and _is_whole(number.real) and _is_whole(number.imag):
            real, imaginary = Scalar.of(int(number.real)), Scalar.of(int(number.imag))
            return real if imaginary.is_zero else Complex(real, imaginary)
        repair = f'write an exact value such as "{_exact_text(value)}"{FLOATS}'
        raise InexactInput(f"{shown(str(value))} is a float", where=where, repair=repair)
    return _rational(value, where)


def _rational(value: numbers.Rational | int, where: str) -> Scalar:
    """Return a fraction of Python's; raises `BudgetExceeded` where it is too long."""
    above, below = int(value.numerator), int(value.denominator)
    if max(abs(above), below) >= 10**MOST_DIGITS:
        raise BudgetExceeded(f"a number has more than {MOST_DIGITS} digits", where=where)
    return Scalar.rational(above, below)


def _is_short(value: Decimal) -> bool:
    """Return whether a decimal has few digits when it is written out: 1E+1000000 has many."""
    _, digits, exponent = value.as_tuple()
    return len(digits) + abs(int(exponent)) <= MOST_DIGITS


def _is_whole(part: float) -> bool:
    """Return whether a float is an integer that no other integer shares it with."""
    return abs(part) <= _WHOLE_UP_TO and part == int(part)


def _exact_text(value: numbers.Complex) -> str:
    """Return the fraction of the shortest decimal of a float, as a text."""
    decimals = str(value).strip("()")
    try:
        exact = str(Fraction(decimals))
    except ValueError:  # complex, infinite or not a number
        return "1/10" if isinstance(value, numbers.Real) else decimals
    return exact if len(exact) <= _LONGEST_REPAIR else shown(decimals)


def _real(value: Number, where: str) -> Scalar:
    if isinstance(value, Complex):
        repair = "write a real value; only poles may be complex"
        raise ExpressionError(f"a real value is expected, but {shown(str(value))} came", where=where, repair=repair)
    return value


# -- many numbers -------------------------------------------------------------------------------------------------


def _is_of_numbers(value: object) -> TypeGuard[list[list[int | Fraction]]]:
    """Return whether this is rows of one length, of integers and fractions that are not large: then nothing can be wrong."""
    if not isinstance(value, list) or not value or not all(isinstance(row, list) and row for row in value):
        return False
    entries = [entry for row in value for entry in row]
    if any(len(row) != len(value[0]) for row in value) or not {type(entry) for entry in entries} <= _NUMBERS:
        return False
    common = lcm(*(entry.denominator for entry in entries))
    return common.bit_length() <= _SMALL and all(entry.numerator.bit_length() <= _SMALL for entry in entries)


def _numbers_of_text(text: str, scope: Scope, where: str) -> list[Number]:
    """Return the numbers set apart by commas, or those of one row or column in brackets."""
    _refuse_blanks_for_commas(text, where)
    entries = read(text, scope, where)
    if len(entries) == 1 and isinstance(entries[0], MatrixRows) and 1 in entries[0].shape:
        return [number for row in entries[0].rows for number in row]
    return [_single(entry, where) for entry in entries]


def _refuse_blanks_for_commas(text: str, where: str) -> None:
    """Raise ExpressionError for numbers with a blank and a sign between them, -1 -2: two poles, or one difference.

    With blanks on both sides, -1 - 2, the sign is that of a difference, and of a complex number it is -1 +2i.
    """
    if len(text) > MOST_CHARACTERS or "[" in text or not any(_SIGNED_APART.fullmatch(part) for part in text.split(",")):
        return
    repair = f'write "{re.sub(r"(?<=[0-9.])[ ]+(?=[-+][0-9.])", ", ", text.strip())}", with commas between the numbers'
    raise ExpressionError(f'"{shown(text)}" may be several numbers or one sum', where=where, repair=repair)


#: The sign of a transpose behind the bracket of a matrix; ^T is one unless T is declared.
_TRANSPOSED = re.compile(r"(\[.*\])\s*(?:'|ᵀ|\^\s*(?:T|\{T\}|\(T\)))\s*", re.DOTALL)


def _rows_of_text(text: str, scope: Scope, where: str) -> Sequence[Sequence[Number]]:
    turned = _TRANSPOSED.fullmatch(text) if len(text) <= MOST_CHARACTERS else None
    if turned and not ("T" in text[turned.end(1) :] and scope.declares("T")):
        return [*zip(*_rows_of_text(turned[1], scope, where), strict=True)]
    if len(text) <= MOST_CHARACTERS and (rows := ROWS.fullmatch(text.strip())):
        text = f"[{'; '.join(row.strip() for row in ROW.findall(rows[1]))}]"
    try:
        entries = read(text, scope, where)
    except ExpressionError as error:
        if (";" in text or "follows a number" in str(error)) and _lacks_brackets(text, scope, where):
            error.repair = f'put the matrix in brackets: write "[{shown(text)}]"'
        raise
    if len(entries) > 1:
        repair = "write the rows in one pair of brackets: [1 0; 0 1]"
        if all(not isinstance(entry, MatrixRows) for entry in entries):
            repair = f"write [{shown(text)}] for a row, [{shown(text.replace(',', ';'))}] for a column"
        raise ExpressionError(f'"{shown(text)}" is not one matrix', where=where, repair=repair)
    return entries[0].rows if isinstance(entries[0], MatrixRows) else [[entries[0]]]


def _lacks_brackets(text: str, scope: Scope, where: str) -> bool:
    """Return whether a text is a matrix as soon as it stands in brackets."""
    if "[" in text or not text.strip():
        return False
    try:
        read(f"[{text}]", scope, where)
    except InputError:
        return False
    return True


def _rows_of_lists(value: object, scope: Scope, where: str) -> list[list[Number]]:
    listed = _as_list(value)
    if listed is None:
        repair = 'write nested lists or a text such as "[1 0; 0 1]"'
        raise InputError(f"a matrix is expected, but {_kind(value)} came", where=where, repair=repair)
    rows = [_as_list(row) for row in listed]
    if None in rows:
        repair = "write [[1, 2]] for one row, [[1], [2]] for one column"
        raise ShapeMismatch(f"row {rows.index(None) + 1} is not a list of entries", where=where, repair=repair)
    cells = [row for row in rows if row is not None]
    unequal = unequal_row(cells)
    if unequal:
        raise ShapeMismatch(unequal[0], where=where, repair=EQUAL_ROWS, row=unequal[1])
    if not cells or not cells[0]:
        raise ShapeMismatch("the matrix has no entry", where=where, repair="write for example [[0, 1], [0, -1]]")
    scope = sharing(scope, [cell for row in cells for cell in row])
    return [[_entry(cell, scope, _cell(where, i, j)) for j, cell in enumerate(row)] for i, row in enumerate(cells)]


def _as_list(value: object) -> Sequence[object] | None:
    """Return a list, a tuple or an array as a sequence, and None for anything else."""
    listed = value.tolist() if hasattr(value, "tolist") else value
    return listed if isinstance(listed, (list, tuple)) else None


def _cell(where: str, row: int, column: int) -> str:
    return f"{where}[{row}][{column}]"


def _kind(value: object) -> str:
    return _KINDS.get(type(value), f"a value of type {type(value).__name__}")
