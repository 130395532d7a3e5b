"""Reports as plain text and as Markdown."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING

from symobs.checking.report.report import decimal

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.checking.report.report import CheckReport, Line, Part

_WIDTH = 100


def text(report: CheckReport) -> str:
    """Return a report as plain text of at most 100 columns."""
    from symobs.render.formats.text import printable  # noqa: PLC0415 - each format pays for its own

    lines: list[str] = []
    width = max((len(part.letter) for part in report.parts), default=1)
    for part in report.parts:
        head = f"{part.letter:<{width}}  {part.verdict}"
        credit = f"  {part.credit}" if part.weight and part.credit is not None and 0 < part.credit < 1 else ""
        lines += _wrapped(printable("  ".join(filter(None, (head + credit, "; ".join(sentences(part)))))), width + 2)
    for line in shown_lines(report):
        said = f": {line.reason}" if line.reason else ""
        right = f" (right: {line.right})" if line.right else ""
        lines += _wrapped(printable(f"{line.where} is {line.verdict}: {line.relation}{said}{right}"), 2)
    lines += [line for hint in report.hints for line in _wrapped(printable(hint), 2)]
    lines += _wrapped(printable(result(report)), 2)
    return "\n".join([*lines, ""])


def markdown(report: CheckReport) -> str:
    """Return a report as Markdown."""
    from symobs.render.formats.markdown import plain  # noqa: PLC0415 - each format pays for its own

    lines = [f"**{plain(report.title)}**", ""] if report.title else []
    lines += ["| part | verdict | credit | |", "|---|---|---|---|"]
    for part in report.parts:
        credit = "" if part.credit is None else str(part.credit)
        lines.append(f"| {plain(part.letter)} | {part.verdict} | {credit} | {plain('; '.join(sentences(part)))} |")
    for line in shown_lines(report):
        said = f": {line.reason}" if line.reason else ""
        lines += ["", plain(f"{line.where} is {line.verdict}: {line.relation}{said}")]
    for hint in report.hints:
        lines += ["", plain(hint)]
    return "\n".join([*lines, "", plain(result(report)), ""])


def _wrapped(line: str, indent: int) -> list[str]:
    return wrap(line, _WIDTH, subsequent_indent=" " * indent, break_on_hyphens=False) or [""]


def sentences(part: Part) -> Iterator[str]:
    """Yield what is said of a part."""
    if part.reason:
        yield part.reason
    yield from part.alternatives
    if part.origins:
        yield f"it follows from your {' and '.join(origin.partition('.')[2] for origin in part.origins)}, which is wrong"
    if part.place and not part.reason and isinstance(part.place, list):
        yield f"look at entry ({part.place[0]},{part.place[1]})"
    if part.effect and part.verdict == "wrong" and "the polynomial is" not in part.reason:
        yield f"with yours the polynomial is {part.effect['polynomial']}"
    if part.effect.get("stable") == "no":
        yield "which is not stable"
    yield from part.hints
    if part.right is not None and part.verdict != "right":
        yield f"right: {part.right}"


def shown_lines(report: CheckReport) -> list[Line]:
    """Return the lines that need a word: false, unreadable and undecided ones."""
    return [line for line in report.lines if line.verdict not in {"true", "follows"}]


def result(report: CheckReport) -> str:
    """Return the verdict and the score in one sentence."""
    if report.score is None:
        return f"{report.verdict}: this answer is to be marked by hand"
    return f"{report.verdict}: {decimal(report.score)} of {decimal(report.total)}"
