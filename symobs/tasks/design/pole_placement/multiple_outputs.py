"""Placing the poles of A − L C for several outputs: one gain that is easy to read, and the family of all.

Where (C, A) is not observable the hidden modes stay, and φ can be assigned exactly when their polynomial divides it: the
seen part is given the rest of φ, and a gain may have anything along ker 𝒪.
"""

from __future__ import annotations

from functools import cached_property
from itertools import permutations
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, factored, independent_rows, primitive_kernel, rank, unit_rows
from symobs.exact.core.generators import NotWritten, symbols_in
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.analysis.strata.loci import loci, maximal
from symobs.tasks.design.pole_placement.brunovsky_chains import BrunovskyChains, cost, simple_gains, split_polynomial
from symobs.tasks.design.pole_placement.single_output import ObserverPair
from symobs.tasks.design.pole_placement.sylvester import charts_of, has_meaning
from symobs.tasks.result import equality, holds

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.analysis.strata.loci import Region
    from symobs.tasks.design.pole_placement.sylvester import Sylvester


def pair_of(A: Matrix, C: Matrix, variable: str, equations: tuple[Scalar, ...] = ()) -> ObserverPair:
    """Return the pair (A, C): unique gain for one output if observable, families for several outputs."""
    return (ObserverPair if C.shape[0] == 1 else MultiOutputPair)(A, C, variable, equations)


@dataclass
class MultiOutputPair(ObserverPair):
    """A matrix A and several output rows c."""

    @cached_property
    def matrix(self) -> Matrix:
        """𝒪."""
        return power_rows(self.A, self.c)

    @cached_property
    def kernel(self) -> Matrix:
        """A basis of ker 𝒪 as columns."""
        return primitive_kernel(self.matrix, self.ideal)

    @property
    def decisive(self) -> tuple[Scalar, ...]:
        """Nothing: the rank of 𝒪 drops where several minors vanish together, which the rank test decides."""
        return ()

    @property
    def is_observable(self) -> bool:
        """Whether 𝒪 has rank n."""
        return not self.kernel.shape[1]

    @cached_property
    def seen(self) -> tuple[Matrix, Matrix, Matrix]:
        """(A, C) of the seen part, and S: a gain Lₒ of it is the gain S Lₒ of the whole."""
        if self.is_observable:
            return self.A, self.c, Matrix.identity(self.A.shape[0])
        order, outputs = self.A.shape[0], self.c.shape[0]
        rows = independent_rows(self.matrix, self.ideal)
        size = len(rows)
        others = unit_rows(order, independent_rows(self.kernel, self.ideal))
        T = Matrix.block([[self.matrix.select(rows, range(order))], [others]] if size else [[others]])
        inverse = T.inverse()
        A, C = (T @ self.A @ inverse).normal(), (self.c @ inverse).normal()
        return (
            A.select(range(size), range(size)),
            C.select(range(outputs), range(size)),
            inverse.select(range(order), range(size)).normal(),
        )

    def remaining(self, desired: DesiredPolynomial) -> tuple[Scalar, ...] | None:
        """Return the factors of φ over the fixed polynomial, None where it does not divide φ."""
        if self.is_observable:
            return desired.factors
        quotient, rest = self.divided(desired.polynomial)
        if not rest.is_zero:
            return None
        return tuple(f for f, power in factored(quotient, self.variable).factors for _ in range(power))

    def gain(self, desired: DesiredPolynomial) -> Matrix | None:
        """Return a gain with det(sI − A + L C) = φ(s) that is easy to read, or None where there is none.

        It lies in a chart of the family: the easiest one of all need not be cyclic.
        """
        factors = self.remaining(desired)
        if factors is None:
            return None
        A, C, S = self.seen
        if not A.shape[0]:
            return Matrix.zeros(self.A.shape[0], C.shape[0])
        simple = dict.fromkeys(simple_gains(A, C, factors, self.variable, self.ideal))
        found = sorted((L for L in simple if has_meaning(L, self.ideal)), key=cost) or list(simple)
        charts = charts_of(A, C, factors, self.variable, (), self.ideal)
        inside = (L for L in found if any(has_meaning(chart.free_entries(L), self.ideal) for chart in charts))
        return (S @ next(inside, found[0])).normal()

    @property
    def freedom(self) -> int:
        """How many dimensions the family has: nₒ (p − 1) for the seen part, (n − nₒ) p for the rest."""
        outputs, hidden = self.c.shape[0], self.kernel.shape[1]
        return (self.A.shape[0] - hidden) * (outputs - 1) + hidden * outputs

    def part_of(self, gain: Matrix) -> Matrix:
        """Return Lₒ of a gain: what it does to the seen part."""
        if self.is_observable:
            return gain
        rows = independent_rows(self.matrix, self.ideal)
        return (self.matrix.select(rows, range(self.A.shape[0])) @ gain).normal()


