"""Canonical forms: controllable and observable (one input, one output), and the real modal form.

With χ = sⁿ + a₁ sⁿ⁻¹ + … + aₙ and the Hankel matrix H = [aₙ₋₁ … a₁ 1; …; 1 0 … 0] the controllable form has S = T⁻¹ = 𝒞 H,
ones above the diagonal, the last row −aₙ … −a₁ and B̄ = eₙ; the observable form has T = H 𝒪 and is its transpose.
The modal form is block diagonal: numbers, Jordan blocks, [σ ω; −ω σ], companion blocks of irreducible factors.
"""

from __future__ import annotations

from difflib import get_close_matches
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, TypedDict

from symobs.exact import (
    Ideal,
    Matrix,
    Scalar,
    companion,
    echelon,
    factored,
    hankel_of,
    independent_rows,
    kernel,
    modulo,
    primitive,
    transfer,
)
from symobs.exact.linear_algebra.modal_matrix import cyclic_vector, modal_matrix
from symobs.formula.tree import Environment
from symobs.formula.tree.term import block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import Builder, relation
from symobs.system.conditions import Condition, joined, nonzero, vanishing_factors
from symobs.system.specification import in_common_field, read_gain
from symobs.tasks.analysis.modes.modes import TESTS
from symobs.tasks.analysis.page_parts import case_steps, formula_of_factored, given
from symobs.tasks.analysis.rank.observability import power_rows
from symobs.tasks.analysis.rank.rank_page import square_test
from symobs.tasks.analysis.realization.modal_form import modal_basis
from symobs.tasks.analysis.strata.strata import carried, strata
from symobs.tasks.result import Case, Result, choose, equality, holds, method, task
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact.linear_algebra.modal_matrix import Blocks
    from symobs.proof.certificate.claims import Certificate
    from symobs.system import StateSpace
    from symobs.system.specification import MatrixText, Name
    from symobs.tasks.analysis.rank.observability import RankResult


#: Kind of the form, and the rank test that decides whether it exists.
KINDS: dict[str, str | None] = {"controllable": "controllability", "observable": "observability", "modal": None}
#: The kind of the form in coordinates that are given.
GIVEN = "given"


class PlantMoved(TypedDict):
    """T, T⁻¹ and the matrices of the plant in the coordinates T x; None where there are none."""

    T: Matrix | None
    inverse: Matrix | None
    A: Matrix | None
    B: Matrix | None
    C: Matrix | None
    D: Matrix | None


class CanonicalAnswer(PlantMoved):
    """Also χ, and the blocks of the modal form."""

    polynomial: Scalar
    blocks: Blocks


