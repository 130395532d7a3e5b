"""The printers: what they write is read back by a small reader, so that a wrong sign or a lost parenthesis is seen."""

from __future__ import annotations

import random
import re
import subprocess
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar
from symobs.formula import (
    Apply,
    Block,
    Derivative,
    Formula,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
)
from symobs.notation import symbol_latex, symbol_text
from symobs.render.latex_printer import LatexPrinter
from symobs.render.scalars import spelled
from symobs.render.text_printer import TextPrinter, text_width

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

Value = Scalar | Matrix

s, b, h1, h2, m, p, omega = map(Scalar.symbol, ("s", "b", "h_1", "h_2", "m", "p", "omega"))
A, B, C, K, L, O, P, F = map(Letter, ("A", "B", "C", "K", "L", "O", "P", "F"))
x, x_hat, e = map(Letter, ("x", "x_hat", "e"))
sI_minus_A = Sum((Product((Letter("s"), Identity(2))), Negative(A)))


def lit(value: Value | Fraction | int) -> Literal:
    return Literal(value if isinstance(value, Matrix) else Scalar.of(value))


def table(*rows: list[Scalar | Fraction | int]) -> Literal:
    return Literal(Matrix.of(rows))


def equation(*members: Formula) -> Relation:
    return Relation(members, ("=",) * (len(members) - 1))


# -- a reader of what is printed --------------------------------------------------------------------------------------


class Token(NamedTuple):
    """A number, name, function, sign, bracket, power or matrix (its entries being tokens)."""

    kind: str
    value: object = None


class Reader:
    """Reads tokens by the rules of written mathematics: juxtaposition multiplies, a/b divides what stands before."""

    def __init__(self, tokens: list[Token], values: Mapping[str, Value]) -> None:
        self.tokens = tokens
        self.values = values
        self.place = 0

    def peek(self) -> Token:
        return self.tokens[self.place] if self.place < len(self.tokens) else Token("end")

    def take(self, kind: str) -> Token:
        token = self.peek()
        assert token.kind == kind, (token, self.tokens)
        self.place += 1
        return token

    def accept(self, token: Token) -> bool:
        if self.peek() == token:
            self.place += 1
            return True
        return False

    def whole(self) -> Value:
        value = self.sum()
        self.take("end")
        return value

    def sum(self) -> Value:
        negative = self.accept(Token("sign", "-"))
        value = self.product()
        value = minus(value) if negative else value
        while self.peek().kind == "sign":
            negative = self.take("sign").value == "-"
            term = self.product()
            value = plus(value, minus(term) if negative else term)
        return value

    def product(self) -> Value:
        value = self.factor()
        while True:
            if self.accept(Token("slash")):
                value = times(1 / scalar(self.factor()), value)
            elif self.accept(Token("dot")) or self.peek().kind in {"number", "name", "open", "frac", "table", "function"}:
                value = times(value, self.factor())
            else:
                return value

    def factor(self) -> Value:
        value = self.atom()
        while self.peek().kind == "power":
            exponent = self.take("power").value
            if exponent == "T":
                assert isinstance(value, Matrix)
                value = value.T
            else:
                assert isinstance(exponent, int)
                value = value**exponent
        return value

    def atom(self) -> Value:
        token = self.peek()
        self.place += 1
        match token:
            case Token("number", str() as digits):
                return Scalar.of(int(digits))
            case Token("name", str() as name):
                return self.values[name]
            case Token("open"):
                value = self.sum()
                self.take("close")
                return value
            case Token("frac"):
                self.take("open")
                above = self.sum()
                self.take("close")
                self.take("open")
                below = self.sum()
                self.take("close")
                return times(1 / scalar(below), above)
            case Token("table", list() as rows):
                cells = [[Reader(cell, self.values).whole() for cell in row] for row in rows]
                return Matrix.block([[c if isinstance(c, Matrix) else Matrix.of([[c]]) for c in row] for row in cells])
            case Token("function", str() as name):
                matrix = self.factor()
                assert isinstance(matrix, Matrix)
                return matrix.determinant() if name == "det" else matrix.adjugate()
        raise AssertionError(token)


def scalar(value: Value) -> Scalar:
    assert isinstance(value, Scalar)
    return value


