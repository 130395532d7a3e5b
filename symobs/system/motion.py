r"""Equations of motion as they are typed, Lagrange's equations from energies, and both as ẋ = f(x, u).

Chapters: derivatives in a text (x', θ'', ẍ, \ddot x); equations and energies; the highest derivatives.  The rate of a
variable q is the name q_dot, its second derivative q_ddot; both are printed with dots, and typed and listed with primes.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from symobs.exact import Ideal, Matrix, Scalar
from symobs.exact.core.generators import derivative, identities, symbols_in
from symobs.formula.expression import parse_scalar, typed_name, without_latex
from symobs.formula.expression.names import PRINTED_NAME
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch, together
from symobs.system.symbols import Symbols, is_sympy

if TYPE_CHECKING:
    from collections.abc import Iterable

ZERO = Scalar.of(0)
_MOST_CHARACTERS = 20_000
_EXAMPLE = "m*x'' + k*x = F"


@dataclass
class Motion:
    """Equations of motion J w + c = 0 in the highest derivatives w, and the energies they come from.

    `equations` are the differences of their sides; with energies the i-th is d/dt ∂T/∂qᵢ′ − ∂T/∂qᵢ + ∂V/∂qᵢ − Qᵢ.
    """

    coordinates: tuple[str, ...]
    equations: tuple[Scalar, ...]
    highest: tuple[str, ...]
    kinetic: Scalar | None = None
    potential: Scalar | None = None
    forces: tuple[Scalar, ...] = ()
    #: The equations as they are typed, (left, right); none where energies are given.
    sides: tuple[tuple[Scalar, Scalar], ...] = ()

    @property
    def energies(self) -> tuple[Scalar, ...]:
        """T and V, where they are given."""
        return tuple(energy for energy in (self.kinetic, self.potential) if energy is not None)

    @property
    def mass(self) -> Matrix:
        """J, the matrix of the highest derivatives: M(q) of a mechanical system."""
        return jacobian(self.equations, self.highest)

    @property
    def rest(self) -> Matrix:
        """c, the equations without their highest derivatives."""
        zeros = dict.fromkeys(self.highest, ZERO)
        return Matrix.column([equation.substitute(zeros) for equation in self.equations])

    @property
    def derivatives(self) -> tuple[str, ...]:
        """The names of all derivatives of the coordinates."""
        return tuple(rate_of(q, times) for q in self.coordinates for times in (1, 2))

    def moved(self, values: Mapping[str, Scalar]) -> Motion:
        """Return the equations with parameters replaced."""

        def there(value: Scalar | None) -> Scalar | None:
            return None if value is None else value.substitute(values)

        equations = tuple(equation.substitute(values) for equation in self.equations)
        forces = tuple(force.substitute(values) for force in self.forces)
        sides = tuple((left.substitute(values), right.substitute(values)) for left, right in self.sides)
        return replace(
            self,
            equations=equations,
            kinetic=there(self.kinetic),
            potential=there(self.potential),
            forces=forces,
            sides=sides,
        )


# Derivatives in a text.


_RATE, _SECOND = "_dot", "_ddot"
_MARKS = {"'": 1, "′": 1, "\u2019": 1, "″": 2, '"': 2}
_PRIMED = re.compile(rf"({PRINTED_NAME})\s?([{''.join(_MARKS)}]+)")
_COMMAND = re.compile(
    r"\\(d{1,3})ot\s*(?:\{\s*(\\?[A-Za-z]+(?:_\w+|_\{\w+\})?)\s*\}|(\\[A-Za-z]+|[A-Za-z]))(_\w|_\{\w+\})?"
)
_OF_SYMPY = re.compile(r"Derivative\((\w+)\(t\), (?:t|\(t, (\d)\))\)")
_QUOTIENT = re.compile(r"d(?:\^?2|²)?\s?(\w+)\s?/\s?dt(\^2|²)?(?!\w)")
_DOTS = {"\u0307": 1, "\u0308": 2}
_DOTTED = re.compile(rf"([^\W\d_])([{''.join(_DOTS)}])((?:_?\w*))")


def rate_of(name: str, times: int = 1) -> str:
    """Return the name of a derivative of a variable."""
    return name + ("", _RATE, _SECOND)[times]


def with_primes(name: str) -> str:
    """Return the name of a variable or its rate as it is typed: x_dot is x'."""
    return f"{name.removesuffix(_RATE)}'" if name.endswith(_RATE) else name


