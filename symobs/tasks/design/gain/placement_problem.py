"""The letters and phrases of one side of pole placement: observers of (C, A) and state feedback of (A, B) are dual."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.tasks.analysis.page_parts import HIDDEN

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder


@dataclass(frozen=True)
class PlacementProblem:
    """The words and letters of one side of pole placement."""

    kind: str
    gain: str
    matrix: str
    test: str
    index: str
    coefficient: str

    @property
    def hidden(self) -> tuple[str, str]:
        """The letters of the hidden subspace, different for the two sides."""
        return HIDDEN[self.test]

    @property
    def phi(self) -> str:
        """The letter of the desired polynomial."""
        return f"phi_{self.index}"

    def closed_loop_matrix(self, page: Builder) -> Term:
        """Return A − LC or A − BK."""
        return page["A"] - self._gain_term(page)

    def error_determinant(self, page: Builder) -> Term:
        """Return det(sI − A + LC) or det(sI − A + BK)."""
        return (page.s @ page.identity(page.plant.order) - page["A"] + self._gain_term(page)).apply("det")

    def _gain_term(self, page: Builder) -> Term:
        return page["L"] @ page["C"] if self.gain == "L" else page["B"] @ page["K"]


OBSERVER = PlacementProblem("observer", "L", "O", "observability", "o", "beta_")
FEEDBACK = PlacementProblem("state_feedback", "K", "Ctr", "controllability", "c", "alpha_")
