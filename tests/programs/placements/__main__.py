"""Gains of several inputs or outputs beside those of scipy.signal.place_poles: a program.

Run it by `python -m tests.programs.placements --plants 100`.

For the plants of the literature in plants.toml, and for random ones in either time, a state feedback or an observer is
designed with `choose`.  Its largest entry, the condition of its eigenvectors and the seconds of the processor stand beside
the largest entry and the condition of both methods of SciPy: that of Kautsky, Nichols and Van Dooren (KNV0) for real poles,
and that of Tits and Yang (YT).  The polynomial of A − B K is held against the poles in exact arithmetic of its own.
"""

from __future__ import annotations

import argparse
import time
import warnings
from fractions import Fraction
from pathlib import Path
from random import Random
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.signal import place_poles  # type: ignore[import-untyped]

import symobs
from tests.kit import tables

if TYPE_CHECKING:
    from collections.abc import Iterator

Rows = list[list[str]]


class Problem(NamedTuple):
    """A pair (A, B) and the poles of A − B K; with `dual` K is the transposed gain of an observer."""

    name: str
    A: Rows
    B: Rows
    poles: list[str]
    dual: bool = False
    dt: bool = False

    def gain(self, choose: str) -> list[list[Fraction]]:
        """Return K as symobs finds it."""
        if self.dual:
            plant = symobs.StateSpace(_transposed(self.A), C=_transposed(self.B), dt=self.dt)
            found = symobs.observer(plant, poles=self.poles, choose=choose).L.T
        else:
            plant = symobs.StateSpace(self.A, self.B, dt=self.dt)
            found = symobs.state_feedback(plant, poles=self.poles, choose=choose).K
        return [[Fraction(int(entry.p), int(entry.q)) for entry in found.row(i)] for i in range(found.rows)]

    @property
    def numbers(self) -> tuple[Any, Any, list[complex]]:
        """A, B and the poles in floating point."""
        A, B = (np.array([[float(Fraction(entry)) for entry in row] for row in rows]) for rows in (self.A, self.B))
        return A, B, [complex(pole.replace("i", "j")) for pole in self.poles]


class Measured(NamedTuple):
    """What is compared of a gain."""

    largest: float
    condition: float
    seconds: float = 0.0


def literature() -> Iterator[Problem]:
    """Yield the plants of plants.toml."""
    for name, plant in tables(Path(__file__).with_name("plants")).items():
        yield Problem(name, _texts(plant["A"]), _texts(plant["B"]), plant["poles"])


def at_random(count: int, seed: int = 0) -> Iterator[Problem]:
    """Yield controllable plants of order 3 to 6 with two or three inputs: of integers, or sampled ones of decimals."""
    chance = Random(seed)  # noqa: S311 - plants, not keys
    found = 0
    while found < count:
        n, m, sampled = chance.randint(3, 6), chance.randint(2, 3), chance.random() < 0.5
        size = 0.4 if chance.random() < 0.5 else 0.0

        def entry(unit: int, zeros: float = size) -> str:
            number = 0 if chance.random() < zeros else chance.randint(-9, 9)
            return str(Fraction(number, unit))

        A = [[entry(10 if sampled else 1) for _ in range(n)] for _ in range(n)]
        B = [[entry(1, 0.4) for _ in range(m)] for _ in range(n)]
        poles = _poles(chance, n, m, sampled=sampled)
        problem = Problem(f"random {found}", A, B, poles, dual=chance.random() < 0.5, dt=sampled)
        if _is_controllable(problem):
            found += 1
            yield problem


def _poles(chance: Random, n: int, m: int, *, sampled: bool) -> list[str]:
    """Return n poles, pairs among them, none more often than there are inputs."""
    poles: list[str] = []
    while len(poles) < n:
        real = Fraction(chance.randint(-8, 8), 10) if sampled else Fraction(-chance.randint(1, 12))
        if len(poles) + 2 <= n and chance.random() < 0.3:
            imaginary = Fraction(chance.randint(1, 5), 10) if sampled else Fraction(chance.randint(1, 6))
            new = [f"{float(real)}+{float(imaginary)}i", f"{float(real)}-{float(imaginary)}i"]
        else:
            new = [str(float(real))]
        if poles.count(new[0]) < m:
            poles += new
    return poles


def _is_controllable(problem: Problem) -> bool:
    """Return whether rank B = m and rank [B, AB, …] = n, well away from less."""
    A, B, _ = problem.numbers
    powers = np.hstack([np.linalg.matrix_power(A, k) @ B for k in range(len(A))])
    return bool(np.linalg.matrix_rank(B) == B.shape[1] and np.linalg.svd(powers)[1][-1] > 1e-3)


def measured(problem: Problem, choose: str) -> Measured:
    """Return the size and condition of the gain of symobs; raises AssertionError where a pole is another one."""
    start = time.process_time()
    K = problem.gain(choose)
    seconds = time.process_time() - start
    A, B = ([[Fraction(entry) for entry in row] for row in rows] for rows in (problem.A, problem.B))
    fed = [[sum(b * k for b, k in zip(row, column, strict=True)) for column in zip(*K, strict=True)] for row in B]
    closed = [[a - f for a, f in zip(left, right, strict=True)] for left, right in zip(A, fed, strict=True)]
    assert characteristic_polynomial(closed) == polynomial_with(problem.poles), problem
    condition = condition_with(np.array(closed, dtype=float), problem.numbers[2])
    return Measured(float(max(abs(k) for row in K for k in row)), condition, seconds)


