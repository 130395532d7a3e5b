"""The grader of exported questions, line by line: verdict, slip, reason and credit worked out by hand or by SymPy."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import sympy as sp

from symobs.applications.grader import claims
from symobs.applications.grader.claims import judge
from symobs.applications.grader.values import ONE, number, points, poly
from tests.kit import tabled, tables

if TYPE_CHECKING:
    import pytest

S = sp.Symbol("s")
MARKS: dict[str, Any] = tables(Path(__file__))["marks"]
PLANT = tables(Path(__file__))["plant"]


def gain(
    name: str, A: list[list[str]], C: list[list[str]], phi: str, right: list[list[str]], **more: Any
) -> dict[str, Any]:
    """A gain as an export describes it."""
    usual = {
        "name": name,
        "part": f"compensator.{name}",
        "letter": name,
        "weight": "1",
        "function": False,
        "variable": "s",
    }
    usual |= {
        "kind": "gain",
        "A": A,
        "C": C,
        "phi": phi.split(),
        "right": right,
        "zero": [],
        "turned": False,
        "other": None,
    }
    return {**usual, "transposed": name == "K", **more}


# A − LC = [-a 1; -b -1] has s² + (a + 1) s + a + b;  A − BK = [0 1; -a -b-1] has s² + (b + 1) s + a
OBSERVER = gain("L", PLANT["A"], PLANT["C"], "1 20 100", [["19"], ["81"]], other=["1", "4", "4"])
FEEDBACK = gain("K", [["0", "0"], ["1", "-1"]], [["0", "1"]], "1 4 4", [["4", "3"]], other=["1", "20", "100"])
F = {"name": "F", "part": "compensator.F", "letter": "F", "weight": "2", "function": True, "variable": "s"}
F |= {"kind": "compensator", "order": 2, "phi": ["1", "24", "184", "480", "400"], **PLANT}
F |= {"right_K": [["4", "3"]], "right_L": [["19"], ["81"]]}
THIRDS = gain("L", PLANT["A"], [["3", "0"]], "1 20 100", [["19/3"], ["27"]])


def question(*parts: dict[str, Any], names: tuple[str, ...] = (), **marks: Any) -> dict[str, Any]:
    return {"names": list(names), "marks": {**MARKS, **marks}, "parts": list(parts)}


def outcome(asked: dict[str, Any], name: str, given: dict[str, Any]) -> Any:
    found = judge(asked, given)[name]
    return [found["verdict"], found["slip"], found["reason"], str(found["credit"])]


def rows(text: str) -> list[list[str]]:
    return [row.split() for row in text.split(";")]


# -- gains ------------------------------------------------------------------------------------------------------------


def other_polynomial(letter: str, polynomial: str) -> list[str]:
    return ["wrong", "", f"with your {letter} the polynomial is {polynomial}, not the one asked for", "0"]


@tabled
def test_what_is_said_of_a_gain(given: str, expected: list[str]) -> None:
    assert outcome(question(OBSERVER), "L", {"L": rows(given)}) == expected
    turned = {"turned": True, "letter": "M"}
    opposite = [[f"-({entry})" for entry in row] for row in rows(given)]
    verdict, slip, reason, credit = outcome(question({**OBSERVER, **turned}), "L", {"L": opposite})
    mirrored = expected[2].replace("of L", "of M").replace("your L", "your M").replace("should be 81", "should be -81")
    mirrored = f"M{mirrored[1:]}" if mirrored.startswith("L") else mirrored
    assert [verdict, slip, reason, credit] == [*expected[:2], mirrored, expected[3]]


def test_of_several_entries_that_may_be_mended_none_is_named() -> None:
    """Both outputs are the same: A − LC depends on the sums of the rows of L alone."""
    twins = gain("L", [["0", "1"], ["0", "0"]], [["1", "0"], ["1", "0"]], "1 3 2", [["3", "0"], ["2", "0"]])
    assert outcome(question(twins), "L", {"L": rows("1 2; 0 2")})[0] == "right"
    found = outcome(question(twins), "L", {"L": rows("1 1; 2 0")})
    assert found == ["wrong", "entry", "one of several slips in a single entry", "1/2"]


def test_what_does_not_tell_is_not_told() -> None:
    """One coefficient alone is no other half, and an entry without any effect is no slip."""
    near = {**OBSERVER, "other": ["1", "21", "100"]}
    assert outcome(question(near), "L", {"L": rows("20; 80")}) == other_polynomial("L", "s^2 + 21 s + 100")
    far = {**OBSERVER, "other": ["1", "21", "90"]}
    assert outcome(question(far), "L", {"L": rows("20; 70")})[1] == "other_half"
    harmless = gain("L", [["0", "1"], ["0", "0"]], [["1", "0"], ["0", "0"]], "1 3 2", [["3", "0"], ["2", "0"]])
    assert outcome(question(harmless), "L", {"L": rows("4 5; 9 7")}) == other_polynomial("L", "s^2 + 4 s + 9")


@tabled
def test_a_rounded_gain_is_named_so(given: str, rounds: bool) -> None:  # noqa: FBT001 - a table
    said = ["wrong", "rounded", "L is rounded, and its exact value is asked for", "1/3"]
    found = outcome(question(THIRDS), "L", {"L": rows(given)})
    assert (found == said) is rounds
    opposite = [[f"-{entry}" for entry in row] for row in rows(given)]
    assert (outcome(question({**THIRDS, "turned": True}), "L", {"L": opposite}) == said) is rounds
    assert outcome(question(THIRDS, decimals="accept"), "L", {"L": rows(given)})[0] == "wrong"
    assert rows(given) != [["6.5"], ["27"]]


# -- the compensator --------------------------------------------------------------------------------------------------


def function(K: tuple[str, str], L: tuple[str, str], D: int = 0) -> str:
    """K (sI − A + BK + LC − LDK)⁻¹ L, by SymPy."""
    A, B, C = sp.Matrix([[0, 1], [0, -1]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]])
    feedback, observer = sp.Matrix([list(map(sp.Rational, K))]), sp.Matrix(list(map(sp.Rational, L)))
    inner = S * sp.eye(2) - A + B * feedback + observer * C - observer * D * feedback
    return str(sp.cancel((feedback * inner.inv() * observer)[0]))


WHOLE = question(FEEDBACK, OBSERVER, F)
RIGHT = {"K": rows("4 3"), "L": rows("19; 81"), "F": [[function(("4", "3"), ("19", "81"))]]}


@cache
def another() -> str:
    """(5 s² + …)/(s² + …) with the same closed loop."""
    b, c, d, e = sp.symbols("b c d e")
    loop = sp.Poly(S * (S + 1) * (S**2 + d * S + e) + 5 * S**2 + b * S + c - (S + 2) ** 2 * (S + 10) ** 2, S)
    found = sp.solve(loop.all_coeffs(), [b, c, d, e])
    return f"(5 s^2 + ({found[b]}) s + ({found[c]}))/(s^2 + ({found[d]}) s + ({found[e]}))"


@tabled
def test_what_is_said_of_a_compensator(changed: dict[str, Any], expected: list[str]) -> None:
    given = {part: value for part, value in {**RIGHT, **changed}.items() if value}
    assert outcome(WHOLE, "F", given) == expected


def test_the_marks_of_a_compensator_are_those_of_the_file() -> None:
    easy = {**RIGHT, "L": rows("0; 7"), "F": [[function(("4", "3"), ("0", "7"))]]}
    unguarded = question(FEEDBACK, OBSERVER, F, guard=False)
    assert outcome(unguarded, "F", easy) == ["follows", "", "it follows from your earlier result", "3/4"]
    either = question(FEEDBACK, OBSERVER, F, sign_of_F="either")
    assert outcome(either, "F", {**RIGHT, "F": [[f"-({RIGHT['F'][0][0]})"]]}) == ["right", "", "", "1"]
    wrong = {**RIGHT, "L": rows("19; 80"), "F": [[f"-({function(('4', '3'), ('19', '80'))})"]]}
    assert outcome(either, "F", wrong)[0] == "follows"
    assert outcome(WHOLE, "F", wrong)[0] == "wrong"


def test_a_compensator_alone_is_held_to_the_closed_loop_and_its_order() -> None:
    """A mode that F does not reach stays: (s + 2) · ((s + 1)(s + 5) + 3) = (s + 2)² (s + 4)."""
    hidden = {"A": rows("-1 0; 0 -2"), "B": rows("1; 0"), "C": rows("1 0"), "phi": ["1", "8", "20", "16"]}
    asked = question({**F, **hidden, "right_K": rows("9 9"), "right_L": rows("9; 9")})
    said = ["right", "", "another compensator with the same closed-loop polynomial", "1"]
    assert outcome(asked, "F", {"F": [["3/(s + 5)"]]}) == said
    assert outcome(asked, "F", {"F": [["4/(s + 5)"]]})[0] == "wrong"
    for order, verdict in ((1, "right"), (0, "wrong")):
        bounded = question({**asked["parts"][0], "order": order})
        assert outcome(bounded, "F", {"F": [["3/(s + 5)"]]})[0] == verdict
    # 1/s closed by s is a loop of degree 1 too, but s is improper: s · 1 + 1 · s = 2 s is not monic, 1 + (s + 1) is
    integrator = {
        "A": rows("0"),
        "B": rows("1"),
        "C": rows("1"),
        "right_K": rows("9"),
        "right_L": rows("9"),
        "order": 1,
    }
    improper = question({**F, **integrator, "phi": ["2", "1"]})
    assert outcome(improper, "F", {"F": [["s + 1"]]})[0] == "wrong"


@tabled
def test_when_a_wrong_gain_makes_the_rest_easy(mine: str, right: str, easy: bool) -> None:  # noqa: FBT001 - a table
    read_as = ([[Fraction(cell) for cell in row] for row in rows(text)] for text in (mine, right))
    assert claims.is_degenerate(*read_as) is easy


# -- other values -----------------------------------------------------------------------------------------------------


def value(right: str, **more: Any) -> dict[str, Any]:
    usual = {"name": "M", "part": "gramian.matrix", "letter": "W", "weight": "1", "function": False, "variable": "s"}
    return {**usual, "kind": "value", "exact": False, "right": rows(right), **more}


@tabled
def test_what_is_said_of_a_value(right: str, given: str, expected: list[str]) -> None:
    assert outcome(question(value(right)), "M", {"M": rows(given)}) == expected


def test_functions_are_equal_as_functions() -> None:
    asked = question(value("1/(s^2+1)", function=True))
    for given, verdict in (("(s+1)/((s^2+1)*(s+1))", "right"), ("1/(s^2+2)", "wrong"), ("0.5", "wrong")):
        assert outcome(asked, "M", {"M": [[given]]})[0] == verdict
    asked["parts"][0]["variable"] = "z"
    asked["parts"][0]["right"] = [["z"]]
    assert outcome(asked, "M", {"M": [["z"]]})[0] == "right"
    assert outcome(asked, "M", {"M": [["s"]]})[2] == "s is not a letter of this question (z)"


@tabled
def test_a_word_is_right_or_wrong(given: str, means: str) -> None:
    word = {"name": "v", "part": "pbh.verdict", "letter": "verdict", "weight": "1", "function": False, "kind": "word"}
    for right in ("yes", "no", "conditional"):
        found = outcome(question({**word, "right": right}), "v", {"v": [[given]]})
        if means:
            assert found == ["right" if means == right else "wrong", "", "", str(int(means == right))]
        else:
            assert found == ["unreadable", "", "write yes, no or conditional", "0"]


# -- the whole answer -------------------------------------------------------------------------------------------------


def test_what_cannot_be_read_says_why_and_harms_no_other_part(monkeypatch: pytest.MonkeyPatch) -> None:
    found = judge(WHOLE, {**RIGHT, "L": [["19"], ["81", "1"]]})
    assert (found["K"]["verdict"], found["L"]["verdict"]) == ("right", "unreadable")
    assert (found["L"]["reason"], found["L"]["credit"]) == ("the rows have different lengths", 0)
    assert outcome(WHOLE, "L", {"L": [["19"], [""]]})[2] == "a value is missing"
    assert outcome(WHOLE, "L", {"L": [["19"], ["s"]]})[2] == "s is not a letter of this question"
    assert outcome(WHOLE, "F", {"F": [["1/x"]]})[2] == "x is not a letter of this question (s)"

    def broken(*_: object) -> None:
        raise KeyError("a bug")

    monkeypatch.setattr(claims, "judge_gain", broken)
    assert outcome(WHOLE, "L", RIGHT) == ["unreadable", "", "this could not be read", "0"]


def test_symbols_are_drawn_twice_and_both_must_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    """A − LC = [-a 1; -b 0] has s² + a s + b; p and q are asked for."""
    part = gain("L", rows("0 1; 0 0"), rows("1 0"), "1 p q", rows("p; q"), other=["1", "q", "p"])
    asked = question(part, names=("p", "q"))
    assert outcome(asked, "L", {"L": rows("p; q")}) == ["right", "", "", "1"]
    assert outcome(asked, "L", {"L": rows("p+q-q; 2*q/2")})[0] == "right"
    assert outcome(asked, "L", {"L": rows("p; 3")}) == ["wrong", "entry", "entry (2,1) is wrong", "1/2"]
    assert outcome(asked, "L", {"L": rows("q; p")})[1] == "other_half"
    wrong = "with your L the polynomial is not the one asked for"
    assert outcome(asked, "L", {"L": rows("2; 3")}) == ["wrong", "", wrong, "0"]
    fixed = [{"p": (poly([k]), ONE), "q": (poly([3]), ONE)} for k in (2, 5)]
    monkeypatch.setattr(claims, "points", lambda *_: fixed)
    assert outcome(asked, "L", {"L": rows("2; 3")}) == ["wrong", "", "", "0"]
    monkeypatch.setattr(claims, "points", lambda *_: fixed[:1])
    assert outcome(asked, "L", {"L": rows("2; 3")})[0] == "right"


def test_points_are_drawn_from_the_answer() -> None:
    asked = question(names=("p", "q"))
    first, second = points(asked, {"L": "1"})
    assert first != second
    assert first["p"] != first["q"]
    assert points(asked, {"L": "1"}) == [first, second]
    assert points(asked, {"L": "2"}) != [first, second]
    assert points({**asked, "parts": [F]}, {"L": "1"}) != [first, second]
    assert points(asked, {"K": "1", "L": "2"}) == points(asked, {"L": "2", "K": "1"})
    assert all(2 <= number(entry) < 2**60 + 2 for point in (first, second) for entry in point.values())
    assert points(question(), {"L": "1"}) == [{}]
