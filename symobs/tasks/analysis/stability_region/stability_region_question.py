"""The polynomial of a stability region: given, or that of a plant whose gain has free entries."""

from __future__ import annotations

from difflib import get_close_matches
from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar
from symobs.exact.core.generators import function_named
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary
from symobs.system import StateSpace, read_scalar
from symobs.system.conditions import sign_of
from symobs.system.specification import read_gain, read_names

if TYPE_CHECKING:
    from symobs.exact import Matrix


#: The determinants that decide for a polynomial with parameters grow too large beyond this degree.
MOST_DEGREE = 40


@dataclass(frozen=True)
class RegionQuestion:
    """The polynomial's origin (gains that are given, else the plant itself), the parameters, and what stable means."""

    plant: StateSpace
    K: Matrix | None
    L: Matrix | None
    parameters: tuple[str, ...]
    boundary: StabilityBoundary

    @cached_property
    def polynomial(self) -> Scalar:
        """χ: the polynomial itself, or det(sI − A), det(sI − A + BK), det(sI − A + LC), or the product of the last two."""
        m, variable = self.plant.matrices, self.plant.variable
        if self.plant.polynomial is not None:
            return self.plant.polynomial
        moved = [m.A - m.B @ self.K] if self.K is not None else []
        moved += [m.A - self.L @ m.C] if self.L is not None else []
        found = Scalar.of(1)
        for matrix in moved or [m.A]:
            found = found * matrix.characteristic_polynomial(variable)
        return found

    @property
    def limits(self) -> dict[str, Any]:
        """The boundary as keywords."""
        margin, radius = self.boundary.margin, self.boundary.radius
        discrete = self.boundary.discrete
        return {
            "discrete": discrete,
            "margin": None if margin.is_zero else margin,
            "radius": None if radius.is_one else radius,
        }

    @cached_property
    def critical(self) -> CriticalPolynomials:
        """Where roots can cross the boundary."""
        return CriticalPolynomials(self.polynomial, self.boundary, self.plant.symbols.signs)

    @property
    def symbols(self) -> tuple[str, ...]:
        """The names in the polynomial that are no parameters."""
        own = (self.polynomial.names | self.boundary.names) - {self.boundary.variable}
        return tuple(sorted(own - set(self.parameters)))


def read_question(
    plant: StateSpace, gains: dict[str, object], parameters: object, margin: object, radius: object
) -> RegionQuestion:
    """Return the question; raises `InputError` where its parts do not fit together."""
    if plant.polynomial is not None and any(gain is not None for gain in gains.values()):
        name = next(name for name, gain in gains.items() if gain is not None)
        message = f"both a polynomial and the gain {name} are given"
        raise InputError(
            message, where=f"specification.{name}", repair="keep one of them; a gain needs a plant A, B, C"
        )
    plant = plant.knowing(*gains.values())
    found: dict[str, Matrix | None] = dict.fromkeys(gains)
    if gains["K"] is not None:
        plant.require("B", task="the gain K")
        found["K"] = read_gain(gains["K"], plant, "K", (plant.inputs, plant.order))
    if gains["L"] is not None:
        plant.require("C", task="the gain L")
        found["L"] = read_gain(gains["L"], plant, "L", (plant.order, plant.outputs))
    boundary = _boundary(plant, margin, radius)
    asked = RegionQuestion(plant, found["K"], found["L"], (), boundary)
    roots = (asked.polynomial.field | boundary.margin.field | boundary.radius.field).numbers.names
    if roots:
        message = f"the data contain {roots[0]}, and regions are found for polynomials with rational coefficients"
        repair = "write a symbol in its place: the inequalities then hold for its value"
        raise InputError(message, where="specification.polynomial", repair=repair)
    names = sorted(asked.polynomial.names - {plant.variable})
    written = [name for name in names if (f := function_named(name)) is not None and not f.square]
    if written:
        message = f"{written[0]} is no polynomial, and a region is described by polynomials in its parameters"
        raise InputError(message, where="plant", repair="write a symbol in its place, or give numbers")
    degree = asked.polynomial.degree(plant.variable)
    if names and degree > MOST_DEGREE:
        message = f"a polynomial of degree {degree} with parameters, more than {MOST_DEGREE}"
        raise BudgetExceeded(message, where="specification.polynomial", repair="put numbers in place of the symbols")
    if parameters is not None:
        chosen = read_names(parameters, "parameters")
        if plant.variable in chosen:
            message = f"{plant.variable} is the variable of the polynomial"
            raise InputError(message, where="specification.parameters", repair="leave it out")
        _require_occurring(chosen, asked, plant)
    else:
        gained = {name for gain in found.values() if gain is not None for name in gain.names}
        chosen = _free((gained or set(names)) - boundary.names or set(names), plant)
    shared = boundary.names.intersection(chosen)
    if shared:
        name = "radius" if plant.is_discrete else "margin"
        message = f"the {name} contains the parameter {min(shared)}"
        raise InputError(
            message, where=f"specification.{name}", repair="write another name, or leave it out of parameters"
        )
    return RegionQuestion(plant, found["K"], found["L"], chosen, boundary)


