"""Outcomes of commands, computed before anything is written, so that a failing run leaves no files."""

from __future__ import annotations

import errno
import os
import sys
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.ground.child_processes.budget import Budget
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, OutOfBudget, ProblemErrors, SymobsError, Undecided, UsageError, reason_of
from symobs.tasks.result.output_methods import PLAIN, WebPage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.cli.shared.time_and_memory import Progress

    Prepared = tuple[Path, Path, str]


# Output to standard output or to files: complete or not at all, several results all or none.


_ELSEWHERE = "name a file in a folder that can be written"


#: What helps against reasons of the system; the others are helped by another file.
_REPAIRS = {
    errno.ENOSPC: "make room there, or name a file elsewhere with -o",
    errno.EDQUOT: "make room there, or name a file elsewhere with -o",
    errno.EFBIG: "raise the limit on the size of files (ulimit -f), or name a file elsewhere with -o",
}


def write(content: str | bytes, target: str | None = None) -> None:
    """Write the whole result or nothing; without a target, or to `-`, to standard output."""
    write_all(((content, target),))


def write_all(outputs: Sequence[tuple[str | bytes, str | None]]) -> None:
    """Write all results or none: files take their places when each is complete and the streams are served."""
    files: list[Prepared] = []
    try:
        for content, target in outputs:
            if _is_file(target):
                files.append(_prepared(_bytes(content), str(target)))
        for content, target in outputs:
            if not _is_file(target):
                _send(content, target)
        _put_in_place(files)
    finally:
        for temporary, _, _ in files:
            temporary.unlink(missing_ok=True)


def copied(paths: Sequence[Path], folder: str) -> None:
    """Copy files into a folder; raises `InputError` where one of their names is taken there."""
    target = Path(folder)
    taken = [path.name for path in paths if (target / path.name).exists()]
    if taken:
        message = f"{taken[0]} is already there"
        raise InputError(message, where=_shown(folder), repair="name another folder, or move the file away")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        repair = "name a folder that can be written"
        raise InputError(reason_of(error), where=_shown(folder), repair=repair) from None
    write_all([(path.read_bytes(), str(target / path.name)) for path in paths])


def check_target(target: str | None) -> None:
    """Raise `InputError`, before any work, if a result cannot be written."""
    if target is None or target == "-":
        return
    with _explained(target):
        path = Path(os.path.realpath(target))
        folder = path.parent
        if path.is_dir():
            raise InputError("this is a folder", where=_shown(target), repair=_ELSEWHERE)
        if not folder.is_dir():
            repair = f"make it, or {_ELSEWHERE}"
            raise InputError(f"there is no folder {_shown(str(folder))}", where=_shown(target), repair=repair)
        if path.exists() and not os.access(path, os.W_OK):
            repair = f"make it writable (chmod u+w), or {_ELSEWHERE}"
            raise InputError("the file is read-only", where=_shown(target), repair=repair)
        if (path.is_file() or not path.exists()) and not os.access(folder, os.W_OK | os.X_OK):
            raise InputError("the folder cannot be written", where=_shown(target), repair=_ELSEWHERE)


def make_folder(folder: Path) -> None:
    """Make a folder for results, unless it is there; raises `InputError` where it cannot be made."""
    with _explained(str(folder)):
        folder.mkdir(exist_ok=True)


def binary(stream: Any) -> Any:
    """Return the binary stream of a standard stream, which is None if it was closed."""
    if stream is None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))
    return stream.buffer


# -- streams ----------------------------------------------------------------------------------------------------------


def _is_file(target: str | None) -> bool:
    """Return whether a target is or will be a regular file, not a stream (/dev/stdout, a pipe)."""
    if target is None or target == "-":
        return False
    with _explained(target):
        path = Path(os.path.realpath(target))
        return path.is_file() or not path.exists()


def _send(content: str | bytes, target: str | None) -> None:
    """Write to a stream; a closed pipe ends the output without an error."""
    try:
        with _explained(target):
            if target is not None and target != "-":
                check_target(target)
                Path(target).write_bytes(_bytes(content))
                return
            stream = binary(sys.stdout)
            if isinstance(content, bytes) and stream.isatty():
                raise UsageError("this format is not text", repair="name a file with -o")
            stream.write(_bytes(content))
            stream.flush()
    except BrokenPipeError:  # what is left in the buffer goes nowhere
        if target is None or target == "-":
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


# -- files ------------------------------------------------------------------------------------------------------------


def _prepared(data: bytes, target: str) -> Prepared:
    """Write a file beside its place."""
    import tempfile  # noqa: PLC0415 - only with -o

    check_target(target)
    place = Path(os.path.realpath(target))
    with _explained(target):
        mode = place.stat().st_mode & 0o777 if place.exists() else 0o666 & ~_umask()
        with tempfile.NamedTemporaryFile(dir=place.parent, prefix=".symobs-", delete=False) as stream:
            temporary = Path(stream.name)
            try:
                stream.write(data)
                stream.close()
                temporary.chmod(mode)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
    return temporary, place, target


