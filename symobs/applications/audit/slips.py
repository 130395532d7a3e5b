"""Slips of a formula: the single small changes that make a printed equation true.

Kinds are tried from the simplest on, and the first that finds something decides.  A change counts only if the equation
is then true, and only if it is the only one of its kind, or the only one that stays with the same letter.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cached_property, partial
from itertools import combinations, islice
from typing import TYPE_CHECKING

from symobs.applications.audit.differences import wrong_entries
from symobs.applications.audit.equations import HIDDEN, INSTANTS, Reading
from symobs.applications.audit.evaluation import Flexible, Misfit, as_printed, shape, value_of
from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.rounded_decimals import decimals_in
from symobs.formula.expression.syntax import SyntaxNode, every, exponent_of, letters_of, with_part
from symobs.formula.tree import Environment, Signal
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    Kind = tuple[bool, tuple[int, int]] | None
    Test = Callable[[SyntaxNode, SyntaxNode], bool]
    Change = Callable[[SyntaxNode], Iterator["Slip"]]

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


# Candidate letters in place of a printed one.


_NUMBER = (False, (1, 1))


@dataclass
class CandidateLetters:
    """The letters of an environment, without the names of `fields` of an answer and reserved names.

    Where the sizes `fit` as printed, only letters of the same size may have been meant.
    """

    environment: Environment
    fields: frozenset[str]
    fit: bool = True

    def offered(self, name: str, *, primed: bool) -> list[str]:
        """Return the letters that fit in place of `name`; with `primed` those whose transpose or derivative fits."""
        wanted = self.kinds[name] if name in self.kinds else self._kind(name)
        turned = {other: _turned(kind) for other, kind in self.kinds.items() if kind not in {None, _NUMBER}}
        kinds = turned if primed else self.kinds
        return [other for other, kind in kinds.items() if other != name and (not self.fit or kind == wanted)]

    @cached_property
    def kinds(self) -> dict[str, Kind]:
        """What may be offered, and the kind of each."""
        environment = self.environment
        names = [*environment.values, *environment.signals, *INSTANTS, environment.variable]
        known = [n for n in dict.fromkeys(names) if n not in {*self.fields, *HIDDEN} and not n.endswith("'")]
        return {name: self._kind(name) for name in known}

    def is_signal(self, name: str) -> bool:
        """Return whether a letter is a signal."""
        return name in self.environment.signals

    def rounded(self, block: SyntaxNode) -> str | None:
        """Return the letter whose value rounds to a matrix of decimals."""
        try:
            printed = as_printed(block, Reading(self.environment))
        except Misfit:  # a matrix with 1/0 in it rounds nothing
            return None
        if not isinstance(printed, Matrix) or not decimals_in(printed):
            return None
        known = [(name, value) for name, value in self.environment.values.items() if isinstance(value, Matrix)]
        alike = ((name, value) for name, value in known if value.shape == printed.shape)
        return next((name for name, value in alike if not wrong_entries(printed, value)), None)

    def _kind(self, name: str) -> Kind:
        """Return whether a letter is a signal, and its size; numbers count as 1×1 matrices."""
        try:
            found = value_of(SyntaxNode("letter", text=name), Reading(self.environment))
        except Misfit:
            return None
        return None if isinstance(found, Flexible) else (isinstance(found, Signal), shape(found) or (1, 1))


def _turned(kind: Kind) -> Kind:
    """Return the kind of the transpose of a matrix, or of the derivative of a signal."""
    return kind if kind is None or kind[0] else (False, (kind[1][1], kind[1][0]))


@dataclass(frozen=False)
class SearchBudget:
    """The remaining trials of the search for the findings of a file."""

    left: int = _MOST_PARTS_OF_A_FILE

    def asks(self, true: Test) -> Test:
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
    left: SyntaxNode, right: SyntaxNode, true: Test, alphabet: CandidateLetters
) -> tuple[SyntaxNode, SyntaxNode, str] | None:
    """Return the corrected sides and the reason, None if no single slip explains the equation."""
    letters = [_letters(alphabet), _letters(alphabet, primed=True)]
    kinds: list[Change] = [
        _everywhere(partial(_digits, alphabet)),
        _everywhere(_exchanged),
        _whole,
        _everywhere(_stacked),
        _everywhere(_dropped),
        _outermost(partial(_primes, alphabet)),
        _outermost(_inverses),
        _signs,
        lambda side: (slip for slip in letters[0](side) if slip.near),
        _indices,
        lambda side: (slip for slip in letters[0](side) if not slip.near),
        letters[1],
    ]
    for kind in kinds:
        decided = _decided(left, right, true, kind)
        if decided is not None:
            return decided[0]
    return _throughout(left, right, true, alphabet)


def _throughout(
    left: SyntaxNode, right: SyntaxNode, true: Test, alphabet: CandidateLetters
) -> tuple[SyntaxNode, SyntaxNode, str] | None:
    """Return the equation with one letter replaced throughout, if exactly one replacement fits."""
    both = SyntaxNode("row", (left, right))
    twice = [name for name in letters_of(both) if sum(part.text == name for part in every(both)) > 1]
    fitting = []
    for old in twice:
        for new in alphabet.offered(old, primed=False):
            if new not in {*letters_of(both)}:
                changed = _renamed(both, {old: new})
                if true(*changed.parts):
                    fitting.append((*changed.parts, f"{_printed_for(old, new)} throughout"))
    return fitting[0] if len(fitting) == 1 else None  # type: ignore[return-value]


def _renamed(node: SyntaxNode, names: Mapping[str, str]) -> SyntaxNode:
    """Return a tree with other letters."""
    if node.kind == "letter":
        return replace(node, text=names.get(node.text, node.text))
    return replace(node, parts=tuple(_renamed(part, names) for part in node.parts))


def _decided(
    left: SyntaxNode,
    right: SyntaxNode,
    true: Test,
    kind: Change,
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


def _everywhere(change: Change, skips: Callable[[SyntaxNode, SyntaxNode], bool] = lambda _node, _part: False) -> Change:
    """Return the change of a tree in one of its parts, except below a node where it `skips` a part."""

    def changed(node: SyntaxNode) -> Iterator[Slip]:
        yield from change(node)
        for i, part in enumerate(node.parts):
            for slip in () if skips(node, part) else changed(part):
                yield replace(slip, side=with_part(node, i, slip.side))

    return changed


def _outermost(change: Change) -> Change:
    """Return the change of a tree in one of its parts, a letter together with its prime or inverse."""
    return _everywhere(
        change, lambda node, part: node.kind in {"primed", "power", "at"} and part.kind in {"letter", "primed"}
    )


def _exchanged(node: SyntaxNode) -> Iterator[Slip]:
    """Yield a bracket with two entries exchanged."""
    cells = [(i, j) for i, row in enumerate(node.parts) for j in range(len(row.parts))]
    for (a, b), (c, d) in combinations(cells[:12], 2) if node.kind == "block" else ():
        first, second = node.parts[a].parts[b], node.parts[c].parts[d]
        if letters_of(first) and letters_of(second):
            once = with_part(node, a, with_part(node.parts[a], b, second))
            twice = with_part(once, c, with_part(once.parts[c], d, first))
            yield Slip(twice, f"{first} and {second} are exchanged")


def _whole(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side transposed as a whole."""
    if side.kind == "call":
        yield Slip(SyntaxNode("primed", (side,)), _printed_for(side, f"its transpose {side}'"))


