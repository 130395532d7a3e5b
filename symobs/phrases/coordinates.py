"""Changes of coordinates: Kalman's decomposition and the canonical forms."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "decomposition": "Kalman's decomposition.",
    "canonical_form": "Canonical form.",
    "reached_and_hidden": "What the input reaches is spanned by the columns of $Ctr$, and what the output does not show is the kernel of $O$:",
    "basis_blocks": "The columns of $S$ are a basis in four parts: {sizes}. They span, in this order, what is reached and seen, the rest of what "
    "is reached, which is hidden, the rest of what is seen, and the rest of the hidden states.",
    "decomposed": "In the coordinates $T x$ the plant has the matrices",
    "zero_pattern": "Nothing leads out of the reachable states, and nothing leads from the hidden states to the others.",
    "minimal_part": "The first part, controllable and observable, has the transfer function of the whole:",
    "nothing_remains": "No state is both reached and seen, so the transfer function is constant:",
    "structure_provided": "The parts have these dimensions in general. From here on we assume {condition}.",
}
