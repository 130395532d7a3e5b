"""Grids of points: names with exact values each, `l=0.1:0.1:10, m=[1,2,5]`; the last name runs fastest."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from math import prod
from typing import Any

from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.proof.derivation.figures_check import ALLOWS

#: More points need somebody who says that they are meant.
MOST_POINTS = 10**8
_ENTRY = re.compile(r"\s*([A-Za-z][A-Za-z0-9_]*)\s*=\s*(.+?)\s*", re.DOTALL)
_EXAMPLE = "write for example l=0.1:0.1:10, m=[1, 2, 5], k=0:1/11 (11 points) or g=decade(1e-3:1e3)"


@dataclass
class Axis:
    """A name and its values: a start, a step and a count, or a list."""

    name: str
    count: int
    start: Fraction = Fraction(0)
    step: Fraction = Fraction(0)
    listed: tuple[Fraction, ...] = ()

    def at(self, place: int) -> Fraction:
        """Return the value at a place, counted from 0."""
        return self.listed[place] if self.listed else self.start + place * self.step

    @property
    def data(self) -> list[Any]:
        """The axis as plain JSON."""
        return [self.name, self.count, str(self.start), str(self.step), [str(value) for value in self.listed]]

    @staticmethod
    def of(data: Any) -> Axis:
        """Return the axis of plain JSON."""
        name, count, start, step, listed = data
        return Axis(name, int(count), Fraction(start), Fraction(step), tuple(map(Fraction, listed)))


@dataclass
class Grid:
    """The points of a sweep."""

    axes: tuple[Axis, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The names, the fastest last."""
        return tuple(axis.name for axis in self.axes)

    @property
    def size(self) -> int:
        """How many points there are."""
        return prod(axis.count for axis in self.axes)

    def point(self, index: int) -> tuple[Fraction, ...]:
        """Return the point of an index, counted from 0."""
        places: list[Fraction] = []
        for axis in reversed(self.axes):
            index, place = divmod(index, axis.count)
            places.append(axis.at(place))
        return tuple(reversed(places))

    def told(self) -> str:
        """Return the count, the first and the last value of every name."""
        parts = (f"{a.name}: {a.count} from {a.at(0)} to {a.at(a.count - 1)}" for a in self.axes)
        return f"{self.size} points; {'; '.join(parts)}"


def read_grid(over: str | Mapping[str, Any], signs: Mapping[str, str], *, unbounded: bool = False) -> Grid:
    """Return the grid of a text, or of a mapping from names to values; raises all its errors together.

    Every name must be one of `signs`, and every value must have that sign.
    """
    entries = _entries(over) if isinstance(over, str) else list(over.items())
    axes: list[Axis] = []
    errors: list[SymobsError] = []
    for name, given in entries:
        try:
            if name in {axis.name for axis in axes}:
                raise _wrong(name, "it stands twice", "name it once")
            axes.append(_require_signs(_axis(str(name), given), signs))
        except InputError as error:
            errors.append(error)
    if not entries:
        errors.append(InputError("no name is swept", where="over", repair=_EXAMPLE))
    if errors:
        raise ProblemErrors(tuple(errors))
    grid = Grid(tuple(axes))
    if grid.size > MOST_POINTS and not unbounded:
        repair = "take larger steps, or say --yes"
        raise InputError(f"{grid.size} points, more than {MOST_POINTS}", where="over", repair=repair)
    return grid


def _entries(text: str) -> list[tuple[str, str]]:
    """Return the names and what is said of each; commas in brackets part no entries."""
    found: list[tuple[str, str]] = []
    for part in re.split(r",(?![^\[(]*[\])])", text):
        entry = _ENTRY.fullmatch(part)
        if entry is None:
            raise InputError(f'"{part.strip()[:40]}" is no name with values', where="over", repair=_EXAMPLE)
        found.append((entry[1], entry[2]))
    return found


