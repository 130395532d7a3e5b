"""Conditions as students write them: chains, conjunctions and unions of inequalities."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.checking.answers.values import exact
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Scalar

_OPERATOR = re.compile(r"(!=|>=|<=|>|<|==|=)")
_BETWEEN = re.compile(r"[()]|\band\b|&&?|[,;]")
_OR = re.compile(r"\bor\b|\|\|?")
_MOST, _DEEPEST = 40, 10
#: A union of conjunctions.
Union = tuple[tuple["Inequality", ...], ...]


class Inequality(NamedTuple):
    """value > 0, value >= 0 or value != 0, and how it was written."""

    value: Scalar
    operator: str
    text: str

    def holds(self, sign: int) -> bool:
        """Return whether it holds where the value has this sign."""
        return sign > 0 if self.operator == ">" else sign >= 0 if self.operator == ">=" else sign != 0


def read_conditions(given: Any, names: Any, where: str = "stable_if") -> Union:
    """Return the conditions of a text, of a list (all of them hold) or of a list of lists (one of them holds).

    Raises `InputError` for what is no condition.
    """
    given = _unpacked(given)
    if isinstance(given, str):
        union = [_conjunction([part], names, where) for part in _OR.split(given)]
    elif isinstance(given, list) and any(isinstance(part, list) for part in given):
        parts = [part if isinstance(part, list) else [part] for part in given]
        union = [_conjunction(part, names, where) for part in parts]
    elif isinstance(given, list) and len(given) > 1 and any(map(_OR.search, map(str, given))):
        raise InputError('a list with "or" has two readings', where=where, repair="write a list of lists")
    elif isinstance(given, list) and len(given) == 1:
        return read_conditions(given[0], names, where)
    elif isinstance(given, list):
        union = [_conjunction(given, names, where)]
    else:
        raise InputError("conditions are expected", where=where, repair='write "h1 > 3 and h2 > 0"')
    found = tuple(part for part in union if part is not None)
    if sum(map(len, found)) > _MOST:
        raise InputError(f"more than {_MOST} conditions", where=where, repair="write fewer")
    return found


def _unpacked(given: Any) -> Any:
    """Return the conditions in a text that is a list, of texts in quotes or of conditions; another value as it is."""
    if not isinstance(given, str):
        return given
    text = given.strip()
    if '"' in text or "'" in text:
        inside = text.replace("'", '"')
        with suppress(ValueError, RecursionError):
            return json.loads(inside if inside.startswith("[") else f"[{inside}]")
    return text[1:-1] if text[:1] + text[-1:] in {"[]", "{}"} else text


def _conjunction(parts: Sequence[Any], names: Any, where: str) -> tuple[Inequality, ...] | None:
    """Return the inequalities that hold together; None where one of them is False."""
    found: list[Inequality] = []
    for part in parts:
        if not isinstance(part, str):
            raise InputError("a condition is a text", where=where, repair='write "h1 > 3"')
        for text in _conjuncts(part, where):
            if text == "False":
                return None
            if text not in {"", "True"}:
                found += _chain(text, names, where)
    return tuple(found)


def _conjuncts(text: str, where: str, depth: int = 0) -> list[str]:
    """Return the parts of a conjunction, each without the brackets around it, however these are nested."""
    if depth > _DEEPEST:
        raise InputError("brackets are nested too deeply", where=where, repair="write the conditions as a list")
    inner = _without_brackets(text)
    pieces, level, start = [], 0, 0
    for found in _BETWEEN.finditer(inner):
        level += (found[0] == "(") - (found[0] == ")")
        if level == 0 and found[0] not in "()":
            pieces.append(inner[start : found.start()])
            start = found.end()
    pieces.append(inner[start:])
    if len(pieces) == 1 and inner == text.strip():
        return [inner]
    return [part for piece in pieces for part in _conjuncts(piece, where, depth + 1)]


def _without_brackets(text: str) -> str:
    """Return a text without the brackets around all of it."""
    inner = text.strip()
    if not inner.startswith("(") or not inner.endswith(")"):
        return inner
    depth = 0
    for place, character in enumerate(inner):
        depth += (character == "(") - (character == ")")
        if not depth and place < len(inner) - 1:
            return inner
    return inner[1:-1] if _OPERATOR.search(inner) else inner


def _chain(text: str, names: Any, where: str) -> list[Inequality]:
    """Return the inequalities of a chain: 3 < h1 < 8."""
    pieces = _OPERATOR.split(text)
    if len(pieces) < 3 or any(operator in {"=", "=="} for operator in pieces[1::2]):
        repair = 'write for example "h1 > 3" or "3 < h1 < 8"'
        raise InputError(f'"{shown(text, 60)}" is no condition', where=where, repair=repair)
    sides = [parse_scalar(exact(side), names, where=where, functions=True) for side in pieces[::2]]
    found: list[Inequality] = []
    for i, operator in enumerate(pieces[1::2]):
        value = sides[i] - sides[i + 1] if operator in {">", ">=", "!="} else sides[i + 1] - sides[i]
        plain = operator.replace("<", ">")
        below = value.denominator
        written = f"{pieces[2 * i].strip()} {operator} {pieces[2 * i + 2].strip()}"
        found.append(Inequality(value.numerator * below, plain, written))
        if plain != ">" and not below.is_constant:
            found.append(Inequality(below, "!=", written))
    return found
