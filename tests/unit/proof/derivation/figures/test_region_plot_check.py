"""What the check of a drawn region or line is made of, part by part, with values found by hand."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Scalar
from symobs.formula.figures import Curve, End, LinePicture, MarkedPoint, RegionPicture
from symobs.formula.tree import Environment, Letter
from symobs.proof.derivation import figures_check as region_plot_check
from symobs.proof.derivation.figures_check import Stability
from symobs.proof.derivation.plot_check import faults
from tests.kit import member, scalar, tabled
from tests.support.problems.steps import said
from tests.support.regions.drawn_by_hand import h1, h2, k, s

if TYPE_CHECKING:
    from symobs.formula.figures import Picture, Place

CHI, z = Letter("chi"), Scalar.symbol("z")
AXES = ("h1", "h2")


def at(x: Any, y: Any) -> Place:
    return Fraction(x), Fraction(y)


def told(picture: Picture, chi: Scalar, *, discrete: bool = False, **signs: str) -> list[str]:
    known = Environment(variable="z" if discrete else "s", values={"chi": chi}, signs=signs)
    return list(faults(picture, CHI, known, discrete=discrete))


# -- a polynomial at a place --------------------------------------------------------------------------------------------


def asked(polynomial: Scalar, *axes: str, discrete: bool = False, **signs: str) -> Stability:
    declared = tuple(signs.get(name, "real") for name in axes)
    return Stability(polynomial, "z" if discrete else "s", axes, declared, discrete)


@tabled
def test_a_point_that_is_taken_out_is_all_but_unstable(
    polynomial: str, place: Any, around: list[Any], *, expected: bool
) -> None:
    """At the place the condition is a 16th of what it is around, or less: 16 · 1 ≤ min(16, 25); or h² (2 − h²) in z."""
    test = asked(scalar(polynomial), "h1", discrete="z" in polynomial)
    assert test.is_excluded((Fraction(place),), [(Fraction(value),) for value in around]) is expected


# -- curves ---------------------------------------------------------------------------------------------------------------


@tabled
def test_a_curve_passes_where_it_meets_a_cross(value: str, place: list[Any], *, expected: bool) -> None:
    """Of a place, 0.1 to the sides and 0.2 up and down."""
    assert region_plot_check.passes(scalar(value), AXES, at(*place), at("0.1", "0.2")) is expected


@pytest.mark.parametrize("discrete", [False, True])
def test_a_polynomial_of_numbers_is_stable_by_its_roots(*, discrete: bool) -> None:
    """Products of factors whose roots are known: s + 1 is stable, s − 1 and s² + 1 are not; z/2 ± … likewise."""
    known = (
        (2 * s + 1, True, True),
        (3 * s - 1, False, True),
        (s - 2, False, False),
        (s**2 + 1, False, False),
        (3 * s**2 + s + 1, True, True),
        (s**2 + 5 * s + 9, True, False),
        (s, False, True),
        (s + 1, True, False),
    )
    for (one, *first), (other, *second), (third, *last) in product(known, repeat=3):
        wanted = first[discrete] and second[discrete] and last[discrete]
        value = -(one * other * third).substitute({"s": z if discrete else s}) + 0 * h1
        assert asked(value, "h1", discrete=discrete).is_stable(Fraction(1)) is wanted


# -- regions ----------------------------------------------------------------------------------------------------------------

WINDOW = ((Fraction(-500), Fraction(500)), (Fraction(-1000), Fraction(1000)))
RIGHT = (at(0, -1000), at(500, -1000), at(500, 1000), at(0, 1000))
WALL = Curve((at(0, -1000), at(0, 1000)), said(h1, 0))
#: s + h1 is stable on the right; what is near may be 2 off to the side and 4 up or down, between points 20 and 40.
HALF = RegionPicture(
    AXES, WINDOW, (RIGHT,), (WALL,), (MarkedPoint(at(100, 3), "stable"), MarkedPoint(at(-100, 3), "unstable"))
)
STABLE = s + h1 + 0 * h2


def drawn(parts: dict[str, Any]) -> RegionPicture:
    """Return the picture of a half plane with these parts instead of its own."""
    read: dict[str, Any] = {
        "window": lambda sides: tuple(tuple(map(Fraction, side)) for side in sides),
        "areas": lambda areas: tuple(tuple(at(*place) for place in area) for area in areas),
        "curves": lambda curves: tuple(map(curve, curves)),
        "marks": lambda marks: tuple(MarkedPoint(at(*place), kind) for place, kind in marks),
    }
    return replace(HALF, **{name: read[name](value) for name, value in parts.items()})


def curve(given: dict[str, Any]) -> Curve:
    points = tuple(at(*place) for place in given["points"])
    return Curve(points, said(*map(member, given["equation"])), boundary=given.get("boundary", True))


@tabled
def test_what_a_picture_shows_is_so(parts: dict[str, Any], polynomial: str, faults: list[str]) -> None:
    found = told(drawn(parts), scalar(polynomial))
    assert set(faults) <= set(found)
    assert bool(found) == bool(faults)


def test_what_is_shaded_is_stable_and_what_is_stable_is_shaded() -> None:
    whole = (at(-500, -1000), at(500, -1000), at(500, 1000), at(-500, 1000))
    found = told(replace(HALF, areas=(whole,), marks=()), STABLE)
    assert found[0] == "(-400, -46500/97) is stable"
    assert len(found) == 6 + 28  # of nine places inside, and of all over the window
    assert all(fault.endswith(" is stable") for fault in found)
    bare = told(replace(HALF, areas=(), marks=()), STABLE)
    assert bare
    assert all(fault.endswith("is not stable") for fault in bare)


def test_what_is_too_narrow_to_be_seen_is_not_asked_for() -> None:
    for width, is_seen in ((4, False), (5, True)):
        strip = at(-100, -1000), at(width - 100, -1000), at(width - 100, 1000), at(-100, 1000)
        found = told(replace(HALF, areas=(RIGHT, strip), marks=()), STABLE)
        assert len(found) == 9 * is_seen


# -- lines ------------------------------------------------------------------------------------------------------------------

LINE = (Fraction(-500), Fraction(500))


def end(place: Any, label: Any = None) -> End:
    return End(Fraction(place), Scalar.of(Fraction(place)) if label is None else label)


def on_line(*pieces: Any, chi: Scalar = s + k, window: Any = LINE, **more: Any) -> list[str]:
    return told(LinePicture("k", window, pieces, **more), chi)


@tabled
def test_what_a_line_shows_is_so(
    pieces: list[list[Any]], polynomial: str, marks: list[tuple[Any, str]], window: list[int], faults: list[str]
) -> None:
    ends = [tuple(None if place == "" else end(place) for place in piece) for piece in pieces]
    told_of = tuple((Fraction(place), kind) for place, kind in marks)
    found = on_line(*ends, chi=scalar(polynomial), window=tuple(map(Fraction, window)), marks=told_of)
    assert set(faults) <= set(found)
    assert bool(found) == bool(faults)


def test_what_cannot_be_seen_between_pieces_is_not_asked_for() -> None:
    wide = (Fraction(-1000), Fraction(1000))
    for width, is_seen in ((8, False), (9, True)):
        found = on_line((None, end(0)), (end(width), None), chi=s + 1, window=wide)
        assert any(fault.endswith("is not stable") for fault in found) is is_seen


@tabled
def test_what_is_written_at_an_end_is_its_place(label: Any, *, is_so: bool) -> None:
    """On 0 with b = 1, where what is near may be 2 off."""
    written = scalar(label["value"]) if isinstance(label, dict) else label
    found = on_line((End(Fraction(0), written), None), drawn_for=(("b", Scalar.of(1)),))
    assert found == ([] if is_so else [f"{written} = 0"])


@tabled
def test_a_place_is_stable_or_not(polynomial: str, axes: dict[str, str], place: list[Any], *, expected: bool) -> None:
    test = asked(scalar(polynomial), *axes, discrete="z" in polynomial, **axes)
    assert test.is_stable(*map(Fraction, place)) is expected
