"""`eigenvalues(X) = [-1, -2]`: lists of numbers, compared by the polynomial whose roots they are."""

from __future__ import annotations

from symobs.applications.audit.equations.matrix_functions import Misfit
from symobs.applications.audit.equations.reading import text_of_value
from symobs.exact import Scalar, roots_of
from symobs.exact.algebraic.rounded_decimals import polynomial_of
from symobs.formula.expression import parse_poles
from symobs.formula.expression.syntax_tree import SyntaxNode
from symobs.ground.errors import InputError


def spectral(left: SyntaxNode, right: SyntaxNode, variable: str) -> tuple[SyntaxNode, SyntaxNode]:
    """Return both sides, a list of eigenvalues replaced by the polynomial with these roots."""
    if is_spectrum(left) and right.kind == "block":
        return left, _polynomial(right, variable)
    if is_spectrum(right) and left.kind == "block":
        return _polynomial(left, variable), right
    return left, right


def is_spectrum(node: SyntaxNode) -> bool:
    """Return whether a node is `eigenvalues(X)`."""
    return node.kind == "call" and node.text == "eigenvalues"


def _polynomial(node: SyntaxNode, variable: str) -> SyntaxNode:
    try:
        roots = parse_poles(str(node), functions=True, rounding=True)
    except InputError:
        raise Misfit(f"{node} is no list of numbers") from None
    try:
        return SyntaxNode("number", text=str(node), value=polynomial_of(roots, variable))
    except ValueError:
        raise Misfit(f"{node} lacks a complex conjugate") from None


def spectrum_text(spectrum: SyntaxNode, polynomial: Scalar, variable: str) -> str:
    """Return the equation of the eigenvalues, or of their polynomial if they have no short form."""
    roots = [str(root) for root in roots_of(polynomial, variable)]
    if not any("CRootOf" in root for root in roots):
        return f"{spectrum} = [{', '.join(root.replace(' ', '') for root in roots)}]".replace("**", "^")
    pencil = SyntaxNode("sum", (SyntaxNode("letter", text=f"{variable} I"), SyntaxNode("negative", spectrum.parts)))
    return f"{SyntaxNode('call', (pencil,), text='det')} = {text_of_value(polynomial)}"
