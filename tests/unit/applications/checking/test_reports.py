"""Reports: marks, formats, what is given away, and answers that cannot be read."""

from __future__ import annotations

import json
import pickle
import re
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

import symobs
from symobs.applications.audit.differences import EntryDifference, WrongTerm, reasons
from symobs.applications.checking import SHOW, Checked, CheckReport, check
from symobs.applications.checking.report import schema
from symobs.formula.expression import parse_matrix
from symobs.ground.errors import ProblemErrors, UsageError
from symobs.problem import read
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO, THIRD_ORDER, TWO_OUTPUTS, F, K, L, answers, lines

RIGHT = {"K": "[4 3]", "L": "[19; 81]", "F": "(319 s + 400)/(s^2 + 23 s + 161)"}
ANSWERS: list[Any] = [
    RIGHT,
    {"K": "[4 3"},
    {"K": "[4 4]", "L": "[-19; -81]", "F": "1/s"},
    {},
    "K = [4 3]\nL = [19; 80]\nA - L C = [-19 1; -80 -1]\ndet(s I - A) = s^2",
]
CHECKED = Checked.of(SERVO)
VALID = Draft202012Validator(schema())


@pytest.mark.parametrize("show", SHOW)
@pytest.mark.parametrize("answer", ANSWERS, ids=str)
def test_every_report_keeps_its_schema_and_its_width(answer: Any, show: str) -> None:
    report = CHECKED.report(answer, show)
    VALID.validate(json.loads(report.to_json()))
    assert max(map(len, report.to_text().split("\n"))) <= 100
    assert "\x1b" not in report.to_text()
    assert pickle.loads(pickle.dumps(report)) == report  # noqa: S301 - our own bytes
    for page in (report.to_markdown(), report.to_html()):
        assert report.verdict in page


# -- what is given away -----------------------------------------------------------------------------------------------


def _body(page: str) -> str:
    """A page without its styles, and without numbers in attributes."""
    return re.sub(r"<[a-z][^>]*>", lambda tag: tag[0].split()[0] + ">", page.rpartition("</style>")[2])


_POLYNOMIAL = re.compile(r"\bs\*\*|\bs\^[0-9]|<mn>[0-9]+</mn></msup>")


def _given_away(report: CheckReport, right: str, handed_in: str) -> list[str]:
    """The numbers of more than a digit of the right answers that a student did not write, and powers of s, in a report."""
    found = []
    for written in (report.to_json(), report.to_text(), report.to_markdown(), _body(report.to_html())):
        secret = set(re.findall(r"[0-9]{2,}", right)) - set(re.findall(r"[0-9]+", handed_in))
        found += [number for number in secret if re.search(rf"(?<![0-9#]){number}(?![0-9])", written)]
        found += [] if _POLYNOMIAL.search(handed_in) else _POLYNOMIAL.findall(written)
    return found


@pytest.mark.parametrize(
    ("problem", "right", "wrong"),
    [
        (SERVO, str(RIGHT), {"K": "[1 1]", "L": "[-19; 5]", "F": "1/s"}),
        (SERVO, str(RIGHT), "K = [1 1]\nL = [1; 5]\ndet(s I - A + L C) = s + 7\nF = 3"),
        (SERVO, str(RIGHT), {"K": "[4 3 5]", "L": "[q; 5]", "F": "1/S"}),
        (THIRD_ORDER, f"{K}{L}{F}", {"K": "[1 1 1]", "L": "[1; 1; 1]", "F": "7"}),
        (TWO_OUTPUTS, "", {"L": "[1 1; 1 1; 1 1]"}),
    ],
)
def test_without_reasons_no_right_value_and_no_polynomial_is_given_away(problem: str, right: str, wrong: Any) -> None:
    for show in ("verdict", "place"):
        report = Checked.of(problem).report(wrong, show)
        assert _given_away(report, right, str(wrong)) == []
    report = report.bounded("verdict")
    assert (report.lines, report.certificates, report.parts[0].slip) == ((), (), None)


