"""Text becomes exact values by the rules of the contract, and whatever is no expression becomes a clear error."""

from __future__ import annotations

import time
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
import pytest
import sympy
from hypothesis import example, given
from hypothesis import strategies as st

from symobs.exact import Complex, Matrix, Scalar
from symobs.formula.expression import (
    declared_name,
    evaluation,
    parse_matrix,
    parse_poles,
    parse_polynomial,
    parse_scalar,
)
from symobs.ground.errors import (
    BudgetExceeded,
    ExpressionError,
    InexactInput,
    InputError,
    ProblemErrors,
    ShapeMismatch,
    SymobsError,
    UnknownName,
)
from tests.kit import tabled

if TYPE_CHECKING:
    from collections.abc import Callable

# Ten times what the slowest text takes on a slow machine: the bound says "soon", it measures nothing.
SOON = 10.0

a, b, c, s, z, omega, h1, i = map(Scalar.symbol, ("a", "b", "c", "s", "z", "omega", "h1", "i"))
one = Scalar.of(1)
Case = tuple[str, type[SymobsError], str]


def q(above: int, below: int = 1) -> Scalar:
    """The number above / below."""
    return Scalar.rational(above, below)


def fractions_of(matrix: Matrix) -> list[list[Fraction]]:
    """The entries of a numeric matrix."""
    return [[entry.fraction() for entry in row] for row in matrix.rows]


# -- numbers and operators ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0", 0),
        ("007", 7),
        ("10.78", Fraction(539, 50)),
        ("1e-3", Fraction(1, 1000)),
        ("1E3", 1000),
        ("1.5e+2", 150),
        (".5", Fraction(1, 2)),
        ("5.", 5),
        ("0.1 + 0.2", Fraction(3, 10)),
        ("1e1000/1e999", 10),
        ("1 + 2 * 3", 7),
        ("7 - 2 - 1", 4),
        ("12 / 2 / 3", 2),
        ("12 / 2 * 3", 18),
        ("-2^2", -4),
        ("(-2)^2", 4),
        ("2^3^2", 512),
        ("2**3**2", 512),
        ("2^-1", Fraction(1, 2)),
        ("2^-2^2", Fraction(1, 16)),
        ("(2/3)^-2", Fraction(9, 4)),
        ("2^(3-1)", 4),
        ("2^(4/2)", 4),
        ("0^0", 1),
        ("2*-3", -6),
        ("2--3", 5),
        ("+-+2", -2),
        ("- -2", 2),
        ("(2)(3)", 6),
        ("2(3)", 6),
        ("(2) 3", 6),
        ("sqrt(4)", 2),
        ("sqrt (9/16)", Fraction(3, 4)),
        ("2 sqrt(0.25) + 1", 2),
        ("sqrt(0)", 0),
        ("\n1\t+\r\n 2 ", 3),
        ("[5]", 5),
        ("2*[[3]]", 6),
        ("I^2", -1),
        ("i*j", -1),
        ("(1+2i)(1-2i)", 5),
        ("2i 3i", -6),
        ("1/i + i", 0),
        ("i^-2", -1),
        ("9" * 1000, 10**1000 - 1),
        ("1^1000", 1),
    ],
)
def test_number(text: str, expected: Fraction | int) -> None:
    assert parse_scalar(text).fraction() == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("4 s", s * 4),
        ("4s", s * 4),
        ("s 4", s * 4),
        ("(s+1)(s+2)", (s + 1) * (s + 2)),
        ("(s+1) s", (s + 1) * s),
        ("omega^2 (1 - h1)", omega * omega * (one - h1)),
        ("2 a b c", a * b * c * 2),
        ("a b^2", a * b * b),
        ("-a^2", -(a * a)),
        ("s -1", s - 1),
        ("a^-2", one / (a * a)),
        ("(a - b)^3", (a - b) * (a - b) * (a - b)),
        ("(a^2 - b^2)/(a - b)", a + b),
        ("a - a", q(0)),
        ("e1 + x_2", Scalar.symbol("e1") + Scalar.symbol("x_2")),
        ("2e", Scalar.symbol("e") * 2),
        ("2e3e", Scalar.symbol("e") * 2000),
        ("A" * 64, Scalar.symbol("A" * 64)),
        ("−2·a\u00a0b² × ω₀⁻¹", a * b * b * -2 / Scalar.symbol("omega0")),
        ("(a − b)³", (a - b) * (a - b) * (a - b)),
    ],
)
def test_symbols(text: str, expected: Scalar) -> None:
    assert parse_scalar(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("b(1 - h1)", b * (one - h1)),
        ("b (1 - h1)", b * (one - h1)),
        ("i", i),
        ("20i", i * 20),
        ("i^2", i * i),
        ("I^2 + i", i - 1),
        ("j^2", q(-1)),
    ],
)
def test_declared_name_is_a_factor_and_may_be_i(text: str, expected: Scalar) -> None:
    assert parse_scalar(text, {"b": "positive", "h1": "real", "i": "real"}) == expected


def test_a_declared_capital_i_is_that_symbol_and_i_is_the_unit() -> None:
    assert parse_scalar("I^2 + i^2", {"I": "positive"}) == Scalar.symbol("I") * Scalar.symbol("I") - 1
    assert str(parse_poles("-I + 2i", {"I": "positive"})[0]) == "-I + 2*sqrt(-1)"


def test_an_index_below_belongs_to_the_name_that_is_declared() -> None:
    assert parse_scalar("h₂ + x₁", {"h_2": "real", "x1": "real"}) == Scalar.symbol("h_2") + Scalar.symbol("x1")


