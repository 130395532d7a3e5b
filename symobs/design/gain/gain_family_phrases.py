"""Several outputs (inputs): Sylvester's equation and the family of all gains."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "companion_of_wish": "The companion matrix of this polynomial is",
    "spectra_meet": "It has roots in common with the characteristic polynomial of the plant. A fixed gain is therefore taken out first,",
    "sylvester_observer": "For a matrix $G_o$ let $X_o$ be the solution of Sylvester's equation",
    "sylvester_state_feedback": "For a matrix $G_c$ let $X_c$ be the solution of Sylvester's equation",
    "similar_observer": "Where $X_o$ is regular, the gain that follows makes the transpose of $A - L C$ similar to $F_o$:",
    "similar_state_feedback": "Where $X_c$ is regular, the gain that follows makes $A - B K$ similar to $F_c$:",
    "one_row_held_observer": "A polynomial in $F_o$ may be multiplied to $G_o$ from the right without changing the gain, so in general one row of it, or one combination of rows, can be held:",
    "one_row_held_state_feedback": "A polynomial in $F_c$ may be multiplied to $G_c$ from the right without changing the gain, so in general one row of it, or one combination of rows, can be held:",
    "solution_is": "The solution of the equation is then",
    "determinant_free": "where the free entries must not make the determinant vanish,",
    "spectra_provided": "There is one, whatever stands on the right, where the two square matrices beside the unknown one have no eigenvalue in common. For this way to the gain we assume {condition}.",
    "spectra_apart": "There is one, whatever stands on the right, where the two square matrices beside the unknown one have no eigenvalue in common.",
    "solution_long": "for which the solution, too long to be written out, has the determinant",
    "solution_of_member": "for which the solution is",
    "one_gain_only": "For one output (input) nothing is left free. The solution of the equation is",
    "general_gain": "All the others are",
    "dimension_observer": "The gains that place these poles form a family of dimension {count}: the gain determines every free entry of $G_o$. Left out are gains whose closed-loop matrix is not cyclic, and special ones for which that row cannot be held.",
    "dimension_state_feedback": "The gains that place these poles form a family of dimension {count}: the gain determines every free entry of $G_c$. Left out are gains whose closed-loop matrix is not cyclic, and special ones for which that row cannot be held.",
    "member_several": "A gain with short entries belongs to",
    "member_decoupled_observer": "The output errors are decoupled, each obeying an equation of its own, by the gain that belongs to",
    "alone_decoupled_observer": "The output errors are decoupled, each obeying an equation of its own, by the gain",
    "member_decoupled_state_feedback": "The inputs are decoupled, each driving a part of its own, by the gain that belongs to",
    "alone_decoupled_state_feedback": "The inputs are decoupled, each driving a part of its own, by the gain",
    "member_zero": "The entries asked for are zero in the gain that belongs to",
    "impossible_zero": "With zeros in the places {places} of the gain these poles cannot be placed: the coefficients of the closed-loop polynomial, "
    "equated to those asked for, are equations for the other entries that have no common solution.",
    "impossible_zero_unless": "With zeros in the places {places} of the gain these poles cannot be placed in general: the coefficients of the "
    "closed-loop polynomial, equated to those asked for, are equations for the other entries that have a common solution only where {when} vanishes.",
    "impossible_zero_in_general": "With zeros in the places {places} of the gain these poles cannot be placed in general: the coefficients of the "
    "closed-loop polynomial, equated to those asked for, have a common solution for special parameters only.",
    "zero_in_root": "A gain with zeros in the places {places} exists, but neither fractions nor square roots that were tried write it: its entries are "
    "polynomials in the real root between {low} and {high} of",
    "case_zero_gain": "There a gain has its zeros in these places:",
    "case_another_gain": "There another gain places these poles:",
    "gain_provided": "Here we assume {condition}.",
    "case_no_zero": "There is no such gain.",
    "gain_with_roots": "With zeros in the places asked for the coefficients of the closed-loop polynomial, equated to those asked for, are equations for the "
    "other entries. A real solution is the gain",
    "undecided_zero": "No gain with rational entries and zeros in the places {places} was found, and it is not proved that there is none.",
    "gain_follows": "The gain is",
    "no_member": "A gain with short entries, whose closed-loop matrix is not cyclic, is",
    "family_hidden_observer": "It is not the only one. The gains form a family of dimension {count}: the part that is seen has the freedom of "
    "Sylvester's equation, and along the hidden subspace the gain is free.",
    "family_hidden_state_feedback": "It is not the only one. The gains form a family of dimension {count}: the part that the input moves has the "
    "freedom of Sylvester's equation, and along the directions that it never moves the gain is free.",
}

RESTS_ON: dict[str, str] = {
    "sylvester_observer": "sylvester",
    "sylvester_state_feedback": "sylvester",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "sylvester": (
        "pole assignment by Sylvester's equation",
        "S. P. Bhattacharyya and E. de Souza, Systems & Control Letters 1 (1982), 261-263",
    ),
}

NAMING = ("impossible_zero_unless",)
