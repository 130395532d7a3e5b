"""--set, [values], --print, --period and the formats of numbers and programs, as they are typed."""

from __future__ import annotations

import io
import json
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.kit import tabled
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

FILE = """
task = "compensator"
[symbols]
k = "positive"
[plant]
A = "[0 1; 0 -k]"
B = "[0; 1]"
C = "[1 0]"
[specification]
control_poles = "-2, -2"
observer_poles = "-10, -10"
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "servo.toml").write_text(FILE, "utf-8")
    return tmp_path


def test_print_writes_the_answers_alone(folder: Path) -> None:
    run = inside("solve", "servo.toml", "--print", "K,L", folder=folder)
    assert (run.code, run.out, run.err) == (0, "K = [4 -k+4]\nL = [-k+20; k**2-20*k+100]\n", "")


def test_print_of_an_answer_that_does_not_exist_says_why() -> None:
    """The mode 2 of diag(1, 2) with C = [1 0] is fixed, so -1, -2 cannot be assigned."""
    plant = ["--A", "[1 0; 0 2]", "--C", "[1 0]", "--poles=-1, -2"]
    run = inside("observer", *plant, "--print", "L,verdict", "--print", "conditions")
    assert (run.code, run.out) == (4, "L: none, verdict = no, fixed_modes = [2]\nverdict = no\nconditions = []\n")
    assert inside("observer", *plant, "--print", "L", "--format", "csv").code == 4
    modes = inside("detectability", "--A", "[0 1; 0 0]", "--C", "[0 0]", "--print", "verdict")
    assert (modes.code, modes.out) == (4, "verdict = no\n")
    run = inside("observer", "--A", "[0 1; 0 -a]", "--C", "[1 a]", "--poles=-1, -2", "--print", "conditions")
    assert (run.code, run.out) == (0, "conditions = [a + 1 != 0]\n")


def test_set_gives_values_exactly(folder: Path) -> None:
    run = inside("solve", "servo.toml", "--print", "K, L", "--set", "k=1/3", folder=folder)
    assert run.out == "K = [4 11/3]\nL = [59/3; 841/9]\n"
    found = json.loads(inside("solve", "servo.toml", "--set", "k=1", "--format", "json", folder=folder).out)["results"][
        0
    ]
    assert (found["K"], found["L"], found["symbols"]) == ([["4", "3"]], [["19"], ["81"]], {})
    assert found["decimals"]["L"] == [[19.0], [81.0]]
    task = inside("observer", "--A", "[0 1; -2 -k]", "--C", "[1 0]", "--poles=-3, -4", "--set", "k=1", "--print", "L")
    assert (task.code, task.out) == (0, "L = [6; 4]\n")


def test_the_numbers_alone(folder: Path) -> None:
    def printed(name: str, answers: str = "K,L") -> str:
        return inside("solve", "servo.toml", "--set", "k=1/3", "--print", answers, "--format", name, folder=folder).out

    assert printed("matlab") == "K = [4.0 3.6666666666666665];\nL = [19.666666666666668; 93.44444444444444];\n"
    np.testing.assert_array_equal(np.loadtxt(io.StringIO(printed("csv", "K")), delimiter=","), [4, 11 / 3])
    np.testing.assert_array_equal(np.loadtxt(io.StringIO(printed("csv", "L"))), [59 / 3, 841 / 9])
    assert printed("csv").splitlines() == [
        "# K",
        "4.0,3.6666666666666665",
        "# L",
        "19.666666666666668",
        "93.44444444444444",
    ]
    assert printed("numpy") == (
        "import numpy as np\n\nK = np.array([[4.0, 3.6666666666666665]])\n"
        "L = np.array([[19.666666666666668], [93.44444444444444]])\n"
    )
    whole = inside("solve", "servo.toml", "--set", "k=1/3", "--format", "numpy", folder=folder).out
    assert "closed_loop_matrix = np.array([[0.0, 1.0, 0.0, 0.0], [-4.0, -4.0," in whole


@tabled
def test_refusals(folder: Path, arguments: list[str], code: int, message: str) -> None:
    run = inside("solve", "servo.toml", *arguments, folder=folder)
    assert (run.code, run.out) == (code, "")
    assert message in run.err


@pytest.mark.parametrize("kind", ["numpy", "csv"])
@tabled
def test_a_table_of_numbers_that_would_be_empty_is_refused(folder: Path, kind: str, task: str, names: str) -> None:
    (folder / "step.toml").write_text(f'task = {task}\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n')
    run = inside("solve", "step.toml", "--format", kind, folder=folder)
    assert (run.code, run.out) == (3, "")
    assert f"needs numbers, and {names}; write --format text" in run.err


def test_a_gain_alone_says_that_its_loop_is_unstable() -> None:
    chain = ("state_feedback", "--A", "[0 1 0; 0 0 1; 0 0 0]", "--B", "[0; 0; 1]", "--print", "K")
    run = inside(*chain, "--poles=2, 3, 4")
    assert (run.code, run.out) == (0, "K = [-24 26 -9]\n")  # (s − 2)(s − 3)(s − 4)
    assert run.err.strip() == "state_feedback: Closed loop unstable: poles at 2, 3, 4"
    assert inside(*chain, "--poles=-2, -3, -4").err == ""
