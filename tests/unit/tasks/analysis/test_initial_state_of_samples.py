"""The initial state from samples in discrete time, held to the recursion x(k + 1) = A x(k) + B u(k) in SymPy's rationals."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import tabled
from tests.support.sampling import seeds

#: All are drawn where there is time.
SEEDS = seeds(15)


def drawn(chance: random.Random, rows: int, columns: int) -> Any:
    return sympy.Matrix(rows, columns, lambda *_: sympy.Rational(chance.randint(-4, 4), chance.choice([1, 1, 2, 3])))


def texts(matrix: Any) -> list[list[str]]:
    return [[str(entry) for entry in row] for row in matrix.tolist()]


@pytest.mark.parametrize("seed", SEEDS)
def test_the_samples_give_the_state_they_began_with(seed: int) -> None:
    """The state is found where the pair is observable, one of them where it is not; a sample that is wrong refutes all."""
    chance = random.Random(seed)  # noqa: S311 - repeats
    n, m, p = chance.randint(1, 3), chance.randint(1, 2), chance.randint(1, 2)
    A, B, C, D = drawn(chance, n, n), drawn(chance, n, m), drawn(chance, p, n), drawn(chance, p, m)
    if chance.random() < 0.3:
        C[:, 0] = sympy.zeros(p, 1)
        A[1:, :1] = sympy.zeros(n - 1, 1)
    count = n + chance.randint(0, 2)
    inputs, start = drawn(chance, m, count), drawn(chance, n, 1)
    state, outputs = start, []
    for k in range(count):
        outputs.append(C * state + D * inputs[:, k])
        state = A * state + B * inputs[:, k]
    y = sympy.Matrix.hstack(*outputs).copy()
    stack = sympy.Matrix.vstack(*(C * A**k for k in range(count)))
    plant = StateSpace(texts(A), texts(B), texts(C), texts(D), dt=True)
    found = symobs.initial_state(plant, output=texts(y), input=texts(inputs))
    difference = sympy.Matrix(found.x0) - start
    assert (stack * difference).is_zero_matrix
    assert len(found.kernel) == n - stack.rank()
    assert found.verdict == ("yes" if stack.rank() == n else "no")
    y[chance.randrange(p), chance.randrange(count)] += 1
    forced = sympy.Matrix.vstack(*outputs) - stack * start
    right = sympy.Matrix.vstack(*(y[:, k] for k in range(count))) - forced
    wrong = symobs.initial_state(plant, output=texts(y), input=texts(inputs))
    consistent = stack.row_join(right).rank() == stack.rank()
    assert (wrong.fields["x0"] is not None) == consistent
    assert ("residual" in wrong.fields) == (not consistent)
    if not consistent:
        assert wrong.verdict == "no"
        assert not sympy.Matrix(wrong.residual).is_zero_matrix
        assert stack.row_join(right - sympy.Matrix(wrong.residual)).rank() == stack.rank()


def test_pages_and_cases_of_samples() -> None:
    plant = StateSpace("[0 1; -1/2 1]", "[0; 1]", "[1 0]", dt=True)
    assert list(symobs.initial_state(plant, output="1, 3").x0) == [1, 3]
    forced = symobs.initial_state(plant, output="1, 3, 5", input="1, 0, 2")
    assert "No initial state is consistent with these samples" in forced.to("text")
    # y(2) = −1/2 + 3 fits; any other third sample does not
    open_ = symobs.initial_state(plant, output="1, 3, y")
    assert open_.verdict == "no"
    (case,) = open_.cases
    assert str(case.when[0]) == "Eq(2*y - 5, 0)"
    assert list(case.result.x0) == [1, 3]
    open_.derivation.check()
    hidden = symobs.initial_state(StateSpace("[1 0; 0 1/2]", None, "[1 0]", dt=True), output="1, 1, 1")
    assert hidden.verdict == "no"
    assert "so any multiple of it may be added" in hidden.to("text")


@tabled
def test_samples_that_cannot_be_read_are_refused(asked: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        symobs.initial_state(StateSpace("[0 1; -1/2 1]", "[0; 1]", "[1 0]", dt=True), **asked)
