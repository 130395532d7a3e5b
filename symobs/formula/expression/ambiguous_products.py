"""Ambiguous products after a division, `1/s(s+1)`: both readings, written out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.expression.source import shown

if TYPE_CHECKING:
    import re
    from collections.abc import Iterator, Sequence

    from symobs.formula.expression.source import Token

OPERAND_ENDS = ("VALUE", "_CLOSE", "_RIGHT", "PRIME")
_OPENING, _CLOSING = ("_OPEN", "LEFT"), ("_CLOSE", "_RIGHT")
_LONGEST_READING = 100


def division_before(tokens: Sequence[Token]) -> int | None:
    """Return the place of the "/" whose divisor ends here, None if there is none."""
    for place in _term_backwards(tokens, len(tokens)):
        if tokens[place].type == "MULTIPLY":
            return place if tokens[place] == "/" else None
    return None


def two_readings(tokens: Sequence[Token], division: int, text: str, at: int, rest: Iterator[re.Match[str]]) -> str:
    """Return both readings of the factors that begin at `at`; `rest` are the pieces of the text from there on."""
    begin = min((tokens[place].start for place in _term_backwards(tokens, division)), default=0)
    slash, end = tokens[division].start, at
    depth, previous = 0, ""
    for piece in rest:
        kind = str(piece.lastgroup)
        ends = kind in {"CLOSE", "COMMA", "END", "MULTIPLY", "SPACE"} or (kind == "ADD" and previous != "POWER")
        if piece.start() != end or (ends and not depth):
            break
        depth += (kind == "OPEN") - (kind == "CLOSE")
        end, previous = piece.end(), kind
    above, below, factors = (text[i:j].strip() for i, j in ((begin, slash), (slash + 1, at), (at, end)))
    return " or ".join(
        shown(reading, _LONGEST_READING) for reading in (f"{above}/{below}*{factors}", f"{above}/({below}*{factors})")
    )


def _term_backwards(tokens: Sequence[Token], end: int) -> Iterator[int]:
    """Yield the places before `end`, backwards, of what belongs to the same term and stands in no further bracket."""
    depth = 0
    for place in range(end - 1, -1, -1):
        kind = tokens[place].type
        if not depth:
            if kind in {*_OPENING, "_COMMA", "_END", "_EQUAL"} or (kind == "ADD" and _follows_operand(tokens, place)):
                return
            yield place
        depth += (kind in _CLOSING) - (kind in _OPENING)
        if not depth and kind in _OPENING:
            yield place


def _follows_operand(tokens: Sequence[Token], place: int) -> bool:
    return place > 0 and tokens[place - 1].type in OPERAND_ENDS
