"""The powers Aᵏ in discrete time, in closed form: Aᵏ⁺¹ = A Aᵏ and A⁰ = I."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any, Self

from symobs.exact.core.generators import functions_in
from symobs.exact.time_functions.matrix_exponential import NoClosedForm
from symobs.exact.time_functions.matrix_power import INSTANT, matrix_power
from symobs.formula.tree import Literal, Product, Sum
from symobs.formula.tree.term import Term, identity, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.tasks.analysis.page_parts import given
from symobs.tasks.analysis.time_response.damping_cases import DampingCases, Signs, time_environment
from symobs.tasks.analysis.time_response.matrix_exponential import MatrixExponential, question_of, tell_polynomial

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Matrix, Scalar
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace

#: Sums of up to this many matrices are shown before the entries.
_SHOWN_SUM = 4


def require_no_instant(plant: StateSpace) -> None:
    """Raise `InputError` where k is a parameter of the plant."""
    if "k" in plant.matrices.symbols:
        message = "k is the number of the instant and cannot be a parameter of the plant"
        raise InputError(message, where="plant.A", repair="give the parameter another name")


def following(term: Term) -> Term:
    """Return the value of a function of k at the next instant."""
    return term.at("k", INSTANT + 1)


def powers_of(A: Matrix, variable: str) -> Matrix:
    """Return Aᵏ.  Raises `NoClosedForm`."""
    return reduce(add, (matrix * value for value, matrix in matrix_power(A, variable))).normal()


@dataclass(frozen=True, eq=False, repr=False)
class MatrixPower(MatrixExponential):
    """Aᵏ."""

    functions_of_time = {"A^k": "matrix"}
    letters = {"matrix": "A_k"}

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, _: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant."""
        shared = {"taken": taken, "chosen": {}}
        try:
            return cls(plant, method_name, {"matrix": powers_of(plant.matrices.A, plant.variable), **shared})
        except NoClosedForm as error:
            nothing = {"matrix": None, "question": question_of(error), "factor": error.factor}
            return cls(plant, method_name, {**nothing, **shared})

    def claims(self) -> Iterator[Claim]:
        """Yield the recursion and the start."""
        yield from super(MatrixExponential, self).claims()
        if self.answer["matrix"] is None:
            return
        e = time_environment(self.plant, {"A": self.plant.matrices.A, "A_k": self.answer["matrix"]})
        power = letter("A_k", e)
        yield Claim(relation(following(power), letter("A", e) @ power), e, "A**(k + 1) = A*A**k")
        yield Claim(relation(power.at("k", 0), identity(self.plant.order, e)), e, "A**0 = I")

    @property
    def denominators(self) -> tuple[Scalar, ...]:  # type: ignore[override]
        """Those of the entries."""
        return super(MatrixExponential, self).denominators

    def write(self, page: Builder) -> None:
        """Write the characteristic polynomial, the sum of functions and matrices, the entries, the check."""
        page.in_time(*self.everything())
        given(page)
        with page.section("matrix_power"):
            tell_polynomial(page)
            self.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: DampingCases) -> None:
    """Write one branch."""
    if result.answer["matrix"] is None:
        tell_open_power(page, result.answer["factor"])
        return
    power = tell_power(page, result.plant.matrices.A, result.answer["matrix"], answer=True)
    start = relation(power.at("k", 0), page.identity(result.plant.order))
    page.verified("power_start", relation(following(power), page["A"] @ power), start=start)


def tell_open_power(page: Builder, factor: Scalar | None) -> None:
    """State the undecided question."""
    if factor is None:
        page.remark("too_many_states_power", order=str(page.plant.order))
    else:
        page.remark("no_closed_power", factor=factor, degree=str(factor.degree(page.plant.variable)))


def tell_power(page: Builder, A: Matrix, value: Matrix, *, answer: bool = False) -> Term:
    """Define Aᵏ: the sum over the modes where it is short, then the entries."""
    parts = matrix_power(A, page.plant.variable)
    members: list[Term | Matrix] = []
    if 1 < len(parts) <= _SHOWN_SUM:
        members = [page.term(Sum(tuple(Product((Literal(f), Literal(matrix))) for f, matrix in parts)))]
    say = "power_sum" if members else "power_here"
    power = page.define("A_k", *members, value, say=say, answer=answer, closing=False)
    tell_impulses(page, value)
    return power


def tell_impulses(page: Builder, value: Matrix) -> None:
    """Say what δ(k, j) is, where it occurs."""
    if any(found.kind == "KroneckerDelta" for found in functions_in([value])):
        page.remark("power_delta")
