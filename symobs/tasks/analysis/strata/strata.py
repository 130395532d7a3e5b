"""Strata: what becomes of a result where one irreducible factor of its existence condition vanishes.

Where the equations of a stratum can be solved for parameters the whole question is put again with these put in, and
elsewhere for the plant restricted to the stratum, whose claims hold modulo the equations.
"""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeAlias, TypedDict

from symobs.exact import (
    EIGENVALUE,
    Ideal,
    Matrix,
    Scalar,
    TooLarge,
    apart_from_zero,
    echelon,
    independent_rows,
    modulo,
    primitive,
)
from symobs.exact.core.generators import NotWritten, letters_outside
from symobs.formula.tree import Environment
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, Undecided
from symobs.proof.certificate.claims import Claim, verify
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, joined, never_zero, nonzero, vanishing_factors
from symobs.system.reading import is_identity
from symobs.tasks.analysis.strata.loci import Locus, Region, distance_from, loci, maximal
from symobs.tasks.analysis.strata.rank_stratification import (
    Kernel,
    Minor,
    Node,
    cuts_out,
    exclusions,
    maximal_minors,
    node_of,
    with_restriction,
)
from symobs.tasks.result import Case, Result, equality

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.system import StateSpace
    from symobs.tasks.analysis.strata.rank_stratification import Tree

    Solve: TypeAlias = Callable[[StateSpace, dict[str, Scalar]], Result | None]


# The cases of a rank: the strata of a `RankTree` as plants, conditions and claims.
#
# A stratum on which the equations can be solved for parameters is a plant of its own; on another the plant stays and
# the claims hold modulo the equations. That the cases are all is claimed too: outside every locus the minors of the
# generic order do not vanish together, and what is excluded from a stratum lies on the loci below it.


@dataclass
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


@dataclass
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

    The leading coefficient of a parameter must not vanish there; one that never vanishes is preferred.  None, too, where a
    function would have no argument: exp(a) for a = b/(1 - exp(b)) at b = 0.
    """
    values: dict[str, Scalar] = {}
    left = list(node.locus.equations)
    while left:
        found = _solvable_for_a_letter(left, node, region)
        if found is None:
            return None
        name, value = found
        try:
            values = {known: entry.substitute({name: value}) for known, entry in values.items()} | {name: value}
            images = [equation.substitute({name: value}).numerator for equation in left]
        except ZeroDivisionError:
            return None
        left = [math.prod(region.vanishing(image), start=Scalar.of(1)) for image in images if not image.is_zero]
    return values


def _solvable_for_a_letter(equations: list[Scalar], node: Node, region: Region) -> tuple[str, Scalar] | None:
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


class RankAnswer(TypedDict):
    """The test matrix, its rank r, a basis N of its kernel, X with A N = N X, an r×r minor, and rows of a minor of N."""

    matrix: Matrix
    rank: int
    kernel: Matrix
    restricted: Matrix
    rows: tuple[int, ...]
    columns: tuple[int, ...]
    free: tuple[int, ...]


def answer_on(matrix: Matrix, A: Matrix, stratum: RankStratum, values: Mapping[str, Scalar]) -> RankAnswer:
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


def answer_with(matrix: Matrix, rank: int, kernel: Kernel, minor: Minor) -> RankAnswer:
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
        yield _never_zero(both, e, f"in further cases only where {_listed(equations)}")
    inside = Environment(relations=outside([*excluded, *region.nonzero], equations), signs=region.signs)
    for name, value in (stratum.substitution or {}).items():
        if not value.denominator.is_constant:
            below = Matrix.column([value.denominator])
            yield _never_zero(below, inside, f"where {_listed(equations)}")
        solved = relation(Scalar.symbol(name) * value.denominator, value.numerator)
        yield Claim(solved, inside, f"where {_listed(equations)}")


def _never_zero(values: Matrix, e: Environment, says: str) -> Claim:
    return Claim(relation(values, "!=", Matrix.zeros(*values.shape)), e, says)


def _listed(equations: Iterable[Scalar]) -> str:
    return " and ".join(f"{equation} = 0" for equation in equations)


def equations_of_locus(locus: Locus) -> tuple[Condition, ...]:
    """Return the equations of a locus, without those that hold everywhere because of what their functions are."""
    return tuple(Condition("existence", value, "==") for value in locus.equations if not is_identity(value))


class Place(NamedTuple):
    """A stratum on which nothing is asked yet: its conditions, and the values of parameters where it is solved for them.

    Where it is not `open` nothing can be told of it.
    """

    when: tuple[Condition, ...]
    values: dict[str, Scalar] | None
    is_open: bool = True


def strata(plant: StateSpace, existence: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the factors of `existence` that can vanish; `solve` answers on the plant of the stratum.

    A case is undecided (its result is None) where its equations, or the claims of its answer, are beyond what can be
    checked.
    """
    found = solved(plant, places(plant, existence), solve)
    return tuple({frozenset(case.when): case for case in found}.values())


