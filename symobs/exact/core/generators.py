"""Functions as generators: exp, cos, sin, cosh and sinh of an argument, square roots, and those of nonlinear plants.

A generator's name is SymPy's text, `exp(-2*t)` or `cos(sqrt(3)*t)`, and carries the function (`Generator`), so that its
derivative follows from the value alone: d/dt is Σ ∂/∂generator · generator′.  Different generators may depend on each
other, exp(−2t) = exp(−t)²; `identities` says how: what each one is in the base of a set of values, and which polynomials
vanish there.
"""

from __future__ import annotations

from fractions import Fraction
from math import gcd, isqrt
from typing import TYPE_CHECKING, cast, overload

from flint import fmpz

from symobs.exact.core.field import Generator
from symobs.exact.core.matrix import Matrix, measures
from symobs.exact.core.polynomial import highest_power
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping, Sequence

#: Integers of more bits are not split into primes under a root.
_PRIME_BITS = 128
#: The highest multiple of an angle whose cosine is written by that of the angle, and power of an exponential.
_MOST_MULTIPLE, _MOST_POWER = 1000, 100_000
#: Many exponents that are related have a small common measure; higher powers take too long.
_LARGEST_POWER = 1_000_000
#: Relations of angles and of exponents with larger multiples need polynomials of a higher degree than claims have.
_RELATED_ANGLES, _RELATED_POWERS = 30, 100
_WHOLE_POWER = 1000  # e^{p/q} is a power of e^{1/q} up to here: beyond, a polynomial of that degree
ZERO, ONE = Scalar.of(0), Scalar.of(1)
#: The number π, a generator like a parameter: no polynomial over Q vanishes at it.
PI = "pi"
#: cos(π r) for r = 0, 1/6, 1/4, 1/3, 1/2: (rational factor, radicand).
_COSINES = {Fraction(0): (Fraction(1), 1), Fraction(1, 6): (Fraction(1, 2), 3), Fraction(1, 4): (Fraction(1, 2), 2)}
_COSINES |= {Fraction(1, 3): (Fraction(1, 2), 1), Fraction(1, 2): (Fraction(0), 1)}


class NotWritten(ArithmeticError):
    """A value has no closed form by square roots."""


@dataclass
class Function:
    """kind(argument): exp, cos, sin, cosh, sinh, one of `INVERSES` or `PIECES`, or sqrt, whose argument is the radicand."""

    kind: str
    argument: Scalar

    @property
    def text(self) -> str:
        """SymPy's text."""
        return f"{self.kind}({self.argument})"

    @property
    def name(self) -> Generator:
        """The name of the generator, with the function attached."""
        return Generator(self)

    @property
    def value(self) -> Scalar:
        """The function as a generator."""
        return Scalar.symbol(self.name)

    @property
    def square(self) -> int:
        """The prime whose positive square root this is: values are kept in normal form in it; else 0."""
        number = int(self.argument.fraction()) if self.kind == "sqrt" and self.argument.is_constant else 0
        return number if number.bit_length() <= _PRIME_BITS and fmpz(number).is_prime() else 0

    @property
    def symbols(self) -> frozenset[str]:
        """The plain symbols inside."""
        return symbols_in(self.argument)

    def rate(self, time: str) -> Scalar:
        """Return d/dt, by the chain rule."""
        slope = derivative(self.argument, time)
        if slope.is_zero:
            return ZERO
        if self.kind in KINDS:
            sign, kind = _RATES[self.kind]
            return slope * generator(kind, self.argument) * sign
        return slope * _slope(self.kind, self.argument)

    def moved(self, values: Mapping[str, Scalar]) -> Scalar:
        """Return the function with symbols substituted in its argument."""
        argument = substitute(self.argument, values)
        return square_root(argument) if self.kind == "sqrt" else function(self.kind, argument)


