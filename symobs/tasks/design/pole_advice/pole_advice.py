"""Advice on observer poles: the stable zeros of the plant, the rest on a Butterworth circle or as a dominant pair."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

from symobs.exact import Factored, Scalar, roots_of
from symobs.exact.core.generators import function
from symobs.exact.time_functions.antiderivative import butterworth_angles, twice_cosine
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Literal, Power, Roots, Sum
from symobs.formula.tree.term import product
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation import CaseStep, Given
from symobs.proof.derivation.builder import Builder, predicate, relation, sentence
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import Condition, joined, sign_of
from symobs.system.specification import read_quantity
from symobs.system.specification.pole_patterns import overshoot_of, overshoot_within, third_digit
from symobs.tasks.analysis.page_parts import (
    factored_form,
    formula_of_factored,
    given,
    hidden_polynomial,
    redefined_letters,
    stratum_of,
    undecided,
    unobservable_relations,
)
from symobs.tasks.design.pole_advice.advised_poles import (
    FURTHER_LEFT,
    AdvisedPoles,
    PoleRequest,
    needed_of,
    numerator_of,
    numerator_term,
)
from symobs.tasks.result import Case, Result, choose, method, page_of, task

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.formula.tree import Relation
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation import Step
    from symobs.system import StateSpace
    from symobs.system.specification import Name, Quantity
    from symobs.tasks.design.pole_advice.advised_poles import PoleWarning


@dataclass
class PoleAdvice(AdvisedPoles):
    """Advised poles, with their conditions on parameters and the advice elsewhere."""

    @property
    def verdict(self) -> str:
        """`no` where unobservable modes are not among the poles: no gain moves them there."""
        if not self.missed.is_one:
            return "no"
        return "conditional" if self.case_tree else super().verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The conditions of the plant and the zeros, that the radius is positive, and that zeros and modes are all there."""
        signs, radius = self.plant.symbols.signs, self.request.radius
        own = [*super().holds_where]
        if radius is not None and self.count and sign_of(radius, signs) != "positive":
            own.append(Condition("claim", radius.numerator * radius.denominator, ">"))
        for factor in self.taken:
            needed = needed_of(factor, signs, self.answer["sigma"], self.plant.variable)
            own += [Condition("claim", value, ">") for value in needed]
        return joined(own, self._existence)

    @cached_property
    def _existence(self) -> tuple[Condition, ...]:
        """The conditions for as many zeros as in general, and for a plant all of whose modes are seen and moved."""
        if not self.plant.field.names:
            return ()
        from symobs.tasks.design.pole_advice.advised_poles import existence_of  # noqa: PLC0415 - only plants with parameters pay for it

        return existence_of(self.plant, self.numerator)

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The advice where zeros are stable that need not be, and where zeros or modes are lost."""
        if not self.plant.field.names:
            return ()
        from symobs.tasks.design.pole_advice.advised_poles import cases_of  # noqa: PLC0415 - only plants with parameters pay for it

        return cases_of(self)


@method("pole_advice/butterworth", source="doyle1979; butterworth1930; brogan1991, pp. 532–533")
def on_a_circle(plant: StateSpace, request: PoleRequest) -> PoleAdvice:
    """Stable zeros, then a Butterworth circle of the radius given."""
    if request.radius is None:
        raise InputError("butterworth needs a radius", where="specification.radius", repair='give radius = "omega_0"')
    return PoleAdvice.of(plant, request, "butterworth")


@method("pole_advice/dominant_pair", source="second-order step response, 2 % settling time 4/σ")
def with_a_pair(plant: StateSpace, request: PoleRequest) -> PoleAdvice:
    """Stable zeros that are fast enough, a pair for settling time and overshoot, the others further left."""
    if request.settling_time is None:
        message, repair = (
            "dominant_pair needs settling_time and overshoot",
            'give settling_time = 2, overshoot = "0.05"',
        )
        raise InputError(message, where="specification.settling_time", repair=repair)
    return PoleAdvice.of(plant, request, "dominant_pair")


@task
def pole_advice(
    plant: StateSpace,
    *,
    radius: Quantity = None,
    settling_time: Quantity = None,
    overshoot: Quantity = None,
    method: Name = "auto",
) -> Result:
    """Advise observer poles: at the stable zeros of the plant, the rest on a circle or as a dominant pair.

    plant                         n states, one input, one output, continuous time
    radius                        ω₀ > 0, a symbol or a number: φ_r(s) φ_r(−s) = ω₀^{2N} + (−1)^N s^{2N}, N poles remaining
    settling_time and overshoot   numbers T > 0 and 0 < M < 1 instead of a radius: −σ ± iω with σ = 4/T (2 %) and
                                  exp(−πσ/ω) ≤ M, zeros only where Re s < −σ, other poles at −5σ, −6σ, …
    Returns poles (with multiplicity), polynomial (factored), zeros_used, warnings.  The verdict is `no` where modes that
    no observer moves are not among the poles.  Raises `InputError` in discrete time, for several inputs or outputs, and
    where N poles on a circle are not written with square roots (N = 7, 9, 11, …).
    Source: J. C. Doyle and G. Stein (1979); W. L. Brogan, Modern Control Theory, 3rd ed., pp. 532–533.
    """
    plant.require("B", "C", task="pole_advice")
    if (plant.inputs, plant.outputs) != (1, 1):
        message = f"the plant has {plant.inputs} inputs and {plant.outputs} outputs"
        raise InputError(message, where="plant", repair="keep one input and one output")
    if plant.is_discrete:
        message = "a Butterworth circle and a settling time 4/σ are of continuous time"
        raise InputError(
            message, where="plant.dt", repair="leave dt out, or take observer with all poles at 0 (deadbeat)"
        )
    request = _wish(plant, radius, settling_time, overshoot)
    plant = plant.knowing(radius)
    found: Result = choose("pole_advice", method, "dominant_pair" if request.radius is None else "butterworth").solve(
        plant, request
    )
    return found.asked(method)


def _wish(plant: StateSpace, radius: object, settling_time: object, overshoot: object) -> PoleRequest:
    """Return the request: a radius, or settling time and overshoot; raises `InputError` for anything else."""
    where = "specification.radius"
    if radius is not None:
        if settling_time is not None or overshoot is not None:
            raise InputError(
                "a radius is given beside settling_time or overshoot", where=where, repair="keep one of them"
            )
        return PoleRequest(read_quantity(radius, plant, "radius"))
    if settling_time is None or overshoot is None:
        message = "radius is missing" if settling_time is overshoot else "settling_time and overshoot belong together"
        repair = 'give radius = "omega_0", or settling_time = 2 and overshoot = "0.05"'
        raise InputError(message, where=where if settling_time is overshoot else "specification", repair=repair)
    found = [read_quantity(v, plant, n) for n, v in (("settling_time", settling_time), ("overshoot", overshoot))]
    for name, value in zip(("settling_time", "overshoot"), found, strict=True):
        if not value.is_constant:
            message = f"{name} is {value}, not a number"
            raise InputError(message, where=f"specification.{name}", repair="give a number, or a radius as a symbol")
    return PoleRequest(None, found[0], overshoot_within(found[1], "specification.overshoot"))


# The page of the advice: zeros, which of them are used and why, the circle or the pair, the polynomial.


@page_of(PoleAdvice)
def write_pole_advice(page: Builder, advice: PoleAdvice) -> None:
    """Write the plant's zeros, φ_z, φ_r and φ, and what to beware of."""
    page.with_roots(*_written(advice))
    given(page)
    if advice.request.radius is None:
        _asked(page, advice)
    with page.section("pole_advice"):
        _advice(page, advice)
        conditions = [c.expression for c in advice.holds_where if c.kind == "existence"]
        if conditions:
            page.assume("advice_provided", *conditions)
        page.steps += _cases(page, advice)


