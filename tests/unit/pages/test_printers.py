"""The printers: what they write is read back by a small reader, so that a wrong sign or a lost parenthesis is seen."""

from __future__ import annotations

import random
import re
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import function
from symobs.formula.expression import parse_scalar
from symobs.formula.notation import symbol_latex, symbol_text
from symobs.formula.tree import (
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
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.mathml import MathmlPrinter
from symobs.pages.printers.text_printer import TextPrinter, text_width
from tests.kit import tabled
from tests.support.sampling import tried

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

Value = Scalar | Matrix

s, b, h1, h2, m, p, omega = map(Scalar.symbol, ("s", "b", "h_1", "h_2", "m", "p", "omega"))
A, B, C, K, L, O, P, F = map(Letter, ("A", "B", "C", "K", "L", "O", "P", "F"))
x, x_hat, e = map(Letter, ("x", "x_hat", "e"))
RESOLVENT = Sum((Product((Letter("s"), Identity(2))), Negative(A)))


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
            elif self.accept(Token("dot")) or self.peek().kind in {
                "number",
                "name",
                "open",
                "frac",
                "table",
                "function",
            }:
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
        r"(?P<table>(?:\\left\[)?\\begin\{(?P<kind>bmatrix|smallmatrix|array)\}(?:\{c+\})?)"
        r"|(?P<list>\[)|(?P<function>\\det|\\operatorname\{adj\})|(?P<frac>\\d?frac)"
        r"|\^(?P<power>\{(?:-?\d+|\\mathsf T)\}|\d)"
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
        elif kind == "list":
            body = source[place : source.index("]", place)]
            place += len(body) + 1
            rows = [row.split(r",\allowbreak\ ") for row in body.split(r";\allowbreak\ ")]
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
POINT = {name: Scalar.of(Fraction(17 + 6 * index, 5 + 2 * index)) for index, name in enumerate((*PARAMETERS, "s", "z"))}
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


def matrix_of(rows: int, columns: int, entry: Callable[[], Scalar]) -> Literal:
    return lit(Matrix.of([[entry() for _ in range(columns)] for _ in range(rows)]))


def matrix_formula(source: random.Random, depth: int) -> Formula:
    """A formula whose value is a 2×2 matrix."""
    if depth == 0:
        literal = matrix_of(2, 2, lambda: polynomial(source, source.randint(1, 2), ("b", "s")))
        fractions = matrix_of(2, 2, lambda: Scalar.rational(source.randint(-9, 9), 6))
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
        )
    )


def scalar_formula(source: random.Random, depth: int) -> Formula:
    """A formula whose value is a scalar; denominators are chosen not to vanish."""
    if depth == 0:
        return lit(rational(source, 3))
    inner, other = (scalar_formula(source, depth - 1) for _ in range(2))
    below = source.choice(
        (lit(source.randint(2, 9)), lit(s + 23), Sum((lit(s), lit(31))), Quotient(lit(3), lit(s + 7)))
    )
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


def value_of(formula: Formula) -> Value:
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
    body = re.sub(
        r"\\(?:begin|end)\{(?:align|gather)\*\}|\\\[ | \\\]|\{\\allowdisplaybreaks\n|\}(?:\\ignorespaces)?$",
        "",
        display,
    )
    lines = re.split(r"\\\\(?:\[\d+pt\])?\n", body)
    return "".join(line.strip().removeprefix("&").removeprefix(r"\quad") for line in lines).partition("=")[2]


def put_back(display: str) -> str:
    """The right side of a display with what is told below put back into its place."""
    whole, *told = re.split(r",(?:\\qquad )?(?=\\ast|A_)", right_side(display))
    assert told
    for name, meaning in (definition.split("=") for definition in told):
        assert name in whole
        whole = whole.replace(name, f"({meaning})")
    return whole


sources = st.integers(0, 2**64).map(random.Random)


# -- what is printed means what was given -----------------------------------------------------------------------------


@given(sources)
@settings(max_examples=tried(300))
def test_printed_scalars_read_back_as_the_same_number(source: random.Random) -> None:
    value = rational(source, 6)
    expected = value.substitute(POINT)
    assert read_latex(LatexPrinter().inline(lit(value))) == expected
    assert read_latex(LatexPrinter().unbroken(lit(value))) == expected
    assert read_text(TextPrinter().inline(lit(value))) == expected


