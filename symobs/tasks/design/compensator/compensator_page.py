"""The page of the compensator: gains, F(s) through its four stages, and the closed loop."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Root, Scalar, from_coefficients, rank, root_of_pole, roots_of, transfer
from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Evaluated, HoldsExactlyWhere, Literal, Quotient, Roots
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.wording_check import modes_of_double
from symobs.stability.criteria.stability import monic, no_stable_compensator, stability
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.page_parts import factored_form, formula_of_factored, given, in_blocks, is_narrow
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.design import page_parts as readability
from symobs.tasks.design.compensator.compensator import CompensatorDesign
from symobs.tasks.design.compensator.output_feedback import caution_hidden
from symobs.tasks.design.full_order.observer import model_and_innovation, write_observer
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_design import FEEDBACK, OBSERVER, PlacementProblem, page_style
from symobs.tasks.design.gain.gain_page import name_coefficients, say_as_required, write_case, write_cases, write_gain
from symobs.tasks.design.page_parts import caution_poles, draw_compensator, draw_loop, draw_unity_loop, plot_estimate
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Fact, Relation
    from symobs.proof.derivation.builder import Slot
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback
    from symobs.tasks.design.gain.gain_design import GainDesign


# A repeated control pole, which a matrix with fewer eigenvectors than places for it makes defective.


def caution_repeated(page: Builder, design: OutputFeedback) -> None:
    """Warn of a repeated control pole that is defective: its exponential alone does not bound x."""
    plant = design.plant
    desired = design.feedback.desired if page.defines("K") else None
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
            mode, times = modes_of_double(pole, plant.variable)
            page.caution(
                "defective" if instead is None else "defective_instead",
                held,
                pole=Roots(single.formula, roots_of(factor, plant.variable)),
                mode=mode,
                times=times,
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


# Observer and state feedback in two columns, line by line: the same placement for (Aᵀ, Cᵀ) and for (A, B).


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


#: Up to this order positive coefficients make a polynomial stable in continuous time.
_DECIDED_BY_SIGNS = 2


@page_of(CompensatorDesign)
def write_compensator(page: Builder, design: CompensatorDesign) -> None:
    """Write the whole page."""
    given(page, ("control", design.feedback.desired), ("observer", design.estimator.desired))
    plant = design.plant
    page.in_letters = large = design.answer["F"] is not None and design.answer["F"].size > readability.COMPENSATOR
    beside = design.method == "duality" and can_stand_side_by_side(design)
    if beside:
        write_side_by_side(page, design)
    else:
        with page.section("state_feedback"):
            write_gain(
                page, design.feedback, FEEDBACK, page_style("auto", plant, several=plant.inputs > 1), of_loop=True
            )
    caution_repeated(page, design)
    with page.section("observer"):
        if not beside:
            style = page_style("auto", plant, several=plant.outputs > 1)
            write_gain(page, design.estimator, OBSERVER, style, of_loop=True, cases=False)
        if design.answer["L"] is not None:
            write_observer(page, alone=False)
        if not beside:
            write_cases(page, design.estimator, OBSERVER)
    if design.answer["F"] is None:
        return
    with page.section("compensator"):
        _state_space(page, design)
        if not design.is_single:
            _transfer_matrix(page, design)
        elif large:
            _named_transfer_function(page, design)
        else:
            _transfer_function(page, design)
        caution_hidden(page, design.answer["F"], design.own_matrix)
    with page.section("closed_loop"):
        _error_coordinates(page, design, large=large)
        if not design.is_single:
            return_path_of_several(page, design)
        elif large:
            own = (page.s @ page.identity(design.plant.order) - page["A_c"]).apply("det")
            named_return_path(page, design, own)
        else:
            return_path(page, design)


def _state_space(page: Builder, design: CompensatorDesign) -> None:
    """Write u = −K x̂ put into the observer: (4.23), (4.24)."""
    m = design.plant.matrices
    A, B, C, K, L, x_hat = (page[name] for name in ("A", "B", "C", "K", "L", "x_hat"))
    model, innovation = model_and_innovation(page)
    law = relation(page["u"], -K @ x_hat)
    page.signal("u", -K @ x_hat, say="separation")
    both: dict[str, Any] = {"law": law, "rate": relation(x_hat.derivative, model + L @ innovation)}
    closed, shown = A - B @ K - L @ C, A.as_value - (B @ K).as_value - (L @ C).as_value
    if m.has_feedthrough:
        closed, shown = closed + L @ page["D"] @ K, shown + (L @ page["D"] @ K).as_value
    own, is_written = closed @ x_hat + L @ page["y"], closed.value.size <= readability.MATRIX
    small = page.plant.order == readability.PRODUCTS_ORDER and not m.has_feedthrough
    shown = A.as_value - B.as_value @ K.as_value - L.as_value @ C.as_value if small else shown
    numbers = [shown] if page.plant.order <= readability.WRITTEN_OUT_ORDER else []
    if not is_written:
        page.equal(relation(x_hat.derivative, own), say="observer_closed", **both)
        page.define("A_c", closed, *numbers, say="compensator_matrix")
    else:
        page.define("A_c", closed, *numbers, say="observer_closed_matrix", **both)
        written = page["A_c"].as_value @ x_hat + L.as_value @ page["y"]
        page.conclude_silently(relation(x_hat.derivative, own))
        page.equal(
            relation(x_hat.derivative, page["A_c"] @ x_hat + L @ page["y"], written),
            relation(page["u"], -K.as_value @ x_hat),
            say="compensator_written",
        )
    draw_compensator(page)


def _transfer_function(page: Builder, design: CompensatorDesign) -> None:
    """Write (4.25) in four stages: inverse, adjugate over determinant, adjugate times L, scalar; those that can be read."""
    K, L, F = page["K"], page["L"], design.answer["F"]
    order = design.plant.order
    pencil = (page.s @ page.identity(order) - page["A_c"]).value
    _, characteristic = design.own_transfer
    adjugate = pencil.adjugate()
    driven = (adjugate @ L.value).normal()
    one_over = page.term(Quotient(Literal(Scalar.of(1)), Literal(characteristic)))
    stages = [
        (pencil, K.as_value @ page.value(pencil).inverse @ L.as_value),
        (adjugate, one_over @ K.as_value @ page.value(adjugate) @ L.as_value),
        (driven, one_over @ K.as_value @ page.value(driven)),
    ]
    written = [stage for matrix, stage in stages if is_narrow(matrix, K.value)]
    whole = K @ (page.s @ page.identity(order) - page["A_c"]).inverse @ L
    page.define("F", whole, *written, page.value(F), say="transfer_function_of_compensator", answer=True)
    say_stability(page, design, "compensator", predicate("strictly_proper", page["F"]))


def _transfer_matrix(page: Builder, design: CompensatorDesign) -> None:
    """Write (4.25) for several inputs or outputs: the resolvent, then the entries."""
    K, L, F = page["K"], page["L"], design.answer["F"]
    formula = K @ (page.s @ page.identity(design.plant.order) - page["A_c"]).inverse @ L
    define_or_hold(page, "F", formula, F, "transfer_function_of_compensator")
    say_stability(page, design, "compensator", predicate("strictly_proper", page["F"]))


def define_or_hold(page: Builder, name: str, formula: Term, value: Matrix, say: str) -> None:
    """Introduce a transfer matrix, with its entries where they can be read."""
    page.define(
        name,
        formula,
        *([page.value(value)] if value.size <= readability.MATRIX else []),
        say=say,
        answer=True,
        closing=False,
        value=value,
    )
    page.conclude_silently(relation(page[name], value))


def say_stability(page: Builder, design: OutputFeedback, stem: str, proper: Fact, **slots: Slot) -> None:
    """Say that F is proper and, where the conditions are few, whether or where it is stable by itself."""
    plant, F = page.plant, design.answer["F"]
    found = design.own_stability
    if isinstance(F, Matrix) and F.common_denominator().degree(plant.variable) < 1:
        page.conclude(f"{stem}_proper", proper, **slots)
        return
    if found in {"yes", "no"}:
        word = "stable" if found == "yes" else "unstable"
        facts, reason = [proper, predicate(word, page["F"])], _reason(page, design, word)
        key = f"{stem}_{word}_low" if reason and f"{stem}_{word}_low" in PHRASES else f"{stem}_{word}"
        filled = {**slots, **(reason if key.endswith("_low") else {})}
        if found == "no" and page.defines("phi_c") and page.defines("phi_o"):
            loop, signs = page["phi_c"] @ page["phi_o"], plant.symbols.signs
            if stability(loop.scalar, plant.variable, signs, discrete=plant.is_discrete).verdict == "yes":
                key, facts = f"{key}_alone", [*facts, predicate("stable", loop)]
        page.conclude(key, *facts, **filled)
        return
    polynomial = monic(F.common_denominator(), plant.variable)
    positive = stability(polynomial, plant.variable, plant.symbols.signs, discrete=plant.is_discrete).positive
    if not positive or sum(value.size for value in positive) > readability.STABILITY_CONDITIONS:  # none: undecided
        page.conclude(f"{stem}_proper", proper, **slots)
        return
    inequalities = [as_inequality(value, plant.symbols.signs) for value in positive]
    where = tuple(relation(left, operator, right) for left, operator, right in inequalities)
    page.conclude(f"{stem}_stable_if", proper, where=HoldsExactlyWhere(predicate("stable", page["F"]), where), **slots)


def _reason(page: Builder, design: OutputFeedback, word: str) -> dict[str, Slot]:
    """Return the polynomial of order 1 or 2 whose stability follows from its signs, in continuous time."""
    F, plant = design.answer["F"], page.plant
    if plant.is_discrete or plant.order > _DECIDED_BY_SIGNS or not isinstance(F, Scalar) or not page.defines("A_c"):
        return {}
    own = (page.s @ page.identity(page["A_c"].value.shape[0]) - page["A_c"]).apply("det")
    coefficients = own.scalar.coefficients(plant.variable)
    if own.scalar != monic(F.denominator, plant.variable) or not all(c.is_constant for c in coefficients):
        return {}
    positive = all(c.fraction() > 0 for c in coefficients)
    return {"polynomial": Evaluated(own.formula, Literal(own.scalar))} if positive == (word == "stable") else {}


def _error_coordinates(page: Builder, design: CompensatorDesign, *, large: bool) -> None:
    """Write (4.26)-(4.29): u = −Kx + Ke, ẋ = (A − BK) x + BKe, block triangular."""
    A, B, C, K, L = (page[name] for name in "ABCKL")
    x, e, order = page["x"], page["e"], design.plant.order
    control, rate = relation(page["u"], -K @ x + K @ e), relation(x.derivative, (A - B @ K) @ x + B @ K @ e)
    zero = page.value(Matrix.zeros(order, order))
    state = block([[x], [e]])
    matrix = block([[A - B @ K, B @ K], [zero, A - L @ C]])
    halves = [order, order]
    numbers = [in_blocks(page, matrix.value, halves, halves)] if not large and is_narrow(matrix.value) else []
    page.define("A_cl", matrix, *numbers, say="closed_loop_matrix", closing=False, control=control, rate=rate)
    page.equal(relation(state.derivative, page["A_cl"] @ state))
    determinant = (page.s @ page.identity(2 * order) - page["A_cl"]).apply("det")
    parts = FEEDBACK.error_determinant(page) @ OBSERVER.error_determinant(page)
    product = page.term(formula_of_factored(design.loop_polynomial))
    page.equal(relation(determinant, parts, product), say=f"polynomial_splits{of_given(design)}")
    caution_unstable_loop(page, design, determinant)
    second = block([[A, -(B @ K)], [L @ C, A - B @ K - L @ C]])
    states = block([[x], [page["x_hat"]]])
    members = [states.derivative, second @ states]
    if not large and order <= readability.WRITTEN_OUT_ORDER and is_narrow(second.value):
        members.append(in_blocks(page, second.value, halves, halves) @ states)
    one = page.identity(order)
    turn = block([[one, zero], [one, -one]])
    page.conclude_silently(
        relation(turn @ turn, page.identity(2 * order)), relation(turn @ second @ turn, page["A_cl"])
    )
    page.equal(relation(*members), say="estimate_coordinates", turned=relation(state, turn @ states))
    plot_estimate(page, "e", page["A_cl"], Matrix.identity(order))


def return_path(page: Builder, design: OutputFeedback) -> None:
    """Write P/(1 + PF), multiplied out and factored."""
    plant_form = _plant(page, design)
    form = design.single_loop
    denominator = Factored(Scalar.of(1), tuple((f, -power) for f, power in form.factors if power < 0)).value
    expanded = page.term(Quotient(Literal(form.value * denominator), Literal(denominator)))
    definition = page["P"] / (page.value(1) + page["P"] @ page["F"])
    factors = page.term(formula_of_factored(form))
    few = form.value.size + design.answer["F"].size <= readability.LOOP
    if few:
        inserted = page.value(1) + plant_form @ page.value(design.answer["F"])
        below = factored_form(page, inserted.scalar.denominator)
        together = page.value(inserted.scalar.numerator) / below
        page.equal(relation(page.value(1) + page["P"] @ page["F"], inserted, together), say="return_difference")
    is_short = page.plant.order <= readability.LOOP_ORDER and is_narrow(Matrix.of([[denominator]]))
    members = [definition, expanded, factors] if is_short else [definition, factors]
    page.define("G_cl", *members, say="" if few else "return_path", answer=True, closing=False)
    draw_loop(page, plant_form, page.value(design.answer["F"]))
    _say_poles(page, design, form.value)
    unity = page.term(formula_of_factored(design.unity_loop))
    around = page["P"] @ page["F"] / (page.value(1) + page["P"] @ page["F"])
    page.define("G_r", around, unity, say="unity_feedback", closing=False)
    draw_unity_loop(page, plant_form, page.value(design.answer["F"]))


def _say_poles(page: Builder, design: OutputFeedback, loop: Scalar) -> None:
    """Say whose poles those of G_cl are, and which of them cancel in it."""
    variable, whole = design.plant.variable, design.loop_polynomial
    poles, denominator = _poles(design, whole.value), monic(loop.denominator, variable)
    lost, product = whole.value / denominator, page["phi_c"] @ page["phi_o"]
    short = all(_has_short_roots(factor, variable) for factor, _ in whole.factors)
    if lost.is_one and short:
        page.conclude_silently(Roots(product.formula, poles), Roots(page["G_cl"].formula, poles))
    elif lost.is_one:
        page.conclude(f"loop_polynomial{of_given(design)}", relation(product / page.value(denominator), 1))
    elif short:
        cancelled = roots_of(lost, variable)
        left = tuple((Counter(poles) - Counter(cancelled)).elements())
        rest = Roots((product / page.value(denominator)).formula, cancelled)
        _say_left(page, left, rest)
    else:
        page.conclude(
            f"loop_polynomial_divides{of_given(design)}", predicate("polynomial", product / page.value(denominator))
        )


def caution_unstable_loop(page: Builder, design: OutputFeedback, determinant: Term) -> None:
    """Warn where gains that were given surely leave the loop unstable."""
    if design.has_given_gain and design.fields["stable"] == "no":
        time = "discrete" if page.plant.is_discrete else "continuous"
        page.caution(f"loop_unstable_{time}", predicate("unstable", determinant))


def of_given(design: OutputFeedback) -> str:
    """Return the suffix of sentences about polynomials that are found, not desired."""
    return "_given" if design.has_given_gain else ""


def _say_left(page: Builder, left: tuple[Root, ...], lost: Roots) -> None:
    """Say which poles are left where others cancel."""
    if not left:
        page.conclude("loop_no_poles", predicate("polynomial", page["G_cl"]), lost=lost)
        return
    poles = Roots(page["G_cl"].formula, left)
    page.conclude("loop_poles_left" if len(left) > 1 else "loop_pole_left", poles=poles, lost=lost)


def _has_short_roots(factor: Scalar, variable: str) -> bool:
    """Return whether the roots of a factor fit into a sentence: those of a quadratic with parameters do not."""
    return factor.degree(variable) == 1 or (factor.degree(variable) == 2 and factor.names <= {variable})


def return_path_of_several(page: Builder, design: OutputFeedback) -> None:
    """Write (I + PF)⁻¹ P for several inputs or outputs."""
    plant = design.plant
    response = page["C"] @ (page.s @ page.identity(plant.order) - page["A"]).inverse @ page["B"]
    if plant.matrices.has_feedthrough:
        response = response + page["D"]
    P = Matrix.of([[design.plant_function]]) if isinstance(design.plant_function, Scalar) else design.plant_function
    define_or_hold(page, "P", response, P, "plant_transfer")
    formula = (page.identity(plant.outputs) + page["P"] @ page["F"]).inverse @ page["P"]
    entries = [[page.term(formula_of_factored(entry)) for entry in row] for row in design.loop_of_several]
    loop = Matrix.of([[entry.value for entry in row] for row in design.loop_of_several])
    shown = [block(entries)] if loop.size <= readability.MATRIX else []
    page.define("G_cl", formula, *shown, say="return_path", answer=True, closing=False, value=loop)
    page.conclude_silently(relation(page["G_cl"], loop))
    page.conclude("loop_matrix_poles")
    draw_loop(page, page["P"], page["F"])


def _plant(page: Builder, design: OutputFeedback) -> Term:
    """Show the plant's transfer function, unless the problem gave it."""
    plant = design.plant
    numerator, characteristic = design.plant_transfer
    form = factored_form(page, numerator / characteristic)
    if not page.defines("P"):
        page.define("P", form, say="plant_transfer", closing=False)
        response = page["C"] @ (page.s @ page.identity(plant.order) - page["A"]).inverse @ page["B"]
        if plant.matrices.has_feedthrough:
            response = response + page["D"]
        page.conclude_silently(relation(page["P"], response))
    if not plant.is_discrete and no_stable_compensator(page["P"].value, plant.variable, plant.symbols.signs):
        page.conclude("no_stable_compensator", predicate("no_stable_compensator", page["P"]))
    return form


