"""The fields of a result that follow from its answer and are claimed by nothing, computed again in plain fractions."""

from __future__ import annotations

import re
from fractions import Fraction
from functools import cache, partial
from math import prod
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Factored, Matrix, Root, Scalar
from symobs.exact.core.generators import function_named, symbols_in
from symobs.formula.expression import parse_scalar
from symobs.formula.tree import Literal
from tests.support.algebra import (
    CONTEXT,
    Series,
    at_number,
    determinant,
    digits,
    hidden,
    identity,
    inverse,
    matrix_at,
    multiply,
    observability_rows,
    random_fraction,
    seeded,
    subtract,
    transposed,
    value_at,
)
from tests.support.claims.claims import conditions_hold
from tests.support.claims.claims_of_regions import region_holds
from tests.support.derivations import World, times
from tests.support.examples import results_of
from tests.support.paths import ROOT
from tests.support.sampling import every
from tests.support.tampering.mutations import parts_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.tasks.result import Result
    from tests.support.algebra import Point, Rows

pytestmark = pytest.mark.slow

FOLDER = ROOT / "worked_examples"
#: Fractions know no roots: lines of examples with roots in their plant are held with 60 digits.
WITH_ROOTS = {"coupled_masses_irrational", "sensor_at_a_node"}
TEXTS = {path.stem: path.read_text("utf-8") for path in sorted(FOLDER.glob("*.toml"))}
EXAMPLES = sorted(TEXTS.keys() - WITH_ROOTS)


def asking(*tasks: str) -> list[str]:
    """The examples in whose files one of the tasks is named."""
    return [name for name in EXAMPLES if any(task in TEXTS[name] for task in tasks)]


@cache
def every_part(name: str) -> list[Result]:
    return [part for result in results_of(name) for _, part in parts_of(result)]


def has_functions(part: Result) -> bool:
    """Whether an answer contains exponentials, sines or the like."""
    values = [value for value in part.answer.values() if isinstance(value, (Scalar, Matrix))]
    return part.in_time or any(function_named(name) for value in values for name in value.names)


MODES = {"observability": "unobservable_modes", "controllability": "uncontrollable_modes"}
#: How many points are asked.
FEW = 3


def parts(name: str, *tasks: str) -> list[Result]:
    """The parts of an example, or those of some tasks, whose answers are without functions of time."""
    return [p for p in every_part(name) if not has_functions(p) and (not tasks or p.task in tasks)]


def moving(name: str) -> list[Result]:
    return [part for part in every_part(name) if has_functions(part)]


def points(part: Result, count: int) -> Iterator[Point]:
    """Yield values for every name, small ones with the declared signs, at which the answer exists."""
    values = [value for value in part.answer.values() if isinstance(value, (Scalar, Matrix, Factored))]
    names = {part.plant.variable, *part.plant.field.names}.union(*(value.names for value in values))
    for seed in range(count):
        draw = seeded((seed, part.task))
        point = {name: random_fraction(draw, part.plant.symbols.sign(name)) for name in sorted(names)}
        try:
            for value in values:
                at(value, point)
        except ZeroDivisionError:
            continue
        yield point


def at(value: Any, point: Point) -> Any:
    """Read a value of the kernel at a point; roots as the product of (s − root)."""
    if isinstance(value, Matrix):
        return matrix_at(value, point)
    if isinstance(value, Factored):
        return value_at(value.unit, point) * prod(value_at(factor, point) ** power for factor, power in value.factors)
    if isinstance(value, tuple) and value and isinstance(value[0], tuple):
        return [[at(entry, point) for entry in row] for row in value]
    if isinstance(value, tuple):
        return product_of_roots(value, point)
    return None if value is None else value_at(value, point)


