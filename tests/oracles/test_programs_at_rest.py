"""Programs of nonlinear plants, compiled and run against the nonlinear equations, which SymPy derives: they balance."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

import symobs

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_PERIOD, _STEPS = 0.01, 1_500
_KINETIC = "1/2*x'^2 + 1/10*((x' + 1/2*theta'*cos(theta))^2 + (1/2*theta'*sin(theta))^2)"


@cache
def cart_and_pendulum() -> Callable[[Any, float], Any]:
    """x″ and θ″ of M = 1, m = 1/5, l = 1/2, g = 9.81 by Lagrange's equations in SymPy; θ = 0 hangs."""
    t = sp.Symbol("t")
    x, theta, F = sp.Function("x")(t), sp.Function("theta")(t), sp.Symbol("F")
    place = x + theta.func(t) * 0 + sp.sin(theta) / 2, -sp.cos(theta) / 2
    kinetic = x.diff(t) ** 2 / 2 + sum(part.diff(t) ** 2 for part in place) / 10
    L = kinetic - sp.Rational(981, 100) / 5 * place[1]
    equations = [(L.diff(q.diff(t)).diff(t) - L.diff(q)) - force for q, force in ((x, F), (theta, 0))]
    w = sp.symbols("x2 theta2")
    plain = [e.subs({x.diff(t, 2): w[0], theta.diff(t, 2): w[1]}) for e in equations]
    solved = sp.solve(plain, w)
    state = sp.symbols("a b c d")
    names = [(x.diff(t), state[2]), (theta.diff(t), state[3]), (x, state[0]), (theta, state[1])]
    found: Callable[[Any, float], Any]
    found = sp.lambdify([state, F], [solved[each].subs(names) for each in w], "numpy")  # noqa: TID251 - our own
    return found


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs a compiler of C")
def test_a_compensator_in_c_balances_the_pendulum_upright(tmp_path: Path) -> None:
    plant = symobs.linearize(
        coordinates=["x", "theta"],
        inputs="F",
        kinetic=_KINETIC,
        potential="-981/1000*cos(theta)",
        forces={"x": "F"},
        h=["x", "theta"],
        equilibrium={"theta": "pi"},
    )
    design = symobs.compensator(plant, control_poles="-2, -5/2, -3, -7/2", observer_poles="-8, -9, -10, -11")
    (tmp_path / "program.c").write_text(str(design.to("c", period="1/100")), "utf-8")
    built = [str(tmp_path / name) for name in ("program.so", "program.c")]
    subprocess.run(["gcc", "-shared", "-fPIC", "-O2", "-o", *built], check=True)
    program = ctypes.CDLL(built[0])
    state, u = (ctypes.c_double * 4)(), (ctypes.c_double * 1)()
    program.compensator_start(ctypes.byref(state))
    accelerations = cart_and_pendulum()
    at = np.array([0.3, np.pi - 0.15, 0.0, 0.2])  # away from the upright position, and moving
    for _ in range(_STEPS):
        y = (ctypes.c_double * 2)(at[0], at[1])
        program.compensator_step(ctypes.byref(state), y, u)
        force = float(u[0])
        whole = solve_ivp(lambda _, z: [z[2], z[3], *accelerations(z, force)], (0, _PERIOD), at, rtol=1e-8, atol=1e-10)  # noqa: B023
        at = whole.y[:, -1]
    assert np.allclose(at, [0, np.pi, 0, 0], atol=1e-4)


def test_a_program_in_python_gives_the_current_at_which_the_ball_rests() -> None:
    """m = 1/10, c = 1/1000, g = 10 at d = 1/50: i = d sqrt(m g/c) = sqrt(1000)/50 where nothing has happened yet."""
    plant = symobs.linearize(
        coordinates="d", inputs="i", equations=["d''/10 = 1 - i^2/(1000*d^2)"], equilibrium={"d": "1/50"},
        symbols={"d": "positive", "i": "positive"},
    )  # fmt: skip
    design = symobs.compensator(plant, control_poles="-30, -40", observer_poles="-150, -160")
    names: dict[str, Any] = {}
    exec(str(design.to("python", period="1/1000")), names)  # noqa: S102 - our own program
    (current,) = names["Compensator"]().step([0.02])
    assert abs(current - np.sqrt(1000) / 50) < 1e-12
