"""Loops with a dead time against roots of the characteristic function in 50 digits, simulations, and Padé approximations."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import control  # type: ignore[import-untyped]
import mpmath
import numpy as np
import pytest
import sympy

import symobs
from symobs.exact import Scalar
from symobs.formula.tree import Decimals, Predicate, Relation
from symobs.ground.errors import DerivationRejected, ProblemErrors
from symobs.problem import validate
from symobs.proof.derivation import Conclude, Inequalities, RegionSummary

mpmath.mp.dps = 50


def plant(loop: str, delay: str, **further: Any) -> symobs.StateSpace:
    return symobs.StateSpace.from_transfer_function(loop, delay=delay, **further)


def region(loop: str, delay: str, **symbols: str) -> Any:
    known = plant(loop, delay, symbols={"k": "real", **symbols})
    return symobs.stability_region(known, controller="k", parameters=["k"]).fields


#: Loops, dead times, the frequency at which the first branch crosses as a first guess, and the sign of the gain.
LOOPS = [
    ("1/s", "1/2", 3.0, ([1], [1, 0])),
    ("1/(s+1)", "1", 2.0, ([1], [1, 1])),
    ("2/(3*s+1)", "1/4", 6.0, ([2], [3, 1])),
    ("1/(s-1)", "1/2", 2.3, ([1], [1, -1])),
    ("(s+1)/s^2", "1/2", 2.3, ([1, 1], [1, 0, 0])),
    ("1/(s*(s+1)*(s+2))", "1/10", 1.2, ([1], [1, 3, 2, 0])),
    ("(s+3)/(s^2-s+2)", "1/10", 14.8, ([1, 3], [1, -1, 2])),
    ("1/((s+1)*(5*s+1))", "2", 0.7, ([1], [5, 6, 1])),
]


@pytest.mark.parametrize(("loop", "delay", "guess", "parts"), LOOPS)
def test_the_largest_gain_solves_the_characteristic_equation(
    loop: str, delay: str, guess: float, parts: tuple[list[int], list[int]]
) -> None:
    """P(jω) + k N(jω) e^{−jωT} = 0 by Newton's method in 50 digits."""
    above, below = parts
    T = mpmath.mpf(Fraction(delay).numerator) / Fraction(delay).denominator

    def phase(omega: Any) -> Any:
        s = mpmath.mpc(0, omega)
        value = mpmath.polyval(above, s) / mpmath.polyval(below, s) * mpmath.exp(-s * T)
        return mpmath.im(value)

    omega = mpmath.findroot(phase, guess)
    s = mpmath.mpc(0, omega)
    k = mpmath.re(-1 / (mpmath.polyval(above, s) / mpmath.polyval(below, s) * mpmath.exp(-s * T)))
    found = region(loop, delay)
    (_, high), *_ = found["intervals"][-1:]
    assert abs(mpmath.mpf(str(symobs_number(high))) - k) < mpmath.mpf(10) ** -11
    assert any(
        abs(mpmath.mpf(str(symobs_number(c["omega"]))) - omega) < mpmath.mpf(10) ** -11 for c in found["crossings"]
    )


def symobs_number(text: object) -> Any:
    """Return the number that an exact text stands for, by SymPy."""
    return sympy.N(sympy.sympify(str(text)), 40)  # noqa: TID251 - texts of our own


def simulated(parts: tuple[list[int], list[int]], delay: float, k: float, steps: int) -> float:
    """Return by which factor the largest state grows per unit of time, of ẋ = A x − B k C x(t − T) by Heun's rule."""
    above, below = parts
    system = control.ss(control.tf(above, below))
    A, B, C = (np.asarray(part) for part in (system.A, system.B, system.C))
    h = delay / steps
    x = np.ones((A.shape[0], 1))
    past, sizes = [x] * (steps + 1), []
    for _ in range(400 * steps):
        before, after = past[-1 - steps], past[-steps]
        first = A @ x - B @ (k * (C @ before))
        second = A @ (x + h * first) - B @ (k * (C @ after))
        x = x + h / 2 * (first + second)
        past.append(x)
        sizes.append(float(np.abs(x).max()))
    third = len(sizes) // 3
    return float((np.log(max(sizes[2 * third :])) - np.log(max(sizes[third : 2 * third]))) / (third * h))


@pytest.mark.slow
@pytest.mark.parametrize(("loop", "delay", "guess", "parts"), LOOPS[:6])
def test_a_simulation_turns_from_decay_to_growth(loop: str, delay: str, guess: float, parts: Any) -> None:
    del guess
    limit = float(symobs_number(region(loop, delay)["intervals"][-1][1]))
    lag = float(Fraction(delay))
    assert simulated(parts, lag, 0.97 * limit, 100) < 0 < simulated(parts, lag, 1.03 * limit, 100)


