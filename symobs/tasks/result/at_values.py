"""A result at values of its parameters: the same question for the plant that they leave, asked and checked anew.

This module is below the type of results, which therefore has no name here.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import symobs
from symobs.exact import Complex, Matrix, Scalar
from symobs.exact.core.generators import substitute, symbols_in
from symobs.formula.expression import parse_matrix, parse_polynomial
from symobs.formula.expression.source import shown
from symobs.ground.errors import CertificateRejected, InputError, ProblemErrors, together
from symobs.system import StateSpace, read_matrix, read_scalar
from symobs.system.reading import has_decimals, inserted, read_values
from symobs.system.specification import is_pattern, parse_signal, read_names, read_pattern, read_poles
from symobs.system.specification.pole_patterns import OTHERS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

#: The gains that are a choice among many where there are several inputs or outputs: the value of the one that was chosen.
_CHOSEN = ("K", "L")


#: What a task takes where a keyword of some kind is not given.
_UNSAID = {"Horizon": "T"}


def at_values(result: Any, given: Mapping[Any, Any]) -> Any:
    """Return the result of the same task at these values, with the values of its gains where they still serve."""
    task, plant = getattr(symobs, result.task), result.plant
    if plant.is_stratum:
        message = "this is what holds in one case of a result"
        raise InputError(message, where="at", repair="give the values to the result itself")
    read = {
        name: _READERS[kind](asked, plant, f"specification.{name}")
        for name, kind in task.kinds.items()
        if kind in _READERS and (asked := result.specification.get(name, _UNSAID.get(kind))) is not None
    }
    values = _values(given, plant, {name for value in read.values() for name in _names(value)})
    if not values:
        return result
    there = _plant(plant, values)
    there.is_in_decimals = there.is_in_decimals or has_decimals([*given.values()])
    moved = {name: _moved(value, values) for name, value in read.items() if values.keys() & _names(value)}
    return _with_chosen(result, task(there, **{**result.specification, **moved}), values)


def _values(given: Mapping[Any, Any], plant: StateSpace, asked: set[str]) -> dict[str, Scalar]:
    """Return exact values by name; raises `InputError` for what is no parameter, or what its sign excludes."""
    known = {*plant.matrices.symbols, *plant.symbols.signs, *asked} - {plant.variable, "t"}
    symbols, names = plant.symbols.seen(list(given.values())), {name for name in known if name.isidentifier()}
    try:
        read = together(*(partial(read_values, {name: value}, symbols, names) for name, value in given.items()))
    except InputError as raised:
        for error in raised.errors if isinstance(raised, ProblemErrors) else (raised,):
            error.where = error.where.replace("substitute.", "values.")
            error.message = error.message.replace("no parameter of the plant", "no parameter of the problem")
        raise
    return inserted({name: value for one in read for name, value in one.items()})


def _plant(plant: StateSpace, values: dict[str, Scalar]) -> StateSpace:
    """Return the plant at these values; in its page they do not occur any more."""
    try:
        there = plant.substitute(values)
    except ZeroDivisionError:
        shown_values = ", ".join(f"{name} = {value}" for name, value in values.items())
        message = f"there is no plant at {shown(shown_values, 80)}: a denominator of its data is 0"
        raise InputError(message, where="values", repair="give values where the data are defined") from None
    if plant.polynomial is not None:
        polynomial = substitute(plant.polynomial, values)
        there = StateSpace.from_polynomial(polynomial, plant.dt, symbols=there.symbols)
    elif plant.origin is not None:
        written = StateSpace.from_transfer_function(substitute(plant.origin, values), plant.dt, symbols=there.symbols)
        there = written if written.matrices == there.matrices else there
    elif plant.nonlinear is not None:
        there.nonlinear = plant.nonlinear.moved(values)
    kept = {name for value in values.values() for name in value.names}
    left = {name: sign for name, sign in there.symbols.signs.items() if name in kept or name not in values}
    there = there.with_symbols(replace(there.symbols, signs=left))
    there.is_from_floats, there.is_in_decimals = plant.is_from_floats, plant.is_in_decimals
    return there


def _with_chosen(result: Any, found: Any, values: dict[str, Scalar]) -> Any:
    """Return the found result with the gains that were chosen, which its constructor checks, where they serve here."""
    for letter in _CHOSEN:
        chosen, here = result.answer.get(letter), found.answer.get(letter)
        if not isinstance(chosen, Matrix) or not isinstance(here, Matrix):
            continue
        try:
            kept = substitute(chosen, values)
            found = found if kept == here or not found.plant.admits(kept) else found.with_answer(letter, kept)
        except (ZeroDivisionError, CertificateRejected):  # it divides by zero here, or serves in general only
            continue
    return found


# -- what a specification contains -----------------------------------------------------------------------------------


def _entries(value: object, plant: StateSpace, where: str) -> Matrix:
    return read_matrix(value, plant.symbols.seen(value), where, functions=True)


def _polynomial(value: object, plant: StateSpace, where: str) -> Scalar:
    if isinstance(value, str):
        return parse_polynomial(value, plant.variable, plant.symbols.names, where=where, functions=True)
    return read_scalar(value, plant.symbols.seen(value, plant.variable), where, functions=True)


def _poles(value: object, plant: StateSpace, where: str) -> tuple[Complex, ...] | dict[str, Any]:
    if is_pattern(value):
        named, others = read_pattern(value, plant, where)
        return {**named, **({OTHERS: others} if others else {})}
    return read_poles(value, plant.symbols.seen(value), where, plant.variable)


def _signal(value: object, plant: StateSpace, where: str) -> Matrix:
    return parse_signal(value, plant.symbols, where, functions=True)


def _quantity(value: object, plant: StateSpace, where: str) -> object:
    """Return a quantity, or the word that stands for one: the horizon inf."""
    return value if value == "inf" else read_scalar(value, plant.symbols.seen(value), where)


def _intensity(value: object, plant: StateSpace, where: str) -> Matrix | Scalar:
    if isinstance(value, str):
        return parse_matrix(value, plant.symbols.names, where=where)
    return _entries(value, plant, where) if hasattr(value, "__len__") else read_scalar(value, plant.symbols, where)


def _listed(value: object, _: StateSpace, where: str) -> frozenset[str]:
    return frozenset(read_names(value, where.removeprefix("specification.")))


#: How the parts of a specification are read in which parameters may occur, by the kind of keyword.
_READERS: dict[str, Callable[[Any, StateSpace, str], Any]] = {
    "Poles": _poles,
    "PolynomialText": _polynomial,
    "GainText": _entries,
    "MatrixText": _entries,
    "IntervalText": _poles,
    "SignalText": _signal,
    "TimeFunctions": _signal,
    "Intensity": _intensity,
    "Horizon": _quantity,
    "Quantity": _quantity,
    "Names": _listed,
}


def _names(value: Any) -> set[str]:
    """Return the symbols in a part of a specification."""
    if isinstance(value, frozenset):
        return set(value)
    if isinstance(value, dict):
        return {name for part in value.values() for name in _names(part)}
    if isinstance(value, tuple):
        return {name for pole in value for part in (pole.real, pole.imaginary) for name in symbols_in(part)}
    return {*symbols_in(value)} if isinstance(value, Scalar | Matrix) else set()


def _moved(value: Any, values: dict[str, Scalar]) -> Any:
    """Return a part of a specification at these values, as a task reads it."""
    if isinstance(value, frozenset):
        return sorted(value - values.keys())
    if isinstance(value, dict):
        return {name: _moved(part, values) for name, part in value.items()}
    if isinstance(value, tuple):
        return [str(Complex(substitute(p.real, values), substitute(p.imaginary, values))) for p in value]
    if isinstance(value, Matrix):
        return [[str(entry) for entry in row] for row in substitute(value, values).rows]
    return str(substitute(value, values))
