"""Cards: single answers of a result, `letter = value` and nothing else, without a derivation.

A page tells how an answer is found and checks every line; a card shows the answer alone, whose claims were checked when
its result was made.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

from symobs.exact import Factored, Matrix, Root, Scalar
from symobs.formula.convention import STANDARD, Convention
from symobs.formula.notation import LETTERS
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import Apply, Block, Letter, Literal, Negative, Product, Relation, Roots, SignReversal, Sum
from symobs.ground.dataclass import dataclass
from symobs.pages.formats.html import HtmlWriter
from symobs.pages.page.roots_of_letters import in_roots_of_letters, positive_letters
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.mathml import MathmlPrinter
from symobs.pages.printers.root_lists import LATEX, TEXT, listed
from symobs.pages.printers.text_printer import TextPrinter
from symobs.tasks.analysis.page_parts import formula_of_factored

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula
    from symobs.pages.printers.printer import Printer
    from symobs.tasks.result import Result


@dataclass
class Card:
    """One answer: its field, what is shown, and the field's value; roots are shown as their list."""

    name: str
    shown: Relation | Roots
    answer: Any


@dataclass
class CardPrinter:
    """The printers of a result's cards, in the letters of a convention; what they say is in a language."""

    result: Result
    convention: Convention = STANDARD
    language: Language = ENGLISH

    def _printer(self, kind: type[Any]) -> Any:
        plant = self.result.plant
        printer: Printer[Any] = kind(plant.variable, plant.symbols.latex, discrete=plant.is_discrete)
        printer.language = self.language
        reduced = self.result.has_reduced_observer
        printer.letters = {**LETTERS, **self.convention.forms(reduced=reduced)}
        if self.convention is STANDARD:
            of_plant = plant.variable, tuple(sorted(plant.symbols.latex.items())), plant.is_discrete
            printer.remember(_memory(kind.__name__, *of_plant, self.language.code, reduced))
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

    def roots(self, values: Iterable[Root]) -> str:
        """Return roots in a line of text."""
        return ", ".join(listed(Roots(Letter("chi"), tuple(values)), self._text, TEXT))

    def says(self, card: Card) -> str:
        """Return the card in words for a reader of the screen: `K equals 4, 3`."""
        printer = self._text
        if isinstance(card.shown, Roots):
            return self.language.phrases["said_roots"].format(roots=self.roots(card.shown.values))
        left, right = card.shown.members[0], card.shown.members[-1]
        return self.language.phrases["said_equals"].format(name=printer.inline(left), value=printer.inline(right))


@lru_cache(maxsize=24)
def _memory(*_: object) -> dict[Any, Any]:
    """Return what the cards before this one printed in the same letters: of a gain that is moved much stays as it is."""
    return {}


def cards(result: Result, names: Iterable[str], convention: Convention = STANDARD) -> tuple[Card, ...]:
    """Return the cards of these fields, those left out that the result does not have."""
    known, fields = result.letters, result.fields
    there = (name for name in dict.fromkeys(names) if name in known and name in fields and _is_shown(fields[name]))
    return tuple(_card(result, name, convention) for name in there)


def _is_shown(value: Any) -> bool:
    if isinstance(value, (list, tuple)):
        return bool(value) and all(isinstance(entry, (Root, Scalar, list, tuple)) for entry in value)
    return isinstance(value, (Matrix, Scalar, Factored, int))


def _card(result: Result, name: str, convention: Convention) -> Card:
    called, value = result.letters[name], result.fields[name]
    left = formula_named(called)
    if isinstance(value, tuple) and isinstance(value[0], Root):
        return Card(name, Roots(left, value), value)
    gains: Mapping[str, Any] = result.fields
    known = [gains[letter] for letter in ("K", "L") if isinstance(gains.get(letter), Matrix)]
    relation = Relation((left, _written(value)), ("=",))
    shown = SignReversal(convention.turned, known).relation(relation)
    return Card(name, in_roots_of_letters(shown, positive_letters(result.plant.symbols.signs)), value)


def formula_named(name: str) -> Formula:
    """Return the formula of a letter, of det O or rank O, or of A - B K."""
    function, _, of = name.partition(" ")
    if function in {"det", "rank"}:
        return Apply(function, Letter(of))
    first, *rest = (tuple(map(Letter, term.split())) for term in name.split(" - "))
    return Sum((first[0], *(Negative(Product(term)) for term in rest))) if rest else first[0]


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
