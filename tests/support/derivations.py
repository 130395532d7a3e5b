"""Derivations read without the kernel: every formula evaluated at random points, and what a changed derivation says.

Nothing of `symobs.exact`, `symobs.formula.tree.evaluate`, `certificate` or `derivation.check` takes part: a scalar is read by
its terms, a matrix is a list of lists, a determinant is an elimination.  A polynomial identity of degree d that is false
holds at a point drawn from 10⁹ values with probability at most d / 10⁹; three points are drawn.  Functions of time are
numbers of 60 digits there, derivatives are those of Taylor coefficients, and a primitive has its integrand as derivative at
a random instant.
"""

from __future__ import annotations

import cmath
import itertools
import math
import random
from collections import deque
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache, reduce
from operator import mul
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeAlias

import mpmath
import sympy

from symobs.exact import EIGENVALUE, Matrix, Root, Scalar
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import PI, function_named, symbols_in
from symobs.formula.figures import (
    BodePicture,
    BranchPicture,
    NyquistPicture,
    TimeResponse,
    figure_of,
    is_box,
    is_integrator,
    key,
)
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
from symobs.tasks.result.output_methods import to_sympy
from tests.support.algebra import (
    CONTEXT,
    Series,
    adjugate,
    applied,
    at_number,
    coefficients_at,
    determinant,
    digits,
    identity,
    inverse,
    is_stable,
    multiply,
    rank_of,
    rate,
    root_sum,
    transposed,
)
from tests.support.algebra import PI as NUMBER_PI
from tests.support.claims.claims_with_dead_time import are_ends
from tests.support.regions import region_facts as regions

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.figures import Interval, Picture, PlottedResponse
    from symobs.formula.tree import Environment, Fact, Formula
    from symobs.proof.derivation import Derivation, Step
    from tests.support.algebra import Rows