def _written(advice: PoleAdvice) -> Iterator[Scalar]:
    """Yield what may hold square roots, in the cases as well."""
    yield from (advice.answer["zeros"], advice.zeros.others, advice.answer["rest"].value)
    if advice.request.radius is not None:
        yield from (twice_cosine(Fraction(1, 2) - turns) for turns in butterworth_angles(advice.count))
    for case in advice.case_tree:
        if case.result is not None:
            yield from _written(cast("PoleAdvice", case.result))


def _advice(page: Builder, advice: PoleAdvice) -> None:
    """Write zeros, the other places, the polynomial, the cautions."""
    _zeros(page, advice)
    if advice.request.radius is not None:
        _circle(page, advice, advice.request.radius)
    else:
        _pair(page, advice)
    _polynomial(page, advice)
    for warning in advice.cautions:
        _caution(page, advice, warning)


def _cases(page: Builder, advice: PoleAdvice) -> Iterator[Step]:
    """Yield the cases: of zeros that are stable under conditions, and of the strata."""
    for case in advice.case_tree:
        if case.result is None:
            yield undecided(page, case)
            continue
        found = cast("PoleAdvice", case.result)
        inner = Builder(found.plant)
        matrices = {name: getattr(found.plant.matrices, name) for name in "ABCD" if page.defines(name)}
        inner.environment = page.environment.extended_by(values=matrices)
        _advice(inner, found)
        inner.steps += _cases(inner, found)
        anew, steps = redefined_letters(page.environment, inner.environment), tuple(inner.steps)
        conditions = case.when
        if conditions[0].operator != ">":
            yield CaseStep(stratum_of(case), tuple(case.substitution.items()), steps, anew=anew)
            continue
        for condition in reversed(conditions):
            left, operator, right = as_inequality(condition.expression, page.plant.symbols.signs)
            steps = (CaseStep(relation(left, operator, right), (), steps, anew=anew),)
        yield steps[0]