@pytest.mark.parametrize(("loop", "delay", "guess", "parts"), LOOPS)
def test_pade_approximations_come_near(loop: str, delay: str, guess: float, parts: Any) -> None:
    """The largest gain of a Padé approximation of python-control of order 1 to 4, by its roots, and ours by the same order."""
    del guess
    exact = float(symobs_number(region(loop, delay)["intervals"][-1][1]))
    errors = []
    for order in range(1, 5):
        numerator, denominator = control.pade(float(Fraction(delay)), order)
        above, below = np.polymul(parts[0], numerator), np.polymul(parts[1], denominator)

        def is_stable(k: float, above: Any = above, below: Any = below) -> bool:
            return bool(max(np.roots(np.polyadd(below, k * above)).real) < 0)

        low, high = 0.7 * exact, 2 * exact
        assert not is_stable(high)
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if is_stable(middle) else (low, middle)
        errors.append(abs(low - exact))
        known = plant(loop, delay, symbols={"k": "positive"}, pade=order)
        ours: Any = symobs.stability_region(known, controller="k", parameters=["k"], pade=order)
        assert float(ours.fields["intervals_decimal"][-1][1]) == pytest.approx(low, abs=2e-6)
    assert errors[3] < errors[0]
    assert errors[3] < 0.01 * exact


@pytest.mark.parametrize(
    ("loop", "delay", "unstable"),
    [("2/(s+1)", "1", 0), ("5/(s+1)", "1", 2), ("20/(s+1)", "1", 6), ("2/(s-1)", "1/2", 0), ("1/2/(s-1)", "1/2", 1)],
)
def test_encirclements_are_those_of_a_fine_count(loop: str, delay: str, unstable: int) -> None:
    """The winding of 1 + L along the axis, closed by a large arc where L vanishes."""
    found: Any = symobs.margins(plant(loop, delay), controller="1").fields
    gain, _, pole = loop.rpartition("/(s")
    above, below = [float(Fraction(gain))], [1, int(pole.removesuffix(")"))]
    omega = np.linspace(-400, 400, 2_000_001)
    s = 1j * omega
    value = 1 + np.polyval(above, s) / np.polyval(below, s) * np.exp(-s * float(Fraction(delay)))
    turns = round(np.unwrap(np.angle(value))[-1] / (2 * np.pi) - np.unwrap(np.angle(value))[0] / (2 * np.pi))
    before = int(below[1] < 0)
    assert (found["closed_loop_unstable"], found["encirclements"]) == (unstable, turns)
    assert found["open_loop_unstable"] == before
    assert unstable == before - turns


@pytest.mark.parametrize(("loop", "delay", "guess", "parts"), [*LOOPS[:3], LOOPS[5]])
def test_margins_are_those_of_a_fine_sweep(loop: str, delay: str, guess: float, parts: Any) -> None:
    del guess
    found: Any = symobs.margins(plant(loop, delay), controller="1").fields
    omega = np.logspace(-3, 3.01, 1_000_003)
    s = 1j * omega
    value = np.polyval(parts[0], s) / np.polyval(parts[1], s) * np.exp(-s * float(Fraction(delay)))
    assert float(found["modulus"]) == pytest.approx(abs(1 + value).min(), abs=1e-5)
    crossed = np.flatnonzero(np.diff(np.sign(abs(value) - 1)))
    lags = [np.angle(-value[i]) % (2 * np.pi) for i in crossed]
    if lags:
        assert float(found["phase_deg"]) == pytest.approx(
            min(min(a, 2 * np.pi - a) for a in lags) * 180 / np.pi, abs=1e-2
        )
        assert float(found["delay_margin"]) == pytest.approx(
            min(a / omega[i] for a, i in zip(lags, crossed, strict=True)), abs=1e-4
        )
    else:
        assert (found["phase_deg"], found["delay_margin"]) == ("oo", "oo")
    assert len(found["gain_crossover"]) == len(crossed)


def test_an_integrator_has_its_limit_exactly() -> None:
    found = region("1/s", "1/2", k="positive")
    assert (found["intervals"], found["stable_if"]) == ([["0", "pi"]], ["k < pi"])


def test_in_discrete_time_a_dead_time_is_a_power_of_z() -> None:
    assert str(symobs.transfer_function(plant("1/(z-1/2)", "1/5", dt="1/10")).transfer_function) == "2/(2*z**3 - z**2)"
    by_matrices = symobs.StateSpace("1/2", "1", "1", dt=True, delay=2)
    assert str(symobs.transfer_function(by_matrices).transfer_function) == "2/(2*z**3 - z**2)"


