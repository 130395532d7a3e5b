"""The grammar of printed equations: from text to trees.

The tokens and the tree are those of every other expression (`formula.expression`), and three tokens more: `'` after an operand,
its transpose or, behind a signal, its derivative; `=`; and the argument of a function, `P(s)`.  A name is a letter, and is
not evaluated here: letters do not commute.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from symobs.exact import VARIABLES
from symobs.formula.expression.names import FUNCTIONS as SCALAR_FUNCTIONS
from symobs.formula.expression.names import Scope
from symobs.formula.expression.source import Source
from symobs.formula.expression.syntax_parser import parse
from symobs.formula.expression.syntax_tree import every, exponent_of
from symobs.formula.expression.tokenizer import EXPONENTIAL, TOKENS, Tokeniser
from symobs.ground.errors import BudgetExceeded

if TYPE_CHECKING:
    from collections.abc import Collection

    from symobs.formula.expression.syntax_tree import SyntaxNode

FUNCTIONS = (
    ("det", 1),
    ("adj", 1),
    ("trace", 1),
    ("rank", 1),
    ("size", 1),
    ("eigenvalues", 1),
    ("rref", 1),
    ("ctrb", 2),
    ("obsv", 2),
    ("place", 3),
    ("Phi", 2),
    ("integral", 4),
    *((name, 1) for name in SCALAR_FUNCTIONS),
)
_ARGUMENTS = dict(FUNCTIONS)
MOST_CHARACTERS = 2_000
MOST_NODES = 200
MOST_EXPONENT = 12
#: `x(t)` and `P(s)` are x and P whatever they are.
_OF_ITS_VARIABLE = re.compile(rf"\([ ]*({'|'.join(VARIABLES)})[ ]*\)")


def read_relation(
    text: str, where: str, functions: Collection[str] = (), symbols: Collection[str] = ()
) -> tuple[SyntaxNode, ...]:
    """Return the members of a printed equation `a = b = …`; raises ExpressionError with the place of the fault.

    A letter of `functions` directly before "(" is applied to what stands there; before `(s)`, `(z)` or `(t)` any letter is
    but `symbols`, which are numbers.
    """
    source = Source(text, where)
    if len(text) > MOST_CHARACTERS:
        message = f"the equation has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise source.error(message, 0, "print it in parts", kind=BudgetExceeded)
    members = parse(_Printed(source, functions, symbols).run(), source, "_EQUAL")
    parts = [part for member in members for part in every(member)]
    if len(parts) > MOST_NODES:
        raise source.error(f"the equation has more than {MOST_NODES} parts", 0, "print it in parts", BudgetExceeded)
    for part in parts:
        _require_known(part, source)
    return members


def _require_known(part: SyntaxNode, source: Source) -> None:
    """Refuse exponents that are no integers, and functions of another number of arguments."""
    if part.kind == "power":
        exponent = exponent_of(part)
        if exponent is None or abs(exponent) > MOST_EXPONENT:
            of_e = EXPONENTIAL if part.parts[0].text == "e" else ""
            message = f"an exponent is an integer up to {MOST_EXPONENT}{of_e}"
            raise source.error(message, part.places[0], "write A^-1 for the inverse, A' for the transpose")
    if part.kind == "call" and len(part.parts) != _ARGUMENTS[part.text]:
        count = _ARGUMENTS[part.text]
        message = f"{part.text} takes {count} argument{'s' if count > 1 else ''}"
        raise source.error(message, part.places[0], "set them apart by commas")


class _Printed(Tokeniser):
    """Cuts a printed equation into tokens; a letter is a VALUE without a value."""

    pattern = re.compile(rf"{TOKENS}|(?P<PRIME>['ᵀ])|(?P<EQUAL>=)")

    def __init__(self, source: Source, functions: Collection[str], symbols: Collection[str]) -> None:
        super().__init__(source, Scope.of(None, None, source.where))
        self.applied = functions
        self.numbers = symbols

    def _take(self, kind: str, text: str, at: int) -> None:
        if kind == "EQUAL" and self.open:
            raise self.source.error('"=" stands inside brackets', at, "close them first")
        if kind == "EQUAL" or (kind == "COMMA" and self.open and not self._in_brackets()):
            self.spaced = False
            self._add("_EQUAL" if kind == "EQUAL" else "_COMMA", text, at)
        else:
            super()._take(kind, text, at)

    def _imply(self, kind: str, at: int) -> None:
        if kind == "OPEN" and self._is_applied(at):
            self._add("APPLY", "", at)
        else:
            super()._imply(kind, at)

    def _is_applied(self, at: int) -> bool:
        """Return whether the "(" here opens the argument of the preceding letter."""
        letter = next((token for token in reversed(self.tokens) if token.type != "PRIME"), None)
        if (
            self.spaced
            or letter is None
            or letter.type != "VALUE"
            or letter.value is not None
            or letter in self.numbers
        ):
            return False
        return letter in self.applied or _OF_ITS_VARIABLE.match(self.text, at) is not None

    def _name(self, name: str, at: int, end: int) -> None:
        called = self.text.startswith("(", end)
        if name in _ARGUMENTS and called:
            self._add("FUNCTION", name, at)
        elif len(name) > 64:
            raise self.source.error("a letter has more than 64 characters", at, "shorten it")
        else:
            self._add("VALUE", name, at)
