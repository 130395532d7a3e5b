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

from symobs.exact.algebraic.enclosure import is_number, near, polynomial_ball, sign_of_number
from symobs.exact.algebraic.polynomial_roots import Complex, rational_sqrt
from symobs.exact.algebraic.real_algebraic import integer_factor, real_roots
from symobs.exact.core.generators import (
    Function,
    all_roots,
    function_named,
    normal_form,
    partial,
    roots_in,
    square_root,
)
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.polynomial import coefficients_over
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence


_DECIMAL = re.compile(r"(?P<whole>[0-9]*)(?:\.(?P<places>[0-9]*))?(?:[eE](?P<power>[+-]?[0-9]+))?")
#: With more decimals in one number only the printed values themselves are compared.
_MOST_DECIMALS = 40
_WORKING_BITS, _RADIUS, _STEPS = 256, 60, 60


@dataclass
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
        with Precision(_WORKING_BITS):
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


# Decimals of exact numbers: rounding, digits, and the test of a printed rounding.


#: A decimal of more places is written as a fraction.
_MOST_PLACES = 12
#: From this denominator on a reader wants to see the decimals of a fraction.
_HARD_TO_READ = 10


def decimal_places(value: Scalar) -> int | None:
    """Return the number of decimal places, None where the expansion is infinite or too long."""
    if not value.is_constant:
        return None
    below = value.fraction().denominator
    return next((count for count in range(_MOST_PLACES + 1) if 10**count % below == 0), None)


def decimal_digits(value: Scalar) -> str:
    """Return the digits of a decimal, without its sign: 0.3676, 60.  Raises `ValueError` where it does not end."""
    count = decimal_places(value)
    if count is None:
        raise ValueError(f"{value} is not a decimal of at most {_MOST_PLACES} places")
    digits = str(abs(int(value.fraction() * 10**count))).zfill(count + 1)
    return f"{digits[:-count]}.{digits[-count:]}" if count else digits


def is_rounding(exact: Scalar, shown: Scalar) -> bool:
    """Return whether a decimal is within half a unit of its last place; an integer must be exact."""
    count = decimal_places(shown)
    if count is None:
        return False
    if not exact.is_constant:
        half = Scalar.of(Fraction(1, 2 * 10**count))
        return count > 0 and all(sign_of_number(half + off) == "positive" for off in (exact - shown, shown - exact))
    off = abs(exact.fraction() - shown.fraction())
    return off == 0 if count == 0 else off * 2 * 10**count <= 1


def rounded(value: Matrix | Scalar) -> Matrix | Scalar | None:
    """Return a number or matrix rounded to decimals that suit its magnitude, trailing zeros omitted.

    None where they help nobody: nothing in it is a fraction with a large denominator, or an entry would be rounded to a
    whole number, which reads as if it were exact.
    """
    entries = value.entries if isinstance(value, Matrix) else (value,)
    numbers = [number for entry in entries if (number := _number(entry)) is not None]
    if not entries or len(numbers) < len(entries):
        return None
    if all(number.denominator < _HARD_TO_READ for number in numbers):
        return None
    found = _rounded(numbers)
    if any(near.denominator == 1 != number.denominator for near, number in zip(found, numbers, strict=True)):
        return None
    shown = [Scalar.of(near) for near in found]
    if not isinstance(value, Matrix):
        return shown[0]
    width = value.shape[1]
    return Matrix.of([shown[start : start + width] for start in range(0, len(shown), width)])


def _number(value: Scalar) -> Fraction | None:
    """Return a rational number; of a square root of one, or a real root without a closed form, an approximation."""
    if value.is_constant:
        return value.fraction()
    functions = [f for name in value.names if (f := function_named(name)) is not None]
    return near(value) if any(f.square or f.kind == "CRootOf" for f in functions) else None


def _rounded(numbers: Iterable[Fraction]) -> list[Fraction]:
    """Round to four places, larger numbers to fewer."""
    numbers = list(numbers)
    largest = max(abs(number) for number in numbers)
    count = 4 if largest < 10 else 3 if largest < 100 else 2
    return [Fraction(round(number * 10**count), 10**count) for number in numbers]


# Conjugates of complex numbers with square roots, and polynomials from which the roots have gone.


def tidied(value: Complex) -> Complex:
    """Return a complex number with both parts in normal form."""
    return Complex(normal_form(value.real), normal_form(value.imaginary))


def conjugates(value: Complex, *, of_numbers: bool) -> tuple[Complex, ...]:
    """Return the distinct images of a number under changes of the signs of i and its roots, itself first.

    Roots of numbers keep their signs unless `of_numbers` is set.
    """
    roots = dict.fromkeys(root for part in (value.real, value.imaginary) for root in roots_in(part))
    found = [value]
    for root in roots:
        if of_numbers or not is_number(root.argument):
            found += [_with_sign_changed(image, root) for image in found]
    return tuple(dict.fromkeys([*found, *(image.conjugate() for image in found)]))


def _with_sign_changed(value: Complex, root: Function) -> Complex:
    images: dict[str, Scalar] = {root.name: -root.value}
    return tidied(Complex(value.real.substitute(images), value.imaginary.substitute(images)))


def product_of_linear(variable: str, roots: Sequence[Complex]) -> Scalar | None:
    """Return Π (s − root), multiplied out; None unless its coefficients are real, and have no roots but of primes."""
    product = Complex.of(1)
    for root in roots:
        product = product * (Complex.of(Scalar.symbol(variable)) - root)
    product = tidied(product)
    return product.real if product.is_real and all(root.square for root in all_roots(product.real)) else None


def is_in_kernel(value: Scalar) -> bool:
    """Return whether the only functions of a value are roots of primes."""
    functions = (function_named(name) for name in value.names)
    return all(function is None or function.square for function in functions)


def root_in_field(number: Scalar) -> Scalar | None:
    """Return the positive square root of a positive number where it is one of a field Q(√2, √3, …).

    √(3 + 2 √2) = 1 + √2, and √(2 + √3) = (√6 + √2)/2.
    """
    if number.is_constant:
        root = square_root(number)
        return root if is_in_kernel(root) else None
    if not is_number(number) or not is_in_kernel(number) or sign_of_number(number) != "positive":
        return None
    variable = "x"
    found = (Scalar.symbol(variable) ** 2 - number).factors()[1]
    if len(found) == 1:
        return _sum_of_two_roots(number)
    if found[0][0].degree(variable) != 1:  # as of 1/pi
        return None
    lead, constant = found[0][0].coefficients(variable)
    root = constant / lead
    return root if sign_of_number(root) == "positive" else -root


def _sum_of_two_roots(number: Scalar) -> Scalar | None:
    """Return √(a + b √d) as √((a + e)/2) ± √((a − e)/2) where e² = a² − b² d is the square of a rational number."""
    field = number.field
    names = [field.names[index] for index, _ in field.roots if field.names[index] in number.names]
    if len(names) != 1:
        return None
    other = number.substitute({names[0]: -Scalar.symbol(names[0])})
    norm, mean = (number * other).fraction(), ((number + other) / 2).fraction()
    size = rational_sqrt(norm) if norm >= 0 else None
    if size is None:
        return None
    first, second = (square_root(Scalar.of((mean + part) / 2)) for part in (size, -size))
    found = next(total for total in (first + second, first - second) if total**2 == number)
    return found if is_in_kernel(found) else None
