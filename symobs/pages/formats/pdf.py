"""PDF: the LaTeX article, typeset by TeX.

TeX reads and writes inside a temporary folder only, runs no other program, and has a minute and 200 MB for its files.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from contextlib import contextmanager, suppress
from dataclasses import replace
from math import floor
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.ground.child_processes.inside import running
from symobs.ground.errors import TypesettingError
from symobs.pages.formats.latex import typeset, typeset_sheet, values_of
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from types import FrameType

    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document

TIME_LIMIT = 60.0  # seconds
#: Characters of LaTeX a second that TeX, run three times on a slow and busy machine, surely gets through.
SLOWEST = 2000.0
#: Megabytes that TeX may write: a page has less than one, and a log that never ends would fill the disk.
SIZE_LIMIT = 200
#: What is said of an error that came while TeX was running.
TEX_AT_WORK = "TeX was at work"
_LOOK_EVERY = 0.2  # seconds
_LAST_OF_LOG = 1 << 20  # bytes; TeX stops at its first error, which stands there
_INSTALL = (
    "install TeX; on Debian or Ubuntu: apt-get install texlive-latex-recommended texlive-pictures latexmk "
    "(or write LaTeX with --format latex)"
)
_SOURCE = "page.tex"
#: A last page is drawn in where less than this part of it is filled, if that is enough: displays are set closer, pages
#: are 14 mm higher, plots a third smaller, and the references run on.
_SHORTEST = 0.3
_CLOSER = (
    r"\addtolength{\textheight}{14mm}\addtolength{\topmargin}{-7mm}\everydisplay{\abovedisplayskip=3pt plus 1pt minus 2pt"
    r"\belowdisplayskip=\abovedisplayskip}\let\references\relax\let\endreferences\relax"
    r"\newenvironment{references}[1]{\def\item{\stepcounter{enumi}\hskip.8em plus .4em[\arabic{enumi}]~}"
    r"\setcounter{enumi}{0}\par\nopagebreak\smallskip\noindent\footnotesize\textbf{#1}}{\par}"
    r"\ifdefined\tikzset\tikzset{closer/.style={scale=.65}}\fi"
)
#: Where that is not enough, pages are lower, so that the last one gets more: this part of it, or else the next.
_WANTED = (0.35, 0.45)
_LOWER = r"\dimen0=\textheight\textheight={part}\textheight\advance\dimen0-\textheight\advance\footskip\dimen0"
_MEASURED = r"\AtEndDocument{\par\typeout{symobs fills \thepage, \the\pagetotal\space of \the\textheight}}"
_WRITTEN = re.compile(r"^Output written on .*\((\d+) page", re.MULTILINE)
_FILLED = re.compile(r"^symobs fills (\d+), ([\d.]+)pt of ([\d.]+)pt$", re.MULTILINE)
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
        """Return the template values of a question or a solution."""
        _commands()  # without TeX there is no need to go on
        return values_of(document)

    def sheet(self, sheet: Sheet) -> bytes:
        """Return the bytes of the sheet's PDF."""
        logo, pictures = sheet.header.logo, {}
        if logo is not None:  # TeX sees nothing but its own folder
            name = f"logo.{logo.kind}"
            sheet = replace(sheet, header=replace(sheet.header, logo=replace(logo, path=name)))
            pictures = {name: logo.content}
        source = typeset_sheet(sheet, "sheet.tex")
        return compiled(source, time_limit=max(TIME_LIMIT, len(source) / SLOWEST), pictures=pictures)