def _stacked(node: SyntaxNode) -> Iterator[Slip]:
    """Yield blocks stacked in rows instead of columns, or the reverse."""
    if node.kind == "block" and 1 in (len(node.parts), len(node.parts[0].parts)) and letters_of(node):
        rows = zip(*(row.parts for row in node.parts), strict=True)
        turned = SyntaxNode("block", tuple(SyntaxNode("row", tuple(row)) for row in rows))
        yield Slip(turned, _printed_for(node, turned))


def _dropped(node: SyntaxNode) -> Iterator[Slip]:
    """Yield a stack with rows left out."""
    if node.kind != "block" or not 2 <= len(node.parts) <= _MOST_ROWS or not letters_of(node):
        return
    for count in range(1, len(node.parts)):
        for gone in combinations(range(len(node.parts)), count):
            kept = tuple(row for i, row in enumerate(node.parts) if i not in gone)
            rows = " and ".join(str(node.parts[i]) for i in gone)
            are = "rows {} are" if count > 1 else "row {} is"
            yield Slip(SyntaxNode("block", kept), f"the {are.format(rows)} too many")


def _digits(alphabet: CandidateLetters, node: SyntaxNode) -> Iterator[Slip]:
    """Yield a letter for a matrix that was rounded before use."""
    name = alphabet.rounded(node) if node.kind == "block" else None
    if name is not None:
        exact = f"the digits printed for {name} are too few: only its exact value gives this"
        yield Slip(SyntaxNode("letter", text=name), exact)


