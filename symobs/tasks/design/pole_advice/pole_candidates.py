"""Candidate observer poles: stable plant zeros, Butterworth points, and a dominant pair for a given overshoot."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Complex, Root, Scalar, factored, from_coefficients, product_of, transfer
from symobs.exact.core.generators import square_root
from symobs.exact.time_functions.butterworth import butterworth_angles, twice_cosine
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import is_beyond, on_boundary, stability
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace

#: Why a zero is not used that is a place for a pole under conditions on the parameters.
OPEN = frozenset({"zero_open", "zero_slow_open"})


@dataclass(frozen=True)
class PlantZeros:
    """A plant's numerator as a unit and monic factors: those with stable roots, and the others, each with the reason."""

    unit: Scalar
    used: tuple[tuple[Scalar, int], ...]
    unused: tuple[tuple[Scalar, int, str], ...]

    @staticmethod
    def of(numerator: Scalar, plant: StateSpace, sigma: Scalar | None, taken: tuple[Scalar, ...] = ()) -> PlantZeros:
        """Sort the zeros: those in Re s < 0, with σ in Re s < −σ, are used, and those `taken` for being there."""
        used: list[tuple[Scalar, int]] = []
        unused: list[tuple[Scalar, int, str]] = []
        if numerator.is_zero:
            return PlantZeros(numerator, (), ())
        form = factored(numerator, plant.variable)
        for factor, power in form.factors:
            for part in _parts(factor, plant.variable):
                reason = "" if part in taken else _reason(part, plant, sigma)
                if reason:
                    unused.append((part, power, reason))
                else:
                    used.append((part, power))
        return PlantZeros(form.unit, tuple(used), tuple(unused))

    @property
    def polynomial(self) -> Scalar:
        """The product of the factors that are used."""
        return product_of(factor**power for factor, power in self.used)

    @property
    def others(self) -> Scalar:
        """What is left of the numerator."""
        return self.unit * product_of(factor**power for factor, power, _ in self.unused)


def _parts(factor: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return an irreducible factor, or its two linear ones where its roots are real numbers on both sides of 0."""
    coefficients = factor.coefficients(variable)
    if len(coefficients) != 3 or factor.names != {variable} or coefficients[2].fraction() >= 0:
        return (factor,)
    s, centre = Scalar.symbol(variable), -coefficients[1] / 2
    distance = square_root(centre**2 - coefficients[2])
    return s - centre + distance, s - centre - distance


def _reason(factor: Scalar, plant: StateSpace, sigma: Scalar | None) -> str:
    """Return why the roots of a factor are no places for poles; nothing where they are."""
    signs, variable = plant.symbols.signs, plant.variable
    verdict = stability(factor, variable, signs, discrete=False).verdict
    further = (
        verdict
        if sigma is None
        else stability(_moved(factor, sigma, variable), variable, signs, discrete=False).verdict
    )
    if verdict == "yes":
        return {"yes": "", "no": "zero_slow", "conditional": "zero_slow_open"}[further]
    if factor == Scalar.symbol(variable):
        return "zero_at_origin"
    if on_boundary(factor, variable, signs, discrete=False):
        return "zero_on_axis"
    if verdict == further == "conditional":
        return "zero_open"
    far = factor.substitute({variable: -Scalar.symbol(variable)})
    lead = far.coefficients(variable)[0]
    if stability(far / lead, variable, signs, discrete=False).verdict == "yes":
        return "zero_right"
    return "zero_mixed" if _on_both_sides(factor, variable, signs) else "zero_never"


def _on_both_sides(factor: Scalar, variable: str, signs: Mapping[str, str]) -> bool:
    """Return whether an irreducible factor surely has roots on both sides of the axis, and not all of them on one.

    With numbers for coefficients what is neither stable, nor on the axis, nor all on the right.  With parameters this is
    seen of two roots whose product is negative.
    """
    lead, *_, last = factor.coefficients(variable)
    if factor.names == {variable}:
        return is_beyond(factor, variable, signs, discrete=False)
    return factor.degree(variable) == 2 and sign_of(last / lead, signs) == "negative"


def needed_of(factor: Scalar, signs: Mapping[str, str], sigma: Scalar | None, variable: str) -> tuple[Scalar, ...]:
    """Return what must be positive for the roots of a factor to be places for poles, where that is open."""
    moved = factor if sigma is None else _moved(factor, sigma, variable)
    return stability(moved, variable, signs, discrete=False).positive


def _moved(factor: Scalar, sigma: Scalar, variable: str) -> Scalar:
    """Return the factor whose roots lie σ further right."""
    return factor.substitute({variable: Scalar.symbol(variable) - sigma})


def normalised(factor: Scalar, radius: Scalar, variable: str) -> Scalar:
    """Return a factor of a polynomial in s and ω₀ in units of ω₀."""
    return factor.substitute({variable: Scalar.symbol(variable) * radius}) / radius ** factor.degree(variable)


def poles_of(count: int, radius: Scalar) -> tuple[Complex, ...]:
    """Return Butterworth's poles as complex numbers: −ω₀ where N is odd, then the pairs."""
    found = [Complex.of(-radius)] if count % 2 else []
    for turns in butterworth_angles(count):
        pole = Complex(-radius * twice_cosine(turns) / 2, radius * twice_cosine(Fraction(1, 2) - turns) / 2)
        found += [pole, pole.conjugate()]
    return tuple(found)


def pair_poles(count: int, sigma: Scalar, omega_d: Scalar | None) -> tuple[Complex, ...]:
    """Return −σ ± iω, or −σ where one pole is left."""
    if omega_d is None:
        return (Complex.of(-sigma),) if count else ()
    pole = Complex(-sigma, omega_d)
    return pole, pole.conjugate()


def as_number(root: Root) -> Complex | Root:
    """Return a root as a complex number with square roots, as it is where its radicand has no sign or no form."""
    if not root.is_closed:
        return root
    if root.radicand.is_zero:
        return Complex.of(root.centre)
    if not root.radicand.is_constant:
        return root
    size = root.radicand.fraction()
    distance = square_root(Scalar.of(abs(size))) * root.sign
    if size > 0:
        return Complex.of(root.centre + distance)
    return Complex(root.centre, distance)


def numerator_of(plant: StateSpace) -> Scalar:
    """Return C adj(sI − A) B + D det(sI − A), nothing cancelled."""
    m = plant.matrices
    found = transfer(m.A, m.B, m.C, m.D[0, 0], plant.variable)[0]
    if not plant.equations:
        return found
    return from_coefficients([plant.simplified(c) for c in found.coefficients(plant.variable)], plant.variable)
