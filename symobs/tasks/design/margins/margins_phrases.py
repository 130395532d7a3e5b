"""Margins of loops."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "margins": "Margins.",
    "margins_controller": "The controller in the loop with negative feedback is",
    "margins_cut_input": "If the loop is cut at the input of the plant, the characteristic polynomial is",
    "margins_cut_output": "If the loop is cut at the output of the plant, the characteristic polynomial is",
    "margins_closed": "that of the closed loop is",
    "margins_open": "The margins are not found here: {question}.",
    "margins_none": "The closed loop is not stable, so it has no margins.",
    "margins_stable": "The closed loop is stable.",
    "margins_gain": "If the gain of the loop is multiplied by $k$, the characteristic polynomial of the closed loop is",
    "margins_no_loop": "Nothing is fed back: no change of the gain makes the loop unstable.",
    "margins_are": "A change of the phase of the loop, either way, leaves the loop stable as long as it is less than {phase} degrees; its frequency response comes as near to −1 as {modulus}, so that the sensitivity has the peak {peak}, all rounded to six digits after the point§.",
    "margins_any_phase": "No change of the phase of the loop alone makes it unstable, since its frequency response never has modulus 1; it comes as near to −1 as {modulus}, so that the sensitivity has the peak {peak}, both rounded to six digits after the point§.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "margins_none": ("unstable",),
    "margins_stable": ("stable",),
}

QUESTIONS: dict[str, str] = {
    "ask margins": "Find the gain margins and the phase margin of the loop.",
    "ask margins poles": "Find the gain margins and the phase margin of the loop with the poles {poles}.",
    "ask margins polynomial": "Find the gain margins and the phase margin of the loop with the characteristic polynomial {polynomial}.",
    "ask margins controller": "Find the gain margins and the phase margin of the loop of the plant and the controller {controller}.",
    "also margins K": "The feedback gain is $K$.",
    "also margins L": "The observer gain is $L$.",
    "also margins observer=minimal": "Use an observer of minimal order.",
}

DEMANDS: dict[str, str] = {
    "margins_none": "about chi_cl",
    "margins_stable": "about chi_cl",
    "margins_no_loop": "is chi_cl chi_o",
    "margins_are": "has_margins chi_cl chi_o",
    "margins_any_phase": "has_margins chi_cl chi_o",
}

RESTS_ON: dict[str, str] = {
    "margins_are": "loop_margins",
    "margins_any_phase": "loop_margins",
}

THEOREMS: dict[str, str] = {
    "loop_margins": "skogestad2005, ch. 2",
}

#: Phrases that go on with the sentence before them.
CONTINUES = ("margins_closed",)

NAMING = ("margins_are", "margins_any_phase")
