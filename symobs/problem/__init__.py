"""Problem files: read (TOML or JSON), validate with all errors at once, run.

A file is never executed and never partly trusted: its size, its nesting and its keys are bounded before it is parsed.
"""

from pathlib import Path

from symobs.problem.file_tables import MAX_BYTES, Decimal, is_text, parse, text_of
from symobs.problem.schema import schema
from symobs.problem.validation import OPEN, Problem, validate

__all__ = ["MAX_BYTES", "OPEN", "Decimal", "Problem", "is_text", "parse", "read", "schema", "text_of", "validate"]


def read(text: str, where: str = "problem", folder: Path | None = None) -> Problem:
    """Return the problem a file describes; text that starts with `{` is JSON, else TOML.

    `folder` is where a convention of the user's own may lie.  Raises `ProblemErrors` with every error of the file.
    """
    return validate(parse(text, where), folder=folder)