_RATES = {"exp": (1, "exp"), "sin": (1, "cos"), "cos": (-1, "sin"), "sinh": (1, "cosh"), "cosh": (1, "sinh")}
#: The functions that move with time, beside roots; and those that are quotients of two of them.
KINDS = frozenset(_RATES)
QUOTIENTS = {"tan": ("sin", "cos"), "tanh": ("sinh", "cosh")}
#: The inverse functions, and those that are smooth in pieces.
INVERSES = frozenset(("log", "asin", "acos", "atan"))
PIECES = frozenset(("abs", "sign"))


def function_named(name: str) -> Function | None:
    """Return the function that a generator denotes, None for a plain symbol."""
    return cast("Function", name.function) if isinstance(name, Generator) else None


def generator(kind: str, argument: Scalar) -> Scalar:
    """Return kind(argument) as a generator, without simplification."""
    return Function(kind, argument).value


def function(kind: str, argument: Scalar) -> Scalar:
    """Return kind(argument), of the argument's normal form, with a positive leading coefficient for even and odd ones.

    Raises ZeroDivisionError for a number that the function is not defined at.
    """
    argument = normal_form(argument)
    if kind in QUOTIENTS:
        return function(QUOTIENTS[kind][0], argument) / function(QUOTIENTS[kind][1], argument)
    if kind in INVERSES:
        return _inverse(kind, argument)
    if kind in PIECES:
        return _piece(kind, argument)
    if argument.is_zero:
        return ONE if kind in {"exp", "cos", "cosh"} else ZERO
    if kind == "exp" and (undone := _undone(argument, {"log"})) is not None and not undone[0]:
        return undone[1].argument ** undone[2]
    if kind in {"cos", "sin"} and (undone := _undone(argument, {"asin", "acos", "atan"})) is not None:
        return _of_inverse(kind, *undone)
    if kind in {"cos", "sin"} and argument.names == {PI} and (argument / Scalar.symbol(PI)).is_constant:
        turns = (argument / Scalar.symbol(PI)).fraction()
        return _cosine(turns if kind == "cos" else turns - Fraction(1, 2))
    if kind == "exp" and argument.is_constant and abs(power := argument.fraction().numerator) <= _WHOLE_POWER:
        return generator("exp", argument / power) ** power  # equal numbers by equal generators
    if kind == "exp" or not leads_with_minus(argument):
        return generator(kind, argument)
    return generator(kind, -argument) * (-1 if kind in {"sin", "sinh"} else 1)


def _slope(kind: str, argument: Scalar) -> Scalar:
    """Return the derivative of a root, an inverse function or a piecewise one by its argument."""
    match kind:
        case "sqrt":
            return 1 / (2 * generator(kind, argument))
        case "log":
            return 1 / argument
        case "atan":
            return 1 / (1 + argument * argument)
        case "asin" | "acos":
            return (1 if kind == "asin" else -1) / root_of(1 - argument * argument)
        case "abs":
            return function("sign", argument)
    return ZERO


def _inverse(kind: str, argument: Scalar) -> Scalar:
    """Return an inverse function: a multiple of π where a table has it, asin and atan odd, acos(−x) = π − acos x."""
    if kind == "log":
        own = function_named(next(iter(argument.names))) if len(argument.names) == 1 else None
        if own is not None and own.kind == "exp" and argument == own.value:
            return own.argument
        if argument.is_constant and argument.fraction() <= 0:
            raise ZeroDivisionError(f"log({argument}) has no real value")
        return ZERO if argument.is_one else generator(kind, argument)
    if kind != "atan" and argument.is_constant and abs(argument.fraction()) > 1:
        raise ZeroDivisionError(f"{kind}({argument}) has no real value")
    pi = Scalar.symbol(PI)
    for turns, (front, radicand) in _COSINES.items():
        for sign in (1, -1):
            cosine = square_root(Scalar.of(radicand)) * front * sign
            angle = turns if sign > 0 else 1 - turns
            if kind != "atan" and cosine == argument:
                return pi * (angle if kind == "acos" else Fraction(1, 2) - angle)
            if kind == "atan" and turns < Fraction(1, 2) and argument == _sine(turns) * sign / (cosine * sign):
                return pi * turns * sign
    if not leads_with_minus(argument):
        return generator(kind, argument)
    return pi - generator(kind, -argument) if kind == "acos" else -generator(kind, -argument)


