"""A derivation in another convention: the same steps in letters that may mean the negative, checked again (trusted).

The printed forms of letters are the formats' affair; here only signs change.  The translated derivation is held against
the first one: every letter means what it meant, or exactly its negative.
"""

from __future__ import annotations

import re
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

from symobs.convention import OF_REDUCED_ORDER
from symobs.derivation.facts.rejection import reject
from symobs.derivation.steps import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Inequalities,
    Note,
    Plot,
    RegionSummary,
    Section,
    Sentence,
    Solve,
    Tabulate,
)
from symobs.errors import UsageError
from symobs.exact import Matrix, Scalar
from symobs.formula import (
    Conjunction,
    Evaluated,
    Exact,
    Formula,
    HoldsExactlyWhere,
    Letter,
    Literal,
    Predicate,
    Product,
    Relation,
    Roots,
    SignReversal,
    SymbolList,
    Transpose,
    children,
    evaluate,
    with_children,
)
from symobs.formula.sign_changes import negated
from symobs.notation import LETTERS, printed_alike, sans_serif

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from symobs.convention import Convention
    from symobs.derivation.check import Derivation
    from symobs.figures.block_diagram import Label
    from symobs.formula import Environment
    from symobs.notation import LetterForm

_STEPS = (Given, Define, Equal, Solve, Conclude, Note, Plot, Tabulate, Inequalities, RegionSummary, CaseStep, Section)
#: What an observer is assumed to do with the output, and the gain it turns out to be; a convention may call both H.
_ANSATZ = {"L", "H_x"}
_FACTS = (Sentence, Predicate, Roots, HoldsExactlyWhere, Conjunction)


def translated(derivation: Derivation, convention: Convention) -> Derivation:
    """Return the derivation in the signs of a convention, checked.  Raises `DerivationRejected`."""
    before = derivation.check()
    if convention.is_standard:
        return derivation
    letters = {*before.values, *before.signals}
    reduced = not OF_REDUCED_ORDER.isdisjoint(letters)
    forms = convention.forms(reduced=reduced)
    _no_letter_twice(letters, forms, before, convention)
    steps = _with_own_unknowns(derivation.steps, before, convention, reduced=reduced)
    if convention.turned:
        data = {value for name in "ABCD" if name in before.values for value in _both_ways(before.values[name])}
        written = {value for relation in _relations(steps) for value in _values(relation, convention.turned)}
        steps = _in_signs(steps, SignReversal(convention.turned, written - data))
    made = replace(derivation, steps=steps)
    after = made.check()
    _hold_against(before, after, convention.turned)
    return set_apart(made, letters, {**LETTERS, **forms})


def set_apart(derivation: Derivation, letters: Iterable[str], forms: Mapping[str, LetterForm]) -> Derivation:
    """Return the derivation with parameters that print like one of these letters set without serifs, and a note on each.

    The parameters are those of all values written out, be they of the plant or of what is asked of it.
    """
    named = {name for literal in _literals(derivation.steps) for name in literal.names}
    shared = printed_alike(letters, forms, named - {derivation.variable, *derivation.symbols})
    if not shared:
        return derivation
    notes = [Note(Sentence("without_serifs", (("parameter", Literal(Scalar.symbol(name))),))) for name in shared]
    first, *rest = derivation.steps
    if isinstance(first, Section):
        first = replace(first, steps=(*first.steps, *notes))
    symbols = {**derivation.symbols, **{name: sans_serif(name) for name in shared}}
    return replace(derivation, steps=(first, *rest), symbols=symbols)


def _no_letter_twice(
    letters: Collection[str], forms: Mapping[str, LetterForm], known: Environment, convention: Convention
) -> None:
    """Refuse a convention in which a page would write two things alike, unless they are equal."""
    written = {name: {**LETTERS, **forms}[name].alone.text for name in letters if name in LETTERS}
    for name in sorted(forms.keys() & written.keys()):
        for other in sorted(written.keys() - {name}):
            same = known.values.get(name) is not None and known.values.get(name) == known.values.get(other)
            if written[other] == written[name] and not same and {name, other} != _ANSATZ:
                spoken = f"{LETTERS[name].spoken} and {LETTERS[other].spoken}"
                message = (
                    f"the convention {convention.name} writes {written[name]} for two things of this page: {spoken}"
                )
                raise UsageError(message, repair=f"give {name} or {other} a letter of its own there")


def _both_ways(value: Scalar | Matrix) -> tuple[Matrix, ...]:
    return (value, value.T) if isinstance(value, Matrix) else ()


def _in_signs(item: Any, turned: SignReversal) -> Any:
    """Return a step, or a part of one, in the new signs."""
    match item:
        case Relation():
            return turned.relation(item)
        case Evaluated(formula, value):
            return Evaluated(*turned.relation(Relation((formula, value), ("=",))).members)
        case Diagram(labels=labels):
            signed = tuple((name, _label_in_signs(label, turned)) for name, label in labels)
            return replace(item, labels=signed, sentence=_in_signs(item.sentence, turned))
    if isinstance(item, Formula):
        return turned.formula(item)
    return _rebuilt(item, lambda part: _in_signs(part, turned))


def _label_in_signs(label: Label, turned: SignReversal) -> Label:
    """Return what labels a box or a wire, a gain with its sign."""
    found: Label = _in_signs(label, turned) if isinstance(label, Conjunction) else turned.whole(label)
    return found


def _rebuilt(item: Any, of_part: Callable[[Any], Any]) -> Any:
    """Return a step, a sentence, a fact or several of them over other parts; anything else as it is."""
    if isinstance(item, tuple):
        return tuple(map(of_part, item))
    if isinstance(item, (*_STEPS, *_FACTS, Relation, Evaluated, Diagram)):
        return replace(item, **{part.name: of_part(getattr(item, part.name)) for part in fields(item)})
    return item


# -- unknown entries ------------------------------------------------------------------------------------------------


def _with_own_unknowns(steps: Any, final: Environment, convention: Convention, *, reduced: bool) -> Any:
    """Return the steps with the unknown entries of a gain called after its letter: m₁ and not −l₁ where M is −L."""
    used = {name for literal in _literals(steps) for name in literal.names} | set(final.signs)
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
    for relation in _relations(steps):
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


def _every(item: Any) -> Iterator[Any]:
    """Yield a step, or several, and everything in it: sentences, facts, formulas and their parts."""
    yield item
    if isinstance(item, Formula):
        parts: Iterable[Any] = children(item)
    elif isinstance(item, tuple):
        parts = item
    elif isinstance(item, (*_STEPS, *_FACTS, Relation, Evaluated, Diagram)):
        parts = (getattr(item, field.name) for field in fields(item))
    else:
        return
    for part in parts:
        yield from _every(part)


def _relations(steps: Any) -> Iterator[Relation]:
    """Yield all relations of steps, those inside sentences and cases too."""
    return (part for part in _every(steps) if isinstance(part, Relation))


def _literals(steps: Any) -> Iterator[Scalar | Matrix]:
    """Yield all values that are written out."""
    return (part.value for part in _every(steps) if isinstance(part, Literal))


# -- what is held against what --------------------------------------------------------------------------------------


def _values(relation: Relation, names: frozenset[str]) -> Iterator[Matrix]:
    """Yield the matrices, and their transposes, equated with one of the letters by a relation."""
    head = relation.members[0]
    head = head.operand if isinstance(head, Transpose) else head
    if isinstance(head, Letter) and head.name in names:
        for member in relation.members:
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
