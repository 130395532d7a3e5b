"""The dual plant: (Aᵀ, Cᵀ, Bᵀ, Dᵀ), or with time reversed (−Aᵀ, Cᵀ, Bᵀ, Dᵀ).

The controllability matrix of the dual is 𝒪ᵀ, or with −Aᵀ the same block by block up to sign: (−Aᵀ)ᵏ Cᵀ = (−1)ᵏ (C Aᵏ)ᵀ.
So its rank is that of 𝒪.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment
from symobs.formula.tree.written import stacked
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.tasks.analysis.modes.modes import TESTS
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.strata.strata import carried
from symobs.tasks.result import Case, Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Name, Sign
    from symobs.tasks.analysis.rank.observability import RankResult

#: Which rank test of the dual belongs to which of the plant.
_OTHER = {"observability": "controllability", "controllability": "observability"}
_PART = {"observability": "C", "controllability": "B"}


@dataclass
class Dual(Result):
    """The dual plant, and the ranks of both tests, of the plant and of the dual.

    Claims: each matrix of the dual is the transpose of its partner (of −A); the blocks of 𝒞 of the dual are those of 𝒪ᵀ
    up to sign, and conversely.  The ranks themselves are those of rank tests with claims of their own.
    """

    sign: int

    task: ClassVar[str] = "dual"
    answered_by = ("A", "B", "C")
    only_value = ("A", "B", "C")
    letters = {"A": "A_dual", "B": "B_dual", "C": "C_dual", "D": "D_dual"}

    def claims(self) -> Iterator[Claim]:
        """Yield the transpositions, the equality of the test matrices up to signs, the ranks."""
        m, answer = self.plant.matrices, self.answer
        values = {"A": m.A, "A_dual": answer["A"]}
        values |= {"B": m.B, "C_dual": answer["C"]} if m.has_input else {}
        values |= {"C": m.C, "B_dual": answer["B"]} if m.has_output else {}
        values |= {"D": m.D, "D_dual": answer["D"]} if m.has_input and m.has_output else {}
        e = Environment(variable=self.plant.variable, values=values)
        yield holds(e, f"A_dual = {self.image}")
        for left, right in (("B_dual", "C"), ("C_dual", "B"), ("D_dual", "D")):
            if left in values:
                yield holds(e, f"{left} = {right}.T")
        for kind, test in self.tests.items():
            inner = Environment(variable=e.variable, values={"M": test.answer["matrix"], "N": self._dual_matrix(kind)})
            yield holds(inner, "N = M.T {signs}", f"dual of {kind}", signs=self._signs(kind))
            ranks = answer[f"{kind}_rank"], answer[f"dual_{_OTHER[kind]}_rank"], test.answer["rank"]
            yield holds(inner, "{} = {} = {}".format(*ranks), f"both ranks of {kind}")

    @property
    def image(self) -> str:
        """What the dual has in place of A."""
        return "A.T" if self.sign > 0 else "-A.T"

    def _dual_matrix(self, kind: str) -> Matrix:
        """Return [B, AB, …] of the dual, or the transpose of its [C; CA; …]."""
        A = self.answer["A"] if kind == "observability" else self.answer["A"].T
        column = self.answer["B"] if kind == "observability" else self.answer["C"].T
        columns = [column]
        for _ in range(self.plant.order - 1):
            columns.append(A @ columns[-1])
        return Matrix.block([columns])

    def _signs(self, kind: str) -> Matrix:
        """Return diag(I, ±I, I, …), the blocks as wide as there are outputs, or inputs."""
        width = self.plant.outputs if kind == "observability" else self.plant.inputs
        total = width * self.plant.order
        return Matrix.of([[self.sign ** (i // width) * int(i == j) for j in range(total)] for i in range(total)], total)

    @cached_property
    def tests(self) -> dict[str, RankResult]:
        """The rank tests that the plant's matrices allow."""
        m = self.plant.matrices
        given_parts = {"observability": m.has_output, "controllability": m.has_input}
        return {kind: TESTS[kind].of(self.plant, "rank") for kind, there in given_parts.items() if there}

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of this result and of the rank tests below it."""
        return (*self.certificates, *(c for test in self.tests.values() for c in test.certificates))

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What vanishes wherever one of the ranks is below the generic one."""
        return tuple(value for test in self.tests.values() for value in test.existence)

    @property
    def verdict(self) -> str:
        """The dual always exists; its ranks may depend on the parameters."""
        return "conditional" if any(test.case_tree for test in self.tests.values()) else "yes"

    @cached_property
    def holds_where(self) -> tuple[Any, ...]:
        """The plant's domain, and where the ranks are the generic ones."""
        found = [c for test in self.tests.values() for c in test.holds_where]
        return tuple({(c.kind, c.expression, c.operator): c for c in (*self.domain, *found)}.values())

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The dual on every stratum of either rank test."""
        found = {tuple(map(str, case.when)): case for test in self.tests.values() for case in test.case_tree}
        return carried(self.plant, found.values(), lambda plant, _: solve(plant, self.sign, self.method))

    @property
    def as_plant(self) -> StateSpace:
        """The dual plant."""
        A, B, C, D = (self.answer[name] for name in "ABCD")
        return self.plant.in_coordinates(A, B, C, D, [c.expression for c in self.domain])

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The four matrices and the ranks."""
        return {"sign": self.sign, **self.answer}

    def write(self, page: Builder) -> None:
        """Write the dual, its test matrices beside the plant's, and the ranks."""
        given(page)
        m = self.plant.matrices
        with page.section("dual"):
            page.define("A_dual", self.image, say="dual_positive" if self.sign > 0 else "dual_negative", answer=True)
            for name, own in (("B_dual", "C"), ("C_dual", "B"), ("D_dual", "D")):
                if {"B": m.has_input, "C": m.has_output, "D": m.has_feedthrough}[own]:
                    page.define(name, f"{own}.T", answer=True)
            for kind in self.tests:
                self._compare(page, kind)

    def _compare(self, page: Builder, kind: str) -> None:
        """Write the test matrices of plant and dual, one the transpose of the other up to signs, and their ranks."""
        is_observing, order = kind == "observability", self.plant.order
        (own, row), (other, dual) = (
            (("O", "C"), ("Ctr_dual", "B_dual")) if is_observing else (("Ctr", "B"), ("O_dual", "C_dual"))
        )
        page.define(own, stacked(row, "A", order, across=not is_observing), say=f"plant_{kind}")
        page.define(other, stacked(dual, "A_dual", order, across=is_observing), say=f"dual_{_OTHER[kind]}")
        if self.sign > 0 or order == 1:
            page.equal(f"{other} = {own}.T", say="dual_same")
        else:
            turned = f"{own}.T {{signs}}" if is_observing else f"{{signs}} {own}.T"
            page.equal(page.line(f"{other} = {turned}", signs=self._signs(kind)), say="dual_signs")
        if self.plant.equations and self.tests[kind].existence:
            page.assume("dual_provided", *self.tests[kind].existence)
        ranks = page.line(f"rank({other}) = rank({own}) = {self.answer[f'{kind}_rank']}")
        page.conclude("dual_ranks_observing" if is_observing else "dual_ranks_controlling", ranks=ranks)


