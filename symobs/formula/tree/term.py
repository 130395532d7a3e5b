"""Terms: a formula together with its exact value, with arithmetic by Python operators.

`A - L @ C` builds the formula A − LC and, when asked, evaluates it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

from symobs.exact import Matrix, Scalar
from symobs.formula.tree.evaluate import Exact, Meanings, evaluate
from symobs.formula.tree.nodes import (
    Apply,
    At,
    Block,
    Derivative,
    Formula,
    Identity,
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


@dataclass
class Term:
    """A formula in an environment."""

    formula: Formula
    environment: Environment

    @cached_property
    def value(self) -> Any:
        """The exact value: a `Scalar`, a `Matrix` or a `Signal`."""
        environment = self.environment
        if environment.coefficients:
            environment = replace(environment, coefficients={})
        return evaluate(self.formula, environment, Exact(environment))

    @property
    def scalar(self) -> Scalar:
        """The value of a scalar or of a 1×1 matrix."""
        value = self.value
        return value[0, 0] if isinstance(value, Matrix) else value

    def _with(self, formula: Formula, other: object = None) -> Term:
        """Return a term of this one, or of two."""
        return Term(formula, _environment_of(self, other) if isinstance(other, Term) else self.environment)

    def _read(self, other: Term | Scalar | Matrix | int) -> Formula:
        if isinstance(other, Term):
            return other.formula
        return Literal(Scalar.of(other) if isinstance(other, int) else other)

    def __add__(self, other: Term | Scalar | Matrix | int) -> Term:
        return self._with(Sum((*terms_of(self.formula), *terms_of(self._read(other)))), other)

    def __sub__(self, other: Term | Scalar | Matrix | int) -> Term:
        return self._with(Sum((*terms_of(self.formula), Negative(self._read(other)))), other)

    def __neg__(self) -> Term:
        return self._with(Negative(self.formula))

    def __matmul__(self, other: Term) -> Term:
        return self._with(Product((*factors_of(self.formula), *factors_of(other.formula))), other)

    def __mul__(self, other: Term | Scalar | int) -> Term:
        return self._with(Product((*factors_of(self.formula), *factors_of(self._read(other)))), other)

    def __truediv__(self, other: Term | Scalar | int) -> Term:
        return self._with(Quotient(self.formula, self._read(other)), other)

    def __pow__(self, exponent: int) -> Term:
        return self._with(self.formula if exponent == 1 else Power(self.formula, exponent))

    @property
    def inverse(self) -> Term:
        """The inverse."""
        return self._with(Power(self.formula, -1))

    @property
    def T(self) -> Term:
        """The transpose; of a transpose the matrix itself."""
        return self._with(self.formula.operand if isinstance(self.formula, Transpose) else Transpose(self.formula))

    @property
    def pencil(self) -> Term:
        """The matrix pencil sI − M."""
        order = self.value.shape[0]
        return self._with(Product((Letter("s"), Identity(order)))) - self

    @property
    def derivative(self) -> Term:
        """d/dt, or the shift."""
        return self._with(Derivative(self.formula))

    def derivative_by(self, name: str) -> Term:
        """Return d/d(name)."""
        return self._with(Derivative(self.formula, name))

    def at(self, name: str, instant: Scalar | int) -> Term:
        """Return the term at an instant, unchanged if it does not depend on the generator."""
        where = Scalar.of(instant) if isinstance(instant, int) else instant
        return self if Scalar.symbol(name) == where else self._with(At(self.formula, name, where))

    def apply(self, function: str) -> Term:
        """Return function(self): det, adj, rank, or a polynomial's letter with `_at`."""
        return self._with(Apply(function, self.formula))

    @property
    def as_value(self) -> Term:
        """The value written out."""
        return self._with(Literal(self.value))


@dataclass
class Environment(Meanings):
    """The meanings of letters, with the term of each: `e["A"] - e["L"] @ e["C"]`."""

    def __getitem__(self, name: str) -> Term:
        """Return the term of an established letter."""
        return Term(Letter(name), self)


def _environment_of(*terms: Term) -> Environment:
    """Return the environment that knows what all terms know: that of a page grows."""
    return max((term.environment for term in terms), key=lambda environment: environment.age)


def terms_of(formula: Formula) -> tuple[Formula, ...]:
    """Return the terms of a sum, or what is none alone."""
    return formula.terms if isinstance(formula, Sum) else (formula,)


def factors_of(formula: Formula) -> tuple[Formula, ...]:
    """Return the factors of a product, or what is none alone."""
    return formula.factors if isinstance(formula, Product) else (formula,)


def product(terms: list[Term]) -> Term:
    """Return the product of at least one term."""
    if len(terms) == 1:
        return terms[0]
    return Term(Product(tuple(term.formula for term in terms)), _environment_of(*terms))


def block(rows: list[list[Term]]) -> Term:
    """Return the matrix or stacked signal of blocks."""
    formula = Block(tuple(tuple(term.formula for term in row) for row in rows))
    return Term(formula, _environment_of(*(term for row in rows for term in row)))


def identity(order: int, environment: Environment) -> Term:
    """Return I."""
    return Term(Identity(order), environment)


def letter(name: str, environment: Environment) -> Term:
    """Return the term of an established letter."""
    return environment[name]
