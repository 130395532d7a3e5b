"""The widget of notebooks: the page of `symobs serve` below a cell, answered by the kernel.

The front-end is the same module; questions and answers are messages instead of requests.  Where there is no kernel the
notebook shows the derivation of the problem that the widget began with.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from symobs.applications.live.answering import answer, result_of
from symobs.applications.live.assets import ASSETS, script, style
from symobs.applications.live.page import page_object
from symobs.applications.live.request import link_of
from symobs.ground.errors import UsageError
from symobs.problem import parse, text_of, validate
from symobs.system import StateSpace, as_plant
from symobs.tasks.result.output_methods import signs

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.problem import Problem
    from symobs.tasks.result import Result

_IMPORTED = 'import { mount } from "./symobs-live.js";\n'


def front_end() -> str:
    """Return the front-end as the one module that anywidget takes."""
    own = (ASSETS / "start-widget.js").read_text(encoding="utf-8")
    return script() + own.replace(_IMPORTED, "")


class LiveWidget(anywidget.AnyWidget):  # type: ignore[misc] # it is not typed where it is not installed
    """A problem whose poles, entries and parameters are moved in a notebook; `state` is that of a link."""

    _esm = front_end()
    _css = style()
    state = traitlets.Unicode("").tag(sync=True)

    def __init__(self, data: Mapping[str, Any]) -> None:
        """Begin with a problem, whose errors are raised here."""
        self._problem: Problem = validate(data)
        self._result = self._problem.solve()[-1]
        self._first = self._result
        self._told: list[Callable[[Result], object]] = []
        super().__init__(state=link_of(data))
        self.on_msg(self._answer)

    @property
    def result(self) -> Result:
        """The result of the newest answer."""
        return self._result

    def on_change(self, callback: Callable[[Result], object]) -> None:
        """Call a function with the result of every answer from now on."""
        self._told.append(callback)

    def _answer(self, _: object, message: Any, __: object) -> None:
        """Answer a question of the front-end."""
        if not isinstance(message, Mapping) or "id" not in message:
            return
        body = message.get("body")
        found = answer(body)
        self.send({"id": message["id"], "body": found})
        if isinstance(body, Mapping) and body.get("want", "answer") == "answer" and found["status"] in {"done", "no"}:
            self._result = result_of(body)
            for callback in self._told:
                callback(self._result)

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """Return the view of the widget, and the derivation of its first problem for where there is no kernel."""
        bundle = super()._repr_mimebundle_(**kwargs)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle or {}, {})
        return {**data, "text/html": page_object(self._problem, self._first, "full")["html"]}, metadata


def widget(problem: Any, plant: Any, task: str | None, specification: Mapping[str, Any]) -> LiveWidget:
    """Return the widget of a problem file, a mapping, or a task with its plant and specification."""
    if problem is None:
        if task is None:
            raise UsageError("nothing is asked", where="task", repair='write for example task="observer"')
        own = {} if plant is None else _plant_data(as_plant(plant))
        return LiveWidget({"task": task, **own, "specification": {name: _text(v) for name, v in specification.items()}})
    if plant is not None or task is not None or specification:
        raise UsageError("a problem file says all of it", where="problem", repair="give either a problem or a task")
    if isinstance(problem, Mapping):
        return LiveWidget(problem)
    text, folder = text_of(problem)
    return LiveWidget(parse(text, "problem" if folder is None else str(problem)))


def _plant_data(plant: StateSpace) -> dict[str, Any]:
    """Return the tables `plant` and `symbols` of a problem file."""
    m = plant.matrices
    given = {"A": m.A, "B": m.B if m.has_input else None, "C": m.C if m.has_output else None}
    given["D"] = m.D if m.has_input and m.has_output and not m.D.is_zero else None
    table: dict[str, Any] = {name: _rows(value) for name, value in given.items() if value is not None}
    if plant.is_discrete:
        table["dt"] = plant.dt if isinstance(plant.dt, bool) else str(plant.dt)
    if plant.delay is not None:
        table |= {"delay": str(plant.delay)} | ({} if plant.pade is None else {"pade": str(plant.pade)})
    return {"plant": table, "symbols": signs(plant)}


def _rows(matrix: Matrix) -> list[list[str]]:
    return [[str(entry).replace("**", "^") for entry in row] for row in matrix.rows]


def _text(value: Any) -> Any:
    """Return a value as a problem file has it: exact text, and lists of it."""
    if isinstance(value, (list, tuple)):
        return [_text(entry) for entry in value]
    if isinstance(value, Mapping):
        return {name: _text(part) for name, part in value.items()}
    return value if isinstance(value, (bool, int, float)) else str(value)
