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
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import CaseStep, Define, Derivation, Equal, Given, Sentence, Step
from symobs.tasks.result import Document

A, B, C, F, L, P, S = (Letter(name) for name in ("A", "B", "C", "F", "L", "P", "s"))
X, ESTIMATE, E, U, Y = (Letter(name) for name in ("x", "x_hat", "e", "u", "y"))
s, a, b, c = (Scalar.symbol(name) for name in "sabc")
START = Environment(
    signals={"x": None, "x_hat": None, "u": None},
    sizes={"x": 2, "x_hat": 2, "u": 1},
    signs={"a": "positive", "c": "real"},
)


#: The phrases that tests put in while they run.
OWN_PHRASES = {"test_plain": "And so on.", "test_slot": "This is {it}.", "test_case": "the gain loses an entry, and"}


@dataclass
class HandWritten(Document):
    """A document whose derivations were written by hand instead of by results."""

    written: tuple[Derivation, ...] = ()

    @property
    def derivations(self) -> tuple[Derivation, ...]:
        return self.written


def document(*derivations: Derivation, title: str = "", source: str = "") -> HandWritten:
    return HandWritten(title, source, (), written=derivations)


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


def with_a_case() -> Derivation:
    """A plant with a parameter, and what is special where it takes one value."""
    case = CaseStep(
        said(b, 0), (("b", Scalar.of(0)),), (Equal((said(C, Matrix.of([[1, 0]])),)),), Sentence("test_case")
    )
    row = Matrix.of([[1, b]])
    return Derivation((Given((said(C, row),)), case), Environment(values={"C": row}))
