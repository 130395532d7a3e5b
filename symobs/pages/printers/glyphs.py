"""The interface of a format: boxes, and a glyph for every part of a formula or a broken line."""

from __future__ import annotations

from abc import ABC, abstractmethod
from enum import IntEnum
from typing import TYPE_CHECKING, ClassVar, Generic, TypeAlias, TypeVar

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Scalar


class Level(IntEnum):
    """The precedence of a box; an operand of lower precedence than its place is parenthesised."""

    SUM = 0
    PRODUCT = 1
    FRACTION = 2
    POWER = 3
    ATOM = 4


@dataclass
class GlyphBox:
    """A printed part; formats add its text."""

    width: float
    level: Level


B = TypeVar("B", bound=GlyphBox)

#: The numbers of rows above a horizontal line, and of columns before a vertical one.
Rules: TypeAlias = tuple[tuple[int, ...], tuple[int, ...]]
NO_RULES: Rules = ((), ())


class FormulaWriter(ABC, Generic[B]):
    """The writer of formulas of one format: from boxes to a box."""

    #: Whether a broken fraction is always (a)/(b), never 1/b before (a).
    slashes: ClassVar[bool] = False

    # -- of formulas ----------------------------------------------------------------------------------------------

    @abstractmethod
    def letter(self, name: str, mark: str) -> B:
        """Return a letter of the notation; `mark` is empty, `dot`, `k` or `k+1`."""

    @abstractmethod
    def leaf(self, value: Scalar) -> B:
        """Return a whole number or a symbol."""

    @abstractmethod
    def identity(self) -> B:
        """Return the identity matrix."""

    @abstractmethod
    def empty(self, shape: tuple[int, int]) -> B:
        """Return a matrix without entries."""

    @abstractmethod
    def sign(self, *, negative: bool, leading: bool) -> B:
        """Return plus or minus: between terms, or (leading) in front."""

    @abstractmethod
    def comparison(self, operator: str) -> B:
        """Return the sign of a relation, with its space."""

    @abstractmethod
    def joined(self, parts: Sequence[B], level: Level) -> B:
        """Return the parts one after the other."""

    @abstractmethod
    def between(self, left: B, right: B) -> B | None:
        """Return the separator of two factors, such as the dot before a number."""

    @abstractmethod
    def grouped(self, box: B) -> B:
        """Return a box in parentheses."""

    @abstractmethod
    def fraction(self, above: B, below: B) -> B:
        """Return above / below."""

    @abstractmethod
    def raised(self, base: B, exponent: int) -> B:
        """Return a power of an already parenthesised base."""

    @abstractmethod
    def to_the_instant(self, base: B) -> B:
        """Return the k-th power of such a base."""

    @abstractmethod
    def transposed(self, base: B) -> B:
        """Return the transpose of such a base."""

    @abstractmethod
    def applied(self, function: str, argument: B) -> B:
        """Return a function's name before its already grouped argument."""

    @abstractmethod
    def matrix(self, rows: Sequence[Sequence[B]], rules: Rules = NO_RULES) -> B:
        """Return a table in brackets, with lines between its blocks where a display has room for them."""

    @abstractmethod
    def rate(self, box: B, name: str = "t") -> B:
        """Return d/dt, or d/d(name), of something other than a letter."""

    # -- of functions of time ---------------------------------------------------------------------------------------

    @abstractmethod
    def exponential(self, argument: Scalar) -> B:
        """Return the exponential of an argument."""

    @abstractmethod
    def root(self, argument: B, degree: int = 2) -> B:
        """Return a root, a square root by default."""

    @abstractmethod
    def summed(self, over: B, term: B) -> B:
        """Return the sum of a term over all that fulfil an equation."""

    @abstractmethod
    def named(self, form: str) -> B:
        """Return a letter given by its LaTeX."""

    @abstractmethod
    def evaluated(self, box: B, equations: Sequence[B]) -> B:
        """Return the value of a function at the times of the equations."""

    @abstractmethod
    def integral(self, limits: tuple[B, B], integrand: B, name: B) -> B:
        """Return the integral, over the generator `name`, of an integrand with the precedence of a product."""

    # -- of lines -------------------------------------------------------------------------------------------------

    @abstractmethod
    def parentheses(self, content: Sequence[B]) -> tuple[B, B]:
        """Return a pair of parentheses for different lines, as tall as the content."""

    @abstractmethod
    def brackets(self) -> tuple[B, B]:
        """Return the same for a list of entries."""

    @abstractmethod
    def separators(self) -> tuple[B, B]:
        """Return comma and semicolon of such a list."""

    @abstractmethod
    def dot(self) -> B:
        """Return the sign of multiplication at the start of a line."""

    @abstractmethod
    def slash(self) -> B:
        """Return the sign of division between parentheses."""

    @abstractmethod
    def digits(self, run: str) -> B:
        """Return a part of a number."""

    @abstractmethod
    def continued(self) -> B:
        """Return the sign at the start of a line that a number goes on."""

    @abstractmethod
    def star(self, number: int) -> B:
        """Return the name of an entry defined below."""

    @abstractmethod
    def entry_of(self, matrix: B, indices: Sequence[int]) -> B:
        """Return the name of an entry of a matrix."""

    @abstractmethod
    def indent(self) -> B:
        """Return the space before a line that goes on."""

    @abstractmethod
    def framed(self, box: B) -> B:
        """Return the answer, marked."""

    @abstractmethod
    def stacked(self, lines: Sequence[B]) -> B:
        """Return lines under one another as one box."""

    @abstractmethod
    def punctuation(self, mark: str) -> B:
        """Return a comma or full stop after a formula."""

    @abstractmethod
    def gap(self) -> B:
        """Return the space between two relations on one line."""
