"""The learning platforms by name, and what each is given: a folder, or one file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.applications.export.targets import moodle, notebook, prairielearn, qti, rexams, stack
from symobs.applications.export.targets.shared import refuse
from symobs.formula.expression.source import shown
from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.export.questions import ExerciseSet
    from symobs.applications.export.targets.shared import Files

#: What writes the files of a platform.
PLATFORMS = {
    "prairielearn": prairielearn.files,
    "stack": stack.files,
    "moodle": moodle.files,
    "rexams": rexams.files,
    "qti": qti.files,
    "qti21": qti.files_of_2_1,
    "ipynb": notebook.files,
}
#: What other graders than Maxima do not compare, and the repair.
_ROOTS = "these are roots, and an exported grader computes with fractions alone", "export to stack"
#: The platforms that are given a folder; the others one file, whose name is "".
FOLDERS = ("prairielearn", "rexams", "ipynb")


def export(platform: str, exercises: Sequence[ExerciseSet]) -> Files:
    """Return the files of questions for a platform; raises `ProblemErrors` with every part that it cannot hold."""
    if platform not in PLATFORMS:
        raise UsageError(f"{shown(platform, 40)!r} is no platform", where="--to", repair=f"take {', '.join(PLATFORMS)}")
    if platform != "stack":
        refuse(exercises, lambda _, part: _ROOTS if part.data.get("roots") else None)
    return PLATFORMS[platform](exercises)
