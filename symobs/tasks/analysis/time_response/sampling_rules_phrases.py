"""Sampled plants and controllers by a rule that replaces s."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "sampling_rules": "Sampling by a rule.",
    "sampling_forward": "The forward rule replaces the derivative by the forward difference over one sampling period.",
    "sampling_backward": "The backward rule replaces the derivative by the backward difference over one sampling period.",
    "sampling_tustin": "Tustin's rule integrates by trapezoids over one sampling period.",
    "sampling_matrices": "Written as a plant in the state of discrete time, this has the matrices",
    "sampling_output_kept": "The output equation is that of the plant.",
    "sampling_response": "The transfer function is that of the plant at what replaces $s$:",
    "sampling_tustin_stability": "The rule maps the open left half-plane onto the open unit disc: what is sampled is stable if and only if the original is, for every sampling period§.",
    "sampling_backward_stability": "The rule maps the open left half-plane into the open unit disc: what is stable stays stable for every sampling period, and what is unstable may become stable§.",
    "sampling_forward_disc": "The rule carries a pole $p$ to 1 plus the sampling period times $p$: what is sampled is stable only for sampling periods that are small enough, and never if the original is not§.",
    "sampling_poles": "The poles of the plant are the roots of",
    "sampling_forward_stability": "The rule carries a pole $p$ to 1 plus the sampling period times $p$. This lies in the open unit disc if and only if the real part of the reciprocal of $p$ is less than minus half the sampling period, that is, if the following polynomial has roots with negative real part only§:",
    "sampling_stable": "All its roots have negative real part, so the sampled plant is stable.",
    "sampling_not_stable": "Not all its roots have negative real part, so the sampled plant is not stable.",
    "sampling_pole_at_zero": "A pole at 0 is carried to 1 for every sampling period, so the sampled plant is not asymptotically stable:",
    "sampling_controller": "The controller in continuous time is",
    "sampling_controller_is": "Hence $s$ is replaced by {image}, and the controller in discrete time is",
}

QUESTIONS: dict[str, str] = {
    "ask zero_order_hold rule=tustin sampling_period": "The plant is sampled by Tustin's rule with the sampling period {sampling_period}. Find the matrices of the sampled plant, and what the rule does to stability.",
    "ask zero_order_hold rule=tustin sampling_period controller": "The controller {controller} is carried over to discrete time by Tustin's rule with the sampling period {sampling_period}. Find its transfer function in $z$.",
    "ask zero_order_hold rule=forward sampling_period": "The plant is sampled by the forward rule with the sampling period {sampling_period}. Find the matrices of the sampled plant, and what the rule does to stability.",
    "ask zero_order_hold rule=forward sampling_period controller": "The controller {controller} is carried over to discrete time by the forward rule with the sampling period {sampling_period}. Find its transfer function in $z$.",
    "ask zero_order_hold rule=backward sampling_period": "The plant is sampled by the backward rule with the sampling period {sampling_period}. Find the matrices of the sampled plant, and what the rule does to stability.",
    "ask zero_order_hold rule=backward sampling_period controller": "The controller {controller} is carried over to discrete time by the backward rule with the sampling period {sampling_period}. Find its transfer function in $z$.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "sampling_stable": ("stable",),
    "sampling_not_stable": ("unstable",),
}

DEMANDS: dict[str, str] = {
    "sampling_stable": "about q_s",
    "sampling_not_stable": "about q_s",
    "sampling_controller_is": "applies_image",
}

RESTS_ON: dict[str, str] = {
    "sampling_tustin_stability": "sampling_maps",
    "sampling_backward_stability": "sampling_maps",
    "sampling_forward_disc": "sampling_maps",
    "sampling_forward_stability": "sampling_maps",
}

THEOREMS: dict[str, str] = {
    "sampling_maps": "astrom1997, ch. 8",
}

NAMING = ("sampling_controller_is",)

EXPLAINS = ("sampling_forward_stability",)
