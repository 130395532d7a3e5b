"""What the check of a drawn region or line is made of, part by part, with values found by hand."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Scalar
from symobs.exact.core.generators import square_root
from symobs.formula.figures import Curve, End, LinePicture, MarkedPoint, RegionPicture
from symobs.formula.tree import Environment, Letter
from symobs.proof.derivation import figures_check as region_plot_check
from symobs.proof.derivation import plot_check
from symobs.proof.derivation.figures_check import Stability
from symobs.proof.derivation.plot_check import faults
from tests.kit import scalar, tabled
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


def test_a_point_that_is_taken_out_is_all_but_unstable() -> None:
    """s + h² − …: at the place the condition is a 16th of what it is around, or less."""
    test = asked(s + h1**2, "h1")
    around = [(Fraction(-4),), (Fraction(5),)]
    assert test.is_excluded((Fraction(0),), around)
    assert test.is_excluded((Fraction(1),), around)  # 16 · 1 ≤ min(16, 25)
    assert not test.is_excluded((Fraction("1.01"),), around)
    assert not test.is_excluded((Fraction(1),), [(Fraction("3.99"),), (Fraction(5),)])
    leading = asked(h1**2 * s + 1, "h1")
    assert leading.is_excluded((Fraction(1),), around)
    assert not leading.is_excluded((Fraction("1.01"),), around)
    for sign in (1, -1):  # the leading coefficient alone, which 30 − h² hides in the condition
        assert asked(sign * (h1**2 * s + 30 - h1**2), "h1").is_excluded((Fraction(1),), around)
        assert not asked(sign * (h1**2 * s + 30 - h1**2), "h1").is_excluded((Fraction("1.01"),), around)
    second = asked(s**2 + s + h1**2, "h1")
    assert second.is_excluded((Fraction(1),), around)
    assert not second.is_excluded((Fraction("1.01"),), around)
    assert asked(s - 1, "h1").is_excluded((Fraction(1),), around)
    drawn = asked(z + 1 - h1**2, "h1", discrete=True)  # h² (2 − h²) > 0
    near = [(Fraction("-0.1"),), (Fraction("0.1"),)]
    assert drawn.is_excluded((Fraction("0.01"),), near)
    assert not drawn.is_excluded((Fraction("0.03"),), near)


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


def shifted(index: int, x: int, y: int) -> tuple[Place, ...]:
    place = RIGHT[index][0] + x, RIGHT[index][1] + y
    return (*RIGHT[:index], place, *RIGHT[index + 1 :])


def test_a_curve_is_drawn_where_it_is() -> None:
    def drawn(*points: Place, **more: Any) -> list[str]:
        return told(replace(HALF, curves=(replace(WALL, points=points, **more),)), STABLE)

    assert drawn(at(2, -1000), at(0, 1000)) == drawn(at(0, -1000), at(2, 1000)) == []
    on_the_left = ["h1 = 0 is a boundary"]  # of nothing: on both sides of it nothing is stable
    assert drawn(at(-2, -1000), at(0, 1000)) == drawn(at(0, -1000), at(-2, 1000)) == on_the_left
    for off in (Fraction("2.001"), Fraction("-2.001")):
        assert drawn(at(off, -1000), at(0, 1000)) == drawn(at(0, -1000), at(off, 1000)) == ["h1 = 0"]
    assert drawn(at(0, -1000), at(0, 1000), boundary=False) == ["h1 = 0 is no boundary"]
    # Its middle lies out of sight, or is looked at.
    square = said(h1**2, h1 * 600)
    chi = s + h1 * (h1 - 600)
    empty = replace(HALF, marks=(), areas=((at(-500, -1000), at(0, -1000), at(0, 1000), at(-500, 1000)),))
    assert told(replace(empty, curves=(WALL,)), chi) == []
    assert told(replace(empty, curves=(WALL, Curve((at(0, 0), at(600, 0)), square, boundary=True))), chi) != []
    far = Curve((at(600, 0), at(600, 1)), square)
    assert told(replace(empty, curves=(WALL, far)), chi) == []


def test_the_middle_of_a_segment_may_lie_farther_off() -> None:
    """h2 = h1²/k: between −100 and 100 the middle lies 10 000/k off."""
    for scale, is_near in ((250, True), (249, False)):
        curve = Curve((at(-100, Fraction(10**4, scale)), at(100, Fraction(10**4, scale))), said(scale * h2, h1**2))
        found = told(replace(HALF, curves=(WALL, replace(curve, boundary=True)), marks=()), STABLE)
        assert (found == []) == is_near
        assert is_near or len(found) == 1


def test_a_middle_out_of_sight_is_not_looked_at() -> None:
    curve = Curve((at(-600, 1440), at(600, 1440)), said(250 * h2, h1**2))
    assert told(replace(HALF, curves=(WALL, curve)), STABLE) == []


def test_a_window_has_an_inside() -> None:
    for window in (
        ((Fraction(0), Fraction(0)), WINDOW[1]),
        ((Fraction(1), Fraction(0)), WINDOW[1]),
        (WINDOW[0], (Fraction(0), Fraction(0))),
        (WINDOW[0], (Fraction(1), Fraction(0))),
    ):
        assert told(replace(HALF, window=window), STABLE) == ["the window is empty"]


def test_an_equation_is_of_the_axes_and_not_constant() -> None:
    for relation in (said(h1, h1), said(1, 2), said(h1, k), said(h1, ">", 0)):
        found = told(replace(HALF, curves=(replace(WALL, equation=relation), WALL)), STABLE)
        assert len(found) == 1
        assert found[0].endswith("is the equation of a curve")
    wrong = replace(WALL, points=(at(9, 0), at(9, 1)))
    assert told(replace(HALF, curves=(WALL, wrong, replace(WALL, boundary=False))), STABLE) == [
        "h1 = 0",
        "h1 = 0 is no boundary",
    ]


def test_an_area_has_its_edges_on_curves_or_on_the_border() -> None:
    for index, x, y in ((0, 2, 0), (0, -2, 0), (1, 2, 0), (1, -2, 0), (1, 0, 4), (2, 0, -4), (2, 0, 4), (3, 0, 3)):
        assert told(replace(HALF, areas=(shifted(index, x, y),), marks=()), STABLE) == [], (index, x, y)
    beyond = told(replace(HALF, areas=(shifted(1, 3, 0),), marks=()), STABLE)
    assert beyond[0] == "an edge at (503, -1000), outside of the window"
    above = told(replace(HALF, areas=(shifted(2, 0, 5),), marks=()), STABLE)
    assert above[0] == "an edge at (500, 1005), outside of the window"
    five = (*RIGHT, at(3, 0))
    assert told(replace(HALF, areas=(five,), marks=()), STABLE)[0] == "an edge at (3, 0)"
    assert told(replace(HALF, areas=((*RIGHT, at(2, 0)),), marks=()), STABLE) == []
    sloping = (*RIGHT[:3], at(100, 1000))
    assert "an edge at (50, 0)" in told(replace(HALF, areas=(sloping,), marks=()), STABLE)
    for index, x, y in ((3, 3, 1000), (3, 40, 1000), (0, 3, -1000), (0, 40, -1000)):  # where a curve meets the border
        moved = (*RIGHT[:index], at(x, y), *RIGHT[index + 1 :])
        assert told(replace(HALF, areas=(moved,), marks=()), STABLE) == [f"an edge at ({x}, {y})"]


def test_a_corner_inside_of_the_window_lies_on_a_curve() -> None:
    """A notch whose edges are parallel to the axes."""
    notch = at(0, 500), at(50, 500), at(50, 400), at(0, 400)
    found = told(replace(HALF, areas=((*RIGHT, *notch),), marks=()), STABLE)
    assert found == ["an edge at (50, 500)", "an edge at (50, 400)"]


def test_the_middle_of_every_edge_is_asked_for() -> None:
    """Those of a parabola cut short: the second edge lies too far off, beside the first, which does not."""
    high, c = ((Fraction(-500), Fraction(500)), (Fraction(0), Fraction(1000))), 190
    places = [at(Fraction(c * k * k, 9), Fraction(1000 * k, 3)) for k in range(4)]
    bent = Curve(tuple(places), said(h1 * 10**6, c * h2**2))
    area = (*places[:2], places[3], at(500, 1000), at(500, 0))
    drawn = RegionPicture(AXES, high, (area,), (bent,))
    found = told(drawn, s + h1 - h2**2 * Fraction(c, 10**6))
    assert [text for text in found if "edge" in text] == ["an edge at (950/9, 2000/3)"]


def test_the_middle_of_an_edge_may_lie_farther_off() -> None:
    """h1 = c (h2 / 1000)² from (0, 0) to (c, 1000): the middle of the edge lies c / 4 beside the curve."""
    high = ((Fraction(-500), Fraction(500)), (Fraction(0), Fraction(1000)))
    for c, expected in ((80, []), (81, ["an edge at (81/2, 500)"])):
        bent = Curve((at(0, 0), at(Fraction(c, 9), "1000/3"), at(c, 1000)), said(h1 * 10**6, c * h2**2))
        area = (at(0, 0), at(500, 0), at(500, 1000), at(c, 1000))
        drawn = RegionPicture(AXES, high, (area,), (bent,))
        assert told(drawn, s + h1 - h2**2 * Fraction(c, 10**6)) == expected


def test_every_edge_of_every_area_is_on_some_curve() -> None:
    second = Curve((at(100, 500), at(400, 500)), said(h2, 500))
    assert told(replace(HALF, areas=((*RIGHT, at(2, 0)),), curves=(WALL, second)), STABLE) == []
    assert told(replace(HALF, areas=((*RIGHT[:3], at(2, 1000)),), curves=(second, WALL), marks=()), STABLE) == []
    sloping = at(2, 1000), at(0, -1000), at(500, -1000), at(400, 1000)
    assert "an edge at (450, 0)" in told(replace(HALF, areas=(sloping,), marks=()), STABLE)
    below, above = (*RIGHT[:2], at(500, 0), at(0, 0)), (at(0, 0), at(500, 0), *RIGHT[2:])
    for areas in ((below, (*above, at(3, 500))), ((*above, at(3, 500)), below)):
        assert "an edge at (3, 500)" in told(replace(HALF, areas=areas, marks=()), STABLE)


def test_what_is_shaded_is_stable_and_what_is_stable_is_shaded() -> None:
    whole = (at(-500, -1000), at(500, -1000), at(500, 1000), at(-500, 1000))
    found = told(replace(HALF, areas=(whole,), marks=()), STABLE)
    assert found[0] == "(-400, -46500/97) is stable"
    assert len(found) == 6 + 28  # of nine places inside, and of all over the window
    assert all(fault.endswith(" is stable") for fault in found)
    bare = told(replace(HALF, areas=(), marks=()), STABLE)
    assert bare
    assert all(fault.endswith("is not stable") for fault in bare)
    assert told(replace(HALF, areas=(), marks=(), curves=()), s - 1) == []
    halves = ((at(0, -1000), at(500, -1000), at(500, 0), at(0, 0)), (at(0, 0), at(500, 0), at(500, 1000), at(0, 1000)))
    assert told(replace(HALF, areas=halves), STABLE) == []
    assert told(replace(HALF, areas=halves[:1]), STABLE)[0] == "(100, 3) is stable"


def test_a_mark_speaks_of_its_place_and_of_the_shade_there() -> None:
    whole = (at(-500, -1000), at(500, -1000), at(500, 1000), at(-500, 1000))
    for kind in ("stable", "unstable"):
        marks = (MarkedPoint(at(-100, 3), kind),)
        assert f"(-100, 3) is {kind}" in told(replace(HALF, areas=(whole,), marks=marks), STABLE)


def test_what_is_too_narrow_to_be_seen_is_not_asked_for() -> None:
    for width, is_seen in ((4, False), (5, True)):
        strip = at(-100, -1000), at(width - 100, -1000), at(width - 100, 1000), at(-100, 1000)
        found = told(replace(HALF, areas=(RIGHT, strip), marks=()), STABLE)
        assert len(found) == 9 * is_seen


def test_a_place_that_is_taken_out_is_not_asked_for() -> None:
    """Where the samples of an area meet a hole, which is marked."""
    height = Fraction(-1000) + 2000 * (Fraction(2, 4) + Fraction(1, 97))
    hole = at(0, height)
    chi = s + h1**2 + (h2 - Scalar.of(height)) ** 2
    whole = (at(-500, -1000), at(500, -1000), at(500, 1000), at(-500, 1000))
    picture = RegionPicture(AXES, WINDOW, (whole,), (), (MarkedPoint(hole, "excluded"),))
    assert told(picture, chi) == []
    assert told(replace(picture, marks=()), chi) == [f"({hole[0]}, {hole[1]}) is stable"]
    assert told(replace(picture, marks=(MarkedPoint(hole, "unstable"),)), chi)[0].endswith("is stable")


def test_a_hole_that_is_drawn_roughly_is_seen_from_around() -> None:
    """(h1 − x)² + (h2 − y)²/4 is at the place a 16th of what it is 2 to the sides and 4 up and down, or less."""
    whole = (at(-500, -1000), at(500, -1000), at(500, 1000), at(-500, 1000))
    picture = RegionPicture(AXES, WINDOW, (whole,), (), (MarkedPoint(at(0, 0), "excluded"),))
    for off in ("0.4", "-0.4", "0.41", "-0.41"):
        for x, y in ((Fraction(off), Fraction(0)), (Fraction(0), 2 * Fraction(off))):
            chi = s + (h1 - Scalar.of(x)) ** 2 + (h2 - Scalar.of(y)) ** 2 / 4
            assert (told(picture, chi) == []) is off.endswith("4"), (x, y)


# -- lines ------------------------------------------------------------------------------------------------------------------

LINE = (Fraction(-500), Fraction(500))


def end(place: Any, label: Any = None) -> End:
    return End(Fraction(place), Scalar.of(Fraction(place)) if label is None else label)


def on_line(*pieces: Any, chi: Scalar = s + k, window: Any = LINE, **more: Any) -> list[str]:
    return told(LinePicture("k", window, pieces, **more), chi)


def test_an_end_lies_where_stability_ends() -> None:
    assert on_line((end(0), None)) == on_line((None, end(0)), chi=s - k) == []
    assert on_line((end(1), None)) == on_line((end(2), None)) == on_line((end(-1), None)) == []
    assert on_line((end("2.01"), None)) == ["201/100 is an end"]
    assert on_line((end("-2"), None)) == ["-2 is an end"]
    assert on_line((end("-1.99"), None)) == []
    assert on_line((None, end("-2.01")), chi=s - k) == ["-201/100 is an end"]
    assert on_line((None, end(2)), chi=s - k) == ["2 is an end"]
    assert on_line((None, end("1.99")), chi=s - k) == []


def test_a_piece_that_is_short_is_asked_for_within() -> None:
    """Stable between 0 and 3, where 2 is near: a third of it is asked for."""
    chi = s + k * (3 - k)
    assert on_line((end(0), end(3)), chi=chi) == []
    assert on_line((end(0), end("2.9")), chi=chi) == []


def test_an_end_has_an_outer_side() -> None:
    assert on_line((end(1), end(4)), chi=s + k * (4 - k)) == []
    assert on_line((end(5), end(5)), chi=s + k - 4).count("5 is an end") == 2


def test_every_piece_and_every_mark_is_looked_at() -> None:
    assert on_line((None, end(0)), (end(100), None), chi=s - k)[0] == "150 is stable"
    marks = ((Fraction(100), "stable"), (Fraction(-100), "stable"), (Fraction(50), "unstable"))
    assert on_line((end(0), None), marks=marks) == ["-100 is stable", "50 is unstable"]


def test_what_cannot_be_seen_between_pieces_is_not_asked_for() -> None:
    wide = (Fraction(-1000), Fraction(1000))
    for width, is_seen in ((8, False), (9, True)):
        found = on_line((None, end(0)), (end(width), None), chi=s + 1, window=wide)
        assert any(fault.endswith("is not stable") for fault in found) is is_seen


def test_pieces_follow_one_another() -> None:
    chi = s + k**2 * (k - 100) ** 2
    assert on_line((None, end(0)), (end(0), end(100)), (end(100), None), chi=chi) == []
    assert on_line((end(0), end(100)), (None, end(0)), (end(100), None), chi=chi)[0] == "the pieces follow one another"
    for window in ((Fraction(1), Fraction(1)), (Fraction(1), Fraction(0))):
        assert on_line(window=window) == ["the window is empty"]


def test_marks_on_a_line() -> None:
    chi = s + k**2
    pieces = (None, end(0)), (end(0), None)
    for place, kind, expected in (
        (100, "stable", True),
        (0, "stable", False),
        (0, "unstable", True),
        (100, "unstable", False),
        (0, "excluded", True),
        ("0.4", "excluded", True),
        ("0.41", "excluded", False),
        ("-0.4", "excluded", True),
        ("-0.41", "excluded", False),
        (100, "other", False),
    ):
        found = on_line(*pieces, chi=chi, marks=((Fraction(place), kind),))
        assert found == ([] if expected else [f"{Fraction(place)} is {kind}"]), (place, kind)


def test_a_point_that_is_taken_out_is_an_end_of_both_sides() -> None:
    for off, is_end in (("0.4", True), ("0.41", False), ("-0.4", True), ("-0.41", False)):
        chi = s + (k - Scalar.of(Fraction(off))) ** 2
        found = on_line((None, end(0)), (end(0), None), chi=chi)
        assert found == ([] if is_end else ["0 is an end"] * 2), off


def test_what_is_written_at_an_end_is_its_place() -> None:
    for label, is_so in (
        ("2", True),
        ("-2", True),
        ("−2", True),
        ("≈ 1.999…", True),
        ("2.01", False),
        ("-2.01", False),
        ("", False),
        ("'2", False),
        (Scalar.of(2), True),
        (Scalar.of(-3), False),
        (square_root(Scalar.of(3)), True),
        (-square_root(Scalar.of(3)), True),
        (square_root(Scalar.of(5)), False),
        (-square_root(Scalar.of(5)), False),
        (Scalar.symbol("b"), True),
        (Scalar.symbol("b") * 3, False),
    ):
        numbers = {"b": Scalar.of(1)}
        assert plot_check._is_labelled(End(Fraction(0), label), Fraction(2), numbers) is is_so, label
        found = on_line((End(Fraction(0), label), None), drawn_for=tuple(numbers.items()))
        assert found == ([] if is_so else [f"{label} = 0"]), label


def test_a_place_is_stable_or_not() -> None:
    test = asked(h2 * s**2 + (h1 + 1) * s + h2, "h1", "h2", h1="positive")
    for place, expected in (((1, 1), True), ((1, -1), False), ((1, 0), False), (("-1/2", 1), False), ((0, 1), False)):
        assert test.is_stable(*at(*place)) is expected
    assert asked(s + 1 / h1, "h1").is_stable(Fraction(0)) is False
    assert asked(s + 1 / h1, "h1").is_stable(Fraction(1)) is True
    for value, expected in (("1/2", True), ("-1/2", True), (1, False), (-2, False)):
        assert asked(z + h1, "h1", discrete=True).is_stable(Fraction(value)) is expected
    assert len({asked(s + h1, "h1"), asked(h1 + s, "h1"), asked(s + h1, "h1", h1="positive")}) == 2  # plain values
    dropped = asked(h2 * s**2 + s + 1, "h2")
    assert dropped.is_stable(Fraction(1)) is True
    assert dropped.is_stable(Fraction(0)) is False  # a root has gone to infinity
