"""The page of tracking."""

from __future__ import annotations

from symobs.exact import Matrix
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.factored_form import formula_of_factored
from symobs.tasks.analysis.page_parts import in_blocks
from symobs.tasks.design.compensator.estimate_feedback_page import is_ill_posed, write_both_gains
from symobs.tasks.design.compensator.minimal_order_compensator_page import partitioned_gain
from symobs.tasks.design.compensator.unstable_law_caution import caution_law
from symobs.tasks.design.page_parts.block_diagrams import draw_tracking
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.design.reference.tracking import TrackingDesign
from symobs.tasks.result import page_of


@page_of(TrackingDesign)
def write_tracking(page: Builder, design: TrackingDesign) -> None:
    """Write the reference, the gains, K_d and the errors."""
    loop = design.loop
    write_both_gains(page, loop)
    if is_ill_posed(page, loop):
        return
    with page.section("tracking"):
        _reference(page, design)
        if design.has_gains and design.answer["K_d"] is not None:
            _law(page, design)
        _gain(page, design)
        if design.has_gains and design.answer["K_d"] is not None:
            caution_law(page, loop)
            draw_tracking(page, minimal=isinstance(loop.estimator, ReducedOrderObserver))
            _errors(page, design)


def _reference(page: Builder, design: TrackingDesign) -> None:
    """Write ẋ_d = A_d x_d."""
    page.set("A_ref", design.reference)
    page.dynamics("x_d", page["A_ref"] @ page["x_d"], silent=True)
    page.equal(
        relation(page["x_d"].derivative, page["A_ref"] @ page["x_d"]),
        relation(page["A_ref"], design.reference),
        say="reference",
    )


def _law(page: Builder, design: TrackingDesign) -> None:
    """Write u = K (x_d − x̂) − K_d x_d, and the equation of the error."""
    page.set("K_d", design.answer["K_d"])
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    if minimal:
        partitioned_gain(page)
        shown = page["K_1"] @ page["x_1"] + page["K_2"] @ page["x_2_hat"]
    else:
        shown = page["K"] @ page["x_hat"]
    page.signal("u", page["K"] @ page["x_d"] - shown - page["K_d"] @ page["x_d"], silent=True)
    both = (page["K"] - page["K_d"]) @ page["x_d"] - shown
    page.equal(
        relation(page["u"], page["K"] @ (page["x_d"] - page["x_hat"]) - page["K_d"] @ page["x_d"], both),
        say="tracking_law",
    )
    page.signal("e_d", page["x_d"] - page["x"], silent=True)
    A, B, K = (page[name] for name in "ABK")
    through = B @ page["K_2"] @ page["e_2"] if minimal else B @ K @ page["e"]
    page.equal(
        relation(
            page["e_d"].derivative,
            (A - B @ K) @ page["e_d"] + (page["A_ref"] - A + B @ page["K_d"]) @ page["x_d"] - through,
        ),
        say="tracking_error",
        error=relation(page["e_d"], page["x_d"] - page["x"]),
    )


def _gain(page: Builder, design: TrackingDesign) -> None:
    """Write A_d − A + BK_d = 0, for every reference or for what one trajectory passes through."""
    A, B = page["A"], page["B"]
    order, columns = design.passed.shape
    if design.start is not None:
        page.set("x_d0", design.start)
        passes = block([[page["A_ref"] ** k @ page["x_d0"] if k else page["x_d0"] for k in range(columns)]])
        page.define("V_d", passes, say="tracking_condition_one", start=relation(page["x_d0"], design.start))
    V = page["V_d"] if design.start is not None else None
    if design.answer["K_d"] is None:
        page.set("w_d", design.answer["w"])
        w = page["w_d"]
        left = w @ (A - page["A_ref"]) if V is None else w @ (A - page["A_ref"]) @ V
        page.conclude(
            "tracking_impossible" if V is None else "tracking_impossible_one",
            relation(left, "!==", Matrix.zeros(1, columns)),
            row=relation(w, w.as_value),
            annuls=relation(w @ B, Matrix.zeros(1, page.plant.inputs)),
            left=relation(left, left.as_value),
        )
        return
    if not page.defines("K_d"):
        page.set("K_d", design.answer["K_d"])
    K_d = page["K_d"]
    zero = block([[page.value(Matrix.zeros(order, columns))]])
    condition = page["A_ref"] - A + B @ K_d
    page.equal(
        relation(condition if V is None else condition @ V, zero),
        say="tracking_condition" if V is None else "tracking_condition_then",
    )
    page.equal(relation(K_d, K_d.as_value), say="tracking_solved", answer=True)
    if K_d.value.is_zero:
        page.conclude("tracking_no_feedforward", relation(K_d, Matrix.zeros(*K_d.value.shape)))


def _errors(page: Builder, design: TrackingDesign) -> None:
    """Write the block triangular matrix of both errors, and its polynomial."""
    minimal = isinstance(design.loop.estimator, ReducedOrderObserver)
    A, B, C, K, L = (page[name] for name in "ABCKL")
    order, size = page.plant.order, design.matrix_of_errors.shape[0]
    own = page["A_22"] - L @ page["A_12"] if minimal else A - L @ C
    through = B @ page["K_2"] if minimal else B @ K
    zero = page.value(Matrix.zeros(size - order, order))
    one = design.start is not None
    whole, parts = block([[A - B @ K, -through], [zero, own]]), [order, size - order]
    page.define(
        "A_e",
        whole,
        in_blocks(page, whole.value, parts, parts),
        say="tracking_errors_one" if one else "",
        silent=not one,
        closing=False,
    )
    if not one:
        state = block([[page["e_d"]], [page["e_2" if minimal else "e"]]])
        page.equal(
            relation(state.derivative, whole @ state, in_blocks(page, whole.value, parts, parts) @ state),
            say="tracking_errors",
            answer=True,
        )
    determinant = (page.s @ page.identity(size) - page["A_e"]).apply("det")
    page.equal(
        relation(determinant, page.term(formula_of_factored(design.loop.loop_polynomial))), say="tracking_polynomial"
    )