def product_of_roots(roots: Sequence[Root], point: Point) -> Fraction:
    """Multiply (s − root) out: pairs of square roots together, roots without closed form as their whole factor."""
    waiting, total = list(roots), Fraction(1)
    while waiting:
        root = waiting.pop()
        s, centre, radicand = point[root.variable], value_at(root.centre, point), value_at(root.radicand, point)
        if not root.is_closed:
            others = [r for r in waiting if r.factor == root.factor and r.index != root.index]
            partners = list({r.index: r for r in others}.values())
            assert len(partners) + 1 == root.factor.degree(root.variable)
            total *= value_at(root.factor, point)
        elif root.radicand.is_zero:
            partners, total = [], total * (s - centre)
        else:
            partners = [Root(root.factor, root.variable, root.centre, root.radicand, -root.sign)]
            total *= (s - centre) ** 2 - radicand
        for partner in partners:
            waiting.remove(partner)
    return total


def characteristic_at(A: Rows, s: Fraction) -> Fraction:
    return determinant(subtract(times(s, identity(len(A))), A))


def blocks(*rows: tuple[Rows, Rows]) -> Rows:
    return [left + right for pair in rows for left, right in zip(*pair, strict=True)]


def hidden_at(A: Rows, C: Rows, s: Fraction) -> Fraction:
    """Return the polynomial of A on the kernel of 𝒪."""
    return at_number(hidden(A, C), s)


def computed(part: Any, point: Point) -> dict[str, Any]:
    """Return what determinants and polynomials, those of roots too, must be at s, from the plant and the claimed answer."""
    m, s = part.plant.matrices, point[part.plant.variable]
    A, B, C, D = (matrix_at(matrix, point) for matrix in (m.A, m.B, m.C, m.D))
    answer = {name: at(value, point) for name, value in part.answer.items() if isinstance(value, (Matrix, Scalar))}
    match part.task:
        case "observability" | "controllability":
            pair = (transposed(A), transposed(B)) if part.task == "controllability" else (A, C)
            O = observability_rows(*pair)
            square = determinant(O) if len(O) == len(A) else None
            return {"determinant": square, MODES[part.task]: hidden_at(*pair, s)}
        case "pbh" | "detectability" | "stabilizability" | "dual" | "decomposition" | "canonical_form":
            return {"polynomial": characteristic_at(A, s)} if "polynomial" in part.fields else {}
        case "characteristic_polynomial":
            return {"roots": characteristic_at(A, s)}
        case "observer":
            pair = A, C
        case "state_feedback":
            pair = transposed(A), transposed(B)
        case "disturbance_observer":
            moved = part.inner.plant.matrices
            pair = matrix_at(moved.A, point), matrix_at(moved.C, point)
        case "integral_action":
            below = [[-value for value in row] + [Fraction(0)] * len(C) for row in C]
            inputs = [[-value for value in row] for row in D]
            pair = transposed([row + [Fraction(0)] * len(C) for row in A] + below), transposed(B + inputs)
        case "unknown_input_observer" if "H" in answer:
            pair = multiply(subtract(identity(len(A)), multiply(answer["H"], C)), A), C
        case "reduced_order_observer" if "F" in answer:
            moved = [row[len(C) :] for row in multiply(multiply(answer["T"], A), inverse(answer["T"]))]
            pair = moved[len(C) :], moved[: len(C)]
        case "feedforward" | "tracking":
            return errors_of(part, point, (A, B, C), s)
        case "stability_region":
            region_holds(part, point)
            return {}
        case _:
            return {}
    return {"poles": at(part.fields["polynomial"], point), "fixed_modes": hidden_at(*pair, s)}


def errors_of(part: Any, point: Point, plant: tuple[Rows, Rows, Rows], s: Fraction) -> dict[str, Any]:
    """Return the loop in state and estimation error (of full order), or tracking and estimation error (of minimal order)."""
    (A, B, C), K = plant, at(part.loop.answer["K"], point)
    closed = subtract(A, multiply(B, K))
    if part.loop.answer["L"] is None:
        return {"closed_loop_matrix": closed, "polynomial": characteristic_at(closed, s), "K": K}
    L = at(part.loop.answer["L"], point)
    if part.task == "feedforward":
        whole = blocks((closed, multiply(B, K)), ([[Fraction(0)] * len(A) for _ in A], subtract(A, multiply(L, C))))
        return {"closed_loop_matrix": whole, "polynomial": characteristic_at(whole, s), "K": K, "L": L}
    T, known = at(part.loop.estimator.answer["T"], point), len(C)
    moved = [row[known:] for row in multiply(multiply(T, A), inverse(T))]
    through = times(Fraction(-1), multiply(B, [row[known:] for row in multiply(K, inverse(T))]))
    own = subtract(moved[known:], multiply(L, moved[:known]))
    errors = blocks((closed, through), ([[Fraction(0)] * len(A) for _ in own], own))
    return {"error_matrix": errors, "polynomial": characteristic_at(errors, s), "K": K, "L": L}


