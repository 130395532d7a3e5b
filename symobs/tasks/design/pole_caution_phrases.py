"""Cautions about desired poles that are not stable."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "grows_observer_continuous": "Not all desired poles lie in the open left half-plane: for almost every initial error the estimation error grows without bound.",
    "lasts_observer_continuous": "Not all desired poles lie in the open left half-plane: the estimation error need not decay.",
    "stays_observer_continuous": "A desired pole lies on the imaginary axis: a component of the estimation error does not decay.",
    "grows_observer_discrete": "Not all desired poles lie inside the unit circle: for almost every initial error the estimation error grows without bound.",
    "lasts_observer_discrete": "Not all desired poles lie inside the unit circle: the estimation error need not decay.",
    "stays_observer_discrete": "A desired pole lies on the unit circle: a component of the estimation error does not decay.",
    "grows_state_feedback_continuous": "Not all desired poles lie in the open left half-plane: the closed loop is unstable.",
    "lasts_state_feedback_continuous": "Not all desired poles lie in the open left half-plane: the closed-loop state need not converge to zero.",
    "lasts_servo_continuous": "Not all desired poles lie in the open left half-plane: the outputs need not converge to a constant reference.",
    "lasts_servo_discrete": "Not all desired poles lie inside the unit circle: the outputs need not converge to a constant reference.",
    "stays_state_feedback_continuous": "A desired pole lies on the imaginary axis: for almost every initial state the closed loop does not converge to an equilibrium.",
    "drifts_state_feedback_continuous": "A desired pole is 0: the closed loop converges to an equilibrium that depends on the initial state.",
    "drifts_state_feedback_discrete": "A desired pole is 1: the closed loop converges to an equilibrium that depends on the initial state.",
    "grows_state_feedback_discrete": "Not all desired poles lie inside the unit circle: the closed loop is unstable.",
    "lasts_state_feedback_discrete": "Not all desired poles lie inside the unit circle: the closed-loop state need not converge to zero.",
    "stays_state_feedback_discrete": "A desired pole lies on the unit circle: for almost every initial state the closed loop does not converge to an equilibrium.",
    "law_unstable_continuous": "The compensator itself is unstable: not all eigenvalues of {matrix} lie in the open left half-plane.",
    "law_unstable_discrete": "The compensator itself is unstable: not all eigenvalues of {matrix} lie inside the unit circle.",
    "hides_continuous": "$F$ is not a complete description of the compensator: <the cancelled mode |not all of the cancelled modes >{modes}< does not lie| lie> in the open left half-plane, so the compensator itself is unstable.",
    "hides_discrete": "$F$ is not a complete description of the compensator: <the cancelled mode |not all of the cancelled modes >{modes}< does not lie| lie> inside the unit circle, so the compensator itself is unstable.",
    "some_hidden": "$F$ is not a complete description of the compensator: the cancelled <mode|modes> {modes} <is|are> stable if and only if {where}.",
}


ASSERTS: dict[str, tuple[str, ...]] = {
    "grows_observer_continuous": ("unstable", "beyond"),
    "lasts_observer_continuous": ("unstable",),
    "stays_observer_continuous": ("unstable", "marginal"),
    "grows_observer_discrete": ("unstable", "beyond"),
    "lasts_observer_discrete": ("unstable",),
    "stays_observer_discrete": ("unstable", "marginal"),
    "grows_state_feedback_continuous": ("unstable", "beyond"),
    "lasts_state_feedback_continuous": ("unstable",),
    "lasts_servo_continuous": ("unstable",),
    "lasts_servo_discrete": ("unstable",),
    "stays_state_feedback_continuous": ("unstable", "marginal"),
    "drifts_state_feedback_continuous": ("unstable", "marginal", "stable"),
    "drifts_state_feedback_discrete": ("unstable", "marginal", "stable"),
    "grows_state_feedback_discrete": ("unstable", "beyond"),
    "lasts_state_feedback_discrete": ("unstable",),
    "stays_state_feedback_discrete": ("unstable", "marginal"),
    "law_unstable_continuous": ("unstable",),
    "law_unstable_discrete": ("unstable",),
    "hides_continuous": ("unstable",),
    "hides_discrete": ("unstable",),
}


DEMANDS: dict[str, str] = {
    "grows_observer_continuous": "about phi_o",
    "grows_state_feedback_continuous": "about phi_c",
    "grows_observer_discrete": "about phi_o",
    "grows_state_feedback_discrete": "about phi_c",
    "lasts_observer_continuous": "about phi_o",
    "lasts_state_feedback_continuous": "about phi_c",
    "lasts_observer_discrete": "about phi_o",
    "lasts_state_feedback_discrete": "about phi_c",
    "stays_observer_continuous": "about phi_o",
    "stays_state_feedback_continuous": "about phi_c",
    "stays_observer_discrete": "about phi_o",
    "stays_state_feedback_discrete": "about phi_c",
    "lasts_servo_continuous": "about phi_c",
    "drifts_state_feedback_continuous": "about phi_c unstable marginal",
    "lasts_servo_discrete": "about phi_c",
    "drifts_state_feedback_discrete": "about phi_c unstable marginal",
    "law_unstable_continuous": "spectrum A_c",
    "law_unstable_discrete": "spectrum A_c",
}