def without_primes(name: str) -> str:
    """Return the name that a typed one stands for: x' is x_dot."""
    text = _with_primes_alone(name.strip())
    stem = text.rstrip("'")
    return rate_of(typed_name(stem), len(text) - len(stem)) if len(text) - len(stem) < 3 else name


def _with_primes_alone(text: str) -> str:
    """Return a text in which every derivative is written with primes: those of LaTeX, of SymPy, dots and d/dt."""
    if any(ord(character) > 127 for character in text):
        apart = unicodedata.normalize("NFD", text)
        text = _DOTTED.sub(lambda f: f[1] + f[3] + "'" * _DOTS[f[2]], apart)
    text = _COMMAND.sub(lambda f: f"{f[2] or f[3]}{f[4] or ''}{chr(39) * len(f[1])} ", text)
    text = _OF_SYMPY.sub(lambda f: f[1] + "'" * int(f[2] or 1), text)
    text = _QUOTIENT.sub(lambda f: f[1] + ("''" if f[2] else "'"), text)
    return "".join("'" * _MARKS[character] if character in _MARKS else character for character in text)


def typed_derivatives(text: str, variables: Iterable[str], where: str) -> str:
    r"""Return a text with the names of derivatives for x', x'', ẋ, \\ddot x, dx/dt; x(t) is x.

    Raises `InputError` for the derivative of what is no variable, and for a third derivative.
    """
    if len(text) > _MOST_CHARACTERS:
        return text
    known = set(variables)
    text = without_latex(_with_primes_alone(text))

    def named(found: re.Match[str]) -> str:
        name, times = typed_name(found[1]), len(found[2])
        if name not in known:
            message = (
                f"{shown(found[0])} is the derivative of {shown(found[1])}, which is none of {', '.join(sorted(known))}"
            )
            raise InputError(message, where=where, repair="name it among the coordinates, or the states")
        if times > 2:
            message = f"{shown(found[0])} is a derivative of third order"
            raise InputError(message, where=where, repair="write v for the second, and an equation x'' = v")
        return f"{rate_of(name, times)} "

    text = _PRIMED.sub(named, text)
    for name in sorted(known, key=len, reverse=True):
        text = re.sub(rf"\b({re.escape(name)}(?:{_RATE}|{_SECOND})?)\s?\(t\)", r"\1", text)
    return text


# Equations and energies.


def equations_of(
    given: object, variables: Sequence[str], inputs: Sequence[str], symbols: Symbols, orders: Mapping[str, int]
) -> Motion:
    """Return the equations of a list of texts, "m*x'' = F"; `orders` are those the states declare.

    Raises `InputError` for texts without an equation, for too many or too few, and for a variable without a derivative.
    """
    listed = [given] if isinstance(given, str) or is_sympy(given) else given
    if not isinstance(listed, Sequence) or not listed:
        repair = f'write equations = ["{_EXAMPLE}"]'
        raise InputError("equations are expected", where="plant.equations", repair=repair)
    scope = _with_rates(symbols, variables)
    sides = together(
        *(partial(_sides, text, variables, scope, f"plant.equations[{place}]") for place, text in enumerate(listed))
    )
    found = tuple(left - right for left, right in sides)
    if len(found) != len(variables):
        message = (
            f"there {'is 1 equation' if len(found) == 1 else f'are {len(found)} equations'} for {', '.join(variables)}"
        )
        raise ShapeMismatch(message, where="plant.equations", repair="write one for each of them, no more")
    derivatives = {rate_of(name, times) for name in variables for times in (1, 2)}
    moving = [bool(symbols_in(equation) & derivatives) for equation in found]
    for place, moves in enumerate(moving):
        if not moves and any(moving):
            message = "an equation without a derivative ties the variables together"
            repair = "solve it for one of them, put that into the other equations, and leave both out"
            raise InputError(message, where=f"plant.equations[{place}]", repair=repair)
    highest = tuple(_highest(name, found, orders) for name in variables)
    for place, equation in enumerate(found):
        if not symbols_in(equation) & set(highest):
            message = "an equation has no highest derivative"
            repair = f"write it with one of {', '.join(map(_shown, highest))}"
            raise InputError(message, where=f"plant.equations[{place}]", repair=repair)
    return _checked(Motion(tuple(variables), found, highest, sides=sides), inputs)


