"""A result at values of its parameters is that of the plant with these numbers, and its gains have the values they had."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
import sympy

import symobs
from symobs.ground.errors import InputError, ProblemErrors
from symobs.problem import read
from tests.kit import tabled
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from symobs.tasks.result import Result

HIDDEN = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 c]")
#: Whose symbolic answers take seconds, here asked many times.
LARGE = {"cart_pole", "pendulum_on_cart"}


def with_letters() -> list[str]:
    files = sorted((ROOT / "worked_examples").glob("*.toml"))
    return [f.stem for f in files if "[symbols]" in f.read_text("utf-8") and f.stem not in LARGE]


def drawn(result: Result, chosen: random.Random) -> dict[str, Fraction]:
    found = {}
    for name, sign in result.symbols.items():
        size = Fraction(chosen.randint(1, 40), chosen.randint(1, 9))
        found[name] = -size if sign in {"negative", "nonpositive"} else size
    return found


@pytest.mark.parametrize("name", with_letters())
def test_gains_of_worked_examples_have_the_values_that_sympy_finds(name: str) -> None:
    path = ROOT / "worked_examples" / f"{name}.toml"
    for result in read(path.read_text("utf-8"), name, path.parent).solve():
        if result.task not in {"observer", "state_feedback", "compensator", "reduced_order_observer"}:
            continue
        values = drawn(result, random.Random(name))  # noqa: S311 - a seeded draw
        there = result.at(values)
        assert type(there) is type(result)
        assert there.symbols == {}
        assert there.all_certificates
        numbers = {key: sympy.Rational(value) for key, value in values.items()}
        for letter in {"K", "L"} & {key for key, value in result.answer.items() if value is not None}:
            gain = getattr(result, letter)
            assert getattr(there, letter) == gain.subs({s: numbers[s.name] for s in gain.free_symbols})


def test_a_gain_that_is_not_unique_is_kept_and_its_page_speaks_of_it() -> None:
    """With two inputs; for the numbers alone another member of the family would be chosen."""
    A, B = "[1 2 0 k; 0 0 0 2; 0 -1 1 -1; 0 2 1 -1]", "[0 1; k 1; 1 0; k 0]"
    result = symobs.state_feedback(symobs.StateSpace(A, B), poles="-1, -2, -3, -4")
    there = result.at(k=3)
    direct = symobs.state_feedback(symobs.StateSpace(A, B).substitute({"k": 3}), poles="-1, -2, -3, -4")
    assert there.K == result.K.subs(sympy.Symbol("k"), 3) != direct.K
    s = sympy.Symbol("s")
    closed = (s * sympy.eye(4) - there.plant.A + there.plant.B * there.K).det()
    assert sympy.expand(closed - (s + 1) * (s + 2) * (s + 3) * (s + 4)) == 0
    assert "-49" in there.to("text")


@tabled
def test_what_is_asked_for_moves_too(
    task: str, plant: list[str], asked: dict[str, Any], values: dict[str, int], field: str, expected: str
) -> None:
    A, B, C = (part or None for part in plant)
    there = getattr(symobs, task)(symobs.StateSpace(A, B, C), **asked).at(values)
    assert there.symbols == {}
    wanted = sympy.sympify(expected)  # noqa: TID251 - texts of this file
    assert sympy.simplify(getattr(there, field) - wanted) == 0


@tabled
def test_refusals(values: dict[str, Any], message: str) -> None:
    with pytest.raises((InputError, ProblemErrors), match=message):
        symobs.observer(HIDDEN, poles="-k, -5").at(values)


def test_where_there_is_no_plant_and_where_a_sign_is_another() -> None:
    result = symobs.observer(
        symobs.StateSpace("[0 1; -k/m 0]", None, "[1 0]", symbols={"k": "positive", "m": "real"}), poles="-1, -2"
    )
    with pytest.raises(InputError, match=r"the problem is not defined at k = 1, m = 0: a denominator of its data is 0"):
        result.at(k=1, m=0)
    with pytest.raises(InputError, match=r"values\.k: -1 is not positive, as k is declared"):
        result.at(k=-1)
    led = symobs.minimum_energy_input(HIDDEN, final="[1/k; 0]", horizon=1)
    with pytest.raises(InputError, match=r"the problem is not defined at k = 0: a denominator of its data is 0"):
        led.at(k=0)
    with pytest.raises(InputError, match="holds in one case of a result; give the values to the result itself"):
        symobs.observer(HIDDEN, poles="-k, -5").cases[0].result.at(k=1)
