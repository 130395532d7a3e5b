"""Conventions: the letters and signs of pages, of input, and of expected answers.

The mathematics is the same in all of them; the standard one is u = −K x̂, A − L C, e = x − x̂.  Those of the source
documents come with the package as small TOML files (`profiles/`), and a user adds one by writing another (`reading`).
"""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.formula.convention.letter_forms import letter_form, of_determinant, of_polynomial
from symobs.formula.notation import FUNCTIONS, LETTERS
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.notation import LetterForm

#: The letters whose meaning changes its sign with the control law, and those with the observer matrix.
FEEDBACK_GAINS = frozenset({"K", "K_1", "K_2", "K_0", "K_G", "K_y"})
OBSERVER_GAINS = frozenset({"L", "L_0", "L_G"})
#: Letters that a page has only where it speaks of an observer whose state is no estimate of x, of reduced order mostly.
OF_REDUCED_ORDER = frozenset({"F_z", "G_z", "H_z", "M_z", "A_12", "H_d"})


@dataclass(frozen=True)
class Convention:
    """Letters and signs.

    feedback_sign   of K x̂ in the control law, −1 in u = −K x̂
    observer_sign   of L C in the observer matrix, −1 in A − L C
    brackets        around a pair of matrices; with `state_first` the observable pair is A, C and not C, A
    letters         key of `notation.LETTERS` → what is written in its place
    reduced         the same, on pages with a reduced-order observer besides
    """

    name: str
    title: str = ""
    feedback_sign: int = -1
    observer_sign: int = -1
    brackets: tuple[str, str] = ("(", ")")
    state_first: bool = False
    letters: Mapping[str, str] = field(default_factory=dict)
    reduced: Mapping[str, str] = field(default_factory=dict)

    @property
    def is_standard(self) -> bool:
        """Whether this is the standard convention."""
        return self == STANDARD

    @cached_property
    def turned(self) -> frozenset[str]:
        """The letters that denote the negative of their standard meaning."""
        feedback = FEEDBACK_GAINS if self.feedback_sign > 0 else frozenset()
        return feedback | (OBSERVER_GAINS if self.observer_sign > 0 else frozenset())

    def written(self, *, reduced: bool) -> Mapping[str, str]:
        """Return the forms of the letters that differ; with `reduced` those of a reduced-order observer."""
        return {**self.letters, **self.reduced} if reduced else self.letters

    def forms(self, *, reduced: bool) -> Mapping[str, LetterForm]:
        """Return the forms of the letters that differ from the standard convention."""
        changed = self._with_components(self.written(reduced=reduced))
        forms = {name: letter_form(text, LETTERS[name]) for name, text in changed.items()}
        forms |= {f"{name}_at": form.alone for name, form in forms.items() if f"{name}_at" in FUNCTIONS}
        for name, sign, factors in (("chi_K", self.feedback_sign, "BK"), ("chi_L", self.observer_sign, "LC")):
            if sign > 0 or not changed.keys().isdisjoint(factors):
                forms |= of_polynomial(name, sign, [forms.get(letter, LETTERS[letter]) for letter in factors])
        return forms | of_determinant(forms["W_t"]) if "W_t" in forms else forms

    @staticmethod
    def _with_components(written: Mapping[str, str]) -> Mapping[str, str]:
        """Return the letters with those of the components of the estimate: x_01, x_02 for the estimate x_0."""
        estimate = written.get("x_hat", "")
        numbered = estimate if estimate[-1:].isdigit() else f"{estimate}_"
        components = {name: f"{numbered}{name[-1]}" for name in ("x_hat_1", "x_hat_2") if estimate}
        return {**components, **written}

    @property
    def law(self) -> str:
        """The control law, as typed."""
        return f"u = {'-' * (self.feedback_sign < 0)}{self.letters.get('K', 'K')} x_hat"

    @property
    def observer_matrix(self) -> str:
        """The observer matrix, as typed."""
        return f"A {'-' if self.observer_sign < 0 else '+'} {self.letters.get('L', 'L')} C"

    @property
    def pair(self) -> str:
        """The observable pair."""
        opening, closing = self.brackets
        return f"{opening}{'A, C' if self.state_first else 'C, A'}{closing}"


STANDARD = Convention("standard", "the standard convention of the field")
