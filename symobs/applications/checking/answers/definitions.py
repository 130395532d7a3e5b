"""Definitions as students write them: NAME = value, chains of equal values, several of them on a line."""

from __future__ import annotations

import re
from typing import NamedTuple

_NAME = r"[ \t]*([A-Za-z][A-Za-z0-9_.]*)((?:[ \t]*\([szt]\))?)[ \t]*(?::=|==?)(?![=<>])"
#: What gives a letter its value, or a function of s, z or t: F(s) = 1/s.
_DEFINITION = re.compile(rf"{_NAME}(.*)", re.DOTALL)
_NEXT = re.compile(rf"(?:[;,]|\band\b)(?={_NAME})")
_EQUALS = re.compile(r"(?<![<>!=:])==?(?![=<>])")
_ORDER = re.compile(r"[<>]|!=")


class Definition(NamedTuple):
    """A letter, its argument as it was written, and the text of its value; `is_chain` where equal values led to it."""

    name: str
    argument: str
    value: str
    is_chain: bool


def statements(line: str) -> list[str]:
    """Return the definitions that stand on one line behind each other: K = [4 3]; L = [19; 81]."""
    return [line] if " where " in line else _apart(_NEXT, line)


def definition(line: str) -> Definition | None:
    """Return the definition that a line is; its value is the last member of a chain, or the one before a last 0."""
    found = _DEFINITION.fullmatch(line)
    if not found:
        return None
    name, argument, right = found.groups()
    said = right.partition(" where ")[0]
    members = [said] if _ORDER.search(said) else [member.strip() for member in _apart(_EQUALS, said)]
    if len(members) > 1 and members[-1] == "0":
        members.pop()
        return Definition(name, argument, members[-1], is_chain=True)
    # behind a last "=" nothing stands: the whole cannot be read, and takes the place of what was written before
    return Definition(name, argument, members[-1] or right, is_chain=len(members) > 1 or said != right)


def value_of(letter: str, text: str) -> str:
    """Return the value in a text that defines a letter; another text as it is."""
    found = definition(text) if len(statements(text)) == 1 else None
    return found.value if found and found.name.rpartition(".")[2] == letter else text


def is_of_conditions(line: str) -> bool:
    """Return whether a line has inequalities and no equation."""
    return bool(_ORDER.search(line)) and not _EQUALS.search(line) and " where " not in line


def _apart(separator: re.Pattern[str], text: str) -> list[str]:
    """Return the parts of a text between separators that stand in no bracket."""
    parts, start, seen, depth = [], 0, 0, 0
    for found in separator.finditer(text):
        between, seen = text[seen : found.start()], found.start()
        depth += sum(map(between.count, "([{")) - sum(map(between.count, ")]}"))
        if depth == 0:
            parts.append(text[start : found.start()])
            start = found.end()
    return [*parts, text[start:]]
