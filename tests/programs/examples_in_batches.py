"""Measure the worked examples to LaTeX, HTML and JSON, and their sheet: `python -m tests.programs.examples_in_batches`.

One after another in one process, and by two workers, in turns: `--rounds 2`.  Each run is a process of its own, so that its
processor time is known with that of its children; modules are compiled before, as where symobs is installed.  `--step 4` takes
every fourth example, `--pair 0` the files alone, `--pair 1` the sheets.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

from symobs.applications.batch.run import batch
from symobs.cli import main as command_line
from symobs.cli.shared import sheet_entries
from symobs.pages.formats.json import result_object
from symobs.problem import read
from symobs.tasks.result import render
from tests.support.tools.command_line import EXAMPLES, installed_environment

#: Each comparison: one after another, and by two workers.
PAIRS = (("alone", "batch"), ("sheet alone", "sheet"))


def alone(examples: list[Path], folder: Path) -> None:
    """Solve one after another, and write the same files as a batch does."""
    for path in examples:
        problem = read(path.read_text(encoding="utf-8"), folder=path.parent)
        results = problem.solve()
        found = {"results": [result_object(result) for result in results]}
        (folder / f"{path.stem}.json").write_text(json.dumps(found), encoding="utf-8")
        document = problem.document(results)
        for name in ("latex", "html"):
            (folder / f"{path.stem}.{name}").write_text(str(render(document, name)), encoding="utf-8")


def work(name: str, examples: list[Path], folder: Path) -> None:
    """Do one of the works."""
    if name == "alone":
        alone(examples, folder)
    elif name == "batch":
        batch(examples, out=folder, workers=2, formats=("latex", "html"))
    else:
        if name == "sheet alone":
            sheet_entries._WORTH_CHILDREN = sys.maxsize
        sys.argv = ["symobs", "sheet", *map(str, examples), "-o", str(folder / "sheet.html")]
        command_line()


def measured(name: str, step: int, installed: dict[str, str]) -> tuple[float, float]:
    """Seconds by the clock, and of the processor, of a work in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        command = [sys.executable, "-m", __spec__.name, "--only", name, "--step", str(step), "--folder", folder]
        subprocess.run(command, env=installed, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        clock, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
        count = sum(1 for path in Path(folder).rglob("*") if path.is_file())
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(
        f"{name:12} {clock:6.1f} s, processor {used:6.1f} s, {count} files, load {os.getloadavg()[0]:.1f}", flush=True
    )
    return clock, used


def main() -> None:
    """Print what was measured."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--only")
    asked.add_argument("--folder", type=Path)
    asked.add_argument("--step", type=int, default=1)
    asked.add_argument("--rounds", type=int, default=2)
    asked.add_argument("--pair", type=int, choices=range(len(PAIRS)))
    options = asked.parse_args()
    if options.only:
        work(options.only, EXAMPLES[:: options.step], options.folder)
        return
    with tempfile.TemporaryDirectory() as cache:
        installed = installed_environment(Path(cache))
        for pair in PAIRS if options.pair is None else (PAIRS[options.pair],):
            for name in pair:
                measured(name, 40, installed)  # what they import beside symobs is compiled then
            rounds = [[measured(name, options.step, installed) for name in pair] for _ in range(options.rounds)]
            ratios = [median(two[k] / one[k] for one, two in rounds) for k in (0, 1)]
            print(
                f"{' / '.join(reversed(pair))}: {ratios[0]:.2f} by the clock, {ratios[1]:.2f} of the processor",
                flush=True,
            )


if __name__ == "__main__":
    main()
