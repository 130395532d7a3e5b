"""Systems of python-control: what they are, and that they are read back exactly."""

from __future__ import annotations

import random
import sys
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest

import symobs
from symobs.ground.errors import InputError, UsageError


def drawn(chosen: random.Random) -> Any:
    """A design of some kind for a random plant, with or without exact doubles, in continuous or discrete time."""
    n, m, p = chosen.randint(2, 4), chosen.randint(1, 2), 1

    def entries(rows: int, columns: int) -> list[list[str]]:
        return [
            [f"{chosen.randint(-9, 9)}/{chosen.choice([1, 2, 3, 7, 10])}" for _ in range(columns)] for _ in range(rows)
        ]

    D = entries(p, m) if chosen.random() < 0.3 else None
    dt = chosen.choice([0, 0, True, "1/10", "1/3"])
    C = [["1", *row[1:]] for row in entries(p, n)]
    plant = symobs.StateSpace(entries(n, n), entries(n, m), C, D, dt=dt)
    first, second = (", ".join(f"-{k}/{start}" for k in range(1, n + 1)) for start in (7, 11))
    match chosen.randint(0, 3):
        case 0:
            return symobs.compensator(plant, control_poles=first, observer_poles=second)
        case 1:
            return symobs.observer(plant, poles=second)
        case 2:
            return symobs.reduced_order_observer(plant, poles=second.rpartition(",")[0])
    return symobs.state_feedback(plant, poles=first)


@pytest.mark.parametrize("wanted", [15, pytest.param(100, marks=pytest.mark.slow)])
def test_random_designs_are_read_back_exactly(wanted: int) -> None:
    chosen, count = random.Random(wanted), 0  # noqa: S311 - a seeded draw
    while count < wanted:
        design = drawn(chosen)
        if design.verdict != "yes":
            continue
        count += 1
        for name, system in design.to_control().items():
            back = symobs.StateSpace.from_control(system)
            assert tuple(getattr(back.matrices, letter) for letter in "ABCD") == tuple(design.systems[name])
            assert back.dt == design.plant.dt
            for letter, matrix in zip("ABCD", design.systems[name], strict=True):
                doubles = [float(entry.fraction()) for entry in matrix.entries]
                assert getattr(system, letter).reshape(-1).tolist() == doubles
        assert symobs.StateSpace.from_control(design.to_control()["plant"]) == design.plant


def test_the_compensator_in_the_return_path_closes_the_loop() -> None:
    plant = symobs.StateSpace("[0 1; -2 -3/7]", "[0; 1]", "[1 1/3]", "[1/5]")
    for observer, poles in (("full", "-3, -4"), ("minimal", "-3")):
        design = symobs.compensator(plant, control_poles="-1, -2", observer_poles=poles, observer=observer)
        found = design.to_control()
        assert list(found) == ["plant", "observer", "compensator", "closed_loop"]
        loop = control.feedback(found["plant"], found["compensator"])
        for frequency in (0.1j, 1j, 7j):
            np.testing.assert_allclose(found["closed_loop"](frequency), loop(frequency), rtol=1e-9)
        expected = np.sort([-1, -2, *(float(pole) for pole in poles.split(","))])
        np.testing.assert_allclose(np.sort(found["closed_loop"].poles().real), expected, rtol=1e-6)


def test_refusals(monkeypatch: pytest.MonkeyPatch) -> None:
    plant = symobs.StateSpace("[0 1; -2 -k]", "[0; 1]", "[1 h]")
    result = symobs.observer(plant, poles="-1, -2")
    message = r"a system of python-control needs numbers, and h, k have no value; set them: --set h=1, or \.at\(h=1\)"
    with pytest.raises(InputError, match=message):
        result.to_control()
    with pytest.raises(InputError, match="larger than any floating-point number"):
        symobs.observability(symobs.StateSpace([[10**400]], [[1]], [[1]])).to_control()
    monkeypatch.setitem(sys.modules, "control", None)
    with pytest.raises(UsageError, match=r'not installed; pip install "symobs\[control\]"'):
        result.at(k=1, h=2).to_control()
