"""Gains with zeros in given places: rational, with square roots, in a root of high degree, for special parameters only.

What is found is held to the characteristic polynomial by SymPy, what is refused to SymPy's Gröbner bases.
"""

from __future__ import annotations

import random
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import mpmath
import pytest
import sympy

import symobs
from symobs.exact import TooLarge
from symobs.exact import ideals as triangular_basis
from symobs.ground.errors import CertificateRejected
from symobs.tasks.design.gain.gain_kind import AlgebraicGain, NoGainWithZeros
from symobs.tasks.design.pole_placement import zero_pattern
from symobs.tasks.result.output_methods import to_sympy
from tests.kit import text_of

s, x = sympy.Symbol("s"), sympy.Symbol("x")


def placed(A: Any, C: Any, L: Any) -> Any:
    return sympy.expand((s * sympy.eye(A.shape[0]) - A + L * C).det(method="berkowitz"))


def desired(poles: list[int]) -> Any:
    return sympy.expand(sympy.prod([s - p for p in poles]))


def equations(A: Any, C: Any, zero: list[tuple[int, int]], poles: list[int]) -> tuple[list[Any], list[Any]]:
    """Return the coefficients that must vanish, and the unknown entries."""
    n, p = C.shape[1], C.shape[0]
    L = sympy.Matrix(n, p, lambda i, j: 0 if (i + 1, j + 1) in zero else sympy.Symbol(f"l{i}{j}"))
    rest = sympy.Poly(placed(A, C, L) - desired(poles), s).all_coeffs()
    return [c for c in rest if c != 0], sorted(L.free_symbols, key=str)


def is_zero_there(L: Any, zero: list[tuple[int, int]]) -> bool:
    return all(L[i - 1, j - 1] == 0 for i, j in zero)


def asked(zero: list[tuple[int, int]]) -> str:
    return ", ".join(f"({i}, {j})" for i, j in zero)


def matrix(generator: random.Random, rows: int, columns: int) -> str:
    entries = [[str(generator.choice((0, 0, 1, -1, 2, -2, 3))) for _ in range(columns)] for _ in range(rows)]
    return "[" + "; ".join(" ".join(row) for row in entries) + "]"


def numeric_root(report: Any) -> Any:
    """Return the root in the interval, by bisection with 60 digits."""
    polynomial = sympy.Poly(report["polynomial"], x)
    low, high = (mpmath.mpf(end.p) / end.q for end in report["interval"])
    with mpmath.workdps(60):
        coefficients = [int(c) for c in polynomial.all_coeffs()]

        def value(at: Any) -> Any:
            return mpmath.polyval(coefficients, at)

        assert value(low) * value(high) < 0
        return mpmath.findroot(value, (low, high), solver="illinois", tol=1e-50)


def assert_right(A: Any, C: Any, zero: list[tuple[int, int]], poles: list[int], found: Any) -> str:
    """Hold a result to what SymPy finds; return its kind."""
    if found.verdict == "undecided":
        return "undecided"
    if found.verdict == "no":
        if not found.divides:
            return "fixed mode"
        values, unknowns = equations(A, C, zero, poles)
        assert sympy.groebner(values, *unknowns, order="grevlex").exprs == [1] if unknowns else any(values)
        return "no"
    if isinstance(found.kind, AlgebraicGain):
        report = found.fields["in_root"]
        told = {key: to_sympy(value, {}) for key, value in report.items()}
        assert sympy.Poly(told["polynomial"], x).is_irreducible
        assert is_zero_there(told["L"], zero)
        with mpmath.workdps(60):
            at = sympy.Float(str(numeric_root(told)), 55)
            rest = sympy.Poly(placed(A, C, told["L"].subs(x, at)) - desired(poles), s)
            assert max(abs(c) for c in rest.all_coeffs()) < 1e-25
        return "root"
    assert is_zero_there(found.L, zero)
    assert sympy.simplify(placed(A, C, found.L) - desired(poles)) == 0
    return "square root" if found.L.has(sympy.sqrt) or "sqrt" in str(found.L) else "rational"


@pytest.mark.parametrize("seed", range(30))
def test_random_patterns(seed: int) -> None:
    generator = random.Random(seed)  # noqa: S311 - the same plants in every run
    n, p = generator.choice(((2, 2), (3, 2), (3, 2), (3, 3)))
    A, C = matrix(generator, n, n), matrix(generator, p, n)
    places = [(i + 1, j + 1) for i in range(n) for j in range(p)]
    zero = generator.sample(places, generator.randint(1, n * p - n + (seed % 4 == 0)))
    poles = [-generator.randint(1, 6) for _ in range(n)]
    plant = symobs.StateSpace(A, None, C)
    found = symobs.observer(plant, poles=poles, zero=asked(zero))
    kind = assert_right(plant.A, plant.C, zero, poles, found)
    assert kind != "undecided"
    assert found.derivation is not None
    if kind in {"root", "square root"}:
        for style in ("text", "latex", "json"):
            assert found.to(style)


ROOTS = ("[1 0 0 0; 2 -1 0 3; 0 0 3 -2; -1 2 -2 -1]", "[0 0 3 0; 2 0 -1 0]")
ASKED = [(3, 2), (3, 1), (2, 1), (4, 2)], [-5, -6, -5, -2]


