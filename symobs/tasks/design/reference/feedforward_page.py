"""The page of the feedforward."""

from __future__ import annotations

from symobs.exact import Matrix, Scalar, rank, transfer_matrix
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.factored_form import factored_form, formula_of_factored
from symobs.tasks.design.compensator.estimate_feedback_page import is_ill_posed, write_both_gains
from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator
from symobs.tasks.design.compensator.minimal_order_compensator_page import partitioned_gain
from symobs.tasks.design.compensator.unstable_law_caution import caution_law
from symobs.tasks.design.gain.placement_problem import FEEDBACK, OBSERVER
from symobs.tasks.design.page_parts import readability
from symobs.tasks.design.page_parts.block_diagrams import draw_feedforward
from symobs.tasks.design.reference.feedforward import FeedforwardDesign
from symobs.tasks.result import page_of


@page_of(FeedforwardDesign)
def write_feedforward(page: Builder, design: FeedforwardDesign) -> None:
    """Write the gains, the loop with its new input, and F."""
    loop = design.loop
    minimal = isinstance(loop, MinimalOrderCompensator)
    write_both_gains(page, loop)
    if loop.answer["K"] is None or loop.answer["L"] is None:
        return
    if is_ill_posed(page, loop):
        return
    with page.section("feedforward"):
        if design.answer["F"] is None:
            _impossible(page, design)
            return
        _loop(page, design, minimal=minimal)
        _gain(page, design)
        caution_law(page, loop)
        draw_feedforward(page, minimal=minimal)


def _at_rest(page: Builder) -> Term:
    """Return (C − DK)(−A + BK)⁻¹B + D, in discrete time (C − DK)(I − A + BK)⁻¹B + D."""
    A, B, C, K = (page[name] for name in "ABCK")
    closed = B @ K - A
    if page.plant.is_discrete:
        closed = page.identity(page.plant.order) - A + B @ K
    if not page.plant.matrices.has_feedthrough:
        return C @ closed.inverse @ B
    return (C - page["D"] @ K) @ closed.inverse @ B + page["D"]


def _impossible(page: Builder, design: FeedforwardDesign) -> None:
    """Write that the loop never comes to rest, or the gain at rest has dependent rows, whatever K is."""
    if design.answer["stuck"] is not None:
        x = page.set("x_0", design.answer["stuck"])
        moved = (page["A"] - page["B"] @ page["K"]) @ x
        there = x if page.plant.is_discrete else page.value(Matrix.zeros(page.plant.order, 1))
        page.conclude("no_rest", state=relation(x, x.as_value), still=relation(moved, there))
        return
    page.define("G_0", _at_rest(page), say="gain_at_rest")
    m = page.plant.matrices
    whole = rank(transfer_matrix(m.A, m.B, m.C, m.D, page.plant.variable)[0])
    if not whole:
        page.conclude(
            "no_feedforward_none", relation(_response(page), Matrix.zeros(page.plant.outputs, page.plant.inputs))
        )
        return
    if page["G_0"].value.shape == (1, 1):
        page.conclude("no_feedforward_single", relation(page["G_0"], Matrix.zeros(1, 1)))
        return
    w = page.set("w_0", design.answer["w"])
    slots = {"row": relation(w, w.as_value), "vanishes": relation(w @ page["G_0"], Matrix.zeros(1, page.plant.inputs))}
    found = relation(_response(page).apply("rank"), whole)
    if whole < page.plant.outputs:
        page.conclude("no_feedforward_low", rank=found, **slots)
    else:
        page.conclude("no_feedforward_zero", found, **slots)


def _response(page: Builder) -> Term:
    """Return C(sI − A)⁻¹B + D."""
    resolvent = (page.s @ page.identity(page.plant.order) - page["A"]).inverse
    response = page["C"] @ resolvent @ page["B"]
    return response + page["D"] if page.plant.matrices.has_feedthrough else response


