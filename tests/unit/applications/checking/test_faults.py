"""Slips: each planted one is found by its name, and no other answer is explained by what does not reproduce it."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
import sympy as sp

from symobs.applications.checking import Checked, check
from symobs.formula.expression import parse_scalar
from tests.kit import tabled
from tests.support.problems.answered import (
    CONTROL,
    OBSERVER,
    THIRD_ORDER,
    A,
    B,
    C,
    F,
    K,
    L,
    S,
    feedback_gain,
    observer_gain,
    polynomial,
    text,
)

PHI, CHI = polynomial(OBSERVER), sp.Poly(A.charpoly(S).as_expr(), S)
DELTA = sp.Poly(PHI.as_expr() - CHI.as_expr(), S).all_coeffs()
SEEN = sp.Matrix.vstack(C, C * A, C * A**2)
#: x̄ = T x with the coefficients in the last column: H 𝒪, H the Hankel matrix of χ.
T = sp.Matrix([[CHI.all_coeffs()[2], CHI.all_coeffs()[1], 1], [CHI.all_coeffs()[1], 1, 0], [1, 0, 0]]) * SEEN
CANONICAL = sp.Matrix(list(reversed(DELTA)))
CHECKED = Checked.of(THIRD_ORDER)


def gain(phi: sp.Expr, A: sp.Matrix = A, C: sp.Matrix = C) -> sp.Matrix:
    """The observer gain for a polynomial of order 3."""
    return observer_gain(A, C, sp.Poly(phi, S))


MISREAD = sp.Matrix([[1, -2, 0], [0, -1, 3], [1, 0, 2]])
GAINS = {
    "sign": -L,
    "transposed": L.T,
    "entry": L + sp.Matrix([0, 1, 0]),
    "other_half": gain(polynomial(CONTROL).as_expr()),
    "mirrored": gain(polynomial((5, 6, 7)).as_expr()),
    "pole_repeated": gain(polynomial((-5, -6, -6)).as_expr()),
    "pole_dropped": gain(polynomial((-5, -6, 0)).as_expr()),
    "one_coefficient": gain(PHI.as_expr() + S),
    "not_subtracted": gain(CHI.as_expr() + PHI.as_expr() - S**3),
    "reversed": gain(CHI.as_expr() + sum(c * S**k for k, c in enumerate(DELTA))),
    "dual_untransposed": gain(PHI.as_expr(), A.T),
    "other_matrix": gain(PHI.as_expr(), A, B.T),
    "entry_misread": gain(PHI.as_expr(), MISREAD),
    "not_transformed": CANONICAL,
    "wrong_direction": T * CANONICAL,
    "factor": L / 10,
    "exchanged": sp.Matrix([L[2], L[1], L[0]]),
    "sign_entries": sp.Matrix([-L[0], L[1], -L[2]]),
}
RESOLVENT = S * sp.eye(3) - A
COMPENSATORS = {
    "sign_convention": -F,
    "no_observer": (K * (RESOLVENT + B * K).inv() * L)[0],
    "no_feedback": (K * (RESOLVENT + L * C).inv() * L)[0],
    "positive_feedback": (K * (RESOLVENT - B * K + L * C).inv() * L)[0],
    "sign_of_one": (K * (RESOLVENT + B * K - L * C).inv() * L)[0],
    "one_coefficient": F + S / sp.fraction(F)[1],
}
CREDITS = {"sign": Fraction(1, 2), "transposed": Fraction(1, 2), "entry": Fraction(1, 2), "other_half": Fraction(1, 4)}


@pytest.mark.parametrize("slip", GAINS)
def test_a_planted_slip_of_a_gain_is_found(slip: str) -> None:
    (part,) = [part for part in CHECKED.report({"L": text(GAINS[slip])}).parts if part.part == "compensator.L"]
    assert (part.verdict, part.slip) == ("wrong", slip)
    assert part.credit == CREDITS.get(slip, 0)
    if slip != "transposed":
        closed = (A - GAINS[slip] * C).charpoly(S).as_expr()
        assert parse_scalar(part.effect["polynomial"], {}, variable="s") == parse_scalar(str(closed), {}, variable="s")


@pytest.mark.parametrize("slip", COMPENSATORS)
def test_a_planted_slip_of_a_compensator_is_found(slip: str) -> None:
    answer = {"K": text(K), "L": text(L), "F": str(sp.cancel(COMPENSATORS[slip]))}
    part = CHECKED.report(answer).parts[2]
    assert (part.verdict, part.slip) == ("wrong", slip)


@tabled
def test_products_in_the_wrong_order_are_found(left: bool, reason: str) -> None:  # noqa: FBT001 - a table
    """With as many inputs and outputs as states, K B and C L have the sizes of B K and L C."""
    A, B, C = sp.Matrix([[0, 1], [2, 3]]), sp.Matrix([[1, 2], [0, 1]]), sp.Matrix([[1, 0], [3, 1]])
    K = B.inv() * (A - sp.Matrix([[-1, 1], [0, -2]]))
    L = (A - sp.Matrix([[-5, 0], [2, -6]])) * C.inv()
    problem = f'task = "compensator"\n[plant]\nA = "{text(A)}"\nB = "{text(B)}"\nC = "{text(C)}"\n'
    problem += '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-5, -6"\n'
    BK, LC = (K * B, L * C) if left else (B * K, C * L)
    wrong = (K * (S * sp.eye(2) - A + BK + LC).inv() * L).applyfunc(sp.cancel)
    rows = [[str(entry) for entry in wrong.row(i)] for i in range(2)]
    part = check(problem, {"K": text(K), "L": text(L), "F": rows}).parts[2]
    assert (part.verdict, part.slip, part.reason) == ("wrong", "order_of_products", reason)


@pytest.mark.parametrize(
    ("matrix", "slip"),
    [
        ("[0 -1; 1 0]", None),
        ("[-1 0; 0 -1]", "sign"),
        ("[1 0; 0 3]", "entry"),
        ("[2 0; 0 2]", "factor"),
        ("[0 1; 1 0]", "exchanged"),
    ],
)
def test_slips_of_the_only_right_matrix(matrix: str, slip: str | None) -> None:
    problem = (
        'task = "observability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n[marking]\nasked = ["observability.matrix"]\n'
    )
    assert check(problem, {"matrix": matrix}).parts[0].slip == slip


def test_several_signs_the_transpose_and_a_special_value() -> None:
    problem = 'task = "observability"\n[symbols]\na = "positive"\n[plant]\nA = "[0 a; 2 3]"\nC = "[1 1]"\n'
    problem += '[marking]\nasked = ["observability.matrix"]\n'
    right = sp.Matrix([[1, 1], [2, sp.Symbol("a") + 3]])
    for matrix, slip in (
        (sp.Matrix([[-1, 1], [-2, right[1, 1]]]), "sign_entries"),
        (right.T, "transposed"),
        (right.subs("a", 1), "entry"),
        (sp.simplify(right.inv()), "inverse"),
    ):
        assert check(problem, {"matrix": text(matrix).replace(" + ", "+")}).parts[0].slip == slip
    every = 'task = "characteristic_polynomial"\n[symbols]\na = "real"\nb = "real"\n[plant]\nA = "[a 0; 0 b]"\n'
    assert check(every, {"polynomial": "(s - 1)^2"}).parts[0].slip == "specialised"


def explained_truly(slip: str, value: sp.Matrix, part: object) -> bool:
    """Whether a slip reproduces a gain, computed without symobs."""
    mine = sp.Poly((A - value * C).charpoly(S).as_expr(), S)
    if slip == "entry":
        i, j = (number - 1 for number in part.place)  # type: ignore[attr-defined]
        t = sp.Symbol("t")
        changed = value.as_mutable()
        changed[i, j] = t
        equations = sp.Poly((A - changed * C).charpoly(S).as_expr() - PHI.as_expr(), S).all_coeffs()
        return bool(sp.solve(equations, [t]))
    if slip == "one_coefficient":
        return bool(sum(a != b for a, b in zip(mine.all_coeffs(), PHI.all_coeffs(), strict=True)) == 1)
    alike = {
        "factor": value * L[0] == L * value[0],
        "exchanged": sorted(value) == sorted(L),
        "sign_entries": value.applyfunc(abs) == L.applyfunc(abs),
    }
    return bool(alike.get(slip, value == GAINS.get(slip)))


def hold(count: int, seed: int) -> tuple[int, int]:
    """How many of random wrong gains are explained, and how many of these falsely."""
    generator = random.Random(seed)  # noqa: S311 - repeatable by design
    explained = false = 0
    for _ in range(count):
        value = sp.Matrix([generator.randint(-60, 60) for _ in range(3)])
        if generator.random() < 0.3:
            value = L + sp.Matrix([generator.choice([-2, -1, 0, 0, 0, 1]) for _ in range(3)])
        (part,) = [part for part in CHECKED.report({"L": text(value)}).parts if part.part == "compensator.L"]
        if part.verdict == "right":
            assert value == L
        elif part.slip is not None:
            explained += 1
            false += not explained_truly(part.slip, value, part)
    return explained, false


def test_no_random_gain_is_explained_falsely() -> None:
    explained, false = hold(150, 5)
    assert explained > 5
    assert false == 0


@tabled
def test_the_dual_slips_of_a_feedback_gain_are_found(slip: str) -> None:
    wrong = {
        "sign": -K,
        "mirrored": feedback_gain(A, B, polynomial((1, 2, 4))),
        "entry_misread": feedback_gain(sp.Matrix([[1, 2, 0], [0, 1, 3], [1, 0, 2]]), B, polynomial(CONTROL)),
        "other_matrix": feedback_gain(A, C.T, polynomial(CONTROL)),
        "other_half": feedback_gain(A, B, polynomial(OBSERVER)),
    }[slip]
    report = CHECKED.report({"K": text(wrong)})
    part = report.parts[0]
    assert part.slip == slip
    assert report.bounded("place").parts[0].place is None  # the place of what was misread is one of A
    assert slip != "entry_misread" or (part.place, part.reason) == (
        [2, 2],
        "entry (2,2) of A is taken with the other sign",
    )


def test_a_gain_rounded_is_named_so() -> None:
    problem = 'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[3 0]"\n[specification]\npoles = "-10, -10"\n'
    part = check(problem, {"L": "[6.333; 27]"}).parts[0]
    assert (part.slip, part.credit) == ("rounded", Fraction(1, 2))


def test_a_forgotten_feedthrough_is_found() -> None:
    problem = 'task = "compensator"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\nD = "[2]"\n'
    problem += '[specification]\ncontrol_poles = "-2, -2"\nobserver_poles = "-10, -10"\n'
    A, B, C, K, L = (
        sp.Matrix([[0, 1], [0, -1]]),
        sp.Matrix([0, 1]),
        sp.Matrix([[1, 0]]),
        sp.Matrix([[4, 3]]),
        sp.Matrix([19, 81]),
    )
    forgotten = (K * (S * sp.eye(2) - A + B * K + L * C).inv() * L)[0]
    part = check(problem, {"K": text(K), "L": text(L), "F": str(sp.cancel(forgotten))}).parts[2]
    assert part.slip == "forgot_D"
