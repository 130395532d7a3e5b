"""Functions of parameters in poles and polynomials: plant and polynomials over one base, with what vanishes there."""

from __future__ import annotations

from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Matrix, Scalar, modulo
from symobs.exact.core.generators import NotWritten, functions_in, identities, roots_in, square_root
from symobs.ground.errors import InputError
from symobs.system import Matrices
from symobs.system.specification.keywords import DesiredPolynomial

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system import StateSpace


def over_common_data(plant: StateSpace, *asked: Any) -> tuple[StateSpace, tuple[Any, ...]]:
    """Return a plant and what is asked for, the functions in desired polynomials and further matrices among its data.

    cos θ and e⁻ᵀ are letters of their own, as in the entries of a plant; on the plant that is returned cos² θ + sin² θ = 1
    holds.  Raises `InputError` for a function of s or z, and for a root that is not known to be real.
    """
    wanted = [one for one in asked if isinstance(one, DesiredPolynomial)]
    factors = [factor for one in wanted for factor in one.factors]
    further = [one for one in asked if isinstance(one, Matrix)]
    if all(function.square for function in functions_in([*factors, *further])):
        return plant, asked
    m = plant.matrices
    parts = [part for one in wanted for pole in one.poles for part in (pole.real, pole.imaginary)]
    try:
        meanings, _ = identities([m.A, m.B, m.C, m.D, *plant.equations, *factors, *parts, *further])
    except NotWritten as error:
        raise InputError(str(error), where="specification", repair="declare a symbol for it") from None
    there = copy(plant)
    there.__dict__.pop("field", None)
    A, B, C, D = (_moved_matrix(matrix, meanings) for matrix in (m.A, m.B, m.C, m.D))
    there.matrices = Matrices(A, B if m.has_input else None, C if m.has_output else None, D)
    there.equations = tuple(_moved(equation, meanings).numerator for equation in plant.equations)
    if plant.written is not None and there.matrices != m:
        message = "the transfer function and the poles have functions of different multiples of one argument"
        raise InputError(
            message, where="specification", repair="write both with the smaller one, exp(-T)^2 for exp(-2 T)"
        )
    moved = [_moved(factor, meanings) for factor in factors]
    further = [_moved_matrix(matrix, meanings) for matrix in further]
    there = there.restricted(identities([A, B, C, D, *moved, *further])[1])

    def over(one: Any) -> Any:
        if isinstance(one, Matrix):
            return modulo(_moved_matrix(one, meanings), there.ideal)
        return _over(one, meanings, there) if isinstance(one, DesiredPolynomial) else one

    return there, tuple(map(over, asked))


def _over(desired: DesiredPolynomial, meanings: Mapping[str, Scalar], there: StateSpace) -> DesiredPolynomial:
    """Return a desired polynomial over the data of a plant, its factors simplified by what vanishes there."""
    factors = []
    for factor in desired.factors:
        moved = _moved(factor, meanings)
        if not there.admits(moved):
            raise _divides_by_zero()
        short = there.simplified(moved)
        factors.append(short if short.coefficients(desired.variable)[0].is_one else moved)
    poles = tuple(Complex(_moved(pole.real, meanings), _moved(pole.imaginary, meanings)) for pole in desired.poles)
    own = desired.pattern
    pattern = None
    if own is not None:
        values = tuple((name, _moved(value, meanings)) for name, value in own.values)
        pattern = replace(own, values=values, factors=tuple(factors[: len(own.factors)]))
    return replace(desired, factors=tuple(factors), poles=poles, pattern=pattern)


def _moved(value: Scalar, meanings: Mapping[str, Scalar]) -> Scalar:
    """Return a value in the base, the radicands of its roots too."""
    images = {name: meanings[name] for name in value.names if name in meanings}
    for root in roots_in(value):
        if not root.argument.is_constant:
            images[root.name] = square_root(_moved(root.argument, meanings))
    try:
        return value.substitute(images) if images else value
    except ZeroDivisionError:
        raise _divides_by_zero() from None


def _divides_by_zero() -> InputError:
    return InputError("a coefficient divides by 0", where="specification", repair="divide by what is not 0")


def _moved_matrix(matrix: Matrix, meanings: Mapping[str, Scalar]) -> Matrix:
    images = {name: meanings[name] for name in matrix.names if name in meanings}
    return matrix.substitute(images) if images else matrix
