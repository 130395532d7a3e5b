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
from tests.support.algebra import determinant, identity, inverse, rank_of
from tests.support.derivations import plus, times

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.algebra import Rows

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
@tabled
def test_all_gains_of_compensators_are_whole(shape: dict[str, Any], count: int) -> None:
    for plant, asked in made("compensator", count, **shape):
        A, B, C = (table(plant[name]) for name in "ABC")
        O, controllability = observability(A, C), turned(observability(turned(A), turned(B)))
        assert abs(determinant(O)) == abs(determinant(controllability)) == 1
        last = [[Fraction(i == len(A) - 1)] for i in range(len(A))]
        L = times(times(desired(A, asked["observer_poles"].pairs), inverse(O)), last)
        K = times(times(turned(last), inverse(controllability)), desired(A, asked["control_poles"].pairs))
        assert all(entry.denominator == 1 for row in (*K, *L) for entry in row)


@pytest.mark.parametrize("kind", ["compensator", "second_order"])
def test_observers_are_faster_than_the_control_whose_poles_vary(kind: str) -> None:
    asked = [each.specification for each in made(kind, 40)]
    halves = [[[real for real, _ in half[f"{name}_poles"].pairs] for name in ("control", "observer")] for half in asked]
    assert all(max(observer) < min(control) for control, observer in halves)
    assert len({tuple(control) for control, _ in halves}) >= 8  # of 10 each: three or two of five numbers


@tabled
def test_parts_are_hidden_where_the_sizes_say(sizes: list[int]) -> None:
    kept = 0
    for plant, _ in made("decomposition", 60, sizes=sizes):
        A, B, C = (table(plant[name]) for name in "ABC")
        seen = rank_of(observability(A, C))
        moved = rank_of(observability(turned(A), turned(B)))
        assert seen <= sizes[0] + sizes[2]
        assert moved <= sizes[0] + sizes[1]
        kept += (seen, moved) == (sizes[0] + sizes[2], sizes[0] + sizes[1])
    assert kept > 30  # those with fewer are left out by the cheap test


def linear_forms(text: str) -> list[sp.Expr]:
    """The linear forms of h1 and h2 that stand in parentheses."""
    letters = {"h1": h1, "h2": h2, "": sp.Integer(1)}
    term = re.compile(r"([+-]?) ?(\d*) ?\b(h1|h2|)")
    found = []
    for form in re.findall(r"\(([^()]*)\)", text):
        parts = [match for match in term.findall(form) if match[1] or match[2]]
        found.append(sum(int(f"{sign}{size or 1}") * letters[letter] for sign, size, letter in parts))
    return found


def test_members_have_a_whole_gain_for_their_poles() -> None:
    for c, (plant, asked) in enumerate(made("member", 12)):
        draw = Draws(11, c)["L"]
        L = sp.Matrix(3, 2, lambda _i, _j, draw=draw: draw.below(5) - 2)
        A, C = sp.Matrix(plant["A"]), sp.Matrix(plant["C"])
        phi = sp.prod(s - pole for pole, _ in asked["observer_poles"].pairs)
        assert C.rank() == 2
        assert sp.expand((A - L * C).charpoly(s).as_expr() - phi) == 0
    for (plant, asked), (dual, wanted) in zip(made("member", 5), made("member", 5, of="state_feedback"), strict=True):
        assert dual["A"] == tuple(zip(*plant["A"], strict=True))
        assert dual["B"] == tuple(zip(*plant["C"], strict=True))
        assert asked["observer_poles"] == wanted["control_poles"]


def test_modes_and_their_vectors_are_whole() -> None:
    for plant, _ in made("modal", 10):
        A = sp.Matrix(plant["A"])
        roots = sp.Poly(A.charpoly(s).as_expr(), s).ground_roots()
        assert len(roots) == 3
        assert all(root.is_integer for root in roots)
        vectors = [(A - root * sp.eye(3)).nullspace()[0] for root in roots]
        scaled = [vector * sp.ilcm(*(entry.q for entry in vector)) for vector in vectors]
        primitive = [vector / sp.igcd(*vector) for vector in scaled]
        assert abs(sp.Matrix.hstack(*primitive).det()) == 1


def test_corners_of_regions_are_whole() -> None:
    for _, asked in made("region", 25, region="triangle"):
        middle, last = linear_forms(asked["polynomial"])
        sides = [1 + middle + last, 1 - middle + last, 1 - last]  # Jury
        for pair in ((0, 1), (0, 2), (1, 2)):
            corner = sp.linsolve([sides[i] for i in pair], [h1, h2])
            assert all(value.is_integer for value in next(iter(corner)))
    for _, asked in made("region", 25, region="wedge"):
        middle, last = linear_forms(asked["polynomial"])
        a = int(re.fullmatch(r"s\^3 \+ (\d*) ?s\^2.*", asked["polynomial"])[1] or 1)  # type: ignore[index]
        corner = sp.linsolve([last, a * middle - last], [h1, h2])  # Routh
        assert all(value.is_integer for value in next(iter(corner)))
