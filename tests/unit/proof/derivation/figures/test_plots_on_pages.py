"""A picture on a checked page shows what is true of its polynomial: what is moved, left out or mislabelled is refused."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Scalar
from symobs.exact.core.generators import square_root
from symobs.formula.figures.plot import Curve, End, LinePicture, MarkedPoint, PoleMap, RegionPicture
from symobs.formula.tree import Apply, Environment, Letter, Literal, Negative, Relation, Sum
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Derivation, Plot
from tests.kit import tabled
from tests.support.problems.steps import checked, refused
from tests.support.regions import drawn_by_hand as hand
from tests.support.regions.drawn_by_hand import ALL, equation, h1, h2, k, s

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.formula.figures.plot import Picture, Place

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


def test_a_shifted_polynomial_is_a_subject() -> None:
    """Re s < −1 for s + 3 + k: the roots of χ(s − 1) are stable where k > −2."""
    chi, low, high = s + 3 + k, Fraction(-4), Fraction(4)
    picture = LinePicture("k", (low, high), ((End(Fraction(-2), Scalar.of(-2)), None),))
    subject = Apply("chi_at", Sum((Letter("s"), Negative(Literal(Scalar.of(1))))))
    Derivation((Plot(picture, subject),), start(chi)).check()
    refuse(picture, chi, "-2 is an end|is not stable")


def test_other_symbols_have_values_that_their_signs_allow() -> None:
    picture = hand.pendulum()
    accept(picture, hand.PENDULUM)
    refuse(replace(picture, drawn_for=()), hand.PENDULUM, "depends on h1, h2 alone")
    negative = (("b", Scalar.of(-1)), ("omega", Scalar.of(1)))
    refuse(replace(picture, drawn_for=negative), hand.PENDULUM, "b = -1")
    refuse(replace(picture, drawn_for=(("b", h1), ("omega", Scalar.of(1)))), hand.PENDULUM, "b = h1")
    other = (("b", Scalar.of(2)), ("omega", Scalar.of(1)))
    refuse(replace(picture, drawn_for=other), hand.PENDULUM, "h2 = -b")


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


def test_a_moved_point_of_a_curve_is_seen() -> None:
    picture = hand.hyperbola()
    place = len(picture.curves[0].points) // 2
    accept(with_curve(picture, points=moved(picture.curves[0].points, place, y="0.005")), hand.HYPERBOLA)
    refuse(with_curve(picture, points=moved(picture.curves[0].points, place, "0.05", "0.05")), hand.HYPERBOLA, "h1")


def test_two_branches_are_not_joined() -> None:
    ends = at("-1", "-1"), at("2", "1/2")
    refuse(with_curve(hand.hyperbola(), points=ends), hand.HYPERBOLA, "h1")


@pytest.mark.parametrize(
    "relation",
    [
        equation(h1, h1),
        equation(h1 * h2, 2),
        equation(h1 * h2, Scalar.symbol("c")),
        Relation((Literal(h1 * h2), Literal(Scalar.of(1))), (">",)),
        equation(1, 2),
    ],
)
def test_a_curve_has_an_equation_that_is_its_own(relation: Relation) -> None:
    refuse(with_curve(hand.hyperbola(), equation=relation), hand.HYPERBOLA, "in a picture")


def test_an_equation_may_be_solved_or_squared() -> None:
    solved = equation(h2, 1 / h1)
    squared = equation((h1 * h2 - 1) ** 2, 0)
    for relation in (solved, squared):
        accept(with_curve(hand.hyperbola(), equation=relation), hand.HYPERBOLA)


def test_a_curve_that_crosses_itself_is_drawn_through_the_crossing() -> None:
    chi = s + 1 + 0 * h1
    curve = Curve((at(-1, -1), at("1/1000000", 0), at(1, 1)), equation(h1**2, h2**2))
    window = ((Fraction(-2), Fraction(2)),) * 2
    corners = at(-2, -2), at(2, -2), at(2, 2), at(-2, 2)
    accept(RegionPicture(("h1", "h2"), (window[0], window[1]), (corners,), (curve,)), chi)


def test_what_is_shaded_is_stable() -> None:
    picture = hand.hyperbola()
    window = at(-1, -1), at(5, -1), at(5, 5), at(-1, 5)
    refuse(replace(picture, areas=(window,), marks=()), hand.HYPERBOLA, "is stable")
    first, *others = picture.areas
    beyond = moved(first, 20, -1, -1)
    refuse(replace(picture, areas=(beyond, *others)), hand.HYPERBOLA, "an edge at")


@pytest.mark.parametrize(
    ("place", "kind"),
    [
        (at(3, 3), "unstable"),
        (at(3, -1), "stable"),
        (at(3, 3), "excluded"),
        (at(3, 3), "interesting"),
    ],
)
def test_marks_say_what_is_so(place: Place, kind: str) -> None:
    picture = hand.hyperbola()
    refuse(replace(picture, marks=(MarkedPoint(place, kind),)), hand.HYPERBOLA, f"is {kind}")


def test_a_stable_sample_lies_in_the_shade_and_an_unstable_one_does_not() -> None:
    picture = hand.hyperbola()
    refuse(replace(picture, areas=(), marks=(MarkedPoint(at(3, 3), "stable"),)), hand.HYPERBOLA, "is stable")


def test_a_hole_may_be_irrational() -> None:
    near = Fraction(14142136, 10**7)
    chi = s**2 + s + (h1**2 - 2) ** 2 + h2**2
    window = ((Fraction(-1), Fraction(3)), (Fraction(-2), Fraction(2)))
    corners = at(-1, -2), at(3, -2), at(3, 2), at(-1, 2)
    picture = RegionPicture(("h1", "h2"), window, (corners,), (), (MarkedPoint((near, Fraction(0)), "excluded"),))
    accept(picture, chi)
    refuse(replace(picture, marks=(MarkedPoint(at(1, 1), "excluded"),)), chi, "is excluded")


def test_a_window_has_an_inside() -> None:
    empty = ((Fraction(0), Fraction(0)), (Fraction(0), Fraction(1)))
    refuse(replace(hand.hyperbola(), window=empty), hand.HYPERBOLA, "window is empty")
    refuse(replace(hand.interval(), window=empty[0]), hand.INTERVAL, "window is empty")


# -- intervals --------------------------------------------------------------------------------------------------------


def with_ends(begin: End | None, end: End | None) -> LinePicture:
    return replace(hand.interval(), pieces=((begin, end),), marks=())


SIX, SIXTY = End(Fraction(-6), Scalar.of(-6)), End(Fraction(60), Scalar.of(60))


@pytest.mark.parametrize(
    ("begin", "end", "match"),
    [
        (End(Fraction(-8), Scalar.of(-8)), SIXTY, "-8 is an end"),
        (SIX, End(Fraction(50), Scalar.of(50)), "is not stable"),
        (SIX, End(Fraction("59.5"), Scalar.rational(119, 2)), "119/2 is an end"),
        (SIX, None, "is stable"),
        (End(Fraction(-6), Scalar.of(-7)), SIXTY, "-7 = -6"),
        (End(Fraction(-6), "-6.5"), SIXTY, "-6.5 = -6"),
        (End(Fraction(-6), "six"), SIXTY, "six = -6"),
        (SIXTY, SIX, "follow one another"),
    ],
)
def test_pieces_end_where_stability_does(begin: End | None, end: End | None, match: str) -> None:
    refuse(with_ends(begin, end), hand.INTERVAL, match)


def test_every_stretch_between_pieces_is_unstable() -> None:
    picture = hand.four_pieces()
    refuse(replace(picture, pieces=picture.pieces[:3]), hand.PIECES, "is not stable")


def test_ends_may_be_roots_or_decimals() -> None:
    chi = s + k**2 - 2
    low = End(Fraction(-141421, 10**5), -square_root(Scalar.of(2)))
    high = End(Fraction(141421, 10**5), "≈1.414")
    window = Fraction(-3), Fraction(3)
    accept(LinePicture("k", window, ((None, low), (high, None)), ((Fraction(0), "unstable"),)), chi)
    wrong = replace(low, label=-square_root(Scalar.of(3)))
    refuse(LinePicture("k", window, ((None, wrong), (high, None))), chi, "=")


def test_a_point_is_taken_out_of_a_line() -> None:
    chi = s + (k**2 - 2) ** 2
    ends = [End(Fraction(sign * 141421356, 10**8), f"{sign * 1.41421}") for sign in (-1, 1)]
    window = Fraction(-3), Fraction(3)
    pieces = ((None, ends[0]), (ends[0], ends[1]), (ends[1], None))
    accept(LinePicture("k", window, pieces), chi)
    refuse(LinePicture("k", window, ((None, SIX), (SIX, None))), chi, "is an end|follow")


@tabled
def test_marks_on_a_line_say_what_is_so(place: int, kind: str) -> None:
    refuse(replace(hand.interval(), marks=((Fraction(place), kind),)), hand.INTERVAL, f"{place} is {kind}")


# -- poles ------------------------------------------------------------------------------------------------------------


def with_path(picture: PoleMap, path: tuple[Place, ...]) -> PoleMap:
    return replace(picture, paths=(path, *picture.paths[1:]))


def test_a_moved_pole_is_seen() -> None:
    picture = hand.third_order()
    path = picture.paths[0]
    accept(with_path(picture, moved(path, 30, "0.001")), hand.THIRD_ORDER)
    refuse(with_path(picture, moved(path, 30, "0.2", "0.1")), hand.THIRD_ORDER, "is a pole at k = ")


def test_a_double_pole_is_a_pole() -> None:
    """At k = 1/4 both roots of s² + s + k are −1/2, and the derivative says nothing."""
    assert any(place == at("-1/2", 0) for place in hand.second_order().paths[0])


def test_no_pole_is_left_out_or_drawn_twice() -> None:
    picture = hand.third_order()
    fewer = replace(picture, paths=picture.paths[:2], along=picture.along[:2])
    refuse(fewer, hand.THIRD_ORDER, "there are 2 poles")
    twice = replace(picture, paths=(picture.paths[0], picture.paths[0], picture.paths[2]))
    refuse(twice, hand.THIRD_ORDER, "these are all poles")


def test_poles_that_never_part_are_drawn_twice() -> None:
    chi = (s + 1) ** 2 * (s + 2 + k)
    accept(hand.pole_map(chi, (0, 3), ((-6, 1), (-2, 2))), chi)


def test_paths_go_from_one_value_to_the_other() -> None:
    picture = hand.second_order()
    backwards = replace(
        picture,
        values=(picture.values[1], picture.values[0]),
        paths=tuple(path[::-1] for path in picture.paths),
        along=tuple(along[::-1] for along in picture.along),
    )
    accept(backwards, hand.SECOND_ORDER)
    refuse(replace(picture, values=(Fraction(0), Fraction(3))), hand.SECOND_ORDER, "goes from 0 to 3")
    refuse(replace(picture, along=(picture.along[0][:-1],) * 2), hand.SECOND_ORDER, "goes from 0 to 2")
    refuse(replace(picture, along=()), hand.SECOND_ORDER, "there are 2 poles")
    refuse(replace(picture, discrete=True), hand.SECOND_ORDER, "the poles are those in s")
    refuse(picture, hand.SECOND_ORDER + h1, "depends on k alone")
