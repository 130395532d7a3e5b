"""Differences of a printed value from the right one, entry by entry, and the simplest reason."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from symobs.applications.audit.equations import text_of_value
from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.enclosure import near
from symobs.exact.algebraic.rounded_decimals import decimals_in, rounds_to, written_out
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.exact.algebraic.rounded_decimals import PrintedDecimal

#: Numbers with roots are rounded from so many bits.
_BITS = 400
_MOST_LISTED = 4
_MOST_EXCHANGED = 12


@dataclass
class EntryDifference:
    """One entry of a printed value, and the right one; `is_part` unless it is the whole value."""

    place: str
    printed: str
    right: str
    slip: str = ""
    is_part: bool = True

    def __str__(self) -> str:
        because = f": {self.slip}" if self.slip else ""
        return f"{self.place} is {self.right}, not {self.printed}{because}"


@dataclass
class Remark:
    """A sentence on an equation as a whole, and what of it names nothing right; `slip` is its kind, where that has one."""

    said: str
    hint: str
    slip: str = ""

    def __str__(self) -> str:
        return self.said

    @classmethod
    def harmless(cls, said: str, slip: str = "") -> Remark:
        """Return a sentence that names nothing right."""
        return cls(said, said, slip)


@dataclass
class WrongTerm:
    """A term of a signal that is missing in an equation, or does not belong there."""

    signal: str
    term: str
    is_missing: bool

    def __str__(self) -> str:
        return f"the term {self.term} {self.fault}"

    @property
    def fault(self) -> str:
        """What is wrong with the term."""
        return "is missing" if self.is_missing else "does not belong there"


@dataclass
class WrongEntries:
    """The wrong entries of a value, or of the coefficient of a signal."""

    entries: tuple[EntryDifference, ...]
    inside: str = ""

    def __str__(self) -> str:
        return f"{self.inside}{'; '.join([*map(str, self.entries[:_MOST_LISTED]), *self.more])}"

    @property
    def more(self) -> list[str]:
        """How many entries are not listed, if there are any."""
        left = len(self.entries) - _MOST_LISTED
        return [f"and {left} more {'entries' if left > 1 else 'entry'}"] if left > 0 else []

    @property
    def places(self) -> list[str]:
        """The places of the wrong parts of a value; a value that is wrong as a whole has none."""
        found = [entry.place for entry in self.entries[:_MOST_LISTED] if entry.is_part]
        return [f"{self.inside}{found[0]}", *found[1:], *self.more] if found else []


@dataclass
class Reason:
    """Why an equation is false."""

    pieces: tuple[Remark | WrongTerm | WrongEntries, ...] = ()

    def __str__(self) -> str:
        return "; ".join(map(str, self.pieces))

    @property
    def is_single(self) -> bool:
        """Whether there is one remark, or one wrong term or entry."""
        return sum(len(each.entries) if isinstance(each, WrongEntries) else 1 for each in self.pieces) == 1

    def hint(self, *, is_gain: bool = False, is_alone: bool = False) -> str:
        """Return the reason without what is right: one wrong part is told, of several the places.

        Where an entry `is_alone` in its matrix, it is all that there is to find. A value that is wrong as a whole has
        its slip for a reason, or none; so has a gain with several wrong entries, which may be right in other places.
        """
        wrong = [piece for piece in self.pieces if isinstance(piece, WrongEntries)]
        if wrong and self.is_single:
            (entry,) = wrong[0].entries
            if not entry.is_part:
                return entry.slip
            return f"{entry.place} is wrong" if is_alone and not wrong[0].inside else str(self)
        remarks = [piece.hint for piece in self.pieces if isinstance(piece, Remark)]
        if any(remarks) or is_gain:
            return "; ".join(filter(None, remarks))
        places = [place for piece in wrong for place in piece.places]
        terms = [f"a term in {each.signal} {each.fault}" for each in self.pieces if isinstance(each, WrongTerm)]
        return "; ".join([*([f"not right: {', '.join(places)}"] if places else []), *terms])


ALL_SIGNS = Remark.harmless("all signs are wrong", "signs")


def as_matrix(value: Scalar | Matrix) -> Matrix:
    """Return a value as a matrix."""
    return value if isinstance(value, Matrix) else Matrix.of([[value]])


def single(printed: Scalar) -> PrintedDecimal | None:
    """Return a printed value that is a signed decimal, None for any other value."""
    decimals = decimals_in(printed)
    if len(decimals) != 1:
        return None
    ((name, decimal),) = decimals.items()
    generator = Scalar.symbol(name)
    return decimal if printed == generator else -decimal if printed == -generator else None


def wrong_entries(printed: Matrix, right: Matrix, *, whole: str = "the value") -> list[EntryDifference]:
    """Return the entries in which a printed matrix differs beyond rounding."""
    places = [(i, j) for i in range(right.shape[0]) for j in range(right.shape[1])]
    found = [
        entry(f"entry ({i + 1}, {j + 1})", printed[i, j], right[i, j])
        for i, j in places
        if not rounds_to(printed[i, j], right[i, j])
    ]
    return [replace(each, place=whole, is_part=False) for each in found] if right.shape == (1, 1) else found


def entry(place: str, printed: Scalar, right: Scalar) -> EntryDifference:
    """Return the message on a wrong value."""
    decimal, plain, exact = single(printed), written_out(printed), near(right, _BITS)
    if decimal is None or exact is None:
        return EntryDifference(place, text_of_value(plain), text_of_value(right), slip(plain, right))
    sign, size = "-" if decimal.units < 0 else "", -decimal if decimal.units < 0 else decimal
    because = decimal.slip(exact) or slip(plain, right)
    return EntryDifference(place, f"{sign}{size.rounded(size.units * size.unit)}", decimal.rounded(exact), because)


def slip(printed: Scalar, right: Scalar) -> str:
    """Return the simplest slip from one number to another, empty if there is none."""
    if printed == -right:
        return "the sign is wrong"
    if not printed.is_constant or not right.is_constant or printed.is_zero or right.is_zero:
        return ""
    ratio = printed.fraction() / right.fraction()
    power = next((n for n in range(1, 7) if abs(ratio) in (Fraction(10) ** n, Fraction(10) ** -n)), 0)
    if power and ratio > 0:
        return f"the decimal point is {power} place{'s' if power > 1 else ''} off"
    if printed.fraction() == 1 / right.fraction():
        return "numerator and denominator are exchanged"
    return ""


def reasons(printed: Matrix, right: Matrix, whole: str) -> Reason:
    """Return the simplest reason that explains all differences of a printed matrix."""
    entries = tuple(wrong_entries(printed, right, whole=whole))
    listed = WrongEntries(entries)
    if len(entries) == 1 or (entries and all(entry.slip.startswith("truncated") for entry in entries)):
        return Reason((listed,))
    printed = written_out(printed)
    if printed == -right:
        return Reason((ALL_SIGNS,))
    if printed == right.T:
        return Reason((Remark.harmless("the transpose is printed", "transposed"),))
    if _regular(right) and printed == right.inverse():
        return Reason((Remark.harmless("the inverse is printed", "inverse"),))
    exchanged = _exchanged(printed, right)
    if exchanged:
        return Reason((Remark.harmless(exchanged, "exchanged"),))
    factor = _factor(printed, right)
    if not factor:
        return Reason((listed,))
    multiplied = Remark.harmless(factor, "factor")
    return Reason((multiplied, listed) if len(entries) <= _MOST_LISTED else (multiplied,))


def _regular(matrix: Matrix) -> bool:
    return matrix.shape[0] == matrix.shape[1] > 1 and not matrix.determinant().is_zero


def _exchanged(printed: Matrix, right: Matrix) -> str:
    """Return the two exchanged entries, rows or columns."""
    rows, columns = right.shape
    cells = [(i, j) for i in range(rows) for j in range(columns) if printed[i, j] != right[i, j]]
    if len(cells) == 2:
        (a, b), (c, d) = cells
        if printed[a, b] == right[c, d] and printed[c, d] == right[a, b]:
            return f"the entries ({a + 1}, {b + 1}) and ({c + 1}, {d + 1}) are exchanged"
    for size, what in zip(right.shape, ("rows", "columns"), strict=True):
        for i, j in combinations(range(min(size, _MOST_EXCHANGED)), 2):
            order = list(range(size))
            order[i], order[j] = j, i
            chosen = (order, range(columns)) if what == "rows" else (range(rows), order)
            if printed == right.select(*chosen):
                return f"the {what} {i + 1} and {j + 1} are exchanged"
    return ""


def _factor(printed: Matrix, right: Matrix) -> str:
    """Return the rational factor between two matrices."""
    pair = next(((p, r) for p, r in zip(printed.entries, right.entries, strict=True) if not r.is_zero), None)
    if pair is None or pair[0].is_zero or printed != right * (pair[0] / pair[1]):
        return ""
    ratio = pair[0] / pair[1]
    return f"every entry is multiplied by {ratio}" if len(right.entries) > 1 else ""


def polynomial_reason(printed: Scalar, right: Scalar, variable: str) -> Reason | None:
    """Return the coefficients in which a printed polynomial differs, None if the two are not polynomials."""
    if not (printed.is_polynomial_in(variable) and right.is_polynomial_in(variable)) or right.degree(variable) < 1:
        return None
    wanted, came = (list(value.coefficients(variable)) for value in (right, printed))
    length = max(len(wanted), len(came))
    wanted, came = ([Scalar.of(0)] * (length - len(each)) + each for each in (wanted, came))
    if wanted == [-coefficient for coefficient in came]:
        return Reason((ALL_SIGNS,))
    entries = tuple(
        entry(_power_name(length - 1 - i, variable), one, other)
        for i, (one, other) in enumerate(zip(came, wanted, strict=True))
        if not rounds_to(one, other)
    )
    return Reason((WrongEntries(entries),)) if entries else None


def _power_name(power: int, variable: str) -> str:
    if power == 0:
        return "the constant term"
    return f"the coefficient of {variable}{f'^{power}' if power > 1 else ''}"


# -- values as text ---------------------------------------------------------------------------------------------------


def value_text(value: Scalar | Matrix, printed: Scalar | Matrix | None = None) -> str:
    """Return a value in the grammar of printed equations, rounded as printed."""
    if isinstance(value, Scalar):
        return _number_text(value, printed if isinstance(printed, Scalar) else None)
    alike = printed if isinstance(printed, Matrix) and printed.shape == value.shape else None
    rows = [
        " ".join(
            _number_text(entry, None if alike is None else alike[i, j]).replace(" ", "") for j, entry in enumerate(row)
        )
        for i, row in enumerate(value.rows)
    ]
    return f"[{'; '.join(rows)}]"


def _number_text(value: Scalar, printed: Scalar | None) -> str:
    decimal, exact = None if printed is None else single(printed), near(value, _BITS)
    return text_of_value(value) if decimal is None or exact is None else decimal.rounded(exact)


def term_text(value: Matrix, name: str) -> str:
    """Return a matrix times a signal."""
    if value.shape == (1, 1):
        scalar = value[0, 0]
        text = value_text(scalar)
        if scalar == Scalar.of(1):
            return name
        return f"-{name}" if scalar == Scalar.of(-1) else f"({text}) {name}" if " " in text else f"{text} {name}"
    return f"{value_text(value)} {name}"
