"""Where to put the poles of an observer, and what to beware of."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pole_advice": "Zeros first.",
    "numerator_of_plant": "The zeros of the plant are the roots of the numerator",
    "transfer_from_numerator": "of the transfer function",
    "advice_zeros": "They are {roots}.",
    "advice_zero": "There is one, {roots}.",
    "no_zeros": "The plant has no finite zeros.",
    "zeros_taken": "The fastest observer is not the most robust one: its eigenvalues belong first at the stable zeros. Those used here are the roots of",
    "no_zeros_taken": "No stable zero is there to be used.",
    "none_remains": "They take all of the eigenvalues: none remains to be placed.",
    "one_on_circle": "One eigenvalue remains. It goes far to the left, to the distance {radius} from the origin:",
    "some_on_circle": "The remaining {count} eigenvalues go far to the left, all at the distance {radius} from the origin and spread evenly: to the "
    "Butterworth configuration",
    "is_butterworth": "Its roots are the left half of those of {identity}.",
    "circle_pairs": "Real and imaginary parts of the pairs can be read off",
    "rate_from_settling": "A mode with the real part $-sigma_d$ has decayed to less than 2 % after the settling time {time} with",
    "decayed": "since {bound}.",
    "one_from_settling": "One eigenvalue remains, and a real one has no overshoot:",
    "overshoot_held": "The step response of a pair of poles with real part $-sigma_d$ and imaginary part $omega_d$ overshoots by {bound}, which is as "
    "little as asked for with",
    "pair_dominates": "The remaining {count} eigenvalues begin with this pair. The others, if any, lie at least {factor} times as far to the left:",
    "advised_polynomial": "So the polynomial of the observer is advised to be",
    "recovery": "All zeros are used. For a large radius the polynomial is nearly that of the zeros times a power of the radius, and the gain nearly a "
    "multiple of $B$, since",
    "no_response": "The transfer function is zero, so every number is a zero and none is a place for a pole.",
    "zero_at_origin": "The plant has a zero at 0. It is not used: an observer pole at 0 would keep its error for ever.",
    "zero_on_axis": "The zero {zero} lies on the imaginary axis and is not used: an error would not decay.",
    "zero_on_axiss": "The zeros with the factor {polynomial} lie on the imaginary axis and are not used: an error would not decay.",
    "zero_right": "The zero {zero} lies in the right half-plane and cannot be used: the observer would be unstable. The robustness of full state feedback "
    "cannot be recovered.",
    "zero_rights": "The zeros with the factor {polynomial} lie in the right half-plane and cannot be used: the observer would be unstable. The robustness "
    "of full state feedback cannot be recovered.",
    "zero_mixeds": "The zeros with the factor {polynomial} lie on both sides of the imaginary axis. None of them is used, for the stable ones have no factor "
    "of their own here.",
    "zero_open": "Whether the zero {zero} is stable depends on parameters, so it is not used. Declare their signs to use it.",
    "zero_opens": "Whether the zeros with the factor {polynomial} are stable depends on parameters, so they are not used. Declare their signs to use them.",
    "zero_slow": "The zero {zero} is too slow for the settling time and is not used.",
    "zero_slows": "The zeros with the factor {polynomial} are too slow for the settling time and are not used.",
    "cancels": "The zero {zero} is an eigenvalue of $A$ as well: this mode is not observable or not controllable.",
    "nearly_cancels": "The zero {zero} is close to the pole {pole} of the plant. Such a mode is hardly observable or hardly controllable, and small errors "
    "of the model matter.",
    "always_unstable": "Every compensator that stabilises this plant is itself unstable: at a zero in the right half-plane the characteristic "
    "polynomial is negative.",
    "huge_gain": "The observer gain has an entry beyond {limit}: measurement noise would be amplified that much. Take the poles less far to the left.",
    "modes_missed": "The roots of {polynomial} are modes that no observer gain moves, and they are not all among these poles: no gain places them.",
}

ASSERTS: dict[str, tuple[str, ...]] = {"always_unstable": ("no_stable_compensator",)}

#: Slots of warnings name a zero, a pole or a factor that the page shows as such.
NAMING = (
    *(key for key in PHRASES if key.startswith("zero_")),
    *("cancels", "nearly_cancels", "huge_gain", "one_on_circle", "some_on_circle", "rate_from_settling"),
)

RESTS_ON: dict[str, str] = {"zeros_taken": "zeros_first", "some_on_circle": "butterworth"}
