"""What is wrong with an answer about a region: at points, by what is on record, and by proof."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from tests.support.regions import qepcad
from tests.support.regions.region_algebra import All, Atom, Polynomial
from tests.support.regions.region_answers import holds, in_cells, in_intervals
from tests.support.regions.region_points import Oracle, Points
from tests.support.regions.region_proofs import Proof, cell_right, nothing_in, same_intervals, same_relations
from tests.support.regions.region_texts import UnreadableError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.regions.region_algebra import Formula
    from tests.support.regions.region_answers import Answer
    from tests.support.regions.region_points import Point
    from tests.support.regions.region_problem import Problem

#: Beyond this radius no bounded region of `region_problems` reaches.
_FAR = Fraction(10**12)
#: Cells with square roots in their bounds take longer at a point.
_POINTS_IN_CELLS = 2000


def wrong_at_points(problem: Problem, answer: Answer, number: int) -> Iterator[str]:
    """Yield each point at which a part of the answer contradicts the roots."""
    oracle = Oracle(problem)
    points = Points(problem, _points_of(problem, answer)).take(number)
    inside = holds(answer.stable_if, problem.names)
    between = in_intervals(answer.intervals) if answer.intervals is not None and not problem.symbols else None
    cells = in_cells(answer.cells) if answer.cells is not None and not problem.symbols else None
    holes = {tuple(hole.get(name) for name in problem.names) for hole in answer.excluded_points}
    for k, point in enumerate(points):
        stable = oracle(point)
        where = f"at {', '.join(f'{n} = {x}' for n, x in zip(problem.names, point, strict=True))}: stable is {stable}"
        if inside(point) != stable:
            yield f"stable_if {where}"
        if between is not None and between(point[0]) != stable:
            yield f"intervals {where}"
        if tuple(str(x) for x in point) in holes and stable:
            yield f"excluded_points {where}"
        if cells is not None and k < _POINTS_IN_CELLS:
            found = cells(dict(zip(problem.names, point, strict=True)))
            if found is not None and found != stable and tuple(str(x) for x in point) not in holes:
                yield f"cells {where}"


def _points_of(problem: Problem, answer: Answer) -> list[Point]:
    """Return the sample points of an answer, and the rational ends of its intervals."""
    samples = [*answer.samples, *(cell.sample for cell in answer.cells or ())]
    found = [tuple(sample[name] for name in problem.names) for sample in samples if {*problem.names} <= {*sample}]
    for end in {end for interval in answer.intervals or () for end in interval}:
        try:
            found.append((Fraction(end),))
        except ValueError:
            continue
    return found


def wrong_by_record(problem: Problem, answer: Answer) -> Iterator[str]:
    """Yield where the answer contradicts itself, or what is on record."""
    oracle = Oracle(problem)
    if answer.empty is not None and answer.empty != (answer.stable_if == ("False",)):
        yield f"empty is {answer.empty}, stable_if {answer.stable_if}"
    for field, known in (
        ("empty", problem.empty),
        ("components", problem.components),
        ("bounded", problem.bounded),
    ):
        said = getattr(answer, field)
        if said is not None and known is not None and said != known:
            yield f"{field} is {said}, not {known}"
    if answer.intervals is not None and problem.components is not None and len(answer.intervals) != problem.components:
        yield f"{len(answer.intervals)} intervals, not {problem.components}"
    expected = "no" if answer.stable_if == ("False",) else "yes" if not answer.stable_if else "conditional"
    if answer.verdict not in {expected, "undecided"}:
        yield f"the verdict is {answer.verdict}, stable_if {answer.stable_if}"
    for sample in answer.samples:
        if {*problem.names} <= {*sample} and not oracle(tuple(sample[name] for name in problem.names)):
            yield f"the sample {dict(sample)} is not stable"
    for cell in answer.cells or ():
        known = {*problem.names} <= {*cell.sample}
        if known and oracle(tuple(cell.sample[name] for name in problem.names)) != cell.stable:
            yield f"the cell of {dict(cell.sample)} is not {cell.stable}"
    if answer.cells is not None and problem.excluded:
        said_holes = {tuple(hole.get(name, "") for name in problem.parameters) for hole in answer.excluded_points}
        if said_holes != set(problem.excluded):
            yield f"excluded_points are {said_holes}, not {set(problem.excluded)}"


def proofs(problem: Problem, answer: Answer, truth: Formula, limit: float = 20) -> Iterator[tuple[str, Proof]]:
    """Yield for each part of an answer whether it is proved to be the same set."""
    yield "stable_if", same_relations(problem, answer.stable_if, truth, limit)
    if answer.intervals is not None and not problem.symbols:
        yield "intervals", same_intervals(problem, answer, truth, limit)
    if answer.cells is not None and not problem.symbols:
        yield "cells", _all_cells(answer, truth, limit)
    if answer.bounded is not None and not problem.symbols and not answer.empty:
        far = Polynomial.of(-_FAR)
        for name in problem.parameters:
            far = far + Polynomial.symbol(name) ** 2
        none_far = nothing_in(All((truth, Atom(far, ">"))), limit=limit)
        if none_far.verdict == "not decided":
            yield "bounded", none_far
        else:
            agreed = (none_far.verdict == "same") == answer.bounded
            yield "bounded", Proof("same" if agreed else "different", none_far.by, none_far.point)


def _all_cells(answer: Answer, truth: Formula, limit: float) -> Proof:
    """Return the worst verdict of any cell; cells bounded by roots with parameters are left to the points."""
    worst, by, skipped = "same", set(), 0
    for cell in answer.cells or ():
        try:
            proof = cell_right(cell, answer.excluded_points, truth, limit)
        except UnreadableError:
            skipped += 1
            continue
        if proof.verdict == "different":
            return Proof("different", f"{proof.by}: cell {cell.bounds}", proof.point)
        if proof.verdict != "same":
            worst = proof.verdict
        by.add(proof.by)
    if skipped:
        by.add(f"{skipped} of {len(answer.cells or ())} left to points")
    return Proof(worst, ", ".join(sorted(by - {""})))


def truth_of(problem: Problem, limit: float = 60) -> Formula | None:
    """Return QEPCAD's region, or None where it gives none in time."""
    reply = qepcad.region(problem, limit)
    return None if reply is None else reply.formula
