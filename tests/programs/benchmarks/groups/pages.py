"""Pages of random compensators with numbers, their responses drawn and checked, from their text to LaTeX."""

from __future__ import annotations

import random
import statistics
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import symobs
from tests.programs.benchmarks.measuring import Row, processor_time

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 8
_COUNT, _SEED = 200, 20_262


class Compensator(NamedTuple):
    """The text of a plant and of the poles asked for."""

    A: str
    B: str
    C: str
    control: str
    observer: str


def rows(_: Settings) -> Iterator[Row]:
    """Yield the median, the 95th percentile and the longest of the processor times of one page each."""
    times = sorted(processor_time(partial(page, given)) for given in compensators(_COUNT))
    work = f"page of a random compensator, n = 2-4, {_COUNT} of them"
    yield Row(f"{work}: median", statistics.median(times), asked="<= 150 ms")
    yield Row(f"{work}: 95th percentile", times[len(times) * 95 // 100], asked="<= 1 s")
    yield Row(f"{work}: longest", times[-1])


def compensators(count: int) -> Iterator[Compensator]:
    """Yield controllable and observable plants with small entries, and poles on a grid of twentieths."""
    generator = random.Random(_SEED)  # noqa: S311 - plants for a benchmark
    while count:
        order = generator.choice((2, 3, 4))
        A = "; ".join(" ".join(str(generator.randint(-3, 3)) for _ in range(order)) for _ in range(order))
        B = "; ".join(str(generator.randint(-2, 2)) for _ in range(order))
        C = " ".join(str(generator.randint(-2, 2)) for _ in range(order))
        plant = symobs.StateSpace(f"[{A}]", f"[{B}]", f"[{C}]")
        if symobs.controllability(plant).verdict == symobs.observability(plant).verdict == "yes":
            count -= 1
            yield Compensator(f"[{A}]", f"[{B}]", f"[{C}]", _poles(order, generator), _poles(order, generator))


def _poles(count: int, generator: random.Random) -> str:
    """Return poles between -10 and -1, about half of them in pairs."""
    found: list[str] = []
    while len(found) < count:
        real = f"-{generator.randint(20, 200)}/20"
        if count - len(found) > 1 and generator.random() < 1 / 2:
            imaginary = f"{generator.randint(1, 200)}/20"
            found += [f"{real}+{imaginary}i", f"{real}-{imaginary}i"]
        else:
            found.append(real)
    return ", ".join(found)


def page(given: Compensator) -> str:
    """Return the page."""
    plant = symobs.StateSpace(given.A, given.B, given.C)
    result = symobs.compensator(plant, control_poles=given.control, observer_poles=given.observer)
    return str(result.to("latex"))
