"""Optimal gains against SciPy, the eigenvectors of the Hamiltonian matrix at 60 digits, and printed answers."""

from __future__ import annotations

import tomllib
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy
from scipy.linalg import (  # type: ignore[import-untyped]
    solve_continuous_are,
    solve_continuous_lyapunov,
    solve_discrete_are,
    solve_discrete_lyapunov,
)

import symobs
from symobs.exact import Matrix
from symobs.exact.floating.riccati import enclosed_solution
from symobs.exact.floating.riccati_check import Regulator, excess, is_proved
from symobs.exact.sympy_bridge.conversion import scalar_to_sympy
from symobs.formula.expression import parse_poles
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import tabled, text_of
from tests.support.algebra import random_fraction, seeded
from tests.support.claims.claims import HOLDS, Setting, applicable
from tests.support.paths import ROOT
from tests.support.sampling import seeds

PROBLEMS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))["problem"]


#: Seeds of plants for which SciPy has eight or nine right digits.
ILL_CONDITIONED = {119, 129, 161, 209, 225}


def text(rows: Any) -> str:
    return "[" + "; ".join(" ".join(map(str, row)) for row in rows) + "]"


def drawn(seed: int) -> tuple[dict[str, Any], int]:
    """Return A, B, Q, R of a random controllable plant with a cost that sees each mode, and its sampling period."""
    draw = seeded(seed)
    while True:
        n, m, dt = draw.randint(1, 6), draw.randint(1, 2), draw.choice([0, 1])
        A = [[Fraction(draw.randint(-3, 3), draw.choice([1, 2])) for _ in range(n)] for _ in range(n)]
        B = [[Fraction(draw.randint(-2, 2)) for _ in range(m)] for _ in range(n)]
        H = [[draw.randint(-2, 2) for _ in range(n)] for _ in range(draw.randint(1, n))]
        Q = [[Fraction(sum(row[i] * row[j] for row in H)) for j in range(n)] for i in range(n)]
        R = [[Fraction(draw.randint(1, 4) * int(i == j)) for j in range(m)] for i in range(m)]
        a, b, h = (np.array(part, dtype=float) for part in (A, B, H))
        powers = [np.linalg.matrix_power(a, k) for k in range(n)]
        ranks = (np.hstack([p @ b for p in powers]), np.vstack([h @ p for p in powers]))
        if all(np.linalg.matrix_rank(part, tol=1e-9) == n for part in ranks):
            return {"A": A, "B": B, "Q": Q, "R": R}, dt


def precise(data: dict[str, Any], dt: int) -> Any:
    """Return P from the eigenvectors of the Hamiltonian pencil at 60 digits and more."""
    with mpmath.workdps(90):
        A, B, Q, R = (
            mpmath.matrix([[mpmath.mpf(e.numerator) / e.denominator for e in r] for r in data[k]]) for k in "ABQR"
        )
        n = A.rows
        S, one = B * mpmath.inverse(R) * B.T, mpmath.eye(n)
        M, L = mpmath.zeros(2 * n), mpmath.zeros(2 * n)
        if dt:
            M[:n, :n], M[n:, :n], M[n:, n:], L[:n, :n], L[:n, n:], L[n:, n:] = A, -Q, one, one, S, A.T
            H = mpmath.inverse(M + L) * (M - L)
        else:
            M[:n, :n], M[:n, n:], M[n:, :n], M[n:, n:] = A, -S, -Q, -A.T
            H = M
        values, vectors = mpmath.eig(H)
        stable = [k for k, value in enumerate(values) if mpmath.re(value) < 0]
        upper = mpmath.matrix([[vectors[i, k] for k in stable] for i in range(n)])
        lower = mpmath.matrix([[vectors[n + i, k] for k in stable] for i in range(n)])
        return (lower * mpmath.inverse(upper)).apply(mpmath.re)


