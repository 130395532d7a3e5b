"""PDF: TeX confined to its folder, its minute and its task."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import time
from typing import TYPE_CHECKING

import pytest

from symobs.errors import TypesettingError
from symobs.phrases import PHRASES
from symobs.render.pdf import Pdf, compiled
from tests import render_examples as example
from tests.render_examples import document

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    RequireTool = Callable[[str], str]


@pytest.fixture(autouse=True)
def _phrases(monkeypatch: pytest.MonkeyPatch) -> None:
    for key, phrase in example.PHRASES.items():
        monkeypatch.setitem(PHRASES, key, phrase)


def article(body: str) -> str:
    return rf"\documentclass{{article}}\begin{{document}}{body}\end{{document}}"


def words_of(page: bytes, folder: Path, pdftotext: str) -> str:
    (folder / "page.pdf").write_bytes(page)
    run = subprocess.run([pdftotext, "-layout", "page.pdf", "-"], cwd=folder, capture_output=True, check=True)
    return run.stdout.decode()


def test_the_page_to_aim_at(require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    words = words_of(Pdf().render(example.target_document()), tmp_path, require_tool("pdftotext"))
    assert "Output feedback of 1/(s(s+1)) with a full-order observer" in words
    assert "4. Closed loop." in words
    assert "A caution." in words


def test_the_same_page_gives_the_same_bytes(require_tool: RequireTool) -> None:
    require_tool("pdflatex")
    first, second = (Pdf().render(document(title="Twice")) for _ in range(2))
    assert first.startswith(b"%PDF-")
    assert first == second


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


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_text_is_shown_and_does_nothing(text: str, require_tool: RequireTool, tmp_path: Path) -> None:
    require_tool("pdflatex")
    page = Pdf().render(document(example.with_a_case(), title=text, source=text))
    words = words_of(page, tmp_path, require_tool("pdftotext"))
    assert "root:" not in words
    assert "Given." in words
    for part in ("input{/etc/passwd}", "write18{touch", "end{document}", "begin{align*}", "100 % of it %"):
        assert "".join(words.split()).count("".join(part.split())) >= 2 * (part in text)


@pytest.mark.parametrize("name", ["/etc/passwd", "../secret.tex", ".hidden"])
def test_tex_reads_nothing_outside_its_folder(name: str, require_tool: RequireTool) -> None:
    require_tool("pdflatex")
    with pytest.raises(TypesettingError, match="not found"):
        compiled(article(rf"\input{{{name}}}"))


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
    assert calls.read_text(encoding="utf-8").split() == ["once", "once"]


def test_time_limit_ends_tex_and_all_it_started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    number = tmp_path / "number"
    program(tmp_path / "pdflatex", f"sleep 100 &\necho $! > {number}\nwait")
    which = {"pdflatex": str(tmp_path / "pdflatex")}
    monkeypatch.setattr(shutil, "which", which.get)
    with pytest.raises(TypesettingError, match=r"stopped after 0\.5 seconds"):
        compiled(article("x"), time_limit=0.5)
    assert ends(int(number.read_text(encoding="utf-8")))


def test_tex_that_says_nothing_is_reported(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    program(tmp_path / "pdflatex", "exit 1")
    which = {"pdflatex": str(tmp_path / "pdflatex")}
    monkeypatch.setattr(shutil, "which", which.get)
    with pytest.raises(TypesettingError, match="without an error in its log"):
        compiled(article("x"))


def program(path: Path, script: str) -> None:
    path.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def ends(process: int) -> bool:
    """Whether a process ends within a few seconds."""
    for _ in range(50):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False
