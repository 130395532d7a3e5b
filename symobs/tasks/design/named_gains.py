"""Gains on the pages of designs: a long one is a matrix of letters, in which the page goes on."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Literal, children
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.page_parts import is_narrow
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names
from symobs.tasks.design.readability import GAIN, GAIN_IN_SIGNS

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.formula.tree import Formula
    from symobs.formula.tree.term import Term


#: A name in the text of an entry.
_NAME = re.compile(r"[A-Za-z_]\w*")
#: The letters for the entries of gains; one that the data use, too, is passed over.
_ENTRIES = {"K": ("k", "f", "g"), "L": ("l", "h", "g")}


def entry_letters(page: Builder, gain: str, value: Matrix, kept: Callable[[Scalar], bool]) -> Matrix:
    """Return a gain with letters that are free for its entries, but for those that are kept."""
    taken = taken_names(page)
    data = {name.rstrip("0123456789").partition("_")[0] for name in taken - page.environment.coefficients.keys()}
    stem = next((letter for letter in _ENTRIES[gain[0]] if letter not in data), _ENTRIES[gain[0]][0])
    names = iter(fresh_names(f"{stem}_", len(value.entries), taken))
    return Matrix.of([[e if kept(e) else Scalar.symbol(next(names)) for e in row] for row in value.rows])


def gain_letters(page: Builder, gain: str, value: Matrix, kept: Callable[[Scalar], bool] = lambda _: False) -> Matrix:
    """Return a gain with letters that stand for its entries from here on, but for those that are kept."""
    letters = entry_letters(page, gain, value, kept)
    for letter, entry in zip(letters.entries, value.entries, strict=True):
        if not kept(entry):
            page.name_coefficient(str(letter), entry)
    return letters


def _is_short(gain: Matrix) -> bool:
    """Return whether a gain is written out, a name counted as one sign: [lm(lω² + g), 2l²mζω]."""
    signs = [sum(len(_NAME.sub("x", str(entry)).replace("*", "")) for entry in row) for row in gain.rows]
    return is_narrow(gain, within=GAIN) or max(signs) <= GAIN_IN_SIGNS


def _is_brief(formula: Formula) -> bool:
    """Return whether matrices written out in a formula are narrow."""
    if isinstance(formula, Literal):
        return not isinstance(formula.value, Matrix) or _is_short(formula.value)
    return all(map(_is_brief, children(formula)))


def define_gain(
    page: Builder, gain: str, *members: Term | Matrix, say: str = "", transposed: bool = False, answer: bool = True
) -> Term:
    """Introduce a gain (`transposed`, through its transpose); a long one with letters, and what they stand for."""
    *before, last = (page.value(member) if isinstance(member, Matrix) else member for member in members)
    value = last.value.T if transposed else last.value
    if not value.names or (_is_short(value) and not page.in_letters):
        shown, before = value, [*before, last]
    elif page.defines(gain) and page[gain].value.substitute(page.environment.coefficients) == value:
        shown = page[gain].value
    else:
        shown = gain_letters(page, gain, value, lambda entry: entry.is_constant)
        before = [member for member in [*before, last] if _is_brief(member.formula)]
    meanings = [
        relation(name, entry) for name, entry in zip(shown.entries, value.entries, strict=True) if name != entry
    ]
    if page.defines(gain) and page[gain].value == shown and 1 in shown.shape:
        page.equal(*meanings, say=say)
        return page[gain]
    if transposed:
        page.set(gain, shown)
        closing = [] if meanings else [last.as_value]
        page.equal(relation(page[f"{gain}.T"], *before, *closing), relation(page[gain], shown), say=say, answer=answer)
    else:
        page.define(gain, *(before if before and not meanings else [*before, shown]), say=say, answer=answer)
    if meanings:
        page.equal(*meanings, say="with_coefficients")
    return page[gain]
