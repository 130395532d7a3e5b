"""A picture on a checked page shows what is true of its polynomial: what is moved, left out or mislabelled is refused."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import RealNumber, Scalar
from symobs.exact.core.generators import square_root
from symobs.formula.figures import End, LinePicture, RegionPicture
from symobs.formula.tree import Environment, Letter, Literal
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Derivation, Plot
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary
from symobs.stability.plots import picture_of_plane
from symobs.stability.regions.region import PlaneRegion
from tests.support.examples import NAMES, results_of
from tests.support.problems.steps import checked, refused
from tests.support.regions import drawn_by_hand as hand
from tests.support.regions.drawn_by_hand import ALL, h1, k, s

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.formula.figures import Picture, Place

CHI = Letter("chi")
Z, LINE, END = Scalar.symbol("z"), (Fraction(-4), Fraction(4)), End(Fraction(-2), Scalar.of(-2))


def start(chi: Scalar, *, discrete: bool = False) -> Environment:
    signs = {"b": "positive", "omega": "positive"}
    return Environment(variable="z" if discrete else "s", values={"chi": chi}, signs=signs)


def accept(picture: Picture, chi: Scalar, *, discrete: bool = False) -> None:
    checked(Plot(picture, CHI), start=start(chi, discrete=discrete), discrete=discrete)


def refuse(picture: Picture, chi: Scalar, match: str, *, discrete: bool = False) -> None:
    refused(Plot(picture, CHI), start=start(chi, discrete=discrete), discrete=discrete, match=match)


def at(x: Any, y: Any) -> Place:
    return Fraction(x), Fraction(y)


def moved(points: tuple[Place, ...], index: int, x: Any = 0, y: Any = 0) -> tuple[Place, ...]:
    place = points[index][0] + Fraction(x), points[index][1] + Fraction(y)
    return (*points[:index], place, *points[index + 1 :])


@pytest.mark.parametrize("name", ALL)
def test_what_is_drawn_by_other_means_is_true(name: str) -> None:
    make, chi, discrete = ALL[name]
    accept(make(), chi, discrete=discrete)


# -- the polynomial ---------------------------------------------------------------------------------------------------


def test_a_picture_is_one_of_a_letters_polynomial() -> None:
    picture = hand.hyperbola()
    refused(Plot(picture, Literal(hand.HYPERBOLA)), start=start(hand.HYPERBOLA), match="no letter's")
    refused(Plot(picture, Letter("phi")), start=start(hand.HYPERBOLA), match="before it is established")
    refuse(picture, hand.HYPERBOLA + Scalar.symbol("c"), "depends on h1, h2 alone")


@pytest.mark.parametrize("make", [hand.pendulum, lambda: LinePicture("k", LINE, ((END, None),))])
def test_what_was_true_of_one_polynomial_is_asked_anew_of_another(make: Callable[[], Picture]) -> None:
    """The same picture, found true twice, is no truer of what it was not found true of."""
    picture = make()
    chi = hand.PENDULUM if isinstance(picture, RegionPicture) else s + 2 + k
    for _ in range(2):
        accept(picture, chi)
    refuse(picture, chi + k + h1, "depends on")
    refuse(picture, chi - Scalar.of(1), "in a picture")
    mirrored = chi.substitute({"s": -s})
    refuse(picture, -mirrored if mirrored.coefficients("s")[0] == Scalar.of(-1) else mirrored, "stable")
    with pytest.raises(
        DerivationRejected,
        match=r"the line -1/2 is stable, in a picture,|the line h2 = -b is no boundary, in a picture,",
    ):
        Derivation((Plot(picture, CHI),), start(chi.substitute({"s": Z}), discrete=True), discrete=True).check()
    accept(picture, chi)


# -- regions ----------------------------------------------------------------------------------------------------------


def with_curve(picture: RegionPicture, **changes: Any) -> RegionPicture:
    first, *others = picture.curves
    return replace(picture, curves=(replace(first, **changes), *others))


def test_two_branches_are_not_joined() -> None:
    ends = at("-1", "-1"), at("2", "1/2")
    refuse(with_curve(hand.hyperbola(), points=ends), hand.HYPERBOLA, "h1")


# -- intervals --------------------------------------------------------------------------------------------------------


def test_ends_may_be_roots_or_decimals() -> None:
    chi = s + k**2 - 2
    low = End(Fraction(-141421, 10**5), -square_root(Scalar.of(2)))
    high = End(Fraction(141421, 10**5), "≈1.414")
    window = Fraction(-3), Fraction(3)
    accept(LinePicture("k", window, ((None, low), (high, None)), ((Fraction(0), "unstable"),)), chi)
    wrong = replace(low, label=-square_root(Scalar.of(3)))
    refuse(LinePicture("k", window, ((None, wrong), (high, None))), chi, "=")


# -- poles ------------------------------------------------------------------------------------------------------------


def test_poles_that_never_part_are_drawn_twice() -> None:
    chi = (s + 1) ** 2 * (s + 2 + k)
    accept(hand.pole_map(chi, (0, 3), ((-6, 1), (-2, 2))), chi)


# -- the window -------------------------------------------------------------------------------------------------------


def drawn_regions() -> Iterator[PlaneRegion]:
    """Yield the regions of the worked examples, of a loop with PI control, and of cubic polynomials."""
    for name, path in NAMES.items():
        if "stability_region" in path.read_text("utf-8"):
            found = (getattr(result, "region", None) for result in results_of(name))
            yield from (region for region in found if isinstance(region, PlaneRegion))
    x, y = Scalar.symbol("x"), Scalar.symbol("y")
    several = [s**3 + n * s**2 + (x * (7 * n % 90) + 9 - n) * s + y - x**2 for n in range(1, 9)]
    for chi in (s**4 + 10 * s**3 + 35 * s**2 + (50 + x) * s + 24 + y, s**3 + 6 * s**2 + (11 - y) * s + 6 + y, *several):
        yield PlaneRegion(CriticalPolynomials(chi, StabilityBoundary("s")), ("x", "y"))


def test_every_bounded_component_lies_in_the_window() -> None:
    """Its exact limits in a direction are critical lines of the plane that is divided across that direction."""
    boxes = 0
    for region in drawn_regions():
        picture = picture_of_plane(region)
        for names, (low, high) in zip((region.names, region.names[::-1]), picture.window, strict=True):
            across = PlaneRegion(region.critical, names)
            for component in across.components:
                cylinders = [across.plane.cylinders[across.cells[number].cylinder] for number in component.cells]
                ends = [end for cylinder in cylinders for end in (cylinder.left, cylinder.right)]
                if component.bounded:
                    boxes += 1
                    assert all(end is not None and RealNumber.of(low) < end < RealNumber.of(high) for end in ends)
    assert boxes >= 12
