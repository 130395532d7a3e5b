"""PDF: TeX confined to its folder, its minute and its task."""

from __future__ import annotations

import os
import shutil
import signal
import stat
import subprocess
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from symobs.ground.errors import TypesettingError
from symobs.pages.formats import pdf
from symobs.pages.formats.pdf import Pdf, compiled
from tests.kit import tabled
from tests.support.examples import document_of
from tests.support.paths import ROOT
from tests.support.problems.steps import document, with_a_case
from tests.support.tools.command_line import SAFETY

if TYPE_CHECKING:
    from collections.abc import Callable

    RequireTool = Callable[[str], str]


pytestmark = pytest.mark.usefixtures("own_phrases")


def article(body: str) -> str:
    return rf"\documentclass{{article}}\begin{{document}}{body}\end{{document}}"


def words_of(page: bytes, folder: Path, pdftotext: str) -> str:
    (folder / "page.pdf").write_bytes(page)
    run = subprocess.run([pdftotext, "-layout", "page.pdf", "-"], cwd=folder, capture_output=True, check=True)
    return run.stdout.decode()


def test_the_page_to_aim_at(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    words = words_of(Pdf().render(document_of("output_feedback_servo")), tmp_path, require_tool("pdftotext"))
    assert "Remark." in words


HOSTILE = [
    "".join(map(chr, range(0x250))),
    r"\input{/etc/passwd}",
    r"\write18{touch /tmp/owned} \immediate\openout3=x.tex",
    r"}\end{document}\input|ls",
    "$$ $x^2$ \\[ \\( \\begin{align*}",
    "100 % of it %",
    "^^5cinput{/etc/passwd} ^^M",
    "{{{{ }} &#~_^",
    r"\def\x{\x\x}\x \loop\iftrue\repeat",
    "first\n\nsecond\\par\tthird \x00\x1b",
    "Łódź, Zürich, 東京, \u202eabc, 😀, x\u0302, ω, −1 ≤ ½",
    "x" * 5000,
    "word " * 1000,
    r"\csname end\endcsname \catcode`\%=12 \endinput",
]


@pytest.mark.slow
@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_text_is_shown_and_does_nothing(text: str, require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    page = Pdf().render(document(with_a_case(), title=text, source=text))
    words = words_of(page, tmp_path, require_tool("pdftotext"))
    assert "root:" not in words
    assert "Given." in words
    for part in ("input{/etc/passwd}", "write18{touch", "end{document}", "begin{align*}", "100 % of it %"):
        assert "".join(words.split()).count("".join(part.split())) >= 2 * (part in text)


@tabled
def test_tex_reads_nothing_outside_its_folder(name: str, require_tool: RequireTool) -> None:
    require_tool("pdflatex")
    with pytest.raises(TypesettingError, match="not found"):
        compiled(article(rf"\input{{{name}}}"))


#: A display with its line takes some 27 pt of the 724 pt of a page, by hand.
@pytest.mark.parametrize(("displays", "pages"), [(20, 1), (27, 1), (40, 2)], ids=["one", "drawn in", "two"])
def test_a_last_page_is_drawn_in_where_little_stands_on_it(
    displays: int, pages: int, require_tool: RequireTool, tmp_path: Path
) -> None:
    begin = (ROOT / "latex_templates/article.tex").read_text("utf-8")
    geometry = begin[begin.index(r"\usepackage[hmargin") :].partition("\n")[0]
    told = "".join(rf"Line {k}.\[x={k}\]" for k in range(displays))
    source = rf"\documentclass[10pt,a4paper]{{article}}{geometry}\parindent=0pt\begin{{document}}{told}\end{{document}}"
    words = words_of(compiled(source), tmp_path, require_tool("pdftotext"))
    assert words.count("\f") == pages
    assert f"Line {displays - 1}." in words


def test_a_last_page_that_stays_gets_more(require_tool: RequireTool, tmp_path: Path) -> None:
    """68 lines of 12 pt are 1.13 pages of 60; with a third of the last page filled some 50 and 18 of them."""
    begin = (ROOT / "latex_templates/article.tex").read_text("utf-8")
    geometry = begin[begin.index(r"\usepackage[hmargin") :].partition("\n")[0]
    told = r"\par ".join(f"Line {k}." for k in range(68))
    source = rf"\documentclass[10pt,a4paper]{{article}}{geometry}\parindent=0pt\begin{{document}}{told}\end{{document}}"
    first, last, rest = words_of(compiled(source), tmp_path, require_tool("pdftotext")).split("\f")
    assert rest == ""
    assert first.count("Line") + last.count("Line") == 68
    assert last.count("Line") >= 15


def test_plots_are_smaller_where_a_last_page_is_drawn_in(require_tool: RequireTool, tmp_path: Path) -> None:
    """A plot of 200 pt and displays of 520: at two thirds of its height a page holds both, at the whole height none does."""
    begin = (ROOT / "latex_templates/article.tex").read_text("utf-8")
    geometry = begin[begin.index(r"\usepackage[hmargin") :].partition("\n")[0]
    told = "".join(rf"Line {k}.\[x={k}\]" for k in range(21))
    pages = []
    for style in ("closer/.try", ""):
        plot = rf"\begin{{tikzpicture}}[x=1pt,y=1pt,{style}]\draw (0,0) rectangle (10,200);\end{{tikzpicture}}"
        packages = rf"\documentclass[10pt,a4paper]{{article}}\usepackage{{tikz}}{geometry}\parindent=0pt"
        source = rf"{packages}\begin{{document}}{told}\par {plot}\end{{document}}"
        pages.append(words_of(compiled(source), tmp_path, require_tool("pdftotext")).count("\f"))
    assert pages == [1, 2]


def test_tex_runs_no_program(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    compiled(article(rf"x\immediate\write18{{touch {tmp_path}/owned}}"))
    assert not (tmp_path / "owned").exists()


def test_the_first_error_of_tex_is_reported(require_tool: RequireTool) -> None:
    require_tool("pdflatex")
    with pytest.raises(TypesettingError) as caught:
        compiled(article("\n\n\\undefined\n\\alsoundefined"))
    assert str(caught.value).startswith("line 3 of the LaTeX: TeX failed: Undefined control sequence")
    assert caught.value.exit_code == 6


def test_a_package_that_is_missing_is_named_with_what_to_install(require_tool: RequireTool) -> None:
    require_tool("pdflatex")
    with pytest.raises(TypesettingError, match=r"nosuchpackage\.sty.*texlive-latex-recommended"):
        compiled(r"\documentclass{article}\usepackage{nosuchpackage}\begin{document}x\end{document}")


def test_without_tex_the_message_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(TypesettingError) as caught:
        Pdf().render(document(title="No TeX"))
    assert "texlive-latex-recommended texlive-pictures latexmk" in caught.value.repair
    assert caught.value.exit_code == 6


def test_without_latexmk_pdflatex_runs_twice(
    monkeypatch: pytest.MonkeyPatch, require_tool: RequireTool, tmp_path: Path
) -> None:
    calls = tmp_path / "calls"
    program(tmp_path / "pdflatex", f'echo once >> {calls}\nexec {require_tool("pdflatex")} "$@"')
    which = {"pdflatex": str(tmp_path / "pdflatex")}
    monkeypatch.setattr(shutil, "which", which.get)
    assert compiled(article("x")).startswith(b"%PDF-")
    assert calls.read_text("utf-8").split() == ["once", "once"]


def test_time_limit_ends_tex_and_all_it_started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    number = tmp_path / "number"
    program(tmp_path / "pdflatex", f"sleep 100 &\necho $! > {number}\nwait")
    which = {"pdflatex": str(tmp_path / "pdflatex")}
    monkeypatch.setattr(shutil, "which", which.get)
    with pytest.raises(TypesettingError, match=r"stopped after 0\.5 seconds"):
        compiled(article("x"), time_limit=0.5)
    assert ends(int(number.read_text("utf-8")))


@pytest.mark.parametrize(("number", "raised"), [(signal.SIGTERM, SystemExit), (signal.SIGINT, KeyboardInterrupt)])
def test_an_end_that_comes_while_tex_is_being_started_ends_it(
    number: int, raised: type[BaseException], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    begun: list[int] = []

    class Popen(subprocess.Popen[bytes]):
        def __init__(self, *arguments: Any, **options: Any) -> None:
            super().__init__(*arguments, **options)
            begun.append(self.pid)
            signal.raise_signal(number)

    program(tmp_path / "pdflatex", "exec sleep 1000")
    only(monkeypatch, tmp_path / "pdflatex")
    monkeypatch.setattr(subprocess, "Popen", Popen)
    before = signal.getsignal(number)
    with pytest.raises(raised):
        pdf.compiled("")
    assert ends(begun[0])
    assert signal.getsignal(number) == before


def only(monkeypatch: pytest.MonkeyPatch, path: Path) -> None:
    """Let this be the only TeX there is."""
    monkeypatch.setattr(shutil, "which", {"pdflatex": str(path)}.get)


def test_tex_that_floods_its_log_is_stopped(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    number = tmp_path / "number"
    program(tmp_path / "pdflatex", f"echo $$ > {number}\nyes 'a line that says nothing' > page.log")
    only(monkeypatch, tmp_path / "pdflatex")
    monkeypatch.setattr(pdf, "SIZE_LIMIT", 20)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    with pytest.raises(TypesettingError) as caught:
        compiled(article("x"))
    assert str(caught.value) == "TeX was stopped after it had written 20 MB; write LaTeX with --format latex to see why"
    assert ends(int(number.read_text("utf-8")))
    assert {path.name for path in tmp_path.iterdir()} == {"number", "pdflatex"}


def program(path: Path, script: str) -> None:
    path.write_text(f"#!/bin/sh\n{script}\n", "utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def ends(process: int) -> bool:
    """Whether a process has ended, or does so before a test is given up; one that nobody has waited for yet has."""
    end = time.monotonic() + SAFETY
    while time.monotonic() < end:
        try:
            os.kill(process, 0)
            state = Path(f"/proc/{process}/stat")
            if state.exists() and state.read_text("utf-8").rpartition(")")[2].split()[0] == "Z":
                return True
        except (ProcessLookupError, FileNotFoundError):
            return True
        time.sleep(0.05)
    return False
