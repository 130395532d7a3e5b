"""SymPy in and out.  Imported only when SymPy objects come in or are asked for."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.errors import InexactInput, InputError
from symobs.exact import functions
from symobs.exact.complex import Complex
from symobs.exact.field import EIGENVALUE
from symobs.exact.matrix import Matrix
from symobs.exact.real import RealRoot
from symobs.exact.root_sum import RootSum
from symobs.exact.scalar import Scalar
from symobs.exact.whole_sympy import sympy

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact.roots import Factored, Root


def scalar_to_sympy(value: Scalar, objects: Mapping[str, Any] | None = None) -> sympy.Expr:
    """Return the SymPy expression of a scalar; `objects` gives the Symbol a name stands for."""
    known = dict(objects or {})

    def polynomial(part: Scalar) -> sympy.Expr:
        if part.size > _LONG and all(functions.known(name) is None for name in part.names):
            return _long_polynomial(part, known)
        terms = []
        for coefficient, powers in part.terms():
            factors = [_generator(name, known) ** power for name, power in powers]
            terms.append(sympy.Mul(sympy.Integer(coefficient), *factors))
        return sympy.Add(*terms)

    below = value.denominator
    if below.is_one:
        return polynomial(value.numerator)
    return polynomial(value.numerator) / polynomial(below)


#: Polynomials with more terms are put together by SymPy's own polynomials, which takes a fifth of the time.
_LONG = 50


def _long_polynomial(part: Scalar, known: dict[str, Any]) -> sympy.Expr:
    names = sorted(part.names)
    monomials = {}
    for coefficient, powers in part.terms():
        exponents = dict(powers)
        monomials[tuple(exponents.get(name, 0) for name in names)] = sympy.Integer(coefficient)
    return sympy.Poly.from_dict(monomials, *(_generator(name, known) for name in names)).as_expr()


def _generator(name: str, objects: dict[str, Any]) -> sympy.Expr:
    """Return the Symbol of a name, or the function it is the name of."""
    found = functions.known(name)
    if found is None:
        return sympy.pi if name == functions.PI else objects.setdefault(name, sympy.Symbol(name))
    if isinstance(found, RootSum):
        root = sympy.Symbol(found.bound)
        named = {EIGENVALUE: Scalar.symbol(found.bound)}
        q, summand = (
            scalar_to_sympy(functions.substitute(v, named), objects) for v in (found.polynomial, found.summand)
        )
        return sympy.RootSum(sympy.Poly(q, root), sympy.Lambda(root, summand))
    if isinstance(found, RealRoot):
        return sympy.CRootOf(scalar_to_sympy(found.argument), found.number.index)
    return getattr(sympy, found.kind)(scalar_to_sympy(found.argument, objects))


def matrix_to_sympy(value: Matrix, objects: Mapping[str, Any] | None = None) -> sympy.ImmutableMatrix:
    """Return the `ImmutableMatrix` of a matrix."""
    return sympy.ImmutableMatrix(*value.shape, [scalar_to_sympy(entry, objects) for entry in value.entries])


def factored_to_sympy(value: Factored, objects: Mapping[str, Any]) -> sympy.Expr:
    """Return a factored form as a product of powers, not multiplied out."""
    powers = [sympy.Pow(scalar_to_sympy(factor, objects), power) for factor, power in value.factors]
    return sympy.Mul(scalar_to_sympy(value.unit, objects), *powers)


def table_to_sympy(rows: tuple[tuple[Factored, ...], ...], objects: Mapping[str, Any]) -> sympy.ImmutableMatrix:
    """Return the `ImmutableMatrix` of rows of factored forms."""
    return sympy.ImmutableMatrix([[factored_to_sympy(entry, objects) for entry in row] for row in rows])


def complex_to_sympy(value: Complex, objects: Mapping[str, Any]) -> sympy.Expr:
    """Return real + imaginary·I."""
    return scalar_to_sympy(value.real, objects) + sympy.I * scalar_to_sympy(value.imaginary, objects)


def root_to_sympy(root: Root, objects: Mapping[str, Any]) -> sympy.Expr:
    """Return a root in radicals where it has them, else as `CRootOf` or as the factor's root."""
    if not root.is_closed:
        factor = scalar_to_sympy(root.factor, objects)
        if len(root.factor.names) > 1:  # SymPy's CRootOf takes numeric coefficients only
            return sympy.Function("CRootOf")(factor, root.index)
        return sympy.CRootOf(sympy.Poly(factor, sympy.Symbol(root.variable)), root.index)
    offset = root.sign * sympy.sqrt(scalar_to_sympy(root.radicand, objects))
    return scalar_to_sympy(root.centre, objects) + offset


