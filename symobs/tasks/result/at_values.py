"""A result at values of its parameters: the same question for the plant that they leave, asked and checked anew.

This module is below the type of results, which therefore has no name here.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import symobs
from symobs.exact import EIGENVALUE, Complex, Matrix, Scalar
from symobs.exact.core.generators import NotWritten, substitute, symbols_in
from symobs.exact.floating.rounding_errors import CertainFunction
from symobs.exact.floating.sampled import at_points, evaluated, nearest_double, nested, shortest, sizes
from symobs.formula.expression import parse_matrix, parse_polynomial
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, together
from symobs.system import StateSpace, read_matrix, read_scalar
from symobs.system.conditions import sign_of
from symobs.system.reading import has_decimals, inserted, read_values
from symobs.system.specification import (
    from_list,
    is_pattern,
    parse_in_steps,
    parse_signal,
    read_names,
    read_pattern,
    read_poles,
)
from symobs.system.specification.pole_patterns import OTHERS
from symobs.system.transfer_function_text import read_transfer_function

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.system.conditions import Condition


_T = TypeVar("_T")

#: The keywords for which a flat list is a row; it is a column for the others.
_ROWS = {"K", "reference"}
#: What a task takes where a keyword of some kind is not given.
_UNSAID = {"Horizon": Scalar.symbol("T")}


def at_values(result: Any, given: Mapping[Any, Any]) -> Any:
    """Return the result of the same task at these values, with the values of its gains where they still serve."""
    task, plant = getattr(symobs, result.task), result.plant
    if plant.is_stratum:
        message = "this is what holds in one case of a result"
        raise InputError(message, where="at", repair="give the values to the result itself")
    read = {
        name: _READERS[kind](asked, plant, f"specification.{name}")
        for name, kind in task.kinds.items()
        if kind in _READERS and (asked := result.specification.get(name)) is not None
    }
    unsaid = {name: _UNSAID[kind] for name, kind in task.kinds.items() if kind in _UNSAID and not plant.is_discrete}
    read = {**unsaid, **read}
    values = _values(given, plant, {name for value in read.values() for name in _names(value)})
    if not values:
        return result
    there = _defined(lambda: _plant(plant, values), values)
    there.is_in_decimals = there.is_in_decimals or has_decimals([*given.values()])
    used = {name: value for name, value in read.items() if values.keys() & _names(value)}
    moved = _defined(lambda: {name: _moved(value, values) for name, value in used.items()}, values)
    return task(there, **{**result.specification, **moved}).with_gains_of(result, values)


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


def _defined(part: Callable[[], _T], values: dict[str, Scalar]) -> _T:
    """Return a part of the problem at these values; raises `InputError` where it has none."""
    try:
        return part()
    except ZeroDivisionError:
        shown_values = ", ".join(f"{name} = {value}" for name, value in values.items())
        message = f"the problem is not defined at {shown(shown_values, 80)}: a denominator of its data is 0"
        raise InputError(message, where="values", repair="give values where the data are defined") from None


def _plant(plant: StateSpace, values: dict[str, Scalar]) -> StateSpace:
    """Return the plant at these values; in its page they do not occur any more."""
    there = plant.substitute(values)
    if plant.polynomial is not None:
        polynomial = substitute(plant.polynomial, values)
        there = StateSpace.from_polynomial(polynomial, there.dt, symbols=there.symbols)
    elif plant.origin is not None:
        kind, origin = getattr(plant.written, "realisation", None), substitute(plant.origin, values)
        if plant.variable in symbols_in(origin):  # where all poles cancel, the states stay and the function has none
            written = StateSpace.from_transfer_function(origin, there.dt, symbols=there.symbols, realisation=kind)
            there = written if written.matrices == there.matrices else there
    elif plant.nonlinear is not None:
        there.nonlinear = plant.nonlinear.moved(values)
    kept = {name for value in values.values() for name in value.names}
    left = {name: sign for name, sign in there.symbols.signs.items() if name in kept or name not in values}
    there = there.with_symbols(replace(there.symbols, signs=left))
    there.is_from_floats, there.is_in_decimals = plant.is_from_floats, plant.is_in_decimals
    there.general = plant.general or plant
    return there


# -- what a specification contains -----------------------------------------------------------------------------------


def _entries(value: object, plant: StateSpace, where: str) -> Matrix:
    value = from_list(value, column=where.rpartition(".")[2] not in _ROWS)
    return read_matrix(value, plant.symbols.seen(value), where, functions=True)


def _polynomial(value: object, plant: StateSpace, where: str) -> Scalar:
    if isinstance(value, str):
        return parse_polynomial(value, plant.variable, plant.symbols.names, where=where, functions=True)
    return read_scalar(value, plant.symbols.seen(value, plant.variable), where, functions=True)


def _rational(value: object, plant: StateSpace, where: str) -> Scalar:
    return read_transfer_function(value, plant.symbols, plant.variable, where).value


def _poles(value: object, plant: StateSpace, where: str) -> tuple[Complex, ...] | dict[str, Any]:
    if is_pattern(value):
        named, others = read_pattern(value, plant, where)
        return {**named, **({OTHERS: others} if others else {})}
    return read_poles(value, plant.symbols.seen(value), where, plant.variable)


def _signal(value: object, plant: StateSpace, where: str) -> Matrix:
    if plant.is_discrete:
        return parse_in_steps(value, plant.symbols, where)
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
    "TransferFunctionText": _rational,
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
        return [[_written(entry) for entry in row] for row in substitute(value, values).rows]
    return str(substitute(value, values))


def _written(entry: Scalar) -> str:
    """Return an entry as it is read: c^k at c = 0, which is KroneckerDelta(k, 0), as 0^k."""
    return str(entry).replace("KroneckerDelta(k, 0)", "0**k")


# A result at many points at once: its fields as NumPy arrays, with what holds in a case where a condition fails.
#
# Where the value of a condition is too near to 0 for its rounding error, the point is decided, and its fields found,
# exactly, each coordinate read as its shortest decimal. This module is below the type of results, which therefore has
# no name here.


#: A value below this part of the sum of its terms may be nothing but rounding error.
_ROUNDING = 2.0**-40
#: In place of a case about which nothing is known.
_UNDECIDED = object()


#: What a declared sign excludes.
_EXCLUDED: dict[str, Callable[[Any], Any]] = {
    "positive": lambda values: values <= 0,
    "negative": lambda values: values >= 0,
    "nonnegative": lambda values: values < 0,
    "nonpositive": lambda values: values > 0,
    "nonzero": lambda values: values == 0,
}


#: The certain signs for which a condition holds, and those for which it fails.
_SIGNS = {
    "==": ({"zero"}, {"positive", "negative", "nonzero"}),
    "!=": ({"positive", "negative", "nonzero"}, {"zero"}),
    ">": ({"positive"}, {"zero", "negative", "nonpositive"}),
    ">=": ({"positive", "zero", "nonnegative"}, {"negative"}),
    "<": ({"negative"}, {"zero", "positive", "nonnegative"}),
    "<=": ({"negative", "zero", "nonpositive"}, {"positive"}),
}


#: What is known of a condition at a point in double precision.
_FAILS, _OPEN, _HOLDS = -1, 0, 1


def evaluate(result: Any, points: Mapping[Any, Any]) -> dict[str, Any]:
    """Return one array for each field of numbers at arrays of points, as `Result.evaluate` says."""
    import numpy as np

    fields = _fields(result)
    if not fields:
        words = (
            f"its answers are functions of {result.argument}"
            if result.in_time
            else "its answers are polynomials or words"
        )
        repair = "take sympy.lambdify on the field itself" if result.in_time else "read the fields themselves"
        raise InputError(f"{result.task} has no field of numbers: {words}", where="evaluate", repair=repair)
    given = _read(points, result, fields)
    arrays = np.broadcast_arrays(*given.values())
    shape = arrays[0].shape if given else ()
    flat = {name: np.ascontiguousarray(array.reshape(-1)) for name, array in zip(given, arrays, strict=True)}
    count = max((len(array) for array in flat.values()), default=1)
    values = np.full((sum(len(_scalars_of(field)) for field in fields.values()), count), np.nan)
    inside = np.flatnonzero(~_outside(result, flat))
    for index in _fill(result, fields, flat, inside, values):
        values[:, index] = _exactly(result, fields, flat, int(index))
    return _shaped(fields, values, shape)


def _fill(result: Any, fields: Mapping[str, Any], points: Mapping[str, Any], where: Any, values: Any) -> Any:
    """Write the fields at some of the points from the case that holds there; return the points that stay open."""
    import numpy as np

    here = {name: array[where] for name, array in points.items()}
    left = np.ones(len(where), dtype=bool)
    opened = [where[:0]]
    for case in result.case_tree:
        known = _all_hold(case.when, result, here, len(where)) if case.when else np.full(len(where), _OPEN)
        opened.append(where[left & (known == _OPEN)])
        if case.result is not None:
            opened.append(_fill(case.result, fields, points, where[left & (known == _HOLDS)], values))
        left &= known == _FAILS
    known = _all_hold(result.holds_where, result, here, len(where))
    opened.append(where[left & (known == _OPEN)])
    left &= known == _HOLDS
    if left.any():
        there = {name: array[left] for name, array in here.items()}
        entries = _entries_of(result, fields)
        known = [index for index, entry in enumerate(entries) if entry is not None]
        found = [entry for entry in entries if entry is not None]
        plain = not there or not any(entry.names for entry in found)
        if found:
            numbers = [[nearest_double(entry)] for entry in found] if plain else CertainFunction(found)(there)
            values[np.ix_(known, where[left])] = numbers
    return np.concatenate(opened)


def _entries_of(result: Any, fields: Mapping[str, Any]) -> list[Scalar | None]:
    """Return the entries of the fields of a case; None for those of a field that is missing there or has another shape."""
    apart, found = _apart(result), list[Scalar | None]()
    for name, field in fields.items():
        own = result.numbers.get(name)
        alike = own is not None and getattr(own, "shape", None) == getattr(field, "shape", None)
        alike = alike and not (isinstance(own, (Matrix, Scalar)) and symbols_in(own) & apart)
        found += _scalars_of(own) if alike else [None] * len(_scalars_of(field))
    return found


def _all_hold(conditions: Iterable[Condition], result: Any, points: Mapping[str, Any], count: int) -> Any:
    """Return what is known of a conjunction at each point: the least that is known of its conditions."""
    import numpy as np

    apart = _apart(result) | {EIGENVALUE}
    known = np.full(count, _HOLDS)
    for condition in conditions:
        if not symbols_in(condition.expression) & apart:
            known = np.minimum(known, _known(condition, points))
    return known


def _known(condition: Condition, points: Mapping[str, Any]) -> Any:
    """Return whether a condition holds at each point; it is open where rounding errors could decide it."""
    import numpy as np

    operator = "==" if condition.operator == "=" else condition.operator
    signs, near = [], False
    with np.errstate(all="ignore"):
        for part in (condition.expression.numerator, condition.expression.denominator):
            polynomial, here = nested(part), {name: at_points(name, points) for name in part.names}
            value = evaluated(polynomial, here)
            near |= ~(np.abs(value) > _ROUNDING * sizes(polynomial, here))
            signs.append(np.sign(value))
    positive = signs[0] * signs[1] > 0
    holds = np.where(positive, "positive" in _SIGNS[operator][0], "negative" in _SIGNS[operator][0])
    return np.where(near, _OPEN, np.where(holds, _HOLDS, _FAILS))


def _fields(result: Any) -> dict[str, Any]:
    """Return the fields of numbers: matrices, scalars and integers without time or the variable of polynomials."""
    apart = _apart(result)
    return {
        name: value
        for name, value in result.numbers.items()
        if (isinstance(value, int) and not isinstance(value, bool))
        or (isinstance(value, (Matrix, Scalar)) and not symbols_in(value) & apart)
    }


def _apart(result: Any) -> set[str]:
    """Return the variables of polynomials and functions, with the ends of the interval of a time-varying plant."""
    ends = {"t0", "t1"} if result.plant.is_time_varying else set[str]()
    return {result.plant.variable, "t", result.argument} | ends


def _conditions(result: Any) -> Iterator[Condition]:
    """Yield all conditions of a result and of its cases."""
    yield from result.holds_where
    for case in result.case_tree:
        yield from case.when
        if case.result is not None:
            yield from _conditions(case.result)


def _scalars_of(field: Any) -> tuple[Scalar, ...]:
    if isinstance(field, Matrix):
        return tuple(field.entries)
    return (Scalar.of(field),)


def _read(points: Mapping[Any, Any], result: Any, fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays of doubles by name; raises `InputError` for a parameter without a value, or a value that is none."""
    import numpy as np

    deciding = [condition.expression for condition in _conditions(result)]
    needed = set[str]().union(*map(symbols_in, [*(e for f in fields.values() for e in _scalars_of(f)), *deciding]))
    needed -= {"pi", result.plant.variable, "t", EIGENVALUE}
    found: dict[str, Any] = {}
    for key, value in points.items():
        name = str(getattr(key, "name", key))
        if name not in needed | result.symbols.keys() | result.plant.symbols.signs.keys():
            message = f"{shown(name, 40)} is no parameter of the result"
            known = f"use {', '.join(sorted(needed))}" if needed else f"it has none: leave {shown(name, 40)} out"
            raise InputError(message, where="evaluate", repair=known)
        try:
            found[name] = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            message = f"the values of {shown(name, 40)} are no array of real numbers"
            raise InputError(message, where="evaluate", repair="give numbers, or a NumPy array of them") from None
    if missing := sorted(needed - found.keys()):
        message = f"{', '.join(missing)} {'has' if len(missing) == 1 else 'have'} no value"
        repair = f'give one for each: evaluate({{"{missing[0]}": 1.0, …}}), or set it before: .at({missing[0]}=1)'
        raise InputError(message, where="evaluate", repair=repair)
    try:
        np.broadcast_shapes(*(array.shape for array in found.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in found.items())
        message = f"the arrays do not fit together: {shapes}"
        raise InputError(message, where="evaluate", repair="give arrays that broadcast to one shape") from None
    return found


def _outside(result: Any, points: Mapping[str, Any]) -> Any:
    """Return where a value is not finite, or has a sign that is not the declared one."""
    import numpy as np

    count = max((len(array) for array in points.values()), default=1)
    outside = np.zeros(count, dtype=bool)
    for name, values in points.items():
        outside |= ~np.isfinite(values)
        if (excluded := _EXCLUDED.get(result.plant.symbols.sign(name))) is not None:
            outside |= excluded(values)
    return outside


def _exactly(result: Any, fields: Mapping[str, Any], points: Mapping[str, Any], index: int) -> list[float]:
    """Return the entries of the fields at one point, exactly, from the case that applies there."""
    values = {name: Scalar.of(shortest(array[index])) for name, array in points.items()}
    there = _case_at(result, values)
    nothing = [float("nan")] * sum(len(_scalars_of(field)) for field in fields.values())
    try:
        there = result.at(**values) if there is _UNDECIDED else there
        if there is None:
            return nothing
        entries = _entries_of(there, fields)
        return [nothing[0] if entry is None else nearest_double(substitute(entry, values)) for entry in entries]
    except (ZeroDivisionError, NotWritten, ValueError, SymobsError):
        return nothing


def _case_at(result: Any, values: Mapping[str, Scalar]) -> Any:
    """Return the result that holds at a point: this one, that of a case, or of a case of it; None if none does."""
    holds = _hold(result.domain, values)
    if not holds:
        return None if holds is False else _UNDECIDED
    for case in result.case_tree:
        holds = _hold(case.when, values) if case.when else None
        if holds is None:
            return _UNDECIDED
        if holds:
            return _UNDECIDED if case.result is None else _case_at(case.result, values)
    holds = _hold(result.holds_where, values)
    return result if holds else None if holds is False else _UNDECIDED


def _hold(conditions: Iterable[Condition], values: Mapping[str, Scalar]) -> bool | None:
    """Return whether conditions hold at a point, None where that is not known; without a value a condition fails."""
    known: bool | None = True
    for condition in conditions:
        try:
            sign = sign_of(substitute(condition.expression, dict(values)), {})
        except ZeroDivisionError:
            return False
        except NotWritten:
            sign = "real"
        holding, failing = _SIGNS["==" if condition.operator == "=" else condition.operator]
        if sign in failing:
            return False
        known = known if sign in holding else None
    return known


def _shaped(fields: Mapping[str, Any], values: Any, shape: tuple[int, ...]) -> dict[str, Any]:
    """Return the arrays of the fields: a matrix has its rows and columns behind the shape of the points."""
    import numpy as np

    found: dict[str, Any] = {}
    start = 0
    for name, field in fields.items():
        size = getattr(field, "shape", ())
        own = values[start : start + len(_scalars_of(field))].reshape((*size, *shape))
        found[name] = np.moveaxis(own, (0, 1), (-2, -1)) if size else own
        start += len(_scalars_of(field))
    return found
