"""Conversion to and from SymPy, imported only if SymPy objects are given or requested."""

from __future__ import annotations

import gc
from contextlib import contextmanager
from fractions import Fraction
from functools import cmp_to_key
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from symobs.exact.algebraic.polynomial_roots import Complex
from symobs.exact.algebraic.real_algebraic import RealNumber, RealRoot, root_of_fraction, roots_of_scalar
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.algebraic.rounded_decimals import root_in_field
from symobs.exact.core import generators as functions
from symobs.exact.core.field import EIGENVALUE
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar
from symobs.exact.sympy_bridge.sympy_import import sympy
from symobs.exact.time_functions.matrix_power import PowerOf
from symobs.ground.errors import InexactInput, InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.exact.algebraic.polynomial_roots import Factored, Root


def real_to_sympy(number: RealNumber) -> Any:
    """Return a real algebraic number: a rational one, one with a square root, or `CRootOf`."""
    if number.is_rational:
        return sympy.Rational(number.fraction.numerator, number.fraction.denominator)
    coefficients = [int(c) for c in reversed(number.polynomial.coeffs())]
    return sympy.rootof(sympy.Poly(coefficients, sympy.Symbol("x")), number.index)


def scalar_to_sympy(
    value: Scalar, objects: Mapping[str, Any] | None = None, made: dict[Scalar, Any] | None = None
) -> sympy.Expr:
    """Return the SymPy expression of a scalar; `objects` maps names to Symbols.

    `made` keeps the denominators that several entries share.
    """
    known, made = dict(objects or {}), {} if made is None else made
    below = value.denominator
    if below.is_constant:
        return _polynomial(value.numerator, known, int(below.fraction()))
    falling = functions.exponentials_in(below)
    for name, power in falling.items():
        below = below / Scalar.symbol(name) ** power
    if below not in made:
        made[below] = _polynomial(below, known)
    above, under = _polynomial(value.numerator, known), made[below]
    if falling:  # 1 − e^{−T}, not (e^T − 1)/e^T
        turned = [_generator(name, known) ** -power for name, power in falling.items()]
        above = sympy.Add(*(sympy.Mul(term, *turned) for term in sympy.Add.make_args(above)))
    if not (above.is_Add and under.is_Add):
        return above / under
    # What SymPy makes of it too; but long sums it asks for their signs first, for minutes.
    factors = sorted([above, sympy.Pow(under, -1, evaluate=False)], key=_SYMPYS_ORDER)
    return sympy.Mul._from_args(factors, is_commutative=True)  # noqa: SLF001 - as every SymPy module does


#: The bits of a float of double precision.
_DOUBLE = 53
#: Sums with more terms are sorted here: SymPy compares expressions one with another.
_LONG = 50
_SYMPYS_ORDER = cmp_to_key(sympy.Basic.compare)


def _polynomial(part: Scalar, known: dict[str, Any], divisor: int = 1) -> sympy.Expr:
    """Return a polynomial with integer coefficients, divided by an integer, multiplied out."""
    if part.size > _LONG and all(
        name.isidentifier() and functions.function_named(name) is None for name in part.field.names
    ):
        generators = {name: _generator(name, known) for name in part.names}
        if all(generator.is_commutative for generator in generators.values()):
            return _long_polynomial(str(part), generators, divisor)
    terms = []
    for coefficient, powers in part.terms():
        factors = [_generator(name, known) ** power for name, power in powers]
        terms.append(sympy.Mul(sympy.Rational(coefficient, divisor), *factors))
    return sympy.Add(*terms)


def _long_polynomial(text: str, generators: dict[str, Any], divisor: int) -> sympy.Expr:
    """Return a sum of many terms from its canonical text."""
    with _without_collection():
        return _put_together(text, generators, divisor)


