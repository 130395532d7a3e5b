"""Budgets of time and memory, and ends that come from outside: what is said, what is left behind, what goes on."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from symobs.cli.shared.time_and_memory import within
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import OutOfBudget
from symobs.tasks.result import registry
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import SAFETY, SERVO, environment, inside
from tests.unit.pages.test_pdf import ends, program

if TYPE_CHECKING:
    from collections.abc import Callable

pytestmark = pytest.mark.slow

NOT_OBSERVABLE = 'task = "observability"\n[plant]\nA = "[1 0; 0 1]"\nC = "[1 0]"\n'
ORDER = 6
NAMES = [f"a{row}{column}" for row in range(ORDER) for column in range(ORDER)]
OUTPUTS, POLES = ([f"{letter}{place}" for place in range(ORDER)] for letter in "cp")
#: 48 symbols, and an answer of more terms than any machine holds.
GENERIC = "".join(
    [
        'title = "All of sixth order"\ntask = "observer"\n[symbols]\n',
        *(f'{name} = "real"\n' for name in NAMES + OUTPUTS + POLES),
        f'[plant]\nA = "[{"; ".join(" ".join(NAMES[row * ORDER : (row + 1) * ORDER]) for row in range(ORDER))}]"\n',
        f'C = "[{" ".join(OUTPUTS)}]"\n[specification]\npoles = "{", ".join(POLES)}"\n',
    ]
)
LARGE = 200
#: A dense plant of numbers: minutes inside the kernel, call by call.
ROWS = [[(row * row + 7 * column * row + column) % 97 for column in range(LARGE)] for row in range(LARGE)]
NUMERIC = (
    f'task = "observer"\n[plant]\nA = {ROWS}\nC = {[[1] * LARGE]}\n'
    f"[specification]\npoles = {[-place for place in range(1, LARGE + 1)]}\n"
)
LONG = 1000.0  # seconds; never waited for


@pytest.fixture(name="hard")
def hard_problem(tmp_path: Path) -> Path:
    """A problem that does not come to an end."""
    path = tmp_path / "hard.toml"
    path.write_text(GENERIC, "utf-8")
    return path


# -- a budget that is enough changes nothing --------------------------------------------------------------------------


@tabled
def test_a_budget_that_is_enough_changes_nothing(arguments: list[str]) -> None:
    without = inside(*arguments, stdin=NOT_OBSERVABLE.encode())
    assert inside(*arguments, "--timeout", f"{LONG:g}", "--memory", "4000", stdin=NOT_OBSERVABLE.encode()) == without


@pytest.mark.parametrize("option", ["--timeout", "--memory"])
@tabled
def test_what_is_no_budget_is_2(option: str, amount: str) -> None:
    run = inside("solve", str(SERVO), option, amount)
    assert (run.code, run.out) == (2, "")
    expected = "a positive number of seconds" if option == "--timeout" else "a number of megabytes, 64 or more"
    assert run.err.startswith(f'{option}: "{amount}" is not {expected}; write for example {option} ')


# -- a budget that is not enough --------------------------------------------------------------------------------------


def deaf(with_findings: Callable[[object], None]) -> None:
    """Work that hears no signal, as a call into the kernel."""
    with_findings("observer")
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM, signal.SIGINT})
    time.sleep(LONG)


def test_work_that_hears_no_alarm_is_ended() -> None:
    with pytest.raises(OutOfBudget) as caught:
        within(Budget(0.3), deaf, "problem.toml")
    assert str(caught.value) == (
        "problem.toml: undecided: 0.3 seconds were not enough, at work on observer; "
        "give more with --timeout, ask for less, or put numbers in place of symbols"
    )
    assert caught.value.exit_code == 5


def test_work_that_hears_the_alarm_leaves_in_order(tmp_path: Path) -> None:
    def work(_: object) -> None:
        try:
            time.sleep(LONG)
        except Exception:  # noqa: BLE001 - the alarm is no error of the work
            (tmp_path / "swallowed").touch()
        finally:
            (tmp_path / "put away").touch()

    with pytest.raises(OutOfBudget, match=r"^undecided: 0\.3 seconds"):
        within(Budget(0.3), work)
    assert [path.name for path in tmp_path.iterdir()] == ["put away"]


@pytest.mark.parametrize("number", [signal.SIGABRT, signal.SIGSEGV])
def test_a_kernel_that_aborts_has_no_memory_where_that_is_bounded(number: int) -> None:
    def work(_: object) -> None:
        signal.signal(number, signal.SIG_DFL)  # pytest would tell of it
        os.kill(os.getpid(), number)
        time.sleep(LONG)

    with pytest.raises(OutOfBudget, match=r"^undecided: 500 MB of memory were not enough; give more with --memory"):
        within(Budget(LONG, 500), work)
    with pytest.raises(RuntimeError, match=r"the computation ended with SIG(ABRT|SEGV)"):
        within(Budget(LONG), work)


def test_memory_that_is_refused_is_told_as_such() -> None:
    def work(with_findings: Callable[[object], None]) -> int:
        with_findings("it")
        return len(bytearray(1 << 30))

    (data,) = re.findall(r"VmData:\s+(\d+) kB", Path("/proc/self/status").read_text("utf-8"))
    most = 300 + int(data) // 1024  # the child begins with the data of this process
    with pytest.raises(OutOfBudget, match=f"{most} MB of memory were not enough, at work on it"):
        within(Budget(None, most), work)
    assert within(Budget(None, most), lambda _: len(bytes(1 << 20))) == 1 << 20


def test_an_error_of_ours_stays_one() -> None:
    class OfItsOwnError(Exception):
        """One that cannot be pickled."""

        def __init__(self, first: int, second: int) -> None:
            super().__init__(f"{first}, {second}")

    def work(error: Exception) -> Callable[[object], None]:
        def raising(_: object) -> None:
            raise error

        return raising

    with pytest.raises(KeyError, match="x"):
        within(Budget(LONG), work(KeyError("x")))
    with pytest.raises(RuntimeError, match="OfItsOwnError: 1, 2"):
        within(Budget(LONG, 500), work(OfItsOwnError(1, 2)))


@pytest.mark.parametrize(
    ("text", "option", "amount", "said"),
    [
        (GENERIC, "--timeout", "2", "2 seconds were not enough"),
        (GENERIC, "--memory", "300", "300 MB of memory were not enough"),
        (NUMERIC, "--timeout", "2", "2 seconds were not enough"),
    ],
    ids=["generic in time", "generic in memory", "numbers in time"],
)
def test_hostile_problems_end_undecided(text: str, option: str, amount: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "hard.toml").write_text(text, "utf-8")
    (tmp_path / "page.tex").write_text("before", "utf-8")
    run = unbounded("solve", "hard.toml", "-o", "page.tex", option, amount, folder=tmp_path)
    assert run[0] == 5
    assert re.match(f"hard.toml: undecided: {said}(, at work on observer)?; give more with {option}, ", run[1])
    assert run[1].count("\n") == 1
    assert (tmp_path / "page.tex").read_text("utf-8") == "before"
    assert {path.name for path in tmp_path.iterdir()} == {"hard.toml", "page.tex"}


THREE_TASKS = (
    NOT_OBSERVABLE.replace('task = "observability"', 'tasks = ["observability", "observer", "detectability"]')
    + '[specification]\npoles = "-1, -2"\n'
)


@pytest.fixture
def slow_observer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the time be over in the second of the three tasks."""

    def slow(*_: object, **__: object) -> Any:
        os.kill(os.getpid(), signal.SIGALRM)

    monkeypatch.setitem(registry._TASKS, "observer", replace(registry.tasks()["observer"], function=slow))


