"""The exact kernel: scalars and matrices over Q(parameters) on FLINT, fraction-free.

Owns every exact value.  Nothing outside this package imports `flint` or `sympy.polys`.
"""

from symobs.exact.complex import Complex
from symobs.exact.field import RATIONALS, VARIABLES, Field
from symobs.exact.matrix import Matrix
from symobs.exact.polynomial import apply_polynomial, companion, from_coefficients, hankel_of, product_of
from symobs.exact.scalar import Scalar

__all__ = [
    "RATIONALS",
    "VARIABLES",
    "Complex",
    "Field",
    "Matrix",
    "Scalar",
    "apply_polynomial",
    "companion",
    "from_coefficients",
    "hankel_of",
    "product_of",
]
