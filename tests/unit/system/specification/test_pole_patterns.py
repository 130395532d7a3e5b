"""Poles by what they are to do: the polynomials of SciPy and of the tables, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import scipy.signal  # type: ignore[import-untyped]

import symobs
from symobs.exact import Scalar
from symobs.ground.errors import DerivationRejected, InputError, ProblemErrors
from symobs.problem import validate
from symobs.problem.file_tables import parse
from symobs.problem.question import question_of
from symobs.system.specification import PolePattern
from symobs.tasks.result import render
from tests.kit import tabled, text_of


def integrators(order: int, **symbols: str) -> symobs.StateSpace:
    """A chain of integrators: the gain is the row of the coefficients, constant first."""
    A = [[int(column == row + 1) for column in range(order)] for row in range(order)]
    return symobs.StateSpace(A, [[0]] * (order - 1) + [[1]], [[1] + [0] * (order - 1)], symbols=symbols or None)


def polynomial(order: int, poles: object) -> list[float]:
    """The coefficients of the polynomial that is assigned, as floats."""
    K = symobs.state_feedback(integrators(order), poles=poles).K
    return [1.0, *(float(entry) for entry in reversed(list(K)))]


@tabled
def test_a_butterworth_polynomial_is_that_of_scipy(order: int) -> None:
    denominator = scipy.signal.butter(order, 1.7, analog=True)[1]
    assert polynomial(order, {"butterworth": "1.7"}) == pytest.approx(denominator.tolist(), rel=1e-9)


@tabled
def test_a_bessel_polynomial_is_that_of_scipy_for_a_delay(order: int) -> None:
    denominator = scipy.signal.bessel(order, 3, analog=True, norm="delay")[1]
    assert polynomial(order, "bessel = 3") == pytest.approx(denominator.tolist(), rel=1e-9)


#: Poles for ω₀ = 1 as Franklin, Powell and Emami-Naeini tabulate them, with the accuracy of their four digits.
ITAE = {2: [-0.7071 + 0.7071j], 3: [-0.7081, -0.5210 + 1.068j], 4: [-0.4240 + 1.2630j, -0.6260 + 0.4141j]}


@pytest.mark.parametrize("order", ITAE)
def test_an_itae_polynomial_has_the_tabulated_poles(order: int) -> None:
    poles = [root for pole in ITAE[order] for root in ({pole, complex(pole).conjugate()} if pole.imag else {pole})]
    assert polynomial(order, {"itae": 1}) == pytest.approx(np.poly(poles).real.tolist(), abs=0.015)


#: The filters of order two for ω₀ = e⁻ᵀ: s² + c ω₀ s + d ω₀².
OF_AN_EXPONENTIAL = [
    ("damping = exp(-T), natural_frequency = 2", 2 * math.exp(-1) * 2, 4),
    ("damping = 1/2, natural_frequency = exp(-T)", math.exp(-1), math.exp(-2)),
    ("butterworth = exp(-T)", math.sqrt(2) * math.exp(-1), math.exp(-2)),
    ("bessel = exp(-T)", 3 * math.exp(-1), 3 * math.exp(-2)),
    ("settling_time = 4 exp(T), overshoot = 0.05", 2 * math.exp(-1), None),
]


@pytest.mark.parametrize(("poles", "twice", "square"), OF_AN_EXPONENTIAL)
def test_a_pattern_of_an_exponential_has_its_page(poles: str, twice: float, square: float | None) -> None:
    found = symobs.state_feedback(integrators(2, T="positive"), poles=poles)
    assert "u = -K x" in found.to("text")
    constant, linear = map(float, found.K.subs(dict.fromkeys(found.K.free_symbols, 1)))
    assert linear == pytest.approx(twice)
    assert square is None or constant == pytest.approx(square)


FILE = """
task = "compensator"
plant = { A = "[0 1 0; 0 0 1; 0 0 0]", B = "[0; 0; 1]", C = "[1 0 0]" }
[symbols]
w = "positive"
[specification]
observer = "minimal"
control_poles = { damping = 0.5, natural_frequency = "w", others = [-4] }
observer_poles = "butterworth = 2 w"
"""


def test_a_file_asks_in_the_same_words_and_its_question_names_the_polynomials() -> None:
    problem = validate(parse(FILE))
    (found,) = problem.solve()
    assert str(found.closed_loop_polynomial) == "(s + 4)*(s**2 + s*w + w**2)*(s**2 + 2*sqrt(2)*s*w + 4*w**2)"
    page = str(render(question_of(problem), "text"))
    assert "s² + 2√2 w s + 4w²" in page


WRONG = FILE.replace("damping", "dampness").replace("2 w", "2 v")


def test_all_errors_of_a_file_are_told_at_once() -> None:
    with pytest.raises(ProblemErrors) as raised:
        validate(parse(WRONG)).solve()
    places = [error.where for error in raised.value.errors]
    assert places == ["specification.control_poles", "specification.observer_poles.butterworth"]


def test_a_page_with_another_pattern_is_rejected() -> None:
    found = symobs.observer(integrators(2), poles={"itae": 2})
    desired: Any = found.desired
    lie = replace(desired.pattern, factors=(desired.pattern.factors[0] + Scalar.of(Fraction(1, 10)),))
    false = replace(found.kind, desired=replace(desired, pattern=lie))
    with pytest.raises(DerivationRejected, match="is not true"):
        replace(found, kind=false).to("text")


def test_a_page_that_says_a_real_pair_settles_is_rejected() -> None:
    """Poles −2 ± √3: at 2 s the slower mode is still at 58.5 %."""
    found = symobs.state_feedback(integrators(2), polynomial="s^2 + 4 s + 1")
    desired: Any = found.desired
    (factor,) = desired.factors
    lie = PolePattern("s", (("damping", Scalar.of(2)), ("settling_time", Scalar.of(2))), (factor,))
    kind: Any = found.kind
    false = replace(kind, desired=replace(desired, pattern=lie))
    with pytest.raises(DerivationRejected, match="is not true"):
        replace(found, kind=false).to("text")


@tabled
def test_what_need_not_be_positive_or_less_than_one_is_refused(poles: str, reason: str) -> None:
    with pytest.raises(InputError) as raised:
        symobs.state_feedback(integrators(2, a="real", p="positive"), poles=poles)
    assert reason in str(raised.value)


@tabled
def test_what_does_not_say_where_poles_are_is_refused_with_the_reason(poles: object, reason: str) -> None:
    with pytest.raises(InputError) as raised:
        symobs.observer(integrators(3), poles=poles)
    assert reason in str(raised.value)
    assert raised.value.where.startswith("specification.poles")


@tabled
def test_filters_that_are_not_tabulated_are_refused(order: int, poles: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        symobs.state_feedback(integrators(order), poles=poles)


def test_in_discrete_time_they_are_refused() -> None:
    with pytest.raises(InputError, match="continuous time"):
        symobs.observer(symobs.StateSpace("[0 1; 0 1]", None, "[1 0]", dt=True), poles={"itae": 1})


@tabled
def test_a_page_says_what_was_specified_and_nothing_else(
    poles: dict[str, str | int], says: str, is_silent_of: str
) -> None:
    text = text_of(symobs.state_feedback(integrators(2), poles=poles))
    assert says in text
    assert is_silent_of not in text


@tabled
def test_what_is_wrong_with_a_pattern_is_said_with_its_repair(order: int, asked: dict[str, str], said: str) -> None:
    with pytest.raises(InputError) as refused:
        symobs.state_feedback(integrators(order), **asked)
    assert said in str(refused.value)