def condition_with(closed: Any, poles: list[complex]) -> float:
    """Return the condition of the eigenvectors, orthogonal ones for a repeated pole; infinite where there are too few."""
    spaces = []
    for pole in dict.fromkeys(poles):
        _, sizes, rows = np.linalg.svd(closed - pole * np.eye(len(closed)))
        count = poles.count(pole)
        if sizes[-count] > 1e-6 * (1 + sizes[0]):
            return float("inf")
        spaces.append(rows[-count:].conj().T)
    return float(np.linalg.cond(np.hstack(spaces)))


def characteristic_polynomial(A: list[list[Fraction]]) -> list[Fraction]:
    """Return the coefficients of det(sI − A) after the first by Faddeev and LeVerrier."""
    n = len(A)
    found: list[Fraction] = []
    M = [[Fraction(0)] * n for _ in range(n)]
    last = Fraction(1)
    for k in range(1, n + 1):
        M = [[sum(A[i][l] * M[l][j] for l in range(n)) + last * (i == j) for j in range(n)] for i in range(n)]
        last = -sum((A[i][l] * M[l][i] for i in range(n) for l in range(n)), start=Fraction(0)) / k
        found.append(last)
    return found


def polynomial_with(poles: list[str]) -> list[Fraction]:
    """Return the coefficients after the first of the polynomial with these poles, in rational complex numbers."""
    found = [(Fraction(1), Fraction(0))]
    for pole in poles:
        real, imaginary = _parts(pole)
        shifted = [
            (Fraction(0), Fraction(0)),
            *((r * real - i * imaginary, r * imaginary + i * real) for r, i in found),
        ]
        found = [(a[0] - b[0], a[1] - b[1]) for a, b in zip([*found, (Fraction(0), Fraction(0))], shifted, strict=True)]
    assert not any(imaginary for _, imaginary in found)
    return [real for real, _ in found[1:]]


def _parts(pole: str) -> tuple[Fraction, Fraction]:
    """Return the real and the imaginary part of -1.5+2i."""
    if not pole.endswith("i"):
        return Fraction(pole), Fraction(0)
    cut = max(pole.rfind("+"), pole.rfind("-"))
    return Fraction(pole[:cut]), Fraction(pole[cut:-1] + "1" * (pole[cut + 1 : -1] == ""))


def by_scipy(problem: Problem) -> dict[str, Measured]:
    """Return what SciPy's methods find."""
    found = {}
    A, B, poles = problem.numbers
    for method in ("YT", "KNV0"):
        if method == "YT" or not any(pole.imag for pole in poles):
            with warnings.catch_warnings(action="ignore"):
                placed = place_poles(A, B, poles, method=method, maxiter=200, rtol=1e-6)
            largest = float(np.abs(placed.gain_matrix).max())
            found[method] = Measured(largest, float(np.linalg.cond(placed.X)))
    return found


def _texts(rows: list[list[float]]) -> Rows:
    return [[f"{entry:.15f}".rstrip("0").rstrip(".") for entry in row] for row in rows]


def _transposed(rows: Rows) -> Rows:
    return [list(row) for row in zip(*rows, strict=True)]


def main() -> None:
    """Print one line for each plant, then the median and the worst of the ratios to SciPy's."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.placements", description=__doc__)
    parser.add_argument("--plants", type=int, default=100, help="how many random plants")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--choose", default="small", choices=["small", "simple", "auto"])
    asked = parser.parse_args()
    print(f"{'plant':<26}{'largest':>12}{'condition':>12}{'seconds':>9}{'YT':>22}{'KNV0':>22}{'ratios':>14}")
    for title, problems in (("literature", literature()), ("random", at_random(asked.plants, asked.seed))):
        ratios, seconds = [], []
        for problem in problems:
            own, others = measured(problem, asked.choose), by_scipy(problem)
            best = min(others.values(), key=lambda other: other.condition)
            ratios.append((own.largest / best.largest, own.condition / best.condition))
            seconds.append(own.seconds)
            shown = "".join(
                f"{f'{one.largest:.4g}, {one.condition:.4g}' if (one := others.get(method)) else '':>22}"
                for method in ("YT", "KNV0")
            )
            told = f"{own.largest:>12.4g}{own.condition:>12.4g}{own.seconds:>9.2f}"
            print(f"{problem.name:<26}{told}{shown}{ratios[-1][0]:>7.2f}{ratios[-1][1]:>7.2f}", flush=True)
        for name, values in zip(("largest entry", "condition"), zip(*ratios, strict=True), strict=True):
            print(f"{title}: {name}, ratio: median {median(values):.2f}, greatest {max(values):.2f}")
        print(f"{title}: seconds: median {median(seconds):.2f}, greatest {max(seconds):.2f}")


if __name__ == "__main__":
    main()
