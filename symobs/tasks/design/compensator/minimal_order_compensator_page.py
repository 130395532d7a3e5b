"""The page of the compensator with a minimal-order observer; after Example 4.4."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Literal, Quotient
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, predicate, relation, sentence
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import formula_of_factored, given, in_blocks, is_narrow
from symobs.tasks.design import readability
from symobs.tasks.design.compensator.compensator import KnownState
from symobs.tasks.design.compensator.compensator_page import (
    Namer,
    caution_repeated,
    caution_unstable_loop,
    define_or_hold,
    named_return_path,
    of_given,
    return_path,
    return_path_of_several,
    say_stability,
)
from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator
from symobs.tasks.design.compensator.output_feedback import caution_hidden
from symobs.tasks.design.components import combination
from symobs.tasks.design.error_plots import plot_estimate
from symobs.tasks.design.full_order.observer import write_observer
from symobs.tasks.design.gain.gain_design import FEEDBACK, OBSERVER, page_style
from symobs.tasks.design.gain.gain_page import write_cases, write_gain
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.design.reduced_order.reduced_order_observer_page import observer_state, write_observer_of_rest
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback


@page_of(MinimalOrderCompensator)
def write_minimal_order(page: Builder, design: MinimalOrderCompensator) -> None:
    """Write the whole page."""
    given(page, ("control", design.feedback.desired), ("observer", design.estimator.desired))
    page.in_letters = large = design.exists and design.answer["F"].size > readability.COMPENSATOR
    with page.section("state_feedback"):
        style = page_style("auto", design.plant, several=design.plant.inputs > 1)
        write_gain(page, design.feedback, FEEDBACK, style, of_loop=True)
    caution_repeated(page, design)
    write_observer_of_rest(page, design.estimator)
    if design.answer["K"] is None or design.answer["L"] is None:
        return
    with page.section("compensator"):
        write_control_law(page, design, large=large)
        if not design.exists:
            return
        _closed(page, large=large)
        _transfer_function(page, design, large=large)
        caution_hidden(page, design.answer["F"], design.own_matrix)
    with page.section("closed_loop"):
        _error_coordinates(page, design, large=large)
        if not design.is_single:
            return_path_of_several(page, design)
        elif large:
            named_return_path(page, design, _own_denominator(page))
        else:
            return_path(page, design)


def _one(page: Builder) -> Term:
    """Return I, or 1 for one input."""
    return page.identity(page.plant.inputs) if page.plant.inputs > 1 else page["1"]


def write_control_law(page: Builder, design: MinimalOrderCompensator, *, large: bool) -> None:
    """Write u = −K x̂ in terms of the output and of the observer's state."""
    plant = page.plant
    partitioned_gain(page)
    K_1, K_2 = page["K_1"], page["K_2"]
    page.signal("u", page("(-K_1) x_1 - {K_2} x_2_hat", K_2=K_2), say="minimal_control")
    if K_1.value.shape == K_2.value.shape == (1, 1) and not plant.matrices.has_feedthrough:
        pairs = [(-K_1.value, page["y"]), (-K_2.value, page["x_2_hat"])]
        page.equal(relation(page["u"], *_numbers(page, pairs, large=False)))
    page.conclude_silently("u = (-K) x_hat")
    page.define("K_y", K_1 + K_2 @ page["L"], say="output_gain")
    K_y, K_2, u, y, z = (page[name] for name in ("K_y", "K_2", "u", "y", observer_state(page)))
    law, pairs = -K_y @ y - K_2 @ z, [(-K_y.value, y), (-K_2.value, z)]
    if not plant.matrices.has_feedthrough:
        page.equal(relation(u, law, *_numbers(page, pairs, large=large)), say="minimal_control_in_y")
        return
    solving = _one(page) - K_y @ page["D"]
    page.equal(relation(solving @ u, law), say="minimal_control_in_y")
    determinant = relation(solving.apply("det") if plant.inputs > 1 else solving, 0)
    if not design.exists:
        page.conclude("ill_posed_for_some" if design.other_gains_may_do else "ill_posed", determinant=determinant)
        return
    factors = vanishing_factors([design.well_posedness.numerator], plant.symbols.signs)
    if factors:
        page.assume("well_posed_assumed", *factors)
    for case in design.ill_posed:
        if case.result is not None:
            step = Conclude(sentence("ill_posed_there", {"determinant": determinant}))
            page.steps.append(CaseStep(relation(case.when[0].expression, 0), tuple(case.substitution.items()), (step,)))
    page.define("W_u", solving.inverse, say="minimal_control_solved")
    W, K_y, K_2, u, y, z = (page[name] for name in ("W_u", "K_y", "K_2", "u", "y", observer_state(page)))
    pairs = [(-(W @ K_y).value, y), (-(W @ K_2).value, z)]
    page.equal(relation(u, -(W @ K_y) @ y - W @ K_2 @ z, *_numbers(page, pairs, large=large)))


