"""What is read is what was written: nothing that two readers would read in two ways goes through."""

from __future__ import annotations

import re
from typing import Any

import pytest
import sympy
from sympy import Dummy, Symbol

import symobs
from symobs.formula.expression import parse_matrix, parse_poles, parse_scalar
from symobs.ground.errors import ExpressionError, InputError
from symobs.system import Symbols
from tests.kit import tabled

a, b, c, d, s = sympy.symbols("a b c d s")

# -- a product without its sign after a division ----------------------------------------------------------------------


@tabled
def test_a_product_without_its_sign_after_a_division_has_two_readings(
    text: str, from_the_left: str, all_below: str
) -> None:
    told = re.escape(f"write {from_the_left} or {all_below}")
    with pytest.raises(ExpressionError, match=rf"two ways, at .*{told}$"):
        parse_matrix(text, {"a": "real", "b": "real", "c": "real"}, variable="s")
    one, other = (parse_scalar(reading, variable="s") for reading in (from_the_left, all_below))
    assert one != other


@tabled
def test_other_products_need_no_sign(text: str, value: str) -> None:
    names = dict.fromkeys("abcd", "real")
    assert str(parse_scalar(text, names, variable="s")) == value


def test_spaces_in_brackets_set_entries_apart_after_a_division_too() -> None:
    assert parse_matrix("[1/b (b+1)]").shape == (1, 2)


@tabled
def test_a_fraction_before_the_imaginary_unit_is_its_factor(text: str, fraction: str) -> None:
    """And no denominator: 1/(4 i) would be −i/4."""
    (pole,) = parse_poles(text)
    assert (pole.real, pole.imaginary) == (parse_scalar("-1"), parse_scalar(fraction))


# -- SymPy symbols ----------------------------------------------------------------------------------------------------

one, other = Dummy("a"), Dummy("a")
k, positive_k = Symbol("k"), Symbol("k", positive=True)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: symobs.StateSpace(sympy.Matrix([[0, one - other], [1, 0]]), C=sympy.Matrix([[1, 0]])),
        lambda: symobs.StateSpace([[0, k], [1, 0]], C=[[1, positive_k]]),
        lambda: symobs.observer(symobs.StateSpace([[0, k], [1, 0]], C=[[1, 0]]), poles=[-1, -positive_k]),
        lambda: symobs.StateSpace.from_transfer_function(1 / (s * (Dummy("s") + 1))),
        lambda: symobs.StateSpace("[0 k; 1 0]", symbols={k: "real", "k": "positive"}),
    ],
)
def test_two_symbols_of_one_name_are_refused(ask: Any) -> None:
    with pytest.raises(InputError, match=r"symbols\.\w: two different symbols are both called [aks]; give each"):
        ask()


@pytest.mark.parametrize(
    ("symbol", "reason"),
    [
        (Symbol("k", imaginary=True), "k is not real by its assumptions"),
        (Symbol("k", real=False), "k is not real by its assumptions"),
        (Symbol("k", commutative=False), "k does not commute"),
        (Symbol("lambda"), '"lambda" is a word of Python and names no symbol; write another name, such as "lam"'),
        (Symbol("\N{GREEK SMALL LETTER OMEGA}"), "is not a name; begin with a letter"),
        (Symbol("a b"), '"a b" is not a name'),
    ],
)
def test_what_is_no_real_parameter_is_refused(symbol: Symbol, reason: str) -> None:
    with pytest.raises(InputError, match=re.escape(reason)):
        symobs.StateSpace([[0, symbol], [1, 0]])
    with pytest.raises(InputError, match=re.escape(reason)):
        symobs.observer(symobs.StateSpace("[0 1; 1 0]", C="[1 0]"), polynomial=s**2 + symbol * s + 1)


SIGNS = ("positive", "negative", "nonnegative", "nonpositive", "nonzero", "real")
ADMITTED = {
    "positive": {1},
    "negative": {-1},
    "nonnegative": {0, 1},
    "nonpositive": {-1, 0},
    "nonzero": {-1, 1},
    "real": {-1, 0, 1},
}


@pytest.mark.parametrize("declared", SIGNS)
@pytest.mark.parametrize("assumed", SIGNS)
def test_a_declared_sign_may_not_contradict_an_assumption(declared: str, assumed: str) -> None:
    symbol = Symbol("k", **{assumed: True})
    for ask in (
        lambda: Symbols.of({symbol: declared}),
        lambda: symobs.StateSpace([[0, symbol], [1, 0]], symbols={"k": declared}),
    ):
        if ADMITTED[declared] & ADMITTED[assumed]:
            ask()
            continue
        with pytest.raises(InputError, match=f"k is declared {declared}, which the assumptions .* contradict"):
            ask()


@tabled
def test_two_names_that_print_alike_are_refused(declared: dict[str, Any]) -> None:
    one_name, another = sorted(declared)
    with pytest.raises(InputError, match=f"{one_name} and {another} are printed alike; give one of them another name"):
        Symbols.of(declared)
