"""Problem files: what their text means, and what results are held against."""

from __future__ import annotations

import json
import tomllib
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import parse, read, validate
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.tasks.result import render
from tests.kit import tabled
from tests.support.tools.command_line import EXAMPLES, SERVO

if TYPE_CHECKING:
    from collections.abc import Callable
PLANT = '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
OBSERVER = f'task = "observer"\n{PLANT}[specification]\npoles = [-10, -10]\n'


def unmet(text: str) -> list[str]:
    """The expected answers of a problem that are not met."""
    found = read(text)
    return mismatches(found.solve(), found.expect)


def complaint(text: str) -> str:
    """What a file that cannot be parsed is told, one line."""
    with pytest.raises(ProblemErrors) as refused:
        parse(text, "file")
    assert len(refused.value.errors) == 1
    assert refused.value.errors[0].repair
    return str(refused.value)


def errors_of(action: Callable[[], object]) -> tuple[SymobsError, ...]:
    """The errors of a file; anything else that is raised is a bug."""
    try:
        action()
    except ProblemErrors as refused:
        return refused.errors
    return ()


# -- the text of a file ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_json_with_the_same_keys_is_the_same_problem(path: Any) -> None:
    tables = tomllib.loads(path.read_text("utf-8"), parse_float=str)
    from_toml, from_json = read(path.read_text("utf-8")), read("\n " + json.dumps(tables))
    assert from_json.title == from_toml.title
    assert [task.name for task in from_json.tasks] == [task.name for task in from_toml.tasks]
    for name in "ABCD":
        assert getattr(from_json.plant.matrices, name) == getattr(from_toml.plant.matrices, name)
    assert from_json.plant.symbols == from_toml.plant.symbols
    assert from_json.specification == from_toml.specification
    assert from_json.expect == from_toml.expect


@tabled
def test_what_is_neither_toml_nor_json_is_refused_at_its_place(text: str, words: str) -> None:
    said = complaint(text)
    for word in words.split(" … "):
        assert word in said


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "[" * 99 + "]" * 99,
        "a.b.c.d.e.f.g.h.i.j = 1",
        f"x = {'9' * 1000}",
        f'x = "{"a." * 500}"',
        f"x = '''{'[' * 500}'''",
        f'x = """{"[" * 500} "" \\""" """  # {"a." * 500}',
        f'"{"a." * 500}" = 1',
        "x = 0.1\ny = 1.2.3.4"[:7],
    ],
)
def test_what_only_looks_costly_is_read(text: str) -> None:
    assert parse(text) == tomllib.loads(text, parse_float=str)


@given(st.text(alphabet="[]{}\".=#\n\\'ab1_ ", max_size=40))
def test_any_text_is_parsed_or_refused(text: str) -> None:
    assert all(error.where and error.repair for error in errors_of(lambda: parse(text)))


@given(st.data())
def test_any_damage_to_a_file_is_found_out(data: st.DataObject) -> None:
    text = SERVO.read_text("utf-8")
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 12)))
    put = data.draw(st.text(alphabet="[](){};,.=\"'+-*/^01 sxi\n", max_size=3))
    for error in errors_of(lambda: unmet(text[:start] + put + text[end:])):
        assert isinstance(error, InputError)
        assert error.where
        assert error.repair


# -- expected answers -----------------------------------------------------------------------------------------------


def expecting(lines: str, text: str = OBSERVER) -> list[str]:
    return unmet(f"{text}\n[expect]\n{lines}")


@tabled
def test_expected_answers_are_compared_as_mathematics(line: str) -> None:
    assert expecting(line) == []


@tabled
def test_an_answer_that_is_not_met_is_said_with_what_was_found(line: str, said: str) -> None:
    assert expecting(line) == [said]


def test_an_expected_answer_belongs_to_every_task_that_has_it() -> None:
    text = OBSERVER.replace('task = "observer"', 'tasks = ["observability", "observer", "state_feedback"]')
    assert expecting('L = "[19; 81]"\nK = "[100 19]"\nrank = 2\n[expect.state_feedback]\nverdict = "yes"', text) == []
    said = expecting('poles = "-1, -1"\nobservability.rank = "1"', text)
    assert [line.split(":")[0] for line in said] == ["expect.observability.rank", "expect.poles", "expect.poles"]


PARAMETRIC = """
tasks = ["observer", "characteristic_polynomial"]
[symbols]
omega = "positive"
b = "real"
[plant]
A = "[0 1; -omega^2 -b]"
C = "[0 1]"
[specification]
L = "[0; 1]"
"""


@tabled
def test_relations_and_roots_are_compared_as_mathematics(line: str) -> None:
    assert expecting(line, PARAMETRIC) == []


@tabled
def test_another_relation_or_root_is_not_met(line: str) -> None:
    assert len(expecting(line, PARAMETRIC)) == 1


@tabled
def test_irrational_roots_can_be_expected(polynomial: str, roots: list[Any]) -> None:
    text = f'task = "transfer_function"\n[plant]\ntransfer_function = "1/({polynomial})"\n'
    assert expecting(f"poles = {json.dumps(roots)}", text) == []
    assert len(expecting(f"poles = {json.dumps(roots[:-1] + roots[:1])}", text)) == 1


@tabled
def test_unreadable_expectations_are_refused(line: str, said: str) -> None:
    with pytest.raises(ProblemErrors, match=r"^expect") as refused:
        expecting(line, PARAMETRIC)
    assert said in str(refused.value)


