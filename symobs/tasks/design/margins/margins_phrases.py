"""Margins of loops."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "margins": "Margins.",
    "margins_controller": "The controller in the loop with negative feedback is",
    "margins_cut_input": "If the loop is cut at the input of the plant, the characteristic polynomial is",
    "margins_cut_output": "If the loop is cut at the output of the plant, the characteristic polynomial is",
    "margins_closed": "that of the closed loop is",
    "margins_open": "The margins are not found here: {question}.",
    "margins_counts": "The number of unstable poles is {before} without feedback and {after} with it. Hence the frequency response, closed to the right around poles on the boundary of stability, encircles −1 counterclockwise {around} times, that is {before} minus {after}, a negative number counting clockwise turns§.",
    "margins_on_boundary": "The number of unstable poles is {before} without feedback; with it {after} are unstable and others lie on the boundary of stability, so that the frequency response passes through −1.",
    "margins_axis": "The frequency response meets the real axis at {value} for the frequency {omega}, rounded to six digits after the point.",
    "margins_axis_discrete": "The frequency response meets the real axis at {value} for the angle {omega} on the unit circle, rounded to six digits after the point.",
    "margins_level": "Its modulus is 1 at the frequency {omega}, rounded to six digits after the point.",
    "margins_level_discrete": "Its modulus is 1 at the angle {omega} on the unit circle, rounded to six digits after the point.",
    "margins_delay": "A dead time in the loop leaves it stable as long as it is less than {delay}, rounded to six digits after the point: the smallest quotient of phase and frequency where the modulus is 1.",
    "margins_delay_discrete": "A dead time in the loop, measured in sampling periods and continued between them, turns the frequency response into −1 at {delay}, rounded to six digits after the point: the smallest quotient of phase and angle where the modulus is 1.",
    "margins_no_delay": "No dead time in the loop makes it unstable, since the modulus of the frequency response is never 1.",
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
    "margins_counts": "has_nyquist counts chi_cl chi_o",
    "margins_on_boundary": "has_nyquist counts chi_cl chi_o",
    "margins_axis": "has_nyquist axis chi_cl chi_o, continuous_time",
    "margins_axis_discrete": "has_nyquist axis chi_cl chi_o, discrete_time",
    "margins_level": "has_nyquist level chi_cl chi_o, continuous_time",
    "margins_level_discrete": "has_nyquist level chi_cl chi_o, discrete_time",
    "margins_delay": "has_nyquist delay chi_cl chi_o, continuous_time",
    "margins_delay_discrete": "has_nyquist delay chi_cl chi_o, discrete_time",
    "margins_no_delay": "has_nyquist delay chi_cl chi_o",
    "margins_any_phase": "has_margins chi_cl chi_o",
}

RESTS_ON: dict[str, str] = {
    "margins_are": "loop_margins",
    "margins_any_phase": "loop_margins",
    "margins_counts": "nyquist_criterion",
}

THEOREMS: dict[str, str] = {
    "loop_margins": "skogestad2005, ch. 2",
    "nyquist_criterion": "ogata2010, ch. 7",
}

#: Phrases that go on with the sentence before them.
CONTINUES = ("margins_closed",)

NAMING = (
    "margins_are",
    "margins_any_phase",
    "margins_counts",
    "margins_on_boundary",
    "margins_axis",
    "margins_axis_discrete",
    "margins_level",
    "margins_level_discrete",
    "margins_delay",
    "margins_delay_discrete",
)
