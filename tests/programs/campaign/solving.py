"""Our side of the campaign: a problem is solved in this process, and its answer taken as the JSON holds it."""

from __future__ import annotations

import signal
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING

from symobs.ground.errors import SymobsError
from symobs.pages.formats.json import result_object
from symobs.problem import validate
from symobs.problem.file_tables import parse
from tests.programs.campaign.asked import Asked, Tables, to_toml

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType


@dataclass(frozen=True)
class Refused:
    """symobs gave no answer: it refused the problem as one it does not take, or took too long."""

    kind: str
    seed: int
    problem: Tables
    reason: str


class _TooSlow(Exception):
    """The CPU time for one problem is over."""


def solved(kind: str, seed: int, problem: Tables, seconds: float = 20) -> Asked | Refused:
    """Solve a problem through the text of its file; any exception but `SymobsError` is a bug and is not caught."""
    over = Event()
    try:
        with _at_most(seconds, over):
            (result,) = validate(parse(to_toml(problem), "problem")).solve()
            return Asked(kind, seed, problem, result_object(result))
    except SymobsError as error:
        return Refused(kind, seed, problem, " ".join(str(error).split()))
    except Exception:
        # An end in the middle of a property may come out as an AttributeError.
        if over.is_set():
            return Refused(kind, seed, problem, f"no answer within {seconds:g} s")
        raise


@contextmanager
def _at_most(seconds: float, happened: Event) -> Iterator[None]:
    """Give up after so many seconds of CPU; a call into FLINT ends first."""

    def over(_number: int, _frame: FrameType | None) -> None:
        happened.set()
        raise _TooSlow

    before = signal.signal(signal.SIGPROF, over)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
