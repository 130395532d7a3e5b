"""Problems as textbooks print them go through as first typed, and every answer is checked by other means.

The rows lie in `textbook_problems.toml`.  What is typed is read here a second time, by a reader of a few lines, with a
number in place of every parameter; the answers of symobs are held to it by SymPy and mpmath in rational numbers.
"""

from __future__ import annotations

import itertools
import re
import tomllib
from pathlib import Path
from typing import Any

import mpmath
import pytest
import sympy

import symobs
from symobs.ground.errors import InputError

TABLE = tomllib.loads(Path(__file__).with_suffix(".toml").with_stem("textbook_problems").read_text(encoding="utf-8"))
ROWS = TABLE["problems"]
#: Rows with square roots in their data, which are tried where the reader takes them.
ALGEBRAIC = TABLE["algebraic"]
ABOUT = {"source", "task", "verdict", "printed", "refused"}
PLANT = {"A", "B", "C", "D", "transfer_function", "dt"}
s, z, t = sympy.symbols("s z t")


# -- the second reader ------------------------------------------------------------------------------------------------


def value(text: Any) -> Any:
    """An expression, with the number of `point` in place of each name but s, z and t."""
    if not isinstance(text, str):
        return sympy.Rational(text)
    spaced = re.sub(r"(?<=[\w)])\s+(?=[A-Za-z(])", "*", text.strip())
    signed = re.sub(r"(?<=\))(?=[\w(])|(?<=[0-9])(?=[A-Za-z(])(?<![A-Za-z]\d)", "*", spaced)
    signed = re.sub(r"(?<![A-Za-z0-9_])([A-Za-z]\w*)(?=\()(?<!sqrt)", r"\1*", signed)
    number = re.sub(r"(?<![A-Za-z0-9_.])(\d+(?:\.\d+)?)", r"Rational('\1')", signed)
    names = {name: point(name) for name in re.findall(r"[A-Za-z]\w*", signed) if name not in {"s", "z", "t", "j"}}
    known = {"Rational": sympy.Rational, "s": s, "z": z, "t": t, "j": sympy.I, "sqrt": sympy.sqrt}
    return sympy.expand(eval(number.replace("^", "**"), {"__builtins__": {}}, names | known))  # noqa: S307 - our own table


def point(name: str) -> Any:
    """A rational number for a parameter: another one for another name."""
    return sympy.Rational(2 + sum(map(ord, name)) % 23, 7)


def matrix(text: str) -> Any:
    """A matrix in MATLAB's way, its entries written without spaces."""
    return sympy.Matrix([[value(entry) for entry in row.split()] for row in text.strip("[] ").split(";")])


def at_point(answer: Any) -> Any:
    """An answer of symobs with the same numbers in place of its parameters."""
    names = {symbol for symbol in answer.free_symbols if str(symbol) not in {"s", "z", "t"}}
    numbers = {symbol: point(str(symbol)) for symbol in names}
    return answer.subs(numbers) if not hasattr(answer, "applyfunc") else answer.applyfunc(lambda e: e.subs(numbers))


def variable_of(row: dict[str, Any]) -> Any:
    return z if row.get("dt") else s


def polynomial_of(row: dict[str, Any], stem: str = "") -> Any:
    """The polynomial that is desired, multiplied out."""
    x = variable_of(row)
    if f"{stem}polynomial" in row:
        return sympy.Poly(value(row[f"{stem}polynomial"]), x)
    factors = [x - value(pole) for pole in row[f"{stem}poles"].split(",")]
    return sympy.Poly(sympy.expand(sympy.prod(factors)), x)


def characteristic(A: Any, x: Any) -> Any:
    return sympy.Poly(A.charpoly(x).as_expr(), x)


def observability_matrix(A: Any, C: Any) -> Any:
    return sympy.Matrix.vstack(*(C * A**i for i in range(A.shape[0])))


class Data:
    """The plant of a row, read a second time; one that is typed as a function is the realisation found, if it is one."""

    def __init__(self, row: dict[str, Any], plant: Any) -> None:
        self.row, self.x = row, variable_of(row)
        if "transfer_function" in row:
            self.A, self.B, self.C, self.D = (at_point(getattr(plant, name)) for name in "ABCD")
            text = row["transfer_function"]
            wanted = matrix(text) if text.startswith("[") else sympy.Matrix([[value(text)]])
            for number in (sympy.Rational(5, 3), sympy.Rational(-7, 2), 11):
                assert self.function(number) == wanted.subs(self.x, number)
            return
        self.A = matrix(row["A"]) if "A" in row else None
        self.B, self.C = (matrix(row[name]) if name in row else None for name in "BC")
        self.D = sympy.zeros(self.C.rows if self.C else 0, self.B.cols if self.B else 0)

    def function(self, number: Any) -> Any:
        return self.C * (number * sympy.eye(self.A.rows) - self.A).inv() * self.B + self.D


