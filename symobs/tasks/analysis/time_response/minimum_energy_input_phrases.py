"""The input of least energy between two states."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "minimum_energy_input": "Input of minimum energy.",
    "energy_states": "Among the inputs that lead from $x_0$ at the time 0 to $x_1f$ at the time $T_h$, that of minimum energy is sought, where",
    "energy_states_discrete": "Among the input sequences that lead from $x_0$ to $x_1f$, that of minimum energy is sought, where",
    "energy_difference": "The input has to contribute the difference to the zero-input response,",
    "energy_gramian": "The controllability Gramian over the horizon is",
    "energy_gramian_discrete": "The controllability Gramian over a horizon of {steps} is",
    "energy_multiplier": "The equation $W lam_e = d_r$ is solved by",
    "energy_solved": "{equation}.",
    "energy_input": "The input of minimum energy is therefore§",
    "energy_sequence": "The input sequence of minimum energy, one column for each step, is therefore§",
    "energy_spent": "Its energy, the integral of $u_tᵀ u_t$ over the horizon, is",
    "energy_spent_discrete": "Its energy, the sum of the squares of its entries, is",
    "energy_reachable": "What an input can contribute lies in the span of the columns of",
    "energy_open": "The inverse of the controllability Gramian is too long to be computed here, so the input is not given.",
    "energy_unreachable": "With {row}, {annuls}, but {left}. Hence no input leads to this final state.",
}

QUESTIONS: dict[str, str] = {
    "ask minimum_energy_input": "Find the input of minimum energy that leads from the given initial state to the given final state over the horizon {horizon}.",
    "ask minimum_energy_input final": "Find the input of minimum energy that leads from rest to the final state {final} over the horizon {horizon}.",
    "ask minimum_energy_input initial": "Find the input of minimum energy that leads from the initial state {initial} to rest over the horizon {horizon}.",
    "ask minimum_energy_input initial final": "Find the input of minimum energy that leads from the initial state {initial} to the final state {final} over the horizon {horizon}.",
}

DEMANDS: dict[str, str] = {
    "energy_states_discrete": "discrete_time",
    "energy_gramian_discrete": "discrete_time, counts_steps",
    "energy_multiplier": "solves W lam_e d_r",
    "energy_input": "solves W lam_e d_r, continuous_time",
    "energy_sequence": "solves W lam_e d_r, discrete_time",
    "energy_spent": "solves W lam_e d_r, continuous_time",
    "energy_spent_discrete": "solves W lam_e d_r, discrete_time",
    "energy_unreachable": "annuls w_d Ctr d_r",
}

RESTS_ON: dict[str, str] = {
    "energy_input": "minimum_energy",
    "energy_sequence": "minimum_energy",
}

THEOREMS: dict[str, str] = {"minimum_energy": "kalman1963a; kailath1980, ch. 9"}
