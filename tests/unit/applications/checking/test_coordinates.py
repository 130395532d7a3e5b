"""Answers in coordinates that the student chose: forms, decompositions, observers of reduced order, and what follows there."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy as sp

from symobs.applications.checking import Checked, check
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import text

EXAMPLES = ROOT / "worked_examples"

CANONICAL = (
    'task = "canonical_form"\n[plant]\nA = "[1 2; 3 4]"\nB = "[1; 1]"\nC = "[1 0]"\n[specification]\nkind = "{}"\n'
)
REDUCED = 'task = "reduced_order_observer"\n'
REDUCED += '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n[specification]\npoles = "-10"\n'
PARTS = 'task = "decomposition"\n[plant]\nA = "[-1 0; 0 -2]"\nB = "[1; 0]"\nC = "[1 1]"\n'
TURNED = "you gave T^-1: here the new state is T x"


def verdicts(problem: str, answer: dict[str, Any]) -> dict[str, str]:
    return {part.letter: part.verdict for part in check(problem, answer).parts if part.letter in answer}


def observable_layouts() -> list[sp.Matrix]:
    """T of the dual four layouts: the columns of 𝒪⁻¹ and its last column with A, and both reversed."""
    A, C = sp.Matrix([[1, 2], [3, 4]]), sp.Matrix([[1, 0]])
    seen = C.col_join(C * A)
    q = seen.inv()[:, 1]
    turn = sp.Matrix([[0, 1], [1, 0]])
    column = sp.Matrix.hstack(q, A * q).inv()
    return [column, turn * column, seen, turn * seen]


@pytest.mark.parametrize("number", range(4))
def test_the_observable_form_in_any_layout_is_right_and_T_belongs_to_it(number: int) -> None:
    A, B, C = sp.Matrix([[1, 2], [3, 4]]), sp.Matrix([1, 1]), sp.Matrix([[1, 0]])
    T = observable_layouts()[number]
    answer = dict(zip("TABC", map(text, (T, T * A * T.inv(), T * B, C * T.inv())), strict=True))
    problem = CANONICAL.format("observable")
    assert set(verdicts(problem, answer).values()) == {"right"}
    assert set(verdicts(problem, answer | {"T": text(T.inv())}).values()) == {"right"}
    for wrong in (sp.eye(2), 2 * T, sp.Matrix([[1, 1], [1, 1]])):
        assert verdicts(problem, answer | {"T": text(wrong)}) == {
            "T": "wrong",
            "A": "right",
            "B": "right",
            "C": "right",
        }


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


def test_a_modal_form_may_be_given_by_its_vectors_and_T_is_not_any_matrix() -> None:
    problem = CANONICAL.format("modal").replace("[1 2; 3 4]", "[0 1; -2 -3]").replace("[1; 1]", "[0; 1]")
    plant = sp.Matrix([[0, 1], [-2, -3]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]])
    vectors = sp.Matrix([[3, 1], [-3, -2]])
    answer = moved(vectors.inv(), *plant) | {"T": text(vectors)}
    for given in (answer, {"T": answer["T"]}):
        report = check(problem, given)
        assert {part.verdict for part in report.parts if part.given} == {"right"}
        assert report.parts[0].hints == (TURNED,)
    assert set(verdicts(problem, moved(sp.eye(2), *plant)).values()) == {"wrong"}
    assert verdicts(problem, {"A": "[-2 0; 0 -2]"}) == {"A": "wrong"}


@tabled
def test_a_form_of_half_a_plant_and_without_T_is_judged_by_what_is_there(kind: str, left_out: str) -> None:
    problem = CANONICAL.format(kind).replace(left_out, "")
    # χ = s² − 5 s − 2 in the first row or column
    A = "[5 2; 1 0]" if kind == "controllable" else "[5 1; 2 0]"
    report = check(problem, {"A": A, **({"B": "[1; 0]"} if kind == "controllable" else {"C": "[1 0]"})})
    assert [part.verdict for part in report.parts if part.given] == ["right", "right"]
    assert "first" in report.parts[1].hints[0]


def test_T_of_a_controllable_form_is_not_any_matrix() -> None:
    problem = CANONICAL.format("controllable")
    right = Checked.of(problem).results[0].fields
    answer = {name: str(right[name]) for name in "ABC"}
    for wrong in ("[1 0; 0 1]", "[1 1; 1 1]", "[1 0]"):
        assert verdicts(problem, answer | {"T": wrong})["T"] == "wrong"


@pytest.mark.parametrize("T", ["[1 1; 1 1]", "[1 0]", "[1 0; 0 1; 1 1]", "[0 0; 0 0]"])
def test_coordinates_that_are_none_are_wrong(T: str) -> None:
    assert verdicts(PARTS, {"T": T, "A": "[-1 0; 0 -2]"})["T"] == "wrong"


def test_M_alone_says_which_estimate_it_is() -> None:
    assert verdicts(REDUCED, {"M": "[1 0; 9 1/2]"}) == {"M": "right"}  # P = [-18 2], twice the usual one
    for wrong in ("[1 0; 1 0]", "[1 0]", "[1 0; 9 0]", "[2 0; 9 1]"):
        assert verdicts(REDUCED, {"M": wrong}) == {"M": "wrong"}
    given = {"F": "[-10]", "G": "[2]", "H": "[-180]", "M": "[1 0]"}
    assert verdicts(REDUCED, given) == {"F": "right", "G": "right", "H": "right", "M": "wrong"}


def test_an_observer_of_reduced_order_follows_from_a_wrong_gain() -> None:
    """With L = 8 in place of 9 it is z for [-8 1] x: F = -9, and [-8 1] A + 9 [-8 1] = [-72 0]."""
    report = check(REDUCED, "L = [8]\nF = [-9]\nG = [1]\nH = [-72]\n")
    assert [part.verdict for part in report.parts] == ["follows", "right", "follows", "missing", "wrong"]
    assert [line.verdict for line in report.lines] == ["false", "follows", "follows"]


def test_a_part_that_is_right_in_coordinates_of_its_own_is_no_false_line() -> None:
    report = check(REDUCED, "F = [-10]\nG = [2]\nH = [-180]\nA B = [1; -1]\n")
    assert [part.verdict for part in report.parts] == ["right"] * 3 + ["missing"]
    assert [line.verdict for line in report.lines] == ["true"]


def test_what_is_wrong_with_an_observer_of_reduced_order() -> None:
    tanks = Checked.of((EXAMPLES / "tanks_minimal_observer.toml").read_text(encoding="utf-8"))
    assert "follows  it follows from your M, which" in tanks.report({"M": "-8", "F": "-9/25"}).to_text()
    report = tanks.report({"F": "1/5", "G": "1", "H": "-0.6"})
    assert [(part.slip, part.reason) for part in report.parts[:3]] == [
        ("sign", "-F is right"),
        (None, ""),
        ("rounded", "H is rounded, and its exact value is asked for"),
    ]


def test_a_matrix_that_is_wrong_beside_right_ones_has_its_right_value_in_their_coordinates() -> None:
    """t (A + 4 I) = C and t (A + 5 I) = C are the rows of T, and t B = -1/φ(-4) and -1/φ(-5), φ = s³ + 6 s² + 11 s + 6."""
    problem = 'task = "reduced_order_observer"\n[plant]\nA = "[0 1 0; 0 0 1; -6 -11 -6]"\nB = "[0; 0; 1]"\n'
    problem += 'C = "[1 0 0]"\n[specification]\npoles = "-4, -5"\n'
    report = check(problem, {"F": "[-4 0; 0 -5]", "G": "[0; 1]", "H": "[1; 1]"}, show="solution")
    parts = {part.letter: part for part in report.parts if part.given}
    assert {letter: part.verdict for letter, part in parts.items()} == {"F": "right", "G": "wrong", "H": "right"}
    first, second = (-1 / (Fraction(s) ** 3 + 6 * s**2 + 11 * s + 6) for s in (-4, -5))
    assert parts["G"].right == f"[{first}; {second}]"
    assert (parts["G"].reason, parts["G"].slip, parts["G"].alternatives) == ("", None, ())


def test_sizes_are_four_numbers_in_order() -> None:
    for sizes, verdict in (([1, 0, 1, 0], "right"), ([1, 1, 0, 0], "wrong"), ([1, 0, 1], "wrong")):
        assert verdicts(PARTS, {"T": "[1 0; 0 1]", "sizes": sizes})["sizes"] in {verdict, "unreadable"} - {"right"} | {
            verdict
        }


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


def test_a_modal_form_of_modes_that_only_one_of_B_and_C_scales() -> None:
    problem = modal(sp.Matrix([[-1, 0], [0, -2]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]]))
    assert verdicts(problem, {"A": "[-1 0; 0 -2]", "B": "[0; 5]", "C": "[7 0]"}) == dict.fromkeys("ABC", "right")
    assert verdicts(problem, {"A": "[-2 0; 0 -1]", "B": "[5; 0]", "C": "[0 7]"}) == dict.fromkeys("ABC", "right")
    assert verdicts(problem, {"A": "[-1 0; 0 -2]", "B": "[5; 0]", "C": "[7 0]"})["B"] == "wrong"


def test_a_chain_is_not_turned_over() -> None:
    """Of (s + 1)³: the block of order 3 has its ones above the diagonal, where the page puts them, or nowhere."""
    problem = modal(sp.Matrix([[0, 1, 0], [0, 0, 1], [-1, -3, -3]]), sp.Matrix([0, 0, 1]), sp.Matrix([[1, 0, 0]]))
    block = sp.Matrix([[-1, 1, 0], [0, -1, 1], [0, 0, -1]])
    assert verdicts(problem, {"A": text(block)}) == {"A": "right"}
    assert verdicts(problem, {"A": text(block.T)}) == {"A": "wrong"}


def test_an_observer_of_one_state_and_two_outputs_with_any_of_its_estimates() -> None:
    """P = [u v 1] with P A + 4 P = H C: v follows from the third column, H from the first two, and G = P B."""
    A, B, C = sp.Matrix([[0, 1, 1], [2, -1, 1], [1, 0, -2]]), sp.Matrix([1, 0, 2]), sp.eye(3)[:2, :]
    problem = f'task = "reduced_order_observer"\n[plant]\nA = "{text(A)}"\nB = "{text(B)}"\nC = "{text(C)}"\n'
    problem += '[specification]\npoles = "-4"\n'
    for u, scale in ((0, 1), (1, 3), (-5, -2)):
        P = scale * sp.Matrix([[u, -4 - A[2, 2] - u * A[0, 2], 1]])  # (P A)₃ = -4 P₃, as A₂₃ = 1
        rest = P * A + 4 * P
        assert rest[2] == 0
        M = C.col_join(P).inv()
        answer = {"F": "[-4]", "G": text(P * B), "H": text(rest[:, :2]), "M": text(M)}
        assert set(verdicts(problem, answer).values()) == {"right"}
        del answer["M"]
        assert set(verdicts(problem, answer).values()) == {"right"}
        assert verdicts(problem, answer | {"G": text(P * B + sp.eye(1))}) == {"F": "right", "G": "wrong", "H": "right"}
    assert verdicts(problem, {"F": "[-4]", "H": "[0 0]"})["H"] == "wrong"  # the estimate of nothing
    assert verdicts(problem, {"F": "[-4]", "H": "[1; 2; 3]"})["H"] == "wrong"
    # where F is an eigenvalue of A, [1 0 0] (A + 4 I) = 0 and P is not the only one
    alone = problem.replace(text(A), "[-4 0 0; 0 0 1; 0 1 0]")
    assert verdicts(alone, {"F": "[-4]", "H": "[5 5]"})["H"] == "wrong"


def test_a_chain_of_vectors_may_be_scaled_as_a_whole() -> None:
    """χ = (s + 1)³ in companion form: one block of order 3, T of which was multiplied by 5."""
    problem = CANONICAL.format("modal").replace('"[1 2; 3 4]"', '"[0 1 0; 0 0 1; -1 -3 -3]"')
    problem = problem.replace('"[1; 1]"', '"[0; 0; 1]"').replace('"[1 0]"', '"[1 0 0]"')
    plant = sp.Matrix([[0, 1, 0], [0, 0, 1], [-1, -3, -3]]), sp.Matrix([0, 0, 1]), sp.Matrix([[1, 0, 0]])
    chain = sp.Matrix([[1, 1, 1], [-1, 0, 0], [1, -1, 0]])  # (A + I) v1 = 0, (A + I) v2 = v1, (A + I) v3 = v2
    assert set(verdicts(problem, moved(5 * chain.inv(), *plant)).values()) == {"right"}
    assert verdicts(problem, moved(sp.diag(1, 2, 1), *plant))["T"] == "wrong"


def test_blocks_of_a_modal_form_may_change_places_and_the_sign_of_their_sine() -> None:
    """χ = (s + 2)(s² + 2 s + 2): the last state first turns the block of the pair over."""
    problem = CANONICAL.format("modal").replace('"[1 2; 3 4]"', '"[0 1 0; 0 0 1; -4 -6 -4]"')
    problem = problem.replace('"[1; 1]"', '"[0; 0; 1]"').replace('"[1 0]"', '"[1 0 0]"')
    plant = sp.Matrix([[0, 1, 0], [0, 0, 1], [-4, -6, -4]]), sp.Matrix([0, 0, 1]), sp.Matrix([[1, 0, 0]])
    # of -1 + i: [1; -1 + i; -2 i], its real and its imaginary part; of -2: [1; -2; 4]
    real, imaginary, alone = sp.Matrix([1, -1, 0]), sp.Matrix([0, 1, -2]), sp.Matrix([1, -2, 4])
    for columns in ((alone, real, imaginary), (imaginary, real, 3 * alone), (5 * real, 5 * imaginary, alone)):
        assert set(verdicts(problem, moved(sp.Matrix.hstack(*columns).inv(), *plant)).values()) == {"right"}
    split = sp.Matrix.hstack(real, 2 * imaginary, alone).inv()
    assert verdicts(problem, moved(split, *plant))["T"] == "wrong"


def test_a_few_matrices_of_an_observer_of_reduced_order() -> None:
    assert verdicts(REDUCED, {"H": "[-90]"}) == {"H": "right"}
    assert verdicts(REDUCED, {"F": "[-10]", "H": "[-180]"}) == {"F": "right", "H": "right"}
    wrong_size = {"F": "[-10 0; 0 1]", "G": "[2]", "H": "[-180]"}
    assert verdicts(REDUCED, wrong_size) == dict.fromkeys("FGH", "wrong")
    unobservable = REDUCED.replace("[0 1; 0 -1]", "[1 0; 0 2]")
    parts = {part.letter: part.reason for part in check(unobservable, {"L": "[1 2]"}).parts if part.given}
    assert parts == {"L": "L is 1x1 here, yours is 1x2"}


def test_an_observer_of_two_states_and_two_outputs_with_any_of_its_gains_is_right() -> None:
    """ż = -L z + P B u + H y is z for [-L I] x of two double integrators: P A + L P = [-L^2 0] = H C."""
    problem = 'task = "reduced_order_observer"\n[plant]\nA = "[0 0 1 0; 0 0 0 1; 0 0 0 0; 0 0 0 0]"\n'
    problem += 'B = "[0; 0; 1; 0]"\nC = "[1 0 0 0; 0 1 0 0]"\n[specification]\npoles = "-1, -2"\n'
    for gain in (sp.Matrix([[1, 7], [0, 2]]), sp.Matrix([[4, 3], [-2, -1]])):
        M = sp.eye(4)
        M[2:, :2] = gain
        answer = {"F": text(-gain), "G": "[1; 0]", "H": text(-(gain**2)), "M": text(M)}
        assert set(verdicts(problem, answer).values()) == {"right"}
        M[2, 0] += 1
        assert verdicts(problem, {"M": text(M)}) == {"M": "wrong"}
