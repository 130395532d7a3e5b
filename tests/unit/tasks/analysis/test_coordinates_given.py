"""The plant in given coordinates, against NumPy, and where there are none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symobs
from symobs.applications.checking import check
from symobs.ground.errors import InputError


def test_the_matrices_are_those_of_numpy() -> None:
    chance, seen = np.random.default_rng(3), 0
    while seen < 12:
        T, A = (chance.integers(-3, 4, (3, 3)) for _ in range(2))
        B, C = chance.integers(-3, 4, (3, 2)), chance.integers(-3, 4, (1, 3))
        if round(np.linalg.det(T)) == 0:
            continue
        seen += 1
        plant = symobs.StateSpace(A.tolist(), B.tolist(), C.tolist())
        found: Any = symobs.canonical_form(plant, T=T.tolist())
        back = np.linalg.inv(T)
        for ours, theirs in ((found.A, T @ A @ back), (found.B, T @ B), (found.C, C @ back)):
            assert np.array(ours.tolist(), dtype=float) == pytest.approx(theirs)
        assert symobs.observability(found).rank == symobs.observability(plant).rank
        assert "In the coordinates T x" in found.to("text")


def test_letters_say_where_there_is_an_inverse() -> None:
    found: Any = symobs.canonical_form(symobs.StateSpace("[0 1; -2 -3]"), T="[a 1; 0 1]")
    assert [str(each) for each in found.conditions] == ["Ne(a, 0)"]
    assert found.at(a=2).A.tolist() == [[-1, 0], [-1, -2]]  # T A T⁻¹ by hand


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"T": "[1 1; 1 1]"}, "no inverse"),
        ({"T": "[1 0; 0 1]", "kind": "modal"}, "both T and kind"),
        ({"T": "[1 2 3]"}, "expected 2×2"),
    ],
)
def test_what_are_no_coordinates_is_refused(asked: dict[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.canonical_form(symobs.StateSpace("[0 1; -2 -3]"), **asked)


def test_what_is_asked_and_marked_are_the_matrices() -> None:
    problem = 'task = "canonical_form"\n[plant]\nA = "[0 1; -2 -3]"\nC = "[1 0]"\n[specification]\nT = "[2 1; 1 1]"\n'
    assert check(problem, {"A": "[-1 0; 0 -2]", "C": "[1 -1]"}).verdict == "right"
    assert (
        check(problem, {"A": "[-2 0; 0 -1]", "C": "[-1 1]"}).verdict != "right"
    )  # the same plant in other coordinates
