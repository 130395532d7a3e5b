"""The transfer function  P(s) = C (sI − A)⁻¹ B + D  with its poles and zeros."""

from __future__ import annotations

from functools import cached_property
from itertools import combinations, islice, product
from math import comb
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

from symobs.exact import (
    Matrix,
    Scalar,
    independent_rows,
    modulo,
    pole_and_zero_polynomial,
    resultant,
    roots_of,
    transfer,
    transfer_matrix,
)
from symobs.exact.core.generators import NotWritten
from symobs.exact.linear_algebra.transfer_function import minors
from symobs.formula.tree import Environment, Evaluated, Literal, Quotient, Roots
from symobs.formula.tree.term import Term, block
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import Builder, predicate, relation
from symobs.system.conditions import Condition, vanishing_factors
from symobs.tasks.analysis.page_parts import factored_form, given, is_narrow
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.analysis.realization.canonical_form import basis
from symobs.tasks.analysis.realization.canonical_form import transfer_matrix as reduced
from symobs.tasks.result import Case, Result, choose, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.system import StateSpace
    from symobs.system.specification import Name


@dataclass
class TransferFunction(Result):
    """P with P(s) = C (sI − A)⁻¹ B + D."""

    task: ClassVar[str] = "transfer_function"
    answered_by = ("transfer_function",)
    only_value = ("transfer_function",)
    leads = ("transfer_function",)
    letters = {"transfer_function": "P", "poles": "P"}

    def claims(self) -> Iterator[Claim]:
        """Yield the definition; where equations hold, that no realisation is smaller: the fraction is in lowest terms."""
        m = self.plant.matrices
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "P": self.answer["transfer_function"]}
        e = Environment(variable=self.plant.variable, values=values)
        resolvent = e["A"].pencil.inverse
        response = e["C"] @ resolvent @ e["B"]
        if m.has_feedthrough:
            response = response + e["D"]
        yield holds(e, "P = {response}", response=response)
        if self.plant.equations and self.order:
            yield self._smallest(e)

    def _smallest(self, e: Environment) -> Claim:
        """Return the claim that a minor of 𝒪𝒞 of the order of the fraction does not vanish."""
        whole, ideal = hankel(self.plant), self.plant.ideal
        rows = independent_rows(whole, ideal)[: self.order]
        some = whole.select(rows, range(whole.shape[1]))
        minor = some.select(range(len(rows)), independent_rows(some.T, ideal))
        says = f"no realisation has an order below {self.order}"
        return Claim(relation(Term(Literal(minor), e).apply("det"), "!==", 0), e, says)

    # -- what follows ------------------------------------------------------------------------------------------------

    @cached_property
    def polynomials(self) -> tuple[Scalar, Scalar]:
        """The polynomials of the poles and of the zeros."""
        P: Scalar | Matrix = self.answer["transfer_function"]
        if isinstance(P, Matrix):
            return pole_and_zero_polynomial(P, self.plant.variable)
        return P.denominator, P.numerator

    @property
    def order(self) -> int:
        """The order of a smallest realisation."""
        return max(self.polynomials[0].degree(self.plant.variable), 0)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The reduced function, its poles and zeros."""
        below, above = self.polynomials
        variable = self.plant.variable
        return {
            "transfer_function": self.answer["transfer_function"],
            "poles": roots_of(below, variable),
            "zeros": roots_of(above, variable) if above else (),
        }

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return poles and zeros of another transfer function of one input and output."""
        P, variable = given["transfer_function"], self.plant.variable
        if not isinstance(P, Scalar) or P.is_zero:
            return {}
        return {"poles": roots_of(P.denominator, variable), "zeros": roots_of(P.numerator, variable)}

    @cached_property
    def decisive(self) -> tuple[tuple[Scalar, ...], ...]:
        """Systems of polynomials in the parameters: where none of them vanishes, poles and zeros are these."""
        if not self.plant.field.names:
            return ()

        return decisive(self.answer["transfer_function"], self.plant)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, and where nothing more cancels and no zero is lost."""
        own = super().holds_where
        changing = self._cases_of_factors[1] - {c.expression for c in own}
        alone = (*own, *(Condition("existence", f) for f in self._factors if f in changing))
        known = {condition.expression for condition in alone}
        together = (_vanishing(case) for case in self.case_tree if case.when and not known & _vanishing(case))
        from symobs.tasks.analysis.strata.strata import distances  # noqa: PLC0415 - only plants with parameters pay for it

        lost = distances(tuple(sorted(equations, key=str)) for equations in together if equations)
        return (*alone, *(Condition("existence", distance) for distance in lost))

    @cached_property
    def _factors(self) -> tuple[Scalar, ...]:
        """What must not vanish alone."""
        single = [self.plant.simplified(system[0]) for system in self.decisive if len(system) == 1]
        below = self.answer["transfer_function"].common_denominator().coefficients(self.plant.variable)[0]
        return vanishing_factors([*single, below], self.plant.symbols.signs)

    @property
    def verdict(self) -> str:
        """The function always exists; with parameters its poles and zeros may be others somewhere."""
        return "conditional" if self.case_tree else super().verdict

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """Lowest terms, poles and zeros on every stratum where they may not be the generic ones."""
        if not self.decisive:
            return ()
        from symobs.tasks.analysis.strata.strata import common_zeros  # noqa: PLC0415 - only plants with parameters pay for it

        found = self._cases_of_factors[0]
        for system in self.decisive:
            if len(system) > 1:
                further = common_zeros(self.plant, system, self._there)
                found += tuple(case for case in further if not self._is_as_ever(case))
        return tuple({case.when: case for case in found}.values())

    @cached_property
    def _cases_of_factors(self) -> tuple[tuple[Case, ...], frozenset[Scalar]]:
        """The cases where one of the factors vanishes, and the factors with which poles or zeros become others somewhere.

        Each point where such a factor vanishes is in a case: the factor is a condition of the generic answer.
        """
        if not self.decisive:
            return (), frozenset()
        from symobs.tasks.analysis.strata.strata import strata  # noqa: PLC0415 - only plants with parameters pay for it

        found = strata(self.plant, self._factors, self._there)
        changing = frozenset[Scalar]().union(*(_vanishing(case) for case in found if not self._is_as_ever(case)))
        return tuple(case for case in found if _vanishing(case) & changing), changing

    @staticmethod
    def _there(plant: StateSpace, _: Mapping[str, Scalar]) -> TransferFunction:
        """Return the function on a stratum; raises `NotWritten` where more has a root in common all over it."""
        found, ideal = resolvent(plant), plant.ideal
        if ideal is not None and any(all(value in ideal for value in system) for system in found.decisive):
            raise NotWritten("poles or zeros are others all over the stratum")
        return found

    def _is_as_ever(self, case: Case) -> bool:
        """Return whether a case has the poles and zeros that hold in general, and no cases of its own."""
        if not isinstance(case.result, TransferFunction) or not case.substitution or case.result.case_tree:
            return False
        try:
            moved = [value.substitute(dict(case.substitution)) for value in self.polynomials]
        except ZeroDivisionError:
            return False
        variable = self.plant.variable
        kept = [own.degree(variable) == new.degree(variable) for own, new in zip(self.polynomials, moved, strict=True)]
        there = zip(moved, case.result.polynomials, strict=True)
        return all(kept) and all(new and (own / new).is_constant for own, new in there)

    # -- the page ----------------------------------------------------------------------------------------------------

    def write(self, page: Builder) -> None:
        """Write adjugate over determinant, then the reduced function."""
        given(page)
        P: Scalar | Matrix = self.answer["transfer_function"]
        m, variable = page.plant.matrices, self.plant.variable
        with page.section("transfer_function"):
            A, B, C = page["A"], page["B"], page["C"]
            pencil = A.pencil
            characteristic = m.A.characteristic_polynomial(variable)
            adjugate = page.value(pencil.value.adjugate())
            one_over = page.term(Quotient(Literal(Scalar.of(1)), Literal(characteristic)))
            stages = [page["C pencil(A)^-1 B"]]
            if is_narrow(adjugate.value):
                stages.append(one_over @ C.as_value @ adjugate @ B.as_value)
            if m.has_feedthrough:
                stages = [stage + page["D"] for stage in stages]
            if isinstance(P, Matrix):
                page.define("P", *stages, page.value(P), say="its_transfer_matrix", answer=True, closing=False)
            else:
                page.define(
                    "P", *stages, factored_form(page, P), say="its_transfer_function", answer=True, closing=False
                )
                self._tell_order(page)
                self._tell_roots(page)
            self._cases(page)

    def _tell_order(self, page: Builder) -> None:
        """Say whether something cancelled."""
        A, order = page["A"], self.plant.order
        if self.order < order:
            everything = block([[page["C"] @ A**k] for k in range(order)]) @ block(
                [[A**k @ page["B"] for k in range(order)]]
            )
            page.conclude(
                "cancelled", order=Evaluated(everything.apply("rank").formula, page.value(self.order).formula)
            )

    def _tell_roots(self, page: Builder) -> None:
        """Say the poles and the zeros."""
        for part, key, of in zip(self.polynomials, ("its_poles", "its_zeros"), (page["P"], page["P^-1"]), strict=True):
            roots = roots_of(part, self.plant.variable) if part else ()
            if roots and all(root.is_closed for root in roots):
                page.conclude(key, roots=Roots(of.formula, roots))
        if self.order and self.polynomials[1].degree(self.plant.variable) == 0:
            page.conclude("no_zero", predicate("polynomial", page["P^-1"]))

    def _cases(self, page: Builder) -> None:
        """State the conditions, and the cases elsewhere."""
        if not self.case_tree:
            return
        from symobs.tasks.analysis.page_parts import case_steps  # noqa: PLC0415 - only pages with cases pay for it

        conditions = [c.expression for c in self.holds_where if c.kind == "existence"]
        if conditions:
            is_matrix = isinstance(self.answer["transfer_function"], Matrix)
            page.assume("no_pole_lost" if is_matrix else "lowest_provided", *conditions)
        page.steps += case_steps(page, self, lambda inner, found: found.write_form(inner))

    def write_form(self, page: Builder) -> None:
        """Write the function in lowest terms, its poles and zeros, in a case."""
        P: Scalar | Matrix = self.answer["transfer_function"]
        response = page["C pencil(A)^-1 B"]
        if self.plant.matrices.has_feedthrough:
            response = response + page["D"]
        shown = page.value(P) if isinstance(P, Matrix) else factored_form(page, P)
        page.set("P", P)  # in lowest terms as it stands here, though the terms before it have more factors
        page.equal(
            relation(page["P"], response, shown), say="lowest_there" if self.order else "static_there", answer=True
        )
        if not isinstance(P, Matrix) and P:
            self._tell_roots(page)


def _vanishing(case: Case) -> frozenset[Scalar]:
    """Return what vanishes on the stratum of a case."""
    return frozenset(condition.expression for condition in case.when if condition.operator == "==")


@method("transfer_function/resolvent", source="definition")
def resolvent(plant: StateSpace) -> TransferFunction:
    """C adj(sI − A) B over det(sI − A), as a bordered determinant, reduced."""
    m = plant.matrices
    if plant.equations:
        return TransferFunction(plant, "resolvent", {"transfer_function": on_stratum(plant)})
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
    Source: T. Kailath, Linear Systems, ch. 2.
    """
    plant.require("B", "C", task="transfer_function")
    return choose("transfer_function", method, "resolvent").solve(plant)


