"""Conventions stated on a page below its title: the signs of K and L, on every page with such a gain and on no other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.phrases.languages import SPOKEN
from symobs.formula.tree import (
    Conjunction,
    Derivative,
    Evaluated,
    HoldsExactlyWhere,
    Letter,
    LetterList,
    Negative,
    Predicate,
    Product,
    Relation,
    Roots,
    SignReversal,
    Sum,
    SymbolList,
    letters,
)
from symobs.pages.page.blocks import Title
from symobs.pages.page.prose import joined
from symobs.proof.derivation import (
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
    Tabulate,
)
from symobs.proof.derivation.steps import relations

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.formula.convention import Convention
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Fact, Formula
    from symobs.pages.page.blocks import Inline
    from symobs.proof.derivation import Sentence, Step
    from symobs.tasks.result import Document


def letters_used(steps: Iterable[Step]) -> frozenset[str]:
    """Return the names of all letters in the steps."""
    return frozenset().union(*(letters(formula) for step in steps for formula in _formulas(step)))


def stated_conventions(
    used: frozenset[str], convention: Convention, words: Mapping[str, str], law: Relation | None = None
) -> tuple[tuple[Inline, ...], ...]:
    """Return the conventions of the gains used, each as words and a formula; `law` is the control law of the page."""
    turned = SignReversal(convention.turned)
    conventions: list[tuple[Inline, ...]] = []
    if used & {"K", "K_r"}:
        estimated = "L" in used or "x_hat" in used
        conventions.append((law or turned.relation(_control_law("x_hat" if estimated else "x")),))
    if used & {"L", "L_r"}:
        conventions.append((f"{words['observer_matrix']} ", turned.formula(_OBSERVER_MATRIX)))
        conventions.append((f"{words['error']} ", _ERROR))
    return tuple(conventions)


def _meanings(asked: frozenset[str], convention: Convention, *, discrete: bool) -> tuple[tuple[Inline, ...], ...]:
    """Return what letters mean that a question asks for, where only a derivation says it."""
    turned = SignReversal(convention.turned)
    told = {"F": _OUTPUT_FEEDBACK, "F_z": _reduced_observer("w_o" if discrete else "z_o")}
    return tuple((turned.relation(relation),) for letter, relation in told.items() if letter in asked)


def _reduced_observer(state: str) -> Relation:
    terms = (Product((Letter(a), Letter(b))) for a, b in (("F_z", state), ("G_z", "u"), ("H_z", "y")))
    return Relation((Derivative(Letter(state)), Sum(tuple(terms))), ("=",))


def _control_law(state: str) -> Relation:
    return Relation((Letter("u"), Negative(Product((Letter("K"), Letter(state))))), ("=",))


_OBSERVER_MATRIX = Sum((Letter("A"), Negative(Product((Letter("L"), Letter("C"))))))
_OUTPUT_FEEDBACK = Relation((Letter("u"), Negative(Product((Letter("F"), Letter("y"))))), ("=",))
_ERROR = Relation((Letter("e"), Sum((Letter("x"), Negative(Letter("x_hat"))))), ("=",))


def _formulas(step: Step) -> Iterator[Formula]:
    match step:
        case Section(title=title, steps=steps):
            yield from _in_sentence(title)
            for inner in steps:
                yield from _formulas(inner)
        case CaseStep(when=when, steps=steps, sentence=sentence):
            yield from (*_in_facts((when,)), *_in_sentence(sentence))
            for inner in steps:
                yield from _formulas(inner)
        case Given(relations=relations, sentence=sentence) | Equal(relations=relations, sentence=sentence):
            yield from (*_in_facts(relations), *_in_sentence(sentence))
        case Define(relation=relation, sentence=sentence):
            yield from (*relation.members, *_in_sentence(sentence))
        case (
            Conclude(sentence=sentence)
            | Note(sentence=sentence)
            | Tabulate(sentence=sentence)
            | Plot(sentence=sentence)
        ):
            yield from _in_sentence(sentence)
        case Inequalities(fact=fact, sentence=sentence):
            yield from (*_in_facts((fact,)), *_in_sentence(sentence))
        case RegionSummary(polynomial=polynomial):
            yield polynomial
        case Diagram(labels=labels, sentence=sentence):
            yield from _in_sentence(sentence)
            for _, label in labels:
                yield from _in_facts((label,)) if isinstance(label, Conjunction) else (label,)


def _in_facts(facts: Iterable[Fact]) -> Iterator[Formula]:
    for fact in facts:
        match fact:
            case Relation(members=members):
                yield from members
            case Predicate(subject=subject) | Roots(polynomial=subject):
                yield subject
            case HoldsExactlyWhere(property=Predicate(subject=subject), where=where):
                yield from (subject, *_in_facts(where))
            case Conjunction(relations=relations):
                yield from _in_facts(relations)


def _in_sentence(sentence: Sentence | None) -> Iterator[Formula]:
    for _, value in sentence.slots if sentence else ():
        if isinstance(value, Relation | Predicate | Roots | HoldsExactlyWhere | Conjunction):
            yield from _in_facts((value,))
        elif isinstance(value, Evaluated):
            yield value.value
        elif not isinstance(value, (str, SymbolList, LetterList, *SPOKEN)):
            yield value


def title_of(document: Document, language: Language) -> Title:
    """Return the title of a page, with its source and the conventions that it states."""
    steps = [step for derivation in document.derivations for step in derivation.steps]
    asked, chosen = document.letters_asked, document.convention
    conventions = stated_conventions(letters_used(steps) | asked, chosen, language.words, _law_of(steps))
    conventions += _meanings(asked, chosen, discrete=any(each.discrete for each in document.derivations))
    if not conventions:
        return Title(document.title, _as_sentence(document.source), ())
    listed: list[Inline] = [f"{language.words['conventions']} "]
    for convention in conventions:
        listed += [*convention, ", "]
    return Title(document.title, _as_sentence(document.source), joined((*listed[:-1], ".")))


def _law_of(steps: Sequence[Step]) -> Relation | None:
    """Return the control law that the steps state, u = −K x + k ξ; of several the one with the fewest letters."""
    told = relations(tuple(steps))
    laws = [each for each in told if each.members[0] == Letter("u") and "K" in letters(each.members[1])]
    law = min(laws, key=lambda each: len(letters(each.members[1])), default=None)
    return None if law is None else Relation(law.members[:2], law.operators[:1])


def _as_sentence(text: str) -> str:
    text = text.strip()
    return f"{text}." if text and text[-1] not in ".!?" else text
