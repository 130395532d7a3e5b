"""A problem with values in place of the letters of its parameters, and its text as a file."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.variants.drawing.parameters import Poles
from symobs.ground.errors import InputError
from symobs.problem import Decimal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.variants.drawing.parameters import Value

#: Tables whose texts are expressions, and texts for people, where a letter stands in braces.
_EXPRESSIONS = ("plant", "specification", "constants", "values", "marking")
_WORDS = ("title", "text")
#: A relation among parameters, as [variants.parameters] lists them: both sides, and the sign between.
RELATION = re.compile(r"^(.*?)(!=|==|>=|<=|>|<|=)(.*)$", re.DOTALL)
#: A number, which may end in a power of ten, or a name.
_TOKEN = re.compile(r"\d+\.?\d*(?:[eE][-+]?\d+)?|([A-Za-z][A-Za-z0-9_]*)")
#: A name in braces that are not the argument of a command, or an exponent or index, of a formula.
_PLACEHOLDER = re.compile(r"(?<![\w^_}])\{([A-Za-z][A-Za-z0-9_]*)\}")
#: Where a whole number stands safely without parentheses: between these.
_BEFORE, _AFTER = "+-([,;", "+-)],;"


def letters_in(base: Mapping[str, Any]) -> set[str]:
    """Return the names that the expressions of a file contain, and those in the braces of its words."""
    found = {name for table in _EXPRESSIONS for text in _texts(base.get(table)) for name in _TOKEN.findall(text)}
    return found | {name for key in _WORDS for name in re.findall(r"\{(\w+)\}", str(base.get(key, "")))}


def letters_of(text: str) -> set[str]:
    """Return the names in a text."""
    return set(_TOKEN.findall(text)) - {""}


def placeholders(base: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return where in the words of a file a name stands in braces, and the name; braces of formulas are none."""
    found = [(key, name) for key in _WORDS for name in _PLACEHOLDER.findall(str(base.get(key, "")))]
    return list(dict.fromkeys(found))


def _texts(value: object) -> list[str]:
    if isinstance(value, str):
        return [] if isinstance(value, Decimal) else [value]
    inner = value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ()
    return [text for each in inner for text in _texts(each)]


def with_values(base: Mapping[str, Any], values: Mapping[str, Value]) -> dict[str, Any]:
    """Return the tables of a problem with values in place of letters."""
    found: dict[str, Any] = {}
    for key, value in base.items():
        if key in _EXPRESSIONS:
            found[key] = _replaced(value, values, key)
        elif key in _WORDS and isinstance(value, str):
            found[key] = re.sub(r"\{(\w+)\}", lambda m: text_of(values[m[1]]) if m[1] in values else m[0], value)
        else:
            found[key] = value
    return found


def _replaced(value: Any, values: Mapping[str, Value], where: str) -> Any:
    if isinstance(value, Mapping):
        return {key: _replaced(each, values, f"{where}.{key}") for key, each in value.items()}
    if isinstance(value, list):
        return [_replaced(each, values, f"{where}[{i}]") for i, each in enumerate(value)]
    if not isinstance(value, str) or isinstance(value, Decimal):
        return value
    return in_text(value, values, where)


def in_text(text: str, values: Mapping[str, Value], where: str) -> str:
    """Return a text with values in place of letters; numbers within an expression have parentheses where they need them."""
    if text.strip() in values:
        return text_of(values[text.strip()])

    def put(found: re.Match[str]) -> str:
        name = found[1]
        if name not in values:
            return found[0]
        value = values[name]
        if isinstance(value, tuple) and not isinstance(value, Poles):
            message = f"{name} is a matrix, which stands alone"
            raise InputError(message, where=where, repair=f'write "{name}" for the whole matrix')
        written = text_of(value)
        before, after = text[: found.start()].rstrip(), text[found.end() :].lstrip()
        alone = (not before or before[-1] in _BEFORE) and (not after or after[0] in _AFTER)
        signed = written.startswith("-") and before and before[-1] in "+-"
        return written if isinstance(value, Poles) or (alone and not signed) else f"({written})"

    return _TOKEN.sub(put, text)


def text_of(value: Value) -> str:
    """Return a value as the texts of a file write it."""
    if isinstance(value, (Fraction, int, str, Poles)):
        return str(value)
    return matrix_text(value)


def matrix_text(rows: Sequence[Sequence[object]]) -> str:
    """Return a matrix of numbers as a text."""
    return f"[{'; '.join(' '.join(map(str, row)) for row in rows)}]"


# -- files ------------------------------------------------------------------------------------------------------------


def toml_text(data: Mapping[str, Any]) -> str:
    """Return tables as a TOML file: values first, then each table under its heading."""
    lines = [f"{_key(key)} = {_value(value)}" for key, value in data.items() if not isinstance(value, Mapping)]
    for key, table in data.items():
        if isinstance(table, Mapping):
            lines += ["", f"[{_key(key)}]", *(f"{_key(name)} = {_value(value)}" for name, value in table.items())]
    return "\n".join([*lines, ""])


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _quoted(name)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(key)} = {_value(each)}' for key, each in value.items())} }}" if value else "{}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, Decimal)):
        return str(value)
    return _quoted(str(value))


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
