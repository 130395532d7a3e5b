"""The check of an answer: read, judged by the claims of the results, marked, and bounded by what may be shown."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.audit.auditor import printed_entries
from symobs.applications.checking.answers import (
    EXAMPLE,
    MAX_BYTES,
    Answer,
    bare_value,
    is_of_tables,
    plain,
    read_answer,
    states,
    written_text,
)
from symobs.applications.checking.derivations import is_of_conditions, judge_lines, judge_milestone
from symobs.applications.checking.faults import Explained, explain_gain, explain_value, other_values
from symobs.applications.checking.folders import text_of_answer, text_of_path
from symobs.applications.checking.handwriting import entries_of, fields_of, law_of, listed_of, with_own_letters
from symobs.applications.checking.judgement import judge_task, rounds
from symobs.applications.checking.motion_lines import without_motion
from symobs.applications.checking.parts import OF_THE_PLANT, asked_of, exists, field_called, known_names, part_of_task
from symobs.applications.checking.points import Reader
from symobs.applications.checking.regions import read_conditions
from symobs.applications.checking.report import SHOW, TO_BE_READ, CheckReport, Line, Part
from symobs.exact import Factored, Matrix, Scalar
from symobs.formula.convention import Convention, convention_named
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError
from symobs.problem import Problem, is_text, read, text_of
from symobs.problem.expect import available, factored_table, found_in, names_of, shown_value
from symobs.problem.file_tables import Errors
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.result import Result
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from symobs.applications.checking.judgement import Judged, TaskJudgement
    from symobs.problem.fields import Marking


# What an answer may hold: an empty answer file, with the shape of everything that is asked for.


def answer_file(checked: Checked, convention: Convention | None = None) -> str:
    """Return an empty answer file: one line for each part that counts, with its shape, none of them filled in."""
    views = checked.views(convention)
    name = (convention or checked.problem.convention).name
    lines = ['student    = ""', f'convention = "{name}"', ""]
    asked = checked.asked(views)
    fields = [field for _, field in asked]
    for view in dict.fromkeys(view.task for view, _ in asked):
        alone = all(fields.count(field) == 1 for each, field in asked if each.task == view)
        lines.append("[answer]" if alone and len(views) == 1 else f"[answer.{view}]")
        for each, field in asked:
            if each.task == view:
                letter = each.letter_of(field)
                weight = checked.problem.marking.parts.get(f"{view}.{field}")
                marks = f", weight {weight}" if weight is not None else ""
                lines.append(f'# {letter} = ""    # {_shape(each.result.fields.get(field), field)}{marks}')
        lines.append("")
    lines += ["# [[step]]", '# relation = ""   # a line of the derivation, in order', ""]
    return "\n".join(lines)


def example_of(view: ResultInConvention, field: str) -> str:
    """Return a line of the form that a part has, and not with its value."""
    letter, right, variable = view.letter_of(field), view.result.fields.get(field), view.argument
    value = _exact(right)
    for first in (1, 2):  # one of them is not the solution
        if isinstance(value, Matrix):
            rows, columns = value.shape
            entries = [[str(first + i * columns + j) for j in range(columns)] for i in range(rows)]
            made, text = Matrix.of([[int(e) for e in row] for row in entries]), "; ".join(map(" ".join, entries))
            if made != value:
                return f"{letter} = [{text}]"
        elif isinstance(value, Scalar):
            text = f"({variable} + {first})^2" if variable in value.names else str(first)
            if str(value) != text:
                return f"{letter} = {text}"
    if (view.task, field) == ("equilibria", "points"):
        return Reader(view).example
    if field == "stable_if":
        return (
            "1 < h and h < 2" if not (names := getattr(view.result.question, "parameters", ())) else f"{names[0]} > 1"
        )
    if isinstance(right, (list, tuple)):
        return f"{letter} = 1, 2"
    return f"{letter} = yes"


def _shape(right: Any, field: str) -> str:
    """Return what is expected, without a word on its value."""
    table = factored_table(right)
    matrix = right if isinstance(right, Matrix) else table
    if isinstance(matrix, Matrix):
        return f"a {matrix.shape[0]}x{matrix.shape[1]} matrix"
    if isinstance(right, (Scalar, Factored)):
        return "an expression"
    if isinstance(right, int) and not isinstance(right, bool):
        return "an integer"
    if field == "verdict":
        return "yes, no or conditional"
    if field == "stable_if":
        return "conditions: h1 > 3 and h2 > 0"
    if field == "points":
        return "all points, (x1, x2) = (1, 1), (2, 2)"
    return "a list" if isinstance(right, (list, tuple)) else "a value"


# From verdicts to parts with their credit, and why those that are wrong are so.


def part_of(
    view: ResultInConvention, judgement: TaskJudgement, judged: Judged, marking: Marking, *, counts: bool
) -> Part:
    """Return a part with its credit, its slip, and the right value, which the report may not show."""
    name = f"{view.task}.{judged.name}"
    weight = marking.parts.get(name, Fraction(1)) if counts else Fraction(0)
    right = _right(view, judgement.right if judged.there is None else judged.there, judged.letter)
    own, read = written_text(judged.own), reading_of(view, judged)
    part = Part(name, judged.letter, judged.verdict, weight, Fraction(0), own, hints=judged.hints, read=read)
    part = replace(part, right=right, reason=judged.reason)
    if judged.verdict in TO_BE_READ:
        return replace(part, credit=None)
    match judged.verdict:
        case "right":
            return replace(part, credit=Fraction(1), effect=_effect(view, judgement, judged))
        case "follows":
            origins = tuple(f"{view.task}.{origin}" for origin in judged.origins)
            return _followed(replace(part, origins=origins), judgement, judged, marking)
        case "wrong":
            return _explained(part, view, judgement, judged, marking)
    return part


def reading_of(view: ResultInConvention, judged: Judged) -> str:
    """Return how a value was read: K = [10 32], one row; of what cannot be read how far that was."""
    value, letter = judged.value, judged.letter
    if judged.name in view.result.gains and isinstance(value, Matrix) and view.standard(letter)[1] < 0:
        value = -value
    if not isinstance(value, Matrix):
        return f"{letter} = {written_text(judged.given) if value is None else value}"
    rows, columns = value.shape
    size = "one number" if rows == columns == 1 else "one row" if rows == 1 else "one column" if columns == 1 else ""
    return f"{letter} = {value}, {size or f'{rows} rows and {columns} columns'}"


def missing(view: ResultInConvention, name: str, marking: Marking) -> Part:
    """Return a part that the answer lacks."""
    letter = view.letter_of(name)
    part = f"{view.task}.{name}"
    right = _right(view, view.result, letter)
    return Part(part, letter, "missing", marking.parts.get(part, Fraction(1)), Fraction(0), right=right)


def _right(view: ResultInConvention, result: Result, letter: str) -> str | None:
    try:
        return shown_value(found_in(ResultInConvention(result, view.convention), letter))
    except KeyError:
        return None


# -- what follows -----------------------------------------------------------------------------------------------------


def _followed(part: Part, judgement: TaskJudgement, judged: Judged, marking: Marking) -> Part:
    """Return a part that is right from the student's own earlier one, without credit where that made it easy."""
    if marking.guard and any(_is_degenerate(judgement, name) for name in judged.origins):
        hint = "that makes this part too easy to count"
        return replace(part, credit=Fraction(0), hints=(*part.hints, hint))
    if marking.guard and judged.name == "F" and isinstance(judged.value, (Matrix, Scalar)):
        variable = judgement.right.plant.variable
        if judgement.right.task == "compensator" and variable not in judged.value.names:
            return replace(part, credit=Fraction(0), hints=(*part.hints, "it follows, but F is constant there"))
    return replace(part, credit=marking.follow_through)


