"""Derivations read without the kernel: every formula evaluated in plain fractions at random points.

Nothing of `symobs.exact`, `symobs.formula.tree.evaluate`, `certificate` or `derivation.check` takes part: a scalar is read by
its terms, a matrix is a list of lists, a determinant is an elimination.  A polynomial identity of degree d that is false
holds at a point drawn from 10⁹ values with probability at most d / 10⁹; three points are drawn.  Functions of time are
numbers of 60 digits there, derivatives are those of Taylor coefficients (`series`), and a primitive has its integrand as
derivative at a random instant.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact import EIGENVALUE, Matrix, Root, Scalar
from symobs.exact.core.generators import PI, function_named, symbols_in
from symobs.exact.time_functions.matrix_exponential import RootSum
from symobs.formula.figures import TimeResponse, figure_of, is_box, is_integrator, key
from symobs.formula.phrases.languages import Counted, StateChoice
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
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Inequalities,
    Note,
    Plot,
    RegionSummary,
    Section,
    Tabulate,
)
from tests.support.independent_algebra import regions_in_plain_fractions as regions
from tests.support.independent_algebra import series
from tests.support.independent_algebra.plain import coefficients_at, multiply, transposed
from tests.support.independent_algebra.responses import untrue_responses

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.figures import Picture
    from symobs.formula.tree import Environment, Fact, Formula
    from symobs.proof.derivation import Step
    from tests.support.independent_algebra.plain import Rows

LARGEST = 2**30
_ONE = Literal(Scalar.of(1))


def identity(order: int) -> Rows:
    return [[Fraction(i == j) for j in range(order)] for i in range(order)]


def eliminate(table: Rows, width: int) -> tuple[int, Fraction, Rows]:
    """Return rank and determinant of the first `width` columns, and the rows reduced by Gauss and Jordan."""
    rows, rank, determinant = [list(row) for row in table], 0, Fraction(1)
    for column in range(width):
        pivot = next((i for i in range(rank, len(rows)) if rows[i][column]), None)
        if pivot is None:
            determinant = Fraction(0)
            continue
        if pivot != rank:
            rows[rank], rows[pivot], determinant = rows[pivot], rows[rank], -determinant
        lead = rows[rank][column]
        determinant *= lead
        rows[rank] = [entry / lead for entry in rows[rank]]
        for i, row in enumerate(rows):
            if i != rank and row[column]:
                rows[i] = [a - row[column] * b for a, b in zip(row, rows[rank], strict=True)]
        rank += 1
    return rank, determinant, rows


def determinant(table: Rows) -> Fraction:
    return eliminate(table, len(table))[1]


def inverse(table: Rows) -> Rows:
    order = len(table)
    rank, _, rows = eliminate([row + unit for row, unit in zip(table, identity(order), strict=True)], order)
    if rank < order:
        raise ZeroDivisionError
    return [row[order:] for row in rows]


def adjugate(table: Rows) -> Rows:
    def cofactor(i: int, j: int) -> Fraction:
        minor = [[x for b, x in enumerate(row) if b != i] for a, row in enumerate(table) if a != j]
        return -determinant(minor) if (i + j) % 2 else determinant(minor)

    return [[cofactor(i, j) for j in range(len(table))] for i in range(len(table))]


class Algebraic(Fraction):
    """A polynomial in λ modulo q: an element of Q[λ]/(q), which is a field where q is irreducible."""

    parts: list[Fraction]
    modulus: list[Fraction]

    @classmethod
    def make(cls, parts: Sequence[Fraction], modulus: list[Fraction]) -> Fraction:
        """Reduce parts, constant first, by the monic modulus, constant first."""
        left, degree = [Fraction(p) for p in parts], len(modulus) - 1
        while len(left) > degree:
            lead = left.pop()
            for k in range(degree):
                left[len(left) - degree + k] -= lead * modulus[k]
        found = super().__new__(cls, 0)
        found.parts, found.modulus = left + [Fraction(0)] * (degree - len(left)), modulus
        return found

    def _of(self, other: Fraction) -> list[Fraction]:
        return other.parts if isinstance(other, Algebraic) else [Fraction(other)]

    def __add__(self, other: Any) -> Any:
        mine, others = self.parts, [*self._of(other), *([Fraction(0)] * len(self.parts))]
        return self.make([a + b for a, b in zip(mine, others, strict=False)], self.modulus)

    def __mul__(self, other: Any) -> Any:
        others = self._of(other)
        total = [Fraction(0)] * (len(self.parts) + len(others))
        for i, a in enumerate(self.parts):
            for j, b in enumerate(others):
                total[i + j] += a * b
        return self.make(total, self.modulus)

    def __pow__(self, exponent: Any) -> Any:
        total: Any = self.make([Fraction(1)], self.modulus)
        for _ in range(exponent):
            total = total * self
        return total

    def __truediv__(self, other: Any) -> Any:
        if not isinstance(other, Algebraic):
            return self * (1 / Fraction(other))
        degree, root = len(self.parts), self.make([Fraction(0), Fraction(1)], self.modulus)
        images: list[Any] = [other]
        for _ in range(degree - 1):
            images.append(images[-1] * root)
        rows = [[image.parts[i] for image in images] for i in range(degree)]
        solved = inverse(rows)
        return self * self.make([row[0] for row in solved], self.modulus)

    def __rtruediv__(self, other: Any) -> Any:
        return self.make([Fraction(other)], self.modulus) / self

    def __neg__(self) -> Any:
        return self * Fraction(-1)

    def __sub__(self, other: Any) -> Any:
        return self + Fraction(-1) * other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __bool__(self) -> bool:
        return any(self.parts)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (int, Fraction)) and not (self - other)

    __hash__ = None  # type: ignore[assignment]


class Compared(NamedTuple):
    """Two members that an inequality or inequation compares, and their difference."""

    difference: Any
    members: tuple[Formula, ...]


@dataclass
class World:
    """What the letters mean at one point; a letter stands for a value or a formula, read when asked for."""

    seed: int
    variable: str
    signs: Mapping[str, str]
    letters: dict[str, Any] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    rates: dict[str, Formula] = field(default_factory=dict)
    meanings: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, environment: Environment, seed: int) -> World:
        return cls(
            seed,
            environment.variable,
            environment.signs,
            {**environment.values, **environment.signals},
            environment.sizes,
            dict(environment.dynamics),
            dict(environment.coefficients),
        )

    def copy(self) -> World:
        return replace(self, letters=dict(self.letters), rates=dict(self.rates), meanings=dict(self.meanings))

    # -- values ---------------------------------------------------------------------------------------------------

    def number(self, name: str) -> Fraction:
        """Return what a parameter is here: its meaning, or a random fraction of its sign."""
        function = function_named(name)
        if regions.is_number(name):
            return regions.number_of(name)
        if isinstance(function, RootSum):
            q = [self.scalar(c) for c in function.polynomial.coefficients(EIGENVALUE)]
            return series.root_sum(q, function.power, self.scalar(function.argument))  # type: ignore[no-any-return]
        if function is not None:
            return series.applied(function.kind, self.scalar(function.argument))  # type: ignore[no-any-return]
        if name == PI:
            return series.PI
        if name in self.meanings:
            found = self.meanings[name]
            found = found if isinstance(found, Fraction) else self.value(found)
            return found if isinstance(found, Fraction) else found[0][0]
        draw = random.Random(f"{self.seed} {name}")  # noqa: S311 - repeatable by design
        size = Fraction(draw.randint(LARGEST // 8, LARGEST), draw.choice((1, 2, 3)) * LARGEST // 4)
        sign = self.signs.get(name, "real")
        down = sign in {"negative", "nonpositive"} or (sign in {"real", "nonzero"} and draw.random() < 0.5)
        return -size if down else size

    def scalar(self, value: Scalar) -> Fraction:
        return self.polynomial(value.numerator) / self.polynomial(value.denominator)

    def polynomial(self, value: Scalar) -> Fraction:
        numbers = {name: self.number(name) for name in value.names}
        total = Fraction(0)
        for coefficient, powers in value.terms():
            term = Fraction(coefficient)
            for name, exponent in powers:
                term *= numbers[name] ** exponent
            total += term
        return total

    def coefficients(self, value: Scalar) -> list[Fraction]:
        """Return the coefficients of a polynomial of the variable, constant first."""
        below = self.polynomial(value.denominator)
        collected: dict[int, Fraction] = {}
        for coefficient, powers in value.terms():
            term, degree = Fraction(coefficient) / below, 0
            for name, exponent in powers:
                if name == self.variable:
                    degree = exponent
                else:
                    term *= self.number(name) ** exponent
            collected[degree] = collected.get(degree, Fraction(0)) + term
        return [collected.get(degree, Fraction(0)) for degree in range(max(collected, default=0) + 1)]

    def value(self, item: Any) -> Any:
        """Return a fraction, a table, or a signal: free signal → table of coefficients."""
        match item:
            case Scalar():
                return self.scalar(item)
            case Matrix():
                return [[self.scalar(entry) for entry in row] for row in item.rows]
            case Literal(value) | Decimals(value):
                return self.value(value)
            case Letter("s"):
                return self.number(self.variable)
            case Letter(name):
                if self.letters[name] is None:
                    return {name: identity(self.sizes[name])}
                return self.value(self.letters[name])
            case Identity(order):
                return identity(order)
            case Negative(operand):
                return times(Fraction(-1), self.value(operand))
            case Sum(terms):
                total = self.value(terms[0])
                for term in terms[1:]:
                    total = plus(total, self.value(term))
                return total
            case Product(factors):
                total = self.value(factors[-1])
                for factor in reversed(factors[:-1]):
                    total = times(self.value(factor), total)
                return total
            case Quotient(above, below):
                return times(1 / single(self.value(below)), self.value(above))
            case Power(base, exponent):
                return power(self.value(base), exponent)
            case Transpose(operand):
                value = self.value(operand)
                return value if is_number(value) else transposed(value)
            case Apply(function, argument):
                return self.apply(function, self.value(argument))
            case Block(rows):
                return stacked([[self.value(entry) for entry in row] for row in rows])
            case Derivative(operand, name):
                return self.derivative(operand, name)
            case At(operand, name, instant):
                return self.at(name, self.scalar(instant)).value(operand)
            case Integral(integrand, primitive, name, lower, upper):
                there = self.at(name, World(self.seed, "", {}).number(f"instant {name}"))
                if zeroed(plus(there.derivative(primitive, name), times(Fraction(-1), there.value(integrand)))) != 0:
                    raise ArithmeticError(primitive)
                first, last = (self.at(name, self.scalar(end)).value(primitive) for end in (lower, upper))
                return plus(last, times(Fraction(-1), first))
        raise TypeError(item)

    def at(self, name: str, instant: Fraction) -> World:
        """Return the world where a generator is a given number."""
        return replace(self, meanings={**self.meanings, name: instant})

    def apply(self, function: str, table: Any) -> Any:
        if function.endswith("_at") and is_number(table):
            return single(self.at(self.variable, table).value(Letter(function.removesuffix("_at"))))
        if function.endswith("_at"):
            total = [[Fraction(0)] * len(table) for _ in table]
            for coefficient in reversed(self.coefficients(self.letters[function.removesuffix("_at")])):
                total = plus(multiply(total, table), times(coefficient, identity(len(table))))
            return total
        if function == "rank":
            return Fraction(eliminate(table, len(table[0]))[0])
        return {"det": determinant, "adj": adjugate}[function](table)

    def derivative(self, operand: Formula, name: str) -> Any:
        """Return the derivative of a value by a generator, or of a signal by the time."""
        now = self.number(name)
        parts = now.parts if isinstance(now, series.Series) else [now]
        value = self.at(name, series.Series.moving(parts[0], len(parts) + 1)).value(operand)
        if not isinstance(value, dict):
            return series.rate(value)
        slopes = {signal: series.rate(table) for signal, table in value.items()}
        whole = self.rate(self.value(operand))
        return whole if zeroed(slopes) == 0 else plus(whole, slopes)

    def rate(self, signal: Mapping[str, Rows]) -> Any:
        parts = [times(table, self.value(self.rates[name])) for name, table in signal.items()]
        total = parts[0]
        for part in parts[1:]:
            total = plus(total, part)
        return total

    # -- steps ----------------------------------------------------------------------------------------------------

    def introduce(self, relation: Relation) -> None:
        target, *rest = relation.members
        meaning = next((member for member in reversed(rest) if isinstance(member, Literal)), rest[0])
        match target:
            case Derivative(Letter(name)):
                self.rates[name] = rest[0]
            case Letter(name):
                self.letters[name] = meaning.value if isinstance(meaning, Literal) else meaning
            case Literal(Scalar() as value) if len(value.names) == 1:
                (name,) = value.names
                self.meanings[name] = rest[-1]
            case _:
                raise TypeError(target)

    def read(self, steps: Sequence[Step]) -> Iterator[tuple[str, Any]]:
        """Yield what the steps say as (kind, content), each read at this point; relations introduce first members."""
        for step in steps:
            match step:
                case Section(steps=inside):
                    yield from self.read(inside)
                case Given(relations):
                    for relation in relations:
                        yield from self.data(relation)
                case Define(relation):
                    yield from self.data(relation)
                case Equal(relations):
                    yield from self.facts(relations)
                case Conclude(facts=facts) | Note(facts=facts):
                    yield from self.facts(facts)
                case Diagram(figure, labels):
                    signs = {wire.gain for wire in figure_of(figure).wires}
                    for name, label in labels:
                        if isinstance(label, Conjunction):
                            yield from self.facts((label,))
                        elif name in signs:  # whatever it is, where a gain behind it is 0
                            yield f"label {name}", self.arriving(figure, dict(labels)) or self.value(label)
                        elif name[0].isupper():
                            yield f"label {name}", self.value(label)
                case Tabulate():
                    yield from self.table(step)
                case Inequalities(fact):
                    yield from self.facts((fact,))
                case RegionSummary():
                    yield from self.survey(step)
                case Plot(TimeResponse() as responses, subject):
                    yield "=", Fraction(len(untrue_responses(responses, self.value(subject))))
                case Plot(picture, subject):
                    yield "property stable", single(self.value(subject))
                    yield "=", Fraction(len(list(self.seen(picture, subject))))
                case CaseStep(when, substitution, inside):
                    stratum = self.copy()
                    relations = when.relations if isinstance(when, Conjunction) else (when,)
                    if not substitution:
                        stratum.move_to([_equation(relation) for relation in relations if relation.operators == ("=",)])
                    stratum.meanings |= dict(substitution)
                    for relation in relations:
                        (operator,) = relation.operators
                        kind = f"condition {operator}" if operator in {"<", ">"} else "condition"
                        yield kind, single(self.difference(relation))
                        if operator == "=":
                            yield "zero", single(stratum.difference(relation))
                    yield from stratum.read(inside)
            sentence = getattr(step, "sentence", None)
            if sentence is not None:
                yield "words", sentence.key
                for _, slot in sentence.slots:
                    yield from self.facts((slot,))

    def arriving(self, name: str, labels: Mapping[str, Any]) -> dict[str, Any]:
        """Return by which matrices signals reach the integrators of a diagram; nothing where boxes are whole systems."""
        figure = figure_of(name).without_missing(labels)
        if figure.response or any(isinstance(label, Conjunction) for label in labels.values()):
            return {}

        def leaving(node: str) -> Any:
            if is_integrator(node) or not figure.into(node):
                return self.value(labels[key(node)])
            return times(self.value(labels[key(node)]), total(node)) if is_box(node) else total(node)

        def total(node: str) -> Any:
            wires = figure.into(node)
            return reduce(plus, (times(self.value(labels.get(w.gain, _ONE)), leaving(w.begin)) for w in wires))

        return {node: total(node) for node in figure.place if is_integrator(node)}

    def table(self, step: Tabulate) -> Iterator[tuple[str, Any]]:
        """Yield what a table says: the polynomial of its two upper rows, the rule of each row, its shape, its findings."""
        rows = [(row.power, [self.scalar(entry) for entry in row.entries], row.origin) for row in step.table.rows]
        yield "=", Fraction(rows[0][0] + 1 - len(rows))
        yield from (("=", Fraction(len(entries) - power // 2 - 1)) for power, entries, _ in rows)
        at, left = self.number(step.variable), single(self.value(step.polynomial))
        yield "means", left
        for power, entries, origin in rows[:2]:
            held = {"auxiliary": [], "epsilon": [Fraction(0), *entries[1:]]}.get(origin, entries)
            left -= sum((entry * at ** (power - 2 * k) for k, entry in enumerate(held)), Fraction(0))
        yield "=", left
        for i, (_, entries, origin) in enumerate(rows[1:], 1):
            (above, q, _), p = rows[i - 1], rows[i - 2][1]
            crossed = [q[0] * _at(p, k + 1) - p[0] * _at(q, k + 1) for k in range(len(entries))]
            for k, (entry, product) in enumerate(zip(entries, crossed, strict=True)):
                if origin == "auxiliary":
                    yield "=", entry - (above - 2 * k) * q[k]
                elif origin == "epsilon" and k == 0:
                    yield "=", entry - self.number(step.table.epsilon)
                elif i > 1:
                    yield "=", entry * q[0] - product
            if i > 1 and origin in {"auxiliary", "epsilon"}:
                yield "=", Fraction(any(crossed if origin == "auxiliary" else crossed[:1]))
        yield "shape", [(power, origin, len(entries)) for power, entries, origin in rows]
        yield "words", [(finding.key, repr(finding.slots)) for finding in step.findings]

    def survey(self, step: RegionSummary) -> Iterator[tuple[str, Any]]:
        """Yield of which polynomial it is, whether the parts are where it is stable, and the findings."""
        yield "property stable", single(self.value(step.polynomial))
        signs = {name: self.signs.get(name, "real") for name in self.names_of(step.polynomial)}
        samples = list(regions.points(tuple(signs), signs, self.seed))

        def stable(point: Mapping[str, Fraction]) -> bool:
            return self.is_stable(step.polynomial, point)

        if step.parts:
            wrong = sum(stable(p) != any(regions.all_hold(part, p) for part in step.parts) for p in samples)
            yield "=", Fraction(wrong)
        yield "=", Fraction(sum(not regions.is_so(finding, stable, samples, step.names) for finding in step.findings))
        yield "words", (step.names, [repr(finding) for finding in step.findings])

    def seen(self, picture: Picture, subject: Formula) -> Iterator[str]:
        """Yield what a picture shows that is not so."""
        value = self.polynomial_of(subject)
        assert value is not None
        yield from regions.all_faults(picture, value, self.variable, self.is_discrete)

    @property
    def is_discrete(self) -> bool:
        return self.variable == "z"

    def polynomial_of(self, subject: Formula) -> Scalar | None:
        """Return a letter's polynomial in the variable up to a number, of a quotient that of its poles; None without one."""
        value = self.scalar_of(subject)
        if value is None:
            return None
        value = value.denominator if self.is_quotient(value) else value
        return None if value.names & set(self.meanings) else value

    def scalar_of(self, subject: Formula) -> Scalar | None:
        """Return the value of a letter up to a number, None where it is no scalar."""
        if isinstance(subject, Negative):
            return self.scalar_of(subject.operand)
        if isinstance(subject, Sum) and len(set(subject.terms)) == 1:
            return self.scalar_of(subject.terms[0])
        value = self.letters.get(subject.name) if isinstance(subject, Letter) else None
        value = value.value if isinstance(value, Literal) else value
        return value if isinstance(value, Scalar) else None

    def is_quotient(self, value: Scalar | None) -> bool:
        return value is not None and self.variable in value.denominator.names

    def names_of(self, subject: Formula) -> frozenset[str]:
        value = self.polynomial_of(subject)
        assert value is not None
        return frozenset(value.names) - {self.variable}

    def is_stable(self, subject: Formula, point: Mapping[str, Fraction]) -> bool:
        value = self.polynomial_of(subject)
        assert value is not None
        coefficients = coefficients_at(value, self.variable, point)
        if self.is_quotient(self.scalar_of(subject)) and not any(coefficients):
            raise ZeroDivisionError(point)
        return regions.is_stable(coefficients, discrete=self.is_discrete)

    def region(self, fact: HoldsExactlyWhere) -> Iterator[tuple[str, Any]]:
        """Yield whether some inequalities hold exactly where a polynomial is stable, at points."""
        about = fact.property.subject
        wrong = 0
        said = {name for relation in fact.where for member in relation.members for name in _symbols(member)}
        names = {*said, *self.names_of(about)}
        for point in regions.points(tuple(names), self.signs, self.seed):
            try:
                wrong += self.is_stable(about, point) != regions.all_hold(fact.where, point)
            except ZeroDivisionError:  # there is no such function there
                continue
        yield "=", Fraction(wrong)

    def move_to(self, equations: Sequence[Scalar]) -> None:
        """Let λ, or a parameter, be a root of the one equation that holds: a rational one or that of an irreducible factor."""
        if len(equations) != 1 or not equations[0].names:
            return
        (equation,) = equations
        name = EIGENVALUE if EIGENVALUE in equation.names else min(equation.names)
        moved = equation.substitute({other: Scalar.of(self.number(other)) for other in equation.names - {name}})
        factors = [factor for factor, _ in moved.numerator.factors()[1] if name in factor.names]
        lead, *rest = min(factors, key=lambda factor: factor.degree(name)).coefficients(name)
        monic = [*(c.fraction() / lead.fraction() for c in reversed(rest)), Fraction(1)]
        self.meanings[name] = -monic[0] if len(rest) == 1 else Algebraic.make([Fraction(0), Fraction(1)], monic)

    def difference(self, relation: Relation) -> Any:
        return plus(self.value(relation.members[0]), times(Fraction(-1), self.value(relation.members[1])))

    def data(self, relation: Relation) -> Iterator[tuple[str, Any]]:
        if relation.operators == ("!=",):
            yield "condition", self.difference(relation)
            return
        assert relation.operators[0] == "=", "an introduction is an equation"
        self.introduce(relation)
        free = relation.members[0] in {
            Letter("N"),
            Letter("N_K"),
        }  # any basis will do, for which the facts that follow are true
        yield "basis" if free else "means", self.value(relation.members[0])
        yield from self.facts((relation,))

    def facts(self, facts: Sequence[Fact | Formula | str]) -> Iterator[tuple[str, Any]]:
        for fact in facts:
            match fact:
                case Relation(members, operators):
                    values = [self.value(member) for member in members]
                    for index, operator in enumerate(operators):
                        if operator == "~":  # the rows span the same space
                            yield "=", Fraction(not same_rows(values[index], values[index + 1]))
                            continue
                        if operator == "≈":
                            yield "=", Fraction(not is_rounded(values[index], values[index + 1]))
                            continue
                        content = zeroed(plus(values[index], times(Fraction(-1), values[index + 1])))
                        yield (
                            operator,
                            content if operator in {"=", "!=="} else Compared(content, members[index : index + 2]),
                        )
                case Conjunction(relations):
                    yield from self.facts(relations)
                case Evaluated(formula, value):
                    yield from self.facts((Relation((formula, value), ("=",)),))
                case Predicate(name, subject):
                    value = self.value(subject)
                    yield f"property {name}", value if is_matrix(value) else single(value)
                case Roots(polynomial, values):
                    yield "condition", single(self.value(polynomial))
                    yield "roots", tuple(sorted(repr(self.root(root)) for root in values))
                case HoldsExactlyWhere(about, where):
                    yield f"property {about.name}", single(self.value(about.subject))
                    if about.name == "stable" and self.polynomial_of(about.subject) is not None:
                        yield from self.region(fact)
                        continue
                    yield "region", [(relation.operators, single(self.difference(relation))) for relation in where]
                case str() | Counted() | StateChoice():
                    yield "word", fact
                case SymbolList(names):
                    yield "word", names
                case _:
                    yield "shown", self.value(fact)

    def root(self, root: Root) -> tuple[Any, ...]:
        if not root.is_closed:
            return ("of", tuple(self.coefficients(root.factor)), root.index)
        radicand = self.scalar(root.radicand)
        return ("at", self.scalar(root.centre), radicand, root.sign if radicand else 1)


