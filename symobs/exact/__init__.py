"""The exact kernel: scalars and matrices over Q(parameters) on FLINT, fraction-free.

Owns every exact value.  Nothing outside this package imports `flint` or `sympy.polys`.
"""

from symobs.exact.algebraic.extension import AlgebraicExtension
from symobs.exact.algebraic.polynomial_roots import Complex, Factored, Root, Shifted, factored, root_of_pole, roots_of
from symobs.exact.algebraic.real_algebraic import RealNumber
from symobs.exact.algebraic.rounded_decimals import decimal_digits, decimal_places, is_rounding, rounded
from symobs.exact.core.field import EIGENVALUE, RATIONALS, VARIABLES, Field
from symobs.exact.core.generators import derivative
from symobs.exact.core.matrix import Matrix, matrix_of_numbers
from symobs.exact.core.polynomial import (
    apply_polynomial,
    companion,
    from_coefficients,
    hankel_of,
    product_of,
    remainder,
    resultant,
)
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import Ideal, TooLarge, apart_from_zero, is_inverse, kept_from_zero
from symobs.exact.linear_algebra.elimination import (
    echelon,
    independent_rows,
    kernel,
    modulo,
    primitive,
    primitive_kernel,
    rank,
    reduced_echelon,
    solve_or_refute,
    unit_rows,
)
from symobs.exact.linear_algebra.transfer_function import (
    controller,
    pole_and_zero_polynomial,
    transfer,
    transfer_matrix,
)
from symobs.exact.numerals.rounded_roots import is_correctly_written, is_written_exactly
from symobs.exact.numerals.written_digits import significant
from symobs.exact.sympy_bridge.stable_roots import stable_roots
from symobs.exact.time_functions.antiderivative import antiderivative, exponential_of_integral

__all__ = [
    "EIGENVALUE",
    "RATIONALS",
    "VARIABLES",
    "AlgebraicExtension",
    "Complex",
    "Factored",
    "Field",
    "Ideal",
    "Matrix",
    "RealNumber",
    "Root",
    "Scalar",
    "Shifted",
    "TooLarge",
    "antiderivative",
    "apart_from_zero",
    "apply_polynomial",
    "companion",
    "controller",
    "decimal_digits",
    "decimal_places",
    "derivative",
    "echelon",
    "exponential_of_integral",
    "factored",
    "from_coefficients",
    "hankel_of",
    "independent_rows",
    "is_correctly_written",
    "is_inverse",
    "is_rounding",
    "is_written_exactly",
    "kept_from_zero",
    "kernel",
    "matrix_of_numbers",
    "modulo",
    "pole_and_zero_polynomial",
    "primitive",
    "primitive_kernel",
    "product_of",
    "rank",
    "reduced_echelon",
    "remainder",
    "resultant",
    "root_of_pole",
    "roots_of",
    "rounded",
    "significant",
    "solve_or_refute",
    "stable_roots",
    "transfer",
    "transfer_matrix",
    "unit_rows",
]
