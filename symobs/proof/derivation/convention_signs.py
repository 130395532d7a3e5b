"""A derivation in another convention: the same steps in letters that may mean the negative, checked again (trusted).

The printed forms of letters are the formats' affair; here only signs change.  The translated derivation is held against
the first one: every letter means what it meant, or exactly its negative.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.formula.convention import OF_REDUCED_ORDER
from symobs.formula.notation import LETTERS, printed_alike, sans_serif
from symobs.formula.tree import Exact, Letter, Literal, Relation, SignReversal, SymbolList, Transpose, evaluate
from symobs.ground.errors import UsageError
from symobs.proof.derivation.facts import reject
from symobs.proof.derivation.sign_translation import in_signs, with_own_unknowns
from symobs.proof.derivation.steps import Note, Section, Sentence, everything_in, literals, relations

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from symobs.formula.convention import Convention
    from symobs.formula.notation import LetterForm
    from symobs.formula.tree import Environment
    from symobs.proof.derivation.check import Derivation

#: What an observer is assumed to do with the output, and the gain it turns out to be; a convention may call both H.
_ANSATZ = {"L", "H_x"}
#: The identity matrix and the imaginary unit, which a page writes as letters.
_MARKS = {"I", "i"}


def translated(derivation: Derivation, convention: Convention) -> Derivation:
    """Return the derivation in the signs of a convention, checked.  Raises `DerivationRejected`."""
    before = derivation.check()
    if convention.is_standard:
        return derivation
    letters = {*before.values, *before.signals}
    reduced = not OF_REDUCED_ORDER.isdisjoint(letters)
    forms = convention.forms(reduced=reduced)
    _no_letter_twice(letters, forms, before, convention)
    steps = with_own_unknowns(derivation.steps, before, convention, reduced=reduced)
    if convention.turned:
        data = {value for name in "ABCD" if name in before.values for value in _both_ways(before.values[name])}
        written = {value for relation in relations(steps) for value in _values(relation, convention.turned)}
        steps = in_signs(steps, SignReversal(convention.turned, written - data))
    made = derivation if steps == derivation.steps else replace(derivation, steps=steps)
    after = made.check()
    _hold_against(before, after, convention.turned)
    return set_apart(made, letters, {**LETTERS, **forms})


def set_apart(derivation: Derivation, letters: Iterable[str], forms: Mapping[str, LetterForm]) -> Derivation:
    """Return the derivation with parameters that print like one of these letters set without serifs, and a note on each.

    The parameters are those of all values written out, be they of the plant or of what is asked of it.
    """
    named = {name for literal in literals(derivation.steps) for name in literal.names}
    named -= {derivation.variable, *derivation.symbols}
    shared = sorted({*printed_alike(letters, forms, named), *_MARKS & named})
    if not shared:
        return derivation
    alone = _single_input(derivation)
    notes = [
        Note(
            Sentence(
                "nonlinear_input" if name == alone == "u" else "without_serifs", (("parameter", SymbolList((name,))),)
            )
        )
        for name in shared
    ]
    first, *rest = derivation.steps
    if isinstance(first, Section):
        first = replace(first, steps=(*first.steps, *notes))
    symbols = {**derivation.symbols, **{name: sans_serif(name) for name in shared}}
    return replace(derivation, steps=(first, *rest), symbols=symbols)


def _single_input(derivation: Derivation) -> str:
    """Return the input of a nonlinear plant that has one."""
    for part in everything_in(derivation.steps):
        if isinstance(part, Sentence) and "arguments" in (slots := dict(part.slots)):
            named = [slot.names for slot in (slots["states"], slots["arguments"]) if isinstance(slot, SymbolList)]
            inputs = named[1][len(named[0]) :]
            return inputs[0] if len(inputs) == 1 else ""
    return ""


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