LARGEST = 2**30
_ONE = Literal(Scalar.of(1))


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
    def of(cls, environment: Environment, seed: int) -> Self:
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
            return root_sum(q, function.power, self.scalar(function.argument))  # type: ignore[no-any-return]
        if function is not None:
            return applied(function.kind, self.scalar(function.argument))  # type: ignore[no-any-return]
        if name == PI:
            return NUMBER_PI
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
            return Fraction(rank_of(table))
        return {"det": determinant, "adj": adjugate}[function](table)

    def derivative(self, operand: Formula, name: str) -> Any:
        """Return the derivative of a value by a generator, or of a signal by the time."""
        now = self.number(name)
        parts = now.parts if isinstance(now, Series) else [now]
        value = self.at(name, Series.moving(parts[0], len(parts) + 1)).value(operand)
        if not isinstance(value, dict):
            return rate(value)
        slopes = {signal: rate(table) for signal, table in value.items()}
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

    def read(self, steps: Sequence[Step]) -> Iterator[tuple[str, Any]]:  # noqa: PLR0915 - one kind of step after another
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
                case Plot(NyquistPicture() | BodePicture() as response, subject):
                    assert isinstance(subject, Quotient)
                    yield "=", Fraction(len(list(self.untrue_frequencies(response))))
                case Plot(BranchPicture() as branches):
                    yield "=", Fraction(len(list(untrue_branches(branches))))
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
        if (value := self.polynomial_of(step.polynomial)) is not None and any(map(function_named, value.names)):
            yield from self.gains(value, step.parts)
            return
        signs = {name: self.signs.get(name, "real") for name in self.names_of(step.polynomial)}
        samples = list(regions.points(tuple(signs), signs, self.seed))

        def stable(point: Mapping[str, Fraction]) -> bool:
            return self.is_stable(step.polynomial, point)

        if step.parts:
            wrong = sum(stable(p) != any(regions.all_hold(part, p) for part in step.parts) for p in samples)
            yield "=", Fraction(wrong)
        yield "=", Fraction(sum(not regions.is_so(finding, stable, samples, step.names) for finding in step.findings))
        yield "words", (step.names, [repr(finding) for finding in step.findings])

    def untrue_frequencies(self, picture: NyquistPicture | BodePicture) -> Iterator[str]:
        """Yield where (χ_cl − χ_o)/χ_o, or q/χ_o e^{−sT}, found in floating point, is not what a picture has there."""
        moved, opened, delay = (self.scalar_of(Letter(name)) for name in ("q", "chi_o", "T_t"))
        if delay is None:
            moved = self.scalar_of(Letter("chi_cl"))
        assert moved is not None
        assert opened is not None
        lag = 0.0 if delay is None else float(delay.fraction())
        if float(picture.delay) != lag:
            yield "delay"
            return
        lists = [[float(c.fraction()) for c in p.coefficients(self.variable)] for p in (moved, opened)]
        (left, right), (bottom, top) = picture.window
        places = [complex(float(x), float(y)) for x, y in picture.contour]
        far = [abs(s) - 1 if self.is_discrete else s.real for s in places]
        turned = [cmath.phase(s) % (2 * cmath.pi) if self.is_discrete else s.imag for s in places]
        if picture.discrete != self.is_discrete or min(far) < -1e-9 or turned != sorted(turned):
            yield "contour"
            return
        near = float(min(right - left, top - bottom)) / 200
        for k, s in enumerate(places):
            value = (
                reduce(lambda sum_, c: sum_ * s + c, lists[0], 0j) / reduce(lambda sum_, c: sum_ * s + c, lists[1], 0j)
                - (1 if delay is None else 0)
            ) * cmath.exp(-s * lag)
            if isinstance(picture, NyquistPicture):
                u, v = picture.values[k]
                missed = abs(value - complex(float(u), float(v)))
                if missed > max(near, abs(value) * 1e-6) or (far[k] > 1e-9 and abs(value) < 1):
                    yield f"values[{k}]"
                continue
            omega = turned[k]
            off = abs(float(picture.phases[k]) - math.degrees(cmath.phase(value))) % 360
            told = (
                abs(math.log10(omega) - float(picture.across[k])),
                abs(20 * math.log10(abs(value)) - float(picture.levels[k])),
            )
            if max(*told, min(off, 360 - off) / 10) > near or far[k] > 1e-9:
                yield f"levels[{k}]"
        if isinstance(picture, BodePicture):
            jumps = [abs(b - a) for a, b in itertools.pairwise(picture.phases)]
            if list(picture.across) != sorted(picture.across) or max(jumps) > 200:
                yield "jumps"
        elif not (left <= -1 <= right and bottom <= 0 <= top):
            yield "window"

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
        return is_stable(coefficients, discrete=self.is_discrete)

    def region(self, fact: HoldsExactlyWhere) -> Iterator[tuple[str, Any]]:
        """Yield whether some inequalities hold exactly where a polynomial is stable, at points."""
        about = fact.property.subject
        if (value := self.polynomial_of(about)) is not None and any(map(function_named, value.names)):
            yield from self.gains(value, [fact.where])
            return
        wrong = 0
        said = {name for relation in fact.where for member in relation.members for name in _symbols(member)}
        names = {*said, *self.names_of(about)}
        for point in regions.points(tuple(names), self.signs, self.seed):
            try:
                wrong += self.is_stable(about, point) != regions.all_hold(fact.where, point)
            except ZeroDivisionError:  # there is no such function there
                continue
        yield "=", Fraction(wrong)

    def gains(self, value: Scalar, parts: Sequence[Sequence[Relation]]) -> Iterator[tuple[str, Any]]:
        """Yield whether P + k N e^{−sT} is stable in the open intervals of k that are told, and not just outside."""
        (name,) = (name for name in value.names if function_named(name))
        (lag,), (moved, opened) = [f for f in (function_named(name),) if f], value.coefficients(name)
        (k,) = moved.names - {self.variable}
        N, P = (coefficients_at(each, self.variable, {k: Fraction(1)}) for each in (moved, opened))
        delay = -coefficients_at(lag.argument, self.variable, {})[0]
        ends = [[float(self.value(relation.members[place])) for place in (0, 2)] for (relation,) in parts]
        yield "=", Fraction(sum(not are_ends(P, N, float(delay), low, high) for low, high in ends))

    def move_to(self, equations: Sequence[Scalar]) -> None:
        """Let λ, or a parameter, be a root of the one equation that holds: a rational one, or one of 60 digits."""
        if len(equations) != 1 or not equations[0].names:
            return
        (equation,) = equations
        name = EIGENVALUE if EIGENVALUE in equation.names else min(equation.names)
        moved = equation.substitute({other: Scalar.of(self.number(other)) for other in equation.names - {name}})
        factors = [factor for factor, _ in moved.numerator.factors()[1] if name in factor.names]
        lead, *rest = min(factors, key=lambda factor: factor.degree(name)).coefficients(name)
        if len(rest) == 1:
            self.meanings[name] = -rest[0].fraction() / lead.fraction()
            return
        roots = CONTEXT.polyroots([digits(c.fraction()) for c in (lead, *rest)], maxsteps=500, extraprec=400)
        self.meanings[name] = Series.make([min(roots, key=lambda root: (abs(CONTEXT.im(root)), CONTEXT.re(root)))])

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
    return len({rank_of(table) for table in (left, right, [*left, *right])}) == 1


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


