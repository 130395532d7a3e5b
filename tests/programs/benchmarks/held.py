"""What is held in CI: seven pieces of work as ratios to a fixed piece of arithmetic in the same process.

`python -m tests.programs.benchmarks.held` prints the ratios of today; `test_speed_is_held.toml` has the limits, 1.3 times
what was measured when they were set.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from tests.programs.benchmarks import designs, models
from tests.programs.benchmarks.groups import live, numeric, pages, regions
from tests.programs.benchmarks.measuring import processor_time
from tests.support.regions.region_problems import PROBLEMS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_TURNS = 9


def fixed() -> int:
    """Do what exact algebra in Python is made of: objects, dictionaries, texts, long integers; nothing of symobs."""
    total, known = Fraction(0), dict[str, Fraction]()
    for k in range(1, 1500):
        total += Fraction(k * k + 1, k + 1) if k % 7 else -total
        known[f"{total.numerator % 10007}/{k % 11}"] = total
        total = Fraction(total.numerator % 1_000_003, 1 + total.denominator % 1009)
    return len(known) + sum(map(len, known))


def works() -> Mapping[str, Callable[[], float]]:
    """Return the pieces of work, each with its processor time as the value."""
    region = [problem for problem in PROBLEMS if problem.name in {"cubic_bilin", "observer_3", "jury3"}]
    page = list(pages.compensators(5))
    return {
        "cart-pole, K, L and F": designs.ours(models.cart_pole),
        "generic 3x3, L": designs.ours(lambda: models.generic(3)),
        "generic 4x4, L": designs.ours(lambda: models.generic(4)),
        "dense rational, n = 10": lambda: processor_time(lambda: numeric.design(10)),
        "three regions": lambda: sum(map(regions.ours, region)),
        "five pages": lambda: processor_time(lambda: [pages.page(given) for given in page]),
        "ten answers of a drag": lambda: processor_time(lambda: [live.dragged(3) for _ in range(10)]),
    }


def ratio(work: Callable[[], float]) -> float:
    """Return the least time of a piece of work over that of the fixed one, both taking turns."""
    work()
    turns = [(work(), processor_time(fixed)) for _ in range(_TURNS)]
    return min(ours for ours, _ in turns) / min(theirs for _, theirs in turns)


if __name__ == "__main__":
    for name, work in works().items():
        print(f"{name:25} {ratio(work):6.2f}")
