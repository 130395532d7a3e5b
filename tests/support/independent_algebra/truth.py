"""What a changed derivation says: a lie, or something else that is true as well.  Decided without the kernel."""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy

from symobs.exact import Scalar
from symobs.formula.tree import Literal, Negative, Power, Product, Quotient
from tests.support.independent_algebra.plain import at_number, multiply
from tests.support.independent_algebra.plain_fractions import Compared, World, inverse, is_matrix, single
from tests.support.independent_algebra.regions_in_plain_fractions import is_stable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.proof.derivation import Derivation

POINTS = 3
#: Enough values of the variable to tell a polynomial of degree up to 9 from any other rational function.
_FITTED, _TESTED = 10, 4

Readings: TypeAlias = "list[list[tuple[str, Any]]]"


def readings(derivation: Derivation, points: Sequence[Any] = range(POINTS), scale: Fraction | None = None) -> Readings:
    """Return what a derivation says at random points; `scale` puts that multiple of the variable in its place."""
    found = []
    for seed in points:
        world = World.of(derivation.start, seed)
        if scale is not None:
            world.meanings[world.variable] = Scalar.of(scale * world.number(world.variable))
        found.append(list(world.read(derivation.steps)))
    return found


def is_true(derivation: Derivation) -> bool:
    """Tell whether every equation of a derivation holds at random points."""
    return all(content == 0 for reading in readings(derivation) for kind, content in reading if kind in {"=", "zero"})


def still_true(changed: Derivation, original: Derivation) -> bool:
    """Tell whether a changed derivation says other things that are true as well.

    What it introduces means the same.  Equations hold.  Inequalities are proved by SymPy from the declared signs, or are the
    same up to a factor.  Conditions are the same up to a factor.  Properties are of the same function up to a factor of
    value or variable, or are decided anew.  Roots, regions, labels, words are the same.
    """
    try:
        told = readings(changed)
    except (ArithmeticError, ValueError, TypeError, LookupError, AssertionError):
        return False
    meant = _meant(original)
    if [_family(kind) for kind, _ in told[0]] != [_family(kind) for kind, _ in meant[0]]:
        return False
    for place, kind in enumerate(kind for kind, _ in told[0]):
        new, old = ([reading[place][1] for reading in side] for side in (told, meant))
        if not (_agrees(kind, new, old, original.start.signs) or _has_property(kind, place, changed, original, new)):
            return False
    return True


def _meant(original: Derivation) -> Readings:
    """Return what an original says: it is asked for again by each of its changes."""
    for known, found in _READ:
        if known is original:
            return found
    _READ.append((original, readings(original)))
    return _READ[-1][1]


_READ: deque[tuple[Derivation, Readings]] = deque(maxlen=2)


def _family(kind: str) -> str:
    return "comparison" if kind in _HOLDS else kind


def _agrees(kind: str, new: list[Any], old: list[Any], signs: Mapping[str, str]) -> bool:
    if kind in {"=", "zero"}:
        return all(content == 0 for content in new)
    if kind == "basis":
        return True
    if kind == "!==":
        return any(content != 0 for content in new)
    if new == old:
        return True
    if kind in _HOLDS:
        return _compares(kind, new, signs)
    if kind == "region":
        return _same_bounds(new, old)
    if kind.startswith(("condition", "property")):
        ratio = _ratio(new, old)
        return ratio is not None and (kind not in {"condition <", "condition >"} or ratio > 0)
    return False


def _ratio(new: list[Any], old: list[Any]) -> Any:
    """Return by what the first are multiples of the second, the same at all points; None where they are not.

    The entries of a table may be multiples by different numbers, and the first of them is returned.
    """
    if is_matrix(new[0]) or is_matrix(old[0]):
        return _ratio_of_tables(new, old)
    values = [(single(a), single(b)) for a, b in zip(new, old, strict=True)]
    if any(a == 0 or b == 0 for a, b in values):
        return None
    ratios = [a / b for a, b in values]
    return None if any(ratio != ratios[0] for ratio in ratios) else ratios[0]


def _same_bounds(new: list[Any], old: list[Any]) -> bool:
    """Tell whether inequalities are the same in turn, each up to a positive factor."""
    for bounds, others in zip(zip(*new, strict=True), zip(*old, strict=True), strict=True):
        if {operators for operators, _ in bounds} != {operators for operators, _ in others}:
            return False
        ratio = _ratio([value for _, value in bounds], [value for _, value in others])
        if ratio is None or ratio < 0:
            return False
    return True


