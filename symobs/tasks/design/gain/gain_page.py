"""The pages of gain design, on either side of duality: the test, the polynomial, the gain and its check, the cases."""

from __future__ import annotations

from dataclasses import replace
from math import prod
from typing import TYPE_CHECKING

from symobs.exact import Factored, Matrix, Scalar, factored, from_coefficients, root_of_pole, roots_of
from symobs.exact.core.generators import all_roots
from symobs.formula.tree import Evaluated, Literal, Roots
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.proof.derivation.facts import PREDICATES
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.wording_check import meets_obligations
from symobs.stability.criteria.stability import stability
from symobs.system.specification import DesiredPolynomial
from symobs.tasks.analysis.page_parts import (
    environment_on,
    factored_form,
    formula_of_factored,
    hidden_polynomial,
    redefined_letters,
    say_stability,
    stratum_of,
    undecided,
)
from symobs.tasks.analysis.rank.rank_page import outside_cases, write_test
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
from symobs.tasks.design.gain.gain_ways_page import (
    is_canonical,
    readable,
    say_canonical,
    write_ackermann_formula,
    write_canonical,
    write_row_reduction,
)
from symobs.tasks.design.named_gains import define_gain
from symobs.tasks.design.pole_cautions import caution_poles
from symobs.tasks.design.pole_placement.sylvester import fresh_names, taken_names
from symobs.tasks.design.unassignable import over_fixed, say_unassignable
from symobs.tasks.result import choose

if TYPE_CHECKING:
    from symobs.exact.core.generators import Function
    from symobs.formula.tree.term import Term
    from symobs.tasks.result import Case


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
        asks = "polynomials" if write is write_canonical and not (side.gain == "K" and is_canonical(page)) else "asks"
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


def _test(page: Builder, design: GainDesign, side: PlacementProblem, style: str) -> None:
    if side.gain == "K" and style == "canonical_form" and is_canonical(page):
        say_canonical(page)
        return
    if not page.defines(side.matrix):
        is_known = write_test(page, side.matrix, design.test, side.test)
    else:
        is_known = meets_obligations(f"assignable_{side.kind}", SentenceContext((), page.environment))
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
    say_as_required(page, desired, side.error_determinant(page), page.value(polynomial))
    caution_poles(page, desired, side.phi, side.kind)
    if not desired.poles and not desired.is_numeric and polynomial == desired.polynomial:
        say_stability(page, side.error_determinant(page))


def say_as_required(page: Builder, desired: DesiredPolynomial, *members: Term) -> None:
    """Show the check of a gain, the desired factors last; for a desired conjugate pair with the poles themselves.

    A gain with roots in it has the polynomial only as far as their own polynomials vanish: there the check says enough.
    """
    if not desired.is_expanded and members[-1].value == desired.polynomial:
        members = (*members, page.term(formula_of_factored(Factored(Scalar.of(1), desired.grouped()))))
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
    anew = redefined_letters(here, inside)
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
        anew = redefined_letters(before, page.environment)
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