@pytest.mark.usefixtures("slow_observer")
@tabled
def test_a_page_keeps_the_tasks_that_were_finished(form: str) -> None:
    alone = inside("solve", "-", "--format", form, stdin=NOT_OBSERVABLE.encode()).out
    run = inside("solve", "-", "--format", form, "--timeout", f"{LONG:g}", stdin=THREE_TASKS.encode())
    assert run.code == 5
    assert "at work on observer; " in run.err
    assert run.out.splitlines()[-5:] == alone.splitlines()[-5:]
    assert "detectab" not in run.out


def unbounded(*arguments: str, folder: Path, **more: str) -> tuple[int, str]:
    """Exit code and messages of a run in a process of its own."""
    run = subprocess.run(
        [sys.executable, "-m", "symobs", *arguments],
        cwd=folder,
        env=environment() | more,
        capture_output=True,
        text=True,
        timeout=SAFETY,
        check=False,
    )
    assert run.stdout == ""
    return run.returncode, run.stderr


def test_a_problem_that_takes_too_much_keeps_its_place_with_its_question(hard: Path) -> None:
    run = inside("sheet", str(SERVO), str(hard), str(SERVO), "--timeout", "20", "--format", "json")
    assert run.code == 5
    assert run.err.startswith(f"{hard}: undecided: 20 seconds were not enough; give more with --timeout")
    assert run.err.count("\n") == 1
    first, second, third = json.loads(run.out)["problems"]
    assert first["results"] == third["results"]
    assert first["results"][0]["verdict"] == "yes"
    assert (second["results"], second["title"]) == (None, "All of sixth order")
    assert "Design an observer" in second["question"]
    assert second["failure"] == "This problem could not be solved within the time or memory allowed."