# -- true or a lie --------------------------------------------------------------------------------------------------------

POINTS = 3
#: Enough values of the variable to tell a polynomial of degree up to 9 from any other rational function.
_FITTED, _TESTED = 10, 4

Readings: TypeAlias = "list[list[tuple[str, Any]]]"


def readings(derivation: Derivation, points: Sequence[Any] = range(POINTS), scale: Fraction | None = None) -> Readings:
    """Return what a derivation says at random points; `scale` puts that multiple of the variable in its place."""
    found = []
    for seed in points:
        world = World.of(derivation.start, seed)
        if scale is not None:
            world.meanings[world.variable] = Scalar.of(scale * world.number(world.variable))
        found.append(list(world.read(derivation.steps)))
    return found


def is_true(derivation: Derivation) -> bool:
    """Tell whether every equation of a derivation holds at random points."""
    return all(content == 0 for reading in readings(derivation) for kind, content in reading if kind in {"=", "zero"})


def untrue_branches(picture: BranchPicture) -> Iterator[str]:
    """Yield the points of branches that do not lie, by SymPy's numbers, where their branch has them, or not in order."""
    parameter, drawn = picture.axes
    bottom, top = picture.window[1]
    for branch in picture.branches:
        (height,) = to_sympy([dict(branch.at)[drawn]], {})
        places = [(sympy.Rational(x), sympy.Rational(y)) for x, y in branch.points]
        if [x for x, _ in places] != sorted(x for x, _ in places):
            yield "the order of points"
        for x, y in places:
            if abs(height.subs(sympy.Symbol(parameter), x).evalf(20) - y) > (top - bottom) / 200:
                yield f"{x}"
    for (x, _), exact in picture.marks:
        if abs(to_sympy(exact, {}).evalf(20) - sympy.Rational(x)) > (picture.window[0][1] - picture.window[0][0]) / 200:
            yield f"the mark at {x}"


def still_true(changed: Derivation, original: Derivation) -> bool:
    """Tell whether a changed derivation says other things that are true as well.

    What it introduces means the same.  Equations hold.  Inequalities are proved by SymPy from the declared signs, or are the
    same up to a factor.  Conditions are the same up to a factor.  Properties are of the same function up to a factor of
    value or variable, or are decided anew.  Roots, regions, labels, words are the same.
    """
    try:
        told = readings(changed)
    except (ArithmeticError, ValueError, TypeError, LookupError, AssertionError):
        return False
    meant = _meant(original)
    if [_family(kind) for kind, _ in told[0]] != [_family(kind) for kind, _ in meant[0]]:
        return False
    for place, kind in enumerate(kind for kind, _ in told[0]):
        new, old = ([reading[place][1] for reading in side] for side in (told, meant))
        if not (_agrees(kind, new, old, original.start.signs) or _has_property(kind, place, changed, original, new)):
            return False
    return True


def _meant(original: Derivation) -> Readings:
    """Return what an original says: it is asked for again by each of its changes."""
    for known, found in _READ:
        if known is original:
            return found
    _READ.append((original, readings(original)))
    return _READ[-1][1]


_READ: deque[tuple[Derivation, Readings]] = deque(maxlen=2)


def _family(kind: str) -> str:
    return "comparison" if kind in _HOLDS else kind


def _agrees(kind: str, new: list[Any], old: list[Any], signs: Mapping[str, str]) -> bool:
    if kind in {"=", "zero"}:
        return all(content == 0 for content in new)
    if kind == "basis":
        return True
    if kind == "!==":
        return any(content != 0 for content in new)
    if new == old:
        return True
    if kind in _HOLDS:
        return _compares(kind, new, signs)
    if kind == "region":
        return _same_bounds(new, old)
    if kind.startswith(("condition", "property")):
        ratio = _ratio(new, old)
        return ratio is not None and (kind not in {"condition <", "condition >"} or ratio > 0)
    return False


