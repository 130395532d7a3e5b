"""Nyquist and Bode pictures of a loop N/P of numbers: places on the boundary of stability, and the values there.

Poles on the boundary are passed on the unstable side, in half circles so small that they hold no pole of the closed loop.
"""

from __future__ import annotations

from cmath import exp, phase, pi
from fractions import Fraction
from math import ceil, degrees, log10, tan
from typing import TYPE_CHECKING

from symobs.exact.algebraic.root_location import complex_roots
from symobs.formula.figures import BodePicture, NyquistPicture
from symobs.stability.plots import range_around

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Scalar
    from symobs.formula.figures import Place

#: Nodes along the boundary, and along a half circle around a pole.
_NODES, _ARC = 240, 40
#: A root so near to the boundary stands on it; a curve is drawn up to so many times the largest crossing of the real axis.
_ON, _SEEN = 1e-9, 2.2
#: Turns that a dead time makes in a picture, nodes for each of them, and how many nodes there are at most.
_TURNS, _NODES_OF_TURN, _MOST_NODES = 5, 48, 1200
_NONE = Fraction(0)


def nyquist_picture(
    N: Scalar, P: Scalar, variable: str, crossings: Sequence[float], delay: Fraction = _NONE
) -> NyquistPicture:
    """Return the Nyquist picture; `crossings` are the values of the loop on the real axis, `delay` its dead time."""
    discrete = variable == "z"
    above, below = (_numbers(each, variable) for each in (N, P))
    poles, zeros, closed = (_roots(each, variable) for each in (P, N, P + N))
    size = max([1.0, *map(abs, crossings)])

    def along(place: complex) -> float:
        return phase(place) % (2 * pi) if discrete else place.imag

    on = sorted((p for p in poles if _outside(p, discrete=discrete) is None and p.imag >= -_ON), key=along)
    on = [p for k, p in enumerate(on) if not k or abs(p - on[k - 1]) > _ON]
    radius = {p: _radius(p, [*poles, *zeros], closed, (above, below), size * _SEEN, discrete=discrete) for p in on}
    boundary = _boundary([*poles, *zeros, *closed], discrete=discrete, delay=delay)
    contour = [place for place in boundary if all(abs(place - p) > radius[p] for p in on)]
    for p in on:
        turned = p if discrete else 1
        first = 0.0 if abs(p.imag) < _ON and (not discrete or p.real > 0) else -pi / 2
        last = 0.0 if discrete and abs(p.imag) < _ON and p.real < 0 else pi / 2
        arc = [p + radius[p] * turned * exp(1j * (first + (last - first) * k / _ARC)) for k in range(_ARC + 1)]
        at = sum(along(place) <= along(p) for place in contour)
        contour[at:at] = arc
    places = [_rational(place) for place in contour]
    values = [_rational(_at(above, place) / _at(below, place) * exp(-place * float(delay))) for place in contour]
    seen = [v for v in values if max(map(abs, v)) <= 3 * _SEEN * size] + [(Fraction(-1), Fraction(0))]
    ys = [y * sign for _, y in seen for sign in (1, -1)]
    window = range_around([x for x, _ in seen], spread=True), range_around(ys, spread=True)
    return NyquistPicture(tuple(places), tuple(values), window, discrete, bool(on), delay)


