"""What a problem asks for, as the question sheet puts it.

The key of a sentence says when it is said: `ask` and a task, then what the specification must contain, a keyword, or
`keyword=value` where it is a word; `poles=1` is a single pole.  Of several that fit, the one that says most is said.
What it leaves unsaid is said by sentences that begin with `also`, for one task or for all.  Slots are keywords.
"""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "sheet_questions": "Questions",
    "sheet_solutions": "Solutions",
    "sheet_solution": "solution",
    "sheet_contents": "Contents",
    "sheet_problem": "Problem",
    "sheet_failed": "This problem could not be worked out.",
    "sheet_undecided": "This problem was not worked out in the time or memory it was given.",
    "task": "Task.",
    "tasks": "Tasks.",
    "part": "({letter})",
    # What is said of a task without a sentence of its own: the first line of its description.
    "asked": "{summary}",
    # -- what the plant is ----------------------------------------------------------------------------------------
    "ask characteristic_polynomial": "Find the characteristic polynomial of $A$ and its roots.",
    "ask transfer_function": "Find the transfer function of the plant in lowest terms, its poles and its zeros.",
    "ask canonical_form": "Transform the plant to canonical form.",
    "ask canonical_form kind=controllable": "Transform the plant to controllable canonical form.",
    "ask canonical_form kind=observable": "Transform the plant to observable canonical form.",
    "ask canonical_form kind=modal": "Transform the plant to real modal form.",
    "ask dual": "Form the dual plant. Which ranks are equal by duality?",
    "ask dual sign=1": "Form the dual plant with the state matrix $Aᵀ$. Which ranks are equal by duality?",
    "ask dual sign=-1": "Form the dual plant with the state matrix $- Aᵀ$. Which ranks are equal by duality?",
    "ask decomposition": "Split the plant into its four parts, controllable or not and observable or not. Find the minimal part and its transfer function.",
    # -- what can be seen and moved -------------------------------------------------------------------------------
    "ask observability": "Is the pair ($C$, $A$) observable?",
    "ask controllability": "Is the pair ($A$, $B$) controllable?",
    "ask pbh": "Test the observability of the pair ($C$, $A$) eigenvalue by eigenvalue.",
    "ask pbh of=observability": "Test the observability of the pair ($C$, $A$) eigenvalue by eigenvalue.",
    "ask pbh of=controllability": "Test the controllability of the pair ($A$, $B$) eigenvalue by eigenvalue.",
    "ask detectability": "Is the pair ($C$, $A$) detectable?",
    "ask detectability meaning=asymptotic": "Is the pair ($C$, $A$) detectable, the hidden modes being asymptotically stable?",
    "ask detectability meaning=lyapunov": "Is the pair ($C$, $A$) detectable, the hidden modes being stable in the sense of Lyapunov?",
    "ask stabilizability": "Is the pair ($A$, $B$) stabilizable?",
    "ask stabilizability meaning=asymptotic": "Is the pair ($A$, $B$) stabilizable, the modes that are not reached being asymptotically stable?",
    "ask stabilizability meaning=lyapunov": "Is the pair ($A$, $B$) stabilizable, the modes that are not reached being stable in the sense of Lyapunov?",
    # -- in time --------------------------------------------------------------------------------------------------
    "ask matrix_exponential": "Find the matrix exponential $exp_At$, in real terms.",
    "ask gramian": "Find the observability Gramian over the horizon {horizon}, with its determinant. Is every initial state seen at the output?",
    "ask gramian horizon=inf": "Find the observability Gramian over all time, with its determinant. Is every initial state seen at the output?",
    "ask gramian of=observability": "Find the observability Gramian over the horizon {horizon}, with its determinant.",
    "ask gramian of=observability horizon=inf": "Find the observability Gramian over all time, with its determinant.",
    "ask gramian of=controllability": "Find the controllability Gramian over the horizon {horizon}, with its determinant.",
    "ask gramian of=controllability horizon=inf": "Find the controllability Gramian over all time, with its determinant.",
    "ask initial_state": "Find the initial state from the output.",
    "ask initial_state output": "Up to the time {horizon} the output was measured as {output}, and there was no input. Find the initial state.",
    "ask initial_state output input": "Up to the time {horizon} the output was measured as {output} under the input {input}. Find the initial state.",
    "also initial_state input": "The input is {input}.",
    "also initial_state_covariance Q": "White noise {Q} is added to the known input.",
    "ask initial_state_covariance": "Find the covariance of the initial state that the Gramian reconstructs from a noisy output.",
    "ask initial_state_covariance R": "The output is measured with white noise {R} up to the time {horizon}. Find the covariance of the initial state "
    "that the Gramian reconstructs, and the best horizon for each component.",
    "ask initial_state_covariance Q R": "White noise {Q} is added to the known input and white noise {R} to the output, up to the time {horizon}. Find "
    "the covariance of the initial state that the Gramian reconstructs, and the best horizon for each component.",
    "ask time_varying_observability": "Is the plant observable?",
    "ask time_varying_observability interval": "Is the plant observable on the interval from {start} to {end}?",
    "also time_varying_observability output": "Find the initial state that explains the output {output}.",
    "also time_varying_observability input": "The input is {input}.",
    # -- for which parameters -------------------------------------------------------------------------------------
    "ask stability_region": "Is the polynomial $chi_p$ stable?",
    "ask stability_region K": "Is the loop with the feedback gain $K$ stable?",
    "ask stability_region L": "Is the observer with the gain $L$ stable?",
    "ask stability_region K L": "Is the loop with the feedback gain $K$ and the observer gain $L$ stable?",
    "ask stability_region parameters": "For which {parameters} is the polynomial $chi_p$ stable?",
    "ask stability_region K parameters": "For which {parameters} is the loop with the feedback gain $K$ stable?",
    "ask stability_region L parameters": "For which {parameters} is the observer with the gain $L$ stable?",
    "ask stability_region K L parameters": "For which {parameters} is the loop with the feedback gain $K$ and the observer gain $L$ stable?",
    "also stability_region polynomial": "The polynomial is {polynomial}.",
    "also stability_region margin": "Every root is to lie to the left of the imaginary axis by more than {margin}.",
    "also stability_region radius": "Every root is to have an absolute value below {radius}.",
    # -- design ---------------------------------------------------------------------------------------------------
    "ask state_feedback": "Design state feedback.",
    "ask state_feedback poles": "Design state feedback with the poles {poles}.",
    "ask state_feedback poles=1": "Design state feedback with the pole {poles}.",
    "ask state_feedback polynomial": "Design state feedback with the characteristic polynomial {polynomial}.",
    "ask state_feedback K": "Find the characteristic polynomial of the loop with the feedback gain $K$.",
    "ask state_feedback K poles": "Does the feedback gain $K$ give the poles {poles}?",
    "ask observer": "Design an observer.",
    "ask observer poles": "Design an observer with the poles {poles}.",
    "ask observer poles=1": "Design an observer with the pole {poles}.",
    "ask observer polynomial": "Design an observer with the characteristic polynomial {polynomial}.",
    "ask observer L": "Find the characteristic polynomial of the observer with the gain $L$, and the observer itself.",
    "ask observer method=existence": "Which linear systems, driven by the input and the output, estimate the state with an error that does not depend on "
    "them?",
    "ask observer method=existence L": "Which linear systems, driven by the input and the output, estimate the state with an error that does not depend on "
    "them? Find the one with the gain $L$.",
    "ask observer method=existence poles": "Which linear systems, driven by the input and the output, estimate the state with an error that does not "
    "depend on them? Find the one with the poles {poles}.",
    "ask observer method=existence polynomial": "Which linear systems, driven by the input and the output, estimate the state with an error that does not "
    "depend on them? Find the one with the characteristic polynomial {polynomial}.",
    "ask reduced_order_observer": "Design an observer of minimal order.",
    "ask reduced_order_observer poles": "Design an observer of minimal order with the poles {poles}.",
    "ask reduced_order_observer poles=1": "Design an observer of minimal order with the pole {poles}.",
    "ask reduced_order_observer polynomial": "Design an observer of minimal order with the characteristic polynomial {polynomial}.",
    "also reduced_order_observer T": "Use the coordinates $T x$.",
    "ask compensator": "Design a compensator of state feedback and an observer of full order, and close the loop with it.",
    "ask compensator observer=full": "Design a compensator of state feedback and an observer of full order, and close the loop with it.",
    "ask compensator observer=minimal": "Design a compensator of state feedback and an observer of minimal order, and close the loop with it.",
    "ask feedforward": "Design state feedback, an observer of full order, and a feedforward gain for which the output at rest equals the new input.",
    "ask feedforward observer=full": "Design state feedback, an observer of full order, and a feedforward gain for which the output at rest equals the new "
    "input.",
    "ask feedforward observer=minimal": "Design state feedback, an observer of minimal order, and a feedforward gain for which the output at rest equals the "
    "new input.",
    "ask tracking": "Let the state follow the states $x_d$ of its own unforced motion, by state feedback and an observer of minimal order.",
    "ask tracking reference_matrix": "Let the state follow every reference $x_d$, by state feedback and an observer of minimal order. Is that possible?",
    "ask tracking reference_matrix reference_start": "Let the state follow the reference $x_d$ from the initial state given, by state feedback and an observer of "
    "minimal order. Is that possible?",
    "also tracking observer=full": "The observer is to have full order.",
    "also reference_start": "The reference starts at the initial state given.",
    "also control_poles": "The control poles are to be {control_poles}.",
    "also control_poles=1": "The control pole is to be {control_poles}.",
    "also control_polynomial": "The control polynomial is to be {control_polynomial}.",
    "also observer_poles": "The observer poles are to be {observer_poles}.",
    "also observer_poles=1": "The observer pole is to be {observer_poles}.",
    "also observer_polynomial": "The observer polynomial is to be {observer_polynomial}.",
    "ask pole_advice": "Where should the poles of the observer lie?",
    "also pole_advice radius": "Those that do not lie at zeros of the plant are to lie on a circle of radius {radius}.",
    "also pole_advice settling_time": "The estimate is to settle to 2 % within the time {settling_time}.",
    "also pole_advice overshoot": "A step response is to overshoot by at most the fraction {overshoot} of the step.",
    # -- which of several answers, and by which way ---------------------------------------------------------------
    "also zero": "These entries (row, column) of the gain are to be zero: {zero}.",
    "also member=simple": "Several gains do that; choose one with short entries.",
    "also observer member=decoupled": "Of the gains that do that, find one for which every output obeys an equation of its own.",
    "also state_feedback member=decoupled": "Of the gains that do that, find one for which every input moves a part of its own.",
    "also method=canonical_form": "Use the canonical form.",
    "also method=ackermann": "Use Ackermann's formula.",
    "also method=sylvester": "Use Sylvester's equation.",
    "also method=coefficient_matching": "Match the coefficients of the characteristic polynomial.",
    "also method=row_reduced_echelon": "Use row reduction, pole by pole.",
    "also method=companion_form": "Use the companion form.",
    "also method=duality": "Set observer and state feedback side by side.",
    "also method=undetermined": "Leave $F$, $G$ and $H$ open until the error asks for them.",
    "also method=butterworth": "Use a Butterworth configuration.",
    "also method=dominant_pair": "Use a dominant pair.",
}

#: A question claims nothing of the values it names.
NAMING = tuple(PHRASES)

OPENS = ("part",)

#: Methods that are the only one of their task, or follow from what is asked for: a question need not name them.
UNSAID = frozenset(
    {
        "auto",
        "basis",
        "derivatives",
        "determinant",
        "eigenvalues",
        "fixed_modes",
        "gramian",
        "integral",
        "minimal_order",
        "moments",
        "partition",
        "rank",
        "reference_model",
        "resolvent",
        "routh",
        "separation",
        "stack",
        "static",
        "subspaces",
        "transpose",
    }
)