@pytest.mark.parametrize("seed", [*seeds(12, 320), *(pytest.param(k, marks=pytest.mark.slow) for k in ILL_CONDITIONED)])
def test_digits_are_those_of_scipy_and_of_ninety_digits(seed: int) -> None:
    data, dt = drawn(seed)
    result: Any = symobs.lqr(
        symobs.StateSpace(text(data["A"]), text(data["B"]), dt=dt), Q=text(data["Q"]), R=text(data["R"])
    )
    A, B, Q, R = (np.array(data[name], dtype=float) for name in "ABQR")
    found = np.array([[float(entry) for entry in row] for row in result.decimals["P"]])
    expected = (solve_discrete_are if dt else solve_continuous_are)(A, B, Q, R)
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-5 * abs(expected).max()), data
    unit = Fraction(1, 1000)
    centre, near = (
        Matrix.of([[round(Fraction(entry) / unit) * unit for entry in row] for row in result.decimals[name]])
        for name in "PK"
    )
    bound = excess(result.regulator, centre, near, unit)
    if bound is not None:
        K = np.array([[float(entry.fraction()) for entry in row] for row in near.rows])
        loop, cost = A - B @ K, Q + K.T @ R @ K
        reached = solve_discrete_lyapunov(loop.T, cost) if dt else solve_continuous_lyapunov(loop.T, -cost)
        assert np.linalg.eigvalsh(reached - expected).max() <= float(bound) + 1e-7 * abs(expected).max(), data
    if seed % 4 == 0 or seed in ILL_CONDITIONED:
        P = precise(data, dt)
        with mpmath.workdps(60):
            for i, row in enumerate(result.decimals["P"]):
                for j, entry in enumerate(row):
                    half = mpmath.mpf(10) ** -len(entry.partition(".")[2]) / 2
                    assert abs(P[i, j] - mpmath.mpf(entry)) <= half * (1 + mpmath.mpf(10) ** -20), (data, entry)


def solved(problem: dict[str, Any]) -> Any:
    plant = symobs.StateSpace(problem["A"], problem.get("B"), problem.get("C"), dt=problem.get("dt", 0))
    if problem.get("task") == "kalman":
        return symobs.kalman(plant, W=problem["W"], V=problem["V"], G=problem.get("G"))
    return symobs.lqr(plant, Q=problem["Q"], R=problem["R"], N=problem.get("N"))


def entry_of(value: str) -> Any:
    return scalar_to_sympy(parse_poles(value, functions=True)[0].real, {})


def read(value: str) -> Any:
    rows = [row.split() if " + " not in row and " - " not in row else [row] for row in value.strip("[]").split(";")]
    return sympy.Matrix([[entry_of(entry) for entry in row] for row in rows])


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem["source"][:40])
def test_textbook_problems(problem: dict[str, Any]) -> None:
    result = solved(problem)
    assert result.verdict == problem.get("verdict", "yes")
    for name in {"K", "L", "P"} & problem.keys():
        assert (getattr(result, name) - read(problem[name])).applyfunc(sympy.nsimplify).applyfunc(
            sympy.simplify
        ) == sympy.zeros(*getattr(result, name).shape)
    for name in (name for name in "KLP" if f"{name}_decimals" in problem):
        for found, printed in zip(result.decimals[name], problem[f"{name}_decimals"], strict=True):
            half = [Fraction(1, 2 * 10 ** len(entry.partition(".")[2])) for entry in printed]
            pairs = zip(found, printed, half, strict=True)
            assert all(abs(Fraction(one) - Fraction(other)) <= off for one, other, off in pairs), problem["source"]
    if result.verdict == "yes":
        result.to("text")
        result.to("text", language="de")


@tabled
def test_closed_forms_hold_at_points(
    A: str, B: str, Q: str, dt: int, signs: dict[str, str], conditions: list[str], said: str
) -> None:
    """Riccati's equation in sixty digits, in the cases too: what is real is 0 at the first point."""
    plant = symobs.StateSpace(A, B, dt=dt, symbols=signs)
    result: Any = symobs.lqr(plant, Q=Q, R="r")
    assert [str(each) for each in result.conditions] == conditions
    assert said in text_of(result)
    for number in range(13):
        point = {
            name: random_fraction(seeded((name, number)), sign) if number or sign != "real" else Fraction(0)
            for name, sign in signs.items()
        }
        (part,) = applicable(result, point)
        HOLDS["lqr"](part, Setting.of(plant, {}, point))


def test_conditions_and_what_is_true_where_they_fail() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; b]", symbols={"b": "real", "q": "nonnegative", "r": "positive"})
    result: Any = symobs.lqr(plant, Q="[q 0; 0 0]", R="r")
    assert result.verdict == "conditional"
    assert {str(condition) for condition in result.conditions} == {"Ne(b, 0)", "Ne(q, 0)"}
    there = {str(case.when[0]): case.result for case in result.cases}
    assert there["Eq(b, 0)"].verdict == there["Eq(q, 0)"].verdict == "no"
    for b, q, r in ((1, 1, 1), (-2, 3, 5), (0, 1, 1), (1, 0, 1)):  # p(s) = s^2 + sqrt(2 w) s + w with w = |b| sqrt(q/r)
        at = result.at(b=b, q=q, r=r)
        assert at.verdict == ("yes" if b and q else "no")
        if at.verdict == "yes":
            w = abs(b) * sympy.sqrt(sympy.Rational(q, r))
            assert (at.K - sympy.Matrix([[w / b, sympy.sqrt(2 * w) / b]])).applyfunc(sympy.simplify).is_zero_matrix


