"""Lists as students write them: numbers in brackets, vectors, nothing; a comma between two digits has two readings."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from symobs.applications.checking.answers.values import decimal_comma, text_of

_LIST = re.compile(r"\[[^][{}]*\]|\{[^][{}]*\}")
_NOTHING = re.compile(r"none|keine|\[\s*\]|\{\s*\}|\u2205", re.IGNORECASE)
_VECTORS = re.compile(r"\[[^][]*\](?:\s*[,;]\s*\[[^][]*\])*")
_VECTOR = re.compile(r"\[[^][]*\]")
#: What sets numbers apart besides a comma: the blanks of "1,5 -2,5", not those of "1 - 2".
_APART = r"[;\n]|(?<=\d)\s+(?=[-+]?\d)"


def as_list(value: Any) -> Any:
    """Return the entries of a text in brackets, [1, 2] or [1; 2] or {1, 2}, or with semicolons; another value as it is.

    So is one whose commas stand between digits while something else sets its entries apart: [1,5; 2,5].
    """
    if not isinstance(value, str):
        return value
    if _NOTHING.fullmatch(value.strip()):
        return []
    is_bare = ";" in value and not re.search(r"[][{}]", value)
    if not (is_bare or _LIST.fullmatch(value.strip())) or has_two_readings(value):
        return value
    inside = value.strip() if is_bare else value.strip()[1:-1].strip()
    parts = re.split(r"[,;\n]" if re.search(r"[,;\n]", inside) else r"\s+", inside)
    return [part.strip() for part in parts if part.strip()]


def has_two_readings(value: Any, length: int | None = None) -> bool:
    """Return whether the commas of a list may be those of decimals: something else sets its entries apart as well.

    For a list that is wrong `length` is that of the right one, which the reading with decimals may have.
    """
    if isinstance(value, list) and any(map(decimal_comma, value)):
        return True
    if length is None:
        parts = re.split(_APART, value.strip()) if isinstance(value, str) else []
        return len(parts) > 1 and any(map(decimal_comma, parts))
    entries = value.split(",") if isinstance(value, str) else value if isinstance(value, list) else []
    if len(entries) != 2 * length or not length or not all(isinstance(entry, str) for entry in entries):
        return False
    return all(map(decimal_comma, map(",".join, zip(entries[::2], entries[1::2], strict=True))))


def as_kernel(value: Any, order: int) -> Any:
    """Return the vectors of a kernel as a list, none for {0}; the text of a single one as it is."""
    if isinstance(value, (str, int)):
        text = str(value).strip()
        inside = text[1:-1].strip() if text[:1] + text[-1:] == "{}" else text
        if _NOTHING.fullmatch(text) or inside == "0":
            return []
        vectors = _VECTOR.findall(inside) if _VECTORS.fullmatch(inside) else []
        value = vectors if len(vectors) > 1 or (inside != text and vectors) else text
    elif isinstance(value, list) and len(value) == order:
        if not any(isinstance(entry, list) or "[" in str(entry) for entry in value):
            value = [value]  # the entries of a single vector
        elif order > 1 and all(isinstance(entry, list) and len(entry) == 1 for entry in value):
            value = [[entry for (entry,) in value]]  # a column
    vectors = value if isinstance(value, list) else [value]
    return [] if all(_is_zero(vector, order) for vector in vectors) else value


def _is_zero(vector: Any, order: int) -> bool:
    return re.findall(r"[^][\s,;]+", text_of(vector)) == ["0"] * order


def in_a_line(value: Any, shape: tuple[int, int]) -> Any:
    """Return a list of as many entries as a row or a column has as that one; another value as it is."""
    is_flat = isinstance(value, list) and not any(isinstance(entry, (list, Mapping)) for entry in value)
    if not is_flat or 1 not in shape or len(value) != shape[0] * shape[1]:
        return value
    return [value] if shape[0] == 1 else [[entry] for entry in value]
