"""The theorems that a derivation rests on, with their sources."""

from __future__ import annotations

from symobs._dataclass import dataclass


@dataclass(frozen=True)
class Theorem:
    """A statement that a step rests on: its short name and where it is proved."""

    name: str
    source: str


THEOREMS: dict[str, Theorem] = {
    "reconstruction": Theorem("initial state from measurements", "S0, (4.6)-(4.11)"),
    "noise": Theorem("uncertainty of the initial state", "S4, Exercise 3"),
    "gramian": Theorem("Gramian criterion", "S0, Proposition 4.1 and (4.8)"),
    "finite_sum": Theorem("equality of the kernels", "S0, Theorem 4.3"),
    "exponential": Theorem(
        "matrix exponential by its derivatives at 0", "E. J. Putzer, Amer. Math. Monthly 73 (1966), 2-7"
    ),
    "observability_rank": Theorem("rank test for observability", "S0, Theorem 4.2"),
    "controllability_rank": Theorem("rank test for controllability", "S0, Theorem 2.2, dual to Theorem 4.2"),
    "pbh": Theorem("test of Popov, Belevitch and Hautus", "S0, chapter 4"),
    "detectability": Theorem("detectability", "S0, section 4.4"),
    "lyapunov": Theorem("detectability in the sense of Lyapunov", "S3, footnote 1"),
    "duality": Theorem("duality", "S0, Theorem 4.1"),
    "duality_reversed": Theorem("duality through −Aᵀ", "S4"),
    "observer_poles": Theorem("pole assignment for observers", "S0, Theorem 4.4"),
    "state_feedback_poles": Theorem(
        "pole assignment for state feedback", "W. M. Wonham, IEEE Trans. Autom. Control 12 (1967), 660-665"
    ),
    "canonical_form": Theorem("placement through canonical form", "S0, Example 4.1"),
    "decomposition": Theorem("Kalman's decomposition", "R. E. Kalman, Proc. Nat. Acad. Sci. 48 (1962), 596-600"),
    "row_reduction": Theorem("row-reduced echelon method", "S3, (7)-(10)"),
    "companion_form": Theorem("placement through companion form", "S1, slide at 16:01"),
    "sylvester": Theorem(
        "pole assignment by Sylvester's equation",
        "S. P. Bhattacharyya and E. de Souza, Systems & Control Letters 1 (1982), 261-263",
    ),
    "ackermann": Theorem("Ackermann's formula", "J. Ackermann, Regelungstechnik 20 (1972), 297-300"),
    "observer": Theorem("full-order observer", "S0, (4.18)-(4.20)"),
    "error": Theorem("error equation", "S0, (4.19)"),
    "reduced_order": Theorem("reduced-order observer", "S0, (4.37)-(4.41)"),
    "reduced_pair": Theorem("observability of the unmeasured part", "S0, Lemma 4.1"),
    "first_attempt": Theorem("the reduced observer that no gain corrects", "S2"),
    "undetermined": Theorem("conditions on the observer matrices", "S2"),
    "similarity": Theorem("from estimate to error", "S1, slide at 28:08"),
    "existence": Theorem("existence of an asymptotic observer", "S4"),
    "tracking": Theorem("tracking of a reference", "S2"),
    "feedforward": Theorem("feedforward for unit gain at rest", "S3, section G and (12)"),
    "zeros_first": Theorem("observer eigenvalues at the plant's zeros", "S3, section F"),
    "butterworth": Theorem("Butterworth configuration", "W. L. Brogan, Modern Control Theory, 3rd ed., pp. 532-533"),
    "minimal_order": Theorem("compensator with a minimal-order observer", "S0, section 4.6"),
    "separation": Theorem("separation principle", "S0, (4.23)-(4.24)"),
    "compensator": Theorem("compensator in transfer form", "S0, (4.25)"),
    "time_varying_rank": Theorem(
        "rank test for time-varying plants",
        "L. M. Silverman and H. E. Meadows, SIAM J. Control 5 (1967), 64-73",
    ),
    "time_varying_gramian": Theorem("initial state through the Gramian", "S4, time-varying plants"),
    "peano_baker": Theorem("Peano-Baker series", "W. J. Rugh, Linear System Theory, 2nd ed. (1996), chapter 3"),
    "routh": Theorem(
        "Routh's criterion", "E. J. Routh, A Treatise on the Stability of a Given State of Motion (Macmillan, 1877)"
    ),
    "sturm": Theorem("Sturm's theorem", "C. Sturm, 1829"),
    "orlando": Theorem("Orlando's formula", "L. Orlando, Math. Ann. 71 (1911), 233-245"),
    "collins": Theorem("cylindrical decomposition", "G. E. Collins, 1975"),
    "hurwitz": Theorem("Hurwitz's criterion", "A. Hurwitz, Math. Ann. 46 (1895), 273-284"),
    "lienard_chipart": Theorem(
        "criterion of Liénard and Chipart",
        "A. Liénard and M. H. Chipart, J. Math. Pures Appl. 10 (1914), 291-346",
    ),
    "closed_loop": Theorem("closed loop in state and error", "S0, (4.26)-(4.29)"),
}
