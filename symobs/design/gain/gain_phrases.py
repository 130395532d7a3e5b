"""State feedback and observer gains."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "assignable_observer": "By the pole assignment theorem§ the poles of $A - L C$ can therefore be placed at will.",
    "assignable_state_feedback": "By the pole assignment theorem§ the poles of $A - B K$ can therefore be placed at will.",
    "asks_observer": "The observer poles ask for",
    "asks_state_feedback": "The control poles ask for",
    "coefficients": "with the coefficients",
    "already_canonical": "The pair ($A$, $B$) is already in controllable canonical form, with {chi}, so the gain is the difference of "
    "coefficients, constant first.",
    "open_observer": "We place them for the dual pair ($Aᵀ$, $Cᵀ$)§, whose controllability matrix is $Oᵀ$ and whose characteristic polynomial is",
    "open_state_feedback": "The characteristic polynomial of $A$ is",
    "canonical_observer": "The dual pair is brought to controllable canonical form§ by",
    "canonical_state_feedback": "The pair is brought to controllable canonical form§ by",
    "row_observer": "There the gain is the row of differences of coefficients, constant first. Carried back it is",
    "row_state_feedback": "There the gain is the row of differences of coefficients, constant first. Carried back it is",
    "unknown_gain": "The gain is taken with unknown entries,",
    "polynomial_of_unknown": "and with them the polynomial is",
    "equal_coefficients": "Its coefficients are to be those of the polynomial asked for:",
    "linear_system": "This is a system of linear equations,",
    "solution_of_system": "whose solution is",
    "companion_vector_observer": "The last row of the inverse of the controllability matrix of the dual pair ($Aᵀ$, $Cᵀ$) is, as a column,",
    "companion_vector_state_feedback": "The last row of the inverse of the controllability matrix is",
    "companion_rows": "With its images as rows,",
    "companion_reached": "the pair is brought to companion form:",
    "open_eigenvalues_observer": "Without the gain the error would have the <eigenvalue|eigenvalues> {roots} of $A$.",
    "open_eigenvalues_state_feedback": "Without the gain the plant has the <eigenvalue|eigenvalues> {roots}.",
    "null_vectors_observer": "For each pole a null vector of a matrix is wanted§: its upper part becomes an eigenvector of the transpose of $A - L C$ "
    "when the gain takes it to the lower part.",
    "null_vectors_state_feedback": "For each pole a null vector of a matrix is wanted§: its upper part becomes an eigenvector of $A - B K$ when the gain "
    "takes it to the lower part.",
    "pole_reduced": "For the pole {pole} the matrix and its row-reduced echelon form are",
    "pair_reduced": "For the conjugate pair that belongs to the factor {pole} the real matrix and its row-reduced echelon form are",
    "factor_reduced": "For the factor {pole}, whose companion matrix stands for its roots, the matrix and its row-reduced echelon form are",
    "generalised": "A further independent null vector does not exist for {pole}, which is asked for again: the vector before it goes, with the "
    "opposite sign, to the right side, and the row-reduced echelon form is",
    "relations_read_off": "From it are read off, for the components of a null vector,",
    "free_chosen": "What is free is chosen:",
    "vectors_chosen": "With a choice of what is free, and the upper parts before the lower ones, this gives",
    "upper_parts": "The upper parts of these vectors, and the lower ones, are the columns of",
    "with_determinant": "with the determinant",
    "row_reduced_observer": "The gain takes each upper part to its lower part:",
    "row_reduced_state_feedback": "The gain takes each upper part to its lower part:",
    "row_reduced_unique_observer": "The gain takes each upper part to its lower part. There is one output, so no other gain places these poles, "
    "and what was chosen for the free components cancels:",
    "row_reduced_unique_state_feedback": "The gain takes each upper part to its lower part. There is one input, so no other gain places these "
    "poles, and what was chosen for the free components cancels:",
    "in_decimals": "In decimals this is",
    "rounded_too_early": "The fractions are kept to the end with reason. Had the columns been rounded first, the product of $f_psi$ with the inverse would have been",
    "last_column": "Ackermann's formula§ takes the last column of the inverse of the observability matrix,",
    "last_row": "Ackermann's formula§ takes the last row of the inverse of the controllability matrix,",
    "gain_stated": "A gain that assigns it is",
    "ackermann_observer": "and puts $A$ into the polynomial asked for:",
    "ackermann_state_feedback": "and puts $A$ into the polynomial asked for:",
    "as_required": "{check}, as required.",
    "roots_as_required": "{check}, with the <root|roots> {roots}, as required.",
    "fixed_but_wanted_observer": "No gain moves the unobservable <mode|modes> {roots}, but <it is|they are> among the poles asked for.",
    "fixed_but_wanted_state_feedback": "No gain moves the uncontrollable <mode|modes> {roots}, but <it is|they are> among the poles asked for.",
    "one_gain_observer": "A gain that places the others is",
    "one_gain_state_feedback": "A gain that places the others is",
    "no_others_observer": "There are no others to place, so every gain serves, for example",
    "no_others_state_feedback": "There are no others to place, so every gain serves, for example",
    "family_observer": "It is not the only one: all of them are {gain}.",
    "family_state_feedback": "It is not the only one: all of them are {gain}.",
    "impossible_observer": "Every gain leaves the factor {fixed} in the polynomial of $A - L C$, and this factor does not divide "
    "{polynomial}: no gain places these poles.",
    "impossible_state_feedback": "Every gain leaves the factor {fixed} in the polynomial of $A - B K$, and this factor does not divide "
    "{polynomial}: no gain places these poles.",
    "gain_given_observer": "The observer gain is given,",
    "gain_given_state_feedback": "The feedback gain is given,",
    "closed_matrix": "which makes",
    "its_polynomial": "The characteristic polynomial is",
    "case_survives_observer": "There the pair ($C$, $A$) is not observable, but its fixed <mode|modes> {modes} <is|are> among the poles asked for, so this $L$ "
    "still works; it is no longer the only one.",
    "case_survives_state_feedback": "There the pair ($A$, $B$) is not controllable, but its fixed <mode|modes> {modes} <is|are> among the poles asked for, "
    "so this $K$ still works; it is no longer the only one.",
    "case_same_observer": "There the pair ($C$, $A$) is not observable, but its fixed <mode|modes> {modes} <is|are> among the poles asked for, so this "
    "$L$ still works.",
    "case_same_state_feedback": "There the pair ($A$, $B$) is not controllable, but its fixed <mode|modes> {modes} <is|are> among the poles asked "
    "for, so this $K$ still works.",
    "case_other_observer": "There the pair ($C$, $A$) is not observable, but its fixed <mode|modes> {modes} <is|are> among the poles asked for. A gain that "
    "works there is",
    "case_other_state_feedback": "There the pair ($A$, $B$) is not controllable, but its fixed <mode|modes> {modes} <is|are> among the poles asked for. "
    "A gain that works there is",
    "case_no_observer": "There the pair ($C$, $A$) is not observable, and its fixed <mode|modes> {modes} <is not|are not all> among the poles asked for: no gain "
    "places them.",
    "case_no_state_feedback": "There the pair ($A$, $B$) is not controllable, and its fixed <mode|modes> {modes} <is not|are not all> among the poles asked for: no "
    "gain places them.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "fixed_but_wanted_observer": ("polynomial",),
    "case_survives_observer": ("polynomial",),
    "case_same_observer": ("polynomial",),
    "case_other_observer": ("polynomial",),
    "case_no_observer": ("not_polynomial",),
    "impossible_observer": ("not_polynomial",),
    "fixed_but_wanted_state_feedback": ("polynomial",),
    "case_survives_state_feedback": ("polynomial",),
    "case_same_state_feedback": ("polynomial",),
    "case_other_state_feedback": ("polynomial",),
    "case_no_state_feedback": ("not_polynomial",),
    "impossible_state_feedback": ("not_polynomial",),
}

RESTS_ON: dict[str, str] = {
    "null_vectors_observer": "row_reduction",
    "null_vectors_state_feedback": "row_reduction",
    "companion_rows": "companion_form",
    "assignable_observer": "observer_poles",
    "assignable_state_feedback": "state_feedback_poles",
    "open_observer": "duality",
    "canonical_observer": "canonical_form",
    "canonical_state_feedback": "canonical_form",
    "already_canonical": "canonical_form",
    "last_column": "ackermann",
    "last_row": "ackermann",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "observer_poles": ("pole assignment for observers", "S0, Theorem 4.4"),
    "row_reduction": ("row-reduced echelon method", "S3, (7)-(10)"),
    "companion_form": ("placement through companion form", "S1, slide at 16:01"),
}

EXPLAINS = (
    "open_eigenvalues_observer",
    "open_eigenvalues_state_feedback",
    "assignable_observer",
    "assignable_state_feedback",
    "already_canonical",
    "null_vectors_observer",
    "null_vectors_state_feedback",
    "row_observer",
    "row_state_feedback",
    "row_reduced_observer",
    "row_reduced_state_feedback",
)

SPELLS_OUT = ("coefficients",)
