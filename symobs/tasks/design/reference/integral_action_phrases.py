"""Integral action."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "integral_action": "Integral action.",
    "integral_state_continuous": "The integral of the control error is added to the plant as a further state§:",
    "integral_state_discrete": "The sum of the control errors is added to the plant as a further state§:",
    "integral_extended": "With the matrices",
    "integral_together": "plant and integrator together satisfy",
    "integral_possible_origin": "The poles of this system can be assigned arbitrarily, complex ones in conjugate pairs, since ($A$, $B$) is controllable, {controllable}, and the plant has no zero at the origin, {rank}.",
    "integral_possible_one": "The poles of this system can be assigned arbitrarily, complex ones in conjugate pairs, since ($A$, $B$) is controllable, {controllable}, and the plant has no zero at 1, {rank}.",
    "integral_blocked": "The outputs cannot follow arbitrary constant references, since with {row} we obtain {annuls}: a pole of the integrators cannot be moved.",
    "integral_uncontrollable": "The pair ($A$, $B$) is not controllable, {rank}.",
    "integral_impossible": "The roots of {fixed} are uncontrollable modes of plant and integrator, and not all of them are among the desired poles: no gains exist.",
    "integral_unassignable": "The roots of {fixed} are uncontrollable modes of plant and integrator, and the division of {polynomial} by it leaves the remainder {rest}: gains exist only where this remainder is the zero polynomial.",
    "integral_provided": "What follows holds for {condition}.",
    "integral_unknown": "With unknown gains, the characteristic polynomial of plant and integrator is",
    "integral_gains": "The design of state feedback for plant and integrator together gives",
    "integral_parts": "Hence the gains of the state and of the integral are",
    "integral_law": "The control law is",
    "integral_family": "The gain is not unique: other gains assign the same polynomial.",
    "integral_loop": "In the coordinates ($x$, $xi_I$) the closed loop has the system matrix",
    "integral_closed": "The closed loop is therefore",
    "integral_rest": "If the closed loop is stable, the control error vanishes in the steady state, since the DC gain from $r_in$ to $y$ is {gain}.",
    "integral_rest_stable": "The control error vanishes in the steady state, since the closed loop is stable and the DC gain from $r_in$ to $y$ is {gain}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "integral_unassignable": ("strictly_proper",),
    "integral_impossible": ("not_polynomial",),
    "integral_rest_stable": ("stable",),
}

QUESTIONS: dict[str, str] = {
    "means integral_action": "The law is $u = -K x + k_I xi_I$ with the integral $xi_I$ of $r_in - y$.",
    "ask integral_action": "Design state feedback with integral action, such that the output follows constant references.",
    "ask integral_action poles": "Design state feedback with integral action, such that the output follows constant references and the closed loop has the poles {poles}.",
    "ask integral_action polynomial": "Design state feedback with integral action, such that the output follows constant references and the closed loop has the characteristic polynomial {polynomial}.",
}

DEMANDS: dict[str, str] = {
    "integral_possible_origin": "moves_integrators, continuous_time",
    "integral_possible_one": "moves_integrators, discrete_time",
    "integral_blocked": "unobservable B_hatᵀ A_hatᵀ",
    "integral_uncontrollable": "says_unobservable Bᵀ Aᵀ",
    "integral_impossible": "fixes B_hatᵀ A_hatᵀ N_K X_K phi_c",
    "integral_unassignable": "fixes B_hatᵀ A_hatᵀ N_K X_K phi_c",
    "integral_rest_stable": "about phi_c",
    "integral_family": "not_unique B_hatᵀ A_hatᵀ",
}

RESTS_ON: dict[str, str] = {
    "integral_state_continuous": "integral_action",
    "integral_state_discrete": "integral_action",
}

THEOREMS: dict[str, str] = {
    "integral_action": "davison1976; ogata2010, ch. 10",
}

#: Phrases that go on with the sentence before them.
FIGURES: dict[str, dict[str, object]] = {
    "integral_loop": {
        "grid": """
        r  e  ∫xi  Ki  u  Plant  y'  y
        .  .  .    .   K  x      .   .
        .  .  .    .   .  c      .   .
        """,
        "routes": (
            "r > e > ∫xi > Ki > u > Plant > y' > y",
            "Plant > x > K > u",
            "y' |- c -|[U] e",
        ),
        "signals": {"r": "r_in", "u": "u", "y": "y", "x": "x", "xi": "xi_I"},
    },
}

CONTINUES = ("integral_together",)