def _put_in_place(files: Sequence[Prepared]) -> None:
    """Move complete files to their places; if one fails, undo those before it."""
    new = {place for _, place, _ in files if not place.exists()}
    kept: dict[Path, Path] = {}
    moved: list[Path] = []
    try:
        for temporary, place, name in files:
            if len(files) > 1 and place not in new:
                kept |= _kept(temporary, place)
            with _explained(name):
                temporary.replace(place)
            moved.append(place)
    except BaseException:
        for place in moved:
            if place in new:
                place.unlink(missing_ok=True)
            elif place in kept:
                kept[place].replace(place)
        raise
    finally:
        for before in kept.values():
            before.unlink(missing_ok=True)


def _kept(temporary: Path, place: Path) -> dict[Path, Path]:
    """Link an existing file to a second name; return that, or nothing if the file system has no links."""
    before = temporary.with_suffix(".before")
    with suppress(OSError):
        before.hardlink_to(place)
        return {place: before}
    return {}


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


# -- reasons ----------------------------------------------------------------------------------------------------------


@contextmanager
def _explained(target: str | None) -> Iterator[None]:
    """Raise a refusal of the system as an `InputError`; a closed pipe is none."""
    try:
        yield
    except (BrokenPipeError, SymobsError):
        raise
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte, a closed stream
        reason = reason_of(error)
        is_stream = target is None or target == "-"
        where, other = ("standard output", "name a file with -o") if is_stream else (_shown(target), _ELSEWHERE)
        repair = _REPAIRS.get(getattr(error, "errno", 0) or 0, other)
        raise InputError(reason, where=where, repair=repair) from None


def _shown(target: str | None) -> str:
    from symobs.formula.expression.source import shown  # noqa: PLC0415 - needed for messages only

    return shown(str(target), 200)


#: Exit codes of the contract.
EXIT_NO, EXIT_UNDECIDED = 4, 5


@dataclass(frozen=True)
class Outcome:
    """The outputs with their targets, the messages, the exit code, and the folders to be made, outer ones first."""

    outputs: tuple[tuple[str | bytes, str | None], ...]
    messages: tuple[str, ...] = ()
    code: int = 0
    folders: tuple[Path, ...] = ()


def convention_of(name: str | None) -> Any:
    """Return the convention of --convention, None for that of the file."""
    if name is None:
        return None
    from symobs.formula.convention import convention_named  # noqa: PLC0415 - only with --convention

    return convention_named(name)


def page_of(
    detail: str,
    language: str | None,
    templates: str | None,
    format_name: str,
    web: WebPage = PLAIN,
    *,
    digits: object = None,
    exact: bool = False,
    **others: Any,
) -> dict[str, Any]:
    """Return the options of a page: --detail, --language, --digits, --templates, web pages; the others as they are.

    Raises `UsageError` for unknown values, and for options of pages that the format does not write.
    """
    from symobs.pages.page.detail_level import detail_named  # noqa: PLC0415 - it imports the steps
    from symobs.tasks.result.output_methods import digits_asked  # noqa: PLC0415

    asked = digits_asked(digits, exact=exact, where="--digits")
    page = {
        "detail": detail_named(detail, "--detail"),
        "web": web,
        **({} if asked is None else {"digits": asked}),
        **others,
    }
    if web != PLAIN and format_name != "html":
        where = next(f"--{name}" for name in ("details", "copy", "live") if getattr(web, name))
        raise UsageError(f"the format {format_name} is no web page", where=where, repair="use --format html")
    if language is not None:
        from symobs.formula.phrases.languages import language_named  # noqa: PLC0415 - only with --language

        page["language"] = language_named(language, "--language").code
    if templates is None:
        return page
    from symobs.pages.formats.templates import check_folder  # noqa: PLC0415 - only with --templates
    from symobs.tasks.result import format_named, formats  # noqa: PLC0415

    if not hasattr(format_named(format_name), "template"):
        having = ", ".join(sorted(found.name for found in formats().values() if hasattr(found, "template")))
        message = f"the format {format_name} has no LaTeX template"
        raise UsageError(message, where="--templates", repair=f"use one of {having}, or leave it out")
    check_folder(Path(templates))
    return {**page, "templates": Path(templates)}


def of_problem(web: WebPage, data: Mapping[str, Any]) -> WebPage:
    """Return what a page offers, its link with the state of a problem."""
    if not web.live:
        return web
    from symobs.applications.live.request import link_of  # noqa: PLC0415 - only with --live

    return replace(web, live=f"{web.live}#{link_of(data)}")


