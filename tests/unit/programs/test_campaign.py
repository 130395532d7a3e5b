"""A short slice of the campaign in every run of the tests; the whole is `python -m tests.programs.campaign`."""

from __future__ import annotations

import tomllib
from collections import Counter
from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings

from tests.kit import tabled, tables
from tests.programs.campaign import __main__ as campaign
from tests.programs.campaign.__main__ import ORACLES, examine, judged
from tests.programs.campaign.points import Uncovered, answer_at, points_for
from tests.programs.campaign.solving import solved
from tests.programs.campaign.systems import GIAC, MAXIMA, OCTAVE, PARI, Process, Untold
from tests.support.problems.random_problems import TASKS, problem, problems, to_toml

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.programs.campaign.systems import System
    from tests.support.problems.random_problems import Tables

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True, scope="module")
def _ended() -> Iterator[None]:
    """End the systems that stay for the next question."""
    yield
    for system in (PARI, GIAC, MAXIMA, OCTAVE):
        system.process.end()


def test_every_system_agrees_with_answers_to_random_problems(require_tool: Callable[[str], str]) -> None:
    for oracle in ORACLES.values():
        require_tool(oracle.COMMAND)
    counted: Counter[str] = Counter()

    @settings(max_examples=60)
    @given(problems())
    def agreed(drawn: Tables) -> None:
        examine(drawn, list(ORACLES.values()), counted, 2)

    agreed()
    for name in ("PARI", "Octave"):
        assert counted[f"{name} agrees"] > 4 * counted[f"{name} cannot tell"] > -1
    assert counted["PARI agrees"] > 40


#: A field of an answer, how it is made wrong, and what PARI says of it.
LIES = tables(Path(__file__))["lies"]
#: The tasks of which Octave is told as well, by the same fields.
IN_OCTAVE = {*TASKS} - {*OCTAVE.skipped, "pole_advice", "stability_region"}


def wrong(value: Any) -> Any:
    """The same with its first entry changed."""
    match value:
        case [first, *others]:
            return [wrong(first), *others]
        case int():
            return value + 1
        case "yes":
            return "no"
        case str() if " > " in value or " < " in value or "!=" in value:
            return "False"
    return f"{value} + 1/7"


@cache
def answer_with(task: str, field: str) -> tuple[Tables, Tables]:
    """The first answer about a plant without parameters that has the field, and is not a no already."""
    for seed in range(200):
        asked = problem(Random(seed), [task])  # noqa: S311 - test problems
        if set(asked["symbols"]) - {"T", "q", "r", "h1", "h2"}:
            continue
        answer = solved(asked, 2)
        if (
            isinstance(answer, dict)
            and answer.get(field)
            and (field != "verdict" or (answer["verdict"] == "yes" and "L" not in asked["specification"]))
        ):
            return asked, answer
    raise LookupError(task)


@pytest.mark.parametrize(("task", "field", "said"), LIES, ids=[f"{task}-{field}" for task, field, _ in LIES])
def test_a_wrong_answer_is_seen(task: str, field: str, said: str, require_tool: Callable[[str], str]) -> None:
    asked, answer = answer_with(task, field)
    lie = {**answer, field: wrong(answer[field])}
    for system in (PARI, OCTAVE) if task in IN_OCTAVE and field != "verdict" else (PARI,):
        require_tool(system.COMMAND)
        assert system.difference(asked, answer) is None
        bad = system.difference(asked, lie)
        assert isinstance(bad, str), system.NAME
        assert said in bad or system is OCTAVE


