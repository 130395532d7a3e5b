"""The audit, exactly: where an equation holds, what a decimal says, and which letter is meant."""

from __future__ import annotations

import contextlib
import math
import re
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from symobs.applications.audit import audit
from symobs.ground.errors import ProblemErrors
from symobs.problem import read
from tests.kit import tabled, tables
from tests.support.problems.printed import finding, findings, problem
from tests.support.tools.command_line import inside

# O = [c 0; 0 c], so det O = c^2.
CHAIN: dict[str, Any] = {"plant": {"A": "[0 1; 0 0]", "B": "[0; 1]", "C": "[c 0]"}, "symbols": {"c": "real"}}


# -- powers ------------------------------------------------------------------------------------------------------------


@tabled
def test_a_power_of_the_identity_is_right(relation: str) -> None:
    assert findings(relation) == []


@tabled
def test_a_power_of_the_identity_is_wrong(relation: str) -> None:
    assert len(findings(relation)) == 1


# -- where an equation holds -------------------------------------------------------------------------------------------


@tabled
def test_what_fails_at_some_values_is_said_to_hold_in_general_only(relation: str, where: str, reason: str) -> None:
    found = finding(relation, **CHAIN)
    assert (found.holds, found.right) == ("in general", f"{relation} where {where}")
    assert reason in found.reason
    assert findings(found.right, **CHAIN) == []


@tabled
def test_what_is_said_with_its_conditions_is_plainly_true(relation: str) -> None:
    assert findings(relation, **CHAIN) == []


def test_conditions_are_conditions_on_the_symbols() -> None:
    for condition, says in (
        ("c", "a condition is expected"),
        ("c = 0", "a condition is expected"),
        ("d != 0", '"d" is not declared'),
        ("", "a condition is expected"),
    ):
        with pytest.raises(ProblemErrors, match=says):
            findings(f"rank(O) = 2 where {condition}", **CHAIN)


@tabled
def test_the_root_of_a_square_is_not_negative(relation: str, where: str) -> None:
    found = finding(relation, **CHAIN)
    assert (found.holds, found.right) == ("", f"{relation} where {where}")
    assert findings(found.right, **CHAIN) == []
    positive = {**CHAIN, "symbols": {"c": "positive"}}
    assert len(findings(relation, **positive)) == (relation not in {"sqrt(c^2) = c", "sqrt(4 c^2) = 2 c"})


SIGNS: dict[str, Any] = {**CHAIN, "symbols": {"a": "real", "b": "real", "c": "real"}}
#: What is true where the conditions hold; what is true as well, though that is not seen.
TRUE_BY_SIGNS, UNDECIDED_BY_SIGNS = (tables(Path(__file__))[name] for name in ("true_by_signs", "undecided_by_signs"))


def is_true_where_it_says(relation: str) -> bool:
    """Whether an equation holds on a grid wherever its conditions do."""
    equation, _, conditions = relation.replace("^", "**").partition(" where ")
    equation = re.sub(r"(?<=[\w)]) (?=[\w(])", "*", equation)
    left, right = equation.split("=")
    places = ({"sqrt": math.sqrt, **dict(zip("abc", at, strict=True))} for at in product((-2, -1, 0, 1, 3), repeat=3))
    return all(
        math.isclose(eval(left, at), eval(right, at), abs_tol=1e-9)  # noqa: S307 - our own text
        for at in places
        if all(eval(each, at) for each in conditions.split(",") if each)  # noqa: S307
    )


_FACTORS = st.sampled_from(["a", "b", "c", "sqrt(a^2)", "sqrt(b^2)", "sqrt(c^2)", "sqrt(a^2*b^2)", "sqrt((a+b)^2)"])
_SIDE = st.lists(st.lists(_FACTORS, min_size=1, max_size=2).map("*".join), min_size=1, max_size=2).map(" + ".join)
_SIGNS = [f"{each} {sign} 0" for each in ("a", "b", "a*b", "b*c", "a*b*c", "-a*c") for sign in (">", ">=")]
_WHERE = st.lists(st.sampled_from(_SIGNS), max_size=2, unique=True)


