"""The characteristic polynomial  χ(s) = det(sI − A), its factors and its roots."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Factored, Scalar, factored, roots_of
from symobs.formula.tree import Environment, Roots
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import stability
from symobs.tasks.analysis.page_parts import formula_of_factored, given, say_stability
from symobs.tasks.result import Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.certificate.claims import Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Name


@dataclass
class CharacteristicPolynomial(Result):
    """χ with det(sI − A) = χ(s) and the product of the factors equal to χ."""

    task: ClassVar[str] = "characteristic_polynomial"
    answered_by = ("polynomial",)
    only_value = ("polynomial",)
    leads = ("polynomial",)
    letters = {"polynomial": "chi", "roots": "chi"}

    def claims(self) -> Iterator[Claim]:
        """Yield det(sI − A) = χ(s) = product of the factors."""
        values = {"A": self.plant.matrices.A, "chi": self.answer["polynomial"]}
        e = Environment(variable=self.plant.variable, values=values)
        form: Factored = self.answer["factors"]
        product = Term(formula_of_factored(form), e)
        yield holds(e, "det(pencil(A)) = chi")
        yield holds(e, "chi = {product}", product=product)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """Polynomial, factors, roots, stability."""
        plant, polynomial = self.plant, self.answer["polynomial"]
        found = stability(polynomial, plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
        return {
            "polynomial": polynomial,
            "factors": [[factor, power] for factor, power in self.answer["factors"].factors],
            "roots": roots_of(polynomial, plant.variable),
            "stable": found.verdict,
            "stable_if": found.inequalities(plant.symbols.signs),
        }

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return the roots of another polynomial."""
        polynomial, variable = given["polynomial"], self.plant.variable
        return {"roots": roots_of(polynomial, variable)} if polynomial.is_polynomial_in(variable) else {}

    def write(self, page: Builder) -> None:
        """Write the determinant, multiplied out and factored, and the roots."""
        given(page)
        polynomial: Scalar = self.answer["polynomial"]
        with page.section("characteristic_polynomial"):
            members = [page["det(pencil(A))"], page["det(#pencil(A))"], page.value(polynomial)]
            form: Factored = self.answer["factors"]
            if len(form.factors) > 1 or form.factors[0][1] > 1:
                members.append(page.term(formula_of_factored(form)))
            page.define("chi", *members, say="its_characteristic_polynomial", answer=True, closing=False)
            roots = roots_of(polynomial, self.plant.variable)
            if all(root.is_closed for root in roots):
                page.conclude("its_roots", roots=Roots(page["chi"].formula, roots))
            say_stability(page, page["chi"])


@method("characteristic_polynomial/determinant", source="definition")
def determinant(plant: StateSpace) -> CharacteristicPolynomial:
    """Expand det(sI − A) by minors, or by FLINT where there is no parameter."""
    polynomial = plant.matrices.A.characteristic_polynomial(plant.variable)
    answer = {"polynomial": polynomial, "factors": factored(polynomial, plant.variable)}
    return CharacteristicPolynomial(plant, "determinant", answer)


@task
def characteristic_polynomial(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Return χ(s) = det(sI − A), its factors and its roots with multiplicity.

    plant    n states; only A matters
    Returns polynomial (monic of degree n), factors (list of [factor, multiplicity]), roots, stable.  Raises `InputError`
    for an unknown method.
    Source: T. Kailath, Linear Systems.
    """
    return choose("characteristic_polynomial", method, "determinant").solve(plant)