def test_a_pattern_that_one_parameter_value_allows() -> None:
    """L = [l 0; 0 0] gives s² + (3l/… ) …: the constant term asks for b = 2."""
    plant = symobs.StateSpace("[-2 -2; b 0]", None, "[a 0; 3 0]")
    found = symobs.observer(plant, poles=[-4, -1], zero="(2, 2), (1, 2), (2, 1)")
    assert (found.verdict, found.L) == ("no", None)
    (case,) = found.cases
    assert [str(c) for c in case.when] == ["Eq(b - 2, 0)"]
    b = sympy.Symbol("b")
    there = sympy.expand(placed(plant.A.subs(b, 2), plant.C, case.result.L) - desired([-4, -1]))
    assert sympy.simplify(there) == 0
    assert case.result.cases[0].result.verdict == "no"
    page = text_of(found)
    assert "have a common solution only if b - 2 vanishes" in page
    assert "Here we assume a ≠ 0" in page


def test_where_the_gain_that_was_found_has_no_value_another_one_serves() -> None:
    plant = symobs.StateSpace("[0 1; 2 3]", "[a 1; 0 1]")
    found = symobs.state_feedback(plant, poles=[-4, -1], zero="[* 0; * *]")
    (case,) = found.cases
    assert [str(c) for c in found.conditions] == ["Ne(a, 0)"]
    assert case.result.K[0, 1] == 0
    there = plant.A - plant.B.subs(sympy.Symbol("a"), 0) * case.result.K
    assert sympy.expand(there.charpoly(s).as_expr() - desired([-4, -1])) == 0


def test_a_gain_that_is_found_cannot_be_denied() -> None:
    """That none was found is an answer too, but only where none is."""
    zero, poles = ASKED
    square_roots = symobs.observer(symobs.StateSpace(ROOTS[0], None, ROOTS[1]), poles=poles, zero=asked(zero))
    plant = symobs.StateSpace("[0 1; 2 3]", "[a 1; 0 1]")
    rational = symobs.state_feedback(plant, poles=[-4, -1], zero="[* 0; * *]")
    for found, letter in ((square_roots, "L"), (rational, "K")):
        assert found.desired is not None
        with pytest.raises(CertificateRejected, match=f"a gain {letter} with these zeros is found"):
            replace(found, answer={**found.answer, letter: None}, kind=NoGainWithZeros(found.desired, found.zero))


def test_a_pattern_may_have_no_gain_where_the_other_input_is_not_enough() -> None:
    """With a = −4 the second column of B is in the kernel of A, and s = −7/2 stays where it is."""
    plant = symobs.StateSpace("[a 2; -1 1/2]", "[-1 1/2; 2 1]", "[2 1]")
    found = symobs.state_feedback(plant, poles=[-3, -11], zero="(1, 2), (1, 1)")
    (case,) = found.cases
    assert (case.result.verdict, case.result.K) == ("no", None)
    assert plant.A.subs(sympy.Symbol("a"), -4) * plant.B.col(1) == sympy.zeros(2, 1)
    assert "In this case no such gain exists." in text_of(found)


def test_a_pattern_that_is_too_much_work_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """With L = [l; 0] the polynomial is s² − (a − l) s: no gain of this pattern has the poles −1, −2."""

    def found() -> Any:
        return symobs.observer(symobs.StateSpace("[a 1; 0 0]", C="[1 0]"), poles=[-1, -2], zero="(2, 1)")

    def too_large(*_: Any) -> Any:
        raise TooLarge("too large")

    assert (found().needed, found().verdict) == ((1,), "no")
    monkeypatch.setattr(triangular_basis, "triangular", too_large)
    monkeypatch.setattr(zero_pattern, "Ideal", SimpleNamespace(of=too_large))
    assert (found().needed, found().verdict) == (None, "undecided")
    assert "whether one exists is undecided" in text_of(found())


SCIPY_6692 = "[0 0 0 1; -42.7207306947135 0 0 0; 0 0 0 0; 47.0334901743703 0 0 0]"
CART = "[0 1 0 0; 0 -d/M -m*g/M 0; 0 0 0 1; 0 d/(M*l) (M+m)*g/(M*l) 0]"


@pytest.mark.parametrize(
    ("A", "C", "poles"),
    [
        (SCIPY_6692, "[1 0 0 0; 0 1 0 0; 0 0 1 0; 0 0 0 1]", "-1, -0.5, -0.4, -1.5"),
        (CART, "[1 0 0 0; 0 0 1 0]", "-1, -2, -3, -4"),
        ("[0 k 0 k; 1 1 0 -c; 0 0 0 -1; 0 -1 1 k]", "[0 1 0 0; 0 0 0 1]", "-1, -2, -3, -4"),
    ],
)
def test_the_pattern_of_the_decoupled_member_is_one_that_can_be_met(A: str, C: str, poles: str) -> None:
    plant = symobs.StateSpace(A, C=C, symbols=dict.fromkeys(("c", "d", "g", "k", "l", "m", "M"), "positive"))
    member = symobs.observer(plant, poles=poles, member="decoupled").L
    rows, columns = member.shape
    places = [(i, j) for i in range(1, rows + 1) for j in range(1, columns + 1) if member[i - 1, j - 1] == 0]
    found = symobs.observer(plant, poles=poles, zero=str(places)[1:-1])
    assert found.verdict == "yes"
    assert places
    assert all(found.L[i - 1, j - 1] == 0 for i, j in places)
