"""Reading a convention from a small TOML file.

name = "lecture"
title = "our lecture notes"
feedback = "u = K x_hat"          # or "u = -K x_hat"
observer = "A + M C"              # the observer matrix: the letter of its gain, and the sign
pair = "[A, C]"                   # brackets and order of the pair that is observable
[letters]                         # standard letter = what is written in its place
e = "x_bar"
[letters_of_reduced_order]        # besides, where a reduced-order observer has F, G, H, M of its own
M_z = "S"
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from typing import TYPE_CHECKING, Any

from symobs.formula.convention.convention import Convention
from symobs.formula.notation import LETTERS
from symobs.formula.parser_limits import refuse_costly
from symobs.ground.errors import InputError, ProblemErrors, reason_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_MOST_BYTES = 20_000
_SHOWN = 40
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
_SPELLING = r"[A-Za-z]+[0-9]*(?:_[A-Za-z0-9]+)*"
_LETTER = re.compile(_SPELLING)
#: The same in a law, no longer than a letter may be.
_GAIN = rf"(?=\w{{1,{_SHOWN}}}\b)({_SPELLING})"
#: Each key with the pattern of its text, what stands there where it is left out, and what to write.
_TEXTS = {
    "name": (_NAME, None, 'write name = "lecture"'),
    "title": (re.compile(r"[^\x00-\x1f]{0,200}"), "", "write a short text in quotes"),
    "feedback": (
        re.compile(rf"\s*u\s*=\s*([-+−]?)\s*{_GAIN}\s*x_hat\s*"),
        "u = -K x_hat",
        'write "u = -K x_hat" or "u = K x_hat"',
    ),
    "observer": (
        re.compile(rf"\s*A\s*([-+−])\s*{_GAIN}\s+C\s*"),
        "A - L C",
        'write for example "A - L C" or "A + M C"',
    ),
    "pair": (
        re.compile(r"(?:(\()|(\[)|(\{))\s*(A\s*,\s*C|C\s*,\s*A)\s*(?(1)\))(?(2)\])(?(3)\})"),
        "(C, A)",
        'write for example "(C, A)" or "[A, C]"',
    ),
}
_TABLES = ("letters", "letters_of_reduced_order")
#: Letters that nearly every page speaks of: no other letter may be written like one of them.
_COMMON = ("A", "B", "C", "D", "K", "L", "x", "x_hat", "u", "y", "e", "F", "T")


def is_name(text: str) -> bool:
    """Return whether a text can be the name of a convention."""
    return _NAME.fullmatch(text) is not None


@cache
def of_file(path: Path) -> Convention:
    """Return the convention of a file; raises `ProblemErrors` with every error in it."""
    where = path.name[:200]
    try:
        with path.open("rb") as stream:
            raw = stream.read(_MOST_BYTES + 1)
        if len(raw) > _MOST_BYTES:
            raise ValueError(f"it is longer than {_MOST_BYTES} bytes")  # noqa: TRY301 - said like every other reason
        text = raw.decode()
        refuse_costly(text, _MOST_BYTES)
        table = tomllib.loads(text)
    except (OSError, ValueError, RecursionError) as error:
        message = f"no convention can be read: {reason_of(error)}"
        unreadable = InputError(message, where=where, repair="write a small TOML file")
        raise ProblemErrors((unreadable,)) from None
    return read_convention(table, where)


def read_convention(table: Mapping[str, Any], where: str) -> Convention:
    """Return the convention of a table; raises `ProblemErrors` with every error in it."""
    errors: list[InputError] = []
    known = (*_TEXTS, *_TABLES)
    repair = f"known keys are {', '.join(known)}"
    errors += [InputError("unknown key", where=key[:_SHOWN], repair=repair) for key in table if key not in known]
    texts = {key: _text(table, key, errors) for key in _TEXTS}
    letters, reduced = (_letters(table, key, errors) for key in _TABLES)
    law, matrix, pair = texts["feedback"], texts["observer"], texts["pair"]
    if law and matrix:
        gains = {standard: found[2] for standard, found in (("K", law), ("L", matrix)) if found[2] != standard}
        letters = {**gains, **letters}
        errors += [*_shared(letters, _TABLES[0]), *_shared({**letters, **reduced}, _TABLES[1])]
    if errors or not (law and matrix and pair and texts["name"] and texts["title"]):
        for error in errors:
            error.where = f"{where}, {error.where}"
        raise ProblemErrors(tuple({str(error): error for error in errors}.values()))
    brackets = next(both for both, found in zip(("()", "[]", "{}"), pair.groups(), strict=False) if found)
    return Convention(
        texts["name"][0],
        texts["title"][0],
        1 if law[1] in {"", "+"} else -1,
        1 if matrix[1] == "+" else -1,
        (brackets[0], brackets[1]),
        state_first=pair[4].startswith("A"),
        letters=letters,
        reduced=reduced,
    )


def _text(table: Mapping[str, Any], key: str, errors: list[InputError]) -> re.Match[str] | None:
    """Return the match of the text of a key; an error is recorded if there is none."""
    pattern, usual, repair = _TEXTS[key]
    value = table.get(key, usual)
    found = pattern.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        errors.append(InputError("this cannot be read" if key in table else "it is missing", where=key, repair=repair))
    return found


def _letters(table: Mapping[str, Any], key: str, errors: list[InputError]) -> dict[str, str]:
    """Return a table of letters; errors are recorded."""
    value = table.get(key, {})
    if not isinstance(value, dict):
        errors.append(InputError("a table is expected", where=key, repair=f"write [{key}] and the letters below it"))
        return {}
    found: dict[str, str] = {}
    for name, text in value.items():
        place = f"{key}.{name[:_SHOWN]}"
        if name not in LETTERS or name == "s":
            errors.append(InputError("the standard convention has no such letter", where=place, repair=_nearest(name)))
        elif not isinstance(text, str) or not _LETTER.fullmatch(text) or len(text) > _SHOWN:
            repair = 'write for example "M", "x_bar" or "r_o"'
            errors.append(InputError("a letter is expected", where=place, repair=repair))
        else:
            found[name] = text
    return found


def _nearest(name: str) -> str:
    from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

    near = get_close_matches(name[:_SHOWN], LETTERS, 1)
    return f"did you mean {near[0]}?" if near else "write a letter of the standard convention, such as K, L or e"


def _shared(written: Mapping[str, str], key: str) -> list[InputError]:
    """Return an error for each letter with the form of another letter of the pages."""
    errors: list[InputError] = []
    for name, text in written.items():
        others = [other for other in _COMMON if other != name and written.get(other, other) == text]
        if others:
            message = f"{text} would stand for {name} and for {others[0]}"
            errors.append(InputError(message, where=f"{key}.{name}", repair="give each a letter of its own"))
    return errors
