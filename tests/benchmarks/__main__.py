"""How fast symobs is beside giac, PARI, SymPy, QEPCAD and FLINT itself: `python -m tests.benchmarks` prints a table.

Run it in the top folder of the checkout, on a quiet machine, with giac (Debian package `xcas`), gp (`pari-gp`) and
`qepcad` installed; what is missing is left out.  `--only cart-pole` runs one group, `--repetitions 15` repeats more often.

Every figure is a median over repetitions in which all subjects take turns, so a ratio compares runs under one load.
symobs is timed in process from the text of the plant to the checked result, with symbol names no earlier repetition
used.  A system in a process of its own is charged its processor time (its wall time where that is less) minus that of
the same system doing nothing.  giac's best formulation is searched among the files in `giac/`; each is first held to
the answer of symobs: equal K, L and F, and F reduced as far.  Only start-up is a matter of wall time.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import symobs
from tests.benchmarks import models, other_systems, raw_flint, regions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from tests.benchmarks.models import Model

TOP = Path(__file__).parents[2]


@dataclass(frozen=True)
class Row:
    """One line of the table: what symobs took, what another took, and the ratio asked for."""

    work: str
    ours: float
    other: str = ""
    theirs: float | None = None
    asked: str = ""
    inverted: bool = False
    ratio: float | None = None  # where it is not that of the two times

    def cells(self) -> tuple[str, ...]:
        """Return the line as texts."""
        if self.theirs is None:
            return self.work, _milliseconds(self.ours), self.other, "", "", self.asked
        ratio = self.ratio
        if ratio is None:
            ratio = self.ours / self.theirs if self.inverted else self.theirs / self.ours
        return self.work, _milliseconds(self.ours), self.other, _milliseconds(self.theirs), f"{ratio:.3g}", self.asked


def _milliseconds(seconds: float) -> str:
    return f"{1000 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


@dataclass(frozen=True)
class Settings:
    """How often each subject runs, and how long another system may take."""

    repetitions: int
    limit: float


def medians(repetitions: int, subjects: Mapping[str, Callable[[], float | None]]) -> dict[str, float]:
    """Return each subject's median over repetitions in which all take turns; a subject that gives up is left out."""
    found: dict[str, list[float]] = {name: [] for name in subjects}
    for _ in range(repetitions):
        for name in list(found):
            seconds = subjects[name]()
            if seconds is None:
                del found[name]
            else:
                found[name].append(seconds)
    return {name: statistics.median(values) for name, values in found.items()}


def several(times: int, subject: Callable[[], float]) -> Callable[[], float]:
    """Return the median of a subject run several times in a row, for subjects much shorter than the others."""
    return lambda: statistics.median(subject() for _ in range(times))


# -- symobs -------------------------------------------------------------------------------------------------------


def solve(model: Model) -> Any:
    """Return the result of a model: a compensator where it has an input, else an observer."""
    plant = symobs.StateSpace(model.A, model.B, model.C)
    if model.B is None:
        return symobs.observer(plant, poles=list(model.observer_poles))
    control, observer = list(model.control_poles), list(model.observer_poles)
    return symobs.compensator(plant, control_poles=control, observer_poles=observer)


def processor_time(function: Callable[[Any], object], argument: object) -> float:
    """Return the processor time of a call."""
    start = time.process_time()
    function(argument)
    return time.process_time() - start


def ours(make: Callable[[], Model]) -> Callable[[], float]:
    """Return the subject that solves a fresh model."""
    return lambda: processor_time(solve, make())


def conditions(make: Callable[[], Model]) -> float:
    """Return the processor time of the conditions of a result, made when first asked for."""
    return processor_time(lambda result: result.holds_where, solve(make()))


# -- giac ---------------------------------------------------------------------------------------------------------


def differences(model: Model, result: Any) -> list[str]:
    """Return what must be 0 in giac after one of its files: its answers minus ours, and F reduced alike."""
    found = []
    for name in ("K", "L"):
        entries = result.answer[name].entries if name in result.answer else ()
        found += [f"flatten({name})[{k}]-({other_systems.plain(str(e), model.plain)})" for k, e in enumerate(entries)]
    if "F" in result.answer:
        F = result.answer["F"]
        whole, below = (other_systems.plain(str(part), model.plain) for part in (F, F.denominator))
        found += [f"F-({whole})", f"(denom(F)/({below}))^2-1"]
    return found


