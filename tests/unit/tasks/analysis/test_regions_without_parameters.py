"""Regions of polynomials without the parameter, or without any: everywhere or nowhere; horizons that are called t."""

from __future__ import annotations

import json
from typing import Any

import pytest
import sympy

import symobs
from symobs.ground.errors import InputError, ProblemErrors
from symobs.problem import read
from tests.kit import tabled, text_of

T, t = sympy.symbols("T t")


@tabled
@pytest.mark.parametrize(
    ("polynomial", "stable"), [("s^2 + s + 1", True), ("(s + 1)^3", True), ("s^2 - s + 1", False), ("s", False)]
)
def test_a_polynomial_without_the_parameter_is_stable_everywhere_or_nowhere(
    polynomial: str,
    stable: bool,  # noqa: FBT001
    parameters: Any,
) -> None:
    """Their roots are (-1 ± √3 i)/2; -1; (1 ± √3 i)/2; 0."""
    region = symobs.stability_region(polynomial, parameters=parameters)
    assert region.verdict == ("yes" if stable else "no")
    assert list(region.stable_if) == ([] if stable else ["False"])
    assert region.empty is not stable
    if parameters == "h":
        assert [tuple(ends) for ends in region.intervals] == ([("-oo", "oo")] if stable else [])
    for name in ("text", "latex", "html", "json"):
        assert region.to(name)


def test_a_parameter_that_does_not_stand_in_the_polynomial_leaves_the_others_as_they_are() -> None:
    region = symobs.stability_region("s^2 + h s + 1", parameters="h, k", symbols={"h": "real", "k": "real"})
    assert list(region.stable_if) == ["h > 0"]
    assert region.to("latex")
    assert list(symobs.stability_region("s^2 + h s + 1", parameters=[]).stable_if) == ["h > 0"]


@pytest.mark.parametrize(
    ("parameters", "symbols", "repair"),
    [
        (["a", "bb"], None, "did you mean b"),
        (["a", "bb"], {"b": "real"}, "did you mean b"),
        ("a, b, c", None, "its symbols: a, b; leave c out"),
    ],
)
def test_a_parameter_that_nothing_knows_is_misspelt(parameters: Any, symbols: Any, repair: str) -> None:
    with pytest.raises(InputError, match="does not occur in the polynomial") as raised:
        symobs.stability_region("s^2 + a s + b", parameters=parameters, symbols=symbols)
    assert (raised.value.where, repair in raised.value.repair) == ("specification.parameters", True)
    declared = "".join(f'{name} = "{sign}"\n' for name, sign in ({"a": "real", "b": "real"} | (symbols or {})).items())
    text = f'task = "stability_region"\n[symbols]\n{declared}[specification]\npolynomial = "s^2 + a s + b"\n'
    with pytest.raises(ProblemErrors, match="does not occur in the polynomial"):
        read(f"{text}parameters = {json.dumps(parameters)}\n").solve()


def test_the_variable_is_no_parameter() -> None:
    with pytest.raises(
        InputError, match=r"specification\.parameters: s is the variable of the polynomial; leave it out"
    ):
        symobs.stability_region("s^2 + h s + 1", parameters="s")


@pytest.mark.parametrize("of", ["observability", "controllability"])
def test_a_horizon_may_be_called_t(of: str) -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    W = symobs.gramian(plant, horizon="t", of=of)
    tau = sympy.Symbol("tau")
    exponential = sympy.Matrix([[1, tau], [0, 1]])
    seen = sympy.Matrix([[1, 0]]) * exponential if of == "observability" else (exponential * sympy.Matrix([0, 1])).T
    assert W.matrix == (seen.T * seen).integrate((tau, 0, t)).as_immutable()
    assert W.to("latex")


def test_a_horizon_that_contains_t_is_refused() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(InputError, match="the horizon depends on t"):
        symobs.gramian(plant, horizon="2*t")


def test_beside_a_parameter_called_t_in_capitals_the_horizon_is_not_called_t() -> None:
    plant = symobs.StateSpace("[0 T; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(InputError, match="where T is a parameter"):
        symobs.initial_state_covariance(plant, horizon="t", R="[1]")


@tabled
def test_the_covariance_may_end_at_a_horizon_called_t(data: dict[str, str]) -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    called, usual = (symobs.initial_state_covariance(plant, horizon=end, R="[1]", **data) for end in ("t", "T"))
    T = sympy.Symbol("T")
    assert called.covariance == usual.covariance.subs(T, t)
    assert called.output_part == sympy.Matrix([[4 / t, -6 / t**2], [-6 / t**2, 12 / t**3]]).as_immutable()
    assert [None if each is None else each.replace("t", "T") for each in called.best_horizon] == usual.best_horizon
    told, plain = (text_of(each) for each in (called, usual))
    assert "called t in the question, is therefore written T" in told
    assert "is written T" not in plain