def _axis(name: str, given: Any) -> Axis:
    if not isinstance(given, str):
        listed = given if isinstance(given, Iterable) else [given]
        return _listed(name, [_number(name, each) for each in listed])
    if given.startswith("[") and given.endswith("]"):
        return _listed(name, [_number(name, each) for each in re.split(r"[,\s]+", given[1:-1].strip())])
    if given.startswith("log("):
        raise _wrong(name, "values on a logarithmic scale are no fractions", "write decade(1e-3:1e3): 1, 2, 5, 10, …")
    if found := re.fullmatch(r"decade\((.+):(.+)\)", given):
        return _listed(name, _decades(name, _number(name, found[1]), _number(name, found[2])))
    parts = given.split(":")
    if len(parts) == 1:
        return _listed(name, [_number(name, given)])
    if len(parts) == 2:
        stop, slash, count = parts[1].rpartition("/")
        if not slash or not count.strip().isdigit() or int(count) < 2:
            raise _wrong(name, f'"{given[:40]}" has neither a step nor a count', _EXAMPLE)
        start, end, number = _number(name, parts[0]), _number(name, stop), int(count)
        return Axis(name, number, start, (end - start) / (number - 1))
    if len(parts) != 3:
        raise _wrong(name, f'"{given[:40]}" is no start:step:stop', _EXAMPLE)
    start, step, stop_at = (_number(name, part) for part in parts)
    if step == 0 or (stop_at - start) / step < 0:
        raise _wrong(name, f"steps of {step} do not lead from {start} to {stop_at}", "write start:step:stop")
    return Axis(name, int((stop_at - start) / step) + 1, start, step)


def _listed(name: str, values: list[Fraction]) -> Axis:
    if not values:
        raise _wrong(name, "it has no values", _EXAMPLE)
    return Axis(name, len(values), listed=tuple(values))


def _decades(name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    if not 0 < low <= high:
        raise _wrong(name, f"there are no decades from {low} to {high}", "write decade(1e-3:1e3)")
    power = Fraction(1)
    while power > low:
        power /= 10
    while power * 10 <= low:
        power *= 10
    found: list[Fraction] = []
    while power <= high:
        found += [value for value in (power, 2 * power, 5 * power) if low <= value <= high]
        power *= 10
    return found


def _number(name: str, given: Any) -> Fraction:
    """Return an exact number; floats are refused."""
    if isinstance(given, (int, Fraction)) and not isinstance(given, bool):
        return Fraction(given)
    if isinstance(given, str) and len(given) <= 100 and not re.search(r"[eE][-+]?[0-9]{4}", given):
        try:
            return Fraction(given.strip().replace("\N{MINUS SIGN}", "-").replace(" ", ""))
        except (ValueError, ZeroDivisionError):
            pass
    raise _wrong(
        name,
        f"{str(given)[:40]!r} is not an exact number",
        'write 1/10, or "0.1" in quotes: decimals of texts are exact',
    )


def _require_signs(axis: Axis, signs: Mapping[str, str]) -> Axis:
    if axis.name not in signs:
        known = ", ".join(sorted(signs)) or "none"
        raise _wrong(axis.name, "it is not declared in [symbols]", f"declare it, or name one of {known}")
    ends = axis.listed or (axis.at(0), axis.at(axis.count - 1))
    wanted = signs[axis.name]
    wrong = [value for value in ends if not ALLOWS[wanted](value)]
    if wanted == "nonzero" and not axis.listed and axis.step and 0 <= -axis.start / axis.step < axis.count:
        place = -axis.start / axis.step
        wrong += [Fraction(0)] if place.denominator == 1 else []
    if wrong:
        raise _wrong(
            axis.name, f"it is declared {wanted}, and {wrong[0]} is not", "leave the value out, or declare another sign"
        )
    return axis


def _wrong(name: str, message: str, repair: str) -> InputError:
    return InputError(message, where=f"over.{name}", repair=repair)
