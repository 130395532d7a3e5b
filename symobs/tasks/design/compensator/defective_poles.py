"""A repeated control pole, which a matrix with fewer eigenvectors than places for it makes defective."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Factored, Scalar, rank, roots_of
from symobs.formula.tree import Roots
from symobs.proof.derivation.builder import Builder, relation
from symobs.stability.criteria.stability import monic
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.factored_form import formula_of_factored
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.placement_problem import FEEDBACK
from symobs.tasks.design.page_parts import readability

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback


def caution_repeated(page: Builder, design: OutputFeedback) -> None:
    """Warn of a repeated control pole that is defective: its exponential alone does not bound x."""
    plant = design.plant
    desired = design.feedback.desired
    if desired is None or plant.symbols.signs or not desired.is_numeric or plant.inputs > 1:
        return
    for factor, power in desired.grouped():
        if power > 1 and factor.degree(plant.variable) == 1 and factor != page.s.scalar:
            pole = -factor.coefficients(plant.variable)[1]
            closed, size = FEEDBACK.closed_loop_matrix(page), page.identity(plant.order)
            length = abs(pole.fraction())
            shift = size if length == 1 else page.value(Scalar.of(length)) @ size
            offset = closed + shift if pole.fraction() < 0 else closed - shift
            found = rank(offset.value)
            if plant.order - found >= power:
                continue
            held = relation(offset.apply("rank"), found)
            single = page["phi_c"] / page.value(desired.polynomial / factor)
            instead = _with_distinct_poles(page, desired)
            page.caution(
                "defective" if instead is None else "defective_instead",
                held,
                pole=Roots(single.formula, roots_of(factor, plant.variable)),
                matrix=relation(offset, offset.as_value) if plant.order == readability.OFFSET_ORDER else held,
                **({} if instead is None else {"instead": instead}),
            )
            return


def _with_distinct_poles(page: Builder, desired: DesiredPolynomial) -> Relation | None:
    """Return det(sI − A + BK) = φ for the desired poles, repeated ones moved further in, where a gain places them."""
    plant, variable = page.plant, page.plant.variable
    further_in = page.s.scalar * 2 if plant.is_discrete else page.s.scalar + 1
    factors: dict[Scalar, None] = {}
    for factor in desired.factors:
        moved = factor
        while moved in factors:
            moved = monic(moved.substitute({variable: further_in}), variable)
        factors[moved] = None
    distinct = DesiredPolynomial(variable, tuple(factors))
    gain = StateFeedbackDesign.of(plant, distinct, "ackermann").answer["K"]
    if gain is None:
        return None
    pencil = page.s @ page.identity(plant.order) - page["A"] + page["B"] @ page.value(gain)
    product = Factored(Scalar.of(1), tuple((factor, 1) for factor in factors))
    return relation(pencil.apply("det"), page.term(formula_of_factored(product)))
