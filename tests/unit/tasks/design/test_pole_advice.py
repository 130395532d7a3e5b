"""Where to put the poles: circles against numpy's roots, pairs against mpmath, warnings on plants that call for them."""

from __future__ import annotations

import itertools
from dataclasses import replace
from fractions import Fraction
from math import inf as oo
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import symobs
from symobs.exact import Factored, Scalar
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import tabled, tables, text_of
from tests.support.algebra import has_sign
from tests.support.claims.claims import Setting, applicable
from tests.support.claims.claims_of_advice import advice_holds, numerator

s = sympy.Symbol("s")


def plant(transfer_function: str, **symbols: str) -> symobs.StateSpace:
    return symobs.StateSpace.from_transfer_function(transfer_function, symbols=symbols or None)


def advice(transfer_function: str, **asked: Any) -> Any:
    return symobs.pole_advice(plant(transfer_function), **asked)


# -- the circle --------------------------------------------------------------------------------------------------------


def test_a_circle_without_square_roots_is_refused() -> None:
    with pytest.raises(InputError, match="the 7 poles on a circle are not written with square roots"):
        advice("1/s^7", radius=1)


def test_a_radius_of_unknown_sign_is_a_condition() -> None:
    result = symobs.pole_advice(plant("1/s^2"), radius="omega_0")
    assert result.verdict == "conditional"
    assert [str(c) for c in result.conditions] == ["omega_0 > 0"]
    known = symobs.pole_advice(plant("1/s^2", omega_0="positive"), radius="omega_0")
    assert (known.verdict, known.conditions) == ("yes", ())
    own = sympy.Symbol("w", positive=True)
    assert symobs.pole_advice(plant("1/s"), radius=own).poles == (-own,)


# -- zeros -------------------------------------------------------------------------------------------------------------


def test_with_all_poles_at_zeros_none_remains() -> None:
    result = advice("(s + 1) (s + 2)/(s^2 + 1)", radius=3)
    assert (result.poles, result.verdict) == (result.zeros_used, "yes")
    assert sympy.expand(result.polynomial - (s + 1) * (s + 2)) == 0
    assert "none remains" in result.to("text")


# -- the pair ----------------------------------------------------------------------------------------------------------


@given(
    time=st.fractions(min_value="1/20", max_value=50, max_denominator=20),
    overshoot=st.fractions(min_value="1/1000", max_value="99/100", max_denominator=1000),
)
@settings(max_examples=30)
def test_a_pair_overshoots_by_no_more_and_little_less(time: Fraction, overshoot: Fraction) -> None:
    result = advice("1/s^4", settling_time=time, overshoot=overshoot)
    first, second, *others = result.poles
    assert first == sympy.conjugate(second)
    sigma, omega = -sympy.re(first), sympy.im(first)
    assert sigma == 4 / sympy.Rational(time)
    with mpmath.workdps(40):
        reached = mpmath.exp(-mpmath.pi * mpmath.mpf(sigma.p) / sigma.q / (mpmath.mpf(omega.p) / omega.q))
        limit = mpmath.mpf(overshoot.numerator) / overshoot.denominator
        assert reached <= limit
        assert mpmath.log(reached) >= mpmath.log(limit) * (1 + mpmath.mpf(1) / 98)
    assert others == [-5 * sigma, -6 * sigma]


def test_one_pole_has_no_overshoot() -> None:
    result = advice("1/(s - 1)", settling_time=2, overshoot="0.05")
    assert (result.poles, result.omega_d) == ((-2,), None)
    assert "a real pole gives no overshoot" in text_of(result)


def test_zeros_slower_than_the_settling_time_are_not_used() -> None:
    result = advice("(s + 1) (s + 9)/s^4", settling_time=1, overshoot="0.05")
    assert result.zeros_used == (-9,)
    assert any("The zero s = -1 is too slow for the settling time" in warning for warning in result.warnings)


# -- warnings ----------------------------------------------------------------------------------------------------------


@tabled
def test_warnings(transfer_function: str, words: str) -> None:
    result = advice(transfer_function, radius=100 if "exceeds" in words else 3)
    assert any(words in warning for warning in result.warnings)
    page = text_of(result)
    assert page.count("Remark.") == len(result.warnings)


def test_modes_that_no_gain_moves_are_a_no_with_their_subspace() -> None:
    hidden = symobs.StateSpace("[-1 0; 0 2]", "[1; 1]", "[1 0]")
    result = symobs.pole_advice(hidden, radius=3)
    assert result.verdict == "no"
    assert any("s - 2 are unobservable modes" in warning for warning in result.warnings)
    assert symobs.observer(hidden, polynomial=sympy.expand(s**2 + 3 * s + 9)).verdict == "no"
    kept = symobs.StateSpace("[-1 0; 0 -2]", "[1; 1]", "[1 0]")
    assert symobs.pole_advice(kept, radius=3).verdict == "yes"
    assert -2 in symobs.pole_advice(kept, radius=3).zeros_used


# -- special parameters ------------------------------------------------------------------------------------------------

SPECIAL = tables(Path(__file__))["special"]
ASKED: tuple[dict[str, Any], ...] = ({"radius": 3}, {"settling_time": 2, "overshoot": "1/10"})


