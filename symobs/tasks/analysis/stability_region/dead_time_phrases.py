"""Plants with a dead time at the input, and loops with one."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "dead_time": "The plant has the dead time {time} at its input: in these equations $u$ stands for the input at a time earlier by $T_t$, and the transfer function from the input to the output has the further factor $exp_sT$.",
    "dead_time_steps": "The plant has a dead time of {number} sampling periods at its input, which is contained in these equations: each of them is a state, a delay by one period.",
    "dead_time_pade": "The plant has the dead time {time} at its input. It is contained in these equations by its Padé approximation of order {order}, a rational function of modulus 1 on the imaginary axis whose phase differs from that of the dead time§: what follows holds for the approximation, and for the plant with the dead time approximately.",
    "dead_time_pade_error": "At the largest frequency at which the modulus of the plant is 1, {omega}, the phase of this approximation of order {order} is off by {angle} degrees, rounded to six digits after the point.",
    "dead_time_numerator": "The numerator of the loop, without the dead time, is",
    "dead_time_closed": "The characteristic function of the closed loop is",
    "dead_time_poles": "Its roots are the poles of the closed loop; finitely many of them have a real part above any given one§.",
    "dead_time_moves": "They move continuously with the gain, so the number of unstable poles changes only where some are on the imaginary axis§.",
    "dead_time_crossing": "For {gain} = {k} a root lies on the imaginary axis, at the frequency {omega}, both rounded to six digits after the point.",
    "dead_time_bound": "Where the modulus of {gain} is above {bound}, at least one root is unstable: all further crossings lead to the right.",
    "dead_time_rounded": "Hence, rounded to six digits after the point, all poles are stable if and only if",
    "dead_time_response": "The loop for {gain} = 1: where it meets the real axis, −1 divided by the value there is a {gain} with poles on the imaginary axis.",
    "dead_time_never": "The closed loop is stable for no {gain}.",
    "dead_time_counts": "The number of unstable poles is {before} without feedback and {after} with it. Hence the frequency response, closed to the right around poles on the boundary of stability, encircles −1 counterclockwise {around} times, that is {before} minus {after}, a negative number counting clockwise turns§.",
    "dead_time_on_axis": "The number of unstable poles is {before} without feedback; with it poles lie on the imaginary axis, so that the frequency response passes through −1.",
    "dead_time_axis": "The frequency response meets the real axis at {value} for the frequency {omega}, rounded to six digits after the point.",
    "dead_time_level": "Its modulus is 1 at the frequency {omega}, rounded to six digits after the point.",
    "dead_time_no_margins": "The closed loop is not stable, so it has no margins.",
    "dead_time_ends": "The closed loop is stable. It stays so for gains that multiply the loop by a factor between {low} and {high}, rounded to six digits after the point, and by no factor at the ends.",
    "dead_time_margins": "A change of the phase of the loop, either way, leaves the loop stable as long as it is less than {phase} degrees; its frequency response comes as near to −1 as {modulus}, so that the sensitivity has the peak {peak}, all rounded to six digits after the point§.",
    "dead_time_any_phase": "No change of the phase of the loop alone makes it unstable, since its frequency response never has modulus 1; it comes as near to −1 as {modulus}, so that the sensitivity has the peak {peak}, both rounded to six digits after the point§.",
    "dead_time_delay": "A further dead time leaves it stable as long as it is less than {delay}, rounded to six digits after the point: the smallest quotient of phase and frequency where the modulus is 1.",
    "dead_time_any_delay": "No further dead time makes it unstable, since the modulus of the frequency response is never 1.",
}

DEMANDS: dict[str, str] = {
    "dead_time_pade_error": "misses_phase T_p",
    "dead_time_crossing": "has_dead_time crossing q chi_o T_t",
    "dead_time_bound": "has_dead_time bound q chi_o T_t",
    "dead_time_never": "has_dead_time never q chi_o T_t",
    "dead_time_counts": "has_dead_time counts q chi_o T_t",
    "dead_time_on_axis": "has_dead_time counts q chi_o T_t",
    "dead_time_axis": "has_dead_time axis q chi_o T_t",
    "dead_time_level": "has_dead_time level q chi_o T_t",
    "dead_time_no_margins": "has_dead_time unstable q chi_o T_t",
    "dead_time_ends": "has_dead_time ends q chi_o T_t",
    "dead_time_margins": "has_dead_time margins q chi_o T_t",
    "dead_time_any_phase": "has_dead_time margins q chi_o T_t",
    "dead_time_delay": "has_dead_time delay q chi_o T_t",
    "dead_time_any_delay": "has_dead_time delay q chi_o T_t",
}

RESTS_ON: dict[str, str] = {
    "dead_time_pade": "pade_approximation",
    "dead_time_poles": "dead_time_roots",
    "dead_time_moves": "dead_time_roots",
    "dead_time_counts": "nyquist_criterion",
    "dead_time_margins": "loop_margins",
    "dead_time_any_phase": "loop_margins",
}

THEOREMS: dict[str, str] = {
    "dead_time_roots": "gu2003, ch. 1 and 2",
    "pade_approximation": "golub2013, sec. 9.3",
}