def _sine(turns: Fraction) -> Scalar:
    """Return sin(π r)."""
    return _cosine(turns - Fraction(1, 2))


def _piece(kind: str, argument: Scalar) -> Scalar:
    """Return |x| or the sign of x: of a number its value, of others with a positive leading coefficient."""
    if argument.is_constant:
        number = argument.fraction()
        return Scalar.of(abs(number) if kind == "abs" else (number > 0) - (number < 0))
    if leads_with_minus(argument):
        return _piece(kind, -argument) * (1 if kind == "abs" else -1)
    if argument.names and all(map(_is_positive_number, argument.names)) and min(c for c, _ in argument.terms()) > 0:
        return argument if kind == "abs" else ONE
    return generator(kind, argument)


def _is_positive_number(name: str) -> bool:
    """Return whether a generator is π or the root of a number."""
    found = function_named(name)
    return name == PI if found is None else found.kind == "sqrt" and found.argument.is_constant


def root_of(radicand: Scalar) -> Scalar:
    """Return √radicand as one generator where a square of letters would stand before it, whose sign is not known here."""
    _, factors = radicand.factors()
    if any(abs(power) > 1 for _, power in factors):
        return generator("sqrt", radicand)
    return square_root(radicand)


def _undone(argument: Scalar, kinds: set[str]) -> tuple[Fraction, Function, int] | None:
    """Return (r, f, m) of π r + m f, with an inverse function f of one of the kinds and an integer m; else None."""
    found = [f for name in argument.names if (f := function_named(name)) is not None and f.kind in kinds]
    if len(found) != 1 or not argument.denominator.is_constant or argument.names - {found[0].name, PI}:
        return None
    rest, times = argument, partial(argument, found[0].name)
    rest = (argument - times * found[0].value) / Scalar.symbol(PI)
    if not (times.is_constant and times.fraction().denominator == 1 and rest.is_constant):
        return None
    return rest.fraction(), found[0], int(times.fraction())


def _of_inverse(kind: str, turns: Fraction, inner: Function, times: int) -> Scalar:
    """Return cos or sin of π r + m f, from cos f and sin f."""
    x = inner.argument
    if inner.kind == "atan":
        c, s = 1 / root_of(1 + x * x), x / root_of(1 + x * x)
    else:
        other = root_of(1 - x * x)
        c, s = (x, other) if inner.kind == "acos" else (other, x)
    if times < 0:
        s = -s
    real, imaginary = _cosine(turns), _sine(turns)
    for _ in range(abs(times)):
        real, imaginary = normal_form(real * c - imaginary * s), normal_form(real * s + imaginary * c)
    return real if kind == "cos" else imaginary


def _cosine(turns: Fraction) -> Scalar:
    """Return cos(π r).  Raises `NotWritten` where the table does not have it."""
    turns = abs((turns + 1) % 2 - 1)
    sign, turns = (-1, 1 - turns) if turns > Fraction(1, 2) else (1, turns)
    if turns not in _COSINES:
        message = f"cos({turns}*pi) is not written with square roots here"
        raise NotWritten(message)
    front, radicand = _COSINES[turns]
    return square_root(Scalar.of(radicand)) * front * sign


def leads_with_minus(value: Scalar) -> bool:
    """Return whether the first term of the numerator, plain symbols before roots, is negative."""
    return value.terms()[0][0] < 0


