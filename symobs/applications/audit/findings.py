"""Findings of the audit of a problem: false equations, right values and reasons."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.applications.audit.equation_auditor import EquationAuditor
from symobs.applications.audit.printed_entries import PrintedEntry, printed_entries
from symobs.applications.audit.slips import SearchBudget
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ProblemErrors, SymobsError
from symobs.problem.expect import mismatches
from symobs.tasks.result.in_convention import ResultInConvention

if TYPE_CHECKING:
    from symobs.problem import Problem


@dataclass(frozen=True)
class Finding:
    """A printed equation that does not hold in general: its place, text, correction and reason.

    `holds` is empty where it is false, `in general` where it fails only where some polynomials vanish.
    """

    where: str
    erratum: str
    printed: str
    right: str
    reason: str
    holds: str = ""


@dataclass(frozen=True)
class Audited:
    """The findings for one problem, the number of printed equations, and notes on the reading of letters."""

    title: str
    checked: int
    findings: tuple[Finding, ...]
    notes: tuple[str, ...] = ()

    @property
    def wrong(self) -> tuple[Finding, ...]:
        """The equations that are false."""
        return tuple(finding for finding in self.findings if not finding.holds)


def audit(problem: Problem) -> Audited:
    """Solve a problem and compare every printed equation with the answers.

    Raises `ProblemErrors` with every entry that cannot be read.
    """
    entries = printed_entries(problem.printed, problem.convention, problem.plant.symbols.signs)
    results = problem.solve()
    found: list[Finding] = []
    errors: list[SymobsError] = []
    desks: dict[str, EquationAuditor] = {}
    patience = SearchBudget()
    for entry in entries:
        name = entry.convention.name
        desk = desks[name] = desks.get(name) or EquationAuditor(problem, results, entry.convention, patience)
        try:
            found += _read(entry, desk)
        except SymobsError as error:
            error.where = error.where or entry.place
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    notes = dict.fromkeys(note for desk in desks.values() for note in desk.notes)
    return Audited(problem.title, len(entries), tuple(found), tuple(notes))


def _read(entry: PrintedEntry, desk: EquationAuditor) -> list[Finding]:
    """Return the findings for one entry."""
    if entry.expect:
        lines = mismatches([ResultInConvention(result, desk.convention) for result in desk.results], entry.expect)
        texts = [line.partition(": expected ")[2].partition(", found ") for line in lines]
        return [Finding(entry.where, entry.erratum, came, right, "") for came, _, right in texts]
    return [
        Finding(entry.where, entry.erratum, printed, verdict.right, verdict.reason, verdict.holds)
        for printed, verdict in desk.read(entry)
    ]
