"""The finding that no gain assigns a polynomial: everywhere, outside some cases, or where a remainder is not zero."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar, remainder
from symobs.formula.tree import Conjunction, Evaluated, Literal, Predicate, Relation
from symobs.formula.tree.term import Term
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, differs, predicate, relation, sentence
from symobs.proof.derivation.facts import PREDICATES
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.wording_check import meets_obligations
from symobs.tasks.analysis.page_parts import environment_on
from symobs.tasks.analysis.strata.strata import distances, systems_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from symobs.formula.tree import Environment
    from symobs.proof.derivation.builder import Slot
    from symobs.tasks.result import Case


def over_fixed(page: Builder, phi: Term, polynomial: Scalar, fixed: Term) -> tuple[Term, tuple[Relation, ...]]:
    """Return φ over the polynomial of the fixed modes, and what binds φ to its letter.

    A property holds whatever the letters of coefficients stand for: where there are some, φ is written out.
    """
    if not page.environment.coefficients:
        return phi / fixed, ()
    return page.value(polynomial) / fixed, (relation(phi, polynomial),)


def say_unassignable(
    page: Builder,
    keys: tuple[str, str],
    phi: Term,
    polynomial: Scalar,
    fixed: Term,
    cases: Sequence[Case],
    /,
    **slots: Slot,
) -> None:
    """State that φ is no multiple of the polynomial of the fixed modes.

    Where parameters make it one on cases with an equation each, or the modes are others there, it is said outside them;
    where more than one equation does, with the remainder.
    """
    quotient, bound = over_fixed(page, phi, polynomial, fixed)
    never = predicate("not_polynomial", quotient)
    said = Conclude(sentence(keys[0], slots), (*bound, never))
    left = _with_remainder(page, keys[1], phi, fixed)
    everywhere, lines, others = None, _outside_lines(cases), _outside(cases)
    for step, where in ((said, everywhere), (said, lines), (left, everywhere), (said, others), (left, others)):
        if where is not None and not where.relations:
            continue
        environment = page.environment if where is None else environment_on(page, where)
        if environment is not None and _holds(step, environment):
            page.steps.append(step if where is None else CaseStep(where, (), (step,)))
            return
    page.remark("assignable_open")


def _with_remainder(page: Builder, key: str, phi: Term, fixed: Term) -> Conclude:
    """Return the statement that φ is a multiple only where its remainder vanishes."""
    whole, rest = remainder(phi.scalar, fixed.scalar, page.plant.variable)
    left = phi - page.value(whole) @ fixed
    slots = {
        "fixed": Evaluated(fixed.formula, Literal(fixed.scalar)),
        "polynomial": Evaluated(phi.formula, Literal(phi.scalar)),
        "rest": Evaluated(left.formula, Literal(rest)),
    }
    return Conclude(sentence(key, slots), (predicate("strictly_proper", page.value(rest) / fixed),))


def _outside_lines(cases: Sequence[Case]) -> Conjunction:
    """Return that parameters are outside the cases that have a gain; nothing where one has several equations, or none."""
    systems = systems_of(case for case in cases if not _is_unassignable(case))
    if systems is None or any(len(system) > 1 for system in systems):
        return Conjunction(())
    return _apart(equation for (equation,) in dict.fromkeys(systems))


def _outside(cases: Sequence[Case]) -> Conjunction:
    """Return that parameters are outside all cases; nothing where one of them is everywhere."""
    systems = systems_of(cases)
    return _apart(() if systems is None else distances(systems))


def _apart(values: Iterable[Scalar]) -> Conjunction:
    return Conjunction(tuple(map(differs, values)))


def _is_unassignable(case: Case) -> bool:
    """Return whether a case, and all within it, has no gain either."""
    return case.result is not None and case.result.verdict == "no" and not case.result.case_tree


def _holds(step: Conclude, environment: Environment) -> bool:
    """Return whether all that a finding rests on holds at every point of a stratum."""
    for fact in step.facts:
        if isinstance(fact, Relation):
            if not verify(fact, environment)[0]:
                return False
        elif isinstance(fact, Predicate):
            value = Term(fact.subject, environment).scalar
            if not PREDICATES[fact.name](value, environment, False):  # noqa: FBT003 - it is of no time
                return False
    said = step.sentence
    return said is None or meets_obligations(said.key, SentenceContext(step.facts, environment, dict(said.slots)))
