"""The page of integral action: plant and integrator together, the rank condition, the gains, the closed loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, rank
from symobs.formula.tree import Evaluated, Literal
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.tasks.analysis.page_parts import case_steps, given, say_stability
from symobs.tasks.design.page_parts.pole_cautions import caution_poles
from symobs.tasks.design.page_parts.unassignable import say_unassignable
from symobs.tasks.design.reference.integral_action import IntegralAction, closed_loop, extended
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.formula.tree.term import Term


@page_of(IntegralAction)
def write_integral_action(page: Builder, design: IntegralAction) -> None:
    """Write the data, the extended plant, the gains and the closed loop."""
    given(page, ("control", design.desired))
    with page.section("integral_action"):
        _extended(page)
        _design(page, design)
        if design.answer["K"] is not None:
            state = block([[page["x"]], [page["xi_I"]]])
            page.equal(
                relation(state.derivative, page["A_cl"] @ state + _enters(page) @ page["r_in"]), say="integral_closed"
            )
            _at_rest(page, design)
            caution_poles(page, design.desired, "phi_c", "servo")
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: IntegralAction) -> None:
    """Write what is found on a stratum."""
    page.set("phi_c", design.desired.polynomial)
    _name_extended(page)
    _design(page, design, is_case=True)


def _extended(page: Builder) -> None:
    """Write ξ' = r − y, and both equations together."""
    kind = "discrete" if page.plant.is_discrete else "continuous"
    xi, error = page["xi_I"], page["r_in"] - page["y"]
    page.dynamics("xi_I", xi + error if page.plant.is_discrete else error, say=f"integral_state_{kind}")
    plant, m = page.plant, page.plant.matrices
    n, p = plant.order, plant.outputs
    corner = page.identity(p) if plant.is_discrete else page.value(Matrix.zeros(p, p))
    parts = block([[page["A"], page.value(Matrix.zeros(n, p))], [-page["C"], corner]])
    page.define("A_hat", parts, say="integral_extended")
    below = -page["D"] if m.has_feedthrough else page.value(Matrix.zeros(p, plant.inputs))
    page.define("B_hat", block([[page["B"]], [below]]))
    state = block([[page["x"]], [xi]])
    driven = page["B_hat"] @ page["u"] + _enters(page) @ page["r_in"]
    page.equal(relation(state.derivative, page["A_hat"] @ state + driven), say="integral_together")


def _name_extended(page: Builder) -> None:
    """Let the letters of the extended plant stand for its matrices."""
    m = extended(page.plant).matrices
    page.set("A_hat", m.A)
    page.set("B_hat", m.B)


def _enters(page: Builder) -> Term:
    plant = page.plant
    return page.value(Matrix.block([[Matrix.zeros(plant.order, plant.outputs)], [Matrix.identity(plant.outputs)]]))


def _design(page: Builder, design: IntegralAction, *, is_case: bool = False) -> None:
    """Write the rank condition, and the gains or the reason why there are none."""
    assumed = design.assumed
    if assumed:
        page.assume("integral_provided", *assumed)
    _say_condition(page, design)
    if design.answer["K"] is None:
        if design.loop.answer["K"] is None:
            _impossible(page, design)
        return
    conditions = [c.expression for c in design.holds_where if c.kind != "domain" and c.expression not in assumed]
    if conditions:
        page.assume("integral_provided", *conditions)
    _gains(page, design)
    if design.fields["family"] is not None:
        page.remark("integral_family")
    if not is_case:
        page.signal("u", -page["K"] @ page["x"] + page["k_I"] @ page["xi_I"], say="integral_law")
    _closed_loop(page)


def _system(page: Builder) -> Term:
    A, plant = page["A"], page.plant
    D = page["D"] if plant.matrices.has_feedthrough else page.value(plant.matrices.D)
    return block([[A - page.identity(plant.order) if plant.is_discrete else A, page["B"]], [page["C"], D]])


def _controllability(page: Builder) -> Relation:
    """Return rank [B, AB, …] = n, or by how much it is less."""
    A, B, order = page["A"], page["B"], page.plant.order
    tested = block([[A**k @ B if k else B for k in range(order)]])
    found = rank(tested.value, page.plant.ideal)
    whole = tested.apply("rank")
    return relation(whole, order) if found == order else relation(whole, found, "<", order)


