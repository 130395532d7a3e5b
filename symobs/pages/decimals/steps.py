"""The steps of a page in decimals: the checked exact steps, every number in them rounded for itself.

What is given, and what an answer is conditional on, is written in decimals only where these are exact.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.numerals.written_digits import rounded_roots
from symobs.formula.figures import letter_for
from symobs.formula.tree import (
    Conjunction,
    Decimals,
    Evaluated,
    Formula,
    HoldsExactlyWhere,
    Literal,
    Negative,
    Predicate,
    Quotient,
    Relation,
    Roots,
    RoundedRoots,
    SymbolList,
    children,
    is_rounded,
    letters,
)
from symobs.ground.errors import DerivationRejected
from symobs.pages.decimals.formulas import InDecimals
from symobs.proof.derivation import (
    CaseStep,
    Define,
    Diagram,
    Equal,
    Given,
    Inequalities,
    Note,
    RegionSummary,
    Section,
    Sentence,
    Tabulate,
)
from symobs.proof.derivation.builder import warn_left_out
from symobs.proof.derivation.decimals_check import check_decimals, is_in_order

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from symobs.exact import Root
    from symobs.formula.figures import Label
    from symobs.proof.derivation import Derivation, Step

#: Sentences of a page of fractions: before an answer in decimals, and that the decimals of the data are exact.
_OF_FRACTIONS = ("in_decimals", "exact_decimals")
#: An exact answer stands beside its decimals where no entry, and no row, has more characters than this.
_WIDEST_ENTRY, _WIDEST_ROW = 11, 40
#: What may not be rounded is written in decimals of up to so many digits.
_EXACT_DIGITS = 12
#: Square roots of negative whole numbers below this stay, -1 ± √3 i.
_SHORT = 100


def in_decimals(derivation: Derivation, steps: Sequence[Step], digits: int) -> tuple[Step, ...]:
    """Return steps of a derivation in decimals of so many significant digits.

    A step whose decimals fail their check stays exact, with a `SymobsWarning`.
    """
    exact = tuple(_without_decimals(steps))
    written = _Writer(derivation, digits)
    shown = tuple(map(written.step, exact))
    try:
        check_decimals(exact, shown, derivation.variable, digits)
    except DerivationRejected:
        warn_left_out("a line in decimals")
        shown = tuple(_held(*pair, derivation.variable, digits) for pair in zip(exact, shown, strict=True))
        check_decimals(exact, shown, derivation.variable, digits)
    return tuple(_saying_so(step, digits) for step in shown) if any(map(_is_rounded, shown)) else shown


def _held(exact: Any, shown: Any, variable: str, digits: int) -> Any:
    """Return a step in decimals, with the exact one in place of each whose decimals fail their check."""
    if isinstance(exact, Section | CaseStep):
        pairs = zip(exact.steps, shown.steps, strict=True)
        return replace(exact, steps=tuple(_held(*pair, variable, digits) for pair in pairs))
    try:
        check_decimals(exact, shown, variable, digits)
    except DerivationRejected:
        return exact
    return shown


def _saying_so(step: Step, digits: int) -> Step:
    """Return the data with the remark that decimals are rounded, and to how many digits."""
    if not isinstance(step, Section) or step.title.key != "given":
        return step
    return replace(step, steps=(*step.steps, Note(Sentence("rounded_digits", (("digits", str(digits)),)))))


def _is_short_surd(root: Root) -> bool:
    """Return whether a root is a short whole number c, or c ± n√r i with short whole numbers."""
    if not root.is_closed or not root.radicand.is_constant or not root.centre.is_constant:
        return False
    outside, inside, imaginary = root.surd()
    is_short = all(part.denominator == 1 and abs(part) < _SHORT for part in (root.centre.fraction(), outside, inside))
    return is_short and (imaginary or root.radicand.is_zero)


def _is_rounded(part: Any) -> bool:
    """Return whether anything that is printed of a step is rounded."""
    if isinstance(part, tuple):
        return any(map(_is_rounded, part))
    if isinstance(part, Relation):
        return "≈" in part.operators
    if isinstance(part, RoundedRoots):
        return any(is_rounded for *_, is_rounded in part.texts)
    is_printed = is_dataclass(part) and not getattr(part, "silent", False)
    return is_printed and any(_is_rounded(getattr(part, each.name)) for each in fields(part))


def _without_decimals(steps: Iterable[Step]) -> Iterator[Step]:
    """Yield the steps without the decimals that a page of fractions has beside an answer."""
    for step in steps:
        match step:
            case Section(steps=inner) | CaseStep(steps=inner):
                yield replace(step, steps=tuple(_without_decimals(inner)))
            case Equal(sentence=Sentence(key=key)) | Note(sentence=Sentence(key=key)) if key in _OF_FRACTIONS:
                pass
            case Define(relation=relation):
                yield replace(step, relation=_without_last(relation))
            case Equal(relations=relations):
                yield replace(step, relations=tuple(map(_without_last, relations)))
            case _:
                yield step


def _without_last(relation: Relation) -> Relation:
    """Return a chain without decimals behind the exact value."""
    if len(relation.members) > 2 and isinstance(relation.members[-1], Decimals):
        return Relation(relation.members[:-1], relation.operators[:-1])
    return relation


def is_short(value: Scalar | Matrix) -> bool:
    """Return whether an exact value is read as easily as its decimals."""
    rows = value.rows if isinstance(value, Matrix) else ((value,),)
    widths = [[len(str(entry)) for entry in row] for row in rows]
    return all(sum(row) <= _WIDEST_ROW and max(row) <= _WIDEST_ENTRY for row in widths if row)


class _Writer:
    """Steps, sentences and facts in decimals."""

    def __init__(self, derivation: Derivation, digits: int) -> None:
        self.decimals = InDecimals(derivation.variable, digits)
        self.precise = InDecimals(derivation.variable, _EXACT_DIGITS)
        self.digits = digits
        self.parameters = frozenset(derivation.start.signs)

    def step(self, step: Step) -> Any:
        """Return a step in decimals."""
        match step:
            case Section(title, steps):
                return Section(self.sentence(title), tuple(map(self.step, steps)))
            case CaseStep(when=when, steps=steps):
                if isinstance(when, Conjunction):
                    where: Relation | Conjunction = Conjunction(tuple(map(self.exactly, when.relations)))
                else:
                    where = self.exactly(when)
                return self._said(replace(step, when=where, steps=tuple(map(self.step, steps))))
            case Given(relations=relations):
                return self._said(replace(step, relations=tuple(map(self.exactly, relations))))
            case Define(relation=relation, answer=answer):
                return self._said(replace(step, relation=self.answer(relation) if answer else self.relation(relation)))
            case Equal(relations=relations, answer=answer):
                *others, last = relations
                shown = *map(self.relation, others), self.answer(last) if answer else self.relation(last)
                return self._said(replace(step, relations=shown))
            case Tabulate(findings=findings) | RegionSummary(findings=findings):
                return self._said(replace(step, findings=tuple(map(self.sentence, findings))))
            case Diagram(name=name, labels=labels):
                written = tuple((place, self.label(name, place, label)) for place, label in labels)
                return self._said(replace(step, labels=written))
            case Inequalities(fact=fact):
                return self._said(replace(step, fact=replace(fact, where=tuple(map(self.bounds, fact.where)))))
        return self._said(step)

    def _said(self, step: Any) -> Any:
        return step if step.sentence is None else replace(step, sentence=self.sentence(step.sentence))

    def sentence(self, sentence: Sentence) -> Sentence:
        """Return a sentence with its slots in decimals."""
        return replace(sentence, slots=tuple((name, self.slot(slot)) for name, slot in sentence.slots))

    def slot(self, slot: Any) -> Any:
        """Return a slot in decimals; a value that no sign marks as rounded stays exact."""
        match slot:
            case Relation():
                return self.relation(slot)
            case Roots():
                return self.roots(slot)
            case Conjunction(relations):
                return Conjunction(tuple(map(self.relation, relations)))
            case HoldsExactlyWhere(where=where):
                return replace(slot, where=tuple(map(self.exactly, where)))
            case Predicate(subject=subject):
                return replace(slot, subject=self.value(subject))
            case Evaluated(value=value):
                return replace(slot, value=self.value(value))
            case str() | SymbolList():
                return slot
        return self.value(slot)

    def label(self, figure: str, place: str, label: Label) -> Label:
        """Return a label of a block diagram, its sign kept in front: the letter of a value that would be rounded."""
        match label:
            case Conjunction(relations):
                return Conjunction(tuple(map(self.relation, relations)))
            case Negative(operand):
                inside = self.decimals.formula(operand)
                if isinstance(inside, Negative) and isinstance(inside.operand, Quotient):
                    inside = Quotient(Negative(inside.operand.numerator), inside.operand.denominator)
                shown: Formula = Negative(inside)
                is_kept = not isinstance(inside, Negative)
            case _:
                shown, is_kept = self.decimals.formula(label), True
        return shown if is_kept and not is_rounded(shown) else letter_for(figure, place, label) or label

    def roots(self, roots: Roots) -> Roots:
        """Return roots in decimals, where they have them; -1 ± √3 i stays."""
        if all(map(_is_short_surd, roots.values)):
            return roots
        texts = rounded_roots(roots.values, self.digits)
        return roots if texts is None else RoundedRoots(roots.polynomial, roots.values, texts)

    def value(self, formula: Formula) -> Formula:
        """Return a formula in decimals that are not rounded, itself where there are none."""
        written = (each.formula(formula) for each in (self.decimals, self.precise))
        return next((shown for shown in written if not is_rounded(shown)), formula)

    def relation(self, relation: Relation) -> Relation:
        """Return a relation in decimals; conditions and definitions of decimals stay exact."""
        if isinstance(relation.members[0], Decimals):
            return relation
        shown = self.decimals.relation(relation)
        return self.exactly(relation) if self._is_condition(relation) or not is_in_order(shown) else shown

    def answer(self, relation: Relation) -> Relation:
        """Return an answer in decimals, the exact value before them where that is short."""
        shown, value = self.relation(relation), relation.members[-1]
        is_brief = isinstance(value, Literal) and shown.operators[-1] == "≈" and relation.operators[-1] == "="
        if not is_brief or not is_short(value.value) or is_rounded(shown.members[-2]):  # type: ignore[union-attr]
            return shown
        return Relation((*shown.members[:-1], value, shown.members[-1]), (*shown.operators[:-1], "=", "≈"))

    def exactly(self, relation: Relation) -> Relation:
        """Return a relation in decimals that are not rounded, itself where there are none."""
        written = (each.relation(relation) for each in (self.decimals, self.precise))
        return next((shown for shown in written if not any(map(is_rounded, shown.members))), relation)

    def bounds(self, relation: Relation) -> Relation:
        """Return the bounds of a region in decimals that are not rounded, the others with their decimals beside."""
        shown = self.exactly(relation)
        members, operators = list(shown.members), list(shown.operators)
        for place in (len(members), 0):
            end = members[place - 1 if place else 0]
            near = self.decimals.formula(end)
            if (
                isinstance(end, Literal)
                and isinstance(end.value, Scalar)
                and end.value.is_constant
                and is_rounded(near)
            ):
                members.insert(place, near)
                operators.insert(place, "≈")
        return Relation(tuple(members), tuple(operators))

    def _is_condition(self, relation: Relation) -> bool:
        """Return whether a relation is one between parameters alone, which defines no letter for one."""
        first = relation.members[0]
        if isinstance(first, Literal) and first.value.names and not first.value.names & self.parameters:
            return False
        return not any(map(letters, relation.members)) and any(map(self._names, relation.members))

    def _names(self, formula: Formula) -> frozenset[str]:
        if isinstance(formula, Literal):
            return formula.value.names & self.parameters
        return frozenset().union(*map(self._names, children(formula)))
