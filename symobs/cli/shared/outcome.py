"""Outcomes of commands, computed before anything is written, so that a failing run leaves no files."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.cli.shared.output import check_target
from symobs.ground.child_processes.budget import Budget
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, OutOfBudget, ProblemErrors, Undecided, UsageError
from symobs.tasks.result.output_methods import PLAIN, WebPage

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from symobs.cli.shared.time_and_memory import Progress


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
    detail: str | None,
    language: str | None,
    templates: str | None,
    format_name: str,
    web: WebPage = PLAIN,
    *,
    digits: object = None,
    exact: bool = False,
    references: str = "short",
    **others: Any,
) -> dict[str, Any]:
    """Return the options of a page: --detail, --language, --digits, --templates, web pages; the others as they are.

    Raises `UsageError` for unknown values, and for options of pages that the format does not write.
    """
    from symobs.pages.page.detail_level import detail_named  # noqa: PLC0415 - it imports the steps
    from symobs.tasks.result.output_methods import detail_of, digits_asked  # noqa: PLC0415

    asked = digits_asked(digits, exact=exact, where="--digits")
    page = {
        "detail": detail_named(detail or detail_of(format_name), "--detail"),
        "web": web,
        "references": references,
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


def runs_tex(format_name: str, target: str | None) -> bool:
    """Return whether TeX makes the file: a PDF, and slides of which a PDF is asked for."""
    return format_name == "pdf" or (format_name == "beamer" and Path(target or "").suffix == ".pdf")


def typeset_slides(content: str | bytes, format_name: str, target: str | None) -> str | bytes:
    """Return slides as PDF where the target is one; anything else as it is."""
    if isinstance(content, bytes) or not runs_tex(format_name, target):
        return content
    from symobs.pages.formats.pdf import compiled  # noqa: PLC0415 - only with -o slides.pdf

    return compiled(content)


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
        return typeset_slides(render(document_of(results), format_name), format_name, target)

    def begins(name: str, so_far: tuple[Any, ...]) -> None:
        if format_name == "json":
            report_progress(partial(_as_far_as, found, so_far, convention, target))
        elif (
            so_far and not runs_tex(format_name, target) and not page.get("printed")
        ):  # TeX's time; answers of tasks not yet begun
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
