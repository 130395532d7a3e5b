"""Parsing of expressions: from the text of a user to exact values."""

from symobs.formula.expression.names import declared_name
from symobs.formula.expression.parse import (
    comma_between_digits,
    parse_matrix,
    parse_poles,
    parse_polynomial,
    parse_scalar,
    without_comma,
)

__all__ = [
    "comma_between_digits",
    "declared_name",
    "parse_matrix",
    "parse_poles",
    "parse_polynomial",
    "parse_scalar",
    "without_comma",
]