#: What is given beside the plant 1/(s + 1) with the dead time 1/2, and what is said of it.
REFUSED = [
    ({}, "pade = 2"),
    ({"plant": {"pade": 5}}, "write 1, 2, 3 or 4"),
    ({"plant": {"delay": "-1"}}, "give a positive number"),
    ({"plant": {"dt": "1/3"}}, "multiple of dt = 1/3"),
    ({"plant": {"transfer_function": "[1/s 0; 0 1/(s+1)]", "dt": True, "delay": 1}}, "z"),
    ({"task": "margins", "specification": {"poles": "-2"}}, "margins and stability_region with a controller"),
    ({"task": "margins", "specification": {"controller": "s"}}, "a controller with a pole more"),
    ({"task": "margins", "specification": {"controller": "a"}, "symbols": {"a": "positive"}}, "write its value"),
    (
        {"task": "stability_region", "specification": {"controller": "a+b/s"}, "symbols": {"a": "real", "b": "real"}},
        "one gain",
    ),
    ({"task": "stability_region", "specification": {"controller": "1+a/s"}, "symbols": {"a": "real"}}, "no factor"),
]


@pytest.mark.parametrize(("given", "match"), REFUSED)
def test_what_a_dead_time_does_not_go_with_is_refused(given: dict[str, Any], match: str) -> None:
    plant_given = {"transfer_function": "1/(s+1)", "delay": "1/2", **given.get("plant", {})}
    if "dt" in plant_given:
        plant_given["transfer_function"] = plant_given["transfer_function"].replace("s", "z")
    data = {"task": "observer", "specification": {"poles": "-2"}, **given, "plant": plant_given}
    with pytest.raises((symobs.InputError, ProblemErrors), match=match):
        validate(data).solve()


def test_a_nonlinear_plant_has_no_dead_time() -> None:
    table = {"f": "-x + u", "h": "x", "states": "x", "inputs": "u", "equilibrium": {"x": 0, "u": 0}, "delay": 1}
    with pytest.raises(ProblemErrors, match="linearisation"):
        validate({"task": "observer", "plant": table, "specification": {"poles": "-2"}})


@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("table", ["plant", "specification"])
def test_an_approximation_is_that_of_python_control(order: int, table: str) -> None:
    """The transfer function of the file, whether its order stands with the plant or with what is asked for."""
    data: Any = {"task": "transfer_function", "plant": {"A": "-1", "B": "1", "C": "1", "delay": "1/2"}}
    data[table] = {**data.get(table, {}), "pade": order}
    (found,) = validate(data).solve()
    above, below = control.pade(0.5, order)
    for s in (1j, 2 + 1j):
        ours = complex(found.transfer_function.subs("s", s))
        assert ours == pytest.approx(np.polyval(above, s) / np.polyval(below, s) / (s + 1), rel=1e-9)


def changed(result: Any, step: Any, other: Any) -> Any:
    """Return the derivation with a step of its last section replaced, or with one more at its end."""
    *before, section = result.derivation.steps
    inside = [other if each is step else each for each in section.steps] + ([other] if step is None else [])
    return replace(result.derivation, steps=(*before, replace(section, steps=tuple(inside))))


@pytest.mark.parametrize(("loop", "delay"), [each[:2] for each in LOOPS])
def test_the_box_has_the_gains_and_no_others(loop: str, delay: str) -> None:
    """The ends are those of `test_the_largest_gain_solves_the_characteristic_equation`, and a moved one is rejected."""
    known = plant(loop, delay, symbols={"k": "real"})
    result: Any = symobs.stability_region(known, controller="k", parameters=["k"])
    *_, (_, high) = result.fields["intervals_decimal"]
    assert high in result.to("text") or "pi" in result.fields["intervals"][-1][1]
    step = next(s for s in result.derivation.steps[-1].steps if isinstance(s, Inequalities | RegionSummary))
    told = [step.fact.where] if isinstance(step, Inequalities) else step.parts
    first, name, _ = told[-1][0].members
    for moved in (Fraction(high) + Fraction(1, 10**6), Fraction(high) / 2):
        wrong = (Relation((first, name, Decimals(Scalar.of(moved))), ("<", "<")),)
        other: Any
        if isinstance(step, Inequalities):
            other = replace(step, fact=replace(step.fact, where=wrong))
        else:
            other = replace(step, parts=(*told[:-1], wrong))
        with pytest.raises(DerivationRejected):
            changed(result, step, other).check()


def test_the_function_of_a_loop_with_a_dead_time_has_no_property_of_a_polynomial() -> None:
    """s + 1 + k e^{−s/2} has positive coefficients for k > 0, and is not stable for all of them."""
    known = plant("1/(s+1)", "1/2", symbols={"k": "positive"})
    result: Any = symobs.stability_region(known, controller="k", parameters=["k"])
    closed = next(s for s in result.derivation.steps[-1].steps if "dead_time_closed" in repr(s))
    claimed = Conclude(None, (Predicate("stable", closed.relation.members[0]),))
    with pytest.raises(DerivationRejected, match="that the function"):
        changed(result, None, claimed).check()
