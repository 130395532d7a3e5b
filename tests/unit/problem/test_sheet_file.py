"""The file of a sheet: what is read, what is refused with place and repair, and what is no sheet."""

from __future__ import annotations

import json
import re
import tomllib
from datetime import date
from fractions import Fraction
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

from symobs.ground.errors import InputError, ProblemErrors
from symobs.pages.page.blocks import AnswerSpace
from symobs.problem.sheet_file import PROBLEM, SHEET, is_sheet, read_sheet
from symobs.problem.sheet_file import schema as sheet_schema
from tests.kit import tabled, tables
from tests.support.paths import ROOT

ONE = '[[problem]]\nfile = "one.toml"\n'
PNG = b"\x89PNG\r\n\x1a\n" + bytes(20)


@pytest.fixture(name="folder")
def folder_of_a_sheet(tmp_path: Path) -> Path:
    """A problem of one part, one of three, one that is no TOML, and pictures."""
    folder = tmp_path / "sheet"
    folder.mkdir()
    (folder / "one.toml").write_text('task = "observability"\n', "utf-8")
    (folder / "three.toml").write_text('tasks = ["observability", "observer", "pbh"]\n', "utf-8")
    (folder / "broken.toml").write_text("tasks = [", "utf-8")
    for name in ("logo.png", "false.jpg", "a b.png", "../outside.png"):
        (folder / name).write_bytes(PNG)
    return folder


def errors_of(text: str, folder: Path) -> list[str]:
    def opened(path: str) -> str:
        try:
            return Path(path).read_text("utf-8")
        except OSError as error:
            raise InputError(str(error.strerror), where=path, repair="give another") from None

    with pytest.raises(ProblemErrors) as caught:
        read_sheet(text, "sheet.toml", folder, opened)
    return str(caught.value).split("\n")


# -- read -------------------------------------------------------------------------------------------------------------


def test_everything_a_sheet_says_is_read(folder: Path) -> None:
    text = """
title = "T"
course = "C"
term = "S"
number = 3
due = 2026-12-08
instructor = "I"
logo = "logo.png"
text = "W"
language = "en"
style = "exam"
answers = "lines"
space = 6
final_answers = true
[[problem]]
file = "three.toml"
points = [1, 2.5, "1/4"]
hint = "H"
[[problem]]
file = "one.toml"
points = 10
space = 2
"""
    sheet = read_sheet(text, "sheet.toml", folder, lambda path: Path(path).read_text("utf-8"))
    head = sheet.header
    assert (sheet.title, head.course, head.term, head.number, head.due) == ("T", "C", "S", "3", date(2026, 12, 8))
    assert (head.instructor, head.text, head.is_exam, head.has_name) == ("I", "W", True, True)
    assert head.logo is not None
    assert (head.logo.kind, head.logo.content) == ("png", PNG)
    first, second = sheet.problems
    assert first.points == (Fraction(1), Fraction(5, 2), Fraction(1, 4))
    assert (first.hint, first.space) == ("H", AnswerSpace(6, is_ruled=True))
    assert (second.points, second.space) == ((Fraction(10),), AnswerSpace(2, is_ruled=True))
    assert sheet.texts[1] == 'task = "observability"\n'
    assert sheet.has_final_answers


# -- refused ----------------------------------------------------------------------------------------------------------


