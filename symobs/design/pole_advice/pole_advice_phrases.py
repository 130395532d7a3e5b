"""Where to put the poles of an observer, and what to beware of."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pole_advice": "Zeros first.",
    "step_asked_for": "Settling to 2 % and overshoot of a step response are to be at most",
    "numerator_of_plant": "The zeros of the plant are the roots of the numerator",
    "transfer_from_numerator": "of the transfer function",
    "advice_zeros": "The <only zero is|zeros are> {roots}.",
    "no_zeros": "The plant has no finite zeros.",
    "zeros_taken": "The fastest observer is not the most robust one: its eigenvalues belong first at the stable zeros§. Those used here are the roots of",
    "no_zeros_taken": "No zero is used.",
    "none_remains": "They take all of the eigenvalues: none remains to be placed.",
    "one_on_circle": "One eigenvalue remains. It goes far to the left:",
    "some_on_circle": "The remaining {count} eigenvalues go far to the left, equally far from the origin and spread evenly: to the Butterworth "
    "configuration",
    "radius_is_positive": "As a radius, {radius} is positive.",
    "is_butterworth": "Its roots are those in the left half-plane of {identity}.",
    "circle_pairs": "Real and imaginary parts of the pairs can be read off",
    "rate_from_settling": "A mode with the real part $-sigma_d$ has decayed to less than 2 % after the settling time with",
    "decayed": "since {bound}.",
    "one_from_settling": "One eigenvalue remains, and a real one has no overshoot:",
    "overshoot_held": "The step response of a pair of poles with real part $-sigma_d$ and imaginary part $omega_d$ overshoots by {bound} with",
    "overshoot_close": "With the third digit of the ratio of $omega_d$ to $sigma_d$ one higher it would be {more}.",
    "pair_dominates": "The remaining {count} eigenvalues begin with this pair. Any others lie at least {factor} times as far to the left:",
    "advised_polynomial": "So the polynomial of the observer is advised to be",
    "recovery": "All zeros are used. For a large radius the polynomial is nearly that of the zeros times a power of the radius, and the gain nearly a "
    "multiple of $B$, since",
    "no_response": "The transfer function is zero, so every number is a zero and none is a place for a pole.",
    "zero_at_origin": "The plant has a zero at the origin, {zero}. It is not used: an observer pole at 0 would keep its error for ever.",
    "zero_on_axis": "A zero lies on the imaginary axis, {zero}, and is not used: an error would not decay.",
    "zero_on_axiss": "Zeros lie on the imaginary axis, {zero}, and are not used: an error would not decay.",
    "zero_right": "A zero lies in the right half-plane, {zero}, and cannot be used: the observer would be unstable. The robustness of full state feedback "
    "cannot be recovered.",
    "zero_rights": "Zeros lie in the right half-plane, {zero}, and cannot be used: the observer would be unstable. The robustness of full state feedback "
    "cannot be recovered.",
    "zero_mixeds": "Zeros lie on both sides of the imaginary axis, {zero}. None of them is used, for the stable ones have no factor of their own here.",
    "zero_never": "A zero, {zero}, is no place for a pole whatever the parameters are, and is not used.",
    "zero_nevers": "Not all of the zeros {zero} are places for poles, whatever the parameters are, and none of them is used.",
    "zero_open": "Whether a zero is stable, {zero}, depends on parameters. It is used in the case below where it is.",
    "zero_opens": "Whether zeros are stable, {zero}, depends on parameters. They are used in the case below where they are.",
    "zero_slow_open": "Whether a zero is fast enough for the settling time, {zero}, depends on parameters. It is used in the case below where it is.",
    "zero_slow_opens": "Whether zeros are fast enough for the settling time, {zero}, depends on parameters. They are used in the case below where "
    "they are.",
    "advice_provided": "This is for a plant with as many zeros as in general, all of whose modes are seen and moved: {condition}.",
    "zero_slow": "A zero is too slow for the settling time, {zero}, and is not used.",
    "zero_slows": "Zeros are too slow for the settling time, {zero}, and are not used.",
    "cancels": "A zero, {zero}, is an eigenvalue of $A$ as well, {pole}: this mode is not observable or not controllable.",
    "nearly_cancels": "A zero, {zero}, is close to a pole of the plant, {pole}. Such a mode is hardly observable or hardly controllable, and small errors "
    "of the model matter.",
    "always_unstable": "Every compensator that stabilises this plant is itself unstable: at a zero in the right half-plane the characteristic "
    "polynomial is negative.",
    "huge_gain": "The observer gain has an entry beyond {limit}: measurement noise would be amplified that much. Take the poles less far to the left.",
    "modes_missed": "The roots of {polynomial} are modes that no observer gain moves, and they are not all among these poles: no gain places them.",
}

QUESTIONS: dict[str, str] = {
    "ask pole_advice": "Where should the poles of the observer lie?",
    "also pole_advice radius": "Those that do not lie at zeros of the plant are to lie on a circle of radius {radius}.",
    "also pole_advice settling_time": "The estimate is to settle to 2 % within the time {settling_time}.",
    "also pole_advice overshoot": "A step response is to overshoot by at most the fraction {overshoot} of the step.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "always_unstable": ("no_stable_compensator",),
}

DEMANDS: dict[str, str] = {
    "decayed": "says_decay",
    "overshoot_held": "says_overshoot",
    "overshoot_close": "says_overshoot_above",
}

RESTS_ON: dict[str, str] = {
    "zeros_taken": "zeros_first",
    "some_on_circle": "butterworth",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "zeros_first": ("observer eigenvalues at the plant's zeros", "S3, section F"),
    "butterworth": ("Butterworth configuration", "W. L. Brogan, Modern Control Theory, 3rd ed., pp. 532-533"),
}

NAMING = ("radius_is_positive",)
