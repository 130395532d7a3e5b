"""Single points of a region: where the roots lie, and points worth asking about.

Points are drawn uniformly, with small denominators, far out, on the critical curves (exactly), and very near to them.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import Ordering, fmpq, fmpq_mpoly_ctx

from tests.support.algebra import is_stable
from tests.support.regions.region_algebra import Polynomial, Signs, bilinear, hurwitz_determinants
from tests.support.regions.region_roots import primitive, real_roots

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.support.regions.region_problem import Problem
    from tests.support.regions.region_roots import Root

Point: TypeAlias = tuple[Fraction, ...]


# -- where the roots lie --------------------------------------------------------------------------------------------


def stable_at(coefficients: Sequence[int], *, discrete: bool) -> bool:
    """Tell whether a polynomial (highest power first) keeps its degree and has its roots in Re s < 0 (|z| < 1)."""
    return is_stable([Fraction(c) for c in coefficients], discrete=discrete)


class Oracle:
    """The stability of a problem's polynomial at single points."""

    def __init__(self, problem: Problem) -> None:
        self.discrete = problem.discrete
        self.values = Signs(problem.coefficients(), problem.names, together=True)

    def __call__(self, point: Point) -> bool:
        """Tell whether all roots are stable at a point."""
        return stable_at(self.values.at(point), discrete=self.discrete)


# -- points ---------------------------------------------------------------------------------------------------------


def critical(problem: Problem) -> list[Polynomial]:
    """Return the irreducible polynomials of which one vanishes wherever a root reaches the boundary or infinity."""
    found = problem.coefficients()
    moved = bilinear(found) if problem.discrete else found
    candidates = [found[0], moved[0], moved[-1], *hurwitz_determinants(moved)[-1:]]
    context = fmpq_mpoly_ctx.get(problem.names, Ordering.lex)
    factors: dict[str, Polynomial] = {}
    for candidate in candidates:
        if candidate.names:
            terms = {tuple(dict(m).get(n, 0) for n in problem.names): _fmpq(c) for m, c in candidate.terms.items()}
            for factor, _ in context.from_dict(terms).factor()[1]:
                factors.setdefault(str(factor), _read(factor.to_dict(), problem.names))
    return list(factors.values())


