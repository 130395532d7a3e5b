"""Functions of time: the matrix exponential, Gramians, initial states and their covariance."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "matrix_exponential": "Matrix exponential.",
    "exponential_modes": "The characteristic polynomial decides which functions of time occur:",
    "exponential_sum": "Each of its roots brings its functions, with constant matrices that the derivatives at $t=0$ determine:",
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
    "gramian_integral": "Its products, integrated over the horizon, are the Gramian:",
    "gramian_determinant": "Its determinant is",
    "lyapunov": "Lyapunov's equation {equation} has the solution",
    "gramian_by_lyapunov": "Since the derivative of $Phiᵀ P_l Phi$ is $- Yᵀ Y$, the Gramian is the same expression for every "
    "sign of the discriminant:",
    "gramian_in_case": "Entry by entry,",
    "gramian_infinite": "The integral over all time exists, since what the output sees decays. It solves Lyapunov's equation "
    "{equation}, whose only solution is",
    "gramian_diverges": "What the output sees does not decay, so the integral over all time does not exist.",
    "gramian_open": "Whether the integral over all time exists is not decided here: {question}.",
    "gramian_exists_if": "The integral over all time exists where {where}. It solves Lyapunov's equation {equation}, whose only "
    "solution is",
    "gramian_steps": "Over a horizon of {steps} steps the Gramian is the sum",
    "finite_sum": "Finite sum.",
    "finite_sum_is": "The same kernel belongs to the finite sum over the powers of $A$,",
    "kernel_none": "Its determinant is {determinant}, so it has no kernel, and neither has $W$: the initial state can be found "
    "from the output.",
    "kernel_none_controllability": "Its determinant is {determinant}, so it has no kernel, and neither has $W$: every state can be "
    "reached.",
    "kernel_shared": "Gramian, finite sum and $O$ have the same kernel. For",
    "kernel_unseen": "the output vanishes at all times, so this state and 0 cannot be told apart:",
    "kernel_of_gramian": "and with it the product with the Gramian and with the finite sum,",
}

RESTS_ON: dict[str, str] = {
    "exponential_sum": "exponential",
    "gramian_integral": "gramian",
    "finite_sum_is": "finite_sum",
    "kernel_shared": "finite_sum",
}

NAMING = ("no_closed_form",)
