"""Hostile and random inputs: `python -m tests.programs.fuzz --inputs 1000000` runs them and prints what became of them.

Run it in the top folder of the checkout.  `--only grammar` (or problem_toml, problem_json, command_line, printing, audit,
check, convention, live) runs one target with all the inputs; `--input 4711` one input of it, in this process; `--figures
FILE` keeps the table as it grows.  Every input is made from its target's name and its number alone, so all runs are the same.

An input must end in a value or in one of symobs's own errors (the command line: never with exit code 1), within its
budget of processor time and memory, and must reach no code, file, module or program.  What hangs is ended with its
process and told by its number.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.programs.fuzz.targets import TARGETS
from tests.programs.fuzz.worker import HANGS, Tally, allow, outcome, prepared, shown, work

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tests.programs.fuzz.targets import Target

#: A process runs so many inputs at most: what it keeps is given back, and a leak shows in the memory of one process.
_OF_ONE_PROCESS = 50_000


def main() -> int:
    """Run what is asked for; return 1 where something was found."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.programs.fuzz", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("--inputs", type=int, default=1_000_000, help="how many, all targets together")
    parser.add_argument("--only", choices=list(TARGETS), help="one target")
    parser.add_argument("--input", type=int, help="run this one input of the target, in this process")
    parser.add_argument("--first", type=int, default=0, help="the number of the first input of each target")
    parser.add_argument("--figures", type=Path, help="a file to keep the table in as it grows")
    asked = parser.parse_args()
    chosen = [TARGETS[asked.only]] if asked.only else list(TARGETS.values())
    if asked.input is not None:
        return _one(chosen[0], asked.input)
    whole = sum(target.share for target in chosen)
    tallies: dict[str, Tally] = {}
    for target in chosen:
        count = asked.inputs * target.share // whole
        tallies[target.name] = _run(target, asked.first, asked.first + count, tallies, asked.figures)
    print(table(tallies))
    return int(any(tally.faults for tally in tallies.values()))


def _one(target: Target, number: int) -> int:
    watch = prepared()
    allow(watch, target)
    case = target.case(number)
    print(shown(case))
    became, fault = outcome(target.run, case, watch)
    print(became, fault)
    return int(bool(fault))


def _run(target: Target, first: int, last: int, tallies: dict[str, Tally], figures: Path | None) -> Tally:
    """Run inputs in processes of their own; one that hangs is noted, and the next begins behind it."""
    total = tallies[target.name] = Tally()
    skipped: set[int] = set()
    start = shown_at = time.monotonic()
    while first < last:
        place, (receive, send) = multiprocessing.Value("q", first), multiprocessing.Pipe(duplex=False)
        until = min(last, first + _OF_ONE_PROCESS)
        process = multiprocessing.Process(
            target=work, args=(target.name, first, until, frozenset(skipped), place, send), daemon=True
        )
        process.start()
        send.close()
        while first < until:
            try:
                first, tally = receive.recv()
            except EOFError:
                break
            total.add(tally)
            for fault in tally.faults:
                print(fault, flush=True)
            if time.monotonic() - shown_at > 20:
                shown_at = time.monotonic()
                print(f"{target.name}: {total.inputs} inputs in {shown_at - start:.0f} s", flush=True)
                _keep(tallies, figures)
        process.join()
        if first < until:
            skipped.add(place.value)
            why = f"hangs: {HANGS:g} s" if process.exitcode == -14 else f"ended the process ({process.exitcode})"
            total.faults.append(f"{target.name} {place.value}: {why}")
            total.became["hang" if process.exitcode == -14 else "crash"] += 1
            total.inputs += 1
            print(total.faults[-1], flush=True)
    print(f"{target.name}: {total.inputs} inputs in {time.monotonic() - start:.0f} s", flush=True)
    _keep(tallies, figures)
    return total


def _keep(tallies: Mapping[str, Tally], figures: Path | None) -> None:
    if figures is not None:
        details = [
            f"{name}: slowest {tally.slowest_input}\n{name}: largest {tally.largest_input}"
            for name, tally in tallies.items()
        ]
        faults = [fault for tally in tallies.values() for fault in tally.faults]
        figures.write_text(
            "\n".join([table(tallies), "", *faults, "", *details, ""]), encoding="utf-8", errors="backslashreplace"
        )


def table(tallies: Mapping[str, Tally]) -> str:
    """Return the table of all targets."""
    head = ("target", "inputs", "processor", "an input", "slowest", "most memory", "faults", "what became of them")
    rows: list[tuple[str, ...]] = [head]
    whole = Tally()
    for name, tally in tallies.items():
        whole.add(tally)
        rows.append((name, *_cells(tally), ", ".join(f"{word} {count}" for word, count in tally.became.most_common())))
    rows.append(("all", *_cells(whole), ""))
    widths = [max(len(row[k]) for row in rows) for k in range(len(head))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows
    )


def _cells(tally: Tally) -> tuple[str, ...]:
    each = 1000 * tally.seconds / max(1, tally.inputs)
    return (
        str(tally.inputs),
        f"{tally.seconds:.0f} s",
        f"{each:.2f} ms",
        f"{tally.slowest:.2f} s",
        f"{tally.megabytes:.0f} MB",
        str(len(tally.faults)),
    )


if __name__ == "__main__":
    sys.exit(main())
