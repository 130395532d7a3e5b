"""Time-varying plants: values worked out by hand and by SymPy's calculus, pages read by SymPy, and no lie survives.

Pages are read by the second reader, with SymPy's `diff` and `integrate`; the witness of an integral is not looked at there.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Scalar, antiderivative, derivative
from symobs.formula.expression import parse_scalar
from symobs.ground.errors import BudgetExceeded, CertificateRejected, DerivationRejected, InputError
from symobs.tasks.result import tasks
from tests.kit import tabled, tables, text_of
from tests.support.claims.claims import HOLDS, Setting
from tests.support.sampling import FULL
from tests.support.second_reader import sympy_scalar

pytestmark = pytest.mark.slow

t, t0, t1, T, a, b = sympy.symbols("t t0 t1 T a b")

#: name → (A, C, rank, verdict, Φ where it is rational)
PLANTS = tables(Path(__file__))["plants"]


def solved(name: str, **specification: Any) -> Any:
    A, C, *_ = PLANTS[name]
    return symobs.time_varying_observability(symobs.StateSpace(A, None, C), **specification)


every_plant = pytest.mark.parametrize("name", PLANTS)


def zero(expression: Any) -> bool:
    """Whether a SymPy expression or matrix is 0."""
    if expression.has(sympy.exp, sympy.cos, sympy.sin):
        expression = sympy.simplify(expression.rewrite(sympy.exp))
    entries = list(expression) if isinstance(expression, sympy.MatrixBase) else [expression]
    return all(sympy.expand(sympy.together(entry).as_numer_denom()[0]) == 0 for entry in entries)


# -- answers -----------------------------------------------------------------------------------------------------------


@every_plant
def test_an_answer_meets_its_claim(name: str) -> None:
    """Stack, rank, transition matrix and kernel, in plain fractions at a point and near it."""
    result, (_, _, rank, verdict, transition) = solved(name), PLANTS[name]
    assert (result.rank, result.verdict) == (rank, verdict)
    assert ("transition_matrix" in result.fields) == bool(transition)
    point = {"t": Fraction(7, 3), "a": Fraction(5, 11)}
    HOLDS["time_varying_observability"](result, Setting.of(result.plant, {}, point))


def test_a_parameter_on_which_it_depends_becomes_a_case() -> None:
    result = solved("parametric")
    assert [str(c) for c in result.holds_where] == ["a != 0"]
    (case,) = result.case_tree
    assert [str(c) for c in case.when] == ["a == 0"]
    assert case.result is not None
    assert (case.result.verdict, case.result.answer["rank"]) == ("no", 1)


# -- initial states ----------------------------------------------------------------------------------------------------


@given(st.lists(st.integers(-4, 4), min_size=2, max_size=2), st.lists(st.integers(-3, 3), min_size=3, max_size=3))
@settings(max_examples=15 if FULL else 6, deadline=None)
def test_an_initial_state_is_found_again(x0: list[int], u: list[int]) -> None:
    """Simulated by SymPy's integrals for x₁' = t x₂ + u, x₂' = u, y = x₁ + u."""
    driven = u[0] + u[1] * t + u[2] * t**2
    x2 = x0[1] + sympy.integrate(driven, (t, 1, t))
    x1 = x0[0] + sympy.integrate(sympy.expand(t * x2 + driven), (t, 1, t))
    plant = symobs.StateSpace("[0 t; 0 0]", "[1; 1]", "[1 0]", "[1]")
    output = str(sympy.expand(x1 + driven))
    result = symobs.time_varying_observability(plant, interval="1, 3", output=output, input=str(driven))
    assert list(result.x0) == x0
    spoiled = symobs.time_varying_observability(plant, interval="1, 3", output=f"{output} + t^7", input=str(driven))
    assert spoiled.fields["x0"] is None
    assert "No initial state" in spoiled.to("text")


def test_that_no_state_explains_an_output_is_proved() -> None:
    result = solved("integrator", interval="1, 3", output="t^7")
    candidate = result.answer["candidate"]
    assert result.x0 is None
    for value in (candidate * 2, candidate * 0):
        with pytest.raises(CertificateRejected):
            result.with_answer("candidate", value)
    right = solved("integrator", interval="1, 3", output="2 + t^2/2")
    with pytest.raises(CertificateRejected):
        replace(
            right,
            answer={**right.answer, "x0": None, "candidate": right.answer["x0"], "moment": result.answer["moment"]},
        )


def test_the_interval_said_is_the_one_asked_for() -> None:
    result = solved("integrator", interval="1, 3")
    other = result.derivation
    liar = object.__new__(type(result))
    liar.__dict__.update({k: v for k, v in result.__dict__.items() if k != "derivation"})
    liar.__dict__["write"] = lambda page: setattr(page, "steps", list(other.steps))
    assert liar.derivation.steps == other.steps
    liar.__dict__.pop("derivation")
    liar.__dict__["asked_for"] = replace(result.asked_for, interval=(Scalar.of(1), Scalar.of(4)))
    with pytest.raises(DerivationRejected, match="another t_end"):
        _ = liar.derivation


# -- what is refused ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", sorted(set(tasks()) - {"time_varying_observability"}))
def test_every_other_task_refuses_the_time_and_names_this_one(task: str) -> None:
    plant = symobs.StateSpace("[0 t; 0 0]", "[0; 1]", "[1 0]", symbols={})
    with pytest.raises(InputError, match="time_varying_observability") as caught:
        tasks()[task].function(plant)
    assert task in caught.value.message


