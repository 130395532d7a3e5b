"""The compensator with a minimal-order observer."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "partitioned_gain": "Partitioned according to measured and estimated states, the feedback gain is",
    "minimal_control": "By the separation principle§, the control law uses the measured states directly and estimates of the remaining ones:",
    "output_gain": "With",
    "minimal_control_in_y": "it becomes, in terms of the output and the observer state,",
    "well_posed_assumed": "This equation determines $u$ provided that {condition}.",
    "minimal_control_solved": "Solving for the input, we obtain",
    "ill_posed": "Since {determinant}, this equation cannot be solved for $u$: through the feedthrough the measured output contains the input, and the algebraic loop is not well posed. No compensator exists with these gains.",
    "ill_posed_for_some": "Since {determinant}, this equation cannot be solved for $u$ with these gains: through the feedthrough the measured output contains the input, and the algebraic loop is not well posed. Other gains with the same poles were not tried.",
    "ill_posed_there": "In this case {determinant}: the output contains the input, and the algebraic loop is not well posed. No compensator exists with these gains.",
    "minimal_closed": "Substitution into the observer, with {state} and {input}, gives a system driven by $y$ alone:",
    "minimal_transfer": "The compensator has the transfer function, from $y$ to $-u$,",
    "minimal_stable": "Its direct feedthrough, through which the measured states act instantaneously, is {direct}. The compensator itself is stable.",
    "minimal_unstable": "Its direct feedthrough, through which the measured states act instantaneously, is {direct}. The compensator itself is not stable.",
    "minimal_unstable_alone": "Its direct feedthrough, through which the measured states act instantaneously, is {direct}. The compensator itself is not stable, although the closed loop is.",
    "minimal_proper": "Its direct feedthrough, through which the measured states act instantaneously, is {direct}.",
    "minimal_stable_if": "Its direct feedthrough, through which the measured states act instantaneously, is {direct}. The compensator itself is stable if and only if {where}.",
    "reduced_coordinates": "In terms of state and observer state, the closed loop is",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "minimal_stable": ("strictly_proper", "stable"),
    "minimal_unstable": ("strictly_proper", "unstable"),
    "minimal_unstable_alone": ("strictly_proper", "unstable", "stable"),
    "minimal_proper": ("strictly_proper",),
    "minimal_stable_if": ("strictly_proper",),
}

DEMANDS: dict[str, str] = {
    "minimal_stable": "about F stable",
    "minimal_unstable": "about F unstable",
    "minimal_unstable_alone": "about F unstable, loop stable",
    "minimal_stable_if": "about F stable",
}

RESTS_ON: dict[str, str] = {
    "minimal_control": "separation",
    "minimal_transfer": "minimal_order",
}

THEOREMS: dict[str, str] = {
    "minimal_order": "luenberger1971; kailath1980, ch. 4",
}

#: A new thought begins here.
OPENS = (
    "minimal_control",
    "partitioned_gain",
)

#: Phrases that go on with the sentence before them.
CONTINUES = ("minimal_control_in_y",)
