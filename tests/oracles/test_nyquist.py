"""Encirclements against a fine count, crossovers and delay margins against their formulas in floating point."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest

import symobs
from symobs.exact import Scalar
from symobs.formula.figures import BodePicture, NyquistPicture
from symobs.proof.derivation import Plot, Section
from symobs.proof.derivation.plot_check import faults_of_frequency
from symobs.stability.frequency_plots import bode_picture


@pytest.mark.parametrize("seed", range(16))
def test_counts_and_delay_are_those_of_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, m = 2 + seed % 3, seed % 2
    p, q = [1, *map(int, rng.integers(-5, 9, n))], [int(rng.integers(1, 9)), *map(int, rng.integers(-5, 9, m))]
    found: Any = symobs.margins(symobs.StateSpace.from_transfer_function([q, p]), controller="1").fields
    if np.abs(np.roots(np.polyadd(p, q)).real).min() < 1e-9:
        assert found["encirclements"] is None  # the curve runs through −1
        return
    omega = np.concatenate([-np.geomspace(1e5, 1e-5, 200_000), np.geomspace(1e-5, 1e5, 200_000)])
    loop = np.polyval(q, 1j * omega) / np.polyval(p, 1j * omega)
    if np.abs(np.roots(p).real).min() > 1e-9 and len(np.roots(p)) == n:
        turned = np.unwrap(np.angle(1 + loop))
        assert found["encirclements"] == round((turned[-1] - turned[0]) / (2 * math.pi))
    assert found["open_loop_unstable"] == sum(np.roots(p).real > 1e-9)
    size = np.polysub(np.polymul(q, _mirrored(q)), np.polymul(p, _mirrored(p)))
    crossed = sorted(s.imag for s in np.roots(size) if abs(s.real) < 1e-9 and s.imag > 0)
    assert len(found["gain_crossover"]) == len(crossed)
    delays = []
    for w in crossed:
        phase = np.angle(-np.polyval(q, 1j * w) / np.polyval(p, 1j * w)) % (2 * math.pi)
        delays.append(phase / w)
    if delays:
        assert float(found["delay_margin"]) == pytest.approx(min(delays), abs=2e-6)
    else:
        assert found["delay_margin"] == "oo"


def _mirrored(polynomial: list[int]) -> list[int]:
    order = len(polynomial) - 1
    return [c * (-1) ** (order - k) for k, c in enumerate(polynomial)]


def test_a_loop_with_an_integrator_is_known() -> None:
    """Hold 10/(s(s + 1)(s + 2)): the axis is crossed at ω = √2 with −10/6, and the loop encircles −1 twice, clockwise."""
    plant = symobs.StateSpace.from_transfer_function("10/(s*(s+1)*(s+2))")
    found: Any = symobs.margins(plant, controller="1").fields
    assert [(str(c["omega"]), str(c["value"])) for c in found["axis_crossings"]] == [("sqrt(2)", "-5/3")]
    assert (found["open_loop_unstable"], found["closed_loop_unstable"], found["encirclements"]) == (0, 2, -2)


@pytest.mark.parametrize(
    ("controller", "said"),
    [
        # Ogata, Modern Control Engineering, 5th ed., Example 6-1: stable for k < 6, crossing at sqrt(2)
        ("2", "0 without feedback and 0 with it|meets the real axis at -0.333333 for the frequency 1.414214"),
        ("12", "0 without feedback and 2 with it|counterclockwise −2 times|meets the real axis at -2 for"),
        ("6", "others lie on the boundary of stability|meets the real axis at -1 for"),
    ],
)
def test_the_page_tells_the_numbers_of_the_criterion(controller: str, said: str) -> None:
    plant = symobs.StateSpace.from_transfer_function("1/(s*(s+1)*(s+2))")
    page = " ".join(str(symobs.margins(plant, controller=controller).to("text")).split())
    for words in said.split("|"):
        assert words in page


@pytest.mark.parametrize(
    ("loop", "dt"),
    [
        ("2/(s*(s+1)*(s+2))", 0),
        ("12/(s*(s+1)*(s+2))", 0),
        ("1/(s^2*(s+1))", 0),
        ("10*(s+1)/(s*(s^2+4))", 0),
        ("2*(s+3)/(s*(s-1))", 0),
        ("1/s^3", 0),
        ("(z+1)/((z-1)*(z-1/2))", 1),
        ("1/((z+1)*(z-1/2))", 1),
        ("1/(z^2+1)", 1),
    ],
)
def test_the_drawn_curve_turns_around_minus_one_as_often_as_is_told(loop: str, dt: int) -> None:
    found: Any = symobs.margins(symobs.StateSpace.from_transfer_function(loop, dt=dt), controller="1")
    drawn = [step.picture for step in plots(found) if isinstance(step.picture, NyquistPicture)]
    values = np.array([complex(x, y) for x, y in drawn[0].values])
    turned = np.angle((values[1:] + 1) / (values[:-1] + 1))
    assert np.abs(turned).max() < math.pi / 2
    assert round(2 * turned.sum() / (2 * math.pi), 1) == found.fields["encirclements"]
    assert str(found.to("html")).count("<svg") >= 2


def plots(result: Any) -> list[Plot]:
    """Return the plots of a page."""
    sections = [step for step in result.derivation.steps if isinstance(step, Section)]
    return [step for section in sections for step in section.steps if isinstance(step, Plot)]


def test_a_wrong_frequency_response_is_seen() -> None:
    found: Any = symobs.margins(symobs.StateSpace.from_transfer_function("1/(s*(s+1))"), controller="1")
    loop = Scalar.of(1) / (Scalar.symbol("s") * (Scalar.symbol("s") + 1))
    bode, nyquist = (step.picture for step in plots(found)[:2])
    for picture in (bode, nyquist):
        assert not [*faults_of_frequency(picture, loop, "s", discrete=False)]  # type: ignore[arg-type]
        assert [*faults_of_frequency(picture, 2 * loop, "s", discrete=False)]  # type: ignore[arg-type]
        assert [*faults_of_frequency(picture, loop, "s", discrete=True)]  # type: ignore[arg-type]
    assert isinstance(bode, BodePicture)
    assert isinstance(nyquist, NyquistPicture)
    turned = replace(bode, phases=tuple(angle - 180 for angle in bode.phases))
    moved = replace(bode, across=tuple(x + 1 for x in bode.across))
    left = replace(nyquist, contour=tuple((-x, y) for x, y in nyquist.contour))
    narrow = replace(nyquist, window=((Fraction(0), Fraction(1)), nyquist.window[1]))
    (x, y), *rest = bode.asymptotes
    tilted, cut = replace(bode, asymptotes=((x, y + 1), *rest)), replace(bode, asymptotes=((x, y), rest[-1]))
    for picture in (turned, moved, left, narrow, tilted, cut):
        assert [*faults_of_frequency(picture, loop, "s", discrete=False)]


@pytest.mark.parametrize("numbers", [([2], [1, 3, 2, 0]), ([5, 5], [1, 2, 5, 1]), ([20], [1, 6, 11, 6])], ids=str)
def test_the_bars_of_the_bode_picture_are_the_margins(numbers: tuple[list[int], list[int]]) -> None:
    """Those of python-control, as exactly as 240 nodes over some decades allow."""
    s = Scalar.symbol("s")
    above, below = (sum((Scalar.of(c) * s**k for k, c in enumerate(p[::-1])), Scalar.of(0)) for p in numbers)
    picture = bode_picture(above, below, "s")
    gain, turn, at_phase, at_gain = control.margin(control.tf(*numbers))
    for bar, margin, where in (
        (picture.gain_margin, -20 * math.log10(gain), at_phase),
        (picture.phase_margin, turn, at_gain),
    ):
        if not math.isfinite(margin):
            assert bar is None
            continue
        assert bar is not None
        (x, end), (_, level) = bar
        assert 10 ** float(x) == pytest.approx(where, rel=0.02)
        assert float(end - level) == pytest.approx(margin, rel=0.02, abs=0.2)


@pytest.mark.parametrize(
    ("numbers", "slopes"),
    [
        (([4, 8], [1, 10, 0, 0]), [-40, -20, -40]),
        (([3], [1, 0.2, 4]), [0, -40]),
        (([1, 0], [1, 1, 100, 100]), [20, 0, -40]),
    ],
    ids=str,
)
def test_the_asymptotes_bend_at_roots_and_meet_the_curve_far_away(numbers: Any, slopes: list[int]) -> None:
    """The slopes in dB per decade are found by hand, the corners by NumPy; at its ends the curve is near."""
    s = Scalar.symbol("s")
    above, below = (
        sum((Scalar.of(Fraction(str(c))) * s**k for k, c in enumerate(p[::-1])), Scalar.of(0)) for p in numbers
    )
    picture = bode_picture(above, below, "s")
    places = [(float(x), float(y)) for x, y in picture.asymptotes]
    found = [(d - b) / (c - a) for (a, b), (c, d) in itertools.pairwise(places)]
    assert found == pytest.approx(slopes)
    corners = sorted({round(math.log10(abs(r)), 6) for p in numbers for r in np.roots(p) if abs(r) > 1e-9})
    assert [x for x, _ in places[1:-1]] == pytest.approx(corners, abs=1e-6)
    for (x, y), at in ((places[0], 0), (places[-1], -1)):
        assert picture.across[at] == pytest.approx(x)
        assert float(picture.levels[at]) == pytest.approx(y, abs=0.3)