def _equation(relation: Relation) -> Scalar:
    left, right = (member.value for member in relation.members)  # type: ignore[union-attr]
    assert isinstance(left, Scalar)
    assert isinstance(right, Scalar)
    return left - right


def _symbols(member: Formula) -> frozenset[str]:
    return symbols_in(member.value) if isinstance(member, Literal) and isinstance(member.value, Scalar) else frozenset()


def _at(row: Sequence[Fraction], place: int) -> Fraction:
    return row[place] if place < len(row) else Fraction(0)


def is_rounded(exact: Any, shown: Any) -> bool:
    """Tell whether every decimal is within half a unit of its last place, and exact where it has none."""
    if not is_matrix(exact):
        exact, shown = [[single(exact)]], [[single(shown)]]
    if [len(row) for row in exact] != [len(row) for row in shown]:
        return False
    pairs = [pair for left, right in zip(exact, shown, strict=True) for pair in zip(left, right, strict=True)]
    for value, near in pairs:
        unit = Fraction(1)
        while (near / unit).denominator != 1:
            unit /= 10
        if abs(value - near) > (0 if unit == 1 else unit / 2):
            return False
    return True


def same_rows(left: Rows, right: Rows) -> bool:
    """Tell whether the rows of two tables span the same space."""
    if len(left[0]) != len(right[0]):
        return False
    return len({eliminate(table, len(left[0]))[0] for table in (left, right, [*left, *right])}) == 1