def from_energies(
    kinetic: object,
    potential: object,
    forces: object,
    coordinates: Sequence[str],
    inputs: Sequence[str],
    symbols: Symbols,
) -> Motion:
    """Return Lagrange's equations d/dt ∂T/∂q′ − ∂T/∂q + ∂V/∂q = Q of T(q, q′), V(q) and the generalised forces Q.

    Raises `InputError` for second derivatives in T, rates in V, and forces on what is no coordinate.
    """
    if kinetic is None:
        message = "the kinetic energy is missing"
        raise InputError(message, where="plant.kinetic", repair='write kinetic = "m/2*x\'^2"')
    scope = _with_rates(symbols, coordinates)
    table = {} if forces is None else forces
    if not isinstance(table, Mapping):
        raise InputError("a force for a coordinate is expected", where="plant.forces", repair='write { x = "F" }')
    named = {without_primes(str(key)): value for key, value in table.items()}
    if unknown := sorted(set(named) - set(coordinates)):
        message = f"{shown(unknown[0])} is none of the coordinates {', '.join(coordinates)}"
        raise InputError(message, where="plant.forces", repair="name the coordinate that the force acts along")
    T, V, *Q = together(
        partial(_expression, kinetic, coordinates, scope, "plant.kinetic"),
        partial(_expression, 0 if potential is None else potential, coordinates, scope, "plant.potential"),
        *(partial(_expression, named.get(name, 0), coordinates, scope, f"plant.forces.{name}") for name in coordinates),
    )
    rates, second = [rate_of(q) for q in coordinates], [rate_of(q, 2) for q in coordinates]
    for value, where, excluded, repair in (
        (T, "plant.kinetic", second, "the kinetic energy depends on coordinates and rates"),
        (V, "plant.potential", rates + second, "the potential energy depends on coordinates alone"),
        *(
            (force, f"plant.forces.{q}", second, "write the equations instead")
            for q, force in zip(coordinates, Q, strict=True)
        ),
    ):
        if inside := sorted(symbols_in(value) & set(excluded)):
            raise InputError(f"{_shown(inside[0])} occurs", where=where, repair=repair)
    T = simplified(T)
    equations = []
    for q, q_dot, force in zip(coordinates, rates, Q, strict=True):
        momentum = derivative(T, q_dot)
        equations.append(
            simplified(total_derivative(momentum, coordinates) - derivative(T, q) + derivative(V, q) - force)
        )
    motion = Motion(tuple(coordinates), tuple(equations), tuple(second), T, V, tuple(Q))
    return _checked(motion, inputs)


def total_derivative(value: Scalar, coordinates: Iterable[str]) -> Scalar:
    """Return d/dt of a function of coordinates and rates: Σ ∂/∂q q′ + ∂/∂q′ q″."""
    total = ZERO
    for q in coordinates:
        for times in (0, 1):
            total = total + derivative(value, rate_of(q, times)) * Scalar.symbol(rate_of(q, times + 1))
    return total


def jacobian(functions: Sequence[Scalar], names: Sequence[str]) -> Matrix:
    """Return ∂ functions / ∂ names."""
    return Matrix.of([[simplified(derivative(value, name)) for name in names] for value in functions], len(names))


def simplified(value: Scalar) -> Scalar:
    """Return a value by cos² + sin² = 1 and the other identities of its functions, where that is shorter."""
    meanings, vanishing = identities([value])
    if not vanishing:
        return value
    found = Ideal.of(vanishing).simplified(value.substitute(meanings) if meanings else value)
    return found if found.size < value.size else value


def _with_rates(symbols: Symbols, variables: Sequence[str]) -> Symbols:
    return symbols.naming([rate_of(q, times) for q in variables for times in (1, 2)], "plant")


def _expression(value: object, variables: Sequence[str], symbols: Symbols, where: str) -> Scalar:
    text = str(value) if is_sympy(value) or isinstance(value, (int, str)) else value
    if isinstance(text, str):
        text = typed_derivatives(text, variables, where)
    return parse_scalar(text, symbols.names, where=where, functions=True, nonlinear=True)


