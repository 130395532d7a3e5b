"""Every sentence a derivation can say: the languages of the prose live here and nowhere else."""

from symobs.formula.phrases.catalogue import (
    ASSERTS,
    BESIDE,
    CONTINUES,
    COUNTS,
    DEMANDS,
    EXPLAINS,
    FIGURES,
    NAMING,
    OPENS,
    PHRASES,
    QUESTIONS,
    RESTS_ON,
    SPELLS_OUT,
    THEOREMS,
    WORDS,
    slots_of,
)

__all__ = [
    "ASSERTS",
    "BESIDE",
    "CONTINUES",
    "COUNTS",
    "DEMANDS",
    "EXPLAINS",
    "FIGURES",
    "NAMING",
    "OPENS",
    "PHRASES",
    "QUESTIONS",
    "RESTS_ON",
    "SPELLS_OUT",
    "THEOREMS",
    "WORDS",
    "slots_of",
]
