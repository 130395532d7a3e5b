"""Decimals of answers: their digits are right, and the loop of a rounded gain is stable; exceptions belong to a rank."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

from mpmath import matrix, mp, mpf, sqrt

from symobs.applications.checking import Checked
from symobs.problem import read
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.tasks.result import render
from tests.kit import tabled

#: K = 1/5 + √(1/25 + 1/100); [√2, √(2 √2)]; one gain without square roots, of which SciPy gives the third row.
PROBLEMS = {
    "first": ('A = "1/5"\nB = "1"', 'Q = "1/100"\nR = "1"'),
    "double": ('A = "[0 1; 0 0]"\nB = "[0; 1]"', 'Q = "[2 0; 0 0]"\nR = "1"'),
    "third": ('A = "[0 1 0; 0 0 1; 1 2 3]"\nB = "[0; 0; 1]"', 'Q = "[1 0 0; 0 1 0; 0 0 1]"\nR = "1"'),
}


@cache
def checked(name: str, marking: str) -> Checked:
    plant, specification = PROBLEMS[name]
    return Checked.of(f'task = "lqr"\n[plant]\n{plant}\n[specification]\n{specification}\n[marking]\n{marking}\n')


@tabled
def test_a_rounded_gain_is_right_to_its_digits(name: str, digits: int, answer: str, verdict: str) -> None:
    marking = 'decimals = "accept"' + (f"\ndigits = {digits}" if digits else "")
    (part,) = checked(name, marking).report(f"K = {answer}").parts
    assert part.verdict == verdict


#: Routh: 2 (5 − k²) > 4, so that |k| < √3 = 1.7320508…; 2 (5 − k³ + k) > 4, so that k < 1.6716998…, the root of k³ − k − 3;
#: 4 k > 1; s² − s − 1 has the roots (1 ± √5)/2 = 1.6180339…, −0.6180339…; those of s³ − s − 3 are 1.6716998… and
#: −0.8358499… ± 1.0468693… i.
WITH_ENDS = {
    "square": 'task = "stability_region"\n[specification]\npolynomial = "s^3 + 2 s^2 + (5 - k^2) s + 4"\nparameters = "k"\n',
    "cubic": 'task = "stability_region"\n[specification]\npolynomial = "s^3 + 2 s^2 + (5 - k^3 + k) s + 4"\n'
    'parameters = "k"\n',
    "third": 'task = "stability_region"\n[specification]\npolynomial = "s^3 + 3 s^2 + k s + 1"\nparameters = "k"\n',
    "golden": 'task = "transfer_function"\n[plant]\nA = "[0 1; 1 1]"\nB = "[0; 1]"\nC = "[1 0]"\n',
    "roots": 'task = "characteristic_polynomial"\n[plant]\nA = "[0 1 0; 0 0 1; 3 1 0]"\n',
}
_ASKED = {"golden": "transfer_function.poles", "roots": "characteristic_polynomial.roots"}


@cache
def ending(name: str, marking: str) -> Checked:
    asked = f'asked = ["{_ASKED[name]}"]\n' if name in _ASKED else ""
    return Checked.of(f"{WITH_ENDS[name]}[marking]\n{asked}{marking}\n")


@tabled
def test_irrational_ends_and_poles_are_right_in_their_digits(
    name: str, digits: int, answer: str, accepted: str, exactly: str
) -> None:
    told = f"\ndigits = {digits}" if digits else ""
    part, *others = ending(name, f'decimals = "accept"{told}').report(answer).parts
    assert (part.verdict, others) == (accepted, [])
    (part,) = ending(name, "").report(answer).parts
    assert (part.verdict, part.slip or "") == (
        "right" if exactly == "right" else "wrong",
        exactly if exactly != "right" else "",
    )
    assert ("rounded" in part.reason) is (exactly == "rounded")


@tabled
def test_lines_with_rounded_ends_and_poles(name: str, answer: str, verdicts: list[str]) -> None:
    found = [ending(name, marking).report(answer).lines for marking in ('decimals = "accept"', "")]
    assert [line.verdict for lines in found for line in lines] == verdicts


def digits_by_newton(places: int) -> list[str]:
    """The gain of the third problem from Kleinman's iteration, in mpmath: Lyapunov's equations of the loop in turn."""
    mp.dps = places + 20
    A, B = matrix([[0, 1, 0], [0, 0, 1], [1, 2, 3]]), matrix([0, 0, 1])
    K = matrix([[mpf("2.4"), mpf("5.5"), mpf("7.6")]])
    entries = [(i, j) for i in range(3) for j in range(i, 3)]
    for _ in range(9):
        loop, weight = A - B * K, mp.eye(3) + K.T * K
        table, right = matrix(6, 6), matrix(6, 1)
        for row, (i, j) in enumerate(entries):
            right[row] = -weight[i, j]
            for k in range(3):
                table[row, entries.index((min(k, j), max(k, j)))] += loop[k, i]
                table[row, entries.index((min(i, k), max(i, k)))] += loop[k, j]
        P = mp.lu_solve(table, right)
        K = matrix([[P[entries.index((i, 2))] for i in range(3)]])
    assert (
        abs(K[0] - 1 - sqrt(2)) < mpf(10) ** -places
    )  # of P A + A' P - p p' + Q = 0 the entry (1, 1) is 2 K1 - K1^2 + 1
    return [mp.nstr(entry, places) for entry in K]


def test_as_many_digits_are_computed_as_are_given() -> None:
    for places in (5, 16, 20, 60):
        right = digits_by_newton(places)
        last = right[1]
        wrong = [right[0], last[:-1] + str((int(last[-1]) + 5) % 10), right[2]]
        for marking in ("", 'decimals = "accept"'):
            verdicts = [
                checked("third", marking).report({"K": f"[{', '.join(each)}]"}).verdict for each in (right, wrong)
            ]
            assert verdicts == ["right", "right" if places == 16 else "wrong"]  # the last of sixteen is no claim
        solved = checked("third", "")
        expected = [
            mismatches(solved.problem.viewed(solved.results), {"K": f"[{', '.join(each)}]"}) for each in (right, wrong)
        ]
        assert [bool(lines) for lines in expected] == [False, True]


def test_the_loop_of_a_rounded_gain_is_stable() -> None:
    """s − 1000 + K with the pole −1/10000: K = 1000.0001, and 1000.000 leaves the pole at 0."""
    text = 'task = "state_feedback"\n[plant]\nA = "1000"\nB = "1"\n[specification]\npoles = "-1/10000"\n'
    marked = Checked.of(f'{text}[marking]\ndecimals = "accept"\n')
    assert marked.report("K = 1000.000").verdict == "wrong"
    assert marked.report("K = 1000.0001").verdict == "right"


@tabled
def test_exceptions_belong_to_what_is_asked(answer: str, score: str) -> None:
    """A = [0 1; −2 −3], C = [1 a]: det O = (1 − a)(1 − 2 a)."""
    text = 'task = "observability"\n[symbols]\na = "real"\n[plant]\nA = "[0 1; -2 -3]"\nC = "[1 a]"\n'
    assert Checked.of(f"{text}[marking]\ntotal = 2").report(answer).score == Fraction(score)


def test_conditions_of_the_plant_may_go_unsaid() -> None:
    """B = [1; a]/m: det C = −(a + 1)(a + 2)/m²."""
    text = (
        'task = "controllability"\n[symbols]\nm = "real"\na = "real"\n[plant]\nA = "[0 1; -2 -3]"\nB = "[1/m; a/m]"\n'
    )
    report = Checked.of(text).report("rank = 2 where (a + 1) (a + 2) != 0")
    assert report.verdict == "right"
    assert Checked.of(text).report("rank = 2 where m != 0 and a != -1, -2").verdict == "right"


def test_a_question_asks_for_the_exceptions() -> None:
    asked = 'task = "{}"\n{}[plant]\nA = "[0 1; -2 -3]"\n{} = "{}"\n'
    for task, name, value in (("observability", "C", "[1 a]"), ("controllability", "B", "[1; a]")):
        told = render(question_of(read(asked.format(task, '[symbols]\na = "real"\n', name, value))), "text")
        assert "for which it is no" in " ".join(str(told).split())
        numbers = render(question_of(read(asked.format(task, "", name, value.replace("a", "2")))), "text")
        assert "for which it is no" not in " ".join(str(numbers).split())
