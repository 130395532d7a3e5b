"""The command `methods`: every task and its methods."""

from __future__ import annotations

import click

from symobs.cli.shared.output import write
from symobs.formula.phrases.literature import written_out
from symobs.tasks.result import methods as known
from symobs.tasks.result import tasks


@click.command("methods")
def command() -> None:
    """List every task and its methods."""
    lines: list[str] = []
    for name, task in sorted(tasks().items()):
        lines.append(f"{name}: {task.summary}")
        for found in known(name).values():
            lines += [f"    {found.name}: {found.summary}", f"        {written_out(found.source)}"]
    write("\n".join(lines) + "\n")
