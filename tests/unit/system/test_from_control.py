"""Plants that come from python-control: floats as their shortest decimals, and the page says so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import SERVO, text_of


def test_the_page_says_what_was_read() -> None:
    plant = StateSpace.from_control(control.ss([[0, 1], [0, -1]], [[0], [1]], [[1, 0]], [[0]]))
    sentence = "shortest decimals that represent them"
    assert sentence in text_of(symobs.observer(plant, poles=[-10, -10]))
    exact = SERVO
    assert sentence not in text_of(symobs.observer(exact, poles=[-10, -10]))


@pytest.mark.parametrize(
    "system",
    [
        SimpleNamespace(A=np.array([[np.nan]]), B=np.array([[1.0]]), C=np.array([[1.0]]), D=np.array([[0.0]]), dt=0),
        SimpleNamespace(A=np.array([[1j]]), B=np.array([[1.0]]), C=np.array([[1.0]]), D=np.array([[0.0]]), dt=0),
    ],
)
def test_what_is_no_system_of_finite_numbers_is_refused(system: Any) -> None:
    with pytest.raises(InputError) as caught:
        StateSpace.from_control(system)
    assert caught.value.where == "plant.A"
    assert caught.value.repair
