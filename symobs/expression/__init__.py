"""Text to exact values: the only way from what a user wrote into the field."""

from symobs.expression.names import declared_name
from symobs.expression.parse import parse_matrix, parse_poles, parse_polynomial, parse_scalar

__all__ = ["declared_name", "parse_matrix", "parse_poles", "parse_polynomial", "parse_scalar"]
