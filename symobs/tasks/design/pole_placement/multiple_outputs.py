"""Placing the poles of A − L C for several outputs: one gain that is easy to read, and the family of all.

Where (C, A) is not observable the hidden modes stay, and φ can be assigned exactly when their polynomial divides it: the
seen part is given the rest of φ, and a gain may have anything along ker 𝒪.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact import Matrix, factored, independent_rows, primitive_kernel, unit_rows
from symobs.ground.dataclass import dataclass
from symobs.tasks.analysis.rank.rank_test import power_rows
from symobs.tasks.design.pole_placement.brunovsky_chains import cost, simple_gains
from symobs.tasks.design.pole_placement.single_output import ObserverPair
from symobs.tasks.design.pole_placement.sylvester import charts_of, has_meaning

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.system.specification import DesiredPolynomial


def pair_of(A: Matrix, C: Matrix, variable: str, equations: tuple[Scalar, ...] = ()) -> ObserverPair:
    """Return the pair (A, C): unique gain for one output if observable, families for several outputs."""
    return (ObserverPair if C.shape[0] == 1 else MultiOutputPair)(A, C, variable, equations)


@dataclass(frozen=True)
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
