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


@tabled
def test_one_parameter(conditions: str, verdict: str, slip: str) -> None:
    found = part(LINE, conditions)
    assert (found.verdict, found.slip or "") == (verdict, slip)


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


@tabled
def test_where_a_region_differs_and_how(checked: str, conditions: str, verdict: str, reason: str) -> None:
    found = part(PROBLEMS[checked], conditions)
    assert found.verdict == verdict
    assert found.reason.startswith(reason), found.reason
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
# Stable where |h| > 1; the product of the roots is 1, so that in discrete time nothing is.
PIECES = region("s^2 + (h^2 - 1) s + 1", "h")
PROBLEMS = {name: value for name, value in vars().items() if isinstance(value, Checked)}


LAST = "a > 0 and c > 0 and a b > c"


@tabled
def test_the_slip_and_the_reason(checked: str, conditions: Any, verdict: str, reason: str) -> None:
    found = part(PROBLEMS[checked], conditions)
    told = verdict if verdict in {"right", "undecided", "unreadable"} else "wrong"
    assert (found.verdict, found.slip or "") == (told, verdict if verdict != told else "")
    assert found.reason.startswith(reason)
    assert bool(found.reason) is bool(reason)


def test_a_piece_of_a_region_is_no_false_line_and_not_the_region() -> None:
    """Stable are h < −1 and h > 1; h > 2 is less than a piece, h > 0 more."""
    for line, verdict, reason in (
        ("h > 1", "undecided", "some of the pieces of the region"),
        ("h < -1", "undecided", "some of the pieces of the region"),
        ("h > 2", "false", "a part of the region only"),
        ("h > 0", "false", ""),
        ("h > 1 or h < -1", "true", ""),
    ):
        (found,) = PIECES.report({"step": [{"relation": line}]}).lines
        assert (found.verdict, reason in found.reason, bool(found.reason)) == (verdict, True, bool(reason))
    assert "some of the pieces of the region" in part(PIECES, "h > 1").reason
    parted = region("s + h^2", "h", symbols='h = "nonzero"')  # stable but at h = 0, which is excluded
    (found,) = parted.report({"step": [{"relation": "h > 0"}]}).lines
    assert found.verdict == "undecided"
