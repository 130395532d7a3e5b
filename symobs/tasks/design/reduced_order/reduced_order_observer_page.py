"""The page of the reduced-order observer: partition, observability of the unmeasured subsystem, observer, z, assembly."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Scalar, roots_of
from symobs.formula.tree import Roots
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.wording_check import relation_fits
from symobs.stability.criteria.stability import stability
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import case_steps, formula_of_factored, given, in_blocks
from symobs.tasks.analysis.rank.observability import Observability
from symobs.tasks.analysis.rank.rank_page import rank_cases, write_test
from symobs.tasks.design import readability
from symobs.tasks.design.block_diagrams import draw_minimal_order
from symobs.tasks.design.components import combination, summed
from symobs.tasks.design.error_plots import plot_error
from symobs.tasks.design.full_order.observer import undetermined
from symobs.tasks.design.gain.gain_design import OBSERVER
from symobs.tasks.design.gain.gain_page import say_as_required
from symobs.tasks.design.gain.small_gain_page import compare_with_simple, small_gain_terms
from symobs.tasks.design.gain.structured_gain_page import is_held, write_structured
from symobs.tasks.design.named_gains import define_gain, gain_letters
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.reduced_order.reduced_order_observer import DependentOutputs, ReducedOrderObserver, partition
from symobs.tasks.design.unassignable import say_unassignable
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Relation


# The reduced-order observer with undetermined matrices: x̂₂ = z + L x₁, ż = F z + G u + H y with undetermined F, G, H.


def write_undetermined(page: Builder, design: ReducedOrderObserver) -> None:
    """Write the error of the ansatz, collected by signals, and the choice of F, G and H that frees it of x and u."""
    m, name = page.plant.matrices, "w_o" if page.plant.is_discrete else "z_o"
    page.set("L", gain_letters(page, "L", design.answer["L"]))
    for letter, stem in (("F_z", "f_"), ("H_z", "h_"), ("G_z", "g_")):
        value = design.answer[letter[0]]
        if value is not None:
            undetermined(page, letter, stem, value)
    L, F, H, z, x_1, x_2, u = (page[key] for key in ("L", "F_z", "H_z", name, "x_1", "x_2", "u"))
    page.signal("x_2_hat", z + L @ x_1, silent=True)
    rate = F @ z + page["G_z"] @ u if m.has_input else F @ z
    page.dynamics(
        name, rate + H @ page["y"], say="undetermined_ansatz", estimate=relation(page["x_2_hat"], z + L @ x_1)
    )
    page.signal("e_2", x_2 - page["x_2_hat"], silent=True)
    fed = page("A_21 - {L} A_11", L=L) + F @ L
    moving = page("{F} e_2 + {x_1} + (A_22 - {L} A_12 - {F}) {x_2}", F=F, x_1=(fed - H) @ x_1, L=L, x_2=x_2)
    choice = [page.line("{F} = A_22 - {L} A_12", F=F, L=L), relation(H, F @ L + page["A_21"] - L @ page["A_11"])]
    if m.has_input:
        wanted = page("B_2 - {L} B_1", L=L)
        wanted = wanted - H @ page["D"] if m.has_feedthrough else wanted
        moving = moving + (wanted - page["G_z"]) @ u
        choice.insert(1, relation(page["G_z"], wanted))
    error = page.line("e_2 = {x_2} - x_2_hat", x_2=x_2)
    page.equal(page.line("e_2' = {moving}", moving=moving), say="undetermined_error", error=error)
    page.equal(*choice, say="undetermined_choice")
    page.equal(page.line("e_2' = {F} e_2", F=F), say="undetermined_left")


@page_of(ReducedOrderObserver)
def write_reduced_order(page: Builder, design: ReducedOrderObserver) -> None:
    """Write data, test, gain, and the observer without the derivative of the output."""
    given(page, ("observer", design.desired))
    write_observer_of_rest(page, design)
    if design.answer["L"] is not None:
        draw_minimal_order(page)
        plot_error(page, "e_2", page["A_22 - L A_12"])


def _dependent_outputs(page: Builder, design: DependentOutputs) -> None:
    """Write the combination of outputs that vanishes."""
    page.set("w_0", design.answer["w"])
    zero = Matrix.zeros(1, page.plant.order)
    page.conclude("outputs_dependent", row=page.line("w_0 = #"), vanishes=page.line("w_0 C = {zero}", zero=zero))


def write_observer_of_rest(page: Builder, design: ReducedOrderObserver) -> None:
    """Write the test, the gain, and the observer without the derivative of the output."""
    if isinstance(design, DependentOutputs):
        with page.section("reduced_order_observer"):
            _dependent_outputs(page, design)
        return
    with page.section("observability"):
        test = Observability.of(page.plant, "rank")
        write_test(page, OBSERVER.matrix, test, OBSERVER.test)
        rank_cases(page, "O", test, "observability")
    with page.section("reduced_order_observer"):
        _coordinates(page, design)
        if design.answer["L"] is None:
            _impossible(page, design)
        else:
            _whole_observer(page, design)
        page.steps += case_steps(page, design, _case)


def _whole_observer(page: Builder, design: ReducedOrderObserver) -> None:
    """Write the gain and the observer by the method of the page."""
    _parts(page, design)
    if design.page_method == "undetermined":
        write_undetermined(page, design)
        write_inner_gain(page, design)
        _assembled(page, design, ("undetermined_matrices", "rest_set_out"))
    else:
        _observer(page, design)
        write_inner_gain(page, design)
        _without_derivative(page)
        _assembled(page, design, ("reduced_matrices", "rest_estimated"))


def _case(page: Builder, design: ReducedOrderObserver) -> None:
    """Write on a stratum the coordinates where they are others, the gain and the observer, or why there is none."""
    if isinstance(design, DependentOutputs):
        _dependent_outputs(page, design)
        return
    page.set("phi_o", design.desired.polynomial)
    _coordinates(page, design, known=page.defines("T") and page["T"].value == design.answer["T"])
    if design.answer["L"] is None:
        _impossible(page, design)
        return
    key = "gain_follows" if design.inner.fixed_polynomial.is_one else ""
    if not key:
        _say_fixed_modes(page, design)
    define_gain(page, "L", design.answer["L"], say=key)
    conditions = [c.expression for c in design.holds_where if c.kind == "claim" and c.operator == "!="]
    if conditions:
        page.assume("gain_provided", *conditions)
    page.conclude_silently(relation(_determinant(page), page["phi_o"]))
    _matrices(page, design, "undetermined_matrices")


def _coordinates(page: Builder, design: ReducedOrderObserver, *, known: bool = False) -> None:
    """Write T = [C; R] and the blocks of T A T⁻¹ and T B; without words where T is known or the unit matrix."""
    plant, parts = page.plant, partition(page.plant, design.answer["T"])
    order, measured = plant.order, plant.outputs
    page.set("R", parts.T.select(range(measured, order), range(order)))
    trivial = known or Matrix.identity(order) == parts.T
    names = {
        "A_11": parts.A11,
        "A_12": parts.A12,
        "A_21": parts.A21,
        "A_22": parts.A22,
        "B_1": parts.B1,
        "B_2": parts.B2,
    }
    for name, value in names.items():
        if value is not None:
            page.set(name, value)
    stacked = page["[C; R]"]
    if trivial:
        page.set("T", parts.T)
        page.conclude_silently("T = [C; R]")
    else:
        page.define("T", stacked, say="coordinates")
    exceptions = vanishing_factors([parts.T.determinant()], plant.symbols.signs)
    if exceptions:
        page.assume("coordinates_assumed", *exceptions)
    whole, driven = [page["T A T^-1"]], [page["T B"]]
    shown = _in_parts(page, whole, driven)
    if trivial:
        page.conclude_silently(*shown)
    else:
        page.equal(*shown, say="measured_are_first" if exceptions else "measured_first")


def _in_parts(page: Builder, whole: Sequence[Term], driven: Sequence[Term]) -> list[Relation]:
    """Return the blocks of A and B, those of measured and of other states divided by lines; what equals them before."""
    plant = page.plant
    sizes = [plant.outputs, plant.order - plant.outputs]
    blocks = page["[A_11, A_12; A_21, A_22]"]
    shown = [relation(*whole, blocks, in_blocks(page, blocks.value, sizes, sizes))]
    if plant.matrices.has_input:
        inputs = page["[B_1; B_2]"]
        shown.append(relation(*driven, inputs, in_blocks(page, inputs.value, sizes, [plant.inputs])))
    return shown


def _parts(page: Builder, design: ReducedOrderObserver) -> None:
    """Write x₁ = C x and x₂ = R x with their equations, and Lemma 4.1."""
    trivial = page["T"].value == Matrix.identity(page.plant.order)
    page.signal("x_1", "C x", silent=True)
    page.signal("x_2", "R x", silent=True)
    x_1, x_2, u = page["x_1"], page["x_2"], page["u"]
    driven = page.plant.matrices.has_input
    first, second = [(page["A_11"], x_1), (page["A_12"], x_2)], [(page["A_21"], x_1), (page["A_22"], x_2)]
    if driven:
        first.append((page["B_1"], u))
        second.append((page["B_2"], u))
    feedthrough = page.plant.matrices.has_feedthrough
    known = page["y - D u"] if feedthrough else page["y"]
    said: dict[str, Any] = {
        "measured": page.line("x_1 = C x = {known}", known=known),
        "unmeasured": relation(x_2, (page["#R"] if trivial else page["R"]) @ page["x"]),
    }
    key = "parts_with_feedthrough" if feedthrough else "parts"
    lines = [(x_1, first), (x_2, second)]
    if trivial and page.plant.order > readability.BLOCKS_ORDER:
        page.equal(*_in_parts(page, [], []), say=f"{key}_blocks", **said)
        page.equal(*(relation(part.derivative, summed(pairs)) for part, pairs in lines), say="two_parts")
    else:
        rates = (relation(part.derivative, summed(pairs), combination(page, pairs)) for part, pairs in lines)
        page.equal(*rates, say=key, **said)
    _mere_copy(page)
    if design.inner.fixed_polynomial.is_one:
        row, order = page["A_12"], page.plant.order - page.plant.outputs
        test = block([[row @ page["A_22"] ** k if k else row] for k in range(order)])
        found = relation(test.apply("rank"), order)
        if relation_fits(
            "first_part_measures", found, page.environment
        ):  # with parameters it may be so for generic ones only
            page.conclude("first_part_measures", rank=found)


def _observer(page: Builder, design: ReducedOrderObserver) -> None:
    """Write (4.37) and (4.38), the gain a matrix of unknowns."""
    several = page.plant.outputs > 1 and design.inner.fixed_polynomial.is_one
    kept = is_held(page, OBSERVER, design.answer["L"], page["A_22"], page["A_12"]) if several else None
    gain = page.set("L", gain_letters(page, "L", design.answer["L"], kept or (lambda _: False))).value
    x_2_hat = page["x_2_hat"]
    copy = page["A_21 x_1 + A_22 x_2_hat"]
    innovation = page["x_1' - A_11 x_1"]
    if page.plant.matrices.has_input:
        copy, innovation = copy + page["B_2 u"], innovation - page["B_1 u"]
    page.dynamics(
        "x_2_hat",
        page("{copy} + L ({innovation} - A_12 x_2_hat)", copy=copy, innovation=innovation),
        say="reduced_observer",
    )
    if page.plant.outputs == 1 and len(gain.entries) <= readability.UNKNOWN_ENTRIES:
        pairs = _collected(page)
        if sum(matrix.value.size for matrix, _ in pairs) <= readability.OUTPUT_DERIVATIVE:
            page.equal(relation(x_2_hat.derivative, combination(page, pairs)), say="with_gain_unknown")
    page.signal("e_2", "x_2 - x_2_hat", silent=True)
    page.equal(
        page.line("e_2' = {error_matrix} e_2", error_matrix=_error_matrix(page)),
        say="reduced_error",
        error=page.line("e_2 = x_2 - x_2_hat"),
    )


def _mere_copy(page: Builder) -> None:
    """Write a first attempt: the estimate takes x₁ from the measurement, so its output error is 0 and corrects nothing."""
    if not any(page["A_12"].value.entries):  # then no observer does better
        return
    copy = page["A_21 x_1 + A_22 x_2_hat"]
    if page.plant.matrices.has_input:
        copy = page("{copy} + B_2 u", copy=copy)
    page.remark("mere_copy", left=page.line("x_2' - {copy} = A_22 (x_2 - x_2_hat)", copy=copy))
    own = page["det(s I - A_22)"]
    plant = page.plant
    if stability(own.scalar, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).verdict == "no":
        unstable = predicate("unstable", own)
        if own.scalar.names - {plant.variable}:
            page.remark("mere_copy_fails", unstable)
        else:
            page.remark("mere_copy_grows", unstable, roots=Roots(own.formula, roots_of(own.scalar, plant.variable)))


def _error_matrix(page: Builder) -> Term:
    return page["A_22 - L A_12"]


def _determinant(page: Builder) -> Term:
    return page["det(s I - A_22 + L A_12)"]


def write_inner_gain(page: Builder, design: ReducedOrderObserver) -> None:
    """Compare the coefficients of det(sI − A₂₂ + L A₁₂), linear in L for one output, with those of φ."""
    desired, variable = design.desired, page.plant.variable
    unknown, several = page["L"].value, page.plant.outputs > 1
    found = _determinant(page).scalar
    if not several:
        page.equal(
            relation(page["L"], unknown), relation(_determinant(page), page.value(found)), say="with_unknown_gain"
        )
    grouped = page.term(formula_of_factored(Factored(Scalar.of(1), desired.grouped())))
    plain = page.value(desired.polynomial)
    wished = [plain] if desired.is_expanded else [grouped, plain]
    page.define("phi_o", *wished, say="polynomial_is_to_be" if several else "wanted_polynomial")
    if not several:
        pairs = zip(found.coefficients(variable)[1:], desired.coefficients, strict=True)
        open_ = [relation(have, want) for have, want in pairs if not have.is_constant]
        if open_:
            page.equal(*open_, say="compare")
    if not design.inner.fixed_polynomial.is_one:
        _say_fixed_modes(page, design)
    rest = page["A_22"], page["A_12"]
    terms, say = small_gain_terms(page, design.inner, OBSERVER, *rest)
    key = say or ("one_of_several" if several else "hence_gain")
    if several and not terms and design.inner.fixed_polynomial.is_one:
        is_compared = write_structured(
            page, OBSERVER, design.answer["L"], *rest, page["phi_o"], lambda L: page.set("L", L), "form_of_several"
        )
        key = "gain_follows" if is_compared else key
    key = key if design.inner.fixed_polynomial.is_one else ""
    define_gain(page, "L", *terms, design.answer["L"], say=key)
    compare_with_simple(page, design.inner, OBSERVER, *rest)
    page.in_decimals("L")
    say_as_required(page, desired, _determinant(page), plain)
    caution_poles(page, desired, "phi_o", "observer")


def _say_fixed_modes(page: Builder, design: ReducedOrderObserver) -> None:
    """State that the modes that A₁₂ does not show are among the desired poles."""
    fixed = _fixed_modes(page, design)
    modes = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, page.plant.variable))
    rest = page["phi_o"] / fixed
    key = "reduced_all_fixed" if rest.value == 1 else "reduced_not_unique"
    page.remark(key, predicate("polynomial", rest), relation(rest, rest.value), modes=modes)


def observer_state(page: Builder) -> str:
    """Return the letter of the observer's state: in discrete time z is the variable."""
    return "w_o" if page.plant.is_discrete else "z_o"


