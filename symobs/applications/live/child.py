"""The process that answers: the bytes of a request in, the bytes of a response out."""

from __future__ import annotations

import json
import os
import time
from itertools import count

from symobs.applications.live.answering import answer, errors_of
from symobs.applications.live.assets import SCHEMA
from symobs.applications.live.beginning import SERVO
from symobs.applications.live.request import parsed
from symobs.formula.phrases.languages import ENGLISH
from symobs.ground.child_processes.inside import serve
from symobs.ground.errors import SymobsError

#: It is replaced after so many answers, or when it has grown to so many megabytes.
MOST_ANSWERS, MOST_MEGABYTES = 10_000, 500
_answers = count(1)


def prepare() -> None:
    """Solve the problem that the page begins with, so that the first question pays for nothing; further tasks wait."""
    poles = {"control_poles": "-2, -2", "observer_poles": "-10, -10"}
    problem = {"task": "compensator", "plant": SERVO, "specification": poles}
    for want in ("view", "answer"):
        answer({"schema": SCHEMA, "want": want, "problem": problem, "courses": {"count": 9}})


def respond(body: bytes) -> bytes:
    """Return the response to the bytes of a request."""
    begin = time.perf_counter()
    try:
        found = answer(parsed(body))
    except SymobsError as error:
        found = {"schema": SCHEMA, "id": None, "status": "bad", "errors": errors_of(error, ENGLISH)}
    found["ms"] = round(1000 * (time.perf_counter() - begin), 1)
    whole = json.dumps(found, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "backslashreplace")
    if len(whole) > 2**20:
        found = {key: found.get(key) for key in ("schema", "id")}
        whole = json.dumps(found | {"status": "undecided", "message": "the answer is longer than 1 MB"}).encode()
    return whole


def is_worn() -> bool:
    """Return whether this process has answered enough, or has grown too large."""
    if next(_answers) >= MOST_ANSWERS:
        return True
    try:
        with open("/proc/self/statm", encoding="ascii") as stream:  # noqa: PTH123 - no file of anybody
            pages = int(stream.read().split()[1])
    except (OSError, ValueError, IndexError):
        return False
    return pages * os.sysconf("SC_PAGE_SIZE") > MOST_MEGABYTES << 20


if __name__ == "__main__":
    serve(prepare, respond, is_worn)
