"""What the campaign of random problems found wrong, each with its cause."""

from __future__ import annotations

import json
from typing import Any

import pytest

from symobs.pages.formats.json import result_object
from symobs.problem import read
from tests.kit import tabled

pytestmark = pytest.mark.slow


def solved(text: str) -> Any:
    (result,) = read(text).solve()
    return result


def answered(text: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(json.dumps(result_object(solved(text))))
    return found


def test_a_conditional_case_says_under_which_conditions() -> None:
    # The hidden mode −4/b of the stratum lies in the unit disc for some b only, and the case did not say for which.
    found = answered("""
        task = "stabilizability"
        [symbols]
        a = "positive"
        b = "nonnegative"
        [plant]
        A = "[0 -1; -2 -a]"
        B = "[-2; b]"
        dt = true
    """)
    (case,) = found["cases"]
    assert case["verdict"] == "conditional"
    assert case["conditions"]
    assert len(case["conditions"]) == len(case["condition_kinds"])


def test_equations_that_are_too_long_leave_a_stratum_undecided() -> None:
    # An internal limit came out as an exception.
    found = answered("""
        task = "detectability"
        [symbols]
        a = "negative"
        b = "real"
        c = "nonnegative"
        [plant]
        A = "[-2 -2 2; 2 a/c 0; 3/2 2 -3]"
        C = "[1-a -3 a*b]"
    """)
    assert found["verdict"] == "undecided"


@tabled
def test_a_root_at_1_for_all_parameters_leaves_no_region(polynomial: str) -> None:
    # The map from the disc to the half-plane carries 1 to infinity: the table began with a zero, which raised.
    result = solved(f"""
        task = "stability_region"
        [symbols]
        h = "real"
        [plant]
        dt = true
        [specification]
        polynomial = "{polynomial}"
    """)
    assert result.verdict == "no"
    assert [str(bound) for bound in result.stable_if] == ["False"]
    assert "For no values of the parameters do all roots lie in the open unit disc" in " ".join(
        result.to("text").split()
    )


def test_a_constant_compensator_is_stable() -> None:
    # Parity of poles beyond a zero was asked of a plant that passes its input on, where it proves nothing.
    found = answered("""
        task = "compensator"
        [plant]
        A = "[0 1; 1 3]"
        B = "[2; -1]"
        C = "[1 3]"
        D = "[-1]"
        [specification]
        control_polynomial = "s^2 + 5 s + 7"
        observer_poles = "-3"
        observer = "minimal"
    """)
    assert (found["F"], found["F_stable"]) == ("8/7", "yes")
