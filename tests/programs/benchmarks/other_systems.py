"""The same work in giac, Maxima, PARI/gp and SymPy: each system in a process of its own, its start-up measured beside it.

What they are given stands in `giac/*.giac`, `maxima/*.mac` and `pari/*.gp`, one file for each formulation.
"""

from __future__ import annotations

import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

HERE = Path(__file__).resolve().parent
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
#: gp's own default of 8 MB is too small for the larger orders.
_GP = ("gp", "-q", "-f", "-s", "1G")


@dataclass(frozen=True)
class Run:
    """What a process took, and what it printed; `processor` counts its children and all its threads."""

    wall: float
    processor: float
    output: str

    @property
    def seconds(self) -> float:
        """Processor time, or wall time where threads made that the shorter: what is said of another system is the least."""
        return min(self.wall, self.processor)


def run(command: Sequence[str], limit: float, text: str = "", folder: Path | None = None) -> Run | None:
    """Run a command on an input text; None where it did not end within `limit` seconds."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    pipe = subprocess.PIPE
    # In a session of its own: what the program has started itself ends with it.
    with subprocess.Popen(
        command, stdin=pipe, stdout=pipe, stderr=pipe, text=True, cwd=folder, start_new_session=True
    ) as program:
        try:
            output, errors = program.communicate(text, timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(program.pid, signal.SIGKILL)
            return None
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Run(wall, processor, output + errors)


def available(system: str) -> bool:
    """Tell whether a system is installed."""
    return shutil.which(system) is not None


def formulations(system: str, stem: str) -> dict[str, Path]:
    """Return the files of a system whose names begin with `stem`, by the rest of the name."""
    return {path.stem.removeprefix(stem): path for path in sorted((HERE / system).glob(f"{stem}*"))}


def giac(path: Path, limit: float) -> Run | None:
    """Let giac run a file, in a folder of its own: it leaves a `session.tex` where it runs."""
    with tempfile.TemporaryDirectory() as folder:
        return run(["giac", str(path)], limit, folder=Path(folder))


def maxima(path: Path, limit: float) -> Run | None:
    """Let Maxima run a file."""
    return run(["maxima", "--very-quiet", "-b", str(path)], limit)


def gp(path: Path, order: int, limit: float) -> Run | None:
    """Let gp run a file after `n = order`."""
    return run(_GP, limit, f"n = {order};\n{path.read_text(encoding='utf-8')}")


def plain(text: str, names: Mapping[str, str]) -> str:
    """Return an expression in the plain names and with ^ for powers."""
    return _NAME.sub(lambda match: names.get(match.group(), match.group()), text).replace("**", "^")


def agrees(path: Path, differences: Sequence[str], scratch: Path, limit: float = 120) -> bool:
    """Tell whether giac or Maxima, after running a file, finds normal form 0 for each of these expressions."""
    program = scratch / path.name
    text = path.read_text("utf-8")
    if path.suffix == ".mac":
        asked = "\n".join(f'print("difference", ratsimp({difference}))$' for difference in differences)
        program.write_text(f"{text}\n{asked}\n", "utf-8")
        done = maxima(program, limit)
        told = re.findall(r"^difference (.*?)\s*$", done.output, re.MULTILINE) if done else []
        return told == ["0"] * len(differences)
    asked = ",".join(f"normal({difference})" for difference in differences)
    program.write_text(f"{text}\n[{asked}]\n", "utf-8")
    done = giac(program, limit)
    if done is None:
        return False
    answer = re.sub(r"\s", "", done.output.rpartition('"Done"')[2].partition("//")[0])
    return re.fullmatch(r",[\[\]0,]+", answer) is not None and answer.count("0") >= len(differences)
