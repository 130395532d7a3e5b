"""The linear-quadratic regulator and the steady-state Kalman filter."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "optimal_feedback": "Optimal state feedback.",
    "optimal_filter": "Steady-state Kalman filter.",
    "lqr_cost_continuous": "The control law $u = - K x$ is sought that minimises the integral of $xᵀ Q_x x + uᵀ R_u u$ over all times from 0 on, where",
    "lqr_cost_discrete": "The control law $u = - K x$ is sought that minimises the sum of $xᵀ Q_x x + uᵀ R_u u$ over all steps, where",
    "lqr_cost_cross_continuous": "The control law $u = - K x$ is sought that minimises the integral of $xᵀ Q_x x + 2 xᵀ N_x u + uᵀ R_u u$ over all times from 0 on, where",
    "lqr_cost_cross_discrete": "The control law $u = - K x$ is sought that minimises the sum of $xᵀ Q_x x + 2 xᵀ N_x u + uᵀ R_u u$ over all steps, where",
    "kalman_noise_continuous": "White noise $w$ of intensity $W_n$ is added to the state equation, and independent white noise $v$ of intensity $V_n$ to the output. The observer gain $L$ for which the error has the smallest covariance is sought, where",
    "kalman_noise_through_continuous": "White noise $w$ of intensity $W_n$ enters the state equation as $G_n w$, and independent white noise $v$ of intensity $V_n$ is added to the output. The observer gain $L$ for which the error has the smallest covariance is sought, where",
    "kalman_noise_discrete": "White noise $w$ with the covariance $W_n$ is added to the state equation, and independent white noise $v$ with the covariance $V_n$ to the output. The observer gain $L$ for which the error has the smallest covariance is sought, where",
    "kalman_noise_through_discrete": "White noise $w$ with the covariance $W_n$ enters the state equation as $G_n w$, and independent white noise $v$ with the covariance $V_n$ is added to the output. The observer gain $L$ for which the error has the smallest covariance is sought, where",
    "kalman_shared": "The two noises are correlated, with $N_n$ for the expectation of their product:",
    "kalman_update": "This $L$ leads from the output $y$ to the prediction of the next state, and $P_x$ is the covariance of the error before $y$ is known. After the measurement gain and covariance are",
    "optimal_uncrossed": "Completing the square removes the cross weight:",
    "optimal_provided": "What follows holds for {condition}.",
    "optimal_open_loop": "The characteristic polynomial and the numerators from the input to the states are, with their mirror images,",
    "optimal_open_loop_dual": "The characteristic polynomial and the numerators from the states to the output are, with their mirror images,",
    "optimal_even": "From them follows the optimal polynomial times its mirror image§,",
    "optimal_hamiltonian": "The stable eigenvalues of the Hamiltonian matrix are the optimal poles§:",
    "optimal_even_of_pencil": "The optimal polynomial, times its mirror image, is up to a factor§",
    "optimal_factor": "Its factor with all roots in the stable region is",
    "optimal_root": "where {root} and {positive}.",
    "optimal_next_root": "Further {root} and {positive}.",
    "optimal_roots": "Its <root is|roots are> {roots}.",
    "optimal_weighted": "With the weight multiplied by a factor the product above is",
    "optimal_locus": "The symmetric root locus while the weight grows from 0 to the given one.",
    "optimal_roots_real": "The square roots are real and positive: on the boundary the polynomial above is not negative, and where the conditions hold it has no root there.",
    "optimal_matched": "With unknown entries of the gain the polynomial is",
    "optimal_matched_gain": "Comparing coefficients gives",
    "optimal_P": "The stabilizing solution of Riccati's equation is",
    "optimal_gain": "The gain follows from it:",
    "optimal_checked": "{riccati}, and {gain}.",
    "optimal_feedback_found": "The loop is asymptotically stable, hence no other control law costs less, and the least cost from $x_0$ is $x_0ᵀ P_x x_0$§.",
    "optimal_filter_found": "The error is asymptotically stable, hence no other gain leads to a smaller covariance of the error, and this covariance is $P_x$§.",
    "optimal_margins": "Without a cross weight such a loop has a phase margin of at least 60°, and stays stable when the gain is multiplied by any number greater than 1/2§.",
    "optimal_digits": "The solution is not written with square roots here. In decimals",
    "optimal_digits_matched": "Comparing it with the factor of the product above that has all roots in the stable region gives, in decimals,",
    "optimal_loop_polynomial": "With the rounded gain the characteristic polynomial is",
    "kalman_filter": "The filter is {law}.",
    "optimal_too_long": "The solution is not written with square roots here, and the digits that prove it are too many for a page.",
    "optimal_feedback_enclosed": "$P_r$ and $K_r$ are correct to the digits printed, {radius} being the last place§.",
    "optimal_rounded_feedback": "With $K_r$, rounded to multiples of {radius}, the loop is asymptotically stable, and the cost from $x_0$ exceeds the least one by at most {bound} $x_0ᵀ x_0$.",
    "optimal_rounded_filter": "With $L_r$, rounded to multiples of {radius}, the error is asymptotically stable, and the variance of no combination $cᵀ e$ of its components exceeds the smallest one by more than {bound} $cᵀ c$.",
    "optimal_filter_enclosed": "$P_r$ and $L_r$ are correct to the digits printed, {radius} being the last place§.",
    "optimal_open": "No closed form of the solution is found here for all values of the parameters; with numbers in their places its digits can be given.",
    "optimal_uncontrollable_modes": "No input moves the modes with the polynomial",
    "optimal_unmeasured_modes": "The output does not show the modes with the polynomial",
    "optimal_not_stabilizable": "It is not stable, so no control law stabilises the loop, and there is no optimal one.",
    "optimal_not_detectable": "It is not stable, so no gain stabilises the error, and there is no optimal one.",
    "optimal_unseen_modes": "The cost does not contain the modes with the polynomial",
    "optimal_undriven_modes": "The noise does not drive the modes with the polynomial",
    "optimal_on_boundary": "Their eigenvalues lie on the boundary of stability, so the Hamiltonian matrix has them, too, and there is no stabilizing solution of Riccati's equation§.",
    "optimal_filter_on_boundary": "Their eigenvalues lie on the boundary of stability, so the Hamiltonian matrix has them, too, and there is no stabilizing solution of Riccati's equation§.",
}

QUESTIONS: dict[str, str] = {
    "ask lqr": "Find the state feedback that minimises the integral of $xᵀ Q_x x + uᵀ R_u u$ over all times.",
    "ask lqr discrete": "Find the state feedback that minimises the sum of $xᵀ Q_x x + uᵀ R_u u$ over all instants.",
    "ask lqr N": "Find the state feedback that minimises the integral of $xᵀ Q_x x + 2 xᵀ N_x u + uᵀ R_u u$ over all times.",
    "ask lqr N discrete": "Find the state feedback that minimises the sum of $xᵀ Q_x x + 2 xᵀ N_x u + uᵀ R_u u$ over all instants.",
    "ask kalman": "Find the gain of the steady-state Kalman filter for input noise of intensity $W_n$ and output noise of intensity $V_n$.",
    "ask kalman N": "Find the gain of the steady-state Kalman filter for input noise of intensity $W_n$ and output noise of intensity $V_n$, which are correlated with $N_n$.",
    "ask kalman G N": "Find the gain of the steady-state Kalman filter for noise of intensity $W_n$ that enters through $G_n$, and output noise of intensity $V_n$, which are correlated with $N_n$.",
    "ask kalman G": "Find the gain of the steady-state Kalman filter for noise of intensity $W_n$ that enters through $G_n$, and output noise of intensity $V_n$.",
}

CONTINUES = ("optimal_root",)

ASSERTS: dict[str, tuple[str, ...]] = {
    "optimal_rounded_feedback": ("stable",),
    "optimal_rounded_filter": ("stable",),
    "optimal_feedback_found": ("stable",),
    "optimal_filter_found": ("stable",),
    "optimal_not_stabilizable": ("unstable",),
    "optimal_not_detectable": ("unstable",),
}

DEMANDS: dict[str, str] = {
    "optimal_factor": "splits c_even p_s",
    "optimal_feedback_found": "optimal A B Q_x R_u N_x P_x K chi_K",
    "optimal_filter_found": "optimal Aᵀ Cᵀ Q_x V_n N_x P_x Lᵀ chi_L",
    "optimal_margins": "continuous_time, optimal A B Q_x R_u N_x P_x K chi_K, zero N_x, single Bᵀ",
    "optimal_feedback_enclosed": "encloses A B Q_x R_u N_x P_r K_r",
    "optimal_not_stabilizable": "modes_unstable Bᵀ Aᵀ N_K X_K mu",
    "optimal_not_detectable": "modes_unstable C A N X mu",
    "optimal_rounded_feedback": "about chi_K stable, exceeds A B Q_x R_u N_x P_r K_r",
    "optimal_rounded_filter": "about chi_L stable, exceeds Aᵀ Cᵀ Q_x V_n N_x P_r L_rᵀ",
    "optimal_on_boundary": "on_boundary Q_N A_N N X",
    "optimal_filter_on_boundary": "on_boundary Q_x Aᵀ N_K X_K",
    "optimal_filter_enclosed": "encloses Aᵀ Cᵀ Q_x V_n N_x P_r L_rᵀ",
}

RESTS_ON: dict[str, str] = {
    "optimal_even": "root_square",
    "optimal_hamiltonian": "hamiltonian_modes",
    "optimal_even_of_pencil": "hamiltonian_modes",
    "optimal_feedback_found": "regulator_optimal",
    "optimal_filter_found": "filter_optimal",
    "optimal_margins": "regulator_margins",
    "optimal_feedback_enclosed": "stabilizing_solution",
    "optimal_on_boundary": "stabilizing_solution",
    "optimal_filter_enclosed": "stabilizing_solution",
    "optimal_filter_on_boundary": "stabilizing_solution",
}

THEOREMS: dict[str, str] = {
    "root_square": "kalman1964; anderson1990, ch. 5",
    "hamiltonian_modes": "kucera1972",
    "regulator_optimal": "kalman1960b; kucera1972",
    "filter_optimal": "kalman1961; kucera1972",
    "regulator_margins": "safonov1977; anderson1990, ch. 5",
    "stabilizing_solution": "kucera1972",
}
