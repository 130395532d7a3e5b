"""The pages of gain design: canonical form and Ackermann's formula, on either side of duality."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import prod
from typing import TYPE_CHECKING

from symobs.exact import (
    Factored,
    Matrix,
    Scalar,
    companion,
    factored,
    from_coefficients,
    hankel_of,
    root_of_pole,
    roots_of,
)
from symobs.exact.core.generators import all_roots
from symobs.formula.tree import Evaluated, Literal, Roots
from symobs.formula.tree.term import Term, block, product
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.facts import PREDICATES
from symobs.proof.derivation.wording_check import Said, rests
from symobs.stability.criteria.stability import stability
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.page_parts import (
    determinant_form,
    environment_on,
    factored_form,
    formula_of_factored,
    hidden_polynomial,
    say_stability,
    set_anew,
    stratum_of,
    undecided,
)
from symobs.tasks.analysis.rank.rank_page import outside_cases, square_test
from symobs.tasks.design import readability
from symobs.tasks.design.gain.gain_design import OBSERVER, GainDesign, PlacementProblem
from symobs.tasks.design.gain.gain_family_page import (
    another_gain,
    of_the_others,
    pattern_case,
    write_hidden_family,
    write_no_gain,
    write_sylvester,
)
from symobs.tasks.design.gain.gain_kind import GivenGain, UnassignableGain
from symobs.tasks.design.named_gains import define_gain, gain_letters
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.pole_placement.row_reduction import Reduction, gain_of, row_reduction
from symobs.tasks.design.pole_placement.single_output import matching
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names
from symobs.tasks.design.unassignable import over_fixed, say_unassignable
from symobs.tasks.result import choose

if TYPE_CHECKING:
    from symobs.exact.core.generators import Function
    from symobs.formula.tree import Relation
    from symobs.tasks.result import Case


# The pages of ways to a gain: Ackermann's formula, matching coefficients, companion form, row-reduced echelon form.


#: A gain that rounding changes by more than this share of an entry is worth a warning.
_HARM = Fraction(1, 100)


def write_ackermann_formula(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write L = φ(A) 𝒪⁻¹ eₙ, and K = eₙᵀ 𝒞⁻¹ φ(A)."""
    order = page.plant.order
    unit = page.value(Matrix.unit(order, order - 1))
    if side.gain == "L":
        last = page.define("q_o", page["O^-1"] @ unit, say="last_column")
    else:
        last = page.define("q_c", unit.T @ page["Ctr^-1"], say="last_row")
    polynomial = page["A"].apply(f"{side.phi}_at")
    factors = [_factor_at(page, factor, power) for factor, power in desired.grouped()]
    at = product(factors)
    if side.gain == "L":
        define_gain(page, "L", polynomial @ last, at @ last, say="ackermann_observer")
    else:
        define_gain(page, "K", last @ polynomial, last @ at, say="ackermann_state_feedback")


def _factor_at(page: Builder, factor: Scalar, power: int) -> Term:
    """Return a factor of φ with A put in for the variable: (A + 10 I)²."""
    lead, *rest = factor.coefficients(page.plant.variable)
    A, degree, order = page["A"], len(rest), page.plant.order
    total = A**degree if lead.is_one else page.value(lead) @ A**degree
    for index, coefficient in enumerate(rest):
        if coefficient.is_zero:
            continue
        exponent = degree - 1 - index
        body = A**exponent if exponent else page.identity(order)
        negative = coefficient.is_constant and coefficient.fraction() < 0
        size = -coefficient if negative else coefficient
        term = body if size.is_one else page.value(size) @ body
        total = total - term if negative else total + term
    return total**power