@dataclass
class CanonicalForm(Result):
    """The plant in canonical coordinates x̄ = T x, or that there are none.

    Claims: T S = I, Ā = T A S, B̄ = T B, C̄ = C S; Ā and B̄ (C̄) are those of the form, the modal form being that of χ's
    factors.  Where there is no form, the rank test says why.
    """

    answer: CanonicalAnswer
    kind: str

    task: ClassVar[str] = "canonical_form"
    answered_by = ("T", "A", "B", "C")
    in_coordinates: ClassVar[tuple[str, ...]] = ("T", "A", "B", "C")
    letters = {
        "T": "T",
        "A": "A_bar",
        "B": "B_bar",
        "C": "C_bar",
        "D": "D",
        "polynomial": "chi",
    }

    @cached_property
    def test(self) -> RankResult | None:
        """The rank test that decides, None for the modal form."""
        name = KINDS.get(self.kind)
        return None if name is None else TESTS[name].of(self.plant, "rank")

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of this result and of the rank test below it."""
        return (*self.certificates, *(self.test.certificates if self.test is not None else ()))

    @property
    def as_plant(self) -> StateSpace:
        """The plant in these coordinates, where they are some."""
        answer, m = self.answer, self.plant.matrices
        if answer["A"] is None:
            message = f"there is no {self.kind} canonical form, and no plant in it"
            raise InputError(message, where="plant", repair="take another form, or the plant itself")
        B, C = answer["B"] if m.has_input else None, answer["C"] if m.has_output else None
        nonzero = [c.expression for c in self.holds_where]
        return self.plant.in_coordinates(answer["A"], B, C, answer["D"], nonzero)

    @property
    def has_ones(self) -> bool:
        """Whether B̄ of a modal form has a 1 in each block and is 0 elsewhere."""
        blocks, B = self.answer["blocks"], self.answer["B"]
        return bool(blocks) and B is not None and cyclic_vector(blocks, self.plant.variable) == B

    def claims(self) -> Iterator[Claim]:
        """Yield the change of coordinates and the form; or that the rank is below n."""
        m, answer, n = self.plant.matrices, self.answer, self.plant.order
        chi = answer["polynomial"]
        e = Environment(variable=self.plant.variable, values={"A": m.A, "chi": chi})
        yield holds(e, "det(pencil(A)) = chi")
        if answer["T"] is None:
            rank = self.test.answer["rank"] if self.test is not None else n
            yield Claim(relation(rank, "<", n), e, "the pair does not have full rank")
            given = those_found(answer["inverse"], answer["A"], answer["B"], answer["C"], answer["D"])
            yield equality(len(given), 0, e, "no form is given where there is none")
            return
        values: dict[str, Matrix | None] = {"T": answer["T"], "S": answer["inverse"], "A_bar": answer["A"]}
        values |= {"B": m.B, "B_bar": answer["B"]} if m.has_input else {}
        values |= {"C": m.C, "C_bar": answer["C"]} if m.has_output else {}
        values |= {"D": m.D, "D_bar": answer["D"]} if m.has_input and m.has_output else {}
        e = e.extended_by(values=named_found(values))
        T, S = e["T"], e["S"]
        yield holds(e, "T S = I")
        yield holds(e, "A_bar = T A S")
        for left, right in (("B_bar", T @ e["B"]), ("C_bar", e["C"] @ S), ("D_bar", e["D"])):
            if left in values:
                yield holds(e, f"{left} = {{right}}", right=right)
        yield from self._form(e)

    def _form(self, e: Environment) -> Iterator[Claim]:
        n, A_bar = self.plant.order, e["A_bar"]
        wanted = companion(self.answer["polynomial"].coefficients(self.plant.variable)[1:])
        last = Matrix.unit(n, n - 1)
        if self.kind == "controllable":
            yield equality(A_bar, wanted, e, "A_bar has the coefficients of chi in its last row")
            yield holds(e, "B_bar = {last}", "B_bar is the last unit vector", last=last)
        elif self.kind == "observable":
            yield equality(A_bar, wanted.T, e, "A_bar has the coefficients of chi in its last column")
            yield holds(e, "C_bar = {T}", "C_bar is the last unit row", T=last.T)
        elif self.kind == "modal":
            blocks = modal_matrix(self.answer["blocks"], self.plant.variable)
            yield equality(A_bar, blocks, e, "A_bar consists of the blocks of the factors of chi")
            if self.has_ones:
                ones = cyclic_vector(self.answer["blocks"], self.plant.variable)
                yield holds(e, "B_bar = {ones}", "B_bar has a 1 in each block", ones=ones)
            product = Scalar.of(1)
            for factor, length in self.answer["blocks"]:
                product = product * factor**length
            yield holds(e, "chi = {product}", product=product)

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The determinant of the test matrix, or of the basis of the modal form."""
        if self.test is not None:
            return self.test.existence
        S = self.answer["inverse"]
        return () if S is None else (S.determinant(), S.common_denominator())

    @property
    def verdict(self) -> str:
        """Whether the form exists."""
        if self.test is not None:
            return self.test.verdict
        return "conditional" if self._binding_conditions else "yes"

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, and where the coordinates are independent."""
        if self.answer["T"] is None:
            return self.domain
        matrices = [value.common_denominator() for value in self.answer.values() if isinstance(value, Matrix)]
        factors = dict.fromkeys(vanishing_factors((*self.existence, *matrices), self.plant.symbols.signs))
        return joined(self.domain, nonzero("existence", factors))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The form where the generic coordinates are dependent."""
        if self.kind == GIVEN:  # where T has no inverse it is no change of coordinates
            return ()

        def anew(plant: StateSpace, _: dict[str, Scalar]) -> CanonicalForm:
            return solve(plant, self.kind, self.method)

        if self.test is not None:
            return carried(self.plant, self.test.case_tree, anew)
        return strata(self.plant, [c.expression for c in self.holds_where if c.kind == "existence"], anew)

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The change of coordinates and the matrices in it."""
        answer = self.answer
        found = {"T": answer["T"], "A": answer["A"], "B": answer["B"], "C": answer["C"], "D": answer["D"]}
        return {"kind": self.kind, **found, "polynomial": answer["polynomial"]}

    def write(self, page: Builder) -> None:
        """Write χ, the basis, and the plant in it."""
        given(page)
        if self.kind == GIVEN:
            with page.section("coordinates_changed"):
                self.write_form(page)
            return
        with page.section("canonical_form"):
            chi = factored(self.answer["polynomial"], self.plant.variable)
            members = [page["det(pencil(A))"]]
            members.append(page.value(self.answer["polynomial"]))
            if self.kind == "modal" and (len(chi.factors) > 1 or chi.factors[0][1] > 1):
                members.append(page.term(formula_of_factored(chi)))
            page.define("chi", *members, say=f"canonical_{self.kind}", closing=False)
            self.write_form(page)
            page.steps += case_steps(page, self, lambda inner, found: found.write_form(inner))

    def write_form(self, page: Builder) -> None:
        """Write the coordinates and the plant in them."""
        if self.test is not None and not self._write_test(page):
            return
        m, T, S = self.plant.matrices, self.answer["T"], self.answer["inverse"]
        if self.kind == "observable":
            page.define("T", page("{hankel} O", hankel=self._hankel), say="last_column_observable", answer=True)
            page.define("S", "T^-1")
        elif self.kind == "controllable":
            page.define("S", page("Ctr {hankel}", hankel=self._hankel), say="last_row_controllable")
            page.define("T", "S^-1", answer=True)
        elif self.kind == GIVEN and T is not None:
            page.define("T", page.value(T), say="coordinates_given", closing=False)
            page.define("S", "T^-1", say="coordinates_back")
            if conditions := [c.expression for c in self.holds_where if c.kind == "existence"]:
                page.assume("coordinates_provided", *conditions)
        elif S is not None:
            page.define("S", page.value(S), say="modal_ones" if self.has_ones else "modal_basis")
            conditions = [c.expression for c in self.holds_where if c.kind == "existence"]
            if conditions:
                page.assume("distinct_provided", *conditions)
            page.define("T", "S^-1", answer=True)
        page.define("A_bar", "T A S", say="decomposed", answer=True)
        if m.has_input:
            page.define("B_bar", "T B", answer=True)
        if m.has_output:
            page.define("C_bar", "C S", answer=True)

    @property
    def _hankel(self) -> Matrix:
        return hankel_of(self.answer["polynomial"].coefficients(self.plant.variable)[1:])

    def _write_test(self, page: Builder) -> bool:
        """Write the test matrix and decide it; return whether the form exists."""
        A, n = page["A"], range(1, self.plant.order)
        if self.kind == "observable":
            page.define("O", block([[page["C"]], *([page["C"] @ A**k] for k in n)]), say="observability_matrix")
        else:
            page.define("Ctr", block([[page["B"], *(A**k @ page["B"] for k in n)]]), say="controllability_matrix")
        assert self.test is not None  # noqa: S101 - an invariant: this is asked of the two forms with a test only
        square_test(page, "O" if self.kind == "observable" else "Ctr", self.test, str(KINDS[self.kind]))
        if self.answer["T"] is None:
            page.conclude(f"canonical_impossible_{self.kind}")
        return self.answer["T"] is not None


@dataclass
class InGivenCoordinates(CanonicalForm):
    """The plant in given coordinates, whose matrices are right in no others."""

    in_coordinates = ()
    only_value = ("A", "B", "C")


def solve(plant: StateSpace, kind: str, method_name: str) -> CanonicalForm:
    """Return the canonical form of a plant."""
    m, variable = plant.matrices, plant.variable
    chi = m.A.characteristic_polynomial(variable)
    blocks: tuple[tuple[Scalar, int], ...] = ()
    S: Matrix | None
    if kind == "modal":
        S, blocks = modal_basis(m.A, chi, variable)
        S = _with_ones(plant, S, blocks)
    else:
        hankel = hankel_of(chi.coefficients(variable)[1:])
        A, C = (m.A.T, m.B.T) if kind == "controllable" else (m.A, m.C)
        rows = power_rows(A, C)
        S = (rows.T @ hankel).normal() if plant.simplified(rows.determinant()) else None
    answer: PlantMoved = {"T": None, "inverse": None, "A": None, "B": None, "C": None, "D": None}
    if S is not None:
        T = S.inverse().normal()
        if kind == "observable":
            T, S = S.T, T.T
        answer = _moved(plant, T, S)
    return CanonicalForm(plant, method_name, {**answer, "polynomial": chi, "blocks": blocks}, kind)


def _with_ones(plant: StateSpace, S: Matrix, blocks: Blocks) -> Matrix:
    """Return the basis in which B̄ of one input has a 1 in each block, another one where the pair is not controllable."""
    A, B = plant.matrices.A, plant.matrices.B
    if plant.inputs != 1 or len({factor for factor, _ in blocks}) < len(blocks):
        return S
    modal = modal_matrix(blocks, plant.variable)
    own, wanted = (power_rows(a.T, b.T).T for a, b in ((A, B), (modal, cyclic_vector(blocks, plant.variable))))
    return (own @ wanted.inverse()).normal() if plant.simplified(own.determinant()) else S


def _moved(plant: StateSpace, T: Matrix, S: Matrix) -> PlantMoved:
    """Return T, S = T⁻¹ and the matrices of the plant in the coordinates T x."""
    m = plant.matrices
    return {
        "T": T,
        "inverse": S,
        "A": (T @ m.A @ S).normal(),
        "B": (T @ m.B).normal() if m.has_input else None,
        "C": (m.C @ S).normal() if m.has_output else None,
        "D": m.D if m.has_input and m.has_output else None,
    }


@method("canonical_form/basis", source="bass1965; kailath1980, ch. 2")
def canonical_basis(plant: StateSpace, kind: str) -> CanonicalForm:
    """𝒞 H, its dual, or for the modal form cyclic bases of the invariant subspaces of χ's factors."""
    return solve(plant, kind, "basis")


