"""Changes of coordinates: the Kalman decomposition and the canonical forms."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "decomposition": "Kalman decomposition.",
    "canonical_form": "Canonical form.",
    "coordinates_changed": "Change of coordinates.",
    "reached_and_hidden": "The controllable subspace is the range of $Ctr$, and the unobservable subspace is the kernel of $O$:",
    "basis_blocks": "The columns of $S$ form a basis adapted to the decomposition, with blocks of dimensions {sizes}, in this order: controllable and observable; controllable and unobservable; uncontrollable and observable; uncontrollable and unobservable.",
    "reached_alone": "The controllable subspace is the range of $Ctr$:",
    "hidden_alone": "The unobservable subspace is the kernel of $O$:",
    "basis_reached": "The columns of $S$ form a basis adapted to the decomposition, with blocks of dimensions {sizes}, in this order: controllable; uncontrollable.",
    "basis_seen": "The columns of $S$ form a basis adapted to the decomposition, with blocks of dimensions {sizes}, in this order: observable; unobservable.",
    "zero_block_reached": "The zero blocks show that the controllable subspace is invariant under $A$.",
    "zero_block_hidden": "The zero blocks show that the unobservable subspace is invariant under $A$.",
    "decomposed": "In the coordinates $T x$ the plant has the matrices",
    "zero_pattern": "The zero blocks show that the controllable and the unobservable subspace are invariant under $A$.",
    "minimal_part": "The controllable and observable part is a minimal realisation of the transfer function:",
    "nothing_remains": "No part is both controllable and observable, so the transfer function is constant:",
    "canonical_controllable": "The canonical form is determined by the coefficients of the characteristic polynomial",
    "canonical_observable": "The canonical form is determined by the coefficients of the characteristic polynomial",
    "canonical_modal": "The real modal form has one block for each elementary divisor of $A$. The characteristic polynomial is",
    "last_row_controllable": "The columns of the controllability matrix, combined with these coefficients, give the basis of the controllable canonical form:",
    "last_column_observable": "The rows of the observability matrix, combined with these coefficients, give the coordinates of the observable canonical form:",
    "modal_basis": "The columns of $S$ are bases of the invariant subspaces belonging to the factors: eigenvectors for rational roots, chains of generalised eigenvectors for defective ones, and $v$ with its images under $A$ for a factor without rational roots.",
    "modal_ones": "The columns of $S$ are bases of the invariant subspaces belonging to the factors: eigenvectors for rational roots, chains of generalised eigenvectors for defective ones, and $v$ with its images under $A$ for a factor without rational roots. Their lengths are such that $B_bar$ has a single 1 in each block:",
    "canonical_impossible_controllable": "Only a controllable pair has a controllable canonical form.",
    "canonical_impossible_observable": "Only an observable pair has an observable canonical form.",
    "coordinates_given": "The new state is $T x$ with",
    "coordinates_back": "The old one is its product with",
    "coordinates_provided": "What follows holds for {condition}, where $T$ has an inverse.",
    "distinct_provided": "For generic parameter values these vectors are linearly independent. What follows holds for {condition}.",
    "structure_provided": "These are the dimensions for generic parameter values. In what follows we assume {condition}.",
}

QUESTIONS: dict[str, str] = {
    "means canonical_form": "The new state is $T x$.",
    "ask canonical_form": "Transform the plant to canonical form.",
    "ask canonical_form T": "Transform the plant to the coordinates $T x$.",
    "ask canonical_form kind=controllable": "Transform the plant to controllable canonical form.",
    "ask canonical_form kind=observable": "Transform the plant to observable canonical form.",
    "ask canonical_form kind=modal": "Transform the plant to real modal form.",
    "means decomposition": "The new state is $T x$.",
    "ask decomposition": "Find a Kalman decomposition of the plant, and the sizes of its four parts.",
}

DEMANDS: dict[str, str] = {
    "nothing_remains": "no_effect C A B",
}

RESTS_ON: dict[str, str] = {
    "last_row_controllable": "canonical_form",
    "last_column_observable": "canonical_form",
    "reached_and_hidden": "decomposition",
    "reached_alone": "decomposition",
    "hidden_alone": "decomposition",
}

THEOREMS: dict[str, str] = {
    "decomposition": "kalman1962; gilbert1963",
}

EXPLAINS = (
    "last_column_observable",
    "zero_pattern",
    "zero_block_reached",
    "zero_block_hidden",
)