@tabled
def test_matrices_are_read_as_they_are_printed(text: str, expected: str) -> None:
    assert parse_matrix(text) == parse_matrix(expected)


@pytest.mark.parametrize("poles", ["-1 ± 2i, −3", ["-1 ± 2i", "-3"]])
def test_a_pair_of_poles_is_two(poles: object) -> None:
    assert [str(pole) for pole in parse_poles(poles)] == ["-1 + 2*I", "-1 - 2*I", "-3"]


def test_terms_are_bounded_by_the_monomials_there_are() -> None:
    factors = [(a + b + 1) ** 12, (a + b * 2 + 3) ** 12, (a * 2 + b + 5) ** 12]
    assert parse_scalar("(a+b+1)^12 * (a+2b+3)^12 * (2a+b+5)^12") == _product(factors)


def test_variable_is_known_beside_the_names_and_multiplies() -> None:
    assert parse_scalar("1/(s(s+b))", {"b": "real"}, variable="s") == one / (s * (s + b))
    with pytest.raises(UnknownName, match='the name "s" is not declared, at column 1 of "s"; declared: b'):
        parse_scalar("s", {"b": "real"})
    assert parse_scalar("s", {"s": "real"}) == s


def test_exact_values_of_python_pass() -> None:
    assert parse_scalar(3) == q(3)
    assert parse_scalar(Fraction(-1, 3)) == q(-1, 3)
    assert parse_scalar(a) == a
    assert parse_scalar(10**1000 - 1).fraction() == 10**1000 - 1


# -- matrices -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[0 1; 0 -1]", [[0, 1], [0, -1]]),
        ("[1 -2]", [[1, -2]]),
        ("[1 - 2]", [[-1]]),
        ("[1-2]", [[-1]]),
        ("[1- 2]", [[-1]]),
        ("[1 -2 + 3]", [[1, 1]]),
        ("[1 -2 +3]", [[1, -2, 3]]),
        ("[1 - -2]", [[3]]),
        ("[1 --2]", [[1, 2]]),
        ("[1 , - 2]", [[1, -2]]),
        ("[- 1 2]", [[-1, 2]]),
        ("[(1 -2) 3]", [[-1, 3]]),
        ("[(1\n-2) 3]", [[-1, 3]]),
        ("[2 (3)]", [[2, 3]]),
        ("[2(3)]", [[6]]),
        ("[(2) (3)]", [[2, 3]]),
        ("[(2)(3)]", [[6]]),
        ("[2 (-3)]", [[2, -3]]),
        ("[2 *3 4/ 2 2 ^2 2 ** 3]", [[6, 2, 4, 8]]),
        ("[2^ -1]", [[Fraction(1, 2)]]),
        ("[0.5 1e-1]", [[Fraction(1, 2), Fraction(1, 10)]]),
        ("[1,2;3,4]", [[1, 2], [3, 4]]),
        ("[1 2\n3 4]", [[1, 2], [3, 4]]),
        ("[1 2\r\n3 4]", [[1, 2], [3, 4]]),
        ("[1 2\r3 4]", [[1, 2], [3, 4]]),
        ("[1 2;\n 3 4;\n]", [[1, 2], [3, 4]]),
        ("\n[\n  1 2\n\n  3 4\n]\n", [[1, 2], [3, 4]]),
        ("[ 1  2 ; 3 4 ; ]", [[1, 2], [3, 4]]),
        ("[[1] 2]", [[1, 2]]),
        ("[sqrt(4) sqrt(9)]", [[2, 3]]),
        ("[i*i 2]", [[-1, 2]]),
        ("-3", [[-3]]),
        ("[7]", [[7]]),
    ],
)
def test_matrix_of_numbers(text: str, expected: list[list[Fraction | int]]) -> None:
    assert fractions_of(parse_matrix(text)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[0 1; -omega^2 -b]", [[q(0), one], [-(omega * omega), -b]]),
        ("[a (b)]", [[a, b]]),
        ("[a(b)]", [[a * b]]),
        ("[(a (b)) c]", [[a * b, c]]),
        ("[a (b)(c)]", [[a, b * c]]),
        ("[2b c]", [[b * 2, c]]),
        ("[2 b]", [[q(2), b]]),
        ("[a -b]", [[a, -b]]),
        ("[a - b]", [[a - b]]),
        ("[a/b c]", [[a / b, c]]),
        ("[1/(a (1 + b)) c]", [[one / (a * (one + b)), c]]),
    ],
)
def test_matrix_of_symbols(text: str, expected: list[list[Scalar]]) -> None:
    names = {"a": "real", "b": "real", "c": "real", "omega": "positive"}
    assert parse_matrix(text, names) == Matrix.of(expected)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ([[0, 1], [0, -1]], [[0, 1], [0, -1]]),
        (((1, 2),), [[1, 2]]),
        ([["1/2", Fraction(1, 3)], ["1e-1", 2]], [[Fraction(1, 2), Fraction(1, 3)], [Fraction(1, 10), 2]]),
        ([["1 -2", "[3]"]], [[-1, 3]]),
        (np.array([[1, 2], [3, 4]]), [[1, 2], [3, 4]]),
        ([np.array([1, 2])], [[1, 2]]),
        ([[np.int64(5)]], [[5]]),
        ([[sympy.Rational(1, 3)]], [[Fraction(1, 3)]]),
    ],
)
def test_matrix_of_nested_lists(value: object, expected: list[list[Fraction | int]]) -> None:
    assert fractions_of(parse_matrix(value)) == expected


