"""Decimals beside exact numbers: rounded, never cut off, and refused where they are not the rounding of what they follow."""

from __future__ import annotations

from decimal import ROUND_HALF_EVEN, Decimal
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symobs import StateSpace, observer, reduced_order_observer
from symobs.exact import Matrix, Scalar, decimal_digits, decimal_places, is_rounding, rounded
from symobs.formula.tree import Decimals, Environment, Letter, Literal, Relation
from symobs.ground.errors import DerivationRejected
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Derivation, Equal
from tests.kit import tabled


def scalar(text: str) -> Scalar:
    return Scalar.of(Fraction(text))


@tabled
def test_what_is_a_rounding(exact: str, shown: str, so: bool) -> None:  # noqa: FBT001 - the answer to the question
    assert is_rounding(scalar(exact), scalar(shown)) is so


@given(st.fractions(min_value=-(10**6), max_value=10**6, max_denominator=10**6))
def test_what_is_shown_is_the_rounding_of_the_decimal_module(number: Fraction) -> None:
    near = rounded(Scalar.of(number))
    if not isinstance(near, Scalar):
        return
    size = abs(number)
    unit = Decimal("0.0001") if size < 10 else Decimal("0.001") if size < 100 else Decimal("0.01")
    right = (Decimal(number.numerator) / Decimal(number.denominator)).quantize(unit, ROUND_HALF_EVEN)
    assert abs(near.fraction() - Fraction(right)) <= Fraction(unit) * (number.denominator > 10**5)
    assert is_rounding(Scalar.of(number), near)
    assert Fraction(decimal_digits(near)) == abs(near.fraction())


def test_decimals_are_left_out_where_they_help_nobody() -> None:
    assert rounded(Matrix.row([Scalar.of(Fraction(16, 5)), Scalar.of(-1)])) is None
    assert rounded(Scalar.symbol("omega")) is None
    assert rounded(scalar("200000001/100000000")) is None  # it would read as 2, exactly
    assert decimal_places(scalar("1/3")) is None


def test_numbers_are_written_with_their_point() -> None:
    table = Decimals(Matrix.of([[scalar("-0.0735"), Scalar.of(60)]]))
    assert TextPrinter().inline(table) == "[-0.0735 60]"
    assert LatexPrinter().inline(table) == r"\begin{bmatrix}-0.0735&60\end{bmatrix}"


@tabled
def test_a_page_with_a_wrong_digit_is_not_shown(shown: str) -> None:
    line = Relation((Literal(scalar("25/68")), Decimals(scalar(shown))), ("≈",))
    with pytest.raises(DerivationRejected):
        Derivation((Equal((line,)),), Environment()).check()


def test_a_rounding_is_no_equation() -> None:
    both = Literal(scalar("25/68")), Decimals(scalar("0.3676"))
    Derivation((Equal((Relation(both, ("≈",)),)),), Environment()).check()
    with pytest.raises(DerivationRejected, match="the line 25/68 = 919/2500"):
        Derivation((Equal((Relation(both, ("=",)),)),), Environment()).check()


def test_what_depends_on_a_parameter_has_no_decimals() -> None:
    line = Relation((Letter("A"), Decimals(scalar("0.5"))), ("≈",))
    start = Environment(values={"A": Scalar.symbol("b")}, signs={"b": "positive"})
    with pytest.raises(DerivationRejected, match="the line A ≈ 1/2"):
        Derivation((Equal((line,)),), start).check()


def test_decimals_of_the_data_are_given_as_decimals() -> None:
    plant = StateSpace("[0 0 0 1; 0 0 1 0; 0 10.78 0 0; 0 -0.98 0 0]", "[0; 0; -1; 1]", "[1 0 0 0]")
    design = reduced_order_observer(plant, poles="-20, -20+20i, -20-20i")
    page = str(design.to("text", exact=True))
    given_part = page.partition("1. Observability")[0]
    assert "10.78" in given_part
    assert "The decimals are taken as exact: 10.78 = 539/50, 0.98 = 49/50." in " ".join(given_part.split())
    assert "-1643.65" in page  # not the -1643 of a gain that was cut off
    assert "-16986.53" in page


def test_fractions_of_the_data_are_given_as_fractions() -> None:
    page = str(observer(StateSpace("[0 1; -1/2 0]", C="[1 0]"), poles=[-1, -2]).to("text"))
    assert not any("0.5" in line for line in page.splitlines() if "┤" not in line)  # but beside an axis
    assert "1/2" in page


def test_a_matrix_rounded_too_early_spoils_the_gain() -> None:
    """The digits of the source's vectors lead to this gain, as a computation of its own has shown (E3.1)."""
    plant = StateSpace("[-7 1 15; -2 0 5; -2 0 4]", "[65; -5; 30]", "[1 0 -2]")
    page = str(observer(plant, poles=[-5, -6, -7], method="row_reduced_echelon").to("text"))
    assert "[688.57  -187.44  334.84]" in page
    assert "0.3676" in page