def _asked(page: Builder, advice: PoleAdvice) -> None:
    """State settling time and overshoot."""
    time, overshoot = advice.request.settling_time, advice.request.overshoot
    assert time is not None and overshoot is not None  # noqa: S101, PT018 - one of two ways to ask
    data = [relation(page["T_s"], time), relation(page["M_p"], overshoot)]
    page.steps.append(Given(tuple(data), sentence("step_asked_for", {})))
    page.environment = page.environment.extended_by(values={"T_s": time, "M_p": overshoot})


def _product(page: Builder, factors: tuple[tuple[Scalar, int], ...]) -> Term:
    """Return a product of factors as they are."""
    return page.term(formula_of_factored(Factored(Scalar.of(1), factors)))


def _zeros(page: Builder, advice: PoleAdvice) -> None:
    """Write the numerator, its roots, and those of them that are used."""
    plant, b = page.plant, numerator_of(page.plant)
    page.define(
        "b_P", numerator_term(page.environment, plant), factored_form(page, b), say="numerator_of_plant", closing=False
    )
    if not page.defines("P"):
        P = factored_form(page, b / plant.matrices.A.characteristic_polynomial(plant.variable))
        page.define("P", "b_P / det(pencil(A))", P, say="transfer_from_numerator", closing=False)
    zeros = roots_of(b, plant.variable) if b.degree(plant.variable) > 0 else ()
    if not zeros and b:
        page.conclude("no_zeros", relation(page["b_P"], b))
    elif zeros and all(root.is_closed for root in zeros):
        page.conclude("advice_zeros", roots=Roots(page["b_P^-1"].formula, zeros))
    if advice.zeros.used:
        page.define("phi_z", _product(page, advice.zeros.used), say="zeros_taken", closing=False)
    else:
        page.set("phi_z", Scalar.of(1))
        page.conclude("no_zeros_taken", "phi_z = 1")


def _circle(page: Builder, advice: PoleAdvice, radius: Scalar) -> None:
    """Write φ_r with φ_r(s) φ_r(−s), and the pairs."""
    count, variable = advice.count, page.plant.variable
    if not count:
        _nothing(page)
        return
    factors = advice.answer["rest"].factors
    whole = _product(page, factors)
    if sign_of(radius, page.plant.symbols.signs) != "positive":
        page.remark("radius_is_positive", radius=radius)
    if count == 1:
        page.define("phi_r", whole, say="one_on_circle", closing=False)
    else:
        page.define("phi_r", whole, say="some_on_circle", closing=False, count=Counted("number", count))
    powers = [page.value(radius) ** (2 * count), page.s ** (2 * count)]
    circle = powers[0] + powers[1] if count % 2 == 0 else powers[0] - powers[1]
    identity = page.line("phi_r phi_r_at(-s) = {circle}", circle=circle)
    if count == 1:
        page.conclude_silently(identity)
        return
    page.verified("is_butterworth", identity=identity)
    shown = []
    for turns, (factor, _) in zip(butterworth_angles(count), factors[count % 2 :], strict=True):
        real, imaginary = radius * twice_cosine(turns) / 2, (radius * twice_cosine(Fraction(1, 2) - turns) / 2)
        square = Sum((Power(Literal(Scalar.symbol(variable) + real), 2), Power(Literal(imaginary), 2)))
        shown.append(relation(factor, page.term(square)))
    page.equal(*shown, say="circle_pairs")


def _nothing(page: Builder) -> None:
    page.set("phi_r", Scalar.of(1))
    page.conclude("none_remains", "phi_r = 1")


