"""MathML: what is printed is read back by a reader of elements, and every element is one that browsers know."""

from __future__ import annotations

import random
import re
import unicodedata
import xml.etree.ElementTree as ET
from itertools import islice, pairwise
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.formula.notation import LETTERS
from symobs.formula.tree import (
    Letter,
    Product,
    Sum,
)
from symobs.pages.printers.latex_to_mathml import elements_of
from symobs.pages.printers.mathml import MathmlPrinter
from tests.kit import tabled
from tests.support.sampling import tried
from tests.unit.pages.test_printers import (
    MATRICES,
    MATRIX_NAMES,
    PARAMETERS,
    POINT,
    Reader,
    Token,
    at_point,
    equation,
    hostile_members,
    lit,
    matrix_formula,
    polynomial,
    rational,
    scalar_formula,
    sources,
    table,
    value_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.unit.pages.test_printers import Value

A, B, C, K, L, x, x_hat = map(Letter, ("A", "B", "C", "K", "L", "x", "x_hat"))
#: Elements of MathML Core that are used, and how many children those with a fixed number have.
CHILDREN = {"mfrac": 2, "msub": 2, "msup": 2, "msubsup": 3, "mover": 2, "munder": 2}
ELEMENTS = {*CHILDREN, *("math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "msqrt", "mtable", "mtr", "mtd")}
#: How the parameters of the random material are written.
WRITTEN = {"h_1": "h_1", "k_2": "k2", "mass": "mass", "ω": "omega", "τ_f": "tau_f", "ξ": "xi"}
NAMES = WRITTEN | {name: name for name in (*PARAMETERS, "s", "z") if len(name) == 1} | MATRIX_NAMES
SIGNS = {"+": "+", "−": "-"}


def parsed(source: str) -> ET.Element:
    return ET.fromstring(f"<all>{source}</all>")  # noqa: S314 - our own output


def letters(node: ET.Element) -> str:
    return unicodedata.normalize("NFKC", "".join(node.itertext()))


def tokens_of(nodes: Sequence[ET.Element]) -> list[Token]:
    """The tokens of elements side by side; a list in square brackets is a matrix."""
    tokens: list[Token] = []
    outer: list[Token] = []
    listed: list[list[list[Token]]] = []
    for node in nodes:
        sign = node.text if node.tag == "mo" else node[0].text if node.tag == "msup" else ""
        if sign == "[":
            listed, tokens, outer = [[]], [], tokens
        elif sign in {",", ";", "]"} and listed:
            listed[-1].append(merged(tokens))
            tokens = []
            if sign == ";":
                listed.append([])
            elif sign == "]":
                tokens, listed = [*outer, Token("table", listed)], []
                tokens += [power(node[1])] if node.tag == "msup" else []
        else:
            tokens += tokens_of_one(node)
    return merged(tokens)


def merged(tokens: list[Token]) -> list[Token]:
    """The tokens with the runs of a long number put together."""
    whole: list[Token] = []
    for before, token in pairwise([Token("start"), *tokens]):
        if token.kind == before.kind == "number":
            whole[-1] = Token("number", f"{whole[-1].value}{token.value}")
        else:
            whole.append(token)
    return whole


def tokens_of_one(node: ET.Element) -> list[Token]:
    children = list(node)
    match node.tag, node.text:
        case (("math" | "all" | "mtd"), _):
            return tokens_of(children)
        case "mrow", _:
            tables = [child for child in children if child.tag == "mtable"]
            if not tables:
                return tokens_of(children)
            assert [child.text for child in children if child.tag == "mo"] == ["[", "]"]
            return [Token("table", [[tokens_of(list(cell)) for cell in line] for line in tables[0]])]
        case "mn", str() as digits:
            return [Token("number", digits)]
        case "mi", ("det" | "adj") as function:
            return [Token("function", function)]
        case "mi", _:
            return [Token("name", NAMES[letters(node)])]
        case "msub", _:
            return [Token("name", NAMES[f"{letters(children[0])}_{letters(children[1])}"])]
        case "msubsup", _:
            base = Token("name", NAMES[f"{letters(children[0])}_{letters(children[1])}"])
            return [base, power(children[2])]
        case "msup", _:
            if children[0].text == ")":
                return [Token("close"), power(children[1])]
            return [Token("open"), *tokens_of(children[:1]), Token("close"), power(children[1])]
        case "mfrac", _:
            above, below = (tokens_of([child]) for child in children)
            return [Token("frac"), Token("open"), *above, Token("close"), Token("open"), *below, Token("close")]
        case "mo", ("+" | "−") as sign:
            return [Token("sign", SIGNS[sign])]
        case "mo", str() as sign if sign in "(/)⋅":
            return [Token({"(": "open", ")": "close", "/": "slash", "⋅": "dot"}[sign])]
        case ("mo", "\u2061" | "\u2062") | ("mspace", _):
            return []
    raise AssertionError((node.tag, node.text))


def power(script: ET.Element) -> Token:
    written = letters(script)
    return Token("power", "T" if written == "T" else int(written.replace("−", "-")))


def read(source: str) -> Value:
    inside = [part for math in parsed(source) for part in (math if math.tag == "math" else [math])]
    return Reader(tokens_of(inside), POINT | MATRICES).whole()


def faults(source: str) -> Iterator[str]:
    """What no browser would show as it is meant."""
    for node in parsed(source).iter():
        if node.tag not in ELEMENTS | {"all"}:
            yield f"unknown {node.tag}"
        if len(node) != CHILDREN.get(node.tag, len(node)):
            yield f"{node.tag} with {len(node)} parts"
        if node.tag in {"mi", "mn", "mo", "mtext"} and (len(node) or not node.text):
            yield f"empty {node.tag}"
        if node.tag == "mtable" and {child.tag for child in node} != {"mtr"}:
            yield "a table of something other than rows"


# -- what is printed means what was given -----------------------------------------------------------------------------


@given(sources)
@settings(max_examples=tried(100))
def test_scalars_read_back_as_the_same_number(source: random.Random) -> None:
    value = rational(source, 6)
    expected = value.substitute(POINT)
    assert read(MathmlPrinter().inline(lit(value))) == expected
    assert read(MathmlPrinter().unbroken(lit(value))) == expected


@given(sources)
@settings(max_examples=tried(100))
def test_formulas_read_back_as_the_same_value(source: random.Random) -> None:
    formula = source.choice((matrix_formula, scalar_formula))(source, source.randint(0, 3))
    expected = at_point(value_of(formula))
    assert read(MathmlPrinter().unbroken(formula)) == expected
    assert read(MathmlPrinter().inline(formula)) == expected


def right_side(display: str) -> list[ET.Element]:
    """The elements behind the first sign of a display, its lines joined again."""
    (math,) = parsed(display)
    cells = [part for cell in math.iter("mtd") for part in cell] if math[0].tag == "mtable" else list(math)
    place = next(place for place, part in enumerate(cells) if part.text == "=")
    return cells[place + 1 :]


@given(sources)
@settings(max_examples=tried(20))
def test_broken_displays_read_back_as_the_same_number(source: random.Random) -> None:
    names = (*PARAMETERS, "s")
    above, below = polynomial(source, 90, names, 5), polynomial(source, source.choice((1, 3, 6)), names)
    value = above if below.is_zero else above / below
    display = MathmlPrinter().display([equation(A, lit(value))], end="")
    assert display.count("<mtr>") > 3
    assert Reader(tokens_of(right_side(display)), POINT).whole() == value.substitute(POINT)


# -- it is MathML -----------------------------------------------------------------------------------------------------


def test_long_displays_are_made_of_elements_that_browsers_know() -> None:
    for member in islice(hostile_members(random.Random(6)), 0, None, 3):  # noqa: S311
        assert list(faults(MathmlPrinter().display([equation(K, A, member)], boxed=True))) == []


@pytest.mark.parametrize("name", [name for name in LETTERS if not re.search(r"exp|e\^", LETTERS[name].text)])
def test_a_letter_shows_the_characters_it_has_on_a_terminal(name: str) -> None:
    """The two forms of a letter are written down apart; both have to be the same letter."""

    def plain(text: str) -> list[str]:
        """Letters, digits and parentheses, without accents."""
        kinds = ((c, unicodedata.category(c)) for c in unicodedata.normalize("NFKD", text))
        return [c for c, kind in kinds if c in "()," or kind in {"Lu", "Ll", "Nd"}]

    terminal = LETTERS[name].text.replace("{v}", "s").replace("_(A-BK)", "A-BK").replace("_(A-LC)", "A-LC")
    assert plain("".join(ET.fromstring(MathmlPrinter().inline(Letter(name))).itertext())) == plain(terminal)  # noqa: S314


forms = st.lists(
    st.sampled_from([*"abT0189^_{}', ()-+<>&|\"", r"\hat", r"\mathrm ", r"\omega", "\\", r"\mathcal{O}"])
).map("".join)


@tabled
def test_forms(form: str, mathml: str) -> None:
    assert "".join(elements_of(form)) == mathml


def test_parentheses_grow_only_around_what_is_tall() -> None:
    flat, tall = (MathmlPrinter().unbroken(Product((Sum((A, term)), B))) for term in (B, table([1, 2])))
    assert 'stretchy="false">(' in flat
    assert 'stretchy="false">(' not in tall