def _loop(page: Builder, design: FeedforwardDesign, *, minimal: bool) -> None:
    """Write u = −K x̂ + F v, and what becomes of state, error and output."""
    plant, m = page.plant, page.plant.matrices
    F = design.answer["F"]
    page.set("F_v", F if isinstance(F, Matrix) else Matrix.of([[F]]))
    if minimal:
        partitioned_gain(page)
        page.signal(
            "u",
            -page["K_1"] @ page["x_1"] - page["K_2"] @ page["x_2_hat"] + page["F_v"] @ page["v_r"],
            say="feedforward_law",
        )
    else:
        page.signal("u", -page["K"] @ page["x_hat"] + page["F_v"] @ page["v_r"], say="feedforward_law")
    A, B, C, K, F_v = (page[name] for name in ("A", "B", "C", "K", "F_v"))
    x, v, error = page["x"], page["v_r"], page["e_2" if minimal else "e"]
    coupling = page["K_2"] if minimal else K
    own = page["A_22"] - page["L"] @ page["A_12"] if minimal else A - page["L"] @ C
    lines = [
        relation(x.derivative, (A - B @ K) @ x + B @ coupling @ error + B @ F_v @ v),
        relation(error.derivative, own @ error),
    ]
    output = C @ x
    if m.has_feedthrough:
        D = page["D"]
        output = (C - D @ K) @ x + D @ coupling @ error + D @ F_v @ v
    page.equal(*lines, relation(page["y"], output), say="feedforward_loop")
    errors = design.loop.error_coordinates.shape[0] - plant.order
    zero = page.value(Matrix.zeros(errors, plant.order))
    page.define("A_cl", block([[A - B @ K, B @ coupling], [zero, own]]), silent=True, closing=False)
    state, driven = block([[x], [error]]), block([[B @ F_v], [page.value(Matrix.zeros(errors, plant.outputs))]])
    page.conclude_silently(relation(state.derivative, page["A_cl"] @ state + driven @ v))
    determinant = (page.s @ page.identity(plant.order + errors) - page["A_cl"]).apply("det")
    of_rest = page.s @ page.identity(errors) - page["A_22"] + page["L"] @ page["A_12"] if minimal else None
    of_error = OBSERVER.error_determinant(page) if of_rest is None else of_rest.apply("det")
    parts_of = FEEDBACK.error_determinant(page) @ of_error
    product = page.term(formula_of_factored(design.loop.loop_polynomial))
    page.equal(relation(determinant, parts_of, product), say="feedforward_polynomial")


def _gain(page: Builder, design: FeedforwardDesign) -> None:
    """Write F from the gain at rest, and the transfer function from v to y."""
    plant, m = page.plant, page.plant.matrices
    A, B, C, K, F_v = (page[name] for name in ("A", "B", "C", "K", "F_v"))
    page.define("G_0", _at_rest(page), say="gain_at_rest")
    G = page["G_0"]
    if plant.inputs == plant.outputs:
        page.equal(relation(F_v, G.inverse, F_v.as_value), say="feedforward_gain", answer=True)
    else:
        page.equal(relation(F_v, G.T @ (G @ G.T).inverse, F_v.as_value), say="feedforward_smallest", answer=True)
    one = page.identity(plant.outputs) if plant.outputs > 1 else page.value(1)
    page.verified("as_required", check=relation(G @ F_v, one))
    resolvent = (page.s @ page.identity(plant.order) - A + B @ K).inverse
    response = C @ resolvent @ B @ F_v
    if m.has_feedthrough:
        response = (C - page["D"] @ K) @ resolvent @ B @ F_v + page["D"] @ F_v
    T = design.answer["transfer_function"]
    if isinstance(T, Scalar):
        page.define("T_v", response, factored_form(page, T), say="feedforward_response", answer=True, closing=False)
    else:
        shown = [page.value(T)] if T.size <= readability.MATRIX else []
        page.define("T_v", response, *shown, say="feedforward_response", answer=True, closing=False)
    page.conclude_silently(relation(page["T_v"], T))
