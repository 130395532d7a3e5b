"""The auditor of a derivation's lines: that of printed equations, with the student's values in place of letters."""

from __future__ import annotations

import re
from contextlib import suppress
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from symobs.audit.equation_auditor import EquationAuditor
from symobs.audit.equations.evaluation import value_of
from symobs.audit.equations.matrix_functions import Misfit, Unknown
from symobs.exact import Matrix, Scalar
from symobs.expression.syntax_tree import SyntaxNode, letters_of
from symobs.formula.term import Term

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.audit.printed_entries import PrintedEntry
    from symobs.audit.slips import SearchBudget
    from symobs.convention import Convention
    from symobs.problem import Problem
    from symobs.result import Result

#: A right value beside the one that was written, and the slip from one to the other.
_BESIDE = re.compile(r"(.+?) is .+, not [^:]+(?:: (.+))?")
_PART = re.compile(r"(?:in )?(?:entry|the coefficient|the constant term)\b")


def without_solution(reason: str, *, is_gain: bool = False) -> str:
    """Return why a line is false without what is right: one wrong entry or coefficient is told, of several the places.

    A value that is wrong as a whole has its slip for a reason, or none; so has a gain, which may be right in other places.
    """
    pieces = reason.split("; ")
    told = [found for piece in pieces if (found := _BESIDE.fullmatch(piece))]
    parts = [found[1] for found in told if _PART.match(found[1])]
    if len(told) < 2:
        return reason if parts or not told else told[0][2] or ""
    others = [piece for piece in pieces if not _BESIDE.fullmatch(piece)]
    if others and not others[0].startswith("and "):  # "and 2 more entries"
        return others[0]
    return "" if is_gain else f"not right: {', '.join([*parts, *others])}"


class LineAuditor(EquationAuditor):
    """An auditor that tells whether a line is true, and what it defines."""

    def members(self, entry: PrintedEntry) -> tuple[SyntaxNode, ...]:
        """Return the members of a line, its conditions and its own letters being set."""
        self.environments, self.gaps, self.where = {}, [], entry.condition
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
                return verdict.right, without_solution(verdict.reason, is_gain=is_gain)
        return "", ""


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
