"""Sheets as a course hands them out: head, points, room for answers, hints and final answers, in every format."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from symobs.formula.phrases import PHRASES
from symobs.pages.page.sheet import Header, Sheet, SheetEntry
from tests.kit import tabled
from tests.pages.test_sheet import typeset
from tests.support.paths import ROOT
from tests.support.tools.command_line import inside
from tests.unit.cli.test_time_and_memory import GENERIC

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    RequireTool = Callable[[str], str]

SHEET = ROOT / "worked_examples" / "sheets" / "observers.toml"
LOGO = (SHEET.parent / "logo.png").read_bytes()
FORMATS = ("latex", "beamer", "html", "markdown", "text", "json")
HOSTILE = r"\input{x} 100 % <script>alert(1)</script> $x_1$ & #~ [a](b) `c`"
HEAD = """
title = "Observers"
course = "Systems"
term = "Winter"
number = "3a"
due = "Tuesday"
instructor = "Somebody"
text = "Give reasons."
"""
PROBLEMS = """
[[problem]]
file = "two.toml"
points = [1.5, 1]
hint = "Think of rank."
[[problem]]
file = "one.toml"
points = 7
"""


@pytest.fixture(name="folder")
def folder_with_a_sheet(tmp_path: Path) -> Path:
    """A sheet of two problems; the gain of the second one, (3; -1/c), exists under a condition."""
    plant = '[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    two = f'title = "Two parts"\nsource = "A book"\ntasks = ["observability", "characteristic_polynomial"]\n{plant}'
    one = 'title = "One part"\nsource = "Another book"\ntask = "observer"\n[symbols]\nc = "real"\n[plant]\nA = "[0 1; 0 0]"\n'
    (tmp_path / "two.toml").write_text(two, "utf-8")
    (tmp_path / "one.toml").write_text(f'{one}C = "[c 0]"\n[specification]\npoles = [-1, -2]\n', "utf-8")
    (tmp_path / "sheet.toml").write_text(HEAD + PROBLEMS, "utf-8")
    return tmp_path


def written(folder: Path, more: str, *options: str, problems: str = PROBLEMS) -> str:
    """The sheet with further keys in its head."""
    (folder / "sheet.toml").write_text(HEAD + more + problems, "utf-8")
    run = inside("sheet", "sheet.toml", *options, folder=folder)
    assert (run.code, run.err) == (0, "")
    return run.out


# -- the head ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FORMATS)
def test_the_head_stands_in_every_format(name: str, folder: Path) -> None:
    page = written(folder, "", "--questions", "--format", name)
    for text in ("Observers", "Systems", "Winter", "3a", "Tuesday", "Somebody", "Give reasons.", "Think of rank."):
        assert text in page
    assert page.index("Systems") < page.index("Two parts")
    assert page.index("Two parts") < page.index("Think of rank.")


@pytest.mark.parametrize("name", FORMATS)
def test_nothing_in_a_sheet_is_interpreted(name: str, folder: Path) -> None:
    told = json.dumps(HOSTILE)
    keys = ("title", "course", "term", "number", "due", "instructor", "text")
    head = "".join(f"{key} = {told}\n" for key in keys)
    (folder / "sheet.toml").write_text(f'{head}[[problem]]\nfile = "two.toml"\nhint = {told}\n', "utf-8")
    run = inside("sheet", "sheet.toml", "--questions", "--format", name, folder=folder)
    assert run.code == 0
    assert len(re.findall(r"alert", run.out)) >= len(keys) + 1
    if name in {"latex", "beamer"}:
        assert r"\input{x}" not in run.out
    if name == "html":
        assert "<script" not in run.out
    if name == "markdown":
        assert not re.search(r"<script|(?<!\\)\[a\]|(?<!\\)`c", run.out)


@tabled
def test_a_date_is_written_in_the_language_of_the_sheet(language: str, due: str, said: str, folder: Path) -> None:
    (folder / "sheet.toml").write_text(f'due = {due}\nlanguage = "{language}"\n{PROBLEMS}', "utf-8")
    assert f"{said}\n" in inside("sheet", "sheet.toml", "--questions", "--format", "text", folder=folder).out
    whole = json.loads(inside("sheet", "sheet.toml", "--questions", "--format", "json", folder=folder).out)
    assert whole["due"] == due


def test_points_add_up(folder: Path) -> None:
    page = written(folder, "", "--questions", "--format", "text")
    rows = [line.split() for line in page.splitlines() if line.startswith(("Problem  ", "Points", "Score"))]
    assert rows == [["Problem", "1", "2", "Total"], ["Points", "2.5", "7", "9.5"], ["Score"]]
    assert "Problem 1. Two parts (2.5 points)" in page
    assert re.search(r"observable\?\sGive\srank\s𝒪\.\s\(1\.5\spoints\)", page)
    assert re.search(r"\(b\) .*\(1\spoint\)", page)
    assert page.count("7 points") == 1  # one value is said at the title alone
    whole = json.loads(written(folder, "", "--format", "json"))
    assert [problem["points"] for problem in whole["problems"]] == [["1.5", "1"], ["7"]]
    assert (whole["course"], whole["number"]) == ("Systems", "3a")


def test_a_long_row_of_points_goes_on_in_a_second_table() -> None:
    entries = tuple(SheetEntry(number, "", "", points=(number,)) for number in range(1, 24))  # type: ignore[arg-type]
    tables = Sheet("", entries).totals
    assert [len(rows[0]) - 1 for rows in tables] == [10, 10, 4]
    assert tables[-1][1][-1] == str(23 * 24 // 2)


@tabled
def test_what_is_filled_in_stands_on_questions_alone(name: str, folder: Path) -> None:
    more = 'name = true\nanswers = "lines"\nspace = 4\n'
    marks = {
        "latex": r"\\answerlines\{5\}",
        "html": r'<div class="space ruled">(?:<div></div>){5}</div>',
        "text": "_{80}",
    }
    alone = written(folder, more, "--questions", "--format", name)
    assert len(re.findall(marks[name], alone)) == 3 * (5 if name == "text" else 1)  # three parts, lines 8 mm apart
    for word in ("Name", "Student number", "Score"):
        assert word in alone
    for options in ((), ("--solutions",)):
        page = written(folder, more, *options, "--format", name)
        assert not re.search(marks[name], page)
        assert "Student number" not in page
        assert "Score" not in page


def test_room_without_lines(folder: Path) -> None:
    page = written(folder, 'answers = "space"\nspace = 8\n', "--questions", "--format", "latex")
    assert page.count("\n\\answerspace{10}") == 3
    assert r"\answerlines{" not in page.split(r"\begin{document}")[1]
    slides = written(folder, 'answers = "lines"\n', "--questions", "--format", "beamer")
    assert r"\answerlines" not in slides


# -- hints, answers, examinations -------------------------------------------------------------------------------------


def test_hints_and_final_answers_end_the_questions(folder: Path) -> None:
    page = written(folder, "final_answers = true\n", "--format", "text")
    places = [page.index(f"\n{word}\n===") for word in ("Questions", "Hints", "Final answers", "Solutions")]
    assert places == sorted(places)
    hints = page[places[1] : places[2]]
    assert "Two parts" in hints
    assert "One part" not in hints
    answers, solutions = page[places[2] : places[3]], page[places[3] :]
    assert "✓" in solutions
    assert "References" in solutions
    for left_out in ("✓", "References", "Given", "Another book"):
        assert left_out not in answers
    assert re.search(r"c ≠ 0", answers)  # what an answer rests on is never left out
    assert "3/c" in answers
    assert "2/c" in answers
    only = written(folder, "final_answers = true\n", "--solutions", "--format", "text")
    assert "Final answers" not in only
    assert "Hints" not in only


def test_in_an_examination_a_solution_stands_below_its_question(folder: Path) -> None:
    page = written(folder, 'style = "exam"\n', "--format", "text")
    heads = ("Problem 1. Two parts", "Solution 1\n===", "Problem 2. One part", "Solution 2\n===")
    places = [page.index(head) for head in heads]
    assert places == sorted(places)
    assert page.count("A book.") == 1
    assert "Questions\n=" not in page
    handed_out = written(folder, 'style = "exam"\n', "--questions", "--format", "latex")
    assert handed_out.count("\n\\clearpage\n\\problemhead") == 1  # before the second problem
    assert "Student number" in handed_out
    assert handed_out.count("\n\\answerspace{5}") == 3


def test_one_convention_for_all_pages(folder: Path) -> None:
    own = written(folder, 'convention = "plusK-minusHC"\n', "--solutions", "--format", "text")
    assert "H = " in own
    other = written(
        folder, 'convention = "plusK-minusHC"\n', "--solutions", "--format", "text", "--convention", "standard"
    )
    assert "H = " not in other


# -- the picture ------------------------------------------------------------------------------------------------------


def test_the_picture_is_part_of_a_web_page(folder: Path) -> None:
    (folder / "logo.png").write_bytes(LOGO)
    page = written(folder, 'logo = "logo.png"\n', "--questions", "--format", "html")
    data = re.findall(r'src="data:image/png;base64,([^"]*)"', page)
    assert [base64.b64decode(each) for each in data] == [LOGO]
    assert "style-src 'unsafe-inline'; img-src data:\"" in page


def test_without_a_picture_a_web_page_allows_none(folder: Path) -> None:
    assert "img-src" not in written(folder, "", "--format", "html")


def test_latex_names_the_picture_from_where_it_is_written(folder: Path) -> None:
    (folder / "logo.png").write_bytes(LOGO)
    (folder / "elsewhere").mkdir()
    for target, place in (("elsewhere/sheet.tex", "../logo.png"), ("sheet.tex", "logo.png")):
        assert written(folder, 'logo = "logo.png"\n', "--questions", "-o", target) == ""
        assert f"keepaspectratio]{{{place}}}" in (folder / target).read_text("utf-8")


def test_a_web_page_refuses_a_pdf_before_any_work(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("symobs.cli.shared.sheet_entries._entry", lambda *_: pytest.fail("work has started"))
    (folder / "logo.pdf").write_bytes(b"%PDF-1.5\n")
    (folder / "sheet.toml").write_text(f'logo = "logo.pdf"\n{PROBLEMS}', "utf-8")
    run = inside("sheet", "sheet.toml", "-o", "sheet.html", folder=folder)
    assert run.code == 3
    assert run.err == (
        "sheet.toml, logo: the format html shows no picture of the kind pdf; "
        "give it as png or jpg, or write another format\n"
    )
    assert not (folder / "sheet.html").exists()


# -- the command ------------------------------------------------------------------------------------------------------


def test_a_sheet_is_named_alone(folder: Path) -> None:
    run = inside("sheet", "sheet.toml", "one.toml", folder=folder)
    assert (run.code, run.out) == (2, "")
    assert run.err.startswith("sheet.toml describes a whole sheet; name it alone")


def test_errors_of_a_sheet_end_it_before_any_work(folder: Path) -> None:
    (folder / "sheet.toml").write_text("corse = 1\n" + PROBLEMS.replace("one.toml", "gone.toml"), "utf-8")
    run = inside("sheet", "sheet.toml", "-o", "sheet.tex", folder=folder)
    assert (run.code, len(run.lines)) == (3, 2)
    assert run.lines[0] == "sheet.toml, corse: unknown key; did you mean course?"
    assert run.lines[1].startswith("sheet.toml, problem[1].file: gone.toml: No such file or directory")
    assert not (folder / "sheet.tex").exists()


def test_a_sheet_from_standard_input_has_its_problems_here(folder: Path) -> None:
    run = inside("sheet", "-", "--format", "text", folder=folder, stdin=(HEAD + PROBLEMS).encode())
    assert run.code == 0
    assert "Sheet 3a: Observers" in run.out


def test_a_problem_that_fails_keeps_its_place_and_its_points(folder: Path) -> None:
    (folder / "one.toml").write_text("task = ", "utf-8")
    run = inside("sheet", "sheet.toml", "--questions", "--format", "text", folder=folder)
    assert run.code == 3
    assert "Problem 2. one (7 points)" in run.out
    assert "This problem could not be solved." in run.out


@pytest.mark.slow
def test_children_write_the_same_sheet(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "broken.toml").write_text('task = "pbh"\n', "utf-8")
    (folder / "sheet.toml").write_text(f'{HEAD}{PROBLEMS}[[problem]]\nfile = "broken.toml"\n', "utf-8")
    arguments = ("sheet", "sheet.toml", "--format", "latex")
    alone = inside(*arguments, folder=folder)
    monkeypatch.setattr("symobs.cli.shared.sheet_entries._WORTH_CHILDREN", 2)
    assert inside(*arguments, "--memory", "4000", folder=folder) == alone
    assert alone.code == 3


@pytest.mark.slow
def test_what_takes_a_child_too_long_keeps_its_question(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "one.toml").write_text(GENERIC, "utf-8")
    monkeypatch.setattr("symobs.cli.shared.sheet_entries._WORTH_CHILDREN", 2)
    run = inside("sheet", "sheet.toml", "--format", "json", "--timeout", "3", folder=folder)
    assert run.code == 5
    assert run.err == (
        "one.toml: undecided: 3 seconds were not enough; give more with --timeout, ask for less, "
        "or put numbers in place of symbols\n"
    )
    first, second = json.loads(run.out)["problems"]
    assert first["results"][0]["verdict"] == "yes"
    assert (second["title"], second["results"]) == ("All of sixth order", None)
    assert "Design an observer" in second["question"]
    assert second["failure"] == PHRASES["sheet_undecided"]


# -- typeset ----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@tabled
def test_the_worked_sheet_is_typeset_without_a_fault(
    options: tuple[str, ...], tmp_path: Path, require_tool: RequireTool
) -> None:
    run = inside("sheet", str(SHEET), *options, "-o", str(tmp_path / "sheet.tex"))
    assert (run.code, run.err) == (0, "")
    faults, pages = typeset((tmp_path / "sheet.tex").read_text("utf-8"), tmp_path, require_tool("pdflatex"), 2)
    assert faults == []
    assert pages >= 6


@pytest.mark.slow
def test_a_head_is_typeset_without_a_fault_and_pdf_holds_its_picture(folder: Path, require_tool: RequireTool) -> None:
    pdflatex = require_tool("pdflatex")
    (folder / "logo.png").write_bytes(LOGO)
    more = 'logo = "logo.png"\nname = true\nanswers = "lines"\n'
    head = "".join(f"{key} = {json.dumps(HOSTILE)}\n" for key in ("title", "course", "instructor", "due", "text"))
    (folder / "sheet.toml").write_text(head + more + PROBLEMS, "utf-8")
    run = inside("sheet", "sheet.toml", "--questions", "-o", "sheet.tex", folder=folder)
    assert run.code == 0
    faults, pages = typeset((folder / "sheet.tex").read_text("utf-8"), folder, pdflatex, 2)
    assert (faults, pages) == ([], 3)
    assert inside("sheet", "sheet.toml", "--questions", "-o", "sheet.pdf", folder=folder).code == 0
    assert b"/Subtype /Image" in (folder / "sheet.pdf").read_bytes()


def test_a_sheet_without_a_file_has_no_head() -> None:
    sheet = Sheet("T", (SheetEntry(1, "f", "t"),))
    assert sheet.header == Header()
    assert (sheet.heading, sheet.course, sheet.facts, sheet.fields, sheet.totals) == ("T", "", (), (), ())


@pytest.mark.parametrize("name", ["text", "latex", "html", "markdown"])
def test_a_source_stands_once_on_a_sheet_of_questions_and_solutions(name: str, folder: Path) -> None:
    assert written(folder, "", "--format", name).count("Another book") == 1
    assert written(folder, "", "--solutions", "--format", name).count("Another book") == 1


def test_variants_of_one_problem_are_examinations_apart_and_those_of_two_are_one() -> None:
    def parts(*entries: SheetEntry) -> list[tuple[int, ...]]:
        sheet = Sheet("T", entries, header=Header(is_exam=True), has_solutions=False)
        return [tuple(entry.number for entry in part.entries) for part in sheet.apart]

    own, other = (SheetEntry(k, f"own/v00{k}.toml", "t", variant=f"a{k}") for k in (1, 2))
    beside = SheetEntry(3, "beside/v001.toml", "t", variant="b1")
    assert parts(own, other) == [(1,), (2,)]
    assert parts(own, beside) == [(1, 3)]
    assert parts(own, SheetEntry(4, "own/plain.toml", "t")) == [(1, 4)]
    assert parts(*(replace(entry, version=letter) for entry, letter in ((own, "A"), (other, "B")))) == [(1,), (2,)]
    assert parts() == [()]