# Parameter values at which the order, the poles or the zeros of a transfer function change.
#
# C adj(sI − A) B + D det(sI − A) over det(sI − A) stays true at every parameter, but what cancels in it, and how many
# zeros there are, can change. In general it is b/a: the poles are the roots of a wherever b and a have no root in
# common, and the zeros do not change in number as long as the leading coefficient of b does not vanish. Of a matrix the
# same is said of its minors (Smith and McMillan): with rank 𝒪𝒞 = ν the least common denominator of degree ν stays what
# it is, and above it the largest minors are the polynomial of the zeros times polynomials without a common root.


#: Polynomials in the parameters that must not vanish together.
System: TypeAlias = tuple[Scalar, ...]
#: The most minors of 𝒪𝒞 that are looked at: a subset of them vanishes together on more than the true locus, never less.
_MINORS = 40
#: What the numbers of a combination of minors are called; no parameter's name begins so.
_NUMBER = "_t"


def on_stratum(plant: StateSpace) -> Scalar | Matrix:
    """Return the transfer function in lowest terms where equations of the parameters hold: that of the minimal part."""
    m = plant.matrices
    S, sizes = basis(m.A, m.B, m.C, plant.ideal)
    T, first = S.inverse(), range(sizes[0])
    A, B, C = (modulo(value.normal(), plant.ideal) for value in (T @ m.A @ S, T @ m.B, m.C @ S))
    part = A.select(first, first), B.select(first, range(plant.inputs)), C.select(range(plant.outputs), first)
    P = modulo(reduced(*part, m.D, plant.variable), plant.ideal)
    return P[0, 0] if P.shape == (1, 1) else P


