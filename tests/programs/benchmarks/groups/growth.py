"""How time grows with the order, with the number of parameters and with the degree: exponents fitted to the logarithms."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import symobs
from tests.programs.benchmarks import models
from tests.programs.benchmarks.groups.numeric import design
from tests.programs.benchmarks.measuring import Row, exponent, medians, processor_time, written

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from tests.programs.benchmarks.measuring import Settings

PLACE = 10
_SERIAL = itertools.count()


def rows(settings: Settings) -> Iterator[Row]:
    """Yield a fitted exponent a family."""
    families: tuple[tuple[str, str, Sequence[int], Callable[[int], float]], ...] = (
        ("dense rational: L", "n", (10, 20, 30, 50, 70), lambda n: processor_time(lambda: design(n))),
        ("3x3 with k symbols of 15: L", "k", (3, 6, 9, 12, 15), with_symbols),
        ("chain of n masses, 3 symbols, numeric poles: L", "n", (2, 4, 6, 8), chain),
        ("region in two gains, degree d", "d", (2, 3, 4, 5, 6), region),
        ("region in one gain, degree d", "d", (2, 4, 6, 8, 10), lambda d: region(d, 1)),
    )
    for work, letter, sizes, subject in families:
        subjects = {str(size): lambda size=size, subject=subject: subject(size) for size in sizes}
        found = list(medians(min(settings.repetitions, 5), subjects).values())
        told = f"{letter} = {', '.join(map(str, sizes))}: {written(found[0], 's')} to {written(found[-1], 's')}"
        yield Row(f"{work}, time ~ {letter}^", exponent(sizes, found), told, unit="")


def with_symbols(count: int) -> float:
    """Return the time for L of a third-order plant with so many symbols, numbers in the place of the others."""
    model = models.generic(3)
    texts = [model.A, model.C, ", ".join(model.observer_poles)]
    for k, name in enumerate(list(model.plain)[count:]):
        texts = [text.replace(name, str((7 * k * k + 3 * k + 2) % 11 + 1)) for text in texts]
    A, C, poles = texts
    return processor_time(lambda: symobs.observer(symobs.StateSpace(A, None, C), poles=poles))


def chain(order: int) -> float:
    """Return the time for L of a chain of masses, springs and dampers, the place of the last measured."""
    m, k, d = (f"{letter}_{next(_SERIAL)}" for letter in "mkd")
    half = order // 2
    rows = [["1" if j == i + half else "0" for j in range(order)] for i in range(half)]
    for i in range(half):
        ends = 1 if i in {0, half - 1} and half > 1 else 2
        line = ["0"] * order
        for shift, name in ((0, k), (half, d)):
            line[i + shift] = f"-{ends}*{name}/{m}"
            for other in (i - 1, i + 1):
                if 0 <= other < half:
                    line[other + shift] = f"{name}/{m}"
        rows.append(line)
    A = "[" + "; ".join(" ".join(row) for row in rows) + "]"
    C = [[int(j == half - 1) for j in range(order)]]
    poles = [-j for j in range(1, order + 1)]
    return processor_time(lambda: symobs.observer(symobs.StateSpace(A, None, C), poles=poles))


def region(degree: int, gains: int = 2) -> float:
    """Return the time for the region of stability of (s + 1)^d + h1 s + h2, or + h1 alone."""
    names = [f"h{k}_{next(_SERIAL)}" for k in range(gains)]
    polynomial = f"(s + 1)^{degree} + {names[0]}{f' s + {names[1]}' if gains == 2 else ''}"

    def found() -> object:
        return symobs.stability_region(polynomial, parameters=names, symbols=dict.fromkeys(names, "real")).fields

    return processor_time(found)
