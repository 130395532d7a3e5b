"""The pictures of the README that show a drag: `python -m tests.programs.live_pictures` (needs playwright and chromium)."""

from __future__ import annotations

import shutil
import threading
from typing import Any
from urllib.parse import quote

from symobs.applications.live.server import AnswerBudget, Server
from tests.support.paths import ROOT

FOLDER = ROOT / ".github" / "pictures"
STATE = "v=1&task=observer&A=[0 1; 0 -1]&B=[0; 1]&C=[1 0]&poles=-2+3/2i, -2-3/2i&x0=1, 1&xh0=0, 0&closed=page"
#: Where the pole is dragged to, in pixels from where it was before.
MOVES = ((0, 0), (-30, 22), (-50, -40))
HIDDEN = ".bar, .plant, .fields, .legend, .panel > header, [data-name=B_u], [data-name=A], [data-name=conditions]"


def drawn(page: Any) -> None:
    """Wait until what is shown is what was asked."""
    page.wait_for_selector(".card math")
    for _ in range(40):
        page.wait_for_timeout(100)
        if not page.evaluate("Boolean(document.querySelector('.symobs-live[aria-busy=true]'))"):
            break
    page.wait_for_timeout(300)


def take(browser: Any, server: Server) -> None:
    """Write the stills of one drag."""
    page = browser.new_page(viewport={"width": 400, "height": 900}, device_scale_factor=1.5, color_scheme="light")
    page.goto(f"{server.url}&{quote(STATE, safe='=&')}")
    drawn(page)
    page.evaluate(f"() => document.querySelectorAll({HIDDEN!r}).forEach((e) => {{ e.style.display = 'none'; }})")
    box = page.locator('[data-handle="poles.0"] .hit').first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for number, (right, down) in enumerate(MOVES, 1):
        x, y = x + right, y + down
        page.mouse.move(x, y, steps=4)
        drawn(page)
        page.locator(".grid").screenshot(path=FOLDER / f"live_{number}.png")
    page.mouse.up()


def main() -> None:
    """Write all of them."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - of the extra browser-test

    server = Server(budget=AnswerBudget(60, 1000))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    with sync_playwright() as driver:
        flags = ["--headless", "--no-sandbox", "--disable-gpu"]
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=flags)
        take(browser, server)
        browser.close()
    server.shutdown()
    server.server_close()


if __name__ == "__main__":
    main()
