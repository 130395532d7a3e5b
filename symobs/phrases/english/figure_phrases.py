"""What is said beside a block diagram, and beside courses over time."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "block_diagram": "Block diagram",
    "drawn_copy": "Drawn, it is the plant once more, with what its output misses of $y$ fed back through $L$:",
    "drawn_collected": "The collected form is a single loop, driven by input and output:",
    "drawn_collected_free": "The collected form is a single loop, driven by the output:",
    "drawn_compensator": "Plant, observer and feedback together form this loop:",
    "drawn_loop": "$G_cl$ is the transfer function from $r_in$ to $y$ of this loop:",
    "drawn_unity_loop": "$G_r$ is the transfer function from $r_in$ to $y$ of this loop:",
    "drawn_feedforward": "As a block diagram:",
    "drawn_tracking": "As a block diagram, with the generator of the reference on the left:",
    "drawn_feedforward_minimal": "As a block diagram, with $M_z$ the matrix that puts the estimate together:",
    "drawn_tracking_minimal": "As a block diagram, with the generator of the reference on the left and $M_z$ the matrix that puts the estimate together:",
    "plot_error": "The error decays as drawn here.",
    "plot_estimate": "State and estimate meet on their way to rest.",
    "drawn_minimal_order": "As a block diagram, with $M_z$ the matrix that puts the estimate together:",
}