def _ratio(new: list[Any], old: list[Any]) -> Any:
    """Return by what the first are multiples of the second, the same at all points; None where they are not.

    The entries of a table may be multiples by different numbers, and the first of them is returned.
    """
    if is_matrix(new[0]) or is_matrix(old[0]):
        return _ratio_of_tables(new, old)
    values = [(single(a), single(b)) for a, b in zip(new, old, strict=True)]
    if any(a == 0 or b == 0 for a, b in values):
        return None
    ratios = [a / b for a, b in values]
    return None if any(ratio != ratios[0] for ratio in ratios) else ratios[0]


def _same_bounds(new: list[Any], old: list[Any]) -> bool:
    """Tell whether inequalities are the same in turn, each up to a positive factor."""
    for bounds, others in zip(zip(*new, strict=True), zip(*old, strict=True), strict=True):
        if {operators for operators, _ in bounds} != {operators for operators, _ in others}:
            return False
        ratio = _ratio([value for _, value in bounds], [value for _, value in others])
        if ratio is None or ratio < 0:
            return False
    return True


def _ratio_of_tables(new: list[Any], old: list[Any]) -> Any:
    left, right = ([_entries(table) for table in side] for side in (new, old))
    if any(len(a) != len(b) for a, b in zip(left, right, strict=True)):
        return None
    found = []
    for above, below in zip(zip(*left, strict=True), zip(*right, strict=True), strict=True):
        if any(above) or any(below):
            found.append(_ratio(list(above), list(below)))
    return None if not found or None in found else found[0]


def _entries(value: Any) -> list[Any]:
    return [entry for row in value for entry in row] if is_matrix(value) else [single(value)]


def _compares(operator: str, compared: list[Compared], signs: Mapping[str, str]) -> bool:
    """Prove an inequality: between constants, or from declared signs where no letter stands in it."""
    difference, *others = (single(content.difference) for content in compared)
    if all(other == difference for other in others):
        parts = getattr(difference, "parts", None)
        exact = sympy.Rational(*difference.as_integer_ratio()) if parts is None else sympy.Float(str(parts[0]), 50)
        return bool(_HOLDS[operator](exact))
    try:
        left, right = (_symbolic(member, signs) for member in compared[0].members)
    except KeyError:
        return False
    return bool(_HOLDS[operator](sympy.factor(left - right)))


_HOLDS = {
    "!=": lambda difference: difference.is_nonzero,
    ">": lambda difference: difference.is_positive,
    ">=": lambda difference: difference.is_nonnegative,
    "<": lambda difference: difference.is_negative,
    "<=": lambda difference: difference.is_nonpositive,
}


def _symbolic(formula: Any, signs: Mapping[str, str]) -> Any:
    """Return a scalar formula without letters as a SymPy expression in symbols with the declared signs."""
    match formula:
        case Literal(Scalar() as value):
            return _terms(value.numerator, signs) / _terms(value.denominator, signs)
        case Negative(operand):
            return -_symbolic(operand, signs)
        case Product(factors):
            return sympy.Mul(*(_symbolic(factor, signs) for factor in factors))
        case Quotient(above, below):
            return _symbolic(above, signs) / _symbolic(below, signs)
        case Power(base, exponent):
            return _symbolic(base, signs) ** exponent
    raise KeyError(formula)


def _terms(polynomial: Scalar, signs: Mapping[str, str]) -> Any:
    total = sympy.Integer(0)
    for coefficient, powers in polynomial.terms():
        symbols = (sympy.Symbol(name, **{signs.get(name, "real"): True}) ** power for name, power in powers)
        total += coefficient * sympy.Mul(*symbols)
    return total


def _has_property(kind: str, place: int, changed: Derivation, original: Derivation, new: list[Any]) -> bool:
    """Decide a property anew, of a polynomial that is told by interpolation.

    Strictly proper stays what is so when its variable is scaled, and in continuous time stable and unstable do too.
    """
    if kind == "property strictly_proper" or (kind in _OF_ROOTS and not original.discrete):
        for scale in (Fraction(2), Fraction(1, 2)):
            if _ratio(new, [reading[place][1] for reading in readings(original, scale=scale)]) is not None:
                return True
    if kind in _OF_ROOTS:
        found = [_polynomial(changed, place, seed) for seed in range(POINTS)]
        if found[0] is None or any(polynomial != found[0] for polynomial in found):
            return False
        return is_stable(found[0], discrete=changed.discrete) == _OF_ROOTS[kind]
    if kind not in {"property polynomial", "property not_polynomial"}:
        return False
    return (_polynomial(changed, place, 0) is not None) == (kind == "property polynomial")