def _collected(page: Builder) -> list[tuple[Term, Term]]:
    """Return (4.39): the signals of the right-hand side with their matrices, the derivative of x₁ among them."""
    L, x_1 = page["L"], page["x_1"]
    pairs = [(_error_matrix(page), page["x_2_hat"]), (page["A_21 - L A_11"], x_1)]
    if page.plant.matrices.has_input:
        pairs.append((page["B_2 - L B_1"], page["u"]))
    return [*pairs, (L, x_1.derivative)]


def _without_derivative(page: Builder) -> None:
    """Write (4.39) and (4.40): z = x̂₂ − L x₁ in place of x̂₂."""
    m, x_1, x_2_hat = page.plant.matrices, page["x_1"], page["x_2_hat"]
    name = observer_state(page)
    page.signal(name, "x_2_hat - L x_1", silent=True)
    z, closed = page[name], _error_matrix(page)
    rate, fed = closed @ z, page("{closed} L + A_21 - L A_11", closed=closed)
    if m.has_input:
        rate = page("{rate} + (B_2 - L B_1) u", rate=rate)
    page.equal(relation(x_2_hat.derivative, summed(_collected(page))), say="right_side_collected")
    page.equal(
        relation(z.derivative, rate + fed @ x_1),
        say="next_output" if page.plant.is_discrete else "derivative_of_output",
        state=page.line(f"{name} = x_2_hat - L x_1"),
    )


