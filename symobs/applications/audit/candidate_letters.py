"""Candidate letters in place of a printed one."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from symobs.applications.audit.differences import wrong_entries
from symobs.applications.audit.equations.evaluation import as_printed, value_of
from symobs.applications.audit.equations.letter_values import HIDDEN, INSTANTS
from symobs.applications.audit.equations.matrix_functions import Misfit, Unknown
from symobs.applications.audit.equations.reading import Reading
from symobs.applications.audit.equations.sizes import Flexible, is_signal, shape
from symobs.exact import Matrix
from symobs.exact.algebraic.rounded_decimals import decimals_in
from symobs.formula.expression.syntax_tree import SyntaxNode
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.formula.tree import Environment

    Kind = tuple[bool, tuple[int, int] | None] | None


@dataclass(frozen=True)
class CandidateLetters:
    """The letters of an environment, without the names of `fields` of an answer and reserved names.

    Where the sizes `fit` as printed, only letters of the same size may have been meant.
    """

    environment: Environment
    fields: frozenset[str]
    fit: bool = True

    def offered(self, name: str, *, primed: bool) -> list[str]:
        """Return the letters that fit in place of `name`; with `primed` those whose transpose or derivative fits."""
        kinds = {other: kind for other, kind in self.kinds.items() if other != name}
        if primed:
            kinds = {other: _turned(kind) for other, kind in kinds.items() if kind is not None and any(kind)}
        wanted = self.kinds[name] if name in self.kinds else self._kind(name)
        return [other for other, kind in kinds.items() if not self.fit or kind == wanted]

    @cached_property
    def kinds(self) -> dict[str, Kind]:
        """What may be offered, and the kind of each."""
        environment = self.environment
        names = [*environment.values, *environment.signals, *INSTANTS, environment.variable]
        known = [n for n in dict.fromkeys(names) if n not in {*self.fields, *HIDDEN} and not n.endswith("'")]
        return {name: self._kind(name) for name in known}

    def is_signal(self, name: str) -> bool:
        """Return whether a letter is a signal."""
        return name in self.environment.signals

    def rounded(self, block: SyntaxNode) -> str | None:
        """Return the letter whose value rounds to a matrix of decimals."""
        try:
            printed = as_printed(block, Reading(self.environment))
        except Misfit:  # a matrix with 1/0 in it rounds nothing
            return None
        if not isinstance(printed, Matrix) or not decimals_in(printed):
            return None
        known = [(name, value) for name, value in self.environment.values.items() if isinstance(value, Matrix)]
        alike = ((name, value) for name, value in known if value.shape == printed.shape)
        return next((name for name, value in alike if not wrong_entries(printed, value)), None)

    def _kind(self, name: str) -> Kind:
        """Return whether a letter is a signal, and its size; numbers count as 1×1 matrices."""
        try:
            found = value_of(SyntaxNode("letter", text=name), Reading(self.environment))
        except (Misfit, Unknown):
            return None
        if isinstance(found, Flexible):
            return None
        size = shape(found)
        return is_signal(found), None if size == (1, 1) else size


def _turned(kind: Kind) -> Kind:
    """Return the kind of the transpose of a matrix, or of the derivative of a signal."""
    if kind is None or kind[0] or kind[1] is None:
        return kind
    return kind[0], (kind[1][1], kind[1][0])
