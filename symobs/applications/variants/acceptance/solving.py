"""The dear tests of a candidate, as a job of a child process: solved, checked, measured, and written as a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.solving import problem_of
from symobs.applications.batch.solving import recheck as recheck_answers
from symobs.applications.checking.judgement.parts import asked_of
from symobs.applications.variants.acceptance.constraints import beyond, broken, unknown_names
from symobs.applications.variants.acceptance.profile import profile
from symobs.exact import Matrix
from symobs.ground.errors import CertificateRejected
from symobs.pages.formats.json import answer_object
from symobs.problem.expect import mismatches
from symobs.tasks.result.conversions import to_json

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.problem import Problem
    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a candidate: why it is no variant, or its answers and its profile."""
    problem = problem_of(payload)
    results = problem.solve()
    _agree(payload["gains"], results)
    constraints = payload["constraints"]
    unknown = unknown_names(constraints, results)
    if unknown:
        return {"status": "done", "result": {"reason": "a constraint names no field", "unknown": unknown}}
    reason = broken(constraints, results)
    if reason is not None:
        return {"status": "done", "result": {"reason": reason}}
    found = profile(results, problem.document(results).derivations)
    expect = expected(problem, results)
    unmet = mismatches(problem.viewed(results), expect)
    if unmet:
        raise CertificateRejected(f"an answer is not met by its own text: {unmet[0]}")
    result = {
        "reason": beyond(constraints, found),
        "answers": [answer_object(result) for result in results],
        "expect": expect,
        "profile": found,
    }
    return {"status": "done", "result": result}


def _agree(gains: Mapping[str, Any], results: Sequence[Result]) -> None:
    """Raise `CertificateRejected` where the cheap test and the engine have found different gains."""
    for name, rows in gains.items():
        for result in results:
            value = to_json(result.fields.get(name))
            if value is not None and value != [[str(entry) for entry in row] for row in rows]:
                raise CertificateRejected(f"{name} is {value}, and in whole numbers {rows}")


def expected(problem: Problem, results: Sequence[Result]) -> dict[str, Any]:
    """Return what is asked for as `[expect]` of a file has it, in the letters of its convention."""
    tables: dict[str, Any] = {}
    for view in problem.viewed(tuple(results)):
        own = {standard: name for name, (standard, _) in view.names.items()}
        found = {own.get(name, name): _value_of(view, own.get(name, name)) for name in asked_of(view.result)}
        tables[view.task] = {name: value for name, value in found.items() if value is not None}
    return tables if len(tables) > 1 else next(iter(tables.values()))


def _value_of(view: ResultInConvention, name: str) -> Any:
    return view.verdict if name == "verdict" else _written(view.fields[name])


def _written(value: Any) -> Any:
    """Return a value as a file can hold it; None where it has a part that no file can."""
    if isinstance(value, Matrix):
        return f"[{'; '.join(' '.join(str(entry).replace(' ', '') for entry in row) for row in value.rows)}]"
    if isinstance(value, (list, tuple)):
        parts = [_written(each) for each in value]
        return None if any(part is None for part in parts) else parts
    if isinstance(value, Mapping):
        return {key: part for key, each in value.items() if (part := _written(each)) is not None}
    return to_json(value)


def recheck(payload: Mapping[str, Any], row: Mapping[str, Any]) -> str | None:
    """Return what does not hold of the answers of a candidate, by other code than that which found them."""
    if row.get("status") != "done" or "answers" not in row["result"]:
        return None
    told = {"status": "done", "result": row["result"]["answers"], "key": row["key"]}
    return recheck_answers(payload, told)
