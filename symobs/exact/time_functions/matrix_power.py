"""The powers Aᵏ as functions of k: sums of kʲ λᵏ, of real and imaginary parts of (σ + iω)ᵏ, and of δ(k, j), with matrices.

Each is a generator of its own that knows its value at k + 1 and at an integer; so Aᵏ⁺¹ = A Aᵏ is checked as it stands.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from flint import fmpz

from symobs.exact.algebraic.polynomial_roots import factored
from symobs.exact.core.generators import (
    ZERO,
    Function,
    function_named,
    functions_in,
    square_root,
    substitute,
    symbols_in,
)
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import Ideal
from symobs.exact.linear_algebra.elimination import modulo
from symobs.exact.time_functions.matrix_exponential import MOST_STATES, MOST_STATES_WITH_PARAMETERS, NoClosedForm
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

ONE = Scalar.of(1)
#: The number of the instant.
INSTANT = Scalar.symbol("k")


@dataclass
class PowerOf(Function):
    """λᵏ (`power`), the real or imaginary part of (σ + iω)ᵏ (`re`, `im`), or δ(k, j) (`KroneckerDelta`); `argument` is k.

    `base` is λ, σ or j.
    """

    base: Scalar
    imaginary: Scalar

    @staticmethod
    def of(kind: str, base: Scalar, imaginary: Scalar = ZERO, instant: Scalar = INSTANT) -> Scalar:
        """Return the function at an instant, simplified."""
        return PowerOf(kind, INSTANT, base, imaginary).moved({"k": instant})

    @property
    def text(self) -> str:
        """SymPy's text."""
        if self.kind == "KroneckerDelta":
            return f"KroneckerDelta({self.argument}, {self.base})"
        base = str(self.base)
        if self.kind == "power":
            return f"{base if base.isalnum() else f'({base})'}**{self.argument}"
        return f"{self.kind}(({base} + I*({self.imaginary}))**{self.argument})"

    @property
    def symbols(self) -> frozenset[str]:
        """The instant and the parameters of the base."""
        return symbols_in(self.argument) | symbols_in(self.base) | symbols_in(self.imaginary)

    def rate(self, time: str) -> Scalar:  # noqa: ARG002 - it moves in steps
        """Return 0: nothing here is a function of continuous time."""
        return ZERO

    def moved(self, values: Mapping[str, Scalar]) -> Scalar:
        """Return the function with symbols substituted: at k + n by its value at k, at an integer n ≥ 0 as a number."""
        parts = (substitute(part, values) for part in (self.argument, self.base, self.imaginary))
        argument, base, imaginary = parts
        kind = self.kind
        if not argument.denominator.is_one:
            raise ZeroDivisionError(f"{argument} is no instant")
        steps = next((int(c) for c, powers in argument.terms() if not powers), 0)
        rest = argument - steps
        if kind == "power" and base.is_zero:
            kind = "KroneckerDelta"  # 0⁰ = 1
        if kind == "KroneckerDelta":
            left = base - steps
            if left.is_constant and left.fraction() < 0:
                return ZERO
            return Scalar.of(int(left.is_zero)) if rest.is_zero else PowerOf(kind, rest, left, ZERO).value
        if imaginary.is_zero and kind != "power":
            return PowerOf.of("power", base, ZERO, argument) if kind == "re" else ZERO
        real, turned = _power(base, imaginary, steps)
        if rest.is_zero:
            return turned if kind == "im" else real
        if kind == "power":
            return real if base.is_one else real * replace(self, argument=rest, base=base).value
        own, other = (PowerOf(part, rest, base, imaginary).value for part in ("re", "im"))
        return real * own - turned * other if kind == "re" else real * other + turned * own