@tabled
def test_ragged_rows_name_the_row_and_both_lengths(value: object, row: int, message: str) -> None:
    with pytest.raises(ShapeMismatch) as caught:
        parse_matrix(value, where="plant.A")
    assert message in str(caught.value)
    assert caught.value.where == "plant.A"
    assert caught.value.facts["row"] == row


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ([], "the matrix has no entry"),
        ([[]], "the matrix has no entry"),
        ([[], []], "the matrix has no entry"),
        ([1, 2], "row 1 is not a list of entries"),
        (["1 2"], "row 1 is not a list of entries"),
        ([[1], 2], "row 2 is not a list of entries"),
        (np.array([1, 2]), "row 1 is not a list of entries"),
    ],
)
def test_lists_without_the_shape_of_a_matrix(value: object, message: str) -> None:
    with pytest.raises(ShapeMismatch, match=message):
        parse_matrix(value)


# -- poles and polynomials ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("-10, -10", [(-10, 0), (-10, 0)]),
        ("-20+20i, -20-20i", [(-20, 20), (-20, -20)]),
        ("-1/2", [(Fraction(-1, 2), 0)]),
        ("-1 + 2*I, -1 - 2j", [(-1, 2), (-1, -2)]),
        ("1/2i", [(0, Fraction(1, 2))]),
        ("(1+i)^2", [(0, 2)]),
        ("1/(1+i)", [(Fraction(1, 2), Fraction(-1, 2))]),
        ("[-1 -2]", [(-1, 0), (-2, 0)]),
        ("[-1+i; -1-i]", [(-1, 1), (-1, -1)]),
        ([-2, "-2"], [(-2, 0), (-2, 0)]),
        (["-1+i", "-1 - i"], [(-1, 1), (-1, -1)]),
        ((Fraction(-1, 2),), [(Fraction(-1, 2), 0)]),
        (np.array([-1, -2]), [(-1, 0), (-2, 0)]),
        ([], []),
    ],
)
def test_poles(value: object, expected: list[tuple[Fraction | int, Fraction | int]]) -> None:
    poles = [(pole.real.fraction(), pole.imaginary.fraction()) for pole in parse_poles(value)]
    assert poles == expected


def test_symbolic_poles() -> None:
    assert parse_poles("-a, -b + c i", {"a": "real", "b": "real", "c": "real"}) == (
        Complex.of(-a),
        Complex(-b, c),
    )


@pytest.mark.parametrize("value", [-2, None, {"a": 1}, 0.5])
def test_poles_are_a_list(value: object) -> None:
    with pytest.raises(InputError, match="a list of poles is expected"):
        parse_poles(value)


@pytest.mark.parametrize(
    ("text", "variable", "expected"),
    [
        ("s^2 + 4 s + 4", "s", (s + 2) * (s + 2)),
        ("(s+10)^2", "s", (s + 10) * (s + 10)),
        ("s(s+1)/2", "s", s * (s + 1) / 2),
        ("s^2 + (b + h1) s + omega^2 (1 - h1)", "s", s * s + (b + h1) * s + omega * omega * (one - h1)),
        ("s/b + 1", "s", s / b + 1),
        ("(s + 1 + i)(s + 1 - i)", "s", s * s + s * 2 + 2),
        ("(s^2 - 1)/(s - 1)", "s", s + 1),
        ("z - 1/2", "z", z - Fraction(1, 2)),
    ],
)
def test_polynomial(text: str, variable: str, expected: Scalar) -> None:
    assert parse_polynomial(text, variable) == expected


