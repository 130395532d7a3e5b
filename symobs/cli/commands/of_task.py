"""One command for every task, made from its signature: a problem without a file."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Any

import click

from symobs.cli.shared.common import chosen_format, run_work
from symobs.cli.shared.options import OF_A_PAGE, options
from symobs.cli.shared.outcome import check_targets, convention_of, page_of, solved
from symobs.errors import ProblemErrors, SymobsError
from symobs.problem import OPEN, validate
from symobs.specification import KINDS

if TYPE_CHECKING:
    from symobs.cli.shared.outcome import Outcome
    from symobs.cli.shared.time_and_memory import Progress

PLANT_OPTIONS = {
    "A": 'state matrix, "[0 1; 0 -1]"',
    "B": "input matrix",
    "C": "output matrix",
    "D": "feedthrough; 0 if left out",
    "transfer_function": 'instead of A, B, C, D: "1/(s*(s + 1))"',
    "dt": "0: continuous (default); true, or the period: discrete",
}


def task_command(task: Any) -> click.Command:
    """Return the command of a task: the plant's options, then the task's keywords."""

    def option(group: str, name: str, described: str) -> click.Option:
        return click.Option(
            [*dict.fromkeys([f"--{name}", f"--{name.replace('_', '-')}"]), group + name], help=described
        )

    parameters: list[click.Parameter] = [option("plant_", name, text) for name, text in PLANT_OPTIONS.items()]
    parameters += [option("given_", name, KINDS[kind]["description"]) for name, kind in task.keywords.items()]
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
    return options(*OF_A_PAGE)(command)


def _run_task(task: Any, options_given: dict[str, Any]) -> None:
    """Run the problem of the options; undeclared names are real symbols."""

    def given(group: str) -> dict[str, Any]:
        chosen = {name: value for name, value in options_given.items() if name.startswith(group) and value is not None}
        return {name.removeprefix(group): value for name, value in chosen.items()}

    default = "text" if options_given["printed"] else "latex"
    chosen = chosen_format(options_given["format_name"], options_given["target"], default=default)
    check_targets(options_given["target"], options_given["plot"], options_given["bibliography"])
    of_numbers = {name: options_given[name] for name in ("printed", "period", "hold")}
    page = page_of(options_given["detail"], options_given["templates"], chosen, **of_numbers)
    page["settings"] = options_given["settings"]
    plant = given("plant_")
    if plant.get("dt", "").lower() == "true":
        plant["dt"] = True
    symbols = dict(_declaration(entry) for entry in options_given["symbols"]) if options_given["symbols"] else OPEN
    data = {"task": task.name, "plant": plant, "specification": given("given_"), "symbols": symbols}
    convention = convention_of(options_given["convention_name"])

    def work(report_progress: Progress) -> Outcome:
        return solved(
            validate(data),
            chosen,
            options_given["target"],
            options_given["plot"],
            convention,
            report_progress,
            bibliography=options_given["bibliography"],
            **page,
        )

    try:
        run_work(work, options_given["timeout"], options_given["memory"], task.name)
    except SymobsError as raised:
        for error in raised.errors if isinstance(raised, ProblemErrors) else (raised,):
            error.where = re.sub(r"^(plant|specification)\.", "--", error.where)
            error.where = re.sub(r"^symbols\.", "--symbol ", error.where)
        raise


def _declaration(entry: str) -> tuple[str, str]:
    name, separator, sign = entry.partition("=")
    return name.strip(), sign.strip() if separator else "real"
