"""Plants with exponentials, cosines and sines of t: ranks of the stack by SymPy and mpmath, exceptional parameters by hand."""

from __future__ import annotations

from typing import Any

import mpmath
import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError, Undecided
from tests.kit import tabled
from tests.support.algebra import seeded
from tests.support.sampling import seeds

t = sympy.Symbol("t")
ENTRIES = [
    *("0", "0", "0", "1", "-1", "t", "cos(t)", "sin(t)", "exp(-t)", "exp(t)", "cos(2*t)"),
    *("sin(2*t)*exp(-t)", "1+cos(t)", "t*sin(t)", "exp(-2*t)"),
]


def rank_of(matrix: Any, instant: Any) -> int:
    """The numerical rank at an instant, by fifty digits."""
    with mpmath.workdps(50):
        values = mpmath.matrix(matrix.subs(t, instant).evalf(50).tolist())
        sizes = mpmath.svd_r(values, compute_uv=False)
        return sum(1 for size in sizes if size > mpmath.mpf(10) ** -25 * max(1, *sizes))


def stack(A: Any, C: Any) -> Any:
    rows = [C]
    for _ in range(A.rows - 1):
        rows.append(rows[-1] * A + rows[-1].diff(t))
    return sympy.Matrix.vstack(*rows)


@pytest.mark.parametrize("seed", seeds(2))
def test_ranks_are_those_of_the_stack(seed: int) -> None:
    """Hold the rank to that at random instants, the hidden states and Φ to their equations there."""
    draw = seeded(seed)
    n, p = draw.choice([1, 2, 2, 2, 3]), draw.randint(1, 2)
    A, C = ([[draw.choice(ENTRIES) for _ in range(n)] for _ in range(rows)] for rows in (n, p))
    if draw.random() < 0.4:
        A = [[entry if j > i else "0" for j, entry in enumerate(row)] for i, row in enumerate(A)]
    if n > 1 and draw.random() < 0.4:  # states that are hidden: one output is a multiple of another
        A, C = [["0"] * n for _ in range(n)], [[row[0], f"2*({row[0]})", *row[2:]] for row in C]
    found: Any = symobs.time_varying_observability(StateSpace(A, C=C))
    M, N = sympy.Matrix(A), sympy.Matrix(C)
    instants = [sympy.Rational(draw.randint(-40, 40), 17) for _ in range(3)]
    O = stack(M, N)
    assert found.rank == max(rank_of(O, instant) for instant in instants), (A, C)
    assert found.verdict == ("yes" if found.rank == n else "no")
    Phi = found.fields.get("transition_matrix")
    if Phi is None:
        return
    Phi, start = found.transition_matrix, sympy.Symbol("t0")
    at = {t: instants[0], start: instants[1]}
    left = (Phi.diff(t) - M * Phi).subs(at).evalf(30)
    assert all(abs(entry) < 1e-20 for entry in left)
    for vector in found.kernel:
        seen = (N * Phi * sympy.Matrix(vector)).subs(at).evalf(30)
        assert all(abs(entry) < 1e-20 for entry in seen)


@tabled
def test_the_exceptional_parameters_are_all(
    A: str, C: str, exceptional: list[dict[str, Any]], ordinary: list[dict[str, Any]]
) -> None:
    found: Any = symobs.time_varying_observability(StateSpace(A, C=C))
    assert found.verdict == "conditional"
    assert "Case" in found.to("text")

    def hold_at(values: dict[str, Any], *, met: bool) -> None:
        put = {
            sympy.Symbol(name): sympy.pi / 2 if value == "pi/2" else sympy.Integer(value)
            for name, value in values.items()
        }
        conditions = [sympy.simplify(condition.subs(put)) for condition in found.conditions]
        assert all(condition == sympy.true for condition in conditions) == met, values
        M, N = (sympy.Matrix(matrix).subs(put) for matrix in (found.plant.A, found.plant.C))
        assert (rank_of(stack(M, N), sympy.Rational(11, 7)) == M.rows) == met

    for values in exceptional:
        hold_at(values, met=False)
    for values in ordinary:
        hold_at(values, met=True)


def test_an_initial_state_is_found_where_the_plant_moves_with_cosines() -> None:
    plant = StateSpace("[0 cos(t); 0 0]", C="[1 0]")
    found: Any = symobs.time_varying_observability(plant, interval="0, 1", output="1 + 2*sin(t)")
    assert list(found.x0) == [1, 2]
    assert "x₀" in found.to("text")


def test_what_is_no_function_of_time_here_is_refused() -> None:
    for entry in ("exp(t^2)", "cos(1/t)", "sqrt(t)", "exp(cos(t))"):
        with pytest.raises(InputError, match=r"rational in t|function of t|sqrt"):
            StateSpace("[0 1; 0 0]", C=[[entry, 0]])
    plant = StateSpace("[0 1; 0 0]", C="[1/(1 + 2*cos(t)) 0]")
    with pytest.raises(Undecided, match="vanishes in the interval"):
        symobs.time_varying_observability(plant, interval="0, 1")
    bounded = StateSpace("[0 1; 0 0]", C="[1/(2 + cos(t)) 0]")
    assert symobs.time_varying_observability(bounded, interval="0, 1").verdict == "yes"
    with pytest.raises(InputError, match="constant matrices"):
        symobs.observability(StateSpace("[0 cos(t); 0 0]", C="[1 0]"))