def partitioned_gain(page: Builder) -> None:
    """Write [K₁ K₂] = K T⁻¹."""
    plant, K, T = page.plant, page["K"], page["T"]
    whole = K if T.value == Matrix.identity(plant.order) else page["K T^-1"]
    parts, inputs = whole.value.normal(), range(plant.inputs)
    page.set("K_1", parts.select(inputs, range(plant.outputs)))
    page.set("K_2", parts.select(inputs, range(plant.outputs, plant.order)))
    both = page["[K_1, K_2]"]
    page.equal(relation(whole, both, both.as_value), say="partitioned_gain")


def _numbers(page: Builder, pairs: list[tuple[Matrix | Scalar, Term]], *, large: bool) -> list[Term]:
    """Return the combination with numbers, where it is short enough to be read."""
    if large:
        return []
    tables = [(value if isinstance(value, Matrix) else Matrix.of([[value]]), signal) for value, signal in pairs]
    return [combination(page, [(page.value(value.normal()), signal) for value, signal in tables])]


def _closed(page: Builder, *, large: bool) -> None:
    """Write the compensator in state space."""
    F, G, H, K_y, K_2 = (page[name] for name in ("F_z", "G_z", "H_z", "K_y", "K_2"))
    y, z = page["y"], page[observer_state(page)]
    solved, direct = (page["W_u K_2"], page["W_u K_y"]) if page.plant.matrices.has_feedthrough else (K_2, K_y)
    own, driven = F - G @ solved, H - G @ direct
    pairs = [(own.value, z), (driven.value, y)]
    page.set("A_c", own.value)
    page.set("B_c", driven.value)
    page.equal(
        relation(z.derivative, page("A_c {z} + B_c y", z=z), *_numbers(page, pairs, large=large)),
        say="minimal_closed",
        state=relation(page["A_c"], own),
        input=relation(page["B_c"], driven),
    )


def _own_denominator(page: Builder) -> Term:
    """Return det(sI − A_c), over W where the output contains the input."""
    own = page["det(s I - A_c)"]
    return page["det(s I - A_c) / W_u"] if page.plant.matrices.has_feedthrough else own


def _apart(page: Builder, pencil: Term) -> list[Term]:
    """Return K₂ · Z/Y + K_y and the direct term with what decays: for an observer of first order, nothing solved for."""
    K_2, K_y, B_c = (page[name].value for name in ("K_2", "K_y", "B_c"))
    if page.plant.matrices.has_feedthrough or K_2.shape != (1, 1) or page["F_z"].value.shape != (1, 1):
        return []
    state = B_c[0, 0] / pencil.value[0, 0]
    rest = K_2[0, 0] * state
    if rest.is_zero or K_y.is_zero:
        return []
    falls = rest.numerator.is_constant and rest.numerator.fraction() < 0
    parts = (
        page("{K_y} - {rest}", K_y=K_y[0, 0], rest=-rest) if falls else page("{K_y} + {rest}", K_y=K_y[0, 0], rest=rest)
    )
    return [page("{K_2} {state} + {K_y}", K_2=K_2[0, 0], state=state, K_y=K_y[0, 0]), parts]


def _transfer_function(page: Builder, design: MinimalOrderCompensator, *, large: bool) -> None:
    """Write F(s) = K₂ (sI − A_c)⁻¹ B_c + K_y, times W where the output contains the input."""
    K_y, K_2, B_c = (page[name] for name in ("K_y", "K_2", "B_c"))
    pencil = page["s I - A_c"]
    formula = page["K_2 (s I - A_c)^-1 B_c + K_y"]
    if page.plant.matrices.has_feedthrough:
        formula = page["W_u"] @ formula
    direct = page["W_u K_y"] if page.plant.matrices.has_feedthrough else K_y
    if not design.is_single:
        define_or_hold(page, "F", formula, design.answer["F"], "minimal_transfer")
    elif large:
        variable, names = page.plant.variable, Namer(page)
        F = formula.scalar
        lead = F.denominator.coefficients(variable)[0]
        above = names.polynomial("n", (F.numerator / lead).coefficients(variable), variable)
        below = names.polynomial("d", (F.denominator / lead).coefficients(variable)[1:], variable, monic=True)
        page.define("F", formula, page.value(above / below), say="minimal_transfer", answer=True)
        names.show()
        page.conclude_silently(relation(page["F"], design.answer["F"]))
        # The letters of F say nothing of the stability of what they stand for.
        top = page.value(above.coefficients(variable)[0] if above.degree(variable) == below.degree(variable) else 0)
        falls = predicate("strictly_proper", page["F"] - top)
        page.conclude("minimal_proper", falls, direct=relation(direct, top))
        return
    else:
        numbers = _plain(page, K_2) @ _plain(page, pencil).inverse @ _plain(page, B_c) + _plain(page, K_y)
        if page.plant.matrices.has_feedthrough:
            numbers = _plain(page, page["W_u"]) @ numbers
        above, below = design.own_transfer
        whole = (above / below).denominator.degree(page.plant.variable) == below.degree(page.plant.variable)
        plain = above.denominator.is_one and below.denominator.is_one and whole
        result = page.term(Quotient(Literal(above), Literal(below))) if plain else page.value(design.answer["F"])
        page.define(
            "F", formula, numbers, *_apart(page, pencil), result, say="minimal_transfer", answer=True, closing=False
        )
    # Of F with its own numbers the letters of K say nothing; the formula holds whatever they stand for.
    remainder = predicate("strictly_proper", (formula if page.environment.coefficients else page["F"]) - direct)
    say_stability(page, design, "minimal", remainder, direct=relation(direct, direct.as_value))


