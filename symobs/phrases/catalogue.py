"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else.

A phrase is plain text with slots in braces, filled by a formula or fact (set as mathematics) or by a word; between dollar
signs stand formulas in the letters of `notation` that only name things.  Steps name a phrase by its key; a step whose
slots do not match its phrase cannot be made.  Each module of the folder holds the sentences of one subject, with what
they assert and rest on.
"""

from __future__ import annotations

import string
from typing import Any

from symobs.phrases.english.analysis import coordinates, duality, modes, polynomials, rank, time, time_varying
from symobs.phrases.english.design import (
    compensators,
    feedforward,
    gain_families,
    gains,
    minimal_order,
    pole_advice,
    pole_cautions,
    reduced_order,
    side_by_side,
    tracking,
)
from symobs.phrases.english.page import captions, figures, questions, titles
from symobs.phrases.english.stability import regions, routh

_MODULES = (
    titles,
    pole_advice,
    pole_cautions,
    polynomials,
    rank,
    modes,
    duality,
    coordinates,
    time,
    gains,
    side_by_side,
    gain_families,
    compensators,
    minimal_order,
    feedforward,
    tracking,
    reduced_order,
    time_varying,
    routh,
    regions,
    captions,
    figures,
    questions,
)


def _collected(name: str) -> dict[str, Any]:
    """Return what the modules call `name`, joined; raises ValueError for the same key twice and for no phrase's key."""
    joined: dict[str, Any] = {}
    for module in _MODULES:
        for key, value in dict(getattr(module, name, {})).items():
            if key in joined:
                message = f"the phrase {key!r} is written twice"
                raise ValueError(message)
            if name != "PHRASES" and key not in PHRASES:
                message = f"{name} speaks of {key!r}, which is no phrase"
                raise ValueError(message)
            joined[key] = value
    return joined


PHRASES: dict[str, str] = _collected("PHRASES")

#: The properties that a phrase asserts: a step that says it must have them among its facts, and so have been checked.
ASSERTS: dict[str, tuple[str, ...]] = _collected("ASSERTS")

#: The obligation that the words of a phrase carry, by its name in `derivation.wording_check`: a step that says it is
#: rejected where its relation, its facts or its definition do not meet it.
DEMANDS: dict[str, str] = _collected("DEMANDS")

#: The theorem (a key of `notation.THEOREMS`) that a phrase appeals to.
RESTS_ON: dict[str, str] = _collected("RESTS_ON")

#: Phrases that name a value and claim nothing of it: in all others a value stands with what it is the value of.
NAMING = frozenset(key for module in _MODULES for key in getattr(module, "NAMING", ()))

#: Phrases that begin a new paragraph wherever they stand.
OPENS = frozenset(key for module in _MODULES for key in getattr(module, "OPENS", ()))


#: Phrases that only explain, and refer to nothing but what was just shown: a shorter page leaves them out.
EXPLAINS = frozenset(key for module in _MODULES for key in getattr(module, "EXPLAINS", ()))

#: Titles of sections whose own sections stand side by side on the page, row by row.
BESIDE = frozenset(key for module in _MODULES for key in getattr(module, "BESIDE", ()))

#: Phrases before a display that says what the short names stand for in which answers are written: no page goes without.
SPELLS_OUT = frozenset(key for module in _MODULES for key in getattr(module, "SPELLS_OUT", ()))


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
