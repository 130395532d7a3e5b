"""A class against a problem: every submission gets a report, equal ones are checked once, and all of it is counted."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.checking.classes.row import key_of, report_of, solved
from symobs.checking.classes.submissions import read_submissions
from symobs.checking.classes.summary import as_markdown, marks, summary
from symobs.expect import available

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from symobs.checking.checker import Checked
    from symobs.checking.report.report import CheckReport


def check_class(
    problem: str,
    folder: Path,
    path: Path,
    *,
    columns: Mapping[str, str],
    show: str,
    feedback: bool,
    progress: Callable[[int, int], None],
) -> tuple[dict[str, str], int]:
    """Return the files of the results by name, and the exit code: 5 where some are undecided.

    Raises `ProblemErrors` where the problem or the table as a whole cannot be used.
    """
    checked = solved(problem, str(folder))
    submissions = read_submissions(path, _parts(checked), columns)
    seen: dict[object, CheckReport] = {}
    reports: list[CheckReport] = []
    for number, submission in enumerate(submissions.entries, start=1):
        key = key_of(submission)
        if key not in seen:
            seen[key] = report_of(problem, str(folder), submission, show)
        reports.append(replace(seen[key], student=submission.student, variant=submission.variant))
        progress(number, len(submissions.entries))
    found = summary(checked.problem.title, reports, submissions.superseded)
    files = {
        "results.jsonl": "".join(json.dumps(report.as_data(), ensure_ascii=False) + "\n" for report in reports),
        "marks.csv": marks(reports),
        "summary.md": as_markdown(found),
        "summary.json": json.dumps(found, indent=2, ensure_ascii=False) + "\n",
    }
    if feedback:
        files |= {f"feedback/{name_of(report.student)}.html": report.to_html() for report in reports}
    return files, 5 if any(report.verdict == "undecided" for report in reports) else 0


def name_of(student: str) -> str:
    """Return the name of a student's page: no path is made of what somebody handed in."""
    return hashlib.sha256(student.encode(errors="surrogatepass")).hexdigest()[:16]


def _parts(checked: Checked) -> list[str]:
    """Return the names that a column may have: fields, and task.field."""
    views = checked.views()
    named = [f"{view.task}.{name}" for view in views for name in available(view)]
    return [*dict.fromkeys(name for view in views for name in available(view)), *named]
