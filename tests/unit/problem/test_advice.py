"""Advice: a message repairs what it says, leads to no other question's answer, and is not followed by its consequences."""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

import pytest
import sympy

from symobs.cli import main
from symobs.ground.errors import ProblemErrors
from symobs.problem import read
from tests.kit import tabled
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path


@tabled
def test_what_is_refused_is_refused_once_with_its_repair(text: str, where: str, says: str) -> None:
    with pytest.raises(ProblemErrors) as caught:
        read(text).solve()
    (error,) = caught.value.errors
    assert error.where.startswith(where)
    assert says in str(error)


@pytest.mark.parametrize("task", ["pbh", "gramian"])
def test_without_an_output_the_input_is_asked_about(task: str) -> None:
    """[A B; 0 1] of x1' = x2, x2' = -2 x1 - 3 x2 + u has B = [0; 1]: both modes are controllable, W = B B' at t = 0."""
    plant = '[plant]\nA = "[0 1; -2 -3]"\nB = "[0; 1]"\n'
    horizon = '[specification]\nhorizon = "inf"\n' if task == "gramian" else ""
    (result,) = read(f'task = "{task}"\n{plant}{horizon}').solve()
    if task == "pbh":
        assert [mode["controllable"] for mode in result.fields["modes"]] == [True, True]
    else:  # A W + W A' = -B B'
        A, B, W = sympy.Matrix([[0, 1], [-2, -3]]), sympy.Matrix([0, 1]), result.matrix
        assert A * W + W * A.T == -B * B.T
    with pytest.raises(ProblemErrors, match="needs C"):
        read(f'task = "{task}"\n{plant}[specification]\nof = "observability"\n').solve()


@pytest.mark.parametrize("horizon", ["inf", "oo", "infinity", "∞"])
def test_a_horizon_without_end_has_several_names(horizon: str) -> None:
    (result,) = read(
        f'task = "gramian"\n[plant]\nA = "-1"\nC = "1"\n[specification]\nhorizon = "{horizon}"\n'
    ).solve()  # ∫ e^{-2t} dt
    assert result.matrix == sympy.Matrix([[sympy.Rational(1, 2)]])


@pytest.mark.parametrize("written", ["[4 2]'", "[4 2]^T", "[4, 2]ᵀ", "[4 2]^{T}", "(4, 2)", "4, 2"])
def test_a_transpose_and_a_vector_are_read(written: str) -> None:
    text = f'task = "observer"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n[specification]\nL = "{written}"\n'
    (result,) = read(text).solve()
    assert sympy.Matrix([4, 2]) == result.L


def test_a_declared_t_is_no_transpose() -> None:
    plant = '[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    text = f'task = "observer"\n[symbols]\nT = "positive"\n{plant}[specification]\nL = "[4 2]^T"\n'
    with pytest.raises(ProblemErrors, match="a matrix stands inside an expression"):
        read(text).solve()


def test_several_grids_are_swept_together(tmp_path: Path) -> None:
    file = tmp_path / "plant.toml"
    file.write_text(
        'task = "state_feedback"\n[symbols]\nk = "positive"\nm = "positive"\n[plant]\nA = "[0 1; -k -m]"\nB = "[0; 1]"\n'
        '[specification]\npoles = "-1, -2"\n',
        "utf-8",
    )
    out = tmp_path / "table.csv"
    done = inside("sweep", str(file), "--over", "k=1:1:2", "--over", "m=[1,2,3]", "--out", str(out))
    assert done.code == 0
    assert len(out.read_text("utf-8").splitlines()) == 1 + 2 * 3
    twice = inside(
        "sweep", str(file), "--over", "k=1:1:2, m=[1]", "--over", "k=[1,2]", "--out", str(tmp_path / "other.csv")
    )
    assert twice.code == 3
    assert "k: it stands twice" in twice.err


def test_a_standard_output_of_text_alone_is_written_to(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = tmp_path / "plant.toml"
    file.write_text('task = "observability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n', "utf-8")
    out = io.StringIO()
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "argv", ["symobs", "solve", str(file), "--format", "text"])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 0
    assert "observable" in out.getvalue()
