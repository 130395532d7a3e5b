"""L of dense rational plants with the poles -1 ... -n, checked."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import symobs
from tests.programs.benchmarks import models, other_systems, raw_numeric
from tests.programs.benchmarks.designs import seconds_of
from tests.programs.benchmarks.measuring import Row, medians, processor_time

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 5
_ASKED = {50: ">= 2"}
_SYMPY_UP_TO, _FEW_FROM = 30, 100


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs, its check included, beside FLINT alone, PARI without a check and SymPy."""
    for order in (10, 20, 30, 50, 100):
        yield from _beside(
            order, min(settings.repetitions, 3) if order >= _FEW_FROM else settings.repetitions, settings
        )


def _beside(order: int, repetitions: int, settings: Settings) -> Iterator[Row]:
    A, C, poles = models.rational(order)
    work = f"dense rational, n = {order}: L"
    subjects: dict[str, Callable[[], float | None]] = {
        "symobs": lambda: processor_time(lambda: design(order)),
        "raw": lambda: raw_numeric.seconds(A, C, poles)[0],
    }
    if other_systems.available("gp"):
        for name, path in other_systems.formulations("pari", "").items():
            subjects[f"PARI, {name}"] = lambda path=path: seconds_of(other_systems.gp(path, order, settings.limit))  # type: ignore[misc]
    found = medians(repetitions, subjects)
    own, raw, start = found.pop("symobs"), found.pop("raw"), found.pop("PARI, start_up", 0.0)
    yield Row(work, own, "FLINT alone (symobs / FLINT)", raw, "<= 1.5" if order >= _FEW_FROM else "", inverted=True)
    if found:
        best = min(found, key=lambda name: found[name])
        yield Row(work, own, f"{best.replace('_', ' ')}, without a check", found[best] - start, _ASKED.get(order, ""))
    if order <= _SYMPY_UP_TO:
        script = other_systems.HERE / "sympy_scripts" / "numeric_rational.py"
        done = other_systems.run([sys.executable, str(script), str(order)], settings.limit)
        if done is not None:
            yield Row(work, own, "SymPy DomainMatrix, rational, without a check", float(done.output))


def design(order: int) -> object:
    """Return the checked observer."""
    A, C, poles = models.rational(order)
    return symobs.observer(symobs.StateSpace(A, None, C), poles=poles)
