"""A headless Chromium that tests drive by playwright, and pages of it that keep what they say and ask for."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]


@contextmanager
def launched(path: str) -> Iterator[Any]:
    """Start the Chromium at a path, and end it."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - an extra that may be missing

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=_FLAGS)
        yield browser
        browser.close()


class Watched:
    """A page with what went to the console, errors and violations of its policy too, and the addresses it asked for."""

    def __init__(self, chromium: Any) -> None:
        self.page = chromium.new_page()
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda said: self.complaints.append(said.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))

    def open(self, page: Path) -> None:
        """Open a page and wait until it is loaded."""
        self.complaints.clear()
        self.requests.clear()
        self.page.goto(page.as_uri())

    def show(self, width: int, media: str = "screen", scheme: str = "light") -> None:
        """Make the window so wide, and show the page on the screen or as on paper, in light or dark colours."""
        self.page.set_viewport_size({"width": width, "height": 1000})
        self.page.emulate_media(media=media, color_scheme=scheme)
