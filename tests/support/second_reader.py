"""A second opinion on derivations: the walk in plain fractions that judges properties, roots, inequalities and tables anew.

Where `tests.support.derivations` tells whether equations hold, `Reader` also decides by roots and numbers at the point
what is stable, proper or never zero, which roots a polynomial has, and what sentences say of a table.
"""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import prod
from operator import mul
from typing import TYPE_CHECKING, Any, NamedTuple

import sympy

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import function_named
from symobs.formula.phrases.languages import ENGLISH, Counted
from symobs.formula.tree import Conjunction, Letter, Literal, Negative, Predicate, Relation, Roots
from symobs.proof.derivation import CaseStep, Diagram
from tests.support.algebra import CONTEXT, Series, determinant, digits, eliminate, is_stable
from tests.support.derivations import World, single, zeroed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.formula.tree import Fact, Formula
    from symobs.proof.derivation import Derivation, Step, Tabulate

NEAR = CONTEXT.mpf(10) ** -25


def sympy_scalar(value: Scalar, names: Mapping[str, Any]) -> Any:
    """Return a kernel scalar term by term; generators mean what `names` says, else themselves."""
    powers: dict[tuple[str, int], Any] = {}

    def power(name: str, exponent: int) -> Any:
        if (name, exponent) not in powers:
            powers[name, exponent] = sympy_generator(name, names) ** exponent
        return powers[name, exponent]

    def polynomial(part: Scalar) -> Any:
        return sympy.Add(
            *(reduce(mul, (power(*p) for p in monomial), sympy.Integer(c)) for c, monomial in part.terms())
        )

    return polynomial(value.numerator) / polynomial(value.denominator)


def sympy_generator(name: str, names: Mapping[str, Any]) -> Any:
    """Return what a generator means: a function of time by its name, any other what `names` says, else a symbol."""
    function = function_named(name)
    if function is None:
        return sympy.pi if name == "pi" else names.get(name, sympy.Symbol(name))
    return getattr(sympy, function.kind)(sympy_scalar(function.argument, names))


