"""Nearest doubles, sampling, proofs of stability and the bound of the deviation, beside mpmath, SciPy and NumPy."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
from scipy import signal  # type: ignore[import-untyped]

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import square_root
from symobs.exact.floating.margin_search import disc_margin, half_plane_margin
from symobs.exact.floating.sampled import HOLDS, Sampled, nearest_double
from symobs.exact.floating.stability_margin import deviation, loop_matrix, own_matrix
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.formula.expression import parse_scalar
from symobs.ground.errors import InputError
from tests.kit import tabled


def matrix(rows: Any) -> Matrix:
    return Matrix.of([[Scalar.of(Fraction(entry)) for entry in row] for row in rows])


def floats(exact: Matrix) -> Any:
    return np.array([[float(entry.fraction()) for entry in row] for row in exact.rows]).reshape(exact.shape)


def drawn(chosen: random.Random, rows: int, columns: int) -> Matrix:
    return matrix(
        [[Fraction(chosen.randint(-30, 30), chosen.randint(1, 9)) for _ in range(columns)] for _ in range(rows)]
    )


def test_the_nearest_double_of_irrational_numbers() -> None:
    with mpmath.workprec(53):  # mpmath rounds its results correctly
        for number in (2, 3, 5, 7, 10**40 + 1):
            assert nearest_double(square_root(Scalar.of(number))) == float(mpmath.sqrt(number))
    assert nearest_double(Scalar.rational(1, 3)) == 1 / 3
    with pytest.raises(ValueError, match="no number"):
        nearest_double(Scalar.symbol("k"))
    with pytest.raises(InputError, match="larger than any"):
        nearest_double(Scalar.of(10**400))


@pytest.mark.parametrize("hold", HOLDS)
def test_sampling_as_scipy_does(hold: str) -> None:
    chosen = random.Random(7)  # noqa: S311 - a seeded draw
    for order in (1, 2, 3, 4):
        system = Realisation(*(drawn(chosen, *s) for s in ((order, order), (order, 2), (3, order), (3, 2))))
        found = Sampled(system, Fraction(1, 50), hold).rounded()
        kind = {"zoh": "zoh", "tustin": "bilinear"}[hold]
        expected = signal.cont2discrete([floats(part) for part in system], 1 / 50, kind)[:4]
        for own, other in zip(found, expected, strict=True):
            np.testing.assert_allclose(floats(own), other, rtol=1e-11, atol=1e-13)


def test_margins_are_below_those_of_the_eigenvalues_and_near_them() -> None:
    chosen, told = random.Random(3), [0, 0]  # noqa: S311 - a seeded draw
    for _ in range(40):
        order = chosen.randint(1, 6)
        A = matrix([[Fraction(chosen.randint(-9, 9), 10) for _ in range(order)] for _ in range(order)])
        system = Realisation(A, drawn(chosen, order, 1), drawn(chosen, 1, order), matrix([[0]]))
        eigenvalues = np.linalg.eigvals(floats(A))
        for margin, true in (
            (disc_margin(own_matrix(system)), 1 - max(abs(eigenvalues))),
            (half_plane_margin(own_matrix(system)), -max(eigenvalues.real)),
        ):
            told[margin is not None] += 1
            assert (margin is None) == (true <= 0)
            assert margin is None or 0.98 * true - 1e-9 <= float(margin) <= true + 1e-9
    assert min(told) > 10


@tabled
def test_a_root_on_or_barely_beyond_the_circle_is_not_proved(number: str) -> None:
    value = parse_scalar(number, {}, where="").fraction()
    beyond = Realisation(matrix([[value]]), *(matrix([[1]]),) * 3)
    assert disc_margin(own_matrix(beyond)) is None


def test_planted_bad_roundings_are_refused() -> None:
    """A servo, its compensator in doubles, and the same numbers rounded to fewer bits, or one digit of them changed."""
    plant = Realisation(matrix([[0, 1], [0, 0]]), matrix([[0], [1]]), matrix([[1, 0]]), matrix([[0]]))
    exact = Realisation(matrix([[-19, 1], [-85, -4]]), matrix([[19], [81]]), matrix([[-4, -4]]), matrix([[0]]))
    period = Fraction(1, 200)
    rounded = Sampled(exact, period).rounded()
    margin = disc_margin(loop_matrix(plant, period, rounded))
    assert margin is not None
    refused = 0
    for part in "ABC":
        own = getattr(rounded, part)
        for index, entry in enumerate(own.entries):
            for wrong in (-entry, entry * 10, entry + 1, Scalar.of(round(entry.fraction() * 4) * Fraction(1, 4))):
                entries = [wrong if k == index else other for k, other in enumerate(own.entries)]
                width = own.shape[1]
                rows = [entries[k : k + width] for k in range(0, len(entries), width)]
                planted = rounded._replace(**{part: Matrix.of(rows, width)})
                proved = disc_margin(loop_matrix(plant, period, planted))
                A, B, C, _ = (floats(piece) for piece in planted)
                Phi, Gamma = np.array([[1, 1 / 200], [0, 1]]), np.array([[1 / 80000], [1 / 200]])
                whole = np.block([[Phi, Gamma @ C], [B @ floats(plant.C), A]])
                assert (proved is None) == (max(abs(np.linalg.eigvals(whole))) >= 1)
                refused += proved is None
    assert refused > 15


def test_the_deviation_grows_where_the_system_is_unstable_and_has_no_bound_where_it_explodes() -> None:
    def of(number: Fraction) -> Any:
        system = Realisation(*(matrix([[entry]]) for entry in (number, Fraction(1, 3), 1, 0)))
        sampled = Sampled(system)
        return deviation(sampled, sampled.rounded())

    stable, slow, explosive = of(Fraction(1, 3)), of(Fraction(1001, 1000)), of(Fraction(3))
    assert stable.always
    assert not slow.always
    assert slow.state > 1000 * stable.state
    assert explosive is None
