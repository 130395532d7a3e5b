"""Interactive parts of an HTML page."""

from __future__ import annotations

from dataclasses import replace

from symobs.ground.dataclass import dataclass


@dataclass(frozen=True)
class WebPage:
    """All levels of detail to choose from, buttons that copy LaTeX, the address of the problem on a live page."""

    details: bool = False
    copy: bool = False
    live: str = ""

    @property
    def of_question(self) -> WebPage:
        """What the page of a question may offer: nothing that leads to the solution."""
        return replace(self, details=False, live="")


#: A page that is complete as it is.
PLAIN = WebPage()