@settings(max_examples=60)
@given(_SIDE, _SIDE, _WHERE)
@example("sqrt(c^2) + sqrt(a^2)*sqrt(b^2)", "c + a*b", ["a*b >= 0", "a*b*c >= 0"])
@example("sqrt(a^2)*sqrt(c^2) + sqrt(a^2*b^2)", "a*c + a*b", [])
@example("sqrt(a^2)*sqrt(b^2) + sqrt(b^2)*sqrt(c^2)", "a*b + b*c", [])
@example("sqrt(a^2) + sqrt(b^2)", "a + b", ["a*b >= 0"])
@example("(sqrt(a^2)-a)*(sqrt((sqrt(a^2)+b)^2) - (a-b))", "0", [])
def test_no_line_with_roots_of_squares_is_called_true_where_it_is_not(left: str, right: str, where: list[str]) -> None:
    conditions = f" where {', '.join(where)}" if where else ""
    relation = f"{left} = {right}{conditions}"
    with contextlib.suppress(ProblemErrors):  # or it is undecided
        found = findings(relation, **SIGNS)
        assert bool(found) is not is_true_where_it_says(relation)
        for told in (
            each.right for each in found if set(re.findall(r"\w+", each.right)) <= {*"abc012", "sqrt", "where"}
        ):
            assert not told or is_true_where_it_says(told if " where " in told else told + conditions)


@pytest.mark.parametrize("relation", TRUE_BY_SIGNS)
def test_signs_that_are_known_decide(relation: str) -> None:
    assert findings(relation, **SIGNS) == []


@pytest.mark.parametrize("relation", UNDECIDED_BY_SIGNS)
def test_signs_that_are_not_seen_leave_a_line_undecided(relation: str) -> None:
    with pytest.raises(ProblemErrors, match="signs"):
        findings(relation, **SIGNS)


@pytest.mark.parametrize(
    ("relation", "reason"),
    [
        ("sqrt(a^2) = 2 a", "whatever the signs"),
        ("sqrt(a^2 b^2) = a b where a b < 0", "whatever the signs"),
        ("sqrt(a^2 b^2) = a b", "true in general only where a*b >= 0"),
        ("sqrt(a^2) sqrt(b^2) + sqrt(b^2) sqrt(c^2) = a b + b c", "true where a >= 0 and b >= 0 and c >= 0"),
    ],
)
def test_signs_are_said_or_none_does(relation: str, reason: str) -> None:
    assert reason in finding(relation, **SIGNS).reason


def test_the_root_of_a_square_has_a_square() -> None:
    assert findings("sqrt(c^2)^2 = c^2", "sqrt(c^4) = c^2", "sqrt(c^2) = sqrt(c^2)", **CHAIN) == []


@pytest.mark.parametrize(
    ("relation", "wrong"),
    [
        ("sqrt(k/m) = sqrt(k)/sqrt(m)", 0),
        ("sqrt(6 m) = sqrt(2) sqrt(3 m)", 0),
        ("sqrt(m/2) = sqrt(2 m)/2", 0),
        ("sqrt(k/m) = sqrt(k) sqrt(m)", 1),
        ("sqrt(k m) = sqrt(k) + sqrt(m)", 1),
        ("sqrt(3 + 2 sqrt(2)) = 1 + sqrt(3)", 1),
        ("sqrt(3 + 2 sqrt(2)) = 1 + sqrt(2)", 0),
        ("sqrt(k + m + 2 sqrt(k m)) = sqrt(k) + sqrt(m)", 0),
        ("sqrt(k + m - 2 sqrt(k m)) = sqrt(k) + sqrt(m)", 1),
    ],
)
def test_a_root_of_a_product_is_the_product_of_the_roots(relation: str, wrong: int) -> None:
    assert len(findings(relation, **CHAIN | {"symbols": {"c": "real", "k": "positive", "m": "positive"}})) == wrong


@pytest.mark.parametrize("relation", ["sqrt(-k) sqrt(-m) = sqrt(k m)", "sqrt(-k)^2 = -k"])
def test_a_root_of_what_is_negative_has_no_value(relation: str) -> None:
    found = finding(relation, **CHAIN | {"symbols": {"c": "real", "k": "positive", "m": "positive"}})
    assert (found.holds, found.reason) == ("", "sqrt(-k) is not real")


