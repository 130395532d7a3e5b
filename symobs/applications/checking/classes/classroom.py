"""A class against a problem: every submission gets a report, equal ones are checked once, and all of it is counted."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.applications.batch.engine import Settings
from symobs.applications.batch.jobs import USUAL_BUDGET
from symobs.applications.batch.run import Batch
from symobs.applications.checking.classes.picture import picture
from symobs.applications.checking.classes.row import job_of, report_of_row, solved
from symobs.applications.checking.classes.submissions import not_held, read_submissions
from symobs.applications.checking.classes.summary import as_markdown, marks, summary
from symobs.formula.expression.source import shown
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import InputError
from symobs.problem.expect import available

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from symobs.applications.checking.checker import Checked
    from symobs.applications.checking.classes.submissions import Submission
    from symobs.applications.checking.classes.variants_of_class import ClassProblems

#: So many submissions are worth starting processes for.
_WORTH_CHILDREN = 24


def check_class(
    problems: ClassProblems,
    folder: Path,
    path: Path,
    *,
    columns: Mapping[str, str],
    show: str,
    feedback: bool,
    work: Path,
    workers: int | None,
    budget: Budget,
    progress: Callable[[int, int], None],
    tell: Callable[[str], None],
) -> tuple[dict[str, str], int]:
    """Return the files of the results by name, and the exit code: 5 where some are undecided.

    `tell` is given what the teacher should know of the table as a whole.
    Reports are kept in the folder `work` until the files are there: a run that was ended goes on from it.
    Raises `ProblemErrors` where the problem or the table as a whole cannot be used.
    """
    checked = solved(problems.first, str(folder))
    submissions = read_submissions(path, _parts(checked), columns)
    for line in filter(None, [not_held(submissions.columns, _asked(checked), _parts(checked))]):
        tell(line)
    entries, unknown = _with_variants(problems, submissions.entries)
    for i, reason in unknown.items():
        tell(f"{shown(entries[i].student, 60)} is not counted in the mean: {reason}")
    known = [submission for i, submission in enumerate(entries) if i not in unknown]
    jobs = {id(each): job_of(problems.text_of(each.variant), str(folder), each, show) for each in known}
    few = workers is None and budget == Budget(None, None) and len(jobs) < _WORTH_CHILDREN
    allowed = Budget(*(given or usual for given, usual in zip(budget, USUAL_BUDGET, strict=True)))
    settings = Settings(allowed, chunk_seconds=0.5, recheck=0)
    # Those of one variant follow each other: a process keeps the problems that it has solved last.
    in_turn = [jobs[id(each)] for each in sorted(known, key=lambda each: each.variant or "")]
    run = Batch(lambda: in_turn, work, workers=workers, in_process=few, settings=settings)
    for _ in run:
        progress(sum(run.counts.values()), len(jobs))
    rows = {row["key"]: row for row in run.rows()}
    texts = {job.key: problems.text_of(each.variant) for each in known for job in [jobs[id(each)]]}
    done = {key: report_of_row(rows[key], text, str(folder), show) for key, text in texts.items()}
    reports = [
        replace(
            checked.without_answer("", None, "unreadable", unknown[i], show)
            if i in unknown
            else done[jobs[id(each)].key],
            student=each.student,
            variant=each.variant,
        )
        for i, each in enumerate(entries)
    ]
    apart = {entries[i].student for i in unknown}
    found = summary(problems.title or checked.problem.title, reports, submissions.superseded, apart)
    files = {
        "results.jsonl": "".join(json.dumps(report.as_data(), ensure_ascii=False) + "\n" for report in reports),
        "marks.csv": marks(reports),
        "summary.md": as_markdown(found),
        "summary.svg": picture(found),
        "summary.json": json.dumps(found, indent=2, ensure_ascii=False) + "\n",
    }
    if feedback:
        files |= {f"feedback/{name_of(report.student)}.html": report.to_html() for report in reports}
    return files, 5 if any(report.verdict == "undecided" for report in reports) else 0


def _with_variants(problems: ClassProblems, entries: Sequence[Submission]) -> tuple[list[Submission], dict[int, str]]:
    """Return the submissions with the names of their variants, and by place what is wrong with those that have none.

    Raises `InputError` where nobody has one: then it is the table that lacks them.
    """
    found, unknown = list(entries), {}
    for i, submission in enumerate(entries):
        try:
            found[i] = replace(submission, variant=problems.variant_of(submission))
        except InputError as error:
            unknown[i] = str(error)
    if entries and len(unknown) == len(entries):
        repair = "give it a column variant, or lay the assignment.csv of `symobs variants --assign` beside the manifest"
        raise InputError("no submission says which variant it answers", where="--submissions", repair=repair)
    return found, unknown


def name_of(student: str) -> str:
    """Return the name of a student's page: no path is made of what somebody handed in."""
    return hashlib.sha256(student.encode(errors="surrogatepass")).hexdigest()[:16]


def _asked(checked: Checked) -> list[list[str]]:
    """Return the names of each part that counts: its letter, and with its task."""
    found = []
    for view, field in checked.asked(checked.views()):
        letter = next((own for own, (standard, _) in view.names.items() if standard == field), field)
        found.append([letter, f"{view.task}.{letter}", f"{view.task}.{field}"])
    return found


def _parts(checked: Checked) -> list[str]:
    """Return the names that a column may have: fields, and task.field."""
    views = checked.views()
    named = [f"{view.task}.{name}" for view in views for name in available(view)]
    return [*dict.fromkeys(name for view in views for name in available(view)), *named]
