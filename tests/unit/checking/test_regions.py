"""Regions: any form of the right one is right, and a wrong one comes with a point that parts both."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from symobs.checking import Checked

# s^3 + 4 s^2 + h1 s + h2 is stable if and only if h2 > 0 and 4 h1 > h2 (Routh).
CUBIC = 'task = "stability_region"\n[specification]\npolynomial = "s^3 + 4 s^2 + h1 s + h2"\nparameters = "h1, h2"\n'
CHECKED = Checked.of(CUBIC)
# s^3 + 4 s^2 + h s + 6: h > 3/2.
LINE = Checked.of(
    'task = "stability_region"\n[specification]\npolynomial = "s^3 + 4 s^2 + h s + 6"\nparameters = "h"\n'
)
# s^3 + a s^2 + h s + k with a > 0: k > 0 and a h > k.
SYMBOLIC = Checked.of(
    'task = "stability_region"\n[symbols]\na = "positive"\n[specification]\n'
    'polynomial = "s^3 + a s^2 + h s + k"\nparameters = "h, k"\n'
)

EQUAL: list[Any] = [
    "h2 > 0 and 4 h1 > h2",
    "8 h1 > 2 h2 and 3 h2 > 0",
    "0 < h2 < 4 h1",
    ["h2 > 0", "4*h1 - h2 > 0"],
    "h1/h2 > 1/4 and h2 > 0",
    "h2 > 0 and 4 h1 > h2 and h1 > 0",
    "h2 > 0 and 4 h1 > h2 and h1 > -5",
    "h2^3 > 0, h1 > 0.25 h2",
    "h2 (4 h1 - h2) > 0 and h2 > 0",
    "(-h2 < 0 and h2 - 4 h1 < 0)",
    [["h2 > 0", "4 h1 > h2", "h1 < 1"], ["h2 > 0", "4 h1 > h2", "h1 >= 1"]],
    "0 < h2 < 4 h1 or h2 > 0 and 4 h1 > h2 and h1 > 7",
]
WRONG: list[tuple[Any, str | None]] = [
    ("h2 > 0", "condition_missing"),
    ("4 h1 > h2", "condition_missing"),
    ("h1 > 0 and h2 > 0", "only_positive_coefficients"),
    ("h2 > 0 and 4 h1 < h2", "half_plane"),
    ("h2 > 0 and 4 h1 > h2 and h1 > 1", None),
    ("0 < h2 < 4 h1 or h1 > 100", None),
    ("h2 > 0 and 3 h1 > h2", None),
    ("False", None),
]
BOUNDARY: list[Any] = [
    "h2 >= 0 and 4 h1 > h2",
    "h2 > 0 and 4 h1 >= h2",
    "h2 > 0 and 4 h1 > h2 and h1 != 3",
    [["h2 > 0", "4 h1 > h2", "h1 < 1"], ["h2 > 0", "4 h1 > h2", "h1 > 1"]],
]


def part(checked: Checked, conditions: Any) -> Any:
    return checked.report({"stable_if": conditions}).parts[0]


@pytest.mark.parametrize("conditions", EQUAL, ids=str)
def test_every_form_of_the_region_is_right(conditions: Any) -> None:
    assert part(CHECKED, conditions).verdict == "right"


@pytest.mark.parametrize(("conditions", "slip"), WRONG, ids=str)
def test_a_wrong_region_comes_with_a_point_that_parts_both(conditions: Any, slip: str | None) -> None:
    found = part(CHECKED, conditions)
    assert (found.verdict, found.slip) == ("wrong", slip)
    h1, h2 = (Fraction(found.place[name]) for name in ("h1", "h2"))
    stable = h2 > 0 and 4 * h1 > h2
    given = {
        "h2 > 0": h2 > 0,
        "4 h1 > h2": 4 * h1 > h2,
        "h1 > 0 and h2 > 0": h1 > 0 and h2 > 0,
        "h2 > 0 and 4 h1 < h2": h2 > 0 and 4 * h1 < h2,
        "h2 > 0 and 4 h1 > h2 and h1 > 1": stable and h1 > 1,
        "0 < h2 < 4 h1 or h1 > 100": stable or h1 > 100,
        "h2 > 0 and 3 h1 > h2": h2 > 0 and 3 * h1 > h2,
        "False": False,
    }[conditions]
    assert stable is not given
    assert ("your conditions hold" in found.reason) is given


@pytest.mark.parametrize("conditions", BOUNDARY, ids=str)
def test_a_boundary_is_told_apart(conditions: Any) -> None:
    found = part(CHECKED, conditions)
    assert (found.verdict, found.slip, found.credit) == ("wrong", "boundary", Fraction(3, 4))


def test_a_margin_that_was_forgotten() -> None:
    checked = Checked.of(f'{CUBIC}margin = "1/2"\n')
    assert part(checked, "h2 > 0 and 4 h1 > h2").slip == "margin_forgotten"


@pytest.mark.parametrize(
    ("dt", "conditions", "reason"),
    [
        # s² + a s + b: a > 0 and b > 0 by Hurwitz; |b| < 1 and |a| < 1 + b by Jury
        ("false", "b < 1 and 1 + a + b > 0 and 1 - a + b > 0", "these are the conditions for all |z| < 1"),
        ("true", "a > 0 and b > 0", "these are the conditions for all real parts < 0"),
    ],
)
def test_the_other_kind_of_time(dt: str, conditions: str, reason: str) -> None:
    checked = Checked.of(
        f'task = "stability_region"\n[plant]\ndt = {dt}\n[specification]\npolynomial = "{"z" if dt == "true" else "s"}^2 + '
        f'a {"z" if dt == "true" else "s"} + b"\nparameters = "a, b"\n'
    )
    found = part(checked, conditions)
    assert (found.slip, found.reason.partition(",")[0]) == ("discrete", reason)


@pytest.mark.parametrize(
    ("conditions", "verdict", "slip"),
    [
        ("h > 3/2", "right", None),
        ("h > 1.5", "right", None),
        ("3/2 < h < 2 or h >= 2", "right", None),
        ("3/2 < h < 2 or h > 2", "wrong", "boundary"),
        ("h >= 3/2", "wrong", "boundary"),
        ("h > 0", "wrong", "only_positive_coefficients"),
        ("h^2 > 9/4 and h > 0", "right", None),
        ("h^2 > 2", "wrong", "condition_missing"),
        ("h > 2", "wrong", None),
    ],
)
def test_one_parameter(conditions: str, verdict: str, slip: str | None) -> None:
    found = part(LINE, conditions)
    assert (found.verdict, found.slip) == (verdict, slip)


@pytest.mark.parametrize(
    ("conditions", "verdict"),
    [
        ("a h > k and k > 0", "right"),
        ("a h - k > 0 and k > 0 and h > 0", "right"),
        ("h > 0 and k > 0", "wrong"),
        ("a h > k and k > 0 or k < -100", "undecided"),
    ],
)
def test_with_other_symbols_equality_is_proved_or_a_point_found(conditions: str, verdict: str) -> None:
    found = part(SYMBOLIC, conditions)
    assert found.verdict == verdict
    assert found.credit == {"right": 1, "wrong": 0, "undecided": None}[verdict]


@pytest.mark.parametrize("conditions", ["h1", "h1 = 3", "q > 1", ["h1 > 1 or h2 > 1", "h1 > 2"], 7, "h1 > 1 and"])
def test_what_is_no_condition_is_unreadable(conditions: Any) -> None:
    found = part(CHECKED, conditions)
    if conditions == "h1 > 1 and":
        assert found.verdict == "wrong"
    else:
        assert found.verdict == "unreadable"
        assert found.reason


# s^3 + h s + 1 lacks the term in s^2, and so is never stable; s^2 + s + h^2 + 1 always is; s^2 + a s + b where a, b > 0.
NEVER, ALWAYS, BOTH = (
    Checked.of(f'task = "stability_region"\n[specification]\npolynomial = "{polynomial}"\nparameters = "{names}"\n')
    for polynomial, names in (("s^3 + h s + 1", "h"), ("s^2 + s + h^2 + 1", "h"), ("s^2 + a s + b", "a, b"))
)
FAIL = "at {} your conditions fail, but all roots of {} are as asked for"
HOLD = "at {} your conditions hold, but {} has roots with real part >= 0"
LEFT_OUT = "the region is right, but yours leaves out a part of no width"
INCLUDED = "the region is right, but yours includes its boundary, where a root is not stable"
MISSING = "the condition {} is missing; "


@pytest.mark.parametrize(
    ("checked", "conditions", "verdict", "reason"),
    [
        (NEVER, "False", "right", ""),
        (NEVER, "h > 0 and h < 0", "right", ""),
        (NEVER, "True", "wrong", HOLD.format("h = 0", "s**3 + 1")),
        (NEVER, "h > 100", "wrong", HOLD.format("h = 101", "s**3 + 101*s + 1")),
        (NEVER, "none", "unreadable", '"none" is no condition; write for example "h1 > 3" or "3 < h1 < 8"'),
        (ALWAYS, "True", "right", ""),
        (ALWAYS, "h >= 0 or h < 0", "right", ""),
        (ALWAYS, "h > 0", "wrong", FAIL.format("h = -1", "s**2 + s + 2")),
        (ALWAYS, "h > -1", "wrong", FAIL.format("h = -2", "s**2 + s + 5")),
        (ALWAYS, "False", "wrong", FAIL.format("h = 0", "s**2 + s + 1")),
        (ALWAYS, "h != 0", "wrong", LEFT_OUT),
        (LINE, "h^2 > 2", "wrong", MISSING.format("h > 3/2") + HOLD.format("h = -2", "s**3 + 4*s**2 - 2*s + 6")),
        (LINE, "h >= 3/2", "wrong", INCLUDED),
        (LINE, "h > 3/2 and h != 5", "wrong", LEFT_OUT),
        (LINE, "sqrt(h) > 1", "undecided", "conditions with roots or functions are not compared"),
        (LINE, "q > 1", "unreadable", 'the name "q" is not declared'),
        (BOTH, "a^3 > 0 and b > 0", "right", ""),
        (BOTH, "b > 0", "wrong", MISSING.format("a > 0") + HOLD.format("a = -1, b = 1", "s**2 - s + 1")),
        (BOTH, "b > 0 and a > 0 and a != 1", "wrong", LEFT_OUT),
        (BOTH, "b > 0 and a >= 0", "wrong", INCLUDED),
        (BOTH, "b > 0 and a > 1", "wrong", FAIL.format("a = 1/2, b = 1", "s**2 + s/2 + 1")),
        (BOTH, "b > 0 and a > 0 and b > a^2", "wrong", FAIL.format("a = 1, b = 1/2", "s**2 + s + 1/2")),
        (BOTH, "b > 0 and a > 0 and a^2 > 2", "wrong", FAIL.format("a = 1, b = 1", "s**2 + s + 1")),
        (BOTH, "b > 0 and a > 0 and a^2 != 2", "undecided", "a boundary lies at an irrational value of one parameter"),
        (BOTH, "a b > 0", "wrong", None),
        (BOTH, "(a - 1)(a - 2) > 0 and a > 0 and b > 0", "wrong", FAIL.format("a = 3/2, b = 1", "s**2 + 3*s/2 + 1")),
    ],
    ids=lambda value: value.problem.title or "region" if isinstance(value, Checked) else str(value),
)
def test_where_a_region_differs_and_how(checked: Checked, conditions: str, verdict: str, reason: str | None) -> None:
    found = part(checked, conditions)
    assert found.verdict == verdict
    assert reason is None or found.reason.startswith(reason), found.reason
    assert bool(found.reason) is (verdict != "right")
