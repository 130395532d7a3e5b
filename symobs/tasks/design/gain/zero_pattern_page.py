"""The pages of gains with zeros in given places: none, none but on a stratum, one with roots, one in a root of high degree."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE
from symobs.proof.derivation import CaseStep, Note
from symobs.proof.derivation.builder import Builder, relation, sentence
from symobs.tasks.analysis.page_parts import stratum_of, undecided
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.gain.gain_kind import AlgebraicGain
from symobs.tasks.design.page_parts import readability

if TYPE_CHECKING:
    from symobs.proof.derivation import Step
    from symobs.tasks.design.gain.gain_kind import Places
    from symobs.tasks.design.gain.placement_problem import PlacementProblem
    from symobs.tasks.result import Case


def write_no_gain(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """Write why no gain has its zeros there, where one has, or one in a root."""
    listed = _listed(design.zero)
    if isinstance(design.kind, AlgebraicGain):
        _algebraic(page, design, design.kind, side)
    elif not design.needed:
        page.conclude("undecided_zero", places=listed)
    elif design.needed[0].is_constant:
        page.conclude("impossible_zero", places=listed)
    else:
        short = min(design.needed, key=lambda value: value.size)
        if short.size <= readability.ZERO_CONDITION:
            page.remark("impossible_zero_unless", places=listed, when=page.value(short))
        else:
            page.remark("impossible_zero_in_general", places=listed)
        for case in design.case_tree:
            page.steps.append(pattern_case(page, case, side))


def _listed(zero: Places) -> str:
    return ", ".join(f"({i + 1}, {j + 1})" for i, j in zero)


def _algebraic(page: Builder, design: GainDesign, kind: AlgebraicGain, side: PlacementProblem) -> None:
    """Write a gain whose entries are polynomials in a real root λ."""
    found = kind.found
    low, high = found.bounds
    at_ends = [found.polynomial.substitute({EIGENVALUE: end}) for end in (low, high)]
    inner, page.steps, before = page.steps, [], page.environment
    page.environment = before.with_relations((found.polynomial,))
    page.define(side.gain, design.transpose_for_task(found.gain), answer=True)
    page.verified("as_required", check=relation(side.error_determinant(page), page[side.phi]))
    steps, page.steps, page.environment = tuple(page.steps), inner, before
    changes = relation(page.value(at_ends[0]) @ page.value(at_ends[1]), "<", 0)
    page.conclude("zero_in_root", changes, places=_listed(kind.zero), low=str(low), high=str(high))
    page.steps.append(CaseStep(relation(found.polynomial, 0), (), steps))


def pattern_case(page: Builder, case: Case, side: PlacementProblem, say: str = "case_zero_gain") -> Step:
    """Return the gain on a stratum where there is one with its zeros there."""
    result = case.result
    if not isinstance(result, GainDesign) or (result.answer[side.gain] is None and result.verdict != "no"):
        return undecided(page, case)
    if result.answer[side.gain] is None:
        steps: tuple[Step, ...] = (Note(sentence("case_no_zero", {})),)
        return CaseStep(stratum_of(case), tuple(case.substitution.items()), steps)
    return another_gain(page, case, side, say)


def another_gain(page: Builder, case: Case, side: PlacementProblem, say: str) -> Step:
    """Write the gain on a stratum that is not the one of the main line."""
    result = case.result
    assert isinstance(result, GainDesign)  # noqa: S101 - the case is decided
    inner, page.steps, before = page.steps, [], page.environment
    page.with_roots(result.answer[side.gain])
    page.define(side.gain, result.answer[side.gain], say=say, answer=True)
    page.conclude_silently(relation(side.error_determinant(page), page[side.phi]))
    conditions = [c.expression for c in result.holds_where if c.kind == "claim" and c.operator == "!="]
    if conditions:
        page.assume("gain_provided", *conditions)
    for further in result.case_tree:
        page.steps.append(pattern_case(page, further, side, say))
    steps, page.steps, page.environment = tuple(page.steps), inner, before
    return CaseStep(stratum_of(case), tuple(case.substitution.items()), steps, anew=(side.gain,))
