"""The page of the compensator: gains, F(s) through its four stages, and the closed loop."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Root, Scalar, from_coefficients, rank, root_of_pole, roots_of, transfer
from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Evaluated, HoldsExactlyWhere, Literal, Quotient, Roots
from symobs.formula.tree.term import Term, block
from symobs.formula.tree.written import stacked
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.wording_of_polynomials import modes_of_double
from symobs.stability.criteria.stability import monic, no_stable_compensator, stability
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.page_parts import factored_form, formula_of_factored, given, in_blocks, is_narrow
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.design import readability
from symobs.tasks.design.block_diagrams import draw_compensator, draw_loop, draw_unity_loop
from symobs.tasks.design.compensator.compensator import CompensatorDesign
from symobs.tasks.design.compensator.output_feedback import caution_hidden
from symobs.tasks.design.error_plots import plot_estimate
from symobs.tasks.design.full_order.observer import model_and_innovation, write_observer
from symobs.tasks.design.full_order.state_feedback import StateFeedbackDesign
from symobs.tasks.design.gain.gain_design import FEEDBACK, OBSERVER, PlacementProblem, page_style
from symobs.tasks.design.gain.gain_page import name_coefficients, say_as_required, write_case, write_cases, write_gain
from symobs.tasks.design.pole_cautions import caution_poles
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
            single = page("phi_c / {factor}", factor=desired.polynomial / factor)
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
    product = formula_of_factored(Factored(Scalar.of(1), tuple((factor, 1) for factor in factors)))
    return page.line("det(s I - A + B {gain}) = {product}", gain=gain, product=page.term(product))


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
    A, order, value = _matrix(side), page.plant.order, design.answer[side.gain]
    if side is OBSERVER:
        page.define("O", stacked("C", "A", order), silent=True)
        test, gain, found, blocks = "Oᵀ", "Lᵀ", value.T, page[stacked("Cᵀ", "Aᵀ", order, across=True)]
        page.conclude_silently(page.line("Oᵀ = {blocks}", blocks=blocks))
    else:
        test, gain, found, blocks = "Ctr", "K", value, page[stacked("B", "A", order, across=True)]
        page.define("Ctr", blocks, silent=True)
    shown = "{blocks} = #" if order <= readability.COLUMN_ORDER else "#"
    page.equal(page.line(f"{test} = {shown}{test}", blocks=blocks), say=f"test_{side.kind}")
    if square_test(page, side.matrix, design.test, side.test):
        page.conclude(f"any_{side.kind}")
    desired = name_coefficients(page, design, side)
    page.set(side.gain, value)
    last = page.value(Matrix.unit(order, order - 1).T)
    chain = page.line(f"{gain} = {{last}} {test}^-1 {side.phi}_at({A}) = {{found}}", last=last, found=found)
    page.equal(chain, say=f"gain_{side.kind}", answer=side is FEEDBACK)
    say_as_required(page, desired, _determinant(page, side), page.value(desired.polynomial))


def _matrix(side: PlacementProblem) -> str:
    """Return Aᵀ on the left, A on the right."""
    return "Aᵀ" if side is OBSERVER else "A"


def _determinant(page: Builder, side: PlacementProblem) -> Term:
    """Return det(sI − Aᵀ + CᵀLᵀ) on the left, det(sI − A + BK) on the right."""
    return side.error_determinant(page) if side is FEEDBACK else page["det(s I - Aᵀ + Cᵀ Lᵀ)"]


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
            named_return_path(page, design, page["det(pencil(A_c))"])
        else:
            return_path(page, design)


def _state_space(page: Builder, design: CompensatorDesign) -> None:
    """Write u = −K x̂ put into the observer: (4.23), (4.24)."""
    m = design.plant.matrices
    model, innovation = model_and_innovation(page)
    page.signal("u", "(-K) x_hat", say="separation")
    rate = page.line("x_hat' = {model} + L {innovation}", model=model, innovation=innovation)
    both: dict[str, Any] = {"law": page.line("u = (-K) x_hat"), "rate": rate}
    closed, shown = "A - B K - L C", "#A - #(B K) - #(L C)"
    if m.has_feedthrough:
        closed, shown = f"{closed} + L D K", f"{shown} + #(L D K)"
    elif page.plant.order == readability.PRODUCTS_ORDER:
        shown = "#A - #B #K - #L #C"
    numbers = [shown] if page.plant.order <= readability.WRITTEN_OUT_ORDER else []
    own = page.line(f"x_hat' = ({closed}) x_hat + L y")
    if page[closed].value.size > readability.MATRIX:
        page.equal(own, say="observer_closed", **both)
        page.define("A_c", closed, *numbers, say="compensator_matrix")
    else:
        page.define("A_c", closed, *numbers, say="observer_closed_matrix", **both)
        page.conclude_silently(own)
        # A_c, L and K stand above; of small ones the whole is seen at a glance
        is_small = page.plant.order <= readability.WRITTEN_OUT_ORDER
        state, law = (" = #A_c x_hat + #L y", "u = (-#K) x_hat") if is_small else ("", "u = (-K) x_hat")
        page.equal(f"x_hat' = A_c x_hat + L y{state}", law, say="compensator_written")
    draw_compensator(page)


def _transfer_function(page: Builder, design: CompensatorDesign) -> None:
    """Write (4.25) in four stages: inverse, adjugate over determinant, adjugate times L, scalar; those that can be read."""
    F, L, K = design.answer["F"], page["L"].value, page["K"].value
    pencil = page["pencil(A_c)"].value
    adjugate = pencil.adjugate()
    driven = (adjugate @ L).normal()
    one_over = page.term(Quotient(Literal(Scalar.of(1)), Literal(design.own_transfer[1])))
    stages = ((pencil, "#K {M}^-1 #L"), (adjugate, "{one_over} #K {M} #L"), (driven, "{one_over} #K {M}"))
    written = [page(text, M=matrix, one_over=one_over) for matrix, text in stages if is_narrow(matrix, K)]
    say = "transfer_function_of_compensator"
    page.define("F", "K pencil(A_c)^-1 L", *written, page.value(F), say=say, answer=True)
    say_stability(page, design, "compensator", predicate("strictly_proper", page["F"]))


def _transfer_matrix(page: Builder, design: CompensatorDesign) -> None:
    """Write (4.25) for several inputs or outputs: the resolvent, then the entries."""
    define_or_hold(page, "F", page["K pencil(A_c)^-1 L"], design.answer["F"], "transfer_function_of_compensator")
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
            loop, signs = page["phi_c phi_o"], plant.symbols.signs
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
    own = page["det(pencil(A_c))"]
    coefficients = own.scalar.coefficients(plant.variable)
    if own.scalar != monic(F.denominator, plant.variable) or not all(c.is_constant for c in coefficients):
        return {}
    positive = all(c.fraction() > 0 for c in coefficients)
    return {"polynomial": Evaluated(own.formula, Literal(own.scalar))} if positive == (word == "stable") else {}


def _error_coordinates(page: Builder, design: CompensatorDesign, *, large: bool) -> None:
    """Write (4.26)-(4.29): u = −Kx + Ke, ẋ = (A − BK) x + BKe, block triangular."""
    order = design.plant.order
    control, rate = page.line("u = (-K) x + K e"), page.line("x' = (A - B K) x + B K e")
    halves, zero, one = [order, order], Matrix.zeros(order, order), page.identity(order)
    matrix = page("[A - B K, B K; {zero}, A - L C]", zero=zero)
    turn = page("[{one}, {zero}; {one}, -{one}]", zero=zero, one=one)
    numbers = [in_blocks(page, matrix.value, halves, halves)] if not large and is_narrow(matrix.value) else []
    page.define("A_cl", matrix, *numbers, say="closed_loop_matrix", closing=False, control=control, rate=rate)
    page.equal("[x; e]' = A_cl [x; e]")
    determinant = page["det(pencil(A_cl))"]
    parts = FEEDBACK.error_determinant(page) @ OBSERVER.error_determinant(page)
    product = page.term(formula_of_factored(design.loop_polynomial))
    page.equal(relation(determinant, parts, product), say=f"polynomial_splits{of_given(design)}")
    caution_unstable_loop(page, design, determinant)
    second = page["[A, -(B K); L C, A - B K - L C]"]
    numbers = []
    if not large and order <= readability.WRITTEN_OUT_ORDER and is_narrow(second.value):
        numbers = [in_blocks(page, second.value, halves, halves) @ page["[x; x_hat]"]]
    page.conclude_silently(page.line("{turn} = I", turn=turn @ turn), page.line("{T} {M} {T} = A_cl", T=turn, M=second))
    states = page("{M} [x; x_hat]", M=second)
    turned = page.line("[x; e] = {T} [x; x_hat]", T=turn)
    page.equal(relation(page["[x; x_hat]'"], states, *numbers), say="estimate_coordinates", turned=turned)
    plot_estimate(page, "e", page["A_cl"], Matrix.identity(order))


def return_path(page: Builder, design: OutputFeedback) -> None:
    """Write P/(1 + PF), multiplied out and factored."""
    plant_form = _plant(page, design)
    form = design.single_loop
    denominator = Factored(Scalar.of(1), tuple((f, -power) for f, power in form.factors if power < 0)).value
    expanded = page.term(Quotient(Literal(form.value * denominator), Literal(denominator)))
    definition = page["P / (1 + P F)"]
    factors = page.term(formula_of_factored(form))
    few = form.value.size + design.answer["F"].size <= readability.LOOP
    if few:
        inserted = page("1 + {plant_form} {F}", plant_form=plant_form, F=design.answer["F"])
        below = factored_form(page, inserted.scalar.denominator)
        together = page.value(inserted.scalar.numerator) / below
        page.equal(relation(page["1 + P F"], inserted, together), say="return_difference")
    is_short = page.plant.order <= readability.LOOP_ORDER and is_narrow(Matrix.of([[denominator]]))
    members = [definition, expanded, factors] if is_short else [definition, factors]
    page.define("G_cl", *members, say="" if few else "return_path", answer=True, closing=False)
    draw_loop(page, plant_form, page.value(design.answer["F"]))
    _say_poles(page, design, form.value)
    unity = page.term(formula_of_factored(design.unity_loop))
    page.define("G_r", "(P F) / (1 + P F)", unity, say="unity_feedback", closing=False)
    draw_unity_loop(page, plant_form, page.value(design.answer["F"]))


def _say_poles(page: Builder, design: OutputFeedback, loop: Scalar) -> None:
    """Say whose poles those of G_cl are, and which of them cancel in it."""
    variable, whole = design.plant.variable, design.loop_polynomial
    poles, denominator = _poles(design, whole.value), monic(loop.denominator, variable)
    lost, product = whole.value / denominator, page["phi_c phi_o"]
    short = all(_has_short_roots(factor, variable) for factor, _ in whole.factors)
    if lost.is_one and short:
        page.conclude_silently(Roots(product.formula, poles), Roots(page["G_cl"].formula, poles))
    elif lost.is_one:
        page.conclude(
            f"loop_polynomial{of_given(design)}", page.line("phi_c phi_o / {denominator} = 1", denominator=denominator)
        )
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
    response = page["C pencil(A)^-1 B" + (" + D" if plant.matrices.has_feedthrough else "")]
    P = Matrix.of([[design.plant_function]]) if isinstance(design.plant_function, Scalar) else design.plant_function
    define_or_hold(page, "P", response, P, "plant_transfer")
    formula = page("({one} + P F)^-1 P", one=page.identity(plant.outputs))
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
        D = " + D" if plant.matrices.has_feedthrough else ""
        page.conclude_silently(page.line(f"P = C pencil(A)^-1 B{D}"))
    if not plant.is_discrete and no_stable_compensator(page["P"].value, plant.variable, plant.symbols.signs):
        page.conclude("no_stable_compensator", predicate("no_stable_compensator", page["P"]))
    return form


def _named_transfer_function(page: Builder, design: CompensatorDesign) -> None:
    """Write F(s) with letters for its coefficients, which are written out below it."""
    variable = design.plant.variable
    A_c, L, K = (page[name].value for name in ("A_c", "L", "K"))
    numerator, denominator = transfer(A_c, L, K, Scalar.of(0), variable)
    names = Namer(page)
    above = names.polynomial("n", numerator.coefficients(variable), variable)
    below = names.polynomial("d", denominator.coefficients(variable)[1:], variable, monic=True)
    say = "transfer_function_of_compensator"
    page.define("F", "K pencil(A_c)^-1 L", above / below, say=say, answer=True)
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
    above, below = numerator.numerator, numerator.denominator
    product = page("({above} {own}) / ({below} phi_c phi_o)", above=above, own=own, below=below)
    page.define("G_cl", "P / (1 + P F)", product, say="return_path", answer=True, closing=False)
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
    own_law = "F_z - G_z K_2" if minimal else "A - B K - L C"
    own_law += " + L D K" if plant.matrices.has_feedthrough else ""
    page.set("A_c", own)
    determinant = page["det(pencil(A_c))"]
    time = "discrete" if plant.is_discrete else "continuous"
    unstable = predicate("unstable", determinant)
    page.caution(f"law_unstable_{time}", unstable, matrix=page.line(f"A_c = {own_law} = #A_c"))