def _power(base: Scalar, imaginary: Scalar, count: int) -> tuple[Scalar, Scalar]:
    """Return (σ + iω)ⁿ, n of either sign."""
    if count < 0:
        size = base * base + imaginary * imaginary
        base, imaginary = base / size, -imaginary / size
    real, turned = ONE, ZERO
    for _ in range(abs(count)):
        real, turned = real * base - turned * imaginary, real * imaginary + turned * base
    return real, turned


def by_factors(value: Scalar | Matrix) -> Scalar | Matrix:
    """Return a value with λᵏ as the product of the powers of the factors of λ: of −1, of primes, of polynomials.

    These are independent of each other, but for ((−1)ᵏ)² = 1: values that agree at all k ≥ 0 become equal.
    """
    found = {name: f for name in value.names if isinstance(f := function_named(name), PowerOf)}
    meanings = {name: _of_factors(f) for name, f in found.items() if f.kind == "power" and not functions_in([f.base])}
    value = value.substitute(meanings)
    sign = PowerOf("power", INSTANT, Scalar.of(-1), ZERO).value
    relation = Ideal.of([sign**2 - 1])
    return modulo(value, relation) if isinstance(value, Matrix) else relation.simplified(value)


def _of_factors(power: PowerOf) -> Scalar:
    unit, factors = power.base.factors()
    number = unit.fraction()
    primes = [(Scalar.of(int(p)), e) for p, e in fmpz(abs(number.numerator)).factor()]
    primes += [(Scalar.of(int(p)), -e) for p, e in fmpz(number.denominator).factor()]
    primes += [(Scalar.of(-1), 1)] if number < 0 else []
    whole = ONE
    for factor, exponent in (*primes, *factors):
        whole = whole * PowerOf("power", power.argument, factor, ZERO).value ** exponent
    return whole


def modes_of(chi: Scalar, variable: str) -> Iterator[Scalar]:
    """Yield as many functions of k as χ has roots, whose combinations all solutions are.  Raises `NoClosedForm`."""
    for factor, count in factored(chi, variable).factors:
        lead, *rest = factor.coefficients(variable)
        if len(rest) == 1:
            root = -rest[0] / lead
            kinds = [("power", root, ZERO)]
        elif len(rest) == 2 and factor.names <= {variable}:
            centre, last = -rest[0] / (2 * lead), rest[1] / lead
            distance = centre * centre - last
            if distance.fraction() > 0:
                root = square_root(distance)
                kinds = [("power", centre + root, ZERO), ("power", centre - root, ZERO)]
            else:
                speed = square_root(-distance)
                kinds = [("re", centre, speed), ("im", centre, speed)]
        else:
            raise NoClosedForm(factor)
        for power in range(count):
            for kind, base, imaginary in kinds:
                if base.is_zero and imaginary.is_zero:
                    yield PowerOf.of("KroneckerDelta", Scalar.of(power))
                else:
                    yield INSTANT**power * PowerOf.of(kind, base, imaginary)


def matrix_power(A: Matrix, variable: str) -> tuple[tuple[Scalar, Matrix], ...]:
    """Return functions fᵢ and matrices Mᵢ with Aᵏ = Σ fᵢ(k) Mᵢ: by its values at k = 0, …, n − 1.  Raises `NoClosedForm`."""
    order = A.shape[0]
    if order > (MOST_STATES_WITH_PARAMETERS if A.names else MOST_STATES):
        raise NoClosedForm(None)
    functions = list(modes_of(A.characteristic_polynomial(variable), variable))
    values = Matrix.of([[substitute(f, {"k": Scalar.of(at)}) for f in functions] for at in range(order)])
    weights = values.inverse()
    powers = [Matrix.identity(order)]
    for _ in range(order - 1):
        powers.append((powers[-1] @ A).normal())
    found = []
    for i, f in enumerate(functions):
        total = powers[0] * weights[i, 0]
        for at in range(1, order):
            total = total + powers[at] * weights[i, at]
        if not (total := total.normal()).is_zero:
            found.append((f, total))
    return tuple(found)