def _error_coordinates(page: Builder, design: MinimalOrderCompensator, *, large: bool) -> None:
    """Write u = −Kx + K₂e₂, ẋ = (A − BK) x + BK₂e₂, block triangular; and the same in (x, z)."""
    z, order = page[observer_state(page)], page.plant.order
    control = page.line("u = (-K) x + K_2 e_2")
    rate = page.line("x' = (A - B K) x + B K_2 e_2")
    estimated = order - page.plant.outputs
    zero = page.value(Matrix.zeros(estimated, order))
    matrix, sizes = page("[A - B K, B K_2; {zero}, F_z]", zero=zero), [order, estimated]
    numbers = [in_blocks(page, matrix.value, sizes, sizes)] if not large and is_narrow(matrix.value) else []
    page.define("A_cl", matrix, *numbers, say="closed_loop_matrix", closing=False, control=control, rate=rate)
    page.equal("[x; e_2]' = A_cl [x; e_2]")
    determinant = page["det(s I - A_cl)"]
    parts = page("{value} det(s I - F_z)", value=FEEDBACK.error_determinant(page))
    product = page.term(formula_of_factored(design.loop_polynomial))
    page.equal(relation(determinant, parts, product), say=f"polynomial_splits{of_given(design)}")
    caution_unstable_loop(page, design, determinant)
    G = page["G_z"]
    driven = page["G_z + H_z D"] if page.plant.matrices.has_feedthrough else G
    second = page("[A - B K_y C, -B K_2; (H_z - {driven} K_y) C, F_z - {driven} K_2]", driven=driven)
    states = page("[x; {z}]", z=z)
    is_written = not large and order <= readability.WRITTEN_OUT_ORDER and is_narrow(second.value)
    numbers = [in_blocks(page, second.value, sizes, sizes) @ states] if is_written else []
    page.equal(relation(states.derivative, second @ states, *numbers), say="reduced_coordinates")
    plot_estimate(page, "e_2", page["A_cl"], (page["T^-1"].value).select(range(order), range(order - estimated, order)))


def _plain(page: Builder, term: Term) -> Term:
    """Return a value written out, a 1×1 matrix as a number."""
    value = term.value
    return page.value(value[0, 0] if isinstance(value, Matrix) and value.shape == (1, 1) else value)


# The first part of pages with estimated-state feedback: both gains, and the law solved for the input.


def write_both_gains(page: Builder, loop: OutputFeedback) -> None:
    """Write the data, the feedback and the observer, where there is one."""
    plant = page.plant
    asked = zip(("control", "observer"), (half.desired for half in loop.halves), strict=False)
    given(page, *asked)
    with page.section("state_feedback"):
        write_gain(page, loop.feedback, FEEDBACK, page_style("auto", plant, several=plant.inputs > 1))
    if isinstance(loop, KnownState):
        return
    if isinstance(loop.estimator, ReducedOrderObserver):
        write_observer_of_rest(page, loop.estimator)
        return
    with page.section("observer"):
        style = page_style("auto", plant, several=plant.outputs > 1)
        write_gain(page, loop.estimator, OBSERVER, style, cases=False)
        if loop.answer["L"] is not None:
            write_observer(page)
        write_cases(page, loop.estimator, OBSERVER)


def is_ill_posed(page: Builder, loop: OutputFeedback) -> bool:
    """Write that the law cannot be solved for u although both gains exist; return whether this is the case."""
    if loop.exists or None in (loop.answer["K"], loop.answer["L"]) or not isinstance(loop, MinimalOrderCompensator):
        return False
    with page.section("compensator"):
        write_control_law(page, loop, large=False)
    return True
