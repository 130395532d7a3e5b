"""Promises of the contract, held to problems that are no worked examples: what was once broken, each with its cause."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import sympy

from symobs.problem import read
from symobs.render.json import result_object
from tests.campaign.points import value


def answered(problem: dict[str, Any]) -> dict[str, Any]:
    (result,) = read(json.dumps(problem)).solve()
    found: dict[str, Any] = json.loads(json.dumps(result_object(result)))
    return found


def case(answer: dict[str, Any], *when: str) -> dict[str, Any]:
    (found,) = [one for one in answer["cases"] if one["when"] == list(when)]
    return dict(found)


def at(table: list[list[str]], **values: int) -> sympy.Matrix:
    point = {name: Fraction(number) for name, number in values.items()}
    return sympy.Matrix([[sympy.Rational(value(entry, point)) for entry in row] for row in table])


# -- no silent generic answer: what is true where the conditions of a case fail ------------------------------------


def test_a_chosen_gain_of_a_reduced_order_observer_says_where_another_serves() -> None:
    # At a = 1 a mode is hidden and the gain is one of many; this one divides by b + 1, and b = -1 was passed over.
    found = answered(
        {
            "task": "reduced_order_observer",
            "symbols": {"a": "positive", "b": "real", "p": "positive"},
            "plant": {
                "A": [["2", "-a", "-1"], ["0", "1", "a-1"], ["0", "0", "1"]],
                "B": [["0"], ["2"], ["a+b"]],
                "C": [["1", "a", "b"]],
            },
            "specification": {"poles": "a, -p"},
        }
    )
    hidden = case(found, "a - 1 == 0")
    assert hidden["conditions"] == ["b + 1 != 0"]
    there = case(hidden, "b + 1 == 0")
    assert there["verdict"] == "yes"
    p = 3
    A, C = sympy.Matrix([[2, -1, -1], [0, 1, 0], [0, 0, 1]]), sympy.Matrix([[1, 1, -1]])
    F, H, M = at(there["F"], p=p), at(there["H"], p=p), at(there["M"], p=p)
    P = M.inv()[1:, :]
    assert P * A - F * P == H * C
    s = sympy.Symbol("s")
    assert F.charpoly(s).as_expr().expand() == ((s - 1) * (s + p)).expand()


def test_a_hidden_pair_of_one_output_may_hide_more() -> None:
    # Where b = 1 the pair (A12, A22) loses a mode for every a; for a = 1 and a = 1/2 it loses another, which was not said.
    found = answered(
        {
            "task": "reduced_order_observer",
            "symbols": {"a": "real", "b": "nonzero", "p": "positive"},
            "plant": {
                "A": [["0", "a*b", "2"], ["0", "1-a", "b"], ["0", "0", "1"]],
                "C": [["0", "a-1", "1"]],
            },
            "specification": {"poles": "b-1, -p"},
        }
    )
    hidden = case(found, "b - 1 == 0")
    for a in (sympy.Integer(1), sympy.Rational(1, 2)):
        A = sympy.Matrix([[0, a, 2], [0, 1 - a, 1], [0, 0, 1]])
        C = sympy.Matrix([[0, a - 1, 1]])
        assert sympy.Matrix.vstack(C, C * A, C * A**2).rank() == 1
    assert case(hidden, "a - 1 == 0")["verdict"] == "no"
    assert case(hidden, "2*a - 1 == 0")["verdict"] == "no"


def test_the_feedforward_of_a_reference_says_where_its_denominator_vanishes() -> None:
    # The columns of B are (1, a) and (-2, -2): K_d divides by a - 1, and nothing was said of a = 1.
    found = answered(
        {
            "task": "tracking",
            "symbols": {"a": "nonnegative"},
            "plant": {"A": "[a 0; 2 a]", "B": "[1 -2; a -2]", "C": "[1 -1]"},
            "specification": {
                "control_poles": "-1, -3",
                "observer_poles": "-2",
                "reference_matrix": "[0 1; 1 0]",
            },
        }
    )
    there = case(found, "a - 1 == 0")
    B, wanted = sympy.Matrix([[1, -2], [1, -2]]), sympy.Matrix([[1, -1], [1, 1]])
    assert B.row_join(wanted).rank() > B.rank()
    assert (there["verdict"], there["solvable"], there["K_d"]) == ("no", False, None)


def test_a_law_that_cannot_be_solved_for_u_on_a_curve_is_no_compensator_there() -> None:
    # On the curve the case said "where the equation of the curve does not hold".
    found = answered(
        {
            "task": "compensator",
            "symbols": {"a": "real", "b": "real"},
            "plant": {"A": "[0 1; 0 0]", "B": "[0; 1]", "C": "[1 0]", "D": "[(a^2+b^2)/38]"},
            "specification": {"control_poles": "-2, -2", "observer_poles": "-3", "observer": "minimal"},
        }
    )
    # K = [4 4], L = 3: u = -4 (y - D u) - 4 (z + 3 (y - D u)) has the factor 1 - 16 D before u
    there = case(found, "8*a**2 + 8*b**2 - 19 == 0")
    assert (there["verdict"], there["F"]) == ("no", None)


# -- no traceback where a stratum is more than one curve or point --------------------------------------------------


def test_a_locus_of_several_points_does_not_end_the_search_for_ranks() -> None:
    # Columns and rows of a minor were found on different points of it.
    found = answered(
        {
            "task": "canonical_form",
            "symbols": {"a": "nonpositive", "b": "nonzero"},
            "plant": {
                "A": [["2", "-1", "a-1"], ["0", "-b", "2"], ["-1", "0", "1"]],
                "B": [["a"], ["a"], ["2"]],
                "C": [["1", "-1", "0"]],
            },
            "specification": {"kind": "controllable"},
        }
    )
    assert found["verdict"] == "conditional"
    assert {one["verdict"] for one in found["cases"]} <= {"no", "undecided"}


def test_a_stratum_whose_own_cases_cannot_be_claimed_is_undecided() -> None:
    # The claim about a case within a case was refused when the case was written, too late to leave it undecided.
    found = answered(
        {
            "task": "state_feedback",
            "symbols": {"a": "nonzero", "b": "positive", "p": "positive"},
            "plant": {"A": "[-1 0 2; 1 1 0; -1 2 -b]", "B": "[-a; 0; b]"},
            "specification": {"poles": "-2, -p, -b"},
        }
    )
    assert found["verdict"] == "conditional"
    deeper = [inner for one in found["cases"] for inner in one.get("cases", [])]
    assert "undecided" in {one["verdict"] for one in deeper}
