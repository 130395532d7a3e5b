"""Descriptions with roots as formulas without: every root becomes a variable of its own with what defines it.

`sqrt(a)` becomes t with t ≥ 0 and t² = a; `CRootOf(p, k)` becomes t with p(t) = 0 between two rational numbers.  The
definitions hold for exactly one value of t wherever the rest may stand, so a set is proved empty with them beside it.
A relation of which a part is undefined holds nowhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from tests.support.regions.region_algebra import (
    FALSE,
    All,
    Atom,
    Polynomial,
    Some,
    opposite,
)
from tests.support.regions.region_roots import UndefinedError, root_of
from tests.support.regions.region_texts import (
    AllOf,
    Binary,
    Call,
    Name,
    NotOf,
    Number,
    Power,
    Relation,
    SomeOf,
    UnreadableError,
    bound,
    combined,
    fraction,
    statement,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from tests.support.regions.region_algebra import Formula
    from tests.support.regions.region_texts import Node, Statement


@dataclass
class Translation:
    """Formulas made so far share their auxiliary variables: the same root is the same variable."""

    definitions: list[Formula] = field(default_factory=list)
    _known: dict[Node, tuple[str, Formula]] = field(default_factory=dict)

    def statement(self, found: Statement) -> Formula:
        """Return a set; its definitions are added to those of the translation."""
        match found:
            case Relation(left, op, right):
                return self.relation(left, op, right)
            case AllOf(parts):
                return All(tuple(self.statement(part) for part in parts))
            case SomeOf(parts):
                return Some(tuple(self.statement(part) for part in parts))
            case NotOf(part):
                return opposite(self.statement(part))

    def relation(self, left: Node, op: str, right: Node) -> Formula:
        """Return where `left op right` holds."""
        guards: list[Formula] = []
        try:
            above, below = combined("-", self.fraction(left, guards), self.fraction(right, guards))
        except UndefinedError:
            return FALSE
        if below.constant is not None:
            atom = Atom(above * (1 / below.constant), op)
            return All((*guards, atom)) if guards else atom
        return All((*guards, Atom(below, "!="), Atom(above * below, op)))

    def fraction(self, node: Node, guards: list[Formula]) -> tuple[Polynomial, Polynomial]:
        """Return numerator and denominator; what must hold for them to mean anything goes to `guards`."""
        match node:
            case Number() | Name():
                return fraction(node)
            case Binary(op, left, right):
                a, b = self.fraction(left, guards), self.fraction(right, guards)
                if op == "/":
                    self._nonzero(b[0], guards)
                return combined(op, a, b)
            case Power(base, exponent):
                above, below = self.fraction(base, guards)
                if exponent < 0:
                    self._nonzero(above, guards)
                    above, below = below, above
                return above ** abs(exponent), below ** abs(exponent)
            case Call("CRootOf"):
                return Polynomial.symbol(self._root(node)), Polynomial.of(1)
            case Call(function, (inside, *_)):
                name, guard = self._square_root(node, function, inside)
                guards.append(guard)
                return Polynomial.symbol(name), Polynomial.of(1)
            case Call():
                raise UnreadableError(str(node))

    def _nonzero(self, divisor: Polynomial, guards: list[Formula]) -> None:
        if divisor.constant == 0:
            raise UndefinedError
        if divisor.constant is None:
            guards.append(Atom(divisor, "!="))

    def _fresh(self) -> str:
        return f"t{len(self._known) + 1}"

    def _square_root(self, node: Node, function: str, inside: Node) -> tuple[str, Formula]:
        """Return the variable of √a or |a|, and where it is defined; elsewhere it is 0, so that it always has a value."""
        if node not in self._known:
            guards: list[Formula] = []
            above, below = self.fraction(inside, guards)
            if function == "Abs":
                above, below = above * above, below * below
            name = self._fresh()
            t = Polynomial.symbol(name)
            defined = All((*guards, Atom(below, "!="), Atom(above * below, ">=")))
            equation = Atom(t * t * below - above, "=")
            self._known[node] = name, defined
            self.definitions += [
                Atom(t, ">="),
                Some((All((defined, equation)), All((opposite(defined), Atom(t, "="))))),
            ]
        return self._known[node]

    def _root(self, node: Call) -> str:
        if node not in self._known:
            root = root_of(node, {})
            name = self._fresh()
            t = Polynomial.symbol(name)
            self._known[node] = name, All(())
            if root.low == root.high:
                self.definitions.append(Atom(t - root.low, "="))
            else:
                root.narrow(Fraction(1, 64))
            if root.low != root.high:
                value = Polynomial.of(0)
                for c in root.polynomial:
                    value = value * t + c
                self.definitions += [Atom(value, "="), Atom(t - root.low, ">"), Atom(t - root.high, "<")]
        return self._known[node][0]


def between(translation: Translation, name: str, low: str, high: str, names: Collection[str] = ()) -> Formula:
    """Return low < name < high, the ends in these variables; "-oo" and "oo" bound nothing."""
    ends = ((">", bound(low, names)), ("<", bound(high, names)))
    return All(tuple(translation.relation(Name(name), op, end) for op, end in ends if end is not None))


def conjunction(translation: Translation, relations: Iterable[str]) -> Formula:
    """Return where all these relations hold."""
    return All(tuple(translation.statement(statement(text)) for text in relations))


def union(translation: Translation, name: str, intervals: Sequence[Sequence[str]]) -> Formula:
    """Return a union of open intervals."""
    return Some(tuple(between(translation, name, low, high) for low, high in intervals))
