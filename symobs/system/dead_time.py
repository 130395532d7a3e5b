"""A dead time at the input of a plant: read, realised by delays in discrete time, or by a Padé approximation.

e^{−sT} ≈ R(−sT)/R(sT) with R(x) = Σ (2n − k)!/(k! (n − k)!) xᵏ, of modulus 1 on the imaginary axis.
Source: G. H. Golub and C. F. Van Loan, Matrix Computations, 4th ed., sec. 9.3.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.dead_time import pade_coefficients
from symobs.exact.linear_algebra.transfer_function import Realisation
from symobs.ground.errors import InputError
from symobs.system.conditions import sign_of
from symobs.system.reading import Discrete, Matrices, read_scalar
from symobs.system.transfer_function_text import WrittenTransferFunction, realise

if TYPE_CHECKING:
    from symobs.system.reading import TimeDomain
    from symobs.system.symbols import Symbols

Plant = TypeVar("Plant", bound=Any)

#: The orders of a Padé approximation.
ORDERS = (1, 2, 3, 4)
#: A dead time of more sampling periods is refused: so many states would be added for every input.
MOST_STEPS = 50
_WHERE = "plant.delay"


def read_delay(value: object, symbols: Symbols, time: TimeDomain) -> Scalar | None:
    """Return the dead time, in discrete time the number of periods; None for 0.

    Raises `InputError` where it is not positive, and in discrete time where it is no whole number of periods.
    """
    if value is None:
        return None
    found = read_scalar(value, symbols.seen(value), _WHERE)
    if found.is_zero:
        return None
    if sign_of(found, symbols.signs) != "positive":
        repair = 'give a positive number, delay = "1/2", or a symbol that is declared positive'
        raise InputError(f"the dead time is {found}", where=_WHERE, repair=repair)
    if not isinstance(time, Discrete):
        return found
    steps = found if time.period is None else found / time.period
    if not steps.is_constant or steps.fraction().denominator != 1:
        unit = "a whole number of sampling periods" if time.period is None else f"a multiple of dt = {time.period}"
        message = f"the dead time is {found}, and in discrete time it is {unit}"
        raise InputError(message, where=_WHERE, repair="write it as one, or give the plant that is sampled with it")
    if steps.fraction() > MOST_STEPS:
        message = f"a dead time of {steps} sampling periods, more than {MOST_STEPS}"
        raise InputError(message, where=_WHERE, repair="sample less often")
    return steps


def lagging(written: Any, steps: Scalar) -> WrittenTransferFunction:
    """Return a transfer function divided by z^d; raises `InputError` for a matrix of them."""
    if not isinstance(written, WrittenTransferFunction):
        message = "a dead time is given for a matrix of transfer functions"
        raise InputError(message, where=_WHERE, repair="write z^-1, z^-2, … in its entries, or give A, B and C")
    factor = Scalar.symbol(written.variable) ** int(steps.fraction())
    return replace(written, below=written.below * factor)


def delayed(matrices: Matrices, steps: int) -> Matrices:
    """Return the matrices of the plant behind so many delays: the states are x, u(k − d), …, u(k − 1)."""
    inputs = matrices.B.shape[1]
    rest = inputs * (steps - 1)
    shift = (
        [Matrix.zeros(rest, inputs), Matrix.identity(rest)],
        [Matrix.zeros(inputs, inputs), Matrix.zeros(inputs, rest)],
    )
    A = Matrix.block(shift)
    B = Matrix.block([[Matrix.zeros(rest, inputs)], [Matrix.identity(inputs)]])
    C = Matrix.block([[Matrix.identity(inputs), Matrix.zeros(inputs, rest)]])
    return _behind(matrices, Realisation(A, B, C, Matrix.zeros(inputs, inputs)))


def _behind(matrices: Matrices, first: Realisation) -> Matrices:
    """Return the matrices of a plant behind a system at its input; the states of the plant come first."""
    below = Matrix.zeros(first.A.shape[0], matrices.A.shape[0])
    A = Matrix.block([[matrices.A, matrices.B @ first.C], [below, first.A]])
    B = Matrix.block([[matrices.B @ first.D], [first.B]])
    C = Matrix.block([[matrices.C, matrices.D @ first.C]]) if matrices.has_output else None
    return Matrices(A, B, C, matrices.D @ first.D if matrices.has_output else None)


def pade(delay: Scalar, order: int) -> tuple[Scalar, Scalar]:
    """Return numerator and denominator of the Padé approximation of e^{−sT} with as many zeros as poles."""
    x, above, below = Scalar.symbol("s") * delay, Scalar.of(0), Scalar.of(0)
    for k, coefficient in enumerate(pade_coefficients(order)):
        above += coefficient * (-x) ** k
        below += coefficient * x**k
    return above, below


def read_order(value: object) -> int | None:
    """Return the order of a Padé approximation, None where there is none; raises `InputError` for another than 1 to 4."""
    if value is None:
        return None
    if isinstance(value, bool) or str(value) not in map(str, ORDERS):
        message = f"{str(value)[:20]} is no order of a Padé approximation here"
        raise InputError(message, where="plant.pade", repair="write 1, 2, 3 or 4")
    return int(str(value))


def approximated(plant: Plant, order: int) -> Plant:
    """Return a plant with its dead time replaced by a Padé approximation."""
    above, below = pade(plant.delay, order)
    written = plant.written
    if isinstance(written, WrittenTransferFunction):
        written = replace(written, above=written.above * above, below=written.below * below)
        A, B, C, D = written.realised("plant.transfer_function", plant.symbols.signs)
    else:
        one = realise(above / below, plant.variable, _WHERE)
        m = _behind(plant.matrices, Realisation(*(_diagonal(part, plant.inputs) for part in one)))
        A, B, C, D, written = m.A, m.B, m.C, m.D, None
    found: Plant = plant.in_coordinates(A, B, C if C.shape[0] else None, D, ())
    found.written = written
    found.delay, found.approximates = None, (plant.delay, order)
    return found


def _diagonal(matrix: Matrix, count: int) -> Matrix:
    zeros = Matrix.zeros(*matrix.shape)
    return Matrix.block([[matrix if i == j else zeros for j in range(count)] for i in range(count)])