def order_of(P: Scalar | Matrix, variable: str) -> int:
    """Return the degree of the least common denominator of all minors: the order of a smallest realisation."""
    below = pole_and_zero_polynomial(P, variable)[0] if isinstance(P, Matrix) else P.denominator
    return max(below.degree(variable), 0)


def hankel(plant: StateSpace) -> Matrix:
    """Return 𝒪𝒞, whose rank is the order of a smallest realisation."""
    m = plant.matrices
    return (power_rows(m.A, m.C) @ power_rows(m.A.T, m.B.T).T).normal()


def decisive(P: Scalar | Matrix, plant: StateSpace) -> tuple[System, ...]:
    """Return systems of polynomials in the parameters: where none of them vanishes, poles and zeros are the generic ones."""
    if not plant.field.names:
        return ()
    found = _of_matrix(P, plant) if isinstance(P, Matrix) else _of_function(P, plant.variable)
    return tuple(dict.fromkeys(system for system in found if not any(value.is_constant for value in system)))


def _of_function(P: Scalar, variable: str) -> list[System]:
    """Return the resultant of numerator and denominator, and the leading coefficient of the numerator."""
    above, below = P.numerator, P.denominator
    if not P or below.degree(variable) < 1:
        return []
    return [(resultant(above, below, variable),), (above.coefficients(variable)[0],)]


