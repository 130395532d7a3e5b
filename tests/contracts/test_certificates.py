"""What a certificate prints is what was checked: its text reads back as the relation, in every worked example."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Block,
    Identity,
    Integral,
    Letter,
    Literal,
    Product,
    Relation,
    Sum,
    children,
    with_children,
)
from symobs.formula.tree.term import factors_of, terms_of
from symobs.formula.tree.written import read_formula, read_relation
from symobs.proof.certificate import claims
from symobs.proof.certificate.claims import Claim, Statement
from tests.support.examples import NAMES, problem_of

if TYPE_CHECKING:
    from symobs.formula.tree import Formula

#: Claims that are no relation of formulas: what is shown is said in words.
IN_WORDS = {
    "stable exactly where",
    "stable nowhere",
    "the bounds over each interval",
    "the table is Routh's",
    "angle, distance and peak",
    "the ends of the gains around 1",
    "the slowest root",
    "the unstable poles",
    "the digits are those of the stabilising solution",
    "the factors are monic",
    "the loop is asymptotically stable",
    "the weight of the input is positive definite",
    "the weight of the state is positive semidefinite",
}


@pytest.mark.parametrize("name", NAMES)
def test_the_text_of_a_certificate_reads_back_as_what_was_checked(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    checked, check = list[Claim | Statement](), claims.check

    def noted(claim: Claim | Statement) -> claims.Certificate:
        checked.append(claim)
        return check(claim)

    monkeypatch.setattr(claims, "check", noted)
    results = problem_of.__wrapped__(
        name
    ).solve()  # those of other tests may have been asked for more of their certificates
    printed = {certificate.claim for result in results for certificate in result.all_certificates}
    for claim in checked:
        if isinstance(claim, Statement):
            assert any(claim.says.startswith(words) for words in IN_WORDS), claim.says
        else:
            assert read_relation(str(claim).rpartition(": ")[2]) == _as_read(claim), str(claim)
            assert not claim.environment.values.keys() & _parameters_in(claim.relation), str(claim)
    assert printed <= set(map(str, checked))


def test_few_claims_are_in_words() -> None:
    assert len(IN_WORDS) <= 20


def _as_read(claim: Claim) -> Relation:
    """Return the relation of a claim with the texts of its values in their places."""
    first, *others = claim.relation.members
    zero = Literal(Scalar.of(0))  # whatever its shape, behind the first member
    members = (first, *(zero if isinstance(m, Literal) and m.value == m.value * 0 else m for m in others))
    return Relation(tuple(_with_texts(m, claim.environment.variable) for m in members), claim.relation.operators)


def _with_texts(formula: Formula, variable: str) -> Formula:
    match formula:
        case Letter("s"):
            return Letter(variable)
        case Literal(Scalar() as value):
            return read_formula(str(value))
        case Literal(Matrix() as value):
            return Block(tuple(tuple(read_formula(str(entry)) for entry in row) for row in value.rows))
        case Identity():
            return Identity(0)
        case Integral(integrand, _, name, lower, upper):
            inner = _with_texts(integrand, variable)
            return Integral(inner, inner, name, lower, upper)
    parts = tuple(_with_texts(part, variable) for part in children(formula))
    match formula:
        case Sum():
            return Sum(tuple(term for part in parts for term in terms_of(part)))
        case Product():
            return Product(tuple(factor for part in parts for factor in factors_of(part)))
    return with_children(formula, parts)


def _parameters_in(part: Relation | Formula) -> set[str]:
    below = part.members if isinstance(part, Relation) else children(part)
    own = set(part.value.names) if isinstance(part, Literal) else set()
    return own.union(*map(_parameters_in, below))
