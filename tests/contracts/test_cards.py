"""A card shows the value of its field, and nothing else."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING, Any

import pytest

from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.convention import conventions
from symobs.formula.tree import Environment, Exact, Literal, Relation, Roots, evaluate
from symobs.pages.cards import NAMES, CardPrinter, cards
from symobs.problem import read
from symobs.tasks.result import tasks
from tests.support.tools.command_line import EXAMPLES

if TYPE_CHECKING:
    from pathlib import Path

LARGE = {"cart_pole", "region_three_gains"}
_WITHOUT_A_CARD = {"initial_state_covariance"}


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


@pytest.mark.parametrize("path", [path for path in EXAMPLES if path.stem not in LARGE], ids=lambda path: path.stem)
def test_a_card_shows_the_value_of_its_field(path: Path) -> None:
    problem = read(path.read_text(encoding="utf-8"), folder=path.parent)
    for result in problem.solve():
        for card in cards(result, result.fields):
            assert card.answer is result.fields[card.name]
            if isinstance(card.shown, Roots):
                assert card.shown.values == card.answer
                continue
            environment = Environment(variable=result.plant.variable)
            shown = evaluate(card.shown.members[-1], environment, Exact(environment))
            assert shown == value_of(card.answer), (result.task, card.name)
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


def test_only_fields_that_exist_have_a_name_of_their_own() -> None:
    assert NAMES.keys() <= tasks().keys()
