"""Slips of a formula: the single small changes that make a printed equation true.

Kinds are tried from the simplest on, and the first that finds something decides.  A change counts only if the equation
is then true, and only if it is the only one of its kind, or the only one that stays with the same letter.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations, islice
from typing import TYPE_CHECKING, Protocol

from symobs.exact import Scalar
from symobs.formula.expression.syntax import SyntaxNode, every, exponent_of, letters_of, with_part
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator

_MOST_TRIED = 1_000
#: So many parts of changed equations are evaluated for one finding, and for all of a file: of long equations fewer
#: changes are tried.
_MOST_PARTS, _MOST_PARTS_OF_A_FILE = 12_000, 100_000
_MOST_ROWS = 6
_MINUS_ONE = SyntaxNode("negative", (SyntaxNode("number", text="1", value=Scalar.of(1)),))
_INDEX = re.compile(r"_?[0-9]+$|_d$")
_INDEXED = re.compile(r"(.*?)_?([0-9]+|d)")


@dataclass
class Slip:
    """A changed side, the change, and whether its letter is kept."""

    side: SyntaxNode
    reason: str
    near: bool = True


class Alphabet(Protocol):
    """The interface of the letters of an equation for the search for slips."""

    def offered(self, name: str, *, primed: bool) -> Collection[str]:
        """Return the letters that fit in place of `name`; with `primed` those whose transpose or derivative fits."""

    def is_signal(self, name: str) -> bool:
        """Return whether a letter is a signal."""

    def rounded(self, block: SyntaxNode) -> str | None:
        """Return the letter whose value rounds to a matrix of decimals."""


@dataclass(frozen=False)
class SearchBudget:
    """The remaining trials of the search for the findings of a file."""

    left: int = _MOST_PARTS_OF_A_FILE

    def asks(self, true: Callable[[SyntaxNode, SyntaxNode], bool]) -> Callable[[SyntaxNode, SyntaxNode], bool]:
        """Return a test limited to the trials of one finding; beyond them it answers no."""
        end = max(0, self.left - _MOST_PARTS)

        def asked(left: SyntaxNode, right: SyntaxNode) -> bool:
            cost = sum(1 for side in (left, right) for _ in every(side))
            if self.left - cost < end:
                return False
            self.left -= cost
            return true(left, right)

        return asked


def found_slip(
    left: SyntaxNode, right: SyntaxNode, true: Callable[[SyntaxNode, SyntaxNode], bool], alphabet: Alphabet
) -> tuple[SyntaxNode, SyntaxNode, str] | None:
    """Return the corrected sides and the reason, None if no single slip explains the equation."""
    kinds: list[Callable[[SyntaxNode], Iterator[Slip]]] = [
        lambda side: _digits(side, alphabet),
        _exchanged,
        _whole,
        _stacked,
        _dropped,
        lambda side: _primes(side, alphabet),
        _inverses,
        _signs,
        lambda side: (slip for slip in _letters(side, alphabet) if slip.near),
        _indices,
        lambda side: (slip for slip in _letters(side, alphabet) if not slip.near),
        lambda side: _letters(side, alphabet, primed=True),
    ]
    for kind in kinds:
        decided = _decided(left, right, true, kind)
        if decided is not None:
            return decided[0]
    return _throughout(left, right, true, alphabet)


def _throughout(
    left: SyntaxNode, right: SyntaxNode, true: Callable[[SyntaxNode, SyntaxNode], bool], alphabet: Alphabet
) -> tuple[SyntaxNode, SyntaxNode, str] | None:
    """Return the equation with one letter replaced throughout, if exactly one replacement fits."""
    both = SyntaxNode("row", (left, right))
    twice = [name for name in letters_of(both) if sum(part.text == name for part in every(both)) > 1]
    fitting = []
    for old in twice:
        for new in alphabet.offered(old, primed=False):
            if new not in {*letters_of(both)}:
                changed = _renamed(both, old, new)
                if true(*changed.parts):
                    fitting.append((*changed.parts, f"{_printed_for(old, new)} throughout"))
    return fitting[0] if len(fitting) == 1 else None  # type: ignore[return-value]


def _renamed(node: SyntaxNode, old: str, new: str) -> SyntaxNode:
    if node.kind == "letter" and node.text == old:
        return replace(node, text=new)
    return replace(node, parts=tuple(_renamed(part, old, new) for part in node.parts))


def _decided(
    left: SyntaxNode,
    right: SyntaxNode,
    true: Callable[[SyntaxNode, SyntaxNode], bool],
    kind: Callable[[SyntaxNode], Iterator[Slip]],
) -> tuple[tuple[SyntaxNode, SyntaxNode, str] | None] | None:
    """Return a pair with the unique slip of a kind; None if there is none, a pair of None if there are several."""
    candidates = [
        *((slip, (left, slip.side)) for slip in islice(kind(right), _MOST_TRIED)),
        *((slip, (slip.side, right)) for slip in islice(kind(left), _MOST_TRIED) if left.kind != "letter"),
    ]
    fitting: dict[str, tuple[Slip, tuple[SyntaxNode, SyntaxNode]]] = {}
    for slip, pair in candidates:
        if pair[0] != pair[1] and not (fitting and _text(pair) in fitting) and true(*pair):
            fitting[_text(pair)] = (slip, pair)
    if not fitting:
        return None
    near = [entry for entry in fitting.values() if entry[0].near] or list(fitting.values())
    if len(near) > 1:
        return (None,)
    slip, pair = near[0]
    return ((*pair, slip.reason),)


def _text(pair: tuple[SyntaxNode, SyntaxNode]) -> str:
    return f"{pair[0]} = {pair[1]}"


def _printed_for(printed: SyntaxNode | str, right: SyntaxNode | str) -> str:
    return f"{printed} is printed for {right}"


def _everywhere(node: SyntaxNode, change: Callable[[SyntaxNode], Iterator[Slip]]) -> Iterator[Slip]:
    """Yield the tree with one of its parts changed."""
    yield from change(node)
    for i, part in enumerate(node.parts):
        for slip in _everywhere(part, change):
            yield Slip(with_part(node, i, slip.side), slip.reason, slip.near)


def _exchanged(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with two entries of a bracket exchanged."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        if node.kind != "block":
            return
        cells = [(i, j) for i, row in enumerate(node.parts) for j in range(len(row.parts))]
        for (a, b), (c, d) in combinations(cells[:12], 2):
            first, second = node.parts[a].parts[b], node.parts[c].parts[d]
            if not letters_of(first) or not letters_of(second):
                continue
            once = with_part(node, a, with_part(node.parts[a], b, second))
            twice = with_part(once, c, with_part(once.parts[c], d, first))
            yield Slip(twice, f"{first} and {second} are exchanged")

    return _everywhere(side, change)


def _whole(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side transposed as a whole."""
    if side.kind == "call":
        yield Slip(SyntaxNode("primed", (side,)), _printed_for(side, f"its transpose {side}'"))


