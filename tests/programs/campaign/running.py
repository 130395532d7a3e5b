"""Many questions for one process of a system: each in a statement of its own, each with an answer on a line of its own.

A system that dies or takes too long over one question is started again behind it.
"""

from __future__ import annotations

import os
import re
import selectors
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

_ANSWER = re.compile(r"#(\d+)#(.*?)#")


@dataclass(frozen=True)
class System:
    """How a system is run: its command, what it reads first, and whether the program is a file or its standard input."""

    command: tuple[str, ...]
    preamble: str
    by_file: bool = False


def answers(system: System, questions: Sequence[str], seconds: float = 20) -> list[str | None]:
    """Return what each question printed between `#number#` and `#`; None where no answer came in that time.

    A question is a text with `{}` where its number stands.
    """
    found: dict[int, str] = {}
    start = 0
    while start < len(questions):
        program = "\n".join([system.preamble, *(_numbered(questions[k], k) for k in range(start, len(questions)))])
        came = _run(system, program, seconds)
        found |= {k: text for k, text in came.items() if k >= start}
        last = max(came, default=start - 1)
        if last == len(questions) - 1:
            break
        start = max(last, start - 1) + 2
    return [found.get(k) for k in range(len(questions))]


def _numbered(question: str, number: int) -> str:
    return question.replace("{}", str(number))


def _run(system: System, program: str, seconds: float) -> dict[int, str]:
    """Run a program until it ends, or prints nothing for so many seconds."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "program"
        path.write_text(program + "\n", encoding="utf-8")
        command = [*system.command, str(path)] if system.by_file else list(system.command)
        with (
            path.open(encoding="utf-8") as source,
            subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL if system.by_file else source,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                cwd=folder,
                start_new_session=True,
            ) as process,
        ):
            try:
                text = _read(process, seconds)
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)
    return {int(number): answer for number, answer in _ANSWER.findall(re.sub(r"\s", "", text))}


def _read(process: subprocess.Popen[bytes], seconds: float) -> str:
    assert process.stdout is not None
    parts: list[bytes] = []
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        last = time.monotonic()
        while time.monotonic() - last < seconds:
            if not selector.select(timeout=1):
                continue
            part = os.read(process.stdout.fileno(), 65536)
            if not part:
                process.wait()
                break
            parts.append(part)
            last = time.monotonic()
    return b"".join(parts).decode("utf-8", "replace")