@tabled
def test_a_line_on_signals_does_not_tell_the_gains(line: str, place: str) -> None:
    report = CHECKED.report(line)
    (judged,) = report.lines
    assert judged.verdict == "false"
    assert place in judged.reason
    assert not re.search(r"\b(?:4|3|19|81)\b", judged.reason)
    for page in (report.to_text(), report.to_markdown(), _body(report.to_html())):
        assert not re.search(r"\[-?4 -?3\]|\[-?19; -?81\]", page)


@tabled
def test_hints_do_not_depend_on_the_words_of_reasons(
    monkeypatch: pytest.MonkeyPatch, line: str, kept: str, gone: str
) -> None:
    monkeypatch.setattr(EntryDifference, "__str__", lambda entry: f"{entry.right} gehört an die Stelle {entry.place}")
    monkeypatch.setattr(WrongTerm, "__str__", lambda term: f"{term.term} fehlt")
    judged = CHECKED.report(line).lines[-1]
    assert judged.verdict == "false"
    assert kept in judged.reason
    assert not re.search(rf"(?<!\d){gone}(?!\d)", judged.reason)


@tabled
def test_a_reason_tells_one_wrong_part_and_of_several_the_places(
    printed: str, right: str, said: str, hint: str
) -> None:
    found = reasons(parse_matrix(printed), parse_matrix(right), "L")
    assert (str(found), found.hint()) == (said, hint)


def test_nothing_is_given_away_to_any_student_of_a_class() -> None:
    checked, seen = Checked.of(THIRD_ORDER), set()
    for number, answer in enumerate(answers(9, "feedback")):
        steps = [{"relation": line} for line in lines(answer, number).splitlines()[:4]]
        whole = checked.report({"answer": {name: answer[name] for name in "KLF"}, "step": steps})
        seen |= {part.slip for part in whole.parts} | {line.verdict for line in whole.lines}
        for show in ("place", "verdict"):
            bounded = whole.bounded(show)
            ours = replace(bounded, lines=(), parts=tuple(replace(part, given="", read="") for part in bounded.parts))
            assert _given_away(ours, f"{K}{L}{F}", "") == []
        assert not any(line.reason or line.right for line in whole.bounded("place").lines)
        assert _given_away(whole, f"{K}{L}{F}", "") != []
    assert {"sign", "entry", "false"} <= seen


def test_each_level_shows_more() -> None:
    answer = {"L": "[19; 80]"}
    by_level = {show: CHECKED.report(answer, show).parts[1] for show in SHOW}
    assert [part.place for part in by_level.values()] == [None, [2, 1], [2, 1], [2, 1]]
    assert [bool(part.reason) for part in by_level.values()] == [False, False, True, True]
    assert [part.right for part in by_level.values()] == [None, None, None, "[19; 81]"]
    assert "<math" in CHECKED.report(answer, "solution").to_html()


@tabled
def test_a_wrong_marking_is_refused(marking: str, message: str) -> None:
    with pytest.raises(ProblemErrors, match=message):
        read(f"{SERVO}[marking]\n{marking}\n")


def test_a_part_that_does_not_exist_is_named() -> None:
    with pytest.raises(
        ProblemErrors,
        match=r"marking.asked\[0\]: there is no compensator.Q; did you mean compensator.L\? known: compensator.verdict",
    ):
        check(f'{SERVO}[marking]\nasked = ["compensator.Q"]\n', RIGHT)


# L = [2 1; 0 2] and L = [1 1; 0 3] both place -1, -2 for x' = [1 1; 0 1] x, y = x (A - L triangular, by hand).
_TWO_OUTPUTS = (
    'task = "observer"\n[plant]\nA = "[1 1; 0 1]"\nC = "[1 0; 0 1]"\n[specification]\npoles = "-1, -2"\n[marking]\n'
)