def single(value: Any) -> Fraction:
    """Read a 1×1 table as its entry."""
    if isinstance(value, Fraction):
        return value
    ((entry,),) = value
    assert isinstance(entry, Fraction)
    return entry


def is_number(value: Any) -> bool:
    return isinstance(value, Fraction)


def is_matrix(value: Any) -> bool:
    """Tell whether a value is a table of more than one entry."""
    return isinstance(value, list) and len(value) * len(value[0]) > 1


def plus(left: Any, right: Any) -> Any:
    if isinstance(left, dict):
        return {
            name: plus(left[name], right[name]) if name in left and name in right else (left.get(name) or right[name])
            for name in {**left, **right}
        }
    if is_number(left) and is_number(right):
        return left + right
    if is_number(left) or is_number(right):
        return single(left) + single(right)
    return [[a + b for a, b in zip(p, q, strict=True)] for p, q in zip(left, right, strict=True)]


def times(left: Any, right: Any) -> Any:
    if isinstance(right, dict):
        return {name: times(left, table) for name, table in right.items()}
    if is_number(left):
        return left * right if is_number(right) else [[left * entry for entry in row] for row in right]
    if is_number(right):
        return times(right, left)
    if len(left[0]) == len(right):
        return multiply(left, right)
    return times(single(left), right) if len(left) == len(left[0]) == 1 else times(single(right), left)


