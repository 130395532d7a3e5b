"""The powers Aᵏ in k: at the first instants they are the products of A, in SymPy's numbers."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import CertificateRejected, InputError

k = sympy.Symbol("k")
#: Matrices of one to three states: a real, a double, a nilpotent, a turning and an irrational pair of modes.
_BLOCKS = ("[r]", "[0]", "[r, 1; 0, r]", "[0, 1; 0, 0]", "[r, q; -q, r]", "[0, 1; 1, r]", "[0, 1; q, 0]")
#: All are drawn where there is time.
SEEDS = [*range(30), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(30, 200))]


def drawn(chance: random.Random) -> Any:
    """Return a block diagonal matrix in other coordinates."""
    blocks: list[Any] = []
    while sum(block.rows for block in blocks) < chance.randint(1, 3):
        r, q = (sympy.Rational(chance.choice([-3, -2, -1, 1, 2]), chance.choice([1, 2, 3])) for _ in range(2))
        rows = [
            [{"r": r, "q": q, "-q": -q}.get(entry.strip(), entry.strip()) for entry in row.split(",")]
            for row in chance.choice(_BLOCKS)[1:-1].split(";")
        ]
        blocks.append(sympy.Matrix([[sympy.Rational(entry) for entry in row] for row in rows]))
    whole = sympy.diag(*blocks)
    T = sympy.eye(whole.rows) + sympy.Matrix(whole.rows, whole.rows, lambda i, j: chance.randint(-2, 2) if i < j else 0)
    return T * whole * T.inv()


@pytest.mark.parametrize("seed", SEEDS)
def test_the_powers_are_the_products(seed: int) -> None:
    A = drawn(random.Random(seed))  # noqa: S311 - repeats
    found = symobs.matrix_exponential(StateSpace([[str(entry) for entry in row] for row in A.tolist()], dt=True))
    assert found.verdict == "yes"
    for at in (0, 1, 2, 3, 7):
        difference = found.matrix.subs(k, at) - A**at
        assert max(abs(complex(entry)) for entry in difference) < 1e-9 * (1 + max(map(abs, A**at)))


def test_powers_with_parameters_have_their_cases() -> None:
    a, b = sympy.symbols("a b")
    found = symobs.matrix_exponential(StateSpace("[a 0; 1 b]", dt=True))
    assert found.matrix == sympy.Matrix([[a**k, 0], [(a**k - b**k) / (a - b), b**k]])
    (double,) = found.cases
    assert str(double.when[0]) == "Eq(a - b, 0)"
    assert double.result.matrix[1, 0] == k * b**k / b
    (singular,) = double.result.cases
    assert singular.result.matrix[1, 0] == sympy.KroneckerDelta(k, 1)
    for kind in ("text", "latex", "html", "json"):
        found.to(kind)
    text = found.to("text")
    assert "(k/b)bᵏ" in text
    assert "δ is 1 where its arguments are equal" in text


def test_powers_without_closed_form_are_undecided() -> None:
    found = symobs.matrix_exponential(StateSpace("[0 1 0; 0 0 1; -1/3 0 1]", dt=True))
    assert found.verdict == "undecided"
    assert "The powers of A are not given" in found.to("text")


def test_wrong_powers_are_rejected() -> None:
    found = symobs.matrix_exponential(StateSpace("[1/2 1; 0 2]", dt=True))
    with pytest.raises(CertificateRejected):
        found.with_answer("matrix", found.answer["matrix"] * 2)
    with pytest.raises(CertificateRejected):
        found.with_answer("matrix", found.plant.matrices.A)


def test_the_instant_is_no_parameter() -> None:
    with pytest.raises(InputError, match="k is the number of the instant"):
        symobs.matrix_exponential(StateSpace("[k]", dt=True))
