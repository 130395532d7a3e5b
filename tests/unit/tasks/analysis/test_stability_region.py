"""Stability regions: odd questions and their answers by hand, what is refused, what a list may not leave out."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.exact import Scalar
from symobs.formula.figures import LinePicture, PoleMap
from symobs.ground.errors import CertificateRejected, InputError
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary
from symobs.stability.regions.region import LineRegion, PlaneRegion, RegionInequality, plane_region, short_list
from symobs.stability.regions.region_check import is_region
from tests.kit import scalar, tabled, text_of

if TYPE_CHECKING:
    from collections.abc import Mapping

s, h1, h2 = (Scalar.symbol(name) for name in ("s", "h1", "h2"))


def region(text: Any, **keywords: Any) -> Any:
    """Ask, and let every face speak."""
    result = symobs.stability_region(text, **keywords)
    json.loads(result.to_json())
    assert result.to("text")
    return result


#: Questions with the exact answers, worked by hand: polynomial, signs, verdict, stable_if.


@tabled
def test_answers_worked_by_hand(text: str, signs: Mapping[str, str], verdict: str, inequalities: list[str]) -> None:
    found = region(text, symbols=signs or None)
    assert (found.verdict, list(found.stable_if)) == (verdict, inequalities)


@tabled
def test_the_picture_of_a_region_with_narrow_corners_is_on_its_page(text: str) -> None:
    """A picture that is not faithful is left out with a warning, which is an error here."""
    found = region(text, symbols=dict.fromkeys(["h1", "h2"], "real"))
    assert found.verdict == "conditional"
    assert "<figure>" in found.to("html")


def quadratic() -> PlaneRegion:
    """Return h1 > 0, h2 > 0."""
    return plane_region(CriticalPolynomials(s**2 + h1 * s + h2, StabilityBoundary("s")), ("h1", "h2"))


@tabled
def test_a_list_cannot_cut_a_curve_or_a_point_out_of_a_region(polynomial: str, operator: str) -> None:
    more = RegionInequality(scalar(polynomial), operator)
    found = quadratic()
    bounds = short_list(found)
    assert is_region(found, bounds)
    assert not is_region(found, (*bounds, more))
    result = symobs.stability_region("s^2 + h1 s + h2")
    with pytest.raises(CertificateRejected):
        replace(result, answer={**result.answer, "bounds": (*result.answer["bounds"], more)})


def test_a_list_cannot_leave_a_condition_out_nor_an_empty_region_be_called_so() -> None:
    found = quadratic()
    for bound in short_list(found):
        assert not is_region(found, (bound,))
    assert not is_region(found, None)
    assert not is_region(found, ())


@tabled
def test_questions_that_do_not_fit_are_refused_at_their_place(keywords: Mapping[str, Any], place: str) -> None:
    with pytest.raises(InputError) as refused:
        symobs.stability_region("s^2 + h1 s + h2", **keywords)
    assert refused.value.where == f"specification.{place}"
    assert refused.value.repair


def test_the_sign_of_a_coefficient_makes_cases() -> None:
    found = region("s^2 + 2 s + 1 + a h", parameters=["h"], symbols={"a": "real"})
    assert [(str(case.when[0]), list(case.result.stable_if)) for case in found.cases] == [
        ("a > 0", ["h > -1/a"]),
        ("a < 0", ["h < -1/a"]),
        ("Eq(a, 0)", []),
    ]


@tabled
def test_a_moved_boundary_is_told_where_nothing_is_open(dt: Any, limit: Any, said: str) -> None:
    plant = symobs.StateSpace("[0 1; -1/8 1/2]" if dt else "[0 1; -2 -3]", dt=dt)
    found = symobs.stability_region(plant, **limit)
    assert found.verdict == "yes"
    assert said in text_of(found)


@tabled
@pytest.mark.parametrize("parameters", [["h"], ["h", "k"]])
def test_the_sign_of_a_parameter_outside_of_the_polynomial_empties_nothing(sign: str, parameters: list[str]) -> None:
    signs = dict.fromkeys(parameters, "real") | {"h": sign}
    assert region("s + 1", parameters=parameters, symbols=signs).verdict == "yes"
    assert region("s - 1", parameters=parameters, symbols=signs).verdict == "no"
    found = region("s^2 + k s + 1", parameters=["h", "k"], symbols=signs | {"k": "real"})
    assert (found.verdict, list(found.stable_if)) == ("conditional", ["k > 0"])
    assert all(point["h"] != "0" for point in found.sample_points)


def test_a_region_whose_cells_hold_allowed_and_forbidden_values_is_none() -> None:
    critical = CriticalPolynomials(Scalar.symbol("s") + 1, StabilityBoundary("s"), {"h": "positive"})
    blind = LineRegion(critical, "h")
    assert blind.empty
    assert not is_region(blind, None)
    assert is_region(LineRegion(replace(critical, asked=("h",)), "h"), ())


#: Regions with turning branches, crossings, holes, slivers, vertical lines and several pieces.


@tabled
def test_pieces_bounds_and_holes_do_not_depend_on_which_parameter_is_across(polynomial: str) -> None:
    critical = CriticalPolynomials(scalar(polynomial), StabilityBoundary("s"))
    one, other = (PlaneRegion(critical, names) for names in (("h1", "h2"), ("h2", "h1")))
    assert sorted(c.bounded for c in one.components) == sorted(c.bounded for c in other.components)
    assert len(one.holes) == len(other.holes)
    assert set(one.surrounded()) == set(other.surrounded())
    bounds = None if one.empty else short_list(one)
    assert is_region(one, bounds)
    assert is_region(other, bounds)


@pytest.mark.parametrize(
    ("text", "sign", "kind"),
    [
        ("s^2 + (2 - a) s + 1/a", "positive", LinePicture),  # at a = 0, where the window begins, there is no polynomial
        ("s^2 + (2 - a) s + 1/a", "real", LinePicture),
        ("s^2 + (2 - a) s + 1/(a^2 + 1)", "real", PoleMap),
    ],
)
def test_roots_are_not_drawn_where_a_denominator_vanishes(text: str, sign: str, kind: type) -> None:
    result = region(text, parameters=["a"], symbols={"a": sign})
    assert type(result.picture) is kind
    assert result.critical.is_stable({"a": Fraction(1)})  # s² + s + 1
    assert not result.critical.is_stable({"a": Fraction(3)})  # s² − s + 1/3


def test_a_case_in_which_inequalities_contradict_each_other_is_told_to_be_empty() -> None:
    plant = symobs.StateSpace("[a 0 a; a 1/2 -1; -1 -b 1/10]", symbols={"a": "real", "b": "nonzero"})
    page = text_of(symobs.stability_region(plant))
    assert "Case b > 0. The stability region is empty. Case b < 0. All roots are stable if and only if" in page

    def is_stable(
        a: Fraction, b: Fraction
    ) -> bool:  # Routh's criterion of order three for s³ + p s² + q s + r, by hand
        p, q, r = (
            -a - Fraction(3, 5),
            Fraction(8, 5) * a - b + Fraction(1, 20),
            a * a * b + a * b - Fraction(11, 20) * a,
        )
        return p > 0 and r > 0 and p * q > r

    values = [Fraction(k, 7) for k in range(-100, 101, 9)]
    assert not any(is_stable(a, b) for a in values for b in values if b > 0)
    assert is_stable(Fraction(-1), Fraction(-10000))


def test_an_interval_that_begins_at_the_declared_sign_is_printed() -> None:
    """By Routh's criterion 3 − 2a, a² − 6a + 3/10 and their product less 3a² − 3a/10 + 3/100 are positive."""
    plant = symobs.StateSpace("[a 0.1 0; -3 -3 0.1; -3 0 a]", symbols={"a": "positive"})
    found = symobs.stability_region(plant)
    assert "0 < a < " in found.to("text")
    for a, stable in ((Fraction(1, 25), True), (Fraction(1, 20), False), (Fraction(6), False)):
        p, q, r = 3 - 2 * a, a * a - 6 * a + Fraction(3, 10), 3 * a * a - Fraction(3, 10) * a + Fraction(3, 100)
        assert (p > 0 and q > 0 and r > 0 and p * q > r) is stable
        assert (found.at(a=a).verdict == "yes") is stable


def test_a_parameter_in_the_numerator_alone_says_how_the_loop_is_asked_for() -> None:
    found = symobs.stability_region(symobs.StateSpace.from_transfer_function("K/(s*(s+1)*(s+2))"), parameters="K")
    page = text_of(found)
    assert "The loop with unity feedback is asked for by polynomial = s**3 + 3*s**2 + 2*s + K." in page
    assert symobs.stability_region("s**3 + 3*s**2 + 2*s + K", parameters="K").stable_if == ["K > 0", "K < 6"]
