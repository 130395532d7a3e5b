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
    "transition_exponential": "so that $Phi$ is the exponential of $M$. Since {power}, its series terminates:",
    "peano_baker": "Without input the state is $x = Phi x_0$. The Peano–Baker series of $Phi$ terminates; its terms after the first are",
    "peano_baker_sum": "each the integral of $A$ times the preceding one, and {end}. Their sum is",
    "transition_constant": "Without input the state is $x = Phi x_0$. Since {zero}, the state is constant:",
    "transition_triangular": "Without input the state is $x = Phi x_0$. The equations can be solved successively, by variation of constants:",
    "transition_direction": "Without input the state is $x = Phi x_0$. The matrix $A$ is a function of $t$ times a constant matrix, so its eigenvectors are constant:",
    "closed_form_if": "The closed forms hold provided that {condition}, which we assume in what follows; the exceptional values are separate cases.",
    "transition_checked": "{rate} and {start}, as required.",
    "transition_open": "No closed form of the transition matrix was found, so neither it nor the Gramian is given. The rank test does not need them.",
    "transition_open_integral": "The equations can be solved successively, but the solution contains the integral of {integrand} over $t$, for which no closed form was found. So neither the transition matrix nor the Gramian is given. The rank test does not need them.",
    "transition_commuting": "Without input the state is $x = Phi x_0$. The matrix $A$ is a sum of functions of $t$ times constant matrices that "
    "commute, so $Phi$ is the product of the exponentials of their integrals:",
    "gramian": "After subtraction of the forced response the output is $C Phi x_0$. Multiplying by $Phiᵀ Cᵀ$ and integrating over the interval gives $W x_0$ with",
    "gramian_open_integral": "After subtraction of the forced response the output is $C Phi x_0$. The Gramian, the integral of $Phiᵀ Cᵀ C Phi$, contains the integral of {integrand} over $t$, for which no closed form was found, so it is not given.",
    "gramian_long": "After subtraction of the forced response the output is $C Phi x_0$. The Gramian, the integral of $Phiᵀ Cᵀ C Phi$, has too many terms to be given here.",
    "gramian_regular": "Its determinant is nonzero, so the kernel of $W$ is trivial, and distinct initial states give distinct outputs.",
    "gramian_generic": "The initial state is uniquely determined if and only if this is nonzero; the rank test shows when.",
    "gramian_singular": "It is singular, and the initial states in its kernel are unobservable:",
    "never_seen_start": "The following initial state is unobservable:",
    "stack_rule": "The derivatives of the output $C Phi x_0$ are $N_k Phi x_0$, where each $N_k$ is the preceding one times $A$ plus its derivative:",
    "stack_matrix": "Stacked, they are",
    "stack_yes": "Since {rank} for almost all $t$, the plant is observable on every interval of time on which $A$ and $C$ have no pole.",
    "stack_yes_minor": "Since {minor} as a function of $t$, and it is analytic§, the plant is observable on every interval of time on which $A$ and $C$ have no pole.",
    "stack_no_states": "Since {hidden} with the matrix $V$ below, the plant is observable on no interval.",
    "case_stack_states": "In this case the plant is not observable:",
    "case_stack_minor": "In this case {minor}: the plant is observable.",
    "stack_yes_at": "Full rank at one instant is enough: {instant}, so the plant is observable on every interval that contains this instant. The "
    "rank is the same for almost all $t$, hence on every other interval without a pole of $A$ and $C$ as well.",
    "stack_yes_on": "Full rank at one instant of the interval is enough: {instant}, so the plant is observable on it.",
    "stack_yes_if": "It is not identically 0 as long as {condition}, which we assume from here on. Then the plant is observable on every interval "
    "of time on which $A$ and $C$ have no pole.",
    "stack_drops": "That {rank} at this isolated instant is immaterial.",
    "stack_no": "Since {rank} wherever its entries are defined, the plant is observable on no interval. Full rank at an instant is sufficient for any "
    "smooth data. It is necessary too because the entries are rational, hence analytic; for merely smooth ones it is not.",
    "stack_moving": "The unobservable states at time $t$ are the linear combinations of the columns of",
    "stack_invariant": "They produce no output, {unseen}, and trajectories starting among them remain among them, since",
    "case_stack": "In this case {rank} for all $t$: the plant is not observable.",
    "case_stack_yes": "In this case {rank} for almost all $t$.",
    "frozen_instant": "The time-invariant rank test, applied at a frozen instant, ignores the derivatives and is inconclusive. Here {frozen}, and yet the plant is observable on every interval around this instant.",
    "frozen_misled_no": "The time-invariant rank test, applied at a frozen instant, ignores the derivatives and is inconclusive. Here {frozen} at almost every instant, and yet the plant is not observable.",
    "frozen_misled_yes": "The time-invariant rank test, applied at a frozen instant, ignores the derivatives and is inconclusive. Here {frozen} at almost every instant, and never more, and yet the plant is observable.",
    "frozen_example": "The time-invariant rank test, applied at a frozen instant, ignores the derivatives and is inconclusive in general. With {state} and {output} it is passed at every $t$, {frozen}, although {derived}: the output of that plant is constant, and only one scalar can be determined from it.",
    "forced_state": "The forced response of the state, from zero initial state, is",
    "forced_checked": "{rate} and {start}, as required.",
    "xi_forced": "Subtracting its contribution to the output gives",
    "xi_same": "Without input the output is due to the initial state alone,",
    "x0_formula": "and the initial state is",
    "state_history": "The state at all times follows by variation of constants,",
    "x0_checked": "{output}: this is the given output.",
    "x0_candidate": "The only initial state that can be consistent with the output is",
    "x0_none": "No initial state produces this output: the residual is {rest}.",
    "x0_open": "An initial state in closed form is not given here.",
    "x0_not_unique": "The initial state cannot be determined uniquely, since unobservable states do not contribute to the output.",
}

