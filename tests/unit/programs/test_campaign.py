"""A short slice of the campaign in every run of the tests.

The whole is `python -m tests.programs.campaign --designs 100000`.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

import mpmath
import pytest

from tests.programs.campaign import __main__ as campaign
from tests.programs.campaign import discovery, shrink
from tests.programs.campaign.asked import Asked, Untold, rows, to_toml
from tests.programs.campaign.figures import AGREES, DIFFERS, UNTOLD, Figures
from tests.programs.campaign.plants import KINDS, drawn
from tests.programs.campaign.points import Uncovered, answer_at, points_for
from tests.programs.campaign.running import System, answers
from tests.programs.campaign.shrink import shrunk
from tests.programs.campaign.solving import Refused, solved
from tests.programs.campaign.specifications import TASKS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from tests.programs.campaign.asked import Difference, Tables

pytestmark = pytest.mark.slow

ORACLES = sorted(path.stem for path in discovery.FOLDER.glob("*.py"))
#: Problems of the slice that all oracles judge.
SLICE = range(400, 480)


@pytest.fixture(autouse=True)
def _fifty_digits() -> Iterator[None]:
    """Compute as the campaign does, whatever other tests have set."""
    with mpmath.workdps(50):
        yield


@cache
def slice_of_answers() -> tuple[Asked, ...]:
    answers = (solved(*_seeded(seed)) for seed in SLICE)
    return tuple(answer for answer in answers if isinstance(answer, Asked))


def _seeded(seed: int) -> tuple[str, int, Tables]:
    kind, problem = drawn(seed)
    return kind, seed, problem


def oracle_of(module: str, require_tool: Callable[[str], str]) -> Any:
    oracle = pytest.importorskip(f"tests.programs.campaign.oracles.{module}")
    if oracle.COMMAND is not None:
        require_tool(oracle.COMMAND)
    return oracle


# -- the slice ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("module", ORACLES)
def test_an_oracle_agrees_with_every_answer_of_the_slice(module: str, require_tool: Callable[[str], str]) -> None:
    oracle = oracle_of(module, require_tool)
    covered = [answer for answer in slice_of_answers() if oracle.covers(answer.problem)]
    judged = oracle.differences(covered)
    differences = [
        f"{a.seed} {a.task}: {said}" for a, said in zip(covered, judged, strict=True) if isinstance(said, str)
    ]
    assert not differences
    assert sum(said is None for said in judged) >= len(covered) * 3 // 4


#: A field of an answer, how it is made wrong, and what PARI says of it.
LIES = [
    ("observability", "rank", "rank"),
    ("controllability", "matrix", "matrix"),
    ("detectability", "fixed_polynomial", "fixed polynomial"),
    ("pbh", "polynomial", "characteristic polynomial"),
    ("characteristic_polynomial", "polynomial", "polynomial"),
    ("transfer_function", "transfer_function", "transfer function"),
    ("canonical_form", "T", "A"),
    ("dual", "A", "A"),
    ("decomposition", "T", "A"),
    ("state_feedback", "K", "closed-loop polynomial"),
    ("observer", "L", "B_y"),
    ("observer", "verdict", "verdict"),
    ("reduced_order_observer", "H", "P A − F P = H C"),
    ("compensator", "F", "F"),
    ("compensator", "closed_loop_polynomial", "closed-loop polynomial"),
    ("feedforward", "F", "transfer function"),
    ("tracking", "K_d", "K_d"),
    ("matrix_exponential", "matrix", "series"),
    ("gramian", "matrix", "determinant"),
    ("initial_state", "x0", "the outputs"),
    ("initial_state_covariance", "output_part", "output part"),
    ("time_varying_observability", "rank", "rank"),
    ("pole_advice", "polynomial", "polynomial"),
    ("stability_region", "stable_if", "inside"),
]


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
def answer_with(task: str, field: str) -> Asked:
    """The first answer about a plant without parameters that has the field, and is not a no already."""
    for seed in range(200):
        kind, problem = drawn(seed, [task])
        if set(problem["symbols"]) - {"T", "q", "r", "h1", "h2"}:
            continue
        answer = solved(kind, seed, problem, 2)
        if isinstance(answer, Asked) and answer.answer.get(field) and (field != "verdict" or answer.verdict == "yes"):
            return answer
    raise LookupError(task)


@pytest.mark.parametrize(("task", "field", "said"), LIES, ids=[f"{task}-{field}" for task, field, _ in LIES])
def test_a_wrong_answer_is_seen(task: str, field: str, said: str, require_tool: Callable[[str], str]) -> None:
    oracle = oracle_of("pari", require_tool)
    answer = answer_with(task, field)
    lie = replace(answer, answer={**answer.answer, field: wrong(answer.answer[field])})
    good, bad = oracle.differences([answer, lie])
    assert good is None
    assert isinstance(bad, str)
    assert said in bad


@pytest.mark.parametrize("module", ["giac", "maxima"])
@pytest.mark.parametrize(
    ("task", "field"), [("observer", "L"), ("transfer_function", "transfer_function"), ("observability", "rank")]
)
def test_a_wrong_answer_is_seen_with_parameters(
    module: str, task: str, field: str, require_tool: Callable[[str], str]
) -> None:
    oracle = oracle_of(module, require_tool)
    plant = {"A": "[0 1; -a -b]", "B": "[0; 1]", "C": "[1 a]"}
    asked = {"poles": "-1, -p"} if task == "observer" else {}
    signs = dict.fromkeys(["a", "b", "p"], "positive")
    answer = solved("", 0, {"task": task, "symbols": signs, "plant": plant, "specification": asked})
    assert isinstance(answer, Asked)
    lie = replace(answer, answer={**answer.answer, field: wrong(answer.answer[field])})
    good, bad = oracle.differences([answer, lie])
    assert good is None
    assert isinstance(bad, str)


# -- problems ----------------------------------------------------------------------------------------------------------


def test_a_seed_draws_the_same_problem_of_any_kind_and_task() -> None:
    problems = [drawn(seed) for seed in range(4000)]
    assert problems[:50] == [drawn(seed) for seed in range(50)]
    assert {kind for kind, _ in problems} == set(KINDS)
    assert {problem["task"] for _, problem in problems} == set(TASKS)
    assert {drawn(seed, ["dual"])[1]["task"] for seed in range(20)} == {"dual"}
    sizes = {len(rows(problem["plant"]["A"])) for kind, problem in problems if "A" in problem["plant"]}
    assert {1, 2, 3, 4} < sizes
    assert max(sizes) <= 12


def test_a_problem_is_a_file() -> None:
    for seed in range(60):
        _, problem = drawn(seed)
        tables = {name: value for name, value in problem.items() if value != {}}
        assert tomllib.loads(to_toml(problem)) == tables
    with pytest.raises(ValueError, match="quote"):
        to_toml({"task": 'a "quote"'})


def test_what_symobs_refuses_is_no_answer() -> None:
    problem = {"task": "observer", "symbols": {}, "plant": {"A": "[1 2]", "C": "[1 0]"}, "specification": {}}
    refused = solved("", 0, problem)
    assert isinstance(refused, Refused)
    assert "plant.A" in refused.reason


# -- points ------------------------------------------------------------------------------------------------------------

_ANSWER = {
    "verdict": "conditional",
    "conditions": ["m != 0", "a != b"],
    "condition_kinds": ["domain", "existence"],
    "rank": 2,
    "cases": [
        {"when": ["a == b", "a != 1"], "verdict": "no", "rank": 1},
        {"when": ["a == 1", "b == 1"], "verdict": "no", "rank": 0},
    ],
}


def test_the_case_that_holds_at_a_point_is_found() -> None:
    def at(a: int, b: int, m: int = 1) -> Any:
        return answer_at(_ANSWER, {"a": Fraction(a), "b": Fraction(b), "m": Fraction(m)})

    assert (at(2, 3)["rank"], at(2, 3)["verdict"]) == (2, "yes")
    assert (at(2, 2)["rank"], at(2, 2)["verdict"]) == (1, "no")
    assert at(1, 1)["rank"] == 0
    assert at(2, 3, 0) is None
    with pytest.raises(Uncovered):
        answer_at({**_ANSWER, "cases": []}, {"a": Fraction(2), "b": Fraction(2), "m": Fraction(1)})


def test_points_lie_on_the_equations_of_an_answer_too() -> None:
    problem = {"task": "observability", "symbols": dict.fromkeys("abm", "real"), "plant": {}}
    points = list(points_for(Asked("", 1, problem, _ANSWER)))
    assert any(point["a"] == point["b"] for point in points)
    assert any(point["a"] != point["b"] for point in points)


# -- running -----------------------------------------------------------------------------------------------------------


def test_a_question_without_an_answer_does_not_take_the_others_along(require_tool: Callable[[str], str]) -> None:
    gp = System((require_tool("gp"), "-q", "-f"), "")
    questions = ['print("#{}#", 6 * 7, "#")', "while (1, )", 'print("#{}#", 1, "#")', "quit", 'print("#{}#", 2, "#")']
    assert answers(gp, questions, 1.5) == ["42", None, "1", None, "2"]


# -- shrinking, counting, going on -------------------------------------------------------------------------------------


def test_a_failure_shrinks_to_what_matters() -> None:
    kind, problem = next(p for p in map(drawn, range(5000)) if p[0] == "several" and "3" in p[1]["plant"].get("A", ""))
    assert kind == "several"
    smaller = shrunk(problem, lambda tried: "3" in tried["plant"]["A"])
    plant = smaller["plant"]
    assert plant in ({"A": "[3]", "B": "[0]", "C": "[0]"}, {"A": "[-3]", "B": "[0]", "C": "[0]"})


def test_a_bug_of_ours_is_found_shrunk_and_written_down(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, require_tool: Callable[[str], str]
) -> None:
    require_tool("gp")

    def lying(*arguments: Any) -> Any:
        found = solved(*arguments)
        if isinstance(found, Asked) and found.answer.get("rank", 0) > 1:
            return replace(found, answer={**found.answer, "rank": found.answer["rank"] - 1})
        return found

    monkeypatch.setattr(campaign, "solved", lying)
    monkeypatch.setattr(shrink, "solved", lying)
    asked = ["--designs", "2", "--seed", "3", "--task", "observability", "--oracle", "PARI", "--out", str(tmp_path)]
    assert campaign.main(asked) == 1
    small = sorted((tmp_path / "failures").glob("PARI-*-small.toml"))
    assert small
    for path in small:
        text = path.read_text(encoding="utf-8")
        assert text.startswith("# rank")
        assert len(rows(tomllib.loads(text)["plant"]["A"])) == 2

    monkeypatch.undo()
    assert campaign.main([*asked[:1], "3", *asked[2:]]) == 0
    assert not list((tmp_path / "failures").glob("*.toml"))
    figures = Figures.load(tmp_path / "figures.json")
    assert figures.next_seed == 6
    assert figures.count("PARI", DIFFERS) == 0
    assert figures.count("PARI", AGREES) == figures.total == 3
    assert "3/0/0" in (tmp_path / "table.txt").read_text(encoding="utf-8")


def test_where_doubles_say_otherwise_the_exact_oracle_decides(require_tool: Callable[[str], str]) -> None:
    require_tool("gp")
    right = answer_with("observability", "rank")
    lie = replace(right, answer={**right.answer, "rank": right.answer["rank"] + 1})

    class Rounding:
        NAME = "python-control"
        COMMAND: str | None = None

        def covers(self, problem: Tables) -> bool:
            return bool(problem)

        def differences(self, batch: Sequence[Asked]) -> list[Difference]:
            return ["rank is another one"] * len(batch)

    misled, seen = discovery.judged(Rounding(), [right, lie])
    assert isinstance(misled, Untold)
    assert seen == "rank is another one"


def test_what_could_not_be_told_is_counted_with_its_reason() -> None:
    figures = Figures(1)
    asked = Asked("numeric", 1, {"task": "dual"}, {"verdict": "yes"})
    figures.answered(asked)
    figures.judge("X", asked, Untold("no answer in 12 s"))
    figures.judge("X", asked, Untold("no answer in 34 s"))
    assert figures.count("X", UNTOLD) == 2
    assert figures.reasons == {("X", "no answer in 00 s"): 2}
