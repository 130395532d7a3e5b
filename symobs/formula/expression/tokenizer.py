"""First step: from a text to tokens, with every implied product, comma and row end inserted.

The product of two neighbours, the comma MATLAB reads from a space inside brackets and the row a newline ends are
written out here, so that what comes after needs to know nothing of spaces.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import replace
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING

from symobs.exact import Complex, Field, Scalar
from symobs.exact.algebraic.rounded_decimals import as_generator
from symobs.exact.core.generators import PI
from symobs.formula.expression.names import (
    BLANK,
    EIGENVALUES,
    FUNCTIONS,
    LONGEST_NAME,
    MINUS,
    NAME,
    NONLINEAR,
    PRINTED_NAME,
    SUPERSCRIPTS,
    Scope,
    ascii_names,
    ascii_of,
    refusal,
    spellings,
)
from symobs.formula.expression.source import Source, Token, shown
from symobs.ground.errors import BudgetExceeded, InputError, ProblemErrors, UnknownName

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Sequence


# Ambiguous products after a division, `1/s(s+1)`: both readings, written out.


OPERAND_ENDS = ("VALUE", "_CLOSE", "_RIGHT", "PRIME")
_OPENING_KINDS, _CLOSING_KINDS = ("_OPEN", "LEFT"), ("_CLOSE", "_RIGHT")
_LONGEST_READING = 100


def division_before(tokens: Sequence[Token]) -> int | None:
    """Return the place of the "/" whose divisor ends here, None if there is none."""
    for place in _term_backwards(tokens, len(tokens)):
        if tokens[place].type == "MULTIPLY":
            return place if tokens[place] == "/" else None
    return None


def two_readings(tokens: Sequence[Token], division: int, text: str, at: int, rest: Iterator[re.Match[str]]) -> str:
    """Return both readings of the factors that begin at `at`; `rest` are the pieces of the text from there on."""
    begin = min((tokens[place].start for place in _term_backwards(tokens, division)), default=0)
    slash, end = tokens[division].start, at
    depth, previous = 0, ""
    for piece in rest:
        kind = str(piece.lastgroup)
        ends = kind in {"CLOSE", "COMMA", "END", "MULTIPLY", "SPACE"} or (kind == "ADD" and previous != "POWER")
        if piece.start() != end or (ends and not depth):
            break
        depth += (kind == "OPEN") - (kind == "CLOSE")
        end, previous = piece.end(), kind
    above, below, factors = (text[i:j].strip() for i, j in ((begin, slash), (slash + 1, at), (at, end)))
    return " or ".join(
        shown(reading, _LONGEST_READING) for reading in (f"{above}/{below}*{factors}", f"{above}/({below}*{factors})")
    )


def _term_backwards(tokens: Sequence[Token], end: int) -> Iterator[int]:
    """Yield the places before `end`, backwards, of what belongs to the same term and stands in no further bracket."""
    depth = 0
    for place in range(end - 1, -1, -1):
        kind = tokens[place].type
        if not depth:
            if kind in {*_OPENING_KINDS, "_COMMA", "_END", "_EQUAL"} or (
                kind == "ADD" and place > 0 and tokens[place - 1].type in OPERAND_ENDS
            ):
                return
            yield place
        depth += (kind in _CLOSING_KINDS) - (kind in _OPENING_KINDS)
        if not depth and kind in _OPENING_KINDS:
            yield place


def _closing(text: str, place: int) -> int:
    """Return the place of the parenthesis that closes the one at a place, the end of the text where there is none."""
    depths = accumulate((character == "(") - (character == ")") for character in text[place:])
    return next((place + k for k, depth in enumerate(depths) if not depth), len(text))


MOST_NESTING = 100
#: After this many names that are not declared a text is read no further.
_MOST_UNKNOWN = 20
MOST_DIGITS = 1_000
MOST_POWER_OF_TEN = 1_000
MOST_NAMES = 400


#: What a token looks like; the implied signs are those of `Tokeniser`.
TOKENS = (
    r"(?P<NUMBER>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    rf"|(?P<NAME>{PRINTED_NAME})"
    rf"|(?P<POWER>\*\*|\^)|(?P<MULTIPLY>[*/·⋅×])|(?P<ADD>[+{re.escape(MINUS)}])"
    r"|(?P<OPEN>[(\[{])|(?P<CLOSE>[)\]}])|(?P<COMMA>,)|(?P<END>;)|(?P<UNIT>[°%])"
    rf"|(?P<ROOT>(?:(?<![\w)\]])⁴)?√(?P<RADICAND>[0-9]+|{PRINTED_NAME})?)|(?P<RAISED>⁻?[{SUPERSCRIPTS}]+)"
    rf"|(?P<SPACE>[ \t\r\n{BLANK}]+)"
)


#: The matrices that are made by a word, with an example.
CONSTRUCTORS = {"diag": "diag(1, 10)", "eye": "eye(2)", "zeros": "zeros(2, 1)", "ones": "ones(2, 1)"}
_ARGUMENTS = re.compile(r"\s*\(((?:[^()]|\((?:[^()]|\([^()]*\))*\))*)\)")
#: An entry of diag, without commas outside of parentheses.
_PART = re.compile(r"(?:[^(),\s]|\((?:[^()]|\([^()]*\))*\)|\s+(?=[-+*/^]\s)|(?<=[-+*/^])\s+)+")
_SIZES, _MOST_SIZE = re.compile(r"[0-9]{1,3}(?:\s*,\s*[0-9]{1,3})?"), 30
#: e^{-2t} and e^(-2t), where e is no name and no second power follows.
_GROUP = r"[({](?:[^(){}]|[({](?:[^(){}]|[({][^(){}]*[)}])*[)}])*[)}]"
_EXP = re.compile(rf"\s{{0,9}}(?:\^|\*\*)(?=\s{{0,9}}{_GROUP}(?!\s{{0,9}}(?:\^|\*\*)))")
#: The argument of sin ωt and cos 2t: a number and a name, and of a wave two where the second is the time; in brackets,
#: where blanks set entries apart, one.  What follows leaves no doubt where the argument ends.
_OTHER = rf"(?!(?:{'|'.join(FUNCTIONS)})\b){PRINTED_NAME}"
_COUNTED = r"[0-9]+(?:\.[0-9]+)?"
_ENDS = rf"(?=\s*(?:[-+),;\]}}]|$|(?:{'|'.join(FUNCTIONS)})\b))"
_FACTOR = rf"(?>{_COUNTED}(?: ?{_OTHER})?|{_OTHER})"
_BARE_IN_BRACKETS = re.compile(rf"[ \t]{{1,9}}((?>{_COUNTED}(?:{_OTHER})?|{_OTHER})){_ENDS}")
_BARE = re.compile(rf"\s{{1,9}}({_FACTOR}){_ENDS}")
_BARE_IN_TIME = re.compile(rf"\s{{1,9}}({_FACTOR} (?<!\st )[tk](?![\w{{(])){_ENDS}")
_WAVES = {"sin", "cos", "sinh", "cosh"}
#: The entries that words may make in one text.
_MOST_MADE = 2_500
_ROW = re.compile(r"[^][;\r\n]*")
_CLOSING = {"(": ")", "[": "]"}
#: Braces are parentheses: e^{-4t}.
_BRACES = str.maketrans("{}", "()")
_CALL = re.compile(r"[ \t\r\n]*\(")
_POWER = re.compile(r"[ \t\r\n]*(?:\*\*|\^)")


#: What is a function or a command elsewhere, and no symbol that anybody means to declare.
_FUNCTIONS_ELSEWHERE = re.compile(
    r"abs|a(?:rc)?(?:cos|sin|tan|cot)h?|atan2|conj|coth?|csch?|sech?|l[gn]|log(?:2|10)?|det|diag|eye|floor|imag|inv|max|min|ones"
    r"|rank|real|root|round|sat|sgn|sign|sinc|step|sum|trace|transpose|zeros"
)


#: What follows the 0 of a number in base 16, 8 or 2, and what is a power of ten in Fortran.
_OTHER_BASE, _POWER_OF_TEN = re.compile(r"[xX][0-9A-Fa-f]+|[oO][0-7]+|[bB][01]+"), re.compile(r"[dD][0-9]+")
_OPERAND_STARTS = ("NUMBER", "NAME", "OPEN")


def sharing(scope: Scope, values: Iterable[object], variable: str | None = None) -> Scope:
    """Return the scope with one context for all texts among the values and for the variable."""
    context = _context_of((value for value in values if isinstance(value, str)), variable)
    return replace(scope, context=context)


def _context_of(texts: Iterable[str], variable: str | None = None) -> Field:
    """Return one context for every name in the texts, so that no value needs conversion."""
    names = {name for text in texts for name in NAME.findall(text)} - set(FUNCTIONS)
    fit = {name for name in names if len(name) <= LONGEST_NAME}
    return Field.of(fit.union([variable] if variable and fit else ()) if len(fit) <= MOST_NAMES else ())


#: A 0 before another digit where a number begins: what stands behind a decimal comma.
LEADING_ZERO = re.compile(r"(?<![A-Za-z0-9_.])0[0-9]")


class Tokeniser:
    """A tokeniser of one text; each VALUE has its exact number.

    Invariant: `tokens` says what the text read so far means, `open` holds the brackets still to be closed.
    """

    pattern = re.compile(TOKENS)

    def __init__(self, source: Source, scope: Scope) -> None:
        """Take the text, and the names it may use."""
        self.source = source
        self.text = source.text
        self.scope = scope
        self.tokens: list[Token] = []
        self.open: list[Token] = []
        self.symbols: dict[str, Scalar] = {}
        self.unknown: list[InputError] = []
        self.spaced = False
        #: Where the text goes on after the present token: behind the argument that it has taken.
        self.ahead = 0
        self.made = 0
        #: Of each open bracket, whether commas set the entries of its present row apart.
        self.commas: list[bool] = []

    @cached_property
    def field(self) -> Field:
        """The context of the values."""
        return _context_of([self.text]) if self.scope.context is None else self.scope.context

    def run(self) -> list[Token]:
        """Return the tokens, with brackets matched; raises ExpressionError with the place of the fault.

        All names that are not declared are told together, at the end.
        """
        self._read(0, len(self.text))
        if self.open:
            place, repair = self.open[-1].start, f'close it with "{_CLOSING[self.open[-1]]}"'
            raise self.source.error(f'this "{self.open[-1]}" is never closed', place, repair)
        if not self.tokens:
            raise self.source.error(
                "an expression is expected, but the text is empty", 0, "write one between the quotes"
            )
        if self.unknown:
            raise self.unknown[0] if len(self.unknown) == 1 else ProblemErrors(tuple(self.unknown))
        return self.tokens

    def _read(self, position: int, end: int) -> None:
        """Take the tokens of a part of the text; what was taken ahead is passed over."""
        while position < end:
            if self.scope.poles and (unit := self.scope.unit_first(self.text, position)):
                self._unit_first(unit, position)
                position = unit.end()
                continue
            match = self.pattern.match(self.text, position)
            if match is None:
                message, repair = _unreadable(self.text[position])
                raise self.source.error(message, position, repair)
            self.ahead = match.end()
            self._take(str(match.lastgroup), match.group(), position)
            position = self.ahead

    def _take(self, kind: str, text: str, at: int) -> None:
        if kind == "SPACE":
            self.spaced = True
            if self._in_brackets() and ("\n" in text or "\r" in text):
                self._end_row(text, at)
            return
        self._imply(kind, at)
        self.spaced = False
        match kind:
            case "NUMBER":
                self._refuse_leading_zero(text, at)
                self._add("VALUE", text, at, self._decimal(text, at))
            case "NAME":
                self._name(text if NAME.fullmatch(text) else self._spelt(text), at, at + len(text))
            case "OPEN":
                self._open(text.translate(_BRACES), at)
            case "CLOSE":
                self._close(text.translate(_BRACES), at)
            case "UNIT":
                self._unit(text, at)
            case "RAISED":
                self._raised(ascii_of(text), at)
            case "ROOT":
                self._root(text, at)
            case "COMMA" | "END" if self.open and not self._in_brackets():
                raise self.source.error(f'"{text}" stands inside parentheses', at, 'close them with ")" first')
            case "COMMA":
                self._add("_COMMA", text, at)
            case "END":
                self._end_row(text, at)
            case _:
                self._add(kind, ascii_of(text), at)

    def _imply(self, kind: str, at: int) -> None:
        """Insert the product or comma implied between the last operand and the token `kind`."""
        if not self._after(OPERAND_ENDS):
            return
        kind = "NAME" if kind == "ROOT" else kind
        apart = self.spaced and self._in_brackets() and not (self.commas[-1] and kind == "NAME")
        signs_entry = kind == "ADD" and bool(self.text[at + 1 : at + 2].strip())  # [1 -2] is two entries, [1 - 2] one
        if apart and (signs_entry or kind in _OPERAND_STARTS):
            self._add("_COMMA", " ", at)
        elif kind == "NUMBER" and self.tokens[-1][0] in ".0123456789":
            raise self.source.error("a number follows a number", at, "write an operator between them")
        elif kind in _OPERAND_STARTS:
            division = division_before(self.tokens)
            if division is not None and not self._is_imaginary_part(division, at):
                readings = two_readings(self.tokens, division, self.text, at, self.pattern.finditer(self.text, at))
                message = "a product without its sign follows a division, which can be read in two ways"
                raise self.source.error(message, at, f"write {readings}")
            self._add("MULTIPLY", "*", at)

    def _is_imaginary_part(self, division: int, at: int) -> bool:
        """Return whether the imaginary unit follows a number that something is divided by.

        3/2 j and 52/25 I are these fractions times i, as all read them, and never a number over 2 i or 25 i.
        """
        name = NAME.match(self.text, at)
        divisor = self.tokens[division + 1 :]
        is_number = len(divisor) == 1 and isinstance(divisor[0].value, Scalar) and divisor[0].value.is_constant
        return is_number and name is not None and self.scope.is_imaginary_unit(name[0])

    def _in_brackets(self) -> bool:
        """Return whether spaces count here: inside brackets, but not inside parentheses within them."""
        return bool(self.open) and self.open[-1].type == "LEFT"

    def _after(self, types: Container[str]) -> bool:
        return bool(self.tokens) and self.tokens[-1].type in types

    def _add(self, kind: str, text: str, at: int, value: Scalar | Complex | None = None) -> Token:
        token = Token(kind, text, at, value)
        self.tokens.append(token)
        return token

    # -- brackets -------------------------------------------------------------------------------------------------

    def _open(self, text: str, at: int) -> None:
        if text == "[" and self.tokens and self.text[at - 1 : at].strip() and self._is_indexed(at):
            message = "what stands in brackets directly behind a value is an index"
            name = self.tokens[-2 if self.tokens[-1].start == at else -1]
            instead = f"write {name}_1 or another name of its own; of a product {name}*( )"
            repair = "write the entry itself" if name == "]" else instead
            raise self.source.error(message, at, repair)
        if len(self.open) >= MOST_NESTING:
            message, repair = f"brackets are nested deeper than {MOST_NESTING}", "write it with fewer brackets"
            raise self.source.error(message, at, repair, kind=BudgetExceeded)
        self.open.append(self._add("LEFT" if text == "[" else "_OPEN", text, at))
        self.commas.append(self._has_commas(at + 1))

    def _is_indexed(self, at: int) -> bool:
        """Return whether the last token is a matrix, or a letter with an implied product behind it."""
        last = self.tokens[-1]
        if last.type == "MULTIPLY" and last.start == at and len(self.tokens) > 1:
            last = self.tokens[-2]
        return last.type == "_RIGHT" or (last.type == "VALUE" and last[:1].isalpha())

    def _close(self, text: str, at: int) -> None:
        if not self.open:
            raise self.source.error(f'this "{text}" closes nothing', at, "leave it out, or open it before")
        if self.open[-1] + text not in {"()", "[]"}:
            repair = f'write "{_CLOSING[self.open[-1]]}" before it'
            raise self.source.error(f'this "{text}" stands where "{self.open[-1]}" has to be closed first', at, repair)
        if self._after(("_END",)):
            self.tokens.pop()
        self._add("_RIGHT" if text == "]" else "_CLOSE", text, at)
        self.open.pop()
        self.commas.pop()

    def _end_row(self, text: str, at: int) -> None:
        """End a row; semicolons and newlines in a run, or beside a bracket, end one row together."""
        if not self.open:
            raise self.source.error('";" ends a row, but no "[" is open', at, "write the rows in brackets: [1; 2]")
        if not self._after(("_END", "LEFT")):
            self._add("_END", text, at)
        self.commas[-1] = self._has_commas(at + len(text))

    def _has_commas(self, at: int) -> bool:
        """Return whether commas set the entries of the row from here apart, so that a blank before a name is a product."""
        row = _ROW.match(self.text, at)
        return row is not None and "," in row[0]

    # -- operands -------------------------------------------------------------------------------------------------

    def _decimal(self, text: str, at: int) -> Scalar:
        """Return the exact value of a number: 10.78 is 539/50."""
        mantissa, _, power = text.lower().partition("e")
        whole, _, decimals = mantissa.partition(".")
        if len(whole) + len(decimals) > MOST_DIGITS:
            message, repair = f"a number has more than {MOST_DIGITS} digits", "write fewer digits"
            raise self.source.error(message, at, repair, kind=BudgetExceeded)
        if len(power.lstrip("+-0")) > 4 or abs(int(power or 0)) > MOST_POWER_OF_TEN:
            message, repair = f"a power of ten is beyond {MOST_POWER_OF_TEN}", "write a smaller power"
            raise self.source.error(message, at, repair, kind=BudgetExceeded)
        decimal = as_generator(text, at) if self.scope.rounding else None
        if decimal is not None:
            return decimal
        digits, shift = int(whole + decimals), int(power or 0) - len(decimals)
        return Scalar.of(digits * 10**shift) if shift >= 0 else Scalar.rational(digits, 10**-shift)

    def _refuse_leading_zero(self, text: str, at: int) -> None:
        """Raise ExpressionError for [0,05] and [007]: in brackets, and behind a comma, it is a decimal that is meant."""
        whole = re.search(r"([0-9]+), *$", self.text[:at])
        if LEADING_ZERO.match(text) and (self.open or whole):
            message = f'a number does not begin with 0: "{text}"'
            instead = f"decimals have a point: {whole[1]}.{text}" if whole else f"write {text.lstrip('0') or '0'}"
            if whole and len(text) == 3 and whole[1] != "0":
                instead += f", or {whole[1]}{text} if the comma sets thousands apart"
            raise self.source.error(message, at, instead)

    def _unit(self, unit: str, at: int) -> None:
        """Take a number of degrees as an angle in radians, or of per cent as a fraction."""
        last = self.tokens[-1] if self.tokens else None
        if last is None or last.type != "VALUE" or not isinstance(last.value, Scalar) or not last.value.is_constant:
            raise self.source.error(f'"{unit}" belongs behind a number', at, "write 30° or 5 %")
        before = self.tokens[-2].type if len(self.tokens) > 1 else ""
        follows = self.text[at + 1 :].lstrip()[:1]
        is_angle = self.source.where.startswith("substitute.") or any(map(self._is_called, self.open))
        if unit == "°" and not is_angle:
            raise self.source.error("an angle in degrees stands where no angle is asked for", at, "write a number")
        if unit == "%" and (before in {"MULTIPLY", "POWER"} or follows.isalnum() or follows in {"(", "%"}):
            message = "this per cent sign may be a remark, or belong to a quotient or a product"
            raise self.source.error(message, at, "write the number itself, 0.05 for 5 %")
        value = last.value / 100 if unit == "%" else last.value * Scalar.symbol(PI) / 180
        self.tokens[-1] = Token("VALUE", last, last.start, value)

    def _is_called(self, bracket: Token) -> bool:
        """Return whether an open bracket holds the argument of a function."""
        place = next(place for place, token in enumerate(self.tokens) if token is bracket)
        return place > 0 and self.tokens[place - 1].type == "FUNCTION"

    def _raised(self, power: str, at: int) -> None:
        """Add a power that is written above the line."""
        self._add("POWER", "^", at)
        if power.startswith("-"):
            self._add("ADD", "-", at)
        self._add("VALUE", power, at, self._decimal(power.lstrip("-"), at))

    def _root(self, text: str, at: int) -> None:
        """Add the root, or the fourth root, of a number, of a name, or of what stands in the parentheses that follow."""
        index, _, radicand = text.partition("√")
        begin = at + len(index) + 1
        if index:
            self._add("FUNCTION", "sqrt", at)
            self._add("_OPEN", "(", at)
        self._add("FUNCTION", "sqrt", at)
        if radicand:
            self._add("_OPEN", "(", at)
            self._take("NUMBER" if radicand.isdecimal() else "NAME", radicand, begin)
            self._add("_CLOSE", ")", at)
        elif not self.text.startswith("(", begin):
            raise self.source.error("a root is followed by a number, a name or (", at, "write sqrt( )")
        elif index:
            end = _closing(self.text, begin)
            if end == len(self.text):
                raise self.source.error('this "(" is never closed', begin, 'write ")" behind the radicand')
            self._grouped(begin + 1, end)
            self.ahead = end + 1
        if index:
            self._add("_CLOSE", ")", at)

    def _unit_first(self, found: re.Match[str], at: int) -> None:
        """Add j2 as the number 2 j; raises ExpressionError for jw, 1/j2, j2^2, 3j2, and where j2 is a letter in use."""
        self._imply("NAME", at)
        self.spaced = False
        whole, size = found[0], found["size"]
        apart = not self.text[max(at - 1, 0) : at].isalnum() and not (self.tokens and self.tokens[-1] == "/")
        if not size or whole in self.scope.letters or not apart or _POWER.match(self.text, found.end()):
            raise self.source.error(f'"{shown(whole)}" may be a name or a product', at, _unit_apart(found))
        self._add("VALUE", whole, at, Complex(Scalar.of(0), self._decimal(size, at)))

    def _spelt(self, printed: str) -> str:
        """Return the name that is printed like this, one that is declared or in use where there are several."""
        names = spellings(printed)
        known = (name for name in names if self.scope.declares(name) or name in self.scope.letters)
        return next(known, names[0])

    def _name(self, name: str, at: int, end: int) -> None:
        called = self.text.startswith("(", end) if self._in_brackets() else bool(_CALL.match(self.text, end))
        if self.scope.is_imaginary_unit(name):
            self._add("VALUE", name, at, Complex(Scalar.of(0), Scalar.of(1)))
        elif called and name in CONSTRUCTORS and not self.scope.declares(name):
            self._constructed(name, at, end)
        elif (
            name == "e"
            and self.scope.functions
            and not self.scope.declares(name)
            and (power := _EXP.match(self.text, end))
        ):
            self._add("FUNCTION", "exp", at)
            self.ahead = power.end()
        elif called and self.scope.nonlinear and name in NONLINEAR and not self.scope.declares(name):
            self._add("FUNCTION", NONLINEAR[name], at)
        elif name not in FUNCTIONS:
            self._add("VALUE", name, at, self.symbols.get(name) or self._symbol(name, at, called=called))
        elif called:
            self._add("FUNCTION", name, at)
        elif self.scope.functions and (argument := self._bare(name, end)):
            self._add("FUNCTION", name, at)
            self._grouped(*argument.span(1))
            self.ahead = argument.end()
        else:
            raise self.source.error(f'"{name}" is a function', at, f"write its argument in parentheses: {name}( )")

    def _bare(self, name: str, end: int) -> re.Match[str] | None:
        """Return the argument of a function without parentheses, where it has one reading."""
        if self._in_brackets():
            return _BARE_IN_BRACKETS.match(self.text, end)
        return _BARE.match(self.text, end) or (_BARE_IN_TIME.match(self.text, end) if name in _WAVES else None)

    def _grouped(self, start: int, end: int) -> None:
        """Take a part of the text as if it stood in parentheses."""
        self._open("(", start)
        self._read(start, end)
        self._close(")", end)

    def _constructed(self, name: str, at: int, end: int) -> None:
        """Write out diag(1, 10), eye(2), zeros(2, 1) and ones(2, 1) as matrices."""
        found = _ARGUMENTS.match(self.text, end)
        if found is None:
            raise self.source.error(f"{name}( ) is not closed", at, f"write {CONSTRUCTORS[name]}")
        listed = found[1].strip()
        if name == "diag":
            start = found.start(1) + found[1].index(listed)
            if listed[:1] == "[" and listed[-1:] == "]":
                listed, start = listed[1:-1], start + 1
            entries = [(start + part.start(), start + part.end()) for part in _PART.finditer(listed)]
            rows = columns = len(entries)
        else:
            sizes = [int(size) for size in re.findall(r"[0-9]+", listed)]
            if not _SIZES.fullmatch(listed) or max(sizes) > _MOST_SIZE:
                message = f"{name}( ) takes numbers of rows and columns"
                raise self.source.error(message, at, f"write {CONSTRUCTORS[name]}")
            entries, (rows, columns) = [], (sizes * 2)[:2]
        self.made += rows * columns
        if self.made > _MOST_MADE:
            message, repair = f"matrices by words have more than {_MOST_MADE} entries", "write smaller ones"
            raise self.source.error(message, at, repair, kind=BudgetExceeded)
        self._open("[", at)
        for i in range(rows):
            for j in range(columns):
                if j:
                    self._add("_COMMA", ",", at)
                if i == j and entries:
                    self._grouped(*entries[i])
                else:
                    self._add("VALUE", "0", at, Scalar.of(int(name == "ones" or (name == "eye" and i == j))))
            if i + 1 < rows:
                self._add("_END", ";", at)
        self._close("]", at)
        self.ahead = found.end()

    def _symbol(self, name: str, at: int, *, called: bool) -> Scalar:
        """Return the symbol `name`; raises the error with the reason if there is none."""
        self._require_product(name, at)
        variable = self.scope.variable
        if self.scope.polynomial and variable and name in EIGENVALUES and not self.scope.declares(name):
            written = {"lam" if each == "lambda" else each for each in NAME.findall(ascii_names(self.text))}
            if variable not in written and len(written & set(EIGENVALUES)) == 1:
                return self._symbol(variable, at, called=called)
        if name == PI and (self.scope.functions or self.open):  # what it is an argument of takes it, or refuses it
            return Scalar.symbol(PI)
        reasons = refusal(name)
        if reasons:
            raise self.source.error(reasons[0], at, reasons[1])
        constant = self.scope.constant(name)
        if constant is not None:
            return constant
        if not self.scope.declares(name):
            self._require_admitted(name, at, called=called)
        if len(self.symbols) >= MOST_NAMES:
            repair = "use fewer names in one matrix"
            raise self.source.error(f"more than {MOST_NAMES} different names", at, repair, kind=BudgetExceeded)
        shared = name in self.field.position  # not the e of 2e3e, which follows a number
        return self.symbols.setdefault(name, Scalar.generator(self.field, name) if shared else Scalar.symbol(name))

    def _require_product(self, name: str, at: int) -> None:
        """Raise ExpressionError for 0x10, which is 16 elsewhere, and for 1d3, 1000 in Fortran, where d3 is not declared."""
        number = self.tokens[-2] if len(self.tokens) > 1 else ""
        if number[:1] not in {*".0123456789"} or not self.text.startswith(number, at - len(number)):
            return
        if number == "0" and _OTHER_BASE.fullmatch(name):
            repair = "write the integer in decimal digits"
        elif _POWER_OF_TEN.fullmatch(name) and not self.scope.declares(name):
            repair = f"write {number}e{name[1:]} for the power of ten, {number}*{name} for the product"
        else:
            return
        raise self.source.error(f'"{number}{shown(name)}" may be a number or a product', at - len(number), repair)

    def _require_admitted(self, name: str, at: int, *, called: bool) -> None:
        if called and name == "CRootOf":
            repair = 'name it in the table [constants] of a file: r = "CRootOf(x^3 - x - 1, 0)"'
            raise self.source.error("a root of a polynomial stands inside an expression", at, repair)
        if self.scope.names is not None:
            self.unknown.append(self._unknown(name, at, called=called))
            if len(self.unknown) == _MOST_UNKNOWN:
                raise ProblemErrors(tuple(self.unknown))
        elif called:
            repair = f"write {name}*(...) for a product; the functions are {', '.join(FUNCTIONS)}"
            raise self.source.error(f'"{name}" is followed by "(" but is neither declared nor a function', at, repair)

    def _unknown(self, name: str, at: int, *, called: bool) -> InputError:
        declared, nearest = self.scope.declared(), self.scope.nearest(name, called=called)
        pairs = [(name[:i], name[i:]) for i in range(1, len(name)) if {name[:i], name[i:]} <= {*declared}]
        question = f'did you mean "{nearest}"? ' if nearest else ""
        question = f"write {'*'.join(pairs[0])} for the product; " if pairs else question
        declare = f'add {name} = "real" to [symbols], or --symbol {name}=real to a command'
        unit = self.scope.unit_first(name)
        if unit:
            declare = _unit_apart(unit)
        elif _FUNCTIONS_ELSEWHERE.fullmatch(name.lower()):
            declare = f"it is no function here; the functions are {', '.join(FUNCTIONS)}"
        listed = f"declared: {shown(', '.join(declared), 200)}{'' if question else f'; {declare}'}"
        if set(self.scope.names or ()) <= {"t"}:  # the variable and the time alone are none that anybody declared
            listed = f"no name is declared; {declare}"
        if {name, self.scope.variable} == {"s", "z"}:
            question, listed = "", _OF_OTHER_TIME[name]
        message = f'the name "{name}" is not declared{EXPONENTIAL if name == "e" else ""}'
        facts = {"name": name, "nearest": nearest, "declared": tuple(declared)}
        return self.source.error(message, at, question + listed, UnknownName, **facts)


def _unit_apart(found: re.Match[str]) -> str:
    """Return the repair for j2 or jw where it may be a name."""
    product = f"{found['unit']}*{found['frequency'] or found['size']}"
    return f"write {product} for the imaginary number, in parentheses where it is divided by or raised to a power"


#: What is said of e^(-a t), which is a power of a name here.
EXPONENTIAL = ": write exp(-a*t) for e^(-a*t)"


#: What to do about the variable of the other domain of time.
_OF_OTHER_TIME = {
    "z": "z is the variable in discrete time: give dt = true, or the period",
    "s": "s is the variable in continuous time: leave dt out, or write z",
}


# -- characters that begin no token -------------------------------------------------------------------------------

# By a word of the character's Unicode name; the first that fits.
_INSTEAD = {
    "SUPERSCRIPT": "write a power with ^, such as s^2",
    "GREEK": "spell the letter out, such as omega or lam",
    "DASH": "write the ASCII minus -",
    "DOT": "write the ASCII star *",
    "ASTERISK": "write the ASCII star *",
    "BULLET": "write the ASCII star *",
    "DIVISION": "write the ASCII slash /",
    "FRACTION": "write a fraction with /, such as 1/2",
    "SOLIDUS": "LaTeX is not read here: write [1 0; 0 1] and (s + 1)/(s + 2)",
    "DOLLAR": "write the formula alone, without dollar signs, and no LaTeX: [1 0; 0 1]",
    "CURLY": "write ( ) around what belongs together, [ ] around a list or a matrix",
    "ROOT": "write sqrt( )",
    "PERCENT": 'write 5 % as "0.05"',
    "APOSTROPHE": "a transpose is not read here: write the entries out transposed",
    "STOP": "write a digit beside the decimal point, and * / ^ without a point",
    "LOW": "begin a name with a letter",
}


def _unreadable(character: str) -> tuple[str, str]:
    """Return the message and the repair for a character that begins no token."""
    words = unicodedata.name(character, "").split()
    plain = unicodedata.normalize("NFKC", character)
    repair = "write numbers, names, + - * / ^ ( ) and, for a matrix, [ , ; ]"
    if plain != character and plain.isascii():
        repair = f'write the ASCII "{plain}"'
    repair = next((instead for word, instead in _INSTEAD.items() if word in words), repair)
    code = "" if character.isascii() else f" (U+{ord(character):04X})"
    return f'the character "{shown(character)}"{code} belongs to no expression', repair
