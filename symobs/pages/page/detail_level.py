"""Levels of detail: the filter on the steps of a page.

`full` tells everything. `outline` keeps headings, what is defined with the words before it, tables and pictures, without
the running explanation. `answer` keeps what is given, conditions, cases, findings, the answers and their checks.  Both
leave out only what is known to explain; whatever conditions an answer stays, and a sentence that stays keeps what it
speaks of.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.formula.phrases import ASSERTS, CONTINUES, EXPLAINS, SPELLS_OUT
from symobs.formula.tree import Conjunction, HoldsExactlyWhere, Predicate, Relation, Transpose, children
from symobs.ground.errors import UsageError
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Note,
    Plot,
    RegionSummary,
    Section,
    Tabulate,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.tree import Formula
    from symobs.proof.derivation import Sentence, Step

DETAILS = ("full", "outline", "answer")
#: The answers below their question at the end of a sheet: as `answer`, but without data, checks and references.
FINAL = "final"


def detail_named(name: str, where: str = "detail") -> str:
    """Return the name of a level of detail; raises `UsageError` naming those that exist."""
    if name not in DETAILS:
        repair = f"use one of {', '.join(DETAILS)}"
        raise UsageError(f"{str(name)[:40]!r} is not a level of detail", where=where, repair=repair)
    return name


def at_detail(steps: Sequence[Step], detail: str) -> tuple[Step, ...]:
    """Return the steps of a page at this level of detail."""
    if detail == FINAL:
        return tuple(_unproved(at_detail(steps, "answer")))
    if detail_named(detail) == "full":
        return tuple(steps)
    kept: list[Step] = []
    passed: list[Step] = []
    for step in steps:
        inner = tuple(_shortened(step, detail))
        if isinstance(step, Define | Equal) and not inner:
            passed = [step] if _begins(step.sentence) else [*passed, step]
            continue
        if inner and _speaks_of_before(step):
            kept += passed
        kept += inner
        passed = []
    return tuple(kept)


def _unproved(steps: Sequence[Step]) -> Iterator[Step]:
    """Yield the steps without the checks of answers, and without sections of nothing else."""
    for step in steps:
        if isinstance(step, Section):
            if inner := tuple(_unproved(step.steps)):
                yield replace(step, steps=inner)
        elif isinstance(step, CaseStep):
            yield replace(step, steps=tuple(_unproved(step.steps)))
        elif not (isinstance(step, Conclude) and step.verified):
            yield step


def _shortened(step: Step, detail: str) -> Iterator[Step]:
    """Yield the rest of a step: the step, the step without its sentence, its findings, or nothing."""
    match step:
        case Section(steps=steps):
            if inner := at_detail(steps, detail):
                yield replace(step, steps=inner)
        case CaseStep(steps=steps):
            inner = at_detail(steps, detail)
            yield replace(step, steps=inner) if any(_is_seen(left) for left in inner) else step
        case Define(silent=True):
            yield step
        case Define(answer=True) | Equal(answer=True):
            answer = step if detail == "outline" else _result_alone(step)
            yield answer if _introduces(step.sentence) else replace(answer, sentence=None)
        case Define(sentence=sentence) | Equal(sentence=sentence) if _spells_out(step) or conditions(sentence):
            yield step
        case Diagram() if detail == "outline":
            yield step
        case Define(sentence=sentence) if detail == "outline":
            yield step if _introduces(sentence) else replace(step, sentence=None)
        case Tabulate(findings=findings) if detail == "answer":
            yield from (Note(finding) for finding in findings if finding.key not in EXPLAINS)
        case RegionSummary(findings=findings):
            yield replace(step, findings=tuple(finding for finding in findings if finding.key not in EXPLAINS))
        case Plot() if detail == "outline":
            yield step
        case Equal(relations=relations) if any("!=" in relation.operators for relation in relations):
            yield replace(step, sentence=None)
        case Define() | Equal() | Diagram() | Plot():
            pass
        case Conclude(sentence=sentence) | Note(sentence=sentence):
            if sentence is None or sentence.key not in EXPLAINS:
                yield step
        case _:
            yield step


def conditions(sentence: Sentence | None) -> bool:
    """Return whether a sentence may condition an answer: it contains an inequality, or asserts a property."""
    if sentence is None:
        return False
    slots = [slot for _, slot in sentence.slots]
    return sentence.key in ASSERTS or any(
        isinstance(slot, Conjunction | HoldsExactlyWhere | Predicate)
        or (isinstance(slot, Relation) and any(operator != "=" for operator in slot.operators))
        for slot in slots
    )


def _introduces(sentence: Sentence | None) -> bool:
    """Return whether a sentence introduces the answer below it and is complete by itself."""
    if sentence is None or conditions(sentence):
        return sentence is not None
    return _begins(sentence) and sentence.key not in EXPLAINS


def _result_alone(step: Define | Equal) -> Define | Equal:
    """Return an answer without its derivation: a = d for a = b = c = d, without transposed rows beside the gain."""
    if isinstance(step, Define):
        return replace(step, relation=_ends(step.relation))
    firsts = [relation.members[0] for relation in step.relations]
    own = [r for r, first in zip(step.relations, firsts, strict=True) if not _is_transposed(first, firsts)]
    return replace(step, relations=tuple(_ends(relation) for relation in own))


def _ends(relation: Relation) -> Relation:
    """Return a chain without the members between its first and the last equal one."""
    equals = next(
        (place for place, operator in enumerate(relation.operators) if operator != "="), len(relation.operators)
    )
    first, rest = relation.members[0], relation.members[max(1, equals) :]
    return Relation((first, *rest), relation.operators[max(0, equals - 1) :])


def _is_transposed(first: Formula, others: Sequence[Formula]) -> bool:
    return isinstance(first, Transpose) and children(first)[0] in others


def _spells_out(step: Define | Equal) -> bool:
    """Return whether a step defines short names of an answer."""
    return step.sentence is not None and step.sentence.key in SPELLS_OUT


def _is_seen(step: Step) -> bool:
    """Return whether a step prints anything."""
    is_bare_fact = isinstance(step, Conclude) and step.sentence is None
    return not (getattr(step, "silent", False) or is_bare_fact)


def _begins(sentence: Sentence | None) -> bool:
    """Return whether a sentence is complete without the one before it."""
    return sentence is not None and sentence.key not in CONTINUES


def _speaks_of_before(step: Step) -> bool:
    """Return whether a step refers to the one before it: a finding, a condition, or a definition of short names."""
    if isinstance(step, Define | Equal):
        return _spells_out(step)
    return getattr(step, "sentence", None) is not None and not isinstance(step, CaseStep)
