"""What the grader of exported questions reads: texts to exact values, held against Python's own arithmetic and SymPy."""

from __future__ import annotations

import random
import re
from fractions import Fraction
from pathlib import Path

import pytest
import sympy as sp

from symobs.applications.grader.values import ONE, UnreadableError, number, poly, read
from tests.kit import tabled, tables

S = sp.Symbol("s")

TEXTS = tables(Path(__file__))["texts"]


@pytest.mark.parametrize("text", TEXTS)
def test_a_number_is_read_as_one_means_it(text: str) -> None:
    assert number(read(text, {})) == Fraction(TEXTS[text])


@tabled
def test_what_is_no_value_is_refused_with_its_reason(text: str, reason: str) -> None:
    with pytest.raises(UnreadableError) as raised:
        read(text, {"s": (poly([0, 1]), ONE)})
    assert str(raised.value) == reason


def test_a_random_expression_has_the_value_that_python_finds() -> None:
    """Trees of sums, products, quotients and powers with their text; both evaluated at points, and in lowest terms."""
    reasons: set[str] = set()
    draw, read_ones = random.Random(11), 0  # noqa: S311 - repeatable by design
    for _ in range(200):
        text = _expression(draw, 4)
        try:
            above, below = read(text, {"s": (poly([0, 1]), ONE)})
        except UnreadableError as error:
            reasons.add(str(error))
            continue
        read_ones += 1
        assert below[-1] == 1
        p, q = (
            sp.Poly([sp.Rational(c.numerator, c.denominator) for c in reversed(part)] or [0], S)
            for part in (above, below)
        )
        assert sp.gcd(p, q).degree() <= 0 or p.is_zero
        for at in (Fraction(3), Fraction(-7, 5), Fraction(11, 2)):
            try:
                expected = _at(text, at)
            except ZeroDivisionError:
                continue
            assert sum(c * at**k for k, c in enumerate(above)) == expected * sum(c * at**k for k, c in enumerate(below))
    assert read_ones > 120
    assert reasons <= {"a division by zero", "this is too large"}


def _expression(draw: random.Random, depth: int) -> str:
    if not depth or draw.random() < 0.2:
        return draw.choice(["s", "s", str(draw.randrange(6)), f"{draw.randrange(4)}.{draw.randrange(10)}", "2e-1"])
    left, right = _expression(draw, depth - 1), _expression(draw, depth - 1)
    return draw.choice(
        [
            f"({left}) + {right}",
            f"({left}) - ({right})",
            f"({left})*({right})",
            f"({left})/({right})",
            f"-({left})",
            f"({left})^{draw.randrange(-2, 4)}",
        ]
    )


def _at(text: str, at: Fraction) -> Fraction:
    """The value by Python's own arithmetic: every number a fraction."""
    numbers = re.sub(r"[0-9]+(\.[0-9]+)?(e-?[0-9]+)?", lambda found: f"Fraction('{found[0]}')", text)
    powers = re.sub(r"\^Fraction\('(\d+)'\)", r"**\1", numbers.replace("^-", "^~"))
    powers = re.sub(r"\^~Fraction\('(\d+)'\)", r"**-\1", powers)
    found = eval(powers, {"Fraction": Fraction, "s": at})  # noqa: S307 - the text above
    return Fraction(found)
