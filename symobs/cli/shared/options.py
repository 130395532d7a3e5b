"""Options shared by several commands: format, target, detail, time and memory."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.shell_completion import CompletionItem

from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

Optioned = TypeVar("Optioned", bound="Callable[..., Any] | click.Command")

_LONG_NUMBER = 10
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


def _settings(_: click.Context, __: click.Parameter, entries: tuple[str, ...]) -> dict[str, str]:
    """Return the values of --set by name; raises `UsageError` for what is no NAME=VALUE, or a name set twice."""
    found: dict[str, str] = {}
    for entry in entries:
        name, separator, value = (part.strip() for part in entry.partition("="))
        if not (name and separator and value):
            raise UsageError(f"{quoted(entry)} gives no value", where="--set", repair="write for example --set k=4")
        if "=" in value:
            message = f"{quoted(entry)} sets more than one name"
            raise UsageError(message, where="--set", repair="write --set once for each name: --set k=4 --set m=2")
        if name in found:
            raise UsageError(f"{quoted(name)} is set twice", where="--set", repair="keep one of them")
        found[name] = value
    return found


def _address(_: click.Context, __: click.Parameter, value: str | None) -> str:
    """Return the address of a page without what stands after #; raises `UsageError` for what is none."""
    address = (value or "").partition("#")[0]
    if value is not None and not re.fullmatch(r"https?://[^\s\"'<>\\]+", address):
        repair = "write for example --live https://example.org/live/"
        raise UsageError(f"{quoted(value)} is not the address of a page", where="--live", repair=repair)
    return address


def _names(_: click.Context, __: click.Parameter, value: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of every --print; raises `UsageError` where there is none."""
    names = tuple(name for part in ",".join(value).split(",") if (name := part.strip()))
    if value and not names:
        raise UsageError("no answer is named", where="--print", repair="write for example --print K,L")
    return names


def _digits(_: click.Context, __: click.Parameter, value: str | None) -> object:
    """Return the number of --digits; whoever writes the page says which numbers there are."""
    return int(value) if value is not None and value.isdecimal() and len(value) < _LONG_NUMBER else value


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
    from symobs.formula.convention import conventions  # noqa: PLC0415 - for help and completion only

    return conventions()


def _languages() -> Iterable[str]:
    from symobs.formula.phrases.languages import languages  # noqa: PLC0415 - for help and completion only

    return languages()


def _details() -> Iterable[str]:
    from symobs.pages.page.detail_level import DETAILS  # noqa: PLC0415 - for help and completion only

    return DETAILS


def _references() -> Iterable[str]:
    from symobs.tasks.result.output_methods import REFERENCES  # noqa: PLC0415 - for help and completion only

    return REFERENCES


#: The options that several commands share, in the order in which their help lists them.
OPTIONS: dict[str, Callable[[Any], Any]] = {
    "format": click.option(
        "--format",
        "format_name",
        type=OneOf(_formats),
        help="The output format: of a page, of a program (c, python, matlab, modelica) or of numbers alone (numpy, csv); "
        "latex where nothing is said.",
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
        type=OneOf(_details),
        help="Level of detail of the derivation; full where nothing is said, outline on slides.",
    ),
    "references": click.option(
        "--references",
        default="short",
        type=OneOf(_references),
        help="How the literature is told below the page: none, short (a line each) or full; short where nothing is said.",
    ),
    "language": click.option(
        "--language",
        type=OneOf(_languages),
        help="The language of the page; that of the file, or en, where nothing is said.",
    ),
    "digits": click.option(
        "--digits",
        metavar="N",
        help="Write the numbers of the page in decimals with N significant digits, correctly rounded; 5 where the data "
        "are typed as decimals and nothing is said.",
        callback=_digits,
    ),
    "exact": click.option(
        "--exact",
        is_flag=True,
        help="Write the numbers of the page exactly, also where the data are typed as decimals.",
    ),
    "details": click.option(
        "--details",
        is_flag=True,
        help="For HTML: every level of detail on one page, to choose from; solutions of a sheet folded.",
    ),
    "copy": click.option("--copy", is_flag=True, help="For HTML: a button at each display that copies its LaTeX."),
    "live": click.option(
        "--live",
        metavar="URL",
        help="For HTML: a link that opens the problem on the live page at URL.",
        callback=_address,
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
    "bibliography": click.option(
        "--bibliography", metavar="PATH", help="Write the works that the page cites to PATH, as a BibTeX file."
    ),
    "convention": click.option(
        "--convention",
        "convention_name",
        type=OneOf(_conventions),
        metavar="NAME",
        help='Write the page in this convention: standard, a law such as "u = K x_hat, A + M C", a name that '
        "`symobs conventions` lists, or the path of a TOML file.",
    ),
    "printed": click.option(
        "--print",
        "printed",
        metavar="NAMES",
        multiple=True,
        help="Print these answers alone, for example K,L, also verdict and conditions: exact, or as numbers with "
        "--format matlab, numpy or csv.",
        callback=_names,
    ),
    "period": click.option("--period", metavar="TIME", help="For a program: the sampling period, for example 1/100."),
    "hold": click.option(
        "--hold",
        default="zoh",
        metavar="NAME",
        help="For a program: zoh, a zero-order hold (default), or tustin, the bilinear map.",
    ),
    "settings": click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="NAME=VALUE",
        help="Give a parameter a value, for example k=4; repeat it. The answers are those at these values.",
        callback=_settings,
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
#: That of a command whose work is done by many processes.
WORKERS = click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    metavar="N",
    help="Processes of this machine; default: as many as it has processors.",
)


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
    from symobs.formula.expression.source import shown  # noqa: PLC0415 - needed for messages only

    return f'"{shown(text, 40)}"'