def test_signs_that_weights_need_are_conditions() -> None:
    result: Any = symobs.lqr(symobs.StateSpace("[0 1; 0 0]", "[0; 1]"), Q="[q1 0; 0 q2]", R="r")
    assert [str(each) for each in result.conditions] == ["q1 >= 0", "q2 >= 0", "r > 0", "Ne(q1, 0)"]
    assert [case.result.verdict for case in result.cases] == ["no"]
    # p(s) = s^2 + sqrt(q2/r + 2 sqrt(q1/r)) s + sqrt(q1/r)
    K = result.evaluate({"q1": np.array([1.0, -1.0, 16.0]), "q2": np.array([2.0, 1.0, 1.0]), "r": 1.0})["K"]
    assert np.allclose(K[[0, 2]], [[[1, 2]], [[4, 3]]])
    assert np.isnan(K[1]).all()
    with pytest.raises(InputError, match="-1 is not nonnegative"):
        result.at(q1=-1, q2=1, r=1)
    filtered: Any = symobs.kalman(
        symobs.StateSpace("[a]", None, "[1]", symbols={"a": "nonzero", "w": "real", "v": "nonzero"}), W="4*w", V="v"
    )
    assert [str(each) for each in filtered.conditions] == ["w >= 0", "v > 0"]


def test_a_root_on_the_circle_is_excluded_where_its_mirror_image_is_one() -> None:
    # At a = 1, q = 0 the modes 1 and -1 are hidden from the cost, and c(z) is a polynomial in z^2.
    result: Any = symobs.lqr(symobs.StateSpace("[0 1; a 0]", "[0; 1]", dt=1), Q="[q 0; 0 0]", R="1")
    assert "Ne(a**2 - 2*a + q + 1, 0)" in map(str, result.conditions)
    there = {tuple(map(str, case.when)): case.result for case in result.cases}
    assert there["Eq(q, 0)", "Eq(a - 1, 0)"].verdict == "no"


@tabled
def test_an_obstacle_is_named(task: str, plant: dict[str, Any], weights: dict[str, str], modes: list[str]) -> None:
    found: Any = getattr(symobs, task)(symobs.StateSpace(**plant), **weights)
    assert (found.verdict, found.K if task == "lqr" else found.L) == ("no", None)
    assert sorted(map(str, found.modes)) == modes
    assert found.to("text")


def test_lies_are_rejected() -> None:
    other: Any = symobs.lqr(symobs.StateSpace("[0 1 0; 0 0 1; 1 2 3]", "[0; 0; 1]"), Q="1", R="1")
    digits = other.answer["digits"]
    first = digits.K[0][0]
    changed = f"{first[:-1]}{'1' if first[-1] != '1' else '2'}"
    with pytest.raises(CertificateRejected):
        other.with_answer("digits", digits._replace(K=((changed, *digits.K[0][1:]),)))
    # The other solution of p^2 = 1 is no stabilising one.
    scalar: Any = symobs.lqr(symobs.StateSpace("[0]", "[1]"), Q="1", R="1")
    with pytest.raises(CertificateRejected):
        scalar.with_answer("digits", scalar.answer["digits"]._replace(centre=-scalar.answer["digits"].centre))


@tabled
def test_wrong_weights_are_refused(weights: dict[str, str], match: str) -> None:
    with pytest.raises(InputError, match=match):
        symobs.lqr(symobs.StateSpace("[0 1; 0 0]", "[0; 1]"), **weights)


def test_intensities_of_noise_have_their_signs() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", None, "[1 0]")
    with pytest.raises(InputError, match="W is not positive semidefinite"):
        symobs.kalman(plant, W="[1 0; 0 -1]", V="1", G="[1 0; 1 0]")
    with pytest.raises(InputError, match="V is not positive definite"):
        symobs.kalman(plant, W="1", V="0")


def test_what_no_square_roots_write_is_undecided_with_parameters() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 1; 0 0 a]", "[0; 0; 1]")
    result: Any = symobs.lqr(plant, Q="1", R="1")
    assert (result.verdict, result.K, result.P) == ("undecided", None, None)
    assert "up to order 2" in result.question
    result.to("text")
    assert result.at(a=0).verdict == "yes"


