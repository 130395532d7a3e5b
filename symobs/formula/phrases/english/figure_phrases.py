"""Captions of block diagrams and of time responses."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "block_diagram": "Block diagram",
    "figure": "Figure",
    "drawn_copy": "The observer: a model of the plant, with the difference between $y$ and the model output fed back through $L$.",
    "drawn_collected": "The observer with terms collected: a single loop driven by input and output.",
    "drawn_collected_free": "The observer with terms collected: a single loop driven by the output.",
    "drawn_compensator": "Plant, observer and state feedback.",
    "drawn_loop": "The loop with the transfer function $G_cl$ from $r_in$ to $y$.",
    "drawn_unity_loop": "The loop with the transfer function $G_r$ from $r_in$ to $y$.",
    "drawn_feedforward": "Plant, observer, state feedback and feedforward.",
    "drawn_integral": "State feedback with the integral of the control error.",
    "drawn_state_feedforward": "Plant, state feedback and feedforward.",
    "drawn_tracking": "Tracking: the reference model stands on the left.",
    "drawn_feedforward_minimal": "Plant, observer, state feedback and feedforward; $M_z$ assembles the estimate from the output and the observer state.",
    "drawn_tracking_minimal": "Tracking: the reference model stands on the left; $M_z$ assembles the estimate from the output and the observer state.",
    "plot_error": "The estimation error.",
    "plot_estimate": "The state and its estimate.",
    "plot_response_constant": "The response to the constant input {input}.",
    "plot_response_forced": "The response to the input {input}, where {exosystem}.",
    "drawn_minimal_order": "The reduced-order observer; $M_z$ assembles the estimate from the output and the observer state.",
}