class Reader(World):
    """A walk through one derivation at one point, in the cases whose conditions hold there."""

    def point(self, names: Iterable[Any]) -> dict[Any, Any]:
        """Return what symbols are here, rational numbers as SymPy has them."""
        found = {name: self.number(str(name)) for name in names}
        return {name: _rational(value) for name, value in found.items()}

    def read(self, steps: Sequence[Step]) -> Iterator[tuple[str, Any]]:
        """Read on in the cases whose conditions hold here; a box of a loop has the value of its letter."""
        for step in steps:
            if isinstance(step, CaseStep) and not self.is_met(step):
                continue
            if isinstance(step, Diagram) and step.name in {"loop", "unity_loop"}:
                for name, label in step.labels:
                    if name in {"P", "F"} and not isinstance(label, Conjunction):
                        drawn = label.operand if isinstance(label, Negative) else label
                        assert zeroed(self.difference(Relation((drawn, Letter(name)), ("=",)))) == 0, label
            yield from super().read((step,))

    def is_met(self, step: CaseStep) -> bool:
        relations = step.when.relations if isinstance(step.when, Conjunction) else (step.when,)
        there = self.copy()
        there.meanings |= dict(step.substitution)
        judged = ((there.difference(r), r.operators[0]) for r in relations if r.operators != ("=",))
        return all(compares(single(value), operator) for value, operator in judged)

    def facts(self, facts: Sequence[Fact | Formula | str]) -> Iterator[tuple[str, Any]]:
        for fact in facts:
            if isinstance(fact, Predicate):
                assert self.has(fact.name, fact.subject), fact
            if isinstance(fact, Roots):
                assert self.has_roots(fact), fact
            yield from super().facts((fact,))

    def has_roots(self, fact: Roots) -> bool:
        """Tell whether the product of s − root is the polynomial, or that of the poles, up to a number."""
        (polynomial,), at = self.decided(fact.polynomial), digits(self.number(self.variable))
        whole = CONTEXT.polyval(list(map(_digits, polynomial)), at) / _digits(polynomial[0])
        found = [self.root(root) for root in fact.values]
        roots = [_digits(centre) + sign * CONTEXT.sqrt(_digits(radicand)) for _, centre, radicand, sign in found]
        return bool(abs(prod(at - root for root in roots) - whole) <= NEAR * (1 + abs(whole)))

    def has(self, name: str, subject: Formula) -> bool:
        """Decide a property anew: of polynomials by their coefficients or roots here, of a matrix by its entries."""
        if name == "never_zero":
            return bool(single(self.value(subject)))
        if name == "positive_definite":
            table = self.value(subject)
            return all(determinant([row[:k] for row in table[:k]]) > 0 for k in range(1, len(table) + 1))
        entries = self.entries(subject)
        if name == "strictly_proper":
            return all(len(above) < len(below) or not any(above) for above, below in entries)
        if name in {"polynomial", "not_polynomial"}:
            return all(len(below) == 1 for _, below in entries) == (name == "polynomial")
        if name == "no_stable_compensator":
            ((zeros, poles),) = entries
            real = [CONTEXT.re(z) for z in roots_of(zeros) if abs(CONTEXT.im(z)) < NEAR and CONTEXT.re(z) > 0]
            return any(CONTEXT.polyval(list(map(digits, poles)), z) * digits(poles[0]) < 0 for z in real)
        decided = self.decided(subject)
        if name in {"marginal", "beyond"}:
            return bool(max(map(CONTEXT.re, roots_of(decided[0]))) <= NEAR) == (name == "marginal")
        return all(map(self.is_stable_here, decided)) == (name == "stable")

    def is_stable_here(self, polynomial: list[Any]) -> bool:
        if all(isinstance(c, Fraction) and not isinstance(c, Series) for c in polynomial):
            return is_stable(polynomial, discrete=self.is_discrete)
        return all(abs(r) < 1 if self.is_discrete else CONTEXT.re(r) < 0 for r in roots_of(polynomial))

    def decided(self, subject: Formula) -> list[list[Any]]:
        """Return the polynomials by whose roots a property is decided: denominators, of a polynomial itself."""
        entries = self.entries(subject)
        return [below for _, below in entries if len(below) > 1] or [above for above, _ in entries]

    def entries(self, subject: Formula) -> list[tuple[list[Any], list[Any]]]:
        """Return numerators and denominators of the entries of a letter; of a formula by interpolation."""
        value = self.letters.get(subject.name) if isinstance(subject, Letter) else self.scalar_of(subject)
        value = value.value if isinstance(value, Literal) else value
        if isinstance(value, (Scalar, Matrix)):
            entries = value.entries if isinstance(value, Matrix) else (value,)
            return [(self.trimmed(entry.numerator), self.trimmed(entry.denominator)) for entry in entries]
        found = [self.at(self.variable, place).value(subject) for place in _PLACES]
        tables = [value if isinstance(value, list) else [[value]] for value in found]
        return [_fitted([table[i][j] for table in tables]) for i, row in enumerate(tables[0]) for j in range(len(row))]

    def trimmed(self, polynomial: Scalar) -> list[Fraction]:
        """Return the coefficients here, highest power first."""
        return _without_zeros(self.coefficients(polynomial)[::-1])

    def table(self, step: Tabulate) -> Iterator[tuple[str, Any]]:
        """Hold what is said of a table against the table made anew, and the roots."""
        yield from super().table(step)
        symbol, small, polynomial = (
            sympy.Symbol(step.variable),
            sympy.Symbol("epsilon"),
            self.scalar_of(step.polynomial),
        )
        if polynomial is None:  # that of a region, which is held at points
            return
        names = {step.table.epsilon: small} if step.table.epsilon else {}
        coefficients = sympy.Poly(sympy_scalar(polynomial, names), symbol).all_coeffs()
        points = [self.point(polynomial.names - {step.variable})]
        for finding in step.findings:
            slots = {name: _said(slot, {**names, step.variable: sympy.Symbol("s")}) for name, slot in finding.slots}
            assert is_so(finding.key, slots, rows_of(coefficients, small), coefficients, points), finding