def solve(plant: StateSpace, sign: int, method_name: str) -> Dual:
    """Return the dual of a plant."""
    m = plant.matrices
    answer: dict[str, Any] = {
        "A": m.A.T * sign,
        "B": m.C.T if m.has_output else None,
        "C": m.B.T if m.has_input else None,
        "D": m.D.T if m.has_input and m.has_output else None,
    }
    for kind, part in _PART.items():
        if answer["B" if part == "C" else "C"] is not None:
            rank = TESTS[kind].of(plant, "rank").answer["rank"]
            answer |= {f"{kind}_rank": rank, f"dual_{_OTHER[kind]}_rank": rank}
    return Dual(plant, method_name, answer, sign)


@method("dual/transpose", source="kalman1960; brockett1970")
def transpose(plant: StateSpace, sign: int) -> Dual:
    """Transpose the matrices and exchange input and output; the ranks are those of the plant's own tests."""
    return solve(plant, sign, "transpose")


@task
def dual(plant: StateSpace, *, sign: Sign = 1, method: Name = "auto") -> Result:
    """Return the dual plant (± Aᵀ, Cᵀ, Bᵀ, Dᵀ) and the ranks that are equal by duality.

    plant    n states; inputs or outputs or both
    sign     1 for Aᵀ, −1 for −Aᵀ (time reversed)
    Returns A, B, C, D of the dual; observability_rank of the plant with dual_controllability_rank, and
    controllability_rank with dual_observability_rank.  Raises `InputError` where both B and C are missing.
    Source: R. E. Kalman (1960); R. W. Brockett (1970) for −Aᵀ.
    """
    if str(sign).strip() not in {"1", "-1", "+1"}:
        message = f"{str(sign)[:40]!r} is not a sign"
        raise InputError(message, where="specification.sign", repair="write 1 for (Aᵀ, Cᵀ), -1 for (-Aᵀ, Cᵀ)")
    if not plant.matrices.has_input:
        plant.require("C", task="dual")
    return choose("dual", method, "transpose").solve(plant, int(str(sign)))
