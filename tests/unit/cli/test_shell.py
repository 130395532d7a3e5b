"""What a shell and a terminal are given: examples, choices, completion, progress, interruption, repairs."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.cli.shared import common
from symobs.ground.errors import InputError, UsageError
from symobs.system.specification import CHOICES
from symobs.tasks.result import tasks
from tests.kit import SERVO, tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import environment, inside

if TYPE_CHECKING:
    from pathlib import Path

PLANT = ("--A", "[0 1; 0 -1]", "--B", "[0; 1]", "--C", "[1 0]")
EXAMPLES = sorted(path.stem for path in (ROOT / "worked_examples").glob("*.toml"))


# -- worked examples --------------------------------------------------------------------------------------------------


def test_examples_are_listed_printed_and_copied(tmp_path: Path) -> None:
    assert [line.split()[0] for line in inside("examples").out.splitlines()] == EXAMPLES
    source = (ROOT / "worked_examples" / "servo_observer.toml").read_text("utf-8")
    assert inside("examples", "servo_observer").out == inside("examples", "servo_observer.toml").out == source
    folder = tmp_path / "mine"
    assert inside("examples", "servo_observer", "--copy", str(folder)).code == 0
    assert [path.read_text("utf-8") for path in folder.iterdir()] == [source]
    again = inside("examples", "--copy", str(folder))
    assert (again.code, len(list(folder.iterdir()))) == (3, 1)
    assert "servo_observer.toml is already there" in again.err
    assert inside("examples", "--copy", str(tmp_path / "all")).code == 0
    assert sorted(path.stem for path in (tmp_path / "all").iterdir()) == EXAMPLES


# -- choices ----------------------------------------------------------------------------------------------------------


@tabled
def test_choices_are_those_that_the_task_takes(task: str, name: str) -> None:
    """No word of the table is refused as a word, and one outside of it is."""
    plant = SERVO
    for word in CHOICES[name]:
        assert f"{word!r} is no" not in reason_of(task, plant, name, word)
    assert "'other' is no" in reason_of(task, plant, name, "other")


def reason_of(task: str, plant: symobs.StateSpace, name: str, word: str) -> str:
    """What is said where a task refuses a word, or nothing."""
    try:
        tasks()[task].function(plant, **{name: word})
    except InputError as error:
        return str(error)
    return ""


# -- completion -------------------------------------------------------------------------------------------------------


@tabled
def test_the_shell_completes(words: list[str], completed: list[str]) -> None:
    asked = {"_SYMOBS_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    run = subprocess.run(
        [sys.executable, "-m", "symobs"], env=environment() | asked, capture_output=True, text=True, check=False
    )
    assert run.stdout.splitlines() == completed, run.stderr


# -- repairs ----------------------------------------------------------------------------------------------------------


@tabled
def test_what_is_wrong_with_an_option_is_said_with_its_repair(arguments: list[str], said: str) -> None:
    run = inside("observer", *PLANT, *arguments)
    assert run.code in {2, 3}
    assert said in run.err


@tabled
def test_the_variable_of_the_other_time_is_said(arguments: list[str], said: str) -> None:
    assert said in inside("observer", "--poles", "0", "--transfer-function", *arguments).err


@tabled
def test_what_is_wrong_in_a_file_is_said_with_its_repair(text: str, said: str) -> None:
    assert said in inside("solve", "-", stdin=text.encode()).err


# -- a terminal -------------------------------------------------------------------------------------------------------


class _Timer:
    """A timer that fires when told to."""

    last: Any = None

    def __init__(self, seconds: float, with_findings: object) -> None:
        assert seconds == 2.0
        self.with_findings, self.waits, _Timer.last = with_findings, True, self

    def start(self) -> None:
        pass

    def is_alive(self) -> bool:
        return self.waits


@pytest.mark.parametrize("is_terminal", [True, False])
def test_progress_is_told_after_two_seconds_on_a_terminal(
    *, is_terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(threading, "Timer", _Timer)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal)
    reached: list[object] = []
    told = common.progress_on_terminal(reached.append)
    told("observability")
    told("observer")
    assert capsys.readouterr().err == ""
    if is_terminal:
        _Timer.last.waits = False
        _Timer.last.with_findings()
        told("the page")
        assert capsys.readouterr().err == "observer …\nthe page …\n"
    assert reached[:2] == ["observability", "observer"]


LONG = """
import flint, sys
from symobs.__main__ import main
from symobs.cli.commands import solve
def long(*_):
    print("begun", file=sys.stderr, flush=True)
    flint.fmpz.fac_ui(10**9)
solve.read_file = long
sys.argv = ["symobs", "solve", "x.toml"]
main()
"""


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="there is no terminal here")
def test_an_interruption_on_a_terminal_ends_a_call_into_flint() -> None:
    mine, theirs = os.openpty()
    with subprocess.Popen([sys.executable, "-c", LONG], stderr=theirs, env=environment(), cwd=ROOT) as run:
        os.close(theirs)
        assert b"begun" in os.read(mine, 100)
        run.send_signal(signal.SIGINT)
        assert run.wait() == 130
        assert b"interrupted" in os.read(mine, 100)
    os.close(mine)


# -- time and memory in Python ----------------------------------------------------------------------------------------


@tabled
def test_bounds_that_are_none_are_refused(bound: dict[str, float]) -> None:
    with pytest.raises(UsageError, match="is not a positive number; write for example"):
        symobs.bounded(lambda: 1, **bound)