def _stacked(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with blocks stacked in rows instead of columns, or the reverse."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        if node.kind == "block" and 1 in (len(node.parts), len(node.parts[0].parts)) and letters_of(node):
            rows = zip(*(row.parts for row in node.parts), strict=True)
            turned = SyntaxNode("block", tuple(SyntaxNode("row", tuple(row)) for row in rows))
            yield Slip(turned, _printed_for(node, turned))

    return _everywhere(side, change)


def _dropped(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with rows of a stack left out."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        if node.kind != "block" or not 2 <= len(node.parts) <= _MOST_ROWS or not letters_of(node):
            return
        for count in range(1, len(node.parts)):
            for gone in combinations(range(len(node.parts)), count):
                kept = tuple(row for i, row in enumerate(node.parts) if i not in gone)
                rows = " and ".join(str(SyntaxNode("block", (node.parts[i],)))[1:-1] for i in gone)
                are = "rows {} are" if count > 1 else "row {} is"
                yield Slip(SyntaxNode("block", kept), f"the {are.format(rows)} too many")

    return _everywhere(side, change)


def _digits(side: SyntaxNode, alphabet: Alphabet) -> Iterator[Slip]:
    """Yield the side with a matrix rounded before use."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        name = alphabet.rounded(node) if node.kind == "block" else None
        if name is not None:
            exact = f"the digits printed for {name} are too few: only its exact value gives this"
            yield Slip(SyntaxNode("letter", text=name), exact)

    return _everywhere(side, change)


def _primes(side: SyntaxNode, alphabet: Alphabet) -> Iterator[Slip]:
    """Yield the side with a transpose or a dot removed or added."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        if node.kind == "primed":
            yield Slip(node.parts[0], _printed_for(node, node.parts[0]))
            inner = node.parts[0]
            if inner.kind == "letter" and alphabet.is_signal(inner.text):
                yield Slip(SyntaxNode("primed", (node,)), _printed_for(node, SyntaxNode("primed", (node,))))
        elif node.kind == "letter":
            primed = SyntaxNode("primed", (node,))
            yield Slip(primed, _printed_for(node, primed))

    return _outermost(side, change)


def _inverses(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with an inverse removed or added."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        if node.kind == "power" and exponent_of(node) == -1:
            yield Slip(node.parts[0], _printed_for(node, node.parts[0]))
        elif node.kind == "letter":
            inverse = SyntaxNode("power", (node, _MINUS_ONE))
            yield Slip(inverse, _printed_for(node, inverse))

    return _outermost(side, change)


def _outermost(node: SyntaxNode, change: Callable[[SyntaxNode], Iterator[Slip]]) -> Iterator[Slip]:
    """Yield the tree with one of its parts changed, a letter together with its prime or inverse."""
    yield from change(node)
    for i, part in enumerate(node.parts):
        if node.kind not in {"primed", "power"} or part.kind not in {"letter", "primed"}:
            for slip in _outermost(part, change):
                yield Slip(with_part(node, i, slip.side), slip.reason, slip.near)


def _signs(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with its sign, or that of a term, reversed."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        for i, part in enumerate(node.parts if node.kind == "sum" else ()):
            turned = part.parts[0] if part.kind == "negative" else SyntaxNode("negative", (part,))
            inner = part.parts[0] if part.kind == "negative" else part
            yield Slip(with_part(node, i, turned), f"the sign of {inner} is wrong")

    plain = side.parts[0] if side.kind == "negative" else side
    if side.kind != "sum":
        yield Slip(
            plain if side.kind == "negative" else SyntaxNode("negative", (side,)), f"the sign of {plain} is wrong"
        )
    yield from _everywhere(side, change)


def _indices(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with one index replaced throughout."""
    found = {match[2] for name in letters_of(side) if (match := _INDEXED.fullmatch(name)) and match[2].isdigit()}
    for old in sorted(found):
        for new in map(str, range(1, 7)):
            if new != old:
                yield Slip(_reindexed(side, old, new), f"index {old} is printed for {new}")


def _reindexed(node: SyntaxNode, old: str, new: str) -> SyntaxNode:
    if node.kind == "letter" and node.text.endswith(f"_{old}"):
        return replace(node, text=f"{node.text.removesuffix(old)}{new}")
    return replace(node, parts=tuple(_reindexed(part, old, new) for part in node.parts))


def _letters(side: SyntaxNode, alphabet: Alphabet, *, primed: bool = False) -> Iterator[Slip]:
    """Yield the side with a letter replaced by another, its transpose or its derivative."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        for name in alphabet.offered(node.text, primed=primed) if node.kind == "letter" else ():
            plain = SyntaxNode("letter", text=name)
            right = SyntaxNode("primed", (plain,)) if primed else plain
            yield Slip(right, _printed_for(node, right), near=_stem(name) == _stem(node.text))

    alone = _alone(side)
    return (slip for slip in _everywhere(side, change) if slip.near or _alone(slip.side) == alone)


def _alone(side: SyntaxNode) -> set[str]:
    """Return the functions and powers of a letter alone."""
    return {str(part) for part in every(side) if part.kind in {"call", "power"} and part.parts[0].kind == "letter"}


def _stem(name: str) -> str:
    """Return a letter without its index: K of K_2 and K_d, x_hat of x_hat_1, t of t1."""
    return _INDEX.sub("", name) or name
