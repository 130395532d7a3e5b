"""The static site in a real browser, without Python: its worker is a stand-in that gives answers recorded before.

`programs/live_site.py` opens it with Python and holds its answers against those of the engine.
"""

from __future__ import annotations

import functools
import json
import threading
import zipfile
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

import pytest

from symobs.applications.live import answer
from symobs.applications.live.site import build
from tests.programs.live_site import Files

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.slow
SERVO = "v=1&task=observer&A=[0 1; 0 -1]&C=[1 0]&poles=-10, -10&closed=responses"
PROBLEM = {"task": "observer", "plant": {"A": "[0 1; 0 -1]", "C": "[1 0]"}, "specification": {"poles": "-10, -10"}}
RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
PATIENCE = 60_000  # milliseconds; ends a page that hangs, measures nothing
#: It ends at a pole of −99, and never answers at one of −98; its answers name it.
WORKER = """
const own = crypto.randomUUID();
onmessage = ({ data }) => {
  postMessage({ loading: "Python" });
  postMessage({ begun: true });
  const poles = data.problem?.specification.poles ?? "";
  if (poles.includes("-99")) postMessage({ ended: "memory" });
  else if (!poles.includes("-98")) postMessage({ answer: { ...ANSWERS[data.want], id: data.id, note: own } });
};
"""


@pytest.fixture(name="folder", scope="module")
def written_site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    _written(folder)
    return folder


@pytest.fixture(name="site")
def served_site(folder: Path) -> Iterator[ThreadingHTTPServer]:
    yield from served(Files, folder / "out")


def served(kind: type[SimpleHTTPRequestHandler], folder: Path) -> Iterator[ThreadingHTTPServer]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(kind, directory=folder))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def _written(folder: Path) -> None:
    pyodide, wheel = folder / "pyodide", folder / "python_flint-1-cp314-cp314-pyemscripten_2026_0_wasm32.whl"
    pyodide.mkdir()
    for name in RUNTIME:
        (pyodide / name).write_text(name)
    (pyodide / "package.json").write_text('{"version": "1.2.3"}')
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("flint/__init__.py", "")
    build(folder / "out", pyodide, wheel)
    wants = ("view", "answer", "page", "start")
    told = {want: answer({"schema": "symobs-live/1", "want": want, "problem": PROBLEM}) for want in wants}
    worker = f"const ANSWERS = {json.dumps(told)};{WORKER}"
    (folder / "out" / "worker.js").write_text(worker, "utf-8")


@pytest.fixture(name="page")
def opened_page(chromium: Any, site: ThreadingHTTPServer) -> Iterator[Any]:
    context = chromium.new_context()
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.clock.install()
    page.goto(f"http://127.0.0.1:{site.server_address[1]}/#{SERVO}")
    page.wait_for_selector(".card math")
    yield page
    context.close()


def answered_by(page: Any, poles: str) -> str:
    """Ask for poles, and return which worker answered."""
    page.fill('[data-set="poles"]', poles)
    page.keyboard.press("Tab")
    page.locator(".symobs-live:not([aria-busy=true]):not(.stale) .notes:not(:empty)").wait_for()
    found: str = page.inner_text(".notes")
    return found


def test_a_worker_that_ends_is_replaced(page: Any) -> None:
    first = answered_by(page, "-7, -8")
    assert answered_by(page, "-7, -9") == first
    page.fill('[data-set="poles"]', "-7, -99")
    page.keyboard.press("Tab")
    page.wait_for_selector(".message:has-text('Undecided: Python ended: memory.')")
    assert page.input_value('[data-set="poles"]') == "-7, -99"
    assert answered_by(page, "-7, -8") != first


def test_a_question_that_takes_too_long_is_given_up_and_has_a_minute_when_asked_again(page: Any) -> None:
    page.fill('[data-set="poles"]', "-7, -98")
    page.keyboard.press("Tab")
    page.wait_for_selector(".symobs-live.busy")
    page.clock.run_for(11_000)
    page.wait_for_selector(".message:has-text('Undecided: not decided within 10 s.')")
    page.click("text=Try again")
    page.wait_for_selector(".symobs-live.busy")
    page.clock.run_for(59_000)
    assert page.is_hidden(".message")
    page.clock.run_for(2_000)
    page.wait_for_selector(".message:has-text('not decided within 60 s')")


def test_the_site_can_be_a_part_of_another_page_without_its_derivation(page: Any, tmp_path: Path) -> None:
    address = page.url.replace("closed=responses", "closed=page")
    (tmp_path / "index.html").write_text(f'<iframe src="{address}" width="900" height="700"></iframe>', "utf-8")
    for other in served(SimpleHTTPRequestHandler, tmp_path):
        page.goto(f"http://127.0.0.1:{other.server_address[1]}/")
        frame = page.frame_locator("iframe")
        frame.locator(".card math").first.wait_for()
        assert frame.locator(".responses").is_visible()
        assert frame.locator(".page").is_hidden()


def test_the_site_opens_and_answers_when_its_server_is_gone(page: Any, site: ThreadingHTTPServer) -> None:
    page.evaluate("() => navigator.serviceWorker.ready.then(() => true)")
    site.shutdown()
    site.server_close()
    address = page.url
    page.goto("about:blank")
    page.goto(address)
    page.wait_for_selector(".card math")
    page.wait_for_selector(".html math")
    assert page.locator(".first").count() == 0
    assert page.get_attribute('.card[data-name="L"] .display', "data-latex") == r"L=\begin{bmatrix}19\\81\end{bmatrix}"
