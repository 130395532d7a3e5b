"""The unknown-input observer."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "unknown_input_observer": "Unknown-input observer.",
    "cases_uio": "Special cases, in which the fixed modes are the invariant zeros of the plant from the unknown input to the output:",
    "row_not_decoupled": "none, since $H_d C E_d = E_d$ has no solution $H_d$",
    "row_converges": "of these poles",
    "row_diverges": "whose error converges",
    "uio_independent": "The columns of $E_d$ are linearly dependent, {rank}. Independent ones are those of",
    "uio_seen": "Such an observer requires that $C E_d$ and $E_d$ have the same rank§. Here",
    "uio_provided": "What follows holds for {condition}.",
    "uio_decoupled": "Here {rank}.",
    "uio_output_matrix": "A solution of $H_d C E_d = E_d$ is",
    "uio_nothing": "There is no unknown input to decouple from, so we take",
    "uio_projection": "With it we obtain",
    "uio_not_decoupled": "Since {unseen} whereas {nonzero}, the ranks of $C E_d$ and $E_d$ differ. No matrix $H$ therefore satisfies $H C E_d = E_d$, and no such observer exists§.",
    "uio_direction": "For the direction",
    "uio_not_decoupled_along": "of the unknown input we obtain {unseen} whereas {nonzero}, so that the ranks of $C E_d$ and $E_d$ differ. No matrix $H$ therefore satisfies $H C E_d = E_d$, and no such observer exists§.",
    "uio_observable": "The pair ($C$, $A_T$) is observable, {rank}: the plant has no invariant zeros from the unknown input to the output, and all poles of the observer can be assigned§.",
    "uio_zeros_desired": "The invariant <zero|zeros> {zeros} of the plant from the unknown input to the output <is an unobservable mode|are unobservable modes> of ($C$, $A_T$)§, hence <a pole|poles> of every such observer; <it is|they are> among the desired ones.",
    "uio_impossible": "The invariant <zero|zeros> {zeros} of the plant from the unknown input to the output <is an unobservable mode|are unobservable modes> of ($C$, $A_T$)§, hence <a pole|poles> of every such observer; <it is not|they are not all> among the desired ones, so no such observer has these poles.",
    "uio_unassignable": "The factor {fixed} of the characteristic polynomial of $A_T - L C$ is the same for every $L$, and the division of {polynomial} by it leaves the remainder {rest}: an observer with these poles exists only where this remainder is the zero polynomial.",
    "uio_zeros_stable": "Since no zero of the plant from the unknown input to the output is unstable, an observer with a convergent error exists; its poles include the zeros.",
    "uio_zeros_unstable": "Since the plant has an unstable zero from the unknown input to the output, no observer of this kind has an error that converges.",
    "uio_gain": "The design of an observer gain for this pair gives",
    "uio_state_matrix": "so that the matrices of the observer are",
    "uio_family": "The gain is not unique: other gains assign the same polynomial.",
    "uio_observer": "The observer is therefore",
    "uio_error": "Irrespective of the unknown input, the estimation error {error} satisfies",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "uio_zeros_desired": ("polynomial",),
    "uio_impossible": ("not_polynomial",),
    "uio_unassignable": ("strictly_proper",),
    "uio_zeros_stable": ("stable",),
    "uio_zeros_unstable": ("unstable",),
}

QUESTIONS: dict[str, str] = {
    "means unknown_input_observer": "Here $H_d C E_d = E_d$, and $L$ is a gain for the pair ($C$, $A - H_d C A$).",
    "ask unknown_input_observer": "Design an observer whose estimation error does not depend on the unknown input.",
    "ask unknown_input_observer poles": "Design an observer with the poles {poles} whose estimation error does not depend on the unknown input.",
    "ask unknown_input_observer polynomial": "Design an observer with the characteristic polynomial {polynomial} whose estimation error does not depend on the unknown input.",
    "also unknown_input_observer E": "The term $E_d d$ with the unknown input $d$ is added to the state equation.",
}

#: In a table of special cases: what goes before it, and the answer in a row.
ROWS: dict[str, str] = {
    "uio_not_decoupled": "cases_uio row_not_decoupled",
    "uio_not_decoupled_along": "cases_uio row_not_decoupled",
    "uio_direction": "cases_uio uio_direction",
    "uio_observable": "cases_uio row_other",
    "uio_zeros_desired": "cases_uio row_other",
    "uio_impossible": "cases_uio row_no",
    "uio_zeros_stable": "cases_uio row_converges",
    "uio_zeros_unstable": "cases_uio row_diverges",
}

DEMANDS: dict[str, str] = {
    "uio_decoupled": "one_rank C E_d",
    "uio_not_decoupled": "lower_rank C E_d",
    "uio_not_decoupled_along": "lower_rank C E_d",
    "uio_observable": "says_observable_everywhere C A_T",
    "uio_zeros_desired": "fixes C A_T N X phi_o",
    "uio_impossible": "fixes C A_T N X phi_o",
    "uio_unassignable": "fixes C A_T N X phi_o",
    "uio_zeros_stable": "modes_stable C A_T N X mu",
    "uio_zeros_unstable": "modes_unstable C A_T N X mu",
    "uio_family": "not_unique C A_T",
}

RESTS_ON: dict[str, str] = {
    "uio_seen": "unknown_input",
    "uio_not_decoupled": "unknown_input",
    "uio_not_decoupled_along": "unknown_input",
    "uio_observable": "unknown_input_zeros",
    "uio_zeros_desired": "unknown_input_zeros",
    "uio_impossible": "unknown_input_zeros",
}

THEOREMS: dict[str, str] = {
    "unknown_input": "hautus1983; darouach1994",
    "unknown_input_zeros": "hautus1983; darouach1994",
}

#: Phrases that go on with the sentence before them.
CONTINUES = ("uio_state_matrix", "uio_not_decoupled_along", "row_not_decoupled", "row_converges", "row_diverges")
