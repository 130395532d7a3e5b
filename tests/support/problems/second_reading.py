"""The files of the worked examples read a second time, into SymPy: nothing here asks symobs for anything."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import sympy

from tests.support.algebra import evaluated
from tests.support.paths import ROOT

FOLDER = ROOT / "worked_examples"
_FUNCTIONS = {name: getattr(sympy, name) for name in ("sqrt", "exp", "sin", "cos")}
_NAMES = {"i": sympy.I, "j": sympy.I, "I": sympy.I, "pi": sympy.pi, "inf": sympy.oo}
#: What the gains of a book's letters and signs are in u = −K x and A − L C: K for plusK, M for plusMC, H for minusHC.
_GAINS = {"K": "K", "L": "L", "M": "L", "H": "L"}


def expression(text: object, constants: dict[str, Any] | None = None) -> Any:
    """Return an expression: decimals are fractions, factors may stand beside each other."""
    written = re.sub(
        r"(\d+)\.(\d+)", lambda found: f"({int(found[1] + found[2])}/{10 ** len(found[2])})", str(text).strip()
    )
    written = re.sub(r"(?<=[\w)])\s+(?=[\w(])", "*", re.sub(r"(?<=\d)(?=[ij]\b)", "*", written))
    names = {name: sympy.Symbol(name) for name in re.findall(r"[A-Za-z_]\w*", written)}
    return evaluated(written, {**names, **_NAMES, **(constants or {})}, _FUNCTIONS, sympy.Integer)


def matrix(given: Any, constants: dict[str, Any], *, column: bool = False) -> Any:
    """Return a matrix written as a text, a list of rows, or a list of one row or column."""
    if isinstance(given, str) and given.startswith("["):
        given = [re.split(r"\s+(?![^()]*\))", row.strip()) for row in given.strip("[]").split(";")]
    rows = given if isinstance(given, list) else [given]
    if not isinstance(rows[0], list):
        rows = [[entry] for entry in rows] if column else [rows]
    return sympy.Matrix([[expression(entry, constants) for entry in row] for row in rows])


def canonical(function: Any) -> dict[str, Any]:
    """Return the controllable canonical form of a strictly proper function of s."""
    s = sympy.Symbol("s")
    above, below = (sympy.Poly(part, s).all_coeffs() for part in sympy.fraction(sympy.cancel(function)))
    order = len(below) - 1
    A = sympy.zeros(order, order)
    A[:-1, 1:] = sympy.eye(order - 1)
    A[-1, :] = sympy.Matrix([[-c / below[0] for c in reversed(below[1:])]])
    ascending = [*(c / below[0] for c in reversed(above)), *([0] * (order - len(above)))]
    return {"A": A, "B": sympy.eye(order)[:, -1], "C": sympy.Matrix([ascending])}


def tasks_of(name: str) -> list[str]:
    """Return the tasks of a worked example, `minimal` among them where an observer of minimal order is asked for."""
    data = tomllib.loads((FOLDER / f"{name}.toml").read_text("utf-8"))
    return [*(data.get("tasks") or [data["task"]]), str(data.get("specification", {}).get("observer", ""))]


def given(name: str) -> dict[str, Any]:
    """Return the plant of a worked example and what is asked about it, under the names of the problems by hand."""
    data = tomllib.loads((FOLDER / f"{name}.toml").read_text("utf-8"))
    plant, asked = data["plant"], data.get("specification", {})
    constants = {key: expression(text) for key, text in data.get("constants", {}).items()}
    found: dict[str, Any] = {"signs": data.get("symbols", {})}
    if "transfer_function" in plant:
        found |= canonical(expression(plant["transfer_function"]))
    found |= {x: matrix(plant[x], constants, column=x == "B") for x in "ABCD" if x in plant}
    if "D" in found and found["D"].is_zero_matrix:
        del found["D"]
    if plant.get("dt"):
        found["variable"] = sympy.Symbol("z")
    for key, value in asked.items():
        prefix, _, kind = key.rpartition("_")
        if kind in {"poles", "polynomial"}:
            found[prefix or "poles"] = polynomial(value, found.get("variable", sympy.Symbol("s")), constants)
        elif key in _GAINS:
            sign = -1 if str(data.get("convention", "")).startswith("plusK") and key in "KM" else 1
            found[_GAINS[key]] = sign * matrix(value, constants, column=key != "K")
        elif key in {"E", "S"}:
            found[key] = matrix(value, constants, column=True)
        elif key == "reference_matrix":
            found["reference"] = matrix(value, constants)
        elif key in {"input", "output"}:
            found[key] = sympy.Matrix([expression(value)])
        elif key in {"Q", "R"}:
            found[key] = expression(value)
        elif key in {"horizon", "sampling_period"}:
            found["horizon"] = expression(value)
        elif key == "sign":
            found["sign"] = value
    return found | {"tasks": tasks_of(name)}


def polynomial(value: Any, variable: Any, constants: dict[str, Any]) -> Any:
    """Return the polynomial that poles, or a text, ask for."""
    if isinstance(value, str) and variable in expression(value.split(",")[0], constants).free_symbols:
        return expression(value, constants)
    poles = value.split(",") if isinstance(value, str) else value
    return sympy.prod(variable - expression(pole, constants) for pole in poles)
