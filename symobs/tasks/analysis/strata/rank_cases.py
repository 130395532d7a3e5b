"""The cases of a rank: the strata of a `RankTree` as plants, conditions and claims.

A stratum on which the equations can be solved for parameters is a plant of its own; on another the plant stays and the
claims hold modulo the equations.  That the cases are all is claimed too: outside every locus the minors of the generic
order do not vanish together, and what is excluded from a stratum lies on the loci below it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, apart_from_zero, primitive
from symobs.exact.core.generators import letters_outside
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition
from symobs.system.reading import is_identity
from symobs.tasks.analysis.strata.rank_stratification import (
    Kernel,
    Minor,
    Node,
    cuts_out,
    exclusions,
    maximal_minors,
    with_restriction,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from symobs.tasks.analysis.strata.loci import Locus, Region
    from symobs.tasks.analysis.strata.rank_stratification import Tree


@dataclass(frozen=True)
class Piece:
    """The parameters for which a rank and a kernel are claimed, and minors that never vanish together there."""

    conditions: tuple[Condition, ...] = ()
    minors: tuple[Minor, ...] = ()

    def relations(self, nonzero: Iterable[Scalar]) -> tuple[Scalar, ...]:
        """Return the relations of the piece; p ≠ 0 is written as 1 − w p = 0 with a new name w."""
        equations = tuple(c.expression for c in self.conditions if c.operator == "==")
        others = [c.expression for c in self.conditions if c.operator == "!="]
        return outside([*others, *nonzero], equations)


def outside(excluded: Iterable[Scalar], equations: Iterable[Scalar] = ()) -> tuple[Scalar, ...]:
    """Return relations that hold where the equations do and none of some polynomials vanishes."""
    distinct = [value for value in dict.fromkeys(excluded) if not value.is_constant]
    return (*equations, *map(apart_from_zero, distinct))


@dataclass(frozen=True)
class RankStratum:
    """A node with its conditions on the parameters, and the parameters that they are solved for, if they can be."""

    node: Node
    when: tuple[Condition, ...]
    substitution: Mapping[str, Scalar] | None


def stratum_of(node: Node, region: Region) -> RankStratum:
    """Return equations and inequations of a node, and a parametrisation of it."""
    equations = [*equations_of_locus(node.locus)]
    others = [Condition("existence", value) for value in exclusions(node, region)]
    return RankStratum(node, (*equations, *others), parametrised(node, region))


def parametrised(node: Node, region: Region) -> dict[str, Scalar] | None:
    """Return the values of some parameters in the others wherever a node holds, or None where no equation is linear.

    The leading coefficient of a parameter must not vanish there; one that never vanishes is preferred.
    """
    values: dict[str, Scalar] = {}
    left = list(node.locus.equations)
    while left:
        found = _linear(left, node, region)
        if found is None:
            return None
        name, value = found
        values = {known: entry.substitute({name: value}) for known, entry in values.items()} | {name: value}
        images = [equation.substitute({name: value}).numerator for equation in left]
        left = [math.prod(region.vanishing(image), start=Scalar.of(1)) for image in images if not image.is_zero]
    return values


def _linear(equations: list[Scalar], node: Node, region: Region) -> tuple[str, Scalar] | None:
    possible = []
    for equation in equations:
        for name in letters_outside(equation):
            if equation.degree(name) == 1:
                lead, constant = equation.coefficients(name)
                if not region.vanishing(lead):
                    return name, -constant / lead
                possible.append((name, lead, constant))
    for name, lead, constant in possible:
        if cuts_out(lead, node, region):
            return name, -constant / lead
    return None


def answer_on(matrix: Matrix, A: Matrix, stratum: RankStratum, values: Mapping[str, Scalar]) -> dict[str, object]:
    """Return the answer of a rank test on a stratum, the parameters in `values` put in."""
    node, kernel = stratum.node, stratum.node.kernel
    assert kernel is not None  # noqa: S101 - nodes of a tree have kernels
    if values and kernel.basis.shape[1]:
        columns = [
            primitive(entry.substitute(values) for entry in kernel.basis.select(range(A.shape[0]), [j]).entries)
            for j in range(kernel.basis.shape[1])
        ]
        N = Matrix.of([[column[i] for column in columns] for i in range(A.shape[0])], len(columns))
        kernel = with_restriction(N, A.substitute(values))
    return answer_with(matrix.substitute(values).normal() if values else matrix, node.rank, kernel, node.minors[0])


def answer_with(matrix: Matrix, rank: int, kernel: Kernel, minor: Minor) -> dict[str, object]:
    """Return an answer of a rank test."""
    return {
        "matrix": matrix,
        "rank": rank,
        "kernel": kernel.basis,
        "restricted": kernel.restricted,
        "rows": minor[0],
        "columns": minor[1],
        "free": kernel.free,
    }


def piece_of(stratum: RankStratum, values: Mapping[str, Scalar], region: Region) -> Piece:
    """Return the conditions of a stratum after a substitution."""
    left: dict[Condition, None] = {}
    for condition in stratum.when:
        value = condition.expression.substitute(values).numerator
        if condition.operator == "==":
            if not value.is_zero:
                left[Condition("existence", value, "==")] = None
            continue
        for factor in region.vanishing(value):
            left[Condition("existence", factor)] = None
    return Piece(tuple(left), stratum.node.minors)


# -- the cases are all ---------------------------------------------------------------------------------------------------


def generic_claims(matrix: Matrix, tree: Tree, region: Region) -> Iterator[Claim]:
    """Yield that outside the loci the minors of the generic order do not vanish together and the kernel holds."""
    node = tree.generic
    kernel = node.kernel
    assert kernel is not None  # noqa: S101 - nodes of a tree have kernels
    distances = [locus.distance for locus in dict.fromkeys(node.covers)]
    if node.minors[0][0] and matrix.select(*node.minors[0]).determinant().numerator in distances:
        return
    e = Environment(relations=outside([*distances, *region.nonzero]), signs=region.signs)
    yield from minors_claim(matrix, node.minors, e, "outside the cases")
    yield from kernel_claims(kernel.basis, kernel.restricted, e, "outside the cases")


def minors_claim(matrix: Matrix, minors: Iterable[Minor], e: Environment, where: str) -> Iterator[Claim]:
    """Yield that at every point where the relations hold one of the minors is not zero."""
    chosen = list(minors)
    if chosen[0][0]:
        values = Matrix.column([matrix.select(*minor).determinant() for minor in chosen])
        yield _never_zero(values, e, f"minors of order {len(chosen[0][0])} never vanish together {where}")


def kernel_claims(N: Matrix, X: Matrix, e: Environment, where: str) -> Iterator[Claim]:
    """Yield that the columns of N are independent and X has a meaning at every point where the relations hold."""
    if not N.shape[1]:
        return
    yield _never_zero(Matrix.column(maximal_minors(N)), e, f"the columns of N are independent {where}")
    below = X.common_denominator()
    if not below.is_constant:
        yield _never_zero(Matrix.column([below]), e, f"no denominator of X vanishes {where}")


def stratum_claims(stratum: RankStratum, region: Region) -> Iterator[Claim]:
    """Yield the claims that the stratum excludes only the loci below, and that its parametrisation covers it."""
    node, equations = stratum.node, stratum.node.locus.equations
    distances = [locus.distance for locus in dict.fromkeys(node.covers)]
    excluded = [c.expression for c in stratum.when if c.operator == "!="]
    for value in excluded:
        if any(value == distance for distance in distances):
            continue
        e = Environment(relations=outside([*distances, *region.nonzero]), signs=region.signs)
        both = Matrix.column([*equations, value])
        yield _never_zero(both, e, f"where {_listed(equations)}, {value} vanishes in further cases only")
    inside = Environment(relations=outside([*excluded, *region.nonzero], equations), signs=region.signs)
    for name, value in (stratum.substitution or {}).items():
        if not value.denominator.is_constant:
            below = Matrix.column([value.denominator])
            yield _never_zero(below, inside, f"where {_listed(equations)}, {value.denominator} does not vanish")
        solved = relation(Scalar.symbol(name) * value.denominator, value.numerator)
        yield Claim(solved, inside, f"where {_listed(equations)}, {name} = {value}")


def _never_zero(values: Matrix, e: Environment, says: str) -> Claim:
    return Claim(relation(values, "!=", Matrix.zeros(*values.shape)), e, says)


def _listed(equations: Iterable[Scalar]) -> str:
    return " and ".join(f"{equation} = 0" for equation in equations)


def equations_of_locus(locus: Locus) -> tuple[Condition, ...]:
    """Return the equations of a locus, without those that hold everywhere because of what their functions are."""
    return tuple(Condition("existence", value, "==") for value in locus.equations if not is_identity(value))
