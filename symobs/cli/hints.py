"""Hints for command lines that are not understood."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import click

_QUOTES = 'A value with spaces stands in quotes, as in --A "[0 1; 0 -1]" and --poles "-10, -10".'


def hint(error: click.ClickException) -> str:
    """Return a sentence to append to the message, or nothing."""
    context = getattr(error, "ctx", None)
    if context is None:
        return ""
    options = [name for parameter in context.command.params for name in parameter.opts if name.startswith("--")]
    unknown = str(getattr(error, "option_name", ""))
    if unknown:
        meant = {name.lower(): name for name in options}.get(f"--{unknown.lstrip('-').lower()}")
        if meant is not None and meant != unknown:
            return f"Write {meant}."
        return _QUOTES if "--A" in options and re.match(r"-+[\d.]", unknown) else ""
    if "unexpected extra argument" not in error.message:
        return ""
    if "--A" in options:
        return _QUOTES
    return "For several files there is `symobs sheet FILE...`." if context.command.name == "solve" else ""