def in_coordinates(plant: StateSpace, T: Matrix) -> InGivenCoordinates:
    """Return the plant in the coordinates T x; raises `InputError` where T has no inverse."""
    if T.determinant().is_zero:
        message = "the matrix has no inverse, so that T x are no coordinates of the state"
        raise InputError(message, where="specification.T", repair="give rows that are independent")
    chi = plant.matrices.A.characteristic_polynomial(plant.variable)
    answer: CanonicalAnswer = {**_moved(plant, T, T.inverse().normal()), "polynomial": chi, "blocks": ()}
    return InGivenCoordinates(plant, "basis", answer, GIVEN)


@task
def canonical_form(
    plant: StateSpace, *, kind: Name | None = None, T: MatrixText = None, method: Name = "auto"
) -> Result:
    """Return the controllable, observable or modal canonical form, x̄ = T x, or the plant in given coordinates.

    plant    n states; one input for "controllable", one output for "observable"; only A for "modal"
    kind     controllable: ones above the diagonal, −aₙ … −a₁ in the last row, B̄ = eₙ; observable: its transpose, C̄ = eₙᵀ;
             modal: block diagonal and real, a block for each elementary divisor of A over Q(parameters), B̄ of one input
             with a single 1 in each block where the pair is controllable;
             controllable where neither kind nor T is given
    T        n×n with an inverse, in the place of a kind: the plant in the coordinates T x
    Returns T, A, B, C, D, polynomial.  Raises `InputError` where a matrix is missing or there are several inputs (outputs).
    Source: T. Kailath, Linear Systems, ch. 2.
    """
    if T is not None:
        if kind is not None:
            message = "both T and kind are given, and each of them says which coordinates"
            raise InputError(message, where="specification.T", repair="keep one of them")
        plant = plant.knowing(T)
        plant, (given_T,) = in_common_field(plant, read_gain(T, plant, "T", (plant.order, plant.order)))
        choose("canonical_form", method, "basis")
        return in_coordinates(plant, given_T)
    kind = kind or "controllable"
    if kind not in KINDS:
        message, near = f"{str(kind)[:40]!r} is not a canonical form", get_close_matches(str(kind)[:40], KINDS, 1)
        question = f"did you mean {near[0]}? " if near else ""
        raise InputError(message, where="specification.kind", repair=f"{question}write one of {', '.join(KINDS)}")
    if kind != "modal":
        part, count, name = ("B", plant.inputs, "inputs") if kind == "controllable" else ("C", plant.outputs, "outputs")
        plant.require(part, task="canonical_form")
        if count != 1:
            message = f"the plant has {count} {name}, and the {kind} canonical form is that of one"
            raise InputError(message, where=f"plant.{part}", repair='keep one of them, or write kind = "modal"')
    return choose("canonical_form", method, "basis").solve(plant, kind)


