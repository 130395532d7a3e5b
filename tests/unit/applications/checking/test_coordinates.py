"""Answers in coordinates that the student chose: forms, decompositions, observers of reduced order, and what follows there."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp

from symobs.applications.checking import check
from tests.kit import tabled
from tests.support.problems.answered import text

CANONICAL = (
    'task = "canonical_form"\n[plant]\nA = "[1 2; 3 4]"\nB = "[1; 1]"\nC = "[1 0]"\n[specification]\nkind = "{}"\n'
)


REDUCED = 'task = "reduced_order_observer"\n'
REDUCED += '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n[specification]\npoles = "-10"\n'
PARTS = 'task = "decomposition"\n[plant]\nA = "[-1 0; 0 -2]"\nB = "[1; 0]"\nC = "[1 1]"\n'
TURNED = "you gave T^-1: here the new state is T x"


def verdicts(problem: str, answer: dict[str, Any]) -> dict[str, str]:
    return {part.letter: part.verdict for part in check(problem, answer).parts if part.letter in answer}


def moved(T: sp.Matrix, A: sp.Matrix, B: sp.Matrix, C: sp.Matrix) -> dict[str, Any]:
    """An answer in the coordinates T x."""
    return dict(zip("TABC", map(text, (T, T * A * T.inv(), T * B, C * T.inv())), strict=True))


def test_a_decomposition_in_another_basis_is_right() -> None:
    plant = sp.diag(-1, -2), sp.Matrix([1, 0]), sp.Matrix([[1, 1]])
    own = moved(sp.diag(2, -3), *plant) | {"sizes": [1, 0, 1, 0]}
    assert set(verdicts(PARTS, own).values()) == {"right"}
    assert check(PARTS, own).parts[0].hints == ()
    turned = check(PARTS, own | {"T": text(sp.diag(2, -3).inv())})
    assert {part.verdict for part in turned.parts if part.given} == {"right"}
    assert turned.parts[0].hints == (TURNED,)
    whole = PARTS.replace("[-1 0; 0 -2]", "[0 1; -2 -3]").replace("[1; 0]", "[0; 1]").replace("[1 1]", "[1 0]")
    one_part = sp.Matrix([[0, 1], [-2, -3]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]])
    assert set(verdicts(whole, moved(sp.Matrix([[1, 1], [0, 1]]), *one_part)).values()) == {"right"}
    # x1 + x2 is controllable, though it is to be the part that is not
    mixed = verdicts(PARTS, moved(sp.Matrix([[1, 0], [1, 1]]), *plant))
    assert mixed == dict.fromkeys("TABC", "wrong") | {"C": mixed["C"]}


@tabled
def test_coordinates_that_are_none_are_wrong(T: str) -> None:
    assert verdicts(PARTS, {"T": T, "A": "[-1 0; 0 -2]"})["T"] == "wrong"


def test_an_observer_of_reduced_order_follows_from_a_wrong_gain() -> None:
    """With L = 8 in place of 9 it is z for [-8 1] x: F = -9, and [-8 1] A + 9 [-8 1] = [-72 0]."""
    report = check(REDUCED, "L = [8]\nF = [-9]\nG = [1]\nH = [-72]\n")
    assert [part.verdict for part in report.parts] == ["follows", "right", "follows", "missing", "wrong"]
    assert [line.verdict for line in report.lines] == ["false", "follows", "follows"]


def test_a_part_that_is_right_in_coordinates_of_its_own_is_no_false_line() -> None:
    report = check(REDUCED, "F = [-10]\nG = [2]\nH = [-180]\nA B = [1; -1]\n")
    assert [part.verdict for part in report.parts] == ["right"] * 3 + ["missing"]
    assert [line.verdict for line in report.lines] == ["true"]


#: Eigenvalues -1, -2 ± 3i, -5; of the fields of T x = z with integers, so that all of the plant is integral.
BLOCKS = [sp.Matrix([[-1]]), sp.Matrix([[-2, 3], [-3, -2]]), sp.Matrix([[-5]])]
OF_FOUR = sp.diag(*BLOCKS), sp.Matrix([1, 2, -1, 3]), sp.Matrix([[2, 1, 1, -1]])
MIXED = sp.Matrix([[1, 2, 0, 1], [0, 1, 1, 0], [0, 0, 1, 3], [0, 0, 0, 1]])


def modal(A: sp.Matrix, B: sp.Matrix, C: sp.Matrix) -> str:
    plant = f'[plant]\nA = "{text(A)}"\nB = "{text(B)}"\nC = "{text(C)}"\n'
    return f'task = "canonical_form"\n{plant}[specification]\nkind = "modal"\n'


@tabled
def test_a_modal_form_without_T_in_any_order_and_scaling(order: tuple[int, ...]) -> None:
    A, B, C = OF_FOUR
    problem = modal(MIXED * A * MIXED.inv(), MIXED * B, C * MIXED.inv())
    starts = {0: [0], 1: [1, 2], 2: [3]}
    places = [state for block in order for state in starts[block]]
    own = {0: sp.Matrix([[7]]), 1: sp.Matrix([[2, -1], [1, 2]]), 2: sp.Matrix([[-3]])}  # what commutes with each block
    T = sp.diag(*(own[block] for block in order)) * sp.eye(4).extract(places, list(range(4)))
    answer = moved(T, A, B, C)
    del answer["T"]
    assert verdicts(problem, answer) == dict.fromkeys("ABC", "right")
    for name, wrong in (("B", T * B), ("C", C * T.inv())):
        wrong[2] += 1  # B and C do not belong together: in the coordinates of one of them the other one is wrong
        assert sorted(verdicts(problem, answer | {name: text(wrong)}).values()) == ["right", "right", "wrong"]
        short = wrong[:3, :] if name == "B" else wrong[:, :3]
        assert verdicts(problem, answer | {name: text(short)}) == dict.fromkeys("ABC", "right") | {name: "wrong"}
    coupled, shared = T * A * T.inv(), sp.zeros(4)
    for i, j in ((0, 3), (3, 0)):
        shared[i, j] = 1
        assert verdicts(problem, {"A": text(coupled + shared)}) == {"A": "wrong"}
        shared[i, j] = 0
    assert verdicts(problem, {"A": text(coupled[:3, :3])}) == {"A": "wrong"}


PLANT = sp.Matrix([[1, 2], [3, 4]]), sp.Matrix([1, 1]), sp.Matrix([[1, 0]])
LAYOUTS = ("last row", "first row", "last column", "first column")


def layouts(kind: str) -> list[sp.Matrix]:
    """T of the four layouts: from the rows of 𝒞⁻¹ and 𝒞⁻¹ itself, or the columns of 𝒪⁻¹ and 𝒪 itself; and both reversed."""
    A, B, C = PLANT
    turn = sp.Matrix([[0, 1], [1, 0]])
    if kind == "observable":
        seen = C.col_join(C * A)
        q = seen.inv()[:, 1]
        column = sp.Matrix.hstack(q, A * q).inv()
        return [column, turn * column, seen, turn * seen]
    column = sp.Matrix.hstack(B, A * B).inv()
    row = column[1, :].col_join(column[1, :] * A)
    return [row, turn * row, column, turn * column]


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("kind", ["controllable", "observable"])
def test_a_canonical_form_in_any_layout_is_right_and_T_belongs_to_it(kind: str, number: int) -> None:
    T, problem = layouts(kind)[number], CANONICAL.format(kind)
    answer = moved(T, *PLANT)
    report, turned = check(problem, answer), check(problem, answer | {"T": text(T.inv())})
    assert report.verdict == turned.verdict == "right"
    if kind == "controllable":
        layout = f"the coefficients stand in the {LAYOUTS[number]} here" if number else ""
        assert not number or report.parts[0].hints == (layout,)
        assert next(part for part in turned.parts if part.letter == "T").hints == (
            "; ".join(filter(None, (layout, TURNED))),
        )
    changed = T * PLANT[0] * T.inv() + sp.diag(1, 0)
    assert verdicts(problem, answer | {"A": text(changed)})["A"] == "wrong"
    for wrong in (sp.eye(2), 2 * T, sp.Matrix([[1, 1], [1, 1]])):
        found = verdicts(problem, answer | {"T": text(wrong)})
        assert found == {"T": "wrong", "A": "right", "B": "right", "C": "right"}


@tabled
def test_a_form_of_half_a_plant_and_without_T_is_judged_by_what_is_there(kind: str, left_out: str) -> None:
    problem = CANONICAL.format(kind).replace(left_out, "")
    # χ = s² − 5 s − 2 in the first row or column
    A = "[5 2; 1 0]" if kind == "controllable" else "[5 1; 2 0]"
    report = check(problem, {"A": A, **({"B": "[1; 0]"} if kind == "controllable" else {"C": "[1 0]"})})
    assert [part.verdict for part in report.parts if part.given] == ["right", "right"]
    assert "first" in report.parts[1].hints[0]