def minus(value: Value) -> Value:
    return -value


def plus(left: Value, right: Value) -> Value:
    if isinstance(left, Matrix):
        assert isinstance(right, Matrix)
        return left + right
    return left + scalar(right)


def times(left: Value, right: Value) -> Value:
    if isinstance(left, Matrix):
        return left @ right if isinstance(right, Matrix) else left * right
    return right * left


def latex_tokens(source: str, names: dict[str, str]) -> list[Token]:
    """The tokens of LaTeX; `names` maps what is written to the name."""
    written = "|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
    pattern = re.compile(
        r"(?P<table>(?:\\left\[)?\\begin\{(?P<kind>bmatrix|smallmatrix|array)\}(?:\{@\{\}\*\{\d+\}\{c\}@\{\}\})?)"
        r"|(?P<function>\\det|\\operatorname\{adj\})|(?P<frac>\\d?frac)|\^(?P<power>\{(?:-?\d+|\\mathsf T)\}|\d)"
        r"|(?P<skip>\\(?:left|right|[bB]igg?[lr])(?=[()])|\\[,; ]|\\(?:allowbreak|displaystyle) ?|\{\}| )"
        r"|(?P<dot>\\cdot ?)|(?P<slash>/|\\big/)|(?P<sign>[+-])|(?P<open>[({])|(?P<close>[)}])"
        rf"|(?P<name>{written})|(?P<number>\d+)"
    )
    tokens: list[Token] = []
    place = 0
    while place < len(source):
        found = pattern.match(source, place)
        assert found is not None, source[place : place + 60]
        place = found.end()
        kind = found.lastgroup if found["table"] is None else "table"
        if kind == "table":
            closing = rf"\end{{{found['kind']}}}"
            body = source[place : source.index(closing, place)]
            place += len(body) + len(closing)
            place += len(r"\right]") * source.startswith(r"\right]", place)
            rows = [row.split("&") for row in re.split(r"\\\\(?:\[\d+pt\])?", body)]
            tokens.append(Token("table", [[latex_tokens(cell, names) for cell in row] for row in rows]))
        elif kind == "power":
            exponent = found["power"].strip("{}")
            tokens.append(Token("power", "T" if "T" in exponent else int(exponent)))
        elif kind == "function":
            tokens.append(Token("function", "det" if "det" in found["function"] else "adj"))
        elif kind == "name":
            tokens.append(Token("name", names[found["name"]]))
        elif kind in {"sign", "number"}:
            tokens.append(Token(str(kind), found[kind]))
        elif kind != "skip":
            tokens.append(Token(str(kind)))
    return tokens


SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


def text_tokens(source: str, names: dict[str, str]) -> list[Token]:
    """The tokens of one line of text; inside brackets a space separates entries."""
    written = "|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
    pattern = re.compile(
        r"(?P<table>\[)|(?P<function>det|adj)|(?P<power>[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+|ᵀ)|(?P<skip> )|(?P<dot>·)|(?P<slash>/)"
        rf"|(?P<sign>[+-])|(?P<open>\()|(?P<close>\))|(?P<name>{written})|(?P<number>\d+)"
    )
    tokens: list[Token] = []
    place = 0
    while place < len(source):
        found = pattern.match(source, place)
        assert found is not None, source[place : place + 60]
        place, kind = found.end(), str(found.lastgroup)
        if kind == "table":
            body = source[place : source.index("]", place)]
            place += len(body) + 1
            rows = [row.split() for row in body.split(";")]
            tokens.append(Token("table", [[text_tokens(cell, names) for cell in row] for row in rows]))
        elif kind == "power":
            tokens.append(Token("power", "T" if found[0] == "ᵀ" else int(found[0].translate(SUPERSCRIPTS))))
        elif kind == "name":
            tokens.append(Token("name", names[found[0]]))
        elif kind in {"sign", "number", "function"}:
            tokens.append(Token(kind, found[0]))
        elif kind != "skip":
            tokens.append(Token(kind))
    return tokens


# -- random material --------------------------------------------------------------------------------------------------

