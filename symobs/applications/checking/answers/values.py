"""The values of an answer: texts, lists and numbers, always exact."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from fractions import Fraction
from typing import Any

from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.expression import parse_matrix, parse_scalar
from symobs.formula.expression.parse import ROW, ROWS
from symobs.ground.errors import SymobsError
from symobs.problem.expect.structure import factored_table

#: A decimal number, not a part of a name or of a longer number.
_DECIMAL = re.compile(
    r"(?<![A-Za-z0-9_.])(?:(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?|[0-9]+[eE][+-]?[0-9]{1,3})(?![A-Za-z0-9_.])"
)
#: A decimal comma stands between two digits, with no space around it.
_COMMA = re.compile(r"(?<![0-9.,])([0-9]+),([0-9]+)(?![0-9.,])")
#: What editors and web pages put in place of the minus and of nothing.
_TYPED = str.maketrans(
    dict.fromkeys("\u2212\u2010\u2011\u2013", "-")
    | dict.fromkeys("\u200b\u2060\ufeff")
    | {"\u00a0": " "}
    | {"\u2264": "<=", "\u2265": ">=", "\u2260": "!="}
)
#: What NumPy and SymPy call a matrix.
_CALL = re.compile(
    r"(?:[A-Za-z]+\.)?(array|asarray|matrix|Matrix|ImmutableMatrix)\(\s*(\[.*\])\s*(?:,\s*dtype\s*=\s*[\w.]+\s*)?\)",
    re.DOTALL,
)
#: A matrix of SymPy by its size and the entries of its rows.
_OF_SIZE = re.compile(r"(?:[A-Za-z]+\.)?(?:Immutable)?Matrix\(\s*(\d{1,2})\s*,\s*(\d{1,2})\s*,\s*\[([^][;]*)\]\s*\)")
_FLAT = re.compile(r"\[([^][;]*)\]")
_QUOTED = re.compile(r"""(["'])([^"']*)\1""")
_QUOTE, _ORDER = re.compile(r"[\"']"), re.compile(r"[<>]")


#: What a verdict may be called.
VERDICTS = {
    "yes": "yes",
    "true": "yes",
    "ja": "yes",
    "no": "no",
    "false": "no",
    "nein": "no",
    "conditional": "conditional",
}


def typed(text: str) -> str:
    """Return a text with the minus, the spaces and the byte order mark of ASCII."""
    return text.translate(_TYPED)


def as_value(text: str) -> str | list[str]:
    """Return the text of a value without its quotes and the semicolon that ends a statement, and rows in brackets as rows.

    A vector of NumPy, which is neither row nor column, is the list of its entries; one of SymPy is a column.
    """
    value = text.strip().removesuffix(";").rstrip()
    if quoted := _QUOTED.fullmatch(value):
        value = quoted[2].strip()
    if sized := _OF_SIZE.fullmatch(value):
        columns, entries = int(sized[2]), sized[3].split(",")
        if len(entries) != int(sized[1]) * columns or not columns:
            return value
        return f"[{'; '.join(', '.join(entries[i : i + columns]) for i in range(0, len(entries), columns))}]"
    called = _CALL.fullmatch(value)
    flat = _FLAT.fullmatch(called[2]) if called else None
    if called and flat:
        entries = [entry.strip() for entry in flat[1].split(",") if entry.strip()]
        if called[1] in {"array", "asarray"}:
            return entries
        return f"[{(', ' if called[1] == 'matrix' else '; ').join(entries)}]"
    quote = _QUOTE.search(value)
    if quote and _ORDER.search(value, quote.end()):  # conditions in quotes
        return value
    rows = ROWS.fullmatch(called[2] if called else value)
    return f"[{'; '.join(row.strip() for row in ROW.findall(rows[1]))}]" if rows else value


def plain(value: Any) -> Any:
    """Return a value as texts, integers and lists of them: arrays and SymPy objects are written out.

    A float stays one, so that whoever reads it refuses it and says what to write.
    """
    if isinstance(value, str):
        return as_value(typed(value))
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if hasattr(value, "free_symbols"):
        return str(value)
    return value


def has_decimals(value: Any) -> bool:
    """Return whether a decimal stands in a value."""
    if isinstance(value, Mapping):
        return any(map(has_decimals, value.values()))
    if isinstance(value, list):
        return any(map(has_decimals, value))
    return isinstance(value, str) and _DECIMAL.search(value) is not None


def decimal_comma(value: Any) -> str:
    """Return the number with a decimal comma in a text, empty where there is none."""
    found = _COMMA.search(value) if isinstance(value, str) else None
    return found[0] if found else ""


def has_decimal_commas(value: Any, names: Any, shape: tuple[int, int]) -> bool:
    """Return whether a matrix has the right size, or its transpose, if the commas between its digits are of decimals."""
    if not decimal_comma(value):
        return False
    with suppress(SymobsError):
        return parse_matrix(_COMMA.sub(r"\1.\2", value), names).shape in {shape, shape[::-1]}
    return False


def exact(value: Any) -> Any:
    """Return the same value with every decimal as the fraction that it is: 0.333 is 333/1000."""
    if isinstance(value, Mapping):
        return {key: exact(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [exact(entry) for entry in value]
    return _DECIMAL.sub(lambda found: f"({Fraction(found[0])})", value) if isinstance(value, str) else value


def text_of(value: Any) -> str:
    """Return a value as a student may have written it."""
    if isinstance(value, list):
        rows = [" ".join(map(text_of, row)) if isinstance(row, list) else text_of(row) for row in value]
        return f"[{('; ' if any(isinstance(row, list) for row in value) else ', ').join(rows)}]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {text_of(entry)}" for key, entry in value.items()) + "}"
    return str(value)


def read_like(found: Any, value: Any, names: Any, variable: str, where: str) -> Matrix | Scalar | None:
    """Return the value of an answer as a matrix or a number, as the right one is; None where that is neither.

    Raises what reading it raises.
    """
    table = factored_table(found)
    right = found.value if isinstance(found, Factored) else table if table is not None else found
    if isinstance(right, int) and not isinstance(right, bool):
        right = Scalar.of(right)
    if not isinstance(right, (Matrix, Scalar)):
        return None
    free = None if names is not None and variable in names else variable
    read = parse_matrix if isinstance(right, Matrix) else parse_scalar
    return read(exact(value), names, variable=free, where=where, functions=True)
