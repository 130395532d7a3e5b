"""Optimal gains against SciPy, the eigenvectors of the Hamiltonian matrix at 60 digits, and printed answers."""

from __future__ import annotations

import tomllib
from fractions import Fraction
from pathlib import Path
from typing import Any

import mpmath  # type: ignore[import-untyped]
import numpy as np
import pytest
import sympy
from scipy.linalg import solve_continuous_are, solve_discrete_are  # type: ignore[import-untyped]

import symobs
from symobs.ground.errors import CertificateRejected, InputError, Undecided
from tests.support.algebra import seeded

PROBLEMS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))["problem"]


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
        A, B, Q, R = (mpmath.matrix([[mpmath.mpf(e.numerator) / e.denominator for e in r] for r in data[k]]) for k in "ABQR")
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


def hold(seed: int, *, digits: bool) -> None:
    """Hold the digits of P to SciPy, and to a computation with 90 digits."""
    data, dt = drawn(seed)
    result: Any = symobs.lqr(
        symobs.StateSpace(text(data["A"]), text(data["B"]), dt=dt), Q=text(data["Q"]), R=text(data["R"])
    )
    A, B, Q, R = (np.array(data[name], dtype=float) for name in "ABQR")
    found = np.array([[float(entry) for entry in row] for row in result.decimals["P"]])
    gain = np.array([[float(entry) for entry in row] for row in result.decimals["K"]])
    expected = (solve_discrete_are if dt else solve_continuous_are)(A, B, Q, R)
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-5 * abs(expected).max()), data
    poles = np.linalg.eigvals(A - B @ gain)
    assert (abs(poles) < 1).all() if dt else (poles.real < 0).all()
    if result.P is not None:
        exact = np.array(result.P.evalf(30).tolist(), dtype=float)
        assert np.allclose(exact, found, rtol=1e-12, atol=1e-12 * abs(found).max())
    if digits:
        P = precise(data, dt)
        with mpmath.workdps(60):
            for i, row in enumerate(result.decimals["P"]):
                for j, entry in enumerate(row):
                    half = mpmath.mpf(10) ** -len(entry.partition(".")[2]) / 2
                    assert abs(P[i, j] - mpmath.mpf(entry)) <= half * (1 + mpmath.mpf(10) ** -20), (data, entry)


@pytest.mark.parametrize("seed", range(20))
def test_digits_are_those_of_scipy(seed: int) -> None:
    hold(seed, digits=seed < 4)


@pytest.mark.slow
def test_many_digits_are_those_of_scipy_and_of_ninety_digits() -> None:
    for seed in range(20, 320):
        hold(seed, digits=seed % 4 == 0)


def solved(problem: dict[str, Any]) -> Any:
    plant = symobs.StateSpace(problem["A"], problem.get("B"), problem.get("C"), dt=problem.get("dt", 0))
    if problem.get("task") == "kalman":
        return symobs.kalman(plant, W=problem["W"], V=problem["V"])
    return symobs.lqr(plant, Q=problem["Q"], R=problem["R"], N=problem.get("N"))


def read(value: str) -> Any:
    rows = [row.split() if " + " not in row and " - " not in row else [row] for row in value.strip("[]").split(";")]
    return sympy.Matrix([[sympy.sympify(entry.replace("^", "**")) for entry in row] for row in rows])


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem["source"][:40])
def test_textbook_problems(problem: dict[str, Any]) -> None:
    result = solved(problem)
    assert result.verdict == problem.get("verdict", "yes")
    for name in {"K", "L", "P"} & problem.keys():
        assert (getattr(result, name) - read(problem[name])).applyfunc(sympy.nsimplify).applyfunc(
            sympy.simplify
        ) == sympy.zeros(*getattr(result, name).shape)
    for name in {"K", "P"} if "K_decimals" in problem else ():
        for found, printed in zip(result.decimals[name], problem.get(f"{name}_decimals", []), strict=False):
            half = [Fraction(1, 2 * 10 ** len(entry.partition(".")[2])) for entry in printed]
            pairs = zip(found, printed, half, strict=True)
            assert all(abs(Fraction(one) - Fraction(other)) <= off for one, other, off in pairs), problem["source"]
    if result.verdict == "yes":
        result.to("text")
        result.to("text", language="de")
