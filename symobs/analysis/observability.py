"""Observability and its dual: the matrix, its rank with the exact exceptions, the kernel, the hidden modes.

(C, A) is observable exactly when 𝒪 = [C; CA; …; CAⁿ⁻¹] has rank n; (A, B) is controllable exactly when (Bᵀ, Aᵀ) is
observable.  With parameters the rank is the generic one, and every stratum where it drops is a case.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.analysis.pages import given, rank_cases, square_test
from symobs.analysis.strata import strata
from symobs.certificate import Claim
from symobs.conditions import Condition, vanishing_factors
from symobs.exact import Matrix, Root, Scalar, echelon, independent_rows, roots_of
from symobs.formula import Environment, Literal
from symobs.formula.term import Term, block, letter
from symobs.method import Case, Result, choose, method, task
from symobs.page import Page, relation

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.specification import Name
    from symobs.system import StateSpace


def power_rows(A: Matrix, C: Matrix) -> Matrix:
    """Return [C; CA; …; CAⁿ⁻¹]."""
    rows = [C]
    for _ in range(A.shape[0] - 1):
        rows.append(rows[-1] @ A)
    return Matrix.block([[row] for row in rows]).normal()


def rank_answer(A: Matrix, C: Matrix) -> dict[str, Any]:
    """Return the observability test of a pair: matrix, rank r, kernel basis N, and the witnesses.

    Witnesses: rows and columns of an r×r minor, rows of a minor of N, and X with A N = N X.
    """
    O = power_rows(A, C)
    columns, vectors = echelon(O)
    order, count = A.shape[0], len(vectors)
    N = Matrix.of([[v[i, 0] for v in vectors] for i in range(order)], count)
    free = independent_rows(N)
    X = N.select(free, range(count)).solve((A @ N).select(free, range(count))) if count else Matrix.zeros(0, 0)
    return {
        "matrix": O,
        "rank": len(columns),
        "kernel": N,
        "restricted": X.normal(),
        "rows": independent_rows(O.select(range(O.shape[0]), columns)),
        "columns": columns,
        "free": free,
    }


@dataclass(frozen=True, eq=False, repr=False)
class RankResult(Result):
    """The test matrix M of a pair, its rank r, and a basis N of its kernel.

    Claims: the blocks of M follow each other by A; M N = 0; an r×r minor of M and a minor of N are not zero; A N = N X.
    """

    @classmethod
    def of(cls, plant: StateSpace, method_name: str) -> Self:
        """Return the result for a plant."""
        return cls(plant, method_name, rank_answer(*cls.pair(plant)))

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (A, C) of the observability test that decides."""
        raise NotImplementedError

    def claims(self) -> Iterator[Claim]:
        """Yield structure, rank from below, kernel and rank from above, invariance."""
        A, C = self.pair(self.plant)
        O, N, outputs = self.answer["matrix"], self.answer["kernel"], C.shape[0]
        every, states = range(O.shape[0]), range(self.plant.order)
        values = {
            "A": A,
            "C": C,
            "O": O,
            "N": N,
            "X": self.answer["restricted"],
            "upper": Matrix.block([[C], [O.select(every[:-outputs], states) @ A]]),
        }
        e = Environment(variable=self.plant.variable, values=values)
        yield Claim(relation(letter("O", e), letter("upper", e)), e, "the blocks are C, C*A, ..., C*A**(n - 1)")
        found, hidden = self.answer["rank"], self.plant.order - self.answer["rank"]
        witnesses = len(self.answer["rows"]), len(self.answer["columns"])
        yield Claim(relation(found, *witnesses), e, "the minor has the order of the rank")
        beside = N.shape[1], len(self.answer["free"]), *self.answer["restricted"].shape
        yield Claim(relation(hidden, *beside), e, "the kernel has the dimension n - rank")
        if found:
            minor = O.select(self.answer["rows"], self.answer["columns"])
            yield Claim(relation(_det(minor, e), "!==", 0), e, f"a minor of order {self.answer['rank']} is not zero")
        if N.shape[1]:
            count = range(N.shape[1])
            yield Claim(relation(letter("O", e) @ letter("N", e), Matrix.zeros(O.shape[0], len(count))), e, "M*N = 0")
            yield Claim(relation(_det(N.select(self.answer["free"], count), e), "!==", 0), e, "rank N = n - rank M")
            yield Claim(relation(letter("A", e) @ letter("N", e), letter("N", e) @ letter("X", e)), e, "A*N = N*X")

    @cached_property
    def test_determinant(self) -> Scalar | None:
        """The determinant of a square test matrix, None otherwise."""
        matrix: Matrix = self.answer["matrix"]
        return matrix.determinant() if matrix.shape[0] == matrix.shape[1] else None

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What vanishes wherever the rank is below the generic one: the determinant, or a minor of that order."""
        if self.test_determinant:
            return (self.test_determinant,)
        minor = self.answer["matrix"].select(self.answer["rows"], self.answer["columns"])
        return (minor.determinant(),) if minor.shape[0] else ()

    @property
    def verdict(self) -> str:
        """`no` where the rank is below n everywhere, else whether it can drop."""
        if self.answer["rank"] < self.plant.order:
            return "no"
        if self.test_determinant is None:
            return self._verdict_of_strata
        return "conditional" if self._binding_conditions else "yes"

    @property
    def _verdict_of_strata(self) -> str:
        """Whether a matrix that is not square loses its rank somewhere: asked stratum by stratum of one minor."""
        verdicts = {"undecided" if case.result is None else case.result.verdict for case in self.case_tree}
        if verdicts <= {"yes"}:
            return "yes"
        return "undecided" if "undecided" in verdicts and not verdicts & {"no", "conditional"} else "conditional"

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, and the factors on whose vanishing the rank falls below n."""
        factors = vanishing_factors(self.existence, self.plant.symbols.signs)
        if self.answer["rank"] < self.plant.order:
            factors = ()
        elif self.test_determinant is None:
            lost = [c.when[0].expression for c in self.case_tree if c.result is not None and c.result.verdict == "no"]
            factors = tuple(f for f in factors if f in lost)
        listed = {c.expression for c in self.domain}
        return (*self.domain, *(Condition("existence", f) for f in factors if f not in listed))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """Rank and kernel on every stratum where they are not the generic ones."""
        found = strata(self.plant, self.existence, lambda plant, _: type(self).of(plant, self.method))
        return tuple(case for case in found if case.result is None or _other(case.result, self))

    @cached_property
    def modes(self) -> tuple[Root, ...]:
        """The eigenvalues of A on the kernel."""
        restricted: Matrix = self.answer["restricted"]
        if not restricted.shape[0]:
            return ()
        return roots_of(restricted.characteristic_polynomial(self.plant.variable), self.plant.variable)

    @property
    def kernel_vectors(self) -> tuple[Matrix, ...]:
        """The basis of the kernel, vector by vector."""
        N: Matrix = self.answer["kernel"]
        return tuple(N.select(range(N.shape[0]), [j]) for j in range(N.shape[1]))


