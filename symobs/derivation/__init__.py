"""Derivations: closed kinds of steps, and the check without which none is shown."""

from symobs.derivation.check import Derivation
from symobs.derivation.pictures import is_faithful
from symobs.derivation.regions import findings_of_conditions, findings_of_region
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
from symobs.derivation.tables import findings_of

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
    "findings_of",
    "findings_of_conditions",
    "findings_of_region",
    "is_faithful",
]
