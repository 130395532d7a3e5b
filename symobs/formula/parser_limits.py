"""Limits of TOML and JSON texts whose parsing would cost more than linear time or memory.

`tomllib` takes 1.5 GB for the 40 kB of `a.a.a…=1`; both parsers recurse on brackets, and Python on the digits of a number.
"""

from __future__ import annotations

import re

from symobs.ground.errors import InputError

_MAX_PARTS = 10
_MAX_TABLES = 1000
_MAX_NESTING = 100
_MAX_DIGITS = 1000

# Strings and comments as TOML reads them.  One that is never closed reaches to the end, where no parser gets anyway.
_QUOTED = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*(?:"{3,5}|\Z)'
    r"|'''.*?(?:'{3,5}|\Z)"
    r'|"(?:[^"\\\n]|\\[^\n])*"?'
    r"|'[^'\n]*'?"
    r"|(?P<comment>#[^\n]*)",
    re.DOTALL,
)
_LONG_NUMBER = re.compile(rf"(?<!\w)(?:0[xo])?[0-9A-Fa-f][0-9A-Fa-f_]{{{_MAX_DIGITS},}}")
_DOTTED_KEY = re.compile(rf"(?<![\w-])(?:[\w-]+[ \t]*\.[ \t]*){{{_MAX_PARTS},}}")
_HEADER = re.compile(r"^[ \t]*\[[^\],\n]*\]+[ \t\r]*$", re.MULTILINE)


def refuse_costly(text: str, most_bytes: int) -> None:
    """Raise `InputError`, with the line, for a text that would exhaust memory, stack or time of a parser."""
    if len(text) > most_bytes or len(text.encode("utf-8", "replace")) > most_bytes:
        raise InputError(f"the file is larger than {most_bytes // 1024} kB", repair="keep one problem to a file")
    bare = _QUOTED.sub(lambda found: " " if found["comment"] else "q" + "\n" * found[0].count("\n"), text)
    tables = "write keys below the header of their table"

    def refuse(position: int, message: str, repair: str) -> None:
        raise InputError(message, where=f"line {bare.count(chr(10), 0, position) + 1}", repair=repair)

    if found := _LONG_NUMBER.search(bare):
        refuse(found.start(), f"a number or a name has more than {_MAX_DIGITS} characters", "shorten it")
    if found := _DOTTED_KEY.search(bare):
        refuse(found.start(), f"a dotted key has more than {_MAX_PARTS} parts", tables)
    if len(_HEADER.findall(bare)) > _MAX_TABLES:
        raise InputError(f"the file has more than {_MAX_TABLES} tables", repair=tables)
    depth = 0
    for bracket in re.finditer(r"[\[\]{}]", bare):
        depth += 1 if bracket[0] in "[{" else -1
        if depth > _MAX_NESTING:
            message = f"brackets are nested more than {_MAX_NESTING} deep"
            refuse(bracket.start(), message, "write a matrix as a text or as a list of rows")
