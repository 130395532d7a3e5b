"""Modes one by one: the test of Popov, Belevitch and Hautus, detectability and stabilizability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pbh": "The test at each eigenvalue.",
    "detectability": "Detectability.",
    "stabilizability": "Stabilizability.",
    "eigenvalue_polynomial": "The eigenvalues of $A$ are the roots of its characteristic polynomial",
    "eigenvalues": "<The only one is|They are> {roots}.",
    "eigenvalues_open": "Where a factor has no roots in closed form, λ stands for any of them.",
    "pbh_asks_observability": "The pair ($C$, $A$) is observable exactly if the matrix of $A - lambda I$ over $C$ has full rank at each of them.",
    "pbh_asks_controllability": "The pair ($A$, $B$) is controllable exactly if the matrix of $A - lambda I$ beside $B$ has full rank at each of them.",
    "pbh_low_observability": "The rank is too low: an eigenvector is not seen at the output,",
    "pbh_low_controllability": "The rank is too low: a left eigenvector is not moved by the input,",
    "pbh_yes_observability": "The rank is full at every eigenvalue, so the pair ($C$, $A$) is observable.",
    "pbh_yes_controllability": "The rank is full at every eigenvalue, so the pair ($A$, $B$) is controllable.",
    "pbh_no_observability": "The rank is too low at some eigenvalue, so the pair ($C$, $A$) is not observable.",
    "pbh_no_controllability": "The rank is too low at some eigenvalue, so the pair ($A$, $B$) is not controllable.",
    "pbh_general": "What is true of other parameters is told without eigenvalues.",
    "ranks_meet": "There a rank is lower than in general.",
    "fixed_modes_observability": "The unobservable modes, which no observer gain can move, are those of $A$ on the kernel:",
    "fixed_modes_controllability": "The uncontrollable modes, which no feedback gain can move, are those of $Aᵀ$ on the left kernel:",
    "on_kernel_observability": "On the kernel, whose basis are the columns of $N$, the matrix $A$ acts as $X$:",
    "on_kernel_controllability": "On the left kernel, whose basis are the columns of $N$, the matrix $Aᵀ$ acts as $X$:",
    "no_fixed_modes_observability": "There are no unobservable modes.",
    "no_fixed_modes_controllability": "There are no uncontrollable modes.",
    "asks_detectability_continuous": "The pair ($C$, $A$) is detectable exactly if the matrix of $A - lambda I$ over $C$ has full rank at every eigenvalue with "
    "a real part that is not negative.",
    "asks_detectability_discrete": "The pair ($C$, $A$) is detectable exactly if the matrix of $A - lambda I$ over $C$ has full rank at every eigenvalue that is "
    "not inside the unit circle.",
    "asks_stabilizability_continuous": "The pair ($A$, $B$) is stabilizable exactly if the matrix of $A - lambda I$ beside $B$ has full rank at every eigenvalue with "
    "a real part that is not negative.",
    "asks_stabilizability_discrete": "The pair ($A$, $B$) is stabilizable exactly if the matrix of $A - lambda I$ beside $B$ has full rank at every eigenvalue that is "
    "not inside the unit circle.",
    "only_stable": "There is no such eigenvalue: every mode is stable.",
    "means_lyapunov": "Only stability in the sense of Lyapunov is asked for here: a hidden mode may also lie on the boundary, provided that it does "
    "not grow.",
    "means_detectability": "The pair ($C$, $A$) is detectable exactly if its unobservable modes are stable.",
    "means_stabilizability": "The pair ($A$, $B$) is stabilizable exactly if its uncontrollable modes are stable.",
    "yes_detectability": "So the pair ($C$, $A$) is detectable.",
    "yes_stabilizability": "So the pair ($A$, $B$) is stabilizable.",
    "no_detectability": "So the pair ($C$, $A$) is not detectable.",
    "no_stabilizability": "So the pair ($A$, $B$) is not stabilizable.",
    "seen_detectability": "An observable pair is detectable.",
    "seen_stabilizability": "A controllable pair is stabilizable.",
    "marginal_continuous": "No root lies in the open right half plane.",
    "marginal_discrete": "No root lies outside the unit circle.",
    "semisimple": "Those on the boundary do not grow, since the polynomial {polynomial}, in which they are simple, is zero at the matrix $X$.",
    "grows": "A root on the boundary is defective, so the mode grows with time, since the polynomial {polynomial} is not zero at the matrix $X$.",
    "apart_provided": "No two of the modes on the boundary meet provided that {condition}.",
    "grows_detectability": "Where such a mode grows, the pair ($C$, $A$) is not detectable.",
    "grows_stabilizability": "Where such a mode grows, the pair ($A$, $B$) is not stabilizable.",
    "beyond_continuous": "A root lies in the open right half plane.",
    "beyond_discrete": "A root lies outside the unit circle.",
    "fixed_polynomial": "The hidden modes are the roots of",
    "marginal_if": "It is stable in this sense exactly where {where}.",
    "lyapunov_undecided": "Whether such a mode grows is not decided here.",
    "exactly_there_detectability": "Exactly there the pair ($C$, $A$) is detectable.",
    "exactly_there_stabilizability": "Exactly there the pair ($A$, $B$) is stabilizable.",
    "boundary_undecided": "What is true on the boundary of this region is not decided here.",
}

QUESTIONS: dict[str, str] = {
    "ask pbh": "Test the observability of the pair ($C$, $A$) eigenvalue by eigenvalue.",
    "ask pbh of=observability": "Test the observability of the pair ($C$, $A$) eigenvalue by eigenvalue.",
    "ask pbh of=controllability": "Test the controllability of the pair ($A$, $B$) eigenvalue by eigenvalue.",
    "ask detectability": "Is the pair ($C$, $A$) detectable?",
    "ask detectability meaning=asymptotic": "Is the pair ($C$, $A$) detectable, the hidden modes being asymptotically stable?",
    "ask detectability meaning=lyapunov": "Is the pair ($C$, $A$) detectable, the hidden modes being stable in the sense of Lyapunov?",
    "ask stabilizability": "Is the pair ($A$, $B$) stabilizable?",
    "ask stabilizability meaning=asymptotic": "Is the pair ($A$, $B$) stabilizable, the modes that are not reached being asymptotically stable?",
    "ask stabilizability meaning=lyapunov": "Is the pair ($A$, $B$) stabilizable, the modes that are not reached being stable in the sense of Lyapunov?",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "only_stable": ("stable",),
    "marginal_continuous": ("marginal",),
    "marginal_discrete": ("marginal",),
    "beyond_continuous": ("beyond",),
    "beyond_discrete": ("beyond",),
}

DEMANDS: dict[str, str] = {
    "pbh_yes_observability": "needs_rank_full",
    "pbh_yes_controllability": "needs_rank_full",
    "no_fixed_modes_observability": "needs_rank_full",
    "no_fixed_modes_controllability": "needs_rank_full",
    "pbh_no_observability": "needs_rank_low",
    "pbh_no_controllability": "needs_rank_low",
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

THEOREMS: dict[str, tuple[str, str]] = {
    "pbh": ("test of Popov, Belevitch and Hautus", "S0, chapter 4"),
    "detectability": ("detectability", "S0, section 4.4"),
    "lyapunov": ("detectability in the sense of Lyapunov", "S3, footnote 1"),
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
