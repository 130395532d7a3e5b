"""Changes of coordinates: Kalman's decomposition and the canonical forms."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "decomposition": "Kalman's decomposition.",
    "canonical_form": "Canonical form.",
    "reached_and_hidden": "What the input reaches is spanned by the columns of $Ctr$, and what the output does not show is the kernel of $O$:",
    "basis_blocks": "The columns of $S$ are a basis in four parts, of the dimensions {sizes}, in this order: reached and seen; reached and hidden; "
    "seen but not reached; neither.",
    "decomposed": "In the coordinates $T x$ the plant has the matrices",
    "zero_pattern": "Nothing leads out of the reachable states, and nothing leads from the hidden states to the others.",
    "minimal_part": "The first part, controllable and observable, has the transfer function of the whole:",
    "nothing_remains": "No state is both reached and seen, so the transfer function is constant:",
    "canonical_controllable": "The coefficients of the form are those of the characteristic polynomial",
    "canonical_observable": "The coefficients of the form are those of the characteristic polynomial",
    "canonical_modal": "The form has a block for each elementary divisor of $A$. The characteristic polynomial is",
    "last_row_controllable": "The columns of the controllability matrix, combined with these coefficients, are the basis of the controllable "
    "canonical form:",
    "last_column_observable": "The rows of the observability matrix, combined with these coefficients, are the coordinates of the observable "
    "canonical form:",
    "modal_basis": "The columns of $S$ are bases of the invariant subspaces that belong to the factors: eigenvectors where the roots are rational, "
    "chains of them where they are defective, $v$ and its images under $A$ where a factor has no rational roots.",
    "canonical_impossible_controllable": "Only a controllable pair has a controllable canonical form.",
    "canonical_impossible_observable": "Only an observable pair has an observable canonical form.",
    "distinct_provided": "Where the blocks are those of the plant in general, these vectors are independent. From here on we assume {condition}.",
    "structure_provided": "The parts have these dimensions in general. From here on we assume {condition}.",
}

QUESTIONS: dict[str, str] = {
    "ask canonical_form": "Transform the plant to canonical form.",
    "ask canonical_form kind=controllable": "Transform the plant to controllable canonical form.",
    "ask canonical_form kind=observable": "Transform the plant to observable canonical form.",
    "ask canonical_form kind=modal": "Transform the plant to real modal form.",
    "ask decomposition": "Split the plant into its four parts, controllable or not and observable or not. Find the minimal part and its transfer function.",
}

RESTS_ON: dict[str, str] = {
    "last_row_controllable": "canonical_form",
    "last_column_observable": "canonical_form",
    "reached_and_hidden": "decomposition",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "decomposition": ("Kalman's decomposition", "R. E. Kalman, Proc. Nat. Acad. Sci. 48 (1962), 596-600"),
}

EXPLAINS = (
    "last_column_observable",
    "zero_pattern",
)