def power(base: Any, exponent: int) -> Any:
    if exponent < 0:
        base, exponent = (1 / base if is_number(base) else inverse(base)), -exponent
    total = Fraction(1) if is_number(base) else identity(len(base))
    for _ in range(exponent):
        total = times(total, base)
    return total


def stacked(rows: list[list[Any]]) -> Any:
    if isinstance(rows[0][0], dict):
        names = dict.fromkeys(name for (part,) in rows for name in part)
        heights = [len(next(iter(part.values()))) for (part,) in rows]
        widths = {name: len(part[name][0]) for (part,) in rows for name in part}
        return {
            name: [
                line
                for (part,), height in zip(rows, heights, strict=True)
                for line in part.get(name, [[Fraction(0)] * widths[name]] * height)
            ]
            for name in names
        }
    tables = [[[[part]] if is_number(part) else part for part in row] for row in rows]
    return [[entry for part in row for entry in part[i]] for row in tables for i in range(len(row[0]))]


def zeroed(value: Any) -> Any:
    """Return 0 for a difference that vanishes in every entry, else the difference."""
    if isinstance(value, dict):
        return Fraction(0) if all(zeroed(table) == 0 for table in value.values()) else value
    if is_number(value):
        return value
    return Fraction(0) if not any(entry for row in value for entry in row) else value
