"""Evaluation of formulas in an environment, in any arithmetic.

One function, `evaluate`, walks the tree; an arithmetic supplies the operations.  `Exact` computes in the kernel,
`Modular` at a random point modulo a prime, and `certificate` adds one that only bounds degrees and heights.
A signal's value is its row of matrix coefficients over the free signals; d/dt follows the dynamics of the environment.
"""

from __future__ import annotations

from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.exact import EIGENVALUE, AlgebraicExtension, Ideal, Matrix, Scalar, rank
from symobs.exact.core.field import RATIONALS
from symobs.exact.core.generators import function_named
from symobs.exact.core.modular import block, scaled
from symobs.formula.tree import calculus
from symobs.formula.tree.arithmetic import Arithmetic, Signal, add, scalar, times
from symobs.formula.tree.nodes import (
    Apply,
    At,
    Block,
    Decimals,
    Derivative,
    Formula,
    Identity,
    Integral,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Sum,
    Transpose,
)
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import NotShown, WrongKind

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact.core.modular import Point


@dataclass
class Meanings:
    """The meaning of the letters: values, dynamics, and relations.

    values      letter → exact scalar or matrix
    signals     signal → its formula in other signals, or None for a free one
    sizes       free signal → number of components
    dynamics    free signal → the formula of its derivative (or shift)
    coefficients   a generator that stands for a longer scalar → that scalar, in generators introduced before it
    signs       parameter → declared sign
    nonzero     polynomials in the parameters that a stated condition keeps from 0
    domain      factors of the denominators of the data, which vanish nowhere in the domain
    relations   polynomials that are 0 here: the equations of a stratum, the minimal polynomial of an eigenvalue
    positive    polynomials in the parameters that a stated inequality keeps above 0
    shown       what a page displayed, or spoke of, last: what "it" and "the polynomial" in the next sentence mean
    age         how often it was extended: of two environments of a page the older one knows what both know
    """

    variable: str = "s"
    values: Mapping[str, Scalar | Matrix] = field(default_factory=dict)
    signals: Mapping[str, Formula | None] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    dynamics: Mapping[str, Formula] = field(default_factory=dict)
    coefficients: Mapping[str, Scalar] = field(default_factory=dict)
    signs: Mapping[str, str] = field(default_factory=dict)
    nonzero: tuple[Scalar, ...] = ()
    domain: tuple[Scalar, ...] = ()
    relations: tuple[Scalar, ...] = ()
    positive: tuple[Scalar, ...] = ()
    shown: tuple[Any, ...] = field(default=(), compare=False)
    age: int = field(default=0, compare=False)

    def defines(self, name: str) -> bool:
        """Return whether a letter is defined."""
        return name in self.values or name in self.signals or name == "s"

    def value(self, name: str) -> Scalar | Matrix:
        """Return the value of a letter."""
        return Scalar.symbol(self.variable) if name == "s" else self.values[name]

    def extended_by(self, **updates: Mapping[str, Any]) -> Self:
        """Return an environment with entries added to the named mappings."""
        changed: dict[str, Any] = {key: {**getattr(self, key), **new} for key, new in updates.items()}
        return replace(self, age=self.age + 1, **changed)

    def with_relations(self, relations: tuple[Scalar, ...]) -> Self:
        """Return an environment in which further polynomials are 0."""
        return replace(self, relations=(*self.relations, *relations)) if relations else self


