"""The page of the disturbance observer: plant and exosystem together, observability, the gain, observer and error."""

from __future__ import annotations

from symobs.exact import Matrix, rank, roots_of
from symobs.formula.tree import Roots
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.tasks.analysis.page_parts import case_steps, given, say_stability
from symobs.tasks.analysis.rank.rank_page import assume_rank
from symobs.tasks.design.disturbance.disturbance_observer import DisturbanceObserver, extended
from symobs.tasks.design.full_order.observer import model_and_innovation
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.page_parts.pole_cautions import caution_poles
from symobs.tasks.design.page_parts.unassignable import say_unassignable
from symobs.tasks.result import page_of


@page_of(DisturbanceObserver)
def write_disturbance_observer(page: Builder, design: DisturbanceObserver) -> None:
    """Write the data, plant and exosystem together, the gain, and the observer."""
    given(page, ("observer", design.desired), disturbed=design.exosystem.E)
    with page.section("disturbance_observer"):
        _together(page, design)
        _design(page, design)
        if design.answer["L_x"] is not None:
            _observer(page, design)
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: DisturbanceObserver) -> None:
    """Write the design on a stratum."""
    for name, value in zip(("E_d", "S_w", "V_w"), design.exosystem, strict=True):
        page.set(name, value)
    page.set("phi_o", design.desired.polynomial)
    _name_extended(page, design, silent=True)
    _design(page, design)


def _together(page: Builder, design: DisturbanceObserver) -> None:
    """Write ẇ = S w and d = V w, and both equations together."""
    plant, m, (_, S, V) = page.plant, page.plant.matrices, design.exosystem
    page.set("S_w", S)
    page.set("V_w", V)
    w = page["w_e"]
    page.dynamics("w_e", page["S_w"] @ w, silent=True)
    page.signal("d", page["V_w"] @ w, silent=True)
    if _is_constant(design):
        generated = [relation(w.derivative, page["S_w"] @ w), relation(page["S_w"], S)]
        page.equal(*generated, relation(page["d"], w), say="disturbance_constant")
    else:
        generated = [relation(w.derivative, page["S_w"].as_value @ w)]
        page.equal(*generated, relation(page["d"], page["V_w"].as_value @ w), say="disturbance_model")
    _name_extended(page, design)
    state = block([[page["x"]], [page["w_e"]]])
    rate, seen = page["A_hat"] @ state, page["C_hat"] @ state
    if m.has_input:
        below = page.value(Matrix.zeros(S.shape[0], plant.inputs))
        page.define("B_hat", block([[page["B"]], [below]]))
        rate = page["A_hat"] @ state + page["B_hat"] @ page["u"]
    seen = page["C_hat"] @ state
    seen = seen + page["D"] @ page["u"] if m.has_feedthrough else seen
    page.equal(relation(state.derivative, rate), relation(page["y"], seen), say="disturbance_together")


def _name_extended(page: Builder, design: DisturbanceObserver, *, silent: bool = False) -> None:
    """Define Â = [A EV; 0 S] and Ĉ = [C 0]."""
    outputs, order = page.plant.outputs, design.exosystem.order
    whole = block(extended(page.environment, page.plant, design.exosystem))
    page.define("A_hat", whole, say="" if silent else "disturbance_extended", silent=silent)
    page.define("C_hat", block([[page["C"], page.value(Matrix.zeros(outputs, order))]]), silent=silent)


def _is_constant(design: DisturbanceObserver) -> bool:
    """Return whether the disturbance is constant: d = w, with S = 0, in discrete time S = I."""
    _, S, V = design.exosystem
    order = S.shape[0]
    still = Matrix.identity(order) if design.plant.is_discrete else Matrix.zeros(order, order)
    return still == S and Matrix.identity(order) == V


