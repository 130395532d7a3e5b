"""Published problems, typed as their sources print them, go through at first try, and other means confirm every answer.

The rows of `published_problems.toml` are run as the files that a reader would type, those of `textbook_problems.toml` from
Python.  Their data are read here a second time, with a number in place of every parameter; SymPy and SciPy hold the answer
to them, and to what is printed.
"""

from __future__ import annotations

import itertools
import json
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg  # type: ignore[import-untyped]
import sympy

import symobs
from symobs import problem
from symobs.ground.errors import SymobsError
from tests.kit import tabled

TABLE, BOOKS = (
    tomllib.loads(Path(__file__).with_name(f"{name}_problems.toml").read_text("utf-8"))
    for name in ("published", "textbook")
)
s, z, t = sympy.symbols("s z t")
NAMES = {name: getattr(sympy, name) for name in ("sin", "cos", "exp", "sqrt", "pi", "oo", "Rational")}
NAMES |= {"s": s, "z": z, "t": t, "i": sympy.I, "j": sympy.I}
#: What holds the answer of a task to its data; the rows that are files name it themselves.
CHECKS = {
    **dict.fromkeys(("state_feedback", "observer"), "poles"),
    **dict.fromkeys(("observability", "controllability"), "rank"),
    **dict.fromkeys(("pbh", "detectability", "stabilizability"), "hidden"),
    **dict.fromkeys(("canonical_form", "decomposition"), "realisation"),
    "reduced_order_observer": "functional",
    "compensator": "loop",
    "feedforward": "unit_gain",
    "transfer_function": "function",
    "matrix_exponential": "expm",
    "stability_region": "hurwitz",
}


def of_book(row: dict[str, Any]) -> dict[str, Any]:
    """Return a row of a textbook in the form of the others: every name in its data is a real parameter."""
    plant = {key: row[key] for key in (*"ABCD", "transfer_function", "dt") if key in row}
    about = {"source", "task", "verdict", "printed", "refused", "tolerance", *plant}
    given = {key: value for key, value in row.items() if key not in about}
    typed = " ".join(str(v) for k, v in (plant | given).items() if k not in {"kind", "of", "observer", "dt"})
    names = {*re.findall(r"[A-Za-z]\w*", re.sub(r"(?<=\d)(?=[A-Za-z])", " ", typed))} - {*NAMES, "inf"}
    found = {key: row[key] for key in ("source", "task", "printed", "verdict", "refused", "tolerance") if key in row}
    check = CHECKS.get(row["task"], row["task"])
    own = {"name": row["source"], "plant": plant, "specification": given, "check": check, "book": True}
    return found | own | {"symbols": dict.fromkeys(sorted(names), "real")}


ROWS = [*TABLE["problems"], *map(of_book, (*BOOKS["problems"], *BOOKS["algebraic"]))]


def point(name: str) -> Any:
    """A rational number for a parameter: another one for another name."""
    return sympy.Rational(2 + sum(map(ord, name)) % 23, 7)


def characteristic(A: Any, x: Any) -> Any:
    return sympy.Poly(A.charpoly(x).as_expr(), x)


def observability_matrix(A: Any, C: Any) -> Any:
    return sympy.Matrix.vstack(*(C * A**i for i in range(A.shape[0])))


def solved(row: dict[str, Any]) -> Any:
    """The answer to a row, read as `symobs solve` reads a file, or that of Python, where nothing is declared."""
    if row.get("book"):
        return of_python(row)
    own = {"name", "printed", "check", "tolerance", "first_try", "refused"}
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


