"""A result at many points at once: its fields as NumPy arrays, with what holds in a case where a condition fails.

Where the value of a condition is too near to 0 for its rounding error, the point is decided, and its fields found,
exactly, each coordinate read as its shortest decimal.  This module is below the type of results, which therefore has
no name here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.errors import InputError, UsageError
from symobs.exact import EIGENVALUE, Matrix, Scalar
from symobs.exact.core.generators import NotWritten, substitute, symbols_in
from symobs.exact.floating.array_functions import ArrayFunction, at_points, evaluated, nested, shortest, sizes
from symobs.exact.floating.doubles import nearest_double
from symobs.expression.source import shown

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from symobs.conditions import Condition

#: A value below this part of the sum of its terms may be nothing but rounding error.
_ROUNDING = 2.0**-40
#: What a declared sign excludes.
_EXCLUDED: dict[str, Callable[[Any], Any]] = {
    "positive": lambda values: values <= 0,
    "negative": lambda values: values >= 0,
    "nonnegative": lambda values: values < 0,
    "nonpositive": lambda values: values > 0,
    "nonzero": lambda values: values == 0,
}
_HOLDS: dict[str, Callable[[Any], bool]] = {
    "==": lambda value: value == 0,
    "!=": lambda value: value != 0,
    ">": lambda value: value > 0,
    ">=": lambda value: value >= 0,
    "<": lambda value: value < 0,
    "<=": lambda value: value <= 0,
}


def evaluate(result: Any, points: Mapping[Any, Any]) -> dict[str, Any]:
    """Return one array for each field of numbers at arrays of points, as `Result.evaluate` says."""
    try:
        import numpy as np
    except ImportError:
        message = "evaluating at arrays of points needs NumPy, which is not installed"
        raise UsageError(message, repair="pip install numpy, or use .at(...) for one point") from None
    fields = _fields(result)
    if not fields:
        words = "its answers are functions of t" if result.in_time else "its answers are polynomials or words"
        repair = "take sympy.lambdify on the field itself" if result.in_time else "read the fields themselves"
        raise InputError(f"{result.task} has no field of numbers: {words}", where="evaluate", repair=repair)
    given = _read(points, result, fields)
    arrays = np.broadcast_arrays(*given.values()) if given else [np.zeros(())]
    shape = arrays[0].shape
    flat = {name: np.ascontiguousarray(array.reshape(-1)) for name, array in zip(given, arrays, strict=True)}
    entries = [entry for field in fields.values() for entry in _entries(field)]
    values = ArrayFunction(entries)(flat) if flat else np.array([[nearest_double(entry)] for entry in entries])
    outside = _outside(result, flat)
    values[:, outside] = np.nan
    for index in np.flatnonzero(_doubtful(_decisive(result), flat) & ~outside):
        values[:, index] = _exactly(result, fields, flat, int(index))
    return _shaped(fields, values, shape)


def _fields(result: Any) -> dict[str, Any]:
    """Return the fields of numbers: matrices, scalars and integers without time or the variable of polynomials."""
    apart = {result.plant.variable, "t"}
    return {
        name: value
        for name, value in result.fields.items()
        if (isinstance(value, int) and not isinstance(value, bool))
        or (isinstance(value, (Matrix, Scalar)) and not symbols_in(value) & apart)
    }


def _decisive(result: Any) -> list[Scalar]:
    """Return what must not vanish where the result holds without a look at its cases."""
    apart = {result.plant.variable, "t", EIGENVALUE}
    values = dict.fromkeys([*(condition.expression for condition in result.holds_where), *result.existence])
    return [value for value in values if not symbols_in(value) & apart]


def _entries(field: Any) -> tuple[Scalar, ...]:
    if isinstance(field, Matrix):
        return tuple(field.entries)
    return (Scalar.of(field),)


def _read(points: Mapping[Any, Any], result: Any, fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays of doubles by name; raises `InputError` for a parameter without a value, or a value that is none."""
    import numpy as np

    needed = set().union(
        *map(symbols_in, [*(e for field in fields.values() for e in _entries(field)), *_decisive(result)])
    )
    needed -= {"pi"}
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
    return {name: found[name] for name in found if name in needed}


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


def _doubtful(decisive: Iterable[Scalar], points: Mapping[str, Any]) -> Any:
    """Return where one of the values that decide may be 0, its rounding error taken into account."""
    import numpy as np

    count = max((len(array) for array in points.values()), default=1)
    doubtful = np.zeros(count, dtype=bool)
    for value in decisive:
        polynomial = nested(value.numerator)
        here = {name: at_points(name, points) for name in value.names}
        with np.errstate(all="ignore"):
            doubtful |= ~(np.abs(evaluated(polynomial, here)) > _ROUNDING * sizes(polynomial, here))
    return doubtful


def _exactly(result: Any, fields: Mapping[str, Any], points: Mapping[str, Any], index: int) -> list[float]:
    """Return the entries of the fields at one point, exactly, from the case that applies there."""
    values = {name: Scalar.of(shortest(array[index])) for name, array in points.items()}
    there = _case_at(result, values)
    found: list[float] = []
    for name, field in fields.items():
        own = None if there is None else there.fields.get(name)
        size = len(_entries(field))
        shape = getattr(field, "shape", None)
        if own is None or getattr(own, "shape", None) != shape:
            found += [float("nan")] * size
            continue
        try:
            found += [nearest_double(substitute(entry, values)) for entry in _entries(own)]
        except (ZeroDivisionError, NotWritten, ValueError):
            found += [float("nan")] * size
    return found


def _case_at(result: Any, values: Mapping[str, Scalar]) -> Any:
    """Return the result that holds at a point: this one, that of a case, or of a case of it; None if none does."""
    if not all(_holds(condition, values) for condition in result.domain):
        return None
    for case in result.case_tree:
        if all(_holds(condition, values) for condition in case.when):
            return None if case.result is None else _case_at(case.result, values)
    return result if all(_holds(condition, values) for condition in result.holds_where) else None


def _holds(condition: Condition, values: Mapping[str, Scalar]) -> bool:
    """Return whether a condition holds at a point; where its value has no number, it does not."""
    try:
        value = substitute(condition.expression, dict(values))
    except (ZeroDivisionError, NotWritten):
        return False
    return value.is_constant and _HOLDS["==" if condition.operator == "=" else condition.operator](value.fraction())


def _shaped(fields: Mapping[str, Any], values: Any, shape: tuple[int, ...]) -> dict[str, Any]:
    """Return the arrays of the fields: a matrix has its rows and columns behind the shape of the points."""
    import numpy as np

    found: dict[str, Any] = {}
    start = 0
    for name, field in fields.items():
        size = getattr(field, "shape", ())
        own = values[start : start + len(_entries(field))].reshape(*size, *shape)
        found[name] = np.moveaxis(own, (0, 1), (-2, -1)) if size else own
        start += len(_entries(field))
    return found
