"""Answers to exported questions, and what `check` says of them."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from symobs.applications.export import exercises
from tests.support.paths import ROOT

if TYPE_CHECKING:
    import random

    from symobs.applications.export import Exercise, ExerciseSet
    from symobs.applications.export.questions import ExportedPart

    Given = dict[str, list[list[str]]]

EXAMPLES = ROOT / "worked_examples"
#: Worked examples that the platforms with claims can hold.
HELD = (
    "servo_observer",
    "third_order_observer",
    "triple_pole_two_outputs",
    "double_integrator_output_feedback",
    "output_feedback_servo",
    "third_order_matching",
    "two_inputs_feedback",
    "tanks_observer",
    "third_order_plant",
    "servo_observer_feedthrough",
    "detectable",
    "tanks_observer_parametric",
)
#: Problems whose marks and signs are less usual: asked zeros, the other signs, a square gain, feedthrough.
BY_HAND = {
    "zeros": (
        'task = "observer"\n[plant]\nA = "[0 1 0; 0 0 1; 1 2 3]"\nC = "[1 0 0; 0 0 1]"\n'
        '[specification]\npoles = "-1, -1, -1"\nzero = ["1,1"]\n'
    ),
    "other signs": (
        'task = "compensator"\nconvention = "u = K x_hat, A + M C"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
        '[specification]\ncontrol_poles = "-2, -3"\nobserver_poles = "-10, -11"\n'
    ),
    "either sign": (
        'task = "compensator"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\nD = "[2]"\n'
        '[specification]\ncontrol_poles = "-2, -3"\nobserver_poles = "-10, -11"\n'
        '[marking]\nsign_of_F = "either"\nguard = false\nfollow_through = "1/2"\nparts = { "compensator.F" = 3 }\n'
    ),
    "square": (
        'task = "state_feedback"\n[plant]\nA = "[0 1; 2 3]"\nB = "[1 0; 0 1]"\nC = "[1 0]"\n[specification]\npoles = "-2, -3"\n'
    ),
}
_UNREADABLE = ("x", "1..2", "2 3", "1/2 3", "3/0", "(1", "1 +", "__import__('os')")


def held(name: str) -> ExerciseSet:
    """A worked example, or a problem by hand, as a question."""
    if name not in BY_HAND:
        (found,) = exercises([str(EXAMPLES / f"{name}.toml")])
        return found
    with TemporaryDirectory() as folder:
        path = Path(folder) / "problem.toml"
        path.write_text(BY_HAND[name], "utf-8")
        (found,) = exercises([str(path)])
        return found


def right(part: ExportedPart) -> list[list[str]]:
    """The right value, row by row."""
    return [[str(entry) for entry in row] for row in part.right]


def random_answer(exercise: Exercise, draw: random.Random, *, exact: bool = False) -> Given:
    """An answer: right, another, or with a slip; `exact` leaves out decimals and what cannot be read."""
    given: Given = {}
    for part in exercise.parts:
        rows = right(part)
        if part.kind == "word":
            rows = [[draw.choice(["yes", "no", "conditional"])]]
        elif draw.random() < 0.65:
            rows = _changed(rows, draw, exact=exact)
        given[part.name] = rows
    return given


def _changed(rows: list[list[str]], draw: random.Random, *, exact: bool) -> list[list[str]]:
    rows = [list(row) for row in rows]
    i, j = draw.randrange(len(rows)), draw.randrange(len(rows[0]))
    match draw.randrange(6 if exact else 8):
        case 0:
            rows[i][j] = f"({rows[i][j]})+({draw.choice(['1', '-1', '1/2', '3'])})"
        case 1:
            return [[f"-({cell})" for cell in row] for row in rows]
        case 2:
            return [[f"({cell})*2" for cell in row] for row in rows]
        case 3:
            return [list(row) for row in zip(*rows, strict=True)] if len(rows) == len(rows[0]) else rows
        case 4:
            return [[str(draw.randrange(-9, 10)) for _ in row] for row in rows]
        case 5:
            return [["0" for _ in row] for row in rows]
        case 6:
            if all(re.fullmatch(r"-?[0-9/]+", cell) for row in rows for cell in row):
                return [[f"{float(Fraction(cell)):.2f}" for cell in row] for row in rows]
            rows[i][j] = rows[i][j].replace("-", "\N{MINUS SIGN}")
        case 7:
            rows[i][j] = draw.choice(_UNREADABLE)
    return rows


def checked(exercise: Exercise, given: Given) -> dict[str, tuple[str, Fraction | None]]:
    """What `check` says of an answer: verdict and credit of each part; a platform leaves no marks open for a reader."""
    answer: dict[str, dict[str, Any]] = {}
    for part in exercise.parts:
        if part.name in given:
            rows = given[part.name]
            is_text = part.kind == "word" or (part.shape == (1, 1) and part.kind != "gain")
            answer.setdefault(part.part.partition(".")[0], {})[part.letter] = rows[0][0] if is_text else rows
    report = exercise.checked.report(answer)
    names = {part.part: part.name for part in exercise.parts}
    open_marks = {"unreadable": Fraction(0)}
    return {
        names[part.part]: (part.verdict, open_marks.get(part.verdict, part.credit))
        for part in report.parts
        if part.part in names
    }
