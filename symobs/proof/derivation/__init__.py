"""Derivations: closed kinds of steps, and the check without which none is shown."""

from symobs.proof.derivation.check import Derivation
from symobs.proof.derivation.convention_signs import set_apart, translated
from symobs.proof.derivation.steps import (
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
    Sentence,
    Step,
    Tabulate,
)

__all__ = [
    "CaseStep",
    "Conclude",
    "Define",
    "Derivation",
    "Diagram",
    "Equal",
    "Given",
    "Inequalities",
    "Note",
    "Plot",
    "RegionSummary",
    "Section",
    "Sentence",
    "Step",
    "Tabulate",
    "set_apart",
    "translated",
]
