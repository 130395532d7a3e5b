"""The command `schema`: the JSON schema of problem files."""

from __future__ import annotations

import json

import click

from symobs.cli.shared.output import write
from symobs.problem import schema as whole


@click.command("schema")
def command() -> None:
    """Print the JSON schema of problem files."""
    write(json.dumps(whole(), indent=2, ensure_ascii=False) + "\n")