PARAMETERS = ("a", "b", "g", "h_1", "k2", "mass", "m", "omega", "tau_f", "xi", "p")
POINT = {
    name: Scalar.of(Fraction(17 + 6 * index, 5 + 2 * index)) for index, name in enumerate((*PARAMETERS, "s", "z"))
}
LATEX_NAMES = {symbol_latex(name): name for name in (*PARAMETERS, "s", "z")}
TEXT_NAMES = {symbol_text(name): name for name in (*PARAMETERS, "s", "z")}
MATRICES: dict[str, Value] = {
    "A": Matrix.of([[2, -3], [5, 7]]),
    "B": Matrix.of([[1, 4], [-6, 9]]),
    "L": Matrix.of([[0, 8], [3, -1]]),
    "I": Matrix.identity(2),
}
MATRIX_NAMES = {name: name for name in MATRICES}


def polynomial(source: random.Random, terms: int, names: tuple[str, ...] = PARAMETERS, degree: int = 3) -> Scalar:
    total = Scalar.of(0)
    for _ in range(terms):
        term = Scalar.of(source.choice((-1, 1)) * source.randint(1, 12))
        for _ in range(source.randint(0, degree)):
            term = term * Scalar.symbol(source.choice(names))
        total = total + term
    return total


def rational(source: random.Random, size: int = 4) -> Scalar:
    """A scalar of any shape: number, polynomial or fraction, with or without s, sometimes with repeated factors."""
    names = source.choice(((), ("s",), PARAMETERS[:3], (*PARAMETERS, "s", "s", "s")))
    degree = 3 if names else 0
    above, below = (polynomial(source, source.randint(1, size), names, degree) for _ in range(2))
    if source.random() < 0.3:
        above = above * polynomial(source, 2, names, degree) ** 2
    kind = source.randrange(4)
    if kind == 0 or below.is_zero:
        return above
    if kind == 1:
        below = Scalar.of(source.randint(1, 30))
    return above / below


def matrix_formula(source: random.Random, depth: int) -> Formula:
    """A formula whose value is a 2×2 matrix."""
    if depth == 0:
        literal = table(*([source.randint(-9, 9), polynomial(source, 2, ("b", "s"))] for _ in range(2)))
        fractions = table(*([Fraction(source.randint(-9, 9), 6), Fraction(source.randint(-9, 9), 6)] for _ in range(2)))
        return source.choice((A, B, L, Identity(2), literal, fractions))
    inner, other = (matrix_formula(source, depth - 1) for _ in range(2))
    number = scalar_formula(source, depth - 1)
    return source.choice(
        (
            Sum((inner, other)),
            Sum((inner, Negative(other))),
            Sum((Negative(inner), Product((number, other)))),
            Product((inner, other)),
            Product((number, inner)),
            Product((inner, number, other)),
            Negative(inner),
            Power(inner, 2),
            Transpose(inner),
            Quotient(inner, lit(source.randint(2, 9))),
            Apply("adj", inner),
            Block(((inner, other), (other, inner))) if depth > 4 else inner,
        )
    )


def scalar_formula(source: random.Random, depth: int) -> Formula:
    """A formula whose value is a scalar; denominators are chosen not to vanish."""
    if depth == 0:
        return lit(rational(source, 3))
    inner, other = (scalar_formula(source, depth - 1) for _ in range(2))
    below = source.choice((lit(source.randint(2, 9)), lit(s + 23), Sum((lit(s), lit(31))), Quotient(lit(3), lit(s + 7))))
    return source.choice(
        (
            Sum((inner, other)),
            Sum((inner, Negative(other))),
            Product((inner, other)),
            Negative(inner),
            Power(inner, source.choice((1, 2, 3))),
            Quotient(inner, below),
            Power(below, -1),
            Apply("det", matrix_formula(source, depth - 1)),
        )
    )


def value_of(formula: Formula) -> Value:  # noqa: C901, PLR0911 - a case for each kind of node
    """The value of a formula over `MATRICES` and symbols: an evaluation that shares nothing with the printers."""
    match formula:
        case Letter(name):
            return MATRICES[name]
        case Literal(value):
            return value
        case Identity(order):
            return Matrix.identity(order)
        case Sum((first, *rest)):
            total = value_of(first)
            for term in rest:
                total = plus(total, value_of(term))
            return total
        case Negative(operand):
            return minus(value_of(operand))
        case Product((first, *rest)):
            total = value_of(first)
            for factor in rest:
                total = times(total, value_of(factor))
            return total
        case Power(base, exponent):
            return value_of(base) ** exponent
        case Transpose(operand):
            transposed = value_of(operand)
            assert isinstance(transposed, Matrix)
            return transposed.T
        case Quotient(above, below):
            return times(1 / scalar(value_of(below)), value_of(above))
        case Apply(function, argument):
            matrix = value_of(argument)
            assert isinstance(matrix, Matrix)
            return matrix.determinant() if function == "det" else matrix.adjugate()
    raise AssertionError(formula)