@tabled
def test_no_polynomial(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        parse_polynomial(text, "s", where="observer_polynomial")


def test_variable_of_the_polynomial_cannot_be_declared() -> None:
    with pytest.raises(ExpressionError, match='"s" is the variable of the polynomial'):
        parse_polynomial("s + 1", "s", {"s": "positive"})
    assert parse_polynomial("z + s", "z", {"s": "positive"}) == z + s


# -- what is refused ----------------------------------------------------------------------------------------------

OPERAND = 'a number, a name or "(" is expected'
REFUSED: list[Case] = [
    # grammar
    ("", ExpressionError, "the text is empty"),
    (" \n ", ExpressionError, "the text is empty"),
    ("1 +", ExpressionError, f"{OPERAND} at the end"),
    ("* 2", ExpressionError, f'{OPERAND} before "*"'),
    ("2 + / 3", ExpressionError, f'{OPERAND} before "/"'),
    ("()", ExpressionError, f'{OPERAND} before ")"'),
    ("2 3", ExpressionError, "a number follows a number"),
    ("2^3 4", ExpressionError, "a number follows a number"),
    ("1.2.3", ExpressionError, "a number follows a number"),
    (".5 2", ExpressionError, "a number follows a number"),
    ("1 000", ExpressionError, "a number follows a number"),
    ("(1", ExpressionError, 'this "(" is never closed'),
    ("1)", ExpressionError, 'this ")" closes nothing'),
    ("(1]", ExpressionError, 'where "(" has to be closed first'),
    ("(1, 2)", ExpressionError, '"," stands inside parentheses'),
    ("[(1; 2)]", ExpressionError, '";" stands inside parentheses'),
    ("1; 2", ExpressionError, "write the rows in brackets"),
    ("1,5", ExpressionError, "write a decimal number with a point"),
    # brackets
    ("[]", ExpressionError, f'{OPERAND} before "]"'),
    ("[;]", ExpressionError, f'{OPERAND} before "]"'),
    ("[1,,2]", ExpressionError, f'{OPERAND} before ","'),
    ("[1,2,]", ExpressionError, f'{OPERAND} before "]"'),
    ("[1 +\n2]", ExpressionError, f'{OPERAND} before "\\n"'),
    ("[[1 2] 3]", ExpressionError, "a matrix stands inside"),
    ("[[1, 2], [3, 4]]", ExpressionError, "[1 0; 0 1]"),
    ("[1 2]*[1 2]", ExpressionError, "a matrix stands inside"),
    ("[1 2] + 1", ExpressionError, "a matrix stands inside"),
    ("1/[1 2]", ExpressionError, "a matrix stands inside"),
    ("[1 2]^2", ExpressionError, "a matrix stands inside"),
    ("2^[1 2]", ExpressionError, "a matrix stands inside"),
    ("sqrt([1 2])", ExpressionError, "a matrix stands inside"),
    ("[a' 1]", ExpressionError, "a transpose is not read"),
    ("[1 2]", ExpressionError, "one number is expected, but a 1×2 matrix came"),
    # values
    ("1/0", ExpressionError, "division by zero"),
    ("1/(a - a)", ExpressionError, "division by zero"),
    ("0^-1", ExpressionError, "division by zero"),
    ("(i^2 + 1)^-1", ExpressionError, "division by zero"),
    ("20i", ExpressionError, "a real value is expected, but 20*I came"),
    ("2^a", ExpressionError, "the exponent a is not an integer"),
    ("4^(1/2)", ExpressionError, "the exponent 1/2 is not an integer"),
    ("2^i", ExpressionError, "the exponent I is not an integer"),
    ("sqrt(sqrt(2))", ExpressionError, "sqrt of a rational number is possible"),
    ("sqrt(-4)", ExpressionError, "a real value is expected, but 2*I came"),
    ("sqrt(a)", ExpressionError, "sqrt of a rational number is possible"),
    ("sqrt(i)", ExpressionError, "sqrt of a complex number"),
    ("exp(1)", ExpressionError, "exp has no exact value"),
    ("cos(1)", ExpressionError, "cos has no exact value"),
    # names
    ("sqrt", ExpressionError, '"sqrt" is a function'),
    ("sin 4", ExpressionError, '"sin" is a function'),
    ("[sqrt (4)]", ExpressionError, '"sqrt" is a function'),
    ("f(a)", ExpressionError, '"f" is followed by "(" but is neither declared nor a function'),
    ("f (a)", ExpressionError, "write f*(...) for a product"),
    ("lambda", ExpressionError, 'write another name, such as "lam"'),
    ("None", ExpressionError, "is a word of Python"),
    ("for", ExpressionError, 'write another name, such as "for_"'),
    ("pi", ExpressionError, '"pi" is reserved'),
    ("oo", ExpressionError, '"oo" is reserved'),
    ("inf", ExpressionError, '"inf" is reserved'),
    ("nan + 1", ExpressionError, '"nan" is reserved'),
    ("x" * 65, ExpressionError, "has more than 64 characters"),
    ("_a", ExpressionError, "begin a name with a letter"),
    ("1_000", ExpressionError, "begin a name with a letter"),
    # programs, other languages and look-alikes
    ("__import__('os').system('x')", ExpressionError, "belongs to no expression"),
    ("().__class__", ExpressionError, "belongs to no expression"),
    ("a.b", ExpressionError, "belongs to no expression"),
    ("a .* b", ExpressionError, "* / ^ without a point"),
    ("!!python/object:os.system", ExpressionError, "belongs to no expression"),
    ("{a: 1}", ExpressionError, "around what belongs together, [ ] around a list"),
    ("a = 1", ExpressionError, 'the character "=" belongs to no expression'),
    ("lambda: 1", ExpressionError, "is a word of Python"),
    ("ά + 1", ExpressionError, "spell the letter out"),
    ("1 — 2", ExpressionError, "write the ASCII minus -"),
    ("2•3", ExpressionError, "write the ASCII star *"),
    ("1÷2", ExpressionError, "write the ASCII slash /"),
    ("aⁿ", ExpressionError, "belongs to no expression"),
    ("a²²^2 + ²", ExpressionError, "expected before"),
    ("√ 4", ExpressionError, "write sqrt( )"),
    ("１", ExpressionError, 'write the ASCII "1"'),  # noqa: RUF001 - a full-width digit is the point
    ("٣", ExpressionError, "(U+0663) belongs to no expression"),
    ("\u202e1", ExpressionError, '"\\u202e" (U+202E)'),
    ("a\x00b", ExpressionError, '"\\x00"'),
    ("\ud800", ExpressionError, '"\\ud800"'),
    # budgets
    ("1" * 1001, BudgetExceeded, "more than 1000 digits"),
    ("0." + "1" * 1001, BudgetExceeded, "more than 1000 digits"),
    ("1" * 100_000, BudgetExceeded, "more than 10000"),
    ("a+" * 5000 + "a", BudgetExceeded, "has 10001 characters"),
    ("1e1001", BudgetExceeded, "a power of ten is beyond 1000"),
    ("1e-99999999999999999999", BudgetExceeded, "a power of ten is beyond 1000"),
    ("a^1001", BudgetExceeded, "the exponent is beyond 1000"),
    ("a^-1001", BudgetExceeded, "the exponent is beyond 1000"),
    ("9^9^9^9", BudgetExceeded, "the exponent is beyond 1000"),
    ("((10^64)^64)^64", BudgetExceeded, "10000 bits"),
    ("(10^64)^64", BudgetExceeded, "10000 bits"),
    ("(((a^1000)^1000)^1000)^1000", BudgetExceeded, "a power beyond 10000"),
    ("(a+b+c+d)^1000", BudgetExceeded, "more than 20000 terms"),
    ("(a+b+c+d)^-1000", BudgetExceeded, "more than 20000 terms"),
    ("(x+1)^1000^1000", BudgetExceeded, "the exponent is beyond 1000"),
    ("((x+1)^1000)^1000", BudgetExceeded, "would build"),
    ("((a+b*i)/(c+d*i))^900", BudgetExceeded, "would build"),
    ("*".join(["999^999"] * 900), BudgetExceeded, "10000 bits"),
    ("*".join(["(a+b+c+d+e)"] * 800), BudgetExceeded, "would build"),
    ("".join(f"(a{k}+b{k})" for k in range(40)), BudgetExceeded, "more than 20000 terms"),
    ("+".join(["(s+1)^1000"] * 800), BudgetExceeded, "too much"),
    ("+".join(f"1/(s+{k})" for k in range(900)), BudgetExceeded, "too much"),
    ("+".join(f"(a^{900 + k}+b^997)/(b^{950 + k}+a^991)" for k in range(200)), BudgetExceeded, "too much"),
    ("+".join(f"a{k}" for k in range(390)), BudgetExceeded, "too much"),
    ("+".join(f"a{k}" for k in range(1500)), BudgetExceeded, "more than 400 different names"),
    ("(" * 101 + "1" + ")" * 101, BudgetExceeded, "nested deeper than 100"),
    ("(" * 9_999, BudgetExceeded, "nested deeper than 100"),
    ("[" * 20_000, BudgetExceeded, "more than 10000"),
    ("(" * 10_000 + ")" * 10_000, BudgetExceeded, "more than 10000"),
]


@pytest.mark.parametrize(("text", "kind", "message"), REFUSED, ids=[ascii(case[0][:30]) for case in REFUSED])
def test_refused_with_place_and_reason_soon(text: str, kind: type[SymobsError], message: str) -> None:
    start = time.process_time()
    with pytest.raises(kind) as caught:
        parse_scalar(text, where="plant.A")
    assert time.process_time() - start < SOON
    assert type(caught.value) is kind
    assert message in str(caught.value)
    assert str(caught.value).startswith("plant.A: ")
    assert_safe(caught.value)


def assert_safe(error: SymobsError) -> None:
    """An error is one short line of printable characters, however hostile the text was."""
    if isinstance(error, ProblemErrors):
        for each in error.errors:
            assert_safe(each)
        return
    assert str(error).isprintable()
    assert len(str(error)) < 500


@tabled
def test_error_points_into_the_text(text: str, line: int, column: int, excerpt: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse_matrix(text)
    facts = caught.value.facts
    assert (facts["line"], facts["column"], facts["text"]) == (line, column, excerpt)
    assert f'column {column} of "{excerpt}"' in str(caught.value)


def test_unknown_name_says_the_nearest_and_the_declared_ones() -> None:
    with pytest.raises(UnknownName) as caught:
        parse_matrix("[0 1; -omga^2 0]", {"omega": "positive", "b": "real"}, where="plant.A")
    error = caught.value
    assert (error.facts["name"], error.facts["nearest"], error.facts["declared"]) == ("omga", "omega", ("b", "omega"))
    assert 'the name "omga" is not declared' in str(error)
    assert 'did you mean "omega"? declared: b, omega' in error.repair


@tabled
def test_unknown_name_among_declared_ones(text: str, repair: str) -> None:
    with pytest.raises(UnknownName) as caught:
        parse_scalar(text, {"b": "real"}, variable="s")
    assert repair in caught.value.repair


def test_no_name_is_declared() -> None:
    for names, variable in (({}, None), ({}, "t"), ({"t": "real"}, None)):  # the time, which nobody declares
        with pytest.raises(UnknownName, match=r'no name is declared; add b = "real" to \[symbols\]'):
            parse_scalar("b", names, variable=variable)


@pytest.mark.parametrize("text", ["0 1; 0 -1", "1 0", "k; 2"])
def test_a_matrix_without_its_brackets_is_told_so(text: str) -> None:
    with pytest.raises(ExpressionError, match="at column") as raised:
        parse_matrix(text, {"k": "real"}, where="plant.A")
    assert raised.value.repair == f'put the matrix in brackets: write "[{text}]"'
    assert parse_matrix("2 k", {"k": "real"}).shape == (1, 1)


@tabled
def test_numbers_with_a_blank_and_a_sign_between_are_not_guessed_at(poles: object, repair: str) -> None:
    with pytest.raises(ExpressionError, match="may be several numbers or one sum") as raised:
        parse_poles(poles, where="specification.poles")
    assert repair in raised.value.repair


def test_a_sign_with_blanks_on_both_sides_is_that_of_a_sum() -> None:
    assert parse_poles("-1 - 2") == parse_poles("-3") == parse_poles("-1-2")
    assert parse_poles("-1 +2i, -1 -2i") == parse_poles("-1+2i, -1-2i")
    assert parse_poles("[-1 -2]") == parse_poles("-1, -2")


@pytest.mark.parametrize(
    ("value", "place", "message", "repair"),
    [
        ([[0.1, 1]], "A[0][0]", "0.1 is a float", '"1/10"'),
        ([[1, 2], [3, -2.5]], "A[1][1]", "-2.5 is a float", '"-5/2"'),
        ([[1.0]], "A[0][0]", "1.0 is a float", '"1"'),
        ([[float("inf")]], "A[0][0]", "inf is a float", '"1/10"'),
        ([[float("nan")]], "A[0][0]", "nan is a float", '"1/10"'),
        ([[1e300]], "A[0][0]", "1e+300 is a float", '"1e+300"'),
        ([[0.5j]], "A[0][0]", "0.5j is a float", '"0.5j"'),
        ([[np.float32(0.1)]], "A[0][0]", "0.1 is a float", '"1/10"'),
        (np.array([[0.5, 1.0]]), "A[0][0]", "0.5 is a float", '"1/2"'),
    ],
)
def test_floats_are_refused_with_the_fraction_to_write(value: object, place: str, message: str, repair: str) -> None:
    with pytest.raises(InexactInput) as caught:
        parse_matrix(value, where="A")
    assert (caught.value.where, caught.value.message) == (place, message)
    assert (
        caught.value.repair == f'write an exact value such as {repair}, or give the plant or the task floats="decimal"'
    )
    assert isinstance(caught.value, TypeError)


def test_floats_are_refused_everywhere() -> None:
    with pytest.raises(InexactInput, match=r"poles\[1\]"):
        parse_poles([-2, -2.5], where="poles")
    with pytest.raises(InexactInput, match=r"-20\+0.5j"):
        parse_poles([-20 + 0.5j])
    with pytest.raises(InexactInput, match=r"0\.5 is a float"):
        parse_scalar(0.5)
    with pytest.raises(InexactInput, match=r"0\.5 is a float"):
        parse_polynomial(0.5, "s")


@pytest.mark.parametrize(
    ("entry", "kind"),
    [
        (True, "bool"),
        (np.True_, "bool"),
        (None, "NoneType"),
        (sympy.Symbol("x"), "Symbol"),
        (b"1", "bytes"),
        ([1], "list"),
        ({1: 2}, "dict"),
    ],
)
def test_other_types_are_refused_by_name(entry: object, kind: str) -> None:
    with pytest.raises(InputError, match=kind) as caught:
        parse_matrix([[1, entry]], where="A")
    assert caught.value.where == "A[0][1]"
    assert not isinstance(caught.value, InexactInput)


@pytest.mark.parametrize("value", [None, 5, {"a": 1}, b"[1]", {1, 2}])
def test_no_matrix(value: object) -> None:
    with pytest.raises(InputError, match="a matrix is expected"):
        parse_matrix(value)


@pytest.mark.parametrize(
    "number", [10**1000, -(10**1000), 10**100_000, Fraction(1, 10**1000)], ids=["1001", "-1001", "100001", "1/1001"]
)
def test_python_numbers_have_at_most_1000_digits(number: Fraction | int) -> None:
    with pytest.raises(BudgetExceeded, match="more than 1000 digits") as caught:
        parse_matrix([[number]], where="A")
    assert caught.value.where == "A[0][0]"


@pytest.mark.parametrize(
    "text",
    [
        "[" + " ".join(f"1/(a{k}+b{k})" for k in range(20)) + "]",
        "[" + " ".join(f"1/(a+{k}*b)^30" for k in range(300)) + "]",
        "[" + " ".join(f"1/({k}^999+1)" for k in range(2, 600)) + "]",
    ],
)
def test_common_denominator_of_a_matrix_is_bounded(text: str) -> None:
    with pytest.raises(BudgetExceeded, match="common denominator"):
        parse_matrix(text)


def test_cells_of_one_matrix_share_one_budget() -> None:
    cell = "(a + b + 1)^100"
    assert parse_matrix([[cell]]).shape == (1, 1)
    with pytest.raises(BudgetExceeded, match=r"A\[0\]\[\d+\]: .*too much"):
        parse_matrix([[cell] * 1000], where="A")


def test_place_of_a_bad_cell() -> None:
    with pytest.raises(ExpressionError, match=r"^A\[1\]\[0\]: "):
        parse_matrix([[1], ["1 +"]], where="A")
    with pytest.raises(ExpressionError, match=r"^A\[0\]\[1\]: a real value"):
        parse_matrix("[1 2i]", where="A")
    with pytest.raises(ExpressionError, match=r"^poles\[1\]: "):
        parse_poles([1, "$"], where="poles")
    with pytest.raises(ExpressionError, match="is not one matrix"):
        parse_matrix("1, 2")


@tabled
def test_declared_name(name: str) -> None:
    assert declared_name(name) == name


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("", "is not a name"),
        ("1a", "is not a name"),
        ("_a", "is not a name"),
        ("a b", "is not a name"),
        ("a\n", "is not a name"),
        ("ω", "is not a name"),
        ("a-b", "is not a name"),
        (None, "a NoneType is not a name"),
        (3, "a int is not a name"),
        ("x" * 65, "more than 64 characters"),
        ("lambda", '"lam"'),
        ("oo", "reserved"),
        ("inf", "reserved"),
        ("nan", "reserved"),
        ("pi", "reserved"),
        ("sqrt", "reserved"),
        ("cosh", "reserved"),
    ],
)
def test_name_that_cannot_be_declared(name: object, message: str) -> None:
    with pytest.raises(ExpressionError, match=message) as caught:
        declared_name(name, "symbols")
    assert caught.value.where == "symbols"
    assert_safe(caught.value)


