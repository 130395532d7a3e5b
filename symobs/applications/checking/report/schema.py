"""The JSON schema of a report."""

from __future__ import annotations

from typing import Any

from symobs.applications.checking.report.data import SHOW

_TEXT: dict[str, Any] = {"type": "string"}
_TEXT_OR_NULL: dict[str, Any] = {"type": ["string", "null"]}
_TEXTS: dict[str, Any] = {"type": "array", "items": _TEXT}
_NUMBER = {"type": "string", "pattern": "^[0-9]+(/[0-9]+)?$"}
_NUMBER_OR_NULL = {"anyOf": [_NUMBER, {"type": "null"}]}


def _table(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _named(names: dict[str, Any], **others: Any) -> dict[str, Any]:
    return _table(**{**others, **names})


def schema() -> dict[str, Any]:
    """Return the JSON schema of the report of `symobs check`."""
    part = _named(
        {"from": _TEXTS},
        part=_TEXT,
        letter=_TEXT,
        verdict={"enum": ["right", "follows", "wrong", "missing", "unreadable", "undecided"]},
        weight=_NUMBER,
        credit=_NUMBER_OR_NULL,
        given=_TEXT,
        slip=_TEXT_OR_NULL,
        place={"type": ["array", "object", "null"]},
        reason=_TEXT,
        alternatives=_TEXTS,
        effect={"type": ["object", "null"], "additionalProperties": _TEXT},
        hints=_TEXTS,
        right=_TEXT_OR_NULL,
    )
    line = _named(
        {"from": _TEXTS},
        where=_TEXT,
        relation=_TEXT,
        verdict={"enum": ["true", "follows", "false", "unreadable", "undecided"]},
        right=_TEXT_OR_NULL,
        reason=_TEXT,
    )
    whole = _table(
        schema={"const": "symobs-check/1"},
        title=_TEXT,
        student=_TEXT,
        variant=_TEXT_OR_NULL,
        convention=_TEXT,
        show={"enum": list(SHOW)},
        verdict={"enum": ["right", "wrong", "incomplete", "unreadable", "undecided"]},
        score=_NUMBER_OR_NULL,
        score_decimal=_TEXT_OR_NULL,
        total=_NUMBER,
        parts={"type": "array", "items": part},
        lines={"type": "array", "items": line},
        first_false=_TEXT_OR_NULL,
        milestones={"type": "array", "items": _table(relation=_TEXT, points=_NUMBER, met={"type": "boolean"})},
        certificates={"type": "array", "items": _table(claim=_TEXT, holds={"type": "boolean"}, how=_TEXT)},
        hints=_TEXTS,
    )
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs check", **whole}
