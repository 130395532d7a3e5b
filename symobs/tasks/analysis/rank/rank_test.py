"""The rank test of observability and of controllability: test matrix, rank, kernel, cases, missing measurements."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from symobs.exact import (
    Ideal,
    Matrix,
    Root,
    Scalar,
    TooLarge,
    echelon,
    independent_rows,
    kernel,
    modulo,
    rank,
    roots_of,
    unit_rows,
)
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected
from symobs.proof.certificate.claims import Certificate, Claim, check_all
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, vanishing_factors
from symobs.tasks.analysis.strata.loci import Region, distance_from, maximal
from symobs.tasks.analysis.strata.rank_stratification import (
    ELIMINATED_UP_TO,
    EXPANDED,
    Kernel,
    Node,
    Tree,
    determinant_terms,
    exclusions,
    kernel_on,
    minor_at_a_point,
    rank_tree,
    with_restriction,
)
from symobs.tasks.analysis.strata.strata import (
    Piece,
    RankAnswer,
    RankStratum,
    answer_on,
    answer_with,
    equations_of_locus,
    generic_claims,
    kernel_claims,
    minors_claim,
    piece_of,
    stratum_claims,
    stratum_of,
)
from symobs.tasks.result import Case, Result, equality, holds

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.system import StateSpace


# Minimal sets of additional state measurements that make the pair observable.
#
# With N a basis of the unobservable subspace and A N = N X, measuring the states of a set too, whose unit rows are E,
# makes the pair observable exactly where (E N, X) is observable: N z is seen at no output and in no state of the set
# unless z = 0.


#: The most sets that are tried, and terms of the matrices; the minors of a set that are tried first, and the most.
_SETS, _TERMS = 200, 400
_MINORS = (60, 500)


def smallest_sets(N: Matrix, X: Matrix, e: Environment) -> tuple[tuple[int, ...], ...] | None:
    """Return the smallest sets of states whose measurement repairs every point where the relations of `e` hold.

    States are counted from 1.  None where there are too many sets, or too long entries, to try them all, and where
    whether one of them repairs every point is beyond the limits.
    """
    order, hidden = N.shape
    if not hidden:
        return ()
    if N.size + X.size > _TERMS:
        return None
    for count in range(1, order + 1):
        if math.comb(order, count) > _SETS:
            return None
        tried = {chosen: _repairs(chosen, N, X, e) for chosen in itertools.combinations(range(order), count)}
        if None in tried.values():
            return None
        found = tuple(tuple(i + 1 for i in chosen) for chosen, repairs in tried.items() if repairs)
        if found:
            return found
    return None


def _repairs(chosen: tuple[int, ...], N: Matrix, X: Matrix, e: Environment) -> bool | None:
    """Return whether measuring these states repairs every point, None where that is beyond the limits."""
    seen = seen_through(chosen, N, X)
    if rank(seen) < X.shape[0]:
        return False
    try:
        return _deciding_minors(seen, e) is not None
    except TooLarge:
        return None


def _deciding_minors(seen: Matrix, e: Environment) -> list[Scalar] | None:
    """Return minors that never vanish together, None where all do somewhere; raises `TooLarge` where others may not."""
    for most in _MINORS:
        minors = _minors(seen, most)
        if never_together_zero(minors, e.relations, e.signs):
            return minors
        if len(minors) < most:
            return None
    raise TooLarge(f"more than {_MINORS[-1]} minors decide whether these measurements are enough")


def seen_through(chosen: tuple[int, ...], N: Matrix, X: Matrix) -> Matrix:
    """Return [E N; E N X; …], as many blocks as X has rows."""
    rows = [unit_rows(N.shape[0], chosen) @ N]
    for _ in range(X.shape[0] - 1):
        rows.append(rows[-1] @ X)
    return Matrix.block([[row] for row in rows]).normal()


def _minors(matrix: Matrix, most: int) -> list[Scalar]:
    """Return minors that use all columns, the independent-looking ones first, up to so many."""
    count = matrix.shape[1]
    rows = [i for i in range(matrix.shape[0]) if any(matrix.rows[i])]
    chosen = itertools.islice(itertools.combinations(rows, count), most)
    return [matrix.select(minor, range(count)).determinant() for minor in chosen]


def repair_claims(
    sets: tuple[tuple[int, ...], ...], N: Matrix, X: Matrix, e: Environment, verb: str
) -> Iterator[Claim]:
    """Yield that each set repairs the plant at every point, and that of the smaller sets none does in general."""
    for numbers in sets:
        seen = seen_through(tuple(number - 1 for number in numbers), N, X)
        minors = Matrix.column(_deciding_minors(seen, e) or _minors(seen, 1))
        yield Claim(relation(minors, "!=", minors * 0), e, f"with states {numbers} {verb} too the rank is n")
    for chosen in itertools.combinations(range(N.shape[0]), len(sets[0]) - 1) if sets else ():
        most = rank(seen_through(chosen, N, X)) if chosen else 0
        if most < X.shape[0]:
            numbers = tuple(index + 1 for index in chosen)
            yield Claim(relation(most, "<", X.shape[0]), e, f"with states {numbers} {verb} too it is not")


def power_rows(A: Matrix, C: Matrix) -> Matrix:
    """Return [C; CA; …; CAⁿ⁻¹]."""
    rows = [C]
    for _ in range(A.shape[0] - 1):
        rows.append(rows[-1] @ A)
    return Matrix.block([[row] for row in rows]).normal()


def rank_answer(A: Matrix, C: Matrix, ideal: Ideal | None = None) -> RankAnswer:
    """Return the observability test of a pair (on a stratum): matrix, rank r, kernel basis N, and the witnesses.

    Witnesses: rows and columns of an r×r minor, rows of a minor of N, and X with A N = N X.
    """
    O = modulo(power_rows(A, C), ideal)
    order = A.shape[0]
    if ideal is not None:
        columns = echelon(O, ideal)[0]
        rows = independent_rows(O.select(range(O.shape[0]), columns), ideal)
        return answer_with(O, len(columns), kernel_on(O, A, ideal, tuple(range(order))), (rows, columns))
    minor = minor_at_a_point(O) if O.size > ELIMINATED_UP_TO else None
    if minor is not None and len(minor[0]) == order:
        return answer_with(O, order, with_restriction(Matrix.zeros(order, 0), A), minor)
    columns, vectors = echelon(O)
    N = Matrix.of([[v[i, 0] for v in vectors] for i in range(order)], len(vectors))
    rows = independent_rows(O.select(range(O.shape[0]), columns))
    return answer_with(O, len(columns), with_restriction(N, A), (rows, columns))


def rank_environment(plant: StateSpace, pair: tuple[Matrix, Matrix], found: RankAnswer) -> Environment:
    """Return the environment of the claims about a test of observability."""
    (A, C), O = pair, found["matrix"]
    above = O.select(range(O.shape[0] - C.shape[0]), range(O.shape[1]))
    values = {"A": A, "C": C, "O": O, "N": found["kernel"], "X": found["restricted"]}
    values["upper"] = Matrix.block([[C], [above @ A]])
    return Environment(variable=plant.variable, values=values, signs=plant.symbols.signs)


def rank_claims(found: RankAnswer, e: Environment, here: Environment | None = None) -> Iterator[Claim]:
    """Yield structure, kernel and rank from above, invariance; the kernel's claims hold `here`, on a stratum."""
    O, N, X = found["matrix"], found["kernel"], found["restricted"]
    order = O.shape[1]
    yield holds(e, "O = upper", "the blocks are C, C*A, ..., C*A**(n - 1)")
    witnesses = len(found["rows"]), len(found["columns"])
    yield Claim(relation(found["rank"], *witnesses), e, "the minor has the order of the rank")
    beside = N.shape[1], len(found["free"]), *X.shape
    yield Claim(relation(order - found["rank"], *beside), e, "the kernel has the dimension n - rank")
    if N.shape[1]:
        e, count = here or e, range(N.shape[1])
        yield holds(e, "O N = 0")
        yield Claim(relation(determinant_term(N.select(found["free"], count), e), "!==", 0), e)
        yield holds(e, "A N = N X")