def hidden_modes(A: Any, B: Any) -> list[Any]:
    """The eigenvalues at which [A - λI, B] loses rank."""
    A, B = floats(A), floats(B)
    pencils = [(e, np.hstack([A - e * np.eye(len(A)), B])) for e in np.linalg.eigvals(A)]
    return [e for e, pencil in pencils if np.linalg.svd(pencil, compute_uv=False)[-1] < 1e-9]


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
            return characteristic(self.A - moved, self.x)
        if f"{stem}polynomial" in self.given:
            return sympy.Poly(self.value(self.given[f"{stem}polynomial"]), self.x)
        factors = [self.x - self.value(pole) for pole in self.given[f"{stem}poles"].split(",")]
        return sympy.Poly(sympy.expand(sympy.prod(factors)), self.x)

    def function_at(self, at: Any) -> Any:
        return self.C * (at * sympy.eye(self.A.rows) - self.A).inv() * self.B + self.D

    def rank(self, result: Any) -> None:
        seen = self.row["task"] == "observability"
        matrix = observability_matrix(self.A, self.C) if seen else observability_matrix(self.A.T, self.B.T).T
        assert (result.rank, self.at(result.matrix)) == (matrix.rank(), matrix)
        assert (result.verdict == "no") == (matrix.rank() < self.A.rows)

    def hidden(self, result: Any) -> None:
        seen = self.given.get("of", self.row["task"]) in {"observability", "detectability"}
        lost = hidden_modes(*((self.A.T, self.C.T) if seen else (self.A, self.B)))
        stable = [abs(e) < 1 - 1e-9 if self.discrete else e.real < -1e-9 for e in lost]
        assert (result.verdict == "no") == (bool(lost) if self.row["task"] == "pbh" else not all(stable))

    def poles(self, result: Any) -> None:
        A, B = (self.A, self.B) if self.row["task"] == "state_feedback" else (self.A.T, self.C.T)
        if result.verdict == "no":  # a mode that no gain moves, and that is not desired
            assert any(abs(complex(self.polynomial().eval(mode))) > 1e-6 for mode in hidden_modes(A, B))
            return
        gain = self.at(result.K) if self.row["task"] == "state_feedback" else self.at(result.L).T
        assert characteristic(A - B * gain, self.x) == self.polynomial()

    def functional(self, result: Any) -> None:
        """An observer of P x, of minimal order or for unknown inputs: P A - F P = H C, P B = G, P E = 0."""
        E = self.matrix(self.given["E"]) if "E" in self.given else sympy.zeros(self.A.rows, 1)
        P = self.at(result.T) if "E" in self.given else self.at(result.M).inv()[self.C.rows :, :]
        F, G, H = (self.at(getattr(result, n)) for n in (("F", "B_u", "B_y") if "E" in self.given else "FGH"))
        assert characteristic(F, self.x) == self.polynomial()
        assert "E" in self.given or self.at(result.M).inv()[: self.C.rows, :] == self.C
        assert ((P * E).is_zero_matrix, P * self.A - F * P, P * self.B) == (True, H * self.C, G)

    def loop(self, result: Any) -> None:
        above, below = (sympy.Poly(part, self.x) for part in sympy.fraction(sympy.together(self.at(result.F))))
        P = sympy.fraction(sympy.together(self.function_at(self.x)[0]))
        closed = sympy.Poly(P[1], self.x) * below + sympy.Poly(P[0], self.x) * above
        assert closed.monic() == (self.polynomial("control_") * self.polynomial("observer_")).monic()

        assert characteristic(self.A - self.B * self.at(result.K), self.x) == self.polynomial("control_")

    def unit_gain(self, result: Any) -> None:
        assert (-self.C * (self.A - self.B * self.at(result.K)).inv() * self.B * sympy.Matrix([[result.F]]))[0] == 1

    def integral(self, result: Any) -> None:
        upper = (self.A - self.B * self.at(result.K)).row_join(self.B * self.at(result.k_I))
        whole = upper.col_join((-self.C).row_join(sympy.zeros(self.C.rows)))
        assert characteristic(whole, self.x) == self.polynomial()

    def function(self, result: Any) -> None:
        for at in (3, 11, sympy.Rational(-7, 2)):
            found = self.at(result.transfer_function).subs(self.x, at)
            assert sympy.Matrix([found]) == self.function_at(at)

    def realisation(self, result: Any) -> None:
        T, A, B, C = (self.at(getattr(result, name)) for name in "TABC")
        assert all(rest.is_zero_matrix for rest in (T * self.A - A * T, T * self.B - B, self.C - C * T))
        if self.row["task"] == "decomposition":
            hankel = observability_matrix(self.A, self.C) * observability_matrix(self.A.T, self.B.T).T
            assert (result.minimal_order, sum(result.sizes.values())) == (hankel.rank(), self.A.rows)
            return
        last = [-c for c in characteristic(self.A, s).all_coeffs()[:0:-1]]
        forms = {"modal": A.is_diagonal(), "controllable": list(A[-1, :]) == last, "observable": list(A[:, -1]) == last}
        assert forms[self.given["kind"]]

    def expm(self, result: Any) -> None:
        assert close(self.at(result.matrix).subs(t, 1), scipy.linalg.expm(floats(self.A)))

    def response(self, result: Any) -> None:
        x, start = self.at(result.state), self.matrix(self.given.get("initial", ", ".join("0" * self.A.rows))).T
        forced = self.B * self.value(self.given["input"]) if "input" in self.given else sympy.zeros(*x.shape)
        rest = x.diff(t) - self.A * x - forced
        assert close(x.subs(t, 0), start)
        assert all(close(rest.subs(t, at), sympy.zeros(*x.shape)) for at in (0, 1, 2))

    def zoh(self, result: Any) -> None:
        n, m = self.B.shape
        whole = floats(
            self.A.row_join(self.B).col_join(sympy.zeros(m, n + m)) * self.value(self.given["sampling_period"])
        )
        assert close(result.A.row_join(result.B), scipy.linalg.expm(whole)[:n])

    def gramian(self, result: Any) -> None:
        A, C = (self.A.T, self.B.T) if self.given.get("of") == "controllability" else (self.A, self.C)
        W = self.at(result.matrix)
        rest = (A.T * W + W * A + C.T * C).applyfunc(sympy.simplify)
        if self.given.get("horizon", "inf") == "inf":
            assert rest.is_zero_matrix
            return
        end = scipy.linalg.expm(floats(A * self.value(self.given["horizon"])))
        assert close(rest, end.T @ floats(C.T * C) @ end)

    def characteristic_polynomial(self, result: Any) -> None:
        assert sympy.Poly(self.at(result.polynomial), self.x) == characteristic(self.A, self.x)

    def dual(self, result: Any) -> None:
        assert (result.A, result.B, result.C) == (self.A.T, self.C.T, self.B.T)

    def lyapunov(self, result: Any) -> None:
        A, P, Q = self.A, result.P, self.matrix(self.given["Q"])
        assert (A.T * P * A - P + Q if self.discrete else A.T * P + P * A + Q).is_zero_matrix
        assert (result.positive_definite == "yes") == bool((np.linalg.eigvalsh(floats(P)) > 0).all())

    def riccati(self, result: Any) -> None:
        A, B, Q, R = map(floats, (self.A, self.B, *(self.matrix(self.given[name]) for name in "QR")))
        P = (scipy.linalg.solve_discrete_are if self.discrete else scipy.linalg.solve_continuous_are)(A, B, Q, R)
        both = (R + B.T @ P @ B, B.T @ P @ A) if self.discrete else (R, B.T @ P)
        assert close(result.decimals["K"] if result.K is None else result.K, np.linalg.solve(*both), 1e-7)

    def energy(self, result: Any) -> None:
        steps, target = int(self.given["horizon"]), self.matrix(self.given["final"]).T
        moves = sympy.Matrix.hstack(*(self.A ** (steps - 1 - step) * self.B for step in range(steps)))
        u = sympy.Matrix(result.input).reshape(self.B.cols, steps).T.reshape(self.B.cols * steps, 1)
        assert moves * u == target
        assert result.energy == (target.T * (moves * moves.T).inv() * target)[0] == (u.T * u)[0]

    def jacobian(self, result: Any) -> None:
        names = self.plant["states"].split(", ")
        f = sympy.Matrix([self.value(row, names) for row in self.plant["f"].strip("[] ").split(";")])
        around = {sympy.Symbol(name): self.value(at) for name, at in self.plant["equilibrium"].items()}
        polynomial = f.jacobian([sympy.Symbol(name) for name in names]).subs(around).charpoly(s).as_expr()
        assert sympy.simplify(self.at(result.polynomial) - polynomial) == 0

    def hurwitz(self, result: Any) -> None:
        free = sorted(self.row.get("symbols", {}))
        polynomial = self.value(self.given["polynomial"], free)
        grid = [sympy.Rational(n, 2) for n in (-9, -3, -1, 1, 2, 3, 5, 7, 9, 14, 31, 90, 400, 8597, 8598, 59999, 60001)]
        for numbers in itertools.product(grid, repeat=len(free)):
            chosen = dict(zip(map(sympy.Symbol, free), numbers, strict=True))
            roots = sympy.Poly(polynomial.subs(chosen), self.x).sqf_part().nroots(maxsteps=500)
            beyond = (
                abs(r) - 1 if self.discrete else sympy.re(r) + self.value(self.given.get("margin", 0)) for r in roots
            )
            assert self.lies_in(result, chosen) == all(distance < -1e-9 for distance in beyond), chosen

    def lies_in(self, result: Any, chosen: dict[Any, Any]) -> bool:
        """Whether the answer says that numbers lie in the region: its conditions, or else its intervals."""
        if result.verdict != "conditional":
            return bool(result.verdict == "yes")
        if result.stable_if and len(chosen) > 1:
            sides = (re.split(r"\s*([<>])\s*", condition) for condition in result.stable_if)
            told = ((self.value(f"{a}-({b})", map(str, chosen)).subs(chosen), sign) for a, sign, b in sides)
            return all(value > 0 if sign == ">" else value < 0 for value, sign in told)
        (number,) = chosen.values()
        ends = [[self.value(end) for end in pair] for pair in result.intervals]
        return any(low < number < high for low, high in ends)

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
    getattr(data, row["check"])(result)
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
            getattr(Data(other, result.plant), row["check"])(result)


def test_few_first_tries_fail_and_every_source_is_named() -> None:
    assert sum("first_try" in row for row in ROWS) <= 6
    assert {row["source"] for row in TABLE["problems"]} == set(TABLE["sources"])
