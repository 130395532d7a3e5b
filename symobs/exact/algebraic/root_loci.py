"""Landmarks of the root locus p + k q of numbers, k ≥ 0: where branches meet, cross the boundary of stability, and arrive.

A branch point s is a root of p′q − pq′ with k = −p/q real there, a root of the resultant of both equations in k.  On the
boundary q(s) p(s̄) is real; that is a polynomial condition on x = ω², in discrete time on x = cos θ.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from flint import acb, arb, fmpz_poly

from symobs.exact.algebraic.loop_distances import certain
from symobs.exact.algebraic.polynomial_roots import roots_of
from symobs.exact.algebraic.real_algebraic import (
    FIRST_BITS,
    RealNumber,
    irreducible_factors,
    real_roots,
    roots_of_scalar,
)
from symobs.exact.core.polynomial import resultant
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.algebraic.polynomial_roots import Root

#: Angles and places without a closed form are rounded to so many digits after the point.
LOCUS_DIGITS = 6


@dataclass
class BranchPoint:
    """A multiple root s of p + k q with k ≥ 0: its parts by certain digits, and its multiplicity."""

    s: Root
    real: str
    imaginary: str
    k: RealNumber
    multiplicity: int


@dataclass
class Crossing:
    """A root on the boundary of stability for k > 0: x = ω², in discrete time x = cos θ, and the angle or frequency ω ≥ 0."""

    k: RealNumber
    x: RealNumber
    omega: str


@dataclass
class Angle:
    """The angle in degrees, −180 < angle ≤ 180, of a branch at a root with imaginary part > 0."""

    s: Root
    degrees: str


def whole(polynomial: Scalar, variable: str) -> fmpz_poly:
    """Return the numerator of a polynomial of numbers with integer coefficients."""
    return fmpz_poly([int(c.fraction()) for c in reversed(polynomial.numerator.coefficients(variable))])


def _at(polynomial: fmpz_poly, place: acb) -> acb:
    value = acb(0)
    for coefficient in reversed(polynomial.coeffs()):
        value = value * place + int(coefficient)
    return value


def enclosed(root: Root, bits: int) -> acb:
    """Return an enclosure of a root, numbered as SymPy does: real ones first, ascending, then pairs by real part."""
    factor = whole(root.factor, root.variable)
    with Precision(bits):
        listed: Any = factor.complex_roots()
        found: list[Any] = [each for each, _ in listed]
        if root.is_closed:
            centre, square = (arb_of(part, bits) for part in (root.centre, root.radicand))
            if square >= 0:
                return acb(centre + root.sign * square.sqrt())
            return acb(centre, root.sign * (-square).sqrt())
        real = sorted((z for z in found if z.imag == 0), key=lambda z: z.real.mid().fmpq())
        pairs = sorted(
            (z for z in found if z.imag != 0), key=lambda z: (z.real.mid().fmpq(), abs(z.imag).mid().fmpq(), z.imag > 0)
        )
        found_root: acb = [*real, *pairs][root.index]
        return found_root


def arb_of(value: Scalar, bits: int) -> arb:
    """Return an enclosure of a rational number."""
    number = value.fraction()
    with Precision(bits):
        return arb(number.numerator) / arb(number.denominator)


def branch_points(p: Scalar, q: Scalar, variable: str) -> tuple[BranchPoint, ...]:
    """Return the multiple roots of p + k q for k ≥ 0, those with imaginary part ≥ 0; p and q without a common factor."""
    slope = slope_of(p, q, variable)
    found: list[BranchPoint] = []
    for root in dict.fromkeys(roots_of(slope, variable)) if slope.names else ():
        k = gain_at(root, p, q, variable)
        if k is not None and k.sign >= 0 and _upper(root):
            order = 1 + sum(other == root for other in roots_of(slope, variable))
            found.append(BranchPoint(root, *_parts(root), k, order))
    return tuple(sorted(found, key=lambda point: (point.k, float(point.real))))


def slope_of(p: Scalar, q: Scalar, variable: str) -> Scalar:
    """Return p′q − pq′."""
    return derivative_in(p, variable) * q - p * derivative_in(q, variable)


def derivative_in(p: Scalar, variable: str) -> Scalar:
    """Return the derivative of a polynomial by its variable."""
    s, found = Scalar.symbol(variable), Scalar.of(0)
    for power, coefficient in enumerate(reversed(p.coefficients(variable))):
        if power:
            found += coefficient * power * s ** (power - 1)
    return found


def quotient_at(p: Scalar, q: Scalar, factor: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return u, v with p/q = u + v s at the roots s of a quadratic factor, where q does not vanish: its norm is divided by."""
    lead, linear, constant = factor.coefficients(variable)
    c1, c0 = linear / lead, constant / lead
    (p0, p1), (q0, q1) = (_modulo_square(part, c1, c0, variable) for part in (p, q))
    norm = q0 * q0 - q0 * q1 * c1 + q1 * q1 * c0
    return (p0 * q0 - p0 * q1 * c1 + p1 * q1 * c0) / norm, (p1 * q0 - p0 * q1) / norm


