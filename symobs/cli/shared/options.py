"""Options shared by several commands: format, target, detail, time and memory."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.shell_completion import CompletionItem

from symobs.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

Optioned = TypeVar("Optioned", bound="Callable[..., Any] | click.Command")

_LEAST_MEMORY = 64  # megabytes; symobs and its libraries take half of that before they begin


def _amount(_: click.Context, parameter: click.Parameter, value: str | None) -> float | None:
    """Return the number of an option; raises `UsageError` unless it is positive and finite."""
    if value is None:
        return None
    least = _LEAST_MEMORY if parameter.name == "memory" else 0
    with suppress(ValueError):
        number = float(value)
        if 0 < number < float("inf") and number >= least:
            return number
    amount = f"a number of megabytes, {least} or more" if least else "a positive number of seconds"
    example = f"write for example --{parameter.name} {2000 if least else 60}"
    raise UsageError(f"{quoted(value)} is not {amount}", where=f"--{parameter.name}", repair=example)


class OneOf(click.ParamType):  # type: ignore[type-arg]  # generic in the newest click alone
    """A word of a few, which help and completion show; whoever reads it refuses another one, with what to do."""

    name = "word"

    def __init__(self, choices: Callable[[], Iterable[str]]) -> None:
        """Take the words, which are looked up where they are shown."""
        self.choices = choices

    def get_metavar(self, param: click.Parameter, ctx: click.Context | None = None) -> str:  # noqa: ARG002 - click's signature
        """Return the words as help shows them."""
        return f"[{'|'.join(self.choices())}]"

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        param: click.Parameter,  # noqa: ARG002
        incomplete: str,
    ) -> list[CompletionItem]:
        """Return the words that begin like this."""
        return [CompletionItem(word) for word in self.choices() if word.startswith(incomplete)]


class AFile(click.ParamType):  # type: ignore[type-arg]  # as above
    """The path of a file, or of a folder, which the shell completes; whoever opens it says what is wrong with it."""

    name = "path"

    def __init__(self, kind: str = "file") -> None:
        """Take what the shell is to complete: file or dir."""
        self.kind = kind

    def shell_complete(
        self,
        ctx: click.Context,  # noqa: ARG002 - click's signature
        param: click.Parameter,  # noqa: ARG002
        incomplete: str,
    ) -> list[CompletionItem]:
        """Leave the completion to the shell."""
        return [CompletionItem(incomplete, type=self.kind)]


def _formats() -> Iterable[str]:
    import symobs  # noqa: PLC0415 - the package itself stands above all floors
    from symobs.cli.shared.task_index import format_suffixes  # noqa: PLC0415 - for help and completion only

    return format_suffixes(symobs.FORMAT_PACKAGE)


def _conventions() -> Iterable[str]:
    from symobs.convention import conventions  # noqa: PLC0415 - for help and completion only

    return conventions()


def _details() -> Iterable[str]:
    from symobs.render.page.detail_level import DETAILS  # noqa: PLC0415 - for help and completion only

    return DETAILS


#: The options that several commands share, in the order in which their help lists them.
OPTIONS: dict[str, Callable[[Any], Any]] = {
    "format": click.option(
        "--format", "format_name", type=OneOf(_formats), help="The output format; latex where nothing is said."
    ),
    "target": click.option(
        "-o",
        "target",
        type=AFile(),
        metavar="PATH",
        help="Write to PATH; its suffix names the format where --format does not.",
    ),
    "detail": click.option(
        "--detail",
        default="full",
        type=OneOf(_details),
        help="How much of the derivation is told; full where nothing is said.",
    ),
    "templates": click.option(
        "--templates", type=AFile("dir"), metavar="FOLDER", help="Use your own LaTeX templates: see `symobs templates`."
    ),
    "plot": click.option(
        "--plot",
        type=AFile(),
        metavar="PATH",
        help="Write the picture of the first result that has one to PATH: .svg, .png, .pdf or .tex.",
    ),
    "convention": click.option(
        "--convention",
        "convention_name",
        type=OneOf(_conventions),
        metavar="NAME",
        help="Write the page in this convention: standard, S0 to S4, or the path of a TOML file.",
    ),
    "timeout": click.option(
        "--timeout",
        metavar="SECONDS",
        help="Stop after so many seconds: undecided, exit code 5.",
        callback=_amount,
    ),
    "memory": click.option(
        "--memory",
        metavar="MEGABYTES",
        help="Take no more than so many megabytes: undecided where that is not enough, exit code 5.",
        callback=_amount,
    ),
}
#: Those of a command that writes the page of one problem, and those that bound its work.
LIMITS = ("timeout", "memory")
OF_A_PAGE = tuple(OPTIONS)


def options(*names: str) -> Callable[[Optioned], Optioned]:
    """Give a function, or a command, the shared options of these names."""

    def give(command: Optioned) -> Optioned:
        # click reads the options of a function from the last to the first, those of a command as they come
        for name in names if isinstance(command, click.Command) else reversed(names):
            command = OPTIONS[name](command)
        return command

    return give


def quoted(text: str) -> str:
    """Return a user's text, shortened, in quotation marks."""
    from symobs.expression.source import shown  # noqa: PLC0415 - needed for messages only

    return f'"{shown(text, 40)}"'
