"""The command `schema`: the JSON schemas of problem files, of sheets and of results."""

from __future__ import annotations

import json

import click

from symobs.applications.checking.report import schema as of_check
from symobs.applications.variants.search import schema as of_variants
from symobs.cli.shared.output import write
from symobs.ground.errors import UsageError
from symobs.problem import schema as of_problem
from symobs.problem.sheet_file import schema as of_sheet

#: What has a schema, by the name that the command takes.
SCHEMAS = {"problem": of_problem, "sheet": of_sheet, "check": of_check, "variants": of_variants}


@click.command("schema")
@click.argument("name", default="problem")
def command(name: str) -> None:
    """Print the JSON schema of problem files, of the file of a sheet, or of the results of the command NAME.

    NAME is problem (default), sheet, check or variants (their manifest).
    """
    if name not in SCHEMAS:
        raise UsageError(f"{name[:40]!r} has no schema", repair=f"take {', '.join(SCHEMAS)}")
    write(json.dumps(SCHEMAS[name](), indent=2, ensure_ascii=False) + "\n")