def test_all_errors_of_a_sheet_are_told_at_once(folder: Path) -> None:
    text = """
course = 3
number = -1
due = true
language = "xx"
style = "book"
answers = "box"
space = 0
name = "yes"
corse = "C"
logo = "logo.svg"
[[problem]]
file = "three.toml"
points = [1, 2]
[[problem]]
file = "gone.toml"
points = -1
hint = 4
[[problem]]
points = "many"
point = 1
"""
    assert errors_of(text, folder) == [
        "sheet.toml, corse: unknown key; did you mean course?",
        "sheet.toml, course: a text is expected, but a number came; write it in quotes",
        'sheet.toml, language: "xx" is no choice; write one of en, de',
        'sheet.toml, style: "book" is no choice; write one of exercise, exam',
        'sheet.toml, answers: "box" is no choice; write one of none, space, lines',
        'sheet.toml, number: this is no number of a sheet; write number = 3, or number = "3a"',
        'sheet.toml, due: a date or a text is expected, but true or false came; write due = 2026-12-08 or due = "Monday"',
        'sheet.toml, logo: "logo.svg" is no picture that pages can show; give a png, jpg or pdf',
        "sheet.toml, name: true or false is expected, but a text came; write name = true",
        "sheet.toml, space: a whole number of centimetres from 1 to 25 is expected; write space = 4",
        "sheet.toml, problem[0].points: 2 values for 3 parts; give one value for each task of the problem, or one for all",
        (
            "sheet.toml, problem[1].points: a number from 0 to 1000 with at most two decimals is expected; "
            "write points = 10, or points = [4, 6] for two parts"
        ),
        "sheet.toml, problem[1].hint: a text is expected, but a number came; write it in quotes",
        f"sheet.toml, problem[1].file: gone.toml: No such file or directory; give the path of a problem file, from {folder}",
        "sheet.toml, problem[2].point: unknown key; did you mean points?",
        (
            "sheet.toml, problem[2].points: a number from 0 to 1000 with at most two decimals is expected; "
            "write points = 10, or points = [4, 6] for two parts"
        ),
        'sheet.toml, problem[2].file: no file is named; write file = "problem.toml"',
    ]


@tabled
def test_what_is_no_sheet_is_refused(text: str, said: str, folder: Path) -> None:
    (folder / "link.png").symlink_to(folder / ".." / "outside.png")
    (folder / "large.png").write_bytes(PNG + bytes(2 << 20))
    errors = errors_of(text.replace("ONE\n", ONE), folder)
    assert len(errors) == 1
    assert said in errors[0]


def test_parts_of_a_problem_that_cannot_be_read_are_not_counted(folder: Path) -> None:
    text = '[[problem]]\nfile = "broken.toml"\npoints = [1, 2]\n'
    sheet = read_sheet(text, "sheet.toml", folder, lambda path: Path(path).read_text("utf-8"))
    assert len(sheet.problems[0].points) == 2


# -- recognised -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", [ONE, f'course = "C"\n{ONE}', "[[ problem ]]\nfile = ", 'due = "now"\ncourse = '])
def test_a_sheet_is_known_by_its_keys_even_where_it_is_broken(text: str) -> None:
    assert is_sheet(text)


@tabled
def test_anything_else_is_a_problem(text: str) -> None:
    assert not is_sheet(text)


def test_the_guide_names_every_key() -> None:
    guide = (ROOT / "docs" / "sheets.md").read_text("utf-8")
    assert [key for key in (*SHEET, *PROBLEM) if f"`{key}`" not in guide] == []


# -- its schema -------------------------------------------------------------------------------------------------------


def test_the_schema_fits_a_sheet_and_refuses_what_the_reader_refuses(folder: Path) -> None:
    schema = sheet_schema()
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    shown = tomllib.loads((ROOT / "worked_examples" / "sheets" / "observers.toml").read_text("utf-8"))
    assert set(shown) <= set(schema["properties"]) == set(SHEET)
    assert list(validator.iter_errors(shown)) == []
    entry = {"file": "one.toml"}
    for change in tables(Path(__file__))["wrong"]:
        assert list(validator.iter_errors({"title": "T", "problem": [entry], **change})), change
        text = "".join(f"{key} = {json.dumps(value)}\n" for key, value in ({"problem": [entry]} | change).items())
        text = re.sub(r'"(\w+)": ', r"\1 = ", text)
        with pytest.raises(ProblemErrors):
            read_sheet(text, "sheet.toml", folder, lambda path: Path(path).read_text("utf-8"))
