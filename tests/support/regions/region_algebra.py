"""Polynomials in plain fractions and sets made of their signs: what regions are judged by, without the kernel or SymPy.

A `Polynomial` maps monomials to fractions.  A `Formula` is built of atoms `value op 0` by `All`, `Some` and `Not`.
The regions themselves come from Hurwitz determinants expanded along rows, after a shift or the bilinear map.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import lcm
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

Monomial: TypeAlias = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Polynomial:
    """A polynomial by its nonzero terms."""

    terms: Mapping[Monomial, Fraction]

    @classmethod
    def of(cls, value: Fraction | int) -> Polynomial:
        """Return a constant."""
        return cls({(): Fraction(value)} if value else {})

    @classmethod
    def symbol(cls, name: str) -> Polynomial:
        """Return a variable."""
        return cls({((name, 1),): Fraction(1)})

    def __add__(self, other: Polynomial | Fraction | int) -> Polynomial:
        total = dict(self.terms)
        for monomial, c in _polynomial(other).terms.items():
            total[monomial] = total.get(monomial, Fraction(0)) + c
        return Polynomial({monomial: c for monomial, c in total.items() if c})

    def __neg__(self) -> Polynomial:
        return Polynomial({monomial: -c for monomial, c in self.terms.items()})

    def __sub__(self, other: Polynomial | Fraction | int) -> Polynomial:
        return self + -_polynomial(other)

    def __mul__(self, other: Polynomial | Fraction | int) -> Polynomial:
        total: dict[Monomial, Fraction] = {}
        for m, c in _polynomial(other).terms.items():
            for monomial, a in self.terms.items():
                product = _times(monomial, m)
                total[product] = total.get(product, Fraction(0)) + a * c
        return Polynomial({monomial: c for monomial, c in total.items() if c})

    def __pow__(self, exponent: int) -> Polynomial:
        power = Polynomial.of(1)
        for _ in range(exponent):
            power = power * self
        return power

    @property
    def names(self) -> frozenset[str]:
        return frozenset(name for monomial in self.terms for name, _ in monomial)

    @property
    def constant(self) -> Fraction | None:
        """The value of a polynomial without variables; None where it has any."""
        return None if self.names else self.terms.get((), Fraction(0))

    def degree(self, name: str) -> int:
        return max((dict(monomial).get(name, 0) for monomial in self.terms), default=0)

    def coefficients(self, name: str) -> list[Polynomial]:
        """Return the coefficients in one variable, the highest power first."""
        found: list[dict[Monomial, Fraction]] = [{} for _ in range(self.degree(name) + 1)]
        for monomial, c in self.terms.items():
            powers = dict(monomial)
            found[powers.pop(name, 0)][tuple(powers.items())] = c
        return [Polynomial(terms) for terms in reversed(found)]

    def at(self, values: Mapping[str, Polynomial | Fraction]) -> Polynomial:
        """Return the polynomial with other values for some of its variables."""
        total = Polynomial.of(0)
        for monomial, c in self.terms.items():
            term = Polynomial.of(c)
            for name, power in monomial:
                value = values.get(name)
                term = term * (Polynomial.symbol(name) if value is None else _polynomial(value)) ** power
            total = total + term
        return total

    def derivative(self, name: str) -> Polynomial:
        total = Polynomial.of(0)
        for monomial, c in self.terms.items():
            powers = dict(monomial)
            power = powers.get(name, 0)
            if power:
                powers[name] = power - 1
                total = total + Polynomial({tuple((n, p) for n, p in powers.items() if p): c * power})
        return total

    def integral(self) -> Polynomial:
        """Return it with its denominators cleared, a positive multiple."""
        return self * lcm(*(c.denominator for c in self.terms.values()))

    def __str__(self) -> str:
        """Write it as QEPCAD reads it: `3/4 h1^2 h2 - 1`."""
        return self.text(" ")

    def text(self, times: str) -> str:
        """Write it with this sign between factors."""
        text = ""
        for monomial, c in self.terms.items():
            factors = [name if power == 1 else f"{name}^{power}" for name, power in monomial]
            size = [] if abs(c) == 1 and factors else [str(abs(c))]
            text += (" - " if c < 0 else " + ") + times.join([*size, *factors])
        return text.removeprefix(" + ").replace(" - ", "-", text.startswith(" - ")) or "0"


def _polynomial(value: Polynomial | Fraction | int) -> Polynomial:
    return value if isinstance(value, Polynomial) else Polynomial.of(value)


def _times(left: Monomial, right: Monomial) -> Monomial:
    if not left or not right:
        return left or right
    powers = dict(left)
    for name, power in right:
        powers[name] = powers.get(name, 0) + power
    return tuple(sorted(powers.items()))


# -- sets ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Atom:
    """`value op 0`, op one of > >= = != < <=."""

    value: Polynomial
    op: str


@dataclass(frozen=True)
class All:
    """The intersection; of nothing, everything."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True)
