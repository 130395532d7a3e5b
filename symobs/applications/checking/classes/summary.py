"""What a class made of a problem: verdicts, marks, slips, and where derivations went wrong."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.report.data import decimal

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from symobs.applications.checking.report.data import Part
    from symobs.applications.checking.report.report import CheckReport

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
    superseded: Sequence[tuple[str, str]],
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
        "superseded": [{"student": student, "place": place} for student, place in superseded],
        "unreadable": [
            {"student": report.student, "message": "; ".join(dict.fromkeys(reasons))}
            for report in reports
            if (reasons := [part.reason for part in report.parts if part.verdict == "unreadable"])
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
    """Return the wrong values that several students share and no slip explains."""
    groups: dict[str, list[str]] = {}
    for student, part in found:
        if part.verdict == "wrong" and part.slip is None and part.given:
            groups.setdefault(re.sub(r"\s+", " ", part.given.strip()), []).append(student)
    ranked = sorted(groups.items(), key=lambda item: (-len(item[1]), item[0]))
    return [{"given": text, "count": len(who), "students": who} for text, who in ranked if len(who) > 1]


def as_markdown(found: Mapping[str, Any]) -> str:
    """Return a summary as Markdown."""
    from symobs.pages.formats.markdown import plain  # noqa: PLC0415 - only with a class

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
            f"- {each['count']} × {plain(each['given'])}, which no slip explains" for each in found["agreement"][part]
        ]
    if found["first_false"]:
        lines += ["", "## First false lines", ""]
        lines += [f"- {entry['count']} × {plain(entry['relation'])}" for entry in found["first_false"]]
    if found["variants"]:
        lines += ["", "## Variants", "", "| variant | students | marks on average |", "|---|---:|---:|"]
        lines += [
            f"| {plain(name)} | {each['students']} | {each['mean_decimal']} |"
            for name, each in found["variants"].items()
        ]
    if found["without_variant"]:
        lines += ["", f"Without a known variant, not in the average: {plain(', '.join(found['without_variant']))}."]
    if found["superseded"]:
        lines += ["", f"{len(found['superseded'])} submissions were replaced by later ones of the same student."]
    return "\n".join([*lines, ""])
