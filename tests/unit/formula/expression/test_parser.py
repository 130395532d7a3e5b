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
from symobs.exact.core.generators import substitute
from symobs.formula.expression import (
    declared_name,
    evaluation,
    parse_matrix,
    parse_poles,
    parse_polynomial,
    parse_scalar,
)
from symobs.ground import errors
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


def q(above: int, below: int = 1) -> Scalar:
    """The number above / below."""
    return Scalar.rational(above, below)


def fractions_of(matrix: Matrix) -> list[list[Fraction]]:
    """The entries of a numeric matrix."""
    return [[entry.fraction() for entry in row] for row in matrix.rows]


# -- numbers and operators ----------------------------------------------------------------------------------------


@tabled
def test_number(text: str, expected: str) -> None:
    assert parse_scalar(text).fraction() == Fraction(expected)


@tabled
def test_symbols(text: str, expected: str) -> None:
    assert str(parse_scalar(text)) == expected


@tabled
def test_declared_name_is_a_factor_and_may_be_i(text: str, expected: str) -> None:
    assert str(parse_scalar(text, {"b": "positive", "h1": "real", "i": "real"})) == expected


@tabled
def test_matrices_are_read_as_they_are_printed(text: str, expected: str) -> None:
    assert parse_matrix(text) == parse_matrix(expected)


@tabled
def test_a_pair_of_poles_is_two(poles: object) -> None:
    assert [str(pole) for pole in parse_poles(poles)] == ["-1 + 2*I", "-1 - 2*I", "-3"]


# -- matrices -----------------------------------------------------------------------------------------------------


@tabled
def test_matrix_of_numbers(text: str, expected: list[list[str]]) -> None:
    assert fractions_of(parse_matrix(text)) == [[Fraction(entry) for entry in row] for row in expected]


@tabled
def test_lists_without_the_shape_of_a_matrix(value: object, message: str) -> None:
    with pytest.raises(ShapeMismatch, match=message):
        parse_matrix(value)


# -- poles and polynomials ----------------------------------------------------------------------------------------


@tabled
def test_poles(value: object, expected: list[list[str]]) -> None:
    poles = [[str(pole.real), str(pole.imaginary)] for pole in parse_poles(value)]
    assert poles == expected


def test_poles_may_be_fractions_and_arrays() -> None:
    assert parse_poles((Fraction(-1, 2),)) == parse_poles("-1/2")
    assert parse_poles(np.array([-1, -2])) == parse_poles("-1, -2")


@pytest.mark.parametrize("value", [-2, None, {"a": 1}, 0.5])
def test_poles_are_a_list(value: object) -> None:
    with pytest.raises(InputError, match="a list of poles is expected"):
        parse_poles(value)


@tabled
def test_polynomial(text: str, variable: str, expected: str) -> None:
    assert str(parse_polynomial(text, variable)) == expected


@tabled
def test_no_polynomial(text: str, message: str) -> None:
    with pytest.raises(ExpressionError, match=message):
        parse_polynomial(text, "s", where="observer_polynomial")


def test_variable_of_the_polynomial_cannot_be_declared() -> None:
    with pytest.raises(ExpressionError, match='"s" is the variable of the polynomial'):
        parse_polynomial("s + 1", "s", {"s": "positive"})
    assert parse_polynomial("z + s", "z", {"s": "positive"}) == z + s


# -- what is refused ----------------------------------------------------------------------------------------------

BEYOND_A_BUDGET = [
    ("1" * 1001, "more than 1000 digits"),
    ("0." + "1" * 1001, "more than 1000 digits"),
    ("1" * 100_000, "more than 10000"),
    ("a+" * 5000 + "a", "has 10001 characters"),
    ("*".join(["999^999"] * 900), "10000 bits"),
    ("*".join(["(a+b+c+d+e)"] * 800), "would build"),
    ("".join(f"(a{k}+b{k})" for k in range(40)), "more than 20000 terms"),
    ("+".join(["(s+1)^1000"] * 800), "too much"),
    ("+".join(f"1/(s+{k})" for k in range(900)), "too much"),
    ("+".join(f"(a^{900 + k}+b^997)/(b^{950 + k}+a^991)" for k in range(200)), "too much"),
    ("+".join(f"a{k}" for k in range(390)), "too much"),
    ("+".join(f"a{k}" for k in range(1500)), "more than 400 different names"),
    ("(" * 101 + "1" + ")" * 101, "nested deeper than 100"),
    ("(" * 9_999, "nested deeper than 100"),
    ("[" * 20_000, "more than 10000"),
    ("(" * 10_000 + ")" * 10_000, "more than 10000"),
]


@tabled
def test_refused_with_place_and_reason_soon(text: str, kind: str, message: str) -> None:
    refused_soon(text, getattr(errors, kind), message)


@pytest.mark.parametrize(("text", "message"), BEYOND_A_BUDGET, ids=range(len(BEYOND_A_BUDGET)))
def test_what_would_be_too_large_is_refused_soon(text: str, message: str) -> None:
    refused_soon(text, BudgetExceeded, message)


def refused_soon(text: str, kind: type[SymobsError], message: str) -> None:
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


@tabled
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


@tabled
def test_floats_are_refused_with_the_fraction_to_write(
    value: list[list[float]], place: str, message: str, repair: str
) -> None:
    with pytest.raises(InexactInput) as caught:
        parse_matrix(value, where="A")
    assert (caught.value.where, caught.value.message) == (place, message)
    assert (
        caught.value.repair == f'write an exact value such as {repair}, or give the plant or the task floats="decimal"'
    )
    assert isinstance(caught.value, TypeError)


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


@pytest.mark.parametrize(
    "number", [10**1000, -(10**1000), 10**100_000, Fraction(1, 10**1000)], ids=["1001", "-1001", "100001", "1/1001"]
)
def test_python_numbers_have_at_most_1000_digits(number: Fraction | int) -> None:
    with pytest.raises(BudgetExceeded, match="more than 1000 digits") as caught:
        parse_matrix([[number]], where="A")
    assert caught.value.where == "A[0][0]"


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


@tabled
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


entries = st.one_of(atoms, st.builds(lambda one, other: (f"({one[0]} - {other[0]})", one[1] - other[1]), atoms, atoms))
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


@tabled
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


@tabled
def test_a_decimal_comma_is_refused_with_the_point(text: str, repair: str) -> None:
    for read in (parse_matrix, parse_poles):
        if read is parse_poles and text.startswith("["):
            continue
        with pytest.raises(ExpressionError) as caught:
            read(text)
        assert repair in caught.value.repair


def test_a_fourth_root_as_it_is_printed_is_one() -> None:
    names = {"q": "positive", "x": "real"}
    for text, plain in (("⁴√(16 q)", "2*q^(1/4)"), ("2·⁴√q", "2*q^(1/4)"), ("x⁴√4", "2*x^4"), ("⁴√16", "2")):
        read = (parse_scalar(each, names, functions=True) for each in (text, plain))
        assert len({substitute(value, {"q": Scalar.of(81)}) for value in read}) == 1
    with pytest.raises(ExpressionError, match="never closed"):
        parse_scalar("⁴√(q", names, functions=True)
