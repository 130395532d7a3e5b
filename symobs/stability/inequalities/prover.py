"""Search for a proof that a value is positive wherever others are; `proof` checks the result.

*Shifted positivity*: where a known value is linear in a parameter p, its coefficient g₁ of certain sign, put
p = (t − g₀)/g₁ with a new t > 0, the known value.  When enough parameters are replaced, every term of the goal may
have the sign +.  Read backwards that is an identity: goal · (powers of g₁) = Σ (certain) · products of known values.
Where terms of both signs are left, `combination` looks for such an identity by linear programming.
"""

from __future__ import annotations

from dataclasses import field, replace
from fractions import Fraction
from itertools import combinations, combinations_with_replacement, islice
from math import gcd
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.proof import ONE, ZERO, Combined, Opposite, Product, Step, proves, refutes
from symobs.stability.inequalities.z3_backend import is_free
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence


# Steps of a proof that a value is positive, in their usual forms: by signs, of a product, of a quotient, by
# contradiction.


UNIT: tuple[Product, ...] = ((ONE, ()),)


def by_signs(value: Scalar) -> Combined:
    """Return the step for a value positive by the declared signs."""
    return Combined(value, UNIT, ((value, ()),))


def is_product(value: Scalar, factors: Sequence[Scalar]) -> Combined:
    """Return the step for a product of known values."""
    return Combined(value, UNIT, ((ONE, tuple(factors)),))


def is_quotient(value: Scalar, product: Scalar, factors: Sequence[Scalar], coefficient: Scalar = ONE) -> Combined:
    """Return the step for a quotient of a known value by known factors and a coefficient of known sign."""
    return Combined(value, ((coefficient, tuple(factors)),), ((ONE, (product,)),))


def contradiction(value: Scalar) -> Combined:
    """Return the step to 0 > 0 from value > 0 for a value that is never positive."""
    return Combined(ZERO, (), ((ONE, (value,)), (-value, ())))


def from_contradiction(value: Scalar) -> Combined:
    """Return the step from 0 > 0 to anything."""
    return Combined(value, (), ((ONE, (ZERO,)),))


# Positive combinations by linear programming in exact fractions.
#
# Wanted are m, c and fₖ, sums of monomials of certain sign with coefficients ≥ 0, and squares (u ± v)² of monomials,
# such that m · goal = c + Σ squares + Σ fₖ · (product of one or two known values): linear equations, one for each
# monomial, in coefficients that must not be negative. With m = 0 the known values contradict each other.


#: A monomial as names with exponents, and a polynomial as its coefficients.
Monomial: TypeAlias = tuple[tuple[str, int], ...]
Terms: TypeAlias = dict[Monomial, int]
#: The monomial 1.
NOTHING: Monomial = ()
#: Larger programs are not tried.
_ROWS, _COLUMNS, _PIVOTS = 60, 160, 40


@dataclass
class Combination:
    """multiplier · goal = certain + Σ squares + Σ factor · (the known values at these places)."""

    multiplier: Scalar
    certain: Scalar
    squares: tuple[Scalar, ...]
    multiples: tuple[tuple[Scalar, tuple[int, ...]], ...]


@dataclass
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


#: How many views are tried for one goal, how many ways on from each, and how large a polynomial may become.
_VIEWS, _WAYS, _TERMS = 24, 3, 400
#: A known value of more terms is left aside.
_SOLVED = 60
#: How often a combination is looked for.
_PROGRAMS = 3
_DOWN = {"negative", "nonpositive", "zero"}


@dataclass
class Open:
    """A polynomial in the names of a view, and the same known value in the old names."""

    polynomial: Scalar
    value: Scalar


@dataclass(frozen=False)
class _SearchBudget:
    """The remaining steps of the search for one goal."""

    views: int
    programs: int


@dataclass
class SubstitutedProblem:
    """The problem after some substitutions: new names stand for known values."""

    signs: Mapping[str, str]
    stands_for: Mapping[str, Scalar] = field(default_factory=dict)
    open: tuple[Open, ...] = ()
    steps: tuple[Step, ...] = ()

    def products(self, polynomial: Scalar) -> tuple[Product, ...]:
        """Return a polynomial of the view as a sum of products of known values, with coefficients in the old names."""
        found: dict[tuple[Scalar, ...], Scalar] = {}
        for number, powers in polynomial.each_term():
            coefficient, factors = Scalar.of(number), list[Scalar]()
            for name, exponent in powers:
                if name in self.stands_for:
                    factors += [self.stands_for[name]] * exponent
                else:
                    coefficient = coefficient * Scalar.symbol(name) ** exponent
            found[tuple(factors)] = found.get(tuple(factors), ZERO) + coefficient
        below = polynomial.denominator
        return tuple((coefficient / below, factors) for factors, coefficient in found.items())


