"""Published problems, typed as their sources print them, go through at first try, and other means confirm every answer.

The rows lie in `published_problems.toml`.  Each is run as the file that a reader would type.  Its data are read here a
second time, by SymPy's parser with a number in place of every parameter; the answer is held to them by SymPy, SciPy and
mpmath, and to what the source prints, with the digits that are printed.
"""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy
import pytest
import scipy.linalg
import sympy
from sympy.parsing.sympy_parser import (
    convert_xor,
    implicit_multiplication,
    parse_expr,
    rationalize,
    standard_transformations,
)

from symobs import problem
from symobs.ground.errors import SymobsError

TABLE = tomllib.loads(Path(__file__).with_name("published_problems.toml").read_text(encoding="utf-8"))
ROWS = TABLE["problems"]
FILE = "task", "plant", "specification", "symbols", "values", "constants"
MOST_FAILURES = 6
s, z, t, k = sympy.symbols("s z t k")
OWN = {"s": s, "z": z, "t": t, "pi": sympy.pi, "i": sympy.I, "j": sympy.I}
FUNCTIONS = {name: getattr(sympy, name) for name in ("sin", "cos", "exp", "sqrt", "sign")}


def solved(row: dict[str, Any]) -> Any:
    """The answer to a row, read as `symobs solve` reads a file."""
    (result,) = problem.read(json.dumps({key: row[key] for key in FILE if key in row})).solve()
    return result


# -- the second reader ------------------------------------------------------------------------------------------------


def point(name: str) -> Any:
    """A rational number for a parameter: another one for another name."""
    return sympy.Rational(2 + sum(map(ord, name)) % 23, 7)


class Data:
    """The data of a row, with the numbers of the row or of `point` in place of its parameters."""

    def __init__(self, row: dict[str, Any], result: Any) -> None:
        self.row, self.plant, self.specification = row, row.get("plant", {}), row.get("specification", {})
        self.discrete = bool(self.plant.get("dt"))
        self.x = z if self.discrete else s
        fixed = row.get("values", {}) | row.get("constants", {})
        self.numbers = {name: sympy.Rational(str(fixed.get(name, point(name)))) for name in [*row.get("symbols", {}), *fixed]}
        if "transfer_function" in self.plant:  # the realisation found, if it is one
            origin = problem.read(json.dumps({"task": row["task"], "plant": self.plant})).plant
            self.A, self.B, self.C, self.D = (sympy.Matrix(getattr(origin, name)) for name in "ABCD")
            wanted = self.value(self.plant["transfer_function"])
            assert all(self.function(at)[0] == wanted.subs(self.x, at) for at in (sympy.Rational(5, 3), 11, 13, 17))
        else:
            self.A, self.B, self.C = (self.matrix(self.plant[n]) if n in self.plant else None for n in "ABC")
            rows, columns = self.C.rows if self.C else 0, self.B.cols if self.B else 0
            self.D = self.matrix(self.plant["D"]) if "D" in self.plant else sympy.zeros(rows, columns)

    def value(self, typed: Any, left: Any = ()) -> Any:
        text = re.sub(r"(?<![\w.])(\d+\.?\d*|\.\d+)(?![\d.])(?!e[-+]?\d)(?=[A-Za-z(])", r"\1*", str(typed))
        text = re.sub(r"(?<![A-Za-z_])([ij])(?=\d)", r"\1*", text)
        names = {n: OWN.get(n, sympy.Symbol(n)) for n in re.findall(r"[A-Za-z]\w*", re.sub(r"\de[-+]?\d", "", text))}
        names |= {name: number for name, number in self.numbers.items() if name not in left}
        rules = (*standard_transformations, convert_xor, implicit_multiplication, rationalize)
        return sympy.expand(parse_expr(text, names | FUNCTIONS, rules))

    def matrix(self, typed: Any) -> Any:
        """A matrix in MATLAB's way: a space between two values parts entries unless it stands beside an operator."""
        rows = re.sub(r"\s*([*/^])\s*", r"\1", str(typed).strip("[] ")).split(";")
        parts = [re.split(r"\s*,\s*|\s+", re.sub(r"([-+]) +(?=[\w(])", r"\1", row.strip())) for row in rows]
        return sympy.Matrix([[self.value(entry) for entry in row] for row in parts])

    def at(self, answer: Any) -> Any:
        """An answer of symobs with the same numbers in place of its parameters."""
        numbers = {letter: self.numbers[str(letter)] for letter in answer.free_symbols if str(letter) in self.numbers}
        return answer.subs(numbers)

    def polynomial(self, stem: str = "") -> Any:
        if f"{stem}polynomial" in self.specification:
            return sympy.Poly(self.value(self.specification[f"{stem}polynomial"]), self.x)
        poles = self.specification[f"{stem}poles"].split(",")
        return sympy.Poly(sympy.expand(sympy.prod(self.x - self.value(pole) for pole in poles)), self.x)

    def function(self, at: Any) -> Any:
        return self.C * (at * sympy.eye(self.A.rows) - self.A).inv() * self.B + self.D


