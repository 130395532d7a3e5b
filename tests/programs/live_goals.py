"""How fast live answers are, in one run: `python -m tests.programs.live_goals [SITE]`.

CPU time where it can be measured, in a process made ready as those of the server are, wall time of the round trip and of
the browser else; goals are those of a machine with two cores to itself.  The browser's figures need playwright and
chromium, and are left out without them; those of the static site need the folder SITE, which `python -m symobs.live.site`
wrote.  Ends with 1 where a figure is more than twice its goal.
"""

from __future__ import annotations

import gc
import gzip
import http.client
import json
import random
import shutil
import statistics
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.live import answer
from symobs.applications.live.child import prepare
from symobs.applications.live.server import AnswerBudget, Server
from symobs.ground.child_processes import COLLECTED_AFTER

if TYPE_CHECKING:
    from collections.abc import Iterator

GENERATOR = random.Random(7)  # noqa: S311 - repeatable by design
ANSWER_GOALS = {2: 15, 3: 25, 4: 35, 6: 60}
HEAD = "| what | median | 95 % | goal | |\n|---|---:|---:|---:|---|"
#: What is measured, and more than twice its goal.
MISSED: list[str] = []


def poles(order: int) -> str:
    """Poles on the grid of twentieths, in pairs where they fit."""
    found: list[str] = []
    while len(found) < order:
        real = Fraction(GENERATOR.randint(-200, -10), 20)
        imaginary = Fraction(GENERATOR.randint(1, 100), 20)
        pair = len(found) + 2 <= order and GENERATOR.random() < 0.5
        found += [f"{real}+{imaginary}i", f"{real}-{imaginary}i"] if pair else [str(real)]
    return ", ".join(found)


def problem(order: int) -> dict[str, Any]:
    """A compensator for a chain of integrators with feedback."""
    rows = [" ".join("1" if j == i + 1 else "0" for j in range(order)) for i in range(order - 1)]
    rows.append(" ".join(str(GENERATOR.randint(-3, 3)) for _ in range(order)))
    zeros = "; ".join("0" for _ in range(order - 1))
    plant = {"A": f"[{'; '.join(rows)}]", "B": f"[{zeros}; 1]", "C": f"[{' '.join(['1', *['0'] * (order - 1)])}]"}
    specification = {"control_poles": poles(order), "observer_poles": poles(order)}
    return {"task": "compensator", "plant": plant, "specification": specification}


def question(order: int, want: str = "answer") -> dict[str, Any]:
    """A request for what is shown while a pole moves, or for the page."""
    asked = {"schema": "symobs-live/1", "want": want, "problem": problem(order)}
    return asked | ({"cards": ["K", "L", "F"], "courses": {"count": 129}} if want == "answer" else {})


def spent(requests: list[dict[str, Any]]) -> list[float]:
    """CPU milliseconds of each answer."""
    found = []
    for request in requests:
        begin = time.process_time()
        assert answer(request)["status"] == "done"
        found.append(1000 * (time.process_time() - begin))
    return found


def row(what: str, values: list[float], goal: float) -> None:
    """Print median, 95th percentile, goal, and whether it is met."""
    high = statistics.quantiles(values, n=20)[-1] if len(values) > 1 else values[0]
    met = "met" if high <= goal else f"{high / goal:.1f} times the goal"
    if high > 2 * goal:
        MISSED.append(what)
    print(f"| {what} | {statistics.median(values):.1f} | {high:.1f} | {goal:g} | {met} |", flush=True)


@contextmanager
def running() -> Iterator[Server]:
    """A server that takes its time."""
    server = Server(budget=AnswerBudget(60, 1000))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def over_http() -> list[float]:
    """Milliseconds of a round trip above those of the answer, as its child measured them."""
    with running() as server:
        place = f"127.0.0.1:{server.server_address[1]}"
        headers = {"Origin": f"http://{place}", "Content-Type": "application/json", "X-Symobs-Token": server.token}
        connection, found = http.client.HTTPConnection(place), []
        for _ in range(150):
            body = json.dumps(question(2))
            begin = time.perf_counter()
            connection.request("POST", "/api", body, headers)
            content = connection.getresponse().read()
            found.append(1000 * (time.perf_counter() - begin) - json.loads(content)["ms"])
        connection.close()
    return found[20:]


#: Drags a handle in a plane, and waits for a change in `seen` after every move; milliseconds until it is painted.
PAINTED = """async ([x, y, steps, plane, hit, seen]) => {
  const svg = document.querySelector(plane), list = document.querySelector(seen), found = [];
  const at = (kind, k) => new PointerEvent(kind,
    { bubbles: true, pointerId: 1, clientX: x - 1.5 * k, clientY: y - k, button: 0 });
  const frame = () => new Promise(requestAnimationFrame);
  svg.setPointerCapture = () => {};
  document.querySelector(hit).dispatchEvent(at('pointerdown', 0));
  for (let k = 1; k <= steps; k += 1) {
    const changed = new Promise(done => new MutationObserver((_, o) => { o.disconnect(); done(); })
      .observe(list, { subtree: true, childList: true }));
    const begin = performance.now();
    svg.dispatchEvent(at('pointermove', 12 * (k % 5) + (k % 12)));
    await Promise.race([changed, new Promise(done => setTimeout(done, 3000))]);
    await frame();
    found.push(performance.now() - begin);
  }
  svg.dispatchEvent(at('pointerup', steps));
  return found;
}"""
REGION = {
    "task": "stability_region",
    "plant": {"A": "[0 1; 9 0]", "C": "[0 1]"},
    "specification": {"L": "[h1; h2]", "parameters": ["h1", "h2"]},
    "symbols": {"h1": "real", "h2": "real"},
}