def _require_occurring(chosen: tuple[str, ...], asked: RegionQuestion, plant: StateSpace) -> None:
    """Raise `InputError` for a parameter that is neither declared nor in the data, unless they have no symbol at all."""
    data = set(plant.matrices.symbols) if plant.polynomial is None else plant.polynomial.names
    names = data.union(*(gain.names for gain in (asked.K, asked.L) if gain is not None)) - {plant.variable}
    declared = set(plant.symbols.signs) - plant.symbols.named
    absent = [name for name in chosen if name not in names | declared | asked.boundary.names]
    if names and absent:
        near = get_close_matches(absent[0], sorted(names), 1)
        repair = f"did you mean {near[0]}? " if near else ""
        repair += f"its symbols: {', '.join(sorted(names))}; leave {absent[0]} out, or declare it in [symbols]"
        message = (
            f"the parameter {absent[0]} does not occur in the {'plant' if plant.polynomial is None else 'polynomial'}"
        )
        raise InputError(message, where="specification.parameters", repair=repair)


def _free(names: set[str], plant: StateSpace) -> tuple[str, ...]:
    """Return the names whose sign is not declared, or all of them where every one has a sign."""
    free = sorted(name for name in names if plant.symbols.sign(name) == "real")
    return tuple(free or sorted(names))


def _boundary(plant: StateSpace, margin: object, radius: object) -> StabilityBoundary:
    """Return what stable means; raises `InputError` for a margin in discrete time, a radius in continuous time."""
    name, other = ("margin", "radius") if plant.is_discrete else ("radius", "margin")
    wrong, value = (margin, radius) if plant.is_discrete else (radius, margin)
    if wrong is not None:
        message = f"a {name} is for {'continuous' if plant.is_discrete else 'discrete'} time"
        raise InputError(message, where=f"specification.{name}", repair=f"give a {other}, or leave it out")
    if value is None:
        return StabilityBoundary(plant.variable, plant.is_discrete)
    where = f"specification.{other}"
    found = read_scalar(value, plant.symbols.seen(value), where)
    if plant.variable in found.names:
        message = f"the {other} contains {plant.variable}, the variable of the polynomial"
        raise InputError(message, where=where, repair="write another name")
    signs = plant.symbols.signs
    if not plant.is_discrete:
        if sign_of(found, signs) in {"negative", "nonpositive"} and not found.is_zero:
            message = f"the margin is {found}, which is negative"
            raise InputError(message, where=where, repair="all roots shall lie in Re s < -margin: give a margin >= 0")
        return StabilityBoundary(plant.variable, margin=found)
    if sign_of(found, signs) in {"zero", "negative", "nonpositive"} or sign_of(found - 1, signs) == "positive":
        message = f"the radius is {found}, which is not between 0 and 1"
        raise InputError(
            message, where=where, repair="all roots shall lie in |z| < radius: give a radius > 0, at most 1"
        )
    return StabilityBoundary(plant.variable, discrete=True, radius=found)
