"""The response to an initial state and an input."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "response": "Response.",
    "response_free": "The plant is released from the initial state",
    "response_driven": "The initial state and the input are",
    "response_from_rest": "The initial state is zero, and the input is",
    "response_impulse": "The impulse of the input at $t=0$ moves the state to",
    "response_beside": "Apart from the impulse the input is",
    "response_state": "The state is the response to the initial state plus the forced response:",
    "response_state_free": "The state is therefore",
    "steps_state": "The state is therefore, by the powers of the matrix of plant and input together,",
    "steps_checked": "The state satisfies the difference equation and has the initial value {start}.",
    "response_output": "The output is",
    "response_at_time": "The value that is asked for is",
    "response_not_given": "Therefore the response is not given either.",
    "response_checked": "The state satisfies the differential equation and has the initial value {start}.",
}


QUESTIONS: dict[str, str] = {
    "ask response": "Find the response of the plant.",
    "ask response input": "The input is {input} from $t=0$ on, and the initial state is zero. Find the response of the plant.",
    "ask response initial": "The plant is released from the initial state {initial}. Find its response.",
    "ask response initial input": "The initial state is {initial}, and the input is {input} from $t=0$ on. Find the response of the plant.",
    "ask response discrete input": "The input from $k=0$ on is {input}, and the initial state is zero. Find the response of the plant.",
    "ask response discrete initial input": "The initial state is {initial}, and the input from $k=0$ on is {input}. Find the response of the plant.",
    "also response impulse": "At $t=0$ an impulse of strength {impulse} acts on the input.",
    "also response at_time": "Also give its value at the instant {at_time}.",
}
