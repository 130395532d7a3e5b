"""Reports as plain text and as Markdown."""

from __future__ import annotations

import re
from dataclasses import replace
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.report.data import decimal
from symobs.formula.expression.source import shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.applications.checking.report.data import Line, Part, ReportData

_WIDTH = 100
#: Longer lines of an answer are shown by their beginning.
LONGEST = 300


def text(report: ReportData) -> str:
    """Return a report as plain text of at most 100 columns."""
    from symobs.pages.formats.text import printable  # noqa: PLC0415 - each format pays for its own

    lines: list[str] = []
    names = names_of(report)
    width = max(map(len, names.values()), default=1)
    for part in report.parts:
        head = f"{names[part.part]:<{width}}  {part.verdict}"
        credit = f"  {part.credit}" if part.weight and part.credit is not None and 0 < part.credit < 1 else ""
        lines += _wrapped(
            printable("  ".join(filter(None, (head + credit, of_numbers("; ".join(sentences(part, names))))))),
            width + 2,
        )
    for line in shown_lines(report):
        said = f": {of_numbers(line.reason)}" if line.reason else ""
        right = f" (right: {of_numbers(line.right)})" if line.right else ""
        lines += _wrapped(printable(f"{line.where} is {line.verdict}: {line.relation}{said}{right}"), 2)
    lines += [line for hint in report.hints for line in _wrapped(printable(hint), 2)]
    lines += _wrapped(printable(result(report)), 2)
    return "\n".join([*lines, ""])


def markdown(report: ReportData) -> str:
    """Return a report as Markdown."""
    from symobs.pages.formats.markdown import plain  # noqa: PLC0415 - each format pays for its own

    names = names_of(report)
    lines = [f"**{plain(report.title)}**", ""] if report.title else []
    lines += ["| part | verdict | credit | |", "|---|---|---|---|"]
    for part in report.parts:
        credit = "" if part.credit is None else str(part.credit)
        said = plain(of_numbers("; ".join(sentences(part, names))))
        lines.append(f"| {plain(names[part.part])} | {part.verdict} | {credit} | {said} |")
    for line in shown_lines(report):
        said = f": {of_numbers(line.reason)}" if line.reason else ""
        lines += ["", plain(f"{line.where} is {line.verdict}: {line.relation}{said}")]
    for hint in report.hints:
        lines += ["", plain(hint)]
    return "\n".join([*lines, "", plain(result(report)), ""])


def _wrapped(line: str, indent: int) -> list[str]:
    return wrap(line, _WIDTH, subsequent_indent=" " * indent, break_on_hyphens=False) or [""]


def names_of(report: ReportData) -> dict[str, str]:
    """Return what each part is called: its letter, with the task where several have that one."""
    letters = [part.letter for part in report.parts]
    return {
        part.part: part.letter if letters.count(part.letter) == 1 else f"{part.part.partition('.')[0]}.{part.letter}"
        for part in report.parts
    }


def sentences(part: Part, names: Mapping[str, str], *, effect: bool = True) -> Iterator[str]:
    """Yield what is said of a part, others having these `names`; with `effect` also what its value does, and what is right."""
    if part.reason and (effect or not part.effect or part.slip is not None):
        yield part.reason
    yield from part.alternatives
    if part.origins:
        named = " and ".join(names.get(origin, origin.partition(".")[2]) for origin in part.origins)
        yield f"it follows from your {named}, which {'are' if len(part.origins) > 1 else 'is'} wrong"
    if part.place and not part.reason:
        yield f"look at {_place(part.place)}"
    if effect and part.effect and part.verdict == "wrong":
        if part.effect["polynomial"] not in part.reason:
            yield f"with yours the polynomial is {part.effect['polynomial']}"
        if part.effect.get("stable") == "no":
            yield "it is not stable"
    yield from part.hints
    if effect and part.right is not None and part.verdict != "right":
        yield f"right: {part.right}"


def _place(place: Any) -> str:
    """Return a place in words."""
    if isinstance(place, list):
        return f"entry ({place[0]},{place[1]})"
    if "coefficient" in place:
        return f"the coefficient of the power {place['coefficient']}"
    return "the point " + ", ".join(f"{name} = {value}" for name, value in place.items())


def of_numbers(text: str) -> str:
    """Return a sentence with powers as one writes them by hand: s^2 + 3 s in place of s**2 + 3*s."""
    return re.sub(r"(?<=[0-9A-Za-z)])\*(?=[A-Za-z(])", " ", text.replace("**", "^"))


def shown_lines(report: ReportData) -> list[Line]:
    """Return the lines that need a word: false, unreadable and undecided ones."""
    said = [line for line in report.lines if line.verdict not in {"true", "follows"}]
    return [replace(line, relation=beginning(line.relation)) for line in said]


def beginning(written: str) -> str:
    """Return what a student wrote on one line, a long one by its beginning."""
    return shown(" ".join(written.split()), LONGEST)


def result(report: ReportData) -> str:
    """Return the verdict and the score in one sentence."""
    if report.score is None:
        return f"{report.verdict}: this answer is to be marked by hand"
    return f"{report.verdict}: {decimal(report.score)} of {decimal(report.total)}"