class Exact:
    """The exact kernel."""

    def __init__(self, environment: Meanings) -> None:
        """Substitute the values of named coefficients in every value.

        With roots of numbers all are put in at once: what is still a name would grow in a denominator without roots.
        """
        self.coefficients = dict(environment.coefficients)
        self.at_once = any(meaning.field.roots for meaning in self.coefficients.values())
        if self.at_once:
            for name, meaning in self.coefficients.items():
                self.coefficients[name] = meaning.substitute(self.coefficients)

    def leaf(self, value: Scalar | Matrix) -> Scalar | Matrix:
        if self.at_once:
            return value.substitute(self.coefficients)
        for name in reversed(self.coefficients):
            if name in value.field.position:
                value = value.substitute({name: self.coefficients[name]})
        is_of_numbers = isinstance(value, Matrix) and value.field.names and not value.names
        return value.within(RATIONALS) if is_of_numbers else value  # where products take much less time

    def shape(self, value: Scalar | Matrix) -> tuple[int, int] | None:
        return value.shape if isinstance(value, Matrix) else None

    def entry(self, value: Matrix) -> Scalar:
        return value[0, 0]

    def add(self, left: Any, right: Any) -> Any:
        return left + right

    def scale(self, value: Any, factor: Scalar) -> Any:
        return value * factor

    def matmul(self, left: Matrix, right: Matrix) -> Matrix:
        return left @ right

    def invert(self, value: Any) -> Any:
        return value.inverse() if isinstance(value, Matrix) else 1 / value

    def transpose(self, value: Scalar | Matrix) -> Scalar | Matrix:
        return value.T if isinstance(value, Matrix) else value

    def apply(self, function: str, value: Matrix) -> Any:
        if function == "det":
            return value.determinant()
        if function == "adj":
            return value.adjugate()
        return Scalar.of(rank(value))

    def block(self, rows: list[list[Any]]) -> Matrix:
        return Matrix.block([[e if isinstance(e, Matrix) else Matrix.of([[e]]) for e in row] for row in rows])

    def equal(self, left: Any, right: Any) -> bool:
        return bool(left == right)


class Modular:
    """Residues at a random point modulo a prime: integers for scalars, FLINT's `nmod_mat` for matrices."""

    def __init__(self, environment: Meanings, point: Point) -> None:
        """Give each named coefficient the residue of its value."""
        self.point = point
        self.prime = point.prime
        self.known: dict[int, tuple[object, Any]] = {}
        for name, meaning in environment.coefficients.items():
            point.values[name] = point.scalar(meaning)

    def leaf(self, value: Scalar | Matrix) -> Any:
        found = self.known.get(id(value))
        if found is None:
            residue = self.point.matrix(value) if isinstance(value, Matrix) else self.point.scalar(value)
            self.known[id(value)] = found = (value, residue)
        return found[1]

    def shape(self, value: Any) -> tuple[int, int] | None:
        return None if isinstance(value, int) else (value.nrows(), value.ncols())

    def entry(self, value: Any) -> int:
        return int(value[0, 0])

    def add(self, left: Any, right: Any) -> Any:
        return (left + right) % self.prime if isinstance(left, int) else left + right

    def scale(self, value: Any, factor: int) -> Any:
        return value * factor % self.prime if isinstance(value, int) else scaled(value, factor, self.prime)

    def matmul(self, left: Any, right: Any) -> Any:
        return left * right

    def invert(self, value: Any) -> Any:
        if value == 0 and isinstance(value, int):
            raise ZeroDivisionError
        return pow(value, -1, self.prime) if isinstance(value, int) else value.inv()

    def transpose(self, value: Any) -> Any:
        return value.transpose()

    def apply(self, function: str, value: Any) -> Any:
        if function == "det":
            return int(value.det())
        if function == "adj":
            return self.scale(value.inv(), int(value.det()))
        return value.rank()

    def block(self, rows: list[list[Any]]) -> Any:
        return block(rows, self.prime)

    def equal(self, left: Any, right: Any) -> bool:
        return bool(left == right)


_MINUS_ONE = Scalar.of(-1)
_OF_MATRICES = {"det", "adj", "rank"}