def _ratio_of_tables(new: list[Any], old: list[Any]) -> Any:
    left, right = ([_entries(table) for table in side] for side in (new, old))
    if any(len(a) != len(b) for a, b in zip(left, right, strict=True)):
        return None
    found = []
    for above, below in zip(zip(*left, strict=True), zip(*right, strict=True), strict=True):
        if any(above) or any(below):
            found.append(_ratio(list(above), list(below)))
    return None if not found or None in found else found[0]


def _entries(value: Any) -> list[Any]:
    return [entry for row in value for entry in row] if is_matrix(value) else [single(value)]


def _compares(operator: str, compared: list[Compared], signs: Mapping[str, str]) -> bool:
    """Prove an inequality: between constants, or from declared signs where no letter stands in it."""
    difference, *others = (single(content.difference) for content in compared)
    if all(other == difference for other in others):
        parts = getattr(difference, "parts", None)
        exact = sympy.Rational(*difference.as_integer_ratio()) if parts is None else sympy.Float(str(parts[0]), 50)
        return bool(_HOLDS[operator](exact))
    try:
        left, right = (_symbolic(member, signs) for member in compared[0].members)
    except KeyError:
        return False
    return bool(_HOLDS[operator](sympy.factor(left - right)))


_HOLDS = {
    "!=": lambda difference: difference.is_nonzero,
    ">": lambda difference: difference.is_positive,
    ">=": lambda difference: difference.is_nonnegative,
    "<": lambda difference: difference.is_negative,
    "<=": lambda difference: difference.is_nonpositive,
}


def _symbolic(formula: Any, signs: Mapping[str, str]) -> Any:
    """Return a scalar formula without letters as a SymPy expression in symbols with the declared signs."""
    match formula:
        case Literal(Scalar() as value):
            return _terms(value.numerator, signs) / _terms(value.denominator, signs)
        case Negative(operand):
            return -_symbolic(operand, signs)
        case Product(factors):
            return sympy.Mul(*(_symbolic(factor, signs) for factor in factors))
        case Quotient(above, below):
            return _symbolic(above, signs) / _symbolic(below, signs)
        case Power(base, exponent):
            return _symbolic(base, signs) ** exponent
    raise KeyError(formula)


def _terms(polynomial: Scalar, signs: Mapping[str, str]) -> Any:
    total = sympy.Integer(0)
    for coefficient, powers in polynomial.terms():
        symbols = (sympy.Symbol(name, **{signs.get(name, "real"): True}) ** power for name, power in powers)
        total += coefficient * sympy.Mul(*symbols)
    return total


def _has_property(kind: str, place: int, changed: Derivation, original: Derivation, new: list[Any]) -> bool:
    """Decide a property anew, of a polynomial that is told by interpolation.

    Strictly proper stays what is so when its variable is scaled, and in continuous time stable and unstable do too.
    """
    if kind == "property strictly_proper" or (kind in _OF_ROOTS and not original.discrete):
        for scale in (Fraction(2), Fraction(1, 2)):
            if _ratio(new, [reading[place][1] for reading in readings(original, scale=scale)]) is not None:
                return True
    if kind in _OF_ROOTS:
        found = [_polynomial(changed, place, seed) for seed in range(POINTS)]
        if found[0] is None or any(polynomial != found[0] for polynomial in found):
            return False
        return is_stable(found[0], discrete=changed.discrete) == _OF_ROOTS[kind]
    if kind not in {"property polynomial", "property not_polynomial"}:
        return False
    return (_polynomial(changed, place, 0) is not None) == (kind == "property polynomial")


_OF_ROOTS = {"property stable": True, "property unstable": False}


def _polynomial(derivation: Derivation, place: int, seed: int) -> list[Fraction] | None:
    """Return the coefficients of what is told at a place, highest power first; None where it is no polynomial."""
    at = World(seed, derivation.variable, {}).number(derivation.variable)
    values = [(k * at, readings(derivation, [seed], Fraction(k))[0][place][1]) for k in range(1, _FITTED + _TESTED + 1)]
    places, told = zip(*values[:_FITTED], strict=True)
    powers = [[point**k for k in reversed(range(_FITTED))] for point in places]
    found = [entry for (entry,) in multiply(inverse(powers), [[single(value)] for value in told])]
    while len(found) > 1 and not found[0]:
        del found[0]
    return found if all(at_number(found, point) == single(value) for point, value in values[_FITTED:]) else None
