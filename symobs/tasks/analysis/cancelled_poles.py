"""The transfer function a plant is given by, as the page states it: what cancels in it is a finding."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import roots_of
from symobs.formula.tree import HoldsExactlyWhere, Roots
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import predicate, relation
from symobs.stability.criteria.stability import monic, stability
from symobs.stability.inequalities.written_form import as_inequality
from symobs.system.conditions import vanishing_factors
from symobs.system.transfer_matrix import WrittenTransferMatrix
from symobs.tasks.analysis.factored_form import factored_form

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder


def state_transfer_function(page: Builder) -> None:
    """State P, as it is written where that is not in lowest terms, and what cancels in it."""
    plant, written = page.plant, page.plant.written
    assert written is not None  # noqa: S101 - the caller has looked
    cancelled = monic(written.cancelled, plant.variable)
    if isinstance(written, WrittenTransferMatrix):
        page.given(relation(page["P"], _written_out(page, written)))
    elif written.cancelled.is_one and not written.apart:
        page.given(relation(page["P"], factored_form(page, written.value)))
    else:
        above, below = (factored_form(page, part) for part in (written.above, written.below))
        page.given(relation(page["P"], above / below, factored_form(page, written.value)))
    page.environment = page.environment.extended_by(values={"P": written.value})
    apart = vanishing_factors(written.apart, plant.symbols.signs)
    if apart:
        page.assume("lowest_terms_parameters", *apart)
    if not written.cancelled.is_one:
        _say_cancelled(page, cancelled, written.below)
    page.remark("realised_minimal" if isinstance(written, WrittenTransferMatrix) else "realised")


def _written_out(page: Builder, written: WrittenTransferMatrix) -> Term:
    """Return the matrix with its entries factored."""
    return block([[factored_form(page, entry.value) for entry in row] for row in written.rows])


def _say_cancelled(page: Builder, cancelled: Scalar, below: Scalar) -> None:
    """Say which poles cancel, and warn where they are not surely stable."""
    plant = page.plant
    c = page.set("c_P", cancelled)
    rest = page.value(below / cancelled)
    poles = Roots(c.formula, roots_of(cancelled, plant.variable))
    facts = (relation(below, c * rest),)
    cancelled_stability = stability(cancelled, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    if cancelled_stability.verdict == "yes":
        page.remark("lowest_terms", *facts, poles=poles)
    elif cancelled_stability.verdict == "no":
        time = "discrete" if plant.is_discrete else "continuous"
        page.caution(f"lowest_terms_unstable_{time}", predicate("unstable", c), *facts, poles=poles)
    else:
        solved = [as_inequality(value, plant.symbols.signs) for value in cancelled_stability.positive]
        where = HoldsExactlyWhere(predicate("stable", c), tuple(relation(*parts) for parts in solved))
        page.caution("lowest_terms_where", *facts, poles=poles, where=where)