def evaluate(formula: Formula, environment: Meanings, arithmetic: Arithmetic) -> Any:
    """Return the value of a formula: a scalar, a matrix or a `Signal` of the arithmetic."""
    match formula:
        case Letter(name):
            if name in environment.signals:
                return _signal(name, environment, arithmetic)
            return arithmetic.leaf(environment.value(name))
        case Literal(value) | Decimals(value):
            return arithmetic.leaf(value)
        case Identity(order):
            return arithmetic.leaf(Matrix.identity(order))
        case Sum(terms):
            total = evaluate(terms[0], environment, arithmetic)
            for term in terms[1:]:
                total = add(total, evaluate(term, environment, arithmetic), arithmetic)
            return total
        case Negative(operand):
            return times(arithmetic.leaf(_MINUS_ONE), evaluate(operand, environment, arithmetic), arithmetic)
        case Product(factors):
            value = evaluate(factors[-1], environment, arithmetic)
            for factor in reversed(factors[:-1]):
                value = times(evaluate(factor, environment, arithmetic), value, arithmetic)
            return value
        case Quotient(positive, below):
            divisor = scalar(evaluate(below, environment, arithmetic), arithmetic)
            return times(arithmetic.invert(divisor), evaluate(positive, environment, arithmetic), arithmetic)
        case Power(base, exponent):
            return _power(evaluate(base, environment, arithmetic), exponent, arithmetic)
        case Transpose(operand):
            return arithmetic.transpose(evaluate(operand, environment, arithmetic))
        case Apply(function, argument):
            value = evaluate(argument, environment, arithmetic)
            if function.endswith("_at"):
                return _polynomial_at(environment.values[function.removesuffix("_at")], value, environment, arithmetic)
            if function not in _OF_MATRICES:
                raise ValueError(f"{function} is no function of a matrix")
            return arithmetic.apply(function, value)
        case Block(rows):
            return _block([[evaluate(entry, environment, arithmetic) for entry in row] for row in rows], arithmetic)
        case Derivative(operand, name):
            value = evaluate(operand, environment, arithmetic)
            if isinstance(value, Signal):
                return _derivative(value, environment, arithmetic)
            return arithmetic.leaf(calculus.rate(value, name, constant=environment.variable == calculus.TIME))
        case At(operand, name, instant):
            return arithmetic.leaf(
                calculus.at(evaluate(operand, environment, _without_base(environment)), name, instant)
            )
        case Integral(integrand, primitive, name, lower, upper):
            slope, whole = evaluate(integrand, environment, arithmetic), evaluate(primitive, environment, arithmetic)
            calculus.check_primitive(slope, whole, name, arithmetic)
            whole = evaluate(primitive, environment, _without_base(environment))
            return arithmetic.leaf(calculus.at(whole, name, upper) - calculus.at(whole, name, lower))


def _without_base(environment: Meanings) -> Exact:
    """Return the kernel with named coefficients, but no common base of functions, which is another one at an instant."""
    named = {name: value for name, value in environment.coefficients.items() if function_named(name) is None}
    return Exact(replace(environment, coefficients=named))


def _signal(name: str, environment: Meanings, arithmetic: Arithmetic) -> Signal:
    formula = environment.signals[name]
    if formula is None:
        size = environment.sizes[name]
        return Signal(size, {name: arithmetic.leaf(Matrix.identity(size))})
    value = evaluate(formula, environment, arithmetic)
    if not isinstance(value, Signal):
        raise WrongKind(f"{name} is defined as {type(value).__name__}, not as a signal")
    return value


def _power(base: Any, exponent: int, arithmetic: Arithmetic) -> Any:
    if exponent < 0:
        base, exponent = arithmetic.invert(base), -exponent
    shape = arithmetic.shape(base)
    power = arithmetic.leaf(Scalar.of(1) if shape is None else Matrix.identity(shape[0]))
    for _ in range(exponent):
        power = times(power, base, arithmetic)
    return power


def _polynomial_at(polynomial: object, value: Any, environment: Meanings, arithmetic: Arithmetic) -> Any:
    """Return the polynomial of the variable at a square matrix or a scalar, by Horner's rule."""
    polynomial = polynomial[0, 0] if isinstance(polynomial, Matrix) else polynomial
    if not isinstance(polynomial, Scalar):
        raise WrongKind(f"{type(polynomial).__name__} is not a polynomial")
    shape = arithmetic.shape(value)
    if shape is None:
        number = arithmetic.leaf(Scalar.of(0))
        for coefficient in polynomial.coefficients(environment.variable):
            number = arithmetic.add(arithmetic.scale(number, value), arithmetic.leaf(coefficient))
        return number
    identity = arithmetic.leaf(Matrix.identity(shape[0]))
    total = arithmetic.leaf(Matrix.zeros(*shape))
    for coefficient in polynomial.coefficients(environment.variable):
        total = arithmetic.add(
            arithmetic.matmul(total, value), arithmetic.scale(identity, arithmetic.leaf(coefficient))
        )
    return total


