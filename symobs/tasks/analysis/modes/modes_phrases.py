"""Modes one by one: the test of Popov, Belevitch and Hautus, detectability and stabilizability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pbh": "Popov–Belevitch–Hautus (PBH) test.",
    "detectability": "Detectability.",
    "stabilizability": "Stabilizability.",
    "eigenvalue_polynomial": "The eigenvalues of $A$ are the roots of its characteristic polynomial",
    "eigenvalues": "<The only eigenvalue is|The eigenvalues are> {roots}.",
    "eigenvalues_open": "For a factor without roots in closed form, λ denotes any of its roots.",
    "pbh_asks_observability": "The pair ($C$, $A$) is observable if and only if the matrix with $A - lambda I$ above $C$ has full column rank at every eigenvalue.",
    "pbh_asks_controllability": "The pair ($A$, $B$) is controllable if and only if the matrix with $A - lambda I$ beside $B$ has full row rank at every eigenvalue.",
    "pbh_low_observability": "The matrix loses rank: an eigenvector is unobservable,",
    "pbh_low_controllability": "The matrix loses rank: a left eigenvector is orthogonal to the columns of the input matrix,",
    "pbh_yes_observability": "The rank is full at every eigenvalue, so the pair ($C$, $A$) is observable.",
    "pbh_yes_controllability": "The rank is full at every eigenvalue, so the pair ($A$, $B$) is controllable.",
    "pbh_no_observability": "The rank drops at some eigenvalue, so the pair ($C$, $A$) is not observable.",
    "pbh_no_controllability": "The rank drops at some eigenvalue, so the pair ($A$, $B$) is not controllable.",
    "pbh_general": "For other parameter values the result is stated without using eigenvalues.",
    "ranks_meet": "In this case a rank drops below its generic value.",
    "fixed_modes_observability": "The unobservable modes, which no observer gain can move, are the eigenvalues of $A$ restricted to the unobservable subspace:",
    "fixed_modes_controllability": "The uncontrollable modes, which no feedback gain can move, are the eigenvalues of $Aᵀ$ restricted to the left kernel of the controllability matrix:",
    "on_kernel_observability": "The columns of $N$ form a basis of the unobservable subspace, on which $A$ is represented by $X$:",
    "on_kernel_controllability": "The columns of $N$ form a basis of the left kernel of the controllability matrix, on which $Aᵀ$ is represented by $X$:",
    "no_fixed_modes_observability": "There are no unobservable modes.",
    "no_fixed_modes_controllability": "There are no uncontrollable modes.",
    "asks_detectability_continuous": "The pair ($C$, $A$) is detectable if and only if the matrix with $A - lambda I$ above $C$ has full column rank at every eigenvalue with nonnegative real part.",
    "asks_detectability_discrete": "The pair ($C$, $A$) is detectable if and only if the matrix with $A - lambda I$ above $C$ has full column rank at every eigenvalue on or outside the unit circle.",
    "asks_stabilizability_continuous": "The pair ($A$, $B$) is stabilizable if and only if the matrix with $A - lambda I$ beside $B$ has full row rank at every eigenvalue with nonnegative real part.",
    "asks_stabilizability_discrete": "The pair ($A$, $B$) is stabilizable if and only if the matrix with $A - lambda I$ beside $B$ has full row rank at every eigenvalue on or outside the unit circle.",
    "only_stable": "Every mode is stable, so no eigenvalue has to be tested.",
    "means_lyapunov": "Here only stability in the sense of Lyapunov is required: a fixed mode may also lie on the stability boundary, provided that it is semisimple.",
    "means_detectability": "The pair ($C$, $A$) is detectable if and only if all its unobservable modes are stable.",
    "means_stabilizability": "The pair ($A$, $B$) is stabilizable if and only if all its uncontrollable modes are stable.",
    "yes_detectability": "Hence the pair ($C$, $A$) is detectable.",
    "yes_stabilizability": "Hence the pair ($A$, $B$) is stabilizable.",
    "no_detectability": "Hence the pair ($C$, $A$) is not detectable.",
    "no_stabilizability": "Hence the pair ($A$, $B$) is not stabilizable.",
    "seen_detectability": "An observable pair is detectable.",
    "seen_stabilizability": "A controllable pair is stabilizable.",
    "marginal_continuous": "No root lies in the open right half-plane.",
    "marginal_discrete": "No root lies outside the unit circle.",
    "semisimple": "The modes on the boundary are semisimple and hence bounded, since the polynomial {polynomial}, in which they are simple roots, annihilates $X$.",
    "grows": "A root on the boundary is defective, and the corresponding mode is unbounded, since the polynomial {polynomial} does not annihilate $X$.",
    "apart_provided": "The modes on the boundary are distinct provided that {condition}.",
    "grows_detectability": "If such a mode is unbounded, the pair ($C$, $A$) is not detectable.",
    "grows_stabilizability": "If such a mode is unbounded, the pair ($A$, $B$) is not stabilizable.",
    "beyond_continuous": "A root lies in the open right half-plane.",
    "beyond_discrete": "A root lies outside the unit circle.",
    "fixed_polynomial": "The fixed modes are the roots of",
    "marginal_if": "It is stable in this sense if and only if {where}.",
    "lyapunov_undecided": "Whether such a mode is bounded is not decided here.",
    "exactly_there_detectability": "The pair ($C$, $A$) is detectable if and only if this holds.",
    "exactly_there_stabilizability": "The pair ($A$, $B$) is stabilizable if and only if this holds.",
    "boundary_undecided": "The boundary of this region is not decided here.",
}

QUESTIONS: dict[str, str] = {
    "ask pbh": "Test the pair ($C$, $A$) for observability by the PBH test.",
    "ask pbh of=observability": "Test the pair ($C$, $A$) for observability by the PBH test.",
    "ask pbh of=controllability": "Test the pair ($A$, $B$) for controllability by the PBH test.",
    "ask detectability": "Is the pair ($C$, $A$) detectable?",
    "ask detectability meaning=asymptotic": "Is the pair ($C$, $A$) detectable, that is, are its unobservable modes asymptotically stable?",
    "ask detectability meaning=lyapunov": "Is the pair ($C$, $A$) detectable in the weaker sense that its unobservable modes are stable in the sense of Lyapunov?",
    "ask stabilizability": "Is the pair ($A$, $B$) stabilizable?",
    "ask stabilizability meaning=asymptotic": "Is the pair ($A$, $B$) stabilizable, that is, are its uncontrollable modes asymptotically stable?",
    "ask stabilizability meaning=lyapunov": "Is the pair ($A$, $B$) stabilizable in the weaker sense that its uncontrollable modes are stable in the sense of Lyapunov?",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "only_stable": ("stable",),
    "marginal_continuous": ("marginal",),
    "marginal_discrete": ("marginal",),
    "beyond_continuous": ("beyond",),
    "beyond_discrete": ("beyond",),
}

DEMANDS: dict[str, str] = {
    "pbh_yes_observability": "needs_observable",
    "pbh_yes_controllability": "needs_controllable",
    "no_fixed_modes_observability": "needs_observable",
    "no_fixed_modes_controllability": "needs_controllable",
    "pbh_no_observability": "needs_unobservable",
    "pbh_no_controllability": "needs_uncontrollable",
    "yes_detectability": "needs_modes_stable",
    "yes_stabilizability": "needs_modes_stable",
    "no_detectability": "needs_modes_unstable",
    "no_stabilizability": "needs_modes_unstable",
}

RESTS_ON: dict[str, str] = {
    "pbh_asks_observability": "pbh",
    "pbh_asks_controllability": "pbh",
    "asks_detectability_continuous": "detectability",
    "asks_detectability_discrete": "detectability",
    "asks_stabilizability_continuous": "detectability",
    "asks_stabilizability_discrete": "detectability",
    "means_detectability": "detectability",
    "means_stabilizability": "detectability",
    "means_lyapunov": "lyapunov",
}

THEOREMS: dict[str, str] = {
    "pbh": "popov1973; belevitch1968; hautus1969",
    "detectability": "wonham1968; hautus1970",
    "lyapunov": "brogan1991",
}

EXPLAINS = (
    "asks_detectability_continuous",
    "asks_stabilizability_continuous",
    "asks_detectability_discrete",
    "asks_stabilizability_discrete",
    "means_detectability",
    "means_stabilizability",
    "pbh_asks_observability",
    "pbh_asks_controllability",
)
