"""Kalman decomposition in four parts: reached and seen (co), reached and hidden (c_no), and the same not reached.

With R the reachable subspace, the image of 𝒞, and N = ker 𝒪, the columns of S = T⁻¹ are bases of a complement of R ∩ N in
R, of R ∩ N, of a complement of R + N, and of a complement of R ∩ N in N, in the order co, c_no, nc_o, nc_no.  Then

    Ā = [A₁₁  0   A₁₃  0 ;  A₂₁ A₂₂ A₂₃ A₂₄ ;  0  0  A₃₃  0 ;  0  0  A₄₃ A₄₄],   B̄ = [B₁; B₂; 0; 0],   C̄ = [C₁ 0 C₃ 0].

Without an output nothing is seen, N is the whole space, and R splits it in two; without an input R = 0, and N does.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.exact import Matrix, Scalar, modulo
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term, block
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import Builder, relation
from symobs.system.conditions import Condition, joined, nonzero, vanishing_factors
from symobs.tasks.analysis.page_parts import case_steps, factored_form, given, in_blocks
from symobs.tasks.analysis.rank.observability import power_rows
from symobs.tasks.analysis.realization.canonical_form import BLOCKS, basis, minor_of, transfer_matrix
from symobs.tasks.analysis.strata.strata import strata
from symobs.tasks.result import Case, Result, choose, equality, holds, method, task

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.system import StateSpace
    from symobs.system.specification import Name

#: The blocks (to, from) of Ā that are 0: nothing leads out of R, and nothing out of N.
ZEROS = ((0, 1), (0, 3), (2, 0), (2, 1), (2, 3), (3, 0), (3, 1))


@dataclass
class Decomposition(Result):
    """The plant in coordinates x̄ = T x that separate the four parts, and its minimal transfer function.

    Claims: T S = I, Ā = T A S, B̄ = T B, C̄ = C S; the blocks that must be 0 are 0; minors show that what should be
    reached is reached and what should be seen is seen; C₁ (sI − A₁₁)⁻¹ B₁ + D = C (sI − A)⁻¹ B + D = the transfer function.
    """

    task: ClassVar[str] = "decomposition"
    answered_by = ("T", "sizes")
    only_value = ("minimal_order",)
    in_coordinates = ("T", "A", "B", "C", "sizes")
    letters = {
        "T": "T",
        "A": "A_bar",
        "B": "B_bar",
        "C": "C_bar",
        "D": "D",
        "transfer_function": "P",
    }

    @property
    def as_plant(self) -> StateSpace:
        """The plant in these coordinates, where they are some."""
        answer, m = self.answer, self.plant.matrices
        B, C = answer["B"] if m.has_input else None, answer["C"] if m.has_output else None
        nonzero = [c.expression for c in self.holds_where]
        return self.plant.in_coordinates(answer["A"], B, C, answer["D"], nonzero)

    @property
    def dimensions(self) -> tuple[int, ...]:
        """The dimensions of the four parts."""
        found: tuple[int, ...] = self.answer["sizes"]
        return found

    @property
    def parts(self) -> Mapping[str, int]:
        """The dimensions by name: of a plant without input or output those of its two parts."""
        if self._is_whole:
            return dict(zip(BLOCKS, self.dimensions, strict=True))
        _, reached, seen, rest = self.dimensions
        return {"c": reached, "no c": rest} if self.plant.matrices.has_input else {"o": seen, "no o": rest}

    @property
    def _is_whole(self) -> bool:
        """Whether the plant has input and output."""
        return self.plant.matrices.has_input and self.plant.matrices.has_output

    def part(self, *blocks: int) -> list[int]:
        """Return the indices of the states of some parts."""
        starts = [sum(self.dimensions[:k]) for k in range(4)]
        return [i for k in blocks for i in range(starts[k], starts[k] + self.dimensions[k])]

    def claims(self) -> Iterator[Claim]:
        """Yield the change of coordinates, the zero pattern, the minors, the transfer function."""
        m, answer, n = self.plant.matrices, self.answer, self.plant.order
        names = {"A_bar": "A", "B_bar": "B", "C_bar": "C", "D_bar": "D", "T": "T", "S": "inverse"}
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D} | {name: answer[key] for name, key in names.items()}
        e = Environment(variable=self.plant.variable, values=values)
        yield holds(e, "T S = I")
        yield holds(e, "A_bar = T A S")
        if m.has_input:
            yield holds(e, "B_bar = T B")
        if m.has_output:
            yield holds(e, "C_bar = C S")
        if self._is_whole:
            yield holds(e, "D_bar = D")
        yield equality(Scalar.of(sum(self.dimensions)), n, e, "the parts make up the whole")
        yield equality(answer["minimal_order"], self.dimensions[0], e, "the order is that of the first part")
        for to, out in ZEROS:
            yield from self._zero("A_bar", self.part(to), self.part(out), e)
        yield from self._zero("B_bar", self.part(2, 3), range(self.plant.inputs), e)
        yield from self._zero("C_bar", range(self.plant.outputs), self.part(1, 3), e)
        yield from self._minors(e)
        if self._is_whole:
            yield from self._transfer(e)

    def _zero(self, name: str, rows: Any, columns: Any, e: Environment) -> Iterator[Claim]:
        rows, columns = list(rows), list(columns)
        if rows and columns:
            entries = Term(Literal(e.value(name).select(rows, columns)), e)  # type: ignore[union-attr]
            says = f"{name}: rows {rows} do not depend on columns {columns}"
            yield equality(entries, Matrix.zeros(len(rows), len(columns)), e, says)

    def _minors(self, e: Environment) -> Iterator[Claim]:
        """Yield that the parts that should be reached are controllable, and those that should be seen observable."""
        for minor, says in ((self._reaching, "reached"), (self._seeing, "seen")):
            if minor is not None:
                yield Claim(
                    relation(Term(Literal(minor), e).apply("det"), "!==", 0), e, f"what should be {says} is {says}"
                )

    @cached_property
    def _reaching(self) -> Matrix | None:
        """A minor of the order of co and c_no of their controllability matrix."""
        there = self.part(0, 1)
        A, B = self.answer["A"].select(there, there), self.answer["B"].select(there, range(self.plant.inputs))
        return minor_of(power_rows(A.T, B.T), len(there), self.plant.ideal)

    @cached_property
    def _seeing(self) -> Matrix | None:
        """A minor of the order of co and nc_o of their observability matrix."""
        there = self.part(0, 2)
        A, C = self.answer["A"].select(there, there), self.answer["C"].select(range(self.plant.outputs), there)
        return minor_of(power_rows(A, C), len(there), self.plant.ideal)

    def _transfer(self, e: Environment) -> Iterator[Claim]:
        first, inputs, outputs = self.part(0), range(self.plant.inputs), range(self.plant.outputs)
        A1 = self.answer["A"].select(first, first)
        B1, C1 = self.answer["B"].select(first, inputs), self.answer["C"].select(outputs, first)
        e = e.extended_by(values={"P": self.answer["transfer_function"], "A_co": A1, "B_co": B1, "C_co": C1})
        yield holds(e, "P = C pencil(A)^-1 B + D")
        if first:
            yield holds(e, "P = C_co pencil(A_co)^-1 B_co + D")
        else:
            yield holds(e, "P = D")

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """The minors of 𝒞 and 𝒪 and the determinant of S: where they do not vanish the parts are the generic ones."""
        minors = [m.determinant() for m in (self._reaching, self._seeing) if m is not None]
        return (*minors, self.answer["inverse"].determinant(), self.answer["inverse"].common_denominator())

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, and where the parts have the generic dimensions in these coordinates."""
        entries = [value.common_denominator() for value in self.answer.values() if isinstance(value, Matrix)]
        claimed = [
            f for f in vanishing_factors(entries, self.plant.symbols.signs) if self.plant.variable not in f.names
        ]
        factors = dict.fromkeys((*vanishing_factors(self.existence, self.plant.symbols.signs), *claimed))
        return joined(self.domain, nonzero("existence", factors))

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The decomposition on every stratum where that of the plant in general may not hold."""
        factors = [c.expression for c in self.holds_where if c.kind == "existence"]
        return strata(self.plant, factors, lambda plant, _: solve(plant, self.method))

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The change of coordinates, the four matrices in it, the sizes, the minimal order and transfer function."""
        m = self.plant.matrices
        missing = {"B": m.has_input, "C": m.has_output, "D": self._is_whole}
        found = {key: self.answer[key] for key in "TABCD" if missing.get(key, True)} | {"sizes": self.parts}
        if not self._is_whole:
            return found
        P: Matrix = self.answer["transfer_function"]
        found["minimal_order"] = self.answer["minimal_order"]
        return found | {"transfer_function": P[0, 0] if P.shape == (1, 1) else P}

    def write(self, page: Builder) -> None:
        """Write the two subspaces, the basis, the plant in it, and its minimal part."""
        given(page)
        with page.section("decomposition"):
            self._subspaces(page)
            self._coordinates(page)
            conditions = [c.expression for c in self.holds_where if c.kind == "existence"]
            if conditions:
                page.assume("structure_provided", *conditions)
            self._minimal(page)
            page.steps += case_steps(page, self, lambda inner, found: found.write_form(inner))

    def _subspaces(self, page: Builder) -> None:
        A, B, C, n = page["A"], page["B"], page["C"], range(1, self.plant.order)
        m = self.plant.matrices
        if m.has_input:
            reach = page.term(block([[B, *(A**k @ B for k in n)]]).formula)
            page.define("Ctr", reach, say="reached_and_hidden" if m.has_output else "reached_alone")
        if m.has_output:
            see = page.term(block([[C], *([C @ A**k] for k in n)]).formula)
            page.define("O", see, say="" if m.has_input else "hidden_alone")

    def _coordinates(self, page: Builder) -> None:
        m = self.plant.matrices
        say = "basis_blocks" if self._is_whole else "basis_reached" if m.has_input else "basis_seen"
        page.define("S", page.value(self.answer["inverse"]), say=say, sizes=", ".join(map(str, self.parts.values())))
        page.define("T", "S^-1", say="", answer=True)
        sizes, inputs, outputs = self.dimensions, [self.plant.inputs], [self.plant.outputs]
        parts = {name: self.answer[name] for name in "ABC"}
        page.define(
            "A_bar",
            "T A S",
            in_blocks(page, parts["A"], sizes, sizes),
            say="decomposed",
            answer=True,
            closing=False,
        )
        if m.has_input:
            page.define("B_bar", "T B", in_blocks(page, parts["B"], sizes, inputs), answer=True, closing=False)
        if m.has_output:
            page.define("C_bar", "C S", in_blocks(page, parts["C"], outputs, sizes), answer=True, closing=False)
        if self._is_whole:
            page.remark("zero_pattern")
        elif all(self.parts.values()):
            page.remark("zero_block_reached" if m.has_input else "zero_block_hidden")

    def _minimal(self, page: Builder) -> None:
        if not self._is_whole:
            return
        first = self.part(0)
        P: Matrix = self.answer["transfer_function"]
        value = factored_form(page, P[0, 0]) if P.shape == (1, 1) else page.value(P)
        direct = page["D"] if self.plant.matrices.has_feedthrough else None
        whole = page["C pencil(A)^-1 B"]
        whole = whole + direct if direct is not None else whole
        if not first:
            page.define("P", whole, value, say="nothing_remains", answer=True, closing=False)
            return
        m, p = range(self.plant.inputs), range(self.plant.outputs)
        page.set("A_co", self.answer["A"].select(first, first))
        page.set("B_co", self.answer["B"].select(first, m))
        page.set("C_co", self.answer["C"].select(p, first))
        own = page["C_co pencil(A_co)^-1 B_co"]
        own = own + direct if direct is not None else own
        page.define("P", whole, own, value, say="minimal_part", answer=True, closing=False)

    def write_form(self, page: Builder) -> None:
        """Write the coordinates and the minimal part, in a case."""
        self._coordinates(page)
        self._minimal(page)