@pytest.mark.parametrize("asked", ASKED, ids=["circle", "pair"])
@pytest.mark.parametrize("name", SPECIAL)
def test_every_point_of_a_grid_has_advice_that_is_right_there(name: str, asked: dict[str, Any]) -> None:
    """Zeros that are places for poles at a point are used by what is said of it first."""
    A, B, C, signs = SPECIAL[name]
    own = symobs.StateSpace(A, B, C, symbols={n: signs.get(n, "real") for n in "abc" if n in A + C})
    result = symobs.pole_advice(own, **asked)
    assert result.derivation is not None
    names, met, sigma = sorted(own.symbols.signs), 0, 4 / asked.get("settling_time", oo)
    for values in itertools.product(map(Fraction, (-3, -1, 0, 1, 2, 5)), repeat=len(names)):
        point = dict(zip(names, values, strict=True))
        if not all(has_sign(value, own.symbols.sign(n)) for n, value in point.items()):
            continue
        at, found = Setting.of(own, {}, point), list(applicable(result, point))
        assert found
        for part in found:
            advice_holds(part, at)
        met += found[0] is not result
        above = [float(c) for c in numerator(at)]
        roots: list[Any] = list(np.roots(np.trim_zeros(above, "f"))) if any(above) else []
        if all(abs(root.real + sigma) > 1e-6 for root in roots) and len({root.real < -sigma for root in roots}) < 2:
            assert max(len(part.zeros_used) for part in found) == sum(root.real < -sigma for root in roots)
    assert met


def test_what_depends_on_parameters_is_not_called_slow_or_right() -> None:
    """−c is fast enough for c > 4, and the zeros ±√(−a) are on the axis for a > 0."""
    slow = symobs.pole_advice(plant("(s + c)/((s + 1) (s + 3))", c="positive"), settling_time=1, overshoot="0.05")
    assert ["depends on the parameters" in warning for warning in slow.warnings] == [True]
    (first, *_) = slow.cases
    assert ([str(c) for c in first.when], first.result.zeros_used) == (["c - 4 > 0"], (-sympy.Symbol("c"),))
    even = symobs.pole_advice(plant("(s^2 + a)/(s + 1)^3"), radius=1)
    assert ["no place" in w or "For no parameter values are all the zeros" in w for w in even.warnings] == [True]


def test_what_is_not_stable_cannot_be_taken_for_stable() -> None:
    result, v = advice("(s - 2)/(s^2 + s + 1)", radius=3), Scalar.symbol("s")
    told = {"zeros": v - 2, "rest": factors(v + 3), "polynomial": factors(v - 2, v + 3)}
    with pytest.raises(CertificateRejected, match="the poles advised are the stable zeros"):
        replace(result, answer={**result.answer, **told}, taken=(v - 2,))


# -- what is refused ---------------------------------------------------------------------------------------------------


@tabled
def test_what_is_refused_says_where_and_what_to_write(asked: dict[str, Any], where: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        advice("1/s^2", **asked)
    assert caught.value.where == where
    assert caught.value.repair


def test_discrete_time_and_several_outputs_are_refused() -> None:
    with pytest.raises(InputError, match="continuous time") as caught:
        symobs.pole_advice(symobs.StateSpace("[1 1; 0 1]", "[0; 1]", "[1 0]", dt=True), radius=1)
    assert caught.value.where == "plant.dt"
    with pytest.raises(InputError, match="1 inputs and 2 outputs"):
        symobs.pole_advice(symobs.StateSpace("[1 1; 0 1]", "[0; 1]", "[1 0; 0 1]"), radius=1)


# -- lies --------------------------------------------------------------------------------------------------------------


def factors(*found: Any) -> Factored:
    return Factored(Scalar.of(1), tuple((factor, 1) for factor in found))


def test_mirrored_poles_meet_the_identity_and_are_rejected_all_the_same() -> None:
    result, v = advice("(s + 2)/(s^2 + s + 1)", radius=3), Scalar.symbol("s")
    replace(result, answer={**result.answer, "polynomial": factors(v + 2, v + 3)})
    mirrored = {"rest": factors(v - 3), "polynomial": factors(v + 2, v - 3)}
    with pytest.raises(CertificateRejected, match="the poles advised are the stable zeros"):
        replace(result, answer={**result.answer, **mirrored})


def test_a_zero_left_out_or_invented_is_rejected() -> None:
    result, v = advice("(s + 2)/(s^2 + s + 1)", radius=3), Scalar.symbol("s")
    for zeros in (Scalar.of(1), v + 1, (v + 2) ** 2):
        with pytest.raises(
            CertificateRejected,
            match="the poles advised are the stable zeros",
        ):
            replace(result, answer={**result.answer, "zeros": zeros})


def test_a_faster_oscillation_is_rejected() -> None:
    result, v = advice("1/s^2", settling_time=2, overshoot="0.05"), Scalar.symbol("s")
    for omega in (Scalar.of(2), Scalar.rational(21, 10)):
        pair = factors((v + 2) ** 2 + omega**2)
        told = {"omega_d": omega, "rest": pair, "polynomial": pair}
        if omega == Scalar.of(2):
            replace(result, answer={**result.answer, **told})  # slower, and so within the overshoot too
            continue
        with pytest.raises(CertificateRejected, match=r"the claim exp\(-20\*pi/21\) <= 1/20"):
            replace(result, answer={**result.answer, **told})