def compiled(
    source: str, *, time_limit: float = TIME_LIMIT, pictures: Mapping[str, bytes] = MappingProxyType({})
) -> bytes:
    """Return the PDF of a LaTeX document by TeX; `pictures` are the files that it names."""
    commands = _commands()
    try:
        with _ending_in_order(), tempfile.TemporaryDirectory(prefix="symobs-", ignore_cleanup_errors=True) as name:
            folder = Path(name)
            for picture, content in pictures.items():
                (folder / picture).write_bytes(content)
            loose, pages = _typeset(source, "", folder, commands, time_limit)
            if pages == floor(pages) or pages % 1 > _SHORTEST:
                return loose
            closer, fewer = _typeset(source, _CLOSER, folder, commands, time_limit)
            if fewer <= floor(pages):
                return closer
            for wanted in _WANTED:
                part = f"{pages / (floor(pages) + wanted):.3f}"
                lower, more = _typeset(source, _LOWER.replace("{part}", part), folder, commands, time_limit)
                if floor(pages) + _SHORTEST < more < floor(pages) + 1:
                    return lower
            return loose
    except OSError as error:
        reason = f"TeX could not be given a folder to work in: {error.strerror or error}"
        repair = "make room, or name another folder for temporary files in the variable TMPDIR"
        raise TypesettingError(reason, where=_temporary(), repair=repair) from None


def _typeset(
    source: str, preamble: str, folder: Path, commands: Sequence[Sequence[str]], time_limit: float
) -> tuple[bytes, float]:
    """Return the PDF, and how many pages it fills: of the last one the part that something stands on."""
    begin = r"\begin{document}"
    (folder / _SOURCE).write_text(source.replace(begin, f"{preamble}{_MEASURED}{begin}", 1), "utf-8")
    page = (folder / _SOURCE).with_suffix(".pdf")
    if any(_run(command, folder, time_limit) != 0 for command in commands) or not page.exists():
        raise _failure(folder)
    log = page.with_suffix(".log").read_text("utf-8", "replace")
    told, written = _FILLED.findall(log), _WRITTEN.findall(log)
    if not told or not written:
        return page.read_bytes(), 1
    begun, height, whole = map(float, told[-1])
    pages = int(written[-1])  # what is over at the end may begin another page
    part = height / whole - (pages - begun)
    return page.read_bytes(), pages - 1 + part if pages > 1 and 0 < part < 1 else pages


def _commands() -> tuple[tuple[str, ...], ...]:
    """Return the commands: latexmk, or else pdflatex twice, for its references."""
    pdflatex, latexmk = shutil.which("pdflatex"), shutil.which("latexmk")
    if pdflatex is None:
        raise TypesettingError("pdflatex is not on PATH", repair=_INSTALL)
    if latexmk is None:
        return ((pdflatex, *_OPTIONS, _SOURCE),) * 2
    # -norc: a personal set-up of latexmk could allow what is forbidden here.
    return ((latexmk, "-norc", "-pdf", f"-pdflatex=pdflatex {' '.join(_OPTIONS)} %O %S", _SOURCE),)


