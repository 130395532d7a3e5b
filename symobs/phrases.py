"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else.

A phrase is plain text with slots in braces; a slot is filled by a formula or relation (set as mathematics) or by a
word.  Steps name a phrase by its key; a step whose slots do not match its phrase cannot be made.
"""

from __future__ import annotations

import string

PHRASES: dict[str, str] = {
    "given": "Given.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
}


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
