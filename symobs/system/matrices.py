"""The four exact matrices of a plant, and the check of their shapes; the functions of a nonlinear one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative, substitute, symbols_in
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch, SymobsError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class Matrices:
    """The four exact matrices of a plant; a missing one has no columns (B) or no rows (C)."""

    def __init__(self, A: Matrix, B: Matrix | None, C: Matrix | None, D: Matrix | None) -> None:
        """Complete missing matrices; D is zero.

        All have the same roots of numbers in their fields, and no symbol that occurs in none of them: a plant of numbers
        is one of numbers, whatever the transfer function was written in that it realises.
        """
        order = A.shape[0]
        self.A = A
        self.B = Matrix.zeros(order, 0) if B is None else B
        self.C = Matrix.zeros(0, order) if C is None else C
        self.D = Matrix.zeros(self.C.shape[0], self.B.shape[1]) if D is None else D
        self.has_input, self.has_output = B is not None, C is not None
        numbers = self.A.field.numbers | self.B.field.numbers | self.C.field.numbers | self.D.field.numbers
        if numbers.names:  # what factors over these numbers does so for every matrix
            self.A, self.B, self.C, self.D = (m.within(m.field | numbers) for m in (self.A, self.B, self.C, self.D))
        parts = self.A, self.B, self.C, self.D
        idle = (
            frozenset[str]().union(*(m.field.names for m in parts)).difference(numbers.names, *(m.names for m in parts))
        )
        if idle:
            self.A, self.B, self.C, self.D = (m.within(m.field.without(idle)) for m in parts)

    @property
    def has_feedthrough(self) -> bool:
        """Whether D is not zero."""
        return not self.D.is_zero

    @property
    def symbols(self) -> frozenset[str]:
        """The plain symbols of the entries, those inside functions too."""
        return symbols_in(self.A) | symbols_in(self.B) | symbols_in(self.C) | symbols_in(self.D)

    def __eq__(self, other: object) -> bool:
        return self._value == other._value if isinstance(other, Matrices) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.A, self.B, self.C))

    @property
    def _value(self) -> tuple[object, ...]:
        return self.A, self.B, self.C, self.D, self.has_input, self.has_output


def as_rows(name: str, value: Any) -> Any:
    """Return the rows of a matrix: a flat list is a column of B or a row of C or D, a number a 1×1 matrix."""
    if (
        value is None
        or isinstance(value, (str, Matrix, dict, set))
        or (hasattr(value, "shape") and len(value.shape) == 2)
    ):
        return value
    listed = value.tolist() if hasattr(value, "tolist") else value
    if not isinstance(listed, (list, tuple)):
        return [[value]]
    if name == "A" or any(isinstance(row, (list, tuple)) or getattr(row, "shape", ()) for row in listed):
        return value
    return [[entry] for entry in listed] if name == "B" else [list(listed)]


def shape_errors(parts: Mapping[str, Matrix | None]) -> list[SymobsError]:
    """Return the faults in the shapes of A, B, C and D; None stands for a matrix that is not given."""
    A, B, C, D = parts["A"], parts["B"], parts["C"], parts["D"]
    errors: list[SymobsError] = []

    def expect(name: str, wanted: str, came: Matrix) -> None:
        message = f"{name} is {came.shape[0]}×{came.shape[1]}, expected {wanted}"
        errors.append(
            ShapeMismatch(message, where=f"plant.{name}", repair=f"write {name} as {wanted.split(',', maxsplit=1)[0]}")
        )

    if A is None:
        return [InputError("A is missing", where="plant.A", repair='give the state matrix, for example "[0 1; 0 -1]"')]
    order = A.shape[0]
    if order == 0 or A.shape[1] != order:
        expect("A", "a square matrix", A)
        return errors
    if B is not None and (B.shape[0] != order or B.shape[1] == 0):
        expect("B", f"a matrix of {order} rows, one for each state", B)
    if C is not None and (C.shape[1] != order or C.shape[0] == 0):
        expect("C", f"a matrix of {order} columns, one for each state", C)
    if D is not None and not errors:
        rows, columns = (C.shape[0] if C is not None else 0), (B.shape[1] if B is not None else 0)
        if D.shape != (rows, columns):
            expect("D", f"a {rows}×{columns} matrix, outputs by inputs", D)
    return errors


@dataclass(frozen=True)
class Nonlinear:
    """A plant ẋ = f(x, u), y = h(x, u) (x(k+1) = f in discrete time) and an equilibrium of it, by name."""

    f: Matrix
    h: Matrix | None
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    equilibrium: tuple[tuple[str, Scalar], ...]

    def jacobian(self, function: Matrix, names: Sequence[str]) -> Matrix:
        """Return ∂ function / ∂ names, a column for each name."""
        return Matrix.block([[derivative(function, name) for name in names]])

    def there(self, value: Matrix) -> Matrix:
        """Return a matrix at the equilibrium; raises ZeroDivisionError where it is not defined there."""
        return substitute(value, dict(self.equilibrium))

    def moved(self, values: Mapping[str, Scalar]) -> Nonlinear:
        """Return the plant with parameters replaced."""
        point = tuple((name, substitute(value, values)) for name, value in self.equilibrium)
        f, h = substitute(self.f, values), None if self.h is None else substitute(self.h, values)
        return Nonlinear(f, h, self.states, self.inputs, point)
