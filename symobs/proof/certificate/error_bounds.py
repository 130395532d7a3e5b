"""Error bounds of the randomised check: degrees and heights propagated through formulas (trusted)."""

from __future__ import annotations

from math import log2
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Matrix, Scalar
from symobs.exact.core.modular import POINT_BITS, squares_of

if TYPE_CHECKING:
    from symobs.formula.tree import Environment, Modular


class SizeBound(NamedTuple):
    """The size of a rational function: degrees and log₂ of the lengths of its two parts; shape of a matrix."""

    above: float
    below: float
    above_bits: float
    below_bits: float
    shape: tuple[int, int] | None = None


class Bounds:
    """The arithmetic of sizes: bounds for degree and height of the value of a formula.

    Heights are those of the integers the leaves became at the point.  Named coefficients are rational there, and roots
    of numbers have conjugates, so with them the heights are bounded through the coefficients of the leaves instead.
    """

    def __init__(self, environment: Environment, arithmetic: Modular) -> None:
        """Bound the values of named coefficients in the order of their definition."""
        self.arithmetic = arithmetic
        self.named = bool(environment.coefficients) or bool(squares_of(arithmetic.point.values))
        degrees: dict[str, float] = {}
        bits: dict[str, float] = {}
        for name, meaning in environment.coefficients.items():
            above, below = meaning.degrees()
            growth = max((degrees[other] for other in meaning.names if other in degrees), default=1.0)
            length = max((bits[other] for other in meaning.names if other in bits), default=float(POINT_BITS))
            degrees[name] = max(1.0, (above + below) * growth)
            bits[name] = sum(meaning.lengths()) + (above + below) * max(length, POINT_BITS)
        self.larger = max(degrees.values(), default=1.0)
        squares = squares_of(arithmetic.point.values).values()
        self.longer = max([*bits.values(), POINT_BITS, *(square.bit_length() for square in squares)])

    def leaf(self, value: Scalar | Matrix) -> SizeBound:
        above, below = value.degrees()
        shape = value.shape if isinstance(value, Matrix) else None
        if not self.named and id(value) in self.arithmetic.known:
            return SizeBound(above, below, *self.arithmetic.point.bits[id(value)], shape)
        above_bits, below_bits = value.lengths()
        grown = (above + below) * self.longer
        degree = (above + below) * self.larger
        return SizeBound(degree, degree, above_bits + grown, below_bits + grown, shape)

    def shape(self, value: SizeBound) -> tuple[int, int] | None:
        return value.shape

    def entry(self, value: SizeBound) -> SizeBound:
        return SizeBound(value.above, value.below, value.above_bits, value.below_bits)

    def add(self, left: SizeBound, right: SizeBound) -> SizeBound:
        return SizeBound(
            max(left.above + right.below, right.above + left.below),
            left.below + right.below,
            1 + max(left.above_bits + right.below_bits, right.above_bits + left.below_bits),
            left.below_bits + right.below_bits,
            left.shape,
        )

    def scale(self, value: SizeBound, factor: SizeBound) -> SizeBound:
        return SizeBound(
            value.above + factor.above,
            value.below + factor.below,
            value.above_bits + factor.above_bits,
            value.below_bits + factor.below_bits,
            value.shape,
        )

    def matmul(self, left: SizeBound, right: SizeBound) -> SizeBound:
        inner, outer = left.shape or (1, 1), right.shape or (1, 1)
        product = self.scale(left, right)
        return SizeBound(
            product.above,
            product.below,
            product.above_bits + log2(max(inner[1], 1)),
            product.below_bits,
            (inner[0], outer[1]),
        )

    def _determinant(self, value: SizeBound, order: int) -> SizeBound:
        return SizeBound(
            order * value.above,
            order * value.below,
            order * (value.above_bits + log2(max(order, 1))),
            order * value.below_bits,
        )

    def invert(self, value: SizeBound) -> SizeBound:
        if value.shape is None:
            return SizeBound(value.below, value.above, value.below_bits, value.above_bits)
        whole = self._determinant(value, value.shape[0])
        return SizeBound(
            whole.above + whole.below,
            whole.above + whole.below,
            whole.above_bits + whole.below_bits,
            whole.above_bits + whole.below_bits,
            value.shape,
        )

    def transpose(self, value: SizeBound) -> SizeBound:
        rows, columns = value.shape or (1, 1)
        return SizeBound(value.above, value.below, value.above_bits, value.below_bits, (columns, rows))

    def apply(self, function: str, value: SizeBound) -> SizeBound:
        rows, columns = value.shape or (1, 1)
        whole = self._determinant(value, min(rows, columns))
        if function == "adj":
            return SizeBound(whole.above, whole.below, whole.above_bits, whole.below_bits, value.shape)
        return whole

    def block(self, rows: list[list[SizeBound]]) -> SizeBound:
        """Return all blocks over one common denominator."""
        parts = [part for row in rows for part in row]
        below, below_bits = sum(p.below for p in parts), sum(p.below_bits for p in parts)
        height = sum((row[0].shape or (1, 1))[0] for row in rows)
        width = sum((part.shape or (1, 1))[1] for part in rows[0])
        return SizeBound(
            max(p.above for p in parts) + below,
            below,
            max(p.above_bits for p in parts) + below_bits,
            below_bits,
            (height, width),
        )

    def equal(self, left: SizeBound, right: SizeBound) -> bool:
        raise AssertionError(f"sizes are not compared: {left}, {right}")