@pytest.mark.parametrize("system", [GIAC, MAXIMA], ids=lambda system: system.NAME)
@tabled
def test_a_wrong_answer_is_seen_with_parameters(
    system: System, task: str, field: str, require_tool: Callable[[str], str]
) -> None:
    require_tool(system.COMMAND)
    plant = {"A": "[0 1; -a -b]", "B": "[0; 1]", "C": "[1 a]"}
    signs = dict.fromkeys(["a", "b", "p"], "positive")
    given = {"poles": "-1, -p"} if task == "observer" else {}
    asked = {"task": task, "symbols": signs, "plant": plant, "specification": given}
    answer = solved(asked)
    assert isinstance(answer, dict)
    assert system.difference(asked, answer) is None
    assert isinstance(system.difference(asked, {**answer, field: wrong(answer[field])}), str)


def test_where_doubles_say_otherwise_the_exact_system_decides(require_tool: Callable[[str], str]) -> None:
    require_tool(PARI.COMMAND)
    asked, answer = answer_with("observability", "rank")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(OCTAVE), "_at_points", lambda self, *_: "rank" if self is OCTAVE else None)
        assert isinstance(judged(OCTAVE, asked, answer), Untold)
        patch.setattr(type(OCTAVE), "_at_points", lambda *_: "rank")
        assert judged(OCTAVE, asked, answer) == "rank"


def test_a_bug_of_ours_is_found_and_made_small(
    monkeypatch: pytest.MonkeyPatch, require_tool: Callable[[str], str]
) -> None:
    require_tool("gp")

    def lying(*arguments: Any) -> Any:
        found = solved(*arguments)
        return {**found, "rank": found["rank"] - 1} if isinstance(found, dict) and found["rank"] > 1 else found

    asked = ["--problems", "10", "--task", "observability", "--oracle", "PARI"]
    monkeypatch.setattr(campaign, "BATCH", 5)
    assert campaign.main(asked) == 0
    monkeypatch.setattr(campaign, "solved", lying)
    with pytest.raises(AssertionError, match="PARI: rank") as told:
        campaign.main(asked)
    _, _, text = str(told.value).partition("\n")
    plant = tomllib.loads(text.partition("\nassert")[0])["plant"]
    assert len(plant["A"].split(";")) == 2


def test_a_problem_is_a_file_and_the_same_of_one_seed() -> None:
    for seed in range(60):
        drawn, again = (problem(Random(seed)) for _ in range(2))  # noqa: S311 - test problems
        assert drawn == again
        tables = {name: value for name, value in drawn.items() if value != {}}
        assert tomllib.loads(to_toml(drawn)) == tables
    refused = {"task": "observer", "symbols": {}, "plant": {"A": "[1 2]", "C": "[1 0]"}, "specification": {}}
    assert "plant.A" in str(solved(refused))


# -- points ------------------------------------------------------------------------------------------------------------

_ANSWER = tables(Path(__file__))["answer"]


def test_the_case_that_holds_at_a_point_is_found() -> None:
    def at(a: int, b: int, m: int = 1) -> Any:
        return answer_at(_ANSWER, {"a": Fraction(a), "b": Fraction(b), "m": Fraction(m)})

    assert (at(2, 3)["rank"], at(2, 3)["verdict"]) == (2, "yes")
    assert (at(2, 2)["rank"], at(2, 2)["verdict"]) == (1, "no")
    assert at(1, 1)["rank"] == 0
    assert at(2, 3, 0) is None
    with pytest.raises(Uncovered):
        answer_at({**_ANSWER, "cases": []}, {"a": Fraction(2), "b": Fraction(2), "m": Fraction(1)})
    points = points_for({"symbols": dict.fromkeys("abm", "real")}, _ANSWER)
    assert {point["a"] == point["b"] for point in points} == {True, False}


def test_a_question_without_an_answer_does_not_take_the_others_along(require_tool: Callable[[str], str]) -> None:
    gp = Process((require_tool("gp"), "-q", "-f"), "")
    questions = ['print("#{}#", 6 * 7, "#")', "while (1, )", 'print("#{}#", 1, "#")', "quit", 'print("#{}#", 2, "#")']
    assert [gp.ask(question, 1.5) for question in questions] == ["42", None, "1", None, "2"]
    gp.end()
