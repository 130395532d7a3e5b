"""Texts of problems and answers as numbers of fifty digits: read by Python's own parser, never evaluated by it.

A quotient of polynomials in s or z is read coefficient by coefficient; everything else at given values of its symbols.
"""

from __future__ import annotations

import ast
import operator
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    Numbers = NDArray[Any]

real = mpmath.mpf
mpmath.mp.dps = 50

_OPERATIONS: dict[type, Any] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_FUNCTIONS = {name: getattr(mpmath, name) for name in ("sqrt", "exp", "sin", "cos", "sinh", "cosh")}
_FUNCTIONS["Abs"] = abs
_RELATIONS = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
}
#: What is smaller than this, in fifty digits, is 0.
TINY = real(10) ** -35


class UnreadableError(ValueError):
    """A text that is no number of the kind this oracle reads."""


class Ratio:
    """A quotient of polynomials, coefficients with the highest power first; never reduced."""

    def __init__(self, over: Sequence[Any], under: Sequence[Any] = (1,)) -> None:
        self.over, self.under = list(over), list(under)

    @staticmethod
    def of(value: Any) -> Ratio:
        return value if isinstance(value, Ratio) else Ratio([value])

    def __add__(self, other: Any) -> Ratio:
        other = Ratio.of(other)
        if self.under == other.under:
            return Ratio(_sum(self.over, other.over), self.under)
        over = _sum(_product(self.over, other.under), _product(other.over, self.under))
        return Ratio(over, _product(self.under, other.under))

    def __mul__(self, other: Any) -> Ratio:
        other = Ratio.of(other)
        return Ratio(_product(self.over, other.over), _product(self.under, other.under))

    def __neg__(self) -> Ratio:
        return Ratio([-c for c in self.over], self.under)

    def __sub__(self, other: Any) -> Ratio:
        return self + -Ratio.of(other)

    def __rsub__(self, other: Any) -> Ratio:
        return Ratio.of(other) + -self

    def __truediv__(self, other: Any) -> Ratio:
        other = Ratio.of(other)
        return self * Ratio(other.under, other.over)

    def __rtruediv__(self, other: Any) -> Ratio:
        return Ratio.of(other) / self

    def __pow__(self, power: Any) -> Ratio:
        count = int(power)
        if count != power:
            raise UnreadableError(f"the power {power}")
        base, found = self if count >= 0 else 1 / self, Ratio([real(1)])
        for _ in range(abs(count)):
            found = found * base
        return found

    __radd__, __rmul__ = __add__, __mul__

    def at(self, s: complex) -> Any:
        return mpmath.polyval(self.over, s) / mpmath.polyval(self.under, s)


def _sum(left: list[Any], right: list[Any]) -> list[Any]:
    length = max(len(left), len(right))
    padded = ([0] * (length - len(part)) + list(part) for part in (left, right))
    return [a + b for a, b in zip(*padded, strict=True)]


def _product(left: list[Any], right: list[Any]) -> list[Any]:
    found = [real(0)] * (len(left) + len(right) - 1)
    for i, a in enumerate(left):
        for j, b in enumerate(right):
            found[i + j] += a * b
    return found


# -- reading -----------------------------------------------------------------------------------------------------------


@lru_cache(maxsize=4096)
def _parsed(text: str) -> ast.expr:
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, RecursionError) as error:
        raise UnreadableError(text[:80]) from error


def value(text: object, point: Mapping[str, Any]) -> Any:
    """Return a text's value where its symbols have those of `point`; raises ZeroDivisionError and `UnreadableError`."""
    return _value(_parsed(str(text)), point)


def _value(node: ast.expr, point: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=int(number)):
            return real(number)
        case ast.Name(id=name) if name in point:
            return point[name]
        case ast.Name(id="I"):
            return mpmath.mpc(0, 1)
        case ast.Name(id="pi"):
            return +mpmath.pi
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return -_value(inner, point)
        case ast.UnaryOp(op=ast.UAdd(), operand=inner):
            return _value(inner, point)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATIONS:
            first, second = _value(left, point), _value(right, point)
            if isinstance(op, ast.Div) and not isinstance(second, Ratio) and abs(second) < TINY:
                raise ZeroDivisionError(ast.unparse(right)[:80])
            return _OPERATIONS[type(op)](first, second)
        case ast.Call(func=ast.Name(id=name), args=[inner]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_value(inner, point))
        case ast.Call(func=ast.Name(id="CRootOf"), args=[polynomial, ast.Constant(value=int(index))]):
            return _root(polynomial, index, point)
        case ast.Call(func=ast.Name(id="RootSum"), args=[polynomial, ast.Call(args=[ast.Name(id=name), inner])]):
            over = Ratio.of(_value(polynomial, {**point, name: Ratio([real(1), real(0)])})).over
            return sum(_value(inner, {**point, name: root}) for root in roots_of(over))
    raise UnreadableError(ast.unparse(node)[:80])


