"""The check of an answer: read, judged by the claims of the results, marked, and bounded by what may be shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers.answer_file import Answer, read_answer
from symobs.applications.checking.answers.values import as_value, plain
from symobs.applications.checking.derivations.lines import judge_lines
from symobs.applications.checking.judgement.judge import judge_task
from symobs.applications.checking.judgement.parts import asked_of, field_called, is_of_time
from symobs.applications.checking.marking_check import known_parts, marking_errors, part_of_name
from symobs.applications.checking.marks import missing, part_of
from symobs.applications.checking.report.data import SHOW, Line, Part
from symobs.applications.checking.report.report import CheckReport
from symobs.formula.convention import Convention, convention_named
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError
from symobs.problem import MAX_BYTES, Problem, is_text, read, text_of
from symobs.problem.expect import available
from symobs.problem.noted_errors import Errors
from symobs.tasks.result import Result
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.checking.judgement.judge import TaskJudgement


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
        given = _given(handed_in, views)
        judged = {
            view.task: judge_task(view, given[view.task], handed_in.symbols, self.problem.marking) for view in views
        }
        parts = self._parts(views, judged)
        lines, milestones = judge_lines(self.problem, views, judged, handed_in, self.problem.marking.milestones)
        if handed_in.loose:
            lines = _without_answers(lines, parts)
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
        if show == "solution":
            report = replace(report, page=self.solution(chosen))
        return report.bounded(show)

    def without_answer(
        self, student: str, variant: str | None, verdict: str, reason: str, show: str = "reason"
    ) -> CheckReport:
        """Return the report on an answer that as a whole cannot be read (`unreadable`), or checked (`undecided`)."""
        credit = None if verdict == "undecided" else Fraction(0)
        marking, title = self.problem.marking, self.problem.title
        parts = tuple(
            replace(missing(view, name, marking), verdict=verdict, reason=reason, credit=credit)
            for view, name in self.asked(self.views())
        )
        points = tuple((each.relation, each.points, False) for each in marking.milestones)
        name = self.problem.convention.name
        report = CheckReport(title, student, variant, name, show, parts, (), points, marking.total)
        return report.bounded(show)

    def report_of_text(self, text: str, where: str, show: str, convention: str | None = None) -> CheckReport:
        """Return the report on the text of an answer file; its errors name the file."""
        return self.report(read_answer(text, where), show, convention)

    def solution(self, convention: Convention) -> str:
        """Return the derivation of the solution as HTML."""
        from symobs.tasks.result import render  # noqa: PLC0415 - only where the solution is shown

        return str(render(self.problem.document(self.results, convention), "html_fragment"))

    def _answer(self, answer: object) -> Answer:
        """Return what was handed in: read, or the one value that is asked for."""
        if isinstance(answer, Answer):
            return answer
        if isinstance(answer, Path) or (isinstance(answer, str) and not is_text(answer)):
            return read_answer(text_of(answer, limit=MAX_BYTES)[0], "answer")
        if isinstance(answer, (str, Mapping)):
            return read_answer(answer)
        views = self.views()
        asked = self.asked(views)
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


def _given(answer: Answer, views: Sequence[ResultInConvention]) -> dict[str, dict[str, Any]]:
    """Return what is given for each task, without what is empty; raises `ProblemErrors` for what no task has."""
    found: dict[str, dict[str, Any]] = {view.task: {} for view in views}
    errors: list[SymobsError] = []
    tasks = {view.task: view for view in views}
    for key, value in [*answer.values.items(), *_functions_of_time(answer, views)]:
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
        for task, field in having:
            if field not in found[task] and not _is_empty(value):
                found[task][field] = value
        if not having and (not answer.loose or isinstance(value, Mapping)):
            errors.append(_unknown(key, views))
    if errors:
        raise ProblemErrors(tuple(errors))
    return found


def _functions_of_time(answer: Answer, views: Sequence[ResultInConvention]) -> list[tuple[str, Any]]:
    """Return exp(A t) and its value, the last one, where a text of lines defines it: it is no letter."""
    sides = [step.relation.rpartition("=") for step in answer.steps if answer.loose]
    results = [view.result for view in views]
    named = {left.strip(): as_value(right) for left, _, right in sides if is_of_time(results, left.strip())}
    return [(left, right) for left, right in named.items() if left not in answer.values]


def _without_answers(lines: Sequence[Line], parts: Sequence[Part]) -> tuple[Line, ...]:
    """Return the lines without those that mean nothing in a derivation and are parts of the answer, where it is told why.

    The last line of a letter is the answer: where that cannot be read, it is no line that could be true or false either,
    and a right one need not have the value of the solution.
    """
    judged = {part.letter: part for part in parts if part.given}
    sides = [[side.strip() for side in line.relation.partition("=")[::2]] for line in lines]
    answers = set({letter: place for place, (letter, _) in enumerate(sides)}.values())

    def says_more(place: int) -> bool:
        line, (letter, value) = lines[place], sides[place]
        if letter not in judged:
            return True
        part = judged[letter]
        if place in answers and (part.verdict == "unreadable" or (part.verdict == "right" and part.given == value)):
            return line.verdict == "true"
        return line.verdict != "unreadable"

    return tuple(line for place, line in enumerate(lines) if says_more(place))


def _is_empty(value: Any) -> bool:
    """Return whether nothing stands where a value could."""
    return value is None or value == ""


def _unknown(name: str, views: Sequence[ResultInConvention]) -> InputError:
    known = ", ".join(dict.fromkeys(field for view in views for field in available(view)))
    return InputError("no task here has such a field", where=f"answer.{shown(name, 60)}", repair=f"known: {known}")
