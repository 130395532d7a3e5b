"""Cards: single answers of a result, `letter = value` and nothing else, without a derivation.

A page tells how an answer is found and checks every line; a card shows the answer alone, whose claims were checked when
its result was made.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Root, Scalar
from symobs.formula.convention import STANDARD, Convention
from symobs.formula.notation import LETTERS
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import Apply, Block, Letter, Literal, Negative, Product, Relation, Roots, SignReversal, Sum
from symobs.ground.dataclass import dataclass
from symobs.pages.formats.html import HtmlWriter
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.mathml.mathml_printer import MathmlPrinter
from symobs.pages.printers.root_lists import LATEX, TEXT, listed
from symobs.pages.printers.text_printer import TextPrinter
from symobs.tasks.analysis.factored_form import formula_of_factored

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula
    from symobs.pages.printers.printer import Printer
    from symobs.tasks.result import Result

_A_BK = Sum((Letter("A"), Negative(Product((Letter("B"), Letter("K"))))))
_A_LC = Sum((Letter("A"), Negative(Product((Letter("L"), Letter("C"))))))
_B_LD = Sum((Letter("B"), Negative(Product((Letter("L"), Letter("D"))))))
_RANK_O, _RANK_C = Apply("rank", Letter("O")), Apply("rank", Letter("Ctr"))
#: How the fields of each task are called; a text is the name of a letter.
NAMES: dict[str, dict[str, str | Formula]] = {
    "observability": {"matrix": "O", "rank": _RANK_O, "determinant": Apply("det", Letter("O")), "kernel": "N"},
    "controllability": {"matrix": "Ctr", "rank": _RANK_C, "determinant": Apply("det", Letter("Ctr")), "kernel": "N_K"},
    "detectability": {"polynomial": "chi", "fixed_polynomial": "mu", "rank": _RANK_O},
    "stabilizability": {"polynomial": "chi", "fixed_polynomial": "mu", "rank": _RANK_C},
    "pbh": {"polynomial": "chi", "fixed_polynomial": "mu"},
    "characteristic_polynomial": {"polynomial": "chi", "roots": "chi"},
    "transfer_function": {"transfer_function": "P", "poles": "P"},
    "canonical_form": {"T": "T", "A": "A_bar", "B": "B_bar", "C": "C_bar", "D": "D", "polynomial": "chi"},
    "decomposition": {"T": "T", "A": "A_bar", "B": "B_bar", "C": "C_bar", "D": "D", "transfer_function": "P"},
    "dual": {"A": "A_dual", "B": "B_dual", "C": "C_dual", "D": "D_dual"},
    "matrix_exponential": {"matrix": "exp_At"},
    "response": {"state": "x_t", "output": "y_t"},
    "gramian": {"matrix": "W", "determinant": Apply("det", Letter("W")), "finite_sum": "M", "kernel": "N"},
    "initial_state": {"x0": "x_0"},
    "initial_state_covariance": {"covariance": "Cov", "input_part": "Cov_Q", "output_part": "Cov_R"},
    "time_varying_observability": {"matrix": "O", "rank": _RANK_O, "transition_matrix": "Phi_", "gramian": "W"},
    "state_feedback": {"K": "K", "polynomial": "chi_K", "closed_loop_matrix": _A_BK, "poles": "chi_K"},
    "observer": {"L": "L", "polynomial": "chi_L", "A": _A_LC, "B_u": _B_LD, "poles": "chi_L"},
    "reduced_order_observer": {
        "L": "L", "F": "F_z", "G": "G_z", "H": "H_z", "M": "M_z", "T": "T", "polynomial": "phi", "poles": "phi",
    },
    "compensator": {
        "K": "K", "L": "L", "F": "F", "closed_loop_polynomial": "chi_cl", "closed_loop": "G_cl",
        "closed_loop_matrix": "A_cl", "compensator_matrix": "A_c", "T": "T",
    },
    "feedforward": {
        "F": "F_v", "transfer_function": "T_v", "K": "K", "L": "L", "polynomial": "chi_cl", "closed_loop_matrix": "A_cl",
    },
    "tracking": {"K": "K", "K_d": "K_d", "L": "L", "error_matrix": "A_e", "polynomial": "chi_cl"},
    "integral_action": {"K": "K", "k_I": "k_I", "polynomial": "chi_cl", "closed_loop_matrix": "A_cl"},
    "disturbance_observer": {"L_x": "L_x", "L_w": "L_w", "polynomial": "phi", "poles": "phi"},
    "unknown_input_observer": {
        "H": "H_d", "T": "T_d", "L": "L", "F": "F_d", "B_y": "L_y", "polynomial": "phi", "poles": "phi",
    },
    "pole_advice": {"polynomial": "phi", "sigma": "sigma_d", "omega_d": "omega_d"},
    "stability_region": {"polynomial": "chi_p"},
    "zero_order_hold": {"A_d": "A_zoh", "B_d": "B_zoh"},
}  # fmt: skip


@dataclass(frozen=True)
class Card:
    """One answer: its field, what is shown, and the field's value; roots are shown as their list."""

    name: str
    shown: Relation | Roots
    answer: Any