# -- the checks, one a task -------------------------------------------------------------------------------------------


def check_state_feedback(data: Data, result: Any) -> None:
    if result.verdict == "no":
        modes = [value(str(mode)) for mode in result.fixed_modes]
        pairs = [(data.A.T - mode * sympy.eye(data.A.rows)).row_join(sympy.zeros(data.A.rows, 0)) for mode in modes]
        assert all(sympy.Matrix.vstack(pair, data.B.T).rank() < data.A.rows for pair in pairs)
        assert any(polynomial_of(data.row).eval(mode) != 0 for mode in modes)
        return
    assert characteristic(data.A - data.B * at_point(result.K), data.x) == polynomial_of(data.row)


def check_observer(data: Data, result: Any) -> None:
    if result.verdict == "no":
        modes = [value(str(mode)) for mode in result.fixed_modes]
        pairs = [sympy.Matrix.vstack(data.A - mode * sympy.eye(data.A.rows), data.C) for mode in modes]
        assert all(pair.rank() < data.A.rows for pair in pairs)
        assert any(polynomial_of(data.row).eval(mode) != 0 for mode in modes)
        return
    assert characteristic(data.A - at_point(result.L) * data.C, data.x) == polynomial_of(data.row)


def check_reduced_order_observer(data: Data, result: Any) -> None:
    F, G, H, M = (at_point(getattr(result, name)) for name in "FGHM")
    assert characteristic(F, data.x) == polynomial_of(data.row)
    P = M.inv()[data.C.rows :, :]
    assert P * data.A - F * P == H * data.C
    assert G == P * data.B - H * data.D
    assert M.inv()[: data.C.rows, :] == data.C


def check_compensator(data: Data, result: Any) -> None:
    K, F = at_point(result.K), at_point(result.F)
    assert characteristic(data.A - data.B * K, data.x) == polynomial_of(data.row, "control_")
    wanted = polynomial_of(data.row, "control_") * polynomial_of(data.row, "observer_")
    above, below = (sympy.Poly(part, data.x) for part in sympy.fraction(sympy.together(F)))
    P = sympy.fraction(sympy.together((data.C * (data.x * sympy.eye(data.A.rows) - data.A).inv() * data.B)[0]))
    numerator, denominator = (sympy.Poly(part, data.x) for part in P)
    loop = denominator * below + numerator * above
    assert loop.monic() == wanted.monic()


def check_feedforward(data: Data, result: Any) -> None:
    whole = at_point(result.transfer_function)
    assert sympy.simplify(whole.subs(data.x, 1 if data.row.get("dt") else 0)) == 1


def check_observability(data: Data, result: Any) -> None:
    rank = observability_matrix(data.A, data.C).rank()
    assert result.rank == rank
    assert (result.verdict == "no") == (rank < data.A.rows)


def check_controllability(data: Data, result: Any) -> None:
    rank = observability_matrix(data.A.T, data.B.T).rank()
    assert result.rank == rank
    assert (result.verdict == "no") == (rank < data.A.rows)


def check_pbh(data: Data, result: Any) -> None:
    A, C = (data.A, data.C) if data.row["of"] == "observability" else (data.A.T, data.B.T)
    lost = [mode for mode in A.eigenvals() if sympy.Matrix.vstack(mode * sympy.eye(A.rows) - A, C).rank() < A.rows]
    assert (result.verdict == "no") == bool(lost)


def check_detectability(data: Data, result: Any) -> None:
    _check_hidden(data.A, data.C, result)


def check_stabilizability(data: Data, result: Any) -> None:
    _check_hidden(data.A.T, data.B.T, result)


def _check_hidden(A: Any, C: Any, result: Any) -> None:
    lost = [mode for mode in A.eigenvals() if sympy.Matrix.vstack(mode * sympy.eye(A.rows) - A, C).rank() < A.rows]
    assert (result.verdict == "no") == any(sympy.re(mode) >= 0 for mode in lost)


