"""What works without POSIX: everything but limits of time and memory, which say so.

The process has none of what other systems lack.  SIGKILL stays, since the standard library ends children with it here.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.kit import tabled, tables
from tests.support.paths import ROOT

_STRIPPED = """
import os, signal, sys
sys.modules |= dict.fromkeys(("resource", "fcntl", "pwd", "grp", "termios"))
for name in ("fork", "killpg", "getuid", "sysconf"):
    delattr(os, name)
for name in ("SIGBUS", "SIGHUP", "SIGALRM", "SIGVTALRM", "SIGQUIT", "SIG_BLOCK", "SIG_UNBLOCK", "ITIMER_REAL",
             "ITIMER_VIRTUAL", "setitimer", "alarm", "pthread_sigmask"):
    delattr(signal, name)
"""
_COMMAND = f"{_STRIPPED}\nfrom symobs.__main__ import main\nmain()"
_BOUNDED = f"{_STRIPPED}\nimport symobs\nsymobs.bounded(lambda: 1, timeout=3)"


def _run(program: str, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", program, *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300, check=False)


@pytest.mark.slow
@tabled
def test_a_command_works(words: str, wanted: str, tmp_path: Path) -> None:
    (tmp_path / "answer.txt").write_text("L = [19; 81]\n", "utf-8")
    (tmp_path / "plant.toml").write_text(tables(Path(__file__))["problem"]["text"], "utf-8")
    examples = ROOT / "worked_examples"
    done = _run(_COMMAND, tmp_path, *(word.format(examples=examples) for word in words.split(" ")))
    assert (done.returncode, "Traceback" in done.stderr) == (0, False), done.stderr
    assert wanted in done.stdout + done.stderr or (tmp_path / wanted).stat().st_size > 0


@tabled
def test_a_limit_is_refused(words: str, tmp_path: Path) -> None:
    done = _run(_COMMAND, tmp_path, "solve", str(ROOT / "worked_examples" / "servo_observer.toml"), *words.split())
    assert done.returncode == 2
    assert "this system cannot end a computation that is under way" in done.stderr


def test_a_limit_from_python_is_refused(tmp_path: Path) -> None:
    assert "UsageError: timeout: this system cannot end" in _run(_BOUNDED, tmp_path).stderr
