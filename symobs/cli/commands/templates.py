"""The command `templates`: the built-in LaTeX templates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from symobs.cli.shared.options import AFile
from symobs.cli.shared.output import copied, write
from symobs.pages.formats.templates import template_folder

if TYPE_CHECKING:
    from pathlib import Path


@click.group("templates", invoke_without_command=True)
@click.pass_context
def command(ctx: click.Context) -> None:
    """List the built-in LaTeX templates, or copy them."""
    if ctx.invoked_subcommand is None:
        write("".join(f"{path.name}\n" for path in _templates()))


@command.command()
@click.argument("folder", type=AFile("dir"))
def copy(folder: str) -> None:
    """Copy the built-in LaTeX templates into FOLDER; no file there is overwritten."""
    copied(_templates(), folder)


def _templates() -> list[Path]:
    return sorted(template_folder().glob("*.tex"))
