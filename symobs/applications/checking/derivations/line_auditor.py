"""The auditor of a derivation's lines: that of printed equations, with the student's values in place of letters."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import field
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from symobs.applications.audit.equation_auditor import EquationAuditor
from symobs.applications.audit.equations.evaluation import value_of
from symobs.applications.audit.equations.matrix_functions import Misfit, Unknown
from symobs.exact import Matrix, Scalar
from symobs.formula.expression.syntax_tree import SyntaxNode, letters_of
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.applications.audit.printed_entries import PrintedEntry
    from symobs.applications.audit.slips import SearchBudget
    from symobs.formula.convention import Convention
    from symobs.problem import Problem
    from symobs.tasks.result import Result

#: A right value beside the one that was written, and the slip from one to the other.
_BESIDE = re.compile(r"(.+?) is .+, not [^:]+(?:: (.+))?")
_PART = re.compile(r"(?:in )?(?:entry|the coefficient|the constant term)\b")
#: A term with its right coefficient, or with what a student's letters make of it: its signal alone is a place.
_TERM = re.compile(r"the term (?:.* )?-?(\S+) (is missing|does not belong there)")
_MORE = re.compile(r"and [0-9]+ more entr(?:y|ies)")
#: What is wrong with a value as a whole, in words that have no right value in them.
_CAUSE = re.compile(
    r"(?:in the coefficient of \S+ )?"
    r"(?:all signs are wrong|the (?:transpose|inverse) is printed|every entry is multiplied by \S+"
    r"|the (?:entries|rows|columns) [(),0-9 ]+ and [(),0-9 ]+ are exchanged)"
    r"|the eigenvalues are others"
)
_BETWEEN_PIECES = re.compile(r"; (?![^\[]*\])")


def without_solution(reason: str, *, is_gain: bool = False) -> str:
    """Return why a line is false without what is right: one wrong entry or coefficient is told, of several the places.

    A value that is wrong as a whole has its slip for a reason, or none; so has a gain, which may be right in other places.
    Of what has none of the known wordings nothing is told.
    """
    pieces = _BETWEEN_PIECES.split(reason)
    beside = [found for piece in pieces if (found := _BESIDE.fullmatch(piece)) and not _TERM.fullmatch(piece)]
    if len(pieces) == len(beside) == 1:
        return reason if _PART.match(beside[0][1]) else beside[0][2] or ""
    causes = [piece for piece in pieces if _CAUSE.fullmatch(piece)]
    if causes or is_gain:
        return "; ".join(causes)
    places = [found[1] for found in beside if _PART.match(found[1])]
    places += [piece for piece in pieces if places and _MORE.fullmatch(piece)]
    terms = [f"a term in {found[1]} {found[2]}" for piece in pieces if (found := _TERM.fullmatch(piece))]
    return "; ".join([*([f"not right: {', '.join(places)}"] if places else []), *terms])


def place_alone(reason: str) -> str:
    """Return the reason for a matrix with one entry at most, of which a right entry may be all that there is to find."""
    return re.sub(r"^(entry \([0-9]+, [0-9]+\)) is [^;]*$", r"\1 is wrong", reason)


@dataclass()
class LineAuditor(EquationAuditor):
    """An auditor that tells whether a line is true, and what it defines.

    What is said in the letters and numbers of the line itself, of slips and of sizes, is `harmless`: it gives nothing away.
    """

    harmless: set[str] = field(init=False, default_factory=set)

    def members(self, entry: PrintedEntry) -> tuple[SyntaxNode, ...]:
        """Return the members of a line, its conditions and its own letters being set."""
        self.environments, self.kept, self.gaps, self.where = {}, {}, [], entry.condition
        self.let = {name: self._members(text)[0] for name, text in entry.let.items()}
        return self._members(entry.relation)

    def is_true(self, entry: PrintedEntry) -> bool:
        """Return whether a line holds in general; raises `UnknownName` for a letter without a meaning."""
        members = self.members(entry)
        reading = self.reading(members[0], members[-1])
        for name in {*letters_of(*members)} - {*self.let}:
            with suppress(Misfit):
                self._value(SyntaxNode("letter", text=name), reading)
        return all(self.true(left, right) for left, right in pairwise(members))

    def defined(self, entry: PrintedEntry) -> tuple[str, Scalar | Matrix] | None:
        """Return the letter that a line defines, and its value; None for any other line."""
        members = self.members(entry)
        letter, last = members[0], members[-1]
        plain = {*self.symbols, *self.let, self.problem.plant.variable, "t"}
        if letter.kind != "letter" or letter.text in plain or not set(letters_of(last)) <= plain:
            return None
        try:
            found = value_of(last, self.reading(letter, last))
        except (Misfit, Unknown):
            return None
        value = found.value if isinstance(found, Term) else None
        known = self.values.get(letter.text)
        if isinstance(known, Scalar) and isinstance(value, Matrix) and value.shape == (1, 1):
            value = value[0, 0]
        return (letter.text, value) if isinstance(value, (Scalar, Matrix)) else None

    def letters(self, entry: PrintedEntry) -> set[str]:
        """Return the letters of a line."""
        return {*letters_of(*self.members(entry), *self.let.values())}

    def explained(self, entry: PrintedEntry, *, is_gain: bool) -> tuple[str, str]:
        """Return the correction of a false line and the reason without it, empty where none is found."""
        for _, verdict in self.read(entry):
            if not verdict.holds:
                said = verdict.reason
                return verdict.right, said if said in self.harmless else without_solution(said, is_gain=is_gain)
        return "", ""

    def _slip(self, *sides: Any, **options: Any) -> tuple[str, str] | None:
        return self._noted(super()._slip(*sides, **options))

    def _misfit(self, *sides: Any) -> tuple[str, str]:
        found = super()._misfit(*sides)
        self._noted(found)
        return found

    def _missing_factor(self, *sides: Any) -> tuple[str, str] | None:
        return self._noted(super()._missing_factor(*sides))

    def _missing_term(self, *sides: Any) -> tuple[str, str] | None:
        return self._noted(super()._missing_term(*sides))

    def _noted(self, found: tuple[str, str] | None) -> tuple[str, str] | None:
        """Return a correction, its reason being noted as harmless."""
        if found is not None:
            self.harmless.add(found[1])
        return found


def auditor(
    problem: Problem,
    results: Sequence[Result],
    convention: Convention,
    budget: SearchBudget,
    values: Mapping[str, Any],
) -> LineAuditor:
    """Return an auditor in which some letters have values of their own."""
    found = LineAuditor(problem, results, convention, budget)
    found.values = {**found.values, **values}
    return found
