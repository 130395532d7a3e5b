"""What the trusted floors refuse, one check at a time: each of these tests fails where one check is left out or weaker."""

from __future__ import annotations

import random
from dataclasses import replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import EIGENVALUE, Matrix, Scalar
from symobs.exact.core.modular import Point
from symobs.formula.tree import (
    Apply,
    At,
    Derivative,
    Environment,
    Integral,
    Letter,
    Literal,
    Modular,
    Product,
    Relation,
    Sum,
)
from symobs.ground.errors import CertificateRejected
from symobs.proof.certificate import claims
from symobs.proof.certificate.claims import (
    EXACT_UP_TO,
    Certificate,
    Claim,
    Statement,
    check,
    check_all,
    verify,
)
from symobs.proof.certificate.pointwise import SizeBound
from tests.kit import member, tabled
from tests.support.problems.steps import A, X, a, b, c, literal, said

if TYPE_CHECKING:
    from symobs.formula.tree import Formula

FALSE = ("", 0.0)
EXACTLY = ("exact", 0.0)
t, s, d = (Scalar.symbol(name) for name in "tsd")


@pytest.fixture
def at_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """Check small claims in the way large ones are checked."""
    monkeypatch.setattr(claims, "EXACT_UP_TO", -1)


def is_at_points(relation: Relation, environment: Environment) -> bool:
    how, error = verify(relation, environment)
    return how.startswith("at 1 random point modulo") and 0 < error <= 2.0**-50


# -- certificates ------------------------------------------------------------------------------------------------------


def test_a_statement_holds_where_something_shows_it() -> None:
    shown, not_shown = Statement("it is so", lambda: "by hand"), Statement("it is so", lambda: "")
    assert check(shown) == Certificate("it is so", "by hand", "0")
    assert check_all([shown], (a,)) == (Certificate("it is so", "by hand", "0"),)
    with pytest.raises(CertificateRejected, match="the claim it is so does not hold") as caught:
        check(not_shown)
    assert caught.value.facts["claim"] == "it is so"
    with pytest.raises(CertificateRejected, match="the claim it is so"):
        check_all([shown, not_shown])


def test_claims_are_checked_where_relations_hold_and_keep_their_names() -> None:
    claim = Claim(said(a, b), Environment(), "a is b")
    with pytest.raises(CertificateRejected, match="the claim a is b: a = b does not hold"):
        check(claim)
    assert check_all([claim], (a - b,)) == (Certificate("a is b: a = b", "exact", "0"),)
    with pytest.raises(CertificateRejected, match="the claim a is b"):
        check_all([claim], (a - 2 * b,))


def test_the_error_of_what_is_checked_at_points_stays_below_its_bound() -> None:
    assert claims.ERROR_GOAL == 2.0**-50
    found = check(Claim(said((a + b + c) ** 12, Product((literal((a + b + c) ** 6),) * 2)), Environment()))
    assert found.how == "at 1 random point modulo 64-bit primes"
    assert 2.0**-64 < float(found.bound) < 2.0**-50


# -- exactly, or at points ---------------------------------------------------------------------------------------------


def test_what_is_small_is_checked_exactly(monkeypatch: pytest.MonkeyPatch) -> None:
    relation, names = said(a + b, Sum((literal(a), literal(b)))), Environment()
    assert verify(relation, names) == EXACTLY
    monkeypatch.setattr(claims, "EXACT_UP_TO", 7)
    assert verify(relation, names) == EXACTLY, "a + b, a and b have four terms, and three denominators"
    monkeypatch.setattr(claims, "EXACT_UP_TO", 6)
    assert is_at_points(relation, names)
    assert verify(said(a + b, b + a), names) == EXACTLY
    monkeypatch.setattr(claims, "EXACT_UP_TO", 5)
    assert is_at_points(said(a + b, b + a), names), "each is counted"


@pytest.mark.usefixtures("at_points")
def test_what_points_cannot_decide_is_decided_exactly() -> None:
    names = Environment(signs={"a": "positive", "b": "real"})
    assert verify(said(a, "!=", 0), names) == EXACTLY
    assert verify(said(b, "!=", 0), names) == FALSE, "different at a random point, and not at all"
    assert verify(said(a, "=", a, ">", 0), names) == EXACTLY
    assert verify(said(a, "=", a, ">", 1), names) == FALSE
    assert is_at_points(said(a, "=", a, "!==", b), names)
    assert is_at_points(said(a, "!==", b), names)
    assert verify(said(a, "=", b, "!==", 1), names) == FALSE
    assert verify(said(a, "=", a, "!==", a), names) == FALSE