QUESTIONS: dict[str, str] = {
    "ask time_varying_observability": "Is the plant observable?",
    "ask time_varying_observability interval": "Is the plant observable on the interval from {start} to {end}?",
    "also time_varying_observability output": "Find the initial state that is consistent with the output {output}.",
    "also time_varying_observability input": "The input is {input}.",
}

DEMANDS: dict[str, str] = {
    "closed_form_if": "promises_cases",
    "gramian_regular": "nonsingular W",
    "gramian_singular": "vanishes C Phi v",
    "never_seen_start": "vanishes C Phi v",
    "stack_yes": "says_observable C A",
    "stack_yes_minor": "observable C A",
    "stack_no_states": "unobservable C A",
    "case_stack_states": "unobservable C A",
    "case_stack_minor": "observable C A",
    "stack_yes_at": "says_regular_at C A",
    "stack_yes_on": "says_regular_at C A",
    "stack_yes_if": "observable C A",
    "case_stack_yes": "says_observable C A",
    "stack_no": "says_unobservable C A",
    "case_stack": "says_unobservable C A",
    "frozen_instant": "observable C A",
    "frozen_misled_yes": "observable C A",
    "frozen_misled_no": "unobservable C A",
    "x0_not_unique": "unobservable C A",
}

RESTS_ON: dict[str, str] = {
    "stack_yes": "time_varying_rank",
    "stack_yes_minor": "time_varying_rank",
    "stack_yes_at": "time_varying_rank",
    "stack_yes_on": "time_varying_rank",
    "stack_yes_if": "time_varying_rank",
    "stack_no": "time_varying_rank",
    "gramian": "time_varying_gramian",
    "peano_baker": "peano_baker",
}

THEOREMS: dict[str, str] = {
    "time_varying_rank": "silverman1967",
    "time_varying_gramian": "kalman1960; rugh1996, ch. 9",
    "peano_baker": "peano1888; baker1905; rugh1996, ch. 3",
}

NAMING = ("transition_open_integral",)

EXPLAINS = (
    "stack_matrix",
    "gramian",
    "transition_commuting",
    "transition_exponential",
    "stack_drops",
)

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "input_given",
    "transition_exponential",
    "peano_baker_sum",
    "x0_formula",
)
