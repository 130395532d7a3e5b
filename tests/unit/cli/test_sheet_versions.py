"""Versions of a sheet: other numbers in another order, each on pages of its own, and one key with the points of each step."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import pytest

from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

    from tests.support.tools.command_line import Run

SHEET = """
title = "Test 1"
style = "exam"
[[problem]]
file = "drawn.toml"
points = 20
[[problem]]
file = "fixed.toml"
points = [2, 3]
"""
DRAWN = """
title = "An observer, a = {a}"
task = "observer"
[plant]
A = "[0 1; 0 a]"
C = "[1 0]"
[specification]
poles = "-5, -6"
[marking]
total = 10
[[marking.milestone]]
relation = "rank(O) = 2"
points = 4
[variants.parameters]
a = { set = [1, 2, 3] }
"""
FIXED = """
title = "A servo"
tasks = ["observability", "observer"]
[plant]
A = "[0 1; 0 -1]"
C = "[1 0]"
[specification]
poles = "-2, -3"
"""


def sheet(folder: Path, *arguments: str, text: str = SHEET) -> Run:
    for name, content in (("sheet.toml", text), ("drawn.toml", DRAWN), ("fixed.toml", FIXED)):
        (folder / name).write_text(content, "utf-8")
    return inside("sheet", "sheet.toml", *arguments, folder=folder)


def test_what_is_given_stands_once_in_an_exam_with_solutions(tmp_path: Path) -> None:
    """Each solution stands below its question; solutions alone begin with the data, and so do those behind all questions."""
    exam = SHEET.replace("drawn", "fixed")
    both = sheet(tmp_path, "--format", "text", text=exam).out
    assert both.count("Given\n") == 2
    assert both.index("Given\n") < both.index("Solution 1\n") < both.rindex("Given\n") < both.index("Solution 2\n")
    assert sheet(tmp_path, "--solutions", "--format", "text", text=exam).out.count("Given\n") == 2
    apart = exam.replace('style = "exam"', "")
    assert sheet(tmp_path, "--format", "text", text=apart).out.count("Given\n") == 4


def test_each_version_has_other_numbers_in_another_order(tmp_path: Path) -> None:
    run = sheet(tmp_path, "--versions", "3", "--format", "json")
    assert run.code == 0, run.err
    problems = json.loads(run.out)["problems"]
    assert [(each["version"], each["file"]) for each in problems] == [
        *[("A", "drawn.toml"), ("A", "fixed.toml"), ("B", "fixed.toml"), ("B", "drawn.toml")],
        *[("C", "drawn.toml"), ("C", "fixed.toml")],
    ]
    drawn = [each for each in problems if each["file"] == "drawn.toml"]
    gains = [each["results"][0]["L"] for each in drawn]
    numbers = [int(each["title"].removeprefix("An observer, a = ")) for each in drawn]  # no "variant 1" in a title
    # det(sI - A + LC) = s^2 + (l1 - a)s + l2 - a l1 = s^2 + 11 s + 30
    assert gains == [[[str(11 + a)], [str(30 + a * (11 + a))]] for a in numbers]
    assert sorted(numbers) == [1, 2, 3]


def test_the_key_has_the_points_of_each_step(tmp_path: Path) -> None:
    text = sheet(tmp_path, "--versions", "2", "--format", "text", "--language", "de").out
    papers, key = text.split("Test 1, Lösungen")
    assert re.findall(r"^Test 1, Gruppe ([AB])$", papers, re.MULTILINE) == ["A", "B"]
    assert papers.count("Matrikelnummer:") == papers.count("Erreicht") == 2
    assert "Schritt" not in papers
    assert "Lösung" not in papers
    assert re.findall(r"^Gruppe ([AB])$", key, re.MULTILINE) == ["A", "B"]
    rows = re.findall(r"^(\S.*?) +│ ([0-9,]+)$", key, re.MULTILINE)
    drawn = [("L", "12"), ("rang 𝒪 = 2", "8"), ("Summe", "20")]  # 6 and 4 of 10, doubled
    fixed = [("(a) rang 𝒪", "2"), ("(b) L", "3"), ("Summe", "5")]
    assert rows == [*drawn, *fixed, *fixed, *drawn]
    assert not re.search("variant", text, re.IGNORECASE)


@pytest.mark.parametrize(("half", "heads"), [("--questions", 2), ("--solutions", 1)])
@pytest.mark.parametrize("suffix", ["tex", "html", "md"])
def test_versions_and_key_are_sheets_of_their_own(tmp_path: Path, half: str, heads: int, suffix: str) -> None:
    assert sheet(tmp_path, "--versions", "2", half, "-o", f"out.{suffix}").code == 0
    written = (tmp_path / f"out.{suffix}").read_text("utf-8")
    head = {"tex": r"\\LARGE\\bfseries\\raggedright Test 1, (.*?)\\par", "html": "<h1>Test 1, (.*?)</h1>"}
    found = re.findall(head.get(suffix, "(?m)^# Test 1, (.*)$"), written)
    assert found == (["Version A", "Version B"] if heads == 2 else ["Solutions"])
    places = re.findall(r'\\label\{([a-z]+-.*?)\}|id="((?:questions|solutions)-[AB]?[0-9])"', written)
    assert len(places) == len(set(places))


def test_a_sheet_of_one_fixed_problem_has_no_versions(tmp_path: Path) -> None:
    run = sheet(tmp_path, "--versions", "2", text='[[problem]]\nfile = "fixed.toml"\n')
    assert run.code == 2
    assert "the versions would all be the same" in run.err
    run = sheet(tmp_path, "--versions", "4")
    assert run.code == 4
    assert "3 of 4 variants were found" in run.err