def _root(polynomial: ast.expr, index: int, point: Mapping[str, Any]) -> Any:
    """Real roots first and in order, then the pairs by real part and the size of the imaginary one, the lower first."""
    (variable,) = {node.id for node in ast.walk(polynomial) if isinstance(node, ast.Name)} - {*point} or {"s"}
    roots = roots_of(Ratio.of(_value(polynomial, {**point, variable: Ratio([real(1), real(0)])})).over)
    reals = sorted(root.real for root in roots if abs(root.imag) < TINY)
    pairs = sorted(
        (r for r in roots if abs(r.imag) >= TINY), key=lambda r: (round(r.real, 30), round(abs(r.imag), 30), r.imag)
    )
    return [*reals, *pairs][index]


def roots_of(coefficients: Sequence[Any]) -> list[Any]:
    kept = list(coefficients)
    while kept and abs(kept[0]) < TINY:
        kept.pop(0)
    return list(_roots_of(tuple(kept))) if len(kept) > 1 else []


@lru_cache(maxsize=1024)
def _roots_of(coefficients: tuple[Any, ...]) -> tuple[Any, ...]:
    """With more digits where few do not suffice."""
    for extra in (50, 200, 800):
        try:
            found = mpmath.polyroots(coefficients, maxsteps=200, extraprec=extra)
        except mpmath.mp.NoConvergence:
            continue
        return tuple(mpmath.mpc(root) for root in found)
    raise UnreadableError("no roots were found")


def ratio(text: object, point: Mapping[str, Any], variable: str) -> Ratio:
    """Return a quotient of polynomials in the variable."""
    return Ratio.of(value(text, {**point, variable: Ratio([real(1), real(0)])}))


def polynomial(text: object, point: Mapping[str, Any], variable: str, *, monic: bool = False) -> list[Any]:
    """Return the coefficients of a polynomial, on request of its monic multiple."""
    found = ratio(text, point, variable)
    if len(found.under) > 1:
        raise UnreadableError(f"no polynomial: {text}")
    over = list(found.over)
    while len(over) > 1 and abs(over[0]) < TINY:
        over.pop(0)
    return [c / (over[0] if monic else found.under[0]) for c in over]


def from_roots(roots: Sequence[Any]) -> list[Any]:
    """Return the coefficients of the monic polynomial with these roots."""
    found = [real(1)]
    for root in roots:
        found = _product(found, [real(1), -root])
    return found


_RELATION = re.compile(r"(.*?)\s*(==|!=|<=|>=|<|>)\s*(.*)", re.DOTALL)


def sides(relation: str) -> tuple[str, str, str]:
    """Return left side, relation and right side."""
    found = _RELATION.fullmatch(relation)
    if found is None:
        raise UnreadableError(relation)
    left, how, right = found.groups()
    return left, how, right


def holds(relation: str, point: Mapping[str, Any]) -> bool:
    """Tell whether `expr op expr` is true."""
    if relation in {"True", "False"}:
        return relation == "True"
    left, how, right = sides(relation)
    difference = value(left, point) - value(right, point)
    if abs(difference) < TINY:
        return how in {"==", "<=", ">="}
    if how in {"==", "!="}:
        return how == "!="
    return bool(_RELATIONS[how](mpmath.re(difference), 0))


def array(table: Sequence[Sequence[object]], columns: int, point: Mapping[str, Any]) -> Numbers:
    """Return a matrix of texts in doubles; one without rows has the given number of columns."""
    values = [[complex(value(entry, point)) for entry in row] for row in table]
    return np.array(values, dtype=complex).reshape(len(values), len(values[0]) if values else columns)


def vector(values: Sequence[Any]) -> Numbers:
    """Return numbers as one row of doubles."""
    return np.array([[complex(each) for each in values]], dtype=complex)