def _say_condition(page: Builder, design: IntegralAction) -> None:
    """Say whether plant and integrator are controllable, and by which rank."""
    plant = page.plant
    size, place = plant.order + plant.outputs, "one" if plant.is_discrete else "origin"
    whole, controllable = _system(page), _controllability(page)
    if design.answer["w"] is not None:
        row = page.set("w_0", design.answer["w"])
        annuls = relation(row @ whole, Matrix.zeros(1, plant.order + plant.inputs))
        page.conclude("integral_blocked", row=relation(row, row.as_value), annuls=annuls)
    elif len(controllable.operators) > 1:
        page.conclude("integral_uncontrollable", rank=controllable)
    else:
        found = relation(whole.apply("rank"), size)
        page.conclude(f"integral_possible_{place}", controllable=controllable, rank=found)


def _impossible(page: Builder, design: IntegralAction) -> None:
    """Write that the modes of plant and integrator that no gain moves are not among the desired poles."""
    pair = design.loop.pair
    page.set("N_K", pair.kernel)
    X = page.set("X_K", pair.restricted)
    fixed = (page.s @ page.identity(pair.kernel.shape[1]) - X).apply("det")
    say_unassignable(
        page,
        ("integral_impossible", "integral_unassignable"),
        page["phi_c"],
        design.desired.polynomial,
        fixed,
        design.case_tree,
        fixed=Evaluated(fixed.formula, Literal(design.loop.fixed_polynomial)),
    )


def _gains(page: Builder, design: IntegralAction) -> None:
    """Write [K, −k_I] of the extended plant, and its parts."""
    plant, gain = page.plant, design.loop.answer["K"]
    K, k_I = page.set("K", design.answer["K"]), page.set("k_I", design.answer["k_I"])
    both = block([[K, -k_I]])
    A_hat, B_hat = page["A_hat"], page["B_hat"]
    page.equal(relation(both, gain), say="integral_gains")
    page.equal(relation(K, K.as_value), say="integral_parts", answer=True)
    page.equal(relation(k_I, k_I.as_value), answer=True)
    pencil = page.s @ page.identity(plant.order + plant.outputs) - A_hat + B_hat @ both
    page.verified("as_required", check=relation(pencil.apply("det"), page.value(design.desired.polynomial)))
    if not design.desired.is_numeric:
        say_stability(page, pencil.apply("det"))


def _closed_loop(page: Builder) -> None:
    """Write the matrix of the closed loop in (x, ξ)."""
    plant = page.plant
    page.define("A_cl", block(closed_loop(page.environment, plant)), say="integral_loop")


def _at_rest(page: Builder, design: IntegralAction) -> None:
    """Write the gain at rest, which is one: the last rows of the closed loop are r − y."""
    plant, A_cl = page.plant, page["A_cl"]
    zero = design.desired.polynomial.substitute({plant.variable: Scalar.of(int(plant.is_discrete))})
    if zero.is_zero:
        return
    C, k_I, size = page["C"], page["k_I"], plant.order + plant.outputs
    corner, seen = page.value(Matrix.zeros(plant.outputs, plant.outputs)), C
    if plant.matrices.has_feedthrough:
        seen, corner = C - page["D"] @ page["K"], page["D"] @ k_I
    rest = (page.identity(size) - A_cl if plant.is_discrete else -A_cl).inverse
    gain = block([[seen, corner]]) @ rest @ _enters(page)
    at_rest = relation(gain, Matrix.identity(plant.outputs))
    asked, discrete = design.desired, plant.is_discrete
    if asked.is_numeric and stability(asked.polynomial, plant.variable, {}, discrete=discrete).verdict == "yes":
        loop = (page.s @ page.identity(size) - A_cl).apply("det")
        has_poles = relation(loop, page["phi_c"])
        page.conclude("integral_rest_stable", has_poles, predicate("stable", page["phi_c"]), gain=at_rest)
    else:
        page.conclude("integral_rest", gain=at_rest)
