"""The page of the compensator: gains, F(s) through its four stages (S0, Example 4.2), and the closed loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.analysis.pages import factored_form, formula_of_factored, given
from symobs.design.gain_pages import FEEDBACK, OBSERVER, closed_loop_matrix, error_determinant, write_gain
from symobs.design.observer import page_style, write_observer
from symobs.exact import Factored, Matrix, Root, Scalar, root_of_pole, roots_of
from symobs.formula import Exactly, Literal, Quotient, Roots
from symobs.formula.term import block
from symobs.page import Page, predicate, relation
from symobs.stability import as_inequality, stability

if TYPE_CHECKING:
    from symobs.design.compensator import CompensatorDesign

#: Conditions with more terms than this are left to the JSON.
_READABLE_TERMS = 40


def write_compensator(page: Page, design: CompensatorDesign) -> None:
    """Write the whole page."""
    given(page, ("control", design.feedback.desired), ("observer", design.estimator.desired))
    style = page_style("auto", design.plant)
    with page.section("state_feedback"):
        write_gain(page, design.feedback, FEEDBACK, style)
    with page.section("observer"):
        write_gain(page, design.estimator, OBSERVER, style)
        if design.answer["L"] is not None:
            write_observer(page)
    if design.answer["F"] is None:
        return
    with page.section("compensator"):
        _state_space(page, design)
        _transfer_function(page, design)
    with page.section("closed_loop"):
        _error_coordinates(page, design)
        _return_path(page, design)
    _cautions(page, design)


def _state_space(page: Page, design: CompensatorDesign) -> None:
    """U = −K x̂ put into the observer: (4.23), (4.24)."""
    m = design.plant.matrices
    A, B, C, K, L = (page[name] for name in "ABCKL")
    page.signal("u", -K @ page["x_hat"], say="separation")
    closed, shown = A - B @ K - L @ C, A.shown - (B @ K).shown - (L @ C).shown
    if m.has_feedthrough:
        closed, shown = closed + L @ page["D"] @ K, shown + (L @ page["D"] @ K).shown
    page.equal(relation(page["x_hat"].derivative, closed @ page["x_hat"] + L @ page["y"]), say="observer_closed")
    page.define("A_c", closed, shown, say="compensator_matrix")


def _transfer_function(page: Page, design: CompensatorDesign) -> None:
    """(4.25) in four stages: inverse, adjugate over determinant, adjugate times L, scalar."""
    K, L, F = page["K"], page["L"], design.answer["F"]
    order = design.plant.order
    pencil = (page.s @ page.identity(order) - page["A_c"]).value
    characteristic = design.compensator_matrix.characteristic_polynomial(design.plant.variable)
    adjugate = pencil.adjugate()
    one_over = page.term(Quotient(Literal(Scalar.of(1)), Literal(characteristic)))
    resolvent = page.value(pencil)
    stages = [
        K @ (page.s @ page.identity(order) - page["A_c"]).inverse @ L,
        K.shown @ resolvent.inverse @ L.shown,
        one_over @ K.shown @ page.value(adjugate) @ L.shown,
        one_over @ K.shown @ page.value((adjugate @ L.value).normal()),
        page.value(F),
    ]
    page.define("F", *stages, say="transfer_function_of_compensator", answer=True)
    found = design.F_stable
    properness = predicate("strictly_proper", F)
    key = {"yes": "compensator_stable", "no": "compensator_unstable"}.get(found)
    if key is None:
        _stable_where(page, F)
    else:
        page.conclude(key, properness, predicate("stable" if found == "yes" else "unstable", F.denominator))


def _stable_where(page: Page, F: Scalar) -> None:
    """Say for which parameters the compensator itself is stable, where the conditions are few."""
    plant = page.plant
    found = stability(F.denominator, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    proper = predicate("strictly_proper", F)
    if sum(value.size for value in found.positive) > _READABLE_TERMS:
        page.conclude("compensator_proper", proper)
        return
    inequalities = [as_inequality(value, plant.symbols.signs) for value in found.positive]
    where = tuple(relation(left, operator, right) for left, operator, right in inequalities)
    page.conclude("compensator_stable_if", proper, where=Exactly(predicate("stable", F.denominator), where))


def _error_coordinates(page: Page, design: CompensatorDesign) -> None:
    """(4.26)-(4.29): u = −Kx + Ke, ẋ = (A − BK) x + BKe, block triangular."""
    A, B, C, K, L = (page[name] for name in "ABCKL")
    x, e = page["x"], page["e"]
    page.equal(
        relation(page["u"], -K @ x + K @ e),
        relation(x.derivative, (A - B @ K) @ x + B @ K @ e),
        say="control_in_error",
    )
    zero = page.value(Matrix.zeros(design.plant.order, design.plant.order))
    state = block([[x], [e]])
    matrix = block([[A - B @ K, B @ K], [zero, A - L @ C]])
    page.define("A_cl", matrix, say="closed_loop_matrix")
    page.equal(relation(state.derivative, page["A_cl"] @ state))
    left = (page.s @ page.identity(2 * design.plant.order) - page["A_cl"]).apply("det")
    page.equal(
        relation(
            left,
            error_determinant(page, FEEDBACK) @ error_determinant(page, OBSERVER),
            page.term(formula_of_factored(design.closed_loop_polynomial)),
        ),
        say="polynomial_splits",
    )
    second = block([[A, -(B @ K)], [L @ C, A - B @ K - L @ C]])
    states = block([[x], [page["x_hat"]]])
    page.equal(relation(states.derivative, second @ states, second.shown @ states), say="estimate_coordinates")


def _return_path(page: Page, design: CompensatorDesign) -> None:
    """P/(1 + PF), multiplied out and factored."""
    numerator, characteristic = design.plant_transfer
    page.define("P", factored_form(page, numerator / characteristic), say="plant_transfer", closing=False)
    page.diagram(
        "loop", plant=factored_form(page, numerator / characteristic), compensator=page.value(design.answer["F"])
    )
    form = design.closed_loop
    denominator = Factored(Scalar.of(1), tuple((f, -power) for f, power in form.factors if power < 0)).value
    expanded = page.term(Quotient(Literal(form.value * denominator), Literal(denominator)))
    definition = page["P"] / (page.value(1) + page["P"] @ page["F"])
    factors = page.term(formula_of_factored(form))
    page.define("G_cl", definition, expanded, factors, say="return_path", answer=True, closing=False)
    polynomial = design.closed_loop_polynomial.value
    page.conclude("loop_poles", poles=Roots(Literal(polynomial), _poles(design, polynomial)))


def _poles(design: CompensatorDesign, polynomial: Scalar) -> tuple[Root, ...]:
    """Return the poles in the order they were asked for, or as the roots of the polynomial."""
    poles: list[Root] = []
    for part in (design.feedback, design.estimator):
        desired = part.desired
        if desired is None or not desired.poles:
            return roots_of(polynomial, design.plant.variable)
        poles += [root_of_pole(pole, design.plant.variable) for pole in desired.poles]
    return tuple(poles)


def _cautions(page: Page, design: CompensatorDesign) -> None:
    """Warn where an expert would: a repeated control pole is defective, so its exponential alone does not bound x."""
    plant = design.plant
    desired = design.feedback.desired
    if desired is None or plant.symbols.signs or not desired.is_numeric:
        return
    for factor, power in desired.grouped():
        if power > 1 and factor.degree(plant.variable) == 1:
            pole = -factor.coefficients(plant.variable)[1]
            offset = closed_loop_matrix(page, FEEDBACK) - page.value(pole) @ page.identity(plant.order)
            zero = Matrix.zeros(plant.order, plant.order)
            facts = relation(offset, "!==", zero)
            page.caution("defective", facts, pole=page.value(pole), matrix=relation(offset, offset.shown))
            return
