"""Conditions as students write them mean what they say, however they are written; what is no condition is refused."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest

from symobs.applications.checking.regions import read_conditions
from symobs.exact.algebraic.root_location import value_at
from symobs.ground.errors import InputError
from tests.kit import tabled

if TYPE_CHECKING:
    from collections.abc import Callable

NAMES = {"h": "real", "k": "real"}
#: Sides of inequalities, and what they are in plain fractions.
SIDES: list[tuple[str, Callable[[Fraction, Fraction], Fraction]]] = [
    ("h", lambda h, _: h),
    ("k", lambda _, k: k),
    ("2 h - (k + 1)", lambda h, k: 2 * h - k - 1),
    ("(h - 1) k", lambda h, k: (h - 1) * k),
    ("0.25 h^2", lambda h, _: h**2 / 4),
    ("-1", lambda h, _: h - h - 1),
    ("(k)/(h^2 + 1)", lambda h, k: k / (h**2 + 1)),
    ("(3/2)", lambda h, _: h - h + Fraction(3, 2)),
]
HOLDS: dict[str, Callable[[Fraction, Fraction], bool]] = {
    ">": lambda a, b: a > b,
    "<": lambda a, b: a < b,
    ">=": lambda a, b: a >= b,
    "<=": lambda a, b: a <= b,
    "!=": lambda a, b: a != b,
}
POINTS = [(Fraction(h), Fraction(k)) for h in ("-2", "0", "1", "3/2", "4") for k in ("-1", "0", "1/2", "2", "5")]


def chain(draw: random.Random) -> tuple[str, Callable[[Fraction, Fraction], bool]]:
    """A chain of two or three sides, and whether it holds at a point."""
    sides = [draw.choice(SIDES) for _ in range(draw.choice((2, 2, 3)))]
    signs = [draw.choice(list(HOLDS)) for _ in sides[1:]]
    text = sides[0][0] + "".join(f" {sign} {side}" for sign, (side, _) in zip(signs, sides[1:], strict=True))

    def holds(h: Fraction, k: Fraction) -> bool:
        values = [side(h, k) for _, side in sides]
        return all(HOLDS[sign](a, b) for sign, a, b in zip(signs, values, values[1:], strict=False))

    return text, holds


def within(draw: random.Random, text: str) -> str:
    """A text in brackets, in many, or in none."""
    depth = draw.choice((0, 0, 1, 2))
    return "(" * depth + text + ")" * depth


def said(draw: random.Random, parts: list[list[str]]) -> Any:
    """One of the forms in which a union of conjunctions may be written."""
    written = [[within(draw, part) for part in conjunction] for conjunction in parts]
    joined = [draw.choice((" and ", ", ", " && ", " & ", "; ")).join(conjunction) for conjunction in written]
    forms: list[Any] = [
        f" {draw.choice(('or', '|', '||'))} ".join(within(draw, text) if " and " in text else text for text in joined),
        [list(conjunction) for conjunction in written],
        [*(list(conjunction) for conjunction in written[:-1]), joined[-1]] if len(written) > 1 else [joined[0]],
    ]
    if len(parts) == 1:
        quote = draw.choice("\"'")
        quoted = ", ".join(f"{quote}{text}{quote}" for text in written[0])
        forms += [written[0], quoted, f"[{quoted}]", f" [{joined[0]}] ", f"{{{joined[0]}}}", f"({joined[0]})"]
        forms += [f"{joined[0]}, True", f"True and {joined[0]}", f"{joined[0]} or False"]
    else:
        forms += [[forms[0]]]
    return draw.choice(forms)


@pytest.mark.parametrize("number", range(120))
def test_what_is_written_holds_where_it_says(number: int) -> None:
    draw = random.Random(f"conditions {number}")  # noqa: S311 - repeatable by design
    union = [[chain(draw) for _ in range(draw.choice((1, 2, 3)))] for _ in range(draw.choice((1, 1, 2, 3)))]
    given = said(draw, [[text for text, _ in conjunction] for conjunction in union])
    read = read_conditions(given, NAMES)
    for h, k in POINTS:
        signs = [[(c, value_at(c.value, {"h": h, "k": k})) for c in part] for part in read]
        found = any(all(c.holds((value > 0) - (value < 0)) for c, value in part) for part in signs)
        assert found is any(all(holds(h, k) for _, holds in part) for part in union), (given, h, k)


@tabled
def test_what_always_and_never_holds(given: Any, union: list[list[str]]) -> None:
    assert [[c.text for c in part] for part in read_conditions(given, NAMES)] == union


@tabled
def test_what_is_no_condition_is_refused_with_its_repair(given: Any, message: str, repair: str) -> None:
    with pytest.raises(InputError) as refused:
        read_conditions(given, NAMES)
    assert refused.value.message.startswith(message)
    assert not repair or refused.value.repair.replace("h1", "h") == repair.replace("h1", "h")
    assert refused.value.where in {"stable_if", *(f"stable_if[{i}]" for i in range(3))}
