"""The command `templates`: the built-in LaTeX templates."""

from __future__ import annotations

from pathlib import Path

import click

from symobs.cli.shared.common import place_of
from symobs.cli.shared.output import write, write_all
from symobs.errors import InputError, reason_of
from symobs.render.formats.templates import template_folder


@click.group("templates", invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """List the built-in LaTeX templates, or copy them."""
    if ctx.invoked_subcommand is None:
        write("".join(f"{path.name}\n" for path in _templates()))


@command.command()
@click.argument("folder")
def copy(folder: str) -> None:
    """Copy the built-in LaTeX templates into FOLDER; no file there is overwritten."""
    target = Path(folder)
    taken = [path.name for path in _templates() if (target / path.name).exists()]
    if taken:
        message = f"{taken[0]} is already there"
        raise InputError(message, where=folder[:200], repair="name another folder, or move the file away")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(reason_of(error), where=place_of(folder), repair="name a folder that can be written") from None
    write_all([(path.read_bytes(), str(target / path.name)) for path in _templates()])


def _templates() -> list[Path]:
    return sorted(template_folder().glob("*.tex"))