def _modulo_square(polynomial: Scalar, c1: Scalar, c0: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return a, b with p = a + b s modulo s² + c₁ s + c₀."""
    a, b = Scalar.of(0), Scalar.of(0)
    for coefficient in polynomial.coefficients(variable):
        a, b = coefficient - b * c0, a - b * c1
    return a, b


def gain_at(root: Root, p: Scalar, q: Scalar, variable: str) -> RealNumber | None:
    """Return k with p + k q = 0 at a root, where that is a real number."""
    above, below, factor = (whole(part, variable) for part in (p, q, root.factor))
    scale = p.numerator.coefficients(variable)[0] / p.coefficients(variable)[0]
    other = q.numerator.coefficients(variable)[0] / q.coefficients(variable)[0]
    if not below % factor:
        return None  # k is infinite
    k = Scalar.symbol("k")
    condition = resultant(root.factor.numerator, (p + k * q).numerator, variable)
    candidates = whole(condition, "k")
    bits = FIRST_BITS
    while True:
        with Precision(bits):
            place = enclosed(root, bits)
            value = -_at(above, place) / arb_of(scale, bits) * arb_of(other, bits) / _at(below, place)
            if value.is_finite():
                near = []
                for part in irreducible_factors(candidates):
                    roots: Any = part.complex_roots()
                    near += [z for z, _ in roots if z.overlaps(value)]
                real = [number for number in roots_of_scalar(condition, "k") if acb(number.ball(bits)).overlaps(value)]
                if len(near) == 1:
                    return real[0] if near[0].imag == 0 else None
        bits *= 2


def _parts(root: Root) -> tuple[str, str]:
    real = certain(lambda bits: enclosed(root, bits).real, LOCUS_DIGITS)
    imaginary = certain(lambda bits: enclosed(root, bits).imag, LOCUS_DIGITS)
    return real or "", imaginary or ""


def _upper(root: Root) -> bool:
    """Return whether the imaginary part is not negative."""
    bits = FIRST_BITS
    while True:
        place = enclosed(root, bits)
        if place.imag == 0 or place.imag > 0:
            return True
        if place.imag < 0:
            return False
        bits *= 2


def on_boundary(p: Scalar, q: Scalar, variable: str) -> tuple[Scalar, Scalar, Scalar]:
    """Return Im(p q̄) without its factor ω (sin θ), Re(p q̄) and |q|² on the boundary, as polynomials of x."""
    x = Scalar.symbol("x")
    if variable == "s":
        (a, b), (c, d) = (_even_and_odd(each, x) for each in (p, q))
        return b * c - a * d, a * c + x * b * d, c * c + x * d * d
    first, second = (list(reversed(each.coefficients(variable))) for each in (p, q))
    cosines, sines = [Scalar.of(1), x], [Scalar.of(0), Scalar.of(1)]
    while len(cosines) <= max(len(first), len(second)):
        cosines.append(2 * x * cosines[-1] - cosines[-2])
        sines.append(2 * x * sines[-1] - sines[-2])
    im, re, square = Scalar.of(0), Scalar.of(0), Scalar.of(0)
    for i, a in enumerate(first):
        for j, b in enumerate(second):
            re += a * b * cosines[abs(i - j)]
            im += a * b * (sines[i - j] if i >= j else -sines[j - i])
    for i, a in enumerate(second):
        for j, b in enumerate(second):
            square += a * b * cosines[abs(i - j)]
    return im, re, square


def _even_and_odd(polynomial: Scalar, x: Scalar) -> tuple[Scalar, Scalar]:
    """Return a(x), b(x) with p(jω) = a(ω²) + jω b(ω²)."""
    parts = [Scalar.of(0), Scalar.of(0)]
    for power, c in enumerate(reversed(polynomial.coefficients("s"))):
        sign = -1 if power % 4 in (2, 3) else 1
        parts[power % 2] += sign * c * x ** (power // 2)
    return parts[0], parts[1]


def crossings(p: Scalar, q: Scalar, variable: str) -> tuple[Crossing, ...]:
    """Return where p + k q has a root on the boundary of stability, for k > 0; p and q without a common factor."""
    im, re, square = on_boundary(p, q, variable)
    discrete, found = variable == "z", list[Crossing]()
    ends = [RealNumber.of(-1), RealNumber.of(1)] if discrete else [RealNumber.of(0)]
    inner = roots_of_scalar(im, "x") if "x" in im.names else []
    inside = [x for x in inner if x > ends[0] and (not discrete or x < ends[1])]
    for x in [*ends, *inside]:
        k = gain_on_boundary(x, re, square)
        if k is not None and k.sign > 0:
            found.append(Crossing(k, x, omega_of(x, discrete=discrete)))
    return tuple(sorted(found, key=lambda crossing: crossing.k))


def gain_on_boundary(x: RealNumber, re: Scalar, square: Scalar) -> RealNumber | None:
    """Return −Re(p q̄)/|q|² at x; None where q vanishes."""
    if x.sign_of(whole(square, "x")) == 0:
        return None
    k, minimal = Scalar.symbol("k"), x.minimal_polynomial("x")
    candidates = roots_of_scalar(resultant(minimal, (k * square + re).numerator, "x"), "k")
    above, below = re.numerator, square.numerator
    bits = FIRST_BITS
    while True:
        with Precision(bits):
            place = acb(x.ball(bits))
            value = (
                -_at(whole(re, "x"), place)
                / arb_of(above.coefficients("x")[0] / re.coefficients("x")[0], bits)
                / _at(whole(square, "x"), place)
                * arb_of(below.coefficients("x")[0] / square.coefficients("x")[0], bits)
                if not re.is_zero
                else acb(0)
            )
            near = [number for number in candidates if acb(number.ball(bits)).overlaps(value)]
        if len(near) == 1:
            return near[0]
        bits *= 2


def frequency(x: RealNumber) -> RealNumber:
    """Return √x of x ≥ 0."""
    below = sum(RealNumber.of(0) < other < x for other in real_roots(x.polynomial))
    roots = roots_of_scalar(x.minimal_polynomial("x").substitute({"x": Scalar.symbol("y") ** 2}), "y")
    return [root for root in roots if root.sign >= 0][below]


def omega_of(x: RealNumber, *, discrete: bool) -> str:
    """Return √x, or arccos x, exactly."""
    if not discrete:
        return frequency(x).text("x")
    if x == RealNumber.of(1):
        return "0"
    return "pi" if x == RealNumber.of(-1) else "pi/2" if x == RealNumber.of(0) else f"acos({x.text('x')})"


def omega_digits(x: RealNumber, *, discrete: bool) -> str:
    """Return the same by certain digits."""
    if not discrete:
        return frequency(x).decimal(LOCUS_DIGITS)
    if x == RealNumber.of(1):
        return "0"
    return certain(lambda bits: arb.pi() if x == RealNumber.of(-1) else x.ball(bits).acos(), LOCUS_DIGITS) or ""


def angles_at(roots: Sequence[Root], others: Sequence[Root], *, even: bool) -> tuple[Angle, ...]:
    """Return the angles of branches at the roots with imaginary part > 0: of departure from poles, of arrival at zeros.

    At a root of multiplicity m they satisfy m·angle = h·180° + Σ angles from `others` − Σ angles from the other `roots` with
    h odd, or even where q leads with a negative coefficient.
    """
    found: list[Angle] = []
    for root in dict.fromkeys(roots):
        if _is_complex(root) and _upper(root):
            order = sum(other == root for other in roots)
            starts = [2 * turn + (0 if even else 1) for turn in range(order)]
            found += [Angle(root, _angle(root, roots, others, start=start, order=order)) for start in starts]
    return tuple(found)


def coprime(p: Scalar, q: Scalar) -> tuple[Scalar, Scalar]:
    """Return p and q without their common factor."""
    least = q / p
    return least.denominator, least.numerator


def landmarks(kind: str, p: Scalar, q: Scalar, variable: str) -> list[dict[str, Fraction]]:
    """Return what a sentence tells of each landmark of a kind, by rounded numbers."""
    above, below = coprime(p, q)
    if kind == "crossing":
        found: list[dict[str, str]] = [
            {"k": c.k.decimal(LOCUS_DIGITS), "omega": omega_digits(c.x, discrete=variable == "z")}
            for c in crossings(above, below, variable)
        ]
    elif kind == "branch":
        found = [
            {"real": point.real, "imaginary": point.imaginary, "k": point.k.decimal(LOCUS_DIGITS)}
            for point in branch_points(above, below, variable)
        ]
        found = [{name: text for name, text in each.items() if name != "imaginary" or text != "0"} for each in found]
    else:
        poles, zeros = roots_of(p, variable), roots_of(q, variable)
        first, second = (poles, zeros) if kind == "departure" else (zeros, poles)
        found = [
            {**dict(zip(("real", "imaginary"), _parts(angle.s), strict=True)), "angle": angle.degrees}
            for angle in angles_at(first, second, even=leads_negatively(q, variable))
        ]
    return [{name: Fraction(text) for name, text in each.items()} for each in found]


def leads_negatively(q: Scalar, variable: str) -> bool:
    """Return whether the leading coefficient of a polynomial of numbers is negative."""
    return q.coefficients(variable)[0].fraction() < 0


def _is_complex(root: Root) -> bool:
    bits = FIRST_BITS
    while True:
        place = enclosed(root, bits)
        if place.imag == 0:
            return False
        if place.imag > 0 or place.imag < 0:
            return True
        bits *= 2


def _angle(root: Root, roots: Sequence[Root], others: Sequence[Root], *, start: int, order: int) -> str:
    def total(bits: int) -> arb:
        here = enclosed(root, bits)
        angle = arb(180 * start)
        for each in others:
            angle += _argument(here - enclosed(each, bits)) * 180 / arb.pi()
        for each in roots:
            if each != root:
                angle -= _argument(here - enclosed(each, bits)) * 180 / arb.pi()
        angle /= order
        turns = round(float(angle.mid()) / 360)
        angle -= 360 * turns
        return angle + 360 if float(angle.mid()) < -179.99999999 else angle

    return certain(total, LOCUS_DIGITS) or ""


def _argument(value: acb) -> arb:
    """Return the argument, from −π/2 to 3π/2: two roots with one imaginary part have it between balls of either sign."""
    found: arb = (-value).arg() + arb.pi() if value.real < 0 else value.arg()
    return found


def crossings_with_letters(p: Scalar, q: Scalar) -> list[tuple[Scalar, Scalar]]:
    """Return k and ω² of roots on the imaginary axis where ω² is rational in the letters."""
    im, re, square = on_boundary(p, q, "s")
    found = []
    for factor, _ in im.numerator.factors()[1]:
        if "x" in factor.names and factor.degree("x") == 1:
            lead, rest = factor.coefficients("x")
            x = -rest / lead
            below = square.substitute({"x": x})
            if not below.is_zero:
                found.append((-re.substitute({"x": x}) / below, x))
    return found
