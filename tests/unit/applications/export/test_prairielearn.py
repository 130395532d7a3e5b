"""The PrairieLearn export: its server run as it is, in a bare Python, beside `check`."""

from __future__ import annotations

import json
import random
import re
import subprocess
import sys
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import fromstring

import pytest

from symobs.applications.export import export
from symobs.applications.grader.claims import judge
from tests.kit import tabled
from tests.support.tools.exported import BY_HAND, HELD, checked, held, random_answer

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.applications.export import ExerciseSet

#: The runtime as far as a server uses it, and a loop that grades what comes on standard input.
RUNTIME = """
def set_weighted_score_data(data):
    parts = data["partial_scores"].values()
    data["score"] = sum(p["score"] * p["weight"] for p in parts) / sum(p["weight"] for p in parts)
"""
DRIVER = """
import json, sys
sys.path.insert(0, ".")
import server
for line in sys.stdin:
    asked = json.loads(line)
    data = {"options": {"question_path": "."}, "variant_seed": asked["seed"], "params": {}}
    data |= {"raw_submitted_answers": asked["raw"],
            "format_errors": {}, "partial_scores": {}, "feedback": {}, "score": 0, "correct_answers": {}}
    if "test" in asked:
        data["test_type"] = asked["test"]
        server.test(data)
    else:
        server.generate(data)
        server.parse(data)
        if not data["format_errors"]:
            server.grade(data)
    print(json.dumps(data))
"""


def installed(each: ExerciseSet, folder: Path) -> dict[str, str]:
    """Write an export into a folder, with the stand-in beside it; return the files of the question."""
    files = {name.split("/")[-1]: str(text) for name, text in export("prairielearn", [each]).items()}
    for name, text in {**files, "prairielearn.py": RUNTIME, "driver.py": DRIVER}.items():
        (folder / name).write_text(text, "utf-8")
    return files


def graded(folder: Path, asked: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What the server makes of submissions: a Python without packages, that knows nothing of symobs."""
    lines = "\n".join(map(json.dumps, asked))
    command = [sys.executable, "-S", "-E", "driver.py"]
    done = subprocess.run(command, input=lines, capture_output=True, text=True, cwd=folder, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def raw(each: ExerciseSet, given: dict[str, list[list[str]]]) -> dict[str, str]:
    """What the inputs of the page send."""
    found: dict[str, str] = {}
    for part in each.first.parts:
        cells = [cell for row in given[part.name] for cell in row]
        alone = part.shape == (1, 1) and part.kind != "gain"
        found |= {part.name if alone else f"{part.name}{k}": cell for k, cell in enumerate(cells, 1)}
    return found


def agree(name: str, count: int) -> None:
    """Verdicts and credits of the grader are those of `check`."""
    exercise, draw = held(name).first, random.Random(name)  # noqa: S311
    for _ in range(count):
        given = random_answer(exercise, draw)
        found = {part: (told["verdict"], told["credit"]) for part, told in judge(exercise.question, given).items()}
        assert found == checked(exercise, given), given


@pytest.mark.parametrize("name", [*HELD, *BY_HAND])
def test_the_grader_gives_the_verdicts_of_check(name: str) -> None:
    agree(name, 5)


@pytest.mark.parametrize("name", ["output_feedback_servo", "triple_pole_two_outputs"])
def test_the_server_gives_the_credits_of_check(name: str, tmp_path: Path) -> None:
    each, draw = held(name), random.Random(name)  # noqa: S311
    installed(each, tmp_path)
    given = [random_answer(each.first, draw) for _ in range(15)]
    for answer, data in zip(given, graded(tmp_path, [{"seed": "7", "raw": raw(each, g)} for g in given]), strict=True):
        told = checked(each.first, answer)
        unreadable = {part for part, (verdict, _) in told.items() if verdict == "unreadable"}
        assert set(data["format_errors"]) == unreadable
        if not unreadable:
            assert {part: found["score"] for part, found in data["partial_scores"].items()} == {
                part: float(credit or 0) for part, (_, credit) in told.items()
            }


@tabled
def test_what_is_nearly_right_has_the_verdict_of_check(name: str, given: dict[str, list[list[str]]]) -> None:
    exercise = held(name).first
    found = {part: (told["verdict"], told["credit"]) for part, told in judge(exercise.question, given).items()}
    assert found == checked(exercise, given)


def test_what_the_platform_asks_of_a_question(tmp_path: Path) -> None:
    each = held("output_feedback_servo")
    files = installed(each, tmp_path)
    info = json.loads(files["info.json"])
    required = {"uuid", "type", "title", "topic"}
    assert required <= set(info) <= required | {"tags", "partialCredit", "singleVariant"}
    html = re.sub(r"\{\{\{params.question\}\}\}|\{\{[#/]", "", files["question.html"])
    page = fromstring(f"<div>{html}</div>")  # noqa: S314
    assert [found.get("answers-name") for found in page.iter() if found.tag.endswith("-input")] == ["K", "L", "F"]
    kinds = ("correct", "incorrect", "invalid")
    told = graded(tmp_path, [{"seed": "1", "raw": {}, "test": kind} for kind in kinds])
    assert [data["score"] for data in told] == [1, 0, 0]
    assert [bool(data["format_errors"]) for data in told] == [False, False, True]


@pytest.mark.parametrize(
    "text",
    ["9" * 1999, "(" * 500, "2^" * 300 + "2", "s^1000^1000", "1e999", "1e9999", "\0", "\ud800", "(1)(2)", "''", "--" * 900 + "1",  # noqa: E501
     "(s+1)^60*(s+2)^60", "1/0", "0^-1", "1/(s-s)", "__import__('os').system('touch hacked')", "{" * 99, "\N{ARABIC-INDIC DIGIT ONE}"],  # noqa: E501
)  # fmt: skip
def test_nothing_that_is_typed_raises_or_is_executed(text: str) -> None:
    exercise = held("output_feedback_servo").first
    for name in ("F", "K", "L"):
        given = {part.name: [[text] * part.shape[1]] * part.shape[0] for part in exercise.parts if part.name == name}
        found = judge(exercise.question, given)[name]
        assert found["verdict"] in {"unreadable", "wrong"}
        assert found["credit"] < 1
