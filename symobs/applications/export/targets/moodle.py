r"""Moodle XML: cloze questions whose gaps are numbers without a tolerance, for answers of which there is one."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from symobs.applications.export.questions import instruction, label, matrix_text, plain, question_html, solution_html
from symobs.applications.export.targets.shared import refuse, terminating, unique_number
from symobs.formula.phrases import PHRASES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.applications.export.targets.shared import Files

_WORDS = ("yes", "no", "conditional")


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return the quiz: a category for each question, and a cloze question for each of its variants."""
    refuse(exercises, lambda _, part: unique_number(part))
    questions = []
    for each in exercises:
        questions.append(category(each))
        questions += [_question(exercise) for exercise in each.variants]
    return {"": quiz(questions)}


def quiz(questions: Sequence[str]) -> str:
    """Return a quiz in Moodle's XML."""
    body = "\n".join(questions)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<quiz>\n{body}\n</quiz>\n'


def category(each: ExerciseSet) -> str:
    """Return the category of a question and its variants; a slash in its name is written twice."""
    name = xml_text(each.title.replace("/", "//"))
    return f'<question type="category"><category><text>$course$/symobs/{name}</text></category></question>'


def xml_text(text: str) -> str:
    """Return text for an element."""
    return escape(plain(text), quote=False)


def cdata(html: str) -> str:
    """Return HTML as character data that nothing in it ends."""
    return f"<text><![CDATA[{html.replace(']]>', ']]]]><![CDATA[>')}]]></text>"


def _question(exercise: Exercise) -> str:
    body = "\n".join([question_html(exercise), *map(_input, exercise.parts)])
    solution = "\n".join(
        f"<p>{PHRASES['export_right']}: {label(part)} = <code>{escape(matrix_text(part))}</code></p>"
        for part in exercise.parts
    )
    solution += f"\n{solution_html(exercise)}"
    return f"""<question type="cloze">
<name><text>{xml_text(exercise.title)}</text></name>
<questiontext format="html">{cdata(body)}</questiontext>
<generalfeedback format="html">{cdata(solution)}</generalfeedback>
<penalty>0</penalty>
<hidden>0</hidden>
<idnumber>{exercise.identifier}</idnumber>
<tags><tag><text>symobs</text></tag></tags>
</question>"""


def _input(part: ExportedPart) -> str:
    """Return the gaps of a part: a table of numbers, or a choice of words."""
    if part.kind == "word":
        right = part.data["right"]
        choices = "~".join(f"{'=' * (word == right)}{word}" for word in _WORDS)
        return f"<p>{label(part)}: {{1:MULTICHOICE:{choices}}}</p>"
    rows = part.numbers
    assert rows is not None  # noqa: S101 - others are refused
    gaps = [[f"{{1:NUMERICAL:={terminating(entry)}:0}}" for entry in row] for row in rows]
    said = f"<p>{escape(instruction(part, 'export_decimals'))}</p>"
    if part.shape == (1, 1):
        return f"{said}\n<p>{label(part)} = {gaps[0][0]}</p>"
    head = "".join(f'<th scope="col">{j + 1}</th>' for j in range(part.shape[1]))
    body = "".join(
        f'<tr><th scope="row">{i + 1}</th>{"".join(f"<td>{gap}</td>" for gap in row)}</tr>'
        for i, row in enumerate(gaps)
    )
    return f"{said}\n<table><caption>{label(part)}</caption><tr><td></td>{head}</tr>{body}</table>"
