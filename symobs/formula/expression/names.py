"""Names in a text: declared symbols, the variable of a polynomial, the imaginary unit, functions."""

from __future__ import annotations

import keyword
import re
import unicodedata
from dataclasses import field
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar
from symobs.formula.expression.source import Meter, shown
from symobs.formula.notation import GREEK_LETTERS
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ExpressionError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Field


#: The declared names; None declares every well-formed name.
Names: TypeAlias = "Mapping[str, object] | None"
FUNCTIONS = ("sqrt", "exp", "sin", "cos", "tan", "sinh", "cosh", "tanh")
#: Functions of nonlinear plants alone, as they are typed: names of them may be symbols elsewhere.
NONLINEAR = {name: name for name in ("log", "asin", "acos", "atan", "abs", "sign")}
NONLINEAR |= {"ln": "log", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "sgn": "sign"}
RESERVED = ("oo", "inf", "nan", "pi")
IMAGINARY = ("i", "j", "I")
LONGEST_NAME = 64
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


#: The imaginary unit directly before a number or a frequency: j2.4, jw_d.
UNIT_FIRST = re.compile(
    r"(?P<unit>[ij])(?:(?P<size>[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)|(?P<frequency>(?:w|omega)[A-Za-z0-9_]*))(?![\w.])",
    re.ASCII,
)


_MOST_COMPARED = 1_000


def typed_name(name: str) -> str:
    """Return how a printed name is typed: ω_0 is omega_0, and a_{11} is a_11; any other one as it is."""
    is_printed = not NAME.fullmatch(name) and _PRINTED.fullmatch(name)
    return spellings(name)[0 if "_" in name else -1] if is_printed else name


def declared_name(name: object, where: str = "") -> str:
    """Return `name` if it is admissible for a symbol; raises ExpressionError otherwise."""
    if not isinstance(name, str) or not NAME.fullmatch(name):
        came = f'"{shown(name)}"' if isinstance(name, str) else f"a {type(name).__name__}"
        repair = "begin with a letter A-Z or a-z and go on with letters, digits and _"
        raise ExpressionError(f"{came} is not a name", where=where, repair=repair)
    reasons = refusal(name)
    if reasons:
        raise ExpressionError(reasons[0], where=where, repair=reasons[1])
    return name


def refusal(name: str) -> tuple[str, str] | None:
    """Return why a well-formed name is reserved, and the repair."""
    if len(name) > LONGEST_NAME:
        return f'the name "{shown(name)}" has more than {LONGEST_NAME} characters', "shorten it"
    if name in {"and", "or"}:
        return f'"{name}" stands between values', "set them apart by commas"
    if keyword.iskeyword(name):
        another = f"{name}_" if keyword.iskeyword(name[:3]) else name[:3]
        return f'"{name}" is a word of Python and names no symbol', f'write another name, such as "{another}"'
    if name in {"oo", "inf", "infinity", "nan"}:
        return f'"{name}" is reserved: it is not a finite number', "write a finite exact value"
    if name in RESERVED or name in FUNCTIONS:
        return f'"{name}" is reserved and names no symbol', "write another name"
    return None


@dataclass
class Scope:
    """The names, the budget and the context of the texts of one call.

    In a `polynomial` an undeclared λ or p may be its variable.  In `poles` an undeclared j2 is 2 j, unless it is one of the
    `letters` that are in use.  In a `nonlinear` plant more functions are read.
    """

    names: Names
    variable: str | None
    meter: Meter = field(default_factory=Meter)
    context: Field | None = None
    functions: bool = False
    rounding: bool = False
    roots: bool = False
    poles: bool = False
    polynomial: bool = False
    nonlinear: bool = False
    letters: frozenset[str] = frozenset()

    @staticmethod
    def of(
        names: Names,
        variable: str | None,
        where: str,
        *,
        functions: bool = False,
        rounding: bool = False,
        roots: bool = False,
    ) -> Scope:
        """Return the scope; raises ExpressionError if the variable of the polynomial is declared as a symbol."""
        if names is not None and variable in names:
            message = f'"{variable}" is the variable of the polynomial and cannot be a symbol'
            raise ExpressionError(message, where=where, repair="give the symbol another name")
        return Scope(names, variable, functions=functions, rounding=rounding, roots=roots)

    def declares(self, name: str) -> bool:
        """Return whether the name is declared by name, not only admitted because every name is."""
        return name == self.variable or (self.names is not None and name in self.names)

    def constant(self, name: str) -> Scalar | None:
        """Return the value of a declared constant, None for any other name."""
        value = None if self.names is None else self.names.get(name)
        return value if isinstance(value, Scalar) else None

    def is_imaginary_unit(self, name: str) -> bool:
        """Return whether the name stands for the imaginary unit here."""
        return name in IMAGINARY and not self.declares(name)

    def unit_first(self, text: str, at: int = 0) -> re.Match[str] | None:
        """Return the imaginary unit before a number or a frequency, j2 or jw, where this is no declared name."""
        found = UNIT_FIRST.match(text, at)
        return found if found and self.is_imaginary_unit(found["unit"]) and not self.declares(found[0]) else None

    def declared(self) -> list[str]:
        """Return all declared names, for messages."""
        return [*sorted(self.names or ()), *([self.variable] if self.variable else [])]

    def nearest(self, name: str, *, called: bool) -> str | None:
        """Return the known name most similar to `name`, functions included for a call."""
        known = self.declared()[:_MOST_COMPARED] + (list(FUNCTIONS) if called else [])
        from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

        return next(iter(get_close_matches(name, known, 1)), None)


