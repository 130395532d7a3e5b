"""The page of the unknown-input observer: rank test, H and T, zeros, gain, observer, and its error equation without d."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, roots_of
from symobs.formula.tree import Roots
from symobs.formula.tree.term import block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.tasks.analysis.page_parts import case_steps, given, say_stability
from symobs.tasks.analysis.rank.rank_page import assume_rank
from symobs.tasks.design.disturbance.unknown_input_observer import UnknownInputObserver, independent_columns
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.page_parts.component_equations import combination, summed
from symobs.tasks.design.page_parts.pole_cautions import caution_poles
from symobs.tasks.design.page_parts.time_responses import plot_error
from symobs.tasks.design.page_parts.unassignable import say_unassignable
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term


@page_of(UnknownInputObserver)
def write_unknown_input_observer(page: Builder, design: UnknownInputObserver) -> None:
    """Write the data, why d can be decoupled or not, the gain, and the observer."""
    given(page, ("observer", design.desired), disturbed=design.disturbance_input)
    with page.section("unknown_input_observer"):
        _design(page, design)
        if design.answer["L"] is not None:
            _observer(page, design)
            plot_error(page, "e", page["F_d"])
        page.steps += case_steps(page, design, _case)


def _case(page: Builder, design: UnknownInputObserver) -> None:
    """Write the design on a stratum."""
    page.set("E_d", design.disturbance_input)
    page.set("phi_o", design.desired.polynomial)
    _design(page, design)


def _design(page: Builder, design: UnknownInputObserver) -> None:
    """Write the rank of C E, H and T, the zeros and the gain; or the reason why there is no observer."""
    E = _independent(page, design)
    if design.inner is None:
        _not_decoupled(page, design)
        return
    _decoupled(page, design, E)
    _zeros(page, design)
    if design.answer["L"] is not None:
        _gain(page, design)


def _independent(page: Builder, design: UnknownInputObserver) -> Term:
    """Return E, or the letter of its independent columns."""
    found = independent_columns(design.disturbance_input, design.plant.ideal)
    if found.shape[1] == design.disturbance_input.shape[1] or not found.shape[1]:
        return page["E_d"]
    rank = relation(page["E_d"].apply("rank"), found.shape[1])
    return page.define("E_1", page.value(found), say="uio_independent", closing=False, rank=rank)


def _not_decoupled(page: Builder, design: UnknownInputObserver) -> None:
    """Write that E w is not seen in the output, so that no H has H C E = E."""
    C, E, along = page["C"], page["E_d"], ""
    unseen, direction = C @ E, E
    if design.disturbance_input.shape[1] > 1:
        w = page.set("w_0", design.answer["w"])
        page.equal(relation(w, w.as_value), say="uio_direction")
        C, E = page["C"], page["E_d"]
        unseen, direction, along = C @ E @ w, E @ w, "_along"
    zero, nothing = (Matrix.zeros(size, 1) for size in (page.plant.outputs, page.plant.order))
    differs = relation(direction, "!==" if direction.value.names else "!=", nothing)
    page.conclude(f"uio_not_decoupled{along}", unseen=relation(unseen, zero), nonzero=differs)


def _decoupled(page: Builder, design: UnknownInputObserver, E: Term) -> None:
    """Write the rank of C E, a solution H of H C E = E, T = I − H C and T A."""
    C, H = page["C"], design.answer["H"]
    conditions = [c.expression for c in design.holds_where if c.kind != "domain"]
    if H.is_zero:
        page.define("H_d", page.value(H), say="uio_nothing", closing=False, answer=True)
    else:
        seen = C @ E
        page.equal(relation(seen, seen.as_value), say="uio_seen")
        if conditions:
            page.assume("uio_provided", *conditions)
        count = seen.value.shape[1]
        page.conclude("uio_decoupled", rank=relation(seen.apply("rank"), E.apply("rank"), count))
        square = seen.value.shape[0] == count
        left = seen.inverse if square else (seen.T @ seen).inverse @ seen.T
        page.define("H_d", E @ left, say="uio_output_matrix", answer=True)
        H_d, identity = page["H_d"], page.identity(page.plant.order)
        page.conclude_silently(
            relation((H_d @ C - identity) @ page["E_d"], Matrix.zeros(*design.disturbance_input.shape))
        )
    T = page.define("T_d", page.identity(page.plant.order) - page["H_d"] @ C, say="uio_projection")
    page.define("A_T", T @ page["A"])


def _zeros(page: Builder, design: UnknownInputObserver) -> None:
    """Write whether (C, T A) is observable: its unobservable modes are the zeros of (A, E, C)."""
    assert design.inner is not None  # noqa: S101 - the caller's branch
    pair, plant, C, A = design.inner.pair, page.plant, page["C"], page["A_T"]
    tested = block([[C @ A**k if k else C] for k in range(plant.order)])
    if pair.is_observable:
        assume_rank(page, "uio_provided", design.inner.test, design)
        page.conclude("uio_observable", rank=relation(tested.apply("rank"), plant.order))
        return
    count = pair.kernel.shape[1]
    page.set("N", pair.kernel)
    X = page.set("X", pair.restricted)
    fixed = (page.s @ page.identity(count) - X).apply("det")
    zeros = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, plant.variable))
    if design.answer["L"] is not None:
        page.conclude("uio_zeros_desired", predicate("polynomial", page["phi_o"] / fixed), zeros=zeros)
        return
    keys, polynomial = ("uio_impossible", "uio_unassignable"), design.desired.polynomial
    say_unassignable(page, keys, page["phi_o"], polynomial, fixed, design.case_tree, zeros=zeros)
    signs, discrete = plant.symbols.signs, plant.is_discrete
    found = stability(design.inner.fixed_polynomial, plant.variable, signs, discrete=discrete).verdict
    if found == "yes":
        page.remark("uio_zeros_stable", predicate("stable", fixed))
    elif found == "no":
        page.remark("uio_zeros_unstable", predicate("unstable", fixed))


def _gain(page: Builder, design: UnknownInputObserver) -> None:
    """Write L, F = T A − L C, and what multiplies y in the equation of z."""
    L = page.define("L", page.value(design.answer["L"]), say="uio_gain", closing=False, answer=True)
    F = page.define("F_d", page["A_T"] - L @ page["C"], say="uio_state_matrix")
    page.define("L_y", page["L"] + F @ page["H_d"])
    page.conclude_silently(*(relation(page[name], design.answer[of]) for name, of in _LETTERS.items()))
    pencil, asked = (page.s @ page.identity(page.plant.order) - F).apply("det"), design.desired
    say_as_required(page, asked, pencil, page.value(asked.polynomial))
    caution_poles(page, asked, "phi_o", "observer")
    if not asked.is_numeric:
        say_stability(page, pencil)
    if design.fields["family"] is not None:
        page.remark("uio_family")


#: The letters of the page and the answers that they are.
_LETTERS = {"H_d": "H", "T_d": "T", "L": "L", "F_d": "F", "L_y": "B_y"}


def _observer(page: Builder, design: UnknownInputObserver) -> None:
    """Write the observer, and that its error does not depend on u and d."""
    m, name = page.plant.matrices, "w_o" if page.plant.is_discrete else "z_o"
    z = page[name]
    C, E, F, H, T, B_y, x, y = (page[letter] for letter in ("C", "E_d", "F_d", "H_d", "T_d", "L_y", "x", "y"))
    pairs = [(F, z)]
    known = y
    if m.has_input:
        driven = T @ page["B"] - B_y @ page["D"] if m.has_feedthrough else T @ page["B"]
        pairs.append((driven, page["u"]))
        known = y - page["D"] @ page["u"] if m.has_feedthrough else y
        page.conclude_silently(relation(driven, design.answer["B_u"]))
    pairs.append((B_y, y))
    page.dynamics(name, summed(pairs), silent=True)
    page.signal("x_hat", z + H @ C @ x, silent=True)  # y − D u, whose parts D u have no derivatives that are known
    page.equal(
        relation(z.derivative, summed(pairs), combination(page, pairs)),
        relation(page["x_hat"], z + H @ known, z + H.as_value @ known),
        say="uio_observer",
        answer=True,
    )
    page.signal("e", x - page["x_hat"], silent=True)
    error = relation(page["e"], x - page["x_hat"], T @ x - z)
    rate = F @ page["e"]
    page.equal(
        relation(page["e"].derivative, rate + T @ E @ page["d"], rate, F.as_value @ page["e"]),
        say="uio_error",
        error=error,
    )