@given(sources)
@settings(max_examples=tried(300))
def test_printed_formulas_read_back_as_the_same_value(source: random.Random) -> None:
    formula = source.choice((matrix_formula, scalar_formula))(source, source.randint(0, 3))
    expected = at_point(value_of(formula))
    assert read_latex(LatexPrinter().unbroken(formula)) == expected
    assert read_latex(LatexPrinter().inline(formula)) == expected
    assert read_text(TextPrinter().inline(formula)) == expected


@given(sources)
@settings(max_examples=tried(60))
def test_broken_displays_read_back_as_the_same_number(source: random.Random) -> None:
    names = (*PARAMETERS, "s")
    above, below = polynomial(source, 90, names, 5), polynomial(source, source.choice((1, 3, 6)), names)
    value = above if below.is_zero else above / below
    display = LatexPrinter().display([equation(A, lit(value))], end="")
    assert display.count(r"\\") > 2
    assert read_latex(right_side(display)) == value.substitute(POINT)


@given(sources)
@settings(max_examples=tried(60))
def test_what_a_matrix_leaves_out_is_told_below(source: random.Random) -> None:
    value = Matrix.of(
        [[polynomial(source, 30, degree=5), 1], [polynomial(source, 3), polynomial(source, 25, degree=5)]]
    )
    assert read_latex(put_back(LatexPrinter().display([equation(A, lit(value))], end=""))) == at_point(value)


@given(sources)
@settings(max_examples=tried(40))
def test_broken_text_reads_back_as_the_same_number(source: random.Random) -> None:
    value = polynomial(source, 60, (*PARAMETERS, "s"), 5) / polynomial(source, 1)
    display = TextPrinter(width=80).display([equation(A, lit(value))])
    lines = display.split("\n")
    assert len(lines) > 2
    assert max(map(text_width, lines)) <= 80
    assert read_text("".join(lines).removeprefix("A = ")) == value.substitute(POINT)


# -- what is printed looks like the page of a book --------------------------------------------------------------------


@tabled
def test_scalars_look_as_in_a_book(value: str, latex: str, text: str) -> None:
    assert LatexPrinter().unbroken(lit(parse_scalar(value))) == latex
    assert TextPrinter().inline(lit(parse_scalar(value))) == text