@pytest.mark.usefixtures("at_points")
def test_what_varies_in_time_needs_values() -> None:
    square = Literal(t * t)
    assert verify(said(Derivative(square), 2 * t), Environment()) == EXACTLY
    assert verify(said(Derivative(square), t), Environment()) == FALSE
    assert verify(said(Derivative(Literal(a * a), "a"), 2 * a), Environment()) == EXACTLY
    assert verify(said(Derivative(Literal(a * a), "a"), a), Environment()) == FALSE
    assert verify(said(At(square, "t", Scalar.of(3)), 9), Environment()) == EXACTLY
    assert verify(said(At(square, "t", Scalar.of(3)), 3), Environment()) == FALSE
    integral = Integral(Literal(2 * t), square, "t", Scalar.of(0), a)
    assert verify(said(integral, a * a), Environment()) == EXACTLY
    assert verify(said(integral, a), Environment()) == FALSE
    named = Environment(coefficients={"d": t + 1})
    assert verify(said(Derivative(Literal(t * t)), d + t - 1), named) == EXACTLY
    assert verify(said(Derivative(Literal(d)), 1), named) != FALSE
    assert verify(said(Derivative(Literal(d)), 0), named) == FALSE


@pytest.mark.usefixtures("at_points")
def test_a_signal_in_time_needs_values_too() -> None:
    plant = {
        "signals": {"x": None, "y": Product((Letter("T"), X))},
        "sizes": {"x": 1},
        "dynamics": {"x": Product((A, X))},
    }
    rate = said(Derivative(Letter("y")), Product((Literal(t + 1), X)))
    varying = Environment(values={"A": Scalar.of(1), "T": t}, **plant)  # type: ignore[arg-type]
    assert verify(rate, varying) == EXACTLY, "(t x)' = x + t x"
    beta = Scalar.symbol("beta")  # a name with a t in it is not the time
    constant = Environment(values={"A": Scalar.of(1), "T": beta}, **plant)  # type: ignore[arg-type]
    assert is_at_points(said(Derivative(Letter("y")), Product((Literal(beta), X))), constant)
    assert verify(said(Derivative(Letter("y")), Product((Literal(beta + 1), X))), constant) == FALSE
    assert is_at_points(said(t, t), Environment()), "without a derivative the time is a name like others"


def test_what_is_found_false_exactly_is_not_asked_at_points(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claims, "_holds_at_points", lambda *_: ("at points", 2.0**-60))
    for environment in (Environment(), Environment(relations=(c,)), Environment(relations=(c,), coefficients={"d": a})):
        assert verify(said(a, b), environment) == FALSE
        assert verify(said(b, "!=", 0), environment) == FALSE
    assert verify(said(d, "!=", 0), Environment(coefficients={"d": a})) == FALSE


# -- comparisons -------------------------------------------------------------------------------------------------------


def test_a_chain_has_an_operator_for_every_link() -> None:
    for members, operators in (((a, a, b), ("=",)), ((a, a), ("=", "=")), ((a, a), ())):
        relation = Relation(tuple(map(Literal, members)), operators)
        assert verify(relation, Environment()) == FALSE
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(claims, "EXACT_UP_TO", -1)
            assert verify(relation, Environment()) == FALSE


def test_only_the_functions_of_a_matrix_are_read() -> None:
    M = Matrix.of([[1, 2], [2, 4]])
    assert verify(said(Apply("rank", Literal(M)), 1), Environment()) == EXACTLY
    for way in (EXACT_UP_TO, -1):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(claims, "EXACT_UP_TO", way)
            assert verify(said(Apply("order", Literal(M)), 1), Environment()) == FALSE


SIGNED = Environment(signs={"a": "positive", "b": "real", "c": "nonnegative"}, nonzero=(b - 1,))


@tabled
def test_signs_decide(relation: list[Any], *, is_so: bool) -> None:
    assert verify(said(*map(member, relation)), SIGNED) == (EXACTLY if is_so else FALSE)


def test_conditions_keep_what_an_eigenvalue_may_meet_from_zero() -> None:
    root = Scalar.symbol(EIGENVALUE)
    both = said((root + b) * (root + c), "!=", 0)
    assert verify(both, Environment(nonzero=(root + b,), domain=(root + c,))) == EXACTLY
    for relations in ((), (root**2 - 2,)):
        assert verify(both, Environment(nonzero=(root + b,), relations=relations)) == FALSE


