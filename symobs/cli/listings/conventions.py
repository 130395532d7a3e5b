"""The command `conventions`: the conventions a page can be written in."""

from __future__ import annotations

import click

from symobs.cli.shared.options import OneOf
from symobs.cli.shared.output import write
from symobs.formula.convention import conventions
from symobs.formula.convention.convention import file_of, listed


@click.command("conventions")
@click.argument("name", required=False, type=OneOf(conventions))
def command(name: str | None) -> None:
    """List the conventions a page can be written in, or print the file of the one called NAME."""
    write(listed() if name is None else file_of(name))
