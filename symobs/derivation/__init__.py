"""Derivations: closed kinds of steps, and the check without which none is shown."""

from symobs.derivation.check import Derivation
from symobs.derivation.convention_signs import set_apart, translated
from symobs.derivation.steps import (
    Case,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Note,
    Plot,
    Section,
    Sentence,
    Solve,
    Step,
    Survey,
    Tabulate,
    Where,
)

__all__ = [
    "Case",
    "Conclude",
    "Define",
    "Derivation",
    "Diagram",
    "Equal",
    "Given",
    "Note",
    "Plot",
    "Section",
    "Sentence",
    "Solve",
    "Step",
    "Survey",
    "Tabulate",
    "Where",
    "set_apart",
    "translated",
]
