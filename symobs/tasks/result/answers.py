"""What there is of the parts of an answer, which are None where they do not exist."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Mapping

Part = TypeVar("Part")


def those_found(*parts: Part | None) -> tuple[Part, ...]:
    """Return the parts that there are."""
    return tuple(part for part in parts if part is not None)


def named_found(parts: Mapping[str, Part | None]) -> dict[str, Part]:
    """Return the parts that there are by their letters."""
    return {name: part for name, part in parts.items() if part is not None}
