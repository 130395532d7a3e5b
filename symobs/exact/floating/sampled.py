"""A system ẋ = A x + B w, v = C x + D w as the difference equation that a program runs, enclosed to any precision.

zoh      Φ = e^{Ah},  Γ = ∫₀ʰ e^{As} ds B,  C,  D: exact for inputs that are held over each period h
tustin   s = 2(z − 1)/(h(z + 1)):  Φ = (I − Ah/2)⁻¹(I + Ah/2),  Γ = (I − Ah/2)⁻¹Bh,  C(I − Ah/2)⁻¹,  D + C(I − Ah/2)⁻¹Bh/2
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from flint import arb, arb_mat

from symobs.exact.algebraic.enclosure import _ball, decimal, is_number, near
from symobs.exact.core.generators import PI, NotWritten, function_named, substitute
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


HOLDS = ("zoh", "tustin")
#: Bits of the enclosures that are tried in turn until both ends round to one double.
_BITS = (128, 512, 2048)
#: Below this a number is 0 in double precision: half of the smallest double.
_SMALLEST = Fraction(1, 2**1075)


class Sampled(NamedTuple):
    """A system and how its difference equation is made: with a period in a `hold`, or as it is where there is none."""

    system: Realisation
    period: Fraction | None = None
    hold: str = "zoh"

    def enclosed(self, bits: int) -> tuple[arb_mat, arb_mat, arb_mat, arb_mat]:
        """Return enclosures of Φ, Γ and of the matrices of the output."""
        with Precision(bits):
            A, B, C, D = (balls(matrix) for matrix in self.system)
            if self.period is None:
                return A, B, C, D
            h = arb(self.period.numerator) / self.period.denominator
            return (*held(A, B, h), C, D) if self.hold == "zoh" else bilinear(A, B, C, D, h)

    def rounded(self) -> Realisation:
        """Return the nearest doubles of Φ, Γ and of the matrices of the output, as exact numbers."""
        tried = [self.enclosed(bits) for bits in _BITS[:1]]
        for bits in _BITS[1:]:
            if all(_double(entry) is not None for matrix in tried[-1] for entry in matrix.entries()):
                break
            tried.append(self.enclosed(bits))
        return Realisation(*(_doubles(matrix) for matrix in tried[-1]))


def balls(matrix: Matrix) -> arb_mat:
    """Return the entries of a matrix of numbers as enclosures, at the precision in use."""
    rows, columns = matrix.shape
    return arb_mat(rows, columns, [_ball(entry) for entry in matrix.entries])


def held(A: arb_mat, B: arb_mat, h: arb) -> tuple[arb_mat, arb_mat]:
    """Return e^{Ah} and ∫₀ʰ e^{As} ds B from the exponential of [A B; 0 0] h."""
    order, width = A.nrows(), B.ncols()
    whole = arb_mat(order + width, order + width)
    for i in range(order):
        for j in range(order):
            whole[i, j] = A[i, j] * h
        for j in range(width):
            whole[i, order + j] = B[i, j] * h
    power = whole.exp()
    return part(power, (0, order), (0, order)), part(power, (0, order), (order, order + width))


def bilinear(A: arb_mat, B: arb_mat, C: arb_mat, D: arb_mat, h: arb) -> tuple[arb_mat, arb_mat, arb_mat, arb_mat]:
    """Return the matrices under s = 2(z − 1)/(h(z + 1)); raises `InputError` where 2/h is a pole."""
    order = A.nrows()
    one = arb_mat(order, order, [int(i == j) for i in range(order) for j in range(order)])
    half = A * (h / 2)
    try:
        inverse = (one - half).inv()
    except ZeroDivisionError:
        message = "the bilinear map has no value here: 2 divided by the period is a pole"
        raise InputError(message, where="period", repair="choose another period, or hold zoh") from None
    return inverse * (one + half), inverse * B * h, C * inverse, D + C * inverse * B * (h / 2)


def part(matrix: arb_mat, rows: tuple[int, int], columns: tuple[int, int]) -> arb_mat:
    """Return the rows and columns between these bounds."""
    entries = [matrix[i, j] for i in range(*rows) for j in range(*columns)]
    return arb_mat(rows[1] - rows[0], columns[1] - columns[0], entries)


def joined(blocks: list[list[arb_mat]]) -> arb_mat:
    """Return a matrix of blocks."""
    rows = [[entry for block in line for entry in block.tolist()[i]] for line in blocks for i in range(line[0].nrows())]
    return arb_mat(rows)


def _ends(ball: arb) -> tuple[Fraction, Fraction]:
    middle, radius = (Fraction(int(q.p), int(q.q)) for q in (ball.mid().fmpq(), ball.rad().fmpq()))
    return middle - radius, middle + radius


def _double(ball: arb) -> float | None:
    """Return the double that every number of a ball rounds to, None where they round to several."""
    lower, upper = _ends(ball)
    if max(abs(lower), abs(upper)) < _SMALLEST:
        return 0.0
    try:
        return float(lower) if float(lower) == float(upper) else None
    except OverflowError:
        message = "an entry is larger than any floating-point number"
        raise InputError(message, where="period", repair="choose a shorter period, or other units") from None


def _doubles(matrix: arb_mat) -> Matrix:
    """Return doubles of the entries; between two doubles, to the accuracy of the last enclosure."""
    rows = [[_double(entry) for entry in row] for row in matrix.tolist()]
    exact = [
        [Scalar.of(Fraction(float(sum(_ends(entry)) / 2) if number is None else number)) for entry, number in line]
        for line in (zip(own, found, strict=True) for own, found in zip(matrix.tolist(), rows, strict=True))
    ]
    return Matrix.of(exact, matrix.ncols())


# Exact values as functions of NumPy arrays: numerator and denominator by nested multiplication, in double precision.
#
# A polynomial is nested once, p = q xᵏ + r with the generator x that most of its terms contain, and evaluated at blocks
# of points that stay in the processor's cache. NumPy is imported by whoever brings arrays.


#: Points that are evaluated together: a few arrays of this length fit into the cache of a processor.
BLOCK = 1 << 14
Term: TypeAlias = tuple[float, dict[str, int]]


class Nested(NamedTuple):
    """q xᵏ + r."""

    high: Polynomial
    name: str
    power: int
    low: Polynomial


Polynomial: TypeAlias = "Nested | float"


class ArrayFunction:
    """Some exact values as a function of arrays, one for each name; functions such as exp(−2a) are evaluated, too."""

    def __init__(self, values: Sequence[Scalar]) -> None:
        """Nest numerators and denominators; raises `InputError` where a coefficient has no double."""
        self.fractions = [(nested(value.numerator), nested(value.denominator)) for value in values]
        self.names = sorted({name for value in values for name in value.names})

    def __call__(self, points: Mapping[str, Any]) -> Any:
        """Return an array with one row for each value; `points` has flat arrays of one length by name."""
        import numpy as np

        known = {name: at_points(name, points) for name in self.names}
        count = max((len(array) for array in points.values()), default=1)
        found = np.empty((len(self.fractions), count))
        with np.errstate(all="ignore"):
            for start in range(0, count, BLOCK):
                block = slice(start, min(start + BLOCK, count))
                here = {name: values[block] if np.ndim(values) else values for name, values in known.items()}
                for (above, below), into in zip(self.fractions, found, strict=True):
                    top = evaluated(above, here)
                    into[block] = top if below == 1.0 else top / evaluated(below, here)
        return found


def at_points(name: str, points: Mapping[str, Any]) -> Any:
    """Return the values of a generator: those of its own symbol, or a function of them."""
    import numpy as np

    function = function_named(name)
    if function is None:
        return pi if name == PI else points[name]
    argument: Scalar = function.argument
    if is_number(argument) or function.kind == "CRootOf":
        return decimal(_symbol(name))
    if function.kind == "RootSum":
        given = np.broadcast_arrays(*(points[symbol] for symbol in sorted(function.symbols)))
        rows = zip(*(array.tolist() for array in given), strict=True)
        return np.array([_sum_at(name, dict(zip(sorted(function.symbols), row, strict=True))) for row in rows])
    kind = f"arc{function.kind[1:]}" if function.kind in {"asin", "acos", "atan"} else function.kind
    return getattr(np, kind)(ArrayFunction([argument])(points)[0])


def _sum_at(name: str, point: Mapping[str, float]) -> float:
    """Return the double nearest to a sum over roots at a point, nan where it has no value."""
    try:
        return nearest_double(substitute(_symbol(name), {key: Scalar.of(shortest(x)) for key, x in point.items()}))
    except (ArithmeticError, ValueError, NotWritten, InputError):
        return float("nan")


def _symbol(name: str) -> Scalar:
    return Scalar.symbol(name)


def nested(polynomial: Scalar) -> Polynomial:
    """Return a polynomial as q xᵏ + r, and q and r likewise."""
    try:
        return _nested([(float(coefficient), dict(powers)) for coefficient, powers in polynomial.each_term()])
    except OverflowError:
        message = "a coefficient is larger than any floating-point number"
        raise InputError(message, repair="evaluate exactly with .at(...), or write the data in other units") from None


def _nested(terms: list[Term]) -> Polynomial:
    """Return the nested form of Σ c Π x^k."""
    shared = Counter(name for _, powers in terms for name in powers)
    if not shared:
        return sum((coefficient for coefficient, _ in terms), 0.0)
    name = max(shared, key=lambda each: (shared[each], each))
    having = [(coefficient, powers) for coefficient, powers in terms if name in powers]
    rest = [(coefficient, powers) for coefficient, powers in terms if name not in powers]
    least = min(powers[name] for _, powers in having)
    lowered = [
        (coefficient, {other: power - least * (other == name) for other, power in powers.items()})
        for coefficient, powers in having
    ]
    kept = [
        (coefficient, {other: power for other, power in powers.items() if power}) for coefficient, powers in lowered
    ]
    return Nested(_nested(kept), name, least, _nested(rest) if rest else 0.0)


def evaluated(polynomial: Polynomial, points: Mapping[str, Any]) -> Any:
    """Return the values of a nested polynomial."""
    if not isinstance(polynomial, Nested):
        return polynomial
    high, name, power, low = polynomial
    factor = points[name] if power == 1 else points[name] ** power
    value = factor if high == 1.0 else evaluated(high, points) * factor
    return value if low == 0.0 else value + evaluated(low, points)


def sizes(polynomial: Polynomial, points: Mapping[str, Any]) -> Any:
    """Return Σ |c| Π |x|^k, the scale of the rounding errors."""
    if not isinstance(polynomial, Nested):
        return abs(polynomial)
    high, name, power, low = polynomial
    return sizes(high, points) * abs(points[name]) ** power + sizes(low, points)


def shortest(value: float) -> Fraction:
    """Return the shortest decimal that names a double."""
    return Fraction(repr(float(value)))


# The double nearest to an exact number, and exact matrices of doubles.


#: Bits beyond the binary point to which an irrational number is enclosed, in turn, until both ends round alike.
_BITS_OF_DOUBLES = (200, 800, 2000)


def nearest_double(value: Scalar) -> float:
    """Return the double nearest to a number; raises `InputError` where it has none, `ValueError` for no number."""
    try:
        if value.is_constant:
            return float(value.fraction())
        for bits in _BITS_OF_DOUBLES:
            middle = near(value, bits)
            if middle is None:
                break
            lower, upper = float(middle - Fraction(1, 2**bits)), float(middle + Fraction(1, 2**bits))
            if lower == upper:
                return lower
    except OverflowError:
        message = f"{str(value)[:40]} is larger than any floating-point number"
        raise InputError(message, repair="write the data in other units") from None
    raise ValueError(f"{str(value)[:80]} is no number that can be rounded")


def rounded_matrix(matrix: Matrix, rounding: Callable[[Scalar], float] = nearest_double) -> Matrix:
    """Return the matrix of the nearest doubles, as exact numbers."""
    rows = [[Scalar.of(Fraction(rounding(entry))) for entry in row] for row in matrix.rows]
    return Matrix.of(rows, matrix.shape[1])
