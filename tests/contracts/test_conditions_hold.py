"""Conditions are right: results specialised at random rational points, judged by plain arithmetic of fractions.

At points where the conditions of a result hold, its values meet the claim of the plant at that point.  Where a
denominator of the plant vanishes there is no plant.  Where a factor of det 𝒪 or det 𝒞 vanishes the rank drops, and
either no gain exists or a case of the result says why one survives, and that case is right on its stratum.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import function_named, symbols_in
from symobs.problem import Problem, read
from symobs.system.conditions import never_zero
from tests.support.algebra import (
    has_sign,
    matrix_at,
    observability_rows,
    random_fraction,
    rank_of,
    seeded,
    value_at,
)
from tests.support.claims.claims import HOLDS, Setting, applicable, conditions_hold, read_once
from tests.support.derivations import World
from tests.support.examples import NAMES as FILES
from tests.support.examples import problem_of, results_of
from tests.support.sampling import FULL, every

if TYPE_CHECKING:
    from collections.abc import Iterator
    from fractions import Fraction

    from symobs.tasks.result import Result

pytestmark = pytest.mark.slow

#: With SYMOBS_FULL=1 more of them.
POINTS, FEW = (200, 20) if FULL else (50, 8)
#: Points on a stratum: one parameter is solved for, the others are random.
ON_STRATUM = 15 if FULL else 8

BUILT = {
    f"fixed_modes_{'_'.join(str(-pole) for pole in poles)}": f"""
        tasks = ["observability", "observer", "characteristic_polynomial"]
        [symbols]
        c = "real"
        [plant]
        A = "[0 1; -2 -3]"
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
        k = "nonnegative"
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

#: Fractions know no roots: lines of examples with roots in their data are held with 60 digits, their answers to the file.
WITH_ROOTS = {
    "coupled_masses_irrational",
    "inverted_pendulum_integral_action",
    "magnetic_levitation",
    "sensor_at_a_node",
    "servo_with_irrational_poles",
}
#: Whose cosine and sine of one angle are no independent numbers.
_TURNING = {"time_varying_rotating_sensor"}
NAMES = [*(name for name in FILES if name not in WITH_ROOTS | _TURNING), *BUILT]


@cache
def solved(name: str) -> tuple[Problem, tuple[Result, ...]]:
    problem = problem_of(name) if name in FILES else read(BUILT[name])
    results = results_of(name) if name in FILES else problem.solve()
    return replace(problem, specification=read_once(problem.plant, problem.specification)), results


def names_of(problem: Problem, results: tuple[Result, ...]) -> list[str]:
    """Return the parameters of plant and answers."""
    found = set(problem.plant.field.names) | set(problem.plant.symbols.signs)
    for result in results:
        for value in result.answer.values():
            if isinstance(value, (Scalar, Matrix)):
                found |= symbols_in(value) - {result.plant.variable, problem.plant.variable}
        found |= {"t"} if result.in_time else set()
    return sorted(found)


def points(problem: Problem, names: list[str], seed: object) -> Iterator[dict[str, Fraction]]:
    """Yield random points that respect the declared signs."""
    generator, sign = seeded(seed), problem.plant.symbols.sign
    size = 16 if "t" in names else 1  # exponentials of large numbers have too many digits
    while True:
        yield {name: random_fraction(generator, sign(name)) / size for name in names}


def setting(problem: Problem, point: dict[str, Fraction]) -> Setting | None:
    """Return plant and specification at a point, None where they do not exist."""
    try:
        return Setting.of(problem.plant, problem.specification, point)
    except ZeroDivisionError:
        return None


def scalars(point: dict[str, Fraction]) -> dict[str, Scalar]:
    return {name: Scalar.of(value) for name, value in point.items()}


@pytest.mark.parametrize("name", every(5, NAMES))
def test_claims_hold_wherever_the_conditions_do(name: str) -> None:
    problem, results = solved(name)
    names = names_of(problem, results)
    tested = dict.fromkeys(results, 0)
    wanted = POINTS if names else 1
    for point in islice(points(problem, names, name), 4 * wanted):
        at = setting(problem, point)
        if at is None:
            continue
        assert Matrix.of(at.A) == problem.plant.substitute(scalars(point)).matrices.A
        for result in results:
            if tested[result] < wanted and conditions_hold(result.holds_where, point):
                says(result, at)
                tested[result] += 1
        if set(tested.values()) == {wanted}:
            break
    assert set(tested.values()) == {wanted}


def says(result: Result, at: Setting) -> int:
    """Hold all that a result says of a point against the plant there; return in how many ways it says it."""
    parts = list(applicable(result, at.point))
    for part in parts:
        assert part is result or matrix_at(part.plant.matrices.A, at.point) == at.A
        HOLDS[result.task](part, at)
    has_claim = result.verdict != "no" and result.task not in {"observability", "controllability"}
    if result not in parts and has_claim and conditions_hold(result.holds_where, at.point):
        HOLDS[result.task](result, at)  # the claim of an answer is an identity, true on the strata of its cases too
    return len(parts)