def characteristic(A: Any, x: Any) -> Any:
    return sympy.Poly(A.charpoly(x).as_expr(), x)


def observability_matrix(A: Any, C: Any) -> Any:
    return sympy.Matrix.vstack(*(C * A**i for i in range(A.rows)))


def floats(matrix: Any) -> Any:
    return numpy.array(sympy.Matrix(matrix).evalf(30).tolist(), dtype=complex).real


def lowest(*blocks: Any) -> float:
    return float(numpy.linalg.svd(numpy.hstack(blocks), compute_uv=False)[-1])


def close(found: Any, wanted: Any, room: float = 1e-9) -> bool:
    return bool(numpy.allclose(floats(found), floats(wanted), rtol=room, atol=room * 1e-3))


# -- the checks -------------------------------------------------------------------------------------------------------


def rank(data: Data, result: Any) -> None:
    seen = data.row["task"] == "observability"
    matrix = observability_matrix(data.A, data.C) if seen else observability_matrix(data.A.T, data.B.T)
    assert result.rank == matrix.rank()
    assert (result.verdict == "no") == (matrix.rank() < data.A.rows)


def hidden(data: Data, result: Any) -> None:
    of = data.specification.get("of", data.row["task"])
    A, C = (data.A, data.C) if of in {"observability", "detectability"} else (data.A.T, data.B.T)
    lost = [e for e in numpy.linalg.eigvals(floats(A)) if lowest(floats(A).T - e * numpy.eye(A.rows), floats(C.T)) < 1e-9]
    stable = [abs(e) < 1 - 1e-9 if data.discrete else e.real < -1e-9 for e in lost]
    assert (result.verdict == "no") == (bool(lost) if data.row["task"] == "pbh" else not all(stable))


def poles(data: Data, result: Any) -> None:
    gain, A = ("K", data.A) if data.row["task"] == "state_feedback" else ("L", data.A.T)
    B = data.B if gain == "K" else data.C.T
    if result.verdict == "no":  # a mode that no gain moves, and that is not desired
        modes = [e for e in numpy.linalg.eigvals(floats(A)) if lowest(floats(A) - e * numpy.eye(A.rows), floats(B)) < 1e-9]
        assert any(abs(complex(data.polynomial().eval(mode))) > 1e-6 for mode in modes)
        return
    found = data.at(getattr(result, gain))
    assert characteristic(A - B * (found if gain == "K" else found.T), data.x) == data.polynomial()


def given(data: Data, result: Any) -> None:
    L = data.matrix(data.specification["L"])
    if data.row["task"] == "observer":
        assert (result.A, result.B_u) == (data.A - L * data.C, data.B - L * data.D)
        return
    K = data.matrix(data.specification["K"])
    result_poles = characteristic(data.A - data.B * K, data.x) * characteristic(data.A - L * data.C, data.x)
    assert characteristic(result.closed_loop_matrix, data.x) == result_poles
    for at in (3, 5, 7):
        F = (K * (at * sympy.eye(K.cols) - (data.A - data.B * K - L * data.C)).inv() * L)[0]
        assert result.F.subs(data.x, at) == F


def reduced(data: Data, result: Any) -> None:
    F, H = (data.at(getattr(result, name)) for name in "FH")
    P = data.at(result.M).inv()[data.C.rows :, :]
    assert characteristic(F, data.x) == data.polynomial()
    assert (P * data.A - F * P, P * data.B) == (H * data.C, data.at(result.G))


def loop(data: Data, result: Any) -> None:
    above, below = (sympy.Poly(part, data.x) for part in sympy.fraction(sympy.together(data.at(result.F))))
    P = sympy.together((data.C * (data.x * sympy.eye(data.A.rows) - data.A).inv() * data.B)[0])
    numerator, denominator = (sympy.Poly(part, data.x) for part in sympy.fraction(P))
    wanted = data.polynomial("control_") * data.polynomial("observer_")
    assert (denominator * below + numerator * above).monic() == wanted.monic()


def dc(data: Data, result: Any) -> None:
    K = data.matrix(data.specification["K"]) if "K" in data.specification else data.at(result.K)
    assert (-data.C * (data.A - data.B * K).inv() * data.B * sympy.Matrix([[result.F]]))[0] == 1