def _fmpq(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _read(terms: Any, names: Sequence[str]) -> Polynomial:
    total = Polynomial.of(0)
    for exponents, c in terms.items():
        term = Polynomial.of(Fraction(int(c.p), int(c.q)))
        for name, exponent in zip(names, exponents, strict=True):
            term = term * Polynomial.symbol(name) ** int(exponent)
        total = total + term
    return total


class Points:
    """Rational points worth asking about: a stream without end, the same in every run."""

    def __init__(self, problem: Problem, samples: Sequence[Point] = (), seed: int = 0) -> None:
        self.problem, self.samples = problem, list(samples)
        self.random = random.Random(f"{problem.name} {seed}")  # noqa: S311 - the same points in every run
        self.curves = critical(problem)

    def take(self, number: int) -> list[Point]:
        """Return different points: half near or on the critical curves where there are any."""
        found: dict[Point, None] = dict.fromkeys(point for point in self._special() if self._allowed(point))
        misses = 0
        while len(found) < number and misses < 50 * number:
            before = len(found)
            for point in self._some():
                if self._allowed(point):
                    found[point] = None
            misses += len(found) == before
        return list(found)[:number]

    def _allowed(self, point: Point) -> bool:
        signs = [*([""] * len(self.problem.parameters)), *self.problem.symbols.values()]
        return all(sign != "positive" or x > 0 for sign, x in zip(signs, point, strict=True))

    def _special(self) -> Iterator[Point]:
        """Yield the samples and what hand work found: holes, and corners of the simplest coordinates."""
        for point in [*self.samples, *(tuple(Fraction(x) for x in hole) for hole in self.problem.excluded)]:
            if len(point) == len(self.problem.names):
                yield point
        if len(self.problem.names) <= 2:
            line = [Fraction(k) for k in range(-5, 6)]
            grid = [(x,) for x in line] if len(self.problem.names) == 1 else [(x, y) for x in line for y in line]
            yield from grid

    def _some(self) -> Iterator[Point]:
        kind = self.random.random()
        if kind < 0.3 or not self.curves:
            yield tuple(self._uniform() for _ in self.problem.names)
        elif kind < 0.4:
            yield tuple(self._simple() for _ in self.problem.names)
        elif kind < 0.45:
            yield tuple(self._wide() for _ in self.problem.names)
        else:
            yield from self._at_curve(self.random.choice(self.curves))

    def _uniform(self) -> Fraction:
        below = self.random.choice((1, 2, 3, 7, 10, 64, 1000, 10**6))
        return Fraction(self.random.randint(-self.problem.window * below, self.problem.window * below), below)

    def _simple(self) -> Fraction:
        return Fraction(self.random.randint(-24, 24), self.random.choice((1, 1, 2, 3, 4, 6)))

    def _wide(self) -> Fraction:
        return self._uniform() * self.random.choice((10, 100, 10**4, 10**6))

    def _at_curve(self, curve: Polynomial) -> Iterator[Point]:
        """Yield points on one critical curve: exact where a root is rational, else on both sides of it, very near."""
        names = sorted(curve.names)
        solved = self.random.choice(names)
        linear = [name for name in names if curve.degree(name) == 1]
        if linear and self.random.random() < 0.5:
            solved = self.random.choice(linear)
        others: dict[str, Fraction] = {
            name: self.random.choice((self._uniform, self._simple))() for name in self.problem.names if name != solved
        }
        along = self._through(curve, names, others) if self.random.random() < 0.4 else None
        if along is not None:
            yield along
            return
        values = primitive([c.at(others).constant or Fraction(0) for c in curve.coefficients(solved)])
        if not values:
            yield self._point(others, solved, self._uniform())
        for root in _roots(values) if values else ():
            exact = _rational_root(root)
            width = Fraction(1, 10 ** self.random.randint(1, 15))
            if exact is not None:
                yield self._point(others, solved, exact)
            else:
                root.narrow(width)
            yield self._point(others, solved, root.low - width * self.random.randint(1, 99))
            yield self._point(others, solved, root.high + width * self.random.randint(1, 99))

    def _through(self, curve: Polynomial, names: Sequence[str], others: dict[str, Fraction]) -> Point | None:
        """Return the other point of a conic on a random line through a rational point of it."""
        if len(names) != 2 or len(self.problem.names) != 2 or any(_total(m) > 2 for m in curve.terms):
            return None
        base = self._base(curve, names)
        if base is None:
            return None
        x, y = names
        slope = self._simple()
        t = Polynomial.symbol("t")
        line = curve.at({x: t + base[0], y: t * slope + base[1]}).coefficients("t")
        if len(line) != 3 or line[2].constant != 0:
            return None
        step = -(line[1].constant or Fraction(0)) / (line[0].constant or Fraction(1))
        return self._point({**others, x: base[0] + step}, y, base[1] + slope * step)

    def _base(self, curve: Polynomial, names: Sequence[str]) -> Point | None:
        """Return a rational point of a conic, looked for among small coordinates once."""
        cache: dict[int, Point | None] = self.__dict__.setdefault("_bases", {})
        if id(curve) not in cache:
            cache[id(curve)] = None
            for numerator in range(-40, 41):
                x = Fraction(numerator, 4)
                values = [c.at({names[0]: x}).constant or Fraction(0) for c in curve.coefficients(names[1])]
                roots = [_rational_root(root) for root in real_roots(values)] if any(values) else []
                found = [root for root in roots if root is not None]
                if found:
                    cache[id(curve)] = (x, found[0])
                    break
        return cache[id(curve)]

    def _point(self, others: dict[str, Fraction], name: str, value: Fraction) -> Point:
        values = {**others, name: value}
        return tuple(values[n] for n in self.problem.names)


def _total(monomial: Sequence[tuple[str, int]]) -> int:
    return sum(power for _, power in monomial)


@lru_cache(maxsize=256)
def _roots(polynomial: tuple[int, ...]) -> list[Root]:
    return real_roots(polynomial)


def _rational_root(root: Root) -> Fraction | None:
    """Return the root where it is rational: its denominator divides the leading coefficient."""
    if root.low == root.high:
        return root.low
    lead = abs(root.polynomial[0])
    root.narrow(Fraction(1, 4 * lead))
    nearest = Fraction(round((root.low + root.high) / 2 * lead), lead)
    return nearest if root.compare(nearest) == 0 else None