@tabled
def test_a_root_of_a_square_has_the_sign_that_is_known(text: str, expected: str) -> None:
    found = parse_scalar(text, {"a": "real", "b": "real", "p": "positive"}, functions=True)
    assert found == parse_scalar(expected, functions=True)


@tabled
def test_functions_without_a_value_are_refused(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message) as caught:
        parse_scalar(text, {"a": "real", "b": "real", "p": "positive"}, functions=True)
    assert_safe(caught.value)


# -- properties ---------------------------------------------------------------------------------------------------

names = st.sampled_from(["a", "b", "s", "omega", "h1", "x_1"])
integers = st.integers(-(10**12), 10**12)
monomials = st.builds(
    lambda factor, powers: _product([q(factor), *(Scalar.symbol(name) ** power for name, power in powers.items())]),
    integers,
    st.dictionaries(names, st.integers(1, 4), max_size=3),
)
polynomials = st.lists(monomials, max_size=4).map(lambda terms: sum(terms, q(0)))
scalars = st.builds(lambda above, below: above / below, polynomials, polynomials.filter(bool))


def _product(factors: list[Scalar]) -> Scalar:
    total = one
    for factor in factors:
        total = total * factor
    return total


@given(scalars)
def test_text_of_a_scalar_reads_back(value: Scalar) -> None:
    assert parse_scalar(str(value)) == value


