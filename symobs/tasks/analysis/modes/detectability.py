"""Detectability and stabilizability: whether the modes that stay hidden are stable.

(C, A) is detectable exactly when the polynomial of the fixed modes, det(sI − X) with X = A on ker 𝒪, is stable; (A, B)
is stabilizable exactly when (Bᵀ, Aᵀ) is detectable.  Under Brogan's weaker reading a fixed mode may lie on the
boundary, if it does not grow: X must be stable in the sense of Lyapunov.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from symobs.exact import EIGENVALUE, Scalar, product_of
from symobs.formula.tree import Conjunction, HoldsExactlyWhere
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import verify
from symobs.proof.derivation import CaseStep, Conclude
from symobs.proof.derivation.builder import Builder, predicate, relation, sentence
from symobs.proof.derivation.facts import on_stratum
from symobs.stability.criteria.stability import (
    is_beyond,
    is_marginal,
    marginal_where,
    meetings,
    monic,
    on_boundary,
    stability,
)
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import Condition, nonzero
from symobs.tasks.analysis.modes.modes import (
    ModeResult,
    at_eigenvalues,
    fixed_modes,
    meeting_steps,
    polynomial_of,
    show_hidden,
    show_spectrum,
    stable_modes,
    stack_of,
)
from symobs.tasks.analysis.page_parts import (
    as_written,
    given,
    hidden_polynomial,
    redefined_letters,
    say_stability,
    stratum_of,
    undecided,
)
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.analysis.strata.strata import distances, systems_of
from symobs.tasks.result import Case, Result, choose, method, page_of, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.tree.term import Term
    from symobs.proof.derivation import Step
    from symobs.system import StateSpace
    from symobs.system.specification import Name


MEANINGS = ("asymptotic", "lyapunov")


class Hidden(NamedTuple):
    """The verdict on the fixed modes, and its conditions."""

    verdict: str
    where: tuple[Condition, ...] = ()
    annuls: Scalar | None = None


@dataclass
class HiddenStability(ModeResult):
    """The modes, and whether the fixed ones are stable in the chosen meaning."""

    meaning: str

    @cached_property
    def hidden(self) -> Hidden:
        """The verdict on the fixed modes, the cases left aside."""
        f: Scalar = self.answer["fixed_polynomial"]
        plant = self.plant
        found = stability(f, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
        strict = tuple(Condition("existence", value, ">") for value in found.positive)
        if self.meaning == "asymptotic" or found.verdict == "yes":
            return Hidden(found.verdict, strict)
        return self._in_the_sense_of_lyapunov(f, found.verdict, strict)

    def _in_the_sense_of_lyapunov(self, f: Scalar, verdict: str, strict: tuple[Condition, ...]) -> Hidden:
        """Decide X: no root beyond the boundary, and those on it simple in a polynomial that annuls X."""
        plant, X = self.plant, self.test.answer["restricted"]
        variable, signs, discrete = plant.variable, plant.symbols.signs, plant.is_discrete
        if is_beyond(f, variable, signs, discrete=discrete):
            return Hidden("no")
        smaller = [
            monic(factor, variable) ** (power if _is_stable(factor, plant) else 1)
            for factor, power in f.numerator.factors()[1]
            if factor.degree(variable) > 0
        ]
        annuls = product_of(smaller)
        if is_marginal(annuls, variable, signs, discrete=discrete, apart=self.meetings):
            return Hidden("yes" if polynomial_of(annuls, variable, X).is_zero else "no", (), annuls)
        bounds = marginal_where(f, variable, signs, discrete=discrete)
        if bounds:
            return Hidden("conditional", tuple(Condition("existence", bound, ">=") for bound in bounds))
        return Hidden("conditional", strict) if verdict == "conditional" else Hidden("undecided")

    @cached_property
    def meetings(self) -> tuple[Scalar, ...]:
        """What vanishes where two fixed modes on the boundary meet, under the weaker reading: they may grow there."""
        plant = self.plant
        variable, signs, discrete = plant.variable, plant.symbols.signs, plant.is_discrete
        factors = [factor for factor, _ in self.answer["fixed_polynomial"].numerator.factors()[1]]
        marginal = [factor for factor in factors if on_boundary(factor, variable, signs, discrete=discrete)]
        return meetings(marginal, variable, signs) if self.meaning == "lyapunov" else ()

    @property
    def verdict(self) -> str:
        """That of the fixed modes where there are no cases, else what holds on all of them.

        A mode that grows in general is fixed on every stratum too: what is undecided there does not make it conditional.
        """
        verdicts = {self.hidden.verdict}
        verdicts |= {"undecided" if case.result is None else case.result.verdict for case in self.deciding_cases}
        if self.grows_where is None or (self._lost is None and self.hidden.verdict != "no"):
            return "undecided"
        if self.hidden.verdict == "no" and verdicts <= {"no", "undecided"} and not self._only_there:
            return "no"
        if len(verdicts) == 1:
            return verdicts.pop()
        return "undecided" if "undecided" in verdicts and not verdicts & {"no", "conditional"} else "conditional"

    @cached_property
    def rank_cases(self) -> tuple[Case, ...]:
        """The fixed modes on the strata where the rank test has others."""
        task_name, meaning, method_name = self.task, self.meaning, self.method
        return self.cases_by(lambda plant: solve(plant, task_name, meaning, method_name))

    @cached_property
    def meeting_cases(self) -> tuple[Case, ...]:
        """The modes where eigenvalues meet."""
        task_name, meaning, method_name = self.task, self.meaning, self.method
        further = [(value,) for value in self.meetings]
        return self.meetings_by(lambda plant: solve(plant, task_name, meaning, method_name), *further)

    @property
    def deciding_cases(self) -> tuple[Case, ...]:
        """The cases on which another verdict may hold.

        Where eigenvalues meet the fixed modes are the same, and only the weaker reading asks for their eigenvectors: a
        mode that grows in general may have as many as it should there, on strata that are told.
        """
        if self.hidden.annuls is None:
            return self.rank_cases
        return (*self.rank_cases, *(case for case in self.meeting_cases if case.when or self.hidden.verdict == "no"))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The cases of the rank test, where eigenvalues meet, and the boundary where the weaker reading leaves it open."""
        strict = [c.expression for c in self.hidden.where if c.operator == ">"]
        found = (*self.rank_cases, *self.meeting_cases)
        if self.meaning == "asymptotic" or not strict:
            return found
        return (*found, Case((Condition("existence", product_of(strict), "=="),), {}, None))

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, what makes the fixed modes stable, and the strata on which others are not."""
        if self.hidden.verdict == "no":
            return (*self.domain, *self._only_there)
        if self.hidden.verdict == "undecided" or self._lost is None:
            return self.domain
        listed = {c.expression for c in self.domain}
        lost = (value for value in distances(self._lost) if value not in listed)
        return (*self.domain, *self.hidden.where, *nonzero("existence", lost))

    @cached_property
    def _lost(self) -> tuple[tuple[Scalar, ...], ...] | None:
        """The equations of the strata on which another verdict may hold; None where it is not known which these are."""
        differing = [case for case in self.deciding_cases if case.result is None or case.result.verdict != "yes"]
        return systems_of(differing)

    @property
    def grows_where(self) -> tuple[Condition, ...] | None:
        """What keeps away from the strata on which a mode that grows in general, under the weaker reading, may not.

        None where it is not known which these are.
        """
        if self.hidden.annuls is None or self.hidden.verdict != "no":
            return ()
        systems = systems_of(self.meeting_cases)
        return None if systems is None else tuple(Condition("existence", value) for value in distances(systems))

    @property
    def _only_there(self) -> tuple[Condition, ...]:
        """What must vanish where fixed modes grow in general: some of these strata, where they do not."""
        kept = [case for case in self.meeting_cases if case.result is None or case.result.verdict != "no"]
        systems = systems_of(kept)
        if not self.grows_where or not systems:
            return ()
        return (Condition("existence", product_of(distances(systems)), "=="),)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The modes, the polynomial of the fixed ones, and where it is stable."""
        return {
            "meaning": self.meaning,
            "modes": self.modes_of(with_matrix=False),
            "fixed_polynomial": self.answer["fixed_polynomial"],
            "polynomial": self.answer["polynomial"],
            "rank": self.test.answer["rank"],
        }


