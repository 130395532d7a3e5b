"""The arithmetic of formulas: signals, and the operations on scalars, matrices and signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from symobs.exact import Matrix, Scalar, is_written_exactly
from symobs.formula.tree.nodes import Literal, Numeral, children, with_children
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.formula.tree.nodes import Formula


@dataclass
class Signal:
    """Σ coefficient · free signal, with `size` components; coefficients are matrices of the arithmetic in use."""

    size: int
    coefficients: Mapping[str, Any]


class Arithmetic(Protocol):
    """The operations of a formula on the scalars and matrices of one arithmetic."""

    def leaf(self, value: Scalar | Matrix) -> Any:
        """Convert an exact value to the arithmetic."""

    def shape(self, value: Any) -> tuple[int, int] | None:
        """Return a matrix's shape, None for a scalar."""

    def entry(self, value: Any) -> Any:
        """Return the entry of a 1×1 matrix as a scalar."""

    def add(self, left: Any, right: Any) -> Any:
        """Return left + right of equal kind and shape."""

    def scale(self, value: Any, factor: Any) -> Any:
        """Return a scalar or matrix times a scalar."""

    def matmul(self, left: Any, right: Any) -> Any:
        """Return the product of two matrices."""

    def invert(self, value: Any) -> Any:
        """Return the inverse of a scalar or matrix."""

    def transpose(self, value: Any) -> Any:
        """Return the transpose of a matrix."""

    def apply(self, function: str, value: Any) -> Any:
        """Return det, adj or rank of a matrix."""

    def block(self, rows: list[list[Any]]) -> Any:
        """Return the matrix of blocks."""

    def equal(self, left: Any, right: Any) -> bool:
        """Return whether two values of equal kind agree."""


def add(left: Any, right: Any, arithmetic: Arithmetic) -> Any:
    """Return the sum of two signals or values, a 1×1 matrix read as a scalar beside one."""
    if isinstance(left, Signal) and isinstance(right, Signal):
        total = dict(left.coefficients)
        for name, coefficient in right.coefficients.items():
            total[name] = arithmetic.add(total[name], coefficient) if name in total else coefficient
        return Signal(left.size, total)
    if arithmetic.shape(left) != arithmetic.shape(right):
        left, right = scalar(left, arithmetic), scalar(right, arithmetic)
    return arithmetic.add(left, right)


def times(left: Any, right: Any, arithmetic: Arithmetic) -> Any:
    """Return the product of a value with a value or a signal."""
    if isinstance(right, Signal):
        products = {name: times(left, value, arithmetic) for name, value in right.coefficients.items()}
        shape = arithmetic.shape(left)
        return Signal(right.size if shape is None else shape[0], products)
    left_shape, right_shape = arithmetic.shape(left), arithmetic.shape(right)
    if left_shape is None:
        return arithmetic.scale(right, left)
    if right_shape is None:
        return arithmetic.scale(left, right)
    if left_shape[1] == right_shape[0]:
        return arithmetic.matmul(left, right)
    if left_shape == (1, 1):
        return arithmetic.scale(right, arithmetic.entry(left))
    return arithmetic.scale(left, scalar(right, arithmetic))


def scalar(value: Any, arithmetic: Arithmetic) -> Any:
    """Return the entry of a 1×1 matrix, any other value unchanged."""
    if arithmetic.shape(value) == (1, 1):
        return arithmetic.entry(value)
    return value


# Equality of two values in any arithmetic.


def agree(left: Any, right: Any, arithmetic: Arithmetic) -> bool:
    """Return whether two values are equal, reading 1×1 matrices as scalars and missing signals as 0."""
    if isinstance(left, Signal) and isinstance(right, Signal):
        difference = add(left, times(arithmetic.leaf(Scalar.of(-1)), right, arithmetic), arithmetic)
        return all(
            arithmetic.equal(value, arithmetic.leaf(Matrix.zeros(*arithmetic.shape(value))))  # type: ignore[misc]
            for value in difference.coefficients.values()
        )
    left, right = _alike(left, right, arithmetic)
    return left is not None and arithmetic.equal(left, right)


def differ(left: Any, right: Any, arithmetic: Arithmetic) -> bool:
    """Return whether two values of one kind and shape differ; False if they are not comparable."""
    left, right = _alike(left, right, arithmetic)
    return left is not None and not arithmetic.equal(left, right)


def _alike(left: Any, right: Any, arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return two values in one kind and shape, 1×1 matrices as scalars; (None, None) if that is impossible."""
    if isinstance(left, Signal) or isinstance(right, Signal):
        return None, None
    if arithmetic.shape(left) != arithmetic.shape(right):
        left, right = scalar(left, arithmetic), scalar(right, arithmetic)
        if arithmetic.shape(left) != arithmetic.shape(right):
            return None, None
    return left, right


# Numerals on pages in decimals: rounded or exact, and the formula that one stands for.


def is_rounded(shown: Formula) -> bool:
    """Return whether a decimal in a formula is not exactly its number."""
    if isinstance(shown, Numeral):
        return not is_written_exactly(shown.value, shown.text)
    return any(map(is_rounded, children(shown)))


def exact_meaning(shown: Formula) -> Formula:
    """Return a formula with the exact number in place of each decimal."""
    if isinstance(shown, Numeral):
        return Literal(shown.value)
    return with_children(shown, tuple(map(exact_meaning, children(shown))))
