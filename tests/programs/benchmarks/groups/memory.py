"""The most memory that a process of its own takes, less what Python takes for doing nothing."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from tests.programs.benchmarks import other_systems
from tests.programs.benchmarks.measuring import Row
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 11
#: The high-water mark of this program alone; that of `getrusage` begins with what the program that started it had.
_MARK = """
import re
print(int(re.search(r"VmHWM:\\s*(\\d+)", open("/proc/self/status").read())[1]) * 1024)
"""
_DESIGN = "from tests.programs.benchmarks import designs, models\ndesigns.solve(models.{})"
_NUMERIC = "from tests.programs.benchmarks.groups import numeric\nnumeric.design({})"
_SHEET = (
    "from tests.programs.benchmarks.groups import sheets\nsheets.spent_on(sheets.ROOT / 'worked_examples' / '{}.toml')"
)
_WORK = {
    "cart-pole: K, L, F": _DESIGN.format("cart_pole()"),
    "generic 3x3: L": _DESIGN.format("generic(3)"),
    "generic 4x4: L": _DESIGN.format("generic(4)"),
    "dense rational, n = 50: L": _NUMERIC.format(50),
    "dense rational, n = 100: L": _NUMERIC.format(100),
    "sheet of the servo with output feedback, four formats": _SHEET.format("output_feedback_servo"),
    "sheet of a region, four formats": _SHEET.format("region_two_masses_observer"),
}


def rows(settings: Settings) -> Iterator[Row]:
    """Yield megabytes, beside what importing SymPy takes."""
    nothing, sympy = peak("pass", settings.limit), peak("import sympy", settings.limit)
    if nothing is None or sympy is None:
        return
    beside = "import sympy (symobs / SymPy)"
    for work, code in _WORK.items():
        found = peak(code, settings.limit)
        if found is not None:
            yield Row(f"memory, {work}", found - nothing, beside, sympy - nothing, inverted=True, unit="MB")


def peak(code: str, limit: float) -> float | None:
    """Return the megabytes that a Python process takes at most, None where it fails or this system does not tell."""
    done = other_systems.run([sys.executable, "-c", code + _MARK], limit, folder=ROOT)
    last = done.output.split()[-1] if done and done.output.split() else ""
    return int(last) / 1e6 if last.isdigit() else None
