"""Models as courses print them: A and B by SymPy, and all equilibria by a numeric search from many starts."""

from __future__ import annotations

import random
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import root  # type: ignore[import-untyped]

import symobs

MODELS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_suffix(".toml").with_stem("models_of_motion").read_text("utf-8")
)["model"]
T = sp.Symbol("time")
_FUNCTIONS = {"sin", "cos", "sqrt", "exp", "acos", "asin", "atan", "pi", "CRootOf"}
_STARTS = 400


def _names(given: dict[str, Any]) -> tuple[list[str], list[str]]:
    """The variables without primes, and the inputs."""
    listed = given.get("coordinates") or [name for name in given["states"] if not name.endswith("'")]
    return listed, given.get("inputs", [])


def _read(text: str, known: dict[str, Any] | None = None) -> sp.Expr:
    """A text of this file, or one that is found; all names but those of functions are symbols."""
    free = {name: sp.Symbol(name) for name in re.findall(r"[A-Za-z]\w*", text) if name not in _FUNCTIONS}
    return sp.sympify(text.replace("^", "**"), locals={**free, **(known or {})})  # noqa: TID251


class Model:
    """Equations of motion by SymPy alone, with functions of time in place of the variables."""

    def __init__(self, model: dict[str, Any]) -> None:
        self.plant = model["plant"]
        self.variables, self.inputs = _names(self.plant)
        self.of_time = {name: sp.Function(f"{name}_of")(T) for name in self.variables}
        texts = self.plant.get("equations")
        self.equations = (
            self._lagrange()
            if texts is None
            else [self._read(f"({a})-({b})") for a, b in (t.split("=") for t in texts)]
        )
        self.symbols = {name: sp.Symbol(name) for name in (*self.variables, *self.inputs)}

    def _read(self, text: str) -> sp.Expr:
        named: dict[str, Any] = {}

        def derivative(found: re.Match[str]) -> str:
            key = f"{found[1]}_d{len(found[2])}"
            named[key] = sp.diff(self.of_time[found[1]], T, len(found[2]))
            return key

        text = re.sub(r"(\w+)('+)", derivative, text)
        return _read(text, {**self.of_time, **named})

    def _lagrange(self) -> list[sp.Expr]:
        kinetic, potential = self._read(self.plant["kinetic"]), self._read(str(self.plant.get("potential", "0")))
        forces = {name: self._read(text) for name, text in self.plant.get("forces", {}).items()}
        L, found = kinetic - potential, []
        for name, q in self.of_time.items():
            found.append(sp.diff(L.diff(q.diff(T)), T) - L.diff(q) - forces.get(name, 0))
        return found

    def jacobians(self, plant: symobs.StateSpace, values: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
        """A and B at the equilibrium that was found, at values of the parameters."""
        point = dict(plant.nonlinear.equilibrium)  # type: ignore[union-attr]
        highest = {}
        for name, q in self.of_time.items():
            order = max(int(d.derivative_count) for e in self.equations for d in e.atoms(sp.Derivative) if d.expr == q)
            highest[name] = q.diff(T, order)
        w = {d: sp.Symbol(f"w_{name}") for name, d in highest.items()}
        plain = [e.subs(w) for e in self.equations]
        (solution,) = sp.solve(plain, list(w.values()), dict=True)
        states = plant.nonlinear.states  # type: ignore[union-attr]
        to_symbols = [(q.diff(T), sp.Symbol(f"{name}_dot")) for name, q in self.of_time.items()]
        to_symbols += [(q, sp.Symbol(name)) for name, q in self.of_time.items()]
        rates = []
        for state in states:
            stem = state.removesuffix("_dot")
            is_first = sp.Symbol(f"w_{stem}") in solution and (state != stem or f"{stem}_dot" not in states)
            rate = solution[sp.Symbol(f"w_{stem}")] if is_first else sp.Symbol(f"{stem}_dot")
            rates.append(rate.subs(to_symbols))
        at = {sp.Symbol(name): _read(str(value)) for name, value in point.items()}
        found = []
        for names in (states, self.inputs):
            J = sp.Matrix(rates).jacobian([sp.Symbol(name) for name in names]) if names else sp.zeros(len(states), 0)
            found.append(
                np.array(J.subs(at).subs(values).evalf().tolist(), dtype=float).reshape(len(states), len(names))
            )
        return found[0], found[1]


def _values(model: dict[str, Any], plant: symobs.StateSpace, draw: random.Random) -> dict[sp.Symbol, float]:
    names = {*model["positive"].split(), *map(str, plant.A.free_symbols | plant.B.free_symbols)}
    names |= {str(s) for _, v in plant.nonlinear.equilibrium for s in _read(str(v)).free_symbols}  # type: ignore[union-attr]
    return {sp.Symbol(name): draw.uniform(0.6, 1.4) * (3 if name in {"omega", "k"} else 1) for name in sorted(names)}


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model["name"])
def test_matrices_are_those_of_sympy(model: dict[str, Any]) -> None:
    signs = dict.fromkeys(model["positive"].split(), "positive")
    plant = symobs.linearize(**model["plant"], equilibrium=model["equilibrium"], symbols=signs)
    values = _values(model, plant, random.Random(7))  # noqa: S311
    A, B = Model(model).jacobians(plant, values)
    for found, wanted in ((plant.A, A), (plant.B, B)):
        here = np.array(found.subs(values).evalf().tolist(), dtype=float).reshape(wanted.shape)
        assert np.allclose(here, wanted, rtol=1e-9, atol=1e-9)
    assert plant.nonlinear is not None
    page = symobs.characteristic_polynomial(plant).to("text")
    assert "linearised plant" in page


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model["name"])
def test_no_zero_of_a_numeric_search_is_missing(model: dict[str, Any]) -> None:
    """The inputs that are given are held, others at 0, or at 1 where they are positive."""
    signs = dict.fromkeys(model["positive"].split(), "positive")
    held = {name: model["equilibrium"].get(name, int(name in signs)) for name in model["plant"].get("inputs", [])}
    found = symobs.equilibria({**model["plant"], "equilibrium": held, "symbols": signs})
    by_sympy, draw = Model(model), random.Random(3)  # noqa: S311
    still = {d: 0 for e in by_sympy.equations for d in e.atoms(sp.Derivative)}
    at_rest = [
        e.subs(still).subs({q: sp.Symbol(name) for name, q in by_sympy.of_time.items()}) for e in by_sympy.equations
    ]
    used = sorted(set().union(*(e.free_symbols for e in (*at_rest, *(_read(str(v)) for v in held.values())))), key=str)
    unknown = [sp.Symbol(name) for name in by_sympy.variables]
    values = {s: draw.uniform(0.6, 1.4) * (3 if str(s) in {"omega", "k"} else 1) for s in used if s not in unknown}
    values |= {sp.Symbol(name): _read(str(value)).subs(values) for name, value in held.items()}
    f = sp.lambdify(unknown, [e.subs(values) for e in at_rest], "numpy")  # noqa: TID251 - texts of this file
    positive = [s for s in unknown if str(s) in signs]
    roots: list[np.ndarray] = []
    numbers = np.random.default_rng(5)
    for _ in range(_STARTS):
        start = numbers.uniform(-4, 4, len(unknown))
        start = np.where([s in positive for s in unknown], np.abs(start) + 0.05, start)
        with np.errstate(all="ignore"):
            solved = root(lambda x: np.array(f(*x), dtype=float), start, tol=1e-13)
        if solved.success and np.all(np.isfinite(solved.x)) and np.max(np.abs(f(*solved.x))) < 1e-9:
            roots.append(solved.x)
    points = [
        ({name: _read(str(value)) for name, value in point.items()}, conditions)
        for point, conditions in zip(found.fields["points"], found.fields["conditions"], strict=True)
    ]
    here = [p for p, conditions in points if all(_holds(c, values) for c in conditions)]
    assert found.fields["complete"] == (model["name"] not in OPEN)
    for x in roots:
        if any(x[unknown.index(s)] <= 1e-6 for s in positive) or not found.fields["complete"]:
            continue
        assert any(_is_near(point, unknown, x, values) for point in here), dict(zip(unknown, x, strict=True))


#: Whose equilibria are not all found: transcendental, or of degree three with letters.
OPEN = {"stirred tank reactor, cooled"}


def _holds(condition: Any, values: dict[Any, Any]) -> bool:
    value = float(_read(str(condition.expression)).subs(values))
    return {">": value > 0, ">=": value >= 0, "!=": value != 0, "==": abs(value) < 1e-12}[condition.operator]


def _is_near(point: dict[str, sp.Expr], unknown: list[sp.Symbol], x: np.ndarray, values: dict[Any, Any]) -> bool:
    at = dict(zip(unknown, x, strict=True))
    for s in unknown:
        value = point[str(s)]
        wanted = complex(value.subs({t: at[t] for t in unknown}).subs(values).evalf())
        gap = (x[unknown.index(s)] - wanted.real + np.pi) % (2 * np.pi) - np.pi  # angles count modulo 2π
        if abs(wanted.imag) > 1e-9 or min(abs(gap), abs(x[unknown.index(s)] - wanted.real)) > 1e-5:
            return False
    return True