def relation_to_sympy(left: Scalar, operator: str, objects: Mapping[str, Any]) -> Any:
    """Return `left operator 0` as a SymPy relation, not evaluated away."""
    kinds = {"!=": sympy.Ne, "==": sympy.Eq, ">": sympy.Gt, ">=": sympy.Ge, "<": sympy.Lt, "<=": sympy.Le}
    return kinds[operator](scalar_to_sympy(left, objects), 0, evaluate=False)


def complex_from_sympy(expression: Any, where: str) -> Complex:
    """Return the exact value of a SymPy expression built from numbers, symbols, i and the four operations."""
    if isinstance(expression, (int, Fraction)):
        return Complex.of(expression)
    if isinstance(expression, sympy.Poly):
        return complex_from_sympy(expression.as_expr(), where)
    if not isinstance(expression, sympy.Expr):
        message = f"{type(expression).__name__} is not an exact expression"
        raise InputError(message, where=where)
    if expression.is_Integer or expression.is_Rational:
        return Complex.of(Fraction(int(expression.p), int(expression.q)))
    if expression.is_Float:
        message = f"{expression} is a floating-point number"
        raise InexactInput(message, where=where, repair="write an exact value such as Rational(1, 10)")
    if expression is sympy.I:
        return Complex(Scalar.of(0), Scalar.of(1))
    if expression.is_Symbol:
        return Complex.of(Scalar.symbol(str(expression)))
    arguments = expression.args
    if expression.is_Add or expression.is_Mul:
        total = complex_from_sympy(arguments[0], where)
        for argument in arguments[1:]:
            value = complex_from_sympy(argument, where)
            total = total + value if expression.is_Add else total * value
        return total
    if expression.is_Pow and expression.exp.is_Integer:
        return complex_from_sympy(expression.base, where) ** int(expression.exp)
    message = f"{expression} is not a rational expression"
    raise InputError(message, where=where, repair="use numbers, symbols and + - * / with integer powers")


def scalar_from_sympy(expression: Any, where: str) -> Scalar:
    """Return the scalar of a real SymPy expression."""
    value = complex_from_sympy(expression, where)
    if not value.is_real:
        message = f"{expression} is not real"
        raise InputError(message, where=where)
    return value.real


def matrix_from_sympy(matrix: Any, where: str) -> Matrix:
    """Return the exact matrix of a SymPy matrix."""
    rows, columns = matrix.shape
    return Matrix.of(
        [[scalar_from_sympy(matrix[i, j], f"{where}[{i}][{j}]") for j in range(columns)] for i in range(rows)], columns
    )


def sign_from_assumptions(symbol: Any) -> str:
    """Return the sign a caller's Symbol declares by its assumptions."""
    for sign in ("positive", "negative", "nonnegative", "nonpositive"):
        if getattr(symbol, f"is_{sign}"):
            return sign
    return "nonzero" if symbol.is_nonzero else "real"


def rectangles(factor: Scalar, variable: str, first: int) -> tuple[tuple[Fraction, Any], ...]:
    """Return where SymPy has isolated the roots of a polynomial from `CRootOf(polynomial, first)` on.

    Each is a number times what lies in a rectangle.
    """
    polynomial = sympy.Poly(scalar_to_sympy(factor.numerator), sympy.Symbol(variable))
    found = []
    for k in range(first, polynomial.degree()):
        scale, root = sympy.CRootOf(polynomial, k).as_coeff_Mul()
        interval = root._get_interval()  # noqa: SLF001 - SymPy tells its order in no other way
        found.append((Fraction(int(scale.p), int(scale.q)), interval))
    return tuple(found)
