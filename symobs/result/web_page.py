"""What a page of HTML may offer besides its text."""

from __future__ import annotations

from symobs._dataclass import dataclass


@dataclass(frozen=True)
class WebPage:
    """All levels of detail to choose from, buttons that copy LaTeX, the address of the problem on a live page."""

    details: bool = False
    copy: bool = False
    live: str = ""


#: A page that is complete as it is.
PLAIN = WebPage()
