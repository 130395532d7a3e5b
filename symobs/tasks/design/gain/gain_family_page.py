"""The page of the family of gains: companion matrix, Sylvester's equation, its solution, the general gain, one member."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import EIGENVALUE, Matrix, Scalar, companion, roots_of
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Roots
from symobs.proof.derivation import CaseStep, Note
from symobs.proof.derivation.builder import Builder, relation, sentence
from symobs.stability.criteria.stability import monic
from symobs.system.conditions import vanishing_factors
from symobs.tasks.analysis.page_parts import (
    determinant_form,
    stratum_of,
    undecided,
)
from symobs.tasks.design import readability
from symobs.tasks.design.gain.gain_design import GainDesign
from symobs.tasks.design.gain.gain_kind import AlgebraicGain, SmallGain
from symobs.tasks.design.gain.small_gain_page import compare_with_simple, say_why_simple, small_gain_terms
from symobs.tasks.design.gain.structured_gain_page import write_structured
from symobs.tasks.design.named_gains import define_gain
from symobs.tasks.design.pole_placement.sylvester import Sylvester, charts_of

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation import Step
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.gain.gain_design import PlacementProblem
    from symobs.tasks.design.gain.gain_kind import Places
    from symobs.tasks.result import Case


def write_sylvester(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the equation, its solution, and for several outputs (inputs) the family and one member of it."""
    chart = design.chart
    terms, say = (
        small_gain_terms(page, design, side, *_pair(page, side)) if design.page_method != "sylvester" else ([], "")
    )
    if terms:
        define_gain(page, side.gain, *terms, say=say)
        compare_with_simple(page, design, side, *_pair(page, side))
        page.remark(f"others_{side.kind}", count=str(_freedom(design)))
        return
    if (
        chart is not None
        and design.page_method != "sylvester"
        and not design.decoupled
        and _structured(page, design, side)
    ):
        page.remark(f"others_{side.kind}", count=str(len(chart.names)))
        return
    if chart is None and design.dual_pair(page.plant).c.shape[0] > 1:  # whether the rows of G are free is not known
        define_gain(page, side.gain, design.answer[side.gain], say="gain_stated")
        return
    page.define(f"F_{side.index}", companion(desired.coefficients), say="companion_of_wish")
    if chart is None:
        _only_gain(page, design, side, desired)
        return
    equation = chart.equation
    _shift(page, equation, side, design)
    _equation(page, side, "", equation, equation.G)
    page.remark(f"dimension_{side.kind}", count=str(len(chart.names)))
    if chart.general is not None and chart.general.size <= readability.GENERAL_GAIN:
        general = design.transpose_for_task(chart.general)
        define_gain(page, f"{side.gain}_G", _gain(page, side, "", equation), general, say="general_gain", answer=False)
    own = chart.own_G
    if own is None:
        say = f"alone_decoupled_{side.kind}" if design.decoupled else "no_member"
        say = "small_alone" if isinstance(design.kind, SmallGain) else say
        define_gain(page, side.gain, design.answer[side.gain], say=say)
        return
    words = f"decoupled_{side.kind}" if design.decoupled else "zero" if design.zero else "several"
    words = "small" if isinstance(design.kind, SmallGain) else words
    page.define(f"G_{side.index}1", own, say=f"member_{words}")
    solution = page.set(f"X_{side.index}1", equation.solution(own))
    determinant = relation(solution.apply("det"), determinant_form(page, solution.value.determinant()))
    if solution.value.size <= readability.MEMBER_SOLUTION:
        page.equal(relation(solution, solution.as_value), determinant, say="solution_of_member")
    else:
        page.equal(determinant, say="solution_long")
    page.conclude_silently(_sylvester(page, side, "1", equation))
    define_gain(page, side.gain, _gain(page, side, "1", equation), say="gain_follows")
    compare_with_simple(page, design, side, *_pair(page, side))


def _freedom(design: GainDesign) -> int:
    """Return how many dimensions the family of an observable pair has."""
    outputs, order = design.pair.c.shape
    return order * (outputs - 1)


def _pair(page: Builder, side: PlacementProblem) -> tuple[Term, Term]:
    return page["A"], page["C" if side.is_dual else "B"]


def _structured(page: Builder, design: GainDesign, side: PlacementProblem) -> bool:
    """Write the gain factor by factor where that is possible; return whether it is."""
    value, phi = design.answer[side.gain], page[side.phi]
    if design.desired is None or phi.value != design.desired.polynomial:
        return False
    if not write_structured(page, side, value, *_pair(page, side), phi):
        return False
    define_gain(page, side.gain, value, say="gain_follows")
    return True


