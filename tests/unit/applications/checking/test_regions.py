"""Regions: any form of the right one is right, and a wrong one comes with a point that parts both."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from symobs.applications.checking import Checked
from tests.kit import tabled

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


def part(checked: Checked, conditions: Any) -> Any:
    return checked.report({"stable_if": conditions}).parts[0]


@tabled
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


@tabled
def test_a_boundary_is_told_apart(conditions: Any) -> None:
    found = part(CHECKED, conditions)
    assert (found.verdict, found.slip, found.credit) == ("wrong", "boundary", Fraction(3, 4))


def test_a_margin_that_was_forgotten() -> None:
    checked = Checked.of(f'{CUBIC}margin = "1/2"\n')
    assert part(checked, "h2 > 0 and 4 h1 > h2").slip == "margin_forgotten"


@tabled
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


@tabled
def test_with_other_symbols_equality_is_proved_or_a_point_found(conditions: str, verdict: str) -> None:
    found = part(SYMBOLIC, conditions)
    assert found.verdict == verdict
    assert found.credit == {"right": 1, "wrong": 0, "undecided": None}[verdict]


@tabled
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


def region(polynomial: str, parameters: str, more: str = "", symbols: str = "", plant: str = "") -> Checked:
    return Checked.of(
        f'task = "stability_region"\n[symbols]\n{symbols}\n[plant]\n{plant}\n[specification]\n'
        f'polynomial = "{polynomial}"\nparameters = "{parameters}"\n{more}\n'
    )


# s² + a s + b with all real parts below −1: (s − 1)² + a (s − 1) + b has a − 2 > 0 and 1 − a + b > 0.
MARGIN = region("s^2 + a s + b", "a, b", 'margin = "1"')
# z + a: |a| < 1; s + a with a declared; s³ + a s² + b s + c: a, c > 0 and a b > c (Routh); a s² + s has a root at 0.
DISCRETE = region("z + a", "a", plant="dt = true")
POSITIVE, NONZERO, REAL = (region("s + a", "a", symbols=symbols) for symbols in ('a = "positive"', 'a = "nonzero"', ""))
SHIFTED = region("s + a - 1", "a", symbols='a = "positive"')
THREE = region("s^3 + a s^2 + b s + c", "a, b, c")
NOWHERE = region("s^4 + a s^3 + b s + c", "a, b, c")


LAST = "a > 0 and c > 0 and a b > c"


@pytest.mark.parametrize(
    ("checked", "conditions", "verdict", "reason"),
    [
        (MARGIN, "a > 2 and b > a - 1", "right", ""),
        (
            MARGIN,
            "a > 0 and b > 0",
            "margin_forgotten",
            "these are the conditions without the margin 1; at a = 1, b = 1 your",
        ),
        (
            MARGIN,
            "a > 2 and b > a - 2",
            "condition_missing",
            "the condition a < b + 1 is missing; at a = 3, b = 3/2 your",
        ),
        (MARGIN, "a > 3 and b > a - 1", "", FAIL.format("a = 5/2, b = 2", "s**2 + 5*s/2 + 2")),
        (MARGIN, "b > a - 1 and a > 1", "condition_missing", "the condition a > 2 is missing"),
        (DISCRETE, "-1 < a < 1", "right", ""),
        (
            DISCRETE,
            "a > 0",
            "discrete",
            "these are the conditions for all real parts < 0, which is stability in the other kind of",
        ),
        (
            DISCRETE,
            "-1 < a",
            "condition_missing",
            "the condition a < 1 is missing; at a = 2 your conditions hold, but z + 2 has",
        ),
        (DISCRETE, "-1 < a < 3/2", "condition_missing", "the condition a < 1 is missing"),
        (DISCRETE, "-1/2 < a < 1", "", "at a = -2/3 your conditions fail, but all roots of z - 2/3 are as asked for"),
        (DISCRETE, "-1 < a < 1 or a > 3", "", "at a = 4 your conditions hold, but z + 4 has roots with |z| >= 1"),
        (POSITIVE, "a >= 0", "right", ""),  # 0 is excluded
        (POSITIVE, "a > 1", "", "at a = 1/2 your conditions fail, but all roots of s + 1/2 are as asked for"),
        (NONZERO, "a >= 0", "right", ""),
        (SHIFTED, "a >= 1", "boundary", INCLUDED),
        (REAL, "a >= 0", "boundary", INCLUDED),
        (
            REAL,
            "a < 0",
            "half_plane",
            "a < 0 is the wrong half; at a = -1 your conditions hold, but s - 1 has roots with real",
        ),
        (REAL, "a != 0", "condition_missing", "the condition a > 0 is missing"),
        (THREE, LAST, "right", ""),
        (THREE, "a > 0 and c > 0 and a b >= c", "undecided", ""),
        (
            THREE,
            "a > 0 and b > 0 and c > 0",
            "condition_missing",
            "the condition c < a*b is missing; at a = 1, b = 1, c = 2 your",
        ),
        (THREE, "a > 0 and c > 0 and a b < c", "half_plane", "a b < c is the wrong half; at a = 1"),
        (THREE, "a < 0 and c > 0 and a b > c", "half_plane", "a < 0 is the wrong half; at "),
        (THREE, "a > 0 and c < 0 and a b > c", "half_plane", "c < 0 is the wrong half; at "),
        (THREE, [["a > 0", "c > 0", "a b > c"], ["a > 0", "c > 0", "a b >= c", "b > 1"]], "undecided", ""),
        (
            THREE,
            "False",
            "",
            "at a = 2, b = 1, c = 1 your conditions fail, but all roots of s**3 + 2*s**2 + s + 1 are",
        ),
        (THREE, "d > 0 and a > 0 and c > 0 and a b > c", "unreadable", 'the name "d" is not declared'),
        (NOWHERE, "False", "right", ""),
        (
            NOWHERE,
            "a > 0 and b > 0",
            "",
            "at a = 1, b = 1, c = 1 your conditions hold, but s**4 + s**3 + s + 1 has roots",
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "region",
)
def test_the_slip_and_the_reason(checked: Checked, conditions: Any, verdict: str, reason: str) -> None:
    found = part(checked, conditions)
    told = verdict if verdict in {"right", "undecided", "unreadable"} else "wrong"
    assert (found.verdict, found.slip or "") == (told, verdict if verdict != told else "")
    assert found.reason.startswith(reason)
    assert bool(found.reason) is bool(reason)
