"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else.

A phrase is plain text with slots in braces; a slot is filled by a formula or fact (set as mathematics) or by a word.
Steps name a phrase by its key; a step whose slots do not match its phrase cannot be made.
"""

from __future__ import annotations

import string

PHRASES: dict[str, str] = {
    # titles
    "given": "Given.",
    "observability": "Observability.",
    "controllability": "Controllability.",
    "characteristic_polynomial": "Characteristic polynomial.",
    "transfer_function": "Transfer function.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
    # data
    "realised": "We realise it in controllable canonical form.",
    "declared": "Throughout, {sign}.",
    "desired_poles": "The desired poles are {poles}.",
    "desired_polynomial": "The desired polynomial is {polynomial}.",
    "control_poles": "The control poles are to be {poles}.",
    "control_polynomial": "The control polynomial is to be {polynomial}.",
    "observer_poles": "The observer poles are to be {poles}.",
    "observer_polynomial": "The observer polynomial is to be {polynomial}.",
    # rank tests
    "observability_matrix": "The observability matrix stacks the output and what its derivatives show of the state,",
    "controllability_matrix": "The controllability matrix collects what the input and its derivatives reach,",
    "yes_observability": "It has full rank, so the pair (C, A) is observable.",
    "yes_controllability": "It has full rank, so the pair (A, B) is controllable.",
    "full_rank_observability": "Since {rank}, the pair (C, A) is observable.",
    "full_rank_controllability": "Since {rank}, the pair (A, B) is controllable.",
    "provided_observability": "The pair (C, A) is observable only where {condition}, which we assume from here on.",
    "provided_controllability": "The pair (A, B) is controllable only where {condition}, which we assume from here on.",
    "no_observability": "Here {rank}, so the pair (C, A) is not observable.",
    "no_controllability": "Here {rank}, so the pair (A, B) is not controllable.",
    "kernel_observability": "A state in this direction is never seen at the output,",
    "kernel_controllability": "The input never moves the state along this row,",
    "modes_observability": "The unobservable modes are {modes}.",
    "modes_controllability": "The uncontrollable modes are {modes}.",
}


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
