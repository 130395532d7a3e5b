"""Conditions are right: results specialised at random rational points, judged by plain arithmetic of fractions.

At points where the conditions of a result hold, its values must meet the claim of the plant at that point.  Where a
denominator of the plant vanishes there is no plant.  Where a factor of det 𝒪 or det 𝒞 vanishes the rank drops, and
either no gain exists or a case of the result says why one survives, and that case is right on its stratum.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.conditions import never_zero
from symobs.exact import Complex, Factored, Matrix, Scalar
from symobs.expression import parse_polynomial
from symobs.problem import Problem, read
from symobs.specification import read_poles
from tests.strategies import (
    Point,
    Polynomial,
    Rows,
    assignable,
    at_number,
    characteristic,
    coefficients_at,
    faddeev_leverrier,
    is_hurwitz,
    is_schur,
    matrix_at,
    multiply,
    observability_rows,
    product,
    random_fraction,
    rank_of,
    seeded,
    subtract,
    transposed,
    value_at,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.method import Case, Result

POINTS = 200
PROBES = [Fraction(7, 3), Fraction(-11, 5), Fraction(23)]  # values of s at which rational functions are compared

BUILT = {
    f"fixed_modes_{'_'.join(str(-pole) for pole in poles)}": f"""
        tasks = ["observability", "controllability", "observer", "state_feedback", "characteristic_polynomial"]
        [symbols]
        c = "real"
        [plant]
        A = "[0 1; -2 -3]"
        B = "[0; 1]"
        C = "[1 c]"
        [specification]
        poles = {poles}
    """
    for poles in ([-1, -5], [-1, -2])
} | {
    "domain": """
        tasks = ["observability", "controllability", "transfer_function", "characteristic_polynomial", "compensator"]
        [symbols]
        m = "real"
        k = { sign = "nonnegative" }
        d = "real"
        p = "real"
        q = "nonzero"
        [plant]
        A = "[0 1; -k/m -d/(m + k)]"
        B = "[0; 1/m]"
        C = "[1 p/q]"
        [specification]
        control_poles = [-1, "-d"]
        observer_polynomial = "s^2 + p s + 1/m"
    """,
    "third_order": """
        tasks = ["observability", "controllability", "compensator", "transfer_function"]
        [symbols]
        a = "real"
        b = "positive"
        c = "real"
        [plant]
        A = "[-1 0 0; 0 a 0; 1 0 -b]"
        B = "[1; 1; c]"
        C = "[1 c 1]"
        [specification]
        control_poles = ["-b", "-1 + i", "-1 - i"]
        observer_poles = [-1, "a", -4]
    """,
}

FILES = {path.stem: path for path in sorted((Path(__file__).parents[1] / "worked_examples").glob("*.toml"))}
NAMES = [*FILES, *BUILT]


@cache
def solved(name: str) -> tuple[Problem, tuple[Result, ...]]:
    problem = read(FILES[name].read_text(encoding="utf-8") if name in FILES else BUILT[name])
    return problem, problem.solve()


# -- the plant and what is asked for, at a point -------------------------------------------------------------------------


@dataclass(frozen=True)
class Setting:
    """A plant and desired polynomials in plain fractions, and the point they belong to."""

    A: Rows
    B: Rows
    C: Rows
    D: Rows
    wanted: dict[str, Polynomial]
    point: Point
    discrete: bool

    @staticmethod
    def of(problem: Problem, point: Point) -> Setting:
        m = problem.plant.matrices
        parts = [matrix_at(part, point) for part in (m.A, m.B, m.C, m.D)]
        return Setting(*parts, dict(wanted(problem, point)), point, problem.plant.is_discrete)

    def is_stable(self, polynomial: Polynomial) -> bool:
        return is_schur(polynomial) if self.discrete else is_hurwitz(polynomial)


def wanted(problem: Problem, point: Point) -> Iterator[tuple[str, Polynomial]]:
    """Read the desired polynomials off the specification and multiply the poles out in fractions."""
    symbols, variable = problem.plant.symbols, problem.plant.variable
    for key, value in problem.specification.items():
        kind = key.removesuffix("poles").removesuffix("polynomial")
        if key.endswith("poles"):
            yield kind, multiplied_out(read_poles(value, symbols, key), point)
        elif key.endswith("polynomial"):
            yield kind, coefficients_at(parse_polynomial(value, variable, symbols.names, where=key), variable, point)


def multiplied_out(poles: tuple[Complex, ...], point: Point) -> Polynomial:
    real, imaginary = [Fraction(1)], [Fraction(0)]
    for pole in poles:
        x, y = value_at(pole.real, point), value_at(pole.imaginary, point)
        zero = [Fraction(0)]
        by_x, by_y = (product([part, [-x]]) for part in (real, imaginary)), (product([p, [-y]]) for p in (real, imaginary))
        (rx, ix), (ry, iy) = by_x, by_y
        real, imaginary = (
            [u + v - w for u, v, w in zip(real + zero, zero + rx, zero + iy, strict=True)],
            [u + v + w for u, v, w in zip(imaginary + zero, zero + ix, zero + ry, strict=True)],
        )
    assert not any(imaginary), "the poles asked for are closed under conjugation"
    return real


def names_of(problem: Problem, results: tuple[Result, ...]) -> list[str]:
    found = set(problem.plant.field.names) | set(problem.plant.symbols.signs)
    for result in results:
        for value in result.answer.values():
            found |= set(getattr(value, "names", ())) - {problem.plant.variable}
    return sorted(found)


def points(problem: Problem, names: list[str], seed: object) -> Iterator[dict[str, Fraction]]:
    """Yield random points that respect the declared signs, simple ones among them, so that coincidences occur."""
    generator, sign = seeded(seed), problem.plant.symbols.sign
    while True:
        yield {name: random_fraction(generator, sign(name)) for name in names}


def exists(problem: Problem, point: Point) -> bool:
    """Whether there is a plant and a specification at a point."""
    try:
        Setting.of(problem, point)
    except ZeroDivisionError:
        return False
    return True


# -- what each task claims, at a point -----------------------------------------------------------------------------------


def gain_holds(result: Result, at: Setting, kind: str, gain: Rows) -> None:
    """Hold a gain against φ: from the specification, or the polynomial reported for a given gain."""
    feedback = result.task == "state_feedback"
    closed = subtract(at.A, multiply(at.B, gain) if feedback else multiply(gain, at.C))
    reported = coefficients_at(result.fields["polynomial"], result.plant.variable, at.point)
    assert characteristic(closed) == reported == at.wanted.get(kind, reported)


def design_holds(result: Result, at: Setting, kind: str = "") -> None:
    letter = "K" if result.task == "state_feedback" else "L"
    A, C = (at.A, at.C) if letter == "L" else (transposed(at.A), transposed(at.B))
    if result.answer[letter] is None:
        assert not assignable(A, C, at.wanted[kind])
        return
    gain = matrix_at(result.answer[letter], at.point)
    gain_holds(result, at, kind, gain)
    if letter == "K":
        assert matrix_at(result.fields["closed_loop_matrix"], at.point) == subtract(at.A, multiply(at.B, gain))
    else:
        assert matrix_at(result.fields["A"], at.point) == subtract(at.A, multiply(gain, at.C))
        if result.plant.matrices.has_input:
            assert matrix_at(result.fields["B_u"], at.point) == subtract(at.B, multiply(gain, at.D))
    family = result.fields["family"]
    for shift in (Fraction(0), Fraction(5, 7)) if family else ():
        free = {name: shift * (k + 1) for k, name in enumerate(family["parameters"])}
        gain_holds(result, at, kind, matrix_at(family[letter], {**at.point, **free}))
    stability_holds(result, at, at.wanted.get(kind, characteristic(subtract(at.A, multiply(at.B, gain) if letter == "K" else multiply(gain, at.C)))))


def stability_holds(result: Result, at: Setting, polynomial: Polynomial) -> None:
    verdict = result.fields["stable"]
    if verdict == "conditional":
        positive: tuple[Scalar, ...] = result.stability.positive
        assert at.is_stable(polynomial) == all(value_at(value, at.point) > 0 for value in positive)
    else:
        assert at.is_stable(polynomial) == (verdict == "yes")


def response(A: Rows, B: Rows, C: Rows, s: Fraction) -> Fraction:
    """Return C (sI − A)⁻¹ B at a number s."""
    chi, adjugates = faddeev_leverrier(A)
    return at_number([multiply(multiply(C, part), B)[0][0] for part in adjugates], s) / at_number(chi, s)


def rational_at(value: Scalar | Factored, variable: str, s: Fraction, point: Point) -> Fraction:
    return value_at(value.value if isinstance(value, Factored) else value, {**point, variable: s})


def compensator_holds(result: Result, at: Setting) -> None:
    design_holds(result.feedback, at, "control_")
    design_holds(result.estimator, at, "observer_")
    if result.answer["F"] is None:
        assert None in (result.answer["K"], result.answer["L"])
        return
    K, L = (matrix_at(result.answer[name], at.point) for name in "KL")
    BK, LC, variable = multiply(at.B, K), multiply(L, at.C), result.plant.variable
    LDK = multiply(multiply(L, at.D), K)
    own = subtract(subtract(subtract(at.A, BK), LC), [[-x for x in row] for row in LDK])
    assert matrix_at(result.fields["compensator_matrix"], at.point) == own
    whole = product([at.wanted["control_"], at.wanted["observer_"]])
    for name in ("closed_loop_matrix", "closed_loop_matrix_estimate"):
        assert characteristic(matrix_at(result.fields[name], at.point)) == whole
    for s in PROBES:
        if not at_number(characteristic(own), s) or not at_number(characteristic(at.A), s) or not at_number(whole, s):
            continue
        F, P = response(own, L, K, s), response(at.A, at.B, at.C, s) + at.D[0][0]
        assert rational_at(result.fields["F"], variable, s, at.point) == F
        assert rational_at(result.fields["closed_loop"], variable, s, at.point) == P / (1 + P * F)
        assert rational_at(result.fields["closed_loop_polynomial"], variable, s, at.point) == at_number(whole, s)
    if result.fields["F_stable"] != "conditional" and not never_reduced(result.fields["F"], variable):
        assert at.is_stable(characteristic(own)) == (result.fields["F_stable"] == "yes")


def never_reduced(F: Scalar, variable: str) -> bool:
    """Whether F is of lower order than its realisation, so that its poles are not all of the matrix's."""
    return F.is_zero or F.denominator.degree(variable) < F.numerator.degree(variable) + 1


