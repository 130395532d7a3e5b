"""What tests of runs share: many small problems, kinds of work that misbehave, and executors of their own."""

from __future__ import annotations

import json
import os
import time
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

#: A kind of work for tests: what its payload says is done, among it what ends a process or never ends.
_HOSTILE = """
import os, time

def run(payload):
    with open(payload["log"], "a") as log:
        log.write(payload["name"] + "\\n")
    does = payload["does"]
    if does == "abort":
        os.abort()
    if does == "eat":
        bytearray(8 << 30)
    if does == "hang":
        while True:
            time.sleep(1000)
    if does == "sleep":
        time.sleep(float(payload["seconds"]))
    if does == "raise":
        raise KeyError("x")
    return {"status": "done", "result": {"square": payload["number"] ** 2}}

def recheck(payload, row):
    return None if row.get("result", {}).get("square", payload["number"] ** 2) == payload["number"] ** 2 else "no square"
"""
_SITE = """
import sys
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import PathFinder

class Finder(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name != "symobs.applications.batch.jobs":
            return None
        spec = PathFinder.find_spec(name, path)
        run = spec.loader.exec_module
        def exec_module(module):
            run(module)
            module.KINDS["hostile"] = "hostile_kind"
        spec.loader.exec_module = exec_module
        return spec

sys.meta_path.insert(0, Finder())
"""


def hostile_kind(folder: Path) -> str:
    """Write the kind `hostile` into a folder; return the PYTHONPATH with which every process knows it."""
    (folder / "hostile_kind.py").write_text(_HOSTILE, "utf-8")
    (folder / "sitecustomize.py").write_text(_SITE, "utf-8")
    return os.pathsep.join([str(folder), str(ROOT)])


def design(number: int) -> str:
    """A compensator of third order, another one for each number."""
    return f"""
task = "compensator"
[plant]
A = "[0 1 0; 0 0 1; -6 -11 -{number}]"
B = "[0; 0; 1]"
C = "[1 0 0]"
[specification]
control_poles = [-1, -2, -3]
observer_poles = [-10, -12, -14]
"""


class Tampering(Executor):
    """An executor whose worker changes a digit of one result, and its hash as well."""

    def __init__(self, name: str, change: Callable[[dict[str, Any]], None]) -> None:
        self.name, self.change = name, change

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        from symobs.applications.batch.jobs import digest  # noqa: PLC0415

        future: Future[Any] = Future()
        texts, seconds = fn(*args, **kwargs)
        rows = [json.loads(text) for text in texts]
        for row, (key, *_) in zip(rows, args[0], strict=True):
            if key == self.name:
                self.change(row)
                row["sha256"] = digest(row["result"])
        future.set_result(([json.dumps(row) for row in rows], seconds))
        return future


def eventually(holds: Callable[[], object], seconds: float = 120.0) -> bool:
    """Whether something comes to hold; the time is a safety net and measures nothing."""
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


def children_of(parent: int) -> list[int]:
    """The processes that work for a process, by what Linux knows of their parents; those of ended parents too."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes().split(b"\0")
        except OSError:
            continue
        if (
            b"symobs.applications.batch.child" in words
            and words[words.index(b"symobs.applications.batch.child") + 1] == str(parent).encode()
        ):
            found.append(int(path.parent.name))
    return found
