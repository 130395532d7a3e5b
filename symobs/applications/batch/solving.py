"""The work of solving a problem: its answers, the pages that are asked for, and how it went."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.recheck import fault
from symobs.ground.errors import InputError
from symobs.pages.formats.json import answer_object, result_object
from symobs.problem import parse, validate
from symobs.problem.expect import held_against
from symobs.system.specification import desired_polynomial
from symobs.tasks.result import render
from symobs.tasks.result.output_methods import to_json

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.problem import Problem
    from symobs.tasks.result import Result, Task


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a problem: its results as JSON, and the pages asked for."""
    problem = problem_of(payload)
    results = problem.solve()
    shown = _SHOWN[payload["fields"]]
    row: dict[str, Any] = {**_how_it_went(problem, results), "result": [shown(result) for result in results]}
    if payload["formats"]:
        document = replace(problem.document(results), templates=None, digits=payload.get("digits", problem.digits))
        row["files"] = {name: render(document, name) for name in payload["formats"]}
    return row


def _with_cases(result: Result) -> dict[str, Any]:
    """Return what was asked for, and where cases of their own begin."""
    cases = [{"when": [to_json(condition) for condition in case.when]} for case in result.case_tree]
    return {**answer_object(result), "cases": cases}


_SHOWN = {"all": result_object, "answer": answer_object, "cases": _with_cases}


def problem_of(payload: Mapping[str, Any]) -> Problem:
    """Return the problem of a job; raises `ProblemErrors` with all its errors."""
    if "unread" in payload:
        raise InputError(payload["unread"])
    if "text" in payload:
        return validate(parse(payload["text"]))
    if "convention_file" not in payload:
        return validate(payload["problem"])
    with TemporaryDirectory() as folder:
        name = str(payload["problem"]["convention"]).removesuffix(".toml")
        (Path(folder) / f"{name}.toml").write_text(payload["convention_file"], "utf-8")
        return validate(payload["problem"], folder=Path(folder))


def _how_it_went(problem: Problem, results: tuple[Result, ...]) -> dict[str, Any]:
    """Return the status of a row: `no` for a mathematical no, or where what is expected is not met."""
    if problem.expect:
        unmet, is_open = held_against(problem.viewed(results), problem.expect)
        return {"status": "undecided" if is_open else "no", "error": unmet} if unmet else {"status": "done"}
    verdicts = {result.verdict for result in results}
    return {"status": "no" if "no" in verdicts else "undecided" if "undecided" in verdicts else "done"}


_HALVES = {
    "state_feedback": ("control",),
    "integral_action": ("control",),
    "observer": ("observer",),
    "compensator": ("control", "observer"),
}


# -- checking again ---------------------------------------------------------------------------------------------------


def recheck(payload: Mapping[str, Any], row: Mapping[str, Any]) -> str | None:
    """Return what does not hold of the answers of a row, in plain fractions; None where all that is looked at does."""
    if row["status"] in {"unreadable", "failed"} or "result" not in row:
        return None
    problem = problem_of(payload)
    for task, answer in zip(problem.tasks, row["result"], strict=True):
        if task.name != answer.get("task"):
            return f"the answer is one of {answer.get('task')!r}, {task.name} was asked for"
        if problem.follows(task.name):  # its plant is an answer, and in no data
            continue
        found = fault(task.name, given_for(problem, task), answer, seed=row["key"])
        if found:
            return f"{task.name}: {found}"
    return None


def given_for(problem: Problem, task: Task) -> dict[str, Any]:
    """Return the data of a task as texts: the matrices, the polynomials asked for, the signs of the symbols."""
    plant, asked = problem.plant, problem.specification
    m = plant.matrices
    there = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_input and m.has_output}
    given: dict[str, Any] = {
        name: [[str(entry) for entry in row] for row in getattr(m, name).rows]
        for name, is_there in there.items()
        if is_there
    }
    given |= {"variable": plant.variable, "signs": dict(plant.symbols.signs), "polynomials": {}}
    is_minimal = "observer_poles" in task.keywords and task.degree("observer_poles", plant, asked) < plant.order
    given["observer"] = "minimal" if is_minimal else "full"
    given["discrete"] = plant.is_discrete
    halves = _HALVES.get(task.name, ())
    for half in halves:
        own = {"poles", "polynomial"} & asked.keys() and len(halves) == 1
        poles, polynomial = (name if own else f"{half}_{name}" for name in ("poles", "polynomial"))
        if {poles, polynomial} & asked.keys() and not (half == "observer" and given["observer"] == "minimal"):
            degree = task.degree("poles" if len(halves) == 1 else poles, plant, asked)
            found = desired_polynomial(plant, asked.get(poles), asked.get(polynomial), degree=degree, required=False)
            given["polynomials"][half] = None if found is None else str(found.polynomial)
    return given
