"""Problems at random, of several inputs and outputs and in either time: every answer is held to the claim of its task.

The claims are checked in plain fractions, or by mpmath where there are functions of time, as in the contract tests.
"""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

import symobs
from symobs.exact import Matrix
from symobs.tasks.result import tasks
from tests.support.algebra import (
    determinant,
    identity,
    matrix_at,
    multiply,
    plus,
    response,
    subtract,
    transposed,
)
from tests.support.claims.claims import HOLDS, Setting
from tests.support.derivations import times
from tests.support.sampling import seeds

#: In discrete time their answers are held to recursions by tests of their own.
CONTINUOUS = {"matrix_exponential", "response", "zero_order_hold"}
TASKS = [
    *("observer", "state_feedback", "reduced_order_observer", "compensator", "integral_action", "decomposition"),
    *("disturbance_observer", "unknown_input_observer", "output_regulation", "lyapunov"),
    *("minimum_energy_input", "margins", "gramian", *sorted(CONTINUOUS)),
]


def drawn(task: str, chance: random.Random) -> tuple[symobs.StateSpace, dict[str, Any]]:
    """Return a plant, some of whose states may be hidden, and what the task is asked for."""
    n = 2 if task == "minimum_energy_input" else chance.choice([2, 3, 3])  # more exponentials take long
    dt = 0 if task in CONTINUOUS else chance.choice([0, 1])
    m, p = (1, 1) if task == "margins" else (chance.choice([1, 2]), chance.choice([1, 1, 2]))
    p = min(p, n - 1)

    def matrix(rows: int, columns: int, zeros: float = 0.3) -> list[list[int]]:
        return [[0 if chance.random() < zeros else chance.randint(-3, 3) for _ in range(columns)] for _ in range(rows)]

    def poles(count: int) -> list[str]:
        pairs = [[f"{k}/4 + i/3", f"{k}/4 - i/3"] for k in range(-3, 1)]
        real = [[f"{k}/3"] for k in range(-2, 1)] if dt else [[f"{k}"] for k in range(-3, 0)]
        found: list[str] = []
        while len(found) < count:
            found += chance.choice(pairs if count - len(found) > 1 and chance.random() < 0.3 else real)
        return found

    C = [[int(i == j) for j in range(p)] + row for i, row in enumerate(matrix(p, n - p))]
    D = None if task == "margins" or chance.random() < 0.5 else matrix(p, m)
    plant = symobs.StateSpace(matrix(n, n), matrix(n, m), C, D, dt=dt)
    S = chance.choice([[[0]], [[1]], [[0, 1], [-1, 0]]])
    E = matrix(n, 1 if task in {"disturbance_observer", "unknown_input_observer"} else len(S))
    Q = matrix(n, n)
    own: dict[str, dict[str, Any]] = {
        "compensator": {"observer": chance.choice(["full", "minimal"])},
        "disturbance_observer": {"E": E, "S": S[:1] if len(S) == 1 else [[0]]},
        "unknown_input_observer": {"E": E},
        "output_regulation": {"S": S, "reference": matrix(p, len(S)), "E": E},
        "lyapunov": {"Q": [[Q[min(i, j)][max(i, j)] for j in range(n)] for i in range(n)]},
        "minimum_energy_input": {"initial": matrix(n, 1), "final": matrix(n, 1), "horizon": chance.randint(1, 3)},
        "margins": {"controller": f"{chance.randint(-4, 4)}/({'z' if dt else 's'} + 1/{chance.randint(2, 5)})"},
        "gramian": {"horizon": n, "of": chance.choice(["observability", "controllability"])},
        "response": {"input": chance.choice(["1", "t*exp(-t)", "cos(2*t)"]).split() * m, "initial": matrix(n, 1)},
        "zero_order_hold": {"sampling_period": "1/2"},
    }
    asked = own.get(task, {})
    for keyword in ("poles", "control_poles", "observer_poles"):
        if keyword in tasks()[task].keywords and task != "margins":
            asked[keyword] = poles(tasks()[task].degree(keyword, plant, asked))
    return plant, asked


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("seed", seeds(4))
def test_the_answer_to_a_random_problem_meets_its_claim(task: str, seed: int) -> None:
    plant, asked = drawn(task, random.Random(f"{task} {seed}"))  # noqa: S311 - repeats
    result = getattr(symobs, task)(plant, **asked)
    assert result.verdict in {"yes", "no"}
    HOLDS[task](result, Setting.of(plant, asked, {}))


@pytest.mark.parametrize("seed", seeds(8))
def test_a_feedforward_of_the_state_gives_unit_dc_gain(seed: int) -> None:
    """(C − DK)(sI − A + BK)⁻¹BF + DF = I at s = 0, in discrete time at 1, for a K that is given."""
    chance = random.Random(seed)  # noqa: S311 - repeats
    plant, _ = drawn("observer", chance)
    K = [[Fraction(chance.randint(-2, 2)) for _ in range(plant.order)] for _ in range(plant.inputs)]
    found = symobs.feedforward(plant, K=K)
    at = Setting.of(plant, {}, {})
    closed, seen, rest = (
        subtract(at.A, multiply(at.B, K)),
        subtract(at.C, multiply(at.D, K)),
        Fraction(int(at.discrete)),
    )
    moves = determinant(subtract(times(rest, identity(plant.order)), closed))
    gain = plus(response(closed, at.B, seen, rest), at.D) if moves else []
    if found.verdict == "no":
        assert not gain or not determinant(multiply(gain, transposed(gain)))
        return
    F = found.answer["F"] if isinstance(found.answer["F"], Matrix) else Matrix.of([[found.answer["F"]]])
    assert multiply(gain, matrix_at(F, {})) == identity(plant.outputs)