def integral(data: Data, result: Any) -> None:
    K, gain = data.at(result.K), data.at(result.k_I)
    lower = (-data.C).row_join(sympy.zeros(data.C.rows))
    whole = (data.A - data.B * K).row_join(data.B * gain).col_join(lower)
    assert characteristic(whole, data.x) == data.polynomial()


def function(data: Data, result: Any) -> None:
    for at in (sympy.Rational(5, 3), 11, sympy.Rational(-7, 2)):
        assert sympy.Matrix([data.at(result.transfer_function).subs(data.x, at)]) == sympy.Matrix([data.function(at)])


def realisation(data: Data, result: Any) -> None:
    T, A, B, C = (data.at(getattr(result, name)) for name in "TABC")
    assert all((rest).is_zero_matrix for rest in (T * data.A - A * T, T * data.B - B, data.C - C * T))
    last = [-c for c in characteristic(data.A, s).all_coeffs()[:0:-1]]
    kind = data.specification["kind"]
    assert A.is_diagonal() if kind == "modal" else list(A[-1, :] if kind == "controllable" else A[:, -1]) == last


def parts(data: Data, result: Any) -> None:
    hankel = observability_matrix(data.A, data.C) * observability_matrix(data.A.T, data.B.T).T
    assert (result.minimal_order, sum(result.sizes.values())) == (hankel.rank(), data.A.rows)
    T = result.T
    assert (T * data.A, T * data.B, data.C) == (result.A * T, result.B, result.C * T)


def expm(data: Data, result: Any) -> None:
    assert close(data.at(result.matrix).subs(t, sympy.Rational(1, 3)), scipy.linalg.expm(floats(data.A) / 3))


def response(data: Data, result: Any) -> None:
    """Held to x' = A x + B u and to x(0), at points of time."""
    x = data.at(result.state)
    u = sympy.Matrix([data.value(data.specification.get("input", 0))])
    rest = x.diff(t) - data.A * x - (data.B * u if data.B else sympy.zeros(x.rows, 1))
    start = data.matrix(data.specification["initial"]).T if "initial" in data.specification else sympy.zeros(x.rows, 1)
    assert all(close(rest.subs(t, at), sympy.zeros(x.rows, 1)) for at in (0, sympy.Rational(1, 3), 2))
    assert close(x.subs(t, 0), start)


def zoh(data: Data, result: Any) -> None:
    n, m, T = data.A.rows, data.B.cols, float(data.value(data.specification["sampling_period"]))
    whole = scipy.linalg.expm(floats(data.A.row_join(data.B).col_join(sympy.zeros(m, n + m))) * T)
    assert close(result.A, whole[:n, :n]) and close(result.B, whole[:n, n:])


def gramian(data: Data, result: Any) -> None:
    A, C = (data.A.T, data.B.T) if data.specification.get("of") == "controllability" else (data.A, data.C)
    assert (A.T * result.matrix + result.matrix * A + C.T * C).is_zero_matrix


def lyapunov(data: Data, result: Any) -> None:
    A, P, Q = data.A, result.P, data.matrix(data.specification["Q"])
    assert (A.T * P * A - P + Q if data.discrete else A.T * P + P * A + Q).is_zero_matrix
    assert (result.positive_definite == "yes") == bool((numpy.linalg.eigvalsh(floats(P)) > 0).all())


def riccati(data: Data, result: Any) -> None:
    A, B, Q, R = (floats(m) for m in (data.A, data.B, *(data.matrix(data.specification[n]) for n in "QR")))
    P = (scipy.linalg.solve_discrete_are if data.discrete else scipy.linalg.solve_continuous_are)(A, B, Q, R)
    K = numpy.linalg.solve(R + B.T @ P @ B, B.T @ P @ A) if data.discrete else numpy.linalg.solve(R, B.T @ P)
    assert close(result.decimals["K"] if result.K is None else result.K, K, 1e-7)


def energy(data: Data, result: Any) -> None:
    """The inputs reach the state, and their energy is that of the pseudo-inverse."""
    steps, target = int(data.specification["horizon"]), data.matrix(data.specification["final"]).T
    moves = sympy.Matrix.hstack(*(data.A ** (steps - 1 - i) * data.B for i in range(steps)))
    u = sympy.Matrix([entry for step in result.input for entry in sympy.Matrix([step])])
    assert moves * u == target
    assert result.energy == (target.T * (moves * moves.T).inv() * target)[0] == (u.T * u)[0]


