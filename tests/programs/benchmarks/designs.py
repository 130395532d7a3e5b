"""The parametric designs of symobs, and the same in giac, Maxima and SymPy, each held to our answer first."""

from __future__ import annotations

import random
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import symobs
from symobs.exact import Scalar
from tests.programs.benchmarks import other_systems, raw_flint
from tests.programs.benchmarks.measuring import Row, medians, processor_time, several

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from tests.programs.benchmarks.measuring import Settings
    from tests.programs.benchmarks.models import Model

_TITLES = {"giac": "giac", "maxima": "Maxima"}
_SEED = 20_261
#: Other systems run at most so often: they take longer, and vary less.
_MOST_RUNS = 5


def solve(model: Model) -> Any:
    """Return the result of a model: a compensator where it has an input, else an observer."""
    plant = symobs.StateSpace(model.A, model.B, model.C)
    if model.B is None:
        return symobs.observer(plant, poles=list(model.observer_poles))
    control, observer = list(model.control_poles), list(model.observer_poles)
    return symobs.compensator(plant, control_poles=control, observer_poles=observer)


def ours(make: Callable[[], Model]) -> Callable[[], float]:
    """Return the subject that solves a fresh model."""

    def subject() -> float:
        model = make()
        return processor_time(lambda: solve(model))

    return subject


def conditions(make: Callable[[], Model]) -> float:
    """Return the processor time of the conditions of a result, made when first asked for."""
    result = solve(make())
    return processor_time(lambda: result.holds_where)


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


def differences_at_points(model: Model, result: Any) -> list[str]:
    """Return the same for Maxima at random points, since its normal form of a difference takes minutes."""
    found = []
    generator = random.Random(_SEED)  # noqa: S311 - repeatable by design
    for _ in range(2):
        point = {name: Scalar.of(generator.randrange(10**6, 10**9)) for name in [*model.plain, "s"]}
        told = ",".join(f"{model.plain.get(name, name)}={value}" for name, value in point.items())
        for name in ("K", "L"):
            entries = result.answer[name].entries if name in result.answer else ()
            for k, entry in enumerate(entries, 1):
                found.append(f"subst([{told}],list_matrix_entries({name})[{k}])-({entry.substitute(point)})")
        if "F" in result.answer:
            found.append(f"subst([{told}],F)-({result.answer['F'].substitute(point)})")
    if "F" in result.answer:
        found.append(f"hipow(denom(F),s)-{result.answer['F'].denominator.degree('s')}")
    return found


def correct_files(system: str, stem: str, make: Callable[[], Model], limit: float) -> dict[str, Path]:
    """Return a system's formulations that agree with symobs; those that do not are named on standard error."""
    model = make()
    wanted = (differences if system == "giac" else differences_at_points)(model, solve(model))
    files = other_systems.formulations(system, stem)
    with tempfile.TemporaryDirectory() as folder:
        correct = {n: path for n, path in files.items() if other_systems.agrees(path, wanted, Path(folder), limit)}
    for name in files.keys() - correct.keys():
        print(f"{system}/{stem}{name} does not agree with symobs, or not in time; left out", file=sys.stderr)
    return correct


def seconds_of(run: other_systems.Run | None) -> float | None:
    """Return what a run took."""
    return None if run is None else run.seconds


def beside_systems(
    work: str, stem: str, make: Callable[[], Model], asked: str, settings: Settings, textbook: str = "inverse"
) -> Iterator[Row]:
    """Yield symobs beside the formulations of giac and Maxima: as the textbook has it, the fastest one, the others."""
    subjects: dict[str, Callable[[], float | None]] = {"symobs": several(25, ours(make))}
    for system, run in (("giac", other_systems.giac), ("maxima", other_systems.maxima)):
        if not other_systems.available(system):
            continue
        ending = ".giac" if system == "giac" else ".mac"
        start = other_systems.HERE / system / f"start_up{ending}"
        subjects[f"{system} start_up"] = lambda run=run, start=start: seconds_of(run(start, 60))  # type: ignore[misc]
        for name, path in correct_files(system, stem, make, settings.limit).items():
            subjects[f"{system} {name}"] = lambda run=run, path=path: seconds_of(run(path, settings.limit))  # type: ignore[misc]
    found = medians(min(settings.repetitions, _MOST_RUNS), subjects)
    own = found.pop("symobs")
    if not found:
        yield Row(work, own)
    for system, title in _TITLES.items():
        start_up = found.pop(f"{system} start_up", 0.0)
        names = sorted((name for name in found if name.startswith(f"{system} ")), key=lambda name: found[name])
        for name in names:
            short = name.partition(" ")[2]
            role = ", as the textbook has it" if short == textbook else ", its fastest" if name == names[0] else ""
            wanted = asked if system == "giac" and role else ""
            yield Row(work, own, f"{title}, {short.replace('_', ' ')}{role}", found[name] - start_up, wanted)


def beside_sympy(work: str, calls: Iterable[tuple[str, ...]], make: Callable[[], Model], limit: float) -> Iterator[Row]:
    """Yield symobs beside scripts of SymPy, which print their own processor time; one that takes too long is said so."""
    for name, *arguments in calls:
        path = other_systems.HERE / "sympy_scripts" / f"{name}.py"
        own = medians(5, {"": ours(make)})[""]
        done = other_systems.run([sys.executable, str(path), *arguments], limit)
        title = f"SymPy DomainMatrix, {name.partition('_')[2]}"
        if done is None:
            yield Row(work, own, title, limit, beyond=True)
        else:
            yield Row(work, own, title, float(done.output))


def beside_flint(work: str, order: int, repetitions: int, asked: str, make: Callable[[], Model]) -> Iterator[Row]:
    """Yield symobs beside the raw operations, whose entries must be the same."""
    model = make()
    found = medians(
        repetitions,
        {
            "symobs": ours(make),
            "raw": lambda: raw_flint.seconds(make(), order)[0],
        },
    )
    _, entries = raw_flint.seconds(model, order)
    sizes = [(len(above), len(below)) for above, below in entries]
    mine = [(len(e.numerator_part), len(e.denominator_part)) for e in solve(model).answer["L"].entries]
    if sizes != mine:
        print(f"{work}: FLINT's entries have {sizes} terms, those of symobs {mine}", file=sys.stderr)
    yield Row(work, found["symobs"], "FLINT alone (symobs / FLINT)", found["raw"], asked, inverted=True)
