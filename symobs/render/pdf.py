"""PDF: the article, typeset by the TeX found on PATH.

TeX reads and writes inside a temporary folder only, runs no other program, and has a minute.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from symobs.errors import TypesettingError
from symobs.method import output_format
from symobs.render.latex import typeset, typeset_sheet, values_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.method import Document
    from symobs.sheet import Sheet

TIME_LIMIT = 60.0  # seconds
#: Characters of LaTeX a second that TeX, run three times on a slow and busy machine, surely gets through.
SLOWEST = 2000.0
_INSTALL = (
    "install TeX; on Debian or Ubuntu: apt-get install texlive-latex-recommended texlive-pictures latexmk "
    "(or write LaTeX with --format latex)"
)
_SOURCE = "page.tex"
_OPTIONS = ("-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape")
_CONFINED = {
    "openin_any": "p",  # paranoid: nothing above the working folder, no hidden files, no absolute names
    "openout_any": "p",
    "shell_escape": "f",
    "max_print_line": "1000",  # else the log breaks an error's line in two
    # The same page gives the same bytes, whenever it is made.
    "SOURCE_DATE_EPOCH": "0",
    "FORCE_SOURCE_DATE": "1",
}


@output_format
class Pdf:
    """The article as PDF."""

    name: ClassVar[str] = "pdf"
    suffix: ClassVar[str] = ".pdf"
    template: ClassVar[str] = "article.tex"

    def render(self, document: Document) -> bytes:
        """Return the bytes of the PDF."""
        return compiled(typeset(document, self.template, folder=document.templates))

    def part(self, document: Document) -> dict[str, object]:
        """Return what a template says of a question or a solution."""
        _commands()  # without TeX there is no need to go on
        return values_of(document)

    def sheet(self, sheet: Sheet) -> bytes:
        """Return the bytes of the sheet's PDF."""
        source = typeset_sheet(sheet, "sheet.tex")
        return compiled(source, time_limit=max(TIME_LIMIT, len(source) / SLOWEST))


def compiled(source: str, *, time_limit: float = TIME_LIMIT) -> bytes:
    """Return the PDF that TeX makes of a LaTeX document."""
    commands = _commands()
    with tempfile.TemporaryDirectory(prefix="symobs-") as name:
        folder = Path(name)
        (folder / _SOURCE).write_text(source, encoding="utf-8")
        for command in commands:
            if _run(command, folder, time_limit) != 0:
                raise _failure(folder)
        return (folder / _SOURCE).with_suffix(".pdf").read_bytes()


def _commands() -> tuple[tuple[str, ...], ...]:
    """Return what to run: latexmk, which knows how often; without it pdflatex twice, for its references."""
    pdflatex, latexmk = shutil.which("pdflatex"), shutil.which("latexmk")
    if pdflatex is None:
        raise TypesettingError("pdflatex is not on PATH", repair=_INSTALL)
    if latexmk is None:
        return ((pdflatex, *_OPTIONS, _SOURCE),) * 2
    # -norc: a personal set-up of latexmk could allow what is forbidden here.
    return ((latexmk, "-norc", "-pdf", f"-pdflatex=pdflatex {' '.join(_OPTIONS)} %O %S", _SOURCE),)


def _run(command: Sequence[str], folder: Path, time_limit: float) -> int:
    """Run a command in `folder` and return its exit code; whatever ends this ends all it has started."""
    process = subprocess.Popen(  # noqa: S603 - a program found on PATH, a source that is escaped, no shell
        command,
        cwd=folder,
        env=_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        return process.wait(time_limit)
    except subprocess.TimeoutExpired as error:
        raise TypesettingError(f"TeX was stopped after {time_limit:g} seconds") from error
    finally:
        _end(process)


def _environment() -> Mapping[str, str]:
    return {**os.environ, **_CONFINED}


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and its children, unless it has ended by itself."""
    if process.poll() is not None:
        return
    with suppress(ProcessLookupError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.wait()


def _failure(folder: Path) -> TypesettingError:
    """Return the first error in TeX's log."""
    log = (folder / _SOURCE).with_suffix(".log")
    text = log.read_text(encoding="latin-1") if log.exists() else ""
    error = re.search(r"^! (.*)", text, re.MULTILINE)
    if error is None:
        return TypesettingError("TeX ended without a page and without an error in its log", repair=_INSTALL)
    place = re.search(r"^l\.(\d+)", text[error.end() :], re.MULTILINE)
    return TypesettingError(
        f"TeX failed: {error[1].strip()}",
        where=f"line {place[1]} of the LaTeX" if place else "",
        repair=_INSTALL if "not found" in error[1] else "write LaTeX with --format latex to see that line",
    )