def check_lines(derivation: Derivation, seeds: Iterable[int]) -> None:
    """Walk a derivation at random points, in which everything has to be so."""
    for seed in seeds:
        for kind, content in Reader.of(derivation.start, seed).read(derivation.steps):
            assert kind not in {"=", "zero"} or content == 0, (kind, content)
            assert kind != "!==" or content != 0
            assert kind not in COMPARISONS or compares(single(content.difference), kind), content


COMPARISONS = {"!=", "<", ">", "<=", ">="}


def compares(difference: Any, operator: str) -> bool:
    """Tell whether difference operator 0 holds for a number."""
    value = difference.parts[0] if isinstance(difference, Series) else difference
    return bool({"!=": value != 0, "<": value < 0, ">": value > 0, "<=": value <= 0, ">=": value >= 0}[operator])


_PLACES = [Fraction(7 * k + 1, 11) for k in range(24)]


def _fitted(told: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """Return P and Q of least degree, at most 9, with P = told Q at all places; of numbers of 60 digits a polynomial."""
    if any(isinstance(value, Series) for value in told):
        powers = CONTEXT.matrix([[digits(x) ** k for k in range(24)] for x in _PLACES])
        polynomial = list(CONTEXT.lu_solve(powers, CONTEXT.matrix(list(map(_digits, told)))))[::-1]
        first = next(k for k, c in enumerate(polynomial) if abs(c) > NEAR)
        return polynomial[first:], [Fraction(1)]
    rows = [[part for k in range(10) for part in (x**k, -value * x**k)] for x, value in zip(_PLACES, told, strict=True)]
    pivots, _, reduced = eliminate(rows)
    free = next(k for k in range(20) if k not in pivots)
    found = [-reduced[pivots.index(k)][free] if k < free else Fraction(k == free) for k in range(20)]
    return _without_zeros(found[0::2][::-1]), _without_zeros(found[1::2][::-1])


def _without_zeros(polynomial: list[Any]) -> list[Any]:
    while len(polynomial) > 1 and not polynomial[0]:
        del polynomial[0]
    return polynomial


def roots_of(polynomial: Sequence[Fraction]) -> list[Any]:
    return list(CONTEXT.polyroots(list(map(_digits, polynomial)), maxsteps=500, extraprec=400))


def _digits(value: Any) -> Any:
    return value.parts[0] if isinstance(value, Series) else digits(value)


def _rational(value: Any) -> Any:
    return value.parts[0] if isinstance(value, Series) else sympy.Rational(value.numerator, value.denominator)


def _said(slot: Any, names: Mapping[str, Any]) -> Any:
    """Return what a slot of a finding says: words, a value, or a comparison."""
    match slot:
        case Relation((left, right), (operator,)):
            return _said(left, names), operator, _said(right, names)
        case Literal(Scalar() as value):
            return sympy_scalar(value, names)
        case Counted():
            return ENGLISH.put(slot)
    return slot


# -- Routh's table by determinants, where roots lie by their numeric values, what sentences say ------------------------------

NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"]
TIMES = ["does not change sign", "changes sign once", "changes sign twice"]
TIMES += [f"changes sign {number} times" for number in NUMBERS[3:]]
LIE = [f"{number} root{'' if k < 2 else 's'} lie{'s' if k < 2 else ''}" for k, number in enumerate(NUMBERS)]


class Row(NamedTuple):
    power: int
    entries: list[Any]
    origin: str


def rows_of(coefficients: Sequence[Any], small: Any) -> list[Row]:
    """Return the rows from the highest power down to 0, by the determinants of the rows above each."""
    order = len(coefficients) - 1
    rows = [Row(order, list(coefficients[0::2]), "coefficients")]
    for power in range(order - 1, -1, -1):
        if power == order - 1:
            found, origin = list(coefficients[1::2]), "coefficients"
        else:
            p, q = ([*row.entries, *[sympy.Integer(0)] * order] for row in rows[-2:])
            minors = [sympy.Matrix([[p[0], p[k + 1]], [q[0], q[k + 1]]]).det() for k in range(power // 2 + 1)]
            found, origin = [sympy.cancel(-minor / q[0]) for minor in minors], "recurrence"
        if found[0] == 0 and any(entry != 0 for entry in found):
            found, origin = [small, *found[1:]], "epsilon"
        elif found[0] == 0:
            found, origin = derivative(rows[-1]), "auxiliary"
        rows.append(Row(power, found, origin))
    return rows


def derivative(row: Row) -> list[Any]:
    """Return every other coefficient of the derivative of Σ entry · xᵖᵒʷᵉʳ⁻²ᵏ."""
    x = sympy.Symbol("x")
    whole = sympy.Poly(sum(entry * x ** (row.power - 2 * k) for k, entry in enumerate(row.entries)), x)
    return list(whole.diff(x).all_coeffs()[0::2])


def located(coefficients: Sequence[Any]) -> tuple[int, int]:
    """Return how many roots have a positive real part, and how many one that is 0, to fifty digits."""
    right = axis = 0
    for factor, power in sympy.Poly(list(coefficients), sympy.Symbol("x")).sqf_list()[1]:
        for root in factor.nroots(n=50, maxsteps=1000):
            real = sympy.re(root)
            if abs(real) < sympy.Float(10) ** -30:
                axis += power
            elif real > 0:
                right += power
    return right, axis


def expression(number: Any) -> Any:
    """Return a number or an expression as an expression."""
    return sympy.Integer(0) + number


def changes(rows: Sequence[Row], small: Any) -> int:
    """Return the changes of sign in the first column, where ε is 10⁻⁶⁰."""
    column = [sympy.sign(expression(row.entries[0]).subs(small, sympy.Rational(1, 10**60))) for row in rows]
    assert set(column) <= {1, -1}
    return sum(a != b for a, b in pairwise(column))


def is_so(
    key: str, slots: Mapping[str, Any], rows: Sequence[Row], coefficients: Sequence[Any], points: Iterable[Any]
) -> bool:
    """Tell whether a sentence about a table is true: at points of the parameters where it speaks of all."""
    small = sympy.Symbol("epsilon")
    origins = [row.origin for row in rows]
    match key:
        case "routh_epsilon":
            return "epsilon" in origins and slots["epsilon"] == (small, ">", 0)
        case "routh_zero_row":
            return "auxiliary" in origins
        case "routh_divides":
            x = sympy.Symbol("s")
            whole, part = sympy.Poly(list(coefficients), x), sympy.Poly(slots["auxiliary"], x)
            is_symmetric = sympy.expand(slots["auxiliary"].subs(x, -x) ** 2 - slots["auxiliary"] ** 2) == 0
            return is_symmetric and bool(whole.rem(part).is_zero)
        case "routh_changes" | "routh_changes_axis" | "routh_misleads":
            right, axis = located(coefficients)
            told = slots["right"] == LIE[right] and slots.get("axis", LIE[0]) == LIE[axis]
            if key == "routh_misleads":
                return told and changes(rows, small) != right and slots["epsilon"] == small
            return told and slots["changes"] == TIMES[changes(rows, small)] and changes(rows, small) == right
    return all(_at_a_point(key, slots, rows, coefficients, point) for point in points)


def _at_a_point(
    key: str, slots: Mapping[str, Any], rows: Sequence[Row], coefficients: Sequence[Any], point: Any
) -> bool:
    numbers = [expression(c).subs(point) for c in coefficients]
    if key == "routh_criterion_where":
        (left, operator, right) = slots["leading"]
        if operator != "!=" or right != 0 or (left - coefficients[0]) != 0:
            return False
        if numbers[0] == 0:
            return True
    stable = located(numbers) == (0, 0)
    if key == "routh_not_stable":
        return not stable
    column = [expression(row.entries[0]).subs(point) for row in rows]
    told = {
        sign: all(entry.is_finite and (entry > 0) == (sign == "positive") and entry != 0 for entry in column)
        for sign in ("positive", "negative")
    }
    match key:
        case "routh_positive" | "routh_negative":
            return stable and told[key.removeprefix("routh_")]
        case "routh_criterion_positive" | "routh_criterion_negative":
            return stable == told[key.removeprefix("routh_criterion_")]
        case "routh_criterion_where":
            return stable == any(told.values())
    raise AssertionError(key)
