"""Parameter values at which the geometric multiplicity of a hidden eigenvalue increases.

The rank of [A − λI; C] at an eigenvalue is n less the dimension of ker(X − λI), X being A on ker 𝒪.  It is the generic one
wherever ker 𝒪 is and the minors of X − λI of the generic order do not vanish together.  Where they do, is an equation in the
parameters once λ is eliminated: two eigenvalues meet there, or a chain of principal vectors breaks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import EIGENVALUE, Ideal, Matrix, Scalar, TooLarge, echelon, independent_rows
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import Claim, verify
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition
from symobs.tasks.analysis.strata.loci import Locus, Region, distance_from, maximal
from symobs.tasks.analysis.strata.rank_cases import minors_claim, outside
from symobs.tasks.analysis.strata.rank_stratification import node_of
from symobs.tasks.analysis.strata.strata import region_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.rank_stratification import Minor
    from symobs.tasks.result import Case

#: Polynomials in the parameters that vanish together on a stratum.
System: TypeAlias = tuple[Scalar, ...]


@dataclass(frozen=True)
class RankConstancy:
    """The domain on which the rank at the roots of a factor is the generic one: the complement of some strata.

    The minors of X − λI never vanish together there.
    """

    systems: tuple[System, ...]
    minors: tuple[Minor, ...]


def distances(systems: Iterable[System]) -> tuple[Scalar, ...]:
    """Return for each stratum, of those that lie in no other, a polynomial that is 0 exactly there."""
    return tuple(distance_from(locus.equations) for locus in maximal(map(_locus_of, systems)))


def _locus_of(system: System) -> Locus:
    """Return the locus of a system, as it stands where its basis is too long."""
    try:
        return Locus.of(Ideal.of(system))
    except TooLarge:
        return Locus(system)


def systems_of(cases: Iterable[Case]) -> tuple[System, ...] | None:
    """Return the equations of cases; None where one of them is everywhere."""
    found = tuple(tuple(c.expression for c in case.when if c.operator == "==") for case in cases)
    return found if all(found) else None


def constancy(
    X: Matrix, factor: Scalar, dimension: int, plant: StateSpace, others: tuple[System, ...]
) -> RankConstancy | None:
    """Return where the rank is the generic one at the roots of an irreducible factor; None where that is not known.

    `dimension` is that of ker(X − λI) in general, and `others` are the strata on which ker 𝒪 is another.
    """
    try:
        return _constancy(X, factor, dimension, plant, others)
    except TooLarge:
        return None


def _constancy(
    X: Matrix, factor: Scalar, dimension: int, plant: StateSpace, others: tuple[System, ...]
) -> RankConstancy | None:
    own: tuple[System, ...] = ()
    minors: tuple[Minor, ...] = ()
    if X.shape[0] > dimension and X.names | factor.names > {plant.variable}:
        region = _at_roots(factor, plant)
        matrix = shifted(X, factor, plant.variable)
        columns = echelon(matrix, region.ideal)[0]
        rows = independent_rows(matrix.select(range(matrix.shape[0]), columns), region.ideal)
        if len(rows) != len(columns):  # the stratum is several, and a pivot vanishes on some of them
            return None
        node = node_of(matrix, region, (rows, columns))
        if node is None or len(columns) != X.shape[0] - dimension:
            return None
        minors = node.minors
        own = tuple(tuple(e for e in locus.equations if EIGENVALUE not in e.names) for locus in node.below)
    if not all(own):
        return None
    loci = maximal(Locus.of(Ideal.of(system)) for system in (*others, *own))
    found = RankConstancy(tuple(locus.equations for locus in loci), minors)
    claims = constancy_claims(found, X, factor, dimension, plant)
    return found if all(verify(c.relation, c.environment.with_relations(plant.relations))[0] for c in claims) else None


def _at_roots(factor: Scalar, plant: StateSpace) -> Region:
    """Return the parameters of a plant; with the eigenvalue among them where it is no function of the others."""
    region = region_of(plant)
    if factor.degree(plant.variable) == 1:
        return region
    equations = (*plant.equations, in_eigenvalue(factor, plant.variable))
    return Region(region.signs, region.nonzero, ideal=Ideal.of(equations))


def in_eigenvalue(factor: Scalar, variable: str) -> Scalar:
    """Return what vanishes at the eigenvalue."""
    return factor.substitute({variable: Scalar.symbol(EIGENVALUE)})


def shifted(X: Matrix, factor: Scalar, variable: str) -> Matrix:
    """Return X − λI times what its entries are divided by; λ is the root of a linear factor, else the generator."""
    order = Matrix.identity(X.shape[0])
    if factor.degree(variable) == 1:
        lead, constant = factor.coefficients(variable)
        pencil = X * lead + order * constant
    else:
        pencil = X - order * Scalar.symbol(EIGENVALUE)
    return (pencil * pencil.common_denominator()).normal()


def holds_where(where: RankConstancy) -> list[Condition]:
    """Return what must not vanish for a rank to be the generic one."""
    return [Condition("existence", distance) for distance in distances(where.systems)]


def constancy_claims(
    found: RankConstancy, X: Matrix, factor: Scalar, dimension: int, plant: StateSpace
) -> Iterator[Claim]:
    """Yield that outside the strata, which are not everything, the minors of X − λI never vanish together."""
    signs, region, excluded = plant.symbols.signs, region_of(plant), distances(found.systems)
    for distance in excluded:
        yield Claim(relation(distance, "!==", 0), Environment(signs=signs), f"{distance} is not zero in general")
    orders = {len(part) for minor in found.minors for part in minor}
    if X.shape[0] == dimension or not X.names | factor.names > {plant.variable}:
        return
    e = Environment(signs=signs)
    yield Claim(relation(len(orders), 1), e, "the minors are of one order")
    yield Claim(relation(*orders, X.shape[0] - dimension), e, "the minors of X - lambda*I have the order of its rank")
    matrix, q = shifted(X, factor, plant.variable), in_eigenvalue(factor, plant.variable)
    at_roots = (q,) if factor.degree(plant.variable) > 1 else ()
    e = Environment(signs=signs, relations=outside([*excluded, *region.nonzero], at_roots))
    yield from minors_claim(matrix, found.minors, e, f"where {q} = 0, outside the cases")
