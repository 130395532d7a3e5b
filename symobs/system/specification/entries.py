"""Entries of a gain that are to vanish: pairs (row, column), or a pattern of 0 and *."""

from __future__ import annotations

import re

from symobs.ground.errors import InputError, ShapeMismatch


def read_entries(value: object, name: str, shape: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Return entries, counted from 0, from pairs (row, column) counted from 1 or from a pattern of 0 and *."""
    where = f"specification.{name}"
    rows = value if isinstance(value, (list, tuple)) else [value]
    text = "; ".join(" ".join(map(str, row)) if isinstance(row, (list, tuple)) else str(row) for row in rows)
    if "*" in text or set(re.findall(r"[0-9]+", text)) == {"0"}:
        return _read_pattern(text, where, shape)
    numbers = [int(digits) for digits in re.findall(r"[0-9]{1,4}", text)]
    if not numbers or len(numbers) % 2 or re.search(r"[^0-9,;\s()\[\]]", text):
        message = f"{text[:40]!r} is no list of entries"
        raise InputError(message, where=where, repair='write (row, column) counted from 1: "(1, 2), (3, 1)"')
    found = tuple(dict.fromkeys((i - 1, j - 1) for i, j in zip(numbers[::2], numbers[1::2], strict=True)))
    for i, j in found:
        if not (0 <= i < shape[0] and 0 <= j < shape[1]):
            message = f"there is no entry ({i + 1}, {j + 1}) in a {shape[0]}×{shape[1]} gain"
            raise InputError(
                message, where=where, repair='count rows and columns from 1, or write a pattern, "[* 0; * *]"'
            )
    return found


def _read_pattern(text: str, where: str, shape: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Return the places of the zeros of a pattern."""
    rows = [row.replace(",", " ").split() for row in text.strip(" []").replace("\n", ";").split(";")]
    if any(sign not in {"0", "*"} for row in rows for sign in row):
        message = f"the pattern {text[:40]!r} has other signs than 0 and *"
        raise InputError(message, where=where, repair='write for example "[* 0; * *]"')
    if (len(rows), *{len(row) for row in rows}) != shape:
        message = f"the pattern {text[:40]!r} is not {shape[0]}×{shape[1]}"
        raise ShapeMismatch(message, where=where, repair=f"write {shape[0]} rows of {shape[1]} signs 0 or *")
    return tuple((i, j) for i, row in enumerate(rows) for j, sign in enumerate(row) if sign == "0")