def square_root(radicand: Scalar, positive: Container[str] = ()) -> Scalar:
    """Return √radicand: square factors in front, numbers as products of roots of primes, the rest one generator.

    A denominator that is one of the `positive` letters stays under the root: √(q/r), not √(qr)/r.

    Raises ZeroDivisionError, as for any value that means nothing here, where the radicand is a negative number.
    """
    if radicand.is_zero:
        return ZERO
    unit, factors = radicand.factors()
    number = unit.fraction() if unit.is_constant else None
    if number is not None and number < 0 and all(power % 2 == 0 for _, power in factors):
        message = f"{radicand} has no real root"
        raise ZeroDivisionError(message)
    front, odd = ONE, ONE
    for factor, power in factors:
        half, rest = divmod(power, 2)
        if rest and power < 0 and str(factor) in positive:
            half, rest = half + 1, -1
        front = front * factor**half
        odd = odd * factor**rest
    if odd.is_one and number is not None:
        return front * _root_of_number(number)
    if number is None:  # of a + b√2, a + b √(c + d√2) the common square is taken out
        common = gcd(*(coefficient for coefficient, _ in unit.terms()))
        below = unit.denominator.fraction() if unit.denominator.is_constant else Fraction(1)
        part = square_part(abs(common) * int(below))
        front, unit = front * Fraction(part, int(below)), unit * Fraction(int(below) ** 2, part**2)
    else:
        outside = square_divisor(number)
        front, unit = front * outside, unit / outside**2
    return front * generator("sqrt", odd * unit)


def square_divisor(number: Fraction) -> Fraction:
    """Return the largest fraction whose square divides the numerator and the denominator of a number other than 0."""
    return Fraction(square_part(abs(number.numerator)), square_part(number.denominator))