class Some:
    """The union; of nothing, nothing."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True)
class Not:
    """The complement."""

    part: Formula


Formula: TypeAlias = Atom | All | Some | Not
OPPOSITE = {">": "<=", ">=": "<", "=": "!=", "!=": "=", "<": ">=", "<=": ">"}
TRUE, FALSE = All(()), Some(())


def opposite(formula: Formula) -> Formula:
    """Return the complement with the negation drawn into the atoms."""
    match formula:
        case Atom(value, op):
            return Atom(value, OPPOSITE[op])
        case All(parts):
            return Some(tuple(opposite(part) for part in parts))
        case Some(parts):
            return All(tuple(opposite(part) for part in parts))
        case Not(part):
            return without_not(part)


def without_not(formula: Formula) -> Formula:
    """Return the set without `Not`."""
    match formula:
        case Atom():
            return formula
        case All(parts):
            return All(tuple(without_not(part) for part in parts))
        case Some(parts):
            return Some(tuple(without_not(part) for part in parts))
        case Not(part):
            return opposite(part)


def difference(left: Formula, right: Formula) -> Formula:
    """Return where exactly one of two sets holds."""
    return Some((All((left, opposite(right))), All((opposite(left), right))))


def atoms(formula: Formula) -> list[Atom]:
    """Return all atoms."""
    match formula:
        case Atom():
            return [formula]
        case All(parts) | Some(parts):
            return [atom for part in parts for atom in atoms(part)]
        case Not(part):
            return atoms(part)


def names_of(formula: Formula) -> frozenset[str]:
    """Return the variables of a set."""
    return frozenset().union(*(atom.value.names for atom in atoms(formula)))


def sign_holds(sign: int, op: str) -> bool:
    """Tell whether a number of this sign stands in the relation to 0."""
    return {
        ">": sign > 0,
        ">=": sign >= 0,
        "=": sign == 0,
        "!=": sign != 0,
        "<": sign < 0,
        "<=": sign <= 0,
    }[op]


class Signs:
    """Polynomials made ready for many rational points: integers only, each scaled by a positive number a point.

    Where they are taken `together`, as the coefficients of one polynomial, all are scaled by the same number.
    """

    def __init__(self, polynomials: Iterable[Polynomial], names: Sequence[str], *, together: bool = False) -> None:
        given = list(polynomials)
        common = lcm(*(c.denominator for p in given for c in p.terms.values())) if together else 1
        cleared = [p * common if together else p.integral() for p in given]
        self.names = tuple(names)
        self.degrees = [max((p.degree(name) for p in cleared), default=0) for name in names]
        self.terms = [
            [([dict(monomial).get(name, 0) for name in names], int(c)) for monomial, c in p.terms.items()]
            for p in cleared
        ]

    def at(self, point: Sequence[Fraction]) -> list[int]:
        """Return each polynomial, its denominators cleared, times Π denominator(xᵢ)^degreeᵢ."""
        powers = []
        for value, degree in zip(point, self.degrees, strict=True):
            above, below = [1], [1]
            for _ in range(degree):
                above.append(above[-1] * value.numerator)
                below.append(below[-1] * value.denominator)
            powers.append([above[k] * below[degree - k] for k in range(degree + 1)])
        found = []
        for terms in self.terms:
            total = 0
            for exponents, c in terms:
                product = c
                for table, k in zip(powers, exponents, strict=True):
                    product *= table[k]
                total += product
            found.append(total)
        return found


class Membership:
    """A set made ready for many rational points."""

    def __init__(self, formula: Formula, names: Sequence[str]) -> None:
        found = atoms(formula)
        self.formula, self.index = formula, {id(atom): k for k, atom in enumerate(found)}
        self.signs = Signs((atom.value for atom in found), names)

    def __call__(self, point: Sequence[Fraction]) -> bool:
        """Tell whether the set holds the point."""
        return self._holds(self.formula, self.signs.at(point))

    def _holds(self, formula: Formula, values: Sequence[int]) -> bool:
        match formula:
            case Atom(_, op):
                return sign_holds(values[self.index[id(formula)]], op)
            case All(parts):
                return all(self._holds(part, values) for part in parts)
            case Some(parts):
                return any(self._holds(part, values) for part in parts)
            case Not(part):
                return not self._holds(part, values)


# -- stability ----------------------------------------------------------------------------------------------------


def shifted(coefficients: Sequence[Polynomial], margin: Fraction) -> list[Polynomial]:
    """Return p(s − margin), whose roots lie in Re s < 0 where those of p lie in Re s < −margin."""
    found = list(coefficients)
    for last in range(len(found), 1, -1):
        for k in range(1, last):
            found[k] = found[k] - found[k - 1] * margin
    return found


def scaled(coefficients: Sequence[Polynomial], radius: Fraction) -> list[Polynomial]:
    """Return p(radius·z)."""
    order = len(coefficients) - 1
    return [c * radius ** (order - k) for k, c in enumerate(coefficients)]


def bilinear(coefficients: Sequence[Polynomial]) -> list[Polynomial]:
    """Return the coefficients of Σ aₖ (w + 1)ⁿ⁻ᵏ (w − 1)ᵏ."""
    order = len(coefficients) - 1
    total = [Polynomial.of(0)] * (order + 1)
    for k, c in enumerate(coefficients):
        product = [1]
        for sign in [1] * (order - k) + [-1] * k:
            product = [a + sign * b for a, b in zip([*product, 0], [0, *product], strict=True)]
        total = [t + c * p for t, p in zip(total, product, strict=True)]
    return total


def hurwitz_determinants(coefficients: Sequence[Polynomial]) -> list[Polynomial]:
    """Return Δ₁ … Δₙ₋₁, each expanded by minors of the rows above: every minor is formed once, no division is used."""
    order = len(coefficients) - 1
    zero, found = Polynomial.of(0), []
    minors: dict[tuple[int, ...], Polynomial] = {(): Polynomial.of(1)}
    for i in range(1, order):
        row = [coefficients[2 * j - i] if 0 <= 2 * j - i <= order else zero for j in range(1, order)]
        larger: dict[tuple[int, ...], Polynomial] = {}
        for columns in combinations(range(order - 1), i):
            total = zero
            for k, column in enumerate(columns):
                term = row[column] * minors[columns[:k] + columns[k + 1 :]]
                total = total - term if (i - 1 + k) % 2 else total + term
            larger[columns] = total
        minors = larger
        found.append(minors[tuple(range(i))])
    return found


def stable_where(coefficients: Sequence[Polynomial], form: str = "even") -> Formula:
    """Return where a₀ sⁿ + … + aₙ has degree n and all its roots in Re s < 0.

    `form`: "even" takes aₙ, aₙ₋₂, …, "odd" takes aₙ, aₙ₋₁, aₙ₋₃, …, each with Δₙ₋₁, Δₙ₋₃, … (Liénard and Chipart); "all"
    takes every Hurwitz determinant.
    """
    lead = coefficients[0].constant
    if lead is None:
        alternatives = [list(coefficients), [-c for c in coefficients]]
    else:
        alternatives = [[-c if lead < 0 else c for c in coefficients]]
    found = tuple(All(tuple(Atom(p, ">") for p in _positive(c, form))) for c in alternatives)
    return found[0] if len(found) == 1 else Some(found)


def _positive(coefficients: Sequence[Polynomial], form: str) -> list[Polynomial]:
    order = len(coefficients) - 1
    determinants = hurwitz_determinants(coefficients)
    if form == "all":
        needed = [coefficients[0], *determinants, coefficients[order]]
    else:
        indices = range(order, 0, -2) if form == "even" else [order, *range(order - 1, 0, -2)]
        needed = [coefficients[0], *(coefficients[k] for k in indices), *determinants[order - 2 :: -2]]
    return [p for p in needed if p.constant is None or p.constant <= 0]
