"""Margins at the points of a sweep: held to python-control, and to the roots of numpy on both sides of every end."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from typing import Any

import pytest

from symobs.applications.batch.sweep import table as margins
from symobs.applications.batch.sweep.program import MARGINS, Program
from symobs.exact.algebraic.loop_distances import slowest_root
from symobs.problem import parse
from tests.unit.applications.batch.test_sweep import problem

control = pytest.importorskip("control")
np = pytest.importorskip("numpy")
pytestmark = pytest.mark.slow

#: By kind of time: the poles of K, those of L, and the slowest of each.
POLES = {
    False: {"K": ("-1/2, -2+i, -2-i", "-1/2"), "L": ("-4, -5+3i, -5-3i", "-4")},
    True: {"K": ("1/2, 1/3+1/2i, 1/3-1/2i", "sqrt(13)/6"), "L": ("-1/5, 1/8+1/4i, 1/8-1/4i", "sqrt(5)/8")},
}
TASKS = {"state_feedback": ("K",), "observer": ("L",), "compensator": ("K", "L")}
HALF = {"K": "control_", "L": "observer_"}


class Design:
    """A design for a random plant of third order: our margins, and the loop as others have it."""

    def __init__(self, task: str, drawn: random.Random, *, discrete: bool) -> None:
        gains, A, B, C = TASKS[task], self.drawn(drawn, 3, 3), self.drawn(drawn, 3, 1), self.drawn(drawn, 1, 3)
        plant = {"A": A, **({"B": B} if "K" in gains else {}), **({"C": C} if "L" in gains else {})}
        lines = [f"{name} = {value}" for name, value in plant.items()] + (["dt = 1"] if discrete else [])
        asked = [f'{HALF[g] if len(gains) == 2 else ""}poles = "{POLES[discrete][g][0]}"' for g in gains]
        self.program = Program(parse(problem(task, "", "\n".join(lines), "\n".join(asked))), (), None)
        row = self.program.alone((), None)
        self.is_there = row.status == "done"
        if self.is_there:
            self.entries = dict(zip(self.program.columns(), map(str, row.values), strict=True))
            self._loop(np.array(A), np.array(B), np.array(C), int(discrete), gains)

    @staticmethod
    def drawn(drawn: random.Random, rows: int, columns: int) -> list[list[int]]:
        return [[drawn.randint(-3, 3) for _ in range(columns)] for _ in range(rows)]

    def _loop(self, A: Any, B: Any, C: Any, dt: int, gains: tuple[str, ...]) -> None:
        K, L = (np.array([float(Fraction(text)) for name, text in self.entries.items() if name[0] == g]) for g in "KL")
        if gains == ("K",):
            self.system, self.open, self.closed = control.ss(A, B, [K], 0, dt), np.poly(A), np.poly(A - B * K)
        elif gains == ("L",):
            L = L.reshape(3, 1)
            self.system, self.open, self.closed = control.ss(A, L, C, 0, dt), np.poly(A), np.poly(A - L * C)
        else:
            L = L.reshape(3, 1)
            own = A - B * K - L * C
            self.system = control.ss(own, L, [K], 0, dt) * control.ss(A, B, C, 0, dt)
            self.open = np.polymul(np.poly(A), np.poly(own))
            self.closed = np.polymul(np.poly(A - B * K), np.poly(A - L * C))

    @property
    def at_the_fastest(self) -> list[float]:
        """The gain that brings a root to z = −1, which python-control leaves out."""
        if not self.system.dt:
            return []
        opened, closed = np.polyval(self.open, -1), np.polyval(self.closed, -1)
        return [float(opened / (opened - closed))] if opened / (opened - closed) > 0 else []

    def is_stable(self, k: float) -> bool:
        """Whether numpy finds all roots inside at a gain k."""
        roots = np.roots(self.open + k * (self.closed - self.open))
        return bool((abs(roots) < 1).all() if self.system.dt else (roots.real < 0).all())


@pytest.mark.parametrize("discrete", [False, True])
@pytest.mark.parametrize("task", TASKS)
def test_random_designs_agree_with_python_control_and_numpy(task: str, *, discrete: bool) -> None:
    drawn, seen = random.Random(f"{task} {discrete}"), 0  # noqa: S311
    while seen < 8:
        design = Design(task, drawn, discrete=discrete)
        if not design.is_there:
            continue
        seen += 1
        cells, nearest = margins.cells_at(design.program, (), design.entries)
        found = {name: nearest[name] if name in nearest else value_of(cells[name]) for name in MARGINS}
        assert cells["margins_status"] == "done"
        assert cells["slowest"] == POLES[discrete][TASKS[task][0]][1]
        low, high = found["gain_down"], found["gain_up"]
        gain, phase, modulus, *_ = control.stability_margins(design.system)
        wanted = min(max(each, 1 / each) for each in (gain, *design.at_the_fastest))
        assert min(1 / low if low else math.inf, high) == pytest.approx(wanted, rel=1e-5)
        assert found["phase_deg"] == pytest.approx(abs(phase), abs=1e-4)
        assert found["modulus"] <= modulus + 1e-4
        assert found["modulus"] == pytest.approx(least_distance(design), abs=1e-3)
        inside_it = [low + (1 - low) * 1e-4, (low + 1) / 2, 1.0, 1e3 if high == math.inf else high - (high - 1) * 1e-4]
        assert all(map(design.is_stable, inside_it))
        assert not low or not design.is_stable(low - (1 - low) * 1e-4)
        assert high == math.inf or not design.is_stable(high + (high - 1) * 1e-4)


def value_of(text: str) -> float:
    return math.inf if text == "oo" else float(Fraction(text))


def least_distance(design: Design) -> float:
    """The least of |1 + N/P| on many points of the boundary."""
    at = np.exp(1j * np.linspace(0, np.pi, 40_001)) if design.system.dt else 1j * np.logspace(-5, 5, 40_001)
    with np.errstate(divide="ignore"):  # an integrator
        distances = abs(np.polyval(design.closed, at) / np.polyval(design.open, at))
    return float(min([*distances, *([] if design.system.dt else [1.0])]))


def test_slowest_roots_of_any_polynomial_are_exact() -> None:
    """Real parts and moduli of roots without a closed form: x³ + x + 1 has one pair, of real part −r/2 for its root r."""
    cases: list[tuple[list[int], bool, str]] = [
        ([1, 0, 1, 1], False, "CRootOf(8*x**3 + 2*x - 1, 0)"),
        ([1, 3, 3, 2], False, "-1/2"),
        ([1, 2, 2], True, "sqrt(2)"),
        ([1, 0, 0, 0, 4], False, "1"),
        ([1, 1, 0], True, "1"),
    ]
    for coefficients, discrete, wanted in cases:
        assert slowest_root([Fraction(c) for c in coefficients], discrete=discrete).text() == wanted
        roots = np.roots(coefficients)
        size = max(abs(roots)) if discrete else max(roots.real)
        assert value_near(slowest_root([Fraction(c) for c in coefficients], discrete=discrete)) == pytest.approx(size)


def value_near(number: Any) -> float:
    low, high = number.interval()
    return float((low + high) / 2)


SPRING = problem(
    "state_feedback", "c:positive", 'A = "[0 1; -c 0]"\nB = "[0; 1]"', 'poles = "-1, -2"'
)  # K = [2 − c, 3]: P + kN = s² + 3ks + c + k(2 − c)


def test_what_is_not_stable_has_no_margins_and_what_takes_long_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    program = Program(parse(SPRING.replace("-1, -2", "1, -2")), ("c",), None)
    entries = dict(zip(program.columns(), map(str, program.alone((Fraction(1),), None).values), strict=True))
    cells, _ = margins.cells_at(program, (Fraction(1),), entries)
    assert cells == {"slowest": "1", "margins_status": "unstable"}
    monkeypatch.setattr(margins, "_SECONDS", 0.0001)
    design = Design("compensator", random.Random(3), discrete=False)  # noqa: S311
    assert margins.cells_at(design.program, (), design.entries) == ({"margins_status": "undecided"}, {})