def places(plant: StateSpace, existence: Iterable[Scalar]) -> tuple[Place, ...]:
    """Return the strata where factors of `existence` vanish under the declared signs.

    Where a factor is linear in a parameter whose coefficient can vanish, there are two of it.
    """
    signs = plant.symbols.signs
    found: list[Place] = []
    region, equations = region_of(plant), plant.equations
    if plant.is_time_varying:  # cos² ωt + sin² ωt = 1 is no equation of parameters
        equations = tuple(equation for equation in equations if not is_identity(equation))
    for factor in vanishing_factors(existence, signs):
        if factor in region.nonzero:
            continue
        linear = None if equations else _linear(factor, signs)
        if linear is None:
            found += _below([factor], region)
            continue
        values, lead = linear
        zeros = region.vanishing(lead)
        when = (Condition("existence", factor, "=="), *(Condition("route", f) for f in zeros))
        found.append(Place(when, values))
        for f in zeros:
            found += _below([factor, f], region)
    return tuple({frozenset(place.when): place for place in found}.values())


def common_zeros(plant: StateSpace, equations: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the strata where several polynomials vanish together."""
    return solved(plant, common_places(plant, equations), solve)


def common_places(plant: StateSpace, equations: Iterable[Scalar]) -> tuple[Place, ...]:
    """Return the strata where several polynomials vanish together."""
    return tuple(_below(equations, region_of(plant)))


def equations_of(place: Place) -> frozenset[Scalar]:
    """Return what vanishes on a stratum."""
    return frozenset(condition.expression for condition in place.when if condition.operator == "==")


def region_of(plant: StateSpace) -> Region:
    """Return the parameters of a plant: with their signs, on its stratum, where its denominators do not vanish."""
    m, signs = plant.matrices, plant.symbols.signs
    domain = vanishing_factors([part.common_denominator() for part in (m.A, m.B, m.C, m.D)], signs)
    return Region(
        signs, frozenset((*domain, *vanishing_factors((*plant.nonzero, *plant.apart), signs))), ideal=plant.ideal
    )


def _below(equations: Iterable[Scalar], region: Region) -> Iterator[Place]:
    """Yield the common zeros of equations, with the values of parameters where they can be solved for them."""
    for locus in loci(equations, region):
        when = equations_of_locus(locus)
        if locus.ideal is None:
            yield Place(when, {}, is_open=False)
        elif locus != region.whole:
            yield Place(when, parametrised(Node(locus, 0, ()), region))


def losses(cases: Iterable[Case], above: tuple[Scalar, ...] = ()) -> Iterator[tuple[Scalar, ...]]:
    """Yield the equations of the strata on which the answer is no or unknown, those inside of a case with its own."""
    for case in cases:
        equations = (*above, *(c.expression for c in case.when if c.operator == "=="))
        if case.result is None or case.result.verdict == "no":
            yield equations
        else:
            yield from losses(case.result.case_tree, equations)


def places_of(cases: Iterable[Case]) -> tuple[Place, ...]:
    """Return where the cases of a test are."""
    return tuple(
        Place(case.when, dict(case.substitution) or None)
        if case.result is not None
        else Place(case.when, {}, is_open=False)
        for case in cases
    )


def carried(plant: StateSpace, cases: Iterable[Case], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of a test with the answers of another task there."""
    return solved(plant, places_of(cases), solve)


def solved(plant: StateSpace, asked: Iterable[Place], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of some strata, each with the answer of a task there.

    All are answered before the strata of one of them are looked at: what may be found goes to the widest strata first.
    """

    def answer(place: Place) -> Result | None:
        if not place.is_open or plant.findings.are_over:
            return None
        return solve(_plant_on(place, plant), place.values or {})

    def with_strata(case: Case) -> Result | None:
        # Its own strata are made now, where what cannot be claimed on them can be left undecided.
        if case.result is not None and case.result.plant.equations:
            _ = case.result.case_tree
        return case.result

    found = [(place, case) for place in asked for case in _case(place, plant, partial(answer, place))]
    return tuple(each for place, case in found for each in _case(place, plant, partial(with_strata, case)))


def found_once(kind: Any, plant: StateSpace, *asked: Any) -> Result:
    """Return `kind.of(plant, *asked)`; on a stratum what was found there once."""
    found: Result = plant.once((kind, *asked), lambda: kind.of(plant, *asked))
    return found


class PutAgain(Result):
    """A result whose cases are the same question with the data on a stratum: `of(plant, *inputs, method)`."""

    #: The data beside the plant by the names of their fields, in the order of `of`.
    inputs: ClassVar[tuple[str, ...]] = ()

    @property
    def further_data(self) -> tuple[Matrix, ...]:
        """The matrices that are given beside the plant."""
        return tuple(getattr(self, name) for name in self.inputs)

    @property
    def obstacle(self) -> Scalar | None:
        """What would vanish if there were an answer; None where there is one."""
        return None

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The domain, the conditions of existence, and the denominators of the answer."""
        found = nonzero("existence", vanishing_factors(self.existence, self.plant.symbols.signs))
        return joined((*self.domain, *found), super().holds_where)

    @cached_property
    def case_tree(self) -> tuple[Case, ...]:
        """The question again where a condition of the answer fails, or where there is an answer after all."""
        if self.obstacle is None:
            where = places(self.plant, [c.expression for c in self.holds_where if c.kind != "domain"])
        else:
            equation = self.obstacle.numerator
            where = () if equation.is_constant else common_places(self.plant, [equation])
        return solved(self.plant, where, self._on)

    def _on(self, there: StateSpace, values: dict[str, Scalar]) -> Result:
        data = (modulo(part.substitute(values), there.ideal) for part in self.further_data)
        return found_once(type(self), there, *data, self.method)


def _case(place: Place, plant: StateSpace, find: Callable[[], Result | None]) -> Iterator[Case]:
    """Yield the case of a stratum with its result; none where the plant is undefined or the question is void."""
    when, values, _ = place
    try:
        yield Case(when, values or {}, find())
    except ZeroDivisionError:
        return
    except (NotWritten, Undecided):
        yield Case(when, values or {}, None)
    except CertificateRejected:
        if values is not None and not plant.equations:
            raise
        yield Case(when, {}, None)


def _plant_on(place: Place, plant: StateSpace) -> StateSpace:
    """Return the plant of a stratum."""
    equations, others = ([c.expression for c in place.when if c.operator == sign] for sign in ("==", "!="))
    there = plant.restricted((), others)
    return plant.stratum(there.restricted(equations) if place.values is None else there.substitute(place.values))


def _linear(factor: Scalar, signs: Mapping[str, str]) -> tuple[dict[str, Scalar], Scalar] | None:
    """Return ({name: value}, leading coefficient) where a polynomial is linear in some parameter.

    A parameter whose coefficient never vanishes is preferred; the coefficient is returned because the solution covers
    the stratum only where it is not 0.
    """
    best = None
    for name in letters_outside(factor):
        if factor.degree(name) != 1:
            continue
        lead, constant = factor.coefficients(name)
        found = ({name: -constant / lead}, lead)
        if never_zero(lead, signs):
            return found
        best = best or found
    return best


# Parameter values at which the geometric multiplicity of a hidden eigenvalue increases.
#
# The rank of [A − λI; C] at an eigenvalue is n less the dimension of ker(X − λI), X being A on ker 𝒪. It is the generic
# one wherever ker 𝒪 is and the minors of X − λI of the generic order do not vanish together. Where they do, is an
# equation in the parameters once λ is eliminated: two eigenvalues meet there, or a chain of principal vectors breaks.


#: Polynomials in the parameters that vanish together on a stratum.
System: TypeAlias = tuple[Scalar, ...]


@dataclass
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
    yield equality(len(orders), 1, e, "the minors are of one order")
    yield Claim(relation(*orders, X.shape[0] - dimension), e, "the minors of X - lambda*I have the order of its rank")
    matrix, q = shifted(X, factor, plant.variable), in_eigenvalue(factor, plant.variable)
    at_roots = (q,) if factor.degree(plant.variable) > 1 else ()
    e = Environment(signs=signs, relations=outside([*excluded, *region.nonzero], at_roots))
    yield from minors_claim(matrix, found.minors, e, f"where {q} = 0, outside the cases")