@dataclass(frozen=True)
class CardPrinter:
    """The printers of a result's cards, in the letters of a convention; what they say is in a language."""

    result: Result
    convention: Convention = STANDARD
    language: Language = ENGLISH

    def _printer(self, kind: type[Any]) -> Any:
        plant = self.result.plant
        printer: Printer[Any] = kind(plant.variable, plant.symbols.latex, discrete=plant.is_discrete)
        printer.language = self.language
        printer.letters = {**LETTERS, **self.convention.forms(reduced=self.result.has_reduced_observer)}
        return printer

    @cached_property
    def _mathml(self) -> MathmlPrinter:
        printer: MathmlPrinter = self._printer(MathmlPrinter)
        return printer

    @cached_property
    def _latex(self) -> LatexPrinter:
        printer: LatexPrinter = self._printer(LatexPrinter)
        return printer

    @cached_property
    def _text(self) -> TextPrinter:
        printer: TextPrinter = self._printer(TextPrinter)
        printer.flat = True
        return printer

    def mathml(self, card: Card) -> str:
        """Return a display, or a line of roots."""
        printer = self._mathml
        if isinstance(card.shown, Roots):
            return HtmlWriter(printer).sentence((card.shown,))
        return printer.display([card.shown], end="")

    def latex(self, card: Card) -> str:
        """Return LaTeX without delimiters."""
        printer = self._latex
        if isinstance(card.shown, Roots):
            return ",\\ ".join(listed(card.shown, printer, LATEX))
        return printer.unbroken(card.shown)

    def says(self, card: Card) -> str:
        """Return the card in words for a reader of the screen: `K equals 4, 3`."""
        printer = self._text
        if isinstance(card.shown, Roots):
            return self.language.phrases["said_roots"].format(roots=", ".join(listed(card.shown, printer, TEXT)))
        left, right = card.shown.members[0], card.shown.members[-1]
        return self.language.phrases["said_equals"].format(name=printer.inline(left), value=printer.inline(right))


def cards(result: Result, names: Iterable[str], convention: Convention = STANDARD) -> tuple[Card, ...]:
    """Return the cards of these fields, those left out that the result does not have."""
    known, fields = NAMES.get(result.task, {}), result.fields
    there = (name for name in dict.fromkeys(names) if name in known and name in fields and _is_shown(fields[name]))
    return tuple(_card(result, name, convention) for name in there)


def _is_shown(value: Any) -> bool:
    if isinstance(value, (list, tuple)):
        return bool(value) and all(isinstance(entry, (Root, Scalar, list, tuple)) for entry in value)
    return isinstance(value, (Matrix, Scalar, Factored, int))


def _card(result: Result, name: str, convention: Convention) -> Card:
    called, value = NAMES[result.task][name], result.fields[name]
    left: Formula = Letter(called) if isinstance(called, str) else called
    if isinstance(value, tuple) and isinstance(value[0], Root):
        return Card(name, Roots(left, value), value)
    gains: Mapping[str, Any] = result.fields
    known = [gains[letter] for letter in ("K", "L") if isinstance(gains.get(letter), Matrix)]
    relation = Relation((left, _written(value)), ("=",))
    return Card(name, SignReversal(convention.turned, known).relation(relation), value)


def _written(value: Any) -> Formula:
    """Return the formula of a value, factors as factors."""
    if isinstance(value, Factored):
        return formula_of_factored(value)
    if isinstance(value, (Scalar, Matrix)):
        return Literal(value)
    if isinstance(value, int):
        return Literal(Scalar.of(value))
    return _table(value)


def _table(value: Any) -> Formula:
    """Return a list of numbers as a column, a kernel as the matrix of its vectors, a table of factors as a matrix."""
    if isinstance(value[0], Scalar):
        return Literal(Matrix.column(value))
    if isinstance(value[0][0], Factored):
        return Block(tuple(tuple(formula_of_factored(entry) for entry in row) for row in value))
    return Literal(Matrix.of([list(row) for row in zip(*value, strict=True)]))
