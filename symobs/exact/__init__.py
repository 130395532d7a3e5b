"""The exact kernel: scalars and matrices over Q(parameters) on FLINT, fraction-free.

Owns every exact value.  Nothing outside this package imports `flint` or `sympy.polys`.
"""

from symobs.exact.algebraic import Extension
from symobs.exact.calculus import antiderivative, exponential_of_integral
from symobs.exact.complex import Complex
from symobs.exact.decimals import is_rounding, places, rounded, written
from symobs.exact.elimination import echelon, independent_rows, kernel, modulo, rank, reduced_echelon, unit_rows
from symobs.exact.field import EIGENVALUE, RATIONALS, VARIABLES, Field
from symobs.exact.functions import derivative
from symobs.exact.ideal import Ideal, TooLarge, apart_from_zero
from symobs.exact.matrix import Matrix
from symobs.exact.numeric import matrix_of_numbers
from symobs.exact.polynomial import (
    apply_polynomial,
    companion,
    from_coefficients,
    hankel_of,
    product_of,
    remainder,
    resultant,
)
from symobs.exact.real import RealNumber
from symobs.exact.roots import Factored, Root, Shifted, factored, root_of_pole, roots_are, roots_of
from symobs.exact.scalar import Scalar
from symobs.exact.sides import stable_roots
from symobs.exact.smith_mcmillan import pole_and_zero_polynomial
from symobs.exact.transfer import controller, transfer, transfer_matrix

__all__ = [
    "EIGENVALUE",
    "RATIONALS",
    "VARIABLES",
    "Complex",
    "Extension",
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
    "derivative",
    "echelon",
    "exponential_of_integral",
    "factored",
    "from_coefficients",
    "hankel_of",
    "independent_rows",
    "is_rounding",
    "kernel",
    "matrix_of_numbers",
    "modulo",
    "places",
    "pole_and_zero_polynomial",
    "product_of",
    "rank",
    "reduced_echelon",
    "remainder",
    "resultant",
    "root_of_pole",
    "roots_are",
    "roots_of",
    "rounded",
    "stable_roots",
    "transfer",
    "transfer_matrix",
    "unit_rows",
    "written",
]
