"""The modes of a compensator's own state that cancel in F: F may be stable where the law by itself is not."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, pole_and_zero_polynomial, roots_of
from symobs.formula.tree import HoldsExactlyWhere, Literal, Quotient, Roots
from symobs.proof.derivation.builder import predicate, relation
from symobs.stability.criteria.stability import monic, stability
from symobs.stability.inequalities.written_form import as_inequality

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace

#: A polynomial of more terms is not decided.
_TERMS = 400
#: The most inputs, or outputs, from all of whose minors the poles of F are found.
_MOST = 3


def hidden_modes(F: Matrix | Scalar, own_matrix: Matrix, variable: str) -> tuple[Scalar, Scalar] | None:
    """Return the polynomial of F's poles, and that of the modes which cancel in F; None where they are too long.

    `own_matrix` is the state matrix of the compensator that F belongs to.
    """
    if isinstance(F, Matrix):
        if F.size > _TERMS or max(F.shape) > _MOST:
            return None
        poles = pole_and_zero_polynomial(F, variable)[0]
    else:
        poles = F.denominator
    if poles.size > _TERMS:
        return None
    own = own_matrix.characteristic_polynomial(variable)
    return poles, monic((own / poles).numerator, variable)


def law_stability(F: Matrix | Scalar, own_matrix: Matrix, plant: StateSpace, stability_of_poles: str) -> str:
    """Return whether the compensator by itself is stable: its poles, and the modes that cancel in F."""
    found = hidden_modes(F, own_matrix, plant.variable)
    if found is None:
        return "undecided"
    hidden = stability(found[1], plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict
    if "no" in (hidden, stability_of_poles):
        return "no"
    return stability_of_poles if hidden == "yes" else hidden


def caution_hidden(page: Builder, F: Matrix | Scalar, own_matrix: Matrix) -> None:
    """Warn where a mode that cancels in F is not stable, surely or for some parameters."""
    plant = page.plant
    found = hidden_modes(F, own_matrix, plant.variable)
    if found is None or found[1].degree(plant.variable) < 1:
        return
    poles, hidden = found
    hidden_stability = stability(hidden, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    if hidden_stability.verdict == "yes":
        return
    own = (page.s @ page.identity(own_matrix.shape[0]) - page["A_c"]).apply("det")
    rest = page.term(Quotient(own.formula, Literal(monic(poles, plant.variable))))
    if rest.value != hidden:
        return
    modes = Roots(rest.formula, roots_of(hidden, plant.variable))
    time = "discrete" if plant.is_discrete else "continuous"
    if hidden_stability.verdict == "no":
        page.caution(f"hides_{time}", predicate("unstable", rest), relation(rest, hidden), modes=modes)
        return
    solved = [as_inequality(value, plant.symbols.signs) for value in hidden_stability.positive]
    where = HoldsExactlyWhere(predicate("stable", rest), tuple(relation(*parts) for parts in solved))
    page.caution("some_hidden", relation(rest, hidden), modes=modes, where=where)
