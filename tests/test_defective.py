"""A repeated pole is called defective where it is, and only there."""

from __future__ import annotations

import pytest

import symobs


def page(A: str, B: str, C: str, control: str, observer: str) -> str:
    design = symobs.compensator(symobs.StateSpace(A, B, C), control_poles=control, observer_poles=observer)
    return " ".join(str(design.to("text")).split())


def test_one_chain_of_eigenvectors() -> None:
    # 1/(s(s+1)(s+5)) with -1, -1, -2: one input leaves one eigenvector for -1.
    text = page("[0 1 0; 0 0 1; 0 -5 -6]", "[0; 0; 1]", "[1 0 0]", "-1, -1, -2", "-5, -6, -7")
    assert "The repeated pole -1 is defective, rank(A - B K + I) = 2, so" in text


@pytest.mark.parametrize(
    ("A", "B", "C", "control", "observer"),
    [
        ("[-2 0; 0 -2]", "[1; 0]", "[1 0]", "-2, -2", "-2, -2"),
        ("[-2 0 0; 0 -2 0; 0 0 1]", "[1; 0; 1]", "[1 0 1]", "-2, -2, -3", "-2, -5, -6"),
    ],
)
def test_a_mode_that_stays_may_have_an_eigenvector_of_its_own(
    A: str, B: str, C: str, control: str, observer: str
) -> None:
    # The input reaches one of two states with the eigenvalue -2; the other keeps its eigenvector.
    assert "defective" not in page(A, B, C, control, observer)
