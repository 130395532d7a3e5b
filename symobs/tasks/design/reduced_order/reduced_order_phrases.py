"""The reduced-order observer."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "coordinates": "In the coordinates",
    "measured_first": "the measured states come first:",
    "measured_are_first": "In them the measured states come first:",
    "coordinates_assumed": "This is a change of coordinates provided that {condition}; otherwise $C$ must be completed by other rows.",
    "parts": "Since {measured} is measured, only {unmeasured} has to be estimated. The plant equations separate into",
    "parts_blocks": "Since {measured} is measured, only {unmeasured} has to be estimated. Partitioned accordingly, the matrices are",
    "parts_with_feedthrough_blocks": "Since {measured} is known, only {unmeasured} has to be estimated. Partitioned accordingly, the matrices are",
    "two_parts": "and the plant equations become",
    "parts_with_feedthrough": "Since {measured} is known, only {unmeasured} has to be estimated. The plant equations separate into",
    "first_part_measures": "In the first equation everything except $x_2$ is known, so it serves as a measurement of $x_2$ through $A_12$. The pair ($A_12$, $A_22$) is observable because ($C$, $A$) is§: {rank}.",
    "mere_copy": "A copy of the plant with output-error correction does not work here: since $x_1$ is taken from the measurement, the output error is zero for every gain, and the error of the other component evolves uncorrected: {left}.",
    "mere_copy_fails": "This error does not decay, since $A_22$ is not stable.",
    "mere_copy_grows": "This error does not decay, since $A_22$ has the <eigenvalue|eigenvalues> {roots}.",
    "undetermined_ansatz": "Let the estimate be {estimate}, where the observer state is driven by the known signals and the matrices are to be determined§:",
    "undetermined_error": "The error {error} then satisfies",
    "undetermined_choice": "For the error to decay irrespective of state and input, the coefficients of both must vanish, which requires",
    "undetermined_left": "and the error dynamics reduce to",
    "undetermined_matrices": "With this gain the matrices are",
    "rest_set_out": "The unmeasured states are estimated, as assumed above, by",
    "right_side_collected": "With this gain, collecting terms, we obtain the observer",
    "reduced_observer": "The observer is a copy of the second equation, corrected by the first, which acts as a measurement of $x_2$:",
    "with_gain_unknown": "With the gain still unknown, this is",
    "reduced_error": "Irrespective of the input, the estimation error {error} satisfies",
    "with_unknown_gain": "With unknown entries of $L$, its characteristic polynomial is",
    "wanted_polynomial": "which is to be equal to the desired polynomial",
    "polynomial_is_to_be": "Its desired characteristic polynomial is",
    "form_of_several": "With several outputs the gain is not unique. We look for one of the following form:",
    "one_of_several": "With several outputs the gain is not unique. One with simple entries is",
    "compare": "Equating coefficients gives",
    "hence_gain": "hence",
    "derivative_of_output": "The right-hand side of the observer contains the derivative of the output. It is eliminated by taking {state} as the observer state in place of the estimate:",
    "next_output": "The right-hand side of the observer contains the output one step ahead. It is eliminated by taking {state} as the observer state in place of the estimate:",
    "reduced_matrices": "With $x_1$ replaced by the output, the observer matrices are",
    "reduced_final": "and the observer is",
    "rest_estimated": "The estimate is recovered from the observer state by",
    "assembled": "and the estimate of the full state is",
    "reduced_impossible": "The eigenvalues of $A_22 - L A_12$ are to be placed. No $L$ moves the <mode|modes> {modes}, and <it is not|they are not all> among the desired poles: no such observer exists.",
    "reduced_unassignable": "The eigenvalues of $A_22 - L A_12$ are to be placed. The factor {fixed} of its characteristic polynomial is the same for every $L$, and the division of {polynomial} by it leaves the remainder {rest}: such an observer exists only where this remainder is the zero polynomial.",
    "outputs_dependent": "With {row} the product {vanishes}: one output is a linear combination of the others. No rows complete $C$ to an invertible matrix, so no such observer exists.",
    "reduced_all_fixed": "No $L$ moves the <mode|modes> {modes}, and <it is the desired pole|they are the desired poles>: any gain will do, for example",
    "reduced_not_unique": "No $L$ moves the <mode|modes> {modes}, but <it is|they are> among the desired poles. A gain that places the remaining poles is",
}

QUESTIONS: dict[str, str] = {
    "means reduced_order_observer": "The estimate of the state is $x_hat = M_z [y; z_o]$, where the input does not act on the output.",
    "ask reduced_order_observer": "Design a reduced-order observer.",
    "ask reduced_order_observer poles": "Design a reduced-order observer with the poles {poles}.",
    "ask reduced_order_observer poles=1": "Design a reduced-order observer with the pole {poles}.",
    "ask reduced_order_observer polynomial": "Design a reduced-order observer with the characteristic polynomial {polynomial}.",
    "also reduced_order_observer T": "Use the coordinates $T x$.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "reduced_unassignable": ("strictly_proper",),
    "reduced_impossible": ("not_polynomial",),
    "reduced_not_unique": ("polynomial",),
    "reduced_all_fixed": ("polynomial",),
}

DEMANDS: dict[str, str] = {
    "first_part_measures": "says_observable_everywhere A_12 A_22",
    "mere_copy_fails": "spectrum A_22",
    "mere_copy_grows": "eigenvalues_of A_22, spectrum A_22",
    "outputs_dependent": "annuls w_0 C",
    "reduced_impossible": "fixes A_12 A_22 N_2 X_2 phi_o",
    "reduced_unassignable": "fixes A_12 A_22 N_2 X_2 phi_o",
    "reduced_not_unique": "fixes A_12 A_22 N_2 X_2 phi_o",
    "reduced_all_fixed": "fixes A_12 A_22 N_2 X_2 phi_o, exhausts A_12 A_22 N_2 X_2 phi_o",
    "form_of_several": "not_unique A_12 A_22",
    "one_of_several": "not_unique A_12 A_22",
}

RESTS_ON: dict[str, str] = {
    "first_part_measures": "reduced_pair",
    "reduced_observer": "reduced_order",
    "undetermined_ansatz": "undetermined",
}

THEOREMS: dict[str, str] = {
    "reduced_order": "luenberger1971; gopinath1971",
    "reduced_pair": "gopinath1971",
    "undetermined": "luenberger1971",
}

OPENS = (
    "reduced_observer",
    "undetermined_ansatz",
    "derivative_of_output",
    "next_output",
    "parts",
    "parts_with_feedthrough",
)

EXPLAINS = (
    "first_part_measures",
    "mere_copy",
    "mere_copy_fails",
    "mere_copy_grows",
)

SPELLS_OUT = (
    "coordinates",
    "measured_first",
    "measured_are_first",
    "parts",
    "parts_blocks",
    "parts_with_feedthrough",
    "parts_with_feedthrough_blocks",
)

FIGURES: dict[str, dict[str, object]] = {
    "minimal_order_observer": {
        "grid": """
        y  b  .  .  .   .  .  .
        .  .  H  .  .   .  .  .
        u  .  G  j  ∫z  a  M  x
        .  .  .  .  F   .  .  .
        """,
        "routes": (
            "y > b -| M",
            "u > G > j > ∫z > a > M > x",
            "b |- H -| j",
            "a |- F -| j",
        ),
        "signals": {"u": "u", "y": "y", "x": "x_hat", "z": "z_o"},
        "optional": ("G",),
    },
    "minimal_order_feedthrough": {
        "grid": """
        y  e  b  .  .  .   .  .  .
        .  D  .  H  .  .   .  .  .
        u  c  .  G  j  ∫z  a  M  x
        .  .  .  .  .  F   .  .  .
        """,
        "routes": (
            "y > e > b -| M",
            "u > c > G > j > ∫z > a > M > x",
            "c > D > e",
            "b |- H -| j",
            "a |- F -| j",
        ),
        "signals": {"u": "u", "y": "y", "x": "x_hat", "z": "z_o"},
    },
}

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "measured_first",
    "two_parts",
    "undetermined_left",
    "wanted_polynomial",
    "hence_gain",
    "reduced_final",
    "assembled",
)