def _is_degenerate(judgement: TaskJudgement, name: str) -> bool:
    """Return whether the student's wrong gain makes easy what follows: zero, much emptier than the right one, or a unit."""
    assert judgement.own is not None  # noqa: S101 - something follows from it
    mine, right = judgement.own.fields.get(name), judgement.right.fields.get(name)
    if not isinstance(mine, Matrix) or not isinstance(right, Matrix):
        return False
    filled, wanted = (sum(not entry.is_zero for entry in matrix.entries) for matrix in (mine, right))
    return filled == 0 or 2 * filled < wanted or (filled == 1 < wanted)


# -- what is wrong ----------------------------------------------------------------------------------------------------


def _effect(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> dict[str, str]:
    if judged.name not in view.result.gains:
        return {}
    design = judgement.right.design_of(judged.name)
    return {"polynomial": str(design.answer["polynomial"]), "stable": design.stability.verdict}


def _explained(
    part: Part, view: ResultInConvention, judgement: TaskJudgement, judged: Judged, marking: Marking
) -> Part:
    """Return a part that is wrong with its slip, where one reproduces it."""
    if judged.separation is not None:
        slip, point = judged.separation.slip or None, judged.separation.point
        credit = marking.credit.get(slip or "", Fraction(0))
        place = None if point is None else {name: str(value) for name, value in point.items()}
        return replace(part, slip=slip, place=place, credit=credit)
    found = _explanation(view, judgement, judged)
    reasons = tuple(fault.reason for fault in found.alternatives)
    other = _exchanged(view, judgement, judged)
    slips = [fault.slip for fault in found.alternatives] or [found.slip or ""]
    credit = min(marking.credit.get(slip, Fraction(0)) for slip in slips)
    if marking.by_entry:
        credit = max(credit, _share_of_entries(view, judgement, judged))
    said = other or found.reason or part.reason
    if not said and "polynomial" in found.effect:
        said = f"with your {judged.letter} the polynomial is {found.effect['polynomial']}, not the one asked for"
    if not said and (view.task, judged.name) == ("compensator", "F") and judgement.has_gains:
        said = f"this is not the {judged.letter} of your gains"
    return replace(
        part,
        slip=found.slip,
        place=found.place,
        reason=said,
        alternatives=reasons,
        effect=found.effect,
        credit=credit,
    )


def _share_of_entries(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> Fraction:
    """Return the share of the right entries of a wrong matrix, zeros that are right apart; 0 where many would be right."""
    right = _exact(judgement.right.fields.get(judged.name))
    mine = judged.value
    is_one = judged.name not in view.result.in_coordinates and judgement.right.fields.get("family") is None
    if not is_one or not isinstance(mine, Matrix) or not isinstance(right, Matrix) or mine.shape != right.shape:
        return Fraction(0)
    pairs = [(a, b) for a, b in zip(mine.entries, right.entries, strict=True) if not (a.is_zero and b.is_zero)]
    return Fraction(sum(a == b for a, b in pairs), len(pairs))


def _exchanged(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> str:
    """Return that a matrix is another part, or its transpose, which the student has, or has in its place; empty if not."""
    fields, value = view.result.fields, judged.value
    for other in judgement.parts:
        right, mine = fields.get(other.name), fields.get(judged.name)
        if other is judged or not isinstance(value, Matrix) or not isinstance(right, Matrix) or right == mine:
            continue
        is_exchanged = isinstance(mine, Matrix) and other.value in {mine, mine.T}
        if value in {right, right.T} and not value.is_zero and (other.verdict == "right" or is_exchanged):
            return f"this is {'' if value == right else 'the transpose of '}{other.letter}"
    return ""


def _explanation(view: ResultInConvention, judgement: TaskJudgement, judged: Judged) -> Explained:
    """Return why a value is wrong, as far as it is a matrix or a number."""
    if judged.value is None:
        said = "the values are rounded, and exact ones are asked for"
        return Explained("rounded", said) if judged.rounded else Explained()
    is_part = view.result.gains_are_one
    if is_part and view.standard(judged.letter)[1] < 0:
        return Explained()  # what is said of a value has its standard sign
    if judged.name in view.result.gains and isinstance(judged.value, Matrix) and not is_part:
        design = judgement.right.design_of(judged.name)
        turned = view.standard(judged.letter)[1] < 0
        right = design.answer[design.letter]
        rounded = right is not None and rounds(view, judged, right, names_of(view), None)
        other = other_polynomial(judgement.right, judged.name)
        return explain_gain(design, judged.value, judged.letter, other, turned=turned, rounded=rounded)
    right = _exact((judgement.right if judged.there is None else judged.there).fields.get(judged.name))
    value = judged.value
    if right is None:
        return Explained()
    if judged.name in view.result.in_coordinates and view.task != "reduced_order_observer":
        return _without_coordinates(value, right, judged.letter) if isinstance(right, Matrix) else Explained()
    if isinstance(right, Scalar) and isinstance(value, Matrix) and value.shape == (1, 1):
        value = value[0, 0]
    variable = view.argument
    in_loop = (view.task, judged.name) == ("compensator", "F")
    others = other_values(judgement.right) if in_loop else []
    return explain_value(value, right, judged.letter, variable, others, rounded=judged.rounded, in_loop=in_loop)


def _without_coordinates(value: Matrix | Scalar, right: Matrix, letter: str) -> Explained:
    """Return why a matrix is wrong in any coordinates: its size, or that it has no inverse."""
    rows, columns = value.shape if isinstance(value, Matrix) else (1, 1)
    if (rows, columns) != right.shape:
        sizes = f"{right.shape[0]}x{right.shape[1]} here, yours is {rows}x{columns}"
        return Explained(None, f"{letter} is {sizes}")
    if letter == "T" and isinstance(value, Matrix) and value.determinant().is_zero:
        return Explained(None, f"{letter} has no inverse")
    return Explained()


def _exact(right: Any) -> Matrix | Scalar | None:
    table = factored_table(right)
    if table is not None:
        return table
    if isinstance(right, Factored):
        return right.value
    if isinstance(right, int) and not isinstance(right, bool):
        return Scalar.of(right)
    return right if isinstance(right, (Matrix, Scalar)) else None


def other_polynomial(result: Result, name: str) -> Scalar | None:
    """Return the polynomial of the other half of a compensator, where it has the same degree."""
    loop = result if isinstance(result, OutputFeedback) else getattr(result, "loop", None)
    if not isinstance(loop, OutputFeedback) or loop.estimator is None:
        return None
    own, other = loop.design_of(name), loop.design_of("L" if name == "K" else "K")
    phi, second = own.answer["polynomial"], other.answer["polynomial"]
    variable = result.plant.variable
    return second if second != phi and second.degree(variable) == phi.degree(variable) else None


# What `[marking]` names, held against the results: parts that exist, and relations that can be read and are true.


def marking_errors(problem: Problem, views: Sequence[ResultInConvention]) -> list[SymobsError]:
    """Return what in the weights and the milestones of a problem would never count."""
    return [*_unknown_weights(problem, views), *_unmet_milestones(problem, views)]


def part_of_name(part: str, views: Sequence[ResultInConvention]) -> tuple[ResultInConvention, str] | None:
    """Return the result of `task.field` and its standard name, None where there is no such part."""
    task, _, letter = part.partition(".")
    view = next((view for view in views if view.task == task), None)
    name = view.standard(letter)[0] if view is not None else letter
    return None if view is None or not exists(view.result, name) else (view, name)


def known_parts(part: str, views: Sequence[ResultInConvention]) -> str:
    """Return what to write for a part that does not exist."""
    return meant(part, [f"{each.task}.{field}" for each in views for field in available(each) if _has(each, field)])


def _has(view: ResultInConvention, letter: str) -> bool:
    return exists(view.result, view.standard(letter)[0])


def meant(name: str, known: Collection[str]) -> str:
    """Return the names there are, and before them the one that was meant."""
    near = get_close_matches(name, known, 1)
    return f"{f'did you mean {near[0]}? ' if near else ''}known: {', '.join(known)}"


def _unknown_weights(problem: Problem, views: Sequence[ResultInConvention]) -> Iterator[SymobsError]:
    """Yield the weights of parts that no result has by this name, which is the standard one."""
    known = [f"{view.task}.{name}" for view in views for name in available(view.result)]
    for part in problem.marking.parts:
        if part not in known:
            yield InputError(f"there is no {part}", where=f"marking.parts.{part}", repair=meant(part, known))


def _unmet_milestones(problem: Problem, views: Sequence[ResultInConvention]) -> Iterator[SymobsError]:
    """Yield the relations that no true line of a derivation could ever be."""
    for i, milestone in enumerate(problem.marking.milestones):
        where = f"marking.milestone[{i}].relation"
        try:
            _require_readable(milestone.relation, problem, where)
        except SymobsError as error:
            each = error.errors[0] if isinstance(error, ProblemErrors) else error
            repair = each.repair or 'write both sides, for example "L = [19; 81]"'
            yield InputError(each.message, where=where, repair=repair)
            continue
        line = judge_milestone(problem, views, milestone)
        rounds = problem.marking.decimals == "accept" and "." in milestone.relation
        if line.verdict == "false" and not rounds:
            repair = f"write {line.right}" if line.right else "write a relation that the solution meets"
            yield InputError(
                f'"{shown(milestone.relation, 80)}" is not true here: {line.reason}', where=where, repair=repair
            )


def _require_readable(relation: str, problem: Problem, where: str) -> None:
    """Raise an error of a relation that is neither an equation nor conditions."""
    if is_of_conditions(relation):
        read_conditions(relation, None, where)
    else:
        printed_entries([{"relation": relation}], problem.convention, problem.plant.symbols.signs)


def check(
    problem: str | Path | Problem | Result | Sequence[Result],
    answer: object,
    *,
    show: str = "reason",
    convention: str | None = None,
) -> CheckReport:
    """Check an answer: each part is right if and only if its claim holds, det(sI − A + LC) = φ(s) for a gain L.

    problem      a problem file (its path or its text), a result, or a list of results
    answer       an answer file (its path or its text), a mapping from fields to values, or one value where one is asked for
    show         what the report gives away: verdict, place, reason or solution
    convention   the letters the answer is written in; the problem's where nothing is said
    Returns a `CheckReport`.  Raises `ProblemErrors` where the problem or the answer as a whole cannot be read, and
    `InexactInput` for floats.
    """
    if show not in SHOW:
        raise UsageError(f"{shown(show, 40)!r} is nothing to show", where="show", repair=f"write {', '.join(SHOW)}")
    return Checked.of(problem).report(answer, show, convention)


class Checked:
    """A solved problem that answers are held against."""

    def __init__(self, problem: Problem, results: tuple[Result, ...]) -> None:
        self.problem = problem
        self.results = results

    @staticmethod
    def of(problem: str | Path | Problem | Result | Sequence[Result]) -> Checked:
        """Return a problem with its results; raises `ProblemErrors` where it cannot be read or solved."""
        if isinstance(problem, Result):
            problem = (problem,)
        if isinstance(problem, (list, tuple)):
            results = tuple(problem)
            return Checked(Problem("", "", (), (), results[0].plant, {}), results)
        if isinstance(problem, (str, Path)):
            text, folder = text_of(problem)
            problem = read(text, "problem" if folder is None else str(problem), folder)
        assert isinstance(problem, Problem)  # noqa: S101 - nothing else is left
        checked = Checked(problem, problem.solve())
        errors, views = Errors(), checked.views()
        with errors:
            checked.asked(views)
        errors.found += marking_errors(problem, views)
        if errors.found:
            raise errors.together()
        return checked

    def views(self, convention: Convention | None = None) -> list[ResultInConvention]:
        """Return the results as a convention writes them."""
        return [ResultInConvention(result, convention or self.problem.convention) for result in self.results]

    def asked(self, views: Sequence[ResultInConvention]) -> list[tuple[ResultInConvention, str]]:
        """Return the parts that count: each with its result, named in the standard convention."""
        wanted = self.problem.marking.asked
        if not wanted:
            return [(view, name) for view in views for name in asked_of(view.result)]
        named = [part_of_name(part, views) for part in wanted]
        errors: list[SymobsError] = [
            InputError(f"there is no {part}", where=f"marking.asked[{i}]", repair=known_parts(part, views))
            for i, (part, found) in enumerate(zip(wanted, named, strict=True))
            if found is None
        ]
        if errors:
            raise ProblemErrors(tuple(errors))
        return [found for found in named if found is not None]

    def report(
        self, answer: object, show: str = "reason", convention: str | None = None, variant: str | None = None
    ) -> CheckReport:
        """Return the report on an answer."""
        handed_in = self._answer(answer)
        name = convention or handed_in.convention
        chosen = convention_named(name) if name else self.problem.convention
        views = self.views(chosen)
        given = _given(handed_in, views, self.asked(views))
        judged = {
            view.task: judge_task(view, given[view.task], handed_in.symbols, self.problem.marking) for view in views
        }
        lines, milestones = judge_lines(self.problem, views, judged, handed_in, self.problem.marking.milestones)
        if handed_in.loose:
            judged = {task: _without_formulas(each, lines) for task, each in judged.items()}
        parts = self._parts(views, judged)
        parts = tuple(replace(part, given=_as_written(part, handed_in)) for part in parts)
        if handed_in.loose:
            lines = _without_answers(lines, parts, given)
        report = CheckReport(
            self.problem.title,
            handed_in.student,
            variant,
            chosen.name,
            show,
            parts,
            lines,
            milestones,
            self.problem.marking.total,
            tuple(claim for each in judged.values() for part in each.parts for claim in part.claims),
        )
        if report.verdict == "right" and report.first_false is not None:
            hint = f"{report.first_false} does not lead to your (right) result"
            report = replace(report, hints=(hint,))
        if handed_in.note:
            report = replace(report, hints=(*report.hints, handed_in.note))
        if show == "solution":
            report = replace(report, page=self.solution(chosen))
        return report.bounded(show)

    def without_answer(
        self, student: str, variant: str | None, verdict: str, reason: str, show: str = "reason"
    ) -> CheckReport:
        """Return the report on an answer that as a whole cannot be read (`unreadable`), or checked (`undecided`)."""
        marking, title = self.problem.marking, self.problem.title
        parts = tuple(
            replace(missing(view, name, marking), verdict=verdict, reason=reason, credit=None)
            for view, name in self.asked(self.views())
        )
        points = tuple((each.relation, each.points, False) for each in marking.milestones)
        name = self.problem.convention.name
        report = CheckReport(title, student, variant, name, show, parts, (), points, marking.total)
        return report.bounded(show)

    def report_of_file(self, raw: bytes, where: str, show: str, convention: str | None = None) -> CheckReport:
        """Return the report on the bytes of an answer file; its errors name the file."""
        try:
            text, note = text_of_answer(raw, where)
        except InputError as error:
            error.where = where
            raise
        return self.report(replace(self.read(text, where), note=note), show, convention)

    def solution(self, convention: Convention) -> str:
        """Return the derivation of the solution as HTML."""
        from symobs.tasks.result import render  # noqa: PLC0415 - only where the solution is shown

        return str(render(self.problem.document(self.results, convention), "html_fragment"))

    def read(self, text: str, where: str = "answer") -> Answer:
        """Return the answer of a text: its lines, or the one value that is asked for; raises `ProblemErrors`."""
        at_rest = next((view for view in self.views() if view.task == "equilibria"), None)
        if self.problem.plant.nonlinear is not None and not is_of_tables(text):
            steps, text = without_motion(text, self.problem.plant)
            points, text = Reader(at_rest).lines_of(text) if at_rest is not None else ([], text)
            if points or steps:
                rest = read_answer(text, where) if text.strip() else Answer(loose=True)
                listed = {"points": points} if points else {}
                written = {**rest.written, **{name: "; ".join(value) for name, value in listed.items()}}
                values = {**rest.values, **listed}
                return replace(rest, values=values, written=written, steps=(*steps, *rest.steps))
        try:
            return read_answer(text, where)
        except ProblemErrors as errors:
            if at_rest is not None:  # the reason why it is no list of points is told with that part
                return Answer(values={at_rest.task: {"points": text}})
            asked = self.asked(self.views())
            for each in errors.errors:
                if each.repair == EXAMPLE:
                    each.repair = f"write for example {example_of(*asked[0])}"
            value = bare_value(text) if len(asked) == 1 and len(text) < MAX_BYTES else ""
            if not value or re.search(r"[^\W\d_]{4,}(?:\s+[^\W\d_]{2,}){2}", str(value)):
                raise
            ((view, name),) = asked
            return Answer(values={view.task: {name: value}})

    def _answer(self, answer: object) -> Answer:
        """Return what was handed in: read, or the one value that is asked for."""
        if isinstance(answer, Answer):
            return answer
        if isinstance(answer, Path) or (isinstance(answer, str) and _is_path(answer)):
            text, note = text_of_path(Path(answer))
            return replace(self.read(text, "answer"), note=note)
        views = self.views()
        asked = self.asked(views)
        if isinstance(answer, str) and self.problem.plant.nonlinear is not None and (len(asked) != 1 or states(answer)):
            return self.read(answer)
        if isinstance(answer, Mapping) or (isinstance(answer, str) and (len(asked) != 1 or states(answer))):
            return read_answer(answer)
        if len(asked) != 1:
            parts = ", ".join(f"{view.task}.{name}" for view, name in asked)
            message = f"one value came, but {len(asked)} parts are asked for"
            raise InputError(message, where="answer", repair=f"give a mapping with {parts}")
        view, name = asked[0]
        return Answer(values={view.task: {name: plain(answer)}})

    def _parts(self, views: Sequence[ResultInConvention], judged: Mapping[str, TaskJudgement]) -> tuple[Part, ...]:
        """Return the parts that are asked for, and behind them what else was given."""
        marking = self.problem.marking
        asked = self.asked(views)
        parts: list[Part] = []
        for view, name in asked:
            part = next((part for part in judged[view.task].parts if part.name == name), None)
            counted = (
                part_of(view, judged[view.task], part, marking, counts=True) if part else missing(view, name, marking)
            )
            parts.append(counted)
        counted_names = {part.part for part in parts}
        for view in views:
            others = [part for part in judged[view.task].parts if f"{view.task}.{part.name}" not in counted_names]
            parts += [part_of(view, judged[view.task], part, marking, counts=False) for part in others]
        return tuple(parts)


def _is_path(text: str) -> bool:
    """Return whether a text names a file: it has the ending of one, or nothing that a value could have."""
    return not is_text(text) and bool(re.search(r"\.[A-Za-z]\w{0,5}$", text) or not re.search(r"[\s<>\[({^*+]", text))


def _given(
    answer: Answer, views: Sequence[ResultInConvention], asked: Sequence[tuple[ResultInConvention, str]]
) -> dict[str, dict[str, Any]]:
    """Return what is given for each task, without what is empty; raises `ProblemErrors` for what no task has."""
    found: dict[str, dict[str, Any]] = {view.task: {} for view in views}
    errors: list[SymobsError] = []
    tasks = {view.task: view for view in views}
    with_exceptions = {view.task for view, name in asked if name == "conditions"}
    for key, value in answer.values.items():
        if key in tasks and isinstance(value, Mapping):
            known = available(tasks[key])
            called = {field_called(tasks[key].result, name): (name, entry) for name, entry in value.items()}
            errors += [
                _unknown(f"{key}.{name}", [tasks[key]]) for field, (name, _) in called.items() if field not in known
            ]
            found[key] |= {
                field: entry for field, (_, entry) in called.items() if field in known and not _is_empty(entry)
            }
            continue
        having = [(view.task, field_called(view.result, key)) for view in views]
        having = [(task, field) for task, field in having if field in available(tasks[task])]
        if key == "conditions" and answer.loose:  # conditions in a text are the answer where they are asked for
            having = [(task, field) for task, field in having if task in with_exceptions]
        if answer.loose and (of_task := part_of_task(key, views)) is not None:
            having = [of_task]
        shared = [part for part in having if part in [(view.task, name) for view, name in asked]]
        values = answer.repeated.get(key, ())
        in_order = 1 < len(values) == len(shared)  # P of lqr, then P of kalman
        pairs = zip(shared, values, strict=True) if in_order else ((part, value) for part in having)
        for (task, field), entry in pairs:
            if field not in found[task] and not _is_empty(entry):
                found[task][field] = entry
        if not having and (not answer.loose or isinstance(value, Mapping)):
            errors.append(_unknown(key, views))
    if errors:
        raise ProblemErrors(tuple(errors))
    for view in views:
        for name, holds in answer.said:
            field = "verdict" if name == view.task else name
            if field in available(view) and field not in found[view.task]:
                found[view.task][field] = "yes" if holds else "no"
    if answer.loose:
        _add_called_otherwise(found, answer, views, asked)
    return found


def _add_called_otherwise(
    found: dict[str, dict[str, Any]],
    answer: Answer,
    views: Sequence[ResultInConvention],
    asked: Sequence[tuple[ResultInConvention, str]],
) -> None:
    """Add what a text of lines calls by the letters of the page, by other usual names, or by its entries."""
    beside = [
        (view, name)
        for view in views
        for name in ("kernel", "roots", "poles")
        if (view, name) not in asked and exists(view.result, name)
    ]
    called = fields_of([*asked, *beside], answer.values)
    for view in views:
        further = {field: value for (task, field), value in called.items() if task == view.task}
        if "K" in view.result.fields and "K" not in answer.values and view.plant.inputs == 1:
            law, sign = law_of(answer.values.get("u"), view.plant.order), view.standard(view.letter_of("K"))[1]
            if law is not None:
                further["K"] = [entry if sign < 0 else f"-({entry})" for entry in law]
        given = {view.standard(letter)[0] for letter in found[view.task]} - {*OF_THE_PLANT}
        for name, entry in (further | entries_of(view, answer.values) | listed_of(view, answer.values)).items():
            if name not in given:
                found[view.task][name] = entry
        names, _ = known_names(view)
        found[view.task] = {name: with_own_letters(v, answer.values, names) for name, v in found[view.task].items()}


def _as_written(part: Part, answer: Answer) -> str:
    """Return what the student wrote, as far as that is known."""
    task = part.part.partition(".")[0]
    names = (f"{task}.{part.letter}", part.letter)
    return next((answer.written[name] for name in names if part.given and name in answer.written), part.given)


def _without_formulas(judgement: TaskJudgement, lines: Sequence[Line]) -> TaskJudgement:
    """Return a judgement without the parts that a text has as formulas in letters alone, K = R^-1 B' P: these are lines."""
    sides = [(line, *line.relation.partition("=")[::2]) for line in lines]
    decided = {
        left.strip()
        for line, left, right in sides
        if line.verdict in {"true", "follows", "false"}
        and "[" not in right
        and re.search(r"(?<![A-Za-z_])[A-ZΠΓ]", right)
    }
    kept = (part for part in judgement.parts if part.verdict != "unreadable" or part.letter not in decided)
    return replace(judgement, parts=tuple(kept))


def _without_answers(
    lines: Sequence[Line], parts: Sequence[Part], given: Mapping[str, Mapping[str, Any]]
) -> tuple[Line, ...]:
    """Return the lines without those that mean nothing in a derivation and are parts of the answer, where it is told why.

    The last line of a letter is the answer: where that cannot be read, it is no line that could be true or false either,
    and a right one need not have the value of the solution.  So is a line that gives a part under another letter than its own.
    """
    judged = {part.letter: part for part in parts if part.given}
    sides = [[side.strip() for side in line.relation.partition("=")[::2]] for line in lines]
    answers = set({letter: place for place, (letter, _) in enumerate(sides)}.values())
    elsewhere = {_spaced(part.given) for letter, part in judged.items() if all(letter != own for own, _ in sides)}

    def says_more(place: int) -> bool:
        line, (letter, value) = lines[place], sides[place]
        if letter not in judged:
            return line.verdict != "unreadable" or _spaced(value) not in elsewhere
        part = judged[letter]
        is_given = _spaced(part.given) == _spaced(value)
        if place in answers and (part.verdict == "unreadable" or (part.verdict == "right" and is_given)):
            return line.verdict == "true"
        return line.verdict != "unreadable"

    values = {_spaced(value) for table in given.values() for each in table.values() for value in _flat(each)}

    def is_read_as_part(line: Line) -> bool:
        texts = {
            _spaced(text.strip())
            for text in (line.relation, line.relation.rpartition("=")[2], line.relation.partition("=")[2])
        }
        return line.verdict == "unreadable" and bool(texts & values)

    return tuple(line for place, line in enumerate(lines) if says_more(place) and not is_read_as_part(line))


def _flat(value: Any) -> list[Any]:
    """Return the texts of a value, of a list each, and the list as a row."""
    return [*value, ", ".join(map(str, value))] if isinstance(value, list) else [value]


def _spaced(value: Any) -> str:
    """Return a value as text with one blank between its entries."""
    return re.sub(r"[\s,]+", " ", str(value))


def _is_empty(value: Any) -> bool:
    """Return whether nothing stands where a value could."""
    return value is None or value == ""


def _unknown(name: str, views: Sequence[ResultInConvention]) -> InputError:
    known = ", ".join(dict.fromkeys(field for view in views for field in available(view)))
    return InputError("no task here has such a field", where=f"answer.{shown(name, 60)}", repair=f"known: {known}")
