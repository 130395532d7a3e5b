"""Our side: a problem is solved in this process through the text of its file, and its answer taken as JSON holds it."""

from __future__ import annotations

import signal
from contextlib import contextmanager
from threading import Event
from typing import TYPE_CHECKING

from symobs.ground.errors import CertificateRejected, DerivationRejected, SymobsError, Undecided
from symobs.pages.formats.json import result_object
from symobs.problem import read
from tests.support.problems.random_problems import Tables, to_toml

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType


class _TooSlow(Exception):
    """The processor time for one problem is over."""


def solved(problem: Tables, seconds: float = 20) -> Tables | str:
    """Return the answer, or why there is none: refused, or too slow; any other exception is a bug and not caught."""
    over = Event()
    try:
        with _at_most(seconds, over):
            (result,) = read(to_toml(problem)).solve()
            return result_object(result)
    except Undecided as error:
        return str(error)
    except (CertificateRejected, DerivationRejected):
        raise
    except SymobsError as error:
        return " ".join(str(error).split())
    except Exception:
        # An end in the middle of a property may come out as an AttributeError.
        if over.is_set():
            return f"no answer within {seconds:g} s"
        raise


@contextmanager
def _at_most(seconds: float, happened: Event) -> Iterator[None]:
    """Give up after so many seconds of the processor; a call into FLINT ends first."""

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
