"""Sheets: several problems on one, what it says where one fails, and that it can be typeset as a whole."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from io import StringIO
from typing import TYPE_CHECKING

import pytest

from symobs.cli.commands.sheet import _Progress
from symobs.pages.formats.pdf import SLOWEST, TIME_LIMIT, Pdf
from symobs.pages.page.sheet import WITHOUT_CONTENTS, Sheet, SheetEntry
from symobs.tasks.result import formats
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import EXAMPLES, SERVO, fresh, inside

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    RequireTool = Callable[[str], str]

OBSERVER = ROOT / "worked_examples" / "servo_observer.toml"
REGION = ROOT / "worked_examples" / "region_nonconvex.toml"
FAULTS = re.compile(r"^(?:! .*|LaTeX Warning.*|Overfull .*)", re.MULTILINE)


@pytest.fixture(name="folder")
def folder_with_problems(tmp_path: Path) -> Path:
    """Files of every kind of outcome."""
    plant = '[plant]\nA = "[1 0; 0 1]"\nC = "[1 0]"\n'
    files = {
        "good": f'title = "Good & well"\ntask = "characteristic_polynomial"\n{plant}',
        "bad": f'title = "Bad"\ntask = "observer"\n{plant}[specification]\npoles = [-1]\n',
        "broken": "title = ",
        "no": f'title = "No"\ntask = "observability"\n{plant}',
        "unmet": f'title = "Unmet"\ntask = "observability"\n{plant}[expect]\nrank = 2\n',
        "met": f'title = "Met"\ntask = "observability"\n{plant}[expect]\nrank = 1\n',
    }
    for name, text in files.items():
        (tmp_path / f"{name}.toml").write_text(text, "utf-8")
    return tmp_path


# -- what stands on it ------------------------------------------------------------------------------------------------


def test_all_questions_come_first_then_all_solutions(folder: Path) -> None:
    run = inside("sheet", "good.toml", str(OBSERVER), "--title", "Sheet 1", "--format", "text", folder=folder)
    assert run.code == 0, run.err
    places = [
        run.out.index(text) for text in ("Sheet 1\n===", "Questions\n===", "Problem 1. Good & well", "Problem 2.")
    ]
    places += [run.out.index("Solutions\n===")]
    places += [run.out.rindex(text) for text in ("Problem 1. Good & well", "Problem 2.", "(s + 10)², as required")]
    assert places == sorted(places)
    assert run.out.count("(lecture notes), Example 4.1") == 1
    assert "Design an observer with the poles -10, -10." in run.out


@tabled
def test_a_problem_without_a_title_has_the_name_of_its_file(name: str, folder: Path) -> None:
    (folder / "untitled.toml").write_text('task = "observability"\n[plant]\nA = "[1]"\nC = "[1]"\n', "utf-8")
    run = inside("sheet", "untitled.toml", "--format", name, folder=folder)
    assert run.code == 0, run.err
    assert run.out.count("untitled") == 2


@tabled
def test_one_half_of_a_sheet(flag: str, has: str, has_not: str, folder: Path) -> None:
    run = inside("sheet", "good.toml", flag, "--format", "text", folder=folder)
    assert run.code == 0
    assert has in run.out
    assert has_not not in run.out
    assert "Given" in run.out  # solutions alone give the data too


@tabled
def test_the_questions_of_an_exam_hold_neither_answers_nor_hints(options: list[str], tmp_path: Path) -> None:
    (tmp_path / "exam.toml").write_text(
        f'title = "Exam"\nstyle = "exam"\nfinal_answers = true\n[[problem]]\nfile = "{OBSERVER}"\nhint = "By heart."\n',
        encoding="utf-8",
    )
    run = inside("sheet", "exam.toml", "--questions", *options, folder=tmp_path)
    assert run.code == 0, run.err
    assert "By heart" not in run.out
    entry = r"\b81\b(?!b)"  # of L; no colour
    assert not re.search(entry, run.out)
    assert re.search(entry, inside("sheet", "exam.toml", "--solutions", *options, folder=tmp_path).out)


def test_every_part_has_symbols_and_time_of_its_own(folder: Path) -> None:
    texts = {
        "first": '[symbols]\nw = { sign = "positive", latex = "\\\\Xi" }\n[plant]\nA = "[0 w; 1 0]"\n',
        "second": '[symbols]\nw = "real"\n[plant]\nA = "[0 w; 1 0]"\ndt = true\n',
    }
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(f'task = "characteristic_polynomial"\n{text}', "utf-8")
    run = inside("sheet", "first.toml", "second.toml", "--solutions", folder=folder)
    assert run.code == 0, run.err
    first, second = run.out.split(r"\problemhead{2.}")
    assert r"\dot x" in first
    assert r"s^2-\Xi" in first
    assert "x_{k+1}" in second
    assert "z^2-w" in second


def test_every_part_keeps_the_convention_of_its_file(folder: Path) -> None:
    plant = '[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\n'
    own = {"S1": 'M = "[-1; -3]"', "S4": 'H = "[1; 3]"', "standard": 'L = "[1; 3]"'}
    for name, gain in own.items():
        text = f'task = "observer"\nconvention = "{name}"\n{plant}{gain}\n'
        (folder / f"{name}.toml").write_text(text, "utf-8")
    files = [f"{name}.toml" for name in own]
    run = inside("sheet", *files, "--questions", "--format", "text", folder=folder)
    assert run.code == 0, run.err
    first, second, third = re.split("Problem [123]", run.out)[1:]
    assert "M = ⎡-1⎤" in first
    assert "A + M C" in first
    assert "H = ⎡1⎤" in second
    assert "A - H C" in second
    assert "L = ⎡1⎤" in third
    assert "the observer with the gain M" in " ".join(first.split())
    together = inside("sheet", *files, "--convention", "standard", "--format", "text", folder=folder)
    assert "M C" not in together.out
    assert together.out.count("L = ⎡1⎤") >= 3


def test_a_web_page_links_its_contents_and_names_every_place_once() -> None:
    files = [str(path) for path in EXAMPLES[:WITHOUT_CONTENTS]] + [str(SERVO)]
    page = inside("sheet", *files, "--format", "html", "--title", "All").out
    ids = re.findall(r'id="([^"]*)"', page)
    assert len(ids) == len(set(ids))
    links = re.findall(r'href="#([^"]*)"', page)
    assert len(links) == 2 * len(files)
    assert set(links) <= set(ids)
    assert "\0" not in page
    assert "http-equiv" in page  # the page that forbids itself everything from outside


def test_the_same_sheet_gives_the_same_text() -> None:
    first, second = (inside("sheet", str(SERVO), str(REGION), "--title", "Twice") for _ in range(2))
    assert first == second


def test_json_holds_every_problem(folder: Path) -> None:
    run = inside("sheet", "good.toml", "bad.toml", "no.toml", "--title", "T", "--format", "json", folder=folder)
    whole = json.loads(run.out)
    assert (whole["schema"], whole["title"]) == ("symobs/1", "T")
    good, bad, no = whole["problems"]
    assert (good["file"], good["title"]) == ("good.toml", "Good & well")
    assert good["results"][0]["polynomial"] == "s**2 - 2*s + 1"
    assert bad["results"] is None
    assert bad["failure"] == "This problem could not be solved."
    assert no["results"][0]["verdict"] == "no"
    assert "Is the pair (C, A) observable?" in no["question"]
    only = json.loads(inside("sheet", "good.toml", "--questions", "--format", "json", folder=folder).out)["problems"][0]
    assert "results" not in only


def test_contents_stand_on_long_sheets_only(folder: Path) -> None:
    short = inside("sheet", *["good.toml"] * WITHOUT_CONTENTS, folder=folder).out
    long = inside("sheet", *["good.toml"] * (WITHOUT_CONTENTS + 1), folder=folder).out
    assert "{Contents}" not in short
    assert "{Contents}" in long
    row = (
        rf"\contentsrow{{{WITHOUT_CONTENTS + 1}.}}{{Good \& well}}{{\pageref{{questions-7}}, \pageref{{solutions-7}}}}"
    )
    assert row in long


def test_detail_holds_for_solutions() -> None:
    full, answer = (
        inside("sheet", str(OBSERVER), "--detail", level, "--format", "text") for level in ("full", "answer")
    )
    assert "copy of the plant" in full.out
    assert "copy of the plant" not in answer.out
    assert "Design an observer with the poles" in answer.out


# -- what fails -------------------------------------------------------------------------------------------------------


def test_one_that_fails_loses_no_other(folder: Path) -> None:
    run = inside("sheet", "broken.toml", "bad.toml", "good.toml", "--format", "text", folder=folder)
    assert run.code == 3
    failed = "This problem could not be solved."
    assert run.out.count(failed) == 3
    assert "Problem 1. broken\n=" in run.out
    assert "Design an observer with the pole -1." in run.out  # what is asked can be told, not what comes of it
    assert f"Problem 2. Bad\n{'=' * 14}\n\n{failed}" in run.out
    assert "χ_A(s) = " in run.out
    broken, bad = run.lines
    assert broken.startswith("broken.toml, its end: this is not TOML: Invalid value; write")
    assert bad.startswith("bad.toml: specification.poles: 1 pole given, 2 needed; give as many poles")


@tabled
def test_the_exit_code_is_the_worst(names: list[str], code: int, folder: Path) -> None:
    run = inside("sheet", *(f"{name}.toml" for name in names), "--format", "text", folder=folder)
    assert run.code == code
    assert "Solutions" in run.out
    assert len(run.lines) == sum(name in {"no", "bad", "unmet"} for name in names)


def test_a_bug_in_one_problem_loses_no_other(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object) -> None:
        raise ZeroDivisionError("of ours")

    monkeypatch.setattr("symobs.cli.shared.sheet_entries.question_of", failing)
    run = inside("sheet", "good.toml", "bad.toml", "--format", "text", folder=folder)
    assert run.code == 1
    assert run.lines[0] == "good.toml: internal error: ZeroDivisionError: of ours; please report this"
    assert "Problem 2. Bad" in run.out


@tabled
def test_what_can_be_said_before_work_starts_is(
    arguments: list[str], code: int, said: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "folder.tex").mkdir()
    monkeypatch.setattr("symobs.cli.shared.sheet_entries._entry", lambda *_: pytest.fail("work has started"))
    run = inside("sheet", *arguments, folder=folder)
    assert (run.code, run.out) == (code, "")
    assert said in run.err


def test_standard_input_may_be_one_of_the_problems(folder: Path) -> None:
    text = (folder / "good.toml").read_bytes()
    run = inside("sheet", "-", "met.toml", "--format", "text", folder=folder, stdin=text)
    assert run.code == 0
    assert "Problem 1. Good & well" in run.out


def test_without_tex_nothing_is_solved_in_vain(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(folder))
    run = inside("sheet", "good.toml", "no.toml", "-o", "sheet.pdf", folder=folder)
    assert run.code == 6
    assert len(run.lines) == 1
    assert not (folder / "sheet.pdf").exists()


# -- a terminal -------------------------------------------------------------------------------------------------------


class Terminal(StringIO):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_progress_is_one_line_that_goes_away(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    progress = _Progress(107)
    progress.show(12, "servo\x1b[31m_observer")
    progress.clear()
    written = terminal.getvalue()
    assert written.startswith("\r\x1b[K12/107 servo")
    assert written.endswith("\r\x1b[K")
    assert "\n" not in written
    assert "\x1b[31m" not in written


def test_no_progress_where_nobody_looks(folder: Path) -> None:
    run = fresh("sheet", "good.toml", "met.toml", "--format", "text", folder=folder)
    assert (run.code, run.err) == (0, "")


# -- typeset ----------------------------------------------------------------------------------------------------------


def typeset(source: str, folder: Path, pdflatex: str, runs: int = 1) -> tuple[list[str], int]:
    """Return what TeX finds wrong with a document, and its pages."""
    (folder / "page.tex").write_text(source, "utf-8")
    for _ in range(runs):
        command = [pdflatex, "-interaction=nonstopmode", "-no-shell-escape", "page.tex"]
        subprocess.run(command, cwd=folder, capture_output=True, check=False)
    log = (folder / "page.log").read_text(encoding="latin-1")
    pages = re.search(r"Output written on page\.pdf \((\d+) pages?", log)
    assert pages, log[-1000:]
    return [fault for fault in FAULTS.findall(log) if wide(fault)], int(pages[1])


def wide(fault: str) -> bool:
    """Whether a fault is none, or a box too full by more than a point."""
    size = re.search(r"\(([\d.]+)pt too", fault)
    return size is None or float(size[1]) > 1


@pytest.mark.slow
def test_a_sheet_is_typeset_without_a_fault(folder: Path, require_tool: RequireTool) -> None:
    hostile = r"100 % of $x_1^2$ \input{x} & #~ " * 4
    text = f"title = {json.dumps(hostile)}\nsource = {json.dumps(hostile)}\n"
    (folder / "hostile.toml").write_text(text + (folder / "good.toml").read_text().partition("\n")[2], "utf-8")
    gramian = ROOT / "worked_examples" / "third_order_gramian.toml"  # wide: functions of time in a matrix
    files = ["hostile.toml", "bad.toml", "no.toml", str(SERVO), str(REGION), str(gramian), "good.toml"]
    run = inside("sheet", *files, "--title", hostile, folder=folder)
    faults, pages = typeset(run.out, folder, require_tool("pdflatex"), runs=2)
    assert faults == []
    assert pages > 5


def test_tex_has_more_time_for_a_longer_sheet(monkeypatch: pytest.MonkeyPatch) -> None:
    limits: list[float] = []

    def recorded(_: str, *, time_limit: float, **_pictures: object) -> bytes:
        limits.append(time_limit)
        return b""

    monkeypatch.setattr("symobs.pages.formats.pdf.compiled", recorded)
    long = {"body": "x" * int(200 * SLOWEST), "drawings": False}
    for part in ({"body": "x", "drawings": False}, long):
        Pdf().sheet(Sheet("", (SheetEntry(1, "file", "title", part, part),)))
    assert limits[0] == TIME_LIMIT
    assert limits[1] > 400


@pytest.mark.slow
def test_slides_are_typeset_without_a_fault(tmp_path: Path, require_tool: RequireTool) -> None:
    names = {
        "two_masses_parametric",
        "region_nonconvex",
        "cart_pole",
        "pendulum_hanging_region",
        "output_feedback_servo",
    }
    files = [str(path) for path in EXAMPLES if path.stem in names]
    run = inside("sheet", *files, "--solutions", "--format", "beamer", "--title", "Slides")
    assert len(files) == len(names)
    faults, pages = typeset(run.out, tmp_path, require_tool("pdflatex"))
    assert faults == []
    assert pages > 40


def test_slides_of_one_problem_begin_with_their_title(tmp_path: Path, require_tool: RequireTool) -> None:
    run = inside("solve", str(OBSERVER), "--format", "beamer")
    assert run.code == 0
    assert r"\begin{frame}[t,allowframebreaks=.9]{Observer}" in run.out
    faults, pages = typeset(run.out, tmp_path, require_tool("pdflatex"))
    assert faults == []
    assert pages > 3


def test_a_figure_a_sentence_and_references_are_two_slides(tmp_path: Path, require_tool: RequireTool) -> None:
    run = inside("solve", str(ROOT / "worked_examples" / "margins_compensator.toml"), "--format", "beamer")
    assert typeset(run.out, tmp_path, require_tool("pdflatex"))[0] == []


def test_a_problem_told_in_words_begins_the_first_slide(folder: Path) -> None:
    text = (
        'title = "T"\ntext = "Two states, one seen."\ntask = "observability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    )
    (folder / "words.toml").write_text(text, "utf-8")
    run = inside("solve", "words.toml", "--format", "beamer", folder=folder)
    frames = run.out.split(r"\begin{frame}")[1:]
    assert [frame.partition("{")[2].partition("}")[0] for frame in frames] == ["", "Given", "Observability"]
    assert frames[1].splitlines()[1] == "Two states, one seen."


def test_a_suffix_never_means_slides(folder: Path) -> None:
    run = inside("sheet", "good.toml", "-o", "out.tex", folder=folder)
    assert run.code == 0
    assert "{article}" in (folder / "out.tex").read_text("utf-8")


@pytest.mark.parametrize("name", [name for name, kind in formats().items() if hasattr(kind, "sheet") and name != "pdf"])
def test_every_format_with_sheets_says_what_failed(name: str, folder: Path) -> None:
    run = inside("sheet", "bad.toml", "good.toml", "--format", name, folder=folder)
    assert run.code == 3
    assert "could not be solved" in run.out
    assert "Good" in run.out