@dataclass(frozen=True, eq=False, repr=False)
class Observability(RankResult):
    """𝒪, its rank, ker 𝒪 and the unobservable modes."""

    task: ClassVar[str] = "observability"

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (A, C)."""
        return plant.matrices.A, plant.matrices.C

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Matrix, rank, kernel and modes."""
        return {
            "matrix": self.answer["matrix"],
            "rank": self.answer["rank"],
            "kernel": [list(v.entries) for v in self.kernel_vectors],
            "unobservable_modes": self.modes,
            "determinant": self.test_determinant,
        }

    def write(self, page: Page) -> None:
        """Build 𝒪 block by block and read off the rank."""
        given(page)
        with page.section("observability"):
            rows, C, A = [[page["C"]]], page["C"], page["A"]
            rows += [[C @ A**k] for k in range(1, self.plant.order)]
            page.define("O", block(rows), say="observability_matrix")
            square_test(page, "O", self, "observability")
            rank_cases(page, "O", self, "observability")


@dataclass(frozen=True, eq=False, repr=False)
class Controllability(RankResult):
    """𝒞, its rank and the uncontrollable modes."""

    task: ClassVar[str] = "controllability"

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (Aᵀ, Bᵀ)."""
        return plant.matrices.A.T, plant.matrices.B.T

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Matrix, rank and modes; `kernel` holds the left null vectors."""
        return {
            "matrix": self.answer["matrix"].T,
            "rank": self.answer["rank"],
            "kernel": [list(v.entries) for v in self.kernel_vectors],
            "uncontrollable_modes": self.modes,
            "determinant": self.test_determinant,
        }

    def write(self, page: Page) -> None:
        """Build 𝒞 block by block and read off the rank."""
        given(page)
        with page.section("controllability"):
            columns, B, A = [page["B"]], page["B"], page["A"]
            columns += [A**k @ B for k in range(1, self.plant.order)]
            page.define("Ctr", block([columns]), say="controllability_matrix")
            square_test(page, "Ctr", self, "controllability")
            rank_cases(page, "Ctr", self, "controllability")


def _other(found: Result, generic: RankResult) -> bool:
    """Whether a stratum's rank differs from the generic one, there or further down."""
    return found.answer["rank"] != generic.answer["rank"] or bool(found.case_tree)


def _det(matrix: Matrix, environment: Environment) -> Term:
    return Term(Literal(matrix), environment).apply("det")


@method("observability/rank", source="algebraic test for observability, Theorem 4.2 of S0")
def observability_rank(plant: StateSpace) -> Observability:
    """Form 𝒪 = [C; CA; …; CAⁿ⁻¹] and its rank by fraction-free elimination."""
    return Observability.of(plant, "rank")


@method("controllability/rank", source="dual of Theorem 4.2 of S0")
def controllability_rank(plant: StateSpace) -> Controllability:
    """Form 𝒞 = [B, AB, …, Aⁿ⁻¹B] and its rank by fraction-free elimination."""
    return Controllability.of(plant, "rank")


@task
def observability(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Decide whether (C, A) is observable: rank [C; CA; …; CAⁿ⁻¹] = n.

    plant    n states, p ≥ 1 outputs; B and D do not matter
    Returns matrix (pn×n), rank, kernel (basis of ker 𝒪), unobservable_modes; with parameters the generic rank, and
    one case for each factor of det 𝒪 that can vanish.  Raises `InputError` where C is missing.
    Source: S0, Theorem 4.2 and (4.12)-(4.15).
    """
    plant.require("C", task="observability")
    return choose("observability", method, "rank").solve(plant)


@task
def controllability(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Decide whether (A, B) is controllable: rank [B, AB, …, Aⁿ⁻¹B] = n.

    plant    n states, m ≥ 1 inputs; C and D do not matter
    Returns matrix (n×nm), rank, uncontrollable_modes; with parameters the generic rank, and one case for each factor of
    det 𝒞 that can vanish.  Raises `InputError` where B is missing.
    Source: S0, Theorem 4.1 (duality) with Theorem 4.2.
    """
    plant.require("B", task="controllability")
    return choose("controllability", method, "rank").solve(plant)
