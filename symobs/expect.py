"""Holding a result against expected answers: compared as mathematics, never as text."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from symobs.conditions import Condition
from symobs.errors import CertificateRejected, InputError, ProblemErrors, SymobsError
from symobs.exact import Complex, Factored, Matrix, Root, Scalar, rank, root_of_pole
from symobs.expression import parse_matrix, parse_poles, parse_scalar

if TYPE_CHECKING:
    from symobs.method import Result

_RELATION = re.compile(r"^(.*?)(!=|==|>=|<=|>|<)(.*)$", re.DOTALL)


def mismatches(results: Sequence[Result], expect: Mapping[str, Any]) -> list[str]:
    """Return one line for each expected answer that is not met; raises `ProblemErrors` for what cannot be read.

    `[expect.TASK]` belongs to one task; other keys belong to every task that has the field, and at least one must.
    """
    lines: list[str] = []
    errors: list[SymobsError] = []
    by_task = {result.task: result for result in results}
    for key, entry in expect.items():
        if isinstance(entry, Mapping) and key in by_task:
            pairs = [(by_task[key], name, value, f"expect.{key}.{name}") for name, value in entry.items()]
        else:
            having = [result for result in results if key in _available(result)]
            if not having:
                known = sorted({name for result in results for name in _available(result)})
                message = f"no task here has a field {str(key)[:40]!r}"
                errors.append(InputError(message, where="expect", repair=f"known fields are {', '.join(known)}"))
            pairs = [(result, key, entry, f"expect.{key}") for result in having]
        for result, name, value, where in pairs:
            try:
                if name not in _available(result):
                    message = f"{result.task} has no field {str(name)[:40]!r}"
                    raise InputError(message, where=where, repair=f"known fields are {', '.join(_available(result))}")
                if not met(result, name, value, where):
                    lines.append(f"{where}: expected {str(value)[:200]}, found {_shown(_found(result, name))}")
            except SymobsError as error:
                errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    return lines


def _available(result: Result) -> list[str]:
    return ["verdict", "conditions", *result.fields]


def _found(result: Result, name: str) -> Any:
    if name == "verdict":
        return result.verdict
    if name == "conditions":
        return result.conditions
    return result.fields[name]


def _shown(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_shown(entry) for entry in value) + "]"
    return str(value)[:200]


def met(result: Result, name: str, expected: Any, where: str) -> bool:
    """Tell whether an expected answer holds for a result; of answers that are not unique any member will do."""
    found = _found(result, name)
    names = None if not result.plant.symbols.closed else result.plant.symbols.names
    variable = result.plant.variable
    if isinstance(found, Matrix):
        wanted = parse_matrix(expected, names, where=where)
        return wanted == found or _is_member(result, name, wanted)
    if isinstance(found, Factored):
        return _scalar(expected, names, variable, where) == found.value
    if isinstance(found, Scalar):
        return _scalar(expected, names, variable, where) == found
    if found is None or isinstance(found, (str, bool, int)):
        return bool(found == expected)
    if isinstance(found, (list, tuple)):
        return _lists_agree(list(found), expected, names, variable, where)
    message = f"the field {name} cannot be compared"
    raise InputError(message, where=where, repair="leave it out")


def _scalar(expected: Any, names: Any, variable: str, where: str) -> Scalar:
    return parse_scalar(str(expected), names, variable=variable, where=where)


def _is_member(result: Result, name: str, wanted: Matrix) -> bool:
    """Whether another gain meets the claims: it does where the answer is one of a family."""
    if name not in result.answer or not isinstance(result.answer[name], Matrix) or result.fields.get("family") is None:
        return False
    if wanted.shape != result.answer[name].shape:
        return False
    try:
        result.with_answer(name, wanted)
    except CertificateRejected:
        return False
    return True


def _lists_agree(found: list[Any], expected: Any, names: Any, variable: str, where: str) -> bool:
    entries = expected if isinstance(expected, list) else [expected]
    if all(isinstance(entry, Root) for entry in found):
        if not found and not entries:
            return True
        poles = parse_poles(expected, names, where=where) if entries else ()
        return Counter(_key(root) for root in found) == Counter(_key(root_of_pole(p, variable)) for p in poles)
    if all(isinstance(entry, Condition) for entry in found):
        wanted = {_direction(entry, names, where) for entry in entries}
        return wanted == {(_primitive(c.expression), c.operator) for c in found}
    if all(isinstance(entry, str) for entry in found):
        return {_direction(e, names, where) for e in entries} == {_direction(e, names, where) for e in found}
    if all(isinstance(entry, list) for entry in found):
        return _same_span(found, entries, names, where)
    return bool(found == entries)


def _key(root: Root) -> Any:
    exact: Complex | None = root.exact()
    return exact if exact is not None else (root.centre, root.radicand, root.sign, root.factor, root.index)


def _direction(text: Any, names: Any, where: str) -> tuple[Scalar, str]:
    """Return a relation as (what is compared with 0 up to a positive factor, operator)."""
    if text == "False":
        return Scalar.of(0), ">"
    match = _RELATION.match(str(text))
    if match is None:
        message = f"{str(text)[:60]!r} is not a relation"
        raise InputError(message, where=where, repair='write for example "2*c - 1 != 0"')
    left, operator, right = match.groups()
    difference = parse_scalar(left, names, where=where) - parse_scalar(right, names, where=where)
    if operator in {"<", "<="}:
        difference, operator = -difference, operator.replace("<", ">")
    if operator in {"!=", "=="}:
        return _primitive(difference), operator
    unit = difference.factors()[0] if difference else Scalar.of(1)
    size = abs(unit.fraction())
    return difference / Scalar.of(size), operator


def _primitive(value: Scalar) -> Scalar:
    """Return the polynomial up to its unit."""
    unit, _ = value.factors()
    return value / unit if value else value


def _same_span(found: list[list[Scalar]], expected: list[Any], names: Any, where: str) -> bool:
    if len(found) != len(expected):
        return False
    if not found:
        return True
    wanted = [parse_matrix([entry] if not isinstance(entry, str) else entry, names, where=where) for entry in expected]
    rows = [Matrix.row(vector) for vector in found]
    columns = [row if row.shape[0] == 1 else row.T for row in wanted]
    if any(row.shape != rows[0].shape for row in columns):
        return False
    together = Matrix.block([[row] for row in [*rows, *columns]])
    return rank(together) == rank(Matrix.block([[row] for row in columns])) == len(rows)
