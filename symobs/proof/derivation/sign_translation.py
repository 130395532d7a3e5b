"""The steps of a derivation in the signs and the names of a convention: letters that may mean the negative.

What is made here is checked again, like every derivation, and held against the first one.
"""

from __future__ import annotations

import re
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Conjunction,
    Evaluated,
    Formula,
    Letter,
    Literal,
    Product,
    Relation,
    SymbolList,
    children,
    with_children,
)
from symobs.formula.tree.sign_changes import negated
from symobs.proof.derivation.steps import WITH_PARTS, Define, Diagram, literals, relations

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.formula.convention import Convention
    from symobs.formula.figures import Label
    from symobs.formula.tree import Environment, SignReversal


def in_signs(item: Any, turned: SignReversal) -> Any:
    """Return a step, or a part of one, in the new signs."""
    match item:
        case Relation():
            return turned.relation(item)
        case Evaluated(formula, value):
            return Evaluated(*turned.relation(Relation((formula, value), ("=",))).members)
        case Diagram(labels=labels):
            signed = tuple((name, _label_in_signs(label, turned)) for name, label in labels)
            return replace(item, labels=signed, sentence=in_signs(item.sentence, turned))
    if isinstance(item, Formula):
        return turned.formula(item)
    return _rebuilt(item, lambda part: in_signs(part, turned))


def _label_in_signs(label: Label, turned: SignReversal) -> Label:
    """Return what labels a box or a wire, a gain with its sign."""
    found: Label = in_signs(label, turned) if isinstance(label, Conjunction) else turned.whole(label)
    return found


def _rebuilt(item: Any, of_part: Callable[[Any], Any]) -> Any:
    """Return a step, a sentence, a fact or several of them over other parts; anything else as it is."""
    if isinstance(item, tuple):
        return tuple(map(of_part, item))
    if isinstance(item, WITH_PARTS):
        return replace(item, **{part.name: of_part(getattr(item, part.name)) for part in fields(item)})
    return item


# -- unknown entries ------------------------------------------------------------------------------------------------


def with_own_unknowns(steps: Any, final: Environment, convention: Convention, *, reduced: bool) -> Any:
    """Return the steps with the unknown entries of a gain called after its letter: m₁ and not −l₁ where M is −L."""
    used = {name for literal in literals(steps) for name in literal.names} | set(final.signs)
    meant: dict[str, Scalar] = {}
    for letter in ("K", "L"):
        own = convention.written(reduced=reduced).get(letter, letter).lower()[:1]
        for name in _unknowns(steps, letter, final):
            written = re.sub("^[a-z]", own, name)
            sign = -1 if letter in convention.turned else 1
            if own != name[0] or sign < 0:
                meant[name] = sign * Scalar.symbol(written)
    # A mass m1 would be printed like an entry m_1.
    taken = {name.replace("_", "") for name in used - meant.keys()}
    fresh = {name.replace("_", "") for value in meant.values() for name in value.names}
    return _substituted(steps, meant) if meant and not fresh & taken else steps


def _unknowns(steps: Any, letter: str, final: Environment) -> Iterator[str]:
    """Yield the symbols that stand for entries of a gain while it is sought."""
    known = set(final.signs) | (final.values[letter].names if letter in final.values else set())
    for relation in relations(steps):
        if relation.members[0] == Letter(letter):
            for literal in relation.members:
                entries = (
                    literal.value.entries if isinstance(literal, Literal) and isinstance(literal.value, Matrix) else ()
                )
                yield from (str(entry) for entry in entries if str(entry) in entry.names - known)


def _substituted(item: Any, meant: Mapping[str, Scalar]) -> Any:
    """Return steps with symbols replaced; what introduces one by its meaning introduces the new one."""
    if isinstance(item, Literal):
        return Literal(item.value.substitute({k: v for k, v in meant.items() if k in item.value.names}))
    if isinstance(item, SymbolList):
        return SymbolList(tuple(name for part in item.names for name in meant.get(part, Scalar.symbol(part)).names))
    if isinstance(item, Formula):
        changed = with_children(item, tuple(_substituted(part, meant) for part in children(item)))
        return _without_minus(changed) if changed != item else item
    if isinstance(item, Define) and isinstance(item.relation.members[0], Literal):
        head, *rest = (_substituted(member, meant) for member in item.relation.members)
        turned = str(head.value) not in head.value.names
        members = tuple(negated(member) if turned else member for member in (head, *rest))
        return replace(
            _rebuilt(item, lambda part: _substituted(part, meant)), relation=Relation(members, item.relation.operators)
        )
    return _rebuilt(item, lambda part: _substituted(part, meant))


def _without_minus(formula: Formula) -> Formula:
    """Return a product with a column of negative symbols with their signs in the matrix before it."""
    match formula:
        case Product((Literal(Matrix()) as table, Literal(Matrix() as column))):
            negative = [str(-entry) in entry.names for entry in column.entries]
            return Product((negated(table), Literal(-column))) if all(negative) else formula
    return formula
