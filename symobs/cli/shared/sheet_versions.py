"""Versions of a sheet: the same problems with other numbers in another order, and the points of each step for the key."""

from __future__ import annotations

import string
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.applications.checking.checker import Checked
from symobs.applications.variants import Variants
from symobs.formula.tree.written import read_relation
from symobs.ground.errors import SymobsError, UsageError
from symobs.pages.cards import formula_named
from symobs.pages.page.blocks import Columns, Paragraph
from symobs.pages.page.sheet import decimal_of, sheet_words
from symobs.problem import parse

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.phrases.languages import Language
    from symobs.pages.page.blocks import Inline
    from symobs.problem import Problem
    from symobs.problem.sheet_file import SheetFile, SheetProblem
    from symobs.tasks.result import Result

#: Each version has a letter.
MOST_VERSIONS = len(string.ascii_uppercase)


def versions_of(file: SheetFile, count: int) -> list[tuple[SheetProblem, str]]:
    """Return the problems of all versions with their texts: of a file with `[variants]` another variant in each.

    The variants of a problem have loads that differ by less than a tenth. Each version begins with another problem.
    Raises `TooFew` where a problem has not so many variants, and `UsageError` where all versions would be the same.
    """
    texts = [_texts(problem.file, text, count) for problem, text in zip(file.problems, file.texts, strict=True)]
    if len(texts) == 1 and len(set(texts[0])) == 1:
        repair = "give the problem a table [variants], or the sheet more problems"
        raise UsageError("the versions would all be the same", where="--versions", repair=repair)
    found = []
    for version, letter in enumerate(string.ascii_uppercase[:count]):
        problems = [
            (replace(each, version=letter), own[version]) for each, own in zip(file.problems, texts, strict=True)
        ]
        first = version % len(problems)
        found += [*problems[first:], *problems[:first]]
    return found


def _texts(name: str, text: str, count: int) -> list[str]:
    """Return the text of a problem for each version."""
    if "variants" not in parse(text, name):
        return [text] * count
    try:
        found = Variants(text, count, where=name, folder=Path(name).parent, profile="strict", in_process=True)
        return [each.untitled for each in found]
    except SymobsError as error:
        error.where = f"{name}, {error.where}" if error.where else name
        raise


# -- the key ----------------------------------------------------------------------------------------------------------


def steps_of(problem: Problem, results: Sequence[Result], points: Sequence[Fraction], language: Language) -> Columns:
    """Return a table of the steps of a problem, its parts and milestones, and the points of each.

    `points` are those of the sheet, one value or one for each task; without them those of the marking scheme count.
    """
    words = sheet_words(language)
    steps = [*_steps(problem, tuple(results), points, words)]
    steps.append(((words["total"],), sum((worth for _, worth in steps), Fraction(0))))
    rows = ((step, (language.decimal(decimal_of(worth)),)) for step, worth in steps)
    heads = ((words["step"],), (words["points_row"],))
    return Columns(heads, tuple(tuple((Paragraph(cell),) for cell in row) for row in rows))


def _steps(
    problem: Problem, results: tuple[Result, ...], points: Sequence[Fraction], words: dict[str, str]
) -> Iterator[tuple[tuple[Inline, ...], Fraction]]:
    """Yield what each step is, and its points."""
    checked, marking = Checked(problem, results), problem.marking
    asked = checked.asked(checked.views())
    weights = [marking.parts.get(f"{view.task}.{name}", Fraction(1)) for view, name in asked]
    on_the_way = sum((each.points for each in marking.milestones), Fraction(0))
    scheme = marking.total or sum(weights, Fraction(0)) + on_the_way
    total = sum(points, Fraction(0)) or scheme
    scale = total / scheme
    tasks = [result.task for result in results]
    by_task = dict(zip(tasks, points, strict=True)) if len(points) == len(tasks) > 1 else {}
    for (view, name), weight in zip(asked, weights, strict=True):
        alike = [w for (other, _), w in zip(asked, weights, strict=True) if not by_task or other.task == view.task]
        whole = by_task.get(view.task, total) * (1 - on_the_way * scale / total)
        part = f"({string.ascii_lowercase[tasks.index(view.task)]}) " if len(tasks) > 1 else ""
        letter = view.result.letters.get(name)
        named: Inline = (
            formula_named(letter) if letter else words["verdict"] if name == "verdict" else name.replace("_", " ")
        )
        yield (part, named) if part else (named,), whole * weight / sum(alike) if weight else Fraction(0)
    for each in marking.milestones:
        try:
            relation: Inline = read_relation(each.relation)
        except ValueError:  # it is no formula of a page
            relation = each.relation
        yield (relation,), each.points * scale
