"""Live: answers while a pole, a parameter or an entry is moved, each of them checked before it is shown.

`answer` is one pure function from a request to a response, both JSON objects of the protocol `symobs-live/1`.  Whatever
carries them (the server of `symobs serve`, a notebook, a worker in a browser) computes no mathematics of its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from symobs.applications.live.notebook import LiveWidget

__all__ = ["answer", "live"]


def answer(request: object) -> dict[str, Any]:
    """Return the response to a request of the protocol `symobs-live/1`; nothing is raised.

    `status` is `done`, `no` (a mathematical no), `bad` (all errors of the request), `undecided`, or `bug`.
    """
    from symobs.applications.live.answering import answer as found  # noqa: PLC0415 - who hands requests on does not answer them

    return found(request)


def live(problem: Any = None, /, *, plant: Any = None, task: str | None = None, **specification: Any) -> LiveWidget:
    """Show a problem in a notebook, where its poles, entries and parameters are moved and every answer is checked.

    problem         a problem file (its path or its text), or a mapping with its tables
    plant, task     in its place: a plant and the name of a task, with the keywords of the task
    Returns a widget: `result` is the result of the newest answer, `state` the text of a link, and `on_change(f)` calls
    f(result) after every answer.  Raises `ProblemErrors` for what is wrong with the problem, and `UsageError` where the
    extra `notebook` (anywidget) is not installed.
    """
    try:
        from symobs.applications.live.notebook import widget  # noqa: PLC0415 - it needs anywidget
    except ImportError:
        repair = "pip install 'symobs[notebook]', or use `symobs serve`"
        raise UsageError("anywidget is not installed", repair=repair) from None
    return widget(problem, plant, task, specification)
