"""`eigenvalues(X) = [-1, -2]`: lists of numbers, compared by the polynomial whose roots they are."""

from __future__ import annotations

from symobs.audit.functions import Misfit
from symobs.audit.grammar import Node
from symobs.errors import InputError
from symobs.exact import Complex, Scalar, roots_of
from symobs.exact.polynomial import from_coefficients
from symobs.expression import parse_poles


def spectral(left: Node, right: Node, variable: str = "s") -> tuple[Node, Node]:
    """Return both sides, a list of numbers beside `eigenvalues` read as the polynomial with these roots."""
    if _is_spectrum(left) and right.kind == "block":
        return left, _polynomial(right, variable)
    if _is_spectrum(right) and left.kind == "block":
        return _polynomial(left, variable), right
    return left, right


def _is_spectrum(node: Node) -> bool:
    return node.kind == "call" and node.text == "eigenvalues"


def _polynomial(node: Node, variable: str) -> Node:
    try:
        roots = parse_poles(str(node))
    except InputError:
        raise Misfit(f"{node} is no list of numbers") from None
    coefficients = [Complex.of(1)]
    for root in roots:
        shifted = [*coefficients, Complex.of(0)]
        for i, coefficient in enumerate(coefficients):
            shifted[i + 1] = shifted[i + 1] - coefficient * root
        coefficients = shifted
    if not all(coefficient.is_real for coefficient in coefficients):
        raise Misfit(f"{node} lacks a complex conjugate")
    value = from_coefficients([coefficient.real for coefficient in coefficients], variable)
    return Node("number", text=str(node), value=value)


def spectrum_text(spectrum: Node, polynomial: Scalar, variable: str) -> str:
    """Return the equation that lists the eigenvalues, or that gives their polynomial where they have no short form."""
    roots = [str(root) for root in roots_of(polynomial, variable)]
    if not any("(" in root for root in roots):
        return f"{spectrum} = [{', '.join(roots)}]".replace("**", "^")
    pencil = Node("sum", (Node("letter", text=f"{variable} I"), Node("negative", spectrum.parts)))
    return f"{Node('call', (pencil,), text='det')} = {polynomial}".replace("**", "^")