@pytest.mark.parametrize("name", every(5, NAMES))
def test_answers_are_defined_wherever_the_conditions_hold(name: str) -> None:
    """No denominator is left out: each factor of one is a condition or excluded by the declared signs.

    A factor with functions in it, 1 - exp(-2 a T), is not 0 at random points where the conditions hold.
    """
    problem, results = solved(name)
    signs = problem.plant.symbols.signs
    everywhere = list(islice(points(problem, names_of(problem, results), name), POINTS))
    for result in results:
        listed = {condition.expression for condition in result.holds_where}
        for value in result.answer.values():
            for entry in value.entries if isinstance(value, Matrix) else [value] if isinstance(value, Scalar) else []:
                factors = {factor for factor, _ in entry.denominator.factors()[1]}
                inner = {factor for factor in factors if not {problem.plant.variable, "t"} & factor.names}
                moving = {factor for factor in inner if any(map(function_named, factor.names))}
                assert all(factor in listed or never_zero(factor, signs) for factor in inner - moving)
                for point in everywhere[: FEW if moving else 0]:
                    if conditions_hold(result.holds_where, point):
                        world = World(0, problem.plant.variable, signs, meanings=dict(point))
                        assert all(world.value(factor) != 0 for factor in moving)


def zeros(problem: Problem, names: list[str], factor: Scalar, seed: object) -> Iterator[dict[str, Fraction]]:
    """Yield points where a factor vanishes, solved for a parameter in which it is linear, the others random."""
    linear = [name for name in sorted(factor.names) if factor.degree(name) == 1]
    for point in islice(points(problem, names, seed), ON_STRATUM):
        for name in linear:
            lead, constant = (value_at(c, point) for c in factor.coefficients(name))
            if lead:
                yield {**point, name: -constant / lead}


@pytest.mark.parametrize("name", every(5, NAMES))
def test_where_a_domain_condition_fails_there_is_no_plant(name: str) -> None:
    problem, results = solved(name)
    names, m = names_of(problem, results), problem.plant.matrices
    entries = [entry for part in (m.A, m.B, m.C, m.D) for entry in part.entries]
    factors = {factor for entry in entries for factor, _ in entry.denominator.factors()[1]}
    domain = {c.expression for result in results for c in result.holds_where if c.kind == "domain"}
    assert domain == {factor for factor in factors if not never_zero(factor, problem.plant.symbols.signs)}
    for factor in factors:
        found = list(zeros(problem, names, factor, name))
        assert found
        for point in found:
            assert setting(problem, point) is None
            with pytest.raises(ZeroDivisionError):
                problem.plant.substitute(scalars(point))


def ranked(result: Any) -> list[tuple[Any, bool]]:
    """Return the parts of a result that stand on a rank, and whether the pair is the dual one."""
    if result.task == "compensator":
        return [(result.feedback, True), (result.estimator, False)]
    # either rank may drop there, or neither: tests/unit/tasks/analysis/test_transfer_function.py and the claims of both
    if result.task in {"transfer_function", "feedforward"}:
        return []
    square = result.task not in {"observability", "controllability"} or result.test_determinant is not None
    return [(result, result.task in {"controllability", "state_feedback"})] if square and result.existence else []


@pytest.mark.parametrize("name", every(5, NAMES))
def test_where_an_existence_factor_vanishes_the_rank_drops_and_the_case_is_right(name: str) -> None:
    problem, results = solved(name)
    names, signs = names_of(problem, results), problem.plant.symbols.signs
    for result in results:
        for part, dual in ranked(result):
            for determinant in part.existence:
                for factor, _ in determinant.numerator.factors()[1]:
                    possible = not never_zero(factor, signs)
                    stratum = [case for case in result.case_tree if factor in {c.expression for c in case.when}]
                    assert bool(stratum) == possible
                    decided = 0
                    for point in zeros(problem, names, factor, name):
                        decided += on_stratum(problem, result, dual=dual, point=point)
                    assert bool(decided) == possible


def on_stratum(problem: Problem, result: Any, *, dual: bool, point: dict[str, Fraction]) -> int:
    """Check the drop of the rank, and what the cases say; where declared signs exclude the point nothing is said."""
    at = setting(problem, point)
    if at is None:
        return 0
    A, C = at.pair(dual=dual)
    assert rank_of(observability_rows(A, C)) < len(A)
    if not all(has_sign(value, problem.plant.symbols.sign(name)) for name, value in point.items()):
        return 0
    return says(result, at)


def test_there_are_strata_among_the_examples() -> None:
    """The test above is not empty: gains that survive, gains that do not, and rank drops were all met."""
    verdicts = {
        (r.task, c.result.verdict)
        for name in NAMES
        for r in solved(name)[1]
        for c in r.case_tree
        if c.result is not None
    }
    tasks = {"observer", "compensator"}
    assert verdicts >= {*((task, verdict) for task in tasks for verdict in ("yes", "no")), ("observability", "no")}
    assert sum(bool(names_of(*solved(name))) for name in FILES) >= 8


# -- what generic answers must not hide --------------------------------------------------------------------------------


@pytest.mark.parametrize("pole", ["-1/(c - 1)", "-1/(2*c - 1)"])
def test_a_stratum_on_which_nothing_is_asked_for_is_no_case(pole: str) -> None:
    plant = symobs.StateSpace("[0 1; -2 -3]", None, "[1 c]")
    result = symobs.observer(plant, poles=[pole, -5])
    assert len(result.case_tree) == 1
    assert result.to("text")
