"""What pictures and diagrams may not show, one check at a time: each fails where one check is left out or weaker."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import exp
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import mpmath
import pytest

from symobs.exact import Matrix, Scalar
from symobs.formula.figures import MarkedPoint, PlottedResponse, PoleMap, RegionPicture, TimeResponse
from symobs.formula.tree import Environment, Letter, Literal, Product
from symobs.proof.derivation import plot_check as root_locus_check
from symobs.proof.derivation import plot_check as time_response_check
from symobs.proof.derivation.plot_check import faults, faults_of_poles, faults_of_response
from tests.kit import scalar, tabled
from tests.support.regions.drawn_by_hand import h1, h2, s

if TYPE_CHECKING:
    from symobs.formula.figures import Picture

CHI = Letter("chi")


def told(picture: Picture, chi: Scalar, *, discrete: bool = False, **signs: str) -> list[str]:
    """Return the faults that are found."""
    known = Environment(variable="z" if discrete else "s", values={"chi": chi}, signs=signs)
    return list(faults(picture, CHI, known, discrete=discrete))


def at(x: Any, y: Any) -> tuple[Fraction, Fraction]:
    return Fraction(x), Fraction(y)


b = Scalar.symbol("b")
HALF_PLANE = RegionPicture(("h1", "h2"), ((Fraction(1), Fraction(2)), (Fraction(1), Fraction(2))), (), ())

# -- regions ------------------------------------------------------------------------------------------------------------


@tabled
def test_numbers_that_are_drawn_for_are_allowed(sign: str, number: int, *, allowed: bool) -> None:
    shown = replace(HALF_PLANE, drawn_for=(("b", Scalar.of(number)),))
    assert told(shown, s - h1 - h2 + b - number, b=sign)[:1] == ([] if allowed else [f"b = {number}"])


def test_numbers_that_are_drawn_for_are_numbers() -> None:
    letters = replace(HALF_PLANE, drawn_for=(("b", h1),))
    assert told(letters, s - h1 - h2 + b, b="real")[0] == "b = h1"
    assert "alone" in told(HALF_PLANE, s - h1 - h2 - b)[0]


WHOLE = (at(-2, -2), at(2, -2), at(2, 2), at(-2, 2))
WINDOW = ((Fraction(-2), Fraction(2)), (Fraction(-2), Fraction(2)))


@tabled
def test_a_mark_says_what_is_so(kind: str, *, shaded: bool, expected: bool) -> None:
    picture = RegionPicture(
        ("h1", "h2"), WINDOW, (WHOLE,) if shaded else (), (), (MarkedPoint(at("1/3", "1/5"), kind),)
    )
    assert (f"(1/3, 1/5) is {kind}" not in told(picture, s + 1)) == expected
    unstable = replace(picture, areas=())
    assert (f"(1/3, 1/5) is {kind}" not in told(unstable, s - 1)) == (kind in {"unstable", "excluded"})


# -- poles --------------------------------------------------------------------------------------------------------------


@tabled
def test_poles_are_where_they_are(parts: dict[str, Any], polynomial: str, time: str, fault: str) -> None:
    """Of s + k, which has the pole −k: drawn at k = 0, 1, 2."""
    ways: dict[str, Any] = {"paths": [[[0, 0], [-1, 0], [-2, 0]]], "along": [[0, 1, 2]], "values": [0, 2]}
    ways |= {"window": [[-5, 5], [-5, 5]]} | parts
    paths = tuple(tuple(at(*place) for place in path) for path in ways["paths"])
    values, window, along = (numbers(ways[name]) for name in ("values", "window", "along"))
    drawn = PoleMap("s", "k", values, paths, window, along=along)
    variable = "z" if "z" in polynomial else "s"
    found = list(faults_of_poles(drawn, scalar(polynomial), variable, discrete=time == "discrete"))
    assert found[:1] == ([fault] if fault else [])


def numbers(value: Any) -> Any:
    return tuple(map(numbers, value)) if isinstance(value, list) else Fraction(value)


@tabled
def test_discs_that_hold_a_root_lie_apart(places: tuple[str, str], *, are_all: bool) -> None:
    """Of s² − 1: each disc has the square of its radius 4 |c₀/c₁|²."""
    drawn = SimpleNamespace(paths=[(at(x, 0),) for x in places], along=((Fraction(0),),) * 2, moved="k")
    assert root_locus_check._are_all(drawn, s**2 - 1, "s", 0) == are_all  # type: ignore[arg-type]


# -- responses ------------------------------------------------------------------------------------------------------------


DECAY = Environment(
    values={"A": Matrix.of([[0]]), "F": Matrix.of([[-1]])},
    signals={"x": None, "y": Product((Literal(Scalar.of(2)), Letter("x")))},
    sizes={"x": 1},
    dynamics={"x": Product((Letter("A"), Letter("x")))},
)
WIDE = ((Fraction(0), Fraction(2)), (Fraction(-1), Fraction(3)))


#: In what parts of one heights are counted.
PARTS = 600_000


def course(*values: Any, signal: str = "x", component: int = 0, row: tuple[int, ...] = (1,)) -> PlottedResponse:
    heights = [Fraction(value) * PARTS for value in values]
    assert all(height.denominator == 1 for height in heights)
    return PlottedResponse(signal, component, tuple(map(Fraction, row)), tuple(map(int, heights)))


def responses(*drawn: PlottedResponse, subject: str = "A", start: tuple[int, ...] = (1,), **more: Any) -> list[str]:
    response = TimeResponse(
        ("x",), (tuple(map(Fraction, start)),), drawn, more.get("window", WIDE), more.get("parts", PARTS)
    )
    return list(faults_of_response(response, Letter(subject), DECAY))


@tabled
def test_a_course_that_stays_is_drawn_so(drawn: list[dict[str, Any]], asked: dict[str, Any], faults: list[str]) -> None:
    """x′ = 0 keeps x, and y = 2 x."""
    ways = {name: numbers(value) if name == "window" else value for name, value in asked.items()}
    assert responses(*(course(*each.pop("values"), **each) for each in map(dict, drawn)), **ways) == faults


def test_all_components_of_a_start_that_is_not_along_one_are_drawn() -> None:
    assert responses(replace(course(1, 1, 1), heights=(1, 1, 1)), parts=1) == []
    with pytest.raises(ValueError, match="not all components of x"):
        responses(course(1, 1, 1, component=1))


def test_a_course_may_be_drawn_as_roughly_as_cannot_be_seen() -> None:
    """A 500th of the height at the points, a 100th between them."""
    for off, is_near in (("0.008", True), ("-0.00799", True), ("0.00801", False), ("-0.00801", False)):
        for index in range(3):
            values = [1 + Fraction(off) * (t == index) for t in range(3)]
            assert (responses(course(*values)) == []) == is_near
    high = (WIDE[0], (Fraction(-250), Fraction(250)))
    assert responses(course(1, 1, 2), window=high) == []
    for bend, is_near in ((8, True), (-8, True), (Fraction("8.05"), False), (-Fraction("8.05"), False)):
        places = [(bend * Fraction(t * t) / 2, Fraction(bend * t), Fraction(bend)) for t in range(3)]
        rows = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
        drawn = [course(*(p[j] for p in places), component=j + 1, row=rows[j]) for j in range(3)]
        window = (WIDE[0], (Fraction(-50), Fraction(50)))
        for order in ((0, 1, 2), (2, 0, 1)):
            response = TimeResponse(("x",), (places[0],), tuple(drawn[j] for j in order), window, PARTS)
            assert (list(faults_of_response(response, Letter("A"), PARABOLA)) == []) == is_near
            with pytest.raises(ValueError, match="not all components of x"):
                list(faults_of_response(replace(response, responses=tuple(drawn[:2])), Letter("A"), PARABOLA))


def test_every_segment_of_a_course_is_looked_at() -> None:
    """Of 7 t³/6 the second segment lies 21/16 off its middle, where 1 is allowed, and the first 7/16."""
    table = Matrix.of([[int(j == i + 1) for j in range(4)] for i in range(4)])
    known = replace(DECAY, values={"A": table}, sizes={"x": 4})
    values = [[Fraction(7 * t**3, 6), Fraction(7 * t * t, 2), Fraction(7 * t), Fraction(7)] for t in range(3)]
    for height, expected in ((100, ["the response of x"]), (132, [])):
        rows = [tuple(int(i == j) for i in range(4)) for j in range(4)]
        drawn = tuple(course(*(v[j] for v in values), component=j + 1, row=rows[j]) for j in range(4))
        window = (WIDE[0], (Fraction(-height, 2), Fraction(height, 2)))
        response = TimeResponse(("x",), (tuple(values[0]),), drawn, window, PARTS)
        assert list(faults_of_response(response, Letter("A"), known)) == expected


def followed(table: Matrix, start: tuple[int, ...], step: Fraction, count: int) -> list[tuple[Any, ...]]:
    """Return the states at so many instants; call it with many bits."""
    units = tuple(tuple(Fraction(int(i == j)) for j in range(len(start))) for i in range(len(start)))
    lines = time_response_check._followed(table, tuple(map(Fraction, start)), units, step, count)
    return [tuple(mpmath.mpf(int(part)) / 2**72 for part in state) for state in zip(*lines, strict=True)]


PARABOLA = replace(DECAY, values={"A": Matrix.of([[0, 1, 0], [0, 0, 1], [0, 0, 0]])}, sizes={"x": 3})


def test_rounding_is_not_seen_however_fast_a_course_grows() -> None:
    """e^{200 t} up to t = 2, which takes 578 bits, beside a constant."""
    table = Matrix.of([[0, 0], [0, 200]])
    with mpmath.workprec(1000):
        found = followed(table, (1, 1), Fraction(1, 10), 21)
        for k, (constant, growing) in enumerate(found):
            assert abs(constant - 1) <= 2**-64
            assert abs(growing - mpmath.exp(20 * k)) <= 2**-64


TURNING = Environment(
    variable="z",
    values={"A": Matrix.of([[2, 1], [0, -1]])},
    signals={"x": None, "y": Product((Literal(Matrix.of([[1, 3]])), Letter("x")))},
    sizes={"x": 2},
    dynamics={"x": Product((Letter("A"), Letter("x")))},
)


def samples(*drawn: PlottedResponse, end: int = 3, low: str = "-1", high: str = "11", count: int = 2) -> list[str]:
    """What is wrong with responses that begin at (1, 1): x₁ is 1, 3, 5, 11 and x₂ is 1, −1, 1, −1."""
    window = ((Fraction(0), Fraction(end)), (Fraction(low), Fraction(high)))
    start = (Fraction(1), Fraction(1))
    response = TimeResponse(("x",), (start,), drawn, window, count, discrete=True)
    return list(faults_of_response(response, Letter("A"), TURNING))


def sampled(*values: int, signal: str = "x", component: int = 0, row: tuple[int, ...] = (1, 0)) -> PlottedResponse:
    return PlottedResponse(signal, component, tuple(map(Fraction, row)), tuple(2 * value for value in values))


FIRST, SECOND = sampled(1, 3, 5, 11, component=1), sampled(1, -1, 1, -1, component=2, row=(0, 1))
OUTPUT = sampled(4, 0, 8, 8, signal="y", row=(1, 3))


def test_courses_of_discrete_time_are_met_exactly() -> None:
    assert samples(FIRST, SECOND) == samples(OUTPUT) == samples(FIRST, SECOND, OUTPUT) == []
    for place in range(4):
        for off in (1, -1):  # half of one is seen
            heights = [height + off * (k == place) for k, height in enumerate(OUTPUT.heights)]
            assert samples(replace(OUTPUT, heights=tuple(heights))) == ["the response of y"]
    assert samples(SECOND, FIRST, replace(OUTPUT, heights=(8, 0, 16, 17))) == ["the response of y"]
    assert samples(OUTPUT, SECOND, FIRST, low="-1/2") == ["x, which leaves the window,"]


@tabled
def test_a_window_of_discrete_time_is_filled(ways: dict[str, Any], faults: list[str]) -> None:
    assert samples(OUTPUT, **ways) == faults


def test_courses_are_of_the_time_of_their_plant() -> None:
    response = TimeResponse(("x",), ((Fraction(1),),), (course(1, 1, 1),), WIDE, PARTS)
    assert list(faults(response, Letter("A"), replace(DECAY, variable="z"), discrete=True)) == ["another time"]
    assert list(faults(response, Letter("A"), DECAY, discrete=False)) == []
    wrong = replace(response, responses=(course(1, 1, 2),))
    assert list(faults(wrong, Letter("A"), DECAY, discrete=False)) == ["the response of x"]


def test_a_course_too_long_to_compute_is_refused() -> None:
    """e^{6000} takes 8,656 bits."""
    with pytest.raises(ValueError, match="too much to compute"):
        followed(Matrix.of([[300]]), (1,), Fraction(1, 100), 2001)


def test_a_mode_that_turns_unseen_between_two_instants_is_refused() -> None:
    """The values of e^{-t} cos(ω t) at 0, 1/200, 2/200, … are those of e^{-t} where ω = 710/113 · 200, nearly 400 π."""
    spin = Fraction(710, 113) * 200
    for turning, expected in ((0, []), (spin, ["modes that do not turn unseen between two instants"])):
        table = Matrix.of([[-1, turning], [-turning, -1]])
        known = replace(DECAY, values={"A": table}, sizes={"x": 2})
        falling = tuple(round(PARTS * exp(-k / 100)) for k in range(101))
        drawn = [PlottedResponse("x", j + 1, row, tuple(h * (1 - j) for h in falling)) for j, row in enumerate(UNITS)]
        window = ((Fraction(0), Fraction(1)), (Fraction(-1), Fraction(2)))
        response = TimeResponse(("x",), ((Fraction(1), Fraction(0)),), tuple(drawn), window, PARTS)
        assert list(faults_of_response(response, Letter("A"), known)) == expected


UNITS = ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(1)))


def test_modes_are_slow_by_their_eigenvalues_and_not_by_the_entries() -> None:
    for radius, is_slow in (("2.6", True), ("3.1", False)):
        largest = Fraction(radius)
        for rows in ((largest, 1000, 0, -1), (-1, 0, 1000, -largest), (0, largest, -largest, 0)):
            table = Matrix.of([rows[:2], rows[2:]])
            assert time_response_check.is_slow(table, Fraction(1)) is is_slow
            assert time_response_check.is_slow(table * Scalar.of(1000), Fraction(1, 1000)) is is_slow


def test_numbers_in_a_field_with_letters_are_raised_to_powers_as_numbers() -> None:
    """What is left of a matrix when a letter cancels has no letters, and its 64th power none in its denominators."""
    a = Scalar.symbol("a")
    table = Matrix.of([[(a + 1) / (a**2 + a + 3), 0], [0, -1]]) @ Matrix.of([[(a**2 + a + 3) / (a + 1), 0], [0, -1]])
    assert table.field.names
    assert not table.names
    assert time_response_check.is_slow(table, Fraction(1))


def test_too_few_bits_are_not_taken_for_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """(M + I)² = 0 with entries of a thousand: e^{Mt} = e^{-t} (I + (M + I) t)."""
    shear = Matrix.of([[-1 + 1000, -1000], [1000, -1 - 1000]])
    for kept in ((72,), (72, 96)):
        monkeypatch.setattr(time_response_check, "_KEPT", kept)
        with pytest.raises(ValueError, match="too much to compute"):
            followed(shear, (1, 0), Fraction(1, 100), 601)
    monkeypatch.setattr(time_response_check, "_KEPT", (72, 256))
    with mpmath.workprec(300):
        found = followed(shear, (1, 0), Fraction(1, 100), 601)
        for k, state in enumerate(found):
            t = mpmath.mpf(k) / 100
            for part, factor in zip(state, (1 + 1000 * t, 1000 * t), strict=True):
                assert abs(part - mpmath.exp(-t) * factor) <= 2**-64


@tabled
def test_a_root_is_surely_near(coefficients: list[Any], within: Any, *, is_near: bool) -> None:
    """By |w|ᵏ ≤ C(n, k) |c₀/cₖ| for one root w."""
    shifted = [(Fraction(c), Fraction(0)) for c in coefficients]
    assert root_locus_check._has_root_near(shifted, Fraction(within)) is is_near
