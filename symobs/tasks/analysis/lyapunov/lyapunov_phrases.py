"""Lyapunov's equation."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "lyapunov_equation": "Lyapunov equation.",
    "lyapunov_sought_continuous": "A symmetric matrix $P_l$ with $Aᵀ P_l + P_l A = - Q_l$ is sought, where",
    "lyapunov_sought_discrete": "A symmetric matrix $P_l$ with $Aᵀ P_l A - P_l = - Q_l$ is sought, where",
    "lyapunov_polynomial": "Whether there is exactly one depends on the characteristic polynomial",
    "lyapunov_reversed": "and on the polynomial with its coefficients in reverse order,",
    "lyapunov_regular_continuous": "The solution is unique if and only if no two eigenvalues of $A$, nor an eigenvalue and itself, have the sum 0§, which is the case here: {determinant}.",
    "lyapunov_regular_discrete": "The solution is unique if and only if no two eigenvalues of $A$, nor an eigenvalue and itself, have the product 1§, which is the case here: {determinant}.",
    "lyapunov_regular_if_continuous": "The solution is unique if and only if no two eigenvalues of $A$, nor an eigenvalue and itself, have the sum 0§, that is, where {determinant} is not 0.",
    "lyapunov_regular_if_discrete": "The solution is unique if and only if no two eigenvalues of $A$, nor an eigenvalue and itself, have the product 1§, that is, where {determinant} is not 0.",
    "lyapunov_singular_continuous": "Since {determinant}, there are eigenvalues of $A$ with the sum 0: the equation does not have a unique solution§.",
    "lyapunov_singular_discrete": "Since {determinant}, there are eigenvalues of $A$ with the product 1: the equation does not have a unique solution§.",
    "lyapunov_provided": "What follows holds for {condition}.",
    "lyapunov_written_out": "In the entries of a symmetric matrix the left-hand side is",
    "lyapunov_solution": "Equating the left-hand side to $- Q_l$ gives",
    "lyapunov_one_of_many": "It has infinitely many solutions. One of them is",
    "lyapunov_checked": "{equation}.",
    "lyapunov_added": "Every multiple of a solution of the homogeneous equation may be added to it:",
    "lyapunov_obstacle": "The matrix",
    "lyapunov_impossible_continuous": "shows that there is none: for every symmetric $P_l$ the trace of the product of $Aᵀ P_l + P_l A$ and $X_l$ is that of $P_l$ and $A X_l + X_l Aᵀ$, hence 0, whereas the trace of $Q_l X_l$ is {trace}.",
    "lyapunov_impossible_discrete": "shows that there is none: for every symmetric $P_l$ the trace of the product of $Aᵀ P_l A - P_l$ and $X_l$ is that of $P_l$ and $A X_l Aᵀ - X_l$, hence 0, whereas the trace of $Q_l X_l$ is {trace}.",
    "lyapunov_tried_continuous": "Of the symmetric matrix $P_l$ the matrix $Q_l$ with $Aᵀ P_l + P_l A = - Q_l$ is sought, where",
    "lyapunov_tried_discrete": "Of the symmetric matrix $P_l$ the matrix $Q_l$ with $Aᵀ P_l A - P_l = - Q_l$ is sought, where",
    "lyapunov_weight": "It is",
    "lyapunov_weight_minors": "The leading principal minors of $Q_l$ are",
    "lyapunov_weight_definite": "All of them are positive, hence $Q_l$ is positive definite§.",
    "lyapunov_weight_definite_if": "All of them are positive, and hence $Q_l$ is positive definite, if and only if {where}§.",
    "lyapunov_weight_not_definite": "Since {minor}, $Q_l$ is not positive definite§.",
    "lyapunov_minors": "The leading principal minors of $P_l$ are",
    "lyapunov_definite": "All of them are positive, hence $P_l$ is positive definite§.",
    "lyapunov_definite_if": "All of them are positive, and hence $P_l$ is positive definite, if and only if {where}§.",
    "lyapunov_not_definite": "Since {minor}, $P_l$ is not positive definite§.",
    "lyapunov_stable": "Since $Q_l$ is positive definite, $P_l$ is positive definite if and only if $A$ is asymptotically stable§, which it is.",
    "lyapunov_unstable": "Since $Q_l$ is positive definite, $P_l$ is positive definite if and only if $A$ is asymptotically stable§, which it is not.",
    "lyapunov_stable_if": "Since $Q_l$ is positive definite, $P_l$ is positive definite if and only if $A$ is asymptotically stable§, that is, if and only if {where}.",
}

QUESTIONS: dict[str, str] = {
    "ask lyapunov": "Solve the Lyapunov equation of the plant with the identity matrix on its right-hand side. Is the solution positive definite?",
    "ask lyapunov P": "Find the matrix $Q_l$ for which the matrix $P_l$ solves the Lyapunov equation of the plant. Is it positive definite?",
    "ask lyapunov Q": "Solve the Lyapunov equation of the plant with $Q_l$ on its right-hand side. Is the solution positive definite?",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "lyapunov_definite": ("positive_definite",),
    "lyapunov_weight_definite": ("positive_definite",),
    "lyapunov_stable": ("positive_definite", "stable"),
    "lyapunov_unstable": ("positive_definite", "unstable"),
    "lyapunov_stable_if": ("positive_definite",),
}

DEMANDS: dict[str, str] = {
    "lyapunov_sought_continuous": "continuous_time",
    "lyapunov_sought_discrete": "discrete_time",
    "lyapunov_polynomial": "is_characteristic chi A",
    "lyapunov_reversed": "reverses chi_r chi",
    "lyapunov_regular_continuous": "continuous_time, of_pairs A, ends !=",
    "lyapunov_regular_discrete": "discrete_time, of_pairs A, ends !=",
    "lyapunov_regular_if_continuous": "continuous_time, of_pairs A",
    "lyapunov_regular_if_discrete": "discrete_time, of_pairs A",
    "lyapunov_singular_continuous": "continuous_time, of_pairs A, ends =",
    "lyapunov_singular_discrete": "discrete_time, of_pairs A, ends =",
    "lyapunov_one_of_many": "solves_homogeneous A N_l",
    "lyapunov_added": "solves_homogeneous A N_l",
    "lyapunov_impossible_continuous": "continuous_time, refutes_lyapunov A Q_l X_l",
    "lyapunov_impossible_discrete": "discrete_time, refutes_lyapunov A Q_l X_l",
    "lyapunov_tried_continuous": "continuous_time",
    "lyapunov_tried_discrete": "discrete_time",
    "lyapunov_weight_minors": "minors Q_l",
    "lyapunov_weight_definite": "about Q_l positive_definite",
    "lyapunov_weight_definite_if": "about Q_l positive_definite",
    "lyapunov_weight_not_definite": "minors Q_l",
    "lyapunov_minors": "minors P_l",
    "lyapunov_definite": "about P_l positive_definite",
    "lyapunov_definite_if": "about P_l positive_definite",
    "lyapunov_not_definite": "minors P_l",
    "lyapunov_stable": "solves_lyapunov P_l Q_l A",
    "lyapunov_unstable": "solves_lyapunov P_l Q_l A",
    "lyapunov_stable_if": "solves_lyapunov P_l Q_l A",
}

RESTS_ON: dict[str, str] = {
    "lyapunov_regular_continuous": "lyapunov_unique",
    "lyapunov_regular_discrete": "lyapunov_unique",
    "lyapunov_regular_if_continuous": "lyapunov_unique",
    "lyapunov_regular_if_discrete": "lyapunov_unique",
    "lyapunov_singular_continuous": "lyapunov_unique",
    "lyapunov_singular_discrete": "lyapunov_unique",
    "lyapunov_definite": "principal_minors",
    "lyapunov_weight_definite": "principal_minors",
    "lyapunov_weight_definite_if": "principal_minors",
    "lyapunov_weight_not_definite": "principal_minors",
    "lyapunov_definite_if": "principal_minors",
    "lyapunov_not_definite": "principal_minors",
    "lyapunov_stable": "lyapunov_theorem",
    "lyapunov_unstable": "lyapunov_theorem",
    "lyapunov_stable_if": "lyapunov_theorem",
}

THEOREMS: dict[str, str] = {
    "lyapunov_unique": "lancaster1985, ch. 12, 13",
    "principal_minors": "lancaster1985, ch. 8",
    "lyapunov_theorem": "kalman1960a; lancaster1985, ch. 13",
}

#: Phrases that go on with the sentence before them.
CONTINUES = ("lyapunov_reversed", "lyapunov_impossible_continuous", "lyapunov_impossible_discrete")

NAMING = ("lyapunov_impossible_continuous", "lyapunov_impossible_discrete")
