"""The loop of a plant G and a controller F with negative feedback: its polynomials, without any cancelling.

F may be improper, as Kp + Ki/s + Kd s is: the loop F G alone counts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Scalar, transfer
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from symobs.system import StateSpace
    from symobs.system.transfer_function_text import WrittenTransferFunction

#: Where a controller stands in a file.
_WHERE = "specification.controller"


class Parameters(NamedTuple):
    """The names that a region is one of."""

    parameters: tuple[str, ...]


def monic(controller: WrittenTransferFunction) -> tuple[Scalar, Scalar]:
    """Return numerator and denominator, the lead of the denominator 1; nothing is cancelled."""
    lead = controller.below.coefficients(controller.variable)[0]
    return controller.above / lead, controller.below / lead


def loop_polynomials(plant: StateSpace, controller: WrittenTransferFunction) -> tuple[Scalar, Scalar]:
    """Return P and N with F G = N/P; raises `InputError` for several inputs or outputs, and where F G is not proper."""
    m = plant.matrices
    if (plant.inputs, plant.outputs) != (1, 1):
        message = f"a loop with a controller has one input and one output, the plant {plant.inputs} and {plant.outputs}"
        raise InputError(message, where=_WHERE, repair="give a plant with one of each")
    above, below = monic(controller)
    numerator, chi = transfer(m.A, m.B, m.C, m.D[0, 0], plant.variable)
    opened, moved = chi * below, numerator * above
    if not moved.is_zero and moved.degree(plant.variable) > opened.degree(plant.variable):
        message = "the loop is not proper: more zeros than poles"
        raise InputError(message, where=_WHERE, repair="give a controller with more poles, or a plant with fewer zeros")
    return opened, moved