def _assembled(page: Builder, design: ReducedOrderObserver, say: tuple[str, str]) -> None:
    """Write F, G, H and the observer, and (4.41): the estimate put together again."""
    m, L, u, x_1, z = page.plant.matrices, page["L"], page["u"], page["x_1"], page[observer_state(page)]
    _matrices(page, design, say[0], closing=False)  # the observer has their values
    pairs = [(page["F_z"], z)]
    if design.answer["G"] is not None:
        pairs.append((page["G_z"], u))
    pairs.append((page["H_z"], page["y"]))
    page.equal(relation(z.derivative, summed(pairs), combination(page, pairs)), say="reduced_final", answer=True)
    output = page["y - D u"] if m.has_feedthrough else page["y"]
    stacked = block([[output], [z]])
    order, outputs = page.plant.order - page.plant.outputs, page.plant.outputs
    corner = page.value(Matrix.zeros(outputs, order))
    above, below = page.identity(outputs), page.identity(order)
    lift = page("[{above}, {corner}; L, {below}]", above=above, corner=corner, below=below)
    page.define("M_z", page["T^-1"] @ lift, silent=True)
    page.signal("x_hat", page["M_z"] @ stacked, silent=True)
    estimate = page["[x_1; x_2_hat]"]
    single = order == outputs == 1 and not m.has_feedthrough
    numbers = [combination(page, [(page.value(Matrix.identity(1)), z), (L, page["y"])])] if single else []
    page.equal(relation(page["x_2_hat"], z + L @ x_1, *numbers), say=say[1])
    trivial = page["T"].value == Matrix.identity(page.plant.order)
    page.equal(
        relation(page["x_hat"], estimate if trivial else page["T^-1 [x_1; x_2_hat]"], page["#M_z"] @ stacked),
        say="assembled",
        answer=True,
    )
    unseen = page("[{corner} e_2; e_2]", corner=corner)
    page.conclude_silently(page.line("x - x_hat = T^-1 {unseen}", unseen=unseen))


