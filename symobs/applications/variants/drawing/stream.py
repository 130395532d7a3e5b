r"""The stream `variants/1`: words made by SHA-256 of seed, candidate, name and number, the same on every machine for ever.

Word k of the draw `name` for candidate c of seed S is the first eight bytes, as a big-endian number, of

    SHA-256("symobs-variants/1\n" + S + "\n" + c + "\n" + name + "\n" + k)

Nothing here may change: a variant is made again from its seed and its number.  Another stream needs another version.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Sequence

VERSION = 1
#: Seeds are the whole numbers up to here.
LARGEST_SEED = 2**63 - 1
_WORDS = 2**64

Item = TypeVar("Item")


class Draw:
    """The words of one draw, in their order."""

    def __init__(self, seed: int, candidate: int, name: str) -> None:
        """Take what the words are made of."""
        self._text = f"symobs-variants/{VERSION}\n{seed}\n{candidate}\n{name}\n"
        self._next = 0

    def word(self) -> int:
        """Return the next word."""
        data = hashlib.sha256(f"{self._text}{self._next}".encode()).digest()
        self._next += 1
        return int.from_bytes(data[:8], "big")

    def below(self, bound: int) -> int:
        """Return a whole number from 0 to below the bound, each as likely: words above the last multiple are left out."""
        limit = bound * (_WORDS // bound)
        while (word := self.word()) >= limit:
            pass
        return word % bound

    def one_of(self, items: Sequence[Item]) -> Item:
        """Return one of the items."""
        return items[self.below(len(items))]

    def some_of(self, items: Sequence[Item], count: int) -> list[Item]:
        """Return so many of the items, none twice: those that Fisher and Yates put at the top first."""
        left = list(items)
        for last in range(len(left) - 1, len(left) - 1 - count, -1):
            other = self.below(last + 1)
            left[last], left[other] = left[other], left[last]
        return left[len(left) - count :]

    def is_heads(self) -> bool:
        """Return true as often as false."""
        return self.below(2) == 1


class Draws:
    """The draws of one candidate, each by its name."""

    def __init__(self, seed: int, candidate: int) -> None:
        """Take the seed and the number of the candidate."""
        self.seed, self.candidate = seed, candidate

    def __getitem__(self, name: str) -> Draw:
        """Return a draw from its first word on."""
        return Draw(self.seed, self.candidate, name)
