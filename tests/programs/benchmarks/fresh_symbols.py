"""How memory grows over designs whose symbols no design before them had.

Run it by `python -m tests.programs.benchmarks.fresh_symbols 20000`.
"""

from __future__ import annotations

import sys
from pathlib import Path
from resource import getpagesize
from typing import Any

import symobs

#: Memory is told once in so many designs.
_STEP = 1_000


def design(number: int) -> tuple[Any, Any]:
    """Return an observer and a matrix exponential for fresh symbols."""
    a, b, p = (f"{letter}{number}" for letter in "abp")
    plant = symobs.StateSpace([["0", a], ["1", b]], [["1"], ["0"]], [["1", b]])
    decaying = symobs.StateSpace([[f"-{p}", "1"], ["0", f"-2*{p}"]], [["0"], ["1"]], [["1", "0"]])
    return symobs.observer(plant, poles=[f"-{p}", "-1"]), symobs.matrix_exponential(decaying)


def resident() -> int:
    """Return the resident memory of this process in kilobytes."""
    pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
    return int(pages) * getpagesize() // 1024


if __name__ == "__main__":
    for number in range(int(sys.argv[1]) + 1):
        design(number)
        if number % _STEP == 0:
            print(f"{number:6} designs {resident():8} kB", flush=True)
