"""Roots of letters as a book prints them: equal to the value by mpmath, with no root left beside a power of its letters."""

from __future__ import annotations

import re

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Scalar
from symobs.exact.core.generators import generator, square_root
from symobs.formula.tree import Literal
from symobs.pages.page.roots_of_letters import in_roots_of_letters
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from tests.kit import text_of

LETTERS = ("a", "b", "q")
POSITIVE = frozenset(LETTERS)

powers = st.tuples(*[st.integers(-2, 2)] * len(LETTERS))
numbers = st.fractions(min_value=-4, max_value=4, max_denominator=6).filter(bool)


def monomial(exponents: tuple[int, ...], number: object = 1) -> Scalar:
    value = Scalar.of(1) * number  # type: ignore[operator]
    for name, power in zip(LETTERS, exponents, strict=True):
        value = value * Scalar.symbol(name) ** power
    return value


@st.composite
def values(draw: st.DrawFn) -> Scalar:
    """A sum of products of powers, roots, and roots of roots, one of which may be of a sum."""
    total = Scalar.of(0)
    for _ in range(draw(st.integers(1, 3))):
        inner = generator("sqrt", monomial(draw(powers), draw(st.sampled_from([1, 2, 6]))))
        nested = generator("sqrt", monomial(draw(powers), draw(st.sampled_from([1, 2, 3]))) * inner)
        of_sum = generator("sqrt", monomial(draw(powers)) + 2)
        chosen = draw(
            st.sampled_from([inner, nested, inner * nested, of_sum, nested * of_sum, square_root(Scalar.of(2))])
        )
        total = total + monomial(draw(powers), draw(numbers)) * chosen
    return total / (Scalar.symbol("a") + 1) if draw(st.booleans()) else total


def at(value: Scalar, point: dict[str, object]) -> mpmath.mpf:
    """Return the value of its text in Python, with SymPy's function sqrt."""
    found: mpmath.mpf = eval(str(value), {"sqrt": mpmath.sqrt, **point})  # noqa: S307 - our own text
    return found


@settings(deadline=None)
@given(values(), st.tuples(*[st.fractions(min_value="1/9", max_value=9, max_denominator=20)] * 3))
def test_what_is_printed_has_the_value(value: Scalar, point: tuple[object, ...]) -> None:
    spelled = in_roots_of_letters(Literal(value), POSITIVE).value
    with mpmath.workdps(40):
        where = {n: mpmath.mpf(p.numerator) / p.denominator for n, p in zip(LETTERS, point, strict=True)}  # type: ignore[attr-defined]
        before, after = at(value, where), at(spelled, where)
        assert mpmath.almosteq(before, after, 1e-30, 1e-30), f"{value} is printed as {spelled}"


@pytest.mark.parametrize(
    ("typed", "text", "latex"),
    [
        ("sqrt(q*r)/r", "√(q/r)", r"\sqrt{q/r}"),
        ("-a*sqrt(k*m)/m", "-a √(k/m)", r"-a\sqrt{k/m}"),
        ("(a + sqrt(q*r))/r", "(a + √(q r))/r", r"\frac{a+\sqrt{qr}}{r}"),
        ("sqrt(q*r)/r + a", "a + √(q/r)", r"a+\sqrt{q/r}"),
        ("3*sqrt(b)/b", "3/√b", r"\frac{3}{\sqrt{b}}"),
        ("sqrt(b)/2", "√b/2", r"\frac{\sqrt{b}}{2}"),
        ("sqrt(a^2 + q)/a", "√(a² + q)/a", r"\frac{\sqrt{a^2+q}}{a}"),
    ],
)
def test_books_forms(typed: str, text: str, latex: str) -> None:
    plant = symobs.StateSpace(typed, symbols=dict.fromkeys(("a", "b", "k", "m", "q", "r", "sigma"), "positive"))
    ((value,),) = plant.matrices.A.rows
    shown = in_roots_of_letters(Literal(value), frozenset(plant.symbols.signs))
    assert TextPrinter().inline(shown) == text
    assert LatexPrinter().unbroken(shown) == latex


def test_a_letter_of_unknown_sign_stays_where_it_is() -> None:
    root = generator("sqrt", Scalar.symbol("q") * Scalar.symbol("r")) / Scalar.symbol("r")
    assert in_roots_of_letters(Literal(root), frozenset({"q"})) == Literal(root)


def test_the_page_and_the_roots_with_names() -> None:
    """Kwakernaak and Sivan's form of the gain of a double integrator; a root that has a letter keeps it."""
    signs = dict.fromkeys(("a", "q", "r"), "positive")
    double = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", symbols=signs)
    page = text_of(symobs.lqr(double, Q="diag(q, 0)", R="r"))
    assert "K = │ [√(q/r), √2·⁴√(q/r)] │" in page
    page = text_of(symobs.lqr(symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", symbols=signs), Q="diag(q, 0)", R="r"))
    assert "ν² = a² + 2√(q/r)" in re.sub(r"\s+", " ", page)
    assert "√(q r)/r" not in page