def _pair(page: Builder, advice: PoleAdvice) -> None:
    """Write σ from the settling time, ω from the overshoot, and φ_r."""
    answer, request, count = advice.answer, advice.request, advice.count
    assert request.settling_time is not None and request.overshoot is not None  # noqa: S101, PT018 - one of two ways to ask
    sigma, omega_d, time = answer["sigma"], answer["omega_d"], request.settling_time
    page.define("sigma_d", "4 / T_s", say="rate_from_settling")
    page.conclude("decayed", bound=relation(function("exp", -sigma * time), "<=", Scalar.of(1) / 50))
    if not count:
        _nothing(page)
        return
    factors = answer["rest"].factors
    if omega_d is None:
        page.define("phi_r", _product(page, factors), say="one_from_settling", closing=False)
        return
    bound = page.line("{sigma} <= M_p", sigma=overshoot_of(omega_d / sigma))
    page.define("omega_d", page.value(omega_d), say="overshoot_held", bound=bound)
    page.conclude_silently(page.line("omega_d = {sigma} sigma_d", sigma=omega_d / sigma))
    more = overshoot_of(omega_d / sigma + third_digit((omega_d / sigma).fraction()))
    page.conclude("overshoot_close", more=page.line("{more} > M_p", more=more))
    first = page["(s + sigma_d)^2 + omega_d^2"]
    others = [page("s + {k} sigma_d", k=k) for k in range(FURTHER_LEFT, FURTHER_LEFT + count - 2)]
    whole = first
    for other in others:
        whole = whole @ other
    told: dict[str, Any] = {"say": "pair_remains", "count": Counted("number", count)}
    if others:
        told |= {"say": "pair_dominates", "factor": Counted("number", FURTHER_LEFT)}
    page.define("phi_r", whole, _product(page, factors), closing=False, **told)


def _polynomial(page: Builder, advice: PoleAdvice) -> None:
    """Write φ, boxed, and where the gain tends."""
    zeros, plant, whole = advice.zeros, page.plant, formula_of_factored(advice.answer["polynomial"])
    parts = [*([page["phi_z"]] if zeros.used else []), *([page["phi_r"]] if advice.count else [])]
    page.define("phi_o", product(parts), page.term(whole), say="advised_polynomial", answer=True, closing=False)
    both = {factor for factor, _ in zeros.used} & {factor for factor, _ in advice.answer["rest"].factors}
    for factor in sorted(both, key=str):
        if factor.degree(plant.variable) == 1:
            twice = page("phi_o / {factor}", factor=factor**2)
            alone = page("phi_z / {factor}", factor=page["phi_z"].scalar / factor)
            repeated = Roots(alone.formula, roots_of(factor, plant.variable))
            page.remark("pole_twice", predicate("polynomial", twice), repeated=repeated)
    if advice.request.radius is None or zeros.unused or not zeros.used or not advice.count:
        return
    if not plant.matrices.has_feedthrough:
        multiple = page["phi_z"] if zeros.unit.is_one else page("{unit} phi_z", unit=zeros.unit)
        page.equal(page.line("C adj(pencil(A)) B = {multiple}", multiple=multiple), say="recovery")


def _caution(page: Builder, advice: PoleAdvice, warning: PoleWarning) -> None:
    """Say a warning, with what can be checked of it."""
    slots = dict(warning.slots)
    if warning.key == "always_unstable":
        page.caution(warning.key, predicate("no_stable_compensator", page["b_P / det(pencil(A))"]))
    elif warning.key == "modes_missed":
        page.set("N", advice.pair.kernel)
        page.set("X", advice.pair.restricted)
        unseen = hidden_polynomial(page)
        page.caution(
            warning.key, *unobservable_relations(page, is_observer=True), polynomial=relation(unseen, advice.missed)
        )
    elif warning.key == "huge_gain":
        page.caution(warning.key, limit=str(slots["limit"]))
    elif "pole" in slots:
        root = page("det({pole} I - A)", pole=slots["pole"])
        page.caution(warning.key, zero=_vanishing(page, advice, slots["zero"]), pole=relation(root, 0))
    elif warning.key == "zero_slow":
        numerator, factor = page["b_P"], slots["zero"]
        alone = numerator / page.value(numerator.scalar / factor)
        page.caution(warning.key, zero=Roots(alone.formula, roots_of(factor, page.plant.variable)))
    elif "zero" in slots:
        page.caution(warning.key, zero=_vanishing(page, advice, slots["zero"]))
    elif warning.key == "no_response":
        page.caution(warning.key, "b_P = 0")


def _vanishing(page: Builder, advice: PoleAdvice, factor: Scalar) -> Relation:
    """Return b(z) = 0 for the root z of a linear factor, b(s) = factor · rest for another."""
    variable = page.plant.variable
    if factor.degree(variable) == 1:
        return page.line("b_P_at({value}) = 0", value=-factor.coefficients(variable)[1])
    rest = advice.zeros.others * advice.zeros.polynomial / factor
    return relation(page["b_P"], factor if rest.is_one else page("{factor} {rest}", factor=factor, rest=rest))
