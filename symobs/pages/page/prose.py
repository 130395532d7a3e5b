"""Sentences: phrases with filled slots, and mathematics for names between dollar signs.

`$A - L C$` in a phrase is a formula in the letters of `notation`, so that it is printed as everywhere else.  It names things
and claims nothing.
"""

from __future__ import annotations

import re
import string
from types import MappingProxyType
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.formula.convention import STANDARD, Convention
from symobs.formula.notation import LETTERS
from symobs.formula.phrases import PHRASES, RESTS_ON, THEOREMS
from symobs.formula.phrases.languages import COUNTED, ENGLISH, SPOKEN
from symobs.formula.phrases.literature import bibliography, cited
from symobs.formula.tree import (
    Conjunction,
    Decimals,
    Evaluated,
    HoldsExactlyWhere,
    Letter,
    LetterList,
    Literal,
    Predicate,
    Relation,
    Roots,
    SignReversal,
    SymbolList,
    children,
)
from symobs.formula.tree.written import read_formula, read_relation
from symobs.pages.page.blocks import is_beside, row_by_row
from symobs.pages.page.detail_level import at_detail

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from symobs.formula.phrases.languages import Counted, Language, StateChoice
    from symobs.formula.tree import Fact, Formula
    from symobs.pages.page.blocks import Inline, Inlines
    from symobs.proof.derivation import Sentence, Step
    from symobs.tasks.result import Document


#: Where in a phrase the number of what it rests on stands, if not at its end.
MARK = "§"
#: How a slot is written whose equation is referred to by its number.
NUMBER = "number"
#: How a slot is written whose names stand between parentheses.
LIST = "list"
#: A pair of matrices in a phrase, `($C$, $A$)`, and the first members of those that are observable.
_PAIR = re.compile(r"\((\$[^$]*\$), (\$[^$]*\$)\)")
_OUTPUTS = {"$C$", "$A_12$", "$C_dual$"}


def filled(
    sentence: Sentence,
    convention: Convention = STANDARD,
    language: Language = ENGLISH,
    numbers: Mapping[Relation, int] = MappingProxyType({}),
) -> Inlines:
    """Return the phrase of a sentence in a language, its slots filled, in the letters and signs of a convention.

    A slot `{law:number}` holds an equation; of one that stands on the page under a number this number is given.
    """
    slots, turned = dict(sentence.slots), SignReversal(convention.turned)
    several = any(isinstance(slot, Roots) and len(slot.values) > 1 for slot in slots.values())
    phrase = COUNTED.sub(lambda words: words[2 if several else 1], language.phrases[sentence.key])
    if not convention.is_standard:
        phrase = _PAIR.sub(lambda pair: _pair(pair[1], pair[2], convention), phrase)
    inlines: list[Inline] = []
    for text, name, form, _ in string.Formatter().parse(phrase):
        inlines += _prose(text, turned, convention.letters)
        if name is not None:
            slot = slots[name]
            number = numbers.get(slot) if form == NUMBER and isinstance(slot, Relation) else None
            apart = ", " if form == LIST else language.words["and"]
            inlines += shown(slot, language, apart) if number is None else (f"({number})",)
    return joined(inlines)


def with_reference(inlines: Inlines, citation: str | None) -> Inlines:
    """Return a sentence with the citation of its theorem, in its slot or before the final punctuation."""
    if any(isinstance(part, str) and MARK in part for part in inlines):
        shown = "" if citation is None else f"\N{NO-BREAK SPACE}{citation}"
        return tuple(part.replace(MARK, shown) if isinstance(part, str) else part for part in inlines)
    if citation is None:
        return inlines
    *rest, last = inlines
    if not isinstance(last, str):
        return joined((*inlines, f"\N{NO-BREAK SPACE}{citation}"))
    words = last.rstrip(".:,")
    return joined((*rest, f"{words}\N{NO-BREAK SPACE}{citation}{last[len(words) :]}"))


def joined(inlines: Iterable[Inline]) -> Inlines:
    """Return the inlines with adjacent texts joined and empty ones omitted."""
    result: list[Inline] = []
    for inline in inlines:
        if isinstance(inline, str) and result and isinstance(before := result[-1], str):
            result[-1] = before + inline
        elif inline != "":
            result.append(inline)
    return tuple(result)


