"""Observer and state feedback in two columns: what stands beside what, in every format, and who is refused."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.formula.tree import Literal
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.errors import DerivationRejected, InputError
from symobs.pages.page.blocks import Columns, Display, every
from symobs.pages.page.narrator import narrate
from symobs.pages.printers.text_printer import text_width
from symobs.proof.derivation import Equal, Section
from symobs.tasks.result import render
from tests.kit import SERVO, tabled
from tests.support.examples import document_of

if TYPE_CHECKING:
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Document

BESIDE = "side_by_side"
POLES: dict[str, Any] = {"control_poles": [-2, -2], "observer_poles": [-10, -10]}


def document() -> Document:
    return document_of("double_integrator_pole_placement")


def columns() -> Columns:
    (found,) = (block for block in every(narrate(document())) if isinstance(block, Columns))
    return found


def told(number: int) -> list[list[str]]:
    """The relations on display in a column, row by row."""
    cells = [row[number] for row in columns().rows]
    displays = [[block for block in cell if isinstance(block, Display)] for cell in cells]
    return [[plain_relation(r, "s") for block in cell for r in block.relations] for cell in displays]


def test_every_line_on_the_left_has_its_dual_on_the_right() -> None:
    """S1 before 14:53: Aᵀ + CᵀMᵀ beside A + BK, from the rank test to the polynomial; the values by hand."""
    left, right = told(0), told(1)
    assert [len(cell) for cell in left] == [len(cell) for cell in right]
    assert all(cell for row in columns().rows for cell in row)
    assert [left[0][0], right[0][0]] == [
        "O.T = [C.T, A.T*C.T] = [1, 0; 0, 1]",
        "Ctr = [B, A*B] = [0, 1; 1, 0]",
    ]
    assert [asked.endswith("= s**2 + s*mu1 + s*mu2 + mu1*mu2") for (asked,) in (left[-3], right[-3])] == [True, True]
    (gain,), (feedback,) = left[-2], right[-2]
    assert gain.endswith("= [-mu1 - mu2, -mu1*mu2]")
    assert feedback.endswith("= [-mu1*mu2, -mu1 - mu2]")


def test_sources_are_numbered_as_they_are_read() -> None:
    page = str(render(document(), "text")).split("References\n")[0]
    cited = [part for entry in re.findall(r"\[(\d+(?:[;,] [^\]]*)?)\]", page) for part in entry.split("; ")]
    numbers = [int(part.split(",")[0]) for part in cited if part[0].isdigit()]
    firsts = list(dict.fromkeys(numbers))
    assert firsts == sorted(firsts)


@tabled
def test_every_format_sets_them_side_by_side(name: str, marks: tuple[str, ...]) -> None:
    written = str(render(document(), name))
    assert all(mark in written for mark in marks)
    if name == "text":
        assert max(text_width(line) for line in written.splitlines()) <= 80
    if name == "markdown":
        table = [line for line in written.splitlines() if line.startswith("| ")]
        assert len(table) == 2 + len(columns().rows)
        assert {line.count("|") for line in table} == {3}


def test_the_answer_is_the_one_of_the_separate_designs() -> None:
    beside, apart = (symobs.compensator(SERVO, **POLES, method=name) for name in ("duality", "separation"))
    assert beside.fields.keys() == apart.fields.keys()
    assert (beside.K, beside.L, beside.F) == (apart.K, apart.L, apart.F)


@pytest.mark.parametrize("side", [0, 1])
def test_a_false_line_in_a_column_is_rejected(side: int) -> None:
    """The gain of a column with its sign turned, everywhere in that column."""
    derivation = document().derivations[0]
    place = next(i for i, step in enumerate(derivation.steps) if isinstance(step, Section) and step.title.key == BESIDE)
    whole = derivation.steps[place]
    assert isinstance(whole, Section)
    columns = [step for step in whole.steps if isinstance(step, Section)]
    wrong = replace(columns[side], steps=tuple(turned(step) for step in columns[side].steps))
    inside = tuple(wrong if step is columns[side] else step for step in whole.steps)
    assert wrong != columns[side]
    with pytest.raises(DerivationRejected, match=r"the line K =|the line L\.T ="):
        replace(
            derivation,
            steps=(*derivation.steps[:place], replace(whole, steps=inside), *derivation.steps[place + 1 :]),
        ).check()


def turned(step: Step) -> Step:
    """The display of a gain that ends in the negative of what it is."""
    if not isinstance(step, Equal) or step.sentence is None or not step.sentence.key.startswith("gain_"):
        return step
    (relation,) = step.relations
    *front, last = relation.members
    assert isinstance(last, Literal)
    return replace(step, relations=(replace(relation, members=(*front, Literal(-last.value))),))


def test_a_side_with_fixed_modes_is_told_apart() -> None:
    plant = symobs.StateSpace("[-2 0; 0 1]", "[0; 1]", "[1 1]")
    found = symobs.compensator(plant, control_poles=[-2, -3], observer_poles=[-4, -5], method="duality")
    assert found.verdict == "yes"
    assert " │ State feedback" not in str(found.to("text"))
    assert "uncontrollable" in str(found.to("text"))


def test_where_the_pair_is_not_observable_is_a_case_below_the_columns() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 c]")
    page = str(symobs.compensator(plant, **POLES, method="duality").to("text"))
    assert page.index(" │ State feedback") < page.index("Case c = 1.") < page.index("2. Observer")


@pytest.mark.parametrize(
    ("plant", "observer", "words"),
    [
        (
            symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0; 0 1]"),
            "full",
            "one input and one output, the plant has 1 and 2",
        ),
        (SERVO, "minimal", "the method duality has an observer of full order"),
    ],
)
def test_who_is_refused(plant: symobs.StateSpace, observer: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        symobs.compensator(
            plant,
            control_poles=[-2, -2],
            observer_poles=[-10] if observer == "minimal" else [-10, -10],
            observer=observer,
            method="duality",
        )
    assert caught.value.where == "specification.method"
