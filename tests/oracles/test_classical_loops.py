"""Loops of textbooks against 50-digit roots, fine counts, python-control, and printed answers."""

from __future__ import annotations

import cmath
import tomllib
import warnings
from fractions import Fraction
from typing import Any

import control  # type: ignore[import-untyped]
import mpmath
import numpy as np
import pytest
import sympy

import symobs
from tests.support.paths import ROOT

LOOPS = tomllib.loads((ROOT / "tests" / "oracles" / "classical_loops.toml").read_text("utf-8"))["loops"]
#: Printed values that are read off a diagram and are farther from the exact ones than any rounding.
OFF = {
    ("Ogata, Modern Control Engineering, Example 7-20, K = 10", "pm"),
    ("Ogata, Modern Control Engineering, Example 7-20, K = 100", "pm"),
    ("Ogata, Modern Control Engineering, Example 7-20, K = 10", "gm_db"),
    ("Ogata, Modern Control Engineering, Example 7-20, K = 100", "gm_db"),
    ("Ogata, Modern Control Engineering, lag compensation, uncompensated", "pm"),
    ("Ogata, Modern Control Engineering, lag compensation, compensated", "gm_db"),
    ("Åström and Murray, Feedback Systems, 3/(s+1)^3", "sm"),
    ("Åström and Murray, Feedback Systems, good margins and a small distance", "gm"),
    ("Dorf and Bishop, Modern Control Systems, liquid level", "pm"),
}


def chosen(of: Any) -> list[Any]:
    """Return the loops of which something is so, by their number."""
    return [pytest.param(loop, id=str(number)) for number, loop in enumerate(LOOPS, 1) if of(loop)]


def parts(loop: dict[str, Any]) -> tuple[sympy.Poly, sympy.Poly]:
    """Return numerator and denominator by SymPy, decimals as fractions."""
    variable = sympy.Symbol("z" if "z" in loop["loop"] else "s")
    value = sympy.nsimplify(sympy.sympify(loop["loop"], locals={variable.name: variable}), rational=True)  # noqa: TID251
    above, below = sympy.fraction(sympy.together(value))
    return sympy.Poly(above, variable), sympy.Poly(below, variable)


def number(text: Any) -> Any:
    """Return the number that an exact text of a landmark stands for, in 50 digits."""
    value = sympy.sympify(str(text)).evalf(60)  # noqa: TID251 - texts of our own
    return mpmath.mpc(*(mpmath.mpf(str(part)) for part in value.as_real_imag()))


def plant(loop: dict[str, Any], gain: object = 1) -> symobs.StateSpace:
    further: dict[str, Any] = {"dt": True} if "z" in loop["loop"] else {}
    further |= {"delay": loop["delay"]} if "delay" in loop else {}
    text = loop["loop"] if gain == 1 else f"({Fraction(str(gain))})*({loop['loop']})"
    return symobs.StateSpace.from_transfer_function(text, **further)


def numbers(polynomial: sympy.Poly) -> list[Any]:
    return [mpmath.mpf(c.p) / c.q for c in map(sympy.Rational, polynomial.all_coeffs())]


def roots(polynomial: sympy.Poly) -> list[Any]:
    """Return the different roots in more than 50 digits."""
    coefficients = numbers(sympy.sqf_part(polynomial))
    return list(mpmath.polyroots(coefficients, maxsteps=500, extraprec=400)) if len(coefficients) > 1 else []


def branches(p: sympy.Poly, q: sympy.Poly) -> list[tuple[Any, Any]]:
    """Return the multiple roots s of p + k q with k ≥ 0, and k."""
    found = []
    for s in roots(p.diff() * q - p * q.diff()):
        below = mpmath.polyval(numbers(q), s)
        if abs(below) < 1e-30:
            continue
        k = -mpmath.polyval(numbers(p), s) / below
        if abs(mpmath.im(k)) < 1e-30 and mpmath.re(k) > -1e-30 and mpmath.im(s) > -1e-30:
            found.append((s, mpmath.re(k)))
    return found


