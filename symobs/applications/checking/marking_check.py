"""What `[marking]` names, held against the results: parts that exist, and relations that can be read and are true."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from symobs.applications.audit.printed_entries import printed_entries
from symobs.applications.checking.derivations.lines import is_of_conditions, judge_milestone
from symobs.applications.checking.judgement.conditions import read_conditions
from symobs.applications.checking.judgement.parts import exists
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem.expect import available

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from symobs.problem import Problem
    from symobs.tasks.result.in_convention import ResultInConvention


def marking_errors(problem: Problem, views: Sequence[ResultInConvention]) -> list[SymobsError]:
    """Return what in the weights and the milestones of a problem would never count."""
    return [*_unknown_weights(problem, views), *_unmet_milestones(problem, views)]


def part_of_name(part: str, views: Sequence[ResultInConvention]) -> tuple[ResultInConvention, str] | None:
    """Return the result of `task.field` and its standard name, None where there is no such part."""
    task, _, letter = part.partition(".")
    view = next((view for view in views if view.task == task), None)
    name = view.standard(letter)[0] if view is not None else letter
    return None if view is None or not exists(view.result, name) else (view, name)


def known_parts(part: str, views: Sequence[ResultInConvention]) -> str:
    """Return what to write for a part that does not exist."""
    return meant(part, [f"{each.task}.{field}" for each in views for field in available(each) if _has(each, field)])


def _has(view: ResultInConvention, letter: str) -> bool:
    return exists(view.result, view.standard(letter)[0])


def meant(name: str, known: Collection[str]) -> str:
    """Return the names there are, and before them the one that was meant."""
    near = get_close_matches(name, known, 1)
    return f"{f'did you mean {near[0]}? ' if near else ''}known: {', '.join(known)}"


def _unknown_weights(problem: Problem, views: Sequence[ResultInConvention]) -> Iterator[SymobsError]:
    """Yield the weights of parts that no result has by this name, which is the standard one."""
    known = [f"{view.task}.{name}" for view in views for name in available(view.result)]
    for part in problem.marking.parts:
        if part not in known:
            yield InputError(f"there is no {part}", where=f"marking.parts.{part}", repair=meant(part, known))


def _unmet_milestones(problem: Problem, views: Sequence[ResultInConvention]) -> Iterator[SymobsError]:
    """Yield the relations that no true line of a derivation could ever be."""
    for i, milestone in enumerate(problem.marking.milestones):
        where = f"marking.milestone[{i}].relation"
        try:
            _require_readable(milestone.relation, problem, where)
        except SymobsError as error:
            each = error.errors[0] if isinstance(error, ProblemErrors) else error
            repair = each.repair or 'write both sides, for example "L = [19; 81]"'
            yield InputError(each.message, where=where, repair=repair)
            continue
        line = judge_milestone(problem, views, milestone)
        rounds = problem.marking.decimals == "accept" and "." in milestone.relation
        if line.verdict == "false" and not rounds:
            repair = f"write {line.right}" if line.right else "write a relation that the solution meets"
            yield InputError(
                f'"{shown(milestone.relation, 80)}" is not true here: {line.reason}', where=where, repair=repair
            )


def _require_readable(relation: str, problem: Problem, where: str) -> None:
    """Raise an error of a relation that is neither an equation nor conditions."""
    if is_of_conditions(relation):
        read_conditions(relation, None, where)
    else:
        printed_entries([{"relation": relation}], problem.convention, problem.plant.symbols.signs)