def check_transfer_function(data: Data, result: Any) -> None:
    found = at_point(result.transfer_function)
    for number in (sympy.Rational(5, 3), sympy.Rational(-7, 2), 11):
        wanted = data.function(number)
        assert found.subs(data.x, number) == (wanted if hasattr(found, "shape") else wanted[0])


def check_characteristic_polynomial(data: Data, result: Any) -> None:
    assert sympy.Poly(at_point(result.polynomial), data.x) == characteristic(data.A, data.x)


def check_matrix_exponential(data: Data, result: Any) -> None:
    found, wanted = at_point(result.matrix).subs(t, sympy.Rational(1, 3)), mpmath.expm(mpmath.matrix(data.A / 3))
    assert all(
        abs(sympy.N(found[i, j]) - wanted[i, j]) < 1e-12 for i, j in itertools.product(range(data.A.rows), repeat=2)
    )


def check_gramian(data: Data, result: Any) -> None:
    """AᵀW + WA + CᵀC = 0 over all time; on [0, T] its right side is e^(AᵀT) CᵀC e^(AT)."""
    A, C = (data.A.T, data.B.T) if data.row.get("of") == "controllability" else (data.A, data.C)
    W = at_point(result.matrix)
    rest = (A.T * W + W * A + C.T * C).applyfunc(sympy.simplify)
    if data.row["horizon"] == "inf":
        assert rest.is_zero_matrix
        return
    end = mpmath.expm(mpmath.matrix(A * point(data.row["horizon"])))
    wanted = end.T * mpmath.matrix(C.T * C) * end
    assert all(abs(sympy.N(rest[i, j]) - wanted[i, j]) < 1e-12 for i, j in itertools.product(range(A.rows), repeat=2))


def check_dual(data: Data, result: Any) -> None:
    assert (result.A, result.B, result.C) == (data.A.T, data.C.T, data.B.T)


def check_canonical_form(data: Data, result: Any) -> None:
    T, A, B, C = (at_point(getattr(result, name)) for name in "TABC")
    assert (T * data.A * T.inv(), T * data.B, data.C * T.inv()) == (A, B, C)
    coefficients = [-c for c in characteristic(data.A, s).all_coeffs()[:0:-1]]
    match data.row["kind"]:
        case "controllable":
            assert list(A[-1, :]) == coefficients
        case "observable":
            assert list(A[:, -1]) == coefficients
        case _:
            assert A.is_diagonal()


def check_decomposition(data: Data, result: Any) -> None:
    hankel = observability_matrix(data.A, data.C) * observability_matrix(data.A.T, data.B.T).T
    assert result.minimal_order == hankel.rank()
    assert sum(result.sizes.values()) == data.A.rows


def check_stability_region(data: Data, result: Any) -> None:
    """Membership of a grid of values, by the Hurwitz determinants of the polynomial with numbers in it."""
    x = data.x
    free = sorted({str(symbol) for symbol in result.polynomial.free_symbols} - {str(x)})
    grid = [sympy.Rational(n, 2) for n in (-9, -3, -1, 1, 2, 5, 9, 14, 31, 90, 400)]
    for numbers in itertools.product(grid, repeat=len(free)):
        chosen = dict(zip(free, numbers, strict=True))
        polynomial = sympy.Poly(result.polynomial.subs(chosen), x)
        typed = sympy.Poly(value_at(data.row["polynomial"], chosen), x)
        assert polynomial.monic() == typed.monic()
        assert holds(result, chosen) == is_stable(typed, data.row), chosen


def value_at(text: str, chosen: dict[str, Any]) -> Any:
    """A polynomial with numbers that are not those of `point`."""
    for name, number in chosen.items():
        text = re.sub(rf"(?<![A-Za-z_]){name}(?!\w)", f"({number})", text)
    return value(text)


def holds(result: Any, chosen: dict[str, Any]) -> bool:
    """Whether the answer says that numbers lie in the region: its conditions, or else its intervals."""
    if result.verdict != "conditional":
        return bool(result.verdict == "yes")
    if result.stable_if:
        return all(
            eval(re.sub(r"(?<![\w.])(\d+)", r"Rational(\1)", condition), {"Rational": sympy.Rational}, dict(chosen))  # noqa: S307
            for condition in result.stable_if
        )
    (number,) = chosen.values()
    ends = [
        [sympy.oo if end == "oo" else -sympy.oo if end == "-oo" else value(end) for end in i] for i in result.intervals
    ]
    return any(low < number < high for low, high in ends)


