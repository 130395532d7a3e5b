"""Hold the static site against the engine: `python -m tests.programs.live_site SITE [NAME …]`.

SITE is a folder that `python -m symobs.live.site` wrote.  It is served with its policy as a header, and opened in the
Chromium of the machine.  Every worked example is asked for its view, its answer with curves, its JSON, its LaTeX and its
page, each of which has to be what this process says; where names are given, these alone.  Needs playwright.
"""

from __future__ import annotations

import functools
import json
import re
import shutil
import sys
import threading
import tomllib
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.live.child import respond
from symobs.applications.live.site import POLICY
from tests.support.tools.browser import launched

if TYPE_CHECKING:
    from collections.abc import Iterator

EXAMPLES = Path(__file__).parents[2] / "worked_examples"
QUESTIONS: tuple[dict[str, Any], ...] = (
    {"want": "view"},
    {"want": "answer", "courses": {"count": 33}, "cases": True},
    {"want": "export", "as": "json"},
    {"want": "export", "as": "latex"},
    {"want": "page"},
)
#: What differs by nature: a certificate of random points says the size of the machine's words.
OF_WORDS = re.compile(r"at \d+ random points? modulo \d+-bit primes\",\s*\"bound\": \"[^\"]*")
#: Asks a worker of its own, which stays for the next question; one that ended is replaced.
ASK = """(question) => new Promise((done) => {
  window.asked ??= new Worker("worker.js", { type: "module" });
  const timer = setTimeout(() => end("longer than five minutes"), 300000);
  const answered = (found) => { clearTimeout(timer); done(found); };
  const end = (message) => { window.asked.terminate(); window.asked = null; answered({ ended: message }); };
  window.asked.onerror = (event) => end(event.message);
  window.asked.onmessage = ({ data }) => { if (data.ended) end(data.ended); else if (data.answer) answered(data.answer); };
  window.asked.postMessage(question);
})"""


class Files(SimpleHTTPRequestHandler):
    """A static server that adds the policy of the page to every file, so that it holds in workers too."""

    def end_headers(self) -> None:
        """Add it."""
        self.send_header("Content-Security-Policy", POLICY)
        super().end_headers()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


def differences(page: Any, names: list[str]) -> list[str]:
    """Return what the site answers otherwise; one line a question."""
    found, asked, by_words = [], 0, 0
    for name in names:
        data = tomllib.loads((EXAMPLES / f"{name}.toml").read_text("utf-8"), parse_float=str)
        kept = {key: data[key] for key in data if key not in {"expect", "printed", "title", "source", "id"}}
        for task in data.get("tasks") or [data["task"]]:
            for question in QUESTIONS:
                request = {"schema": "symobs-live/1", "id": 1, "problem": kept, "task": task, **question}
                native = json.loads(respond(json.dumps(request).encode()))
                there = page.evaluate(ASK, request)
                asked += 1
                for answer in (native, there):
                    answer.pop("ms", None)
                if native != there and _of_words(native) == _of_words(there):
                    by_words += 1
                elif native != there:
                    keys = [key for key in {**native, **there} if native.get(key) != there.get(key)]
                    told = there.get("ended") or there.get("message") or there.get("errors") or ""
                    found.append(f"{name}, {task}, {question['want']}: {', '.join(sorted(keys))} differ {told}")
                    print(found[-1], flush=True)
        print(f"\r{name:40}", end="", file=sys.stderr, flush=True)
    print(f"\r{asked} questions about {len(names)} worked examples, {len(found)} answered otherwise")
    print(f"({by_words} more name primes of 32 bits in place of 64, with their bound)")
    return found


def _of_words(answer: dict[str, Any]) -> dict[str, Any]:
    """Return an answer without what depends on the size of words."""
    return {key: OF_WORDS.sub("", entry) if isinstance(entry, str) else entry for key, entry in answer.items()}


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder with the policy of the site; its address."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Files, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}/"
    server.shutdown()
    server.server_close()


def main(folder: Path, names: list[str]) -> int:
    """Print everything; 1 where an answer differs."""
    with launched(str(shutil.which("chromium"))) as browser, served(folder) as address:
        page = browser.new_page()
        page.goto(f"{address}THIRD-PARTY.txt")
        found = differences(page, names or sorted(path.stem for path in EXAMPLES.glob("*.toml")))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2:]))
