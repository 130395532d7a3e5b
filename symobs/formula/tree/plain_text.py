"""Formulas as one line of plain text, for certificates and messages: `det(s*I - A + L*C) = phi(s)`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.tree.nodes import (
    Apply,
    At,
    Block,
    Decimals,
    Derivative,
    Formula,
    Identity,
    Integral,
    Letter,
    Literal,
    Negative,
    Numeral,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
)

if TYPE_CHECKING:
    from symobs.exact import Matrix, Scalar

_FUNCTIONS_OF_THE_VARIABLE = {"chi", "chi_K", "chi_L", "phi", "phi_c", "phi_o", "F", "P", "G_cl", "mu"}
_LONG = 400


def plain_relation(relation: Relation, variable: str) -> str:
    """Return a relation as text."""
    if variable not in relation.texts:
        text = plain(relation.members[0], variable)
        for operator, member in zip(relation.operators, relation.members[1:], strict=True):
            text += f" {operator} {plain(member, variable)}"
        relation.texts[variable] = text
    return relation.texts[variable]


def plain(formula: Formula, variable: str) -> str:
    """Return a formula as text."""

    def inner(part: Formula) -> str:
        text = plain(part, variable)
        return f"({text})" if isinstance(part, (Sum, Negative)) or (isinstance(part, Literal) and " " in text) else text

    match formula:
        case Letter("s"):
            return variable
        case Letter(name):
            return f"{name}({variable})" if name in _FUNCTIONS_OF_THE_VARIABLE else name
        case Literal(value) | Decimals(value):
            return _literal(value)
        case Numeral(text=text):
            return text
        case Identity():
            return "I"
        case Sum(terms):
            text = plain(terms[0], variable)
            for term in terms[1:]:
                if isinstance(term, Negative):
                    text += f" - {inner(term.operand)}"
                else:
                    text += f" + {plain(term, variable)}"
            return text
        case Negative(operand):
            return f"-{inner(operand)}"
        case Product(factors):
            return "*".join(inner(factor) for factor in factors)
        case Power(base, exponent):
            return f"{inner(base)}**({exponent})" if exponent < 0 else f"{inner(base)}**{exponent}"
        case Transpose(operand):
            return f"{inner(operand)}.T"
        case Quotient(above, below):
            return f"{inner(above)}/{inner(below)}"
        case Apply(function, argument):
            return f"{function}({plain(argument, variable)})"
        case Block(rows):
            return "[" + "; ".join(", ".join(plain(entry, variable) for entry in row) for row in rows) + "]"
        case Derivative(operand, name):
            return f"d/d{name} {inner(operand)}"
        case At(operand, name, instant):
            return f"{inner(operand)}({name} = {instant})"
        case Integral(integrand, _, name, lower, upper):
            return f"integral({plain(integrand, variable)}, {name}, {lower}, {upper})"


def _literal(value: Scalar | Matrix) -> str:
    if value.size > _LONG:
        return f"({value.size} terms)"
    return str(value)