@contextmanager
def _without_collection() -> Iterator[None]:
    """Suspend garbage collection: it doubles the time of building a million parts."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def _put_together(text: str, generators: dict[str, Any], divisor: int) -> sympy.Expr:
    """Return a sum of many terms in SymPy's order.

    SymPy's order is by class, number of parts, and part by part; so each distinct factor is compared once, and a term
    stands where the places of its factors say.
    """
    read = [_term(term) for term in text.replace(" - ", " + -").split(" + ")]
    atoms: dict[object, Any] = {n: sympy.Rational(n, divisor) for n in {number for number, _ in read}}
    for factor in {factor for _, factors in read for factor in factors}:
        name, _, power = factor.partition("^")
        atoms[factor] = generators[name] ** int(power or 1)
    kinds = {type(atom): atom for atom in atoms.values()} | {sympy.Mul: 2 * sympy.Symbol("x")}
    rank = {kind: place for place, kind in enumerate(sorted(kinds, key=lambda kind: _SYMPYS_ORDER(kinds[kind])))}
    place = {atom: place for place, atom in enumerate(sorted(atoms.values(), key=_SYMPYS_ORDER))}
    places = {name: place[atom] for name, atom in atoms.items()}
    in_order = {place[atom]: atom for atom in atoms.values()}
    constants, terms = [], []
    for number, factors in read:
        own = sorted([places[factor] for factor in factors])
        if atoms[number] is not sympy.S.One:
            own.insert(0, places[number])
        if not factors:
            constants.append(atoms[number])
        elif len(own) == 1:
            terms.append((rank[type(in_order[own[0]])], 0, own, in_order[own[0]]))
        else:
            product = sympy.Mul._from_args([in_order[each] for each in own], is_commutative=True)  # noqa: SLF001
            terms.append((rank[sympy.Mul], len(own), own, product))
    terms.sort(key=itemgetter(0, 1, 2))
    return sympy.Add._from_args([*constants, *(term[3] for term in terms)], is_commutative=True)  # noqa: SLF001


def _term(text: str) -> tuple[int, list[str]]:
    """Return coefficient and powers of a term: −3 and a**2, b of `-3*a**2*b`."""
    sign, body = (-1, text[1:]) if text[0] == "-" else (1, text)
    number, *factors = body.replace("**", "^").split("*")
    if number.isdigit():
        return sign * int(number), factors
    return sign, [number, *factors]


def _generator(name: str, objects: dict[str, Any]) -> sympy.Expr:
    """Return the Symbol of a name, or the function that it denotes."""
    found = functions.function_named(name)
    if found is None:
        return sympy.pi if name == functions.PI else objects.setdefault(name, sympy.Symbol(name))
    if isinstance(found, RootSum):
        root = sympy.Symbol(found.bound)
        named = {EIGENVALUE: Scalar.symbol(found.bound)}
        q, summand = (
            scalar_to_sympy(functions.substitute(v, named), objects) for v in (found.polynomial, found.summand)
        )
        return sympy.RootSum(sympy.Poly(q, root), sympy.Lambda(root, summand))
    if isinstance(found, PowerOf):
        return _power_of(found, objects)
    if isinstance(found, RealRoot):
        return sympy.CRootOf(scalar_to_sympy(found.argument), found.number.index)
    kind = "Abs" if found.kind == "abs" else found.kind
    return getattr(sympy, kind)(scalar_to_sympy(found.argument, objects))


def _power_of(found: PowerOf, objects: dict[str, Any]) -> sympy.Expr:
    """Return λᵏ, the real or imaginary part of (σ + iω)ᵏ, or δ(k, j)."""
    k, base, imaginary = (scalar_to_sympy(part, objects) for part in (found.argument, found.base, found.imaginary))
    if found.kind == "KroneckerDelta":
        return sympy.KroneckerDelta(k, base)
    whole = sympy.Pow(base + sympy.I * imaginary, k)
    return whole if found.kind == "power" else getattr(sympy, found.kind)(whole)


def matrix_to_sympy(value: Matrix, objects: Mapping[str, Any] | None = None) -> sympy.ImmutableMatrix:
    """Return the `ImmutableMatrix` of a matrix."""
    made: dict[Scalar, Any] = {}
    return sympy.ImmutableMatrix(*value.shape, [scalar_to_sympy(entry, objects, made) for entry in value.entries])


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


def relation_to_sympy(parts: Sequence[Scalar], operator: str, objects: Mapping[str, Any]) -> Any:
    """Return that one of the parts is `operator 0` as a SymPy relation, not evaluated away."""
    kinds = {"!=": sympy.Ne, "==": sympy.Eq, ">": sympy.Gt, ">=": sympy.Ge, "<": sympy.Lt, "<=": sympy.Le}
    found = [kinds[operator](scalar_to_sympy(left, objects), 0, evaluate=False) for left in parts]
    return found[0] if len(found) == 1 else sympy.Or(*found, evaluate=False)


def complex_from_sympy(expression: Any, where: str, *, roots: bool = False) -> Complex:
    """Return the exact value of a SymPy expression built from numbers and their roots, symbols, i and the four operations.

    With `roots` square roots of other real expressions, and functions of real arguments, are generators.
    """
    if isinstance(expression, (int, Fraction)):
        return Complex.of(expression)
    if isinstance(expression, sympy.Poly):
        return complex_from_sympy(expression.as_expr(), where)
    if not isinstance(expression, sympy.Expr):
        connected = type(expression).__module__.startswith("sympy.physics.control")
        repair = (
            "give the connection itself where a plant is expected: symobs.observer(system, ...)" if connected else ""
        )
        raise InputError(f"{type(expression).__name__} is not an exact expression", where=where, repair=repair)
    if expression.is_Integer or expression.is_Rational:
        return Complex.of(Fraction(int(expression.p), int(expression.q)))
    if expression.is_Float:
        message = f"{expression} is a floating-point number"
        raise InexactInput(message, where=where, repair="write an exact value such as Rational(1, 10)")
    if expression is sympy.I:
        return Complex(Scalar.of(0), Scalar.of(1))
    if roots and expression is sympy.pi:
        return Complex.of(Scalar.symbol(functions.PI))
    if roots and expression is sympy.E:
        return Complex.of(functions.function("exp", Scalar.of(1)))
    if expression.is_Symbol:
        return Complex.of(Scalar.symbol(expression.name))
    arguments = expression.args
    if expression.is_Add or expression.is_Mul:
        total = complex_from_sympy(arguments[0], where, roots=roots)
        for argument in arguments[1:]:
            value = complex_from_sympy(argument, where, roots=roots)
            total = total + value if expression.is_Add else total * value
        return total
    if expression.is_Pow and expression.exp.is_Integer:
        return complex_from_sympy(expression.base, where, roots=roots) ** int(expression.exp)
    if expression.is_Pow and expression.exp.is_Rational and expression.exp.q == 2:
        found = _square_root(complex_from_sympy(expression.base, where, roots=roots), roots=roots)
        if found is not None:
            return found ** int(expression.exp.p)
    if roots and isinstance(expression, sympy.CRootOf) and expression.is_real:
        factor = scalar_from_sympy(expression.expr, where)
        return Complex.of(roots_of_scalar(factor, *factor.names)[expression.index].scalar())
    if (
        roots
        and expression.is_Pow
        and expression.base.is_Rational
        and expression.exp.is_Rational
        and expression.base > 0
    ):
        base = Fraction(int(expression.base.p), int(expression.base.q))
        return Complex.of(root_of_fraction(base, int(expression.exp.q)) ** int(expression.exp.p))
    if roots and expression.is_Function and str(expression.func) in functions.KINDS | functions.QUOTIENTS.keys():
        argument = complex_from_sympy(arguments[0], where, roots=roots)
        if argument.is_real:
            return Complex.of(functions.function(str(expression.func), argument.real))
    message = f"{str(expression)[:200]} is not a rational expression"
    repair = "use numbers, roots of rational numbers, symbols and + - * / with integer powers"
    raise InputError(message, where=where, repair=repair)


def _square_root(radicand: Complex, *, roots: bool) -> Complex | None:
    if not radicand.is_real or radicand.real.is_zero:
        return radicand if radicand.is_real else None
    if radicand.real.is_constant and radicand.real.fraction() < 0:
        return Complex(Scalar.of(0), functions.square_root(-radicand.real))
    known = root_in_field(radicand.real)
    if known is None and roots:
        known = functions.square_root(radicand.real)
    return None if known is None else Complex.of(known)


def fraction_from_sympy(expression: Any, where: str) -> tuple[Complex, Complex]:
    """Return numerator and denominator without cancellation, those of a sum over the least common denominator."""
    if isinstance(expression, sympy.Add | sympy.Mul):
        above, below = fraction_from_sympy(expression.args[0], where)
        for argument in expression.args[1:]:
            other_above, other_below = fraction_from_sympy(argument, where)
            if expression.is_Mul:
                above, below = above * other_above, below * other_below
            else:
                ratio = below / other_below
                mine, theirs = (
                    (Complex.of(ratio.real.denominator), Complex.of(ratio.real.numerator))
                    if ratio.is_real
                    else (other_below, below)
                )
                above, below = above * mine + other_above * theirs, below * mine
        return above, below
    if isinstance(expression, sympy.Pow) and expression.exp.is_Integer:
        above, below = (part ** abs(int(expression.exp)) for part in fraction_from_sympy(expression.base, where))
        return (above, below) if expression.exp > 0 else (below, above)
    return complex_from_sympy(expression, where, roots=True), Complex.of(1)


def scalar_from_sympy(expression: Any, where: str, *, roots: bool = False) -> Scalar:
    """Return the scalar of a real SymPy expression."""
    value = complex_from_sympy(expression, where, roots=roots)
    if not value.is_real:
        raise InputError(f"{expression} is not real", where=where)
    return value.real


def matrix_from_sympy(matrix: Any, where: str, *, roots: bool = False) -> Matrix:
    """Return the exact matrix of a SymPy matrix."""
    rows, columns = matrix.shape
    return Matrix.of(
        [
            [scalar_from_sympy(matrix[i, j], f"{where}[{i}][{j}]", roots=roots) for j in range(columns)]
            for i in range(rows)
        ],
        columns,
    )


def without_floats(value: Any) -> Any:
    """Return an expression or a matrix with each float of double precision as the fraction of its shortest decimal."""
    floats = value.atoms(sympy.Float) if hasattr(value, "atoms") else ()
    exact = {number: sympy.Rational(repr(float(number))) for number in floats if number._prec <= _DOUBLE}  # noqa: SLF001 - SymPy tells the bits of a float in no other way
    return value.xreplace(exact) if exact else value


def sign_from_assumptions(symbol: Any) -> str:
    """Return the sign a caller's Symbol declares by its assumptions."""
    for sign in ("positive", "negative", "nonnegative", "nonpositive"):
        if getattr(symbol, f"is_{sign}"):
            return sign
    return "nonzero" if symbol.is_nonzero else "real"


def rectangles(factor: Scalar, variable: str, first: int) -> tuple[tuple[Fraction, Any], ...]:
    """Return SymPy's isolating rectangles of the roots from `CRootOf(polynomial, first)` on.

    Each is a number times what lies in a rectangle.
    """
    polynomial = sympy.Poly(scalar_to_sympy(factor.numerator), sympy.Symbol(variable))
    found = []
    for k in range(first, polynomial.degree()):
        scale, root = sympy.CRootOf(polynomial, k).as_coeff_Mul()
        interval = root._get_interval()  # noqa: SLF001 - SymPy tells its order in no other way
        found.append((Fraction(int(scale.p), int(scale.q)), interval))
    return tuple(found)


def with_plain_symbols(expression: Any, names: Mapping[Any, str] | None = None) -> Any:
    """Return a SymPy expression whose symbols carry no assumptions, or in which the symbols in `names` are renamed."""
    chosen = {symbol: symbol.name for symbol in expression.free_symbols} if names is None else names
    return expression.subs({symbol: sympy.Symbol(name) for symbol, name in chosen.items()}, simultaneous=True)