def _design(page: Builder, design: DisturbanceObserver) -> None:
    """Write whether plant and exosystem are observable, and the gain or the reason why there is none."""
    pair, plant, C, A = design.inner.pair, page.plant, page["C_hat"], page["A_hat"]
    order = plant.order + design.exosystem.order
    conditions = [c.expression for c in design.holds_where if c.kind != "domain"]
    if conditions:
        page.assume("disturbance_provided", *conditions)
    tested = block([[C @ A**k if k else C] for k in range(order)])
    if pair.is_observable:
        assume_rank(page, "disturbance_provided", design.inner.test, design)
        page.conclude("disturbance_observable", rank=relation(tested.apply("rank"), order))
        _zeros(page, design)
    else:
        count = pair.kernel.shape[1]
        page.set("N", pair.kernel)
        X = page.set("X", pair.restricted)
        fixed = (page.s @ page.identity(count) - X).apply("det")
        roots = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, plant.variable))
        if design.answer["L_x"] is None:
            keys, polynomial = ("disturbance_impossible", "disturbance_unassignable"), design.desired.polynomial
            say_unassignable(page, keys, page["phi_o"], polynomial, fixed, design.case_tree, modes=roots)
            _zeros(page, design)
            return
        page.conclude("disturbance_fixed", predicate("polynomial", page["phi_o"] / fixed), modes=roots)
    L = page.define("L", page.value(design.inner.answer["L"]), say="disturbance_gain", closing=False, answer=True)
    pencil = (page.s @ page.identity(order) - A + L @ C).apply("det")
    say_as_required(page, design.desired, pencil, page.value(design.desired.polynomial))
    caution_poles(page, design.desired, "phi_o", "observer")
    if not design.desired.is_numeric:
        say_stability(page, pencil)
    if design.fields["family"] is not None:
        page.remark("disturbance_family")


def _zeros(page: Builder, design: DisturbanceObserver) -> None:
    """Say what observability of plant and exosystem means for the zeros of the plant from d to y."""
    plant, A, C, E = page.plant, page["A"], page["C"], page["E_d"]
    q, n = E.value.shape[1], plant.order
    if not _is_constant(design):
        if q == 1 and design.inner.pair.is_observable:
            page.remark("disturbance_zeros_model")
        return
    first = A - page.identity(n) if plant.is_discrete else A
    whole = block([[first, E], [C, page.value(Matrix.zeros(plant.outputs, q))]])
    found, place = rank(whole.value, plant.ideal), "one" if plant.is_discrete else "origin"
    if design.inner.pair.is_observable:
        page.remark(f"disturbance_zeros_{place}", rank=relation(whole.apply("rank"), n + q))
    elif found < n + q and rank(block([[first], [C]]).value, plant.ideal) == n:  # so that d is not 0 in its kernel
        page.remark(f"disturbance_blocked_{place}", rank=relation(whole.apply("rank"), found, "<", n + q))


def _observer(page: Builder, design: DisturbanceObserver) -> None:
    """Write the observer, the estimate of the disturbance, and the error equation."""
    L, C_hat, A_hat = page["L"], page["C_hat"], page["A_hat"]
    for name, value in (("L_x", design.answer["L_x"]), ("L_w", design.answer["L_w"])):
        page.set(name, value)
    page.conclude_silently(relation(page["L"], block([[page["L_x"]], [page["L_w"]]])))
    model, innovation = model_and_innovation(page)
    w_hat = page["w_hat"]
    page.dynamics("x_hat", model + page["E_d"] @ page["V_w"] @ w_hat + page["L_x"] @ innovation, silent=True)
    page.dynamics("w_hat", page["S_w"] @ w_hat + page["L_w"] @ innovation, silent=True)
    state = block([[page["x_hat"]], [w_hat]])
    rate = A_hat @ state
    left = page["y"] - C_hat @ state
    if page.plant.matrices.has_input:
        rate = rate + page["B_hat"] @ page["u"]
        left = left - page["D"] @ page["u"] if page.plant.matrices.has_feedthrough else left
    page.signal("d_hat", page["V_w"] @ w_hat, silent=True)
    page.equal(
        relation(state.derivative, rate + L @ left),
        relation(page["d_hat"], page["V_w"] @ w_hat, page["V_w"].as_value @ w_hat),
        say="disturbance_equation",
    )
    page.signal("e", page["x"] - page["x_hat"], silent=True)
    page.signal("e_w", page["w_e"] - w_hat, silent=True)
    error, closed = block([[page["e"]], [page["e_w"]]]), page["A_hat"] - L @ C_hat
    both = (relation(page["e"], page["x"] - page["x_hat"]), relation(page["e_w"], page["w_e"] - w_hat))
    page.equal(
        relation(error.derivative, closed @ error, closed.as_value @ error),
        say="disturbance_error",
        state=both[0],
        other=both[1],
    )
