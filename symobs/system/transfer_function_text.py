"""Transfer functions as given, and their realisation in canonical or modal form."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Matrix, Scalar, companion, product_of, resultant
from symobs.exact.linear_algebra.modal_matrix import modal_realisation
from symobs.formula.expression import parse_polynomial, parse_scalar, right_side
from symobs.formula.expression.written_fraction import parse_fraction
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.system.reading import over_a_base, read_scalar, require_known
from symobs.system.symbols import is_sympy

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.system.symbols import Symbols

#: A realisation of more states is refused: designs and tests for it would not end.
MOST_STATES = 200

#: The coordinates in which a transfer function is realised; the first ones where none are named.
REALISATIONS = ("controllable", "observable", "modal")


@dataclass
class WrittenTransferFunction:
    """An unreduced rational function of the variable: above / below, with common factors."""

    above: Scalar
    below: Scalar
    variable: str
    #: The coordinates of the realisation.
    realisation: str = REALISATIONS[0]

    @cached_property
    def value(self) -> Scalar:
        """The function in lowest terms."""
        return self.above / self.below

    @cached_property
    def _common(self) -> tuple[tuple[Scalar, int], ...]:
        return (self.below / self.value.denominator).numerator.factors()[1]

    @property
    def cancelled(self) -> Scalar:
        """The cancelled factor of the denominator, 1 if nothing cancels."""
        return product_of(factor**power for factor, power in self._common if self.variable in factor.names)

    def realised(self, where: str, signs: Mapping[str, str]) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """Return its realisation in controllable or observable canonical form, or in modal form."""
        del signs  # its roots have been read
        A, B, C, D = realise(self.value, self.variable, where)
        if self.realisation == "observable":
            return A.T, C.T, B.T, D
        return (*modal_realisation(A, B, C, self.variable), D) if self.realisation == "modal" else (A, B, C, D)

    @property
    def apart(self) -> tuple[Scalar, ...]:
        """The cancelled factors in the parameters alone, which are nonzero wherever the function is defined."""
        return tuple(factor for factor, _ in self._common if self.variable not in factor.names)


def read_transfer_function(value: object, symbols: Symbols, variable: str, where: str) -> WrittenTransferFunction:
    """Return the transfer function of a text, a SymPy expression, a number or two lists of coefficients."""
    written: Any
    if isinstance(value, str):
        value = right_side(value)
        found = parse_scalar(value, symbols.names, variable=variable, where=where, functions=True)
        written = parse_fraction(value, symbols.names, variable=variable, where=where)
    elif is_sympy(value):
        found, written = read_scalar(value, symbols, where, functions=True), _of_sympy(value, where)
    elif isinstance(value, (list, tuple)):
        value = [part.tolist() if hasattr(part, "tolist") else part for part in value]  # NumPy arrays
        written = _of_coefficients(value, symbols, variable, where)
        found = written[0] / written[1]
    else:
        found, written = read_scalar(value, symbols, where), None
    above, below = written or (found.numerator, found.denominator)
    return written_over(*over_data(above, below, variable, where, symbols.signs), variable)


def over_data(
    above: Scalar, below: Scalar, variable: str, where: str, signs: Mapping[str, str]
) -> tuple[Scalar, Scalar]:
    """Return numerator and denominator over a common base of their functions, simplified by what vanishes there.

    Raises `InputError` for a function of the variable, and where what vanishes is divided by, is the numerator, or makes the
    two have a common factor.
    """
    if not require_known([above, below], signs, where):
        return above, below
    row, relations = over_a_base({"P": Matrix.row([above, below])}, signs, where)
    assert row["P"] is not None  # noqa: S101 - it is given
    given, common = above, row["P"].common_denominator()
    above, below = (part * common for part in row["P"].entries)
    ideal = Ideal.of(relations)
    if relations:
        above, below = ideal.simplified(above), ideal.simplified(below)
    if below.is_zero or (above.is_zero and not given.is_zero):
        message, repair = "a coefficient divides by 0", "divide by what is not 0"
        if above.is_zero:  # h / (h s² + s + h) may have been written so, or be 1 / (s² + s/h + 1)
            message, repair = f"{message}, or the numerator is 0", f"{repair}, and write 0 for what is"
        raise InputError(f"{message}, for all values of the functions", where=where, repair=repair)
    if relations:
        least = above / below
        if resultant(least.numerator, least.denominator, variable) in ideal:
            message = "numerator and denominator have a common factor, for all values of their functions"
            raise InputError(message, where=where, repair="cancel it")
    return above, below


def written_over(above: Scalar, below: Scalar, variable: str) -> WrittenTransferFunction:
    """Return the function above / below with integer coefficients."""
    common = above.denominator * below.denominator  # numbers, unless a polynomial came with coefficients 1/m
    return WrittenTransferFunction((above * common).numerator, (below * common).numerator, variable)


def _of_sympy(value: Any, where: str) -> tuple[Scalar, Scalar] | None:
    """Return the unreduced numerator and denominator of a SymPy expression, None if they are complex."""
    from symobs.exact.sympy_bridge.conversion import fraction_from_sympy  # noqa: PLC0415 - a SymPy object came in

    above, below = fraction_from_sympy(value, where)
    return (above.real, below.real) if above.is_real and below.is_real else None


def _of_coefficients(value: list[Any] | tuple[Any, ...], symbols: Symbols, variable: str, where: str) -> Any:
    """Return the two polynomials of lists of coefficients, the highest power first."""
    if len(value) == 2 and all(map(is_sympy, value)):
        return [read_scalar(part, symbols, f"{where}[{number}]") for number, part in enumerate(value)]
    if len(value) != 2 or not all(isinstance(part, (list, tuple)) and part for part in value):
        message = "the coefficients of one numerator and of one denominator are expected"
        raise InputError(message, where=where, repair=f"write [[1], [1, 2, 0]] for 1/({variable}^2 + 2*{variable})")
    s, found = Scalar.symbol(variable), []
    for number, part in enumerate(value):
        total = Scalar.of(0)
        for place, entry in enumerate(part):
            total = total * s + read_scalar(entry, symbols, f"{where}[{number}][{place}]")
        found.append(total)
    if found[1].is_zero:
        raise InputError("the denominator is 0", where=f"{where}[1]", repair="give a coefficient that is not 0")
    return found


def read_characteristic(value: object, symbols: Symbols, variable: str, where: str) -> Scalar:
    """Return a polynomial of degree 1 or more, and of no more than a plant may have states."""
    if isinstance(value, str):
        found = parse_polynomial(value, variable, symbols.names, where=where, functions=True)
    else:
        found = read_scalar(value, symbols, where, functions=True)
    degree = found.degree(variable)
    if degree < 1 or not found.is_polynomial_in(variable):
        message = f"{found} is not a polynomial in {variable} of degree 1 or more"
        raise InputError(message, where=where, repair=f'write for example "{variable}^2 + h {variable} + 1"')
    if degree > MOST_STATES:
        message = f"a polynomial of degree {degree}, more than {MOST_STATES}"
        raise BudgetExceeded(message, where=where, repair="give one of lower degree")
    return found


def _other_time(value: Scalar, variable: str) -> str:
    """Return what to do about a function of the variable of the other domain of time."""
    if variable == "s" and "z" in value.names:
        return "z is the variable in discrete time: give dt = true, or the period"
    if variable == "z" and "s" in value.names:
        return "s is the variable in continuous time: leave dt out, or write z"
    return ""


def realise(value: Scalar, variable: str, where: str = "transfer_function") -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return the controllable canonical form (A, B, C, D) of a proper rational function."""
    denominator = value.denominator.coefficients(variable)
    order = len(denominator) - 1
    numerator = value.numerator.coefficients(variable)
    if order < 1:
        message = f"{value} has no pole, so it has no state"
        example = f"1/({variable}*({variable}+1))"
        repair = f"give a proper rational function of {variable}, such as {example}"
        raise InputError(message, where=where, repair=_other_time(value, variable) or repair)
    if order > MOST_STATES:
        message = f"a transfer function of order {order}, more than {MOST_STATES}"
        raise BudgetExceeded(message, where=where, repair="give one of lower order")
    if len(numerator) > order + 1:
        message = f"{value} is not proper: degree {len(numerator) - 1} over degree {order}"
        raise InputError(message, where=where, repair="the degree of the numerator may not exceed the denominator's")
    lead = denominator[0]
    monic = [c / lead for c in denominator[1:]]
    padded = [Scalar.of(0)] * (order + 1 - len(numerator)) + [c / lead for c in numerator]
    feedthrough = padded[0]
    rest = [b - feedthrough * a for a, b in zip(monic, padded[1:], strict=True)]
    return (
        companion(monic),
        Matrix.unit(order, order - 1),
        Matrix.row(list(reversed(rest))),
        Matrix.of([[feedthrough]]),
    )
