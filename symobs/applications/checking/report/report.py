"""The report on an answer with the formats that it can be written in."""

from __future__ import annotations

from typing import Any

from symobs.applications.checking.report.data import ReportData


class CheckReport(ReportData):
    """The report on an answer: `.verdict`, `.score`, `.total`, `.parts`, `.lines`, `.first_false`."""

    def to_text(self) -> str:
        """Return the report as plain text, one line a part."""
        from symobs.applications.checking.report.pages import text  # noqa: PLC0415 - each format pays for its own

        return text(self)

    def to_markdown(self) -> str:
        """Return the report as Markdown."""
        from symobs.applications.checking.report.pages import markdown  # noqa: PLC0415 - each format pays for its own

        return markdown(self)

    def to_html(self) -> str:
        """Return the report as an HTML page of its own."""
        from symobs.applications.checking.report.feedback_page import html  # noqa: PLC0415 - each format pays for its own

        return html(self)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        return {"text/plain": self.to_text(), "text/markdown": self.to_markdown(), "text/html": self.to_html()}