@pytest.mark.parametrize("name", every(5, EXAMPLES))
def test_derived_fields_are_what_plain_fractions_give(name: str) -> None:
    for part in parts(name):
        hold_in_fractions(part)


def hold_in_fractions(part: Result) -> None:
    met = 0
    for point in points(part, FEW):
        try:
            expected = computed(part, point)
        except ZeroDivisionError:  # s meets a pole
            continue
        met += 1
        for name, value in expected.items():
            assert at(part.fields[name], point) == value, name
    assert met >= 2


@pytest.mark.parametrize("name", every(4, asking("transfer_function")))
def test_a_transfer_function_is_made_of_its_poles_and_zeros(name: str) -> None:
    for part in parts(name, "transfer_function"):
        P = part.answer["transfer_function"]
        ratios = {
            value_at(P, point) * at(part.fields["poles"], point) / at(part.fields["zeros"], point)
            for point in points(part, FEW)
        }
        assert len(ratios) == 1
        assert len(part.fields["poles"]) == P.denominator.degree(part.plant.variable)


@pytest.mark.parametrize(("C", "said"), [("[c d]", ["c != 0"]), ("[c*d-1 d]", ["c*d - 1 != 0"]), ("[1 d]", [])])
def test_integral_action_is_possible_where_no_zero_is_at_rest(C: str, said: list[str]) -> None:
    # P = (d s + c)/(s² + b s + a)
    plant = symobs.StateSpace("[0 1; -a -b]", "[0; 1]", C)
    assert symobs.integral_action(plant, poles=[-1, -2, -3]).fields["solvable_if"] == said


# -- functions of time -------------------------------------------------------------------------------------------------


def points_in_time(part: Result) -> Iterator[Point]:
    """Yield small values of the parameters, the times and horizons, where the conditions hold and roots are real."""
    values = [value for value in part.answer.values() if isinstance(value, (Scalar, Matrix))]
    names = {"t", "T", *part.plant.field.names}.union(*map(symbols_in, values)) - {"s"}
    signs = {**part.plant.symbols.signs, "T": "positive"}
    for seed in range(40 * FEW):
        draw = seeded((seed, part.task))
        point = {name: random_fraction(draw, signs.get(name, "real")) / 16 for name in sorted(names)}
        taken = (
            (value_at(delta, point) > 0) == (sign == "positive") for delta, sign in part.answer.get("taken", {}).items()
        )
        if all(taken) and conditions_hold(part.holds_where, point):
            yield point


def slope_of(variance: Scalar, point: Point, end: Any) -> Any:
    """Return the derivative of a variance by the horizon T there."""
    return World(0, "s", {}, meanings={**point, "T": Series.make([end])}).derivative(Literal(variance), "T")


COVARIANCES = asking("initial_state_covariance")


@pytest.mark.parametrize("name", COVARIANCES)
def test_a_variance_is_least_at_its_best_horizon(name: str) -> None:
    """T**4 == 140*r/q: the derivative by T vanishes there, and is negative before and positive behind."""
    for part in moving(name):
        covariance, point = part.fields["covariance"], next(points_in_time(part))
        for index, text in enumerate(part.fields["best_horizon"]):
            if text is None:
                continue
            power, right = re.fullmatch(r"T\*\*(\d+) == (.*)", text).groups()  # type: ignore[union-attr]
            best = CONTEXT.root(digits(value_at(parse_scalar(right), point)), int(power))
            slope = partial(slope_of, covariance[index, index], point)
            assert slope(best) == 0
            assert slope(best * 9 / 10).parts[0] < 0 < slope(best * 10 / 9).parts[0]


def test_a_best_horizon_is_among_the_examples() -> None:
    assert any(any(part.fields.get("best_horizon", ())) for name in COVARIANCES for part in moving(name))