def _matrices(page: Builder, design: ReducedOrderObserver, say: str, *, closing: bool = True) -> None:
    """Write F = A₂₂ − L A₁₂, H = F L + A₂₁ − L A₁₁, G = B₂ − L B₁, which a feedthrough changes by −H D."""
    m = page.plant.matrices
    page.define("F_z", _error_matrix(page), say=say, closing=closing)
    if m.has_input and not m.has_feedthrough:
        page.define("G_z", "B_2 - L B_1", closing=closing)
    page.define("H_z", "F_z L + A_21 - L A_11", closing=closing)
    if m.has_input and m.has_feedthrough:
        page.define("G_z", "B_2 - L B_1 - H_z D", closing=closing)
    page.conclude_silently(
        *(relation(page[f"{name}_z"], design.answer[name]) for name in "FGH" if design.answer[name] is not None)
    )


def _fixed_modes(page: Builder, design: ReducedOrderObserver) -> Term:
    """Introduce the part of x₂ that A₁₂ does not show; return its polynomial."""
    pair = design.inner.pair
    page.set("N_2", pair.kernel)
    page.set("X_2", pair.restricted)
    return page["det(s I - X_2)"]


def _impossible(page: Builder, design: ReducedOrderObserver) -> None:
    """Write that no gain moves the modes that A₁₂ does not show, and that they are not desired."""
    fixed = _fixed_modes(page, design)
    modes = Roots(fixed.formula, roots_of(design.inner.fixed_polynomial, page.plant.variable))
    keys, polynomial = ("reduced_impossible", "reduced_unassignable"), design.desired.polynomial
    say_unassignable(page, keys, page["phi_o"], polynomial, fixed, design.case_tree, modes=modes)