# Changes of coordinates x̄ = T x: bases of the controllable and unobservable subspaces, and their page parts.


#: The four parts in the order of the blocks: controllable and observable, controllable and not observable, and so on.
BLOCKS = ("co", "c_no", "nc_o", "nc_no")


def basis(A: Matrix, B: Matrix, C: Matrix, ideal: Ideal | None = None) -> tuple[Matrix, tuple[int, ...]]:
    """Return S, whose columns are bases of the four parts in the order of `BLOCKS`, and their dimensions."""
    order = A.shape[0]
    reach = modulo(power_rows(A.T, B.T).T, ideal)
    R = reach.select(range(order), echelon(reach, ideal)[0])
    O = modulo(power_rows(A, C), ideal)
    hidden = kernel(O, ideal)
    both = (R @ kernel(O @ R, ideal)).normal() if R.shape[1] else Matrix.zeros(order, 0)
    both = modulo(both, ideal)
    seen = _extension(both, _unit_first(R, ideal), ideal)
    rest_hidden = _extension(_beside(both, seen), hidden, ideal)
    others = _extension(_beside(both, seen, rest_hidden), Matrix.identity(order), ideal)
    parts = [_primitive(part) for part in (seen, both, others, rest_hidden)]
    return _beside(*parts).normal(), tuple(part.shape[1] for part in parts)


