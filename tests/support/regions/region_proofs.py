"""Proofs that two descriptions of a region are the same set: z3 finds no point in one and not in the other.

Where z3 does not decide, the exclusive or is put to QEPCAD as a closed question.  Roots in a description are variables
with their definitions (`region_translation`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import z3  # type: ignore[import-untyped, unused-ignore]

from tests.programs.benchmarks import other_systems
from tests.support.regions import qepcad
from tests.support.regions.region_algebra import (
    All,
    Atom,
    Some,
    difference,
    names_of,
    opposite,
)
from tests.support.regions.region_texts import Name, expression
from tests.support.regions.region_translation import Translation, between, conjunction, union

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from tests.support.regions.region_algebra import Formula, Polynomial
    from tests.support.regions.region_answers import Answer, Cell
    from tests.support.regions.region_problem import Problem


@dataclass(frozen=True)
class Proof:
    """Whether two sets are the same, who says so, and a point where they differ."""

    verdict: str  # "same", "different" or "not decided"
    by: str = ""
    point: Mapping[str, str] | None = None

    def __str__(self) -> str:
        return f"{self.verdict} ({self.by})" if self.by else self.verdict


def nothing_in(found: Formula, definitions: Sequence[Formula] = (), limit: float = 20) -> Proof:
    """Return "same" where a set is empty, "different" with a point of it where it is not."""
    whole = All((*definitions, found))
    solver = z3.Tactic("qfnra-nlsat").solver()
    solver.set("timeout", int(1000 * limit))
    variables = {name: z3.Real(name) for name in sorted(names_of(whole))}
    solver.add(in_z3(qepcad.folded(whole), variables))
    answer = solver.check()
    if answer == z3.unsat:
        return Proof("same", "z3")
    if answer == z3.sat:
        model = solver.model()
        values = {name: str(model.eval(variable, model_completion=True)) for name, variable in variables.items()}
        return Proof("different", "z3", values)
    if other_systems.available("qepcad"):
        empty = qepcad.is_empty(qepcad.folded(whole), limit)
        if empty is not None:
            return Proof("same" if empty else "different", "QEPCAD")
    return Proof("not decided")


def in_z3(found: Formula, variables: Mapping[str, Any]) -> Any:
    """Return a set without negations as a formula of z3."""
    match found:
        case Atom(value, op):
            left = _polynomial(value.integral(), variables)
            return {
                ">": left > 0,
                ">=": left >= 0,
                "=": left == 0,
                "!=": left != 0,
                "<": left < 0,
                "<=": left <= 0,
            }[op]
        case All(parts):
            return z3.And([in_z3(part, variables) for part in parts])
        case Some(parts):
            return z3.Or([in_z3(part, variables) for part in parts])
        case other:
            raise TypeError(other)


def _polynomial(value: Polynomial, variables: Mapping[str, Any]) -> Any:
    terms = []
    for monomial, c in value.terms.items():
        factors = [variables[name] for name, power in monomial for _ in range(power)]
        terms.append(z3.Product(z3.RealVal(int(c)), *factors))
    return z3.Sum(terms) if terms else z3.RealVal(0)


# -- what symobs says -----------------------------------------------------------------------------------------------


def same_relations(problem: Problem, relations: Sequence[str], truth: Formula, limit: float = 20) -> Proof:
    """Hold a conjunction against a set."""
    translation = Translation()
    return _same(problem, translation, conjunction(translation, relations), truth, limit)


def same_intervals(problem: Problem, answer: Answer, truth: Formula, limit: float = 20) -> Proof:
    """Hold the intervals of one parameter against a set."""
    translation = Translation()
    ours = union(translation, problem.parameters[0], answer.intervals or ())
    return _same(problem, translation, ours, truth, limit)


def _same(problem: Problem, translation: Translation, ours: Formula, truth: Formula, limit: float) -> Proof:
    unequal = All((qepcad.assumptions(problem), difference(ours, truth)))
    return nothing_in(unequal, translation.definitions, limit)


def cell_right(cell: Cell, holes: Sequence[Mapping[str, str]], truth: Formula, limit: float = 20) -> Proof:
    """Prove that all of a cell is stable but for single points left out, or that none of it is."""
    translation = Translation()
    names = [name for name, _, _ in cell.bounds]
    inside: list[Formula] = [between(translation, name, low, high, names) for name, low, high in cell.bounds]
    if cell.stable:
        for hole in holes:
            equal = (translation.relation(Name(name), "=", expression(str(value))) for name, value in hole.items())
            inside.append(opposite(All(tuple(equal))))
    wrong = opposite(truth) if cell.stable else truth
    return nothing_in(All((*inside, wrong)), translation.definitions, limit)
