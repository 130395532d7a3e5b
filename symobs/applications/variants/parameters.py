"""The parameters of `[variants.parameters]`: what each may be, and how it is drawn."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.drawing import Rows, rows_of, unimodular
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError
from symobs.problem import Decimal
from symobs.problem.fields import fraction_of, is_integer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.applications.variants.drawing import Draw

    Note = Callable[[str, str, str], None]


#: The keys of each kind of parameter; the first one says which kind it is.
KINDS = {
    "integers": ("integers", "except"),
    "set": ("set",),
    "range": ("range",),
    "poles": ("poles", "from", "distinct", "complex", "except"),
    "matrix": ("matrix", "integers", "zeros"),
    "unimodular": ("unimodular", "steps"),
}


_MOST_VALUES = 100_000
_LARGEST = 10**6
_MOST_ORDER = 8
_RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")


class Poles(NamedTuple):
    """Poles that were drawn: (σ, ω), where ω > 0 stands for the pair σ ± iω."""

    pairs: tuple[tuple[int, int], ...]

    def __str__(self) -> str:
        """Return them as the texts of a file."""
        return ", ".join(text for pair in self.pairs for text in _pole(*pair))


def _pole(real: int, imaginary: int) -> tuple[str, ...]:
    if not imaginary:
        return (str(real),)
    size, lead = "" if imaginary == 1 else imaginary, real or ""
    return f"{lead}{'+' if real else ''}{size}i", f"{lead}-{size}i"


#: What a parameter may be.
Value = Fraction | Poles | Rows | str


class Parameter(NamedTuple):
    """A parameter: its kind, and the table of the file."""

    kind: str
    table: Mapping[str, Any]
    choices: Sequence[Any] = ()

    def drawn(self, draw: Draw) -> Value:
        """Return a value."""
        match self.kind:
            case "poles":
                return self._poles(draw)
            case "matrix":
                return self._matrix(draw)
            case "unimodular":
                return unimodular(draw, self.table["unimodular"], self.table.get("steps", 2))
            case _:
                found: Value = draw.one_of(self.choices)
                return found

    def _poles(self, draw: Draw) -> Poles:
        count = self.table["poles"] // (2 if self.table.get("complex") else 1)
        if self.table.get("distinct", False):
            return Poles(tuple(sorted(draw.some_of(self.choices, count), reverse=True)))
        return Poles(tuple(sorted((draw.one_of(self.choices) for _ in range(count)), reverse=True)))

    def _matrix(self, draw: Draw) -> Rows:
        height, width = self.table["matrix"]
        low, high = self.table["integers"]
        empty = set(draw.some_of(range(height * width), self.table.get("zeros", 0)))
        entries = [0 if place in empty else low + draw.below(high - low + 1) for place in range(height * width)]
        return rows_of(entries[row * width : (row + 1) * width] for row in range(height))


def read_parameter(name: str, table: object, note: Note) -> Parameter | None:
    """Return a parameter; every error is noted, with its place and what to write."""
    where = f"variants.parameters.{shown(name, 40)}"
    kind = next((kind for kind in ("matrix", "poles", *KINDS) if isinstance(table, Mapping) and kind in table), None)
    if kind is None or not isinstance(table, Mapping):
        note("no kind of parameter is named", where, f"give one of {', '.join(KINDS)}: {{ integers = [-5, 5] }}")
        return None
    errors: list[object] = []

    def noted(message: str, place: str, repair: str) -> None:
        errors.append(message)
        note(message, place, repair)

    for key in table:
        if key not in KINDS[kind]:
            noted("unknown key", f"{where}.{shown(key, 40)}", f"known keys are {', '.join(KINDS[kind])}")
    choices = _READERS[kind](table, where, noted)
    if not errors and choices is not None and not choices:
        noted("there is no such value", where, "widen what it is drawn from")
    return None if errors else Parameter(kind, dict(table), choices or ())


# -- kinds ------------------------------------------------------------------------------------------------------------


def interval(value: object, where: str, note: Note) -> tuple[int, int] | None:
    """Return the two ends of an interval of whole numbers; None, with an error noted, for anything else."""
    if isinstance(value, list) and len(value) == 2 and all(is_integer(end) for end in value):
        low, high = value
        if low <= high and max(-low, high) <= _LARGEST and high - low < _MOST_VALUES:
            return low, high
    note("two whole numbers are expected, the smaller first", where, "write for example [-5, 5]")
    return None


def count_of(
    table: Mapping[str, Any], key: str, where: str, note: Note, least: int = 1, most: int = _MOST_ORDER
) -> int:
    """Return a small whole number of a table."""
    value = table.get(key, least)
    if is_integer(value) and least <= value <= most:
        return int(value)
    note(f"a whole number from {least} to {most} is expected", f"{where}.{key}", f"write {key} = {max(least, 2)}")
    return least


def _integers(table: Mapping[str, Any], where: str, note: Note) -> list[Fraction]:
    ends = interval(table["integers"], f"{where}.integers", note)
    without = _excepted(table, where, note)
    return [Fraction(value) for value in range(ends[0], ends[1] + 1) if value not in without] if ends else []


def _excepted(table: Mapping[str, Any], where: str, note: Note) -> set[int]:
    value = table.get("except", [])
    if isinstance(value, list) and all(is_integer(entry) for entry in value):
        return set(value)
    note("a list of whole numbers is expected", f"{where}.except", "write except = [0]")
    return set()


def _set(table: Mapping[str, Any], where: str, note: Note) -> list[Fraction]:
    value = table["set"]
    if not isinstance(value, list) or not 0 < len(value) <= _MOST_VALUES:
        note("a list of numbers is expected", f"{where}.set", 'write set = ["1/2", "1", "2"]')
        return []
    return [found for i, entry in enumerate(value) if (found := _number(entry, f"{where}.set[{i}]", note)) is not None]


def _number(value: object, where: str, note: Note) -> Fraction | None:
    found: Fraction | None = fraction_of(value, where)
    if found is None:
        note("a rational number is expected", where, 'write for example "1/2"')
    return found


def _range(table: Mapping[str, Any], where: str, note: Note) -> list[Fraction]:
    value = table["range"]
    parts = _RANGE.fullmatch(value) if isinstance(value, str) else None
    numbers = [_number(part, f"{where}.range", note) for part in parts.groups()] if parts else []
    if parts is None:
        note("start:step:stop is expected", f"{where}.range", 'write range = "1/2:1/2:4"')
    if parts is None or None in numbers:
        return []
    start, step, stop = (number for number in numbers if number is not None)
    if not step or (stop - start) / step < 0 or (stop - start) / step >= _MOST_VALUES:
        note("these steps lead nowhere, or too far", f"{where}.range", 'write range = "1/2:1/2:4"')
        return []
    return [start + step * k for k in range(int((stop - start) / step) + 1)]


def _poles(table: Mapping[str, Any], where: str, note: Note) -> list[tuple[int, int]]:
    count = count_of(table, "poles", where, note)
    ends = interval(table.get("from"), f"{where}.from", note)
    without = _excepted(table, where, note)
    for key in ("distinct", "complex"):
        if not isinstance(table.get(key, False), bool):
            note("true or false is expected", f"{where}.{key}", f"write {key} = true")
    in_pairs = table.get("complex") is True
    if in_pairs and count % 2:
        note("complex poles come in pairs", f"{where}.poles", f"write poles = {count + 1}")
    if ends is None:
        return []
    low, high = ends
    real = [value for value in range(low, high + 1) if value not in without]
    if in_pairs:
        sizes = range(1, max(-low, high) + 1)
        found = [(value, size) for value in real if value < 0 for size in sizes]
    else:
        found = [(value, 0) for value in real]
    if table.get("distinct") is True and len(found) < count // (2 if in_pairs else 1):
        note("there are not so many distinct poles", f"{where}.from", "widen it, or leave distinct out")
    return found


def _matrix(table: Mapping[str, Any], where: str, note: Note) -> None:
    shape = table["matrix"]
    is_shape = isinstance(shape, list) and len(shape) == 2
    if not is_shape or not all(is_integer(size) and 1 <= size <= _MOST_ORDER for size in shape):
        note("two sizes are expected, rows first", f"{where}.matrix", "write matrix = [3, 3]")
        return
    interval(table.get("integers"), f"{where}.integers", note)
    if "zeros" in table:
        count_of(table, "zeros", where, note, least=0, most=shape[0] * shape[1])


def _unimodular(table: Mapping[str, Any], where: str, note: Note) -> None:
    count_of(table, "unimodular", where, note)
    if "steps" in table:
        count_of(table, "steps", where, note, least=0, most=100)


_READERS: dict[str, Callable[[Mapping[str, Any], str, Note], list[Any] | None]] = {
    "integers": _integers,
    "set": _set,
    "range": _range,
    "poles": _poles,
    "matrix": _matrix,
    "unimodular": _unimodular,
}


# A problem with values in place of the letters of its parameters, and its text as a file.


#: Tables whose texts are expressions, and texts for people, where a letter stands in braces.
_EXPRESSIONS = ("plant", "specification", "constants", "values", "marking", "expect")
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