@given(scalars, scalars)
def test_text_of_a_complex_number_reads_back(real: Scalar, imaginary: Scalar) -> None:
    value = Complex(real, imaginary)
    assert parse_poles([str(value)]) == (value,)


# Texts with their value, made side by side from the same parts, each on the level of the grammar it belongs to.

Valued = tuple[str, Fraction]
spaces = st.sampled_from(["", " ", "  ", "\t", "\n"])
atoms: st.SearchStrategy[Valued] = st.one_of(
    st.integers(0, 99).map(lambda n: (str(n), Fraction(n))),
    st.integers(0, 999).map(lambda n: (f"{n // 100}.{n % 100:02}", Fraction(n, 100))),
)


def _powers(atom: st.SearchStrategy[Valued]) -> st.SearchStrategy[Valued]:
    raised = st.builds(
        lambda base, sign, exponent: (f"{base[0]}{sign}{exponent}", base[1] ** exponent),
        atom.filter(lambda base: base[1] != 0),
        st.sampled_from(["^", "**", " ^ "]),
        st.integers(-3, 3),
    )
    return st.one_of(atom, raised)


def _signed(power: st.SearchStrategy[Valued]) -> st.SearchStrategy[Valued]:
    return st.one_of(power, power.map(lambda part: (f"-{part[0]}", -part[1])))


