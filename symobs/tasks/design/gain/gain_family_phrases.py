"""Several outputs (inputs): Sylvester's equation and the family of all gains."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "companion_of_wish": "The companion matrix of this polynomial is",
    "spectra_meet_observer": "It and the characteristic polynomial of $A$ have the <root|roots> {roots} in common, so that Sylvester's equation need not be solvable for every $G_o$. A preliminary gain removes <it|them>:",
    "spectra_meet_state_feedback": "It and the characteristic polynomial of $A$ have the <root|roots> {roots} in common, so that Sylvester's equation need not be solvable for every $G_c$. A preliminary gain removes <it|them>:",
    "spectra_parted": "A preliminary gain is split off,",
    "sylvester_observer": "For a matrix $G_o$ let $X_o$ be the solution of Sylvester's equation",
    "sylvester_state_feedback": "For a matrix $G_c$ let $X_c$ be the solution of Sylvester's equation",
    "similar_observer": "If $X_o$ is nonsingular, the following gain makes the transpose of $A - L C$ similar to $F_o$:",
    "similar_state_feedback": "If $X_c$ is nonsingular, the following gain makes $A - B K$ similar to $F_c$:",
    "one_row_held_observer": "Multiplying $G_o$ on the right by an invertible polynomial in $F_o$ leaves the gain unchanged, so that generically one of its rows, or one linear combination of rows, can be fixed:",
    "one_row_held_state_feedback": "Multiplying $G_c$ on the right by an invertible polynomial in $F_c$ leaves the gain unchanged, so that generically one of its rows, or one linear combination of rows, can be fixed:",
    "solution_is": "The solution of {equation:number} is then",
    "determinant_free": "where the free entries must be such that the determinant is nonzero,",
    "spectra_provided": "A unique solution exists for every right-hand side if and only if the two coefficient matrices have no common eigenvalue. For this method we assume {condition}.",
    "spectra_apart": "A unique solution exists for every right-hand side if and only if the two coefficient matrices have no common eigenvalue.",
    "solution_long": "for which the solution, too long to display, has the determinant",
    "solution_of_member": "for which the solution is",
    "one_gain_only_observer": "With a single output no freedom remains. The solution of {equation:number} is",
    "one_gain_only_state_feedback": "With a single input no freedom remains. The solution of {equation:number} is",
    "general_gain": "The general gain is",
    "dimension_observer": "The gains that place these poles form a family of dimension {count}, with the free entries of $G_o$ as parameters. Excluded are gains whose closed-loop matrix is not cyclic, and nongeneric ones for which that row cannot be fixed.",
    "dimension_state_feedback": "The gains that place these poles form a family of dimension {count}, with the free entries of $G_c$ as parameters. Excluded are gains whose closed-loop matrix is not cyclic, and nongeneric ones for which that row cannot be fixed.",
    "structured_gain": "We look for a gain of the following form:",
    "structured_wish": "The desired polynomial is the product",
    "equal_factors": "Equating the coefficients factor by factor gives",
    "others_observer": "Other gains place the same poles: they form a family of dimension {count}.",
    "others_state_feedback": "Other gains place the same poles: they form a family of dimension {count}.",
    "member_several": "A gain with simple entries is obtained for",
    "member_small": "A gain with small entries, near the placement whose eigenvectors are best conditioned§, is obtained for",
    "small_chosen_observer": "Several gains place these poles. We choose one with small entries, near the placement whose eigenvectors are best conditioned§. All of its columns but one are fixed at short numbers:",
    "small_chosen_state_feedback": "Several gains place these poles. We choose one with small entries, near the placement whose eigenvectors are best conditioned§. All of its rows but one are fixed at short numbers:",
    "small_left_observer": "The remaining column is the gain of the plant with a single output",
    "small_left_state_feedback": "The remaining row is the gain of the plant with a single input",
    "small_directions_observer": "Several gains place these poles. We choose one with small entries, near the placement whose eigenvectors are best conditioned§. Let",
    "small_directions_state_feedback": "Several gains place these poles. We choose one with small entries, near the placement whose eigenvectors are best conditioned§. Let",
    "small_solved_observer": "and let $Psi_o$ be a solution of the following equation, whose last matrix has the desired poles as eigenvalues:",
    "small_solved_state_feedback": "and let $Psi_c$ be a solution of the following equation, whose last matrix has the desired poles as eigenvalues:",
    "small_vectors_follow": "The gain is therefore",
    "small_alone": "A gain with small entries, near the placement whose eigenvectors are best conditioned§, is",
    "small_follows": "It is unique, and Ackermann's formula§ gives",
    "small_instead_observer": "An observer gain found without regard to size, in contrast, has an entry whose absolute value is at least {bound}.",
    "small_instead_state_feedback": "A feedback gain found without regard to size, in contrast, has an entry whose absolute value is at least {bound}.",
    "small_not_letters": "Small entries are chosen for numerical data only; with parameters the gain with simple entries is taken.",
    "small_not_hidden": "Small entries are chosen where no mode is fixed; here the gain with simple entries is taken.",
    "small_not_found": "No gain with small entries was found; one with simple entries is taken.",
    "small_not_repeated_observer": "Since {rank}, a pole has at most that many independent eigenvectors. One is desired more often, so that no gain is distinguished by well-conditioned eigenvectors, and the gain with simple entries is taken.",
    "small_not_repeated_state_feedback": "Since {rank}, a pole has at most that many independent eigenvectors. One is desired more often, so that no gain is distinguished by well-conditioned eigenvectors, and the gain with simple entries is taken.",
    "member_decoupled_observer": "The output errors are decoupled, each satisfying an equation of its own, by the gain obtained for",
    "alone_decoupled_observer": "The output errors are decoupled, each satisfying an equation of its own, by the gain",
    "member_decoupled_state_feedback": "The inputs are decoupled, each driving a separate subsystem, by the gain obtained for",
    "alone_decoupled_state_feedback": "The inputs are decoupled, each driving a separate subsystem, by the gain",
    "member_zero": "The prescribed entries are zero in the gain obtained for",
    "impossible_zero": "No gain with zero entries at {places} places these poles: equating the coefficients of the closed-loop polynomial to the desired ones gives equations for the remaining entries that have no common solution.",
    "impossible_zero_unless": "For generic parameter values no gain with zero entries at {places} places these poles: equating the coefficients of the closed-loop polynomial to the desired ones gives equations for the remaining entries that have a common solution only if {when} vanishes.",
    "impossible_zero_in_general": "For generic parameter values no gain with zero entries at {places} places these poles: equating the coefficients of the closed-loop polynomial to the desired ones gives equations that have a common solution for exceptional parameter values only.",
    "zero_in_root": "A gain with zero entries at {places} exists, but was not found in terms of rational numbers and square roots: its entries are polynomials in the real root between {low} and {high} of",
    "case_zero_gain": "In this case a gain with these zero entries is",
    "case_another_gain": "In this case a different gain places these poles:",
    "gain_provided": "Here we assume {condition}.",
    "case_no_zero": "In this case no such gain exists.",
    "gain_with_roots": "With the prescribed entries zero, equating the coefficients of the closed-loop polynomial to the desired ones gives equations for the remaining entries. A real solution is the gain",
    "undecided_zero": "No rational gain with zero entries at {places} was found; whether one exists is undecided.",
    "gain_follows": "The gain is",
    "no_member": "A gain with simple entries, whose closed-loop matrix is not cyclic, is",
    "family_hidden_observer": "The gain is not unique: {free} on the observable part; on the unobservable subspace {rest}.",
    "family_hidden_state_feedback": "The gain is not unique: {free} on the controllable part; on the uncontrollable modes {rest}.",
}

DEMANDS: dict[str, str] = {
    "small_instead_observer": "reaches L_s",
    "small_instead_state_feedback": "reaches K_s",
    "spectra_meet_observer": "shared_roots A phi_o",
    "spectra_meet_state_feedback": "shared_roots A phi_c",
    "dimension_observer": "dimension C A",
    "family_hidden_observer": "free_parts C A",
    "others_observer": "dimension C A",
    "others_state_feedback": "dimension Bᵀ Aᵀ",
    "dimension_state_feedback": "dimension Bᵀ Aᵀ",
    "family_hidden_state_feedback": "free_parts Bᵀ Aᵀ",
    "one_gain_only_observer": "single C",
    "one_gain_only_state_feedback": "single Bᵀ",
    "impossible_zero": "no_gain",
    "impossible_zero_unless": "no_gain",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "small_not_repeated_observer": ("polynomial",),
    "small_not_repeated_state_feedback": ("polynomial",),
}

RESTS_ON: dict[str, str] = {
    "member_small": "conditioned",
    "small_chosen_observer": "conditioned",
    "small_directions_observer": "conditioned",
    "small_directions_state_feedback": "conditioned",
    "small_alone": "conditioned",
    "small_chosen_state_feedback": "conditioned",
    "small_follows": "ackermann",
    "sylvester_observer": "sylvester",
    "sylvester_state_feedback": "sylvester",
}

THEOREMS: dict[str, str] = {
    "conditioned": "kautsky1985",
    "sylvester": "bhattacharyya1982",
}

NAMING = ("impossible_zero_unless",)

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "determinant_free",
    "small_solved_observer",
    "small_solved_state_feedback",
    "solution_long",
    "solution_of_member",
)
