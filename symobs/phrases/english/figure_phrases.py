"""What is said beside a block diagram, and beside courses over time."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "block_diagram": "Block diagram",
    "drawn_copy": "Block diagram of the observer: a model of the plant, with the difference between $y$ and the model output fed back through $L$:",
    "drawn_collected": "With terms collected, the observer is a single loop driven by input and output:",
    "drawn_collected_free": "With terms collected, the observer is a single loop driven by the output:",
    "drawn_compensator": "The block diagram of plant, observer and state feedback is:",
    "drawn_loop": "Here $G_cl$ is the transfer function from $r_in$ to $y$ of the following loop:",
    "drawn_unity_loop": "Here $G_r$ is the transfer function from $r_in$ to $y$ of the following loop:",
    "drawn_feedforward": "The block diagram is:",
    "drawn_tracking": "The block diagram is as follows, with the reference model on the left:",
    "drawn_feedforward_minimal": "The block diagram is as follows; $M_z$ assembles the estimate from the output and the observer state:",
    "drawn_tracking_minimal": "The block diagram is as follows, with the reference model on the left; $M_z$ assembles the estimate from the output and the observer state:",
    "plot_error": "The estimation error is plotted below.",
    "plot_estimate": "The state and its estimate are plotted below.",
    "drawn_minimal_order": "The block diagram is as follows; $M_z$ assembles the estimate from the output and the observer state:",
}
