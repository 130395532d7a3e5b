"""Exported graders and `check` on the same answers."""

from __future__ import annotations

import io
import random
from contextlib import redirect_stdout
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import fromstring

from symobs.applications.export import export
from symobs.applications.export.grader.claims import judge
from tests.support.tools.exported import BY_HAND, HELD, checked, held, random_answer
from tests.unit.applications.export import test_other_platforms as others
from tests.unit.applications.export import test_stack as stack

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.applications.export import ExerciseSet

    Given = dict[str, list[list[str]]]

STACK: tuple[str, ...] = (
    "output_feedback_servo",
    "other signs",
    "either sign",
    "zeros",
    "square",
    "two_inputs_feedback",
)
STACK += ("tanks_observer_parametric", "third_order_plant", "triple_pole_two_outputs", "detectable")
NOTEBOOK = ("output_feedback_servo", "triple_pole_two_outputs", "zeros", "two_inputs_feedback", "servo_observer")


def main(count: int, only: str) -> bool:
    """Print a line a platform; False where a verdict differs."""
    kinds: dict[str, tuple[tuple[str, ...], Callable[[ExerciseSet, list[Given]], int]]] = {
        "prairielearn": ((*HELD, *BY_HAND), _by_grader),
        "qti": (others.QTI, _by_qti),
        "moodle": (others.CLOZE, _by_moodle),
        "stack": (STACK, _by_stack),
        "ipynb": (NOTEBOOK, _by_notebook),
    }
    whole = True
    for platform, (names, differing) in kinds.items():
        if only and platform != only:
            continue
        total = off = right = 0
        for name in names:
            each, draw = held(name), random.Random(f"{platform} {name}")  # noqa: S311 - repeatable by design
            exact = platform not in {"prairielearn", "ipynb"}
            given = [random_answer(each.first, draw, exact=exact) for _ in range(-(-count // len(names)))]
            off += differing(each, given)
            total += len(given)
            right += sum(all(verdict == "right" for verdict, _ in checked(each.first, g).values()) for g in given)
        print(
            f"{platform}: {total} answers to {len(names)} questions, {right} all right, {off} verdicts differ",
            flush=True,
        )
        whole &= not off
    return whole


def _by_grader(each: ExerciseSet, given: list[Given]) -> int:
    """Verdict and credit of every part."""
    off = 0
    for answer in given:
        found = {name: (told["verdict"], told["credit"]) for name, told in judge(each.first.question, answer).items()}
        off += found != checked(each.first, answer)
    return off


def _by_stack(each: ExerciseSet, given: list[Given]) -> int:
    """The scores of the response trees in Maxima are the credits."""
    question = stack.question_of(each)
    trees, off = question.findall("prt"), 0
    for start in range(0, len(given), 50):
        some = given[start : start + 50]
        found = stack.run(question, [stack.answered(each, answer) for answer in some])
        for answer, verdicts in zip(some, found, strict=True):
            told = checked(each.first, answer)
            scores = [stack.walked(tree, verdict)[0] for tree, verdict in zip(trees, verdicts, strict=True)]
            off += scores != [told[part.name][1] for part in each.first.parts]
    return off


def _by_qti(each: ExerciseSet, given: list[Given]) -> int:
    """Full marks where `check` says right, and else those of the slips that QTI knows, or none."""
    item, off = others.item_of(each), 0
    for answer in given:
        told = checked(each.first, answer)
        responses: dict[str, Any] = {}
        for k, part in enumerate(each.first.parts, 1):
            cells = [cell for row in answer[part.name] for cell in row]
            if part.kind == "word":
                responses[f"P{k}"] = cells[0]
            else:
                responses |= {f"P{k}R{i}": float(others.number(cell)) for i, cell in enumerate(cells, 1)}
        found = others.processed(item, responses)
        for k, part in enumerate(each.first.parts, 1):
            verdict, credit = told[part.name]
            off += (found[f"S{k}"] == 1) != (verdict == "right") or found[f"S{k}"] not in {0, float(credit or 0)}
    return off


def _by_moodle(each: ExerciseSet, given: list[Given]) -> int:
    """All gaps of a part are taken where `check` says right."""
    quiz = fromstring(str(export("moodle", [each])[""]))  # noqa: S314 - our own export
    gaps, off = others.gaps_of(quiz[1].findtext("questiontext/text", "")), 0
    for answer in given:
        told, left = checked(each.first, answer), iter(gaps)
        for part in each.first.parts:
            cells = [
                str(others.number(cell)) if part.kind != "word" else cell for row in answer[part.name] for cell in row
            ]
            taken = sum(others.cloze_right(next(left), cell) for cell in cells) == len(cells)
            off += taken != (told[part.name][0] == "right")
    return off


def _by_notebook(each: ExerciseSet, given: list[Given]) -> int:
    """The marks of the test cell are the score."""
    lines = others.notebook_of(each)["cells"][2]["source"].splitlines()
    cell, last = compile("\n".join(lines[:-2]), "cell", "exec"), compile(lines[-2], "cell", "eval")
    off = 0
    for answer in given:
        names: dict[str, Any] = {
            part.name: answer[part.name][0][0]
            if part.kind == "word" or (part.shape == (1, 1) and part.kind != "gain")
            else answer[part.name]
            for part in each.first.parts
        }
        told = checked(each.first, answer)
        weights = {part.name: part.data["weight"] for part in each.first.parts}
        wanted = sum(float(weights[name]) * float(credit or 0) for name, (_, credit) in told.items())
        with redirect_stdout(io.StringIO()):
            exec(cell, names)  # noqa: S102 - our own export
            off += abs(eval(last, names) - wanted) > 1e-9  # noqa: S307
    return off
