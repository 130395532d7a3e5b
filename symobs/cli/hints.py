"""Hints for command lines that are not understood."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import click

_QUOTES = 'A value with spaces stands in quotes, as in --A "[0 1; 0 -1]" and --poles "-10, -10".'
#: What a plant as a whole may be called, for which there is no option of that name.
_PLANTS = {"--plant", "--tf", "--system", "--P", "--G"}
_PLANT = 'The plant is --A, --B, --C and --D, or --transfer-function "1/(s*(s + 1))".'


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
        if unknown in _PLANTS and "--A" in options:
            return _PLANT
        return _QUOTES if "--A" in options and re.match(r"-+[\d.]", unknown) else ""
    if "unexpected extra argument" not in error.message:
        return ""
    if "--A" in options:
        return _QUOTES
    return "For several files there is `symobs sheet FILE...`." if context.command.name == "solve" else ""