def bode_picture(N: Scalar, P: Scalar, variable: str, delay: Fraction = _NONE) -> BodePicture:
    """Return the Bode picture of a loop, with a dead time where there is one."""
    discrete = variable == "z"
    above, below = (_numbers(each, variable) for each in (N, P))
    roots = [root for each in (N, P, P + N) for root in _roots(each, variable)]
    contour: list[Place] = []
    across, levels, phases = list[float](), list[float](), list[float]()
    for place in _boundary(roots, discrete=discrete, delay=delay)[1:]:
        omega = phase(place) if discrete else place.imag
        bottom = _at(below, place)
        if not bottom or not omega > 0 or not (value := _at(above, place) / bottom):
            continue
        angle = degrees(phase(value * exp(-place * float(delay))))
        if phases:
            angle += 360 * round((phases[-1] - angle) / 360)
        elif angle > 90 + 1e-6:
            angle -= 360
        contour.append(_rational(place))
        across.append(log10(omega))
        levels.append(20 * log10(abs(value)))
        phases.append(angle)
    inner = sorted(levels)[len(levels) // 50 : len(levels) - len(levels) // 50]
    window = (Fraction(across[0]), Fraction(across[-1])), range_around([Fraction(x) for x in (*inner, 0)], spread=True)
    over, modulus, turned = (tuple(map(Fraction, each)) for each in (across, levels, phases))
    bent = () if discrete else _asymptotes(N / P, variable, across[0], across[-1])
    return BodePicture(tuple(contour), over, modulus, turned, window, discrete, delay, bent)


def _asymptotes(loop: Scalar, variable: str, low: float, high: float) -> tuple[Place, ...]:
    """Return where the asymptotes of the modulus begin, bend and end: each factor s − p counts as the larger of ω and |p|."""
    parts = loop.numerator, loop.denominator
    zeros, poles = ([abs(root) for root in _roots(each, variable)] for each in parts)
    above, below = (_numbers(each, variable)[0] for each in parts)
    corners = {log10(size) for size in (*zeros, *poles) if size > _ON}

    def level(x: float) -> float:
        sizes = [sum(max(x, log10(size) if size > _ON else x) for size in each) for each in (zeros, poles)]
        return 20 * (log10(abs(above / below)) + sizes[0] - sizes[1])

    return tuple(
        (Fraction(x), Fraction(level(x))) for x in sorted({low, high, *(x for x in corners if low < x < high)})
    )


def _boundary(roots: Sequence[complex], *, discrete: bool, delay: Fraction) -> list[complex]:
    """Return places on the upper half of the boundary, two decades beyond the roots, or around the circle.

    With a dead time they end after some turns, or beyond the roots, and lie near enough to one another for each turn.
    """
    if discrete:
        angles = [pi * (10 ** (-3 * (1 - k / _NODES))) for k in range(_NODES)]
        angles += [pi * k / _NODES for k in range(1, _NODES)]
        found = [complex(1, 0)]
        for angle in sorted(set(angles)):
            t = Fraction(tan(angle / 2))
            below = 1 + t * t
            found.append(complex(float((1 - t * t) / below), float(2 * t / below)))
        return [*found, complex(-1, 0)]
    sizes = [abs(root) for root in roots if abs(root) > _ON] or [1.0]
    low, high = log10(min(sizes)) - 1.5, log10(max(sizes)) + 1.5
    near = [root.imag for root in roots if root.imag > _ON]
    beside = [y * (1 + sign * 10**-k) for y in near for sign in (1, -1) for k in (1, 1.3, 1.6, 2, 2.5, 3)]
    grid = [10 ** (low + (high - low) * k / _NODES) for k in range(_NODES + 1)]
    if delay:
        lag = float(delay)
        end = max(2 * pi * _TURNS / lag, 3 * max(sizes))
        steps = min(ceil(end * lag * _NODES_OF_TURN / (2 * pi)), _MOST_NODES)
        grid = [*(x for x in grid if x < end), *(end * k / steps for k in range(1, steps + 1))]
        beside = [x for x in beside if x < end]
    return [complex(0, 0), *(complex(0, y) for y in sorted({*grid, *beside}))]


def _radius(
    pole: complex,
    ends: Sequence[complex],
    closed: Sequence[complex],
    loop: tuple[Sequence[float], Sequence[float]],
    wanted: float,
    *,
    discrete: bool,
) -> float:
    """Return a radius with values as large as wanted on the half circle, far from other roots and from unstable poles."""
    others = [abs(root - pole) for root in ends if abs(root - pole) > _ON]
    unstable = [abs(root - pole) for root in closed if (_outside(root, discrete=discrete) or 0) > 0]
    size = min([1.0, *others, *unstable]) / 2
    outward = pole if discrete else 1
    for _ in range(60):
        place = pole + size * outward
        if abs(_at(loop[0], place)) >= wanted * abs(_at(loop[1], place)):
            break
        size *= 0.85
    return size


def _outside(root: complex, *, discrete: bool) -> float | None:
    """Return how far a root lies on the unstable side, None on the boundary."""
    far = abs(root) - 1 if discrete else root.real
    return None if abs(far) < _ON else far


def _numbers(polynomial: Scalar, variable: str) -> list[float]:
    return [float(c.fraction()) for c in polynomial.coefficients(variable)]


def _roots(polynomial: Scalar, variable: str) -> list[complex]:
    if polynomial.degree(variable) < 1:
        return []
    found = complex_roots([c.fraction() for c in polynomial.coefficients(variable)])
    return [complex(float(x), float(y)) for x, y in found]


def _at(coefficients: Sequence[float], place: complex) -> complex:
    value = 0j
    for coefficient in coefficients:
        value = value * place + coefficient
    return value


def _rational(value: complex) -> Place:
    return Fraction(value.real), Fraction(value.imag)
