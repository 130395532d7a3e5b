"""Warnings about observer poles; each one is also a sentence of the page."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Factored, Scalar, apply_polynomial, roots_of
from symobs.exact.algebraic.enclosure import is_number, sign_of_number
from symobs.formula.phrases import PHRASES
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import no_stable_compensator
from symobs.tasks.design.pole_advice.pole_candidates import numerator_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.system import StateSpace
    from symobs.tasks.design.pole_advice.pole_candidates import PlantZeros
    from symobs.tasks.design.pole_placement.single_output import ObserverPair

#: Zero and pole are near each other where they differ by less than this part of the zero.
_NEAR = 10
#: A gain is huge where an entry is more than this many times the largest of A, and of 1.
_HUGE = 100


@dataclass(frozen=True)
class PoleWarning:
    """A phrase with what stands in its slots: a factor of the numerator, a pole of the plant, a number."""

    key: str
    slots: tuple[tuple[str, Scalar], ...] = ()
    variable: str = "s"

    def __str__(self) -> str:
        return PHRASES[self.key].replace("$", "").format(**{name: self._text(name, v) for name, v in self.slots})

    def _text(self, name: str, value: Scalar) -> str:
        if name == "pole":
            return f"{self.variable} = {value}"
        if name == "zero" and value.degree(self.variable) == 1:
            return f"{self.variable} = {-value.coefficients(self.variable)[1]}"
        return f"{value} = 0" if name == "zero" else str(value)


def warnings_of(
    plant: StateSpace, zeros: PlantZeros, polynomial: Factored, pair: ObserverPair, missed: Scalar
) -> tuple[PoleWarning, ...]:
    """Return the warnings: of zeros that are no places for poles, cancellations, the compensator, the gain, fixed modes."""
    return (
        *_of_zeros(zeros, plant.variable),
        *_of_cancellations(plant, zeros),
        *_of_compensator(plant),
        *_of_gain(plant, polynomial, pair),
        *([] if missed.is_one else [PoleWarning("modes_missed", (("polynomial", missed),))]),
    )


def _of_zeros(zeros: PlantZeros, variable: str) -> Iterator[PoleWarning]:
    if zeros.unit.is_zero:
        yield PoleWarning("no_response")
    for factor, _, reason in zeros.unused:
        alone = reason == "zero_at_origin" or factor.degree(variable) == 1
        yield PoleWarning(reason if alone else f"{reason}s", (("zero", factor),), variable)


def _of_cancellations(plant: StateSpace, zeros: PlantZeros) -> Iterator[PoleWarning]:
    """Compare the rational zeros with the rational poles."""
    chi = plant.matrices.A.characteristic_polynomial(plant.variable)
    if zeros.unit.is_zero or chi.names != {plant.variable}:
        return
    factors = [*(f for f, _ in zeros.used), *(f for f, _, _ in zeros.unused)]
    poles = {root.centre for root in roots_of(chi, plant.variable) if root.factor.degree(plant.variable) == 1}
    for factor in factors:
        zero = -factor.coefficients(plant.variable)[1]
        if factor.degree(plant.variable) != 1 or not zero.is_constant:
            continue
        for pole in sorted(poles, key=lambda p: p.fraction()):
            distance = abs(zero.fraction() - pole.fraction())
            if _NEAR * distance < abs(zero.fraction()) or not distance:
                key = "nearly_cancels" if distance else "cancels"
                yield PoleWarning(key, (("zero", factor), ("pole", pole)), plant.variable)


def _of_compensator(plant: StateSpace) -> Iterator[PoleWarning]:
    """Warn where no compensator that is stable itself can stabilise the plant."""
    P = numerator_of(plant) / plant.matrices.A.characteristic_polynomial(plant.variable)
    if P and no_stable_compensator(P, plant.variable, plant.symbols.signs):
        yield PoleWarning("always_unstable")


def _of_gain(plant: StateSpace, polynomial: Factored, pair: ObserverPair) -> Iterator[PoleWarning]:
    """Warn of a gain with an entry far beyond those of the plant, where all are numbers."""
    A = plant.matrices.A
    if A.names or plant.matrices.C.names or not pair.is_observable:
        return
    factors = [factor for factor, power in polynomial.factors for _ in range(power)]
    if any(not is_number(c) for factor in factors for c in factor.coefficients(plant.variable)):
        return
    gain = apply_polynomial(factors, plant.variable, A, pair.krylov.solve_last())
    limit = _HUGE * max(Fraction(1), *(abs(entry.fraction()) for entry in A.entries))
    for entry in gain.entries:
        if "positive" in (sign_of_number(entry - limit), sign_of_number(-entry - limit)):
            yield PoleWarning("huge_gain", (("limit", Scalar.of(limit)),))
            return
