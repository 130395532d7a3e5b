"""How fast symobs is beside giac, Maxima, PARI, SymPy, QEPCAD and FLINT itself, in one table.

Run it by `python -m tests.programs.benchmarks`.

Run it in the top folder of the checkout, on a quiet machine, with giac (Debian package `xcas`), `maxima`, gp (`pari-gp`)
and `qepcad` installed; what is missing is left out.  `--only cart-pole` runs one group, `--repetitions 15` repeats more
often, `--write` puts the whole table into docs/measurements.md.  Each file in `groups/` is a group.

Every figure is a median over repetitions in which all subjects take turns, so a ratio compares runs under one load.
symobs is timed in process from the text of the plant to the checked result, with symbol names no earlier repetition
used.  A system in a process of its own is charged its processor time (its wall time where that is less) minus that of
the same system doing nothing.  The best formulation for giac and Maxima is searched among the files in `giac/` and
`maxima/`; each is first held to the answer of symobs: equal K, L and F, and F reduced as far.  Only start-up is a matter of
wall time.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.programs.benchmarks.measuring import Settings, markdown, table

if TYPE_CHECKING:
    from collections.abc import Sequence

PAGE = Path(__file__).parents[3] / "docs" / "measurements.md"


def groups() -> dict[str, Any]:
    """Return the modules of the groups by their names, in the order of the table."""
    folder = Path(__file__).parent / "groups"
    found = [
        importlib.import_module(f"tests.programs.benchmarks.groups.{m.name}")
        for m in pkgutil.iter_modules([str(folder)])
    ]
    found.sort(key=lambda module: module.PLACE)
    return {module.__name__.rpartition(".")[2].replace("_", "-"): module for module in found}


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the groups asked for and print the table."""
    known = groups()
    parser = argparse.ArgumentParser(
        prog="python -m tests.programs.benchmarks", description="Print one table of ratios."
    )
    parser.add_argument("--only", choices=known, action="append", help="run this group; may be repeated")
    parser.add_argument("--repetitions", type=int, default=7, help="how often each subject runs (7)")
    parser.add_argument("--limit", type=float, default=60, help="seconds another system may take (60)")
    parser.add_argument("--write", action="store_true", help="put the table of all groups into docs/measurements.md")
    given = parser.parse_args(arguments)
    if given.write and given.only:
        parser.error("--write takes all groups; leave --only out")
    settings = Settings(given.repetitions, given.limit)
    rows = []
    try:
        for name in given.only or known:
            print(f"{name} …", file=sys.stderr)
            rows += known[name].rows(settings)
    finally:
        print(table(rows))
    if given.write:
        above, begin, rest = PAGE.read_text("utf-8").partition("<!-- benchmarks -->\n")
        _, end, below = rest.partition("<!-- end -->\n")
        shown = [row for row in rows if not row.work.startswith("region ")]  # their medians are a row
        PAGE.write_text(f"{above}{begin}\n{markdown(shown)}\n\n{end}{below}", "utf-8")


if __name__ == "__main__":
    main()
