"""What each construction promises of every candidate, before any is left out: computed in plain fractions and by SymPy."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
import sympy as sp

from symobs.applications.variants.constructions import CONSTRUCTIONS, Made
from symobs.applications.variants.drawing import Draws
from tests.kit import tabled
from tests.support.independent_algebra.plain_fractions import determinant, eliminate, identity, inverse, plus, times

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.independent_algebra.plain import Rows

s, h1, h2 = sp.symbols("s h1 h2")


def made(kind: str, count: int, **shape: Any) -> Iterator[Made]:
    make, usual = CONSTRUCTIONS[kind]
    return (make(Draws(11, c), {**usual, **shape}) for c in range(count))


def table(rows: Any) -> Rows:
    return [[Fraction(entry) for entry in row] for row in rows]


def observability(A: Rows, C: Rows) -> Rows:
    rows, last = list(C), C
    for _ in range(len(A) - 1):
        last = times(last, A)
        rows += last
    return rows


def turned(rows: Rows) -> Rows:
    return [list(row) for row in zip(*rows, strict=True)]


def desired(A: Rows, poles: list[tuple[int, int]]) -> Rows:
    total = identity(len(A))
    for real, imaginary in poles:
        assert imaginary == 0
        total = times(total, plus(A, times(Fraction(-real), identity(len(A)))))
    return total


#: Few of each kind in a quick run, as many as a class of classes may need in the long one.
COUNTS = [pytest.param(15, id="few"), pytest.param(100, id="many", marks=pytest.mark.slow)]


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("shape", [{}, {"order": 4, "plant_poles": [-2, 3]}, {"pairs": 1, "steps": 4}])
def test_all_gains_of_compensators_are_whole(shape: dict[str, Any], count: int) -> None:
    for plant, asked in made("compensator", count, **shape):
        A, B, C = (table(plant[name]) for name in "ABC")
        O, controllability = observability(A, C), turned(observability(turned(A), turned(B)))
        assert abs(determinant(O)) == abs(determinant(controllability)) == 1
        last = [[Fraction(i == len(A) - 1)] for i in range(len(A))]
        L = times(times(desired(A, asked["observer_poles"].pairs), inverse(O)), last)
        K = times(times(turned(last), inverse(controllability)), desired(A, asked["control_poles"].pairs))
        assert all(entry.denominator == 1 for row in (*K, *L) for entry in row)


@tabled
def test_parts_are_hidden_where_the_sizes_say(sizes: list[int]) -> None:
    kept = 0
    for plant, _ in made("decomposition", 60, sizes=sizes):
        A, B, C = (table(plant[name]) for name in "ABC")
        seen = eliminate(observability(A, C), len(A))[0]
        moved = eliminate(observability(turned(A), turned(B)), len(A))[0]
        assert seen <= sizes[0] + sizes[2]
        assert moved <= sizes[0] + sizes[1]
        kept += (seen, moved) == (sizes[0] + sizes[2], sizes[0] + sizes[1])
    assert kept > 30  # those with fewer are left out by the cheap test


@pytest.mark.parametrize("hidden", ["stable", "unstable"])
def test_hidden_modes_have_the_sign_that_is_wanted(hidden: str) -> None:
    for plant, _ in made("ranks", 10, hidden=hidden, sizes=[2, 1, 0, 0]):
        A, C = sp.Matrix(plant["A"]), sp.Matrix(plant["C"])
        roots = sp.Poly(A.charpoly(s).as_expr(), s).ground_roots()
        modes = [root for root in roots if (A - root * sp.eye(3)).col_join(C).rank() < 3]
        assert len(modes) == 1
        assert modes[0] < 0 if hidden == "stable" else modes[0] > 0


def linear_forms(text: str) -> list[sp.Expr]:
    """The linear forms of h1 and h2 that stand in parentheses."""
    letters = {"h1": h1, "h2": h2, "": sp.Integer(1)}
    term = re.compile(r"([+-]?) ?(\d*) ?\b(h1|h2|)")
    found = []
    for form in re.findall(r"\(([^()]*)\)", text):
        parts = [match for match in term.findall(form) if match[1] or match[2]]
        found.append(sum(int(f"{sign}{size or 1}") * letters[letter] for sign, size, letter in parts))
    return found
