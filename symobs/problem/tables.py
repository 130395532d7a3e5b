"""From the text of a file to its tables.  What would cost a parser too much is refused before it is parsed."""

from __future__ import annotations

import json
import re
import tomllib
from typing import Any

from symobs.errors import InputError, ProblemErrors
from symobs.expression.source import shown

MAX_BYTES = 256 * 1024
_MAX_PARTS = 10
_MAX_TABLES = 1000
_MAX_NESTING = 100
_MAX_DIGITS = 1000


class Decimal(str):
    """A decimal of a file, kept as its text, so that it is read exactly."""

    __slots__ = ()


def parse(text: str, where: str = "problem") -> dict[str, Any]:
    """Return the file's tables, decimals as `Decimal` texts.  Raises `ProblemErrors`."""
    text = text.removeprefix("\ufeff")
    try:
        _guard(text)
        return _parse_json(text) if text.lstrip().startswith("{") else _parse_toml(text)
    except InputError as error:
        error.where = f"{shown(where, 200)}, {error.where}" if error.where else shown(where, 200)
        raise ProblemErrors((error,)) from None


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


def _guard(text: str) -> None:
    """Refuse what would cost the parsers their memory, their stack or their time."""
    if len(text) > MAX_BYTES or len(text.encode("utf-8", "replace")) > MAX_BYTES:
        raise InputError(f"the file is larger than {MAX_BYTES // 1024} kB", repair="keep one problem to a file")
    bare = _QUOTED.sub(lambda found: " " if found["comment"] else "q" + "\n" * found[0].count("\n"), text)
    tables = "use the tables [plant], [specification] and so on"

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


def _parse_json(text: str) -> dict[str, Any]:
    def refuse_constant(name: str) -> Any:
        raise InputError(f"{name} is not a number", repair="write a finite exact value")

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in pairs:
            if key in found:
                raise InputError(f'the key "{shown(key, 40)}" stands twice in one table', repair="keep one of them")
            found[key] = value
        return found

    try:
        data: dict[str, Any] = json.loads(
            text, parse_float=Decimal, parse_constant=refuse_constant, object_pairs_hook=unique
        )
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        repair = "check quotes, commas and brackets there"
        raise InputError(f"this is not JSON: {error.msg}", where=place, repair=repair) from None
    return data


def _parse_toml(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except ValueError as error:  # a TOMLDecodeError, or a date that does not exist
        message, _, place = str(error).partition(" (at ")
        place = place.rstrip(")").replace("end of document", "its end")
        number = re.match("line ([0-9]+)", place)
        line = text.split("\n")[int(number[1]) - 1] if number else ""
        repair = _toml_repair(message, line, text)
        raise InputError(f"this is not TOML: {message}", where=place, repair=repair) from None


def _toml_repair(message: str, line: str, text: str) -> str:
    first = re.search(r"^\s*([^\s#].*)", text, re.MULTILINE)
    beginning = first[1] if first else ""
    if re.match(r"---|- |[A-Za-z_]+:(\s|$)", beginning):
        return "YAML is not read: write `key = value` lines under [tables]"
    if re.match(r'\[\s*["{\d]|\[\s*$', beginning):
        return "a problem in JSON begins with {"
    if "overwrite" in message or "twice" in message:
        return "keep one of them"
    if re.search(r"""=\s*\[[^"']*[^"',\s\[][ ;]+[-+\w(]""", line):
        return 'write commas between the entries, or the matrix in quotes: "[0 1; 0 -1]"'
    return "write `key = value` lines under [tables], texts in quotes"
