"""Sentences: phrases with their slots filled, and the names between dollar signs in them made mathematics.

`$A - L C$` in a phrase is a formula in the letters of `notation`, so that it is printed as everywhere else: sums of
products of letters, `ᵀ` behind a letter, `=` between two of them.  It names things and claims nothing.
"""

from __future__ import annotations

import re
import string
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.formula import (
    Exactly,
    Letter,
    Literal,
    Names,
    Negative,
    Predicate,
    Product,
    Relation,
    Shown,
    Sum,
    Together,
    Transpose,
)
from symobs.phrases import PHRASES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.derivation import Sentence
    from symobs.formula import Fact, Formula
    from symobs.render.blocks import Inline, Inlines


def filled(sentence: Sentence) -> Inlines:
    """Return the phrase of a sentence with its slots filled."""
    slots = dict(sentence.slots)
    inlines: list[Inline] = []
    for text, name, _, _ in string.Formatter().parse(PHRASES[sentence.key]):
        inlines += _prose(text)
        if name is not None:
            inlines += _shown(slots[name])
    return joined(inlines)


def joined(inlines: Iterable[Inline]) -> Inlines:
    """Return the same inlines, neighbouring texts made one and empty ones left out."""
    result: list[Inline] = []
    for inline in inlines:
        if isinstance(inline, str) and result and isinstance(before := result[-1], str):
            result[-1] = before + inline
        elif inline != "":
            result.append(inline)
    return tuple(result)


def _shown(slot: Formula | Fact | str) -> Iterator[Inline]:
    """Yield what stands in a slot: of a property its subject, of a region its inequalities."""
    match slot:
        case Predicate(subject=subject):
            yield subject
        case Shown(value=value):
            yield value
        case Names(names):
            for place, name in enumerate(names):
                between = "" if not place else " and " if place + 1 == len(names) else ", "
                yield from (between, Literal(Scalar.symbol(name)))
        case Exactly(where=where) | Together(relations=where):
            for place, relation in enumerate(where):
                yield from (", ", relation) if place else (relation,)
        case _:
            yield slot


def _prose(text: str) -> Iterator[Inline]:
    for place, part in enumerate(text.split("$")):
        yield _named(part) if place % 2 else part


def _named(text: str) -> Formula | Relation:
    members = tuple(_sum(member) for member in text.split("="))
    return Relation(members, ("=",) * (len(members) - 1)) if len(members) > 1 else members[0]


def _sum(text: str) -> Formula:
    terms = tuple(
        Negative(_product(term)) if sign in {"-", "−"} else _product(term)
        for sign, term in re.findall(r"([-−+]?)\s*([^-−+]+)", text.strip())
    )
    return terms[0] if len(terms) == 1 else Sum(terms)


def _product(text: str) -> Formula:
    factors = tuple(_factor(name) for name in text.split())
    return factors[0] if len(factors) == 1 else Product(factors)


def _factor(name: str) -> Formula:
    return Transpose(Letter(name[:-1])) if name.endswith("ᵀ") else Letter(name)
