"""The family of all gains for several outputs (inputs) as a result carries it: its parameters, and what proves it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term, letter
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.tasks.analysis.strata.loci import loci, maximal
from symobs.tasks.design.pole_placement.sylvester import charts_of, has_meaning

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.analysis.strata.loci import Region
    from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair
    from symobs.tasks.design.pole_placement.sylvester import Sylvester


def _coefficients(polynomial: Scalar, names: tuple[str, ...]) -> list[Scalar]:
    """Return the coefficients of a polynomial in some of its symbols that are not 0."""
    found = [polynomial]
    for name in names:
        found = [coefficient for value in found for coefficient in value.coefficients(name)]
    return [coefficient for coefficient in found if not coefficient.is_zero]


#: What the family leaves out.
SCOPE = "every gain whose closed-loop matrix is cyclic, but for those where det X = 0"


@dataclass(frozen=True)
class Family:
    """L = S (L₀ + (G X⁻¹)ᵀ) + N H: the seen part by Sylvester's equation, anything along the kernel N of 𝒪."""

    pair: MultiOutputPair
    equation: Sylvester
    names: tuple[str, ...]
    member: Matrix

    @staticmethod
    def of(pair: MultiOutputPair, desired: DesiredPolynomial, names: tuple[str, ...], member: Matrix) -> Family:
        """Return the family in the first chart that contains the member; in the first one where none does."""
        factors = pair.remaining(desired)
        assert factors is not None  # noqa: S101 - a member exists
        A, C, _ = pair.seen
        own = names[: A.shape[0] * (C.shape[0] - 1)]
        charts = charts_of(A, C, factors, pair.variable, own, pair.ideal)
        part = pair.part_of(member)
        inside = (chart for chart in charts if A.shape[0] and has_meaning(chart.free_entries(part), pair.ideal))
        return Family(pair, next(inside, charts[0]), names, member)

    @property
    def is_empty(self) -> bool:
        """Whether nothing is seen, so that every gain serves."""
        return not self.pair.seen[0].shape[0]

    @cached_property
    def own_G(self) -> Matrix | None:
        """The G of the member, None where it lies in no chart."""
        return None if self.is_empty else self.equation.free_entries(self.pair.part_of(self.member))

    @cached_property
    def H(self) -> Matrix:
        """What a gain does along the kernel."""
        outputs, hidden = self.pair.c.shape[0], self.pair.kernel.shape[1]
        free = iter([Scalar.symbol(name) for name in self.names[len(self.equation.names) :]])
        return Matrix.of([[next(free) for _ in range(outputs)] for _ in range(hidden)], outputs)

    @cached_property
    def general(self) -> Matrix | None:
        """The gain with its parameters; None where it is too long to be written out."""
        if self.equation.is_long:
            return None
        own = (self.pair.seen[2] @ self.equation.gain(self.equation.G)).normal() if not self.is_empty else None
        rest = self.pair.kernel @ self.H if self.pair.kernel.shape[1] else None
        parts = [part for part in (own, rest) if part is not None]
        return sum(parts[1:], start=parts[0]).normal()

    @cached_property
    def X(self) -> Matrix:
        """The solution of Sylvester's equation, with its parameters."""
        return self.equation.solution(self.equation.G)

    def scope(self, region: Region) -> str:
        """Return which gains the family consists of, and where in a region a denominator vanishes for each of them."""
        if self.general is None:
            return f"{SCOPE}; where none of them has a value is not decided"
        factors = (factor for factor, _ in self.general.common_denominator().factors()[1])
        lost = maximal(locus for factor in factors for locus in loci(_coefficients(factor, self.names), region))
        found = [" and ".join(f"{equation} == 0" for equation in locus.equations) for locus in lost]
        return f"{SCOPE}; none of them has a value where {', or where '.join(found)}" if found else SCOPE

    def fields(self, name: str, transposed_for_task: Callable[[Matrix], Matrix]) -> dict[str, Any]:
        """Return the fields of the family in results: those of the contract, then what they come from."""
        general = None if self.general is None else transposed_for_task(self.general)
        found: dict[str, Any] = {"parameters": self.names, name: general, "dimension": len(self.names)}
        if self.is_empty:
            return found
        shift = self.equation.shift
        sources = {"F": self.equation.F, "G": self.equation.G, "X": self.X, "scope": SCOPE}
        return found | sources | {"shift": None if shift is None else transposed_for_task(shift)}

    def claims(
        self, transposed_for_task: Callable[[Matrix], Matrix], answer: Mapping[str, Any] | None
    ) -> Iterator[Claim]:
        """Yield (A − L₀C)ᵀX − XF = CᵀG and (L − L₀)ᵀX = G for the seen part: L determines G, so no parameter is idle.

        w G = e₁ᵀ, and e₁ᵀ, e₁ᵀF, … are the rows of I: with both equations r = w Lᵀ has [r; rM; …] X = I, M = (A − LC)ᵀ.
        """
        if self.is_empty or answer is None:
            return
        A, C, _ = self.pair.seen
        values = {"A": A, "C": C, "F": answer["F"], "G": answer["G"], "X": answer["X"]}
        if answer["shift"] is not None:
            values |= {"A": A - transposed_for_task(answer["shift"]) @ C}
        if self.general is not None:
            part = self.pair.part_of(self.general)
            values["L"] = part if answer["shift"] is None else part - transposed_for_task(answer["shift"])
        e = Environment(variable=self.pair.variable, values=values)
        A_, C_, F, G, X = (letter(name, e) for name in ("A", "C", "F", "G", "X"))
        yield Claim(relation(A_.T @ X - X @ F, C_.T @ G), e, "A.T*X - X*F = C.T*G")
        if self.general is not None:
            yield Claim(relation(letter("L", e).T @ X, G), e, "L.T*X = G")
        weights, first = Matrix.row(self.equation.weights), Matrix.unit(A.shape[0], 0).T
        yield Claim(relation(Term(Literal(weights), e) @ G, first), e, "w*G = [1, 0, ..., 0]")
        yield Claim(relation(X.apply("det"), "!==", 0), e, "det(X) is not zero identically")
        rows = len(answer["parameters"]) - self.H.shape[0] * self.H.shape[1]
        yield Claim(relation(rows, A.shape[0] * (C.shape[0] - 1)), e, "G has n*(p - 1) parameters")