@tabled
def test_a_milestone_that_is_false_for_every_right_answer_is_refused(problem: str, relation: str, refusal: str) -> None:
    text = (
        f'{SERVO if problem == "SERVO" else _TWO_OUTPUTS}[[marking.milestone]]\nrelation = "{relation}"\npoints = 1\n'
    )
    if not refusal:
        assert Checked.of(text).problem.marking.milestones
        return
    with pytest.raises(ProblemErrors) as raised:
        Checked.of(text)
    (error,) = raised.value.errors
    assert error.where == "marking.milestone[0].relation"
    assert refusal in str(error)


# -- the answer file --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ("no relation here\n", 'line 1: "no relation here" is no relation'),
        ("[answer]\nK = 1\nK = 2", "this is not TOML"),
        ('[answer]\nK = "1"\n[extra]\n', "extra: unknown key"),
        ('symbols = "a"\n[answer]\n', "symbols: a list of names is expected"),
        ('[answer]\n[[step]]\nwhere = "x"\n', r"step\[0\]: a table with relation is expected"),
        ("K = 1\n" * 201, "201 lines, more than 200"),
        ("K = " + "1" * 70_000, "the answer is larger than 64 kB"),
        ("one\ntwo\n", 'line 2: "two" is no relation'),
        ('{"answer": {"Q": 1}}', r"answer\.Q: no task here has such a field"),
    ],
)
def test_an_answer_that_cannot_be_read_is_refused_with_its_place(answer: str, message: str) -> None:
    with pytest.raises(ProblemErrors, match=message):
        CHECKED.report(answer)


@tabled
def test_what_is_pasted_from_elsewhere_is_read(given: Any) -> None:
    assert [part.verdict for part in CHECKED.report(given).parts] == ["right", "right", "missing"]


def test_a_function_of_s_is_an_answer_and_nothing_is_missing() -> None:
    report = CHECKED.report(f"F(s) = {RIGHT['F']}\n")
    assert (report.parts[2].verdict, report.lines[0].verdict) == ("right", "true")
    assert CHECKED.report(f"F (s) = 1/s\nF(s) = {RIGHT['F']}\n").parts[2].verdict == "right"


def test_a_line_of_words_harms_no_other_one() -> None:
    report = CHECKED.report("Anna Example\nK = [4 3]\nL = [19\nF = 1/s\n")
    assert [part.verdict for part in report.parts] == ["right", "unreadable", "wrong"]
    assert [line.verdict for line in report.lines] == ["unreadable", "true", "false"]


def test_what_stands_below_no_task_is_refused_in_a_text_too() -> None:
    with pytest.raises(ProblemErrors, match=r"answer\.observer: no task here"):
        CHECKED.report("observer.L = [19; 81]\n")


def test_an_empty_answer_is_not_filled_in() -> None:
    """The one entry that is wrong in a gain of order 1, in K_d = 0 and in a line is all that there is to find."""
    alone = 'task = "observer"\n[plant]\nA = "[2]"\nC = "[1]"\n[specification]\npoles = "-15"\n'
    for answer in ({"L": "0"}, "L = [0]\n"):  # L = 17
        report = Checked.of(alone).report(answer)
        assert (report.parts[0].verdict, report.parts[0].slip) == ("wrong", "one_coefficient")
        assert _given_away(report, "17", "s^2") == []
    tracking = ROOT / "worked_examples" / "cart_tracking_angle.toml"  # K_d = [0 -539/50 0 0]
    report = Checked.of(read(tracking.read_text("utf-8"), tracking.name, tracking.parent)).report("K_d = [0 0 0 0]\n")
    assert report.parts[0].reason == report.lines[0].reason == "entry (1, 2) is wrong"


def test_in_python() -> None:
    result = symobs.observer(symobs.StateSpace("[0 1; 0 -1]", None, "[1 0]"), poles="-10, -10")
    report = symobs.check(result, {"L": "[19; 81]"})
    assert (report.verdict, report.score, report.total) == ("right", Fraction(1), Fraction(1))
    assert set(report._repr_mimebundle_()) == {"text/plain", "text/markdown", "text/html"}
    with pytest.raises(UsageError, match="is nothing to show"):
        symobs.check(result, {"L": "[19; 81]"}, show="all")