def _beside(*parts: Matrix) -> Matrix:
    return Matrix.block([list(parts)])


def _unit_first(R: Matrix, ideal: Ideal | None) -> Matrix:
    """Return other generators of the image of R, unit vectors of it first."""
    order = R.shape[0]
    units = []
    for i in range(order):
        unit = Matrix.unit(order, i)
        if R.shape[1] and len(echelon(_beside(R, unit), ideal)[0]) == R.shape[1]:
            units.append(unit)
    return _beside(*units, R) if units else R


def _primitive(vectors: Matrix) -> Matrix:
    """Return each column as polynomials without common factor, its first one beginning with a positive coefficient."""
    columns = []
    for column in vectors.T.rows:
        entries = primitive(column)
        first = next((entry for entry in entries if entry), Scalar.of(1))
        columns.append(entries if first.terms()[0][0] > 0 else [-entry for entry in entries])
    return Matrix.of([list(row) for row in zip(*columns, strict=True)], len(columns)) if columns else vectors


def _extension(given: Matrix, candidates: Matrix, ideal: Ideal | None) -> Matrix:
    """Return the candidates that extend given independent columns to a basis of what all of them span."""
    count, rows = given.shape[1], range(given.shape[0])
    pivots, _ = echelon(_beside(given, candidates), ideal)
    return candidates.select(rows, [j - count for j in pivots if j >= count])


def minor_of(matrix: Matrix, rank: int, ideal: Ideal | None = None) -> Matrix | None:
    """Return a square submatrix of full rank, which must have as many columns as the rank; None where that is 0."""
    if not rank:
        return None
    return matrix.select(independent_rows(matrix, ideal), range(rank))


def transfer_matrix(A: Matrix, B: Matrix, C: Matrix, D: Matrix, variable: str) -> Matrix:
    """Return C (sI − A)⁻¹ B + D, each entry in lowest terms."""
    order, (outputs, inputs) = A.shape[0], D.shape

    def entry(i: int, j: int) -> Scalar:
        if not order:
            return D[i, j]
        numerator, denominator = transfer(
            A, B.select(range(order), [j]), C.select([i], range(order)), D[i, j], variable
        )
        return numerator / denominator

    return Matrix.of([[entry(i, j) for j in range(inputs)] for i in range(outputs)], inputs)