# The characters with which formulas are printed, read back: ω₀², √3, −1 ± 2 i, a·b.


#: Signs in place of the minus of ASCII, and blanks in place of its space.
MINUS = "-\u2212\u2010\u2011\u2013"
BLANK = "\u00a0\u2009\u202f\u200b\u2060\ufeff"
SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_BELOW = "₀₁₂₃₄₅₆₇₈₉"


_SPELT = {letter: name for name, letter in GREEK_LETTERS.items()} | {
    "ϕ": "phi",
    "ϵ": "epsilon",
    "ϑ": "theta",
    "µ": "mu",
}


_SANS_SERIF = "\U0001d5a0-\U0001d5d3"
#: A name as it is typed, or a Greek letter or one without serifs, with indices below, as in LaTeX: ω_n, a₁, a_{11}.
PRINTED_NAME = (
    rf"(?:[A-Za-z][A-Za-z0-9_]*|[{''.join(_SPELT)}{_SANS_SERIF}](?:_(?:[0-9]+|[A-Za-z][A-Za-z0-9_]*))?)"
    rf"(?:[{_BELOW}]+|(?<=_)\{{[A-Za-z0-9]+\}}|(?<![A-Za-z0-9_])_\{{[A-Za-z0-9]+\}})?"
)
_PRINTED = re.compile(PRINTED_NAME)
_PAIR = re.compile(r"([^±]*)(?:±|\+/-)([^±]*)")
#: The variable of a characteristic polynomial in a book, where a text has no s (z).
EIGENVALUES = ("lambda", "lam", "p")


_ASCII = (
    str.maketrans(SUPERSCRIPTS, "0123456789")
    | dict.fromkeys(map(ord, MINUS + "⁻"), "-")
    | dict.fromkeys(map(ord, "·⋅×"), "*")
)


def ascii_names(text: str) -> str:
    """Return a text with its Greek letters spelled out."""
    return "".join(f" {_SPELT[letter]} " if letter in _SPELT else letter for letter in text)


def ascii_of(glyphs: str) -> str:
    """Return signs and digits as they are typed: ⁻² is -2, · is *."""
    return glyphs.translate(_ASCII)


def spellings(printed: str) -> tuple[str, ...]:
    """Return the names that are printed like this: ω₀ is omega0 or omega_0, ω_c omega_c."""
    stem, brace, index = printed.partition("_{")
    if brace:
        return (f"{spellings(stem)[0]}_{index[:-1]}", spellings(stem)[0] + index[:-1])
    stem = printed.rstrip(_BELOW)
    digits = unicodedata.normalize("NFKC", printed[len(stem) :])
    letter, index = (stem[:1], stem[1:]) if stem[:1] in _SPELT else (stem, "")
    plain = _SPELT.get(letter, unicodedata.normalize("NFKC", letter)) + index
    return (plain + digits, f"{plain}_{digits}") if digits else (plain,)


def pairs(pole: object) -> list[object]:
    """Return the two poles of a text -1 ± 2i; any other one alone."""
    pair = _PAIR.fullmatch(pole) if isinstance(pole, str) else None
    return [f"{pair[1]}+{pair[2]}", f"{pair[1]}-{pair[2]}"] if pair else [pole]
