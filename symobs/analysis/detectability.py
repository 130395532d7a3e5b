"""Detectability and stabilizability: whether the modes that stay hidden are stable.

(C, A) is detectable exactly when the polynomial of the fixed modes, det(sI − X) with X = A on ker 𝒪, is stable; (A, B)
is stabilizable exactly when (Bᵀ, Aᵀ) is detectable.  Under the weaker reading of S3 (Brogan) a fixed mode may lie on the
boundary, if it does not grow: X must be stable in the sense of Lyapunov.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from symobs.analysis.detectability_page import write_page
from symobs.analysis.modes import ModeResult, polynomial_of
from symobs.conditions import Condition
from symobs.errors import InputError
from symobs.exact import Scalar, product_of
from symobs.method import Case, Result, choose, method, task
from symobs.record import dataclass
from symobs.stability import is_beyond, is_marginal, marginal_where, monic, stability

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.page import Page
    from symobs.specification import Name
    from symobs.system import StateSpace

MEANINGS = ("asymptotic", "lyapunov")


class Hidden(NamedTuple):
    """What is known of the fixed modes: the verdict, and what must hold where it is conditional."""

    verdict: str
    where: tuple[Condition, ...] = ()
    annuls: Scalar | None = None


@dataclass(frozen=True, eq=False, repr=False)
class HiddenStability(ModeResult):
    """The modes, and whether the fixed ones are stable in the meaning asked for."""

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
        if is_marginal(annuls, variable, signs, discrete=discrete):
            return Hidden("yes" if polynomial_of(annuls, variable, X).is_zero else "no", (), annuls)
        bounds = marginal_where(f, variable, signs, discrete=discrete)
        if bounds:
            return Hidden("conditional", tuple(Condition("existence", bound, ">=") for bound in bounds))
        return Hidden("conditional", strict) if verdict == "conditional" else Hidden("undecided")

    @property
    def verdict(self) -> str:
        """That of the fixed modes where there are no cases, else what holds on all of them."""
        verdicts = {self.hidden.verdict}
        verdicts |= {"undecided" if case.result is None else case.result.verdict for case in self.case_tree}
        if len(verdicts) == 1:
            return verdicts.pop()
        return "undecided" if "undecided" in verdicts and not verdicts & {"no", "conditional"} else "conditional"

    @cached_property
    def rank_cases(self) -> tuple[Case, ...]:
        """The fixed modes on the strata where the rank test has others."""
        task_name, meaning, method_name = self.task, self.meaning, self.method
        return self.cases_by(lambda plant: solve(plant, task_name, meaning, method_name))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The cases of the rank test, and the boundary where the weaker reading leaves it open."""
        strict = [c.expression for c in self.hidden.where if c.operator == ">"]
        if self.meaning == "asymptotic" or not strict:
            return self.rank_cases
        return (*self.rank_cases, Case((Condition("existence", product_of(strict), "=="),), {}, None))

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, what makes the fixed modes stable, and the strata on which others are not."""
        if self.hidden.verdict not in {"yes", "conditional"}:
            return self.domain
        lost = dict.fromkeys(
            case.when[0].expression for case in self.rank_cases if case.result is None or case.result.verdict != "yes"
        )
        listed = {c.expression for c in self.domain}
        others = (Condition("existence", expression) for expression in lost if expression not in listed)
        return (*self.domain, *self.hidden.where, *others)

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

    def write(self, page: Page) -> None:
        """Write the test at the eigenvalues that are not stable, or with parameters the hidden modes."""
        write_page(page, self)


def _is_stable(factor: Scalar, plant: StateSpace) -> bool:
    found = stability(factor, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    return found.verdict == "yes"


@dataclass(frozen=True, eq=False, repr=False)
class Detectability(HiddenStability):
    """Whether the unobservable modes are stable."""

    task: ClassVar[str] = "detectability"

    @property
    def kind(self) -> str:
        """The rank test below it."""
        return "observability"


@dataclass(frozen=True, eq=False, repr=False)
class Stabilizability(HiddenStability):
    """Whether the uncontrollable modes are stable."""

    task: ClassVar[str] = "stabilizability"

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


@method("detectability/fixed_modes", source="S0, section 4.4; S3, footnote 1")
def detectability_fixed_modes(plant: StateSpace, meaning: str) -> HiddenStability:
    """Stability of the characteristic polynomial of A on ker 𝒪, without eigenvalues."""
    return solve(plant, "detectability", meaning, "fixed_modes")


@method("stabilizability/fixed_modes", source="dual of S0, section 4.4")
def stabilizability_fixed_modes(plant: StateSpace, meaning: str) -> HiddenStability:
    """Stability of the characteristic polynomial of Aᵀ on the left kernel of 𝒞, without eigenvalues."""
    return solve(plant, "stabilizability", meaning, "fixed_modes")


@task
def detectability(plant: StateSpace, *, meaning: Name = "asymptotic", method: Name = "auto") -> Result:
    """Decide whether some L makes A − LC stable: whether all unobservable modes are stable.

    plant    n states, p ≥ 1 outputs; B and D do not matter
    meaning  "asymptotic", or "lyapunov": unobservable modes may lie on the boundary if they do not grow (S3, footnote 1)
    Returns modes (list of eigenvalue, stable, observable, rank, with multiplicity), fixed_polynomial; with parameters the
    conditions and cases.  Raises `InputError` where C is missing.  Source: S0, section 4.4.
    """
    plant.require("C", task="detectability")
    return choose("detectability", method, "fixed_modes").solve(plant, _checked(meaning))


@task
def stabilizability(plant: StateSpace, *, meaning: Name = "asymptotic", method: Name = "auto") -> Result:
    """Decide whether some K makes A − BK stable: whether all uncontrollable modes are stable.

    plant    n states, m ≥ 1 inputs; C and D do not matter
    meaning  "asymptotic", or "lyapunov": uncontrollable modes may lie on the boundary if they do not grow
    Returns modes (list of eigenvalue, stable, controllable, rank, with multiplicity), fixed_polynomial; with parameters
    the conditions and cases.  Raises `InputError` where B is missing.  Source: S0, section 4.4, by duality.
    """
    plant.require("B", task="stabilizability")
    return choose("stabilizability", method, "fixed_modes").solve(plant, _checked(meaning))