@tabled
def test_wrong_input_is_refused(plant: Any, specification: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.time_varying_observability(symobs.StateSpace(**plant), **specification)


def test_what_would_grow_too_long_is_refused() -> None:
    A = [[f"{i + 1}*t + a{i}{j}" for j in range(5)] for i in range(5)]
    with pytest.raises(BudgetExceeded, match="terms"):
        symobs.time_varying_observability(symobs.StateSpace(A, None, [[1, 0, 0, 0, 0]]))


def test_a_condition_is_assumed_beside_functions_of_time() -> None:
    """On such a page cos² + sin² = 1 is known; what is assumed from here on is assumed all the same."""
    plant = symobs.StateSpace("[1/2 -b; 0 1/10]", "[1; 1]", "[1/10 1/10]")
    result = symobs.time_varying_observability(plant, output="sin(2 t)")
    assert [str(condition) for condition in result.conditions] == ["Ne(5*b + 2, 0)"]
    assert "b ≠ -2/5" in result.to("text")


def test_discrete_time_has_no_t() -> None:
    with pytest.raises(InputError, match="discrete time"):
        symobs.StateSpace("[t]", None, "[1]", dt=True)
    with pytest.raises(InputError, match="discrete time"):
        symobs.time_varying_observability(symobs.StateSpace("[1]", None, "[1]", dt=True))


# -- calculus ----------------------------------------------------------------------------------------------------------

COEFFICIENTS = st.lists(st.integers(-5, 5), min_size=1, max_size=4)


def rational(above: list[int], below: list[int]) -> tuple[Scalar, Any]:
    s = Scalar.symbol("t")
    values = [sum((s**k * c for k, c in enumerate(part)), Scalar.of(0)) for part in (above, below)]
    images = [sum(c * t**k for k, c in enumerate(part)) for part in (above, below)]
    assume(not values[1].is_zero)
    return values[0] / values[1], images[0] / images[1]


@given(COEFFICIENTS, COEFFICIENTS)
@settings(max_examples=150 if FULL else 12, deadline=None)
def test_derivatives_and_antiderivatives(above: list[int], below: list[int]) -> None:
    value, image = rational(above, below)
    slope = derivative(value, "t")
    assert zero(sympy_scalar(slope, {"t": t}) - sympy.diff(image, t))
    found = antiderivative(slope, "t")
    assert found is not None
    assert derivative(found, "t") == slope
    again = antiderivative(value, "t")
    has_logarithm = sympy.integrate(sympy.cancel(image), t).has(sympy.log, sympy.atan, sympy.RootSum)
    assert (again is None) == has_logarithm


@tabled
def test_what_has_no_elementary_antiderivative(text: str) -> None:
    """The classical ones: error function, Fresnel's integrals, the exponential integral."""
    assert antiderivative(parse_scalar(text, functions=True), "t") is None


def test_a_zero_of_a_denominator_is_a_case() -> None:
    """For A = [-a t; 0 -b] the closed form divides by a - b; at a = b it is another one."""
    result = symobs.time_varying_observability(symobs.StateSpace("[-a t; 0 -b]", None, "[1 0]"))
    assert [(c.kind, str(c)) for c in result.holds_where if "a - b" in str(c)] == [("claim", "a - b != 0")]
    case = next(case for case in result.case_tree if [str(c) for c in case.when] == ["a - b == 0"])
    assert case.result is not None
    Phi = sympy_scalar(case.result.answer["transition_matrix"][0, 1], {"t": t, "t0": t0})
    (left,) = Phi.free_symbols - {t, t0}
    assert zero(Phi - sympy.exp(-left * (t - t0)) * (t**2 - t0**2) / 2)


# -- pages -------------------------------------------------------------------------------------------------------------


def test_a_rank_on_a_stratum_is_said_outside_its_own_cases() -> None:
    """On the curve where the minors of the first rows vanish the rank is 3, but for where another one vanishes, too."""
    plant = symobs.StateSpace(
        "[omega^2, a, -3; 2, a*b, -b; 1/10, a + 1, 1/a]",
        None,
        "[2, 1, 1; 2, -3, 1/10]",
        symbols={"a": "nonzero", "b": "real", "omega": "positive"},
    )
    found = symobs.time_varying_observability(plant)
    (case,) = found.cases
    (inner,) = case.result.cases  # there (-31, -18, 80), which both outputs do not show, is an eigenvector of A
    assert (inner.result.rank, inner.result.kernel) == (2, ((-31, -18, 80),))
    page = text_of(found)
    assert "≠ 0. In this case rank 𝒪 = 3 for almost all t." in page


def test_a_rank_that_drops_where_two_parameters_vanish_is_conditional_on_them() -> None:
    """det 𝒪 = a t³ + (b² − 2a) t² + a t − b vanishes identically at a = b = 0 alone."""
    plant = symobs.StateSpace("[0 1; -a*t 0]", C="[b*t 1-t]")
    found = symobs.time_varying_observability(plant)
    a, b = sympy.symbols("a b")
    assert (found.verdict, found.conditions) == ("conditional", (sympy.Ne(a, 0) | sympy.Ne(b, 0),))
    assert "Case a = 0" in found.to("text")