def _block(rows: list[list[Any]], arithmetic: Arithmetic) -> Any:
    """Return the block matrix of matrices, scalars or (in one column) signals."""
    if not isinstance(rows[0][0], Signal):
        return arithmetic.block(rows)
    parts = [row[0] for row in rows]
    names = dict.fromkeys(name for part in parts for name in part.coefficients)
    stacked = {}
    for name in names:
        width = next(arithmetic.shape(p.coefficients[name])[1] for p in parts if name in p.coefficients)  # type: ignore[index]
        stacked[name] = arithmetic.block(
            [[p.coefficients.get(name, arithmetic.leaf(Matrix.zeros(p.size, width)))] for p in parts]
        )
    return Signal(sum(part.size for part in parts), stacked)


def _derivative(signal: Signal, environment: Meanings, arithmetic: Arithmetic) -> Signal:
    total: Signal | None = None
    for name, coefficient in signal.coefficients.items():
        rate = evaluate(environment.dynamics[name], environment, arithmetic)
        image = times(coefficient, rate, arithmetic)
        if isinstance(arithmetic, Exact) and calculus.TIME in coefficient.names:
            slope = Signal(
                signal.size, {name: arithmetic.leaf(calculus.rate(coefficient, calculus.TIME, constant=True))}
            )
            image = add(image, slope, arithmetic)
        total = image if total is None else add(total, image, arithmetic)
    assert total is not None  # noqa: S101 - a signal has at least one coefficient
    return total


# Exact arithmetic modulo an ideal: on a stratum, at an eigenvalue, with c² + s² = 1.


class ModuloIdeal(Exact):
    """The exact arithmetic modulo the ideal of the relations.

    Nothing may be divided by what vanishes there: cancelling would hide it.  A rank has a meaning where one irreducible
    polynomial vanishes, which leaves a field; on other ideals minors and kernels say the same.
    """

    def __init__(self, environment: Meanings) -> None:
        """Keep the relations."""
        super().__init__(environment)
        self.relations = environment.relations

    @cached_property
    def ideal(self) -> Ideal:
        """The ideal of the relations; raises `TooLarge`."""
        return Ideal.where(self.relations)

    def leaf(self, value: Scalar | Matrix) -> Scalar | Matrix:
        """Raise ZeroDivisionError for a value whose denominator vanishes here."""
        found: Scalar | Matrix = super().leaf(value)
        self._meaningful(found)
        return found

    def invert(self, value: Any) -> Any:
        """Return the inverse; raises ZeroDivisionError for a value that vanishes here."""
        found = super().invert(value)
        self._meaningful(found)
        return found

    def apply(self, function: str, value: Matrix) -> Any:
        """Return det or adj of a matrix, and its rank in the field of one irreducible relation."""
        if function != "rank":
            return super().apply(function, value)
        generators = self.ideal.generators
        field = (
            self.ideal.field | value.field
        )  # what is irreducible over Q may not be so beside the roots of the values
        factors = generators[0].within(field).factors()[1] if len(generators) == 1 else ()
        if len(factors) != 1 or factors[0][1] != 1:
            raise NotShown("a rank on a stratum is shown by minors and kernels")
        roots = {field.names[index] for index, _ in field.roots}
        name = max(factors[0][0].names - roots, key=lambda name: (name == EIGENVALUE, name))
        return Scalar.of(len(AlgebraicExtension(generators[0], name).echelon(value)[0]))

    def equal(self, left: Any, right: Any) -> bool:
        """Return whether two values agree wherever the relations hold."""
        if isinstance(left, Matrix) != isinstance(right, Matrix):
            return False
        difference = left - right
        entries = difference.entries if isinstance(difference, Matrix) else (difference,)
        return all(entry in self.ideal for entry in entries)

    def _meaningful(self, value: Scalar | Matrix) -> None:
        below = value.common_denominator()
        if not below.is_constant and below in self.ideal:
            raise ZeroDivisionError(f"{below} vanishes here")
