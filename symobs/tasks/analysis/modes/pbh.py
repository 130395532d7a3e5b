"""The test of Popov, Belevitch and Hautus: the rank of [A − λI; C], or of [A − λI, B], at every eigenvalue of A."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import roots_of
from symobs.formula.tree import Roots
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation.builder import Builder
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.wording_check import meets_obligations
from symobs.tasks.analysis.modes.modes import (
    TESTS,
    ModeResult,
    at_eigenvalues,
    eigenvectors_there,
    fixed_modes,
    has_open_cases,
    meeting_steps,
    show_spectrum,
    stack_of,
)
from symobs.tasks.analysis.page_parts import given, hidden_polynomial
from symobs.tasks.analysis.rank.rank_page import rank_cases, square_test
from symobs.tasks.result import Case, Result, choose, method, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace
    from symobs.system.conditions import Condition
    from symobs.system.specification import Name


@dataclass
class PopovBelevitchHautus(ModeResult):
    """The rank of the pencil at every eigenvalue; with parameters the generic one, with the cases of the rank test."""

    of: str

    task: ClassVar[str] = "pbh"
    letters = {"polynomial": "chi", "fixed_polynomial": "mu"}
    panels = ("cases",)

    @property
    def kind(self) -> str:
        """What is asked of the pair."""
        return self.of

    @property
    def verdict(self) -> str:
        """That of the rank test, whose ranks these explain."""
        return self.test.verdict

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """Where the pair is what it is in general."""
        return self.test.holds_where

    @property
    def existence(self) -> tuple[Any, ...]:
        """What vanishes wherever a rank is below the generic one."""
        return self.test.existence

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The ranks on every stratum where one of them is not the generic one."""
        return (*self.rank_cases, *self.meeting_cases)

    @cached_property
    def rank_cases(self) -> tuple[Case, ...]:
        """The ranks on the strata of the rank test."""
        return self.cases_by(lambda plant: solve(plant, self.of, self.method))

    @cached_property
    def meeting_cases(self) -> tuple[Case, ...]:
        """The ranks where eigenvalues meet."""
        return self.meetings_by(lambda plant: solve(plant, self.of, self.method))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The modes, each with its matrix and rank, and the polynomial of the fixed ones."""
        return {
            "of": self.of,
            "modes": self.modes_of(with_matrix=True),
            "fixed_polynomial": self.answer["fixed_polynomial"],
            "polynomial": self.answer["polynomial"],
        }

    def write(self, page: Builder) -> None:
        """Write the eigenvalues, one matrix and one rank for each, and what follows."""
        given(page)
        with page.section("pbh"):
            show_spectrum(page, self)
            page.conclude(f"pbh_asks_{self.kind}")
            is_whole = at_eigenvalues(page, self, self.spectrum)
            stack = stack_of(page, self.kind)
            if has_open_cases(self.test):
                if is_whole and self._write_by_eigenvectors(page):
                    return
                page.remark("pbh_general")
                letter = "O" if self.kind == "observability" else "Ctr"
                say = "observability_matrix" if letter == "O" else "controllability_matrix"
                page.define(letter, stack, say=say)
                square_test(page, letter, self.test, self.kind)
                rank_cases(page, letter, self.test, self.kind)
                page.steps += meeting_steps(page, self)
                return
            rank, order = self.test.answer["rank"], self.plant.order
            if rank == order:
                page.conclude(f"pbh_yes_{self.kind}")
                return
            page.conclude(f"pbh_no_{self.kind}")
            fixed_modes(page, self)
            whole = hidden_polynomial(page)
            roots = roots_of(self.answer["fixed_polynomial"], self.plant.variable)
            page.conclude(f"modes_{self.kind}", modes=Roots(whole.formula, roots))
            page.steps += meeting_steps(page, self)

    def _write_by_eigenvectors(self, page: Builder) -> bool:
        """Write where the pair is observable, and the eigenvectors elsewhere; return False where these are not known."""
        if self.test.answer["rank"] < self.plant.order or any(case.result is None for case in self.rank_cases):
            return False
        at_conditions = Builder(self.plant)
        at_conditions.environment = page.environment
        at_conditions.assume("pbh_provided", *(c.expression for c in self.holds_where if c.kind == "existence"))
        if not meets_obligations(f"pbh_yes_{self.kind}", SentenceContext((), at_conditions.environment)):
            return False
        cases = [eigenvectors_there(page, case, closing=f"pbh_no_{self.kind}") for case in self.rank_cases]
        if not all(is_whole for _, is_whole in cases):
            return False
        page.steps += at_conditions.steps
        page.environment = at_conditions.environment
        page.conclude(f"pbh_yes_{self.kind}")
        page.steps += [*(step for step, _ in cases), *meeting_steps(page, self)]
        return True


def solve(plant: StateSpace, of: str, method_name: str) -> PopovBelevitchHautus:
    """Return the test of a plant."""
    return PopovBelevitchHautus(plant, method_name, ModeResult.answer_of(plant, of), of)


@method("pbh/eigenvalues", source="popov1973; belevitch1968; hautus1969; kailath1980, ch. 2")
def pbh_eigenvalues(plant: StateSpace, of: str) -> PopovBelevitchHautus:
    """Factor det(sI − A); at each factor q the rank of the pencil is computed in Q(parameters)[λ]/(q)."""
    return solve(plant, of, "eigenvalues")


@task
def pbh(plant: StateSpace, *, of: Name = "auto", method: Name = "auto") -> Result:
    """Test observability (or controllability) eigenvalue by eigenvalue: rank [A − λI; C] = n for all λ.

    plant    n states; p ≥ 1 outputs for `of` = "observability", m ≥ 1 inputs for "controllability"; without `of` it is
             observability, or controllability of a plant with B and without C
    Returns modes (list of eigenvalue, stable, observable or controllable, rank, matrix, with multiplicity),
    fixed_polynomial, polynomial.  Eigenvalues without closed form are handled through their irreducible factor.
    Raises `InputError` where a matrix is missing or `of` is another name.

    Source: M. L. J. Hautus (1969); T. Kailath, Linear Systems, ch. 2.
    """
    of = plant.pair_asked_for(of)
    if of not in TESTS:
        message = f"{str(of)[:40]!r} is not what the test can be asked of"
        raise InputError(message, where="specification.of", repair=f"write one of {', '.join(TESTS)}")
    plant.require("C" if of == "observability" else "B", task="pbh")
    return choose("pbh", method, "eigenvalues").solve(plant, of)