def _run(command: Sequence[str], folder: Path, time_limit: float) -> int:
    """Run a command in `folder` and return its exit code; its children are always ended with it."""
    with _requests_put_off() as hear_them:
        try:
            process = subprocess.Popen(  # noqa: S603 - a program found on PATH, a source that is escaped, no shell
                command,
                cwd=folder,
                env=_environment(),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
        except OSError as error:
            reason = f"this program cannot be started: {error.strerror or error}"
            raise TypesettingError(reason, where=command[0], repair=_INSTALL) from None
        with running(process.pid):
            try:
                hear_them()
                return _waited(process, folder, time_limit)
            except BaseException as interruption:
                interruption.add_note(TEX_AT_WORK)
                raise
            finally:
                _end(process)


@contextmanager
def _requests_put_off() -> Iterator[Callable[[], None]]:
    """Put off requests to end this process until the function given is called, or until the block is left.

    An exception out of a half-made `Popen` would leave a program running that nobody knows.  A mask would do it too,
    but programs inherit masks and not handlers.
    """
    names = ("SIGINT", "SIGTERM", "SIGHUP", "SIGALRM")
    ours = threading.current_thread() is threading.main_thread()  # else there are no requests to this thread
    numbers = [getattr(signal, name) for name in names if ours and hasattr(signal, name)]
    handlers = {number: signal.getsignal(number) for number in numbers if callable(signal.getsignal(number))}
    come: list[int] = []

    def hear_them() -> None:
        usual = dict(handlers)
        handlers.clear()  # once only: a handler may choose to hear no second request
        for number, handler in usual.items():
            signal.signal(number, handler)
        while come:
            signal.raise_signal(come.pop(0))

    try:
        for number in handlers:
            signal.signal(number, lambda number, _: come.append(number))
        yield hear_them
    finally:
        hear_them()


def _waited(process: subprocess.Popen[bytes], folder: Path, time_limit: float) -> int:
    """Return the exit code of TeX; raises `TypesettingError` beyond its limits of time and disk space."""
    end = time.monotonic() + time_limit
    while True:
        left = end - time.monotonic()
        try:
            return process.wait(max(0.0, min(left, _LOOK_EVERY)))
        except subprocess.TimeoutExpired:
            if left <= 0:
                repair = "write LaTeX with --format latex and typeset it yourself"
                raise TypesettingError(f"TeX was stopped after {time_limit:g} seconds", repair=repair) from None
        if _size(folder) > SIZE_LIMIT << 20:
            repair = "write LaTeX with --format latex to see why"
            raise TypesettingError(f"TeX was stopped after it had written {SIZE_LIMIT} MB", repair=repair)


def _size(folder: Path) -> int:
    """Return the total size in bytes of the files of a folder."""
    with suppress(OSError):  # a file that is gone before it is measured
        return sum(path.stat().st_size for path in folder.iterdir())
    return 0


@contextmanager
def _ending_in_order() -> Iterator[None]:
    """End TeX and remove its folder on the first request to end this process, undisturbed by a second one."""
    usual: dict[signal.Signals, Any] = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    if hasattr(signal, "SIGHUP"):
        usual[signal.SIGHUP] = signal.SIG_DFL
    ours = threading.current_thread() is threading.main_thread()  # else there are no requests to this thread
    taken = [number for number, handler in usual.items() if ours and signal.getsignal(number) == handler]

    def leave(number: int, _: FrameType | None) -> None:
        for each in taken:
            signal.signal(each, signal.SIG_IGN)
        raise KeyboardInterrupt if number == signal.SIGINT else SystemExit(128 + number)

    for number in taken:
        signal.signal(number, leave)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, usual[number])


def _environment() -> Mapping[str, str]:
    return {**os.environ, **_CONFINED}


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a process and its children, unless it has exited."""
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
    text = _log(folder)
    error = re.search(r"^! (.*)", text, re.MULTILINE)
    if error is None and shutil.disk_usage(folder).free < _LAST_OF_LOG:
        repair = "make room, or name another folder for temporary files in the variable TMPDIR"
        return TypesettingError("TeX found no space left on the device", where=_temporary(), repair=repair)
    if error is None:
        return TypesettingError("TeX ended without a page and without an error in its log", repair=_INSTALL)
    place = re.search(r"^l\.(\d+)", text[error.end() :], re.MULTILINE)
    return TypesettingError(
        f"TeX failed: {error[1].strip()}",
        where=f"line {place[1]} of the LaTeX" if place else "",
        repair=_INSTALL if "not found" in error[1] else "write LaTeX with --format latex to see that line",
    )


def _log(folder: Path) -> str:
    """Return the end of TeX's log."""
    log = (folder / _SOURCE).with_suffix(".log")
    if not log.exists():
        return ""
    with log.open("rb") as stream:
        stream.seek(max(0, log.stat().st_size - _LAST_OF_LOG))
        return stream.read(_LAST_OF_LOG).decode("latin-1")


def _temporary() -> str:
    """Return the folder of temporary files."""
    try:
        return tempfile.gettempdir()
    except OSError:
        return "TMPDIR"
