"""Steps written by hand, and whether they are accepted: what the tests of derivations are written in."""

from __future__ import annotations

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    Environment,
    Fact,
    Formula,
    Identity,
    Letter,
    Literal,
    Negative,
    Product,
    Relation,
    Sum,
)
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Define, Derivation, Given, Sentence, Step

A, B, C, F, L, P, S = (Letter(name) for name in ("A", "B", "C", "F", "L", "P", "s"))
X, ESTIMATE, E, U, Y = (Letter(name) for name in ("x", "x_hat", "e", "u", "y"))
s, a, b, c = (Scalar.symbol(name) for name in "sabc")
START = Environment(
    signals={"x": None, "x_hat": None, "u": None},
    sizes={"x": 2, "x_hat": 2, "u": 1},
    signs={"a": "positive", "c": "real"},
)


#: The phrases that tests put in while they run.
OWN_PHRASES = {"test_plain": "And so on.", "test_slot": "This is {it}."}


def literal(item: Formula | Scalar | Matrix | int) -> Formula:
    if isinstance(item, int):
        return Literal(Scalar.of(item))
    return Literal(item) if isinstance(item, (Scalar, Matrix)) else item


def said(*items: Formula | Scalar | Matrix | int | str) -> Relation:
    members = tuple(literal(item) for item in items if not isinstance(item, str))
    operators = tuple(item for item in items if isinstance(item, str))
    return Relation(members, operators or ("=",) * (len(members) - 1))


def slot(it: Formula | Fact | str) -> Sentence:
    return Sentence("test_slot", (("it", it),))


def checked(*steps: Step, start: Environment = START, discrete: bool = False) -> Environment:
    return Derivation(steps, start, discrete=discrete).check()


def refused(*steps: Step, start: Environment = START, match: str | None = None, discrete: bool = False) -> None:
    with pytest.raises(DerivationRejected, match=match):
        checked(*steps, start=start, discrete=discrete)


COMPANION = Matrix.of([[0, 1], [-2, -3]])
A_IS = Given((said(A, COMPANION),), silent=True)
C_IS = Given((said(C, Matrix.of([[1, c]])),), silent=True)
CHI = Define(said(Letter("chi"), Apply("det", Sum((Product((S, Identity(2))), Negative(A)))), s**2 + 3 * s + 2))
