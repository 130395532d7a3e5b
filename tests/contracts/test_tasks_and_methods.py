"""What every registered task and method must keep; a new one is found in the registry and held to it."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from copy import deepcopy
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Matrix, Scalar
from symobs.ground.errors import CertificateRejected, InexactInput
from symobs.tasks.result import Result, methods, tasks
from tests.kit import SERVO, tabled
from tests.support.algebra import assignable, random_fraction, seeded, value_at
from tests.support.claims.asking import (
    DISTURBED,
    OTHER_QUESTIONS,
    OWN_COORDINATES,
    UNASKED,
    WEIGHTED,
    factors,
    is_for,
    specification,
)
from tests.support.claims.claims import HOLDS, Setting, applicable, conditions_hold
from tests.support.paths import ROOT
from tests.support.problems.strategies import Sample, plants, unimodular
from tests.support.sampling import FULL, every
from tests.support.tools.another_process import Account, account_of, read_in_another_process

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.slow

TASKS = sorted(tasks())
#: Every method by its registered name, and every task with the method chosen by itself.
METHODS = [*sorted(methods()), *(f"{task}/auto" for task in TASKS)]
PICKLED = every(6, METHODS)
FORMS = ("json", "text", "latex")

A, B, C = [["0", "1"], ["-a/m", "-2"]], [["0"], ["1/m"]], [["1", "c"]]
POLES = ["-1", "-p"]


def solve(name: str, plant: Any, poles: Any) -> Any:
    """Run one method, or with `auto` the task."""
    task, _, method = name.partition("/")
    return tasks()[task].function(plant, **specification(name, poles), method=method)


def plant_of(sample: Sample) -> Any:
    return symobs.StateSpace(sample.A, sample.B, sample.C)


@cache
def example(name: str) -> Any:
    return solve(name, symobs.StateSpace(A, B, C), POLES)


def unique(result: Any) -> bool:
    """Whether the answer is determined by its claim: it exists, and no family of gains belongs to it."""
    return result.verdict != "no" and result.fields.get("family") is None


def letters(result: Any) -> list[str]:
    """Return the gains among the answers."""
    return [letter for letter in ("K", "L") if result.answer.get(letter) is not None]


# -- input ----------------------------------------------------------------------------------------------

INEXACT = [[[0.5, 1], [0, 1]], np.eye(2), [[np.float64(0.1), 0], [0, 1]], sympy.Matrix([[0.5, 0], [0, 1]])]


@pytest.mark.parametrize("value", INEXACT, ids=["float", "array", "numpy_scalar", "sympy_float"])
def test_floats_in_a_plant_are_refused_with_the_repair(value: Any) -> None:
    rows = value[:1] if isinstance(value, list) else value[:1, :]
    columns = [row[:1] for row in value] if isinstance(value, list) else value[:, :1]
    for place, parts in {
        "A": (value,),
        "B": ([[1, 0], [0, 1]], columns),
        "C": ([[1, 0], [0, 1]], None, rows),
        "D": ([[1, 0], [0, 1]], [[1], [0]], [[1, 0]], value[:1, :1] if not isinstance(value, list) else [value[0][:1]]),
    }.items():
        with pytest.raises(InexactInput) as caught:
            symobs.StateSpace(*parts)
        assert caught.value.where.startswith(f"plant.{place}")
        assert "exact value" in caught.value.repair


def inexact_specifications() -> Iterator[Any]:
    gains = {"L": ([[1.5], [2]], np.ones((2, 1))), "K": ([[1.5, 2]], np.ones((1, 2)))}
    for task in TASKS:
        for name, kind in tasks()[task].keywords.items():
            values = {
                "Poles": ([-1.5, -2], np.array([-1.0, -2.0]), [sympy.Float(-1.5), -2], -1.5),
                "TransferFunctionText": (1.5, 1 / (sympy.Symbol("s") + sympy.Float(1.5))),
                "PolynomialText": (1.5, sympy.Symbol("s") ** 2 + sympy.Float(1.5)),
                "GainText": gains.get(name, ()),
            }.get(kind, ())
            for index, value in enumerate(values):
                yield pytest.param(task, name, value, id=f"{task}-{name}-{index}")


@pytest.mark.parametrize(("task", "name", "value"), list(inexact_specifications()))
def test_floats_in_a_specification_are_refused_with_the_repair(task: str, name: str, value: Any) -> None:
    others = {} if task in UNASKED else specification(task, ["-1", "-2"])
    gains = {"K": ("control", "poles"), "L": ("observer", "poles")}  # what a given gain takes the place of
    stems = gains.get(name, (name.removesuffix("poles").removesuffix("polynomial"),))
    for key in [key for key in others if key.startswith(stems) and key.endswith(("poles", "polynomial"))]:
        del others[key]
    with pytest.raises(InexactInput) as caught:
        tasks()[task].function(SERVO, **{**others, name: value})
    assert caught.value.where.startswith(f"specification.{name}")
    assert "exact value" in caught.value.repair


@pytest.mark.parametrize("name", every(6, METHODS))
def test_input_is_not_changed(name: str) -> None:
    given_lists = deepcopy((A, B, C))
    matrices = [sympy.Matrix(2, 2, [0, 1, -3, sympy.Symbol("a")]), sympy.Matrix([0, 1]), sympy.Matrix([[1, 0]])]
    originals = [matrix.copy() for matrix in matrices]
    poles: list[Any] = [sympy.Rational(-1, 2), "-q"]
    kept = list(poles)
    for parts in (given_lists, matrices):
        plant = symobs.StateSpace(*parts)
        before = [plant.A, plant.B, plant.C, plant.D, repr(plant)]
        result = solve(name, plant, poles)
        result.to("text")
        assert result.plant.matrices == plant.matrices  # a locus declares its gain beside them
        assert [plant.A, plant.B, plant.C, plant.D, repr(plant)] == before
    assert given_lists == (A, B, C)
    assert matrices == originals
    assert poles == kept


@pytest.mark.parametrize("name", every(4, METHODS))
def test_a_question_in_sympy_is_the_question_in_text(name: str) -> None:
    a, s, task = sympy.Symbol("a", positive=True), sympy.Symbol("s"), name.partition("/")[0]
    matrices = sympy.Matrix([[0, 1], [-1 / a, -2]]), sympy.Matrix([0, 1]), sympy.ImmutableMatrix([[1, a]])
    by_text = symobs.StateSpace("[0 1; -1/a -2]", "[0; 1]", "[1 a]", symbols={"a": "positive"})
    by_sympy = symobs.StateSpace(*matrices)
    expected = solve(name, by_text, ["-1/2", "-a"])
    assert solve(name, by_sympy, [-sympy.Rational(1, 2), -a]).to("json") == expected.to("json")
    wanted, kinds = [s + sympy.Rational(1, 2), s + a], tasks()[task].keywords.items()
    polynomials = {n: sympy.prod(factors(name, n, wanted)) for n, k in kinds if k == "PolynomialText"}
    polynomials = {n: value for n, value in polynomials.items() if n not in UNASKED.get(task, ())}
    others = {n: v for n, v in specification(name, None).items() if v is not None}
    found = tasks()[task].function(by_sympy, **others, **polynomials, method=name.partition("/")[2])
    for letter in letters(expected):
        assert found.answer[letter] == expected.answer[letter]
        assert getattr(found, letter).free_symbols <= {a}
    function = symobs.StateSpace.from_transfer_function((s + a) / (s**2 + 2 * s))
    assert function.A == symobs.StateSpace.from_transfer_function("(s + a)/(s^2 + 2 s)", symbols={"a": "real"}).A


# -- runs repeat ----------------------------------------------------------------------------------------


def test_the_same_question_has_the_same_answer_whatever_the_hash_seed() -> None:
    names = every(2, sorted(methods()), 1)
    program = (
        "import pickle, sys; from tests.contracts.test_tasks_and_methods import FORMS, example\n"
        f"told = {{name: [example(name).to(form) for form in FORMS] for name in {names}}}\n"
        "sys.stdout.buffer.write(pickle.dumps(told))"
    )
    run = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONHASHSEED": "271828"},
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    told = pickle.loads(run.stdout)  # noqa: S301 - our own bytes
    for name in names:
        assert told[name] == [example(name).to(form) for form in FORMS], name


# -- no result that does not hold -----------------------------------------------------------------------


def mutants(value: Any) -> Iterator[Any]:
    """Yield values that differ from a matrix, a scalar or a number in one place."""
    if isinstance(value, Matrix):
        for i in range(value.shape[0]):
            for j in range(value.shape[1]):
                for change in (Scalar.of(1), Scalar.symbol("mutation")):
                    entries = [list(row) for row in value.rows]
                    entries[i][j] = entries[i][j] + change
                    yield Matrix.of(entries)
    elif isinstance(value, Scalar):
        yield value + 1
        yield value * 2 + Scalar.symbol("mutation")
    elif isinstance(value, int):
        yield value + 1
        yield value - 1


@pytest.mark.parametrize("name", every(6, METHODS, 1))
def test_a_tampered_answer_is_rejected(name: str) -> None:
    result = example(name)
    rejected = 0
    for key, value in result.answer.items():
        assert result.with_answer(key, value).to("json") == result.to("json")
        # the question: the answer to another one may be the same
        if key in {"horizon", "called_t", "Q", "R", "initial", "final"}:
            continue
        for mutant in mutants(value):
            with pytest.raises((CertificateRejected, ValueError, IndexError)):
                result.with_answer(key, mutant)
            rejected += 1
    assert rejected or result.verdict == "undecided"


@pytest.mark.parametrize("name", sorted(methods()))
def test_nothing_of_a_result_can_be_replaced(name: str) -> None:
    result = example(name)
    before = result.to("json")
    for attribute in ("answer", "plant", "method", "certificates", *result.fields):
        with pytest.raises(AttributeError):
            setattr(result, attribute, None)
    for key in result.answer:
        with pytest.raises(TypeError):
            result.answer[key] = Scalar.of(0)
    assert result.to("json") == before


@pytest.fixture(scope="module")
def elsewhere() -> dict[str, Account]:
    """Return what another process says of the pickled example of every method."""
    return read_in_another_process({name: example(name) for name in PICKLED})


@pytest.mark.parametrize("name", PICKLED)
def test_a_result_pickles_whole(name: str, elsewhere: dict[str, Account]) -> None:
    result = example(name)
    assert elsewhere[name] == account_of(result)
    back = pickle.loads(pickle.dumps(result))  # noqa: S301 - our own bytes
    assert type(back) is type(result)
    told = {k: v for k, v in back.answer.items() if k in back.fields and isinstance(v, Matrix | Scalar)}
    for key, value in list(told.items())[:1]:  # none where undecided, or a vector under another name
        with pytest.raises(CertificateRejected):
            back.with_answer(key, next(mutants(value)))


# -- the face -------------------------------------------------------------------------------------------


def parts_of(value: Any) -> Iterator[Any]:
    if isinstance(value, dict):
        value = [*value.keys(), *value.values()]
    if isinstance(value, list | tuple):
        for part in value:
            yield from parts_of(part)
    else:
        yield value


def is_public(value: Any) -> bool:
    return value is None or isinstance(value, str | bool | int | Decimal | sympy.Basic | sympy.MatrixBase)


SAMPLES: dict[str, tuple[tuple[Any, Any, Any], list[str]]] = {
    "parametric": ((A, B, C), POLES),
    "unobservable": (("[-1 0; 1 -2]", "[0; 1]", "[1 0]"), ["-1", "-2"]),
    "impossible": (("[1 0; 1 2]", "[0; 1]", "[1 0]"), ["-1", "-3"]),
}


@pytest.mark.parametrize("name", every(4, METHODS, 1))
def test_attributes_are_sympy_objects_and_never_of_the_kernel(name: str) -> None:
    for plant, poles in SAMPLES.values():
        if not is_for(name, symobs.StateSpace(*plant), poles):
            continue
        result = solve(name, symobs.StateSpace(*plant), poles)
        for key in result.fields:
            assert all(map(is_public, parts_of(getattr(result, key)))), key
        for case in result.cases:
            assert all(map(is_public, case.when))
        assert all(map(is_public, parts_of(result.conditions)))
        assert set(result.fields) <= set(dir(result))
        for part in (result.plant.A, result.plant.B, result.plant.C, result.plant.D):
            assert isinstance(part, sympy.ImmutableMatrix)
        with pytest.raises(AttributeError, match="has no attribute 'missing'"):
            _ = result.missing


# -- random plants --------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", TASKS)
@given(plants())
@settings(max_examples=8 if FULL else 5)
def test_all_methods_of_a_task_agree_and_meet_the_claim(task: str, sample: Sample) -> None:
    plant = plant_of(sample)
    assume(is_for(task, plant, sample.poles))
    names = [name for name in METHODS if name.startswith(f"{task}/") and name not in OTHER_QUESTIONS]
    results = [solve(name, plant, sample.poles) for name in names]
    first = results[0]
    conditions = [c.expression for result in results for c in result.holds_where]
    names = sorted(
        {
            *plant.field.names,
            *(n for pole in sample.poles for n in sample.names if n in pole),
            *(n for expression in conditions for n in expression.names),  # the horizon's among them
        }
    )
    point = {name: Fraction(seeded((sample, name)).choice([-2, -1, 0, 1, 2, 5])) for name in names}
    for result in results:
        assert result.verdict == first.verdict
        assert {c.expression for c in result.holds_where} == {c.expression for c in first.holds_where}
        if unique(first):
            assert {key: str(value) for key, value in result.fields.items()} == {
                k: str(v) for k, v in first.fields.items()
            }
        for letter in letters(result):
            assert first.with_answer(letter, result.answer[letter]).answer[letter] == result.answer[letter]
        try:
            at = Setting.of(plant, specification(task, sample.poles), point)
        except ZeroDivisionError:
            continue
        for part in applicable(result, point):
            HOLDS[task](part, at)


@pytest.mark.parametrize("task", ["observer", "state_feedback"])
@given(plants(("dense", "hidden", "defective")))
@settings(max_examples=10)
def test_the_verdict_of_a_numeric_design_is_the_solvability_of_the_linear_system(task: str, sample: Sample) -> None:
    plant = plant_of(sample)
    at = Setting.of(plant, {"poles": sample.poles}, {})
    possible = assignable(*at.pair(dual=task == "state_feedback"), at.wanted[""])
    assert solve(f"{task}/auto", plant, sample.poles).verdict == ("yes" if possible else "no")


@pytest.mark.parametrize("name", sorted(methods()))
@given(plants(("parametric",)), st.integers(0, 2**16))
@settings(max_examples=8 if FULL else 4)
def test_a_result_survives_the_specialisation_of_its_parameters(name: str, sample: Sample, seed: int) -> None:
    plant, generator = plant_of(sample), seeded(seed)
    assume(is_for(name, plant, sample.poles))
    result = solve(name, plant, sample.poles)
    unasked = {"stability_region", "time_varying_observability"}  # it has `stable_if`; cases that may take minutes
    if result.task not in unasked:
        assert result.verdict != "conditional" or result.conditions
    point = {n: random_fraction(generator, "nonzero") for n in sample.names}
    values = {n: Scalar.of(x) for n, x in point.items()}
    try:
        at = Setting.of(plant, specification(name, sample.poles), point)
    except ZeroDivisionError:
        with pytest.raises(ZeroDivisionError):
            plant.substitute(values)
        return
    special = symobs.StateSpace(*([[str(e) for e in row] for row in rows] for rows in (at.A, at.B, at.C)))
    poles = [pole.replace("p", f"({point['p']})") for pole in sample.poles]
    found = solve(name, special, poles)
    of_plant = [condition for condition in result.holds_where if condition.expression.names <= point.keys()]
    assume(conditions_hold(of_plant, point))  # a horizon stays a letter
    assume(all(value_at(value, point) for value in result.existence))
    HOLDS[result.task](result, at)
    for letter in [] if {name, result.task} & OWN_COORDINATES else letters(result):
        image = result.answer[letter].substitute(values)
        assert found.with_answer(letter, image).answer[letter] == image
        if unique(found):
            assert found.answer[letter] == image


@pytest.mark.parametrize("task", [task for task in TASKS if task not in {*DISTURBED, *WEIGHTED}])
@given(plants(("dense", "hidden", "parametric"), largest=3), st.data())
@settings(max_examples=8)
def test_a_change_of_coordinates_maps_the_gains(task: str, sample: Sample, data: st.DataObject) -> None:
    """With x̄ = T x: L̄ = T L, K̄ = K T⁻¹, and what belongs to input and output stays."""
    drawn, back = data.draw(unimodular(sample.order))
    T, inverse = sympy.Matrix(drawn), sympy.Matrix(back)
    plant = plant_of(sample)
    assume(is_for(task, plant, sample.poles))
    moved = symobs.StateSpace(T * plant.A * inverse, T * plant.B, plant.C * inverse)
    result, image = (solve(f"{task}/auto", p, sample.poles) for p in (plant, moved))
    assert image.verdict == result.verdict
    kept = ("rank", "transfer_function", "polynomial", "F_stable", "stable", "determinant")
    for key in kept if task in OWN_COORDINATES else (*kept, "F"):
        assert image.fields.get(key) == result.fields.get(key)
    left, right = Matrix.of(drawn), Matrix.of(back)
    for letter in [] if task in OWN_COORDINATES else letters(result):
        gain = left @ result.answer[letter] if letter == "L" else result.answer[letter] @ right
        if unique(result):
            assert image.answer[letter] == gain
        elif task != "compensator":
            assert image.with_answer(letter, gain).answer[letter] == gain


@given(plants(largest=3))
@settings(max_examples=8)
def test_an_observer_is_the_transpose_of_state_feedback_of_the_dual_pair(sample: Sample) -> None:
    plant = plant_of(sample)
    dual = symobs.StateSpace(plant.A.T, plant.C.T, plant.B.T)
    for method in sorted(
        {m.name for m in methods("observer").values()} & {m.name for m in methods("state_feedback").values()}
    ):
        observer, feedback = (
            solve(f"observer/{method}", plant, sample.poles),
            solve(f"state_feedback/{method}", dual, sample.poles),
        )
        assert observer.verdict == feedback.verdict
        L, K = observer.answer["L"], feedback.answer["K"]
        assert (None if L is None else L.T) == K
        assert {str(c) for c in observer.holds_where} == {str(c) for c in feedback.holds_where}
        assert [c.when for c in observer.case_tree] == [c.when for c in feedback.case_tree]
    seen, reached = solve("observability/auto", plant, None), solve("controllability/auto", dual, None)
    assert seen.answer["matrix"] == reached.fields["matrix"].T
    assert (seen.fields["rank"], seen.fields["kernel"]) == (reached.fields["rank"], reached.fields["kernel"])
    assert seen.fields["unobservable_modes"] == reached.fields["uncontrollable_modes"]


@tabled
@given(plants(("dense", "parametric"), largest=3))
@settings(max_examples=8)
def test_a_gain_handed_back_has_the_polynomial_that_was_asked_for(task: str, letter: str, sample: Sample) -> None:
    """Through SymPy and back, and once more by SymPy's own determinant."""
    plant = plant_of(sample)
    result: Any = solve(f"{task}/auto", plant, sample.poles)
    assume(isinstance(result, Result) and letters(result))
    gain = getattr(result, letter)
    again = tasks()[task].function(plant, **{letter: gain})
    assert again.fields["polynomial"] == result.fields["polynomial"]
    s = sympy.Symbol("s")
    moved = gain * plant.C if letter == "L" else plant.B * gain
    found = (s * sympy.eye(sample.order) - plant.A + moved).det(method="berkowitz")
    assert sympy.cancel(found - result.polynomial) == 0