def rank_losses(found: RankAnswer, signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return the factors of a minor of the order of the rank that the signs do not keep from 0."""
    minor = found["matrix"].select(found["rows"], found["columns"])
    return vanishing_factors([minor.determinant()], signs) if minor.shape[0] else ()


def minor_claim(found: RankAnswer, e: Environment) -> Iterator[Claim]:
    """Yield the rank from below, in general: a minor of its order is not zero."""
    if found["rank"]:
        minor = found["matrix"].select(found["rows"], found["columns"])
        yield Claim(relation(determinant_term(minor, e), "!==", 0), e, f"a minor of order {found['rank']} is not zero")


@dataclass
class RankResult(Result):
    """The test matrix M of a pair, its rank r, and a basis N of its kernel.

    Claims: the blocks of M follow each other by A; M N = 0; an r×r minor of M and a minor of N are not zero; A N = N X.
    """

    answer: RankAnswer
    piece: Piece | None = None

    leads = ("matrix",)
    repaired_by: ClassVar[str]

    @classmethod
    def of(cls, plant: StateSpace, method_name: str) -> Self:
        """Return the result for a plant."""
        found: Self = plant.once(
            (cls, method_name), lambda: cls(plant, method_name, rank_answer(*cls.pair(plant), plant.ideal))
        )
        return found

    @staticmethod
    def pair(plant: StateSpace) -> tuple[Matrix, Matrix]:
        """Return (A, C) of the observability test that decides."""
        raise NotImplementedError

    def claims(self) -> Iterator[Claim]:
        """Yield structure, rank from below, kernel and rank from above, invariance."""
        e = here = rank_environment(self.plant, self.pair(self.plant), self.answer)
        yield from minor_claim(self.answer, e)
        if self.piece is not None:
            here = replace(e, relations=self.piece.relations(c.expression for c in self.domain))
            yield from self._at_every_point(self.piece, here)
        yield from rank_claims(self.answer, e, here)

    def _at_every_point(self, piece: Piece, e: Environment) -> Iterator[Claim]:
        """Yield that rank and kernel are right wherever the conditions of the piece hold, not only in general."""
        first = self.answer["rows"], self.answer["columns"]
        orders = {len(part) for minor in (first, *piece.minors) for part in minor}
        yield equality(len(orders), 1, e, "the minors are of one order")
        yield from minors_claim(self.answer["matrix"], (first, *piece.minors[1:]), e, "here")
        yield from kernel_claims(self.answer["kernel"], self.answer["restricted"], e, "here")

    def consequences(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return rank, determinant and kernel of another matrix."""
        matrix = given["matrix"]
        square = matrix.shape[0] == matrix.shape[1]
        null = kernel(matrix if self.fields["matrix"] is self.answer["matrix"] else matrix.T)
        return {
            "rank": rank(matrix),
            "determinant": matrix.determinant() if square else None,
            "kernel": [[*null.select(range(null.shape[0]), [j]).entries] for j in range(null.shape[1])],
        }

    @cached_property
    def test_determinant(self) -> Scalar | None:
        """The determinant of a square test matrix; None where it is not square, or too long to be written down."""
        matrix = self.answer["matrix"]
        square = matrix.shape[0] == matrix.shape[1]
        return self.plant.simplified(matrix.determinant()) if square and not self.is_too_long else None

    @cached_property
    def deciding_determinant(self) -> Scalar | None:
        """That determinant; of a matrix in which all but n rows are multiples of those above them, that of these rows."""
        matrix = self.answer["matrix"]
        order = matrix.shape[1]
        if matrix.shape[0] == order or self.is_too_long:
            return self.test_determinant
        kept: list[int] = []
        for index, row in enumerate(matrix.rows):
            if any(row) and not any(_is_multiple(row, matrix.rows[other]) for other in kept):
                kept.append(index)
        if len(kept) != order:
            return None
        return self.plant.simplified(matrix.select(kept, range(order)).determinant())

    @cached_property
    def is_too_long(self) -> bool:
        """Whether the minors have more terms than can be dealt with."""
        return determinant_terms(self.answer["matrix"].select(self.answer["rows"], range(self.plant.order))) > EXPANDED

    @property
    def existence(self) -> tuple[Scalar, ...]:
        """What vanishes wherever the rank is below the generic one: the determinant, or a minor of that order."""
        if self.piece is not None or self.is_too_long:
            return ()
        if self.test_determinant:
            return (self.test_determinant,)
        minor = self.answer["matrix"].select(self.answer["rows"], self.answer["columns"])
        return (self.plant.simplified(minor.determinant()),) if minor.shape[0] else ()

    @property
    def verdict(self) -> str:
        """`no` where the rank is below n everywhere, else whether it can drop.

        A part of the parameters about which nothing is known leaves the verdict undecided, unless the condition that
        keeps away from it is exact: the determinant of a square matrix.
        """
        if self.answer["rank"] < self.plant.order:
            return "no"
        lost = [case for case in self.case_tree if case.result is not None and case.result.verdict == "no"]
        unknown = [case for case in self.case_tree if case.result is None]
        if lost or (unknown and self.deciding_determinant is not None):
            return "conditional"
        return "undecided" if unknown else "yes"

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """The plant's domain, and what must not vanish for the rank to be n.

        One condition for each irreducible factor of the determinant; for a matrix that is not square, where the rank
        drops on several equations at once, the sum of their squares: not all of them vanish.
        """
        if self.piece is not None:
            return (*self.domain, *self.piece.conditions)
        if self.answer["rank"] < self.plant.order:
            return self.domain
        if self._tree is None or (self._tree.undecided and self.deciding_determinant is not None):
            # the determinant is known, though not what is true where it vanishes
            factors = () if self.deciding_determinant is None else self._region.vanishing(self.deciding_determinant)
            return (*self.domain, *(Condition("existence", value) for value in factors))
        lower = [node.locus for node in self._tree.strata if node.rank < self.plant.order]
        lost = Node(self._region.whole, self.answer["rank"], (), below=maximal([*lower, *self._tree.undecided]))
        try:
            excluded = exclusions(lost, self._region)
        except TooLarge:
            excluded = tuple(f for value in self.existence for f in self._region.vanishing(value))
        return (*self.domain, *(Condition("existence", value) for value in excluded))

    @cached_property
    def _region(self) -> Region:
        signs = self.plant.symbols.signs
        nonzero = (*(c.expression for c in self.domain), *vanishing_factors(self.plant.nonzero, signs))
        return Region(signs, frozenset(nonzero), ideal=self.plant.ideal)

    @cached_property
    def _tree(self) -> Tree | None:
        """The strata of the rank; None where there are no parameters, or more than can be dealt with."""
        matrix = self.answer["matrix"]
        if self.piece is not None or self.is_too_long or not matrix.names:
            return None
        answer, (A, _) = self.answer, self.pair(self.plant)
        kernel = Kernel(answer["kernel"], answer["restricted"], answer["free"])
        try:
            tree = rank_tree(matrix, A, self._region, (answer["rows"], answer["columns"]), kernel)
        except TooLarge:  # on which part of the parameters it is not even known
            return None
        self.plant.findings.spend(tree.eliminations)
        return tree

    @cached_property
    def _checked_cases(self) -> tuple[tuple[Case, ...], tuple[Certificate, ...]]:
        """The cases, and the certificates that outside them nothing else is true."""
        if self._tree is None:
            is_open = self.is_too_long or (self.piece is None and bool(self.answer["matrix"].names))
            return ((Case((), {}, None),) if is_open else ()), ()
        certificates: list[Certificate] = []
        cases = [Case(equations_of_locus(locus), {}, None) for locus in self._tree.undecided]
        found = []
        for node in self._tree.strata:
            try:
                stratum = stratum_of(node, self._region)
                certificates += check_all(stratum_claims(stratum, self._region), self.plant.relations)
                found.append(self._case(stratum))
            except (CertificateRejected, TooLarge):  # a claim beyond the limits of what can be checked
                cases.append(Case(equations_of_locus(node.locus), {}, None))
        try:
            certificates += check_all(
                generic_claims(self.answer["matrix"], self._tree, self._region), self.plant.relations
            )
        except (CertificateRejected, TooLarge):
            unknown = (factor for value in self.existence for factor in self._region.vanishing(value))
            cases += [Case((Condition("existence", factor, "=="),), {}, None) for factor in unknown]
        cases += [case for case in found if case.result is None]
        found = [case for case in found if case.result is not None]
        if cases and self.deciding_determinant is not None:  # they lie where this vanishes
            factors = self._region.vanishing(self.deciding_determinant)
            cases = [Case((Condition("existence", factor, "=="),), {}, None) for factor in factors]
        return (*found, *cases), tuple(certificates)

    def _case(self, stratum: RankStratum) -> Case:
        """Return the case of a stratum, on the restricted plant where its equations can be solved."""
        matrix, (A, _) = self.answer["matrix"], self.pair(self.plant)
        for values in (stratum.substitution, {}):
            if values is None:
                continue
            try:
                plant = self.plant.substitute(values) if values else self.plant
                answer = answer_on(matrix, A, stratum, values)
                result = type(self)(plant, self.method, answer, piece_of(stratum, values, self._region))
            except (CertificateRejected, ZeroDivisionError):
                continue
            return Case(stratum.when, values, result)
        return Case(stratum.when, {}, None)

    @property
    def case_tree(self) -> tuple[Case, ...]:
        """Rank and kernel on every stratum where they are not the generic ones."""
        return self._checked_cases[0]

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the result, and that its cases are all."""
        return (*self.certificates, *self._checked_cases[1], *self._repair[1])

    @cached_property
    def _repair(self) -> tuple[tuple[tuple[int, ...], ...] | None, tuple[Certificate, ...]]:
        """The smallest sets of states whose measurement (actuation) makes the rank n, with their certificates.

        They do so at every point of a case; of a result without a piece, wherever its rank holds.
        """
        N, X = self.answer["kernel"], self.answer["restricted"]
        excluded = [c.expression for c in self.domain]
        if self.piece is None and N.shape[1] and self._tree is not None:
            excluded += [distance_from(locus.equations) for locus in self._tree.generic.covers]
        e = Environment(signs=self.plant.symbols.signs, relations=(self.piece or Piece()).relations(excluded))
        e = e.with_relations(self.plant.relations)
        sets = smallest_sets(N, X, e)
        return sets, check_all(repair_claims(sets or (), N, X, e, self.repaired_by))

    @cached_property
    def modes(self) -> tuple[Root, ...]:
        """The eigenvalues of A on the kernel."""
        restricted = self.answer["restricted"]
        if not restricted.shape[0]:
            return ()
        return roots_of(restricted.characteristic_polynomial(self.plant.variable), self.plant.variable)

    @property
    def repaired(self) -> tuple[tuple[int, ...], ...]:
        """The smallest sets of states, counted from 1, whose measurement (actuation) makes the rank n."""
        return self._repair[0] or ()

    @property
    def kernel_vectors(self) -> tuple[Matrix, ...]:
        """The basis of the kernel, vector by vector."""
        N = self.answer["kernel"]
        return tuple(N.select(range(N.shape[0]), [j]) for j in range(N.shape[1]))


def _is_multiple(row: Sequence[Scalar], other: Sequence[Scalar]) -> bool:
    """Return whether a row is another one times a polynomial."""
    first = next(index for index, entry in enumerate(other) if entry)
    factor = row[first] / other[first]
    return factor.denominator.is_constant and all(x == factor * y for x, y in zip(row, other, strict=True))


def listed(sets: tuple[tuple[int, ...], ...] | None) -> list[list[int]] | None:
    """Return sets of states as lists."""
    return None if sets is None else [list(numbers) for numbers in sets]


def determinant_term(matrix: Matrix, environment: Environment) -> Term:
    """Return det of a matrix as a formula with its value."""
    return Term(Literal(matrix), environment).apply("det")
