"""A second opinion on derivations: plain SymPy matrices, and of symobs nothing but the shape of its formula tree.

`Reader` walks the steps of a derivation, gives every letter a value of its own making, and compares all members of
every line.  It works with symbols, or at one rational point where the expressions are too large for SymPy.  Functions of
time are SymPy's, derivatives and values at an instant are taken by SymPy, integrals by quadrature: the witness of an
integral is not looked at.  What has functions in it is compared with 50 digits at points the signs allow.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, is_dataclass
from functools import reduce
from itertools import islice, pairwise
from math import prod
from operator import mul
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import mpmath
import sympy

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import function_named
from symobs.formula.phrases.languages import ENGLISH, SPOKEN, Counted
from symobs.formula.tree import (
    Apply,
    At,
    Block,
    Conjunction,
    Decimals,
    Derivative,
    Evaluated,
    HoldsExactlyWhere,
    Identity,
    Integral,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    SymbolList,
    Transpose,
)
from symobs.proof.derivation import CaseStep, Conclude, Define, Diagram, Equal, Given, Note, Section, Tabulate
from tests.support.problems.problems_by_hand import compare, inverse, is_stable, is_zero, polynomial_at

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from symobs.exact import Root
    from symobs.formula.tree import Fact, Formula
    from symobs.proof.derivation import Derivation, Sentence, Step

Value: TypeAlias = Any  # sympy.Expr, sympy.Matrix, or a signal: name of a free signal -> its coefficient matrix


# -- reading what symobs wrote -----------------------------------------------------------------------------------------


def facts_in(item: object) -> Iterator[Fact | Tabulate]:
    """Yield every fact anywhere in a derivation, and every table, by the fields of its dataclasses alone."""
    if isinstance(item, Tabulate):
        yield item
        yield from facts_in(item.sentence)
    elif isinstance(item, (Relation, Predicate, Roots, HoldsExactlyWhere, Evaluated)):
        yield item
    elif isinstance(item, (tuple, list)):
        for part in item:
            yield from facts_in(part)
    elif is_dataclass(item):
        for part in fields(item):
            yield from facts_in(getattr(item, part.name))


def values_of(facts: Iterable[Fact | Tabulate]) -> int:
    """Count what must agree: all members of a relation but its first; entries and findings of a table; else one."""
    counted = 0
    for fact in facts:
        if isinstance(fact, Relation):
            counted += len(fact.members) - 1
        elif isinstance(fact, Tabulate):
            counted += sum(len(row.entries) for row in fact.table.rows) + len(fact.findings)
        else:
            counted += 1
    return counted


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
    if name == "pi":
        return sympy.pi
    if function is None:
        return sympy.pi if name == "pi" else names.get(name, sympy.Symbol(name))
    return getattr(sympy, function.kind)(sympy_scalar(function.argument, names))


def sympy_root(root: Root, names: Mapping[str, Any]) -> Any:
    """Return centre ± √radicand."""
    assert root.is_closed
    return sympy_scalar(root.centre, names) + root.sign * sympy.sqrt(sympy_scalar(root.radicand, names))


@dataclass
class Tally:
    """How many values were compared; letters without an independent value; formulas that sentences only mention."""

    compared: int = 0
    unknown: list[str] = field(default_factory=list)
    spoken: list[tuple[str, Value]] = field(default_factory=list)


class Reader:
    """A walk through one derivation.

    known     what letters must be worth, found without symobs; φ at a matrix is known as `phi_at`
    names     generators replaced on sight: nothing, or the coordinates of a rational point
    known_at  what letters must be worth where some names are replaced, if a case may introduce them anew
    samples   parameter points allowed by the declared signs, for what no equation states
    """

    def __init__(
        self,
        derivation: Derivation,
        known: Mapping[str, Value],
        samples: Callable[[], Iterable[Mapping[str, Any]]],
        names: Mapping[str, Any] | None = None,
        known_at: Callable[[Mapping[str, Any]], Mapping[str, Value]] | None = None,
    ) -> None:
        self.derivation = derivation
        self.known = known
        self.known_at = known_at
        self._samples = samples
        self.assumed: list[Any] = []
        self.narrowed: list[tuple[Any, str]] = []
        self.symbol = sympy.Symbol(derivation.variable)
        self.names: dict[str, Any] = dict(names or {})
        self.letters: dict[str, Value] = {}
        self.sizes = dict(derivation.start.sizes)
        self.signals: dict[str, Formula] = {}
        self.rates: dict[str, Formula] = {}
        self.tally = Tally()

    def read(self) -> Tally:
        for step in self.derivation.steps:
            self.step(step)
        return self.tally

    def samples(self) -> Iterator[Mapping[str, Any]]:
        """Yield the sample points where everything assumed so far holds."""
        needed = [*((value, "!=") for value in self.assumed), *self.narrowed]
        return (
            point
            for point in self._samples()
            if all(compare(value.subs(point), operator) for value, operator in needed)
        )

    # -- steps ---------------------------------------------------------------------------------------------------------

    def step(self, step: Step) -> None:
        match step:
            case Given(relations):
                for relation in relations:
                    self.introduce(relation)
            case Define(relation):
                self.introduce(relation)
            case Equal(relations):
                for relation in relations:
                    self.fact(relation)
            case Conclude(facts=facts) | Note(facts=facts):
                for fact in facts:
                    self.fact(fact)
            case Diagram(_, labels):
                for name, label in labels:
                    if isinstance(label, Conjunction):
                        self.fact(label)
                    elif step.name in {"loop", "unity_loop"} and name in {"P", "F"}:
                        drawn = label.operand if isinstance(label, Negative) else label
                        assert self.agree(self.value(drawn), self.letters[name]), label
            case Tabulate():
                self.table(step)
            case CaseStep(when, substitution, steps):
                self.case(when, {name: sympy_scalar(value, self.names) for name, value in substitution}, steps)
            case Section(title, steps):
                self.sentence(title)
                for inside in steps:
                    self.step(inside)
        self.sentence(getattr(step, "sentence", None))

    def table(self, step: Tabulate) -> None:
        """Compare every row with one made anew, and every finding with what the table and the roots say."""
        symbol = sympy.Symbol(step.variable)
        coefficients = sympy.Poly(sympy.cancel(scalar(self.value(step.polynomial))), symbol).all_coeffs()
        small = sympy.Symbol("epsilon")
        names = {**self.names, **({step.table.epsilon: small} if step.table.epsilon else {})}
        expected = rows_of(coefficients, small)
        assert len(step.table.rows) == len(expected)
        for row, (power, entries, origin) in zip(step.table.rows, expected, strict=True):
            assert (row.power, row.origin, len(row.entries)) == (power, origin, len(entries)), row
            assert all(is_zero(sympy_scalar(a, names) - b) for a, b in zip(row.entries, entries, strict=True)), row
            self.tally.compared += len(entries)
        for finding in step.findings:
            slots = {name: self.said(slot, {**names, step.variable: sympy.Symbol("s")}) for name, slot in finding.slots}
            assert is_so(finding.key, slots, expected, coefficients, self.samples()), finding
            self.tally.compared += 1

    @staticmethod
    def said(slot: Any, names: Mapping[str, Any]) -> Any:
        """Return what a slot of a finding says: words, a value, or a comparison."""
        match slot:
            case Relation((left, right), (operator,)):
                return Reader.said(left, names), operator, Reader.said(right, names)
            case Literal(Scalar() as value):
                return sympy_scalar(value, names)
            case Counted():
                return ENGLISH.put(slot)
        return slot

    def sentence(self, sentence: Sentence | None) -> None:
        if sentence is None:
            return
        for name, slot in sentence.slots:
            if isinstance(slot, (Relation, Conjunction, Predicate, Roots, HoldsExactlyWhere)):
                self.fact(slot)
            elif isinstance(slot, Evaluated):
                self.fact(Relation((slot.formula, slot.value), ("=",)))
            elif not isinstance(slot, (str, SymbolList, *SPOKEN)):
                self.tally.spoken.append((f"{sentence.key}.{name}", self.value(slot)))

    def case(self, when: Relation | Conjunction, substitution: Mapping[str, Any], steps: tuple[Step, ...]) -> None:
        """Read on with the parameters replaced; letters that have no value there are forgotten."""
        if not substitution and isinstance(when, Relation) and when.operators == ("=",):
            self.at_eigenvalues(when, steps)
            return
        if not substitution and isinstance(when, Relation):
            self.where(when, steps)
            return
        outside, letters, known = self.names, self.letters, self.known
        self.known = known if self.known_at is None else self.known_at({**outside, **substitution})
        replaced = {sympy.Symbol(name): value for name, value in substitution.items()}
        self.names = {**outside, **substitution}
        self.letters = {}
        for name, value in letters.items():
            moved = value.subs(replaced)
            if not moved.has(sympy.zoo, sympy.nan, sympy.oo):
                self.letters[name] = moved
        for relation in when.relations if isinstance(when, Conjunction) else (when,):
            if relation.operators == ("!=",):
                assert not is_zero(scalar(self.value(relation.members[0])) - scalar(self.value(relation.members[1])))
                self.tally.compared += 1
            else:
                self.fact(relation)
        for step in steps:
            self.step(step)
        self.names, self.letters, self.known = outside, letters, known

    def where(self, when: Relation, steps: tuple[Step, ...]) -> None:
        """Read on at the sample points where an inequality or inequation holds."""
        left, right = (scalar(self.value(member)) for member in when.members)
        outside = self.letters, self.narrowed
        self.letters, self.narrowed = dict(self.letters), [*self.narrowed, (left - right, when.operators[0])]
        assert any(True for _ in self.samples()), when
        self.tally.compared += 1
        for step in steps:
            self.step(step)
        self.letters, self.narrowed = outside

    def at_eigenvalues(self, when: Relation, steps: tuple[Step, ...]) -> None:
        """Read on at every root of the equation in λ."""
        unknown = sympy.Symbol("lambda")
        sides = [scalar(self.value(member)) for member in when.members]
        outside, letters, once = self.names, dict(self.letters), self.tally.compared
        for root in sympy.roots(sides[0] - sides[1], unknown):
            self.names, self.tally.compared = {**outside, "lambda": root}, once
            self.fact(when)
            for step in steps:
                self.step(step)
        self.names, self.letters = outside, letters

    def introduce(self, relation: Relation) -> None:
        """Compare the members after the first with each other and with what is known, then let the first mean them."""
        target, *rest = relation.members
        if relation.operators == ("!=",):
            self.assumed.append(scalar(self.value(target)) - scalar(self.value(rest[0])))
            return
        values = [self.value(member) for member in rest]
        for left, operator, right in zip(values, relation.operators[1:], values[1:], strict=False):
            assert self.holds(left, operator, right) if operator == "≈" else self.agree(values[0], right), relation
        self.tally.compared += len(values) - 1
        match target:
            case Derivative(Letter(name)):
                self.settle(f"{name}'", values[0])
                self.rates[name] = rest[0]
            case Literal(symbol):
                (name,) = symbol.names
                self.settle(name, values[0])
                self.names[name] = values[0]
            case Letter(name):
                self.settle(name, values[0])
                if isinstance(values[0], dict):
                    self.signals[name] = rest[0]
                else:
                    self.letters[name] = values[-1] if values[0].has(sympy.Integral) else values[0]
            case _:
                raise AssertionError(relation)

    def settle(self, name: str, value: Value) -> None:
        """Hold a new letter against its independent value."""
        if name in self.known:
            assert self.agree(value, self.known[name]), (name, value)
            self.tally.compared += 1
        else:
            self.tally.unknown.append(name)

    # -- facts ---------------------------------------------------------------------------------------------------------

    def fact(self, fact: Fact) -> None:
        match fact:
            case Relation(members, operators):
                values = [self.value(member) for member in members]
                for left, operator, right in zip(values, operators, values[1:], strict=False):
                    assert self.holds(left, operator, right), fact
                self.tally.compared += len(operators)
                return
            case Conjunction(relations):
                for relation in relations:
                    self.fact(relation)
                return
            case Roots(polynomial, roots):
                found = [sympy_root(root, self.names) for root in roots]
                product = prod((self.symbol - root for root in found), start=sympy.Integer(1))
                above, below = sympy.cancel(scalar(self.value(polynomial))).as_numer_denom()
                parts = [sympy.Poly(part, self.symbol) for part in (above, below)]
                whole = parts[1] if parts[1].degree() > 0 else parts[0]
                assert is_zero(product - whole.as_expr() / whole.LC()), fact
            case HoldsExactlyWhere(Predicate("stable", subject), where):
                self.exactly(subject, where)
            case Predicate(name, subject):
                self.predicate(name, subject)
        self.tally.compared += 1

    def holds(self, left: Value, operator: str, right: Value) -> bool:
        if operator in {"=", "!=="}:
            return self.agree(left, right) == (operator == "=")
        if operator == "~":
            return bool(left.rank() == right.rank() == left.col_join(right).rank())
        if operator == "≈":
            assert shape(left) == shape(right)
            return all(map(is_rounding, entries_of(left), entries_of(right)))
        difference = scalar(left) - scalar(right)
        return all(compare(difference.subs(point), operator) for point in self.samples())

    def predicate(self, name: str, subject: Formula) -> None:
        found = self.value(subject)
        if shape(found) not in {None, (1, 1)}:
            self.property_of_entries(name, found)
            return
        value = sympy.cancel(scalar(found))
        above, below = (sympy.Poly(part, self.symbol) for part in value.as_numer_denom())
        if name in {"polynomial", "not_polynomial"}:
            assert (below.degree() == 0) == (name == "polynomial"), subject
            return
        if name == "strictly_proper":
            assert above.degree() < below.degree(), subject
            return
        if name == "no_stable_compensator":
            for point in self.samples():
                zeros, monic = (
                    sympy.Poly(above.as_expr().subs(point), self.symbol),
                    (below.as_expr() / below.LC()).subs(point),
                )
                real = [root for root in zeros.nroots() if root.is_real and root > 0]
                assert any(monic.subs(self.symbol, root) < 0 for root in real), subject
            return
        polynomial = (below if below.degree() > 0 else above).as_expr()
        if name in {"marginal", "beyond"}:
            for point in self.samples():
                real = [sympy.re(root) for root in sympy.Poly(polynomial.subs(point), self.symbol).nroots(n=30)]
                assert (max(real) <= 0) == (name == "marginal"), subject
            return
        for point in self.samples():
            if name == "never_zero":
                assert value.subs(point) != 0
            else:
                stable = is_stable(polynomial.subs(point), self.symbol, discrete=self.derivation.discrete)
                assert stable == {"stable": True, "unstable": False}[name], subject

    def property_of_entries(self, name: str, found: Value) -> None:
        """Decide properties of matrices of rational functions: all entries have them, or one is unstable."""
        fractions = [sympy.fraction(sympy.cancel(entry)) for entry in found]
        if name == "strictly_proper":
            assert all(
                sympy.degree(above, self.symbol) < sympy.degree(below, self.symbol) or above == 0
                for above, below in fractions
            ), found
            return
        for point in self.samples():
            poles = [below.subs(point) for _, below in fractions if below.has(self.symbol)]
            stable = all(is_stable(below, self.symbol, discrete=self.derivation.discrete) for below in poles)
            assert stable == {"stable": True, "unstable": False}[name], found

    def exactly(self, subject: Formula, where: tuple[Relation, ...]) -> None:
        """Compare the roots at every sample with the inequalities; both outcomes must occur."""
        above, below = sympy.cancel(scalar(self.value(subject))).as_numer_denom()
        polynomial, seen = (below if below.has(self.symbol) else above), set()
        sides = [(scalar(self.value(r.members[0])) - scalar(self.value(r.members[1])), r.operators[0]) for r in where]
        for point in self.samples():
            stable = is_stable(polynomial.subs(point), self.symbol, discrete=self.derivation.discrete)
            assert stable == all(compare(side.subs(point), operator) for side, operator in sides), (subject, point)
            seen.add(stable)
        assert seen == {True, False}

    def agree(self, left: Value, right: Value) -> bool:
        if isinstance(left, dict) or isinstance(right, dict):
            assert isinstance(left, dict)
            assert isinstance(right, dict)
            return all(
                self.agree(left.get(name, 0 * right.get(name, 0)), right.get(name, 0 * left.get(name, 0)))
                for name in left.keys() | right.keys()
            )
        if shape(left) != shape(right):
            left, right = scalar(left), scalar(right)
        difference = left - right
        return all(map(self.is_zero, difference)) if shape(difference) else self.is_zero(difference)

    def is_zero(self, expression: Any) -> bool:
        """Whether an expression is 0: exactly, or with functions in it by 50 digits at points the signs allow."""
        if not expression.has(sympy.Function, sympy.Integral, sympy.sqrt(sympy.Wild("w"))):
            return is_zero(expression)
        names = sorted(expression.free_symbols, key=str)
        with mpmath.workdps(50):
            return all(abs(numeric(expression, at)) < mpmath.mpf(10) ** -25 for at in self.numbers(names))

    def numbers(self, names: list[Any]) -> Iterator[dict[Any, Any]]:
        """Yield three points: those of the samples, anything for a time."""
        for index, point in enumerate(islice(self.samples(), 3)):
            drawn = (point.get(name, sympy.Rational(sum(map(ord, str(name))) + index, 97)) for name in names)
            yield {name: mpmath.mpf(number.p) / number.q for name, number in zip(names, drawn, strict=True)}

    # -- formulas ------------------------------------------------------------------------------------------------------

    def value(self, formula: Formula) -> Value:
        match formula:
            case Letter("s"):
                return self.symbol
            case Letter(name) if name in self.letters:
                return self.letters[name]
            case Letter(name):
                return self.value(self.signals[name]) if name in self.signals else {name: sympy.eye(self.sizes[name])}
            case Literal(value) | Decimals(value):
                return self.literal(value)
            case Identity(order):
                return sympy.eye(order)
            case Sum(terms):
                return reduce(plus, map(self.value, terms))
            case Negative(operand):
                return times(sympy.Integer(-1), self.value(operand))
            case Product(factors):
                return reduce(lambda right, left: times(left, right), map(self.value, reversed(factors)))
            case Power(base, exponent):
                value = self.value(base)
                return (inverse(value) if exponent < 0 else value) ** abs(exponent) if shape(value) else value**exponent
            case Transpose(operand):
                return self.value(operand).T
            case Quotient(above, below):
                return times(1 / scalar(self.value(below)), self.value(above))
            case Apply(function, argument):
                return self.function(function, self.value(argument))
            case Block(rows):
                return stacked([[self.value(entry) for entry in row] for row in rows])
            case Derivative(operand, name):
                value = self.value(operand)
                return self.rate(value) if isinstance(value, dict) else value.diff(sympy.Symbol(name))
            case At(operand, name, instant):
                return self.value(operand).subs(sympy.Symbol(name), sympy_scalar(instant, self.names))
            case Integral(integrand, _, name, lower, upper):
                limits = (sympy.Symbol(name), *(sympy_scalar(end, self.names) for end in (lower, upper)))
                return integral(self.value(integrand), limits)
        raise AssertionError(formula)

    def literal(self, value: Scalar | Matrix) -> Value:
        if isinstance(value, Matrix):
            return sympy.Matrix(*value.shape, [sympy_scalar(entry, self.names) for entry in value.entries])
        return sympy_scalar(value, self.names)

    def function(self, name: str, value: Value) -> Value:
        match name:
            case "det":
                return value.det(method="berkowitz")
            case "adj":
                return value.adjugate()
            case "rank":
                point = next(iter(self.samples()))
                return sympy.Integer(value.subs(point).rank())
        polynomial = self.known[name] if name in self.known else self.letters[name.removesuffix("_at")]
        if not isinstance(value, sympy.MatrixBase):
            return polynomial.subs(self.symbol, value)
        return polynomial_at(polynomial, self.symbol, value)

    def rate(self, signal: dict[str, Value]) -> Value:
        slopes = {name: part.diff(sympy.Symbol("t")) for name, part in signal.items()}
        whole = reduce(plus, (times(part, self.value(self.rates[name])) for name, part in signal.items()))
        return whole if all(slope.is_zero_matrix for slope in slopes.values()) else plus(whole, slopes)


def numeric(expression: Any, point: Mapping[Any, Any]) -> Any:
    """Return the number an expression is at a point, integrals by quadrature."""
    if expression.is_Symbol:
        return point[expression]
    if expression.is_Rational:
        return mpmath.mpf(int(expression.p)) / int(expression.q)
    if isinstance(expression, sympy.Integral):
        ((name, lower, upper),) = expression.limits
        ends = [numeric(end, point) for end in (lower, upper)]
        return mpmath.quad(lambda x: numeric(expression.function, {**point, name: x}), ends)
    if expression in CONSTANTS:
        return CONSTANTS[expression]
    parts = [numeric(part, point) for part in expression.args]
    kind = expression.func.__name__
    if kind in {"Add", "Mul"}:
        return (mpmath.fsum if kind == "Add" else mpmath.fprod)(parts)
    return getattr(mpmath, {"Pow": "power"}.get(kind, kind))(*parts)


CONSTANTS = {sympy.I: mpmath.j, sympy.E: mpmath.e, sympy.pi: mpmath.pi}


def integral(value: Value, limits: tuple[Any, ...]) -> Value:
    """Return an integral, exactly for polynomials, else as one that quadrature evaluates."""
    if shape(value):
        return value.applyfunc(lambda entry: integral(entry, limits))
    value = sympy.expand(value)
    return sympy.integrate(value, limits) if value.is_polynomial(limits[0]) else sympy.Integral(value, limits)


def shape(value: Value) -> tuple[int, int] | None:
    return value.shape if hasattr(value, "shape") else None


def scalar(value: Value) -> Any:
    """Return a 1×1 matrix as its entry."""
    if shape(value) is None:
        return value
    assert shape(value) == (1, 1)
    return value[0, 0]


def plus(left: Value, right: Value) -> Value:
    if isinstance(left, dict):
        both = left.keys() & right.keys()
        return {**left, **right, **{name: left[name] + right[name] for name in both}}
    return left + right if shape(left) == shape(right) else scalar(left) + scalar(right)


def times(left: Value, right: Value) -> Value:
    if isinstance(right, dict):
        return {name: times(left, part) for name, part in right.items()}
    one, other = shape(left), shape(right)
    if one is None or other is None or one[1] == other[0]:
        return left * right
    return left[0, 0] * right if one == (1, 1) else left * scalar(right)


def stacked(rows: list[list[Value]]) -> Value:
    if isinstance(rows[0][0], dict):
        parts = [row[0] for row in rows]
        names = {name: part for signal in parts for name, part in signal.items()}
        heights = [next(iter(signal.values())).rows for signal in parts]
        return {
            name: sympy.Matrix.vstack(
                *[s.get(name, sympy.zeros(h, some.cols)) for s, h in zip(parts, heights, strict=True)]
            )
            for name, some in names.items()
        }
    blocks = [[part if shape(part) else sympy.Matrix([[part]]) for part in row] for row in rows]
    return sympy.Matrix.vstack(*[sympy.Matrix.hstack(*row) for row in blocks])


def entries_of(value: Value) -> list[Any]:
    """The entries of a matrix, or the number alone."""
    return list(value) if isinstance(value, sympy.MatrixBase) else [value]


def is_rounding(exact: Any, shown: Any) -> bool:
    """Tell whether a decimal is what a number is rounded to: by SymPy's digits, and exact where it is a whole number."""
    places = next(k for k in range(60) if (shown * 10**k).is_integer)
    return bool(exact == shown if places == 0 else abs(exact - shown) * 2 * 10**places <= 1)


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
