"""Claims are checked exactly or at random points; both tell true from false, and the stated bounds are bounds."""

from __future__ import annotations

from typing import Any

import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Environment,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
)
from symobs.ground.errors import CertificateRejected
from symobs.proof.certificate import claims
from symobs.proof.certificate.claims import ERROR_GOAL, Claim, check, check_all, verify
from tests.kit import member, scalar, scalars, tabled
from tests.support.problems.steps import literal, said

A, L, C, S = Letter("A"), Letter("L"), Letter("C"), Letter("s")
s, a, b, c = (Scalar.symbol(name) for name in "sabc")


@pytest.fixture(params=["exactly", "at points"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Check small claims in the way large ones are checked too."""
    if request.param == "at points":
        monkeypatch.setattr(claims, "EXACT_UP_TO", -1)
    return str(request.param)


# -- true and false -----------------------------------------------------------------------------------------------------

SERVO: dict[str, Scalar | Matrix] = {
    "A": Matrix.of([[0, 1], [0, -1]]),
    "C": Matrix.of([[1, 0]]),
    "L": Matrix.of([[19], [81]]),
    "phi": (s + 10) ** 2,
    "M": Matrix.of([[a, 1], [b / c, 2]]),
    "F": (319 * s + 400) / (s**2 + 23 * s + 161),
}
PENCIL = Sum((Product((S, Identity(2))), Negative(A), Product((L, C))))
M, DEPENDENT = Letter("M"), Literal(Matrix.of([[a, b], [2 * a, 2 * b]]))

TRUE = [
    said(Apply("det", PENCIL), Letter("phi"), (s + 10) * (s + 10)),
    said(Apply("phi_at", Sum((A, Negative(Product((L, C)))))), Matrix.zeros(2, 2)),
    said(Product((M, Power(M, -1))), Identity(2)),
    said(Product((M, Apply("adj", M))), Product((Apply("det", M), Identity(2)))),
    said(Apply("det", Power(M, 2)), Power(Apply("det", M), 2)),
    said(Apply("rank", DEPENDENT), 1),
    said(Transpose(Transpose(M)), M),
    said(Block(((M, Identity(2)),)), Block(((M, Literal(Matrix.identity(2))),))),
    said(Quotient(literal(a), literal(b)), a / b),
    said(Block(((literal(a),),)), a),
    said(Power(Letter("F"), -1), (s**2 + 23 * s + 161) / (319 * s + 400)),
    said(Sum((literal(a), Block(((literal(1),),)))), a + 1),
    said(a, "!==", b),
    said(M, "!==", Transpose(M)),
]
FALSE = [
    said(Apply("det", PENCIL), Letter("phi"), (s + 10) * (s + 11)),
    said(Apply("det", PENCIL), Power(literal(s + 10), 3)),
    said(Apply("phi_at", A), Matrix.zeros(2, 2)),
    said(Product((M, M)), Identity(2)),
    said(Apply("rank", DEPENDENT), 2),
    said(Transpose(M), M),
    said(M, Matrix.of([[a, 1]])),
    said(M, a),
    said(a, "!==", a),
    said(M, "!==", Matrix.identity(3)),
    said(Sum((M, Identity(3))), M),
    said(Power(Literal(Matrix.of([[a, b], [a, b]])), -1), M),
    said(Letter("absent"), a),
    said(Quotient(literal(1), literal(0)), 1),
]


@pytest.mark.parametrize("relation", TRUE)
def test_a_true_claim_has_a_certificate(relation: Relation, way: str) -> None:
    found = check(Claim(relation, Environment(values=SERVO)))
    assert found.how == "exact" if way == "exactly" else "random point" in found.how
    assert found.bound == "0" if way == "exactly" else 0 < float(found.bound) < ERROR_GOAL
    assert check(Claim(relation, Environment(values=dict(SERVO)))) == found, "a claim is checked the same way twice"


@pytest.mark.usefixtures("way")
@pytest.mark.parametrize("relation", FALSE)
def test_a_false_claim_has_none(relation: Relation) -> None:
    with pytest.raises(CertificateRejected, match="does not hold"):
        check_all([Claim(relation, Environment(values=SERVO))])


def test_a_claim_is_called_what_it_is_behind_what_it_says() -> None:
    relation = said(Apply("det", PENCIL), Letter("phi"))
    assert str(Claim(relation, Environment(variable="z"))) == "det(z*I - A + L*C) = phi(z)"
    assert str(Claim(relation, Environment(), "as asked")) == "as asked: det(s*I - A + L*C) = phi(s)"


# -- signals ------------------------------------------------------------------------------------------------------------

X, ESTIMATE, E, Y = (Letter(name) for name in ("x", "x_hat", "e", "y"))
LOOP = Environment(
    values={**SERVO, "D": Matrix.of([[2]])},
    signals={"x": None, "x_hat": None, "u": None, "y": Product((C, X)), "e": Sum((X, Negative(ESTIMATE)))},
    sizes={"x": 2, "x_hat": 2, "u": 1},
    dynamics={
        "x": Sum((Product((A, X)), Product((Literal(Matrix.of([[0], [1]])), Letter("u"))))),
        "x_hat": Sum(
            (
                Product((A, ESTIMATE)),
                Product((Literal(Matrix.of([[0], [1]])), Letter("u"))),
                Product((L, Sum((Y, Negative(Product((C, ESTIMATE))))))),
            )
        ),
    },
)
CLOSED = Sum((A, Negative(Product((L, C)))))


@pytest.mark.usefixtures("way")
def test_signals_agree_in_every_free_signal() -> None:
    assert verify(said(Derivative(E), Product((CLOSED, E))), LOOP)[0]
    assert verify(said(Block(((Y,), (E,))), Block(((Product((C, X)),), (E,)))), LOOP)[0]
    for other in (Product((A, E)), Product((CLOSED, X)), CLOSED, Product((literal(2), CLOSED, E)), Y):
        assert not verify(said(Derivative(E), other), LOOP)[0]
    assert not verify(said(CLOSED, E), LOOP)[0]
    assert not verify(said(E, "!==", X), LOOP)[0], "signals are compared by equations only"


# -- where conditions and relations hold ------------------------------------------------------------------------------


def part(given: Any) -> Any:
    """Read a member of a relation, a matrix as its rows, or the rank of one."""
    if isinstance(given, dict):
        return Apply("rank", Literal(member(given["rank"])))
    return given if str(given) in {"~", "≈", "!=="} else member(given)


@pytest.mark.usefixtures("way")
@tabled
def test_a_relation_holds_or_not(relation: list[Any], known: dict[str, Any], *, holds: bool) -> None:
    """For named coefficients, rows that span, ranks, rounded decimals: in general, and where others vanish or do not."""
    read: dict[str, Any] = {
        name: tuple(scalars(known[name])) for name in known.keys() & {"relations", "nonzero", "domain", "positive"}
    }
    named = {name: scalar(value) for name, value in known.get("coefficients", {}).items()}
    environment = Environment(signs=known.get("signs", {}), coefficients=named, **read)
    assert bool(verify(said(*map(part, relation)), environment)[0]) is holds


# -- random points ------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("way")
def test_blocks_whose_sizes_do_not_match_are_no_matrix() -> None:
    P, Q, R = (Literal(Matrix.of([row])) for row in ([1, 2], [1, 2, 3], [7]))
    for blocks, claimed in (
        (((P,), (Q,), (R,)), [[1, 2], [1, 2], [3, 7]]),
        (((R, Literal(Matrix.of([[2], [3]]))),), [[7, 2]]),
    ):
        with pytest.raises(CertificateRejected):
            check(Claim(said(Block(blocks), Matrix.of(claimed)), Environment()))
