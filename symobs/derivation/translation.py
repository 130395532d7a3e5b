"""A derivation in another convention: the same steps in letters that may mean the negative, checked again (trusted).

The printed forms of letters are the formats' affair; here only signs change.  The translated derivation is held against
the first one: every letter means what it meant, or exactly its negative.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

from symobs.derivation.check import Derivation
from symobs.derivation.rejection import reject
from symobs.derivation.steps import (
    Case,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Plot,
    Section,
    Sentence,
    Solve,
    Survey,
    Tabulate,
    Where,
)
from symobs.exact import Matrix
from symobs.formula import (
    Exact,
    Exactly,
    Formula,
    Letter,
    Literal,
    Predicate,
    Relation,
    Roots,
    Shown,
    Together,
    Transpose,
    Turned,
    evaluate,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.convention import Convention
    from symobs.formula import Environment

_STEPS = (Given, Define, Equal, Solve, Conclude, Note, Plot, Tabulate, Where, Survey, Case, Section)
_FACTS = (Sentence, Predicate, Roots, Exactly, Together)


def translated(derivation: Derivation, convention: Convention) -> Derivation:
    """Return the derivation in the signs of a convention, checked.  Raises `DerivationRejected`."""
    before = derivation.check()
    if not convention.turned:
        return derivation
    written = {value for relation in _relations(derivation.steps) for value in _values(relation, convention.turned)}
    turned = Turned(convention.turned, written)
    made = replace(derivation, steps=_in_signs(derivation.steps, turned))
    _hold_against(before, made.check(), convention.turned)
    return made


def _in_signs(item: Any, turned: Turned) -> Any:
    """Return a step, or a part of one, in the new signs."""
    match item:
        case Relation():
            return turned.relation(item)
        case Shown(formula, value):
            return Shown(*turned.relation(Relation((formula, value), ("=",))).members)
        case Diagram(labels=labels):
            return replace(item, labels=tuple((name, turned.whole(label)) for name, label in labels))
        case tuple():
            return tuple(_in_signs(part, turned) for part in item)
    if isinstance(item, Formula):
        return turned.formula(item)
    if isinstance(item, (*_STEPS, *_FACTS)):
        return replace(item, **{part.name: _in_signs(getattr(item, part.name), turned) for part in fields(item)})
    return item


def _relations(item: Any) -> Iterator[Relation]:
    """Yield all relations of steps, those inside sentences and cases too."""
    if isinstance(item, Relation):
        yield item
    elif isinstance(item, tuple):
        for part in item:
            yield from _relations(part)
    elif isinstance(item, (*_STEPS, *_FACTS)):
        for part in fields(item):
            yield from _relations(getattr(item, part.name))


def _values(relation: Relation, names: frozenset[str]) -> Iterator[Matrix]:
    """Yield the matrices, and their transposes, that a relation says one of the letters is."""
    head = relation.members[0]
    head = head.operand if isinstance(head, Transpose) else head
    if isinstance(head, Letter) and head.name in names:
        for member in relation.members[1:]:
            if isinstance(member, Literal) and isinstance(member.value, Matrix) and not member.value.is_zero:
                yield from (member.value, member.value.T)


def _hold_against(before: Environment, after: Environment, names: frozenset[str]) -> None:
    """Reject a translation after which a letter means something else than it did, or than its negative."""
    for name, value in before.values.items():
        if after.values.get(name) != (-value if name in names else value):
            reject(f"{name} in another convention")
    for signals in ("dynamics", "signals"):
        for name, formula in getattr(before, signals).items():
            other = getattr(after, signals).get(name)
            if (formula is None) != (other is None) or (
                formula is not None and evaluate(formula, before, Exact(before)) != evaluate(other, after, Exact(after))
            ):
                reject(f"{name} in another convention")
