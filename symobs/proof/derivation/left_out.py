"""Pages with a remark in place of each statement that fails its check.

Only remarks, findings, further equations and pictures give way: what is given, assumed, defined or answered, and cases,
never do, for without them a page would say something else.  What is left is checked from the beginning.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation.builder import left_out
from symobs.proof.derivation.steps import CaseStep, Conclude, Diagram, Equal, Note, Plot, Section, Sentence

if TYPE_CHECKING:
    from symobs.proof.derivation.check import Derivation
    from symobs.proof.derivation.steps import Step

#: Where more statements fail, the page is none.
_MOST = 20


def without_rejected(written: Derivation) -> Derivation:
    """Return a derivation that passes its check, with remarks for what fails; raises `DerivationRejected`."""
    rejected: list[DerivationRejected] = []
    while len(rejected) <= _MOST:
        try:
            written.check()
        except DerivationRejected as error:
            rejected.append(error)
            if not _gives_way(error.facts.get("step")):
                break
            written = replace(written, steps=_remarked(written.steps, error.facts["step"]))
            continue
        for each in rejected:
            left_out(f"the line {each.facts['line']}")
        return written
    raise rejected[0]


def _gives_way(step: object) -> bool:
    return isinstance(step, Conclude | Note | Equal | Diagram | Plot) and not (
        step.sentence is None or (isinstance(step, Equal) and step.answer)
    )


def _remarked(steps: tuple[Step, ...], rejected: object) -> tuple[Step, ...]:
    """Return steps with the remark in place of one, wherever it stands."""
    return tuple(
        Note(Sentence("left_out"))
        if step is rejected
        else replace(step, steps=_remarked(step.steps, rejected))
        if isinstance(step, Section | CaseStep)
        else step
        for step in steps
    )
