"""The text being read: its tokens, safe excerpts of it, and errors that point into it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ExpressionError, InputError

if TYPE_CHECKING:
    from symobs.exact import Complex, Scalar

MOST_SHOWN = 60
#: An error that points into a text shows this much of it, more than half of it before the place.
_EXCERPT, _BEFORE = 40, 24


def shown(text: str, most: int = MOST_SHOWN) -> str:
    """Return the beginning of a text, safe to print: no control characters, nothing long."""
    safe = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text[: most + 1])
    return safe if len(safe) <= most else safe[: most - 1] + "…"


@dataclass(frozen=True)
class Source:
    """A text and the place it comes from (`plant.A`)."""

    text: str
    where: str

    def error(
        self, message: str, position: int, repair: str = "", kind: type[InputError] = ExpressionError, **facts: object
    ) -> InputError:
        """Return an error with `message` at the character `position`."""
        before = self.text[:position]
        line, column = before.count("\n") + 1, position - before.rfind("\n")
        start = max(0, position - _BEFORE)
        excerpt = shown(("…" if start else "") + self.text[start:], _EXCERPT)
        place = f"line {line}, column {column}" if "\n" in self.text else f"column {column}"
        facts |= {"text": excerpt, "line": line, "column": column}
        return kind(f'{message}, at {place} of "{excerpt}"', where=self.where, repair=repair, **facts)


class Token(str):
    """A piece of the text: its type, its start, and its exact number, None if it has none."""

    __slots__ = ("start", "type", "value")

    type: str
    start: int
    value: Scalar | Complex | None

    def __new__(cls, type_: str, text: str, start: int, value: Scalar | Complex | None = None) -> Self:
        """Make the token of a text."""
        token = super().__new__(cls, text)
        token.type, token.start, token.value = type_, start, value
        return token
