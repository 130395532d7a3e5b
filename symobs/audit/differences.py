"""Two values side by side: what is wrong with the one printed, entry by entry, and the simplest reason."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.audit.grammar import Node

_DECIMAL = re.compile(r"(?P<whole>[0-9]*)(?:\.(?P<places>[0-9]*))?(?:[eE](?P<power>[+-]?[0-9]+))?")
_MOST_LISTED = 4
_MOST_EXCHANGED = 12


@dataclass(frozen=True)
class Decimal:
    """A decimal as it is printed: so many units of its last place, with the power of ten written beside it."""

    units: int
    places: int
    power: str

    @property
    def unit(self) -> Fraction:
        """What one in the last place is worth."""
        return Fraction(10) ** (int(self.power or 0) - self.places)

    def agrees(self, exact: Fraction) -> bool:
        """Whether this is the exact value, rounded to its last place."""
        return abs(exact / self.unit - self.units) <= Fraction(1, 2)

    def rounded(self, exact: Fraction) -> str:
        """Return an exact value, rounded as this is written."""
        units = round(exact / self.unit)
        digits = str(abs(units)).rjust(self.places + 1, "0")
        text = digits if self.places == 0 else f"{digits[: -self.places]}.{digits[-self.places :]}"
        return f"{'-' if units < 0 else ''}{text}{f'e{self.power}' if self.power else ''}"

    def slip(self, exact: Fraction) -> str:
        """Return what happened to the exact value on its way into print, empty where that is not plain."""
        if int(exact / self.unit) == self.units:  # towards 0
            return "truncated, not rounded"
        return "the sign is wrong" if abs(-exact / self.unit - self.units) <= Fraction(1, 2) else ""


def decimal_of(node: Node) -> Decimal | None:
    """Return the decimal that an entry is, where it is one with a point or a power of ten."""
    sign, inner = (-1, node.parts[0]) if node.kind == "negative" else (1, node)
    match = _DECIMAL.fullmatch(inner.text) if inner.kind == "number" else None
    if match is None or (match["places"] is None and match["power"] is None):
        return None
    places = match["places"] or ""
    return Decimal(sign * int((match["whole"] + places) or "0"), len(places), match["power"] or "")


@dataclass(frozen=True)
class Entry:
    """One entry of a printed value, and the right one."""

    place: str
    printed: str
    right: str
    slip: str = ""

    def __str__(self) -> str:
        because = f": {self.slip}" if self.slip else ""
        return f"{self.place} is {self.right}, not {self.printed}{because}"


def as_matrix(value: Scalar | Matrix) -> Matrix:
    """Return a value as a matrix."""
    return value if isinstance(value, Matrix) else Matrix.of([[value]])


def decimals_of(node: Node, shape: tuple[int, int]) -> dict[tuple[int, int], Decimal]:
    """Return the decimals among the entries of a printed matrix or number."""
    rows = [row.parts for row in node.parts] if node.kind == "block" else [(node,)]
    if (len(rows), len(rows[0])) != shape:
        return {}
    cells = {(i, j): decimal_of(cell) for i, row in enumerate(rows) for j, cell in enumerate(row)}
    return {place: found for place, found in cells.items() if found is not None}


def wrong_entries(
    printed: Matrix, right: Matrix, decimals: dict[tuple[int, int], Decimal], *, whole: str = "the value"
) -> list[Entry]:
    """Return the entries in which a printed matrix differs; decimals may be rounded."""
    found = []
    for i in range(right.shape[0]):
        for j in range(right.shape[1]):
            place = whole if right.shape == (1, 1) else f"entry ({i + 1}, {j + 1})"
            decimal = decimals.get((i, j)) if right[i, j].is_constant else None
            if decimal is None and printed[i, j] != right[i, j]:
                found.append(
                    Entry(place, value_text(printed[i, j]), value_text(right[i, j]), slip(printed[i, j], right[i, j]))
                )
            elif decimal is not None and not decimal.agrees(exact := right[i, j].fraction()):
                because = decimal.slip(exact) or slip(printed[i, j], right[i, j])
                text = f"{'-' if decimal.units < 0 else ''}{_as_written(decimal)}"
                found.append(Entry(place, text, decimal.rounded(exact), because))
    return found


def _as_written(decimal: Decimal) -> str:
    return decimal.rounded(abs(decimal.units) * decimal.unit).removeprefix("-")


def slip(printed: Scalar, right: Scalar) -> str:
    """Return the simplest slip that makes one number of another, empty where there is none."""
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


def reasons(printed: Matrix, right: Matrix, decimals: dict[tuple[int, int], Decimal], whole: str) -> str:
    """Return why a printed matrix is not the right one, the simplest that explains all of it."""
    entries = wrong_entries(printed, right, decimals, whole=whole)
    if len(entries) == 1 or (entries and all(entry.slip.startswith("truncated") for entry in entries)):
        return listed(entries)
    if printed == -right:
        return "all signs are wrong"
    if printed == right.T:
        return "the transpose is printed"
    if printed == right.inverse() if _regular(right) else False:
        return "the inverse is printed"
    exchanged = _exchanged(printed, right)
    if exchanged:
        return exchanged
    factor = _factor(printed, right)
    return f"{factor}; {listed(entries)}" if factor and len(entries) <= _MOST_LISTED else factor or listed(entries)


def listed(entries: Sequence[Entry]) -> str:
    """Return the wrong entries as one text."""
    more = [f"and {len(entries) - _MOST_LISTED} more entries"] if len(entries) > _MOST_LISTED else []
    return "; ".join([*map(str, entries[:_MOST_LISTED]), *more])


def _regular(matrix: Matrix) -> bool:
    return matrix.shape[0] == matrix.shape[1] > 1 and not matrix.determinant().is_zero


def _exchanged(printed: Matrix, right: Matrix) -> str:
    """Return which two entries, rows or columns are exchanged."""
    rows, columns = right.shape
    cells = [(i, j) for i in range(rows) for j in range(columns) if printed[i, j] != right[i, j]]
    if len(cells) == 2:
        (a, b), (c, d) = cells
        if printed[a, b] == right[c, d] and printed[c, d] == right[a, b]:
            return f"the entries ({a + 1}, {b + 1}) and ({c + 1}, {d + 1}) are exchanged"
    for size, what, line in ((rows, "rows", 0), (columns, "columns", 1)):
        for i in range(min(size, _MOST_EXCHANGED)):
            for j in range(i):
                order = list(range(size))
                order[i], order[j] = j, i
                chosen = (order, range(columns)) if line == 0 else (range(rows), order)
                if printed == right.select(*chosen):
                    return f"the {what} {j + 1} and {i + 1} are exchanged"
    return ""


def _factor(printed: Matrix, right: Matrix) -> str:
    """Return the rational factor between two matrices."""
    pair = next(((p, r) for p, r in zip(printed.entries, right.entries, strict=True) if not r.is_zero), None)
    if pair is None or pair[0].is_zero or printed != right * (pair[0] / pair[1]):
        return ""
    ratio = pair[0] / pair[1]
    return f"every entry is multiplied by {ratio}" if len(right.entries) > 1 else ""


def polynomial_reason(printed: Scalar, right: Scalar, variable: str) -> str:
    """Return in which coefficients a printed polynomial differs, empty where the two are no polynomials."""
    if not (printed.is_polynomial_in(variable) and right.is_polynomial_in(variable)) or right.degree(variable) < 1:
        return ""
    wanted, came = (list(value.coefficients(variable)) for value in (right, printed))
    length = max(len(wanted), len(came))
    wanted, came = ([Scalar.of(0)] * (length - len(each)) + each for each in (wanted, came))
    if wanted == [-coefficient for coefficient in came]:
        return "all signs are wrong"
    entries = [
        Entry(_power_name(length - 1 - i, variable), value_text(one), value_text(other), slip(one, other))
        for i, (one, other) in enumerate(zip(came, wanted, strict=True))
        if one != other
    ]
    return listed(entries)


def _power_name(power: int, variable: str) -> str:
    if power == 0:
        return "the constant term"
    return f"the coefficient of {variable}{f'^{power}' if power > 1 else ''}"


# -- values as text ---------------------------------------------------------------------------------------------------


def value_text(value: Scalar | Matrix, decimals: dict[tuple[int, int], Decimal] | None = None) -> str:
    """Return a value in the grammar of printed equations, its decimals rounded as they are printed."""
    if isinstance(value, Scalar):
        decimal = (decimals or {}).get((0, 0))
        return decimal.rounded(value.fraction()) if decimal and value.is_constant else str(value).replace("**", "^")
    rows = []
    for i, row in enumerate(value.rows):
        cells = []
        for j, entry in enumerate(row):
            decimal = (decimals or {}).get((i, j)) if entry.is_constant else None
            text = decimal.rounded(entry.fraction()) if decimal else str(entry).replace("**", "^")
            cells.append(text.replace(" ", ""))
        rows.append(" ".join(cells))
    return f"[{'; '.join(rows)}]"