def _sides(value: object, variables: Sequence[str], symbols: Symbols, where: str) -> tuple[Scalar, Scalar]:
    """Return the left and the right side; without "=" the right side is 0."""
    sides: list[object] = [value]
    if is_sympy(value) and hasattr(value, "lhs"):
        sides = [value.lhs, value.rhs]  # type: ignore[attr-defined]
    elif isinstance(value, str):
        sides = [*value.split("=")]
    if len(sides) > 2:
        raise InputError("several signs of equality stand in one equation", where=where, repair="write them one by one")
    left, *right = [_expression(side, variables, symbols, where) for side in sides]
    return left, right[0] if right else ZERO


def _highest(name: str, equations: Sequence[Scalar], orders: Mapping[str, int]) -> str:
    """Return the highest derivative of a variable that occurs."""
    occurring = set[str]().union(*map(symbols_in, equations))
    order = next((times for times in (2, 1) if rate_of(name, times) in occurring), 0)
    if not order:
        message = f"no derivative of {name} occurs"
        repair = f"write {name}' or {name}'' where it changes; what does not is a parameter: declare it in [symbols]"
        raise InputError(message, where="plant.equations", repair=repair)
    if name in orders and orders[name] != order:
        message = f"{_shown(rate_of(name, order))} occurs, and the states are those of order {orders[name]} in {name}"
        repair = f"name {name}{' and ' + name + chr(39) if order > 1 else ' alone'} among the states"
        raise InputError(message, where="plant.states", repair=repair)
    return rate_of(name, order)


def _shown(name: str) -> str:
    return f"{name.removesuffix(_SECOND)}''" if name.endswith(_SECOND) else with_primes(name)


def _checked(motion: Motion, inputs: Sequence[str]) -> Motion:
    """Return the equations; raises `InputError` where they do not determine the highest derivatives, or an input is idle."""
    J, place = motion.mass, "plant.kinetic" if motion.kinetic is not None else "plant.equations"
    if crossed := sorted(symbols_in(J) & set(motion.highest)):
        message = f"the equations are not linear in {_shown(crossed[0])}"
        raise InputError(message, where=place, repair="solve them for the highest derivatives")
    if simplified(J.determinant()).is_zero:
        message = (
            f"the equations do not determine {', '.join(map(_shown, motion.highest))}: their matrix has determinant 0"
        )
        repair = "give every coordinate its mass, and leave out those that others determine"
        if motion.kinetic is None:
            repair = "write independent equations, each with a highest derivative of its own"
        raise InputError(message, where=place, repair=repair)
    occurring = set[str]().union(*map(symbols_in, motion.equations))
    if idle := [name for name in inputs if name not in occurring]:
        message = f"the input {idle[0]} does not occur"
        where = "plant.forces" if motion.kinetic is not None else "plant.equations"
        raise InputError(message, where=where, repair="write it where it acts, or leave it out of the inputs")
    return motion


# The highest derivatives: ẋ = f(x, u).


def states_of(motion: Motion) -> tuple[str, ...]:
    """Return the coordinates, then the rates of those whose equation is of second order."""
    second = (q for q, highest in zip(motion.coordinates, motion.highest, strict=True) if highest.endswith(_SECOND))
    return (*motion.coordinates, *map(rate_of, second))


def rates_of(motion: Motion, states: Sequence[str]) -> Matrix:
    """Return f with ẋ = f(x, u): rates are states, the highest derivatives are −J⁻¹ c."""
    solved = motion.mass.solve(-motion.rest)
    known = {name: simplified(value) for name, value in zip(motion.highest, solved.entries, strict=True)}
    found = []
    for name in states:
        rate = f"{name.removesuffix(_RATE)}{_SECOND}" if name.endswith(_RATE) else rate_of(name)
        found.append(known[rate] if rate in known else Scalar.symbol(rate))
    return Matrix.column(found)


def read_states(given: Sequence[str], where: str = "plant.states") -> tuple[tuple[str, ...], dict[str, int]]:
    """Return the names of states that are typed with primes, and the order of each variable among them."""
    names = tuple(map(without_primes, given))
    orders: dict[str, int] = {}
    for name in names:
        stem = name.removesuffix(_RATE)
        orders[stem] = max(orders.get(stem, 0), 2 if name.endswith(_RATE) else 1)
    if lonely := [stem for stem in orders if stem not in names]:
        message = f"{lonely[0]}' is a state, and {lonely[0]} is none"
        raise InputError(message, where=where, repair=f"name {lonely[0]}, too")
    return names, orders