# The decoupled member of the family: each output error (each input's part) obeys an equation of its own.
#
# A gain decouples where the orders of 𝒪(A − LC, cᵢ) add up to n.


class NotDecoupled(InputError, NotWritten):
    """No gain found decouples; a case of a result is undecided there."""


def decoupled_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return the simplest gain that gives each chain factors of φ of its own and decouples the outputs.

    Raises `NotDecoupled` where a mode is fixed or no chains decouple.
    """
    where = "specification.member"
    if not pair.is_observable:
        message = "a decoupled gain is looked for where no mode is fixed"
        raise NotDecoupled(message, where=where, repair="leave member out, or give zero")
    gains = chain_gains(pair, desired)
    found = [gain for gain in gains if sum(rank(rows) for rows in _own_rows(pair, gain)) == pair.A.shape[0]]
    if not found:
        message = "no chains of the plant decouple the outputs with these poles"
        raise NotDecoupled(message, where=where, repair="leave member out, or say with zero what is to vanish")
    return min(found, key=cost)


def chain_gains(pair: ObserverPair, desired: DesiredPolynomial) -> Iterator[Matrix]:
    """Yield the gains of an observable pair that give each chain factors of φ of its own."""
    tried = set()
    for order in permutations(range(pair.c.shape[0])):
        chains = BrunovskyChains.of(pair.A, pair.c, order)
        if chains.by_output in tried:
            continue  # in another order the same chains share the same factors
        tried.add(chains.by_output)
        for share in split_polynomial(desired.factors, chains.lengths, pair.variable):
            yield chains.gain(chains.shared(share, "nothing"), pair.c.shape[0])


def decoupled_claim(pair: ObserverPair, gain: Matrix) -> Claim:
    """Return the claim that the orders of the output errors add up to n."""
    e = Environment(variable=pair.variable)
    first, *others = (Term(Literal(rows), e).apply("rank") for rows in _own_rows(pair, gain))
    added = relation(sum(others, start=first), pair.A.shape[0])
    return Claim(added, e, "the orders of the output errors add up to n")


def _own_rows(pair: ObserverPair, gain: Matrix) -> Iterator[Matrix]:
    """Yield 𝒪(A − LC, cᵢ) for each output."""
    closed = (pair.A - gain @ pair.c).normal()
    for i in range(pair.c.shape[0]):
        yield power_rows(closed, pair.c.select([i], range(pair.A.shape[0])))


# The family of all gains for several outputs (inputs) as a result carries it: its parameters, and what proves it.


def _coefficients(polynomial: Scalar, names: tuple[str, ...]) -> list[Scalar]:
    """Return the coefficients of a polynomial in some of its symbols that are not 0."""
    found = [polynomial]
    for name in names:
        found = [coefficient for value in found for coefficient in value.coefficients(name)]
    return [coefficient for coefficient in found if not coefficient.is_zero]


#: What the family leaves out.
SCOPE = "every gain whose closed-loop matrix is cyclic, but for those where det X = 0"


@dataclass
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
        if self.general is None and (self.pair.A.names or self.pair.c.names):
            return f"{SCOPE}; where none of them has a value is not decided"
        if self.general is None or symbols_in(self.general) <= {
            *self.names
        }:  # a denominator vanishes for some of them only
            return SCOPE
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
        G = e["G"]
        yield holds(e, "A.T X - X F = C.T G")
        if self.general is not None:
            yield holds(e, "L.T X = G")
        weights, first = Matrix.row(self.equation.weights), Matrix.unit(A.shape[0], 0).T
        yield equality(Term(Literal(weights), e) @ G, first, e)
        yield holds(e, "det(X) !== 0")
        rows = len(answer["parameters"]) - self.H.shape[0] * self.H.shape[1]
        yield equality(rows, A.shape[0] * (C.shape[0] - 1), e, "G has n*(p - 1) parameters")
