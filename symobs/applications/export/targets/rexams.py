"""R/exams: one R Markdown file a variant, without any R in it, and a script that makes quizzes of them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from symobs.applications.export.questions import (
    instruction,
    label,
    matrix_text,
    plain,
    question_markdown,
    solution_markdown,
)
from symobs.applications.export.targets.shared import refuse, terminating, unique_number
from symobs.formula.phrases import PHRASES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.applications.export.targets.shared import Files

_WORDS = ("yes", "no", "conditional")
#: What R/exams would take for a line of meta-information.
_META = re.compile(r"\b(ex[a-z]+):")
_SCRIPT = """library("exams")
files <- list({lists})
set.seed(1)
exams2moodle(files, n = 1, name = "quiz")
# exams2qti21(files, n = 1, name = "quiz")
# exams2pdf(files, n = 1, name = "quiz")
"""
_README = """# R/exams

Each file is one variant. `exams.R` draws one variant of each question for every copy; for all variants of a question give its
files one by one: R/exams draws with replacement. Numbers are compared without a tolerance. Canvas takes single choice alone
in cloze questions, so use Moodle or QTI.
"""


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return a file a variant, the script and a note."""
    refuse(exercises, lambda _, part: unique_number(part))
    found: Files = {}
    lists = []
    for each in exercises:
        names = [f"{each.name}_v{number:03d}.Rmd" for number in range(1, len(each.variants) + 1)]
        found |= {name: _file(exercise, name[:-4]) for name, exercise in zip(names, each.variants, strict=True)}
        quoted = ", ".join(f'"{name}"' for name in names)
        lists.append(f"c({quoted})")
    return {**found, "exams.R": _SCRIPT.format(lists=", ".join(lists)), "README.md": _README}


def _file(exercise: Exercise, name: str) -> str:
    """Return one variant: question, solution and meta-information."""
    gaps = [gap for part in exercise.parts for gap in _gaps(part)]
    said = [f"{label(part, '$', '$')}: {_instruction(part)}" for part in exercise.parts]
    right = [f"{label(part, '$', '$')} = {matrix_text(part)}" for part in exercise.parts]
    meta = {
        "exname": name,
        "extitle": plain(exercise.title).replace("`", "\N{LEFT SINGLE QUOTATION MARK}"),
        "extype": "cloze",
        "exsolution": "|".join(solution for _, solution, _ in gaps),
        "exclozetype": "|".join(kind for kind, _, _ in gaps),
        "extol": "0",
        "expoints": "|".join("1" for _ in gaps),
        "exsection": f"symobs/{exercise.topic}",
    }
    lines = [
        "Question\n========",
        _kept_from_r("\n\n".join([question_markdown(exercise), *said])),
        "Answerlist\n----------",
        "\n".join(f"* {text}" for _, _, texts in gaps for text in texts),
        "Solution\n========",
        _kept_from_r(f"{PHRASES['export_right']}: {'; '.join(right)}.\n\n{solution_markdown(exercise)}"),
        "Meta-information\n================",
        "\n".join(f"{key}: {value}" for key, value in meta.items()),
    ]
    return "\n\n".join(lines) + "\n"


def _instruction(part: ExportedPart) -> str:
    return instruction(part, "export_decimals")


def _kept_from_r(text: str) -> str:
    """Return text without what knitr would execute, or R/exams take for meta-information."""
    text = text.replace(r"\cr ", r"\\ ")  # which the conversion to QTI does not know
    return _META.sub(r"\1&#58;", text.replace(r"\`", "`").replace("`", "&#96;"))


def _gaps(part: ExportedPart) -> list[tuple[str, str, list[str]]]:
    """Return the gaps of a part: kind, solution, and what stands at them."""
    if part.kind == "word":
        return [("schoice", "".join(str(int(word == part.data["right"])) for word in _WORDS), list(_WORDS))]
    assert part.numbers is not None  # noqa: S101 - others are refused
    letter = label(part, "$", "$")
    alone = part.shape == (1, 1)
    return [
        ("num", str(terminating(entry)), [letter if alone else f"{letter} ({i + 1}, {j + 1})"])
        for i, row in enumerate(part.numbers)
        for j, entry in enumerate(row)
    ]