def correct_files(stem: str, make: Callable[[], Model], limit: float) -> dict[str, Path]:
    """Return giac's formulations that agree with symobs; those that do not are named on standard error."""
    model = make()
    wanted = differences(model, solve(model))
    files = other_systems.formulations("giac", stem)
    with tempfile.TemporaryDirectory() as folder:
        correct = {n: path for n, path in files.items() if other_systems.agrees(path, wanted, Path(folder), limit)}
    for name in files.keys() - correct.keys():
        print(f"giac/{stem}{name}.giac does not agree with symobs; left out", file=sys.stderr)
    return correct


def seconds_of(run: other_systems.Run | None) -> float | None:
    """Return what a run took."""
    return None if run is None else run.seconds


def beside_giac(
    work: str, stem: str, make: Callable[[], Model], textbook: str, asked: str, settings: Settings
) -> Iterator[Row]:
    """Yield symobs beside giac's textbook formulation, the fastest one found, and the others."""
    subjects: dict[str, Callable[[], float | None]] = {"symobs": several(5, ours(make))}
    if other_systems.available("giac"):
        subjects["start_up"] = lambda: seconds_of(other_systems.giac(other_systems.HERE / "giac/start_up.giac", 60))
        for name, path in correct_files(stem, make, settings.limit).items():
            subjects[name] = lambda path=path: seconds_of(other_systems.giac(path, settings.limit))  # type: ignore[misc]
    found = medians(settings.repetitions, subjects)
    own, start = found.pop("symobs"), found.pop("start_up", 0.0)
    ranked = sorted(found, key=lambda name: found[name])
    if not ranked:
        yield Row(work, own)
    for name in ranked:
        role = ", as the textbook has it" if name == textbook else ", its fastest" if name == ranked[0] else ""
        yield Row(work, own, f"giac, {name.replace('_', ' ')}{role}", found[name] - start, asked if role else "")


# -- the groups -----------------------------------------------------------------------------------------------------


def cart_pole(settings: Settings) -> Iterator[Row]:
    """K, L and F of the cart-pole with eight symbolic poles."""
    work = "cart-pole, 13 symbols: K, L, F"
    yield from beside_giac(work, "cart_pole_", models.cart_pole, "inverse", ">= 40", settings)
    yield Row("its conditions, when asked for", medians(5, {"": lambda: conditions(models.cart_pole)})[""])


def generic_3(settings: Settings) -> Iterator[Row]:
    """L of the generic third-order plant: beside giac, FLINT alone, SymPy."""
    work = "generic 3x3, 15 symbols: L"
    yield from beside_giac(work, "generic_", lambda: models.generic(3), "inverse", ">= 50", settings)
    yield from beside_flint(work, 3, 5 * settings.repetitions, "")
    subjects: dict[str, Callable[[], float | None]] = {"symobs": several(5, ours(lambda: models.generic(3)))}
    for path in sorted((other_systems.HERE / "sympy_scripts").glob("*.py")):
        subjects[path.stem] = lambda path=path: _printed(path, settings.limit)  # type: ignore[misc]
    found = medians(min(settings.repetitions, 3), subjects)
    own = found.pop("symobs")
    for name, seconds in sorted(found.items()):
        yield Row(work, own, f"SymPy DomainMatrix, {name}", seconds)


def _printed(script: Path, limit: float) -> float | None:
    done = other_systems.run([sys.executable, str(script)], limit)
    return None if done is None else float(done.output)


def generic_4(settings: Settings) -> Iterator[Row]:
    """L of the generic fourth-order plant beside FLINT alone."""
    work = "generic 4x4, 24 symbols: L"
    yield from beside_flint(work, 4, settings.repetitions, "<= 4")
    yield Row("its conditions, when asked for", conditions(lambda: models.generic(4)))


def beside_flint(work: str, order: int, repetitions: int, asked: str) -> Iterator[Row]:
    """Yield symobs beside the raw operations, whose entries must be the same."""
    model = models.generic(order)
    found = medians(
        repetitions,
        {
            "symobs": ours(lambda: models.generic(order)),
            "raw": lambda: raw_flint.seconds(models.generic(order), order)[0],
        },
    )
    _, entries = raw_flint.seconds(model, order)
    sizes = [(len(above), len(below)) for above, below in entries]
    mine = [(len(e.numerator_part), len(e.denominator_part)) for e in solve(model).answer["L"].entries]
    if sizes != mine:
        print(f"{work}: FLINT's entries have {sizes} terms, those of symobs {mine}", file=sys.stderr)
    yield Row(work, found["symobs"], "FLINT alone (symobs / FLINT)", found["raw"], asked, inverted=True)


