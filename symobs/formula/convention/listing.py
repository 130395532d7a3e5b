"""The list of conventions: laws, observers and letters, or the file of one."""

from __future__ import annotations

from pathlib import Path

from symobs.formula.convention.builtin import PROFILES, convention_named, conventions
from symobs.formula.convention.convention import STANDARD, Convention
from symobs.formula.notation import LETTERS
from symobs.ground.errors import UsageError

_HEAD = ("name", "control law", "observer matrix", "observable pair")
_OF_STANDARD = """\
# The standard convention. Write a file like this one for another.
name = "standard"
title = "the standard convention of the field"
feedback = "u = -K x_hat"
observer = "A - L C"
pair = "(C, A)"

[letters]  # standard letter = what is written in its place

[letters_of_reduced_order]  # the same, on pages with a reduced-order observer
"""


def listed() -> str:
    """Return a table of all conventions, and below it their letters that differ from the standard ones."""
    known = conventions()
    rows = [
        _HEAD,
        *((name, _shown(found.law), _shown(found.observer_matrix), found.pair) for name, found in known.items()),
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_HEAD))]
    lines = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    lines.insert(1, "   ".join("─" * width for width in widths))
    for name, found in known.items():
        lines += ["", f"{name}: {found.title}", *_letters(found)]
    lines += ["", "The error is x − x̂ and the compensator F(s) stands in negative feedback, in all of them."]
    lines += [
        "`symobs conventions NAME` prints the file of one, from which to make your own: NAME.toml beside the problem."
    ]
    return "\n".join(lines) + "\n"


def _shown(typed: str) -> str:
    """Return a law as printed."""
    return typed.replace("x_hat", "x̂").replace("-", "−")


def _letters(found: Convention) -> list[str]:
    """Return the lines on the letters that differ from the standard convention."""
    lines: list[str] = []
    for letters, reduced in ((found.letters, False), (found.reduced, True)):
        forms, where = found.forms(reduced=reduced), " (with a reduced-order observer)" if reduced else ""
        for letter in letters:
            usual, own = (form.text.replace("{v}", "s") for form in (LETTERS[letter], forms[letter]))
            stays = " stays" if own == usual else f" for {usual}"
            lines.append(f"    {own}{stays}, {LETTERS[letter].spoken}{where}")
    return lines


def file_of(name: str) -> str:
    """Return the TOML of a convention; raises `UsageError` naming those that exist."""
    found = convention_named(name).name
    if found == STANDARD.name:
        return _OF_STANDARD
    path = Path(name) if name.endswith(".toml") else PROFILES / f"{found}.toml"
    if not path.is_file():
        raise UsageError("no convention of the package has this law", repair="write a file like that of standard")
    return path.read_text(encoding="utf-8")
