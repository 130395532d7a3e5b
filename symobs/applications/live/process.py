"""The children of the server, under a limit of time and of memory: all its mathematics is done by them."""

from __future__ import annotations

import json
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from symobs.applications.live.assets import SCHEMA, language_asked
from symobs.ground.child_processes.child import Died, Ended, Kept
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

#: A whole page may take as many times the seconds of an answer.
PAGE_FACTOR = 6
#: So many questions are answered at a time; a further one waits until a child is free.
_CHILDREN = 2
_LOOK_EVERY, _MOST_SECONDS = 0.02, 600
_LONG = {"page", "view", "export"}


@dataclass(frozen=True)
class AnswerBudget:
    """Seconds an answer may take, megabytes a child may use."""

    seconds: float = 5.0
    megabytes: int = 1000


class Gone(Exception):
    """Whoever asked has left."""


class Children:
    """The children of a server, each replaced as soon as it has ended."""

    def __init__(self, budget: AnswerBudget, module: str = "symobs.applications.live.child") -> None:
        """Start the first; it is ready a moment later, or when it is asked."""
        self.budget, self.kept = budget, Kept(module)
        self.free = threading.BoundedSemaphore(_CHILDREN)
        self.kept.add(1, megabytes=budget.megabytes)

    def answer(self, body: bytes, has_left: Callable[[], bool] = lambda: False) -> bytes:
        """Return the response to a request; raises `Gone`."""

        def look() -> None:
            if has_left():
                raise Gone

        asked = _read(body)
        seconds = self.budget.seconds * (PAGE_FACTOR if asked.get("want") in _LONG else 1)
        with self.free:
            try:
                with self.kept.one(megabytes=self.budget.megabytes) as child:
                    response: bytes = child.ask(body, min(seconds, _MOST_SECONDS), look=look, every=_LOOK_EVERY)
                    return response
            except TimeoutError:
                language = language_asked(asked)
                message = language.phrases["live_late"].format(seconds=language.decimal(f"{seconds:g}"))
            except (Died, Ended):
                message = language_asked(asked).phrases["said_memory"].format(megabytes=self.budget.megabytes)
            finally:
                self.kept.add(_CHILDREN, megabytes=self.budget.megabytes)
        undecided = {"schema": SCHEMA, "id": asked.get("id"), "status": "undecided", "message": message}
        return json.dumps(undecided).encode()

    def close(self) -> None:
        """End all, also those at work."""
        self.kept.close()


def _read(body: bytes) -> dict[str, Any]:
    """Return what a request says, as far as it can be read."""
    with suppress(ValueError, RecursionError):
        asked = json.loads(body)
        return asked if isinstance(asked, dict) else {}
    return {}
