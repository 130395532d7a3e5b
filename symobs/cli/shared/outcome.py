"""Outcomes of commands, computed before anything is written, so that a failing run leaves no files."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.cli.shared.options import quoted
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


@dataclass
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


@dataclass
class PageOptions:
    """The options of a command that writes the page of one problem; `document` has those of the document."""

    format_name: str
    target: str | None
    plot: str | None
    bibliography: str | None
    convention: Any
    settings: Mapping[str, str]
    document: Mapping[str, Any]

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> PageOptions:
        """Return the options of a command line; raises an error, before any work, for what cannot be written."""
        default = "text" if given["printed"] else "latex"
        chosen = chosen_format(given["format_name"], given["target"], default=default)
        places = given["target"], given["plot"], given["bibliography"]
        check_targets(*places)
        convention = convention_of(given["convention_name"])
        return cls(chosen, *places, convention, given["settings"], page_of(chosen, given))

    def offering(self, web: WebPage) -> PageOptions:
        """Return the same options with other parts of a web page."""
        return replace(self, document={**self.document, "web": web})


def page_of(format_name: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of the document among those given to a command.

    Raises `UsageError` for unknown values, and for options of pages that the format does not write.
    """
    from symobs.pages.page.detail_level import detail_named  # noqa: PLC0415 - it imports the steps
    from symobs.tasks.result.output_methods import detail_of, digits_asked  # noqa: PLC0415

    language, templates = given["language"], given["templates"]
    web = WebPage(given["details"], given["copy"], given.get("live", ""))
    asked = digits_asked(given["digits"], exact=given["exact"], where="--digits")
    page = {
        "detail": detail_named(given["detail"] or detail_of(format_name), "--detail"),
        "web": web,
        **({} if asked is None else {"digits": asked}),
        **{name: given[name] for name in ("references", "printed", "period", "hold") if name in given},
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


def chosen_format(format_name: str | None, target: str | None, *, default: str = "latex") -> str:
    """Return the output format: that of --format, else that of the suffix of the target, else the default."""
    import symobs  # noqa: PLC0415 - the package itself stands above all floors
    from symobs.cli.shared.task_index import format_suffixes  # noqa: PLC0415 - a run pays for one format
    from symobs.tasks.result import format_named  # noqa: PLC0415

    suffix = Path(target).suffix if target is not None else ""
    if format_name is None and suffix:
        known = format_suffixes(symobs.FORMAT_PACKAGE)
        named = [name for name in known if known[name] == suffix]
        if not named:
            repair = f"give --format one of {', '.join(known)}"
            raise UsageError(f"the suffix {quoted(suffix)} names no output format", where="-o", repair=repair)
        format_name = "latex" if "latex" in named else named[0]
    return str(format_named(format_name or default).name)


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


def solved(found: Any, options: PageOptions, report_progress: Progress, *, only_some_tasks: bool = False) -> Outcome:
    """Solve a problem and return the outcome: its document, its plot, messages and exit code.

    What the file expects is held against the answers before values of parameters are set.  With `only_some_tasks`, the
    expected answers of the file's other tasks are ignored.  `report_progress` is called with each task begun, and with
    the outcome that is kept if the work is ended.
    """
    from symobs.problem.expect import applicable, held_against  # noqa: PLC0415
    from symobs.tasks.result import render  # noqa: PLC0415

    format_name, target, plot, bibliography = options.format_name, options.target, options.plot, options.bibliography
    shows_parts = not options.document["printed"]  # answers of tasks not yet begun are none

    def document_of(results: tuple[Any, ...]) -> Any:
        return replace(found.document(results, options.convention), **options.document)

    def rendered(results: tuple[Any, ...]) -> str | bytes:
        return typeset_slides(render(document_of(results), format_name), format_name, target)

    def begins(name: str, so_far: tuple[Any, ...]) -> None:
        if format_name == "json":
            report_progress(partial(_as_far_as, found, so_far, options))
        elif so_far and shows_parts and not runs_tex(format_name, target):  # TeX takes its time
            report_progress(lambda: Outcome(((rendered(so_far), target),), (), EXIT_UNDECIDED))
        report_progress(name)

    try:
        results = found.solve(begins)
    except Undecided as error:
        done: Any = error.facts["results"]
        if format_name == "json":
            return replace(_as_far_as(found, done, options, str(error)), messages=(str(error),))
        return Outcome(((rendered(done), target),) if done and shows_parts else (), (str(error),), EXIT_UNDECIDED)
    viewed = found.viewed(results)
    expect = applicable(viewed, found.expect) if only_some_tasks else found.expect
    unmet, is_open = held_against(viewed, expect)
    if options.settings:
        results = _at(results, options.settings)
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
        return Outcome(tuple(outputs), tuple(unmet), EXIT_UNDECIDED if is_open else EXIT_NO if unmet else 0)
    verdicts = {result.verdict for result in results}
    if not shows_parts:
        unmet = [*unmet, *_cautions(document_of(results))]
    messages = [f"{result.task}: {result.verdict}" for result in results if result.verdict in {"no", "undecided"}]
    code = EXIT_NO if "no" in verdicts else EXIT_UNDECIDED if "undecided" in verdicts else 0
    return Outcome(tuple(outputs), (*unmet, *messages), code)


def _cautions(document: Any) -> list[str]:
    """Return which designs do not converge: a page says so, a gain alone does not."""
    from symobs.applications.live.sentences import stability_of  # noqa: PLC0415 - only with --print
    from symobs.formula.phrases.languages import language_named  # noqa: PLC0415
    from symobs.pages.cards import CardPrinter  # noqa: PLC0415

    language = language_named(document.language)
    found = [(result, stability_of(result)) for result in document.results if result.gains and result.verdict != "no"]
    return [
        f"{result.task}: {stable.told(CardPrinter(result, document.convention, language))}"
        for result, stable in found
        if stable.known and stable.poles
    ]


def _at(results: tuple[Any, ...], settings: Mapping[str, str]) -> tuple[Any, ...]:
    """Return the results at values of their parameters; an error names the option."""
    try:
        return tuple(result.at(settings) for result in results)
    except InputError as raised:
        for error in raised.errors if isinstance(raised, ProblemErrors) else (raised,):
            error.where = error.where.replace("values.", "--set ")
        raise


def _as_far_as(found: Any, so_far: tuple[Any, ...], options: PageOptions, reason: str = "") -> Outcome:
    """Return what is left where the work ends now: the results so far, every other task undecided."""
    from symobs.pages.formats.json import given_up  # noqa: PLC0415 - only with --format json

    names, method = [task.name for task in found.tasks], str(found.specification.get("method", "auto"))
    document = found.document(so_far, options.convention)
    whole = given_up(document, names, method, found.plant.symbols.signs, reason)
    return Outcome(((whole, options.target),), (), EXIT_UNDECIDED)


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