def rank_holds(result: Result, at: Setting) -> None:
    controllable = result.task == "controllability"
    A, C = (transposed(at.A), transposed(at.B)) if controllable else (at.A, at.C)
    rows = observability_rows(A, C)
    found = matrix_at(result.fields["matrix"], at.point)
    assert (transposed(found) if controllable else found) == rows
    assert rank_of(rows) == result.fields["rank"]
    kernel = [[value_at(entry, at.point) for entry in vector] for vector in result.fields["kernel"]]
    assert rank_of(kernel) == len(kernel) == len(A) - result.fields["rank"]
    assert not any(any(row) for row in multiply(rows, transposed(kernel)) if kernel)


def polynomial_holds(result: Result, at: Setting) -> None:
    chi = characteristic(at.A)
    assert coefficients_at(result.fields["polynomial"], result.plant.variable, at.point) == chi
    factors = [coefficients_at(f, result.plant.variable, at.point) for f, k in result.fields["factors"] for _ in range(k)]
    assert product(factors) == chi
    if result.fields["stable"] != "conditional":
        assert at.is_stable(chi) == (result.fields["stable"] == "yes")


def transfer_holds(result: Result, at: Setting) -> None:
    for s in PROBES:
        if at_number(characteristic(at.A), s):
            expected = response(at.A, at.B, at.C, s) + at.D[0][0]
            assert rational_at(result.fields["transfer_function"], result.plant.variable, s, at.point) == expected


HOLDS: dict[str, Callable[[Any, Setting], None]] = {
    "observer": design_holds,
    "state_feedback": design_holds,
    "compensator": compensator_holds,
    "observability": rank_holds,
    "controllability": rank_holds,
    "characteristic_polynomial": polynomial_holds,
    "transfer_function": transfer_holds,
}

# -- the tests -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_the_claim_holds_wherever_the_conditions_do(name: str) -> None:
    problem, results = solved(name)
    names = names_of(problem, results)
    count = POINTS if names else 1
    for result in results:
        assert all(condition.operator == "!=" for condition in result.conditions)
        tested = 0
        for point in points(problem, names, name):
            if tested == count:
                break
            if not exists(problem, point) or not all(value_at(c.expression, point) for c in result.conditions):
                continue
            HOLDS[result.task](result, Setting.of(problem, point))
            substituted = result.plant.substitute({n: Scalar.of(x) for n, x in point.items()})
            assert substituted.matrices.A == Matrix.of(matrix_at(result.plant.matrices.A, point))
            tested += 1
        assert tested == count
