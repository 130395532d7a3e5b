"""A card shows the value of its field, and nothing else."""

from __future__ import annotations

import cmath
import json
import re
import xml.etree.ElementTree as ET
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from symobs import StateSpace, state_feedback
from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.convention import conventions
from symobs.formula.expression import parse_matrix, parse_poles, parse_scalar
from symobs.formula.tree import Environment, Exact, Literal, Relation, Roots, evaluate
from symobs.pages.cards import Card, CardPrinter, cards
from symobs.pages.printers.root_lists import TEXT, listed
from symobs.pages.printers.text_printer import TextPrinter
from symobs.problem import read
from symobs.tasks.result.output_methods import to_json
from tests.kit import text_of
from tests.support.examples import EXAMPLES, problem_of, results_of

if TYPE_CHECKING:
    from pathlib import Path

LARGE = {"cart_pole", "region_three_gains"}


def value_of(field: Any) -> Any:
    """The exact value of a field, by its own definition."""
    if isinstance(field, Factored):
        return field.value
    if isinstance(field, int):
        return Scalar.of(field)
    if isinstance(field, (list, tuple)):
        if isinstance(field[0], Scalar):
            return Matrix.of([[entry] for entry in field])
        if isinstance(field[0][0], Factored):
            return Matrix.of([[entry.value for entry in row] for row in field])
        return Matrix.of([list(column) for column in zip(*field, strict=True)])
    return field


def assert_read_back(result: Any, card: Card) -> None:
    """What a terminal prints, and what --print and JSON write, is the same value when it is typed."""
    variable, names = result.plant.variable, dict.fromkeys(result.symbols, "positive")
    printer = TextPrinter(variable, result.plant.symbols.latex, flat=True)
    if isinstance(card.shown, Roots):
        closed = tuple(root for root in card.answer if root.is_closed)
        printed = ", ".join(listed(replace(card.shown, values=closed), printer, TEXT))
        poles = parse_poles(printed, names, roots=True) if closed else ()
        found, expected = (
            sorted(map(number, roots), key=lambda z: (round(z.real, 6), z.imag)) for roots in (poles, closed)
        )
        assert found == pytest.approx(expected), (result.task, card.name, printed)
        return
    is_table = isinstance(value := value_of(card.answer), Matrix)
    texts = [printer.inline(card.shown.members[-1]), to_json(card.answer)]
    for text in texts if isinstance(card.answer, (Matrix, Scalar, Factored)) else texts[:1]:
        reader: Any = parse_matrix if is_table else parse_scalar
        typed = reader(text, names | {"t": "real"} if variable != "t" else names, functions=True, variable=variable)
        pairs = zip(typed.entries, value.entries, strict=True) if is_table else [(typed, value)]
        for found, expected in pairs:
            assert number(found) == pytest.approx(number(expected)), (result.task, card.name, text)


def number(value: Any) -> complex:
    """The value at a point that belongs to its names."""
    functions = {name: getattr(cmath, name) for name in ("sqrt", "exp", "sin", "cos", "sinh", "cosh")}
    point = {name: 1 + zlib.crc32(name.encode()) % 97 / 50 for name in re.findall(r"[A-Za-z]\w*", str(value))}
    return complex(eval(str(value), {**point, **functions, "I": 1j}))  # noqa: S307


@pytest.mark.parametrize("path", [path for path in EXAMPLES if path.stem not in LARGE], ids=lambda path: path.stem)
def test_a_card_shows_the_value_of_its_field(path: Path) -> None:
    problem = problem_of(path.stem)
    for result in results_of(path.stem):
        for card in cards(result, result.fields):
            assert card.answer is result.fields[card.name]
            if isinstance(card.shown, Roots):
                assert card.shown.values == card.answer
                continue
            environment = Environment(variable=result.plant.variable)
            shown = evaluate(card.shown.members[-1], environment, Exact(environment))
            value = value_of(card.answer)
            pairs = zip(shown.entries, value.entries, strict=True) if isinstance(value, Matrix) else [(shown, value)]
            for one, other in pairs:  # roots of letters are spelled anew: √(q/r) for √(qr)/r
                assert one == other or number(one) == pytest.approx(number(other)), (result.task, card.name)
        for card in cards(result, result.fields):
            assert_read_back(result, card)
        printer = CardPrinter(result, problem.convention)
        for card in cards(result, result.fields, problem.convention):
            ET.fromstring(f"<card>{printer.mathml(card)}</card>")  # noqa: S314 - our own
            assert printer.latex(card).count("{") == printer.latex(card).count("}")
            assert printer.says(card)


def test_a_turned_gain_is_shown_with_its_own_sign() -> None:
    plant = "[plant]\nA = '[0 1; 0 -1]'\nC = '[1 0]'\n[specification]\npoles = '-10, -10'\n"
    (result,) = read(f"task = 'observer'\n{plant}").solve()
    for convention in conventions().values():
        (card,) = cards(result, ["L"], convention)
        assert isinstance(card.shown, Relation)
        written = card.shown.members[-1]
        assert isinstance(written, Literal)
        sign = -1 if "L" in convention.turned else 1
        assert written.value == Matrix.of([[19 * sign], [81 * sign]])


def test_a_pair_with_a_letter_is_no_multiple_of_pi_and_a_parameter_may_be_called_i() -> None:
    plant = StateSpace("[0 1; 0 0]", "[0; 1/I]", symbols={"I": "positive", "p": "positive"})
    result = state_feedback(plant, poles="-p + p*i, -p - p*i")
    assert_read_back(result, *cards(result, ["poles"]))
    page = text_of(result)
    assert "-p ± p i" in page
    assert "K = [2p² - 0 2p - 0] V_c⁻¹ = [2p² 2p] ⎡\U0001d5a8 0⎤" in page
    assert "det(sI - A + B K) = s² + 2p s + 2p²" in page
    written = result.to_json()
    assert json.loads(written)["results"][0]["K"] == [["2*I*p**2", "2*I*p"]]
