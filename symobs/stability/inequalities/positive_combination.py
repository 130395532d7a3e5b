"""Positive combinations by linear programming in exact fractions.

Wanted are m, c and fₖ, sums of monomials of certain sign with coefficients ≥ 0, and squares (u ± v)² of monomials,
such that m · goal = c + Σ squares + Σ fₖ · (product of one or two known values): linear equations, one for each
monomial, in coefficients that must not be negative.  With m = 0 the known values contradict each other.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, combinations_with_replacement, islice
from math import gcd
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

ZERO = Scalar.of(0)
#: A monomial as names with exponents, and a polynomial as its coefficients.
Monomial: TypeAlias = tuple[tuple[str, int], ...]
Terms: TypeAlias = dict[Monomial, int]

#: The monomial 1.
NOTHING: Monomial = ()
#: Larger programs are not tried.
_ROWS, _COLUMNS, _PIVOTS = 60, 160, 40


@dataclass(frozen=True)
class Combination:
    """multiplier · goal = certain + Σ squares + Σ factor · (the known values at these places)."""

    multiplier: Scalar
    certain: Scalar
    squares: tuple[Scalar, ...]
    multiples: tuple[tuple[Scalar, tuple[int, ...]], ...]


@dataclass(frozen=True)
class _Column:
    """One unknown coefficient: of a monomial times the goal (None), or times known values (none: by itself).

    Of a square, the monomial is one of its two and `root` the sum or difference of both.
    """

    monomial: Monomial
    places: tuple[int, ...] | None
    terms: Terms
    strict: bool
    root: Scalar | None = None


def combination(goal: Scalar, known: Sequence[Scalar], signs: Mapping[str, str]) -> Combination | None:
    """Return a combination with a positive right side, None if the search finds none."""
    if goal.size + sum(value.size for value in known) > _ROWS:
        return None
    columns = list(islice(_columns(goal, known, signs), _COLUMNS + 1))
    rows = sorted({monomial for column in columns for monomial in column.terms})
    if len(rows) > _ROWS or len(columns) > _COLUMNS:
        return None
    table = [{**column.terms, **({_SCALE: 1} if column.strict else {})} for column in columns]
    solution = _feasible([_SCALE, *rows], table)
    return None if solution is None else _read(columns, solution)


#: The row that says the strict coefficients add up to 1.
_SCALE: Monomial = (("", 1),)
#: The place of the right side in a row.
_RIGHT = -1


def _read(columns: Sequence[_Column], solution: Mapping[int, Fraction]) -> Combination:
    multiplier, certain = ZERO, ZERO
    squares, multiples = list[Scalar](), list[tuple[Scalar, tuple[int, ...]]]()
    for place, amount in solution.items():
        if not amount:
            continue
        column = columns[place]
        value = Scalar.of(amount) * _scalar(column.monomial)
        if column.root is not None:
            squares.append(Scalar.of(amount) * column.root**2)
        elif column.places is None:
            multiplier = multiplier + value
        elif column.places:
            multiples.append((value, column.places))
        else:
            certain = certain + value
    return Combination(multiplier, certain, tuple(squares), tuple(multiples))


def _columns(goal: Scalar, known: Sequence[Scalar], signs: Mapping[str, str]) -> Iterable[_Column]:
    """Return the candidate unknown coefficients: with multiples of monomials that occur elsewhere."""
    products: list[tuple[tuple[int, ...], Terms]] = [((k,), _terms(value)) for k, value in enumerate(known)]
    pairs = combinations_with_replacement(range(len(known)), 2)
    products += [((j, k), _terms(known[j] * known[k])) for j, k in pairs if known[j].size * known[k].size <= _ROWS]
    wanted = _terms(goal)
    factors = {_certain_part(m, signs) for m in {NOTHING, *(m for _, terms in products for m in terms)}}
    targets = set(wanted)
    for monomial in sorted(factors) if wanted else ():
        moved = _times(wanted, monomial, -1)
        targets.update(moved)
        yield _Column(monomial, None, moved, strict=False)
    targets.update(m for places, terms in products if len(places) == 1 for m in terms)
    targets.add(NOTHING)
    for places, terms in products:
        for monomial in sorted(_quotients(targets, terms)):
            sign = _sign(monomial, signs)
            if sign in {"positive", "nonnegative"}:
                yield _Column(monomial, places, _times(terms, monomial, 1), strict=sign == "positive")
    for monomial in sorted(targets):
        sign = _sign(monomial, signs)
        if sign in {"positive", "nonnegative"}:
            yield _Column(monomial, (), {monomial: 1}, strict=sign == "positive")
    yield from _squares(targets, signs)


def _squares(targets: set[Monomial], signs: Mapping[str, str]) -> Iterable[_Column]:
    """Return (u ± v)² for monomials u, v with a product of uncertain sign."""
    roots = sorted({_half(monomial) for monomial in targets} - {None}, key=str)
    for first, second in combinations([root for root in roots if root is not None], 2):
        if _sign(_product(first, second), signs) == "real" and _product(first, second) in targets:
            for sign in (1, -1):
                root = _scalar(first) + sign * _scalar(second)
                terms = _terms(root**2)
                yield _Column(first, (), terms, strict=False, root=root)


def _half(monomial: Monomial) -> Monomial | None:
    """Return the square root of a monomial."""
    return tuple((name, e // 2) for name, e in monomial) if all(e % 2 == 0 for _, e in monomial) else None


def _product(left: Monomial, right: Monomial) -> Monomial:
    (found,) = _times({left: 1}, right, 1)
    return found


def _certain_part(monomial: Monomial, signs: Mapping[str, str]) -> Monomial:
    """Return the monomial without the odd powers of names of uncertain sign."""
    up = {"positive", "nonnegative"}
    return tuple(
        (n, e - (e % 2 and signs.get(n, "real") not in up)) for n, e in monomial if e > 1 or signs.get(n) in up
    )


def _quotients(targets: Iterable[Monomial], terms: Terms) -> set[Monomial]:
    """Return 1 and the quotients of targets by terms."""
    found = {NOTHING}
    for target in targets:
        there = dict(target)
        for monomial in terms:
            if all(there.get(name, 0) >= exponent for name, exponent in monomial):
                below = dict(monomial)
                rest = ((name, e - below.get(name, 0)) for name, e in target)
                found.add(tuple((name, e) for name, e in rest if e))
    return found


def _terms(value: Scalar) -> Terms:
    return {tuple(sorted(powers)): coefficient for coefficient, powers in value.each_term()}


def _times(terms: Terms, monomial: Monomial, sign: int) -> Terms:
    found = {}
    for powers, coefficient in terms.items():
        total = dict(powers)
        for name, exponent in monomial:
            total[name] = total.get(name, 0) + exponent
        found[tuple(sorted(total.items()))] = sign * coefficient
    return found


def _scalar(monomial: Monomial) -> Scalar:
    value = Scalar.of(1)
    for name, exponent in monomial:
        value = value * Scalar.symbol(name) ** exponent
    return value


def _sign(monomial: Monomial, signs: Mapping[str, str]) -> str:
    """Return `positive`, `nonnegative`, or `real` if the sign is uncertain."""
    weak = down = False
    for name, exponent in monomial:
        sign = signs.get(name, "real")
        if exponent % 2 and sign in {"real", "nonzero"}:
            return "real"
        weak = weak or sign in {"real", "nonnegative", "nonpositive"}
        down = down != (exponent % 2 == 1 and sign in {"negative", "nonpositive"})
    return "real" if down else "nonnegative" if weak else "positive"


def _feasible(rows: Sequence[Monomial], columns: Sequence[Mapping[Monomial, int]]) -> dict[int, Fraction] | None:
    """Return x ≥ 0 with Σ xⱼ columnⱼ = e₁ by the simplex method, None if none is found.

    The simplex method on rows of integers, each up to a positive factor; the entry at `_RIGHT` is the right side.
    The last row is the sum of the artificial unknowns, which has to become 0.
    """
    table = [{j: column[row] for j, column in enumerate(columns) if row in column} for row in rows]
    table[0][_RIGHT] = 1
    cost: dict[int, int] = {}
    for line in table:
        for j, entry in line.items():
            cost[j] = cost.get(j, 0) + entry
    basis = [_RIGHT - 1 - k for k in range(len(rows))]
    for _ in range(_PIVOTS):
        if not cost.get(_RIGHT):
            return {j: Fraction(table[k].get(_RIGHT, 0), table[k][j]) for k, j in enumerate(basis) if j >= 0}
        rising = [(-rate, j) for j, rate in cost.items() if rate > 0 and j >= 0]
        if not rising:
            return None
        entering = min(rising)[1]
        ratios = [
            (Fraction(line.get(_RIGHT, 0), line[entering]), basis[k], k)
            for k, line in enumerate(table)
            if line.get(entering, 0) > 0
        ]
        leaving = min(ratios)[2]
        for k, line in enumerate(table):
            if k != leaving and entering in line:
                table[k] = _eliminated(line, table[leaving], entering)
        cost = _eliminated(cost, table[leaving], entering)
        basis[leaving] = entering
    return None


def _eliminated(line: Mapping[int, int], pivot: Mapping[int, int], place: int) -> dict[int, int]:
    """Return a positive multiple of the line minus the multiple of the pivot's line that makes its entry 0."""
    keep, take = pivot[place], line[place]
    found = {j: keep * entry for j, entry in line.items()}
    for j, entry in pivot.items():
        found[j] = found.get(j, 0) - take * entry
    common = gcd(*found.values())
    return {j: entry // common for j, entry in found.items() if entry}