def _chain(part: st.SearchStrategy[Valued], signs: list[str]) -> st.SearchStrategy[Valued]:
    def join(first: Valued, rest: list[tuple[str, str, Valued]]) -> Valued:
        text, value = first
        for sign, space, (next_text, next_value) in rest:
            if sign == "/" and next_value == 0:
                continue
            text = f"{text}{space}{sign}{space}{next_text}"
            value = OPERATIONS[sign](value, next_value)
        return text, value

    return st.builds(join, part, st.lists(st.tuples(st.sampled_from(signs), spaces, part), max_size=3))


OPERATIONS: dict[str, Callable[[Fraction, Fraction], Fraction]] = {
    "+": lambda left, right: left + right,
    "-": lambda left, right: left - right,
    "*": lambda left, right: left * right,
    "/": lambda left, right: left / right,
}


def _expressions(atom: st.SearchStrategy[Valued]) -> st.SearchStrategy[Valued]:
    return _chain(_chain(_signed(_powers(atom)), ["*", "/"]), ["+", "-"])


def _parenthesised(part: st.SearchStrategy[Valued]) -> st.SearchStrategy[Valued]:
    return part.map(lambda inner: (f"({inner[0]})", inner[1]))


@given(
    _expressions(st.one_of(atoms, _parenthesised(_expressions(st.one_of(atoms, _parenthesised(_expressions(atoms)))))))
)
def test_value_of_an_expression_is_that_of_its_parts(valued: Valued) -> None:
    text, value = valued
    assert parse_scalar(text).fraction() == value


entries = st.one_of(atoms, _parenthesised(_expressions(atoms)))
separators = st.sampled_from([" ", "  ", ",", ", ", " ,", "\t", " , "])
row_ends = st.sampled_from([";", " ; ", "\n", ";\n", "\n\n", "\r\n", " \n ;"])


@given(st.data(), st.integers(1, 4), st.integers(1, 4))
def test_entries_and_rows_are_set_apart_by_any_separator(data: st.DataObject, rows: int, columns: int) -> None:
    text, expected = "[", []
    for index in range(rows):
        text += data.draw(row_ends) if index else data.draw(spaces)
        row = []
        for column in range(columns):
            entry, value = data.draw(entries)
            sign = data.draw(st.sampled_from(["", "-", "+"]))
            text += (data.draw(separators) if column else "") + sign + entry
            row.append(-value if sign == "-" else value)
        expected.append(row)
    text += data.draw(st.sampled_from(["]", " ]", ";]", "\n]", ";\n]"]))
    assert fractions_of(parse_matrix(text)) == expected


ALPHABET = "0123456789.eEabsijI+-*/^()[],; \n\t'_"
hostile = st.one_of(
    st.text(max_size=200),
    st.text(ALPHABET, max_size=80),
    st.lists(
        st.sampled_from(
            [
                "(",
                ")",
                "[",
                "]",
                "^",
                "9",
                "^999",
                "(a+b)",
                "/(a-b)",
                "1e999",
                "sqrt(",
                " ",
                "i",
                "*",
                "s",
                ";",
                "-",
                ",",
            ]
        ),
        max_size=60,
    ).map("".join),
)


@pytest.mark.slow
@given(hostile)
@example("(" * 99 + "a" + ")" * 99)
@example("-" * 9_999 + "1")
@example("1^" * 4_999 + "1")
@example("+".join("x" * 5_000))
@example("[" + "1;" * 4_900 + "]")
@example("," * 9_999)
@example("[" + ";" * 9_000 + "]")
def test_any_text_ends_soon_in_a_value_or_in_an_error_of_symobs(text: str) -> None:
    start = time.process_time()
    readers: tuple[Callable[[str], object], ...] = (
        parse_scalar,
        parse_matrix,
        parse_poles,
        lambda each: parse_polynomial(each, "s", {"a": "real"}),
        lambda each: parse_matrix([[each]], {}),
        declared_name,
    )
    for read in readers:
        try:
            read(text)
        except SymobsError as error:
            assert_safe(error)
    assert time.process_time() - start < SOON


