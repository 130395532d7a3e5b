"""What a claim leaves open and what it does not: each test here fails if one comparison of the judgement is left out."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp

from symobs.checking import Checked, check
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO, S, text

EXAMPLES = ROOT / "worked_examples"

CANONICAL = (
    'task = "canonical_form"\n[plant]\nA = "[1 2; 3 4]"\nB = "[1; 1]"\nC = "[1 0]"\n[specification]\nkind = "{}"\n'
)
REDUCED = 'task = "reduced_order_observer"\n'
REDUCED += '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n[specification]\npoles = "-10"\n'
PARTS = 'task = "decomposition"\n[plant]\nA = "[-1 0; 0 -2]"\nB = "[1; 0]"\nC = "[1 1]"\n'
HIDDEN = 'task = "observer"\n[plant]\nA = "[1 0; 0 2]"\nC = "[1 0]"\n[specification]\npoles = "-1, -2"\n'


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


TURNED = "you gave T^-1: here the new state is T x"


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


@pytest.mark.parametrize(("kind", "left_out"), [("controllable", 'C = "[1 0]"\n'), ("observable", 'B = "[1; 1]"\n')])
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


def test_a_gain_where_there_is_none_is_wrong() -> None:
    for given, reason in (("[3; 0]", ""), ("[1 2]", "L is 2x1 here, yours is 1x2")):
        part = check(HIDDEN + '[marking]\nasked = ["observer.verdict"]\n', {"L": given, "verdict": "no"}).parts
        assert [(each.letter, each.verdict) for each in part] == [("verdict", "right"), ("L", "wrong")]
        assert reason in part[1].reason


def test_another_compensator_is_right_only_where_no_gain_is_given() -> None:
    a, b, c, d, e = sp.symbols("a b c d e")
    loop = sp.Poly(S * (S + 1) * (S**2 + d * S + e) + a * S**2 + b * S + c - (S + 2) ** 2 * (S + 10) ** 2, S)
    found = sp.solve([equation.subs(a, 5) for equation in loop.all_coeffs()], [b, c, d, e])
    F = f"(5 s^2 + {found[b]} s + {found[c]})/(s^2 + {found[d]} s + {found[e]})"
    assert verdicts(SERVO, {"F": F}) == {"F": "right"}
    assert verdicts(SERVO, {"F": F, "K": "[4 3]"})["F"] == "wrong"
    assert verdicts(SERVO, {"F": F, "L": "[19; 80]"})["F"] == "wrong"
    assert verdicts(SERVO, {"F": F, "L": "[19 81]"})["F"] == "wrong"
    for wrong in ("(5 s^3 + 1)/(s^2 + 1)", f"({F})*(s + 1)/(s + 1) + 1"):
        assert verdicts(SERVO, {"F": wrong})["F"] == "wrong"
    # one more pole and zero: (s + 3) in both loops, of order 3
    assert verdicts(SERVO, {"F": "(638 s + 800)/(2 s^2 + 46 s + 322)"})["F"] == "right"


def test_minus_F_is_right_only_where_the_file_says_so() -> None:
    opposite = {"F": "-(319 s + 400)/(s^2 + 23 s + 161)", "K": "[4 3]", "L": "[19; 81]"}
    assert verdicts(SERVO, opposite)["F"] == "wrong"
    assert verdicts(SERVO + '[marking]\nsign_of_F = "either"\n', opposite)["F"] == "right"
    either = SERVO + '[marking]\nsign_of_F = "either"\n'
    assert verdicts(either, {"K": "[-4 -3]", "L": "[19; 81]"})["K"] == "wrong"


REGION = (
    'task = "stability_region"\n[specification]\npolynomial = "s^3 + s^2 + 3 s + h"\nparameters = "h"\n'  # 0 < h < 3
)


@pytest.mark.parametrize(
    ("conditions", "verdict"),
    [
        ("(h > 0) and (h < 3)", "right"),
        ("((h > 0) and (3 - h > 0))", "right"),
        ("(0 < h < 3)", "right"),
        ("1/h >= 0 and h < 3", "right"),
        ("h >= 0 and h < 3", "wrong"),
        ("h/(3 - h) > 0", "right"),
        ("h (3 - h) >= 0 and h != 0 and 3 != h", "right"),
    ],
)
def test_what_conditions_say_at_their_boundary(conditions: str, verdict: str) -> None:
    assert verdicts(REGION, {"stable_if": conditions})["stable_if"] == verdict


@pytest.mark.parametrize(
    ("conditions", "verdict"),
    [
        ("h < 3", "right"),
        ("h >= 0 and h < 3", "right"),
        ("h > 0 and h < 3", "right"),
        ("h <= 3", "wrong"),
        ("h < 4", "wrong"),
    ],
)
def test_a_declared_sign_leaves_out_its_boundary(conditions: str, verdict: str) -> None:
    positive = REGION.replace("[specification]", '[symbols]\nh = "positive"\n[specification]')
    assert verdicts(positive, {"stable_if": conditions})["stable_if"] == verdict


def test_columns_of_a_block_may_be_permuted_and_others_not() -> None:
    problem = 'task = "controllability"\n[plant]\nA = "[0 1; 0 0]"\nB = "[0 1; 1 2]"\n'
    problem += '[marking]\nasked = ["controllability.matrix"]\n'
    # [B AB] = [0 1 1 2; 1 2 0 0]
    for matrix, verdict in (
        ("[0 1 1 2; 1 2 0 0]", "right"),
        ("[1 0 2 1; 2 1 0 0]", "right"),
        ("[1 2 0 1; 0 0 1 2]", "wrong"),
        ("[1 0 2 1; 2 1 0 1]", "wrong"),
    ):
        assert verdicts(problem, {"matrix": matrix}) == {"matrix": verdict}


@pytest.mark.parametrize(
    ("given", "verdict"),
    [
        ("yes", "right"),
        (' "Yes" ', "right"),
        ("no", "wrong"),
        ("yes!", "unreadable"),
        ("ja", "right"),
        (False, "wrong"),
    ],
)
def test_a_verdict_is_a_word(given: object, verdict: str) -> None:
    problem = 'task = "detectability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    assert verdicts(problem, {"verdict": given}) == {"verdict": verdict}


def test_a_closed_loop_is_right_in_either_coordinates() -> None:
    """(x, x − x̂) and (x, x̂) of the servo with K = [4 3] and L = [19; 81]."""
    A, B, C = sp.Matrix([[0, 1], [0, -1]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]])
    K, L = sp.Matrix([[4, 3]]), sp.Matrix([19, 81])
    error = sp.Matrix(sp.BlockMatrix([[A - B * K, B * K], [sp.zeros(2), A - L * C]]))
    estimate = sp.Matrix(sp.BlockMatrix([[A, -B * K], [L * C, A - B * K - L * C]]))
    asked = SERVO + '[marking]\nasked = ["compensator.closed_loop_matrix"]\n'
    for matrix, verdict in ((error, "right"), (estimate, "right"), (error.T, "wrong"), (2 * error, "wrong")):
        assert verdicts(asked, {"closed_loop_matrix": text(matrix)}) == {"closed_loop_matrix": verdict}


def test_sizes_are_four_numbers_in_order() -> None:
    for sizes, verdict in (([1, 0, 1, 0], "right"), ([1, 1, 0, 0], "wrong"), ([1, 0, 1], "wrong")):
        assert verdicts(PARTS, {"T": "[1 0; 0 1]", "sizes": sizes})["sizes"] in {verdict, "unreadable"} - {"right"} | {
            verdict
        }


@pytest.mark.parametrize(
    ("given", "verdict"),
    [
        ("[x10; x20]", "right"),
        ("[x10 x20]", "right"),
        ("{x10, x20}", "right"),
        ("[x20; x10]", "wrong"),
        ("[x10]", "wrong"),
    ],
)
def test_a_text_writes_a_list_in_brackets(given: str, verdict: str) -> None:
    problem = (EXAMPLES / "servo_initial_state.toml").read_text(encoding="utf-8")
    report = Checked.of(problem).report(f"x0 = {given}\n")
    assert [part.verdict for part in report.parts] == [verdict]
    assert report.lines == ()  # x0 is an answer here, and no letter of the derivation


def test_sizes_in_a_text_and_matrices_that_are_none() -> None:
    problem = (EXAMPLES / "four_parts.toml").read_text(encoding="utf-8")
    report = Checked.of(problem).report("sizes = [1 1 1 1]\nT = [1 0; 0 1]\n")
    found = {part.letter: (part.verdict, part.reason) for part in report.parts if part.given}
    assert found == {"sizes": ("right", ""), "T": ("wrong", "T is 4x4 here, yours is 2x2")}
    (part,) = (part for part in Checked.of(problem).report({"T": [[1] * 4] * 4}).parts if part.given)
    assert (part.verdict, part.reason) == ("wrong", "T has no inverse")


def test_parts_of_one_letter_are_told_apart() -> None:
    problem = 'tasks = ["observability", "controllability"]\n[plant]\nA = "[0 1; 0 0]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    report = check(problem, {"observability": {"rank": 1}, "controllability": {"rank": 2}})
    for written in (report.to_text(), report.to_markdown(), report.to_html()):
        assert all(f"{task}.rank" in written.replace("\\", "") for task in ("observability", "controllability"))


def test_what_is_said_of_a_gain_and_which_claim_was_tried() -> None:
    checked = Checked.of(SERVO)
    (claim, holds, how), *_ = checked.report({"L": "[19; 80]"}).certificates
    assert (claim.startswith("det("), holds, how) == (True, False, "exact")
    assert [holds for _, holds, _ in checked.report({"L": "[19; 81]", "K": "[4 3]"}).certificates] == [True, True]
    assert checked.report({"L": "[a b; c d]"}).parts[1].reason.count("is not declared") == 3
    assert checked.report({"F": "1/s"}).parts[2].reason == ""
    assert checked.report({"F": "1/s", "K": "[4 3]"}).parts[2].reason == "this is not the F of your gains"
    assert checked.report({"F": "1/s"}).parts[2].slip is None


def test_a_gain_that_is_right_on_a_smaller_domain_says_where_it_is_not() -> None:
    problem = 'task = "observer"\n[symbols]\nalpha = "real"\n[plant]\nA = "[0 alpha; 0 0]"\nC = "[1 0; 0 1]"\n'
    checked = Checked.of(problem + '[specification]\npoles = "-1, -2"\n')
    (part,) = checked.report({"L": "[1 alpha-1/alpha; 0 2]"}).parts
    assert (part.verdict, part.hints) == ("right", ("not defined where alpha = 0",))
    assert checked.report({"L": "[1 alpha-1; 0 2]"}).parts[0].hints == ()
    reason = checked.report({"L": "[1 alpa; 0 2]"}).parts[0].reason
    assert reason.endswith('; did you mean "alpha"? write it with the letters known here: alpha')


def test_what_follows_in_the_other_coordinates_says_so() -> None:
    """[A, -BK; LC, A - BK - LC] of the servo with K = [4 3] and the wrong L = [19; 80]."""
    asked = Checked.of(SERVO + '[marking]\nasked = ["compensator.closed_loop_matrix_estimate"]\n')
    estimate = "[0 1 0 0; 0 -1 -4 -3; 19 0 -19 1; 80 0 -84 -4]"
    error = "[0 1 0 0; -4 -4 4 3; 0 0 -19 1; 0 0 -80 -1]"
    for matrix, hints in ((estimate, ()), (error, ("in the state and the error",))):
        part = asked.report({"K": "[4 3]", "L": "[19; 80]", "closed_loop_matrix_estimate": matrix}).parts[0]
        assert (part.verdict, part.hints, part.origins) == ("follows", hints, ("compensator.L",))


def test_what_does_not_exist_is_wrong_in_any_form() -> None:
    problem = 'task = "compensator"\n[plant]\nA = "[1 0; 0 2]"\nB = "[1; 1]"\nC = "[1 0]"\n'
    problem += '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-1, -2"\n'
    parts = {part.letter: part for part in check(problem, {"F": "1/s", "L": ["3", "0"]}).parts}
    assert (parts["F"].verdict, parts["F"].reason) == ("wrong", "there is no F here")
    assert (parts["L"].verdict, "yours is" in parts["L"].reason) == ("wrong", False)


FEEDFORWARD = 'task = "feedforward"\n[plant]\nA = "[0 0; 0 0]"\nB = "[1 0; 0 1]"\nC = "[1 0; 0 1]"\n'
FEEDFORWARD += '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-3, -4"\n'


def test_a_feedforward_belongs_to_its_feedback() -> None:
    """G(0) = C (BK - A)^-1 B: 1/4 of the servo with K = [4 3], K^-1 of two integrators."""
    servo = Checked.of((EXAMPLES / "servo_feedforward.toml").read_text(encoding="utf-8"))
    for answer, expected in (
        ({"F": "4"}, ["right"]),
        ({"F": "5"}, ["wrong"]),
        ({"F": "5", "K": "[5 3]"}, ["follows", "wrong"]),
        ({"F": "4", "K": "[-4 -3]"}, ["right", "wrong"]),
    ):
        parts = [part for part in servo.report(answer).parts if part.given]
        assert [part.verdict for part in parts] == expected
    assert (parts[1].slip, parts[1].effect["stable"]) == ("sign", "no")
    for F, verdict in (("[1 0; 0 2]", "right"), ("[1 0; 0 3]", "wrong"), ("[2 0; 0 1]", "wrong")):
        assert verdicts(FEEDFORWARD, {"K": "[1 0; 0 2]", "F": F}) == {"K": "right", "F": verdict}


def test_tracking_does_not_depend_on_a_wrong_gain() -> None:
    problem = Checked.of((EXAMPLES / "servo_tracking.toml").read_text(encoding="utf-8"))
    for K_d, verdict in (("[omega^2 -1]", "right"), ("[omega^2 1]", "wrong")):
        parts = {part.letter: part for part in problem.report({"K": "[5 3]", "L": "[-9]", "K_d": K_d}).parts}
        assert (parts["K_d"].verdict, parts["K"].verdict, parts["L"].slip) == (verdict, "wrong", "sign")
    given = {"K": "[5 3]", "error_matrix": "[0 1 0; -5 -4 -3; 0 0 -10]"}
    assert {part.letter: part.verdict for part in problem.report(given).parts}["error_matrix"] == "follows"


def test_a_chain_of_vectors_may_be_scaled_as_a_whole() -> None:
    """χ = (s + 1)³ in companion form: one block of order 3, T of which was multiplied by 5."""
    problem = CANONICAL.format("modal").replace('"[1 2; 3 4]"', '"[0 1 0; 0 0 1; -1 -3 -3]"')
    problem = problem.replace('"[1; 1]"', '"[0; 0; 1]"').replace('"[1 0]"', '"[1 0 0]"')
    plant = sp.Matrix([[0, 1, 0], [0, 0, 1], [-1, -3, -3]]), sp.Matrix([0, 0, 1]), sp.Matrix([[1, 0, 0]])
    chain = sp.Matrix([[1, 1, 1], [-1, 0, 0], [1, -1, 0]])  # (A + I) v1 = 0, (A + I) v2 = v1, (A + I) v3 = v2
    assert set(verdicts(problem, moved(5 * chain.inv(), *plant)).values()) == {"right"}
    assert verdicts(problem, moved(sp.diag(1, 2, 1), *plant))["T"] == "wrong"


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
