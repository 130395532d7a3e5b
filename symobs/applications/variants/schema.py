"""The JSON schema of the manifest of variants."""

from __future__ import annotations

from typing import Any

from symobs.applications.variants.drawing.stream import LARGEST_SEED, VERSION
from symobs.applications.variants.files import SCHEMA

_TEXT: dict[str, Any] = {"type": "string"}
_COUNT: dict[str, Any] = {"type": "integer", "minimum": 0}
_ANY: dict[str, Any] = {"type": "object"}


def _table(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def schema() -> dict[str, Any]:
    """Return the JSON schema of the manifest that `symobs variants` writes."""
    variant = _table(
        id={"type": "string", "pattern": "^[0-9a-f]{12}$"},
        file={"type": "string", "pattern": "^variants/v[0-9]{3,}[.]toml$"},
        candidate=_COUNT,
        data=_ANY,
        answers=_ANY,
        profile=_table(load=_COUNT, peak=_COUNT, fractions=_COUNT, lines=_COUNT),
        certificates=_COUNT,
    )
    whole = _table(
        schema={"const": SCHEMA},
        engine=_TEXT,
        problem={"type": "string", "pattern": "^[0-9a-f]{64}$"},
        version={"const": VERSION},
        seed={"type": "integer", "minimum": 0, "maximum": LARGEST_SEED},
        count=_COUNT,
        variants={"type": "array", "items": variant},
        rejected={"type": "object", "additionalProperties": _COUNT},
    )
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs variants", **whole}
