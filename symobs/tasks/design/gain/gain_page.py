"""The pages of gain design: canonical form and Ackermann's formula, on either side of duality."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Factored, Matrix, Scalar, companion, from_coefficients, hankel_of, root_of_pole, roots_of
from symobs.exact.core.generators import all_roots
from symobs.formula.tree import Evaluated, Literal, Roots
from symobs.formula.tree.term import Term, block
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.wording_check import Said, rests
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.factored_form import factored_form, formula_of_factored
from symobs.tasks.analysis.page_parts import (
    determinant_form,
    environment_on,
    hidden_polynomial,
    say_stability,
    set_anew,
    stratum_of,
    undecided,
)
from symobs.tasks.analysis.rank.rank_page import outside_cases, square_test
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.gain.gain_family_page import of_the_others, write_hidden_family, write_sylvester
from symobs.tasks.design.gain.gain_kind import GivenGain, UnassignableGain
from symobs.tasks.design.gain.gain_methods_page import readable, write_ackermann_formula, write_row_reduction
from symobs.tasks.design.gain.placement_problem import OBSERVER, PlacementProblem
from symobs.tasks.design.gain.zero_pattern_page import another_gain, pattern_case, write_no_gain
from symobs.tasks.design.page_parts import readability
from symobs.tasks.design.page_parts.pole_cautions import caution_poles
from symobs.tasks.design.page_parts.unassignable import over_fixed, say_unassignable
from symobs.tasks.design.pole_placement.fresh_names import fresh_names, taken_names
from symobs.tasks.result import choose

if TYPE_CHECKING:
    from symobs.exact.core.generators import Function
    from symobs.tasks.result import Case

#: The degree of the factor of a conjugate pair.
_PAIR = 2


def write_gain(page: Builder, design: GainDesign, side: PlacementProblem, style: str, *, of_loop: bool = False) -> None:
    """Write how the gain is found, in the style of a method, and the check the reader is shown.

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
    page.conclude_silently(relation(page[side.gain], design.answer[side.gain]))
    page.in_decimals(side.gain)
    _verified(page, design, side)
    for case in design.case_tree:
        write_case(page, case, side)


def _write_gain_alone(page: Builder, design: GainDesign, side: PlacementProblem, _: DesiredPolynomial) -> None:
    """State the gain of a method without a page; the check below proves it."""
    page.define(side.gain, design.answer[side.gain], say="gain_stated", answer=True)


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
        page.define(side.gain, design.answer[side.gain], say="gain_with_roots", answer=True)
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
        chi=relation((page.s @ page.identity(order) - page["A"]).apply("det"), page.value(chi)),
    )


def name_entries(page: Builder, gain: str) -> None:
    """Give the entries of a gain letters of their own, in which the page goes on."""
    value = page[gain].value
    names = fresh_names(f"{gain.lower()}_", len(value.entries), taken_names(page))
    letters = [page.name_coefficient(name, entry) for name, entry in zip(names, value.entries, strict=True)]
    columns = value.shape[1]
    named = Matrix.of([letters[k : k + columns] for k in range(0, len(letters), columns)])
    page.equal(relation(page[gain], named), say="named_entries")
    page.set(gain, named)


def write_canonical(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the difference of coefficients, constant first, carried back by V⁻¹."""
    plant, order = page.plant, page.plant.order
    variable = plant.variable
    wanted = [page.value(c) for c in reversed(desired.coefficients)]
    if side.gain == "K" and _is_canonical(page):
        found = plant.matrices.A.characteristic_polynomial(variable).coefficients(variable)[1:]
        page.define("K", _difference(page, wanted, list(found)), answer=True)
        return
    A = page["A"].T if side.gain == "L" else page["A"]
    matrix = page[side.matrix].T if side.gain == "L" else page[side.matrix]
    chi = plant.matrices.A.characteristic_polynomial(variable)
    found = chi.coefficients(variable)[1:]
    said = getattr(page.steps[-1], "sentence", None)
    is_announced = said is not None and said.key == f"polynomials_{side.kind}"  # beside φ
    say = "" if is_announced else f"open_{side.kind}"
    page.define("chi", (page.s @ page.identity(order) - A).apply("det"), say=say)
    hankel = page.value(hankel_of(found))
    written = [matrix.as_value @ hankel] if order > 1 else []
    V = page.define(f"V_{side.index}", matrix @ hankel, *written, say=f"canonical_{side.kind}")
    page.equal(
        relation(V.inverse, V.inverse.as_value), relation(V.apply("det"), determinant_form(page, V.value.determinant()))
    )
    row = _difference(page, wanted, list(found))
    if side.gain == "L":
        page.define_transposed("L", row @ V.inverse, row.as_value @ V.inverse.as_value, say="row_observer")
    else:
        page.define("K", row @ V.inverse, row.as_value @ V.inverse.as_value, say="row_state_feedback", answer=True)


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
    gain = page.define(side.gain, design.answer[side.gain], say=f"{of_the_others(design)}_{side.kind}", answer=True)
    free = page[side.hidden[0]] @ page.value(Matrix.column([Scalar.symbol(name) for name in family["parameters"]]))
    general = gain + (free if side is OBSERVER else free.T)
    page.remark(f"family_{side.kind}", gain=Evaluated(general.formula, Literal(family[side.gain])))


def _impossible(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """State that no gain exists: fixed modes that are not desired, or an impossible zero pattern."""
    if not isinstance(design.kind, UnassignableGain):
        write_no_gain(page, design, side)
        return
    fixed = _fixed(page, side, design.pair.kernel, design.pair.restricted)
    say_unassignable(
        page,
        (f"impossible_{side.kind}", f"unassignable_{side.kind}"),
        page[side.phi],
        design.answer["polynomial"],
        fixed,
        design.case_tree,
        fixed=Evaluated(fixed.formula, Literal(design.fixed_polynomial)),
        polynomial=Evaluated(page[side.phi].formula, Literal(page[side.phi].value)),
    )


def _fixed(page: Builder, side: PlacementProblem, kernel: Matrix, restricted: Matrix) -> Term:
    """Introduce N and X, and return the polynomial of the modes that no gain moves."""
    for name, value in zip(side.hidden, (kernel, restricted), strict=True):
        page.set(name, value)
    return hidden_polynomial(page, kernel.shape[1], side.hidden[1])


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
    own, gain = _is_finite_on(cases, page, side), result.answer[side.gain]
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
    page.conclude_silently(relation(side.error_determinant(page), page[side.phi]))
    page.steps = outside_cases(page, result, page.steps) or [undecided(page, cases[-1])]


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
