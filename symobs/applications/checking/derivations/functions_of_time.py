"""Lines that say what a function of time is, x(t) = [...], y(t) = ... and exp(A t) = [...]: held against the answer itself."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.applications.audit.differences import as_matrix, wrong_entries
from symobs.applications.checking.answers.values import as_value, read_like
from symobs.applications.checking.derivations.line_auditor import without_solution
from symobs.applications.checking.judgement.parts import exists, field_called, is_of_time
from symobs.applications.checking.report.data import Line
from symobs.exact import TooLarge
from symobs.ground.errors import NotShown, SymobsError
from symobs.problem.expect import found_in, met, names_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.applications.checking.answers.answer_file import Step
    from symobs.tasks.result.in_convention import ResultInConvention


def of_function_of_time(
    step: Step, views: Sequence[ResultInConvention], audited: Callable[[Step], Line]
) -> Line | None:
    """Return the line x(t) = ... = ... with its verdict, None for any other line; members with letters are `audited`."""
    name, *members = (side.strip() for side in step.relation.split("="))
    view = next((view for view in views if is_of_time([view.result], name)), None)
    if view is None or not members or not exists(view.result, field_called(view.result, name)):
        return None
    found = [
        _of_member(step, name, member, view) or audited(replace(step, relation=f"{name} = {member}"))
        for member in members
    ]
    worst = next((line for line in found if line.verdict != "true"), found[0])
    return replace(worst, relation=step.relation)


def _of_member(step: Step, name: str, member: str, view: ResultInConvention) -> Line | None:
    """Return whether a function equals a member that is written out in t; None for a member in letters."""
    field = field_called(view.result, name)
    try:
        if met(view, field, as_value(member), step.where):
            return Line(step.where, step.relation, "true")
        right = found_in(view, field)
        mine = read_like(right, as_value(member), names_of(view), "t", step.where)
    except (NotShown, TooLarge) as error:
        return Line(step.where, step.relation, "undecided", reason=str(error))
    except SymobsError:
        if "exp" not in f"{name} {member}":
            return None
        reason = "only functions of t that are written out can be compared here"
        return Line(step.where, step.relation, "undecided", reason=reason)
    assert mine is not None  # noqa: S101 - a function of time is a matrix or a number
    own, exact = as_matrix(mine), as_matrix(right)
    if own.shape != exact.shape:
        rows, columns = (f"{a}x{b}" for a, b in (exact.shape, own.shape))
        return Line(step.where, step.relation, "false", reason=f"{name} is {rows} here, yours is {columns}")
    wrong = wrong_entries(own, exact, whole=name)
    reason = without_solution("; ".join(map(str, wrong))) or "its sides are not equal"
    return Line(step.where, step.relation, "false", right=f"{name} = {right}", reason=reason)
