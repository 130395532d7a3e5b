"""Headings, and what is given."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "given": "Given.",
    "observability": "Observability.",
    "controllability": "Controllability.",
    "characteristic_polynomial": "Characteristic polynomial.",
    "transfer_function": "Transfer function.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "reduced_order_observer": "Reduced-order observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
    "existence": "An observer from nothing but its task.",
    "feedforward": "Feedforward.",
    "tracking": "Tracking.",
    "lowest_terms_parameters": "What cancels is not zero, for the function has no meaning elsewhere: {condition}.",
    "lowest_terms": "The <pole|poles> {poles} <cancels|cancel>, and what follows is about the function in lowest terms.",
    "lowest_terms_unstable_continuous": "The <pole|poles> {poles} <cancels|cancel>, and what follows is about the function in lowest terms: a plant that has <this mode|these modes> hides <it|them>, and <it does not lie|not all lie> in the open left half plane.",
    "lowest_terms_unstable_discrete": "The <pole|poles> {poles} <cancels|cancel>, and what follows is about the function in lowest terms: a plant that has <this mode|these modes> hides <it|them>, and <it does not lie|not all lie> inside the unit circle.",
    "lowest_terms_where": "The <pole|poles> {poles} <cancels|cancel>, and what follows is about the function in lowest terms: a plant that has <this mode|these modes> hides <it|them>, and <it is|they are> stable exactly where {where}.",
    "realised": "In controllable canonical form this is",
    "realised_minimal": "A minimal realisation of this is",
    "from_floats": "Floating-point numbers are read as their shortest decimals.",
    "exact_decimals": "The decimals are exact: {numbers}.",
    "without_serifs": "Set without serifs, {parameter} is a parameter of the data, not the matrix or signal of that letter.",
    "declared": "Throughout, {signs}.",
    "desired_pole": "The pole asked for is {poles}.",
    "desired_poles": "The poles asked for are {poles}.",
    "desired_polynomial": "The polynomial asked for is {polynomial}.",
    "control_pole": "The control pole is to be {poles}.",
    "control_poles": "The control poles are to be {poles}.",
    "control_polynomial": "The control polynomial is to be {polynomial}.",
    "observer_pole": "The observer pole is to be {poles}.",
    "observer_poles": "The observer poles are to be {poles}.",
    "observer_polynomial": "The observer polynomial is to be {polynomial}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "lowest_terms_unstable_continuous": ("unstable",),
    "lowest_terms_unstable_discrete": ("unstable",),
}

NAMING = ("without_serifs",)
