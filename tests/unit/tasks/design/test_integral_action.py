"""Integral action held to python-control: poles, DC gain from r to y, and the exact condition."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

import control  # type: ignore[import-untyped]
import numpy as np
import pytest
import sympy

import symobs
from symobs.exact import Matrix
from symobs.ground.errors import CertificateRejected, DerivationRejected
from tests.kit import SERVO, tabled, text_of

if TYPE_CHECKING:
    from symobs.tasks.design.reference.integral_action import IntegralAction


def plant_of(seed: int) -> symobs.StateSpace:
    random = Random(seed)  # noqa: S311 - test data
    n, p = random.choice([(1, 1), (2, 1), (3, 1), (2, 2)])
    m = p + random.choice([0, 0, 1])

    def drawn(rows: int, columns: int) -> list[list[int]]:
        return [[random.randint(-3, 3) for _ in range(columns)] for _ in range(rows)]

    D = drawn(p, m) if random.random() < 0.5 else [[0] * m for _ in range(p)]
    return symobs.StateSpace(drawn(n, n), drawn(n, m), drawn(p, n), D, dt=random.random() < 0.5)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_poles_dc_gain_and_existence_are_those_of_other_systems(seed: int) -> None:
    plant = plant_of(seed)
    n, p = plant.order, plant.outputs
    poles = [sympy.Rational(-k, 10) for k in range(1, n + p + 1)]
    found = symobs.integral_action(plant, poles=poles)
    A, B, C, D = (np.array(part, dtype=float) for part in (plant.A, plant.B, plant.C, plant.D))
    first, own = (A - np.eye(n), np.eye(p)) if plant.is_discrete else (A, np.zeros((p, p)))
    full = np.linalg.matrix_rank(np.block([[first, B], [C, D]])) == n + p
    assert found.solvable == full
    controllable = np.linalg.matrix_rank(control.ctrb(A, B)) == n
    assert (found.verdict == "yes") == (full and controllable)
    if found.K is None:
        assert "no gains exist" in text_of(found)
        return
    K, k_I = (np.array(gain, dtype=float) for gain in (found.K, found.k_I))
    closed = np.block([[A - B @ K, B @ k_I], [D @ K - C, own - D @ k_I]])
    assert np.poly(closed) == pytest.approx(np.poly(np.array(poles, dtype=float)), rel=1e-6, abs=1e-6)
    loop = found.to_control()["servo"]
    assert control.dcgain(loop) == pytest.approx(np.eye(p) if p > 1 else 1, abs=1e-6)
    assert "as required" in found.to("text")


@tabled
def test_outputs_that_cannot_follow_are_a_no_even_with_the_fixed_pole_desired(A: str, C: str, dt: int) -> None:
    """The plant has a zero at the origin (at 1): k_I would be 0 and ξ grow without bound for r ≠ 0."""
    found = symobs.integral_action(symobs.StateSpace(A, "[0; 1]", C, dt=dt), poles=f"{int(dt)}, -1/2, 0")
    assert (found.verdict, found.K, found.k_I, found.solvable) == ("no", None, None, False)
    page = text_of(found)
    assert "cannot follow arbitrary constant references" in page
    assert "as required" not in page


def test_a_zero_at_the_origin_is_a_case_with_its_proof() -> None:
    design = symobs.integral_action(symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", "[c 1]"), poles="-1, -2, -3")
    c = sympy.Symbol("c")
    assert list(design.k_I) == [6 / c]
    ((conditions, there),) = design.cases
    assert conditions == (sympy.Eq(c, 0),) or str(conditions[0]) in {"c == 0", "Eq(c, 0)"}
    assert (there.verdict, there.solvable) == ("no", False)
    assert design.at(c=0).verdict == "no"
    assert list(design.at(c=2, a=1).k_I) == [3]


@pytest.mark.parametrize(
    ("name", "value"), [("K", Matrix.row([11, 6])), ("k_I", Matrix.row([7])), ("w", Matrix.row([1, 0, 0]))]
)
def test_a_wrong_answer_is_rejected(name: str, value: Matrix) -> None:
    design: IntegralAction = symobs.integral_action(SERVO, poles="-1, -2, -3")
    with pytest.raises((CertificateRejected, DerivationRejected)):
        design.with_answer(name, value)


@tabled
def test_the_error_at_rest_is_no_matter_of_stability_that_was_shown(poles: str, said: str) -> None:
    found = symobs.integral_action(SERVO, poles=poles)
    assert said in found.to("latex")