def write_matching(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write det(sI − A + LC) with unknown l₁ … lₙ, its coefficients equated to those of φ, the linear system, its solution."""
    variable = page.plant.variable
    system = matching(design.dual_pair(page.plant), desired)
    unknown = gain_letters(page, side.gain, system.solution)
    gain = page.define(side.gain, design.transpose_for_task(unknown), say="unknown_gain")
    moved = gain @ page["C"] if side.gain == "L" else page["B"] @ gain
    determinant = page("det(s I - A + {moved})", moved=moved)
    polynomial = determinant.scalar
    page.equal(relation(determinant, page.value(polynomial)), say="polynomial_of_unknown")
    pairs = zip(polynomial.coefficients(variable)[1:], desired.coefficients, strict=True)
    page.equal(*(relation(found, target) for found, target in pairs), say="equal_coefficients")
    page.equal(relation(page("{M} {unknown}", M=system.M, unknown=unknown), system.r), say="linear_system")
    define_gain(page, side.gain, design.transpose_for_task(system.solution), say="solution_of_system")


def write_companion(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write T = [q; qAᵀ; …], which carries the dual pair to companion form, where the gain is the row of differences."""
    order, variable = page.plant.order, page.plant.variable
    found = page.plant.matrices.A.characteristic_polynomial(variable).coefficients(variable)[1:]
    unit = page.value(Matrix.unit(order, order - 1))
    if side.gain == "L":
        A, driven = page["A.T"], page["C.T"]
        q = page.define("q_o", page["O^-1"] @ unit, say="companion_vector_observer").T
    else:
        A, driven = page["A"], page["B"]
        q = page.define("q_c", unit.T @ page["Ctr^-1"], say="companion_vector_state_feedback")
    T = page.define("T", block([[q @ A**k if k else q] for k in range(order)]), say="companion_rows")
    page.equal(relation(T @ A @ T.inverse, companion(found)), relation(T @ driven, unit), say="companion_reached")
    wanted = [page.value(c) for c in reversed(desired.coefficients)]
    row = block([[w - page.value(a) for w, a in zip(wanted, reversed(found), strict=True)]])
    if side.gain == "L":
        define_gain(page, "L", row @ T, row.as_value @ T.as_value, say="row_observer", transposed=True)
    else:
        define_gain(page, "K", row @ T, row.as_value @ T.as_value, say="row_state_feedback")


def readable(design: GainDesign) -> bool:
    """Return whether the row-reduced forms belong to the gain of the answer and are short enough to be written out."""
    found = _reductions(design)
    if (
        found is None
        or len(found) > readability.NULL_VECTORS
        or any(part.reduced.size > readability.REDUCED_FORM for part in found)
    ):
        return False
    return bool(design.transpose_for_task(gain_of(found)) == design.answer[design.letter])


def _reductions(design: GainDesign) -> tuple[Reduction, ...] | None:
    assert design.desired is not None  # noqa: S101 - a page of a given gain does not come here
    return row_reduction(design.dual_pair(design.plant), design.desired)


def write_row_reduction(page: Builder, design: GainDesign, side: PlacementProblem, _: DesiredPolynomial) -> None:
    """Write for each pole the matrix [λI − Aᵀ : Cᵀ], its reduced form, the scalar relations, what is chosen, the vector."""
    found = _reductions(design)
    assert found is not None  # noqa: S101 - `readable` has said so
    _open_eigenvalues(page, side)
    page.remark(f"null_vectors_{side.kind}")
    for number, part in enumerate(found, 1):
        _reduce(page, side, part, number)
    psi = page.define("Psi", Matrix.block([[part.psi for part in found]]), say="upper_parts")
    page.define("f_psi", Matrix.block([[part.f for part in found]]))
    page.equal(
        page.line("det(Psi) = {value}", value=determinant_form(page, psi.value.determinant())), say="with_determinant"
    )
    gain, shown = page["f_psi Psi^-1"], page["#f_psi (#Psi)^-1"]
    unique = "_unique" if (page.plant.outputs if side.gain == "L" else page.plant.inputs) == 1 else ""
    if side.gain == "L":
        define_gain(page, "L", gain, shown, say=f"row_reduced{unique}_observer", transposed=True)
    else:
        define_gain(page, "K", gain, shown, say=f"row_reduced{unique}_state_feedback")
    _rounded_too_early(page, gain.value)


def _open_eigenvalues(page: Builder, side: PlacementProblem) -> None:
    """Say where the eigenvalues are without the gain, where they can be written down."""
    own = page["det(s I - A)"]
    factors = own.scalar.factors()[1]
    if own.scalar.names <= {page.plant.variable} and all(f.degree(page.plant.variable) <= 2 for f, _ in factors):
        page.remark(
            f"open_eigenvalues_{side.kind}", roots=Roots(own.formula, roots_of(own.scalar, page.plant.variable))
        )


def _rounded_too_early(page: Builder, gain: Matrix) -> None:
    """Show what becomes of the gain when the columns of Ψ are rounded before it is inverted, where that does harm."""
    near = page.decimals(page["Psi"].value)
    if not near or near[1].value.determinant().is_zero:
        return
    spoiled = page["#f_psi"] @ near[1].inverse
    shown = page.decimals(spoiled.value)
    pairs = zip(spoiled.value.entries, gain.entries, strict=True)
    if shown and any(abs((wrong - right).fraction()) > _HARM * abs(right.fraction()) for wrong, right in pairs):
        page.equal(relation(spoiled, *shown), say="rounded_too_early")


def _reduce(page: Builder, side: PlacementProblem, part: Reduction, number: int) -> None:
    """Write one reduction."""
    if part.before is not None:
        page.equal(relation(part.matrix, "~", part.reduced), say="generalised", pole=_named(page, part))
    else:
        words = ("pole" if number == 1 else "next_pole") if part.size == 1 else "pair" if _pair(part) else "factor"
        chain = relation(_matrix(page, side, part), part.matrix, "~", part.reduced)
        page.equal(chain, say=f"{words}_reduced", pole=_named(page, part))
    if part.size == 1 and number == 1:
        _relations(page, part, number)
    near = page.decimals(part.vector)
    xi = page.define(f"xi_{number}", part.vector, *near, say="" if part.size == 1 else "vectors_chosen")
    zero = Matrix.zeros(part.order * part.size, 1)
    matrix = part.matrix.select(range(part.matrix.shape[0]), range(part.vector.shape[0]))
    right = zero if part.before is None else Matrix.column([-entry for entry in part.before.T.entries])
    page.conclude_silently(relation(page.value(matrix) @ xi, right))


def _matrix(page: Builder, side: PlacementProblem, part: Reduction) -> Term:
    """Return [λI − Aᵀ : Cᵀ] (or [λI − A : B]) in letters; of a block J its blocks."""
    order, J = part.order, part.J
    A, driven = (page["A.T"], page["C.T"]) if side.gain == "L" else (page["A"], page["B"])
    nothing, empty = page.value(Matrix.zeros(order, order)), page.value(Matrix.zeros(*driven.value.shape))
    rows = []
    for j in range(part.size):
        row = []
        for k in range(part.size):
            multiple = _multiple(page, J[k, j], order)
            if k == j:
                row.append(-A if multiple is None else multiple - A)
            else:
                row.append(nothing if multiple is None else multiple)
        rows.append([*row, *(driven if k == j else empty for k in range(part.size))])
    return block(rows)


def _multiple(page: Builder, factor: Scalar, order: int) -> Term | None:
    """Return a multiple of I, None for 0."""
    identity = page.identity(order)
    if factor.is_zero:
        return None
    if (factor * factor).is_one:
        return identity if factor.is_one else -identity
    return page.value(factor) @ identity


def _relations(page: Builder, part: Reduction, number: int) -> None:
    """Read the components off the reduced form, and choose what is free: for the first pole, which stands for all."""
    width = part.vector.shape[0]
    short = width < 10
    names = [f"xi_{number}{i}" if short else f"xi_{number}_{i}" for i in range(1, width + 1)]
    if taken_names(page).intersection(names):
        return
    xi = [page.name_coefficient(name, entry) for name, entry in zip(names, part.vector.entries, strict=True)]
    free = [j for j in range(width) if j not in part.pivots]
    lines: list[Relation] = []
    for row, pivot in enumerate(part.pivots):
        right = part.reduced[row, width] if part.before is not None else Scalar.of(0)
        lines.append(relation(xi[pivot], sum((xi[j] * -part.reduced[row, j] for j in free), start=right)))
    chosen = [relation(xi[j], part.vector[j, 0]) for j in free]
    page.equal(*lines, say="relations_read_off")
    page.equal(*chosen, say="free_chosen")


def _pair(part: Reduction) -> bool:
    """Return whether J stands for a conjugate pair."""
    return part.size == 2 and part.J[0, 0] == part.J[1, 1]


def _named(page: Builder, part: Reduction) -> Evaluated:
    """Return the pole, or the factor of φ, of a reduction."""
    if part.size == 1:
        return Evaluated(page("det({J})", J=part.J).formula, Literal(part.J[0, 0]))
    pencil = page("s I - {J}", J=part.J)
    return Evaluated(pencil.apply("det").formula, Literal(part.J.characteristic_polynomial(page.plant.variable)))


#: The degree of the factor of a conjugate pair.
_PAIR = 2


def write_gain(
    page: Builder,
    design: GainDesign,
    side: PlacementProblem,
    style: str,
    *,
    of_loop: bool = False,
    cases: bool = True,
) -> None:
    """Write how the gain is found, in the style of a method, the check the reader is shown, and the special cases.

    Where it is given as a half of a loop, its polynomial has the letter that the page of the loop goes on with.
    """
    if isinstance(design.kind, GivenGain):
        _given_gain(page, design, side, of_loop=of_loop)
        return
    _test(page, design, side, style)
    if not design.kind.exists:
        _impossible(page, design, side)
        if isinstance(design.kind, UnassignableGain):
            for case in design.case_tree:
                write_case(page, case, side)
        return
    if not design.fixed_polynomial.is_one:
        _with_fixed_modes(page, design, side)
    else:
        write = choose(design.task, style, style).page or _write_gain_alone
        asks = "polynomials" if write is write_canonical and not (side.gain == "K" and _is_canonical(page)) else "asks"
        write(page, design, side, name_coefficients(page, design, side, asks))
    page.conclude_silently(page.line(f"{side.gain} = {{gain}}", gain=design.answer[side.gain]))
    page.in_decimals(side.gain)
    _verified(page, design, side)
    if cases:
        write_cases(page, design, side)


def write_cases(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """Write the special cases of a gain that exists in general."""
    if design.answer[side.gain] is not None and design.desired is not None:
        for case in design.case_tree:
            write_case(page, case, side)


def _write_gain_alone(page: Builder, design: GainDesign, side: PlacementProblem, _: DesiredPolynomial) -> None:
    """State the gain of a method without a page; the check below proves it."""
    define_gain(page, side.gain, design.answer[side.gain], say="gain_stated")


def write_reduction(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the row-reduced echelon method where its matrices can be read, else Ackermann's formula."""
    (write_row_reduction if readable(design) else write_ackermann)(page, design, side, desired)


def write_ackermann(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write Ackermann's formula; where there is a family of gains, how the one chosen lies in it."""
    is_of_family = design.chart is not None or _roots_found(design, side)
    (write_member if is_of_family else write_ackermann_formula)(page, design, side, desired)


def write_member(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write how a gain lies in the family of all: as a solution of the Sylvester equation, unless it is a special one."""
    if _roots_found(design, side):
        page.with_roots(design.answer[side.gain])
        define_gain(page, side.gain, design.answer[side.gain], say="gain_with_roots")
    else:
        write_sylvester(page, design, side, desired)


def _roots_found(design: GainDesign, side: PlacementProblem) -> frozenset[Function]:
    """Return the square roots of a gain that are in no datum: those of a solution of quadratic equations."""
    m, desired = design.plant.matrices, () if design.desired is None else design.desired.factors
    return all_roots(design.answer[side.gain]) - all_roots(m.A, m.B, m.C, *desired)


def define_test_matrix(page: Builder, side: PlacementProblem) -> None:
    """Define 𝒪 or 𝒞 block by block."""
    A, order = page["A"], page.plant.order
    if side.gain == "L":
        blocks = [[page["C"] @ A**k if k else page["C"]] for k in range(order)]
    else:
        blocks = [[A**k @ page["B"] if k else page["B"] for k in range(order)]]
    page.define(side.matrix, block(blocks), say=f"{side.test}_matrix")


def _is_canonical(page: Builder) -> bool:
    """Return whether (A, B) is in controllable canonical form."""
    m, order = page.plant.matrices, page.plant.order
    chi = m.A.characteristic_polynomial(page.plant.variable)
    return Matrix.unit(order, order - 1) == m.B and companion(chi.coefficients(page.plant.variable)[1:]) == m.A


def _test(page: Builder, design: GainDesign, side: PlacementProblem, style: str) -> None:
    if side.gain == "K" and style == "canonical_form" and _is_canonical(page):
        _say_canonical(page)
        return
    if not page.defines(side.matrix):
        define_test_matrix(page, side)
        is_known = square_test(page, side.matrix, design.test, side.test)
    else:
        is_known = rests(f"assignable_{side.kind}", Said((), page.environment))
    if is_known and design.fixed_polynomial.is_one and design.answer[side.gain] is not None:
        page.conclude(f"assignable_{side.kind}")


def name_coefficients(
    page: Builder, design: GainDesign, side: PlacementProblem, asks: str = "asks"
) -> DesiredPolynomial:
    """Show φ; where its coefficients are long, give them letters and return φ in these letters."""
    desired = design.desired
    assert desired is not None  # noqa: S101 - only designs with a desired polynomial come here
    variable, coefficients = desired.variable, desired.coefficients
    grouped = page.term(formula_of_factored(Factored(Scalar.of(1), desired.grouped())))
    plain = page.value(desired.polynomial)
    members = [plain] if desired.is_expanded else [grouped, plain]
    if all(c.size - 1 <= readability.COEFFICIENT for c in coefficients):
        if not desired.poles and desired.is_expanded and page.defines(side.phi):
            return desired
        page.define(side.phi, *members, say=f"{asks}_{side.kind}")
        return desired
    taken = {*taken_names(page), *desired.polynomial.field.names}
    names = fresh_names(side.coefficient, len(coefficients), taken)
    symbols = [Scalar.symbol(name) for name in names]
    named = from_coefficients([Scalar.of(1), *symbols], variable)
    for name, meaning in zip(names, coefficients, strict=True):
        page.name_coefficient(name, meaning)
    page.define(side.phi, grouped, page.value(named), say=f"asks_{side.kind}")
    page.equal(*(relation(s, m) for s, m in zip(symbols, coefficients, strict=True)), say="coefficients")
    return DesiredPolynomial(variable, (named,))


def _say_canonical(page: Builder) -> None:
    """Say that (A, B) is in controllable canonical form already."""
    order, variable = page.plant.order, page.plant.variable
    chi = page.plant.matrices.A.characteristic_polynomial(variable)
    tested = block([[page["A"] ** k @ page["B"] if k else page["B"] for k in range(order)]])
    page.remark(
        "already_canonical",
        relation(tested.apply("rank"), order),
        relation(page["A"], companion(chi.coefficients(variable)[1:])),
        relation(page["B"], Matrix.unit(order, order - 1)),
        chi=page.line("det(s I - A) = {chi}", chi=chi),
    )


def write_canonical(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the difference of coefficients, constant first, carried back by V⁻¹."""
    plant, order = page.plant, page.plant.order
    variable = plant.variable
    wanted = [page.value(c) for c in reversed(desired.coefficients)]
    if side.gain == "K" and _is_canonical(page):
        found = plant.matrices.A.characteristic_polynomial(variable).coefficients(variable)[1:]
        define_gain(page, "K", _difference(page, wanted, list(found)))
        return
    A = page["A.T"] if side.gain == "L" else page["A"]
    matrix = page[f"{side.matrix}.T"] if side.gain == "L" else page[side.matrix]
    chi = plant.matrices.A.characteristic_polynomial(variable)
    found = chi.coefficients(variable)[1:]
    said = getattr(page.steps[-1], "sentence", None)
    is_announced = said is not None and said.key == f"polynomials_{side.kind}"  # beside φ
    say = "" if is_announced else f"open_{side.kind}"
    page.define("chi", page("det(s I - {A})", A=A), say=say)
    hankel = page.value(hankel_of(found))
    written = [matrix.as_value @ hankel] if order > 1 else []
    V = page.define(f"V_{side.index}", matrix @ hankel, *written, say=f"canonical_{side.kind}")
    page.equal(
        relation(V.inverse, V.inverse.as_value), relation(V.apply("det"), determinant_form(page, V.value.determinant()))
    )
    row = _difference(page, wanted, list(found))
    if side.gain == "L":
        define_gain(page, "L", row @ V.inverse, row.as_value @ V.inverse.as_value, say="row_observer", transposed=True)
    else:
        define_gain(page, "K", row @ V.inverse, row.as_value @ V.inverse.as_value, say="row_state_feedback")


def _difference(page: Builder, wanted: list[Term], found: list[Scalar]) -> Term:
    entries = [w - page.value(a) for w, a in zip(wanted, reversed(found), strict=True)]
    return block([entries])


def _with_fixed_modes(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """State that the fixed modes are among the desired poles, so that a gain exists and is not unique."""
    variable = page.plant.variable
    polynomial, desired, family = design.fixed_polynomial, design.desired, design.gain_family
    assert desired is not None and family is not None  # noqa: S101, PT018 - fixed modes come with a family
    page.define(side.phi, factored_form(page, desired.polynomial), desired.polynomial, say=f"asks_{side.kind}")
    fixed = _fixed(page, side, design.pair.kernel, design.pair.restricted)
    roots = Roots(fixed.formula, roots_of(polynomial, variable))
    divides = predicate("polynomial", page[side.phi] / fixed)
    page.remark(f"fixed_but_wanted_{side.kind}", divides, roots=roots)
    if design.chart is not None:
        write_hidden_family(page, design, side)
        return
    gain = define_gain(page, side.gain, design.answer[side.gain], say=f"{of_the_others(design)}_{side.kind}")
    free = page[side.hidden[0]] @ page.value(Matrix.column([Scalar.symbol(name) for name in family["parameters"]]))
    general = gain + (free if side is OBSERVER else free.T)
    page.remark(f"family_{side.kind}", gain=Evaluated(general.formula, Literal(family[side.gain])))


def _impossible(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """State that no gain exists: fixed modes that are not desired, or an impossible zero pattern."""
    if not isinstance(design.kind, UnassignableGain):
        write_no_gain(page, design, side)
        return
    fixed = _fixed(page, side, design.pair.kernel, design.pair.restricted)
    phi, variable, told = page[side.phi], page.plant.variable, dict[str, Roots]()
    never_divides, discrete = PREDICATES["not_polynomial"], page.plant.is_discrete
    factors = factored(design.fixed_polynomial, variable).factors
    lacking = [f**k for f, k in factors if never_divides(phi.scalar / f, page.environment, discrete)]
    missing = prod(lacking, start=Scalar.of(1))
    key = f"impossible_{side.kind}"
    if missing.degree(variable):
        rest = page.value(design.fixed_polynomial / missing)
        told = {"missing": Roots((fixed / rest).formula, roots_of(missing, variable))}
        key = f"impossible_roots_{side.kind}"
    say_unassignable(
        page,
        (key, f"unassignable_{side.kind}"),
        phi,
        design.answer["polynomial"],
        fixed,
        design.case_tree,
        fixed=Evaluated(fixed.formula, formula_of_factored(factored(design.fixed_polynomial, variable))),
        polynomial=Evaluated(phi.formula, Literal(phi.value)),
        **told,
    )
    found = stability(design.fixed_polynomial, variable, page.plant.symbols.signs, discrete=discrete)
    if found.verdict == "no":
        page.remark(f"never_converges_{side.kind}", predicate("unstable", fixed))


def _fixed(page: Builder, side: PlacementProblem, kernel: Matrix, restricted: Matrix) -> Term:
    """Introduce N and X, and return the polynomial of the modes that no gain moves."""
    for name, value in zip(side.hidden, (kernel, restricted), strict=True):
        page.set(name, value)
    return hidden_polynomial(page, side.hidden[1])


def _given_gain(page: Builder, design: GainDesign, side: PlacementProblem, *, of_loop: bool) -> None:
    """Find the polynomial of a given gain and decide its stability."""
    gain = page.set(side.gain, design.answer[side.gain])
    page.equal(relation(gain, design.answer[side.gain]), say=f"gain_given_{side.kind}")
    closed = side.closed_loop_matrix(page)
    page.equal(relation(closed, closed.as_value), say="closed_matrix")
    polynomial = design.answer["polynomial"]
    shown = factored_form(page, polynomial)
    members = [side.error_determinant(page), page.value(polynomial)]
    if len(polynomial.factors()[1]) > 1:
        members.append(shown)
    if of_loop:
        page.define(side.phi, *members, say="its_polynomial", answer=True)
    else:
        page.equal(relation(*members), say="its_polynomial", answer=True)
    roots = roots_of(polynomial, page.plant.variable)
    if polynomial.names <= {page.plant.variable} and all(root.is_closed for root in roots):
        page.conclude("roots_found", roots=Roots(members[0].formula, roots))
    say_stability(page, side.error_determinant(page))


def _verified(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    desired = design.desired
    assert desired is not None  # noqa: S101 - only designs with a desired polynomial come here
    polynomial = page[side.phi].value
    grouped = desired.grouped()
    members = [side.error_determinant(page), page.value(polynomial)]
    if not desired.is_expanded and polynomial == desired.polynomial:
        members.append(page.term(formula_of_factored(Factored(Scalar.of(1), grouped))))
    say_as_required(page, desired, *members)
    caution_poles(page, desired, side.phi, side.kind)
    if not desired.poles and not desired.is_numeric and polynomial == desired.polynomial:
        say_stability(page, side.error_determinant(page))


def say_as_required(page: Builder, desired: DesiredPolynomial, *members: Term) -> None:
    """Show the check of a gain; for a desired conjugate pair with the poles themselves.

    A gain with roots in it has the polynomial only as far as their own polynomials vanish: there the check says enough.
    """
    pairs = any(factor.degree(desired.variable) == _PAIR for factor in desired.factors)
    if not pairs or not desired.poles or not desired.is_numeric or members[0].value != members[1].value:
        page.verified("as_required", check=relation(*members))
        return
    roots = Roots(members[0].formula, tuple(root_of_pole(pole, desired.variable) for pole in desired.poles))
    page.verified("roots_as_required", check=relation(*members), roots=roots)


def write_case(page: Builder, case: Case, side: PlacementProblem, around: tuple[Case, ...] = ()) -> None:
    """State the findings on a stratum, and on those within it; `around` are the strata it lies in."""
    here = environment_on(page, stratum_of(case), case.substitution)
    if not isinstance(case.result, GainDesign) or here is None:
        page.steps.append(undecided(page, case))
        return
    result = case.result
    if result.answer[side.gain] is None and not isinstance(result.kind, UnassignableGain):
        page.steps.append(pattern_case(page, case, side))
        return
    if result.pair.is_observable and result.answer[side.gain] is not None:
        page.steps.append(another_gain(page, case, side, "case_another_gain"))
        return
    outer, environment, page.steps, page.environment = page.steps, page.environment, [], here
    try:
        _on_stratum(page, (*around, case), result, side)
        inside = page.environment
        for inner in result.case_tree:
            write_case(page, inner, side, (*around, case))
    finally:
        steps, page.steps, page.environment = page.steps, outer, environment
    anew = set_anew(here, inside)
    page.steps.append(CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(steps), anew=anew))


def _on_stratum(page: Builder, cases: tuple[Case, ...], result: GainDesign, side: PlacementProblem) -> None:
    """Write whether a gain exists on a stratum, with the hidden modes that decide it."""
    before, own, gain = page.environment, _is_finite_on(cases, page, side), result.answer[side.gain]
    fixed = _fixed(page, side, result.pair.kernel, result.pair.restricted)
    modes = Roots(fixed.formula, roots_of(result.fixed_polynomial, page.plant.variable))
    if gain is None:
        keys, polynomial = (f"case_no_{side.kind}", f"unassignable_{side.kind}"), result.answer["polynomial"]
        say_unassignable(page, keys, page[side.phi], polynomial, fixed, result.case_tree, modes=modes)
        return
    kept = "case_same" if (page.plant.outputs if side is OBSERVER else page.plant.inputs) > 1 else "case_survives"
    quotient, bound = over_fixed(page, page[side.phi], result.answer["polynomial"], fixed)
    key = f"{kept if own else 'case_other'}_{side.kind}"
    page.conclude(key, *bound, predicate("polynomial", quotient), modes=modes)
    if not own:
        page.define(side.gain, gain)
    page.conclude_silently(
        page.line(f"{{error_determinant}} = {side.phi}", error_determinant=side.error_determinant(page))
    )
    steps = outside_cases(page, result, page.steps) or [undecided(page, cases[-1])]
    if steps != page.steps:  # a gain that is defined there is none of the further cases
        anew = set_anew(before, page.environment)
        page.environment = before
        steps = [replace(step, anew=anew) if isinstance(step, CaseStep) else step for step in steps]
    page.steps = steps


def _is_finite_on(cases: tuple[Case, ...], page: Builder, side: PlacementProblem) -> bool:
    """Return whether there is a gain in the main line that is still finite on a stratum, the last of those around it."""
    if not page.defines(side.gain):
        return False
    moved = page[side.gain].value.substitute({**page.environment.coefficients})
    for case in cases:
        try:
            moved = moved.substitute(dict(case.substitution))
        except ZeroDivisionError:
            return False
        if case.result is None or not case.result.plant.admits(moved):
            return False
    return True
