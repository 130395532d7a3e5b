"""The real modal form of one input: its output has the residues where its input has ones."""

from __future__ import annotations

from random import Random

import pytest
import sympy

import symobs
from symobs import StateSpace

s = sympy.Symbol("s")


@pytest.mark.parametrize("seed", range(12))
def test_ones_at_the_input_are_residues_at_the_output(seed: int) -> None:
    """With A similar to diag(−1, −2, −4): C̄ᵢ is the limit of (s − λᵢ) G(s), G computed by SymPy."""
    draw = Random(seed)  # noqa: S311 - repeats
    S = sympy.eye(3)
    while S.is_diagonal() or abs(S.det()) != 1:
        S = sympy.Matrix(3, 3, lambda _i, _j: draw.randint(-1, 1))
    poles = [-1, -2, -4]
    A = S * sympy.diag(*poles) * S.inv()
    B, C = (
        (S * sympy.Matrix([draw.choice([-2, -1, 1, 3]) for _ in range(3)])),
        sympy.Matrix([[1, draw.randint(0, 2), 0]]),
    )
    G = sympy.cancel((C * (s * sympy.eye(3) - A).inv() * B)[0])
    found = symobs.canonical_form(StateSpace(A.tolist(), B.tolist(), C.tolist()), kind="modal")
    assert [*found.B] == [1, 1, 1]
    diagonal = [found.A[k, k] for k in range(3)]
    assert sorted(diagonal) == sorted(poles)
    assert [*found.C] == [sympy.limit((s - pole) * G, s, pole) for pole in diagonal]


def test_a_block_that_the_input_does_not_reach_keeps_its_basis() -> None:
    found = symobs.canonical_form(StateSpace("[-1 0; 1 -2]", "[0; 1]", "[1 1]"), kind="modal")
    assert (found.verdict, 0 in found.B) == ("yes", True)
    assert "a single 1 in each block" not in " ".join(found.to("text").split())


def test_letters_of_the_input_say_where_there_are_ones() -> None:
    """Ones divide by b; where b = 0 the first mode is not reached, and keeps its basis."""
    plant = StateSpace("[-1 0; 0 -2]", "[b; 1]", "[1 1]", symbols={"b": "real"})
    found = symobs.canonical_form(plant, kind="modal")
    assert ([str(each) for each in found.conditions], [*found.B]) == (["Ne(b, 0)"], [1, 1])
    (case,) = found.cases
    assert [*case.result.B] == [0, 1]
    assert found.T.subs("b", 3) == found.at(b=3).T


def test_several_inputs_have_no_ones() -> None:
    found = symobs.canonical_form(StateSpace("[-1 0; 0 -2]", "[1 1; 1 2]", "[1 1]"), kind="modal")
    assert (found.verdict, found.B.shape) == ("yes", (2, 2))