def crossings(p: sympy.Poly, q: sympy.Poly, *, discrete: bool) -> list[tuple[Any, Any]]:
    """Return k > 0 and ω ≥ 0 of roots on the boundary: with z = (1 + jv)/(1 − jv) in discrete time."""
    v = sympy.Symbol("v", real=True)
    order = max(p.degree(), q.degree())
    image = [
        sum(
            c * ((1 + sympy.I * v) ** k * (1 - sympy.I * v) ** (order - k) if discrete else (sympy.I * v) ** k)
            for k, c in enumerate(reversed(part.all_coeffs()))
        )
        for part in (p, q)
    ]
    product = sympy.expand(image[0] * sympy.conjugate(image[1]))
    odd = sympy.Poly(sympy.im(product), v)
    ends = (
        {mpmath.nstr(abs(x), 20): abs(x) for x in roots(odd) if abs(mpmath.im(x)) < 1e-25} if odd.degree() > 0 else {}
    )
    found = []
    for x in {**ends, "0.0": mpmath.mpf(0)}.values():
        s = (1 + 1j * x) / (1 - 1j * x) if discrete else 1j * x
        found.append((s, 2 * mpmath.atan(x) if discrete else x))
    found += [(mpmath.mpf(-1), mpmath.pi)] if discrete else []
    gains = []
    for s, omega in found:
        below = mpmath.polyval(numbers(q), s)
        if abs(below) > 1e-25:
            k = -mpmath.polyval(numbers(p), s) / below
            if abs(mpmath.im(k)) < 1e-20 and mpmath.re(k) > 1e-20:
                gains.append((mpmath.re(k), omega))
    return gains


def alike(found: list[tuple[Any, ...]], wanted: list[tuple[Any, ...]], near: float) -> bool:
    """Return whether two lists hold the same numbers in any order."""
    left = list(wanted)
    for one in found:
        other = next((w for w in left if all(abs(a - b) < near for a, b in zip(one, w, strict=True))), None)
        if other is None:
            return False
        left.remove(other)
    return not left


@pytest.mark.parametrize("loop", chosen(lambda loop: "delay" not in loop))
def test_landmarks_are_roots_of_50_digits(loop: dict[str, Any]) -> None:
    """All multiple roots and crossings, to 1e-40, and no others."""
    with mpmath.workdps(60):
        q, p = parts(loop)
        found: Any = symobs.root_locus(plant(loop)).fields
        points = [(number(point["s"]), number(point["k"])) for point in found["breakaway"]]
        assert alike(points, branches(p, q), 1e-40), points
        crossed = [(number(c["k"]), number(c["omega"])) for c in found["crossings"]]
        assert alike(crossed, crossings(p, q, discrete="z" in loop["loop"]), 1e-18), crossed


def is_strictly_proper(loop: dict[str, Any]) -> bool:
    above, below = parts(loop)
    return bool(above.degree() < below.degree())


@pytest.mark.parametrize("loop", chosen(is_strictly_proper))
def test_counts_and_margins_are_those_of_python_control(loop: dict[str, Any]) -> None:
    """Encirclements, crossovers, the distance from −1, and the delay margin by the formula min φ/ω."""
    q, p = parts(loop)
    gain = loop.get("at", 1)
    found: Any = symobs.margins(plant(loop), controller=str(gain)).fields
    discrete, lag = "z" in loop["loop"], float(Fraction(loop.get("delay", "0")))
    above, below = ([float(c) for c in part.all_coeffs()] for part in (q * gain, p))
    omega = np.geomspace(1.003e-4, 3.1 if discrete else 1e4, 400_001)
    at = np.exp(1j * omega) if discrete else 1j * omega
    value = np.polyval(above, at) / np.polyval(below, at) * np.exp(-at * lag if lag else 0 * at)
    if lag:
        closed = [np.roots(np.polyadd(np.polymul(below, b), np.polymul(above, a))) for a, b in [control.pade(lag, 12)]]
    else:
        closed = [np.roots(np.polyadd(below, above))]
    far = np.abs(closed[0]) - 1 if discrete else closed[0].real
    before = np.abs(np.roots(below)) - 1 if discrete else np.roots(below).real
    if found["encirclements"] is not None:
        assert found["closed_loop_unstable"] == sum(far > 1e-9)
        assert found["encirclements"] == sum(before > 1e-6) - sum(far > 1e-9)
    if not lag and not discrete and found["encirclements"] is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert -control.nyquist_response(control.tf(above, below)).count == found["encirclements"]
    crossed = [i for i in np.flatnonzero(np.diff(np.sign(np.abs(value) - 1))) if abs(np.abs(value[i]) - 1) < 0.1]
    assert len(found["gain_crossover"]) == len(crossed), found["gain_crossover"]
    if found["encirclements"] is None:
        return  # it runs through −1
    delays = [(cmath.phase(-value[i]) % (2 * np.pi)) / omega[i] for i in crossed]
    if delays:
        assert float(found["delay_margin"]) == pytest.approx(min(delays), rel=2e-3, abs=1e-4)
    else:
        assert found["delay_margin"] == "oo"
    if found["modulus"] is not None:
        assert float(found["modulus"]) == pytest.approx(float(np.abs(1 + value).min()), abs=2e-4)