def at_point(value: Value) -> Value:
    return value.substitute(POINT)


def read_latex(source: str) -> Value:
    return Reader(latex_tokens(source, LATEX_NAMES | MATRIX_NAMES), POINT | MATRICES).whole()


def read_text(source: str) -> Value:
    return Reader(text_tokens(source, TEXT_NAMES | MATRIX_NAMES), POINT | MATRICES).whole()


def right_side(display: str) -> str:
    """What stands behind the first sign of a display, its lines joined again."""
    body = re.sub(r"\\(?:begin|end)\{(?:align|gather)\*\}|\\\[ | \\\]|\{\\allowdisplaybreaks\n|\}$", "", display)
    body = re.sub(r"\\\\(?:\[\d+pt\])?\n|&|\\quad", "", body)
    return body.partition("=")[2].strip()


randoms = st.randoms(use_true_random=False)


# -- what is printed means what was given -----------------------------------------------------------------------------


@given(randoms)
@settings(max_examples=300)
def test_a_spelling_has_the_value_of_its_scalar(source: random.Random) -> None:
    value = rational(source, 6)
    assert value_of(spelled(value, "s")) == value


@given(randoms)
@settings(max_examples=300)
def test_printed_scalars_read_back_as_the_same_number(source: random.Random) -> None:
    value = rational(source, 6)
    expected = value.substitute(POINT)
    assert read_latex(LatexPrinter().inline(lit(value))) == expected
    assert read_latex(LatexPrinter().unbroken(lit(value))) == expected
    assert read_text(TextPrinter().inline(lit(value))) == expected


@given(randoms)
@settings(max_examples=300)
def test_printed_formulas_read_back_as_the_same_value(source: random.Random) -> None:
    formula = source.choice((matrix_formula, scalar_formula))(source, source.randint(0, 3))
    expected = at_point(value_of(formula))
    assert read_latex(LatexPrinter().unbroken(formula)) == expected
    assert read_latex(LatexPrinter().inline(formula)) == expected
    assert read_text(TextPrinter().inline(formula)) == expected


@given(randoms)
@settings(max_examples=60)
def test_broken_displays_read_back_as_the_same_number(source: random.Random) -> None:
    names = (*PARAMETERS, "s")
    above, below = polynomial(source, 90, names, 5), polynomial(source, source.choice((1, 3, 6)), names)
    value = above if below.is_zero else above / below
    display = LatexPrinter().display([equation(A, lit(value))], end="")
    assert display.count(r"\\") > 2
    assert read_latex(right_side(display)) == value.substitute(POINT)


@given(randoms)
@settings(max_examples=60)
def test_what_a_matrix_leaves_out_is_told_below(source: random.Random) -> None:
    value = Matrix.of([[polynomial(source, 30), 1], [polynomial(source, 3), polynomial(source, 25)]])
    whole, *told = right_side(LatexPrinter().display([equation(A, lit(value))], end="")).split(",")
    meanings = dict(definition.split("=") for definition in told)
    assert meanings
    for name, meaning in meanings.items():
        whole = whole.replace(name, f"({meaning})")
    assert read_latex(whole) == at_point(value)


@given(randoms)
@settings(max_examples=30)
def test_a_fraction_with_a_wide_denominator_is_told_in_parts(source: random.Random) -> None:
    value = polynomial(source, 40) / (polynomial(source, 40) ** 2 + 1)
    whole, *told = right_side(LatexPrinter().display([equation(A, lit(value))], end="")).split(",")
    for name, meaning in (definition.split("=") for definition in told):
        whole = whole.replace(name, f"({meaning})")
    assert told
    assert read_latex(whole) == value.substitute(POINT)