def _named_transfer_function(page: Builder, design: CompensatorDesign) -> None:
    """Write F(s) with letters for its coefficients, which are written out below it."""
    K, L, variable = page["K"], page["L"], design.plant.variable
    resolvent = (page.s @ page.identity(design.plant.order) - page["A_c"]).inverse
    numerator, denominator = transfer(page["A_c"].value, L.value, K.value, Scalar.of(0), variable)
    names = Namer(page)
    above = names.polynomial("n", numerator.coefficients(variable), variable)
    below = names.polynomial("d", denominator.coefficients(variable)[1:], variable, monic=True)
    page.define("F", K @ resolvent @ L, above / below, say="transfer_function_of_compensator", answer=True)
    names.show()
    page.conclude_silently(relation(page["F"], design.answer["F"]))
    page.conclude("compensator_proper", predicate("strictly_proper", page["F"]))


class Namer:
    """Letters for the coefficients of polynomials, and the list of what they stand for."""

    def __init__(self, page: Builder) -> None:
        self.page = page
        self.meanings: list[tuple[Scalar, Scalar]] = []

    def polynomial(self, stem: str, coefficients: Sequence[Scalar], variable: str, *, monic: bool = False) -> Scalar:
        """Return the polynomial with a letter for each coefficient that is not a number."""
        order = len(coefficients) - 1
        named = [Scalar.of(1)] if monic else []
        for index, meaning in enumerate(coefficients):
            if meaning.is_constant:
                named.append(meaning)
                continue
            (name,) = fresh_names(f"{stem}_", 1, taken_names(self.page), start=order - index)
            symbol = self.page.name_coefficient(name, meaning)
            self.meanings.append((symbol, meaning))
            named.append(symbol)
        return from_coefficients(named, variable)

    def show(self) -> None:
        """Write out the values of the letters."""
        self.page.equal(*(relation(symbol, meaning) for symbol, meaning in self.meanings), say="with_coefficients")