FORMULAS: list[tuple[Formula, str, str]] = [
    (Sum((A, Negative(Product((L, C))))), "A-LC", "A - L C"),
    (Negative(Sum((A, B))), "-(A+B)", "-(A + B)"),
    (Sum((A, Negative(Sum((B, C))))), "A-(B+C)", "A - (B + C)"),
    (Sum((lit(4), Negative(lit(0)))), "4-0", "4 - 0"),
    (Sum((lit(4), lit(-3))), "4-3", "4 - 3"),
    (Sum((lit(4), Negative(lit(-3)))), "4-(-3)", "4 - (-3)"),
    (Product((lit(2), lit(3), A)), r"2\cdot 3A", "2·3A"),
    (Product((lit(s + 2), A)), "(s+2)A", "(s + 2)A"),
    (Product((Power(lit(s + 2), 2), Power(lit(s + 10), 2))), "(s+2)^2(s+10)^2", "(s + 2)²(s + 10)²"),
    (Power(O, -1), r"\mathcal O^{-1}", "𝒪⁻¹"),
    (Power(Sum((A, B)), -1), "(A+B)^{-1}", "(A + B)⁻¹"),
    (Transpose(A), r"A^{\mathsf T}", "Aᵀ"),
    (Transpose(Sum((A, B))), r"(A+B)^{\mathsf T}", "(A + B)ᵀ"),
    (Transpose(Transpose(A)), r"(A^{\mathsf T})^{\mathsf T}", "(Aᵀ)ᵀ"),
    (Apply("det", RESOLVENT), r"\det(sI-A)", "det(sI - A)"),
    (Apply("det", O), r"\det\mathcal O", "det 𝒪"),
    (Product((Apply("det", A), B)), r"\det(A)B", "det(A)B"),
    (Product((B, Apply("det", A))), r"B\det A", "B det A"),
    (Product((Apply("det", Sum((A, B))), Apply("det", Sum((A, C))))), r"\det(A+B)\det(A+C)", "det(A + B)det(A + C)"),
    (Product((Apply("det", A),) * 2), r"\det(A)\det A", "det(A)det A"),
    (Apply("phi_at", A), r"\varphi(A)", "φ(A)"),
    (Apply("trace", A), r"\operatorname{trace}A", "trace A"),
    (Quotient(P, Sum((lit(1), Product((P, F))))), r"\frac{P(s)}{1+P(s)F(s)}", "P(s)/(1 + P(s)F(s))"),
    (Quotient(Negative(P), lit(2)), r"-\frac{P(s)}{2}", "-P(s)/2"),
    (table([1, 0]), r"\begin{bmatrix}1&0\end{bmatrix}", "[1 0]"),
    (
        Power(table([s + 19, -1], [85, s + 4]), -1),
        r"\begin{bmatrix}s+19&-1\\85&s+4\end{bmatrix}^{-1}",
        "[s+19 -1; 85 s+4]⁻¹",
    ),
    (
        table([Fraction(1, 2), Fraction(1, 2)], [Fraction(1, 2), Fraction(-1, 2)]),
        r"\frac{1}{2}\begin{bmatrix}1&1\\1&-1\end{bmatrix}",
        "(1/2)[1 1; 1 -1]",
    ),
    (
        table([3 / (1 - 2 * b)], [6 / (2 * b - 1)]),
        r"\frac{1}{2b-1}\begin{bmatrix}-3\\6\end{bmatrix}",
        "(1/(2b - 1))[-3; 6]",
    ),
    (Block(((C,), (Product((C, A)),))), r"\begin{bmatrix}C\\CA\end{bmatrix}", "[C; C·A]"),
    (Block(((A, lit(Matrix.zeros(2, 2))),)), r"\begin{bmatrix}A&0\end{bmatrix}", "[A 0]"),
    (Apply("rank", Block(((B,),))), r"\operatorname{rank}B", "rank B"),
    (Product((Block(((Sum((lit(4), Negative(lit(0)))),),)), A)), "(4-0)A", "(4 - 0)A"),
    (lit(Matrix.zeros(2, 0)), r"0_{2\times 0}", "0(2×0)"),
    (Derivative(x), r"\dot x", "ẋ"),
    (Derivative(x_hat), r"\dot{\hat x}", "dx̂/dt"),
    (Derivative(Block(((x,), (e,)))), r"\frac{d}{dt}\begin{bmatrix}x\\e\end{bmatrix}", "d/dt [x; e]"),
]


def test_discrete_time_carries_an_index() -> None:
    stack = Derivative(Block(((x,), (e,))))
    step = equation(Derivative(x_hat), Sum((Product((A, x_hat)), Product((L, Letter("y"))))))
    assert LatexPrinter("z", discrete=True).inline(step) == r"\hat x_{k+1}=A\hat x_k+Ly_k"
    assert TextPrinter("z", discrete=True).inline(step) == "x̂ₖ₊₁ = A x̂ₖ + L yₖ"
    assert LatexPrinter("z", discrete=True).unbroken(stack) == r"\begin{bmatrix}x_{k+1}\\e_{k+1}\end{bmatrix}"
    assert LatexPrinter("z").inline(Apply("det", RESOLVENT)) == r"\det(zI-A)"


def test_a_formula_is_printed_anew_in_another_style_or_time() -> None:
    table, state = Literal(Matrix.of([[1], [2]])), Letter("x")
    printer = LatexPrinter()
    shown, inside = printer.unbroken(table), printer.inline(table)
    assert "bmatrix" in shown
    assert "smallmatrix" in inside
    assert (printer.unbroken(table), printer.inline(table)) == (shown, inside)
    assert printer.unbroken(state) == "x"
    printer.keep_time(("z", True))
    assert printer.unbroken(state) == "x_k"
    flat = TextPrinter()
    assert "\n" in flat.display([Relation((state, table), ("=",))])
    assert flat.inline(table) == "[1; 2]"


def test_declared_symbols_are_printed_as_declared() -> None:
    assert LatexPrinter(symbols={"m": r"m_{\text{cart}}"}).inline(lit(2 * m * b)) == r"2bm_{\text{cart}}"


@tabled
def test_a_declared_form_with_a_superscript_is_raised_in_parentheses(form: str) -> None:
    """TeX knows no second superscript, and a reader would take both for one."""
    raised = LatexPrinter(symbols={"b": form}).inline(lit(b * b))
    assert raised == (f"({form})^2" if "^" in form else f"{form}^2")


