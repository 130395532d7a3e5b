"""The values of an answer in the form that a task asks for: a list, a row or a column, without the letter in front."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.applications.checking.answers.definitions import value_of
from symobs.applications.checking.answers.lists import as_kernel, as_list, in_a_line
from symobs.applications.checking.answers.values import as_value
from symobs.exact import Complex, Matrix, Root, Scalar
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from symobs.tasks.result import Result
    from symobs.tasks.result.in_convention import ResultInConvention


def as_asked(view: ResultInConvention, letter: str, value: Any) -> Any:
    """Return a value without the letter that it defines; a list as the list, the row or the column that is asked for."""
    if isinstance(value, str) and (inside := value_of(letter, value)) != value:
        value = as_value(inside)
    name = view.standard(letter)[0]
    if is_listed(view, letter):
        return as_list(value)
    if name == "kernel":
        return as_kernel(value, view.plant.order)
    right = view.result.fields.get(name)
    shape = shape_of(view.result, name) if name in view.result.gains else getattr(right, "shape", None)
    return value if shape is None else in_a_line(value, shape)


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