def test_what_is_too_long_is_undecided_and_the_factors_show_that_the_loop_is_stable() -> None:
    long: Any = symobs.lqr(symobs.StateSpace("[a 1; 0 c]", "[b; 1]", dt=1), Q="[q 0; 0 g]", R="r")
    assert (long.verdict, long.question) == ("undecided", "its closed form is too long")
    seen: Any = symobs.lqr(symobs.StateSpace("[b 0; b a]", "[1 1; 1 0]"), Q="[q 0; 0 0]", R="r")
    assert seen.verdict == "conditional"


def test_a_mode_that_may_lie_on_the_boundary_is_left_open() -> None:
    plant = symobs.StateSpace("[0 1; -k 0]", "[0; 1]", symbols={"k": "real", "r": "positive"})
    result: Any = symobs.lqr(plant, Q="0", R="r")  # for k > 0 a hidden oscillation, for k < 0 a saddle
    assert result.verdict == "undecided"
    assert [result.at(k=k, r=1).verdict for k in (4, 0, -4)] == ["no", "no", "yes"]
    assert result.at(k=-4, r=1).K.tolist() == [[8, 4]]


def test_decimals_answer_where_there_is_no_closed_form() -> None:
    problem = (ROOT / "worked_examples" / "lqr_third_order.toml").read_text("utf-8")
    given = {"K = [0.0143 0.1107 0.0676]": "right", "K = [0.0143 0.1108 0.0676]": "wrong", "K = [1 1 1]": "wrong"}
    assert {answer: symobs.check(problem, answer).verdict for answer in given} == given


def test_a_condition_that_never_fails_is_not_told_and_sums_fail_together() -> None:
    both: Any = symobs.lqr(symobs.StateSpace("[a 0; 0 b]", "[1 0; 0 1]"), Q="1", R="1")
    assert (both.verdict, both.conditions, both.cases) == ("yes", (), ())
    signs = {"k": "positive", "m": "positive", "c": "nonnegative", "q": "nonnegative", "r": "positive"}
    damped: Any = symobs.lqr(symobs.StateSpace("[0 1; -k/m -c/m]", "[0; 1/m]", symbols=signs), Q="[0 0; 0 q]", R="r")
    assert [str(condition) for condition in damped.conditions] == ["Ne(c**2 + m**2*q, 0)"]
    (case,) = damped.cases
    assert ({str(each) for each in case.when}, case.result.verdict) == ({"Eq(c, 0)", "Eq(q, 0)"}, "no")
    damped.to("text")


@tabled
def test_plants_near_an_obstacle(A: str, B: str, Q: str, R: str, dt: int) -> None:
    result: Any = symobs.lqr(symobs.StateSpace(A, B, dt=dt), Q=Q, R=R)
    assert result.verdict == "yes"
    exact = [[float(entry) for entry in row] for row in result.decimals["P"]]
    if result.P is not None:
        assert np.allclose(np.array(result.P.evalf(40).tolist(), dtype=float), exact, rtol=1e-12)
    result.to("text")


def test_digits_of_another_shape_are_not_those_of_the_gain() -> None:
    A, B, Q, R, N = map(Matrix.of, ([[0, 1], [0, 0]], [[0], [1]], [[1, 0], [0, 0]], [[1]], [[0], [0]]))
    regulator = Regulator(A, B, Q, R, N, discrete=False)
    found = enclosed_solution(regulator)
    assert found is not None
    P, K = ([[(Fraction(text), Fraction(1, 10**12)) for text in row] for row in table] for table in (found.P, found.K))
    told = partial(is_proved, regulator, found.centre, found.radius)
    assert told(P, K)
    assert not any((told(P, []), told(P, [K[0][:1]]), told(P[:1], K)))


def test_the_time_is_no_weight() -> None:
    with pytest.raises(InputError, match="stands for the time"):
        symobs.lqr(symobs.StateSpace([[0]], [[1]], symbols={"t": "real"}), Q="t^2 + 1", R="1")


def test_margins_of_an_optimal_loop() -> None:
    # x' = x + u with Q = 3, R = 1: P = K = 3, and the loop 3/(s - 1) is stable for gains above 1/3.
    found = symobs.margins(symobs.lqr(symobs.StateSpace("[1]", "[1]"), Q="3", R="1"))
    assert (found["gain_down"], found["gain_up"], found["slowest"]) == (sympy.Rational(1, 3), sympy.oo, -2)


