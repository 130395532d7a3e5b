"""The transfer function  P(s) = C (sI − A)⁻¹ B + D  with its poles and zeros."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.analysis.coordinates import case_steps
from symobs.analysis.pages import factored_form, given
from symobs.analysis.strata import strata
from symobs.certificate import Claim
from symobs.conditions import Condition, vanishing_factors
from symobs.exact import Matrix, Scalar, pole_and_zero_polynomial, roots_of, transfer, transfer_matrix
from symobs.exact.functions import NotWritten
from symobs.formula import Environment, Literal, Quotient, Roots, Shown
from symobs.formula.term import block, identity, letter
from symobs.method import Case, Result, choose, method, task
from symobs.page import Page, relation

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.specification import Name
    from symobs.system import StateSpace


#: A function with more terms has a resultant that nobody reads; its poles and zeros are those of the parameters in general.
_RESULTANT_TERMS = 40


@dataclass(frozen=True, eq=False, repr=False)
class TransferFunction(Result):
    """P with P(s) = C (sI − A)⁻¹ B + D."""

    task: ClassVar[str] = "transfer_function"

    def claims(self) -> Iterator[Claim]:
        """Yield the definition."""
        m = self.plant.matrices
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "P": self.answer["transfer_function"]}
        e = Environment(variable=self.plant.variable, values=values)
        resolvent = (letter("s", e) @ identity(self.plant.order, e) - letter("A", e)).inverse
        response = letter("C", e) @ resolvent @ letter("B", e)
        if m.has_feedthrough:
            response = response + letter("D", e)
        yield Claim(relation(letter("P", e), response), e)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The resultant, which vanishes where a pole meets a zero."""
        above, below = self._coefficients
        return (_resultant(above, below),) if above else ()

    @cached_property
    def _coefficients(self) -> tuple[tuple[Scalar, ...], tuple[Scalar, ...]]:
        """Those of numerator and denominator where they depend on parameters; of a long function none."""
        P: Scalar | Matrix = self.answer["transfer_function"]
        variable = self.plant.variable
        if isinstance(P, Matrix) or not P.numerator or P.size > _RESULTANT_TERMS or not P.names - {variable}:
            return (), ()
        return tuple(P.numerator.coefficients(variable)), tuple(P.denominator.coefficients(variable))

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, where nothing cancels, and where no zero has gone to infinity."""
        signs = self.plant.symbols.signs
        listed = {condition.expression: condition for condition in self.domain}
        for kind, values in (("existence", self.existence), ("claim", self._coefficients[0][:1])):
            for factor in vanishing_factors(values, signs):
                listed.setdefault(factor, Condition(kind, factor))
        return tuple(listed.values())

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The function on every stratum where a pole and a zero cancel, or a zero goes to infinity."""
        factors = [condition.expression for condition in self._binding_conditions]
        return strata(self.plant, factors, lambda plant, _: resolvent(plant))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The reduced function, its poles and zeros."""
        P: Scalar | Matrix = self.answer["transfer_function"]
        variable = self.plant.variable
        if isinstance(P, Matrix):
            below, above = pole_and_zero_polynomial(P, variable)
        else:
            below, above = P.denominator, P.numerator
        return {
            "transfer_function": P,
            "poles": roots_of(below, variable),
            "zeros": roots_of(above, variable) if above else (),
        }

    def write(self, page: Page) -> None:
        """Write adjugate over determinant, then the reduced function."""
        given(page)
        with page.section("transfer_function"):
            self.write_function(page)
            page.steps += case_steps(page, self, "write_function")

    def write_function(self, page: Page) -> None:
        """Write the function, its poles and its zeros."""
        P: Scalar | Matrix = self.answer["transfer_function"]
        m, variable = page.plant.matrices, self.plant.variable
        A, B, C = page["A"], page["B"], page["C"]
        pencil = page.s @ page.identity(self.plant.order) - A
        characteristic = m.A.characteristic_polynomial(variable)
        adjugate = page.value(pencil.value.adjugate())
        one_over = page.term(Quotient(Literal(Scalar.of(1)), Literal(characteristic)))
        stages = [C @ pencil.inverse @ B, one_over @ C.shown @ adjugate @ B.shown]
        if m.has_feedthrough:
            stages = [stage + page["D"] for stage in stages]
        if isinstance(P, Matrix):
            page.define("P", *stages, page.value(P), say="its_transfer_matrix", answer=True, closing=False)
            return
        page.define("P", *stages, factored_form(page, P), say="its_transfer_function", answer=True, closing=False)
        if P.denominator.degree(variable) < self.plant.order:
            everything = block([[C @ A**k] for k in range(m.A.shape[0])]) @ block(
                [[A**k @ B for k in range(m.A.shape[0])]]
            )
            order = page.value(P.denominator.degree(variable))
            page.conclude("cancelled", order=Shown(everything.apply("rank").formula, order.formula))
        conditions = [condition.expression for condition in self._binding_conditions]
        if conditions:
            page.assume("nothing_cancels", *conditions)
        for part, key, of in (
            (P.denominator, "its_poles", page["P"]),
            (P.numerator, "its_zeros", page["P"].inverse),
        ):
            roots = roots_of(part, variable) if part else ()
            if roots and all(root.is_closed for root in roots):
                page.conclude(key, roots=Roots(of.formula, roots))


def _resultant(above: Sequence[Scalar], below: Sequence[Scalar]) -> Scalar:
    """Return the determinant of Sylvester's matrix of two polynomials: 0 where they have a common root."""
    m, n, zero = len(above) - 1, len(below) - 1, Scalar.of(0)
    shifts = [(above, k) for k in range(n)] + [(below, k) for k in range(m)]
    rows = [[zero] * k + list(part) + [zero] * (m + n - k - len(part)) for part, k in shifts]
    return Matrix.of(rows, m + n).determinant()


@method("transfer_function/resolvent", source="definition")
def resolvent(plant: StateSpace) -> TransferFunction:
    """C adj(sI − A) B over det(sI − A), as a bordered determinant, reduced."""
    if plant.equations:
        raise NotWritten  # a quotient is not reduced modulo the equations of a stratum
    m = plant.matrices
    if (plant.inputs, plant.outputs) != (1, 1):
        numerators, below = transfer_matrix(m.A, m.B, m.C, m.D, plant.variable)
        P = Matrix.of([[above / below for above in row] for row in numerators.rows])
        return TransferFunction(plant, "resolvent", {"transfer_function": P})
    numerator, characteristic = transfer(m.A, m.B, m.C, m.D[0, 0], plant.variable)
    return TransferFunction(plant, "resolvent", {"transfer_function": numerator / characteristic})


@task
def transfer_function(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Return P(s) = C (sI − A)⁻¹ B + D in lowest terms, with its poles and zeros.

    plant    n states, m inputs, p outputs
    Returns transfer_function (p×m where it is not 1×1), poles and zeros with multiplicity: those of Smith
    and McMillan.  Raises `InputError` where B or C is missing.
    Source: S0, chapter 4.
    """
    plant.require("B", "C", task="transfer_function")
    return choose("transfer_function", method, "resolvent").solve(plant)
