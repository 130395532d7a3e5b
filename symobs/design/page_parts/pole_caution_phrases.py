"""Cautions beside poles that were asked for and are not stable."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "grows_observer_continuous": "Not all poles asked for lie in the open left half plane: from almost every start the estimation error grows without bound.",
    "lasts_observer_continuous": "Not all poles asked for lie in the open left half plane: the estimation error need not decay.",
    "stays_observer_continuous": "A pole asked for lies on the imaginary axis: a part of the estimation error stays for ever.",
    "grows_observer_discrete": "Not all poles asked for lie inside the unit circle: from almost every start the estimation error grows without bound.",
    "lasts_observer_discrete": "Not all poles asked for lie inside the unit circle: the estimation error need not decay.",
    "stays_observer_discrete": "A pole asked for lies on the unit circle: a part of the estimation error stays for ever.",
    "grows_state_feedback_continuous": "Not all poles asked for lie in the open left half plane: this feedback makes the loop unstable.",
    "lasts_state_feedback_continuous": "Not all poles asked for lie in the open left half plane: with this feedback the loop need not come to rest.",
    "stays_state_feedback_continuous": "A pole asked for lies on the imaginary axis: with this feedback the loop does not come to rest by itself.",
    "drifts_state_feedback_continuous": "A pole asked for is 0: with this feedback the loop comes to rest, but where its start decides.",
    "drifts_state_feedback_discrete": "A pole asked for is 1: with this feedback the loop comes to rest, but where its start decides.",
    "grows_state_feedback_discrete": "Not all poles asked for lie inside the unit circle: this feedback makes the loop unstable.",
    "lasts_state_feedback_discrete": "Not all poles asked for lie inside the unit circle: with this feedback the loop need not come to rest.",
    "stays_state_feedback_discrete": "A pole asked for lies on the unit circle: with this feedback the loop does not come to rest by itself.",
    "law_unstable_continuous": "Without the plant this law is unstable: not all eigenvalues of {matrix} lie in the open left half plane.",
    "law_unstable_discrete": "Without the plant this law is unstable: not all eigenvalues of {matrix} lie inside the unit circle.",
    "hides_continuous": "$F$ does not show the whole compensator: <the mode that cancels in it, |of the modes that cancel in it, >{modes}<, does not lie|, not all lie> in the open left half plane, so without the plant the law is unstable.",
    "hides_discrete": "$F$ does not show the whole compensator: <the mode that cancels in it, |of the modes that cancel in it, >{modes}<, does not lie|, not all lie> inside the unit circle, so without the plant the law is unstable.",
    "some_hidden": "$F$ does not show the whole compensator: the <mode that cancels|modes that cancel> in it, {modes}, <is|are> stable exactly where {where}.",
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
