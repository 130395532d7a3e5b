"""Reports of an audit as text, Markdown or JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from textwrap import wrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from symobs.applications.audit.auditor import Audited, Finding


_WIDTH = 100


def report(audited: Mapping[str, Audited], format_name: str) -> str:
    """Return the report of the findings of several files by path, in the order given."""
    return REPORTS[format_name](audited)


def summary(audited: Mapping[str, Audited]) -> str:
    """Return one sentence: the numbers of printed and of wrong equations."""
    checked = sum(each.checked for each in audited.values())
    wrong = sum(len(each.wrong) for each in audited.values())
    general = sum(len(each.findings) for each in audited.values()) - wrong
    equations = "equation" if checked == 1 else "equations"
    beside = f", {general} true in general only" if general else ""
    return f"{checked} printed {equations}, {wrong or 'nothing'} wrong{beside}."


def _heading(finding: Finding) -> str:
    return " ".join(filter(None, (finding.where, f"({finding.erratum})" if finding.erratum else ""))) or "an entry"


def _text(audited: Mapping[str, Audited]) -> str:
    from symobs.pages.formats.text import printable  # noqa: PLC0415 - each format pays for its own

    lines: list[str] = []
    for path, each in audited.items():
        if each.findings or each.notes:
            lines += [printable(f"{path}: {each.title}" if each.title else path)]
        lines += [f"  note: {printable(note)}" for note in each.notes]
        for finding in each.findings:
            lines += [f"  {printable(_heading(finding))}", f"    printed   {printable(finding.printed)}"]
            label = "plainly" if finding.holds else "right  "
            lines += [f"    {label}   {printable(finding.right)}"] if finding.right else []
            lines += (
                wrap(f"    because   {printable(finding.reason)}", _WIDTH, subsequent_indent=" " * 14)
                if finding.reason
                else []
            )
            lines += [""]
    return "\n".join([*lines, summary(audited), ""])


def _markdown(audited: Mapping[str, Audited]) -> str:
    from symobs.pages.formats.markdown import plain  # noqa: PLC0415 - each format pays for its own

    def code(text: str) -> str:
        """Return mathematics as code; what would end it, or the row, is no mathematics and is shown as text."""
        if not text.isprintable() or "`" in text or "|" in text:
            return plain(text)
        return f"`{text}`" if text else ""

    lines = ["| where | erratum | printed | right | reason |", "|---|---|---|---|---|"]
    for path, each in audited.items():
        for found in each.findings:
            place = f"{found.where}, {path}" if found.where else path
            cells = (plain(place), plain(found.erratum), code(found.printed), code(found.right), plain(found.reason))
            lines.append(f"| {' | '.join(cells)} |")
    table = [*lines, ""] if len(lines) > 2 else []
    notes = [line for path, each in audited.items() for note in each.notes for line in (plain(f"{path}: {note}"), "")]
    return "\n".join([*table, *notes, summary(audited), ""])


def _json(audited: Mapping[str, Audited]) -> str:
    files = [
        {
            "file": path,
            "title": each.title,
            "checked": each.checked,
            "findings": list(map(asdict, each.findings)),
            "notes": list(each.notes),
        }
        for path, each in audited.items()
    ]
    return json.dumps({"schema": "symobs-audit/1", "files": files}, indent=2, ensure_ascii=False) + "\n"


REPORTS: Mapping[str, Callable[[Mapping[str, Audited]], str]] = {"text": _text, "markdown": _markdown, "json": _json}
