"""The benchmark of designs: FLINT alone and symobs do the same work.  No time is tested."""

from __future__ import annotations

from fractions import Fraction

import pytest

import symobs
from symobs.exact import Scalar
from tests.programs.benchmarks import models, raw_design

pytestmark = pytest.mark.slow


def test_flint_alone_finds_the_compensator_of_the_cart_pole() -> None:
    model = models.cart_pole()
    _, (above, below) = raw_design.cart_pole(model)
    plant = symobs.StateSpace(model.A, model.B, model.C)
    poles = list(model.control_poles), list(model.observer_poles)
    found = symobs.compensator(plant, control_poles=poles[0], observer_poles=poles[1]).answer["F"]
    for shift in (2, 5):
        point = {name: k + shift for k, name in enumerate(model.plain.values())}
        values = {fresh: Scalar.of(point[plain]) for fresh, plain in model.plain.items()}
        own = found.substitute(values | {"s": Scalar.of(7)}).fraction()
        assert own == Fraction(int(above(*point.values(), 7)), int(below(*point.values(), 7)))


def test_flint_alone_finds_the_gains_of_a_plant_with_numbers() -> None:
    assert all(time > 0 for time in raw_design.numeric(4))