def shown(
    slot: Formula | Fact | LetterList | Counted | StateChoice | str, language: Language, last: str = ", "
) -> Iterator[Inline]:
    """Yield the content of a slot: of a property its subject, of a region its inequalities; `last` before a last name."""
    if isinstance(slot, SPOKEN):
        yield language.put(slot)
        return
    match slot:
        case Predicate(subject=subject):
            yield subject
        case Evaluated(value=value):
            yield value
        case SymbolList(names):
            for place, name in enumerate(names):
                between = "" if not place else last if place + 1 == len(names) else ", "
                yield from (between, Literal(Scalar.symbol(name)))
        case LetterList(letters):
            for place, letter in enumerate(letters):
                yield from ("" if not place else last if place + 1 == len(letters) else ", ", letter)
        case HoldsExactlyWhere(where=where) | Conjunction(relations=where):
            apart = "; " if language.has_comma and any(map(_has_decimals, where)) else ", "
            for place, relation in enumerate(where):
                yield from (apart, relation) if place else (relation,)
        case _:
            yield slot


def _has_decimals(part: Formula | Relation) -> bool:
    if isinstance(part, Decimals):
        return True
    return any(map(_has_decimals, part.members if isinstance(part, Relation) else children(part)))


def _pair(first: str, second: str, convention: Convention) -> str:
    """Return a pair of matrices in the brackets of a convention."""
    opening, closing = (f"{bracket}{bracket}" if bracket in "{}" else bracket for bracket in convention.brackets)
    members = (second, first) if convention.state_first and first in _OUTPUTS else (first, second)
    return f"{opening}{', '.join(members)}{closing}"


def _once(relation: Relation, letters: Mapping[str, str]) -> Relation | Formula:
    """Return the letter alone if both sides of an equation are printed alike in a convention."""
    names = [member.name if isinstance(member, Letter) else "" for member in relation.members]
    written = {letters.get(name, LETTERS[name].text) if name in LETTERS else "" for name in names}
    return relation.members[-1] if len(written) == 1 and "" not in written else relation


def _prose(text: str, turned: SignReversal, letters: Mapping[str, str]) -> Iterator[Inline]:
    for place, part in enumerate(text.split("$")):
        if place % 2:
            equation = "=" in part
            yield (
                _once(turned.relation(read_relation(part)), letters) if equation else turned.formula(read_formula(part))
            )
        else:
            yield part


# What the sentences of a page refer to: the literature, numbered in the order of the page, and equations before them.


def cited_literature(steps: Iterable[Step], language: Language = ENGLISH) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the works cited, in the order of the page, and how each theorem is cited by their numbers."""
    works: dict[str, int] = {}
    citations: dict[str, str] = {}
    for theorem in dict.fromkeys(RESTS_ON[said.key] for said in _sentences(steps) if said.key in RESTS_ON):
        places = [
            f"{works.setdefault(key, len(works) + 1)}{', ' * bool(place)}{language.place(place)}"
            for key, place in cited(THEOREMS[theorem])
        ]
        citations[theorem] = f"[{'; '.join(places)}]"
    return tuple(works), citations


def referred_to(steps: Iterable[Step]) -> Iterator[Relation]:
    """Yield the equations to which sentences refer by a number."""
    for said in _sentences(steps):
        slots = dict(said.slots)
        for _, name, form, _ in string.Formatter().parse(PHRASES[said.key]):
            if form == NUMBER and isinstance(slot := slots[str(name)], Relation):
                yield slot


def bibliography_of(document: Document) -> str:
    """Return the works that a page cites, as a BibTeX file."""
    steps = (step for derivation in document.derivations for step in at_detail(derivation.steps, document.detail))
    return bibliography(cited_literature(steps)[0])


def _sentences(steps: Iterable[Step]) -> Iterator[Sentence]:
    for step in steps:
        found = getattr(step, "sentence", None)
        if found is not None:
            yield found
        yield from getattr(step, "findings", ())
        yield from _sentences(row_by_row(step) if is_beside(step) else getattr(step, "steps", ()))