@pytest.mark.parametrize("loop", chosen(lambda loop: len(loop) > 2))
def test_printed_answers_are_met(loop: dict[str, Any]) -> None:
    """As they are printed: within one and a half per cent, angles and margins within two degrees or half a decibel."""
    if "delay" in loop:
        found: Any = {"crossings": []}
        if "crossings" in loop:
            region: Any = symobs.stability_region(plant(loop), controller="k", parameters=["k"]).fields
            found["crossings"] = [(number(c["k"]).real, number(c["omega"]).real) for c in region["crossings"]]
    else:
        found = dict(symobs.root_locus(plant(loop)).fields)
        found["crossings"] = [(number(c["k"]).real, number(c["omega"]).real) for c in found["crossings"]]
        found["breakaway"] = [
            (number(b["s"]).real, abs(number(b["s"]).imag), number(b["k"]).real) for b in found["breakaway"]
        ]
        found["departure"] = [(float(a["angle"]),) for a in found["departure"]]
    for name in ("crossings", "breakaway", "departure"):
        for printed in loop.get(name, []):
            told = printed if isinstance(printed, list) else [printed]
            assert any(
                np.allclose([float(x) for x in one[: len(told)]], told, rtol=0.015, atol=0.012) for one in found[name]
            ), (name, printed, found[name])
    if "centroid" in loop:
        assert float(found["asymptotes"]["centroid"].fraction()) == pytest.approx(loop["centroid"], abs=1e-3)
    if "at" not in loop:
        return
    loop = {name: value for name, value in loop.items() if (loop["source"], name) not in OFF}
    margins: Any = symobs.margins(plant(loop), controller=str(loop["at"])).fields
    assert (margins["closed_loop_unstable"] == 0) == loop["stable"]
    q, p = parts(loop)
    omega = [float(number(w).real) for w in margins["gain_crossover"]]
    lag = float(Fraction(loop.get("delay", "0")))
    phases = [180 + np.degrees(np.angle(_value(q, p, w, loop["at"]) * np.exp(-1j * w * lag))) for w in omega]
    phases = [phase - 360 if phase > 180 else phase for phase in phases]
    if "pm" in loop:
        assert min(abs(phase - loop["pm"]) for phase in phases) < 2.5, phases
    if "wcp" in loop:
        assert omega[0] == pytest.approx(loop["wcp"], rel=0.02)
    if "sm" in loop:
        assert float(margins["modulus"]) == pytest.approx(loop["sm"], abs=0.005)
    ratios = [-1 / float(number(c["value"]).real) for c in margins["axis_crossings"] if number(c["value"]).real < 0]
    if "gm" in loop:
        assert any(ratio == pytest.approx(loop["gm"], rel=0.015) for ratio in ratios), ratios
    if "gm_db" in loop:
        assert any(abs(20 * np.log10(ratio) - loop["gm_db"]) < 0.6 for ratio in ratios), ratios


def _value(q: sympy.Poly, p: sympy.Poly, omega: float, gain: float) -> complex:
    above, below = ([float(c) for c in part.all_coeffs()] for part in (q, p))
    return complex(gain * np.polyval(above, 1j * omega) / np.polyval(below, 1j * omega))


@pytest.mark.parametrize("loop", chosen(lambda loop: "z" not in loop["loop"] and "delay" not in loop))
def test_tustin_is_that_of_python_control(loop: dict[str, Any]) -> None:
    sampled: Any = symobs.zero_order_hold(plant(loop), rule="tustin", sampling_period="1/10").fields
    A, B, C, D = (np.array([[float(x.fraction()) for x in row] for row in sampled[name].rows]) for name in "ABCD")
    q, p = parts(loop)
    other = control.sample_system(
        control.tf(*([float(c) for c in part.all_coeffs()] for part in (q, p))), 0.1, "tustin"
    )
    for z in (1.3 + 0.4j, -0.7 + 1j, 2j):
        ours = (C @ np.linalg.solve(z * np.eye(len(A)) - A, B) + D)[0, 0]
        assert ours == pytest.approx(complex(other(z)), rel=1e-6)