def prove(goal: Scalar, known: Sequence[Scalar], signs: Mapping[str, str]) -> tuple[Step, ...] | None:
    """Return steps from the known values, all positive, to goal > 0, None if none are found."""
    if goal in known:
        return ()
    if sign_of(goal, signs) == "positive":
        return (by_signs(goal),)
    if not _is_manageable(goal):
        return None
    budget = _SearchBudget(_VIEWS, _PROGRAMS)
    steps = _prove_in(goal, goal, _first_view(known, signs), budget)
    return steps if steps is not None and proves(steps, known, (goal,), signs) else None


def refute(known: Sequence[Scalar], signs: Mapping[str, str]) -> tuple[Step, ...] | None:
    """Return steps from the known values to 0 > 0, None if none are found."""
    for value in known:
        if sign_of(value, signs) in _DOWN:
            return (contradiction(value),)
    budget = _SearchBudget(_VIEWS, _PROGRAMS)
    steps = _prove_in(ZERO, ZERO, _first_view(known, signs), budget)
    return steps if steps is not None and refutes(steps, known, signs) else None


def prove_by_opposite(
    value: Scalar, multiple: Scalar, known: Sequence[Scalar], signs: Mapping[str, str]
) -> tuple[Step, ...] | None:
    """Return the steps to value > 0 if −value > 0 is contradictory and a multiple of the value is known."""
    cofactor = multiple / value
    other = Combined(-cofactor, ((ONE, (-value,)),), ((ONE, (multiple,)),))
    found = refute((-value, -cofactor, *known), signs)
    return None if found is None else (Opposite(value, multiple, (other, *found)),)


def _is_manageable(value: Scalar) -> bool:
    return value.size <= _TERMS and all(map(is_free, value.names)) and value.denominator.is_constant


def _first_view(known: Sequence[Scalar], signs: Mapping[str, str]) -> SubstitutedProblem:
    ordered = sorted((v for v in known if v.size <= _SOLVED and _is_manageable(v)), key=lambda v: (v.size, str(v)))
    return SubstitutedProblem(dict(signs), open=tuple(Open(value, value) for value in ordered))


def _prove_in(goal: Scalar, image: Scalar, view: SubstitutedProblem, budget: _SearchBudget) -> tuple[Step, ...] | None:
    """Return the steps to a goal whose form in the view is `image`."""
    budget.views -= 1
    if not goal.is_zero and sign_of(image, view.signs) == "positive":
        steps = _read_back(goal, image, view)
        if steps is not None:
            return steps
    for known in view.open:
        if sign_of(known.polynomial, view.signs) in _DOWN:
            steps = _from_impossible(goal, known, view)
            if steps is not None:
                return steps
    tried = False
    for moved, put in _ways_on(image, view):
        if budget.views <= 0:
            return None
        tried = True
        moved_image = image.substitute(put)
        if moved_image.size > _TERMS:
            continue
        steps = _prove_in(goal, moved_image, moved, budget)
        if steps is not None:
            return steps
    if tried or not budget.programs:
        return None
    budget.programs -= 1
    return _by_combination(goal, image, view)


def _ways_on(image: Scalar, view: SubstitutedProblem) -> Iterator[tuple[SubstitutedProblem, Mapping[str, Scalar]]]:
    """Yield the views in which one more parameter is replaced by a known value."""
    found = []
    for place, known in enumerate(view.open):
        names = known.polynomial.names - set(view.stands_for) if known.polynomial.size <= _SOLVED else ()
        for name in names:
            sign = view.signs.get(name, "real")
            if known.polynomial.degree(name) != 1 or sign in {"nonnegative", "nonpositive"}:
                continue
            lead = known.polynomial.coefficients(name)[0]
            if sign_of(lead, view.signs) in {"positive", "negative"}:
                rank = (sign in {"positive", "negative"}, name not in image.names, lead.size, known.polynomial.size)
                found.append((rank, place, name))
    for _, place, name in sorted(found)[:_WAYS]:
        way = _replaced(view, place, name)
        if way is not None:
            yield way


def _replaced(
    view: SubstitutedProblem, place: int, name: str
) -> tuple[SubstitutedProblem, Mapping[str, Scalar]] | None:
    """Return the view in which a new name stands for the known value at `place`, and what `name` becomes."""
    known = view.open[place]
    new = f"_{len(view.stands_for) + 1}"
    lead, rest = known.polynomial.coefficients(name)
    put = {name: (Scalar.symbol(new) - rest) / lead}
    signs = {**view.signs, new: "positive"}
    steps = view.steps
    waiting = [Open(o.polynomial.substitute(put), o.value) for k, o in enumerate(view.open) if k != place]
    sign = view.signs.get(name, "real")
    if sign in {"positive", "negative"}:  # what was declared of the old name is now something known
        own = Scalar.symbol(name) if sign == "positive" else -Scalar.symbol(name)
        steps = (*steps, by_signs(own))
        waiting.append(Open(own.substitute(put), own))
    moved = SubstitutedProblem(signs, {**view.stands_for, new: known.value}, (), steps)
    for item in waiting:
        if item.polynomial.size > _TERMS:
            continue
        stripped = _stripped(item, moved)
        if stripped is not None:
            moved = stripped
    return moved, put


