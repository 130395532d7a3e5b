"""Observer and state feedback in two columns, line by line: the same placement for (Aᵀ, Cᵀ) and for (A, B)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.factored_form import formula_of_factored
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.design.gain.gain_page import name_coefficients, say_as_required, write_case
from symobs.tasks.design.gain.placement_problem import FEEDBACK, OBSERVER, PlacementProblem
from symobs.tasks.design.page_parts import readability
from symobs.tasks.design.page_parts.pole_cautions import caution_poles

if TYPE_CHECKING:
    from symobs.tasks.design.compensator.compensator import CompensatorDesign
    from symobs.tasks.design.gain.gain_design import GainDesign


def can_stand_side_by_side(design: CompensatorDesign) -> bool:
    """Return whether both pairs pass their tests, if only off the zeros of a determinant."""
    sides = (design.feedback, design.estimator)
    return design.exists and all(
        part.fixed_polynomial.is_one and part.answer[part.letter] is not None for part in sides
    )


def write_side_by_side(page: Builder, design: CompensatorDesign) -> None:
    """Write the two columns, what transposition makes of the left one, and the exceptions of both."""
    with page.section("side_by_side"):
        with page.section("left_observer"):
            _column(page, design.estimator, OBSERVER)
        with page.section("right_state_feedback"):
            _column(page, design.feedback, FEEDBACK)
        own = OBSERVER.error_determinant(page)
        page.equal(relation(own, _determinant(page, OBSERVER), page["phi_o"]), say="transposed_back")
        page.equal(relation(page["L"], design.answer["L"]), say="gain_transposed", answer=True)
        for part, side in ((design.estimator, OBSERVER), (design.feedback, FEEDBACK)):
            assert part.desired is not None  # noqa: S101 - a compensator is asked for by its polynomials
            caution_poles(page, part.desired, side.phi, side.kind)
            for case in part.case_tree:
                write_case(page, case, side)


def _column(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """Write the test, the polynomial, the gain and its check for one of the pairs."""
    A, order, value = _matrix(page, side), page.plant.order, design.answer[side.gain]
    if side is OBSERVER:
        page.define("O", block([[page["C"] @ page["A"] ** k if k else page["C"]] for k in range(order)]), silent=True)
        test, gain, found = page["O"].T, page["L"].T, value.T
        blocks = block([[A**k @ page["C"].T if k else page["C"].T for k in range(order)]])
        page.conclude_silently(relation(test, blocks))
    else:
        gain, found = page["K"], value
        blocks = block([[A**k @ page["B"] if k else page["B"] for k in range(order)]])
        page.define("Ctr", blocks, silent=True)
        test = page["Ctr"]
    page.equal(
        relation(test, *([blocks] if order <= readability.COLUMN_ORDER else []), test.as_value), say=f"test_{side.kind}"
    )
    if square_test(page, side.matrix, design.test, side.test):
        page.conclude(f"any_{side.kind}")
    desired = name_coefficients(page, design, side)
    page.set(side.gain, value)
    last = page.value(Matrix.unit(order, order - 1).T)
    page.equal(
        relation(gain, last @ test.inverse @ A.apply(f"{side.phi}_at"), found),
        say=f"gain_{side.kind}",
        answer=side is FEEDBACK,
    )
    grouped = [] if desired.is_expanded else [page.term(formula_of_factored(Factored(Scalar.of(1), desired.grouped())))]
    say_as_required(page, desired, _determinant(page, side), page.value(desired.polynomial), *grouped)


def _matrix(page: Builder, side: PlacementProblem) -> Term:
    """Return Aᵀ on the left, A on the right."""
    return page["A"].T if side is OBSERVER else page["A"]


def _determinant(page: Builder, side: PlacementProblem) -> Term:
    """Return det(sI − Aᵀ + CᵀLᵀ) on the left, det(sI − A + BK) on the right."""
    if side is FEEDBACK:
        return side.error_determinant(page)
    moved = page["C"].T @ page["L"].T
    return (page.s @ page.identity(page.plant.order) - page["A"].T + moved).apply("det")
