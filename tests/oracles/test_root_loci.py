"""Root loci against roots with 50 digits; `test_classical_loops` has those of textbooks."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

import symobs


def symobs_number(text: Any) -> complex:
    """Return the number that an exact text stands for, by SymPy."""
    import sympy  # noqa: PLC0415 - only these tests pay for it

    return complex(sympy.sympify(str(text)).evalf(30))  # noqa: TID251 - texts of our own


@pytest.mark.parametrize("seed", range(12))
def test_multiple_roots_and_crossings_have_50_digits(seed: int) -> None:
    """Hold that p + k q has a double root at each branch point, and a root on the boundary at each crossing, with 50 digits."""
    import sympy  # noqa: PLC0415

    rng = np.random.default_rng(seed)
    discrete = bool(seed % 2)
    n, m = 3 + seed % 2, seed % 3
    p = [1, *(int(c) for c in rng.integers(-6, 7, n))]
    q = [1, *(int(c) for c in rng.integers(-6, 7, m))]
    plant = symobs.StateSpace.from_transfer_function([q, p], dt=int(discrete))
    found: Any = symobs.root_locus(plant).fields
    if len(found["poles"]) < n:  # something cancels
        return
    mpmath.mp.dps = 60

    def value(text: Any) -> Any:
        return mpmath.mpmathify(str(sympy.N(sympy.sympify(str(text)), 55)).replace("*I", "j").replace(" ", ""))  # noqa: TID251 - texts of our own

    def at(s: Any, k: Any, *, slope: bool = False) -> Any:
        whole = [mpmath.mpf(a) + k * b for a, b in zip(p, [0] * (n - m) + q, strict=True)]
        return mpmath.polyval(whole, s, derivative=slope)[int(slope)] if slope else mpmath.polyval(whole, s)

    tiny = mpmath.mpf(10) ** -40
    for branch in found["breakaway"]:
        s, k = value(branch["s"]), value(branch["k"])
        assert k >= 0
        assert abs(at(s, k)) < tiny
        assert abs(at(s, k, slope=True)) < tiny
    for crossing in found["crossings"]:
        k, omega = value(crossing["k"]), value(crossing["omega"])
        s = mpmath.exp(1j * omega) if discrete else 1j * omega
        assert k > 0
        assert abs(at(s, k)) < tiny
    # none is missed: on a fine grid of gains the number of unstable roots changes at the crossings alone
    ends = sorted(float(c["k_decimal"]) for c in found["crossings"])
    grid = np.geomspace(1e-3, 1e4, 3000)
    counts = []
    for k in grid:
        roots = np.roots([a + k * b for a, b in zip(p, [0] * (n - m) + q, strict=True)])
        counts.append(int(sum(abs(roots) > 1) if discrete else sum(roots.real > 0)))
    for k0, k1, a, b in zip(grid, grid[1:], counts, counts[1:], strict=False):
        if a != b:
            assert any(k0 * 0.99 <= end <= k1 * 1.01 for end in ends), (k0, ends)


def test_with_letters_the_centroid_and_the_crossing_gain_stay_exact() -> None:
    """Hold s (s + a)(s + b): by Routh the crossing is at k = a b (a + b), omega^2 = a b."""
    signs = {"a": "positive", "b": "positive"}
    plant = symobs.StateSpace.from_transfer_function("1/(s*(s+a)*(s+b))", symbols=signs)
    found: Any = symobs.root_locus(plant).fields
    (crossing,) = found["crossings"]
    assert str(crossing["k"]) == "a**2*b + a*b**2"
    assert crossing["omega"] == "sqrt(a*b)"
    assert str(found["asymptotes"]["centroid"]) == "-a/3 - b/3"


def test_an_open_sign_of_the_lead_leaves_the_angles_open() -> None:
    plant = symobs.StateSpace.from_transfer_function("b/(s*(s+1))", symbols={"b": "real"})
    found: Any = symobs.root_locus(plant)
    assert found.fields["asymptotes"]["angles"] is None
    assert "Rule 3" not in str(found.to("text"))


def test_a_branch_departs_to_the_left_between_poles_of_one_height() -> None:
    """Hold s^4 = -1 - k: the roots leave along the rays that they lie on."""
    found: Any = symobs.root_locus(symobs.StateSpace.from_transfer_function("1/(s^4+1)")).fields
    assert sorted(float(each["angle"]) for each in found["departure"]) == [45, 135]


@pytest.mark.parametrize("loop", ["1/(s*(s+a)*(s+b))", "(s+a)/(s*(s+b))", "(s+a)/(s^2+b*s+1)"])
def test_branch_points_with_letters_are_double_roots(loop: str) -> None:
    """By SymPy: p + k q and its derivative vanish there, whatever the letters are."""
    import sympy  # noqa: PLC0415

    plant = symobs.StateSpace.from_transfer_function(loop, symbols={"a": "positive", "b": "positive"})
    s, a, b = sympy.symbols("s a b")
    above, below = sympy.fraction(sympy.together(sympy.sympify(loop)))  # noqa: TID251
    found: Any = symobs.root_locus(plant).fields
    assert len(found["breakaway"]) == 2
    for point in found["breakaway"]:
        place, k = (sympy.sympify(str(point[name]), locals={"a": a, "b": b}) for name in ("s", "k"))  # noqa: TID251
        moved = below + k * above
        for expression in (moved, sympy.diff(moved, s)):
            value = expression.subs(s, place).subs({a: sympy.Rational(7, 3), b: sympy.Rational(3, 11)})
            assert abs(sympy.N(value, 60)) < 1e-50


def test_what_has_no_region_is_refused_before_there_is_a_result() -> None:
    plant = symobs.StateSpace("[0 1; -sqrt(a^2+1) -1]", "[0; 1]", "[1 0]", symbols={"a": "positive"})
    with pytest.raises(symobs.InputError, match="is no polynomial"):
        symobs.root_locus(plant)
