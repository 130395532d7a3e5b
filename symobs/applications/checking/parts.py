"""The parts of an answer: which a task asks for, and their values in the form that is asked for, a list, a row or a column."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers import (
    as_conditions,
    as_kernel,
    as_list,
    as_sizes,
    as_value,
    has_two_readings,
    in_a_line,
    value_of,
)
from symobs.applications.checking.handwriting import in_letters, readable, unit_matrix, with_commas, without_and
from symobs.exact import Complex, Matrix, Root, Scalar
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention


def as_asked(view: ResultInConvention, letter: str, value: Any) -> Any:
    """Return a value without the letter that it defines; a list as the list, the row or the column that is asked for."""
    if isinstance(value, str) and (inside := value_of(letter, value)) != value:
        value = as_value(inside)
    name = view.standard(letter)[0]
    if view.task == "equilibria" and name in {"points", "stable"}:
        return value
    if name == "conditions" or (name == "stable_if" and not hasattr(view.result, "critical")):
        return as_conditions(value)
    if isinstance(value, str):
        value = in_letters(value, *known_names(view))
    elif isinstance(value, list):
        value = [in_letters(entry, *known_names(view)) if isinstance(entry, str) else entry for entry in value]
    if name == "sizes":
        value = as_sizes(value, view.result.fields[name])
    if is_listed(view, letter):
        value = as_list(without_and(value))
        is_vector = name == "sizes" or all(isinstance(entry, Scalar) for entry in view.fields[name] or ())
        is_bare = isinstance(value, str) and "," in value and not has_two_readings(value)
        return value.split(",") if is_bare and is_vector else value
    if name == "kernel":
        return as_kernel(value, view.plant.order)
    right = view.result.fields.get(name)
    shape = shape_of(view.result, name) if name in view.result.gains else getattr(right, "shape", None)
    if shape is not None and shape[0] == shape[1] and isinstance(value, str) and "I" not in known_names(view)[0]:
        value = readable(re.sub(r"(?<![A-Za-z0-9_])I(?![A-Za-z0-9_])", unit_matrix(shape[0]), value))
    return value if shape is None else in_a_line(with_commas(value, shape[1]), shape)


def known_names(view: ResultInConvention) -> tuple[set[str], str]:
    """Return the names that an answer may use, and the variable among them."""
    parameters = getattr(getattr(view.result, "question", None), "parameters", ())
    variable = view.argument
    return {*view.plant.symbols.signs, *parameters, variable}, variable


def is_listed(view: ResultInConvention, letter: str) -> bool:
    """Return whether the right value is a list of numbers, which a text writes in brackets."""
    right = view.fields.get(view.standard(letter)[0])
    if not isinstance(right, (list, tuple)) or letter in {"kernel", "stable_if"}:
        return letter == "sizes"
    return all(isinstance(entry, (Scalar, Complex, Root)) for entry in right)


def two_readings() -> InputError:
    """Return the error of a comma between two digits that a decimal may be meant by."""
    return InputError(
        "commas set entries apart", repair="write 2.5 with a decimal point, and semicolons between: 0.5; 2.5"
    )


def shape_of(result: Result, name: str) -> tuple[int, int]:
    """Return the size of a gain."""
    right = result.fields.get(name)
    if isinstance(right, Matrix):
        return right.shape
    n, m, p = result.plant.order, result.plant.inputs, result.plant.outputs
    return (m, n) if name == "K" else (n - p, p) if result.has_reduced_observer else (n, p)


# -- what is asked for --------------------------------------------------------------------------------------------------


#: Letters that a derivation keeps for the plant, also where an answer has parts of these names.
OF_THE_PLANT = ("A", "B", "C", "D")


def asked_of(result: Result) -> tuple[str, ...]:
    """Return the fields that a task asks for; the verdict where there is nothing else to be found.

    Where it depends on parameters whether something is so, a rank or a verdict alone does not say for which.
    """
    asked = result.fields_asked(result.specification)
    there = tuple(name for name in asked if exists(result, name) or name in result.decimals)
    depends = result.verdict == "conditional" and {*there} <= {"rank"} and bool(result.holds_where)
    return (*(there or ("verdict",)), *(("conditions",) if depends else ()))


def part_of_task(name: str, views: Sequence[ResultInConvention]) -> tuple[str, str] | None:
    """Return the task and the field that a name with the task before or behind it means, P_lqr or lqr_P; None for others."""
    for view in views:
        for field in (name.removeprefix(f"{view.task}_"), name.removesuffix(f"_{view.task}")):
            if field != name and exists(view.result, field_called(view.result, view.standard(field)[0])):
                return view.task, field_called(view.result, view.standard(field)[0])
    return None


def field_called(result: Result, name: str) -> str:
    """Return the field that a page writes x(t), y(t) or exp(A t); another name as it is."""
    return result.called.get(re.sub(r"[\s*]", "", name), name)


def is_of_time(results: Iterable[Result], name: str) -> bool:
    """Return whether a name is that of a function of time, such as x(t), in one of the results."""
    return any(field_called(result, name) != name for result in results)


def exists(result: Result, name: str) -> bool:
    """Return whether a field has a value, or is the verdict."""
    return name in {"verdict", "conditions"} or result.fields.get(name) is not None
