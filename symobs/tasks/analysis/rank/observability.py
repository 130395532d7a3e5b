"""Observability and its dual: the matrix, its rank with the exact exceptions, the kernel, the hidden modes.

(C, A) is observable exactly when 𝒪 = [C; CA; …; CAⁿ⁻¹] has rank n; (A, B) is controllable exactly when (Bᵀ, Aᵀ) is
observable.  With parameters the rank is the generic one, and every stratum where it drops is a case.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.ground.dataclass import dataclass
from symobs.tasks.analysis.rank.rank_page import given_here, rank_cases, write_test
from symobs.tasks.analysis.rank.rank_test import RankResult, listed, power_rows, rank_answer
from symobs.tasks.result import Result, choose, method, task

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Matrix
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Name

__all__ = [
    "Controllability",
    "Observability",
    "RankResult",
    "controllability",
    "observability",
    "power_rows",
    "rank_answer",
]


@dataclass
class Observability(RankResult):
    """𝒪, its rank, ker 𝒪 and the unobservable modes."""

    task: ClassVar[str] = "observability"
    answered_by = ("rank",)
    only_value = ("rank",)
    letters = {"matrix": "O", "rank": "rank O", "determinant": "det O", "kernel": "N"}
    panels = ("cases",)
    repaired_by: ClassVar[str] = "measured"

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (A, C)."""
        return plant.matrices.A, plant.matrices.C

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Matrix, rank, kernel, modes, and the smallest sets of states (from 1) that would have to be measured too."""
        return {
            "matrix": self.answer["matrix"],
            "rank": self.answer["rank"],
            "kernel": [list(v.entries) for v in self.kernel_vectors],
            "unobservable_modes": self.modes,
            "determinant": self.test_determinant,
            "missing_measurements": listed(self._repair[0]),
        }

    def write(self, page: Builder) -> None:
        """Build 𝒪 block by block and read off the rank."""
        given_here(page, self)
        with page.section("observability"):
            write_test(page, "O", self, "observability")
            rank_cases(page, "O", self, "observability")


@dataclass
class Controllability(RankResult):
    """𝒞, its rank and the uncontrollable modes."""

    task: ClassVar[str] = "controllability"
    answered_by = ("rank",)
    only_value = ("rank",)
    letters = {
        "matrix": "Ctr",
        "rank": "rank Ctr",
        "determinant": "det Ctr",
        "kernel": "N_K",
    }
    panels = ("cases",)
    repaired_by: ClassVar[str] = "actuated"

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (Aᵀ, Bᵀ)."""
        return plant.matrices.A.T, plant.matrices.B.T

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Matrix, rank, modes, and the smallest sets of states that would have to be actuated too.

        `kernel` holds the left null vectors.
        """
        return {
            "matrix": self.answer["matrix"].T,
            "rank": self.answer["rank"],
            "kernel": [list(v.entries) for v in self.kernel_vectors],
            "uncontrollable_modes": self.modes,
            "determinant": self.test_determinant,
            "missing_inputs": listed(self._repair[0]),
        }

    def write(self, page: Builder) -> None:
        """Build 𝒞 block by block and read off the rank."""
        given_here(page, self)
        with page.section("controllability"):
            write_test(page, "Ctr", self, "controllability")
            rank_cases(page, "Ctr", self, "controllability")


@method("observability/rank", source="kalman1960; kalman1963a")
def observability_rank(plant: StateSpace) -> Observability:
    """Form 𝒪 = [C; CA; …; CAⁿ⁻¹] and its rank by fraction-free elimination."""
    return Observability.of(plant, "rank")


@method("controllability/rank", source="kalman1960; kalman1963a")
def controllability_rank(plant: StateSpace) -> Controllability:
    """Form 𝒞 = [B, AB, …, Aⁿ⁻¹B] and its rank by fraction-free elimination."""
    return Controllability.of(plant, "rank")


@task
def observability(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Decide whether (C, A) is observable: rank [C; CA; …; CAⁿ⁻¹] = n.

    plant    n states, p ≥ 1 outputs; B and D do not matter
    Returns matrix (pn×n), rank, kernel (basis of ker 𝒪), unobservable_modes, missing_measurements (the smallest sets
    of states, counted from 1, whose measurement makes it observable); with parameters the generic rank.  The cases are
    all the strata where rank or kernel differ, each with its rank and kernel at every one of its points; no point lies
    in two cases of different rank.  `conditions` hold exactly where the rank is n: a factor of det 𝒪, or for a drop on
    several equations at once (a = b = 0) the sum of their squares, since parameters are real.  Raises `InputError`
    where C is missing.
    Source: R. E. Kalman (1960, 1963).
    """
    plant.require("C", task="observability")
    return choose("observability", method, "rank").solve(plant)


@task
def controllability(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Decide whether (A, B) is controllable: rank [B, AB, …, Aⁿ⁻¹B] = n.

    plant    n states, m ≥ 1 inputs; C and D do not matter
    Returns matrix (n×nm), rank, uncontrollable_modes, missing_inputs (the smallest sets of states that would have to be
    actuated); with parameters the generic rank, and cases and conditions as for `observability`.  Raises `InputError`
    where B is missing.
    Source: R. E. Kalman, Y. C. Ho and K. S. Narendra (1963).
    """
    plant.require("B", task="controllability")
    return choose("controllability", method, "rank").solve(plant)
