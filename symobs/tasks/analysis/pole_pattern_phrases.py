"""A desired polynomial that is given by what its roots are to do."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "pattern_damping": "Damping ratio {damping} and natural frequency {frequency} give {pair}.",
    "pattern_damped": "It has a pair of roots with the specified damping ratio: {pair}.",
    "pattern_settling": "The amplitude of the mode of its pair of roots decays to less than 2 % of its initial value within the specified settling time {time}: {pair}, and {bound}.",
    "pattern_overshoot": "The imaginary part of this pair is as large as the specified overshoot of the step response allows: {bound}.",
    "pattern_butterworth": "It is a Butterworth polynomial§: {identity}.",
    "pattern_butterworth_beside": "It has a Butterworth polynomial§ as a factor: {identity}.",
    "pattern_bessel": "It is a Bessel polynomial§; by its recursion {recursion}.",
    "pattern_bessel_beside": "It has a Bessel polynomial§ as a factor; by its recursion {recursion}.",
    "pattern_itae": "It is the tabulated ITAE polynomial§ of its degree.",
    "pattern_itae_beside": "It has a tabulated ITAE polynomial§ as a factor: {polynomial}.",
}

DEMANDS: dict[str, str] = {
    "pattern_damping": "of_damping",
}

RESTS_ON: dict[str, str] = {
    "pattern_butterworth": "butterworth",
    "pattern_butterworth_beside": "butterworth",
    "pattern_bessel": "bessel_filter",
    "pattern_bessel_beside": "bessel_filter",
    "pattern_itae": "itae",
    "pattern_itae_beside": "itae",
}

THEOREMS: dict[str, str] = {
    "bessel_filter": "thomson1949",
    "itae": "graham1953",
}

NAMING = ("pattern_damping",)
