"""Functions of time: the matrix exponential, Gramians, initial states and their covariance."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "matrix_exponential": "Matrix exponential.",
    "exponential_modes": "The characteristic polynomial decides which functions of time occur:",
    "exponential_sum": "Each root brings its functions, with constant matrices that the derivatives at $t=0$ determine:",
    "exponential_here": "Here",
    "root_named": "where {root}.",
    "exponential_rate": "The check is the equation that defines it,",
    "exponential_start": "Its derivative is $A$ times itself, and at the start it is the identity, {start}.",
    "branch_under": "There the mode oscillates.",
    "branch_over": "There the mode does not oscillate.",
    "branch_equal": "There the root is double.",
    "no_closed_form": "The factor {factor} of degree {degree} cannot be reduced over the field of the data, so its roots, and "
    "the functions of time that belong to them, have no closed form here. Which exponentials occur is not decided.",
    "too_many_states": "With {order} states the exponential is longer than what is computed here. It is not decided.",
    "gramian_observability": "Observability Gramian.",
    "gramian_controllability": "Controllability Gramian.",
    "output_of_exponential": "The output that the states leave behind is",
    "input_through_exponential": "What the input brings about at a distance $t$ in time is",
    "gramian_integral": "Its products, integrated over the horizon, are the Gramian:",
    "gramian_determinant": "Its determinant is",
    "lyapunov": "Lyapunov's equation {equation} has the solution",
    "lyapunov_denominator": "Where its denominator vanishes there is no such solution, and the integral is taken directly.",
    "gramian_by_lyapunov": "Since the derivative of $exp_Atᵀ P_l exp_At$ is $- exp_Atᵀ Cᵀ C exp_At$, the Gramian is the same expression for every "
    "sign of the discriminant:",
    "gramian_in_case": "Entry by entry,",
    "gramian_infinite_observability": "The integral over all time exists, since what the output sees decays.",
    "gramian_infinite_controllability": "The integral over all time exists, since what the input moves decays.",
    "lyapunov_alone": "It solves Lyapunov's equation {equation}, whose only solution is",
    "lyapunov_with_kernel": "It solves Lyapunov's equation {equation}, and of its symmetric solutions it is the one with {nothing},",
    "part_observability": "Of this the output sees the part that is left without the hidden modes,",
    "part_controllability": "Of this the input moves the part that is left without the modes that it does not move,",
    "gramian_diverges_observability": "What the output sees does not decay, so the integral over all time does not exist.",
    "gramian_diverges_controllability": "What the input moves does not decay, so the integral over all time does not exist.",
    "gramian_open": "Whether the integral over all time exists is not decided here: {question}.",
    "gramian_exists_if": "The integral over all time exists exactly where {where}.",
    "gramian_steps": "Over a horizon of {steps} steps the Gramian is the sum",
    "finite_sum": "Finite sum.",
    "finite_sum_is": "The same kernel belongs to the finite sum over the powers of $A$,",
    "kernel_none": "Its determinant is {determinant}, so it has no kernel, and neither has $W$: the initial state can be found "
    "from the output.",
    "kernel_none_of_sum": "Its determinant is {determinant}, so it has no kernel.",
    "kernel_none_controllability": "Its determinant is {determinant}, so it has no kernel, and neither has $W$: every state can be "
    "reached.",
    "kernel_shared": "Gramian, finite sum and $O$ have the same kernel. For",
    "kernel_unseen": "the output vanishes at all times, so this state and 0 cannot be told apart:",
    "kernel_unseen_several": "the output of every column vanishes at all times, so the states they span and 0 cannot be told apart:",
    "kernel_of_gramian": "and with it the product with the Gramian and with the finite sum,",
    "initial_state": "Initial state.",
    "measured": "The data are",
    "output_free": "Without input, $y = Y x_0$.",
    "output_forced": "The input alone, from rest, moves the state along",
    "output_solution": "which solves {equation} from 0. Then $y = Y x_0$ and what the input adds, and the input's part is moved "
    "to the left:",
    "moments": "Multiplied by $exp_Atᵀ Cᵀ$ and integrated over the interval, this becomes $W x_0 = r_0$ with the Gramian",
    "moments_right": "and the right side",
    "initial_found": "The Gramian is invertible, so the initial state is the one solution,",
    "initial_checked": "{moments}, and the output that starts there is the one that was measured: {output}.",
    "short_horizon": "For a short horizon these equations are ill-conditioned: the Taylor series of the determinant of $W$ at $T = 0$ begins "
    "with {leading}, so errors of the output are much enlarged in $x_0$. An observer, which corrects its estimate all the time, avoids this "
    "inversion.",
    "initial_not_unique": "The output does not fix the initial state, since the pair ($C$, $A$) is not observable. One state that "
    "explains it is",
    "initial_kernel": "Its output is the one measured, and that of the vector beside it vanishes, so every multiple of that one may be added:",
    "initial_kernel_several": "Its output is the one measured, and those of the vectors beside it vanish, so every combination of these may be added:",
    "initial_candidate": "The value and the derivatives of {free} at 0 leave one candidate only,",
    "initial_refused": "but its output is another one: what is left, {rest}, is not 0. No initial state explains these data.",
    "initial_start": "The value and the derivatives at 0 would have to be $O x_0$. They are",
    "initial_inconsistent": "They contradict each other: with {row} one has {zero}, but {rest}. No "
    "initial state explains these data.",
    "covariance": "Uncertainty of the initial state.",
    "noise": "White noise of intensity $Q$ is added to the known input and white noise of intensity $R$ to the output,",
    "noise_output_only": "White noise of intensity $R$ is added to the output,",
    "estimate_is": "The estimate is linear in the measurements, so it is unbiased, and its covariance is the sum of two parts. "
    "The output noise enters through",
    "estimate_of_output": "The estimate is linear in the measurements, so it is unbiased. The output noise enters its covariance through",
    "covariance_of_output": "Between two inverse Gramians this is the covariance,",
    "estimate_input": "The input noise reaches the estimate through",
    "estimate_input_integral": "which gives",
    "parts_of_covariance": "Between two inverse Gramians these are the two parts of the covariance, the one from the output noise",
    "input_part": "and the one from the input noise",
    "covariance_is": "Together,",
    "horizon_called_t": "The time in the integrals is $t$. So their end, which the question calls $t$, is written $T$.",
    "horizon_tradeoff": "A longer horizon averages the output noise and gathers the input noise.",
    "inverse_too_long": "The inverse of this Gramian is longer than what is computed here. The covariance is not decided.",
    "gramian_is": "The Gramian over the horizon is",
    "best_horizon": "The variance of component {number} is {variance}, with {rate}. It is least where the last factor vanishes.",
    "not_minimum_variance": "With input noise this estimate does not have the smallest variance possible; that one comes from a Riccati "
    "equation.",
}

QUESTIONS: dict[str, str] = {
    "ask matrix_exponential": "Find the matrix exponential $exp_At$, in real terms.",
    "ask gramian": "Find the observability Gramian over the horizon {horizon}, with its determinant. Is every initial state seen at the output?",
    "ask gramian horizon=inf": "Find the observability Gramian over all time, with its determinant. Is every initial state seen at the output?",
    "ask gramian of=observability": "Find the observability Gramian over the horizon {horizon}, with its determinant.",
    "ask gramian of=observability horizon=inf": "Find the observability Gramian over all time, with its determinant.",
    "ask gramian of=controllability": "Find the controllability Gramian over the horizon {horizon}, with its determinant.",
    "ask gramian of=controllability horizon=inf": "Find the controllability Gramian over all time, with its determinant.",
    "ask initial_state": "Find the initial state from the output.",
    "ask initial_state output": "Up to the time {horizon} the output was measured as {output}, and there was no input. Find the initial state.",
    "ask initial_state output input": "Up to the time {horizon} the output was measured as {output} under the input {input}. Find the initial state.",
    "also initial_state input": "The input is {input}.",
    "also initial_state_covariance Q": "White noise {Q} is added to the known input.",
    "ask initial_state_covariance": "Find the covariance of the initial state that the Gramian reconstructs from a noisy output.",
    "ask initial_state_covariance R": "The output is measured with white noise {R} up to the time {horizon}. Find the covariance of the initial state "
    "that the Gramian reconstructs, and the best horizon for each component.",
    "ask initial_state_covariance Q R": "White noise {Q} is added to the known input and white noise {R} to the output, up to the time {horizon}. Find "
    "the covariance of the initial state that the Gramian reconstructs, and the best horizon for each component.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "gramian_infinite_observability": ("stable",),
    "gramian_infinite_controllability": ("stable",),
    "gramian_diverges_observability": ("unstable",),
    "gramian_diverges_controllability": ("unstable",),
}

RESTS_ON: dict[str, str] = {
    "exponential_sum": "exponential",
    "gramian_integral": "gramian",
    "finite_sum_is": "finite_sum",
    "kernel_shared": "finite_sum",
    "moments": "reconstruction",
    "estimate_is": "noise",
    "estimate_of_output": "noise",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "reconstruction": ("initial state from measurements", "S0, (4.6)-(4.11)"),
    "noise": ("uncertainty of the initial state", "S4, Exercise 3"),
    "gramian": ("Gramian criterion", "S0, Proposition 4.1 and (4.8)"),
    "finite_sum": ("equality of the kernels", "S0, Theorem 4.3"),
    "exponential": ("matrix exponential by its derivatives at 0", "E. J. Putzer, Amer. Math. Monthly 73 (1966), 2-7"),
}

NAMING = ("no_closed_form",)

EXPLAINS = (
    "exponential_sum",
    "gramian_integral",
)