def _of_matrix(P: Matrix, plant: StateSpace) -> list[System]:
    """Return minors of 𝒪𝒞 of its rank, the zeros' leading coefficient, and what gives the largest minors a root in common."""
    variable = plant.variable
    poles, zeros = pole_and_zero_polynomial(P, variable)
    largest = next((found for order in range(min(P.shape), 0, -1) if (found := list(minors(P, order)))), [])
    if not largest:
        return []
    rest = [(minor * poles / zeros).numerator for minor in largest]
    return [
        _minors_of(hankel(plant), order_of(P, variable)),
        _together(rest, variable),
        (zeros.numerator.coefficients(variable)[0],),
    ]


def _minors_of(matrix: Matrix, order: int) -> System:
    """Return minors of the order of the rank that are not 0; (1) of order 0.

    Where there are too many to look at all of them, they are one that elimination finds and its neighbours.
    """
    if not order:
        return (Scalar.of(1),)
    height, width = matrix.shape
    if comb(height, order) * comb(width, order) <= _MINORS * _MINORS:
        pairs: Iterable[tuple[Sequence[int], Sequence[int]]] = product(
            combinations(range(height), order), combinations(range(width), order)
        )
    else:
        rows = independent_rows(matrix)
        columns = independent_rows(matrix.select(rows, range(width)).T)
        beside = [(other, columns) for other in _exchanged(rows, height)]
        beside += [(rows, other) for other in _exchanged(columns, width)]
        pairs = [(rows, columns), *beside]
    chosen = (matrix.select(*pair).determinant() for pair in pairs)
    return tuple(islice((minor.numerator for minor in chosen if minor), _MINORS))


def _exchanged(chosen: Sequence[int], size: int) -> Iterator[tuple[int, ...]]:
    """Yield the choices with one index in place of another."""
    for place, new in product(range(len(chosen)), range(size)):
        if new not in chosen:
            yield (*chosen[:place], new, *chosen[place + 1 :])


def _together(polynomials: list[Scalar], variable: str) -> System:
    """Return polynomials that vanish together wherever some polynomials without a common factor have a common root.

    They are the coefficients of the resultant of the first and Σ tₖ pₖ of the others, in the tₖ.
    """
    first, *others = sorted(polynomials, key=lambda p: p.degree(variable))
    if first.degree(variable) < 1:
        return tuple(p for p in polynomials if p.degree(variable) < 1)
    numbers = [Scalar.symbol(f"{_NUMBER}{k}") for k in range(len(others))]
    mixed = sum((t * p for t, p in zip(numbers, others, strict=True)), Scalar.of(0))
    found = [resultant(first, mixed, variable)]
    for t in numbers:
        (name,) = t.names
        found = [c for value in found for c in value.coefficients(name) if c]
    return tuple(value.numerator for value in found)