def jacobian(data: Data, result: Any) -> None:
    names = [name.strip() for name in data.plant["states"].split(",")]
    f = sympy.Matrix([data.value(row, names) for row in data.plant["f"].strip("[] ").split(";")])
    around = {sympy.Symbol(name): data.value(at) for name, at in data.plant["equilibrium"].items()}
    assert f.subs(around).applyfunc(sympy.simplify).is_zero_matrix
    A = f.jacobian([sympy.Symbol(name) for name in names]).subs(around)
    assert sympy.simplify(data.at(result.polynomial) - A.charpoly(s).as_expr()) == 0


def hurwitz(data: Data, result: Any) -> None:
    """Membership of a grid of values, by the roots of the polynomial with numbers in it."""
    free = [sympy.Symbol(name) for name in data.row.get("symbols", {})]
    polynomial = data.value(data.specification["polynomial"], list(map(str, free)))
    for number in [sympy.Rational(n, 2) for n in (-9, -1, 1, 3, 7, 9, 31, 400, 8597, 8598, 59999, 60001)]:
        roots = numpy.roots([float(c) for c in sympy.Poly(polynomial.subs({name: number for name in free}), s).all_coeffs()])
        ends = [[sympy.sympify(end) for end in pair] for pair in getattr(result, "intervals", None) or []] if free else []
        inside = any(low < number < high for low, high in ends) or result.verdict == "yes"
        assert inside == bool((roots.real < 0).all() and abs(roots.real).min() > 1e-9), number


# -- what is printed --------------------------------------------------------------------------------------------------


def check_printed(data: Data, result: Any) -> None:
    for name, printed in data.row.get("printed", {}).items():
        found = result.decimals[name] if getattr(result, name, 0) is None else getattr(result, name, None)
        if name in {"verdict", "rank", "positive_definite"}:
            assert found == printed
        elif name == "intervals":
            pairs = zip(sum(printed, []), (str(end) for pair in found for end in pair), strict=True)
            assert all(p == f or rounds_to(data, p, sympy.sympify(f)) for p, f in pairs)
        elif name == "transfer_function":
            held(data, found if hasattr(found, "shape") else [[found]], printed)
        elif name == "routh_table":
            assert sympy.Matrix(found) == data.matrix(printed)
        elif name == "compensator":
            assert data.A - data.B * result.K - result.L * data.C == data.matrix(printed)
        else:
            entries = [entry for row in printed.strip("[] ").split(";") for entry in row.split()]
            flat = list(sympy.Matrix(found)) if hasattr(found, "shape") or isinstance(found, list) else [found]
            assert all(rounds_to(data, p, data.at(f)) for p, f in zip(entries, flat, strict=True)), (name, found)


def held(data: Data, found: Any, printed: str) -> None:
    """Transfer functions agree with printed ones at points, within the digits of the coefficients."""
    x = z if data.row["task"] == "zero_order_hold" else data.x
    for at in (3, 5, 11):
        wanted = [data.value(part).subs(x, at) for part in printed.strip("[]").split(";")]
        for one, other in zip([data.at(entry).subs(x, at) for row in sympy.Matrix(found).tolist() for entry in row], wanted, strict=True):
            assert abs(sympy.N(one - other)) <= float(data.row.get("tolerance", 0)) * abs(sympy.N(other))


def rounds_to(data: Data, printed: str, found: Any) -> bool:
    digits = re.fullmatch(r"-?\d*\.(\d+)(?:e(-?\d+))?", printed)
    unit = 10.0 ** (int(digits[2] or 0) - len(digits[1])) if digits else 0.0
    room = max(unit / 2, float(data.row.get("tolerance", 0)), 1e-13 * abs(float(sympy.N(found.subs(t, 1)))))
    return bool(abs(sympy.N((data.value(printed) - found).subs(t, 1))) <= room)


CHECKS = {
    check.__name__: check
    for check in (rank, hidden, poles, given, reduced, loop, dc, integral, function, realisation, parts, expm, response)
} | {check.__name__: check for check in (zoh, gramian, lyapunov, riccati, energy, jacobian, hurwitz)}


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['source']}, {row['name']}, {row['task']}")
def test_a_published_problem_goes_through_at_first_try(row: dict[str, Any]) -> None:
    message = row.get("first_try", row.get("refused"))
    if message is not None:
        with pytest.raises(SymobsError, match=re.escape(message)):
            solved(row)
        return
    result = solved(row)
    data = Data(row, result)
    CHECKS[row["check"]](data, result)
    check_printed(data, result)


def test_few_first_tries_fail_and_every_source_is_named() -> None:
    assert sum("first_try" in row for row in ROWS) <= MOST_FAILURES
    assert {row["source"] for row in ROWS} == set(TABLE["sources"])