def solve(plant: StateSpace, method_name: str) -> Decomposition:
    """Return the decomposition of a plant."""
    m = plant.matrices
    S, sizes = basis(m.A, m.B, m.C, plant.ideal)
    T = modulo(S.inverse().normal(), plant.ideal)
    A, B, C = (modulo(value.normal(), plant.ideal) for value in (T @ m.A @ S, T @ m.B, m.C @ S))
    first, P = range(sizes[0]), None
    if m.has_input and m.has_output:
        P = transfer_matrix(
            A.select(first, first),
            B.select(first, range(plant.inputs)),
            C.select(range(plant.outputs), first),
            m.D,
            plant.variable,
        )
    answer = {
        "T": T,
        "inverse": S,
        "A": A,
        "B": B,
        "C": C,
        "D": m.D,
        "sizes": sizes,
        "minimal_order": sizes[0],
        "transfer_function": P,
    }
    return Decomposition(plant, method_name, answer)


@method("decomposition/subspaces", source="kalman1962")
def subspaces(plant: StateSpace) -> Decomposition:
    """Bases of im 𝒞 ∩ ker 𝒪 and of its complements, by elimination."""
    return solve(plant, "subspaces")


@task
def decomposition(plant: StateSpace, *, method: Name = "auto") -> Result:
    """Split a plant into four parts: reached and seen, reached and hidden, not reached and seen, neither.

    plant    n states, m inputs, p outputs; B or C may be missing
    Returns T (x̄ = T x), A, B, C, D in the new coordinates, sizes (co, c_no, nc_o, nc_no, in the order of the blocks; c, no c
    without C, and o, no o without B), minimal_order, transfer_function in lowest terms; with parameters the generic parts
    and the cases.  Raises `InputError` where B and C are missing.  Source: R. E. Kalman, 1962.
    """
    if not plant.matrices.has_output:
        plant.require("B", task="decomposition")
    return choose("decomposition", method, "subspaces").solve(plant)
