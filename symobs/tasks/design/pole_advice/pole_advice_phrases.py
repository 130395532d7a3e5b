"""Sentences of the advice on observer poles."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pole_advice": "Choice of the observer poles.",
    "step_asked_for": "The specifications are a 2 % settling time and a step-response overshoot of at most",
    "numerator_of_plant": "The zeros of the plant are the roots of the numerator",
    "transfer_from_numerator": "of the transfer function",
    "advice_zeros": "The <only zero is|zeros are> {roots}.",
    "no_zeros": "The plant has no finite zeros.",
    "zeros_taken": "Fast observer poles alone do not give a robust loop; some of them are placed at the stable zeros of the plant§. The zeros used here are the roots of",
    "no_zeros_taken": "No zero is used.",
    "none_remains": "They use up all observer poles; none remains to be placed.",
    "one_on_circle": "One observer pole remains; it is placed far into the left half-plane:",
    "some_on_circle": "The remaining {count} observer poles are placed far into the left half-plane in a Butterworth configuration",
    "radius_is_positive": "Being a radius, {radius} is positive.",
    "is_butterworth": "Its roots are the left-half-plane roots of {identity}.",
    "circle_pairs": "The real and imaginary parts of the complex pairs follow from",
    "rate_from_settling": "A mode with real part $-sigma_d$ decays to less than 2 % within the settling time if",
    "decayed": "since {bound}.",
    "one_from_settling": "One observer pole remains; a real pole gives no overshoot:",
    "overshoot_held": "The step response of a complex pair with real part $-sigma_d$ and imaginary part $omega_d$ has the overshoot exp(−π $sigma_d$/$omega_d$). It satisfies {bound} for",
    "overshoot_close": "Increasing the ratio of $omega_d$ to $sigma_d$ by one unit in its third digit would give {more}.",
    "pair_remains": "The remaining {count} observer poles are this pair:",
    "pair_dominates": "Among the remaining {count} observer poles this pair is dominant; every other pole lies at least {factor} times as far to the left:",
    "advised_polynomial": "The recommended observer polynomial is therefore",
    "pole_twice": "A zero used here coincides with one of the further poles: the observer has a repeated pole, {repeated}.",
    "recovery": "All zeros are used. For a large radius the observer polynomial approaches the zero polynomial times a power of the radius, and the gain approaches a multiple of $B$, since",
    "no_response": "The transfer function is identically zero, so its zeros give no guidance for the pole locations.",
    "zero_at_origin": "The plant has a zero at the origin, {zero}. It is not used, since with an observer pole at 0 the error would not decay.",
    "zero_on_axis": "A zero lies on the imaginary axis, {zero}, and is not used, since the estimation error would not decay.",
    "zero_on_axiss": "Zeros lie on the imaginary axis, {zero}, and are not used, since the estimation error would not decay.",
    "zero_right": "A zero lies in the right half-plane, {zero} (nonminimum phase), and cannot be used: the observer would be unstable. The robustness of full state feedback cannot be recovered.",
    "zero_rights": "Zeros lie in the right half-plane, {zero} (nonminimum phase), and cannot be used: the observer would be unstable. The robustness of full state feedback cannot be recovered.",
    "zero_mixeds": "Zeros lie on both sides of the imaginary axis, {zero}. None is used, since the stable ones do not form a separate factor over the field of the data.",
    "zero_never": "A zero, {zero}, is not stable for any parameter values and is not used.",
    "zero_nevers": "For no parameter values are all the zeros, {zero}, stable, and none of them is used.",
    "zero_open": "The stability of a zero, {zero}, depends on the parameters. It is used in the case below in which it is stable.",
    "zero_opens": "The stability of zeros, {zero}, depends on the parameters. They are used in the case below in which they are stable.",
    "zero_slow_open": "Whether a zero, {zero}, is fast enough for the settling time depends on the parameters. It is used in the case below in which it is.",
    "zero_slow_opens": "Whether zeros, {zero}, are fast enough for the settling time depends on the parameters. They are used in the case below in which they are.",
    "advice_provided": "This assumes a controllable and observable plant with the generic number of zeros: {condition}.",
    "zero_slow": "The <zero {zero} is|zeros {zero} are> too slow for the settling time and <is|are> not used.",
    "cancels": "A zero, {zero}, coincides with an eigenvalue of $A$, {pole}: this mode is unobservable or uncontrollable.",
    "nearly_cancels": "A zero, {zero}, nearly cancels a pole of the plant, {pole}. The mode is weakly observable or weakly controllable, and the design is sensitive to model errors.",
    "always_unstable": "Every stabilising compensator of this plant is itself unstable: at a real zero in the right half-plane the characteristic polynomial is negative (no parity interlacing).",
    "huge_gain": "An entry of the observer gain exceeds {limit}, which amplifies measurement noise accordingly. Choose slower observer poles.",
    "modes_missed": "The roots of {polynomial} are unobservable modes, and not all of them are among these poles: no gain places the poles.",
}

QUESTIONS: dict[str, str] = {
    "ask pole_advice": "Where should the observer poles be placed?",
    "also pole_advice radius": "Place those that are not at zeros of the plant on a circle of radius {radius}.",
    "also pole_advice settling_time": "The 2 % settling time of the estimate must not exceed {settling_time}.",
    "also pole_advice overshoot": "The overshoot of the step response must not exceed the fraction {overshoot}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "always_unstable": ("no_stable_compensator",),
}

DEMANDS: dict[str, str] = {
    "decayed": "says_decay",
    "overshoot_held": "says_overshoot",
    "overshoot_close": "says_overshoot_above",
    "one_on_circle": "introduces_degree_one",
    "one_from_settling": "introduces_degree_one",
    "some_on_circle": "counts_degree",
    "pair_remains": "counts_degree",
    "pair_dominates": "counts_dominant",
    "modes_missed": "fixes C A N X phi_o",
    "no_response": "no_effect C A B, no_feedthrough",
    "no_zeros": "is_constant b_P",
    "no_zeros_taken": "is_constant phi_z",
    "none_remains": "is_constant phi_r",
}

RESTS_ON: dict[str, str] = {
    "zeros_taken": "zeros_first",
    "some_on_circle": "butterworth",
    "always_unstable": "parity_interlacing",
}

THEOREMS: dict[str, str] = {
    "zeros_first": "doyle1979",
    "butterworth": "butterworth1930; brogan1991, pp. 532–533",
}

NAMING = ("radius_is_positive",)

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "transfer_from_numerator",
    "decayed",
)