def square_part(number: int) -> int:
    """Return the largest integer whose square divides a positive integer, 1 if factoring is too costly."""
    root = isqrt(number)
    if root * root == number:
        return root
    if number.bit_length() > _PRIME_BITS:
        return 1
    part = 1
    for prime, power in fmpz(number).factor():
        part *= int(prime) ** (int(power) // 2)
    return part


def _root_of_number(number: Fraction) -> Scalar:
    """Return √number for a positive fraction."""
    whole = number.numerator * number.denominator
    outside = square_part(whole)
    inside = whole // outside**2
    value = Scalar.of(Fraction(outside, number.denominator))
    if inside == 1:
        return value
    if inside.bit_length() > _PRIME_BITS:
        return value * generator("sqrt", Scalar.of(inside))
    for prime, _ in fmpz(inside).factor():
        value = value * generator("sqrt", Scalar.of(int(prime)))
    return value


def roots_in(value: Scalar | Matrix) -> list[Function]:
    """Return the square roots that occur, longer radicands last."""
    found = [f for name in value.names if (f := function_named(name)) is not None and f.kind == "sqrt"]
    return sorted(found, key=lambda f: (f.argument.size, f.name))


def functions_in(values: Iterable[Scalar | Matrix]) -> frozenset[Function]:
    """Return the functions among the generators that occur."""
    names = (name for value in values if value.field.functions for name in value.names)
    return frozenset(f for name in names if (f := function_named(name)) is not None)


def all_roots(*values: Scalar | Matrix) -> frozenset[Function]:
    """Return the square roots that occur in values, also in the arguments of functions."""
    found = functions_in(values)
    inner = all_roots(*(f.argument for f in found)) if found else frozenset()
    return frozenset(f for f in found if f.kind == "sqrt") | inner


def are_dependent(radicands: Sequence[Scalar]) -> bool:
    """Return whether a product of some of the radicands is a square, or may be one: where numbers are too long to factor."""
    places: dict[Scalar, int] = {}
    pivots: list[int] = []
    for radicand in radicands:
        unit, factors = radicand.factors()
        whole = unit.fraction().numerator * unit.fraction().denominator
        if whole.bit_length() > _PRIME_BITS and len(radicands) > 1:
            return True
        numbers = [(Scalar.of(-1), 1)] if whole < 0 else []
        numbers += [(Scalar.of(int(prime)), int(power)) for prime, power in fmpz(abs(whole)).factor()]
        odd = sum(1 << places.setdefault(factor, len(places)) for factor, power in (*numbers, *factors) if power % 2)
        for pivot in pivots:
            odd = min(odd, odd ^ pivot)
        if not odd:
            return True
        pivots.append(odd)
    return False


def normal_form(value: Scalar) -> Scalar:
    """Return the normal form of a value with square roots: degree at most 1 in each, none in the denominator."""
    for root in roots_in(value):
        if root.square:
            continue  # the field itself keeps values in normal form in it
        above = _split(value.numerator, root)
        below = _split(value.denominator, root)
        over = below[0] * below[0] - below[1] * below[1] * root.argument
        rational = above[0] * below[0] - above[1] * below[1] * root.argument
        value = rational / over + (above[1] * below[0] - above[0] * below[1]) / over * root.value
    return value


def exponentials_in(polynomial: Scalar) -> dict[str, int]:
    """Return the exponentials that divide a polynomial, each with its power."""
    kinds = [name for name in polynomial.names if (f := function_named(name)) is not None and f.kind == "exp"]
    if not kinds:
        return {}
    powers = [dict(monomial) for _, monomial in polynomial.terms()]
    least = {name: min(each.get(name, 0) for each in powers) for name in sorted(kinds)}
    return {name: power for name, power in least.items() if power}


def _split(polynomial: Scalar, root: Function) -> tuple[Scalar, Scalar]:
    """Return (a, b) with polynomial = a + b √radicand."""
    parts = [ZERO, ZERO]
    for power, coefficient in enumerate(reversed(polynomial.coefficients(root.name))):
        parts[power % 2] = parts[power % 2] + coefficient * root.argument ** (power // 2)
    return parts[0], parts[1]


def with_roots(value: Scalar, roots: Iterable[Function]) -> Scalar:
    """Return a value with the radicands of these roots in its denominator written as squares: ν/ν² becomes 1/ν."""
    for root in roots:
        if root.argument.is_constant:
            continue
        core, power = root.argument.numerator, 0
        square = root.value**2 * root.argument.denominator
        unit, _ = core.factors()
        core, square = core / unit, square / unit
        if core.is_one:  # a number under the root divides everything
            continue
        below = value.denominator
        while not (quotient := below / core).is_zero and quotient.denominator.is_constant:
            below, power = quotient, power + 1
        value = value.numerator / (below * square**power)
    return value


# -- calculus ------------------------------------------------------------------------------------------------------


@overload
def derivative(value: Scalar, time: str = "t") -> Scalar: ...
@overload
def derivative(value: Matrix, time: str = "t") -> Matrix: ...
@overload
def derivative(value: Scalar | Matrix, time: str = "t") -> Scalar | Matrix: ...
def derivative(value: Scalar | Matrix, time: str = "t") -> Scalar | Matrix:
    """Return d/dt, by the chain rule on each generator that contains the time."""
    if isinstance(value, Matrix):
        return Matrix.of([[derivative(entry, time) for entry in row] for row in value.rows], value.shape[1])
    total = ZERO
    for name in sorted(value.names):
        rate = _rate(name, time)
        if not rate.is_zero:
            total = total + partial(value, name) * rate
    return total


def partial(value: Scalar, name: str) -> Scalar:
    """Return ∂ value / ∂ name."""
    field, index = value.field, value.field.position[name]
    above, below = value.numerator_part, value.denominator_part
    if below.degrees()[index] <= 0:
        return Scalar.reduced(field, above.derivative(index), below)
    top = above.derivative(index) * below - above * below.derivative(index)
    return Scalar.reduced(field, top, below * below)


def _rate(name: str, time: str) -> Scalar:
    if name == time:
        return ONE
    found = function_named(name)
    return ZERO if found is None else found.rate(time)


@overload
def substitute(value: Scalar, values: Mapping[str, Scalar]) -> Scalar: ...
@overload
def substitute(value: Matrix, values: Mapping[str, Scalar]) -> Matrix: ...
@overload
def substitute(value: Scalar | Matrix, values: Mapping[str, Scalar]) -> Scalar | Matrix: ...
def substitute(value: Scalar | Matrix, values: Mapping[str, Scalar]) -> Scalar | Matrix:
    """Return the value with symbols replaced, in the arguments of functions too; raises ZeroDivisionError."""
    return value.substitute(values)


def symbols_in(value: Scalar | Matrix) -> frozenset[str]:
    """Return the plain symbols of a value, also those inside functions."""
    names: set[str] = set()
    for name in value.names:
        found = function_named(name)
        names |= found.symbols if found is not None else {name}
    return frozenset(names)


def stands_inside(name: str, value: object) -> bool:
    """Return whether a name stands inside of a function of a value, as s does in P(s) + k N(s) e^{−sT}."""
    found = map(function_named, value.names) if isinstance(value, Scalar) else ()
    return any(function is not None and name in function.symbols for function in found)


def letters_outside(value: Scalar) -> list[str]:
    """Return the plain symbols of a value that stand in none of its functions: an equation can be solved for these."""
    inside = {symbol for name in value.names if (found := function_named(name)) for symbol in found.symbols}
    return sorted(name for name in value.names if function_named(name) is None and name not in inside)


def symbols_named(name: str) -> frozenset[str]:
    """Return the plain symbols of a generator: its own name, or those of its argument."""
    found = function_named(name)
    return found.symbols if found is not None else frozenset((name,))


# -- how generators depend on each other -----------------------------------------------------------------------------

Coordinates = dict[Scalar, Fraction]
#: For (whether it is an angle, a monomial): each coefficient as a sum of (measure, multiple).
Steps = dict[tuple[bool, Scalar], dict[Fraction, list[tuple[Fraction, int]]]]


def _coordinates(argument: Scalar, below: Scalar) -> Coordinates:
    """Return an argument as a sum of rational multiples of monomials over a multiple of its denominator."""
    above, found = argument * below, {}
    content = above.denominator.fraction()
    for coefficient, powers in above.terms():
        monomial = ONE
        for name, power in powers:
            monomial = monomial * Scalar.symbol(name) ** power
        found[monomial / below] = coefficient / content
    return found


def identities(
    values: Iterable[Scalar | Matrix], *, falling: bool = False
) -> tuple[dict[str, Scalar], tuple[Scalar, ...]]:
    """Return (each generator in a common base, the polynomials in the base that vanish).

    Base exponentials rise with their monomial, or with `falling` fall with it.

    exp is a product of powers of base exponentials, cosh and sinh are sums of two of them, cos and sin of a multiple or
    a sum are polynomials in the base cosines and sines, several where exponents or angles are far from their common
    measure; what vanishes is c² + s² − 1, root² − radicand, and the minimal polynomial of a real root.
    """
    values = tuple(values)
    found = functions_in(values)
    if not found:
        return {}, ()
    roots = all_roots(*values)
    moving = sorted((f for f in found if f.kind in _RATES), key=lambda f: f.name)
    found_in: dict[tuple[bool, Scalar], set[Fraction]] = {}
    below = _common_denominators(moving)
    for f in moving:
        for monomial, coefficient in _coordinates(f.argument, below[f]).items():
            found_in.setdefault((f.kind in {"cos", "sin"}, monomial), set()).add(abs(coefficient))
    several = any(len(coefficients) > 1 for coefficients in found_in.values())
    degree = highest_power(values, {f.name for f in moving}) if several else 1
    steps: Steps = {}
    for key, coefficients in found_in.items():
        most, related = (_MOST_MULTIPLE, _RELATED_ANGLES) if key[0] else (_MOST_POWER, _RELATED_POWERS)
        sign = -1 if falling and not key[0] else 1
        sums = measures(sorted(coefficients), min(most, related * degree))
        steps[key] = {c: [(sign * step, sign * count) for step, count in parts] for c, parts in sums.items()}
    relations = [root.value**2 - root.argument for root in sorted(roots, key=lambda f: f.name) if not root.square]
    counted = sorted((f for f in found if f.kind == "CRootOf"), key=lambda f: f.name)
    relations += [f.argument.substitute(dict.fromkeys(f.argument.names, f.value)) for f in counted]
    for (turns, monomial), parts in steps.items():
        for step in sorted({step for part in parts.values() for step, _ in part}) if turns else ():
            relations.append(function("cos", monomial * step) ** 2 + function("sin", monomial * step) ** 2 - 1)
    meanings: dict[str, Scalar] = {}
    for f in moving:
        meaning = _in_base(f, steps, below[f])
        if meaning != f.value:
            meanings[f.name] = meaning
    return meanings, tuple(r.substitute(meanings).numerator for r in relations)


def identities_at(
    values: Iterable[Scalar | Matrix], instant: Scalar | None
) -> tuple[dict[str, Scalar], tuple[Scalar, ...]]:
    """Return the identities of values, and of what they are at t = instant."""
    values = tuple(values)
    moved = () if instant is None else tuple(_at(value, instant) for value in values)
    return identities([*values, *moved])


def _at(value: Scalar | Matrix, instant: Scalar) -> Scalar | Matrix:
    return substitute(value, {"t": instant})


def _common_denominators(moving: Iterable[Function]) -> dict[Function, Scalar]:
    """Return for each function the denominator of all arguments that may depend on its own.

    exp(t), exp(t/(a + 1)) and exp(t*a/(a + 1)) do, exp(1), exp((a + 3)/(a + 1)) and exp(2/(a + 1)) as well; exp(x) and
    exp(t*exp(x)/(exp(x) + 1)) do not: over all that stands in a denominator, no term of one has the letters of the other's.
    """
    moving = tuple(moving)
    below = {name for f in moving for name in f.argument.denominator.names}
    groups: list[tuple[set[frozenset[str]], list[Function]]] = []
    for f in moving:
        members = [f]
        letters = {
            frozenset(name for name, _ in powers if name not in below and function_named(name) is None)
            for _, powers in f.argument.terms()
        }
        for group in [group for group in groups if group[0] & letters]:
            groups.remove(group)
            letters |= group[0]
            members += group[1]
        groups.append((letters, members))
    nested = {name for f in moving for name in f.argument.names}
    found: dict[Function, Scalar] = {}
    for _, members in groups:
        shared = _shared_denominator(members)
        terms = {f: set(_coordinates(f.argument, shared)) for f in members}
        for f in members:  # what stands in arguments, and has a term of its own there, is no product of the others
            others = set[Scalar]().union(*(terms[other] for other in members if other != f))
            is_apart = f.name in nested and not terms[f] <= others
            found[f] = _shared_denominator([f]) if is_apart else shared
    return found


def _shared_denominator(members: Sequence[Function]) -> Scalar:
    shared = Matrix.of([[f.argument for f in members]]).common_denominator()
    return shared / gcd(*(coefficient for coefficient, _ in shared.terms()))


def _in_base(f: Function, steps: Steps, below: Scalar) -> Scalar:
    turns = f.kind in {"cos", "sin"}
    real, imaginary = ONE, ZERO
    for monomial, coefficient in _coordinates(f.argument, below).items():
        for step, multiple in steps[turns, monomial][abs(coefficient)]:
            count = multiple if coefficient > 0 else -multiple
            if abs(count) > (_MOST_MULTIPLE if turns else _LARGEST_POWER):
                raise NotWritten(f"{f.text} is too far from the other {'angles' if turns else 'exponents'}")
            if not turns:
                real = real * function("exp", monomial * step) ** count
                continue
            c, s = function("cos", monomial * step), function("sin", monomial * step)
            s = s if count > 0 else -s
            for _ in range(abs(count)):
                real, imaginary = real * c - imaginary * s, real * s + imaginary * c
    if turns or f.kind == "exp":
        return imaginary if f.kind == "sin" else real
    return (real + 1 / real if f.kind == "cosh" else real - 1 / real) / 2
