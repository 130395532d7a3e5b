"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else."""

from symobs.phrases.catalogue import (
    ASSERTS,
    BESIDE,
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
    slots_of,
)

__all__ = [
    "ASSERTS",
    "BESIDE",
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
    "slots_of",
]