def test_roots_that_only_seem_to_differ_are_not_said_to() -> None:
    with pytest.raises(ProblemErrors, match="is not decided"):
        findings("sqrt(exp(2 c)) = exp(c)", **CHAIN)
    assert finding("sqrt(c^2) sqrt(3 + 2 sqrt(2)) = c (1 + sqrt(2))", **CHAIN).right.endswith(" where c >= 0")


@tabled
def test_a_condition_says_nothing_where_its_factor_may_vanish(relation: str) -> None:
    """At a = 0 and c = −1 each condition holds, and the equation does not."""
    symbols = {"a": "real", "c": "real"}
    with contextlib.suppress(ProblemErrors):  # or it is undecided
        assert findings(relation, plant={"A": "[0 1; 0 0]", "C": "[c a]"}, symbols=symbols) != []


# -- eigenvalues -------------------------------------------------------------------------------------------------------


@tabled
def test_eigenvalues_may_be_roots_and_decimals(relation: str, plant: dict[str, object]) -> None:
    assert findings(relation, **plant) == []


@tabled
def test_eigenvalues_that_are_others_are_told(relation: str, plant: dict[str, object], right: str) -> None:
    found = finding(relation, **plant)
    assert found.right == right
    assert "the eigenvalues are others" in found.reason


# -- decimals ----------------------------------------------------------------------------------------------------------

# Of x' = [0 1; 0 -1] x, K = [4 3] by hand; P = 1/(s^2 + s), 1/3 and 2/3 are no decimals.
THIRDS = {"plant": {"A": "[-1/3 1; -2/3 0]", "B": "[2/7; 1/7]", "C": "[1 0]"}}
# P = (2/7 s + 1/7)/(s^2 + 1/3 s + 2/3) = (0.2857 s + 0.1429)/(s^2 + 0.3333 s + 0.6667)


@tabled
def test_decimals_are_compared_as_printed(relation: str) -> None:
    assert findings(relation, **THIRDS) == []


@tabled
def test_decimals_that_are_no_rounding_are_told(relation: str, reason: str) -> None:
    assert reason in finding(relation, **THIRDS).reason


@tabled
def test_factors_with_decimals_are_compared_by_their_roots(
    relation: str, plant: dict[str, object], *, true: bool
) -> None:
    assert (findings(relation, **plant) == []) is true


# Ogata, Modern Control Engineering, 5th edition, section 10-6 (page 777): A = [0 1; 20.6 0], C = [1 0], K = [29.6 3.6],
# L = [16; 84.6]; the controller is (778.2 s + 3690.7)/(s^2 + 19.6 s + 151.2).
OGATA: dict[str, Any] = tables(Path(__file__))["ogata"]


def test_ogata_s_controller_is_right_as_printed() -> None:
    printed = "(778.2 s + 3690.7)/(s^2 + 19.6 s + 151.2)"
    right, wrong = {"expect": {"F": printed}}, {"expect": {"F": printed.replace("3690.7", "3690.8")}}
    assert findings(f"F(s) = {printed}", **OGATA) == []
    assert len(findings(f"F = {printed.replace('778.2', '778.1')}", **OGATA)) == 1
    found = audit(read(problem(printed=[right, wrong], **OGATA))).findings
    assert [each.printed for each in found] == [wrong["expect"]["F"]]


# -- letters -----------------------------------------------------------------------------------------------------------


@tabled
def test_a_letter_before_its_argument_is_a_function(relation: str) -> None:
    assert findings(relation) == []


def test_a_transfer_function_at_a_pole_has_no_value() -> None:
    assert "has no value" in finding("P(0) = 1").reason


def test_expected_decimals_are_compared_as_printed(tmp_path: Path) -> None:
    expected = {"F": "(778.2 s + 3690.7)/(s^2 + 19.6 s + 151.2)", "K": "[29.6 3.60]", "L": "[16.0; 85.]"}
    for expect, code in ((expected, 0), ({**expected, "L": "[16.0; 85]"}, 4), ({**expected, "K": "[29.5 3.6]"}, 4)):
        (tmp_path / "file.json").write_text(problem(**OGATA, expect=expect), "utf-8")
        assert inside("solve", "file.json", folder=tmp_path).code == code