def test_what_keeps_a_single_value_from_zero() -> None:
    def is_kept(value: Scalar, **known: Any) -> bool:
        return claims._excluded_from_zero(value, Environment(signs={"a": "positive"}, **known))

    value = a * (b - 1) ** 2 * c
    assert is_kept(value, nonzero=(b - 1,), domain=(c,))
    assert not is_kept(value, nonzero=(b - 1,))
    assert not is_kept(value, domain=(c,))
    assert is_kept(a + 1)
    assert not is_kept(b)
    assert not is_kept(Scalar.of(0))


# -- points ------------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("at_points")
def test_every_kind_of_leaf_is_drawn_at_a_point() -> None:
    """Letters, values written out, what a coefficient stands for, polynomials of matrices, signals and their rates."""
    names = Environment(values={"A": Matrix.of([[a]]), "F": b, "phi": s + c}, coefficients={"d": 2 * b})
    for itself in (Letter("s"), Apply("phi_at", A), Letter("F")):
        assert is_at_points(said(itself, itself), names)
    for left, right in (
        (Letter("F"), b),
        (Product((Letter("F"), literal(2))), d),
        (Apply("phi_at", A), a + c),
        (Letter("s"), s),
    ):
        assert is_at_points(said(left, right), names)
        assert verify(said(left, right + 1), names) == FALSE
    signals: dict[str, Formula | None] = {"x": None, "y": Product((Letter("F"), X))}
    plant = replace(names, signals=signals, sizes={"x": 1}, dynamics={"x": Product((A, X))}, coefficients={})
    assert is_at_points(said(Derivative(Letter("y")), Product((Literal(a * b), X))), plant)
    assert verify(said(Derivative(Letter("y")), Product((Literal(a), X))), plant) == FALSE
    for signal in (Letter("y"), Derivative(Letter("y")), Derivative(X)):
        assert is_at_points(said(signal, signal), plant)


def test_the_bound_follows_degrees_and_heights(monkeypatch: pytest.MonkeyPatch) -> None:
    """By Schwartz and Zippel with 2^61 values, and a number of so many bits with a random one of 2·10^17 primes > 2^63."""
    left, right, huge = SizeBound(3, 5, 100, 20), SizeBound(7, 2, 50, 40), SizeBound(2.0**70, 0, 0, 0)

    def error(*sizes: Any) -> float:
        found = iter(sizes)
        monkeypatch.setattr(claims, "evaluate", lambda *_: next(found))
        members = tuple(Literal(a) for _ in sizes)
        return claims._error_bound(
            Relation(members, ("=",) * (len(sizes) - 1)), Environment(), Modular(Environment(), point)
        )

    point = Point({"a"}, random.Random(0))  # noqa: S311 - any point will do
    once = 12 / 2**61 + 141 / 63 / (2 * 10**17)
    assert error(left, right) == error(right, left) == pytest.approx(once, rel=1e-12, abs=0)
    assert error(left, right, left) == pytest.approx(2 * once, rel=1e-12, abs=0)
    assert error(huge, left) == 0.5
    x_and_u, x_and_y = (SimpleNamespace(coefficients=c) for c in ({"x": left, "u": left}, {"x": right, "y": right}))
    nothing = SizeBound(0, 0, 0, 0)
    pairs = [(left, right), (left, nothing), (nothing, right)]
    assert sorted(map(str, claims._paired(x_and_u, x_and_y))) == sorted(map(str, pairs))
    apart = [error(first, second) for first, second in pairs]
    assert error(x_and_u, x_and_y) == pytest.approx(sum(apart), rel=1e-12, abs=0)
    for pair in ((left, x_and_y), (x_and_y, left)):
        with pytest.raises(AttributeError):
            claims._paired(*pair)


def test_a_named_function_of_time_is_taken_at_the_instant_too() -> None:
    """m = t is 0 at t = 0, and T at t = T, not t."""
    t, T, m = (Scalar.symbol(name) for name in "tTm")
    e = Environment(values={"f": m}, coefficients={"m": t})
    for instant in (Scalar.of(0), T):
        taken = At(Letter("f"), "t", instant)
        assert verify(Relation((taken, Literal(instant)), ("=",)), e)[0]
        assert not verify(Relation((taken, Literal(t)), ("=",)), e)[0]
