"""Derivations: closed kinds of steps, and the check without which none is shown."""

from symobs.derivation.check import Derivation
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
from symobs.derivation.translation import set_apart, translated

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