# -- cost ---------------------------------------------------------------------------------------------------------


def test_all_undeclared_names_of_a_text_are_told_together() -> None:
    with pytest.raises(ProblemErrors) as caught:
        parse_matrix("[0 1; -omga^2 -beta*omga]", {"omega": "positive"}, where="plant.A")
    assert [(error.facts["name"], error.facts["nearest"]) for error in caught.value.errors] == [
        ("omga", "omega"),
        ("beta", None),
    ]
    with pytest.raises(UnknownName, match=r'the name "omga" is not declared, at column 8 of "\[0 1'):
        parse_matrix("[0 1; -omga^2 -2*omga]", {"omega": "positive"})
    with pytest.raises(ProblemErrors) as caught:
        parse_scalar("+".join(f"a{k}" for k in range(1500)), {})
    assert len(caught.value.errors) == 20


plain_atoms = st.one_of(
    st.sampled_from(
        ["a", "b", "omega", "i", "I", "s", "pi", "e", "oo", "sin", "x_1", "lambda", "1a", "2e3", "1.", ".5"]
    ),
    st.sampled_from(["2i", "0.5j"]),
    st.integers(0, 30).map(str),
    st.decimals(0, 20, places=2).map(str),
)
plain_cells = st.builds(
    lambda sign, atoms, operators: (
        sign + "".join(x for pair in zip(["", *operators], atoms, strict=False) for x in pair)
    ),
    st.sampled_from(["", "-", "+", "--", "- "]),
    st.lists(plain_atoms, min_size=1, max_size=3),
    st.lists(st.sampled_from(["*", "/", "^", " ", " * ", "-", "+"]), min_size=2, max_size=2),
)
plain_texts = st.builds(
    lambda left, rows, right: left + rows + right,
    st.sampled_from(["", "[", " [ ", "(", "[\n"]),
    st.lists(st.lists(plain_cells, min_size=0, max_size=3).map(" ".join), min_size=1, max_size=3).map(";".join)
    | st.lists(plain_cells, min_size=1, max_size=3).map(", ".join),
    st.sampled_from(["", "]", " ] ", ")", ";]"]),
)


@given(plain_texts, st.sampled_from([None, {}, {"a": "real", "b": "real", "i": "real"}]))
@example("[1 -2; a -b/2]", None)
@example("[1 - 2; a, b]", None)
@example("-a/0", None)
@example("-1+3/2i, -1-3/2i, 2*3, 4/0i", None)
@example("1-i, 1+I, +2/3j, 0i", {"i": "real"})
@example("0*a/0.0, 1", None)
@example("[7]", None)
@example("", None)
@example(" ", None)
@example("[]", None)
def test_the_short_way_reads_what_the_grammar_reads(text: str, names: dict[str, str] | None) -> None:
    def outcome(read: Callable[[str], object]) -> object:
        try:
            return read(text)
        except SymobsError as error:
            return type(error), str(error)

    readers: tuple[Callable[[str], object], ...] = (
        lambda each: parse_matrix(each, names),
        lambda each: parse_poles(each, names),
        lambda each: parse_polynomial(each, "s", names),
    )
    found = [outcome(read) for read in readers]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(evaluation, "plain_rows", lambda *_: None)
        assert [outcome(read) for read in readers] == found


@pytest.mark.parametrize("names", [None, {}])
def test_the_imaginary_unit_stands_before_a_number_in_poles(names: dict[str, str] | None) -> None:
    assert parse_poles("-2+j2, -2-j2.4", names) == parse_poles("-2+2*j, -2-12/5*j", names)
    assert parse_poles(["i3", "-i3"], names) == parse_poles(["3*i", "-3*i"], names)
    assert parse_poles("2 j3", names) == parse_poles("6*j", names)
    for text in ("-1+jw", "jomega", "jw0", "-jomega_d", "1/j2", "j2 ^2", "2j3", "[-1; jw]"):
        with pytest.raises(ExpressionError, match="may be a name or a product"):
            parse_poles(text, names)


def test_a_name_like_an_imaginary_number_is_one_only_where_it_is_declared() -> None:
    assert parse_poles("-j2", {"j2": "real"}) == (Complex.of(-Scalar.symbol("j2")),)
    with pytest.raises(ExpressionError, match="may be a name or a product"):
        parse_poles("-2+j2, -2-j2", letters={"j2"})
    with pytest.raises(ExpressionError, match=r'at column 8 of "-2\+j2, \?"'):
        parse_poles("-2+j2, ?", {})


@pytest.mark.parametrize("name", ["j2", "i3", "jw0", "abs", "log"])
def test_a_name_that_means_something_elsewhere_is_not_to_be_declared(name: str) -> None:
    for names in ({}, {"omega": "real"}):
        with pytest.raises(UnknownName) as caught:
            parse_matrix(f"[0 1; {name} 2]", names)
        assert "add" not in caught.value.repair
        assert name not in caught.value.repair


def test_the_notation_of_numbers_of_other_programs_is_no_product() -> None:
    for text in ("0x10", "0b1", "[0XfF 0; 0 1]", "0o17", "1d3", "[1 2.5D3]", "-1.D4"):
        with pytest.raises(ExpressionError, match="may be a number or a product"):
            parse_matrix(text)
    assert parse_scalar("2d1 + 3x1 + 10x10", {"d1": "real", "x1": "real", "x10": "real"}) == parse_scalar(
        "2*d1 + 3*x1 + 10*x10"
    )
