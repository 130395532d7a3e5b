"""Jupyter notebooks for nbgrader: what is handed in is held against the problem by `symobs.check`."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

from symobs.applications.export.questions import instruction, label, matrix_text, plain, question_markdown, total_of
from symobs.applications.export.targets.shared import as_json, refuse
from symobs.formula.phrases import PHRASES
from symobs.ground.errors import InputError
from symobs.pages.formats.markdown import plain as markdown_text
from symobs.problem import read

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions import Exercise, ExerciseSet, ExportedPart
    from symobs.applications.export.targets.shared import Files

#: Marks the answers in a process of its own: what the notebook has done to its own modules does not count there.
_MARKING = """import json
import sys
from dataclasses import replace

import symobs
from symobs.problem import read

given = json.load(sys.stdin)
problem = read(given["problem"])
problem = replace(problem, marking=replace(problem.marking, asked=tuple(given["asked"])))
marks, answer = 0.0, given["answer"]
try:
    report = symobs.check(problem, answer) if answer else None
    print(report.to_text() if report else "nothing is assigned")
    if report:
        marks = None if report.score is None else float(report.score / report.total * given["points"])
    print(*(result.to("text") for result in problem.solve()), sep="\\n")
except symobs.SymobsError as error:
    print(error)
print(json.dumps(marks))
"""
_TEST = """### BEGIN HIDDEN TESTS
import sys

for name in ("json", "subprocess"):
    sys.modules.pop(name, None)
import json
import subprocess


def plain(value):
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return value if isinstance(value, (str, int, float)) else str(value)


given = {{"problem": {text}, "asked": {asked}, "points": {points}, "answer": {{}}}}
found = {{part: globals().get(name) for part, name in {names}.items()}}
for part, value in found.items():
    if value is not None and not (isinstance(value, str) and not value.strip()):
        task, _, field = part.partition(".")
        given["answer"].setdefault(task, {{}})[field] = plain(value)
marking = {marking}
run = subprocess.run(
    [sys.executable, "-P", "-c", marking], input=json.dumps(given), capture_output=True, text=True, timeout=600
)
if run.returncode:
    raise RuntimeError(run.stderr)
said, _, marks = run.stdout.rstrip().rpartition("\\n")
print(said)
missing = [name for part, name in {names}.items() if found[part] is None]
if missing:
    print("missing:", ", ".join(missing))
if json.loads(marks) is None:
    raise RuntimeError("undecided: this answer is to be marked by hand")
json.loads(marks)
### END HIDDEN TESTS"""


def files(exercises: Sequence[ExerciseSet]) -> Files:
    """Return one notebook a variant."""
    refuse(exercises, _why)
    found: Files = {}
    for each in exercises:
        for number, exercise in enumerate(each.variants, 1):
            name = each.name if len(each.variants) == 1 else f"{each.name}_v{number:03d}"
            found[f"{name}.ipynb"] = as_json(_notebook(exercise))
    return found


def _why(exercise: Exercise, _: ExportedPart) -> tuple[str, str] | None:
    """Return why a notebook cannot hold a problem: its text must say everything."""
    try:
        read(exercise.problem_text)
    except InputError:
        return "the problem needs a file beside it", "name a built-in convention"
    return None


def _notebook(exercise: Exercise) -> dict[str, Any]:
    names = {part.part.partition(".")[0] + "." + part.letter: part.name for part in exercise.parts}
    examples = [f'{part.name} = "{matrix_text(part)}"' for part in exercise.parts]
    title = markdown_text(plain(exercise.title))
    said = [f"- {label(part, '$', '$')} (`{part.name}`): {instruction(part)}" for part in exercise.parts]
    listed = ", ".join(f"`{part.name}`" for part in exercise.parts)
    said.append("\n" + PHRASES["export_in_python"].format(names=listed, example='`X = "[1 2; 3 4]"`'))
    question = "\n\n".join([f"# {title}", question_markdown(exercise), "\n".join(said)])
    solution = "\n".join(["### BEGIN SOLUTION", *examples, "### END SOLUTION"])
    test = _TEST.format(
        text=_literal(exercise.problem_text),
        asked=repr([part.part for part in exercise.parts]),
        names=repr(names),
        marking=_literal(_MARKING),
        points=repr(float(total_of(exercise))),
    )
    identifier = exercise.identifier
    cells = [
        _cell("markdown", question, _graded(f"question-{identifier}", locked=True)),
        _cell("code", solution, _graded(f"answer-{identifier}", solution=True)),
        _cell("code", test, _graded(f"test-{identifier}", locked=True, points=float(total_of(exercise)))),
    ]
    for number, cell in enumerate(cells):
        text = f"{number}\n{cell['source']}"
        cell["id"] = hashlib.sha256(text.encode()).hexdigest()[:8]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {
        "cells": cells,
        "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }


def _cell(kind: str, source: str, graded: dict[str, Any]) -> dict[str, Any]:
    cell: dict[str, Any] = {"cell_type": kind, "metadata": {"nbgrader": graded}, "source": source}
    return cell | ({"execution_count": None, "outputs": []} if kind == "code" else {})


def _graded(
    identifier: str, *, locked: bool = False, solution: bool = False, points: float | None = None
) -> dict[str, Any]:
    """Return what nbgrader knows of a cell."""
    found = {
        "schema_version": 3,
        "grade_id": identifier,
        "grade": points is not None,
        "locked": locked,
        "solution": solution,
        "task": False,
    }
    return found if points is None else found | {"points": points}


def _literal(text: str) -> str:
    """Return a text as a literal of Python in ASCII, without the words by which nbgrader finds solutions and tests."""
    return ascii(text).replace("HIDDEN TESTS", "HIDDEN\\x20TESTS").replace("SOLUTION", "\\x53OLUTION")