def named_return_path(page: Builder, design: OutputFeedback, own: Term) -> None:
    """Write P/(1 + PF) over the product of the two polynomials, `own` being the denominator of F."""
    _plant(page, design)
    numerator, _ = design.plant_transfer
    definition = page["P"] / (page.value(1) + page["P"] @ page["F"])
    above, below = (page.value(part) for part in (numerator.numerator, numerator.denominator))
    product = above @ own / (below @ page["phi_c"] @ page["phi_o"])
    page.define("G_cl", definition, product, say="return_path", answer=True, closing=False)
    page.conclude(f"loop_polynomial{of_given(design)}")
    draw_loop(page, page["P"], page["F"])


def _poles(design: OutputFeedback, polynomial: Scalar) -> tuple[Root, ...]:
    """Return the desired poles in their given order, or the roots of the polynomial."""
    poles: list[Root] = []
    for part in (design.feedback, design.estimator):
        desired = part.desired
        if desired is None or not desired.poles:
            return roots_of(polynomial, design.plant.variable)
        poles += [root_of_pole(pole, design.plant.variable) for pole in desired.poles]
    return tuple(poles)


# Remark on a compensator that is unstable in open loop.


def caution_law(page: Builder, loop: OutputFeedback) -> None:
    """Warn where the law is surely unstable by itself, which a loop with stable poles does not show."""
    plant, own = page.plant, loop.own_matrix
    chi = own.characteristic_polynomial(plant.variable)
    minimal = page.defines("F_z")
    if chi.names - {plant.variable} or (minimal and plant.matrices.has_feedthrough):
        return
    if stability(chi, plant.variable, {}, discrete=plant.is_discrete).verdict != "no":
        return
    if minimal:
        matrix = page["F_z"] - page["G_z"] @ page["K_2"]
    else:
        A, B, C, K, L = (page[name] for name in "ABCKL")
        matrix = A - B @ K - L @ C
        matrix = matrix + L @ page["D"] @ K if plant.matrices.has_feedthrough else matrix
    page.set("A_c", own)
    determinant = (page.s @ page.identity(own.shape[0]) - page["A_c"]).apply("det")
    time = "discrete" if plant.is_discrete else "continuous"
    unstable = predicate("unstable", determinant)
    page.caution(f"law_unstable_{time}", unstable, matrix=relation(page["A_c"], matrix, page["A_c"].as_value))
