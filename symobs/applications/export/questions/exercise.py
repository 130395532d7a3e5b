"""Problems as questions: read, solved, and with what decides about each part; many of one kind are variants of a question."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.checking import Checked
from symobs.applications.checking.marking_check import known_parts, marking_errors, part_of_name
from symobs.applications.export.questions.parts import SLIPS, ExportedPart, exported_part
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError, reason_of
from symobs.problem import MAX_BYTES, Problem, read

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

#: So many problems make one export.
MOST_PROBLEMS = 1000
#: The file of a folder of variants that names them.
MANIFEST = "manifest.json"


@dataclass(frozen=True)
class Exercise:
    """A problem as a question: `question` is what its grader knows, `identifier` the beginning of the hash of its file."""

    problem: Problem
    checked: Checked
    identifier: str
    parts: tuple[ExportedPart, ...]
    question: dict[str, Any]
    problem_text: str = ""

    @property
    def title(self) -> str:
        """The title on one line."""
        return " ".join(self.problem.title.split())[:200] or "symobs"

    @property
    def structure(self) -> str:
        """What the inputs of a question look like: variants of one question have the same."""
        asked = [(part.name, part.part, part.kind, part.shape, part.is_function) for part in self.parts]
        return json.dumps([asked, self.question["names"], self.question["marks"]])

    @property
    def topic(self) -> str:
        """The task, for the categories of a platform."""
        return self.parts[0].part.partition(".")[0].replace("_", " ")


@dataclass(frozen=True)
class ExerciseSet:
    """Variants of one question: inputs and marks are the same in all of them."""

    variants: tuple[Exercise, ...]

    @property
    def first(self) -> Exercise:
        """The variant whose title and inputs are those of the question."""
        return self.variants[0]

    @property
    def identifier(self) -> str:
        """Of one problem its own; of several, the hash of theirs."""
        if len(self.variants) == 1:
            return self.first.identifier
        return _hash(" ".join(each.identifier for each in self.variants))

    @property
    def name(self) -> str:
        """A name for files and folders: letters, digits and `_` of the title, and the identifier."""
        plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in self.first.title.lower())
        words = "_".join(filter(None, plain.split("_")))[:40].strip("_")
        return f"{words or 'question'}_{self.identifier}"


def exercises(
    sources: Sequence[str],
    asked: Sequence[str] = (),
    points: Fraction | None = None,
    report: Callable[[str], None] | None = None,
) -> tuple[ExerciseSet, ...]:
    """Return the questions of problem files and folders; raises `ProblemErrors` with all that is wrong in any of them."""
    found: list[tuple[str, Exercise]] = []
    errors: list[SymobsError] = []
    paths = problem_files(sources)
    for number, (path, is_variant) in enumerate(paths, 1):
        if report is not None:
            report(f"{number}/{len(paths)} {path.stem}")
        try:
            exercise = _exercise(path, asked, points)
        except InputError as error:
            errors += _named(error, path, several=len(paths) > 1)
            continue
        found.append((exercise.structure if is_variant else exercise.structure + exercise.title, exercise))
    if errors:
        raise ProblemErrors(tuple(errors))
    return tuple(
        ExerciseSet(tuple(exercise for key, exercise in found if key == kind))
        for kind in dict.fromkeys(k for k, _ in found)
    )


def _named(error: InputError, path: Path, *, several: bool) -> list[SymobsError]:
    """Return errors with the file they are in, where there are several."""
    errors = error.errors if isinstance(error, ProblemErrors) else (error,)
    if not several:
        return list(errors)
    return [
        InputError(each.message, where=f"{path.name}, {each.where}".rstrip(", "), repair=each.repair) for each in errors
    ]


# -- files ------------------------------------------------------------------------------------------------------------


def problem_files(sources: Sequence[str]) -> list[tuple[Path, bool]]:
    """Return the files of sources in order, each with whether it is one of the variants of a manifest."""
    found: list[tuple[Path, bool]] = []
    for source in sources:
        path = Path(source)
        if path.name == MANIFEST:
            path = path.parent
        if not path.is_dir():
            found.append((path, False))
            continue
        is_variant = (path / MANIFEST).is_file()
        folder = path / "variants" if is_variant and (path / "variants").is_dir() else path
        files = sorted(each for each in folder.iterdir() if each.suffix in {".toml", ".json"} and each.name != MANIFEST)
        files = [each for each in files if each.name != "sheet.toml"] if is_variant else files
        if not files:
            message = "there is no problem file in this folder"
            raise InputError(message, where=shown(source, 200), repair="name a folder with files *.toml")
        found += [(each, is_variant) for each in files]
    if len(found) > MOST_PROBLEMS:
        message = f"{len(found)} problems, more than {MOST_PROBLEMS}"
        raise InputError(message, where="SOURCE", repair="export them in several runs")
    return found


def _text(path: Path) -> str:
    try:
        with path.open("rb") as stream:
            raw = stream.read(MAX_BYTES + 1)
        return raw.decode("utf-8-sig")
    except (OSError, ValueError) as error:
        repair = "give the path of a problem file, or of a folder of them"
        raise InputError(reason_of(error), where=shown(str(path), 200), repair=repair) from None


# -- one problem ------------------------------------------------------------------------------------------------------


def _exercise(path: Path, asked: Sequence[str], points: Fraction | None) -> Exercise:
    """Return a problem as a question."""
    text = _text(path)
    problem = read(text, shown(str(path), 200), path.parent)
    marking = problem.marking
    marking = replace(marking, asked=tuple(asked) or marking.asked, total=points or marking.total)
    problem = replace(problem, marking=marking)
    checked = Checked(problem, problem.solve())
    views = checked.views()
    for part in asked:
        if part_of_name(part, views) is None:
            raise UsageError(f"there is no {shown(part, 60)}", where="--asked", repair=known_parts(part, views))
    errors = [*_unheld(problem), *marking_errors(replace(problem, marking=replace(marking, milestones=())), views)]
    parts: list[ExportedPart] = []
    wanted = checked.asked(views)
    letters = Counter(field for _, field in wanted)
    for view, field in wanted:
        letter = next((own for own, (standard, _) in view.names.items() if standard == field), field)
        name = letter if letters[field] == 1 else f"{view.task}_{letter}"
        weight = marking.parts.get(f"{view.task}.{field}", Fraction(1))
        try:
            parts.append(exported_part(view, field, name, str(weight)))
        except InputError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    declared = problem.plant.symbols.names or {}
    marks = {
        "credit": {name: str(value) for name, value in sorted(marking.credit.items()) if name in SLIPS},
        "follow_through": str(marking.follow_through),
        "guard": marking.guard,
        "decimals": marking.decimals,
        "sign_of_F": marking.sign_of_F,
    }
    question = {"names": sorted(declared), "marks": marks, "parts": [dict(part.data) for part in parts]}
    return Exercise(problem, checked, _hash(text), tuple(parts), question, text)


def _unheld(problem: Problem) -> list[SymobsError]:
    """Return what of the marks no exported grader holds."""
    errors: list[SymobsError] = []
    if problem.marking.milestones:
        message = "lines of a derivation are marked, and an exported question takes values alone"
        errors.append(InputError(message, where="marking.milestone", repair="leave the milestones out"))
    for slip, credit in problem.marking.credit.items():
        if credit and slip not in SLIPS and slip != "boundary":
            message = f"an exported grader does not find the slip {shown(slip, 40)}"
            errors.append(
                InputError(message, where=f"marking.credit.{shown(slip, 40)}", repair=f"known: {', '.join(SLIPS)}")
            )
    return errors


def total_of(exercise: Exercise) -> Fraction:
    """Return the marks of an answer that is right."""
    total = exercise.problem.marking.total
    return sum((Fraction(part.data["weight"]) for part in exercise.parts), Fraction(0)) if total is None else total


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]
