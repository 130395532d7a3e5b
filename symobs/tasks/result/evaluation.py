"""A result at many points at once: its fields as NumPy arrays, with what holds in a case where a condition fails.

Where the value of a condition is too near to 0 for its rounding error, the point is decided, and its fields found,
exactly, each coordinate read as its shortest decimal.  This module is below the type of results, which therefore has
no name here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import EIGENVALUE, Matrix, Scalar
from symobs.exact.core.generators import NotWritten, substitute, symbols_in
from symobs.exact.floating.array_functions import ArrayFunction, at_points, evaluated, nested, shortest, sizes
from symobs.exact.floating.doubles import nearest_double
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, SymobsError
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.system.conditions import Condition

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
        words = "its answers are functions of t" if result.in_time else "its answers are polynomials or words"
        repair = "take sympy.lambdify on the field itself" if result.in_time else "read the fields themselves"
        raise InputError(f"{result.task} has no field of numbers: {words}", where="evaluate", repair=repair)
    given = _read(points, result, fields)
    arrays = np.broadcast_arrays(*given.values())
    shape = arrays[0].shape if given else ()
    flat = {name: np.ascontiguousarray(array.reshape(-1)) for name, array in zip(given, arrays, strict=True)}
    count = max((len(array) for array in flat.values()), default=1)
    values = np.full((sum(len(_entries(field)) for field in fields.values()), count), np.nan)
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
    own = _alike(result, fields)
    if own is not None and left.any():
        there = {name: array[left] for name, array in here.items()}
        entries = [entry for field in own for entry in _entries(field)]
        plain = not there or not any(entry.names for entry in entries)
        found = [[nearest_double(entry)] for entry in entries] if plain else ArrayFunction(entries)(there)
        values[:, where[left]] = found
    return np.concatenate(opened)


def _alike(result: Any, fields: Mapping[str, Any]) -> list[Any] | None:
    """Return the fields of a case; None where one is missing or of another shape."""
    own = [result.fields.get(name) for name in fields]
    shapes = [getattr(field, "shape", None) for field in fields.values()]
    if any(field is None or getattr(field, "shape", None) != shape for field, shape in zip(own, shapes, strict=True)):
        return None
    return own


def _all_hold(conditions: Iterable[Condition], result: Any, points: Mapping[str, Any], count: int) -> Any:
    """Return what is known of a conjunction at each point: the least that is known of its conditions."""
    import numpy as np

    apart = {result.plant.variable, "t", EIGENVALUE}
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
    apart = {result.plant.variable, "t"}
    return {
        name: value
        for name, value in result.fields.items()
        if (isinstance(value, int) and not isinstance(value, bool))
        or (isinstance(value, (Matrix, Scalar)) and not symbols_in(value) & apart)
    }


def _conditions(result: Any) -> Iterator[Condition]:
    """Yield all conditions of a result and of its cases."""
    yield from result.holds_where
    for case in result.case_tree:
        yield from case.when
        if case.result is not None:
            yield from _conditions(case.result)


def _entries(field: Any) -> tuple[Scalar, ...]:
    if isinstance(field, Matrix):
        return tuple(field.entries)
    return (Scalar.of(field),)


def _read(points: Mapping[Any, Any], result: Any, fields: Mapping[str, Any]) -> dict[str, Any]:
    """Return arrays of doubles by name; raises `InputError` for a parameter without a value, or a value that is none."""
    import numpy as np

    deciding = [condition.expression for condition in _conditions(result)]
    needed = set[str]().union(*map(symbols_in, [*(e for f in fields.values() for e in _entries(f)), *deciding]))
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


def _exactly(result: Any, fields: Mapping[str, Any], points: Mapping[str, Any], index: int) -> list[float]:
    """Return the entries of the fields at one point, exactly, from the case that applies there."""
    values = {name: Scalar.of(shortest(array[index])) for name, array in points.items()}
    there = _case_at(result, values)
    nothing = [float("nan")] * sum(len(_entries(field)) for field in fields.values())
    try:
        there = result.at(**values) if there is _UNDECIDED else there
        own = None if there is None else _alike(there, fields)
        if own is None:
            return nothing
        return [nearest_double(substitute(entry, values)) for field in own for entry in _entries(field)]
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
        own = values[start : start + len(_entries(field))].reshape(*size, *shape)
        found[name] = np.moveaxis(own, (0, 1), (-2, -1)) if size else own
        start += len(_entries(field))
    return found
