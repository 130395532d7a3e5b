"""Wall time of whole processes beside that of importing SymPy."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from tests.programs.benchmarks import other_systems
from tests.programs.benchmarks.measuring import Row, medians
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.programs.benchmarks.measuring import Settings

PLACE = 9
_SERVO = str(ROOT / "worked_examples/output_feedback_servo.toml")
_COMMANDS: dict[str, Sequence[str]] = {
    "sympy": ["-c", "import sympy"],
    "symobs --help": ["-m", "symobs", "--help"],
    "symobs solve, to LaTeX": ["-m", "symobs", "solve", _SERVO],
}


def rows(settings: Settings) -> Iterator[Row]:
    """Yield `symobs --help` and `symobs solve` of the servo with output feedback."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # an installed module is compiled once
    subjects = {name: lambda arguments=arguments: wall(arguments) for name, arguments in _COMMANDS.items()}
    found = medians(3 * settings.repetitions, subjects)
    against = "import sympy (symobs / SymPy)"
    for name, asked in (("symobs --help", "<= 0.6"), ("symobs solve, to LaTeX", "<= 0.8")):
        yield Row(name, found[name], against, found["sympy"], asked, inverted=True)


def wall(arguments: Sequence[str]) -> float | None:
    """Return the wall time of a Python process."""
    done = other_systems.run([sys.executable, *arguments], 60)
    return None if done is None else done.wall
