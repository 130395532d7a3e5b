"""What a problem asks for, as the question sheet puts it.

The key of a sentence says when it is said: `ask` and a task, then what the specification must contain, a keyword, or
`keyword=value` where it is a word; `poles=1` is a single pole, `discrete` discrete time.  Of several that fit, the one that says most is
said.
What it leaves unsaid is said by sentences that begin with `also`, for one task or for all; `means` and a task says what the
letters mean that answer it.  Slots are keywords.
"""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "sheet_questions": "Questions",
    "sheet_solutions": "Solutions",
    "sheet_solution": "solution",
    "sheet_contents": "Contents",
    "sheet_problem": "Problem",
    "sheet_failed": "This problem could not be solved.",
    "sheet_undecided": "This problem could not be solved within the time or memory allowed.",
    "web_detail": "Detail",
    "web_full": "full derivation",
    "web_outline": "outline",
    "web_answer": "answers",
    "web_solution": "Solution",
    "web_copy": "LaTeX",
    "web_copied": "copied",
    "web_refused": "refused",
    "web_live": "Open live",
    "task": "Task.",
    "tasks": "Tasks.",
    "part": "({letter})",
    "linearise": "Linearise the plant about the equilibrium ({names:list}) = {values}: for small deviations, {laws}. What follows is about this linearised plant.",
    "uses_K": "Use the gain $K$ of part ({part}).",
    "uses_L": "Use the gain $L$ of part ({part}).",
    "give": "Give {letters}.",
    "give_fields": "Give: {names}.",
    "plant_found": "The following parts are about the plant found in part ({letter}).",
    "exceptions_asked": "If the answer depends on the parameters, give the values for which it is no.",
    # What is said of a task without a sentence of its own: the first line of its description.
    "asked": "{summary}",
}

QUESTIONS: dict[str, str] = {
    "also reference_start": "The reference starts at the initial state given.",
    "also control_poles": "Place the control poles at {control_poles}.",
    "also control_poles=1": "Place the control pole at {control_poles}.",
    "also control_polynomial": "The desired control polynomial is {control_polynomial}.",
    "also observer_poles": "Place the observer poles at {observer_poles}.",
    "also observer_poles=1": "Place the observer pole at {observer_poles}.",
    "also observer_polynomial": "The desired observer polynomial is {observer_polynomial}.",
    "also zero": "The entries (row, column) {zero} of the gain must be zero.",
    "also member=simple": "The gain is not unique; choose one with simple entries.",
    "also method=canonical_form": "Use the canonical form.",
    "also method=ackermann": "Use Ackermann's formula.",
    "also method=sylvester": "Use Sylvester's equation.",
    "also method=coefficient_matching": "Match the coefficients of the characteristic polynomial.",
    "also method=row_reduced_echelon": "Use row reduction, pole by pole.",
    "also method=companion_form": "Use the companion form.",
    "also method=duality": "Use duality, and treat observer and state feedback side by side.",
    "also method=undetermined": "Determine $F$, $G$ and $H$ from the error equation.",
    "also method=butterworth": "Use a Butterworth configuration.",
    "also method=dominant_pair": "Use a dominant pair.",
}

#: A question claims nothing of the values it names.
NAMING = (
    "sheet_questions",
    "sheet_solutions",
    "sheet_solution",
    "sheet_contents",
    "sheet_problem",
    "sheet_failed",
    "sheet_undecided",
    "web_detail",
    "web_full",
    "web_outline",
    "web_answer",
    "web_solution",
    "web_copy",
    "web_copied",
    "web_refused",
    "web_live",
    "task",
    "tasks",
    "part",
    "linearise",
    "give",
    "give_fields",
    "plant_found",
    "uses_K",
    "uses_L",
    "asked",
)

OPENS = ("part",)

#: Methods that are the only one of their task, or follow from what is asked for: a question need not name them.
UNSAID = (
    "auto",
    "basis",
    "boundary",
    "decoupled",
    "entries",
    "derivatives",
    "determinant",
    "eigenvalues",
    "extended_state",
    "fixed_modes",
    "gramian",
    "integral",
    "moments",
    "partition",
    "rank",
    "reference_model",
    "regulator_equations",
    "resolvent",
    "riccati",
    "routh",
    "separation",
    "stack",
    "static",
    "subspaces",
    "superposition",
    "transpose",
)

#: Phrases that go on with the sentence before them.
CONTINUES = ("web_full", "web_outline", "web_answer", "web_copied", "web_refused", "sheet_solution")
