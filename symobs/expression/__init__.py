"""Parsing of expressions: from the text of a user to exact values."""

from symobs.expression.names import declared_name
from symobs.expression.parse import parse_matrix, parse_poles, parse_polynomial, parse_scalar

__all__ = ["declared_name", "parse_matrix", "parse_poles", "parse_polynomial", "parse_scalar"]
