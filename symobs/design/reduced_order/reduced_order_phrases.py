"""The reduced-order observer."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "coordinates": "In the coordinates",
    "measured_first": "the measured states come first:",
    "measured_are_first": "In them the measured states come first:",
    "coordinates_assumed": "These are coordinates where {condition}; elsewhere other rows would have to complete $C$.",
    "parts": "Only {unmeasured} has to be estimated, since {measured} is measured. The plant falls into two parts,",
    "parts_blocks": "Only {unmeasured} has to be estimated, since {measured} is measured. Accordingly the matrices fall into the blocks",
    "parts_with_feedthrough_blocks": "Only {unmeasured} has to be estimated, since {measured} is known. Accordingly the matrices fall into the "
    "blocks",
    "two_parts": "and the plant into two parts,",
    "parts_with_feedthrough": "Only {unmeasured} has to be estimated, since {measured} is known. The plant falls into two parts,",
    "first_part_measures": "Yet everything in the first part except $x_2$ is known, so it is a measurement of $x_2$ through $A_12$. The pair "
    "($A_12$, $A_22$) is observable because ($C$, $A$) is§: {rank}.",
    "mere_copy": "A copy of the plant, corrected by its output error, is of no use here§: it takes $x_1$ from the measurement, so its output "
    "error is zero whatever the gain is, and the rest of the copy goes wrong by {left}.",
    "mere_copy_fails": "That does not even die out, since $A_22$ is not stable.",
    "mere_copy_grows": "That does not even die out, since $A_22$ has the <eigenvalue|eigenvalues> {roots}.",
    "undetermined_ansatz": "Let the estimate be {estimate}, with a state of its own, driven by what is known, whose matrices are still to be "
    "determined§:",
    "undetermined_error": "Then {error} obeys",
    "undetermined_choice": "It is to die out whatever state and input are. So both must go, which leaves no choice but",
    "undetermined_left": "and of the error there remains",
    "undetermined_matrices": "With this gain the matrices are",
    "rest_set_out": "What is not measured is estimated, as it was set out, by",
    "right_side_collected": "With this gain, and collected by its signals, the observer reads",
    "reduced_observer": "The observer copies the second part and corrects it by the first, as far as that measures $x_2$:",
    "with_gain_unknown": "Its gain still unknown, this is",
    "reduced_error": "Whatever the input, the error {error} then obeys",
    "with_unknown_gain": "With unknown entries of $L$ its characteristic polynomial is",
    "wanted_polynomial": "and is to become",
    "polynomial_is_to_be": "Its characteristic polynomial is to become",
    "one_of_several": "Several gains do that, because there are several outputs. One with short entries is",
    "compare": "Equal coefficients require",
    "hence_gain": "hence",
    "derivative_of_output": "The right-hand side of the observer contains the derivative of the output. It disappears if not the estimate itself "
    "but {state} is kept as the state:",
    "next_output": "The right-hand side of the observer contains the next output. It disappears if not the estimate itself but {state} is kept "
    "as the state:",
    "reduced_matrices": "With the output in place of $x_1$ its matrices are",
    "reduced_final": "and the observer is",
    "rest_estimated": "The estimate is found again from the definition of its state,",
    "assembled": "and the whole state is estimated by",
    "reduced_impossible": "The poles of $A_22 - L A_12$ are to be placed. No $L$ moves the <mode|modes> "
    "{modes}, and <it is not|they are not all> among the poles asked for: there is no such observer.",
    "outputs_dependent": "With {row} the product {vanishes}: one output is a combination of the others. Whatever rows complete $C$ to a square "
    "matrix, it has no inverse, and there is no such observer.",
    "reduced_all_fixed": "No $L$ moves the <mode|modes> {modes}, and <it is the pole|they are the poles> asked for: every gain serves, for example",
    "reduced_not_unique": "No $L$ moves the <mode|modes> {modes}, but <it is|they are> among the poles asked for. A gain that places the others is",
}

QUESTIONS: dict[str, str] = {
    "ask reduced_order_observer": "Design an observer of minimal order.",
    "ask reduced_order_observer poles": "Design an observer of minimal order with the poles {poles}.",
    "ask reduced_order_observer poles=1": "Design an observer of minimal order with the pole {poles}.",
    "ask reduced_order_observer polynomial": "Design an observer of minimal order with the characteristic polynomial {polynomial}.",
    "also reduced_order_observer T": "Use the coordinates $T x$.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "reduced_impossible": ("not_polynomial",),
    "reduced_not_unique": ("polynomial",),
    "reduced_all_fixed": ("polynomial",),
}

RESTS_ON: dict[str, str] = {
    "mere_copy": "first_attempt",
    "first_part_measures": "reduced_pair",
    "reduced_observer": "reduced_order",
    "undetermined_ansatz": "undetermined",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "reduced_order": ("reduced-order observer", "S0, (4.37)-(4.41)"),
    "reduced_pair": ("observability of the unmeasured part", "S0, Lemma 4.1"),
    "first_attempt": ("the reduced observer that no gain corrects", "S2"),
    "undetermined": ("conditions on the observer matrices", "S2"),
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