# -- it fits on the page ----------------------------------------------------------------------------------------------


def number(source: random.Random, digits: int) -> Scalar:
    return Scalar.of(source.choice((-1, 1)) * source.randrange(10 ** (digits - 1), 10**digits))


def hostile_members(source: random.Random) -> Iterator[Formula]:
    """Right sides that do not fit a line by themselves."""
    names = (*PARAMETERS, "s", "s")
    for terms in (15, 60, 200, 800):
        yield lit(polynomial(source, terms, names, 5))
        yield lit(polynomial(source, terms, names, 5) / polynomial(source, 4))
        yield lit(polynomial(source, 3) / polynomial(source, terms, names, 5))
        yield lit(polynomial(source, terms // 2, names, 5) / polynomial(source, terms // 2, names, 5))
        yield Product((lit(-3), lit(polynomial(source, terms)), A))
        yield Power(lit(polynomial(source, terms, names)), 3)
    for rows, columns in ((1, 6), (6, 1), (3, 3), (6, 6), (4, 13), (1, 40), (40, 1), (12, 12)):
        below = polynomial(source, 2) + 40
        entries: list[Callable[[], Scalar]] = [
            lambda: number(source, 3),
            lambda: polynomial(source, 3),
            lambda: polynomial(source, 3) / below,  # noqa: B023 - used at once
            lambda: number(source, 90) / number(source, 90),
        ]
        for entry in entries:
            yield matrix_of(rows, columns, entry)
            yield Product((A, Transpose(Sum((B, matrix_of(rows, columns, entry)))), matrix_of(rows, columns, entry)))
    for digits in (60, 200, 900):
        yield lit(number(source, digits))
        yield lit(number(source, digits) / number(source, digits) * s + number(source, digits))
        yield Apply("det", matrix_of(2, 2, lambda: number(source, digits)))  # noqa: B023 - used at once
    yield Sum(tuple(Product((Power(A, k), B, lit(polynomial(source, 4)))) for k in range(1, 12)))
    yield Quotient(lit(polynomial(source, 30, names)), Sum((lit(1), Product((P, lit(polynomial(source, 30, names)))))))
    yield Derivative(Block(((x,), (lit(polynomial(source, 50)),))))
    yield Product((Apply("det", A), Apply("det", Sum((A, matrix_of(3, 3, lambda: polynomial(source, 9))))), A))


def test_the_argument_of_a_cosine_ends_where_it_is_seen_to() -> None:
    """Not cos 2t I, which is read as cos(2t I); before another cosine or sine, and at the end, nothing can be misread."""
    t = Scalar.symbol("t")
    cosine, sine = (Literal(function(kind, 2 * t)) for kind in ("cos", "sin"))
    shifted = Sum((A, Identity(2)))
    modes = Sum((Product((cosine, Identity(2))), Product((Quotient(sine, lit(2)), shifted)), Product((sine, shifted))))
    assert LatexPrinter().inline(modes) == r"\cos(2t)I+\frac{\sin2t}{2}(A+I)+\sin(2t)(A+I)"
    assert TextPrinter().inline(modes) == "cos(2t)I + (sin(2t)/2)(A + I) + sin(2t)(A + I)"
    assert LatexPrinter().inline(Product((cosine, sine))) == r"\cos2t\sin2t"
    assert LatexPrinter().inline(Product((cosine, Power(sine, 2)))) == r"\cos(2t)(\sin2t)^2"
    written = MathmlPrinter().inline(Product((cosine, Identity(2))))
    assert "(2" in re.sub(r"<[^>]*>|\s", "", written)


@pytest.mark.parametrize(("formula", "latex", "text"), FORMULAS, ids=[latex for _, latex, _ in FORMULAS])
def test_formulas_look_as_in_a_book(formula: Formula, latex: str, text: str) -> None:
    assert LatexPrinter().unbroken(formula) == latex
    assert TextPrinter().inline(formula) == text


def test_a_transposed_column_in_a_line_has_no_second_sign() -> None:
    column = Literal(Matrix.of([[1], [2], [3]]))
    assert LatexPrinter().inline(column).count("mathsf T") == 1
    assert "mathsf T" not in LatexPrinter().inline(Transpose(column))
