"""Several outputs (inputs): Sylvester's equation and the family of all gains."""

from __future__ import annotations

_SIDES = (("observer", "o"), ("state_feedback", "c"))

PHRASES: dict[str, str] = {
    "companion_of_wish": "The companion matrix of this polynomial is",
    "spectra_meet": "It has roots in common with the characteristic polynomial of the plant. A fixed gain is therefore taken out first,",
    "sylvester_observer": "For a matrix $G_o$ let $X_o$ be the solution of Sylvester's equation",
    "sylvester_state_feedback": "For a matrix $G_c$ let $X_c$ be the solution of Sylvester's equation",
    "similar_observer": "Where $X_o$ is regular, the gain that follows makes the transpose of $A - L C$ similar to $F_o$:",
    "similar_state_feedback": "Where $X_c$ is regular, the gain that follows makes $A - B K$ similar to $F_c$:",
    **{
        f"one_row_held_{kind}": f"A polynomial in $F_{side}$ may be multiplied to $G_{side}$ from the right without changing the gain, so in general one "
        "row of it, or one combination of rows, can be held:"
        for kind, side in _SIDES
    },
    "solution_is": "The solution of the equation is then",
    "determinant_free": "where the free entries must not make the determinant vanish,",
    "spectra_provided": "There is one, whatever stands on the right, where the two square matrices beside the unknown one have no eigenvalue in common. For this way to the gain we assume {condition}.",
    "spectra_apart": "There is one, whatever stands on the right, where the two square matrices beside the unknown one have no eigenvalue in common.",
    "solution_long": "for which the solution, too long to be written out, has the determinant",
    "solution_of_member": "for which the solution is",
    "one_gain_only": "For one output (input) nothing is left free. The solution of the equation is",
    "general_gain": "All the others are",
    **{
        f"dimension_{kind}": "The gains that place these poles form a family of dimension {count}: the gain determines every free entry of "
        f"$G_{side}$. Left out are gains whose closed-loop matrix is not cyclic, and special ones for which that row cannot be held."
        for kind, side in _SIDES
    },
    "member_several": "A gain with short entries belongs to",
    **{
        f"{where}_decoupled_{kind}": f"{what}{end}"
        for kind, what in (
            ("observer", "The output errors are decoupled, each obeying an equation of its own, by the gain"),
            ("state_feedback", "The inputs are decoupled, each driving a part of its own, by the gain"),
        )
        for where, end in (("member", " that belongs to"), ("alone", ""))
    },
    **{
        f"{where}_smallest_{kind}": f"The smallest sum of squares of its entries has the gain{end}"
        for kind in ("observer", "state_feedback")
        for where, end in (("member", " that belongs to"), ("alone", ""))
    },
    "smallest_zero_observer": "Many gains place these poles; the one with the smallest sum of squares of its entries is wanted. They are the eigenvalues "
    "of $A$ already, so that no gain is needed, and none has a smaller sum than",
    "smallest_zero_state_feedback": "Many gains place these poles; the one with the smallest sum of squares of its entries is wanted. They are the "
    "eigenvalues of $A$ already, so that no gain is needed, and none has a smaller sum than",
    "smallest_wanted_observer": "Many gains place these poles; the one with the smallest sum of squares of its entries is wanted. Let $entries_g$ be the "
    "entries of $L$, one column under the other. Lagrange's method adds to their squares the coefficients of the difference between the polynomial of "
    "the error and the one asked for, each times a multiplier; where the sum is stationary and the coefficients vanish, the gain may be the smallest.",
    "smallest_wanted_state_feedback": "Many gains place these poles; the one with the smallest sum of squares of its entries is wanted. Let $entries_g$ be "
    "the entries of $K$, one row transposed under the other. Lagrange's method adds to their squares the coefficients of the difference between the "
    "closed-loop polynomial and the one asked for, each times a multiplier; where the sum is stationary and the coefficients vanish, the gain may be the "
    "smallest.",
    **{
        f"smallest_stationary_{kind}": f"The pair is {able} and the polynomial asked for has no multiple root: every matrix with this polynomial is "
        "cyclic, the derivatives of the coefficients are independent, and Lagrange's equations hold for the smallest gain, which exists. They have "
        "finitely many solutions. The sums of squares at all of them are eigenvalues of one matrix."
        for kind, able in (("observer", "observable"), ("state_feedback", "controllable"))
    },
    "smallest_sum": "The least positive eigenvalue of that matrix is a root of",
    "smallest_sum_of_gain": "No other gain is smaller, since the sum of the squares of the entries of this one is that least eigenvalue:",
    "smallest_root": "The solution is made of a root of a polynomial,",
    "smallest_long": "The entries of the gain are polynomials in this root, too long to be written out,",
    "smallest_long_with_roots": "The entries of the gain are polynomials in this root and one square root, too long to be written out,",
    "smallest_multipliers": "The multipliers are",
    "smallest_deviation_observer": "No other gain is smaller. For any matrix $Delta_g$, $entries_D$ its entries, let $d_1$, $d_2$, … be what a change of the gain "
    "by it adds to the coefficients:",
    "smallest_deviation_state_feedback": "No other gain is smaller. For any matrix $Delta_g$, $entries_D$ its entries, let $d_1$, $d_2$, … be what a change of the "
    "gain by it adds to the coefficients:",
    "smallest_matrix": "With the matrix",
    "smallest_identity": "it is true for every $Delta_g$ that",
    "smallest_rising": "Here",
    "smallest_identity_of_derivatives": "With the matrix $Q_g$ of half the second derivatives of the left side it is true for every $Delta_g$ that",
    "smallest_proved": "The matrix $Q_g$ is symmetric, and no coefficient of the determinant of $s I + Q_g$ is negative, so $Q_g$ has no negative eigenvalue. Of a gain with the poles asked for all of $d_1$, $d_2$, … vanish; the sum of the squares of its entries is therefore that of the gain above and something that is not negative.",
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

NAMING = ("impossible_zero_unless",)

ASSERTS: dict[str, tuple[str, ...]] = {"smallest_proved": ("no_negative_coefficient",)}

SPELLS_OUT = ("smallest_root", "smallest_sum")

RESTS_ON: dict[str, str] = {
    "sylvester_observer": "sylvester",
    "sylvester_state_feedback": "sylvester",
}