_OF_ROOTS = {"property stable": True, "property unstable": False}


def _polynomial(derivation: Derivation, place: int, seed: int) -> list[Fraction] | None:
    """Return the coefficients of what is told at a place, highest power first; None where it is no polynomial."""
    at = World(seed, derivation.variable, {}).number(derivation.variable)
    values = [(k * at, readings(derivation, [seed], Fraction(k))[0][place][1]) for k in range(1, _FITTED + _TESTED + 1)]
    places, told = zip(*values[:_FITTED], strict=True)
    powers = [[point**k for k in reversed(range(_FITTED))] for point in places]
    found = [entry for (entry,) in multiply(inverse(powers), [[single(value)] for value in told])]
    while len(found) > 1 and not found[0]:
        del found[0]
    return found if all(at_number(found, point) == single(value) for point, value in values[_FITTED:]) else None


# -- courses over time, found by powers of the matrix exponential of mpmath -----------------------------------------------

Tables: TypeAlias = "tuple[tuple[Fraction, ...], ...]"
#: Digits that are kept while one instant after the other is found.
_DIGITS = 60


def untrue_responses(picture: TimeResponse, matrix: Sequence[Sequence[Fraction]]) -> tuple[str, ...]:
    """Return the points that lie a thousandth of the window or more from where they should."""
    return _all_untrue(picture, tuple(map(tuple, matrix)))


@lru_cache(maxsize=8)
def _all_untrue(picture: TimeResponse, matrix: Tables) -> tuple[str, ...]:
    """Return them, the same at every random point."""
    if picture.discrete:
        return tuple(_untrue_samples(picture, matrix))
    start = tuple(part for start in picture.starts for part in start)
    found = (_untrue(response, picture.window, picture.parts, start, matrix) for response in picture.responses)
    return tuple(text for texts in found for text in texts)


@lru_cache(maxsize=64)
def _untrue(
    response: PlottedResponse,
    window: tuple[Interval, Interval],
    parts: int,
    start: tuple[Fraction, ...],
    matrix: Tables,
) -> tuple[str, ...]:
    """Return the points of one response: pictures that differ in another response have the same."""
    (begin, end), (bottom, top) = window
    step = end / (len(response.heights) - 1)
    assert begin == 0
    assert step <= end / 100
    row, near = [float(part) for part in response.row], float(top - bottom) / 1000
    states = _states(matrix, start, step, len(response.heights))
    return tuple(
        f"{response.signal} at {k * step}"
        for k, (height, state) in enumerate(zip(response.heights, states, strict=True))
        if abs(sum(map(mul, row, state)) - height / parts) > near
    )


@lru_cache(maxsize=8)
def _states(matrix: Tables, start: tuple[Fraction, ...], step: Fraction, count: int) -> list[list[float]]:
    """Return the state at 0, h, 2 h, …: e^{Mh} times the one before."""
    with mpmath.workdps(_DIGITS):
        once = mpmath.expm(mpmath.matrix([[_real(entry * step) for entry in row] for row in matrix]))
        states = [mpmath.matrix([_real(part) for part in start])]
        for _ in range(count - 1):
            states.append(once * states[-1])
    return [[float(part) for part in state] for state in states]


def _untrue_samples(picture: TimeResponse, matrix: Tables) -> Iterator[str]:
    """Yield the values that are not row · Mᵏ · start, exactly."""
    start = sympy.Matrix([sympy.Rational(str(part)) for start in picture.starts for part in start])
    table = sympy.Matrix([[sympy.Rational(str(entry)) for entry in row] for row in matrix])
    for response in picture.responses:
        row = sympy.Matrix([[sympy.Rational(str(part)) for part in response.row]])
        for place, (instant, height) in enumerate(picture.points(response)):
            if instant != place or (row * table**place * start)[0] != sympy.Rational(str(height)):
                yield f"{response.signal} at {instant}"


def _real(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator
