"""Parsing of expressions: from the text of a user to exact values."""

from symobs.formula.expression.latex import without_latex
from symobs.formula.expression.names import declared_name, typed_name
from symobs.formula.expression.parse import (
    comma_between_digits,
    parse_matrix,
    parse_poles,
    parse_polynomial,
    parse_scalar,
    right_side,
    without_comma,
    without_pole_names,
)

__all__ = [
    "comma_between_digits",
    "declared_name",
    "parse_matrix",
    "parse_poles",
    "parse_polynomial",
    "parse_scalar",
    "right_side",
    "typed_name",
    "without_comma",
    "without_latex",
    "without_pole_names",
]
