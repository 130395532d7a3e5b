"""Levels of detail: what may be left out of a page, and what never is."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest

import symobs
from symobs.formula.phrases import ASSERTS, EXPLAINS, PHRASES, SPELLS_OUT, slots_of
from symobs.formula.tree import Conjunction, Letter, Literal, Relation
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.errors import UsageError
from symobs.pages.page.blocks import CaseBlock, Caution, Display, Paragraph, References, Verified, every
from symobs.pages.page.detail_level import DETAILS, at_detail
from symobs.pages.page.narrator import narrate
from symobs.proof.derivation import CaseStep, Conclude, Define, Equal, Given, Note, Sentence
from tests.kit import tabled
from tests.support.examples import EXAMPLES, document_of
from tests.support.sampling import every as some_of
from tests.support.tools.command_line import SERVO, inside

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from symobs.formula.tree import Formula
    from symobs.pages.page.blocks import Block
    from symobs.proof.derivation import Step

every_third = some_of(3, EXAMPLES)
SHORTER = [detail for detail in DETAILS if detail != "full"]


def blocks(path: Path, detail: str) -> tuple[Block, ...]:
    return tuple(every(narrate(replace(document_of(path.stem), detail=detail))))


def inequalities(page: Iterable[Block]) -> Iterator[Relation]:
    """Everything on a page that says where something holds; `~` and `≈` do not."""
    for block in page:
        found: Iterable[object] = block.relations if isinstance(block, Display) else getattr(block, "inlines", ())
        found = [*found, *(block.label if isinstance(block, CaseBlock) else ())]
        yield from (part for part in found if isinstance(part, Relation) and not set(part.operators) <= {"=", "~", "≈"})


def answers(page: Iterable[Block]) -> list[Formula]:
    return [block.relations[-1].members[-1] for block in page if isinstance(block, Display) and block.boxed]


@pytest.mark.slow
@pytest.mark.parametrize("path", every_third, ids=lambda path: path.stem)
def test_a_shorter_page_hides_nothing_that_conditions_an_answer(path: Path) -> None:
    full = blocks(path, "full")
    for detail in SHORTER:
        shorter = blocks(path, detail)
        assert answers(shorter) == answers(full)
        for kind in (Verified, CaseBlock, Caution):
            label = "label" if kind is CaseBlock else "inlines"
            kept = [getattr(block, label) for block in shorter if isinstance(block, kind)]
            wanted = [getattr(b, label) for b in full if isinstance(b, kind) and not isinstance(b, References)]
            assert [part for part in kept if part in wanted] == wanted
        lost = set(inequalities(full)) - set(inequalities(shorter))
        assert detail == "answer" or not lost
        assert {plain_relation(relation, "s") for relation in lost} <= {"epsilon > 0"}  # of a table that is not shown


@pytest.mark.parametrize("path", every_third, ids=lambda path: path.stem)
def test_sentences_of_a_shorter_page_can_be_read(path: Path) -> None:
    for detail in SHORTER:
        page = list(narrate(replace(document_of(path.stem), detail=detail)))
        for before, block in zip([None, *page], page, strict=False):
            if isinstance(block, Paragraph) and isinstance(first := block.inlines[0], str) and first[:1].islower():
                assert isinstance(before, Display), f"{detail}: {first!r} goes on with nothing"
        for block, after in pairwise(page):
            if isinstance(block, Paragraph) and str(block.inlines[-1])[-1:] not in {".", "?"}:
                assert not isinstance(after, Paragraph | Verified | CaseBlock), f"{detail}: {block.inlines[-1]!r}"


@pytest.mark.parametrize("path", every_third, ids=lambda path: path.stem)
def test_short_names_in_answers_are_spelled_out(path: Path) -> None:
    for detail in SHORTER:
        for derivation in document_of(path.stem).derivations:
            steps = list(walk(at_detail(derivation.steps, detail)))
            short = {name for step in walk(derivation.steps) for name in named_by(step)}
            answered = {name for step in steps if getattr(step, "answer", False) for name in names_in(step)}
            told = {name for step in steps if isinstance(step, Equal) for name in spelled_by(step)}
            told |= {name for step in steps if isinstance(step, Conclude) for name in spelled_in(step.sentence)}
            assert short & answered <= told, detail


def walk(steps: Iterable[Step]) -> Iterator[Step]:
    for step in steps:
        yield step
        yield from walk(getattr(step, "steps", ()))


def named_by(step: Step) -> Iterator[str]:
    """Names that stand for longer values."""
    if isinstance(step, Define) and isinstance(step.relation.members[0], Literal):
        yield str(step.relation.members[0].value)


def names_in(step: Step) -> Iterator[str]:
    relations = (step.relation,) if isinstance(step, Define) else getattr(step, "relations", ())
    for relation in relations:
        for member in relation.members:
            yield from member.value.names if isinstance(member, Literal) else ()


def spelled_by(step: Equal) -> Iterator[str]:
    key = step.sentence.key if step.sentence else ""
    if key in SPELLS_OUT:
        yield from names_in(step)


def spelled_in(sentence: Sentence | None) -> Iterator[str]:
    for _, slot in sentence.slots if sentence else ():
        if isinstance(slot, Relation) and isinstance(slot.members[-1], Literal):
            yield from slot.members[-1].value.names


# -- rules ------------------------------------------------------------------------------------------------------------


def test_what_explains_asserts_nothing_and_holds_no_condition() -> None:
    assert not EXPLAINS & ASSERTS.keys()
    assert not {slot for key in EXPLAINS for slot in slots_of(key)} & {"where", "condition", "conditions", "signs"}


def step_of(detail: str, *steps: Step) -> tuple[Step, ...]:
    return at_detail(steps, detail)


A, B = Letter("A"), Letter("B")
SAME = Relation((A, B), ("=",))


@pytest.mark.parametrize("detail", SHORTER)
def test_every_kind_of_step_that_conditions_stays(detail: str) -> None:
    different = Relation((A, B), ("!=",))
    condition = Sentence("provided_observability", (("condition", Conjunction((different,))),))
    steps: tuple[Step, ...] = (
        Given((SAME,)),
        Given((different,), condition),
        Conclude(None, (SAME,)),
        Conclude(Sentence("yes_observability")),
        Note(Sentence("horizon_tradeoff"), caution=True),
        CaseStep(different, (), (Conclude(Sentence("case_zero")),)),
        Equal((different,)),
    )
    assert step_of(detail, *steps) == steps


def test_a_finding_keeps_what_it_speaks_of() -> None:
    matrix = Define(SAME, Sentence("observability_matrix"))
    determinant = Equal((SAME,))
    finding = Conclude(Sentence("no_observability", (("rank", SAME),)))
    explained = Equal((SAME,), Sentence("compare"))
    assert step_of("answer", matrix, determinant, finding) == (matrix, determinant, finding)
    assert step_of("answer", explained, matrix, determinant, finding) == (matrix, determinant, finding)
    assert step_of("answer", matrix, determinant) == ()


def test_an_answer_stands_alone() -> None:
    way = Relation((A, B, A), ("=", "="))
    (answer,) = step_of("answer", Define(way, Sentence("hence_gain"), answer=True))
    assert answer == Define(Relation((A, A), ("=",)), None, answer=True)
    (answer,) = step_of("outline", Define(way, Sentence("hence_gain"), answer=True))
    assert answer == Define(way, None, answer=True)


@tabled
def test_only_equals_are_passed_over(operators: str, kept: str, left: str) -> None:
    names = "ABCD"[: len(operators) + 1]
    chain = Relation(tuple(map(Letter, names)), tuple(operators))
    (answer,) = step_of("answer", Define(chain, None, answer=True))
    assert answer == Define(Relation(tuple(map(Letter, kept)), tuple(left)), None, answer=True)


def test_explanations_go() -> None:
    explaining = Note(Sentence("assignable_observer"))
    assert step_of("outline", explaining) == ()
    assert step_of("full", explaining) == (explaining,)
    assert PHRASES["assignable_observer"]


# -- faces ------------------------------------------------------------------------------------------------------------


def test_python_and_the_shell_know_the_levels() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")
    result = symobs.observer(plant, poles=[-10, -10])
    full, outline, answer = (" ".join(str(result.to("text", detail=detail)).split()) for detail in DETAILS)
    assert len(answer) < len(outline) < len(full)
    assert "Irrespective of the input" in full
    assert "Irrespective of the input" not in outline
    assert "The observability matrix is" in outline  # no matrix without a word
    assert "The observability matrix is" not in answer
    assert "as required" in answer
    run = inside("solve", str(SERVO), "--format", "text", "--detail", "answer")
    assert run.code == 0
    assert "In these coordinates the gain" in full
    assert "In these coordinates the gain" not in run.out
    assert (
        inside("observer", "--A", "[0 1; 0 -1]", "--C", "[1 0]", "--poles", "-1, -1", "--detail", "outline").code == 0
    )


def test_an_unknown_level_is_refused_before_work_starts() -> None:
    run = inside("solve", str(SERVO), "--detail", "short")
    assert (run.code, run.out) == (2, "")
    assert run.err == "--detail: 'short' is not a level of detail; use one of full, outline, answer\n"
    with pytest.raises(UsageError, match="detail: 'short' is not a level of detail"):
        at_detail((), "short")


def test_json_is_whole_at_every_level() -> None:
    whole, short = (inside("solve", str(SERVO), "--format", "json", "--detail", level) for level in ("full", "answer"))
    assert whole.out == short.out