def test_the_loop_of_a_case_is_stable_because_a_sum_under_a_root_cannot_vanish() -> None:
    """Of two equal columns the pair is controllable but where b = −(a + 1)(a² + a + 1); K there is SciPy's."""
    plant = symobs.StateSpace("[-1 b; -a 0]", "[a+1 a+1; -1 -1]", symbols={"a": "real", "b": "real"})
    (case,) = symobs.lqr(plant, Q="1", R="1").case_tree
    assert case.result is not None
    for a in (-3, -0.5, 2, 7):
        b = -(a + 1) * (a**2 + a + 1)
        A, B = np.array([[-1, b], [-a, 0]]), np.array([[a + 1, a + 1], [-1, -1]])
        K = B.T @ solve_continuous_are(A, B, np.eye(2), np.eye(2))
        found = case.result.K.subs("a", sympy.nsimplify(a)).evalf()
        assert np.allclose(np.array(found, dtype=float), K)


def test_a_factor_that_is_stable_as_it_is_written_is_so_in_any_form() -> None:
    """The Hamiltonian's polynomial at a = 1 is s⁴ − 22 s² + 81 by NumPy; a² + 8 is seen to be positive, r² − 1 is not."""
    found = symobs.kalman(symobs.StateSpace("[-2 a; a 0]", "[0; 1]", "[0 2]", symbols={"a": "real"}), W="1", V="1/4")
    factor = found.polynomial
    a, s = sorted(factor.free_symbols, key=str)
    assert sympy.expand((factor * factor.subs(s, -s)).subs(a, 1)) == s**4 - 22 * s**2 + 81
    assert "stable region" in found.to("text")


def test_a_page_is_written_where_the_roots_of_a_case_are_too_many_beside_the_others() -> None:
    signs = {"a": "positive", "b": "negative", "c": "real", "q": "positive"}
    plant = symobs.StateSpace("[-c 3; -1 -1]", "[b; -a]", symbols=signs)
    found = symobs.lqr(plant, Q="[1 0; 0 q]", R="1")
    assert [case.result for case in found.case_tree] == [None]
    assert "stabilizing solution" in found.to("text")
    long = symobs.lqr(symobs.StateSpace("[a 1; 0 c]", "[0; 1]", dt=True, symbols=signs), Q="1", R="q")
    assert (long.verdict, long.K) == ("undecided", None)
    assert "too long" in long.question


def test_a_gain_in_decimals_is_compared_with_the_factor_and_the_filter_is_written() -> None:
    """The coefficients of the loop against SciPy's solution of Riccati's equation."""
    A, C, noise = np.array([[0, 1, 0], [0, 0, 1], [0, 0, -1]]), np.array([[1, 0, 0]]), np.diag([0, 0, 9])
    P = solve_continuous_are(A.T, C.T, noise, np.eye(1))
    first, second, third = np.poly(A - P @ C.T @ C)[1:]
    plant = symobs.StateSpace("[0 1 0; 0 0 1; 0 0 -1]", "[0; 0; 1]", "[1 0 0]")
    page = text_of(symobs.kalman(plant, W="9", V="1", G="[0; 0; 1]"))
    assert "= s³ + (l₁ + 1)s² + (l₁ + l₂)s + l₂ + l₃" in page
    assert f"= s³ + {first:.5f} s² + {second:.5f} s + {third:.0f}" in page
    assert "dx̂/dt = A x̂ + B u + L̂(y - C x̂)" in page
    assert "enters the state equation as G w" in page


def test_a_page_in_digits_of_two_inputs_has_the_polynomial_of_the_hamiltonian_matrix() -> None:
    A, B, Q, R = "[0 1 0; 0 0 1; 0 -2 -3]", "[0 0; 1 0; 0 1]", "diag(1, 1, 1)", "diag(1, 2)"
    a, b = np.array([[0, 1, 0], [0, 0, 1], [0, -2, -3]]), np.array([[0, 0], [1, 0], [0, 1]])
    H = np.block([[a, -b @ np.diag([1, 0.5]) @ b.T], [-np.eye(3), -a.T]])
    np.testing.assert_allclose(np.poly(H), [1, 0, -6.5, 0, 19, 0, -10], atol=1e-9)
    page = symobs.lqr(symobs.StateSpace(A, B), Q=Q, R=R).to("text")
    assert "c(s) = det(sI - H) = s⁶ - (13/2)s⁴ + 19s² - 10" in page