def is_stable(polynomial: Any, row: dict[str, Any]) -> bool:
    if row.get("dt"):  # the unit disc on the left half-plane
        n = polynomial.degree()
        mapped = sum(c * (s + 1) ** k * (s - 1) ** (n - k) for (k,), c in polynomial.terms())
        polynomial = sympy.Poly(sympy.expand(mapped), s)
        if polynomial.degree() < n:
            return False
    elif "margin" in row:
        polynomial = sympy.Poly(polynomial.as_expr().subs(s, s - value(row["margin"])), s)
    c = polynomial.monic().all_coeffs()
    n = len(c) - 1
    hurwitz = sympy.Matrix(n, n, lambda i, j: c[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else 0)
    return all(hurwitz[:k, :k].det() > 0 for k in range(1, n + 1))


def check_printed(row: dict[str, Any], result: Any) -> None:
    """What the book prints, to its digits."""
    for name, text in row.get("printed", {}).items():
        found = at_point(getattr(result, name))
        if name == "F":
            above, below = (value(part.strip("()")) for part in text.split("/"))
            numerator, denominator = sympy.fraction(sympy.together(found))
            lead = sympy.Poly(denominator, s).LC()
            pairs = zip(
                [*sympy.Poly(above, s).all_coeffs(), *sympy.Poly(below, s).all_coeffs()],
                [*sympy.Poly(numerator / lead, s).all_coeffs(), *sympy.Poly(denominator / lead, s).all_coeffs()],
                strict=True,
            )
            assert all(abs(one - other) <= sympy.Rational(1, 20) for one, other in pairs), (found, text)
            continue
        entries = text.strip("[] ").replace(";", " ").split()
        for typed, answer in zip(entries, found, strict=True):
            digits = re.fullmatch(r"-?\d+(?:\.(\d+))?", typed)
            room = sympy.Rational(1, 2 * 10 ** len(digits.group(1) or "")) if digits and digits.group(1) else 0
            assert abs(value(typed) - answer) <= room, (name, typed, answer)


# -- the table --------------------------------------------------------------------------------------------------------


def solved(row: dict[str, Any]) -> Any:
    """The answer to a row as it is typed: names are real, nothing is declared."""
    specification = {name: typed for name, typed in row.items() if name not in ABOUT | PLANT}
    if "transfer_function" in row:
        plant: Any = symobs.StateSpace.from_transfer_function(row["transfer_function"], row.get("dt", 0))
    elif "A" in row:
        A, B, C, D = (row.get(name) for name in "ABCD")
        plant = symobs.StateSpace(A, B, C, D, dt=row.get("dt", 0))
    elif row.get("dt"):
        plant = symobs.StateSpace.from_polynomial(row["polynomial"], row["dt"])
        specification.pop("polynomial")
    else:
        plant = None
    return getattr(symobs, row["task"])(plant, **specification)


@pytest.mark.parametrize("row", [*ROWS, *ALGEBRAIC], ids=lambda row: row["source"])
def test_a_problem_goes_through_as_it_is_printed(row: dict[str, Any]) -> None:
    if "refused" in row:
        with pytest.raises(InputError, match=row["refused"]):
            solved(row)
        return
    result = solved(row)
    if row["task"] != "stability_region":
        assert result.verdict == row.get("verdict", result.verdict if result.verdict == "conditional" else "yes")
    globals()[f"check_{row['task']}"](Data(row, result.plant), result)
    check_printed(row, result)


def test_the_table_is_one_of_a_hundred_of_which_few_are_refused() -> None:
    assert len(ROWS) >= 100
    assert sum("refused" not in row for row in ROWS) >= 0.95 * len(ROWS)
    assert len({row["source"] for row in (*ROWS, *ALGEBRAIC)}) == len(ROWS) + len(ALGEBRAIC)


@pytest.mark.parametrize("task", ["state_feedback", "observer", "reduced_order_observer", "compensator"])
def test_a_design_for_other_poles_is_seen(task: str) -> None:
    """The checks hold a design to the polynomial of its row: with another one they fail."""
    rows = [row for row in ROWS if row["task"] == task and row.get("verdict") != "no" and "refused" not in row]
    for row in rows[:5]:
        result = solved(row)
        stem = "observer_" if task == "compensator" else ""
        wanted = polynomial_of(row, stem).as_expr() + 1
        other = {name: typed for name, typed in row.items() if name != f"{stem}poles"}
        other[f"{stem}polynomial"] = str(wanted).replace("**", "^")
        with pytest.raises(AssertionError):
            globals()[f"check_{task}"](Data(other, result.plant), result)