def numeric(settings: Settings) -> Iterator[Row]:
    """L of dense rational plants with the poles -1 ... -n beside PARI."""
    for order in (10, 20, 30, 50):
        A, C, poles = models.rational(order)

        def design(A: object = A, C: object = C, poles: object = poles) -> object:
            return symobs.observer(symobs.StateSpace(A, None, C), poles=poles)

        subjects: dict[str, Callable[[], float | None]] = {
            "symobs": lambda design=design: processor_time(lambda _: design(), None)  # type: ignore[misc]
        }
        if other_systems.available("gp"):
            for name, path in other_systems.formulations("pari", "").items():
                subjects[name] = lambda path=path, n=order: seconds_of(other_systems.gp(path, n, settings.limit))  # type: ignore[misc]
        found = medians(settings.repetitions, subjects)
        own, start = found.pop("symobs"), found.pop("start_up", 0.0)
        work = f"dense rational, n = {order}: L"
        if not found:
            yield Row(work, own)
            continue
        best = min(found, key=lambda name: found[name])
        yield Row(work, own, f"PARI, {best}", found[best] - start)


def start_up(settings: Settings) -> Iterator[Row]:
    """Wall time of whole processes beside that of importing SymPy."""
    commands: dict[str, Sequence[str]] = {
        "sympy": ["-c", "import sympy"],
        "symobs --help": ["-m", "symobs", "--help"],
        "symobs solve, to LaTeX": ["-m", "symobs", "solve", str(TOP / "worked_examples/output_feedback_servo.toml")],
    }

    def wall(arguments: Sequence[str]) -> float | None:
        done = other_systems.run([sys.executable, *arguments], 60)
        return None if done is None else done.wall

    found = medians(
        3 * settings.repetitions,
        {name: lambda arguments=arguments: wall(arguments) for name, arguments in commands.items()},  # type: ignore[misc]
    )
    against = "import sympy (symobs / SymPy)"
    yield Row("symobs --help", found["symobs --help"], against, found["sympy"], "<= 0.6", inverted=True)
    name = "symobs solve, to LaTeX"
    yield Row(name, found[name], against, found["sympy"], "<= 0.8", inverted=True)


def stability_regions(settings: Settings) -> Iterator[Row]:
    """Regions of stability beside QEPCAD without its start-up; `tests.benchmarks.regions` prints more of them."""
    rows = list(regions.measure_all((), min(settings.repetitions, 5), settings.limit))
    for row in rows:
        if row.ours is not None:
            yield Row(f"region {row.problem.name}", row.ours, f"QEPCAD alone; {row.verdict}", row.alone)
    times = [(row.ours, row.alone) for row in rows if row.ours is not None and row.alone is not None]
    if times:
        own, alone = (statistics.median(column) for column in zip(*times, strict=True))
        yield Row("regions: medians", own, "QEPCAD alone", alone, ratio=regions.median(row.ratio for row in rows))


GROUPS: dict[str, Callable[[Settings], Iterator[Row]]] = {
    "cart-pole": cart_pole,
    "generic-3": generic_3,
    "generic-4": generic_4,
    "numeric": numeric,
    "start-up": start_up,
    "regions": stability_regions,
}


def table(rows: Sequence[Row]) -> str:
    """Return the rows in columns."""
    lines = [("work", "symobs", "beside", "time", "ratio", "asked"), *(row.cells() for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(6)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the groups asked for and print the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks", description="Print one table of ratios.")
    parser.add_argument("--only", choices=GROUPS, action="append", help="run this group; may be repeated")
    parser.add_argument("--repetitions", type=int, default=7, help="how often each subject runs (7)")
    parser.add_argument("--limit", type=float, default=60, help="seconds another system may take (60)")
    given = parser.parse_args(arguments)
    settings = Settings(given.repetitions, given.limit)
    rows = []
    for name in given.only or GROUPS:
        print(f"{name} …", file=sys.stderr)
        rows += list(GROUPS[name](settings))
    print(table(rows))


if __name__ == "__main__":
    main()