def _is_stable(factor: Scalar, plant: StateSpace) -> bool:
    found = stability(factor, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    return found.verdict == "yes"


@dataclass
class Detectability(HiddenStability):
    """Detectability: stability of the unobservable modes."""

    task: ClassVar[str] = "detectability"
    letters = {"polynomial": "chi", "fixed_polynomial": "mu", "rank": "rank O"}
    panels = ("cases",)
    cards = ("rank", "polynomial", "fixed_polynomial")

    @property
    def kind(self) -> str:
        """The rank test below it."""
        return "observability"


@dataclass
class Stabilizability(HiddenStability):
    """Stabilizability: stability of the uncontrollable modes."""

    task: ClassVar[str] = "stabilizability"
    letters = {"polynomial": "chi", "fixed_polynomial": "mu", "rank": "rank Ctr"}
    panels = ("cases",)
    cards = ("rank", "polynomial", "fixed_polynomial")

    @property
    def kind(self) -> str:
        """The rank test below it."""
        return "controllability"


_KINDS = {"detectability": "observability", "stabilizability": "controllability"}


def solve(plant: StateSpace, task_name: str, meaning: str, method_name: str) -> HiddenStability:
    """Return the answer for a plant."""
    result = Detectability if task_name == "detectability" else Stabilizability
    return result(plant, method_name, ModeResult.answer_of(plant, _KINDS[task_name]), meaning)


def _checked(meaning: str) -> str:
    if meaning not in MEANINGS:
        message = f"{str(meaning)[:40]!r} is not a meaning of stability"
        raise InputError(message, where="specification.meaning", repair=f"write one of {', '.join(MEANINGS)}")
    return meaning


@method("detectability/fixed_modes", source="wonham1968; hautus1970; brogan1991")
def detectability_fixed_modes(plant: StateSpace, meaning: str) -> HiddenStability:
    """Stability of the characteristic polynomial of A on ker 𝒪, without eigenvalues."""
    return solve(plant, "detectability", meaning, "fixed_modes")


@method("stabilizability/fixed_modes", source="wonham1968; hautus1970; brogan1991")
def stabilizability_fixed_modes(plant: StateSpace, meaning: str) -> HiddenStability:
    """Stability of the characteristic polynomial of Aᵀ on the left kernel of 𝒞, without eigenvalues."""
    return solve(plant, "stabilizability", meaning, "fixed_modes")


@task
def detectability(plant: StateSpace, *, meaning: Name = "asymptotic", method: Name = "auto") -> Result:
    """Decide whether some L makes A − LC stable: whether all unobservable modes are stable.

    plant    n states, p ≥ 1 outputs; B and D do not matter
    meaning  "asymptotic", or "lyapunov": unobservable modes may lie on the boundary if they do not grow (Brogan)
    Returns modes (list of eigenvalue, stable, observable, rank, with multiplicity), fixed_polynomial; with parameters the
    conditions and cases.  Raises `InputError` where C is missing.  Source: W. M. Wonham (1968); M. L. J. Hautus (1970).
    """
    plant.require("C", task="detectability")
    return choose("detectability", method, "fixed_modes").solve(plant, _checked(meaning))


@task
def stabilizability(plant: StateSpace, *, meaning: Name = "asymptotic", method: Name = "auto") -> Result:
    """Decide whether some K makes A − BK stable: whether all uncontrollable modes are stable.

    plant    n states, m ≥ 1 inputs; C and D do not matter
    meaning  "asymptotic", or "lyapunov": uncontrollable modes may lie on the boundary if they do not grow
    Returns modes (list of eigenvalue, stable, controllable, rank, with multiplicity), fixed_polynomial; with parameters
    the conditions and cases.  Raises `InputError` where B is missing.  Source: W. M. Wonham (1968); M. L. J. Hautus (1970).
    """
    plant.require("B", task="stabilizability")
    return choose("stabilizability", method, "fixed_modes").solve(plant, _checked(meaning))


# The page of detectability and stabilizability.
#
# Without parameters it follows the definition: the rank of [A − λI; C] at the eigenvalues that are not stable. With
# parameters it goes through ker 𝒪 and the polynomial of the fixed modes.


@page_of(HiddenStability)
def write_page(page: Builder, result: HiddenStability) -> None:
    """Write the page."""
    given(page)
    with page.section(result.task):
        parametric = any(part.matrix.names - {EIGENVALUE} for part in result.spectrum)
        direct = all(part.witness is not None for part in result.spectrum)
        if parametric or result.meaning == "lyapunov" or not direct:
            _through_the_kernel(page, result)
        else:
            _at_eigenvalues(page, result)


def _time(page: Builder) -> str:
    return "discrete" if page.plant.is_discrete else "continuous"


def _at_eigenvalues(page: Builder, result: HiddenStability) -> None:
    """Look at the eigenvalues that are not stable, one by one."""
    plant = page.plant
    show_spectrum(page, result)
    page.conclude(f"asks_{result.task}_{_time(page)}")
    unstable = [
        part
        for part in result.spectrum
        if not all(stable_modes(part.roots, plant.symbols.signs, discrete=plant.is_discrete))
    ]
    if unstable:
        at_eigenvalues(page, result, unstable)
    else:
        page.conclude("only_stable", predicate("stable", page["chi"]))
    if result.test.answer["rank"] == plant.order:
        page.conclude(f"no_fixed_modes_{result.kind}")
        page.conclude(f"yes_{result.task}")
        return
    fixed_modes(page, result)
    _hidden_modes(page, result)


def _hidden_modes(page: Builder, result: HiddenStability) -> None:
    """Write the polynomial of the fixed modes and judge it."""
    about = hidden_polynomial(page)
    page.conclude_silently(relation(page["N"], result.test.answer["kernel"]))
    page.equal(relation(about, result.answer["fixed_polynomial"]), say="fixed_polynomial")
    _judge(page, result, about)


def _judge(page: Builder, result: HiddenStability, about: Term) -> None:
    """State whether the fixed modes, the roots of `about`, are stable in the chosen meaning."""
    plant, time = page.plant, _time(page)
    found = stability(
        result.answer["fixed_polynomial"], plant.variable, plant.symbols.signs, discrete=plant.is_discrete
    )
    if result.meaning == "lyapunov":
        page.remark("means_lyapunov")
    fact = predicate("stable" if found.verdict == "yes" else "unstable", about)
    if found.verdict == "yes":
        page.conclude(f"stable_{time}", fact)
    elif result.meaning == "lyapunov" and found.verdict == "no":
        _beyond_or_marginal(page, result, about)
        if result.hidden.verdict == "yes":
            fact = predicate("marginal", page["mu"])
        elif result.hidden.annuls is None:
            fact = predicate("beyond", about)
    elif found.verdict == "conditional":
        _where(page, result, about)
        return
    elif result.meaning == "asymptotic" and result.hidden.verdict == "no":
        page.conclude(f"never_{result.task}", fact)
        return
    else:
        page.conclude(f"unstable_{time}", fact)
    if result.hidden.verdict == "yes" or (result.hidden.verdict == "no" and result.grows_where == ()):
        page.conclude(f"{result.hidden.verdict}_{result.task}", fact)
    elif result.grows_where:
        page.conclude(f"grows_{result.task}")


def _where(page: Builder, result: HiddenStability, about: Term) -> None:
    """State exactly where the fixed modes are stable; in the weaker meaning also the undecided parameters."""
    signs, conditions = page.plant.symbols.signs, result.hidden.where
    if all(condition.operator == ">=" for condition in conditions):
        solved = [as_inequality(condition.expression, signs) for condition in conditions]
        where = tuple(relation(left, f"{operator}=", right) for left, operator, right in solved)
        page.conclude("marginal_if", where=HoldsExactlyWhere(predicate("marginal", about), where))
        page.conclude(f"exactly_there_{result.task}")
        return
    say_stability(page, about)
    page.conclude(f"exactly_there_{result.task}" if result.meaning == "asymptotic" else "boundary_undecided")


def _beyond_or_marginal(page: Builder, result: HiddenStability, about: Term) -> None:
    time, annuls = _time(page), result.hidden.annuls
    if annuls is None:
        if result.hidden.verdict == "no":
            page.conclude(f"beyond_{time}", predicate("beyond", about))
        else:
            page.remark("lyapunov_undecided")
        return
    mu = page.set("mu", annuls)
    zero = page.value(result.test.answer["restricted"] * 0)
    image = page["mu_at(X)"]
    if result.hidden.verdict == "yes":
        if result.meetings:
            page.assume("apart_provided", *result.meetings)
        page.conclude(f"marginal_{time}", predicate("marginal", mu))
        page.conclude("semisimple", relation(image, zero), polynomial=relation(mu, annuls))
        return
    grows = relation(image, "!=", zero)
    words = Conclude(sentence("grows", {"polynomial": relation(mu, annuls)}), (grows,))
    apart = [as_written(condition) for condition in result.grows_where or ()]
    if result.grows_where is not None and verify(grows, page.environment)[0]:
        page.steps.append(words)
    elif apart and verify(grows, on_stratum(Conjunction(tuple(apart)), {}, page.environment))[0]:
        page.steps.append(CaseStep(Conjunction(tuple(apart)), (), (words,)))
    else:
        page.remark("lyapunov_undecided")


# -- through the kernel ------------------------------------------------------------------------------------------------


def _through_the_kernel(page: Builder, result: HiddenStability) -> None:
    """Find the hidden modes as those of A on ker 𝒪, which needs no eigenvalue."""
    page.conclude(f"means_{result.task}")
    observing = result.kind == "observability"
    letter, say = ("O", "observability_matrix") if observing else ("Ctr", "controllability_matrix")
    page.define(letter, stack_of(page, result.kind), say=say)
    square_test(page, letter, result.test, result.kind)
    _generic(page, result)
    _cases(page, letter, result)


def _generic(page: Builder, result: HiddenStability) -> None:
    hidden_ones = result.plant.order - result.test.answer["rank"]
    if not hidden_ones:
        page.conclude(f"seen_{result.task}")
        return
    if "N" not in page.environment.values:  # the rank test has another letter for what the input does not move
        page.set("N", result.test.answer["kernel"])
        page.set("X", result.test.answer["restricted"])
    show_hidden(page, result, "on_kernel")
    _hidden_modes(page, result)


def _cases(page: Builder, letter: str, result: HiddenStability) -> None:
    """Write the hidden modes and their stability on every stratum, and the ranks at repeated eigenvalues."""
    weaker = result.meaning == "lyapunov"
    for case in (*result.rank_cases, *(result.meeting_cases if weaker else ())):
        page.steps.append(undecided(page, case) if case.result is None else _case(page, letter, case))
    if not weaker:
        page.steps += meeting_steps(page, result)


def _case(page: Builder, letter: str, case: Case) -> Step:
    found: Any = case.result
    inner = Builder(found.plant)
    values = {name: getattr(found.plant.matrices, name) for name in "ABC" if name in page.environment.values}
    inner.environment = page.environment.extended_by(values=values)
    test = found.test.answer
    inner.conclude("case_rank", rank=relation(inner[letter].apply("rank"), test["rank"]))
    if test["kernel"].shape[1]:
        inner.set("N", test["kernel"])
        inner.set("X", test["restricted"])
    _generic(inner, found)
    _cases(inner, letter, found)
    anew = redefined_letters(page.environment, inner.environment)
    return CaseStep(stratum_of(case), tuple(case.substitution.items()), tuple(inner.steps), anew=anew)