# Not observable, but the fixed mode -1 is among the poles: det(sI - A + LC) = (s + 1)(s + 2 + a + b) for L = [a; b].
NOT_UNIQUE = """
task = "observer"
[plant]
A = "[0 1; -2 -3]"
C = "[1 1]"
[specification]
poles = [-1, -5]
"""


def test_any_member_of_the_family_meets_what_is_expected() -> None:
    (ours,) = read(NOT_UNIQUE).solve()
    members = {f"[{a}; {3 - a}]" for a in (0, 1, -7)}
    assert len(members - {str(ours.answer["L"])}) >= 2
    for member in members:
        assert expecting(f'L = "{member}"', NOT_UNIQUE) == []
    said = expecting('L = "[1; 1]"', NOT_UNIQUE)
    assert len(said) == 1
    assert said[0].startswith("expect.L: expected [1; 1], found ")


def test_a_compensator_follows_the_members_expected() -> None:
    # A - BK = [0 1; -4 -4]; F = K (sI - A + BK + LC)^-1 L for L = [1; 2]; ours is for another L.
    text = NOT_UNIQUE.replace('task = "observer"', 'task = "compensator"').replace("poles = [-1, -5]", "")
    text = text.replace("C =", 'B = "[0; 1]"\nC =') + "control_poles = [-2, -2]\nobserver_poles = [-1, -5]\n"
    right = 'K = "[2 1]"\nL = "[1; 2]"\ncompensator_matrix = "[-1 0; -6 -6]"\nF = "4 (s + 2)/((s + 1) (s + 6))"'
    assert expecting(right, text) == []
    wrong = [right.replace("(s + 2)", "(s + 3)"), right.replace("-6 -6", "-6 -5"), right.replace("[1; 2]", "[1; 1]")]
    places = [expecting(lines, text)[0].split(":")[0] for lines in wrong]
    assert places == ["expect.F", "expect.compensator_matrix", "expect.L"]


def test_a_word_that_two_tasks_read_differently_is_read_as_the_task_asked_for_does() -> None:
    """`output` holds functions of t for initial_state, rational ones for time-varying plants; and [expect] is read too."""
    text = """
        titel = "x"
        task = "initial_state"
        [symbols]
        T = "positive"
        [plant]
        A = "[0 1; 0 {entry}]"
        C = "[1 0]"
        [specification]
        horizon = "T"
        output = "1 - exp(-t)"
        [expect]
        x0 = "[1; 2"
    """
    for entry, places in (("-1", ["titel", "expect.x0"]), ("-q", ["titel", "plant.A", "expect.x0"])):
        with pytest.raises(ProblemErrors) as caught:
            read(text.replace("{entry}", entry), "problem.toml")
        assert [error.where for error in caught.value.errors] == places


@tabled
def test_an_error_hides_no_other_and_makes_none(text: str, places: list[str]) -> None:
    with pytest.raises(ProblemErrors) as raised:
        read(text)
    assert [error.where for error in raised.value.errors] == places


def test_a_method_is_for_the_tasks_of_a_file_that_have_it() -> None:
    text = """
tasks = ["observability", "observer", "stability_region"]
[plant]
A = "[0 1; -2 -3]"
C = "[1 0]"
[specification]
poles = "-4, -5"
method = "%s"
"""
    found = validate(parse(text % "ackermann", "problem")).solve()
    assert [result.printed_method for result in found][:2] == ["rank", "ackermann"]
    with pytest.raises(ProblemErrors, match="'magic' is not a method of observability"):
        validate(parse(text % "magic", "problem")).solve()


# -- tasks about the plant that another task finds ---------------------------------------------------------------------

SAMPLED = f"""tasks = ["observability", "zero_order_hold", "state_feedback"]
plant_of = "zero_order_hold"
[symbols]
T = "positive"
{PLANT.replace("-1", "0")}[specification]
sampling_period = "T"
poles = [0, 0]
[expect.state_feedback]
K = "[1/T^2 3/(2*T)]"
"""


def test_tasks_may_be_about_the_plant_that_another_one_finds() -> None:
    """The sampled double integrator has the deadbeat gain [1/T², 3/(2T)] (Åström and Wittenmark, ch. 4)."""
    assert unmet(SAMPLED) == []
    problem = read(SAMPLED)
    results = problem.solve()
    assert [result.plant.is_discrete for result in results] == [False, False, True]
    text = problem.document(results)
    page = str(render(text, "text"))
    before, after = page.split("3. State feedback")
    assert "ẋ" in before
    assert "xₖ₊₁" in before
    assert "ẋ" not in after
    assert "det(zI - A + B K) = z²" in after
    assert "the plant found in part (b)" in " ".join(str(render(question_of(problem), "text")).split())
    alone = validate(parse(SAMPLED, "file"), "state_feedback").solve()
    assert [result.task for result in alone] == ["state_feedback"]
    assert alone[0].plant.is_discrete
    assert not validate(parse(SAMPLED, "file"), "observability").solve()[0].plant.is_discrete


@tabled
def test_the_plant_of_a_task_that_has_none_is_refused(name: str, words: str) -> None:
    (error,) = errors_of(lambda: read(SAMPLED.replace('plant_of = "zero_order_hold"', f'plant_of = "{name}"')))
    assert error.where == "plant_of"
    assert words in f"{error.message}; {error.repair}"
