"""Pages of text handed in whole, and what they need: explained letters, cases, blanks as products, entries that count."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import pytest

from symobs.applications.checking import Checked
from symobs.applications.export.questions import exercises
from symobs.ground.errors import ProblemErrors
from symobs.tasks.result import render
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

#: Examples, whose answers are in [expect], and what their pages print in letters or numbers.
PAGES = {
    "lyapunov_oscillator": {"lyapunov.P"},  # with another P in a case
    "region_disconnected": {"stability_region.stable_if"},  # framed, and again in pieces
    "servo_minimal_order_feedthrough": {"compensator.K", "compensator.L", "compensator.F"},  # F beside F(s), and a case
    "sum_measured_minimal_observer": {f"reduced_order_observer.{letter}" for letter in "LFGH"},
    "tanks_initial_state": {"gramian.matrix"},  # W(1,1) = … below it
    "third_order_plant": {"transfer_function.transfer_function", "state_feedback.K"},
}
EXPONENTIAL = 'task = "matrix_exponential"\n[plant]\nA = "[0 1; 0 -1]"\n'
ROW = 'task = "state_feedback"\n[symbols]\na = "real"\n[plant]\nA = "[0 1; 0 0]"\nB = "[0; 1]"\n'
ROW += '[specification]\npolynomial = "s^2 + 2 a s + a^2"\n'


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("name", PAGES)
def test_a_whole_page_is_an_answer(name: str, language: str) -> None:
    checked = Checked.of((ROOT / "worked_examples" / f"{name}.toml").read_text("utf-8"))
    document = replace(checked.problem.document(checked.results), language=language)
    report = checked.report(str(render(document, "text")))
    verdicts = {part.part: part.verdict for part in report.parts}
    assert {part for part, verdict in verdicts.items() if verdict == "right"} >= PAGES[name]
    assert "wrong" not in verdicts.values()


@pytest.mark.parametrize(
    ("row", "verdict", "said"),
    [
        ("[a^2 2 a]", "right", ""),
        ("[a^2 3 a]", "wrong", ""),
        ("[a a a]", "unreadable", "write [a, a a] or [a a, a]"),
    ],
)
def test_blanks_are_products_where_the_size_says_so(row: str, verdict: str, said: str) -> None:
    (part,) = Checked.of(ROW).report(f"K = {row}").parts
    assert part.verdict == verdict
    assert said in part.reason


@pytest.mark.parametrize(
    ("value", "credit"), [("[1, 1 - exp(-t); 0, exp(t)]", Fraction(2, 3)), ("[0, 0; 0, 0]", Fraction(0))]
)
def test_right_entries_count_where_the_lecturer_says_so(value: str, credit: Fraction) -> None:
    # e^{At} = [1, 1 - e^{-t}; 0, e^{-t}]; its zero counts for nobody
    marking = "[marking]\ncredit = { entry = 0 }\n"
    for more, expected in (("by_entry = true\n", credit), ("", Fraction(0))):
        (part,) = Checked.of(f"{EXPONENTIAL}{marking}{more}").report({"matrix": value}).parts
        assert (part.verdict, part.credit) == ("wrong", expected)


def test_an_exported_question_does_not_credit_entries(tmp_path: Path) -> None:
    file = tmp_path / "problem.toml"
    file.write_text(f"{EXPONENTIAL}[marking]\nby_entry = true\n", "utf-8")
    with pytest.raises(ProblemErrors, match="does not credit entries"):
        list(exercises([str(file)]))


def test_whether_a_pair_is_observable_is_asked_beside_the_rank(tmp_path: Path) -> None:
    file = tmp_path / "problem.toml"
    file.write_text('task = "observability"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[0 1]"\n', "utf-8")
    (each,) = exercises([str(file)])
    assert [(part.part, part.right[0][0]) for part in each.first.parts] == [
        ("observability.verdict", "no"),
        ("observability.rank", 1),
    ]


def test_an_entry_of_a_function_of_time_is_not_told() -> None:
    (part,) = Checked.of(EXPONENTIAL).report({"matrix": "[1, 1 - exp(-t); 0, exp(t)]"}).parts
    assert (part.slip, part.reason) == ("entry", "entry (2, 2) is wrong")


@pytest.mark.parametrize(
    ("line", "verdict"),
    [("exp(A t) = [1, 1 - exp(-t); 0, exp(-t)]", "undecided"), ("x(0) = [1; 1]", "unreadable")],
)
def test_what_is_not_evaluated_is_not_false(line: str, verdict: str) -> None:
    plant = 'A = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    checked = Checked.of(f'task = "observer"\n[plant]\n{plant}[specification]\npoles = "-10, -10"\n')
    assert [each.verdict for each in checked.report(f"{line}\nL = [19; 81]").lines] == [verdict, "true"]


@pytest.mark.parametrize(
    ("letter", "display"),
    [
        (
            "L",
            (
                r"\text{hence}\qquad L=\begin{bmatrix}-\frac{80539}{49}\\-\frac{832340}{49}\\60\end{bmatrix}"
                r"\approx\begin{bmatrix}-1643.7\\-16987\\60\end{bmatrix}"
            ),
        ),
        ("K_d", r"\text{which is satisfied by}\qquad K_{\mathrm d}=\begin{bmatrix}0&0&0&0\end{bmatrix}"),
    ],
)
def test_words_and_decimals_beside_a_display_are_not_its_value(letter: str, display: str) -> None:
    checked = Checked.of((ROOT / "worked_examples" / "cart_tracking.toml").read_text("utf-8"))
    verdicts = {part.letter: part.verdict for part in checked.report(f"{display}\n").parts}
    assert verdicts[letter] == "right"


@pytest.mark.parametrize(("marking", "verdict"), [("", "wrong"), ('decimals = "accept"\ndigits = 4\n', "right")])
def test_a_value_after_about_is_a_rounded_one(marking: str, verdict: str) -> None:
    text = (ROOT / "worked_examples" / "cart_pendulum_feedback.toml").read_text("utf-8")
    report = Checked.of(f"{text}\n[marking]\n{marking}").report("K ≈ [-2.4490, -48.229, -15.102, -5.1020]\n")
    assert [part.verdict for part in report.parts if part.letter == "K"] == [verdict]
    assert report.lines == ()
