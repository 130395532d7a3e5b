"""A class against a problem: every submission gets a report, equal ones are checked once, and all of it is counted."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
from collections import Counter
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.batch.engine import Settings
from symobs.applications.batch.jobs import USUAL_BUDGET
from symobs.applications.batch.run import Batch
from symobs.applications.checking.folders import written_place
from symobs.applications.checking.report import decimal
from symobs.applications.checking.submissions import job_of, not_held, read_submissions, report_of_row, solved
from symobs.formula.expression.source import shown
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import InputError
from symobs.pages.drawings.scene import FONT_SIZE, Rectangle, Scene, Stroke, TextLabel
from symobs.pages.drawings.svg import measure_for, svg
from symobs.pages.printers.text_printer import TextPrinter
from symobs.problem.expect import available

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
    from pathlib import Path

    from symobs.applications.checking.checker import Checked
    from symobs.applications.checking.report import CheckReport, Part
    from symobs.applications.checking.submissions import ClassProblems, Submission, Submissions


# What a class made of a problem: verdicts, marks, slips, and where derivations went wrong.


#: What a spreadsheet would take for a formula at the beginning of a cell.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
_NUMBER = re.compile(r"[+-]?[0-9]+(\.[0-9]+)?")


def safe(cell: str) -> str:
    """Return a cell that no spreadsheet takes for a formula."""
    return f"'{cell}" if cell.startswith(_FORMULA) and not _NUMBER.fullmatch(cell) else cell


def marks(reports: Sequence[CheckReport]) -> str:
    """Return the marks as CSV: a row a student, a column a part."""
    parts = list(dict.fromkeys(part.part for report in reports for part in report.parts if part.weight))
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["student", "variant", "verdict", "score", *(f"part:{part}" for part in parts)])
    for report in reports:
        by_name = {part.part: part for part in report.parts}
        score = "" if report.score is None else decimal(report.score)
        cells = [report.student, report.variant or "", report.verdict, score]
        cells += [by_name[part].verdict if part in by_name else "" for part in parts]
        writer.writerow([safe(cell) for cell in cells])
    return stream.getvalue()


def summary(
    title: str,
    reports: Sequence[CheckReport],
    submissions: Submissions,
    without_variant: Collection[str] = (),
) -> dict[str, Any]:
    """Return the summary of a class as data; students without a known variant are not in the mean."""
    marked = [report for report in reports if report.student not in without_variant]
    scores = [report.score for report in marked if report.score is not None]
    mean = sum(scores, Fraction(0)) / len(scores) if scores else None
    parts: dict[str, list[tuple[str, Part]]] = {}
    for report in reports:
        for part in report.parts:
            if part.weight:
                parts.setdefault(part.part, []).append((report.student, part))
    return {
        "schema": "symobs-check-summary/1",
        "title": title,
        "students": len(reports),
        "verdicts": _counted(report.verdict for report in reports),
        "mean": None if mean is None else str(mean),
        "mean_decimal": None if mean is None else decimal(mean),
        "total": str(reports[0].total) if reports else "0",
        "parts": {name: _counted(part.verdict for _, part in found) for name, found in parts.items()},
        "slips": {name: _slips(found) for name, found in parts.items()},
        "first_false": _first_false(reports),
        "variants": _by_variant(marked),
        "agreement": {name: _agreement(found) for name, found in parts.items()},
        "without_variant": sorted(without_variant),
        "superseded": [{"student": student, "place": place} for student, place in submissions.superseded],
        "left_out": [
            {"student": student, "file": place, "reason": reason} for student, place, reason in submissions.left_out
        ],
        "unreadable": [
            {"student": report.student, "message": "; ".join(dict.fromkeys(reasons))}
            for report in reports
            if (reasons := [part.reason for part in report.parts if part.verdict == "unreadable"])
        ],
        "by_hand": [
            {"student": report.student, "part": part.part, "text": part.given, "reason": part.reason}
            for report in reports
            for part in report.by_hand
        ],
    }


def _by_variant(reports: Sequence[CheckReport]) -> dict[str, Any]:
    """Return of each variant how many have marks, their mean, and the sum of the squared differences from it."""
    scores: dict[str, list[Fraction]] = {}
    for report in reports:
        if report.variant is not None and report.score is not None:
            scores.setdefault(report.variant, []).append(report.score)
    found = {}
    for name, own in sorted(scores.items()):
        mean = sum(own, Fraction(0)) / len(own)
        squares = sum(((score - mean) ** 2 for score in own), Fraction(0))
        found[name] = {
            "students": len(own),
            "mean": str(mean),
            "mean_decimal": decimal(mean),
            "squares": str(squares),
        }
    return found


def _counted(values: Any) -> dict[str, int]:
    return dict(sorted(Counter(values).items()))


def _slips(found: Sequence[tuple[str, Part]]) -> list[dict[str, Any]]:
    """Return the slips of a part, the most frequent first, with the students who made them."""
    by_slip: dict[str, list[str]] = {}
    for student, part in found:
        if part.slip is not None:
            by_slip.setdefault(part.slip, []).append(student)
    ranked = sorted(by_slip.items(), key=lambda item: (-len(item[1]), item[0]))
    return [{"slip": slip, "count": len(students), "students": students} for slip, students in ranked]


def _first_false(reports: Sequence[CheckReport]) -> list[dict[str, Any]]:
    """Return the first false lines of derivations, alike ones together."""
    groups: dict[str, list[str]] = {}
    for report in reports:
        line = next((line for line in report.lines if line.verdict == "false"), None)
        if line is not None:
            groups.setdefault(re.sub(r"\s+", "", line.relation), []).append(report.student)
    ranked = sorted(groups.items(), key=lambda item: (-len(item[1]), item[0]))
    return [{"relation": text, "count": len(students), "students": students} for text, students in ranked]


def _agreement(found: Sequence[tuple[str, Part]]) -> list[dict[str, Any]]:
    """Return the wrong values that several students share and no slip explains, as one of them wrote each."""
    groups: dict[str, list[str]] = {}
    shown_as: dict[str, str] = {}
    for student, part in found:
        if part.verdict == "wrong" and part.slip is None and part.given:
            text = shown_as.setdefault(part.read, re.sub(r"\s+", " ", part.given.strip()))
            groups.setdefault(text, []).append(student)
    ranked = sorted(groups.items(), key=lambda item: (-len(item[1]), item[0]))
    return [{"given": text, "count": len(who), "students": who} for text, who in ranked if len(who) > 1]


def told_of_replaced(submissions: Submissions) -> list[str]:
    """Return of each submission that does not count which one of the same student does."""
    return [
        f"{shown(student, 60)}: {written_place(submissions.places[student])} counts, not {written_place(place)}"
        for student, place in submissions.superseded
    ]


def as_markdown(found: Mapping[str, Any], replaced: Sequence[str] = ()) -> str:
    """Return a summary as Markdown; `replaced` says which of several submissions of a student count."""
    from symobs.pages.formats.markdown import code, plain  # noqa: PLC0415 - only with a class

    lines = [f"# {plain(found['title'] or 'Summary')}", ""]
    mean = f", {found['mean_decimal']} of {found['total']} marks on average" if found["mean_decimal"] else ""
    lines += [f"{found['students']} students{mean}.", "", "| verdict | students |", "|---|---:|"]
    lines += [f"| {verdict} | {count} |" for verdict, count in found["verdicts"].items()]
    lines += ["", "![What became of each part](summary.svg)"] if found["parts"] else []
    for part, verdicts in found["parts"].items():
        said = ", ".join(f"{count} {verdict}" for verdict, count in verdicts.items())
        lines += ["", f"## {plain(part)}", "", f"{said}.", ""]
        lines += [f"- {entry['count']} × {entry['slip'].replace('_', ' ')}" for entry in found["slips"][part]]
        lines += [
            f"- {each['count']} × {code(each['given'])}, which no slip explains" for each in found["agreement"][part]
        ]
    if found["first_false"]:
        lines += ["", "## First false lines", ""]
        lines += [f"- {entry['count']} × {code(entry['relation'])}" for entry in found["first_false"]]
    if found["variants"]:
        lines += ["", "## Variants", "", "| variant | students | marks on average |", "|---|---:|---:|"]
        lines += [
            f"| {plain(name)} | {each['students']} | {each['mean_decimal']} |"
            for name, each in found["variants"].items()
        ]
    if found["by_hand"]:
        lines += ["", "## Not yet marked: to be looked at by hand", ""]
        lines += ["| student | part | text | reason |", "|---|---|---|---|"]
        lines += [
            f"| {plain(each['student'])} | {plain(each['part'])} | {code(each['text'])} | {plain(each['reason'])} |"
            for each in found["by_hand"]
        ]
    if found["left_out"]:
        lines += ["", "## Files that were left out", "", "| student | file | reason |", "|---|---|---|"]
        lines += [
            f"| {plain(each['student'])} | {plain(each['file'])} | {plain(each['reason'])} |"
            for each in found["left_out"]
        ]
    if found["without_variant"]:
        lines += ["", f"Without a known variant, not in the average: {plain(', '.join(found['without_variant']))}."]
    if found["superseded"]:
        lines += ["", f"{len(found['superseded'])} submissions were replaced by others of the same student.", ""]
        lines += [f"- {plain(line)}" for line in replaced]
    return "\n".join([*lines, ""])


# The picture of a class: what became of each part, and which slips were made where, as bars.


#: In points: the height of a row and of its bar, the longest bar, and what is left free around and between.
_ROW, _BAR, _LONGEST, _MARGIN, _GAP = 15.0, 9.0, 220.0, 6.0, 5.0


class Bar(NamedTuple):
    """A row: a part with how many were right, or what became of some of the others."""

    text: str
    number: int
    is_part: bool = False


def picture(found: Mapping[str, Any]) -> str:
    """Return the summary of a class as an SVG file: of each part how many were right, and what went wrong."""
    printer, bars = TextPrinter(), list(_bars(found))
    measure = measure_for(printer)
    beside = max((measure(bar.text)[0] for bar in bars), default=0.0) + _GAP
    scale = _LONGEST / max(1, found["students"])
    shades, texts = [], []
    for place, bar in enumerate(bars):
        y = -_ROW * (place + 0.5)
        texts.append(TextLabel(bar.text, (0.0 if bar.is_part else beside, y), "west" if bar.is_part else "east"))
        length = beside + _GAP + scale * bar.number
        low, high = y - _BAR / 2, y + _BAR / 2
        shades.append(((beside + _GAP, low), (length, low), (length, high), (beside + _GAP, high)))
        texts.append(TextLabel(str(bar.number), (length + _GAP, y), "west"))
    height = _ROW * len(bars)
    frame = Rectangle(0.0, -height, beside + 2 * _GAP + _LONGEST + 4 * FONT_SIZE, 0.0)
    axis = Stroke(((beside + _GAP, 0.0), (beside + _GAP, -height)), "tick")
    scene = Scene(frame, frame.grown(_MARGIN), tuple(shades), (axis,), texts=tuple(texts))
    return svg(scene, printer, f"What became of the answers of {found['students']} students", alone=True) + "\n"


def _bars(found: Mapping[str, Any]) -> Iterator[Bar]:
    """Yield the rows, a part and what went wrong in it."""
    for part, verdicts in found["parts"].items():
        yield Bar(f"{part}: right", verdicts.get("right", 0), is_part=True)
        slips = [(entry["slip"].replace("_", " "), entry["count"]) for entry in found["slips"][part]]
        unexplained = verdicts.get("wrong", 0) - sum(count for _, count in slips)
        others = [("wrong, without a known slip", unexplained)]
        others += [(verdict, count) for verdict, count in verdicts.items() if verdict not in {"right", "wrong"}]
        for text, count in sorted([*slips, *others], key=lambda row: (-row[1], row[0])):
            if count:
                yield Bar(text, count)


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
) -> tuple[dict[str, str], list[str], int]:
    """Return the files of the results by name, what is said of them, and the exit code.

    The code is 5 where some are undecided, 3 where files were left out since they could not be read.
    `tell` is given what the teacher should know of the table as a whole.
    Reports are kept in the folder `work` until the files are there: a run that was ended goes on from it.
    Raises `ProblemErrors` where the problem or the table as a whole cannot be used.
    """
    checked = solved(problems.first, str(folder))
    submissions = read_submissions(path, _parts(checked), columns)
    for line in filter(None, [not_held(submissions.columns, _asked(checked), _parts(checked))]):
        tell(line)
    if submissions.note:
        tell(f"{shown(path.name, 60)}: {submissions.note}")
    for _, place, reason in submissions.left_out:
        tell(f"{written_place(place)} is left out: {reason}")
    entries, unknown = _with_variants(problems, submissions.entries)
    for i, reason in unknown.items():
        tell(f"{shown(entries[i].student, 60)} is not counted in the mean: {reason}")
    unknown |= {i: each.unread for i, each in enumerate(entries) if each.unread}
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
    reports = []
    for i, each in enumerate(entries):
        unread = checked.without_answer("", None, "unreadable", unknown[i], show) if i in unknown else None
        report = unread or done[jobs[id(each)].key]
        hints = (*report.hints, *filter(None, [each.note]))
        reports.append(replace(report, student=each.student, variant=each.variant, hints=hints))
    apart = {entries[i].student for i in unknown if not entries[i].unread}
    found = summary(problems.title or checked.problem.title, reports, submissions, apart)
    replaced = told_of_replaced(submissions)
    files = {
        "results.jsonl": "".join(json.dumps(report.as_data(), ensure_ascii=False) + "\n" for report in reports),
        "marks.csv": marks(reports),
        "summary.md": as_markdown(found, replaced),
        "summary.svg": picture(found),
        "summary.json": json.dumps(found, indent=2, ensure_ascii=False) + "\n",
    }
    if feedback:
        files |= {f"feedback/{name_of(report.student)}.html": report.to_html() for report in reports}
    is_open = any(report.verdict == "undecided" for report in reports)
    return files, [*replaced, counted(found)], 5 if is_open else 3 if submissions.left_out else 0


def counted(found: Mapping[str, Any]) -> str:
    """Return how many students there are, how many have marks, and their mean, in one line."""
    waiting = len({entry["student"] for entry in found["by_hand"]})
    students = f"{found['students']} student{'s' if found['students'] != 1 else ''}"
    mean = f", {found['mean_decimal']} of {decimal(Fraction(found['total']))} on average" if found["mean"] else ""
    return f"{students}, {waiting} of them not yet marked: to be read by hand{mean}"


def _with_variants(problems: ClassProblems, entries: Sequence[Submission]) -> tuple[list[Submission], dict[int, str]]:
    """Return the submissions with the names of their variants, and by place what is wrong with those that have none.

    Raises `InputError` where nobody has one: then it is the table that lacks them.
    """
    found, unknown = list(entries), {}
    for i, submission in enumerate(entries):
        if submission.unread:
            continue
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
        letter = view.letter_of(field)
        found.append([letter, f"{view.task}.{letter}", f"{view.task}.{field}"])
    return found


def _parts(checked: Checked) -> list[str]:
    """Return the names that a column may have: fields, and task.field."""
    views = checked.views()
    named = [f"{view.task}.{name}" for view in views for name in available(view)]
    return [*dict.fromkeys(name for view in views for name in available(view)), *named]
