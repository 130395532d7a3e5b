"""The dual plant."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "dual": "The dual plant.",
    "dual_positive": "Transposing the matrices and interchanging inputs and outputs gives the dual plant",
    "dual_negative": "Transposing the matrices, interchanging inputs and outputs and reversing time gives the dual plant",
    "dual_controllability": "The controllability matrix of the dual is",
    "dual_observability": "The observability matrix of the dual is",
    "plant_observability": "The observability matrix of the plant is",
    "plant_controllability": "The controllability matrix of the plant is",
    "dual_same": "Block by block it is the transpose:",
    "dual_signs": "Its blocks equal those of the transpose up to sign, which leaves the rank unchanged:",
    "dual_provided": "In what follows we assume {condition}.",
    "dual_ranks_observing": "Hence {ranks}, and the pair ($C$, $A$) is observable if and only if the pair ($A_dual$, $B_dual$) is controllable.",
    "dual_ranks_controlling": "Hence {ranks}, and the pair ($A$, $B$) is controllable if and only if the pair ($C_dual$, $A_dual$) is observable.",
}

QUESTIONS: dict[str, str] = {
    "ask dual": "Form the dual plant.",
    "ask dual sign=1": "Form the dual plant with the state matrix $Aᵀ$.",
    "ask dual sign=-1": "Form the dual plant with the state matrix $- Aᵀ$.",
}

DEMANDS: dict[str, str] = {
    "dual_ranks_observing": "duals C A B_dualᵀ A_dualᵀ",
    "dual_ranks_controlling": "duals Bᵀ Aᵀ C_dual A_dual",
    "plant_observability": "tests C A",
    "plant_controllability": "tests Bᵀ Aᵀ",
    "dual_controllability": "tests B_dualᵀ A_dualᵀ",
    "dual_observability": "tests C_dual A_dual",
    "dual_positive": "is A_dual Aᵀ",
    "dual_negative": "is_negative A_dual Aᵀ",
}

RESTS_ON: dict[str, str] = {
    "dual_ranks_observing": "duality",
    "dual_ranks_controlling": "duality",
    "dual_negative": "duality_reversed",
}

THEOREMS: dict[str, str] = {
    "duality_reversed": "brockett1970; rugh1996, ch. 9",
}
