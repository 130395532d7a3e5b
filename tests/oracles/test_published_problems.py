"""Published problems, typed as their sources print them, go through at first try, and other means confirm every answer.

The rows of `published_problems.toml` are run as the files that a reader would type, those of `textbook_problems.toml` from
Python.  Their data are read here a second time, with a number in place of every parameter; plain fractions hold what the
answer claims to them, and the answer is held to what is printed.
"""

from __future__ import annotations

import itertools
import json
import re
import tomllib
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy

import symobs
from symobs import problem
from symobs.ground.errors import SymobsError
from tests.kit import tabled
from tests.support.algebra import characteristic, matrix_at
from tests.support.claims.claims import HOLDS, Setting, applicable

TABLE, BOOKS = (
    tomllib.loads(Path(__file__).with_name(f"{name}_problems.toml").read_text("utf-8"))
    for name in ("published", "textbook")
)
s, z, t = sympy.symbols("s z t")
NAMES = {name: getattr(sympy, name) for name in ("sin", "cos", "exp", "sqrt", "pi", "oo", "Rational")}
NAMES |= {"s": s, "z": z, "t": t, "i": sympy.I, "j": sympy.I}


def of_book(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row of a textbook in the form of the others: every name in its data is a real parameter."""
    plant = {key: row[key] for key in (*"ABCD", "transfer_function", "dt") if key in row}
    about = {"source", "task", "verdict", "printed", "refused", "tolerance", *plant}
    given = {key: value for key, value in row.items() if key not in about}
    typed = " ".join(str(v) for k, v in (plant | given).items() if k not in {"kind", "of", "observer", "dt"})
    names = {*re.findall(r"[A-Za-z]\w*", re.sub(r"(?<=\d)(?=[A-Za-z])", " ", typed))} - {*NAMES, "inf"}
    found = {key: row[key] for key in ("source", "task", "printed", "verdict", "refused", "tolerance") if key in row}
    own = {"name": row["source"], "plant": plant, "specification": given, "book": True}
    return found | own | {"symbols": dict.fromkeys(sorted(names), "real")}


ROWS = [*TABLE["problems"], *map(of_book, (*BOOKS["problems"], *BOOKS["algebraic"]))]


def point(name: str) -> Any:
    """A rational number for a parameter: another one for another name."""
    return sympy.Rational(2 + sum(map(ord, name)) % 23, 7)


def solved(row: dict[str, Any]) -> Any:
    """The answer to a row, read as `symobs solve` reads a file, or that of Python, where nothing is declared."""
    if row.get("book"):
        return of_python(row)
    own = {"name", "printed", "tolerance", "first_try", "refused"}
    (result,) = problem.read(json.dumps({key: row[key] for key in row if key not in own})).solve()
    return result


def of_python(row: dict[str, Any]) -> Any:
    given, asked = row["plant"], dict(row["specification"])
    plant = None
    if "transfer_function" in given:
        plant = symobs.StateSpace.from_transfer_function(given["transfer_function"], given.get("dt", 0))
    elif "A" in given:
        A, B, C, D = (given.get(name) for name in "ABCD")
        plant = symobs.StateSpace(A, B, C, D, dt=given.get("dt", 0))
    elif "dt" in given:
        plant = symobs.StateSpace.from_polynomial(asked.pop("polynomial"), given["dt"])
    return getattr(symobs, row["task"])(plant, **asked)


def floats(matrix: Any) -> Any:
    return np.array(sympy.Matrix(matrix).evalf(30).tolist(), dtype=complex).real


def close(found: Any, wanted: Any, room: float = 1e-9) -> bool:
    return bool(np.allclose(floats(found), floats(wanted), rtol=room, atol=room * 1e-3))


GRID = [sympy.Rational(n, 2) for n in (-9, -3, -1, 1, 2, 3, 5, 7, 9, 14, 31, 90, 400, 8597, 8598, 59999, 60001)]


def number(value: Any) -> Fraction:
    return Fraction(int(value.p), int(value.q))


class Data:
    """The data of a row, with the numbers of the row or of `point` in place of its parameters, and the checks."""

    def __init__(self, row: dict[str, Any], plant: Any) -> None:
        self.row, self.plant, self.given = row, row.get("plant", {}), row.get("specification", {})
        self.discrete, self.x = bool(self.plant.get("dt")), z if self.plant.get("dt") else s
        fixed = row.get("values", {}) | row.get("constants", {})
        self.numbers = {name: sympy.Rational(str(fixed.get(name, point(name)))) for name in row.get("symbols", fixed)}
        if "transfer_function" in self.plant:  # the realisation found, if it is one
            self.A, self.B, self.C, self.D = (self.at(sympy.Matrix(getattr(plant, name))) for name in "ABCD")
            typed = self.plant["transfer_function"]
            wanted = self.matrix(typed) if typed.startswith("[") else sympy.Matrix([[self.value(typed)]])
            assert all(
                self.function_at(number) == wanted.subs(self.x, number) for number in (sympy.Rational(22, 7), 11)
            )
        else:
            self.A, self.B, self.C = (self.matrix(self.plant[n]) if n in self.plant else None for n in "ABC")
            size = self.C.rows if self.C else 0, self.B.cols if self.B else 0
            self.D = self.matrix(self.plant["D"]) if "D" in self.plant else sympy.zeros(*size)
        if "f" in self.plant:
            names = self.plant["states"].split(", ")
            f = sympy.Matrix([self.value(row, names) for row in self.plant["f"].strip("[] ").split(";")])
            around = {sympy.Symbol(name): self.value(at) for name, at in self.plant["equilibrium"].items()}
            self.A = f.jacobian([sympy.Symbol(name) for name in names]).subs(around)

    def value(self, typed: Any, left: Any = ()) -> Any:
        """An expression of the table, with every decimal exact and numbers in place of all names but those `left`."""
        text = re.sub(r"(?<![A-Za-z_])([ij])(?=\d)", r"\1*", str(typed).replace("^", "**"))
        text = re.sub(r"(?<![\w.])(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", r"Rational('\1\2')", text)
        text = re.sub(r"\)\s*(?=[A-Za-z(])|(?<=\w)\s+(?=[A-Za-z(])", lambda gap: f"{gap[0].strip()}*", text)
        text = re.sub(r"\b(?!(?:sin|cos|exp|sqrt|Rational)\()([A-Za-z]\w*)(?=\()", r"\1*", text)
        names = {name: sympy.Symbol(name) for name in re.findall(r"[A-Za-z]\w*", text)} | NAMES
        names |= {name: number for name, number in self.numbers.items() if name not in left}
        return sympy.expand(eval(text, {"__builtins__": {}}, names))  # noqa: S307 - our own table

    def matrix(self, typed: Any) -> Any:
        rows = [re.split(r"\s*,\s*|\s+", row.strip()) for row in str(typed).strip("[] ").split(";")]
        return sympy.Matrix([[self.value(entry) for entry in row] for row in rows])

    def at(self, answer: Any) -> Any:
        """An answer of symobs with the same numbers in place of its parameters."""
        return answer.subs({letter: self.numbers.get(str(letter), letter) for letter in answer.free_symbols})

    def polynomial(self, stem: str = "") -> Any:
        if (gain := "K" if stem == "control_" else "L") in self.given:
            moved = self.B * self.matrix(self.given["K"]) if gain == "K" else self.matrix(self.given["L"]) * self.C
            return sympy.Poly((self.A - moved).charpoly(self.x).as_expr(), self.x)
        if f"{stem}polynomial" in self.given:
            return sympy.Poly(self.value(self.given[f"{stem}polynomial"]), self.x)
        factors = [self.x - self.value(pole) for pole in self.given[f"{stem}poles"].split(",")]
        return sympy.Poly(sympy.expand(sympy.prod(factors)), self.x)

    def function_at(self, at: Any) -> Any:
        return self.C * (at * sympy.eye(self.A.rows) - self.A).inv() * self.B + self.D

    def setting(self, plant: Any) -> Setting:
        """What was typed, in plain fractions; where it is a polynomial, the plant that has it."""
        point = {name: number(value) for name, value in self.numbers.items()}
        pairs = zip("ABCD", (self.A, self.B, self.C, self.D), strict=True)
        A, B, C, D = [
            matrix_at(getattr(plant.matrices, name), point)
            if own is None
            else [list(map(number, row)) for row in own.tolist()]
            for name, own in pairs
        ]
        stems = [s for s in ("", "control_", "observer_") if {f"{s}poles", f"{s}polynomial"} & self.given.keys()]
        asked = {stem: [number(c) for c in self.polynomial(stem).all_coeffs()] for stem in stems}
        if self.row["task"] == "stability_region" and self.A is None:
            assert characteristic(A) == [c / asked[""][0] for c in asked[""]]
        return Setting(A, B, C, D, asked, point, self.discrete)

    def holds(self, result: Any) -> None:
        """Hold what the answer claims to the data: a region at points of a grid, functions of time at an instant."""
        if self.row["task"] in {"state_feedback", "observer"} and not all(
            c.is_Rational for c in self.polynomial().all_coeffs()
        ):
            self.poles(result)
            return
        free = sorted(self.row.get("symbols", {})) if self.row["task"] == "stability_region" else []
        for chosen in itertools.product(GRID, repeat=len(free)):
            self.numbers |= dict(zip(free, chosen, strict=True)) | dict.fromkeys(
                ("t", "T") if result.in_time else (), sympy.Rational(3, 7)
            )
            at = self.setting(result.plant)
            for part in applicable(result, at.point):
                HOLDS[self.row["task"]](part, at)

    def poles(self, result: Any) -> None:
        """Hold a gain with roots to the polynomial."""
        moved = self.B * self.at(result.K) if self.row["task"] == "state_feedback" else self.at(result.L) * self.C
        assert sympy.expand((self.A - moved).charpoly(self.x).as_expr() - self.polynomial().as_expr()) == 0

    def printed(self, result: Any) -> None:
        for name, printed in self.row.get("printed", {}).items():
            found = getattr(result, name, None)
            if name in {"transfer_function", "F"}:
                wanted = [[self.value(part).subs({s: 3, z: 3})] for part in printed.strip("[]").split(";")]
                plain = sympy.Matrix([self.at(found).subs(self.x, 3)])
                assert close(plain, wanted, float(self.row.get("tolerance", 1e-12)))
            elif not isinstance(printed, (str, list)) or name in {"verdict", "positive_definite"}:
                assert found == printed
            else:
                found = self.A - self.B * result.K - result.L * self.C if name == "compensator" else found
                found = result.decimals[name] if found is None else found
                texts = re.findall(r"[^\s;\[\],']+", str(printed))
                flat = list(found) if hasattr(found, "shape") else re.findall(r"[^\s()\[\],']+", str(found))
                assert all(self.rounds_to(*pair) for pair in zip(texts, flat, strict=True)), (name, found)

    def rounds_to(self, printed: str, answer: Any) -> bool:
        found = self.at(self.value(answer) if isinstance(answer, str) else answer).subs(t, 1)
        wanted, digits = self.value(printed).subs(t, 1), re.fullmatch(r"-?\d*\.(\d+)(?:e(-?\d+))?", printed)
        unit = 10.0 ** (int(digits[2] or 0) - len(digits[1])) if digits else 0.0
        room = max(unit / 2, float(self.row.get("tolerance", 0)), 1e-13 * abs(sympy.N(found)))
        return bool(found == wanted or abs(sympy.N(wanted - found)) <= room)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['source']}, {row['name']}, {row['task']}")
def test_a_published_problem_goes_through_at_first_try(row: dict[str, Any]) -> None:
    if message := row.get("first_try", row.get("refused")):
        with pytest.raises(SymobsError, match=re.escape(message)):
            solved(row)
        return
    result = solved(row)
    data = Data(row, result.plant)
    assert result.to_latex()
    if "verdict" in row:
        assert result.verdict == row["verdict"]
    data.holds(result)
    data.printed(result)


@tabled
def test_a_design_for_other_poles_is_seen(task: str) -> None:
    """The checks hold a design to the polynomial of its row: with another one they fail."""
    rows = [row for row in ROWS if row.get("book") and row["task"] == task and not {"verdict", "refused"} & row.keys()]
    stem = "observer_" if task == "compensator" else ""
    for row in rows[:5]:
        result = solved(row)
        wanted = Data(row, result.plant).polynomial(stem).as_expr() + 1
        given = {key: value for key, value in row["specification"].items() if key != f"{stem}poles"}
        other = row | {"specification": given | {f"{stem}polynomial": str(wanted)}}
        with pytest.raises(AssertionError):
            Data(other, result.plant).holds(result)


def test_few_first_tries_fail_and_every_source_is_named() -> None:
    assert sum("first_try" in row for row in ROWS) <= 6
    assert {row["source"] for row in TABLE["problems"]} == set(TABLE["sources"])
