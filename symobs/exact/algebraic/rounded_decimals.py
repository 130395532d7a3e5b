"""Printed decimals, each of which stands for the numbers that round to it.

A decimal is read as a generator (`0.866@17`, by its text and its place), so that a printed value is a rational function of its
decimals.  It agrees with an exact value where numbers that round to the decimals make both equal: a system of polynomial
equations, linear ones solved exactly, the rest by a certified root.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from flint import arb, arb_mat

from symobs.exact.algebraic.complex import Complex
from symobs.exact.algebraic.enclosure import is_number, polynomial_ball, sign_of_number
from symobs.exact.algebraic.real_algebraic import integer_factor, real_roots
from symobs.exact.core.generators import partial
from symobs.exact.core.polynomial import coefficients_over
from symobs.exact.core.precision import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from symobs.exact.core.matrix import Matrix

_DECIMAL = re.compile(r"(?P<whole>[0-9]*)(?:\.(?P<places>[0-9]*))?(?:[eE](?P<power>[+-]?[0-9]+))?")
#: With more decimals in one number only the printed values themselves are compared.
_MOST_DECIMALS = 40
_BITS, _RADIUS, _STEPS = 256, 60, 60


@dataclass(frozen=True)
class PrintedDecimal:
    """A printed decimal: an integer number of units in the last place, times a power of ten."""

    units: int
    places: int
    power: str

    @staticmethod
    def of(text: str) -> PrintedDecimal | None:
        """Return the decimal of a text, None without a point or a power of ten."""
        match = _DECIMAL.fullmatch(text)
        if match is None or (match["places"] is None and match["power"] is None):
            return None
        places = match["places"] or ""
        return PrintedDecimal(int((match["whole"] + places) or "0"), len(places), match["power"] or "")

    def __neg__(self) -> PrintedDecimal:
        return PrintedDecimal(-self.units, self.places, self.power)

    @property
    def unit(self) -> Fraction:
        """The unit of the last place."""
        return Fraction(10) ** (int(self.power or 0) - self.places)

    @property
    def ends(self) -> tuple[Fraction, Fraction]:
        """The least and the largest number that rounds to it."""
        half = Fraction(1, 2)
        return (self.units - half) * self.unit, (self.units + half) * self.unit

    def agrees(self, exact: Fraction) -> bool:
        """Return whether this is the exact value, rounded to its last place."""
        return self.ends[0] <= exact <= self.ends[1]

    def rounded(self, exact: Fraction) -> str:
        """Return an exact value rounded to the same place."""
        units = round(exact / self.unit)
        digits = str(abs(units)).rjust(self.places + 1, "0")
        text = digits if self.places == 0 else f"{digits[: -self.places]}.{digits[-self.places :]}"
        return f"{'-' if units < 0 else ''}{text}{f'e{self.power}' if self.power else ''}"

    def slip(self, exact: Fraction) -> str:
        """Return the likely misprint of an exact value (a digit, a sign, an exchange), empty if none fits."""
        if int(exact / self.unit) == self.units:  # towards 0
            return "truncated, not rounded"
        return "the sign is wrong" if self.agrees(-exact) else ""


def as_generator(text: str, place: int) -> Scalar | None:
    """Return the generator of a decimal, None for another text."""
    return None if PrintedDecimal.of(text) is None else Scalar.symbol(f"{text}@{place}")


def decimals_in(value: Scalar | Matrix) -> dict[str, PrintedDecimal]:
    """Return the decimals of a value by their generators."""
    names = sorted(name for name in value.names if "@" in name)
    return {name: found for name in names if (found := PrintedDecimal.of(name.partition("@")[0])) is not None}


def written_out(value: Any) -> Any:
    """Return a value with every decimal replaced by its exact number."""
    names = decimals_in(value)
    return value.substitute({name: Scalar.of(each.units * each.unit) for name, each in names.items()})


def rounds_to(printed: Scalar, exact: Scalar) -> bool:
    """Return whether the printed value equals the exact one for some numbers that round to its decimals."""
    decimals = decimals_in(printed)
    if written_out(printed) == exact:
        return True
    if not decimals or len(decimals) > _MOST_DECIMALS:
        return False
    alike = {name: Scalar.symbol(name.partition("@")[0] + "@") for name in decimals}
    merged = {str(alike[name]): each for name, each in decimals.items()}
    equations = _equations(printed - exact, decimals)
    return _DecimalBox(decimals).holds_solution(equations) or (
        len(merged) < len(decimals)
        and _DecimalBox(merged).holds_solution([equation.substitute(alike) for equation in equations])
    )


def polynomial_of(roots: Iterable[Complex], variable: str) -> Scalar:
    """Return the polynomial with printed roots; of a complex pair both have the same decimals.

    Raises ValueError where a root lacks its complex conjugate.
    """
    s, value, waiting = Scalar.symbol(variable), Scalar.of(1), list(roots)
    while waiting:
        first = waiting.pop(0)
        if first.is_real:
            value = value * (s - first.real)
            continue
        opposite = Complex(written_out(first.real), -written_out(first.imaginary))
        plain = [Complex(written_out(each.real), written_out(each.imaginary)) for each in waiting]
        del waiting[plain.index(opposite)]
        value = value * ((s - first.real) ** 2 + first.imaginary**2)
    return value


def _equations(difference: Scalar, decimals: Mapping[str, PrintedDecimal]) -> list[Scalar]:
    """Return the coefficients that have to vanish: polynomials in the decimals, over numbers."""
    numbers = {name for name in difference.names if name in decimals or is_number(Scalar.symbol(name))}
    return [equation for equation in coefficients_over(difference, numbers) if not equation.is_zero]


class _DecimalBox:
    """The ranges of decimals and the equations between them; `meanings` holds the decimals solved for."""

    def __init__(self, decimals: Mapping[str, PrintedDecimal]) -> None:
        self.decimals = dict(decimals)
        self.meanings = {name: Scalar.symbol(name) for name in decimals}

    def holds_solution(self, equations: Iterable[Scalar]) -> bool:
        """Return whether the equations are proved to have a solution in the box."""
        left = self._solved([each for each in equations if not each.is_zero])
        if left is None:
            return False
        open_names = sorted(
            {name for value in (*left, *self.meanings.values()) for name in value.names} & {*self.decimals}
        )
        involved = [name for name in open_names if any(name in each.names for each in left)]
        if not left:
            return self._free(open_names)
        if len(involved) == 1 and all(each.names == {involved[0]} for each in left):
            return self._with_root(involved[0], left)
        if len(involved) > len(left):  # more decimals than equations: one as printed
            fixed = self._solved(left, {involved[0]: self._printed(involved[0])})
            return fixed is not None and self.holds_solution(fixed)
        return len(involved) == len(left) and self._near(involved, left)

    def _printed(self, name: str) -> Scalar:
        return Scalar.of(self.decimals[name].units * self.decimals[name].unit)

    def _solved(self, equations: list[Scalar], known: Mapping[str, Scalar] | None = None) -> list[Scalar] | None:
        """Solve the equations that are linear in a decimal; return the others, None on a contradiction."""
        while True:
            if known:
                self.meanings = {name: value.substitute(known) for name, value in self.meanings.items()}
                equations = [value for each in equations if not (value := each.substitute(known).numerator).is_zero]
            if any(self.decimals.keys().isdisjoint(each.names) for each in equations):
                return None
            known = next((found for each in equations if (found := self._linear(each))), None)
            if known is None:
                return equations

    def _linear(self, equation: Scalar) -> dict[str, Scalar]:
        """Return one decimal that an equation gives, in the others."""
        for name in sorted(equation.names & self.decimals.keys()):
            if equation.degree(name) == 1:
                slope, rest = equation.coefficients(name)
                if self.decimals.keys().isdisjoint(slope.names):
                    return {name: -rest / slope}
        return {}

    def _free(self, names: Sequence[str]) -> bool:
        """Return whether a free decimal can be chosen by intervals, all others as printed."""
        for name in names[1:]:
            self._solved([], {name: self._printed(name)})
        if not names:
            return all(_between(value, self.decimals[name].ends) for name, value in self.meanings.items())
        low, high = self.decimals[names[0]].ends
        for name, value in self.meanings.items():
            if value.degree(names[0]) > 1 or not value.denominator.is_constant:
                return False
            slope, constant = value.coefficients(names[0]) if value.degree(names[0]) else (Scalar.of(0), value)
            if not (slope.is_constant and constant.is_constant):
                return False
            if slope.is_zero:
                if not self.decimals[name].agrees(constant.fraction()):
                    return False
                continue
            ends = sorted((end - constant.fraction()) / slope.fraction() for end in self.decimals[name].ends)
            low, high = max(low, ends[0]), min(high, ends[1])
        return low <= high

    def _with_root(self, name: str, equations: Sequence[Scalar]) -> bool:
        """Return whether a common root of the equations in one decimal lies in the box."""
        common = integer_factor(equations[0], name)
        for equation in equations[1:]:
            common = common.gcd(integer_factor(equation, name))
        return any(
            all(
                _between(value.substitute({name: number.scalar()}), self.decimals[decimal].ends)
                for decimal, value in self.meanings.items()
            )
            for number in real_roots(common)
        )

    def _near(self, names: Sequence[str], equations: Sequence[Scalar]) -> bool:
        """Return whether Newton's method finds a root in the box and an interval step proves it."""
        with Precision(_BITS):
            return self._is_root_near(names, equations)

    def _is_root_near(self, names: Sequence[str], equations: Sequence[Scalar]) -> bool:
        try:
            slopes = [[partial(equation, name) for name in names] for equation in equations]
            point = [
                arb(number.numerator) / number.denominator for number in (self._printed(n).fraction() for n in names)
            ]
            for _ in range(_STEPS):
                point = [value.mid() for value in _step(names, equations, slopes, point, point)]
            around = [value + arb(0, arb(2) ** -_RADIUS) for value in point]
            found = _step(names, equations, slopes, point, around)
            if not all(large.contains_interior(small) for large, small in zip(around, found, strict=True)):
                return False
            balls = dict(zip(names, found, strict=True))
            values = {
                name: polynomial_ball(value.numerator, balls) / polynomial_ball(value.denominator, balls)
                for name, value in self.meanings.items()
            }
            return all(_holds(self.decimals[name].ends, value) for name, value in values.items())
        except ZeroDivisionError:  # the slopes are singular there
            return False


def _step(
    names: Sequence[str],
    equations: Sequence[Scalar],
    slopes: Sequence[Sequence[Scalar]],
    point: Sequence[arb],
    around: Sequence[arb],
) -> list[arb]:
    """Return point − J(around)⁻¹ f(point)."""
    here, there = dict(zip(names, point, strict=True)), dict(zip(names, around, strict=True))
    values = arb_mat([[polynomial_ball(equation, here)] for equation in equations])
    matrix = arb_mat([[polynomial_ball(slope, there) for slope in row] for row in slopes])
    steps = matrix.solve(values)
    return [value - steps[i, 0] for i, value in enumerate(point)]


def _holds(ends: tuple[Fraction, Fraction], value: arb) -> bool:
    low, high = (arb(end.numerator) / end.denominator for end in ends)
    return bool(value > low and value < high)


def _between(value: Scalar, ends: tuple[Fraction, Fraction]) -> bool:
    if value.is_constant:
        return ends[0] <= value.fraction() <= ends[1]
    return sign_of_number(value - ends[0]) == sign_of_number(ends[1] - value) == "positive"
