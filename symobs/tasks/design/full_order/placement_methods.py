"""The methods of pole placement, one row each for observers and state feedback: sources, formulas and the page they share."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.tasks.design.gain.gain_page import write_ackermann, write_member, write_reduction
from symobs.tasks.design.gain.gain_ways_page import write_canonical, write_companion, write_matching
from symobs.tasks.design.pole_placement.row_reduction import reduced_gain
from symobs.tasks.design.pole_placement.single_output import canonical_gain, companion_gain, matched_gain
from symobs.tasks.design.pole_placement.sylvester import SYLVESTER
from symobs.tasks.result import method

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.exact import Matrix
    from symobs.system import StateSpace
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


class Formula(NamedTuple):
    """A placement method on one of the dual sides, with its source."""

    source: str
    summary: str


@dataclass
class PlacementMethod:
    """A way to the gain of an observable pair, dual for both tasks.

    `find` is None where the gain is the one that is easiest to read, and only the page tells the method.
    """

    name: str
    observer: Formula
    state_feedback: Formula | None
    find: Callable[[ObserverPair, DesiredPolynomial], Matrix | None] | None = None
    page: Callable[..., None] | None = None
    #: Whether the method is one for a single output (input).
    single: bool = False

    def solver_for(self, kind: type[GainDesign], formula: Formula) -> Callable[..., GainDesign]:
        """Return what solves the task of a kind of design by this method."""

        def solve(plant: StateSpace, desired: DesiredPolynomial) -> GainDesign:
            if self.single:
                self._require_one(plant.outputs if kind.letter == "L" else plant.inputs, kind)
            if self.find is None:
                return kind.of(plant, desired, self.name)
            if desired.choose != "auto" and not self.single:
                message = f"the method {self.name} determines the gain, and choose another one"
                raise InputError(message, where="specification.choose", repair="leave choose or the method out")
            return kind.by_method(plant, desired, self.name, self.find)

        solve.__doc__ = formula.summary
        return solve

    def _require_one(self, count: int, kind: type[GainDesign]) -> None:
        """Raise `InputError` where a method for one output (input) is asked about several."""
        if count != 1:
            what = "output" if kind.letter == "L" else "input"
            message = f"the method {self.name} needs one {what}, the plant has {count}"
            repair = "write sylvester or row_reduced_echelon, which take several"
            raise InputError(message, where="specification.method", repair=repair)


def register_methods(kind: type[GainDesign]) -> None:
    """Register every method of pole placement for the task of a kind of design."""
    for row in PLACEMENT_METHODS:
        formula = row.observer if kind.task == "observer" else row.state_feedback
        if formula is not None:
            method(f"{kind.task}/{row.name}", source=formula.source, page=row.page)(row.solver_for(kind, formula))


PLACEMENT_METHODS = (
    PlacementMethod(
        "canonical_form",
        Formula(
            "bass1965; kailath1980, ch. 3",
            "Lᵀ = (differences of coefficients, constant first) · V⁻¹, V = 𝒞(Aᵀ, Cᵀ) · Hankel matrix of χ.",
        ),
        Formula(
            "bass1965; kailath1980, ch. 3",
            "K = (differences of coefficients, constant first) · V⁻¹, V = 𝒞 · Hankel matrix of χ.",
        ),
        find=canonical_gain,
        page=write_canonical,
        single=True,
    ),
    PlacementMethod(
        "ackermann",
        Formula("ackermann1972", "L = φ(A) 𝒪⁻¹ eₙ."),
        Formula("ackermann1972", "K = eₙᵀ 𝒞⁻¹ φ(A)."),
        page=write_ackermann,
        single=True,
    ),
    PlacementMethod(
        "existence",
        Formula(
            "luenberger1964",
            "x̂' = F x̂ + G u + H y with undetermined F, G, H: the error is free of x and u for G = B, F = A − HC alone.",
        ),
        state_feedback=None,
    ),
    PlacementMethod(
        "sylvester",
        Formula(
            SYLVESTER, "L = (G X⁻¹)ᵀ with AᵀX − XF = CᵀG, F the companion matrix of φ: every G for which X is regular."
        ),
        Formula(SYLVESTER, "K = G X⁻¹ with AX − XF = BG, F the companion matrix of φ: every G for which X is regular."),
        page=write_member,
    ),
    PlacementMethod(
        "coefficient_matching",
        Formula(
            "standard: equating coefficients",
            "Unknown entries of L: det(sI − A + LC) = φ(s), equal coefficients, a linear system.",
        ),
        Formula(
            "standard: equating coefficients",
            "Unknown entries of K: det(sI − A + BK) = φ(s), equal coefficients, a linear system.",
        ),
        find=matched_gain,
        page=write_matching,
        single=True,
    ),
    PlacementMethod(
        "row_reduced_echelon",
        Formula(
            "moore1976; brogan1991",
            "Lᵀ = f Ψ⁻¹ with null vectors [ψ; f] of [λI − Aᵀ : Cᵀ], one for each pole, read off its row-reduced form.",
        ),
        Formula(
            "moore1976; brogan1991",
            "K = f Ψ⁻¹ with null vectors [ψ; f] of [λI − A : B], one for each pole, read off its row-reduced form.",
        ),
        find=reduced_gain,
        page=write_reduction,
    ),
    PlacementMethod(
        "companion_form",
        Formula(
            "bass1965",
            "Lᵀ = (differences of coefficients, constant first) T, where T brings the pair to companion form.",
        ),
        Formula(
            "bass1965",
            "K = (differences of coefficients, constant first) T, where T brings the pair to companion form.",
        ),
        find=companion_gain,
        page=write_companion,
        single=True,
    ),
)
