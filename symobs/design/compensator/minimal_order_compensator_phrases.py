"""The compensator with a minimal-order observer."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "partitioned_gain": "Measured and estimated states are fed back by",
    "minimal_control": "By the separation principle§ the control law uses the measured states as they are and the estimate of the others:",
    "output_gain": "With",
    "minimal_control_in_y": "it reads, in terms of the output and of the observer's state,",
    "well_posed_assumed": "This determines $u$ where {condition}.",
    "minimal_control_solved": "Solved for the input,",
    "ill_posed": "Because of {determinant} this cannot be solved for $u$: the measured output contains the input, which the control law would need "
    "before it is known. With these gains there is no compensator.",
    "ill_posed_for_some": "Because of {determinant} this cannot be solved for $u$ with these gains: the measured output contains the input, which the "
    "control law would need before it is known. Other gains with the same poles were not tried.",
    "ill_posed_there": "There {determinant}: the output contains the input, which the control law would need before it is known. With these "
    "gains there is no compensator.",
    "minimal_closed": "Put into the observer, it leaves, with {state} and {input}, a system that is driven by $y$ alone:",
    "minimal_transfer": "Its transfer function from $y$ to $-u$ is",
    "minimal_stable": "Its direct term, with which the measured states act at once, is {direct}. By itself it is stable.",
    "minimal_unstable": "Its direct term, with which the measured states act at once, is {direct}. By itself it is not stable.",
    "minimal_unstable_alone": "Its direct term, with which the measured states act at once, is {direct}. By itself it is not stable, although the loop is.",
    "minimal_proper": "Its direct term, with which the measured states act at once, is {direct}.",
    "minimal_stable_if": "Its direct term, with which the measured states act at once, is {direct}. By itself it is stable exactly where {where}.",
    "reduced_coordinates": "In state and observer state the same loop reads",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "minimal_stable": ("strictly_proper", "stable"),
    "minimal_unstable": ("strictly_proper", "unstable"),
    "minimal_unstable_alone": ("strictly_proper", "unstable", "stable"),
    "minimal_proper": ("strictly_proper",),
    "minimal_stable_if": ("strictly_proper",),
}

DEMANDS: dict[str, str] = {
    "minimal_unstable_alone": "needs_loop_stable",
}

RESTS_ON: dict[str, str] = {
    "minimal_control": "separation",
    "minimal_transfer": "minimal_order",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "minimal_order": ("compensator with a minimal-order observer", "S0, section 4.6"),
}

#: A new thought begins here.
OPENS = (
    "minimal_control",
    "partitioned_gain",
)
