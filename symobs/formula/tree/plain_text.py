"""Formulas as one line of plain text, for certificates and messages, which `written` reads: `det(s*I - A + L*C) = phi(s)`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix
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
    from symobs.exact import Scalar

_FUNCTIONS_OF_THE_VARIABLE = {"chi", "chi_K", "chi_L", "phi", "phi_c", "phi_o", "G_cl", "mu"}
_LONG = 400
#: What holds a text together: nothing but signs between terms, factors side by side, a sign of a derivative, or its own marks.
_SUM, _PRODUCT, _RATE, _ATOM = range(4)


def plain_relation(relation: Relation, variable: str) -> str:
    """Return a relation as text."""
    if variable not in relation.texts:
        text = plain(relation.members[0], variable)
        for operator, member in zip(relation.operators, relation.members[1:], strict=True):
            is_zero = isinstance(member, Literal) and isinstance(member.value, Matrix) and member.value.is_zero
            text += f" {operator} {'0' if is_zero else plain(member, variable)}"
        relation.texts[variable] = text
    return relation.texts[variable]


def plain(formula: Formula, variable: str, demanded: int = _SUM) -> str:
    """Return a formula as text, in parentheses where less than what is demanded holds it together."""
    text, strength = _written(formula, variable)
    return f"({text})" if strength < demanded else text


def _written(formula: Formula, variable: str) -> tuple[str, int]:
    """Return the text of a formula, and what holds it together."""

    def inner(part: Formula, demanded: int) -> str:
        return plain(part, variable, demanded)

    match formula:
        case Letter("s"):
            return variable, _ATOM
        case Letter(name):
            return f"{name}({variable})" if name in _FUNCTIONS_OF_THE_VARIABLE else name, _ATOM
        case Literal(value) | Decimals(value):
            return _literal(value)
        case Numeral(text=text):
            return text, _ATOM
        case Identity():
            return "I", _ATOM
        case Sum(terms):
            text = inner(terms[0], _SUM)
            for term in terms[1:]:
                sign, part = ("-", term.operand) if isinstance(term, Negative) else ("+", term)
                text += f" {sign} {inner(part, _PRODUCT)}"
            return text, _SUM
        case Negative(operand):
            return f"-{inner(operand, _PRODUCT)}", _SUM
        case Product(factors):
            return "*".join(inner(factor, _RATE) for factor in factors), _PRODUCT
        case Power(base, exponent):
            return f"{inner(base, _ATOM)}**{f'({exponent})' if exponent < 0 else exponent}", _ATOM
        case Transpose(operand):
            return f"{inner(operand, _ATOM)}.T", _ATOM
        case Quotient(above, below):
            return f"{inner(above, _PRODUCT)}/{inner(below, _RATE)}", _PRODUCT
        case Apply(function, argument):
            return f"{function}({inner(argument, _SUM)})", _ATOM
        case Block(rows):
            return f"[{'; '.join(', '.join(inner(entry, _SUM) for entry in row) for row in rows)}]", _ATOM
        case Derivative(operand, name):
            return f"d/d{name} {inner(operand, _ATOM)}", _RATE
        case At(operand, name, instant):
            return f"{inner(operand, _ATOM)}({name} = {instant})", _ATOM
        case Integral(integrand, _, name, lower, upper):
            return f"integral({inner(integrand, _SUM)}, {name}, {lower}, {upper})", _ATOM


def _literal(value: Scalar | Matrix) -> tuple[str, int]:
    if value.size > _LONG:
        return f"({value.size} terms)", _ATOM
    if isinstance(value, Matrix):
        return f"[{'; '.join(', '.join(map(str, row)) for row in value.rows)}]", _ATOM
    text = str(value)
    return text, _SUM if " " in text or text[0] == "-" else _ATOM if text.isidentifier() or text.isdigit() else _PRODUCT
