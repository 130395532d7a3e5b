"""The plant behind a zero-order hold."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "zero_order_hold": "Zero-order hold.",
    "zero_order_hold_held": "The hold keeps the input constant from one sampling instant to the next. Hence the state at the next instant is $A_zoh x + B_zoh u$ with the matrix exponential over the sampling period,",
    "zero_order_hold_integral": "and with the integral",
    "zero_order_hold_not_given": "Therefore the sampled plant is not given either.",
    "zero_order_hold_checked": "The derivative of $exp_At$ is $A exp_At$, {start}; and {balance}.",
}


CONTINUES = ("zero_order_hold_integral",)


QUESTIONS: dict[str, str] = {
    "ask zero_order_hold": "A zero-order hold precedes the plant. Find the matrices of the sampled plant.",
    "ask zero_order_hold sampling_period": "A zero-order hold precedes the plant, and the sampling period is {sampling_period}. Find the matrices of the sampled plant.",
}
