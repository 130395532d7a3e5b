"""Time-varying plants."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "transition": "Transition matrix.",
    "time_varying_gramian": "Output and Gramian.",
    "time_varying_rank": "Rank test.",
    "reconstruction": "Initial state.",
    "on_interval": "The interval of time runs from {start} to {end}.",
    "output_given": "The output is",
    "input_given": "the input is",
    "transition_nilpotent": "Without input the state is $x = Phi x_0$. The matrix $A$ commutes with its integral, {commutes}, where",
    "transition_exponential": "so that $Phi$ is the exponential of $M$. Since {power}, its series ends:",
    "peano_baker": "Without input the state is $x = Phi x_0$. The Peano-Baker series of $Phi$ ends here: its terms after the first are",
    "peano_baker_sum": "each the integral of $A$ times the one before, and {end}. Their sum is",
    "transition_constant": "Without input the state is $x = Phi x_0$. Since {zero}, it stays where it is:",
    "transition_triangular": "Without input the state is $x = Phi x_0$. The equations can be solved one after the other, by variation of "
    "constants:",
    "transition_direction": "Without input the state is $x = Phi x_0$. The matrix $A$ is a function of $t$ times a constant matrix, whose "
    "eigenvectors the solutions keep:",
    "closed_form_if": "The closed forms hold as long as {condition}, which we assume from here on; what is left out are cases of their own.",
    "transition_checked": "{rate} and {start}, as required.",
    "transition_open": "None of the known ways leads to a transition matrix in closed form, so none is given "
    "here, and no Gramian. The rank test does without them.",
    "transition_open_integral": "The equations can be solved one after the other, but the solution contains the integral of {integrand} over "
    "$t$, of which no closed form is known here. So no transition matrix is given, and no Gramian. The rank test does without them.",
    "transition_commuting": "Without input the state is $x = Phi x_0$. The matrix $A$ is a sum of functions of $t$ times constant matrices that "
    "commute, so $Phi$ is the product of the exponentials of their integrals:",
    "gramian": "What the input forces taken away, the output is $C Phi x_0$. Multiplied by $Phiᵀ Cᵀ$ and integrated over the interval it gives "
    "$W x_0$ with",
    "gramian_open_integral": "What the input forces taken away, the output is $C Phi x_0$. The Gramian, the integral of $Phiᵀ Cᵀ C Phi$, contains "
    "the integral of {integrand} over $t$, of which no closed form is known here, so it is not given.",
    "gramian_regular": "Its determinant is not 0, so the kernel of $W$ is trivial, and no two initial states have the same output.",
    "gramian_generic": "The initial state is determined exactly where this is not 0, and the rank test tells when.",
    "gramian_singular": "It is singular, and an initial state in its kernel is never seen at the output:",
    "never_seen_start": "An initial state in this direction is never seen at the output:",
    "stack_rule": "The derivatives of the output $C Phi x_0$ are $N_k Phi x_0$, where each $N_k$ is the one before times $A$, and its derivative "
    "added:",
    "stack_matrix": "Under one another they are",
    "stack_yes": "Since {rank} for almost all $t$, the plant is observable on every interval of time on which $A$ and $C$ have no pole.",
    "stack_yes_at": "Full rank at one instant is enough: {instant}, so the plant is observable on every interval that contains this instant. The "
    "rank is the same for almost all $t$, hence on every other interval without a pole of $A$ and $C$ as well.",
    "stack_yes_on": "Full rank at one instant of the interval is enough: {instant}, so the plant is observable on it.",
    "stack_yes_if": "It is not identically 0 as long as {condition}, which we assume from here on. Then the plant is observable on every interval "
    "of time on which $A$ and $C$ have no pole.",
    "stack_drops": "That {rank} at this one instant does not matter.",
    "stack_no": "Since {rank} wherever its entries are defined, the plant is observable on no interval. Full rank at an instant is sufficient for any "
    "smooth data. It is necessary too because the entries are rational, hence analytic; for merely smooth ones it is not.",
    "stack_moving": "The hidden states at the time $t$ are the combinations of the columns of",
    "stack_invariant": "They give no output, {unseen}, and what starts among them stays among them, since",
    "case_stack": "There {rank} for all $t$: the plant is not observable.",
    "case_stack_yes": "There {rank} for almost all $t$.",
    "frozen_instant": "The rank test of constant matrices, applied at a frozen instant, leaves out the derivatives and decides nothing. Here "
    "{frozen}, and yet the plant is observable on every interval around this instant.",
    "frozen_misled_no": "The rank test of constant matrices, applied at a frozen instant, leaves out the derivatives and decides nothing. Here "
    "{frozen} at almost every instant, and yet the plant is not observable.",
    "frozen_misled_yes": "The rank test of constant matrices, applied at a frozen instant, leaves out the derivatives and decides nothing. Here "
    "{frozen} at almost every instant, and nowhere more, and yet the plant is observable.",
    "frozen_example": "The rank test of constant matrices, applied at a frozen instant, leaves out the derivatives and decides nothing in general. With "
    "{state} and {output} it is passed at every $t$, {frozen}, although {derived}: the output of that plant is constant, and from it only one number "
    "can be found.",
    "forced_state": "From the state 0 the input alone leads to",
    "forced_checked": "{rate} and {start}, as required. The integral runs to the present time, not to the end of the interval.",
    "xi_forced": "Its part of the output is taken away,",
    "xi_same": "Without input all of the output comes from the initial state,",
    "x0_formula": "and the initial state is",
    "state_history": "The state at all times follows by variation of constants,",
    "x0_checked": "{output}: this is the given output.",
    "x0_candidate": "If a state explains the output at all times, then only",
    "x0_none": "No initial state has this output, for that one leaves {rest}.",
    "x0_open": "An initial state in closed form is not given here.",
    "x0_not_unique": "The initial state cannot be found from it, since the hidden states add nothing to an output.",
}

QUESTIONS: dict[str, str] = {
    "ask time_varying_observability": "Is the plant observable?",
    "ask time_varying_observability interval": "Is the plant observable on the interval from {start} to {end}?",
    "also time_varying_observability output": "Find the initial state that explains the output {output}.",
    "also time_varying_observability input": "The input is {input}.",
}

DEMANDS: dict[str, str] = {
    "stack_yes": "says_rank_full",
    "case_stack_yes": "says_rank_full",
    "stack_no": "says_rank_low",
    "case_stack": "says_rank_low",
}

RESTS_ON: dict[str, str] = {
    "stack_yes": "time_varying_rank",
    "stack_yes_at": "time_varying_rank",
    "stack_yes_on": "time_varying_rank",
    "stack_yes_if": "time_varying_rank",
    "stack_no": "time_varying_rank",
    "gramian": "time_varying_gramian",
    "peano_baker": "peano_baker",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "time_varying_rank": (
        "rank test for time-varying plants",
        "L. M. Silverman and H. E. Meadows, SIAM J. Control 5 (1967), 64-73",
    ),
    "time_varying_gramian": ("initial state through the Gramian", "S4, time-varying plants"),
    "peano_baker": ("Peano-Baker series", "W. J. Rugh, Linear System Theory, 2nd ed. (1996), chapter 3"),
}

NAMING = ("transition_open_integral",)

EXPLAINS = (
    "stack_matrix",
    "gramian",
    "transition_commuting",
    "transition_exponential",
    "stack_drops",
)