def link(order: int) -> str:
    """The state of a compensator with a pair to drag."""
    told = problem(order)
    observer = ", ".join([*["-4"] * (order - 2), "-5+3i", "-5-3i"])
    parts = {"task": "compensator", **told["plant"], "control": told["specification"]["control_poles"]}
    parts |= {"observer": observer, "snap": "1/20", "closed": "page"}
    return "&".join(f"{name}={value}" for name, value in parts.items()).replace("+", "%2B")


def dragged(page: Any, *places: str) -> list[float]:
    """Milliseconds from every move of a handle to its answer on the screen."""
    page.wait_for_timeout(1500)
    box = page.locator(places[1]).first.bounding_box()
    assert box is not None
    times: list[float] = page.evaluate(
        PAINTED, [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, 60, *places]
    )
    return times[5:]


def in_the_browser(site: Path | None) -> None:
    """Print the times from the command to the first answer, from a pointer to the painted answer, and those of the site."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - only where it is

    with sync_playwright() as driver:
        flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=flags)
        page = browser.new_page(viewport={"width": 1180, "height": 900})
        page.set_default_timeout(300_000)
        page.goto("about:blank")
        begin = time.perf_counter()
        command = [sys.executable, "-m", "symobs", "serve", "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
            assert run.stdout is not None
            page.goto(run.stdout.readline().strip())
            page.wait_for_selector(".card math")
            row("symobs serve to first answer, ms", [1000 * (time.perf_counter() - begin)], 1500)
            run.terminate()
        with running() as server:
            for order in (2, 4):
                page.goto("about:blank")
                page.goto(f"{server.url}&v=1&{link(order)}")
                page.wait_for_selector(".card math")
                handle = page.locator(".handle.ring", has=page.locator(".hit >> nth=1")).first
                hit = f'[data-handle="{handle.get_attribute("data-handle")}"] .hit'
                row(f"pointer to painted, n = {order}, ms", dragged(page, ".plane svg", hit, ".cards .list"), 100)
            page.goto("about:blank")
            state = "A=[0 1; 9 0]&C=[0 1]&L=[h1; h2]&parameters=h1, h2&symbols=h1:real,h2:real&closed=page,cards"
            page.goto(f"{server.url}&v=1&task=stability_region&{state}")
            page.wait_for_selector(".point math")
            row("pointer to painted, region, ms", dragged(page, ".map svg", ".pick .hit", ".point"), 40)
        if site is not None:
            from tests.programs.live_site import looked_at, served  # noqa: PLC0415 - it takes its script from here

            with served(site) as address:
                looked_at(browser.new_context(viewport={"width": 1180, "height": 900}), address)
        browser.close()


def main() -> int:
    """Measure everything and print the table; memory is cleared as seldom as in the processes that answer."""
    site = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    prepare()
    gc.freeze()
    gc.set_threshold(COLLECTED_AFTER)
    spent([question(2) for _ in range(10)])
    print(HEAD)
    answers = {order: spent([question(order) for _ in range(100)]) for order in ANSWER_GOALS}
    for order, goal in ANSWER_GOALS.items():
        row(f"answer, n = {order}, CPU ms", answers[order], goal)
    points = [
        {"schema": "symobs-live/1", "want": "point", "problem": REGION, "at": {"h1": f"{k}/20", "h2": f"{40 - k}/20"}}
        for k in range(-20, 60)
    ]
    spent(points[:2])
    row("point of a region, CPU ms", spent(points), 40)
    pages = [question(GENERATOR.choice((2, 3, 4)), "page") for _ in range(200)]
    times = spent(pages)
    row("page, 200 compensators of order 2 to 4, CPU ms", times, 1000)
    ratio = statistics.median(times) / statistics.median(answers[2] + answers[3] + answers[4])
    print(f"| a page costs as much as so many answers | {ratio:.0f} | | | |")
    row("HTTP above the answer, n = 2, ms", over_http(), 5)
    if site is not None:
        packed = sum(len(gzip.compress(path.read_bytes(), 6)) for path in site.rglob("*") if path.is_file())
        row("site: transfer gzipped, MB", [packed / 1e6], 15)
    try:
        in_the_browser(site)
    except ImportError:
        print("(no browser: pip install symobs[browser-test])")
    return 1 if MISSED else 0


if __name__ == "__main__":
    sys.exit(main())
