"""The moving picture of the first page: an observer pole is dragged on the page of `symobs serve`.

`python -m tests.programs.live_picture` writes it anew from the real page; it needs Chromium and the extras `browser-test`
and `plot`.
"""

from __future__ import annotations

import io
import threading
from math import cos, pi, sin
from pathlib import Path
from urllib.parse import quote

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from symobs.applications.live.server import Server

_OUT = Path(__file__).parents[2] / ".github" / "pictures" / "live.webp"
_STATE = "v=1&task=observer&A=[0 1; 0 -1]&C=[1 0]&poles=-2+3/2i, -2-3/2i&closed=loop,page"
_FRAMES, _MILLISECONDS, _COLOURS = 24, 160, 128
#: The pole goes round an ellipse: its middle is so far left of where it begins, in pixels, and so much lower.
_WIDE, _HIGH = 45, 40
_ANSWERED = ".symobs-live:not(.stale):not(.busy)"


def frames(page: Page) -> list[Image.Image]:
    """Return the page after each step of the drag, answered."""
    hit = page.locator("[data-handle] .hit").first.bounding_box()
    first, last = (page.locator(f".panel.{name}").bounding_box() for name in ("plane", "responses"))
    if hit is None or first is None or last is None:
        raise RuntimeError("the page has no poles or no responses")
    x, y = hit["x"] + hit["width"] / 2, hit["y"] + hit["height"] / 2
    top, below = first["y"] - 6, last["y"] + last["height"] + 6
    page.mouse.move(x, y)
    page.mouse.down()
    found = []
    for k in range(_FRAMES):
        angle = 2 * pi * k / _FRAMES
        page.mouse.move(x - _WIDE * (1 - cos(angle)), y + _HIGH * sin(angle))
        page.wait_for_timeout(150)
        page.wait_for_selector(_ANSWERED)
        taken = page.screenshot(clip={"x": 0, "y": top, "width": 900, "height": below - top})
        found.append(Image.open(io.BytesIO(taken)).convert("RGB"))
    page.mouse.up()
    return found


def main() -> None:
    """Write the picture."""
    server = Server()
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path="/usr/bin/chromium", args=["--headless", "--no-sandbox"])
            page = browser.new_page(viewport={"width": 900, "height": 1000}, color_scheme="light")
            page.goto(f"{server.url}&{quote(_STATE, safe='=&')}")
            page.wait_for_selector(f"{_ANSWERED} .card math")
            taken = frames(page)
            browser.close()
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
    palette = taken[0].quantize(_COLOURS)
    first, *others = (each.quantize(palette=palette, dither=Image.Dither.NONE).convert("RGB") for each in taken)
    first.save(_OUT, save_all=True, append_images=others, duration=_MILLISECONDS, lossless=True, method=4)
    print(f"{_OUT}: {len(taken)} pictures, {_OUT.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
