"""Octave with its control package, asked many things in one process.

A question is a piece of an Octave program that says what it finds by `say("name", matrix)`.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tests.programs.benchmarks import other_systems

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

COMMAND = "octave-cli"
Numbers: TypeAlias = "NDArray[np.complex128]"
#: What a question said, by name, or the text of its error.
Reply: TypeAlias = "dict[str, Numbers] | str"

_BEGINNING = """\
1;
function say(name, value)
  value = double(full(value));
  printf("@ %s %d %d", name, rows(value), columns(value));
  printf(" %.17g %.17g", [real(value.(:))'; imag(value.(:))']);
  printf("\\n");
end
pkg load control
warning("off", "all");
""".replace("value.(:)", "value(:)")


def ask(questions: Sequence[str], limit: float = 600, beginning: str = "") -> list[Reply]:
    """Return what each question said, after a beginning; a question that ends in an error does not end the others."""
    parts = [
        f'printf("# {k}\\n");\ntry\n{question}\ncatch failure\n'
        'printf("! %s\\n", strrep(failure.message, "\\n", " "));\nend_try_catch'
        for k, question in enumerate(questions)
    ]
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "questions.m"
        program.write_text("\n".join([_BEGINNING, beginning, *parts, 'printf("# end\\n");\n']), "utf-8")
        command = [COMMAND, "--norc", "--no-history", "--quiet", str(program)]
        done = other_systems.run(command, limit, folder=Path(folder))
    if done is None:
        raise TimeoutError(f"Octave did not end within {limit:g} s")
    if "# end\n" not in done.output:
        raise RuntimeError(f"Octave ended early: {done.output[-1000:]}")
    _, *replies = ("\n" + done.output.partition("# end\n")[0]).split("\n# ")
    return [_read(reply) for reply in replies]


def _read(reply: str) -> Reply:
    said: dict[str, Numbers] = {}
    for line in reply.splitlines():
        if line.startswith("! "):
            return line[2:]
        if line.startswith("@ "):
            _, name, rows, columns, *numbers = line.split()
            parts = np.array([float(number) for number in numbers]).reshape(-1, 2)
            values = parts[:, 0] + 1j * parts[:, 1]
            said[name] = values.reshape((int(rows), int(columns)), order="F")
    return said


def matrix(values: Sequence[Sequence[float | complex]], columns: int = 0) -> str:
    """Return a matrix as Octave reads it, with all digits; one without rows has the given number of columns."""
    if not len(values) or not len(values[0]):
        return f"zeros({len(values)}, {columns})"
    return f"[{'; '.join(', '.join(map(number, row)) for row in values)}]"


def number(value: complex) -> str:
    """Return a number as Octave reads it, with all digits."""
    value = complex(value)
    return repr(value.real) if not value.imag else f"complex({value.real!r}, {value.imag!r})"
