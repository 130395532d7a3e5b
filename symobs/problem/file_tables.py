"""From the text of a file to its tables.  What would cost a parser too much is refused before it is parsed."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from symobs.formula.expression.source import shown
from symobs.formula.parser_limits import refuse_costly
from symobs.ground.errors import InputError, ProblemErrors, reason_of

MAX_BYTES = 256 * 1024


def is_text(given: str) -> bool:
    """Return whether this is the text of a file rather than its path."""
    return "\n" in given or "=" in given or given.lstrip().startswith("{") or not given.strip()


def text_of(given: str | Path, limit: int = MAX_BYTES) -> tuple[str, Path | None]:
    """Return the text of a path, with its folder, or a text itself.  Raises `InputError` where it cannot be read."""
    if isinstance(given, str) and is_text(given):
        return given, None
    path = Path(given)
    try:
        with path.open("rb") as stream:
            return stream.read(limit + 1).decode("utf-8-sig"), path.parent
    except (OSError, ValueError) as error:
        repair = "give the path of a file, or its text"
        raise InputError(reason_of(error), where=shown(str(given), 200), repair=repair) from None


class Decimal(str):
    """A decimal of a file, kept as its text, so that it is read exactly."""

    __slots__ = ()


def parse(text: str, where: str = "problem") -> dict[str, Any]:
    """Return the file's tables, decimals as `Decimal` texts.  Raises `ProblemErrors`."""
    text = text.removeprefix("\ufeff")
    try:
        refuse_costly(text, MAX_BYTES)
        return _parse_json(text) if text.lstrip().startswith("{") else _parse_toml(text)
    except InputError as error:
        error.where = f"{shown(where, 200)}, {error.where}" if error.where else shown(where, 200)
        raise ProblemErrors((error,)) from None


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
    lines = (each.strip() for each in text.split("\n"))
    beginning = next((each for each in lines if each and not each.startswith("#")), "")
    if re.match(r"---|- |[A-Za-z_]+:(\s|$)", beginning):
        return "YAML is not read: write `key = value` lines under [tables]"
    if re.match(r'\[\s*["{\d]|\[\s*$', beginning):
        return "a problem in JSON begins with {"
    if "overwrite" in message or "twice" in message:
        return "keep one of them"
    brackets = re.search(r"""=\s*\[([^"']*)""", line)
    if brackets and re.search(r"""[^,;\s\[][ ;]+[-+\w(]""", brackets[1]):
        return 'write commas between the entries, or the matrix in quotes: "[0 1; 0 -1]"'
    if brackets and re.search(r"[A-Za-z]", brackets[1]):
        return 'write what has letters in quotes: [-2, "-1+i", "-omega"]'
    return "write `key = value` lines under [tables], texts in quotes"


def came(value: object) -> str:
    """Return the kind of a value of a file, in words."""
    if value is None:
        return "null"
    words = {bool: "true or false", Decimal: "a number", int: "a number", str: "a text", list: "a list"}
    return "a table" if isinstance(value, Mapping) else words.get(type(value), "a date or a time")
