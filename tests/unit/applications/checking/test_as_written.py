"""More than four hundred answers in the forms of sheets, programs and LaTeX: they are read, and never misjudged."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

import pytest

from symobs.applications.checking import Checked
from symobs.ground.errors import ProblemErrors

CORPUS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
#: Of the right ones so many in a hundred are read as right; the others cannot be read, which a human sees.
READ = 95


def verdict(checked: Checked, text: str) -> str:
    """The verdict on all that a file says, parts and lines together."""
    try:
        report = checked.report_of_file(text.encode(), "answer.txt", "reason")
    except ProblemErrors:
        return "unreadable"
    found = {part.verdict for part in report.parts} - {"missing"}
    found |= {{"true": "right", "false": "wrong"}.get(line.verdict, "") for line in report.lines} - {""}
    return next((each for each in ("wrong", "right") if each in found), "unreadable")


@cache
def judged(name: str) -> list[tuple[str, str, str]]:
    checked = Checked.of(CORPUS[name]["problem"])
    return [(answer, expected, verdict(checked, answer)) for answer, expected in CORPUS[name]["answers"]]


@pytest.mark.parametrize("name", CORPUS)
def test_nothing_is_misjudged(name: str) -> None:
    assert [each for each in judged(name) if {each[1], each[2]} == {"right", "wrong"}] == []


def test_what_is_right_is_read() -> None:
    right = [each for name in CORPUS for each in judged(name) if each[1] == "right"]
    assert len(right) > 300
    assert 100 * sum(found == "right" for *_, found in right) >= READ * len(right)


@pytest.mark.parametrize("words", ["the ", "completely ", "eine verstärkung ", "a ∈ "])
def test_long_lines_of_words_are_no_sentences(words: str) -> None:
    assert verdict(Checked.of(CORPUS["observer"]["problem"]), 3_000 * words) == "unreadable"