def hanging_tex(folder: Path) -> Path:
    """Put a TeX that hangs into a folder; the file returned has the number of the process it started."""
    number = folder / "number"
    for name in ("pdflatex", "latexmk"):
        program(folder / name, f"sleep 1000 &\necho $! > {number}.part\nmv {number}.part {number}\nwait")
    return number


# -- Ctrl-C and its kin -----------------------------------------------------------------------------------------------

INTERRUPTIBLE = """
import runpy, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs begin with it ignored
sys.argv[0] = "symobs"
runpy.run_module("symobs", run_name="__main__", alter_sys=True)
"""


def signalled(
    number: int, ready: Callable[[], object], *arguments: str, folder: Path, **more: str
) -> tuple[int, str, str]:
    """Run symobs, send it a signal once it is ready for that, and return what is left of it; the alarm is its child's."""
    with subprocess.Popen(
        [sys.executable, "-c", INTERRUPTIBLE, *arguments],
        cwd=folder,
        env=environment() | more,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            waited = time.monotonic() + SAFETY
            while not ready():
                assert process.poll() is None, process.communicate()
                assert time.monotonic() < waited
                time.sleep(0.02)
            os.kill(child_of(process.pid) if number == signal.SIGALRM else process.pid, number)
            out, err = process.communicate(timeout=SAFETY)
        finally:
            process.kill()
    return process.returncode, out, err


@tabled
def test_ctrl_c_while_computing(budget: list[str], tmp_path: Path) -> None:
    pipe, target = tmp_path / "problem.toml", tmp_path / "page.tex"
    os.mkfifo(pipe)
    target.write_text("before", "utf-8")
    given: list[Any] = []

    def ready() -> bool:
        """Hand over the problem once somebody reads it, and give the work a moment to be under way."""
        if given:
            return bool(time.monotonic() > given[0] + 2)
        try:
            opened = os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
        except OSError:
            return False
        with os.fdopen(opened, "wb") as stream:
            stream.write(GENERIC.encode())
        given.append(time.monotonic())
        return False

    left = signalled(signal.SIGINT, ready, "solve", str(pipe), "-o", str(target), *budget, folder=tmp_path)
    assert left == (130, "", "interrupted\n")
    assert target.read_text("utf-8") == "before"
    assert {path.name for path in tmp_path.iterdir()} == {"problem.toml", "page.tex"}


@tabled
def test_ctrl_c_while_writing(budget: list[str], tmp_path: Path) -> None:
    """The page is complete and waits for the picture, whose place is a pipe that nobody reads."""
    region, target, picture = ROOT / "worked_examples" / "region_nonconvex.toml", "page.tex", tmp_path / "picture.svg"
    (tmp_path / target).write_text("before", "utf-8")
    os.mkfifo(picture)
    arguments = ["solve", str(region), "-o", target, "--plot", str(picture), *budget]
    left = signalled(signal.SIGINT, lambda: any(tmp_path.glob(".symobs-*")), *arguments, folder=tmp_path)
    assert left == (130, "", "interrupted\n")
    assert (tmp_path / target).read_text("utf-8") == "before"
    assert {path.name for path in tmp_path.iterdir()} == {target, "picture.svg"}


@pytest.mark.parametrize("budget", [[], ["--timeout", "900"]], ids=["free", "bounded"])
@pytest.mark.parametrize(
    ("number", "code", "said"), [(signal.SIGINT, 130, "interrupted\n"), (signal.SIGTERM, 143, "")], ids=["INT", "TERM"]
)
def test_an_end_while_tex_runs_ends_tex(number: int, code: int, said: str, budget: list[str], tmp_path: Path) -> None:
    started = hanging_tex(tmp_path)
    (tmp_path / "page.pdf").write_text("before", "utf-8")
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    more = {"PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "TMPDIR": str(temporary)}
    arguments = ["solve", str(SERVO), "-o", "page.pdf", *budget]
    left = signalled(number, started.exists, *arguments, folder=tmp_path, **more)
    assert left == (code, "", said)
    assert ends(int(started.read_text("utf-8")))
    assert (tmp_path / "page.pdf").read_text("utf-8") == "before"
    assert not any(temporary.iterdir())


def child_of(parent: int) -> int:
    """Number of the only child of a process."""
    (number,) = Path(f"/proc/{parent}/task/{parent}/children").read_text("utf-8").split()
    return int(number)


def test_the_alarm_in_tex_is_tex_s(tmp_path: Path) -> None:
    started = hanging_tex(tmp_path)
    (tmp_path / "page.pdf").write_text("before", "utf-8")
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    arguments = ["solve", str(SERVO), "-o", "page.pdf", "--timeout", "900"]
    left = signalled(signal.SIGALRM, started.exists, *arguments, folder=tmp_path, PATH=path)
    assert left == (
        6,
        "",
        "TeX was stopped: 900 seconds were over; give more with --timeout, or write LaTeX with --format latex\n",
    )
    assert ends(int(started.read_text("utf-8")))
    assert (tmp_path / "page.pdf").read_text("utf-8") == "before"


def test_a_computation_does_not_outlive_its_command(tmp_path: Path) -> None:
    number = tmp_path / "number"
    code = f"""
import os, signal, time
signal.signal(signal.SIGINT, signal.default_int_handler)
from symobs import cli
from symobs.ground.child_processes.budget import Budget
from symobs.cli.shared.time_and_memory import within
def deaf(tell):
    signal.pthread_sigmask(signal.SIG_BLOCK, {{signal.SIGALRM, signal.SIGINT, signal.SIGTERM}})
    open({str(number)!r} + ".part", "w").write(str(os.getpid()))
    os.rename({str(number)!r} + ".part", {str(number)!r})
    time.sleep({LONG})
within(Budget({LONG}), deaf)
"""
    with subprocess.Popen([sys.executable, "-c", code], env=environment(), stderr=subprocess.DEVNULL) as process:
        try:
            waited = time.monotonic() + SAFETY
            while not number.exists() and time.monotonic() < waited:
                time.sleep(0.02)
            process.terminate()
            assert process.wait(SAFETY) == 143
        finally:
            process.kill()
    assert ends(int(number.read_text("utf-8")))