def check_targets(target: str | None, plot: str | None, bibliography: str | None = None) -> None:
    """Raise an error, before any work, if the result, its plot or its bibliography cannot be written."""
    check_target(target)
    check_target(bibliography)
    if plot is not None:
        from symobs.pages.drawings.plot_file import check_target as check_picture  # noqa: PLC0415 - only with --plot

        check_picture(plot)
        check_target(plot)
        if target is not None and Path(plot).resolve() == Path(target).resolve():
            raise UsageError("the result is written to that file", where="--plot", repair="name another file")


def solved(
    found: Any,
    format_name: str,
    target: str | None,
    plot: str | None,
    convention: Any,
    report_progress: Progress,
    *,
    bibliography: str | None = None,
    only_some_tasks: bool = False,
    settings: Mapping[str, str] | None = None,
    **page: Any,
) -> Outcome:
    """Solve a problem and return the outcome: its document, its plot, messages and exit code.

    `settings` are values of parameters; what the file expects is held against the answers before they are set.  With
    `only_some_tasks`, the expected answers of the file's other tasks are ignored.  `page` holds options of the document.
    `report_progress` is called with each task begun, and with the outcome that is kept if the work is ended.
    """
    from symobs.problem.expect import applicable, mismatches  # noqa: PLC0415
    from symobs.tasks.result import render  # noqa: PLC0415

    def document_of(results: tuple[Any, ...]) -> Any:
        return replace(found.document(results, convention), **page)

    def rendered(results: tuple[Any, ...]) -> str | bytes:
        return render(document_of(results), format_name)

    def begins(name: str, so_far: tuple[Any, ...]) -> None:
        if format_name == "json":
            report_progress(partial(_as_far_as, found, so_far, convention, target))
        elif so_far and format_name != "pdf" and not page.get("printed"):  # TeX's time; answers of tasks not yet begun
            report_progress(lambda: Outcome(((rendered(so_far), target),), (), EXIT_UNDECIDED))
        report_progress(name)

    try:
        results = found.solve(begins)
    except Undecided as error:
        done: Any = error.facts["results"]
        if format_name == "json":
            return replace(_as_far_as(found, done, convention, target, str(error)), messages=(str(error),))
        partial_page = done and not page.get("printed")
        return Outcome(((rendered(done), target),) if partial_page else (), (str(error),), EXIT_UNDECIDED)
    viewed = found.viewed(results)
    expect = applicable(viewed, found.expect) if only_some_tasks else found.expect
    unmet = mismatches(viewed, expect)
    if settings:
        results = _at(results, settings)
    report_progress("the page")
    outputs = [(rendered(results), target)]
    if bibliography is not None:
        from symobs.pages.page.prose import bibliography_of  # noqa: PLC0415 - only with --bibliography

        outputs.append((bibliography_of(document_of(results)), bibliography))
    if plot is not None:
        from symobs.pages.drawings.plot_file import picture_file  # noqa: PLC0415

        report_progress("the picture")
        try:
            outputs.append((picture_file(results, plot, document_of(results).language), plot))
        except UsageError as error:  # there is none: the result stands all the same
            return Outcome(tuple(outputs), (str(error),), error.exit_code)
    if expect:
        return Outcome(tuple(outputs), tuple(unmet), EXIT_NO if unmet else 0)
    verdicts = {result.verdict for result in results}
    messages = [f"{result.task}: {result.verdict}" for result in results if result.verdict in {"no", "undecided"}]
    code = EXIT_NO if "no" in verdicts else EXIT_UNDECIDED if "undecided" in verdicts else 0
    return Outcome(tuple(outputs), (*unmet, *messages), code)


def _at(results: tuple[Any, ...], settings: Mapping[str, str]) -> tuple[Any, ...]:
    """Return the results at values of their parameters; an error names the option."""
    try:
        return tuple(result.at(settings) for result in results)
    except InputError as raised:
        for error in raised.errors if isinstance(raised, ProblemErrors) else (raised,):
            error.where = error.where.replace("values.", "--set ")
        raise


def _as_far_as(found: Any, so_far: tuple[Any, ...], convention: Any, target: str | None, reason: str = "") -> Outcome:
    """Return what is left where the work ends now: the results so far, every other task undecided."""
    from symobs.pages.formats.json import given_up  # noqa: PLC0415 - only with --format json

    names, method = [task.name for task in found.tasks], str(found.specification.get("method", "auto"))
    document = found.document(so_far, convention)
    whole = given_up(document, names, method, found.plant.symbols.signs, reason)
    return Outcome(((whole, target),), (), EXIT_UNDECIDED)


def bounded(work: Callable[[Progress], Outcome], timeout: float | None, memory: float | None, where: str) -> Outcome:
    """Return the outcome of the work, or the partial outcome if its budget is exhausted."""
    from symobs.cli.shared.time_and_memory import within  # noqa: PLC0415 - a budget costs nothing where there is none

    try:
        return within(Budget(timeout, memory), work, where)
    except OutOfBudget as error:
        left = error.facts["left"]
        if not isinstance(left, Outcome):
            raise
        return replace(left, messages=(str(error),))
