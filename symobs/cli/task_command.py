"""One command for every task, made from its signature: a problem without a file."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Any

import click

from symobs.cli.shared.common import progress_on_terminal, run_work
from symobs.cli.shared.options import OF_A_PAGE, OneOf, options
from symobs.cli.shared.outcome import PageOptions, solved
from symobs.ground.errors import ProblemErrors, SymobsError, UsageError
from symobs.problem import OPEN, validate
from symobs.system.specification import CHOICES, KINDS
from symobs.tasks.result import methods

if TYPE_CHECKING:
    from symobs.cli.shared.outcome import Outcome
    from symobs.cli.shared.time_and_memory import Progress

PLANT_OPTIONS = {
    "A": 'state matrix, "[0 1; 0 -1]"',
    "B": "input matrix",
    "C": "output matrix",
    "D": "feedthrough; 0 if left out",
    "transfer_function": 'instead of A, B, C, D: "1/(s*(s + 1))"',
    "realisation": "of a transfer function: controllable (default), observable or modal",
    "dt": "0: continuous (default); true, or the period: discrete",
    "delay": "a dead time at the input",
    "pade": "1 to 4: the order of its Padé approximation",
}


def task_command(task: Any) -> click.Command:
    """Return the command of a task: the plant's options, then the task's keywords."""

    def option(group: str, name: str, described: str, words: OneOf | None = None) -> click.Option:
        names = [*dict.fromkeys([f"--{name}", f"--{name.replace('_', '-')}"]), group + name]
        return click.Option(names, help=described, type=words, multiple=True, callback=_once)

    parameters: list[click.Parameter] = [option("plant_", name, text) for name, text in PLANT_OPTIONS.items()]
    for name, kind in task.keywords.items():
        words = _words(task, name) if kind == "Name" else None
        described = KINDS[kind]["description"] if words is None else f"the {name}"
        parameters.append(option("given_", name, described, words))
    signs = "For example omega=positive; repeat it. With it, no other names exist."
    parameters.append(click.Option(["--symbol", "symbols"], multiple=True, metavar="NAME=SIGN", help=signs))
    first, _, rest = (inspect.getdoc(task.function) or "").partition("\n\n")
    command = click.Command(
        task.name,
        params=parameters,
        callback=lambda **given: _run_task(task, given),
        help="\n\n".join([first, *(f"\b\n{paragraph}" for paragraph in rest.split("\n\n"))]),
        short_help=task.summary,
    )
    # A link to a live page needs the signs that a file declares.
    return options(*(name for name in OF_A_PAGE if name != "live"))(command)


def _words(task: Any, name: str) -> OneOf | None:
    """Return the words a keyword may be: the methods of a task, or what the kind of keyword has."""
    if name == "method":
        return OneOf(lambda: ["auto", *(found.name for found in methods(task.name).values())])
    return OneOf(lambda: CHOICES[name]) if name in CHOICES else None


def _once(_: click.Context, parameter: click.Parameter, values: tuple[str, ...]) -> str | None:
    """Return the one value of an option; raises `UsageError` where it is given twice."""
    if len(values) > 1:
        several = f' in one text: {parameter.opts[0]} "{", ".join(values)[:60]}"' if "pole" in parameter.opts[0] else ""
        repair = f"write them{several}" if several else "keep one of them"
        raise UsageError(f"it is given {len(values)} times", where=parameter.opts[0], repair=repair)
    return values[0] if values else None


def _run_task(task: Any, options_given: dict[str, Any]) -> None:
    """Run the problem of the options; undeclared names are real symbols."""

    def given(group: str) -> dict[str, Any]:
        chosen = {name: value for name, value in options_given.items() if name.startswith(group) and value is not None}
        return {name.removeprefix(group): value for name, value in chosen.items()}

    page = PageOptions.of(options_given)
    plant = given("plant_")
    if plant.get("dt", "").lower() == "true":
        plant["dt"] = True
    symbols = dict(_declaration(entry) for entry in options_given["symbols"]) if options_given["symbols"] else OPEN
    data = {"task": task.name, "plant": plant, "specification": given("given_"), "symbols": symbols}
    data |= {"language": page.document["language"]} if "language" in page.document else {}

    def work(report_progress: Progress) -> Outcome:
        return solved(validate(data), page, progress_on_terminal(report_progress))

    try:
        run_work(work, options_given["timeout"], options_given["memory"], task.name)
    except SymobsError as raised:
        for error in raised.errors if isinstance(raised, ProblemErrors) else (raised,):
            error.where = re.sub(r"^(plant|specification)\.", "--", error.where)
            error.where = re.sub(r"^symbols\.", "--symbol ", error.where)
            if error.where.startswith("--symbol") and re.match(r"'[-+.\d]", error.message):
                error.repair += "; it declares a sign: a value is written in place of the letter"
        raise


def _declaration(entry: str) -> tuple[str, str]:
    name, separator, sign = entry.partition("=")
    return name.strip(), sign.strip() if separator else "real"
