"""Every way to change one thing in an answer or in a derivation: the lies that must not survive.

`changes` walks any value of the library (scalars, matrices, formulas, facts, steps) and yields copies that differ in one
place.  Nothing here knows what is true; `tests/support/derivations.py` does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Root, Scalar
from symobs.formula.figures import Curve, MarkedPoint, PlottedResponse, PoleMap
from symobs.formula.phrases import PHRASES, slots_of
from symobs.formula.phrases.languages import SPOKEN, Counted
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
)
from symobs.proof.derivation import Derivation, Section, Sentence
from symobs.proof.derivation.check import after
from symobs.stability.criteria.routh_table import ORIGINS, RouthRow, RouthTable
from symobs.stability.regions.region import RegionInequality
from tests.kit import tables

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.formula.tree import Environment
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Result

#: A formula node that may stand negated or doubled in its place.
NODES = (Letter, Literal, Identity, Sum, Negative, Product, Power, Transpose, Quotient, Apply, Block, Derivative)
#: Up to this many terms every coefficient of a scalar is changed in turn, beyond it the first, middle and last.
_MANY_TERMS = 8
_OTHER_OPERATORS = tables(Path(__file__))["other_operators"]
#: Sentences that say the opposite, or of another thing, with the same slots.
_OTHER_WORDS = tables(Path(__file__))["other_words"]
#: Sentences that say of a value only that nothing is decided where it vanishes.
_UNDECIDED = {"undecided_case", "undecided_together", "undecided_many"}
#: What else may be said to be counted.
_OTHER_THINGS = {"only_real_root": "real_root", "real_root": "only_real_root"}
#: Sentences that say more, or otherwise, with the same slots; what says less is as true.
_MORE_WORDS = {
    "compensator_unstable": "compensator_unstable_alone",
    "compensator_unstable_low": "compensator_unstable_low_alone",
    "minimal_unstable": "minimal_unstable_alone",
    "never_detectability": "yes_detectability",
    "never_stabilizability": "yes_stabilizability",
}
OTHER_WORDS = dict(_OTHER_WORDS) | {second: first for first, second in _OTHER_WORDS} | _MORE_WORDS
#: Where a sentence is changed into one that is true of no page of which it is.
WORDS = ".words"


def _other_words(key: str) -> Iterator[str]:
    """Yield the sentences that say otherwise with the same slots: the opposite, and the same of the other kind of time."""
    if key in OTHER_WORDS:
        yield OTHER_WORDS[key]
    for time, other in (("continuous", "discrete"), ("discrete", "continuous")):
        sibling = f"{key.removesuffix(time)}{other}"
        if key.endswith(f"_{time}") and sibling in PHRASES and slots_of(sibling) == slots_of(key):
            yield sibling


@dataclass(frozen=True)
class Change:
    """A copy of a value with one thing changed: where, and of which kind (entry, number, letter, structure, words)."""

    where: str
    kind: str
    value: Any

    def within(self, where: str, value: Any) -> Change:
        """Return the same change seen from the value around it."""
        return Change(where + self.where, self.kind, value)


def changes(item: Any) -> Iterator[Change]:
    """Yield the copies of a value that differ from it in one place."""
    if isinstance(item, Scalar):
        yield from _of_scalar(item)
    elif isinstance(item, Matrix):
        yield from _of_matrix(item)
    elif isinstance(item, bool) or item is None:
        return
    elif isinstance(item, int):
        yield Change("+1", "number", item + 1)
        yield Change("-1", "number", item - 1)
    elif isinstance(item, Fraction):
        yield Change("+1", "number", item + 1)
        yield Change("*(-1)-1", "number", -item - 1)
    elif isinstance(item, RegionInequality):
        yield Change(".operator", "structure", item._replace(operator="!=" if item.operator == ">" else ">"))
        for change in changes(item.polynomial):
            yield change.within(".polynomial", item._replace(polynomial=change.value))
    elif isinstance(item, tuple):
        for index, part in enumerate(item):
            for change in changes(part):
                yield change.within(f"[{index}]", (*item[:index], change.value, *item[index + 1 :]))
    elif isinstance(item, Mapping):
        for key, part in item.items():
            for change in changes(part):
                yield change.within(f"[{key}]", {**item, key: change.value})
    elif isinstance(item, Relation):
        yield from _of_relation(item)
    elif isinstance(item, Root):
        yield from _of_root(item)
    elif isinstance(item, Sentence):
        for key in _other_words(item.key):
            yield Change(WORDS, "words", replace(item, key=key))
        yield from _of_counts(item)
        if item.key not in _UNDECIDED:
            yield from _of_parts(item)
    elif isinstance(item, RouthRow):
        yield from (Change(f".origin {o}", "structure", replace(item, origin=o)) for o in ORIGINS if o != item.origin)
        yield Change(".entries shortened", "structure", replace(item, entries=item.entries[:-1]))
        yield Change(".entries lengthened", "structure", replace(item, entries=(*item.entries, Scalar.of(0))))
        yield from _of_parts(item)
    elif isinstance(item, RouthTable):
        for index in range(len(item.rows)):
            rows = (*item.rows[:index], *item.rows[index + 1 :])
            yield Change(f".rows[{index}] left out", "structure", replace(item, rows=rows))
        yield from _of_parts(item)
    elif isinstance(item, (Curve, MarkedPoint, PoleMap)):
        yield from _of_drawn(item)
        yield from _of_parts(item)
    elif isinstance(item, PlottedResponse):
        yield from _of_heights(item)
        for change in _of_parts(replace(item, heights=())):
            yield replace(change, value=replace(change.value, heights=item.heights))
    elif isinstance(item, NODES):
        yield from _of_formula(item)
        yield from _of_parts(item)
    elif is_dataclass(item) and not isinstance(item, SPOKEN):
        yield from _of_parts(item)


def _of_parts(item: Any) -> Iterator[Change]:
    for field in fields(item):
        for change in changes(getattr(item, field.name)):
            yield change.within(f".{field.name}", replace(item, **{field.name: change.value}))


def _of_counts(sentence: Sentence) -> Iterator[Change]:
    """Yield a sentence with another number in its words: one more, one less, all, the only one."""
    for index, (name, slot) in enumerate(sentence.slots):
        if not isinstance(slot, Counted):
            continue
        others = [replace(slot, count=count) for count in (slot.count + 1, slot.count - 1, slot.among) if count >= 0]
        others += [replace(slot, thing=_OTHER_THINGS[slot.thing])] if slot.thing in _OTHER_THINGS else []
        for other in others:
            if other != slot:
                slots = (*sentence.slots[:index], (name, other), *sentence.slots[index + 1 :])
                yield Change(f".slots[{name}] {other}", "words", replace(sentence, slots=slots))


def _of_drawn(item: Curve | MarkedPoint | PoleMap) -> Iterator[Change]:
    """Yield what is drawn with another meaning: no boundary, another kind of point, the other kind of time."""
    if isinstance(item, Curve):
        yield Change(".boundary", "structure", replace(item, boundary=not item.boundary))
    elif isinstance(item, MarkedPoint):
        kinds = {"stable", "unstable", "excluded"} - {item.kind}
        yield from (Change(f".kind {kind}", "structure", replace(item, kind=kind)) for kind in sorted(kinds))
    else:
        yield Change(".discrete", "structure", replace(item, discrete=not item.discrete))


def _of_heights(response: PlottedResponse) -> Iterator[Change]:
    """Yield a response with one height changed by the least there is, which none may see, and by what can be seen."""
    heights = response.heights
    step = max(2, max(map(abs, heights)) // 20)
    for index, height in enumerate(heights):
        for by in (1, -step if height >= 0 else step):
            changed = (*heights[:index], height + by, *heights[index + 1 :])
            yield Change(f".heights[{index}]{by:+}", "number", replace(response, heights=changed))


def _of_scalar(value: Scalar) -> Iterator[Change]:
    """Yield value + 1, −value, 2 value and 0, and the numerator with one coefficient one larger."""
    found = {"+1": value + 1} if value else {"+1": value + 1, "-1": value - 1}
    if value:
        found |= {"*(-1)": -value, "*2": value * 2, "*0": value * 0}
    terms = value.terms()
    chosen = range(len(terms)) if len(terms) <= _MANY_TERMS else (0, len(terms) // 2, len(terms) - 1)
    for index in chosen:
        monomial = Scalar.of(1)
        for name, power in terms[index][1]:
            monomial = monomial * Scalar.symbol(name) ** power
        found[f" + {monomial}"] = value + monomial / value.denominator
    distinct = {changed: how for how, changed in reversed(found.items())}
    for changed, how in distinct.items():
        yield Change(how, "entry", changed)


def _of_matrix(matrix: Matrix) -> Iterator[Change]:
    for i, row in enumerate(matrix.rows):
        for j, entry in enumerate(row):
            for change in changes(entry):
                rows = [list(other) for other in matrix.rows]
                rows[i][j] = change.value
                yield change.within(f"[{i}, {j}]", Matrix.of(rows, matrix.shape[1]))


def _of_relation(relation: Relation) -> Iterator[Change]:
    for index, operator in enumerate(relation.operators):
        for other in _OTHER_OPERATORS[operator]:
            operators = (*relation.operators[:index], other, *relation.operators[index + 1 :])
            yield Change(f".operators[{index}] {other}", "structure", replace(relation, operators=operators))
    for change in changes(relation.members):
        yield change.within(".members", replace(relation, members=change.value))


def _of_root(root: Root) -> Iterator[Change]:
    """Yield the root with another number; a root without closed form is one of its factor, by its index."""
    names = ("centre", "radicand") if root.is_closed else ("factor", "index")
    for name in names:
        for change in changes(getattr(root, name)):
            yield change.within(f".{name}", replace(root, **{name: change.value}))
    if root.is_closed and root.radicand:
        yield Change(".sign", "structure", replace(root, sign=-root.sign))


def _of_formula(formula: Any) -> Iterator[Change]:
    """Yield the node negated and doubled, and where it is a minus or a transposition without it."""
    if isinstance(formula, (Negative, Transpose)):
        yield Change(" dropped", "structure", formula.operand)
    elif not isinstance(formula, Literal):
        kind = "letter" if isinstance(formula, Letter) else "structure"
        yield Change(" negated", kind, Negative(formula))
        yield Change(" doubled", kind, Sum((formula, formula)))


# -- answers ------------------------------------------------------------------------------------------------------------


def answer_changes(answer: Any) -> Iterator[Change]:
    """Yield the changes of one answer: of its entries, and the answer left out or shortened."""
    if isinstance(answer, Factored):
        yield from _of_parts(answer)
        return
    yield from changes(answer)
    if isinstance(answer, (Matrix, Scalar)):
        yield Change(" left out", "structure", None)
    if isinstance(answer, tuple) and answer:
        yield Change(" shortened", "structure", answer[:-1])
    if isinstance(answer, Matrix) and answer.shape[1]:
        yield Change(" shortened", "structure", answer.select(range(answer.shape[0]), range(answer.shape[1] - 1)))


def parts_of(result: Result, where: str = "") -> Iterator[tuple[str, Result]]:
    """Yield a result, the results it is made of, and those of its cases."""
    name = f"{where}{result.task}"
    yield name, result
    for part in ("feedback", "estimator", "inner"):
        if getattr(result, part, None) is not None and part in type(result).__dataclass_fields__:
            yield from parts_of(getattr(result, part), f"{name}/")
    for case in result.case_tree:
        if case.result is not None:
            yield from parts_of(case.result, f"{name} at {', '.join(map(str, case.when))}/")


# -- derivations --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Line:
    """A step of a derivation with what is established before and after it, and the steps that follow it."""

    derivation: Derivation
    start: Environment
    step: Step
    after: Environment
    rest: tuple[Step, ...]

    def alone(self, step: Step) -> Derivation:
        """Return nothing but another step in this one's place."""
        return replace(self.derivation, steps=(step,), start=self.start)

    def told(self, step: Step) -> Derivation:
        """Return the derivation from here on with another step in this one's place."""
        return replace(self.derivation, steps=(step, *self.rest), start=self.start)

    def followed(self, after: Environment) -> Derivation:
        """Return what follows this step, after something else was established."""
        return replace(self.derivation, steps=self.rest, start=after)


def lines_of(derivation: Derivation) -> list[Line]:
    """Return the steps of a checked derivation, sections opened."""
    steps = list(_opened(derivation.steps))
    lines, start = [], derivation.start
    for index, step in enumerate(steps):
        known = after(step, start, derivation.discrete)
        lines.append(Line(derivation, start, step, known, tuple(steps[index + 1 :])))
        start = known
    return lines


def _opened(steps: tuple[Step, ...]) -> Iterator[Step]:
    for step in steps:
        if isinstance(step, Section):
            assert all(isinstance(slot, str) for _, slot in step.title.slots)
            yield from _opened(step.steps)
        else:
            yield step
