"""Damping cases: results in functions of time for a negative, zero or positive discriminant.

A factor s² − 2σs + σ² − δ oscillates where δ < 0.  Where the declared signs do not decide, the result says what holds
for δ < 0, and every other sign is a case.  What a denominator of the answer excludes is a case too.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, NotRequired, Self, TypedDict

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import (
    all_roots,
    function_named,
    functions_in,
    identities_at,
    substitute,
    symbols_in,
)
from symobs.exact.time_functions.matrix_exponential import OpenBranch
from symobs.formula.tree import Conjunction, Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.errors import CertificateRejected
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation import CaseStep
from symobs.proof.derivation.builder import Builder, differs, relation, sentence
from symobs.system.conditions import Condition, of_open_sign, opposite, sign_of, vanishing_factors
from symobs.tasks.analysis.strata.loci import Locus
from symobs.tasks.analysis.strata.strata import strata
from symobs.tasks.result import Case, Result, holds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from symobs.proof.derivation import Step
    from symobs.system import StateSpace

#: δ → its sign: `taken` by the caller, or chosen because the signs leave it open.
Signs = dict[Scalar, str]
_MOST_BRANCHES = 4
#: What is said of a mode whose discriminant is negative or positive.
_BRANCHES = {"<": "branch_under", ">": "branch_over"}
#: The signs that a value of a sign cannot have.
_EXCLUDES = {"negative": {"positive", "nonnegative", "zero"}, "positive": {"negative", "nonpositive", "zero"}}


class DampingAnswer(TypedDict):
    """The signs of discriminants that an answer stands on; where there is no closed form what is open, and a factor."""

    taken: Signs
    chosen: Signs
    question: NotRequired[str]
    factor: NotRequired[Scalar | None]


class DampingCases(Result):
    """A result whose answer holds `taken` and `chosen`, the signs of discriminants it stands on."""

    answer: DampingAnswer
    in_time: ClassVar[bool] = True
    #: The answer that every result has, unless it is undecided or negative.
    main: ClassVar[str] = "matrix"
    #: What is asked beside the plant, and may contain its parameters.
    asked_for: ClassVar[tuple[str, ...]] = ()

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The answers that are functions of time."""
        return tuple(v for v in self.answer.values() if isinstance(v, (Matrix, Scalar)))

    @classmethod
    def of(cls, *data: Any, **named: Any) -> Self:
        """Return the result for a plant, a method, what is asked beside the plant, and the signs of discriminants."""
        raise NotImplementedError

    def claims(self) -> Iterator[Claim]:
        """Yield that there is an answer or a question that is open, and that every root in the answer is real."""
        if self.answer.get(self.main) is None and self.answer.get("question") is None and self.has_answer:
            reject(f"the {self.main} of {self.task} is missing")
        signs = {**self.answer["taken"], **self.answer["chosen"]}
        above = tuple(delta if sign == "positive" else -delta for delta, sign in signs.items())
        e = Environment(variable=self.plant.variable, signs=self.plant.symbols.signs, positive=above)
        for root in sorted(all_roots(*self.matrices), key=lambda root: root.name):
            yield Claim(relation(root.argument, ">=", 0), e, f"{root.name} is real")

    @property
    def has_answer(self) -> bool:
        """Whether there is one in general."""
        return self.verdict != "no"

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Polynomials in the parameters beyond the denominators whose zeros are cases."""
        return ()

    @property
    def end(self) -> Scalar | None:
        """The horizon where there is a finite one."""
        horizon = self.answer.get("horizon")
        return horizon if isinstance(horizon, Scalar) else None

    @cached_property
    def domain(self) -> tuple[Condition, ...]:
        """That of the plant; and a horizon is positive, where no sign says so."""
        end = self.end
        if end is None or sign_of(end, self.plant.symbols.signs) == "positive":
            return super().domain
        return (*super().domain, Condition("domain", end, ">"))

    @property
    def verdict(self) -> str:
        """`undecided` where there is no closed form."""
        if self.answer.get("question") is not None:
            return "undecided"
        return super().verdict

    @cached_property
    def denominators(self) -> tuple[Scalar, ...]:
        """The polynomials in the parameters that the answer divides by."""
        return vanishing_denominators(self.matrices, self.plant)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, the signs that were chosen, and the denominators of the answer."""
        return self.stated

    @cached_property
    def stated(self) -> tuple[Condition, ...]:
        """What this branch stands on, the cases left aside."""
        listed = {condition.expression for condition in self.domain}
        chosen = [_stated(delta, sign) for delta, sign in self.answer["chosen"].items()]
        beyond = {f for delta in self.answer["chosen"] for f, _ in delta.numerator.factors()[1]}
        beyond |= {f for delta in self.answer["taken"] for f, _ in delta.numerator.factors()[1]}
        rest = [Condition("claim", f) for f in self.denominators if f not in listed and f not in beyond]
        return (*self.domain, *chosen, *rest)

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The other signs of each discriminant that was left open, and the zeros of the denominators."""
        taken: Signs = dict(self.answer["taken"])
        found: list[Case] = []
        signs = self.plant.symbols.signs
        zeros: list[Scalar] = [*self.further_zeros]
        zeros += [c.expression for c in self.stated if c.kind == "claim" and c.operator == "!="]
        before: tuple[Condition, ...] = ()
        for delta, sign in self.answer["chosen"].items():
            if sign_of(delta, signs) not in {"nonpositive", "nonnegative"}:
                other = opposite(sign)
                when = (*before, _stated(delta, other))
                found.append(Case(when, {}, self._rebuilt(self.plant, self.answer, {**taken, delta: other})))
            zeros.append(delta)
            taken[delta], before = sign, (*before, _stated(delta, sign))
        zeros = list(dict.fromkeys(zeros))
        return (*found, *strata(self.plant, zeros, self._on_stratum))

    def _on_stratum(self, plant: StateSpace, substitution: dict[str, Scalar]) -> Result:
        """Return the result on a stratum; ZeroDivisionError where the signs this one stands on exclude it."""
        taken: Signs = {}
        for delta, sign in self.answer["taken"].items():
            there = delta.substitute(substitution)
            if _sign_in(plant, there) in _EXCLUDES[sign]:
                message = f"{there} is not {sign}"
                raise ZeroDivisionError(message)
            taken[there] = sign
        values = ((name, self.answer.get(name)) for name in self.asked_for)
        moved = {name: substitute(v, substitution) for name, v in values if isinstance(v, (Matrix, Scalar))}
        return self._rebuilt(plant, {**self.answer, **moved}, taken)

    def _rebuilt(self, plant: StateSpace, asked: Mapping[str, Any], taken: Signs) -> Self:
        return type(self).of(plant, self.method, asked, taken)

    @property
    def is_told_in_decimals(self) -> bool:
        """Whether a sum over the roots of a polynomial of numbers is in an answer: its modes have decimals alone."""
        found = [function_named(name) for value in self.matrices for name in value.names]
        return any(isinstance(function, RootSum) and function.is_rational for function in found)

    def everything(self) -> Iterator[Matrix | Scalar]:
        """Yield all functions of time on the page: those of the cases too."""
        yield from self.matrices
        for case in self.case_tree:
            if isinstance(case.result, DampingCases):
                yield from case.result.everything()

    def state_data(self, page: Builder) -> None:
        """State the data, the condition on the horizon, and on the page of a case the signs it stands on."""
        from symobs.tasks.analysis.page_parts import given  # noqa: PLC0415

        given(page)
        beyond = [c.expression for c in self.domain if c.operator == ">"]
        taken = self.answer["taken"].items()
        beyond += [
            of_open_sign(delta if sign == "positive" else -delta, self.plant.symbols.signs) for delta, sign in taken
        ]
        page.assume_positive(beyond)

    def write_branches(self, page: Builder, write_branch: Callable[[Builder, Any], None]) -> None:
        """Write this branch and the others; each is a case if there are several."""
        chosen = [_stated(delta, sign) for delta, sign in self.answer["chosen"].items()]
        if not self.case_tree and not chosen:
            write_branch(page, self)
            return
        inner = inside_case(page, self.plant, {})
        write_branch(inner, self)
        found = dict.fromkeys(_distance(case) for case in self.case_tree if case.when[0].operator == "==")
        signs = self.plant.symbols.signs
        ruled_out = vanishing_factors((condition.expression for condition in chosen), signs)
        zeros = vanishing_factors(map(self.plant.simplified, found), signs)
        steps = tuple(inner.steps)
        if factors := [factor for factor in zeros if factor not in ruled_out]:
            apart = Conjunction(tuple(map(differs, factors)))
            steps = (CaseStep(apart, (), steps),)  # inside, what is told rests on it
        page.steps += _narrowed(steps, chosen, signs)
        page.steps += [_case(page, case, self.answer["chosen"], write_branch) for case in self.case_tree]


def _distance(case: Case) -> Scalar:
    """Return a polynomial that vanishes exactly where the equations of a case hold."""
    return Locus(tuple(c.expression for c in case.when if c.operator == "==")).distance


def _case(page: Builder, case: Case, doubled: Signs, write_branch: Callable[[Builder, Any], None]) -> Step:
    from symobs.tasks.analysis.page_parts import stratum_of, undecided  # noqa: PLC0415

    if not isinstance(case.result, DampingCases):
        return undecided(page, case)
    condition = case.when[0]
    inner = inside_case(page, case.result.plant, case.substitution)
    case.result.write_branches(inner, write_branch)
    steps = tuple(inner.steps)
    if condition.operator != "==":
        return _narrowed(steps, case.when, page.plant.symbols.signs)[0]
    is_double = any((delta / condition.expression).denominator.is_constant for delta in doubled)
    because = sentence("branch_equal", {}) if is_double else None
    return CaseStep(stratum_of(case), tuple(case.substitution.items()), steps, because)


def _narrowed(steps: tuple[Step, ...], conditions: Sequence[Condition], signs: Mapping[str, str]) -> tuple[Step, ...]:
    """Return the steps under inequalities of discriminants, each within the one before; ζ < 1 for ω²ζ² − ω² < 0."""
    from symobs.tasks.analysis.page_parts import as_written  # noqa: PLC0415

    for condition in reversed(conditions):
        when = as_written(replace(condition, expression=of_open_sign(condition.expression, signs)))
        steps = (CaseStep(when, (), steps, sentence(_BRANCHES[condition.operator], {})),)
    return steps


def inside_case(page: Builder, plant: StateSpace, substitution: Mapping[str, Scalar]) -> Builder:
    """Return a builder for the steps of a case, with the same environment."""
    inner = Builder(plant)
    inner.start, inner.forms, inner.told = page.start, page.forms, page.told
    inner.environment = replace(page.environment, values=_moved(page.environment.values, substitution))
    return inner


def _stated(delta: Scalar, sign: str) -> Condition:
    """Return the condition that a discriminant has a sign."""
    return Condition("claim", _plain(delta), "<" if sign == "negative" else ">")


def reject(message: str) -> NoReturn:
    """Refuse an answer that no claim could state."""
    raise CertificateRejected(message)


def rate_of(term: Term) -> Term:
    """Return d/dt of a function of time; of one that stands still the zero matrix."""
    if "t" in symbols_in(term.value):
        return term.derivative
    return Term(Literal(term.value * 0), term.environment)


def _moved(values: Mapping[str, Any], substitution: Mapping[str, Scalar]) -> dict[str, Any]:
    """Return what letters mean on a stratum; those that mean nothing there are left out."""
    found = {}
    for name, value in values.items():
        try:
            found[name] = substitute(value, substitution)
        except ZeroDivisionError:
            continue
    return found


def _plain(delta: Scalar) -> Scalar:
    """Return a positive multiple of a discriminant without a numeric denominator."""
    return delta * delta.denominator if delta.denominator.is_constant else delta


def vanishing_denominators(values: Any, plant: StateSpace) -> tuple[Scalar, ...]:
    """Return the factors of denominators in the plant's data that its signs do not keep from 0.

    Functions of time or of a horizon, such as 1 − e^(−2aT), are no data: what divides by these is a matter of the rank.
    """
    m = plant.matrices
    data = [*functions_in([m.A, m.B, m.C, m.D, *plant.equations])]
    arguments = {symbol for function in data for symbol in function.symbols} - {"t"}

    def is_of_data(factor: Scalar) -> bool:
        found = [f for name in factor.names if (f := function_named(name)) is not None and f not in data]
        return all(f.kind != "sqrt" and f.symbols <= arguments and not functions_in([f.argument]) for f in found)

    denominators = [value.common_denominator() for value in values]
    return tuple(factor for factor in vanishing_factors(denominators, plant.symbols.signs) if is_of_data(factor))


def _sign_in(plant: StateSpace, value: Scalar) -> str:
    """Return the sign that a value has by the declared signs and by the relations between the parameters."""
    return sign_of(plant.simplified(value), plant.symbols.signs)


def with_signs(plant: StateSpace, taken: Signs, solve: Callable[[Callable[[Scalar], str]], Any]) -> tuple[Any, Signs]:
    """Return what `solve` finds, and the discriminants that had to be taken negative because their sign is open."""
    chosen: Signs = {}

    def sign(delta: Scalar) -> str:
        found = _sign_in(plant, delta)
        return found if found in {"positive", "negative", "zero"} else taken.get(delta) or chosen.get(delta) or "open"

    while True:
        try:
            return solve(sign), chosen
        except OpenBranch as open_branch:
            if len(chosen) >= _MOST_BRANCHES:
                raise
            low = _sign_in(plant, open_branch.discriminant) == "nonnegative"
            chosen[open_branch.discriminant] = "positive" if low else "negative"


def exponential_claims(e: Environment) -> Iterator[Claim]:
    """Yield the differential equation of the matrix exponential and its start, which have one solution."""
    Phi = e["exp_At"]
    yield holds(e, "{rate} = A exp_At", rate=rate_of(Phi))
    yield holds(e, "{start} = I", start=Phi.at("t", 0))


def from_zero(names: Iterable[str], e: Environment) -> Iterator[Claim]:
    """Yield that functions of time are 0 at t = 0, as integrals from there are."""
    for name in names:
        if name in e.values:
            value = e.values[name]
            start = Matrix.zeros(*value.shape) if isinstance(value, Matrix) else Scalar.of(0)
            yield holds(e, f"{name}(t = 0) = {{start}}", start=start)


def time_environment(plant: StateSpace, values: Mapping[str, Scalar | Matrix], at: Scalar | None = None) -> Environment:
    """Return an environment for claims about functions of time, and what they are at an instant."""
    meanings, relations = identities_at(values.values(), at)
    return Environment(
        variable=plant.variable,
        values=values,
        coefficients=meanings,
        relations=relations,
        signs=plant.symbols.signs,
    )
