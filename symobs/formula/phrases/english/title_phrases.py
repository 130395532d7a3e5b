"""Headings, and what is given."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "given": "Given.",
    "row_where": "where",
    "row_modes": "fixed modes",
    "row_answer": "answer",
    "observability": "Observability.",
    "controllability": "Controllability.",
    "characteristic_polynomial": "Characteristic polynomial.",
    "transfer_function": "Transfer function.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "reduced_order_observer": "Reduced-order observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
    "existence": "Existence of an asymptotic observer.",
    "feedforward": "Feedforward.",
    "tracking": "Tracking.",
    "lowest_terms_parameters": "The cancelled factor is nonzero, since the function is undefined elsewhere: {condition}.",
    "lowest_terms": "The <pole|poles> {poles} <cancels|cancel>; what follows refers to the transfer function in lowest terms.",
    "lowest_terms_unstable_continuous": "The <pole|poles> {poles} <cancels|cancel>; what follows refers to the transfer function in lowest terms. In a plant with <this mode|these modes> <it is|they are> uncontrollable or unobservable, and <it does not lie|not all lie> in the open left half-plane.",
    "lowest_terms_unstable_discrete": "The <pole|poles> {poles} <cancels|cancel>; what follows refers to the transfer function in lowest terms. In a plant with <this mode|these modes> <it is|they are> uncontrollable or unobservable, and <it does not lie|not all lie> inside the unit circle.",
    "lowest_terms_where": "The <pole|poles> {poles} <cancels|cancel>; what follows refers to the transfer function in lowest terms. In a plant with <this mode|these modes> <it is|they are> uncontrollable or unobservable, and stable if and only if {where}.",
    "nonlinear_continuous": "The plant is d/dt ({states:list}) = $f$({arguments:list}), $y = h$({arguments:list}).",
    "nonlinear_state_continuous": "The plant is d/dt ({states:list}) = $f$({arguments:list}).",
    "nonlinear_discrete": "The next value of ({states:list}) is $f$({arguments:list}), and $y = h$({arguments:list}).",
    "nonlinear_state_discrete": "The next value of ({states:list}) is $f$({arguments:list}).",
    "equilibrium_continuous": "The states are at rest at the equilibrium:",
    "equilibrium_discrete": "The states keep their values at the equilibrium:",
    "linearised": "For small deviations $x$, $u$ and $y$ from the equilibrium, the linearised plant has the matrices",
    "linearisation_proves": "What is true of the linearised plant is true of the plant itself near the equilibrium: if the one is observable or controllable, the other is so locally, and a feedback or an observer that is asymptotically stable for the one is so for the other where deviations are small.",
    "linearisation_leaves_open": "What is not true of the linearised plant proves nothing of the plant itself, which may be observable or controllable all the same.",
    "realised": "A realisation in controllable canonical form is",
    "data_rounded": "Irrational data are rounded to {digits} significant digits; what follows holds for these numbers.",
    "from_floats": "Floating-point entries are taken as the shortest decimals that represent them.",
    "exact_decimals": "The decimals are taken as exact: {numbers}.",
    "rounded_digits": "Numbers after ≈ are exact values rounded to {digits} significant digits.",
    "shown_in_section": "This has been shown in section {number}.",
    "without_serifs": "The sans-serif {parameter} denotes a symbol of the data, not the matrix or signal with that letter.",
    "nonlinear_input": "Here {parameter} is the input of the nonlinear plant, and $u$ its deviation from the equilibrium.",
    "declared": "Throughout, we assume {signs}.",
    "stratum": "Here we consider the case {condition}.",
    "desired_pole": "The desired pole is {poles}.",
    "desired_poles": "The desired poles are {poles}.",
    "desired_polynomial": "The desired polynomial is {polynomial}.",
    "control_pole": "The desired control pole is {poles}.",
    "control_poles": "The desired control poles are {poles}.",
    "control_polynomial": "The desired control polynomial is {polynomial}.",
    "observer_pole": "The desired observer pole is {poles}.",
    "observer_poles": "The desired observer poles are {poles}.",
    "observer_polynomial": "The desired observer polynomial is {polynomial}.",
    "realised_observable": "A realisation in observable canonical form is",
    "realised_modal": "A realisation in modal form is",
    "realised_minimal": "A minimal realisation is",
    "variant": "Variant {number}",
    "variant_of": "{title}, variant {number}",
    "variant_of_seed": "Variant {number} of seed 0.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "lowest_terms_unstable_continuous": ("unstable",),
    "lowest_terms_unstable_discrete": ("unstable",),
}

DEMANDS: dict[str, str] = {
    "control_pole": "poles_of phi_c",
    "control_poles": "poles_of phi_c",
    "control_polynomial": "poles_of phi_c",
    "observer_pole": "poles_of phi_o",
    "observer_poles": "poles_of phi_o",
    "observer_polynomial": "poles_of phi_o",
}

NAMING = ("without_serifs", "nonlinear_input")

CONTINUES = ("row_where", "row_modes", "row_answer")