def write_hidden_family(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """Write one gain and the dimension of the family where some modes are fixed."""
    assert design.chart is not None  # noqa: S101 - several outputs have a chart wherever there is a gain
    key = of_the_others(design)
    say_why_simple(page, design, side, _pair(page, side)[1])
    define_gain(page, side.gain, design.answer[side.gain], say=f"{key}_{side.kind}")
    if key == "one_gain":
        outputs, hidden = design.dual_pair(page.plant).c.shape[0], design.pair.kernel.shape[1]
        free = (page.plant.order - hidden) * (outputs - 1)
        page.remark(
            f"family_hidden_{side.kind}",
            free=Counted("free_parameter", free),
            rest=Counted("free_entry", hidden * outputs),
        )


def of_the_others(design: GainDesign) -> str:
    """Return how a gain is announced beside fixed modes: it places the other poles, or there are none."""
    return "no_others" if design.fixed_polynomial.degree(design.plant.variable) == design.plant.order else "one_gain"


def _only_gain(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the gain of one output (input): G = e₁ᵀ, and X is unique."""
    pair = design.dual_pair(page.plant)
    (equation,) = charts_of(pair.A, pair.c, desired.factors, pair.variable, ())
    _shift(page, equation, side, design)
    _equation(page, side, "", equation, equation.G)
    define_gain(page, side.gain, _gain(page, side, "", equation), say="gain_follows")


def _shift(page: Builder, equation: Sylvester, side: PlacementProblem, design: GainDesign) -> None:
    """Part the spectra where they meet."""
    if equation.shift is None:
        return
    phi, variable = page[side.phi], page.plant.variable
    rest = (page.plant.matrices.A.characteristic_polynomial(variable) / phi.scalar).denominator
    shared = monic(phi.scalar / rest, variable)
    say, told = "spectra_parted", dict[str, Any]()
    if shared.degree(variable):
        roots = Roots((phi / page.value(phi.scalar / shared)).formula, roots_of(shared, variable))
        say, told = f"spectra_meet_{side.kind}", {"roots": roots}
    gain = page.define(f"{side.gain}_0", design.transpose_for_task(equation.shift), say=say, **told)
    moved = gain @ page["C"] if side.gain == "L" else page["B"] @ gain
    page.define(f"A_{side.index}0", page["A"] - moved)


def _state_matrix(page: Builder, side: PlacementProblem, equation: Sylvester) -> Term:
    return page["A"] if equation.shift is None else page[f"A_{side.index}0"]


def _equation(page: Builder, side: PlacementProblem, which: str, equation: Sylvester, value: Matrix) -> None:
    """Write G, the equation, and X with its determinant."""
    G, X = (f"{letter}_{side.index}{which}" for letter in "GX")
    page.set(G, value)
    solution = page.set(X, equation.solution(value))
    conditional = _sylvester(page, side, which, equation)
    page.equal(conditional, say=f"sylvester_{side.kind}")
    apart = vanishing_factors([equation.resultant], page.plant.symbols.signs)
    if apart and all(factor.size <= readability.FAMILY_SOLUTION for factor in apart):
        page.assume("spectra_provided", *apart)
    elif apart:
        page.remark("spectra_apart")
    page.equal(_similar(page, side, which, equation), say=f"similar_{side.kind}")
    has_choice = value.shape[0] > 1
    row = relation(page[G], value)
    if has_choice:
        page.equal(row, say=f"one_row_held_{side.kind}")
    else:
        page.equal(row, say=f"one_gain_only_{side.kind}", equation=conditional)
    if solution.value.size <= readability.FAMILY_SOLUTION:
        shown = relation(solution, solution.as_value)
        if has_choice:
            page.equal(shown, say="solution_is", equation=conditional)
        else:
            page.equal(shown)
    determinant = _short_determinant(solution.value, equation.names)
    if determinant is not None:
        page.equal(
            relation(solution.apply("det"), determinant_form(page, determinant)),
            say="determinant_free" if value.shape[0] > 1 else "",
        )


def _short_determinant(X: Matrix, names: tuple[str, ...]) -> Scalar | None:
    """Return det X unless it is too long to be shown: where letters are 0 it has no more terms than elsewhere."""
    kept = 2
    while True:
        found = (
            X.substitute(dict.fromkeys(names[kept:], Scalar.of(0))).determinant()
            if kept < len(names)
            else X.determinant()
        )
        if found.size > readability.FAMILY_DETERMINANT:
            return None
        if kept >= len(names):
            return found
        kept *= 2


def _sylvester(page: Builder, side: PlacementProblem, which: str, equation: Sylvester) -> Relation:
    """Return AᵀX − XF = CᵀG, or AX − XF = BG."""
    A = _state_matrix(page, side, equation)
    G, X = (f"{letter}_{side.index}{which}" for letter in "GX")
    if side.gain == "L":
        return page.line(f"{{value}} {X} - {X} F_{side.index} = C.T {G}", value=A.T)
    return page.line(f"{{A}} {X} - {X} F_{side.index} = B {G}", A=A)


def _gain(page: Builder, side: PlacementProblem, which: str, equation: Sylvester) -> Term:
    """Return L₀ + (G X⁻¹)ᵀ, or K₀ + G X⁻¹."""
    G, X = (f"{letter}_{side.index}{which}" for letter in "GX")
    found = page[f"{G} {X}^-1"]
    found = found.T if side.gain == "L" else found
    return found if equation.shift is None else page[f"{side.gain}_0"] + found


def _similar(page: Builder, side: PlacementProblem, which: str, equation: Sylvester) -> Relation:
    """Return (A − LC)ᵀ = Aᵀ − CᵀGX⁻¹ = XFX⁻¹, or A − BK = A − BGX⁻¹ = XFX⁻¹."""
    G, X = (f"{letter}_{side.index}{which}" for letter in "GX")
    A = _state_matrix(page, side, equation)
    left = page(f"{{value}} - C.T {G} {X}^-1", value=A.T) if side.gain == "L" else A - page[f"B {G} {X}^-1"]
    return page.line(f"{{left}} = {X} F_{side.index} {X}^-1", left=left)


# The pages of gains with zeros in given places: none, none but on a stratum, one with roots, one in a root of high
# degree.


def write_no_gain(page: Builder, design: GainDesign, side: PlacementProblem) -> None:
    """Write why no gain has its zeros there, where one has, or one in a root."""
    listed = _listed(design.zero)
    if isinstance(design.kind, AlgebraicGain):
        _algebraic(page, design, design.kind, side)
    elif not design.needed:
        page.conclude("undecided_zero", places=listed)
    elif design.needed[0].is_constant:
        page.conclude("impossible_zero", places=listed)
    else:
        short = min(design.needed, key=lambda value: value.size)
        if short.size <= readability.ZERO_CONDITION:
            page.remark("impossible_zero_unless", places=listed, when=page.value(short))
        else:
            page.remark("impossible_zero_in_general", places=listed)
        for case in design.case_tree:
            page.steps.append(pattern_case(page, case, side))


def _listed(zero: Places) -> str:
    return ", ".join(f"({i + 1}, {j + 1})" for i, j in zero)


def _algebraic(page: Builder, design: GainDesign, kind: AlgebraicGain, side: PlacementProblem) -> None:
    """Write a gain whose entries are polynomials in a real root λ."""
    found = kind.found
    low, high = found.bounds
    at_ends = [found.polynomial.substitute({EIGENVALUE: end}) for end in (low, high)]
    inner, page.steps, before = page.steps, [], page.environment
    page.environment = before.with_relations((found.polynomial,))
    define_gain(page, side.gain, design.transpose_for_task(found.gain))
    page.verified(
        "as_required",
        check=page.line(f"{{error_determinant}} = {side.phi}", error_determinant=side.error_determinant(page)),
    )
    steps, page.steps, page.environment = tuple(page.steps), inner, before
    changes = relation(page.value(at_ends[0]) @ page.value(at_ends[1]), "<", 0)
    page.conclude("zero_in_root", changes, places=_listed(kind.zero), low=str(low), high=str(high))
    page.steps.append(CaseStep(relation(found.polynomial, 0), (), steps))


def pattern_case(page: Builder, case: Case, side: PlacementProblem, say: str = "case_zero_gain") -> Step:
    """Return the gain on a stratum where there is one with its zeros there."""
    result = case.result
    if not isinstance(result, GainDesign) or (result.answer[side.gain] is None and result.verdict != "no"):
        return undecided(page, case)
    if result.answer[side.gain] is None:
        steps: tuple[Step, ...] = (Note(sentence("case_no_zero", {})),)
        return CaseStep(stratum_of(case), tuple(case.substitution.items()), steps)
    return another_gain(page, case, side, say)


def another_gain(page: Builder, case: Case, side: PlacementProblem, say: str) -> Step:
    """Write the gain on a stratum that is not the one of the main line."""
    result = case.result
    assert isinstance(result, GainDesign)  # noqa: S101 - the case is decided
    inner, page.steps, before = page.steps, [], page.environment
    page.with_roots(result.answer[side.gain])
    define_gain(page, side.gain, result.answer[side.gain], say=say)
    page.conclude_silently(
        page.line(f"{{error_determinant}} = {side.phi}", error_determinant=side.error_determinant(page))
    )
    conditions = [c.expression for c in result.holds_where if c.kind == "claim" and c.operator == "!="]
    if conditions:
        page.assume("gain_provided", *conditions)
    for further in result.case_tree:
        page.steps.append(pattern_case(page, further, side, say))
    steps, page.steps, page.environment = tuple(page.steps), inner, before
    return CaseStep(stratum_of(case), tuple(case.substitution.items()), steps, anew=(side.gain,))