def _stripped(item: Open, view: SubstitutedProblem) -> SubstitutedProblem | None:
    """Add a known value without factors of certain sign; return None if it becomes constant."""
    if sign_of(item.polynomial, view.signs) == "positive":
        return None
    unit, factors = item.polynomial.factors()
    turned = -1 if sign_of(unit, {}) == "negative" else 1
    kept, certain, below = Scalar.of(turned), unit * turned, ONE
    for factor, power in factors:
        sign = sign_of(factor, view.signs)
        if sign not in {"positive", "negative"}:
            kept = kept * factor**power
            continue
        oriented = factor if sign == "positive" else -factor
        kept = kept if sign == "positive" or power % 2 == 0 else -kept
        if power > 0:
            certain = certain * oriented**power
        else:
            below = below * oriented**-power
    if not kept.denominator.is_constant:
        return None
    seen = _is_seen_positive([*view.products(certain), *view.products(below)], view)
    if kept.is_constant or (certain * below).is_one or not seen:
        return replace(view, open=(*view.open, Open(item.polynomial, item.value)))
    value = kept.substitute(view.stands_for)
    given = tuple((c, (item.value, *factors)) for c, factors in view.products(below))
    step = Combined(value, view.products(certain), given)
    return replace(view, open=(*view.open, Open(kept, value)), steps=(*view.steps, step))


def _read_back(goal: Scalar, image: Scalar, view: SubstitutedProblem) -> tuple[Step, ...] | None:
    """Return the steps to a goal whose image is positive: each factor is a sum of products of known values."""
    unit, factors = image.factors()
    steps, above, below, sign = list(view.steps), list[Scalar](), list[Scalar](), unit
    for factor, power in factors:
        found = sign_of(factor, view.signs)
        if found not in {"positive", "negative"}:
            return None
        oriented = factor if found == "positive" else -factor
        sign = sign if found == "positive" or power % 2 == 0 else -sign
        value, total = oriented.substitute(view.stands_for), view.products(oriented)
        if not _is_seen_positive(total, view):
            return None
        steps.append(Combined(value, UNIT, total))
        (above if power > 0 else below).extend([value] * abs(power))
    if sign_of(sign, {}) == "negative":
        return None
    return (*steps, Combined(goal, ((ONE, tuple(below)),), ((sign, tuple(above)),)))


def _over_positive(value: Scalar, view: SubstitutedProblem) -> tuple[Scalar, Scalar] | None:
    """Return numerator and denominator with a denominator that is positive in the view."""
    sign = sign_of(value.denominator, view.signs)
    if sign == "positive":
        return value.numerator, value.denominator
    return (-value.numerator, -value.denominator) if sign == "negative" else None


def _from_impossible(goal: Scalar, known: Open, view: SubstitutedProblem) -> tuple[Step, ...] | None:
    """Return the steps from a known value v that is never positive: v = −N/D gives D v + N = 0."""
    parts = _over_positive(-known.polynomial, view)
    if parts is None:
        return None
    above, below = parts
    total = [(c, (known.value, *factors)) for c, factors in view.products(below)] + [*view.products(above)]
    if not _is_seen_positive(total, view):
        return None
    return _finished(goal, (*view.steps, Combined(ZERO, (), tuple(total))))


def _is_seen_positive(products: Sequence[Product], view: SubstitutedProblem) -> bool:
    """Return whether no coefficient is negative: where a sign is known from roots alone, the terms do not say it."""
    return all(sign_of(c, view.signs) in {"positive", "nonnegative", "zero"} for c, _ in products)


def _finished(goal: Scalar, steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """Return steps to a contradiction as steps to the goal."""
    return steps if goal.is_zero else (*steps, from_contradiction(goal))


def _by_combination(goal: Scalar, image: Scalar, view: SubstitutedProblem) -> tuple[Step, ...] | None:
    """Return the steps by a positive combination of the known values."""
    parts = _over_positive(image, view)
    if parts is None:
        return None
    found = combination(parts[0], [known.polynomial for known in view.open], view.signs)
    if found is None:
        return None
    total = [*view.products(found.certain), *((square.substitute(view.stands_for), ()) for square in found.squares)]
    for factor, places in found.multiples:
        values = tuple(view.open[place].value for place in places)
        total += [(c, (*values, *factors)) for c, factors in view.products(factor)]
    if found.multiplier.is_zero:
        return _finished(goal, (*view.steps, Combined(ZERO, (), tuple(total))))
    return (*view.steps, Combined(goal, view.products(found.multiplier * parts[1]), tuple(total)))