def _primes(alphabet: CandidateLetters, node: SyntaxNode) -> Iterator[Slip]:
    """Yield a part with a transpose or a dot removed or added."""
    inner = node.parts[0] if node.kind == "primed" else node
    primed = SyntaxNode("primed", (node,))
    if node.kind == "primed":
        yield Slip(inner, _printed_for(node, inner))
    if node.kind == "letter" or (node.kind == "primed" and inner.kind == "letter" and alphabet.is_signal(inner.text)):
        yield Slip(primed, _printed_for(node, primed))


def _inverses(node: SyntaxNode) -> Iterator[Slip]:
    """Yield a part with an inverse removed or added."""
    if node.kind == "letter" or (node.kind == "power" and exponent_of(node) == -1):
        turned = SyntaxNode("power", (node, _MINUS_ONE)) if node.kind == "letter" else node.parts[0]
        yield Slip(turned, _printed_for(node, turned))


def _signs(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with its sign, or that of a term, reversed."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        for i, part in enumerate(node.parts if node.kind == "sum" else ()):
            turned, plain = _negated(part)
            yield Slip(with_part(node, i, turned), f"the sign of {plain} is wrong")

    if side.kind != "sum":
        turned, plain = _negated(side)
        yield Slip(turned, f"the sign of {plain} is wrong")
    yield from _everywhere(change)(side)


def _negated(part: SyntaxNode) -> tuple[SyntaxNode, SyntaxNode]:
    """Return the negative of a part, and the part without its sign."""
    plain = part.parts[0] if part.kind == "negative" else part
    return (SyntaxNode("negative", (part,)) if plain is part else plain), plain


def _indices(side: SyntaxNode) -> Iterator[Slip]:
    """Yield the side with one index replaced throughout."""
    found = {match[2] for name in letters_of(side) if (match := _INDEXED.fullmatch(name)) and match[2].isdigit()}
    for old in sorted(found):
        for new in map(str, range(1, 7)):
            if new != old:
                names = {
                    name: f"{name.removesuffix(old)}{new}" for name in letters_of(side) if name.endswith(f"_{old}")
                }
                yield Slip(_renamed(side, names), f"index {old} is printed for {new}")


def _letters(alphabet: CandidateLetters, *, primed: bool = False) -> Change:
    """Return the change of a letter for another, its transpose or its derivative."""

    def change(node: SyntaxNode) -> Iterator[Slip]:
        for name in alphabet.offered(node.text, primed=primed) if node.kind == "letter" else ():
            plain = SyntaxNode("letter", text=name)
            right = SyntaxNode("primed", (plain,)) if primed else plain
            yield Slip(right, _printed_for(node, right), near=_stem(name) == _stem(node.text))

    return lambda side: (slip for slip in _everywhere(change)(side) if slip.near or _alone(slip.side) == _alone(side))


def _alone(side: SyntaxNode) -> set[str]:
    """Return the functions and powers of a letter alone."""
    return {str(part) for part in every(side) if part.kind in {"call", "power"} and part.parts[0].kind == "letter"}


def _stem(name: str) -> str:
    """Return a letter without its index: K of K_2 and K_d, x_hat of x_hat_1, t of t1."""
    return _INDEX.sub("", name) or name
