"""Declared signs, their consequences, and the conditions under which a result holds.

A condition is one relation `expression op 0` on the parameters, of one of four kinds: *domain* (a denominator of the
plant: where it vanishes there is no plant), *claim* (a denominator of the answer), *existence* (a factor whose
vanishing
costs observability or controllability), *route* (what one method's witness needs).  What the declared signs imply is
not repeated.
"""

from __future__ import annotations

from functools import lru_cache
from math import prod
from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, Scalar, product_of
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.algebraic.real_algebraic import integer_factor, real_roots
from symobs.exact.core.generators import PI, function_named
from symobs.exact.core.polynomial import by_monomial, discriminant
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

#: What may be declared of a symbol.  Each implies that the symbol is real.
SIGNS = ("positive", "negative", "nonnegative", "nonpositive", "nonzero", "real")

#: A polynomial with more terms than this is not factored: it counts as one factor.
FACTORED_UP_TO = 1_500

#: A polynomial with more terms than these is not looked at letter by letter, nor is its discriminant computed.
_BY_LETTER_UP_TO, _BY_DISCRIMINANT_UP_TO, _DISCRIMINANT_OF_DEGREE = 60, 12, 6
#: Nor is one in more letters: each is looked at beside all others.
_BY_LETTERS = 5

#: The side of 0 that a sign leaves to a parameter.
_SIDE = {"positive": 1, "nonnegative": 1, "negative": -1, "nonpositive": -1}
_NEVER_ZERO = {"positive", "negative", "nonzero"}
_OPPOSITE = {
    "positive": "negative",
    "negative": "positive",
    "nonnegative": "nonpositive",
    "nonpositive": "nonnegative",
}
#: The signs that say something; of a number of any other sign nothing is known.
_KNOWN = frozenset(SIGNS) - {"real"}


class SumOfSquares(Scalar):
    """Σ f²: 0 exactly where all f vanish, which are real.  That it is not 0 is told as f ≠ 0 or g ≠ 0."""

    __slots__ = ("parts",)
    parts: tuple[Scalar, ...]

    @staticmethod
    def of_parts(parts: Iterable[Scalar]) -> Scalar:
        """Return the sum of the squares; of one polynomial the polynomial itself."""
        parts = tuple(dict.fromkeys(part for part in parts if not part.is_zero))
        if len(parts) == 1:
            return parts[0]
        total = sum((part**2 for part in parts), Scalar.of(0))
        found = SumOfSquares(total.field, total.numerator_part, total.denominator_part)
        found.parts = parts
        return found

    def __reduce__(self) -> tuple[object, ...]:
        return SumOfSquares.of_parts, (self.parts,)

    @property
    def numerator(self) -> Scalar:
        """The sum itself, where its parts are polynomials."""
        return self if self.denominator_part.is_one() else super().numerator

    def substitute(self, values: Mapping[str, Scalar]) -> Scalar:
        """Return the sum of the squares of the parts there."""
        return SumOfSquares.of_parts(part.substitute(values) for part in self.parts)


@dataclass
class Condition:
    """expression operator 0, of the given kind."""

    kind: str
    expression: Scalar
    operator: str = "!="

    def __str__(self) -> str:
        if isinstance(self.expression, SumOfSquares) and self.operator == "!=":
            return " or ".join("{} != {}".format(*solved(part)) for part in self.expression.parts)
        return f"{self.expression} {self.operator} 0"


#: What a sum of terms of one sign is that cannot all vanish.
_WEAK = {"nonnegative": "positive", "nonpositive": "negative"}


def _product_sign(left: str, right: str) -> str:
    if "zero" in (left, right):
        return "zero"
    if not _KNOWN.issuperset((left, right)):
        return "real"
    if "nonzero" in (left, right):
        weak = {"nonnegative", "nonpositive"} & {left, right}
        return "real" if weak else "nonzero"
    either_weak = left.startswith("non") or right.startswith("non")
    down = {"negative", "nonpositive"}
    negative = (left in down) != (right in down)
    if either_weak:
        return "nonpositive" if negative else "nonnegative"
    return "negative" if negative else "positive"


def _sum_sign(left: str, right: str) -> str:
    for first, second in ((left, right), (right, left)):
        if first == "zero":
            return second
    if {left, right} <= {"positive", "nonnegative"}:
        return "positive" if "positive" in (left, right) else "nonnegative"
    if {left, right} <= {"negative", "nonpositive"}:
        return "negative" if "negative" in (left, right) else "nonpositive"
    return "real"


def _power_sign(sign: str, exponent: int) -> str:
    if exponent % 2:
        return sign
    return "positive" if sign in {"positive", "negative", "nonzero"} else "nonnegative"


def _sign_of_undeclared(name: str, signs: Mapping[str, str]) -> str:
    """Return the sign of a generator that is no parameter: of π, of a root, of exp and cosh."""
    found = function_named(name)
    if found is None:
        return "positive" if name == PI else "real"
    if found.kind == "CRootOf":
        return sign_of_number(found.value)
    if found.kind == "sqrt":
        return "positive" if sign_of(found.argument, signs) == "positive" else "real"
    if found.kind in {"asin", "atan", "sign", "sinh"}:
        return sign_of(found.argument, signs)
    if found.kind in {"acos", "abs"}:
        return "positive" if found.kind == "abs" and never_zero(found.argument, signs) else "nonnegative"
    return "positive" if found.kind in {"exp", "cosh"} else "real"


def _sum_of_terms(polynomial: Scalar, signs: Mapping[str, str]) -> str:
    if EIGENVALUE in polynomial.names:  # it may be complex: nothing is certain of its square either
        return "real"
    total = "zero"
    for lead, powers in _signed_terms(polynomial):
        sign = lead
        for name, exponent in powers:
            sign = _product_sign(sign, _power_sign(signs.get(name) or _sign_of_undeclared(name, signs), exponent))
        total = _sum_sign(total, sign)
        if total == "real":
            break
    if total in _WEAK and polynomial.field.functions and _has_both_of_an_angle(polynomial, signs):
        return _WEAK[total]
    return total


def _has_both_of_an_angle(polynomial: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether two terms are a power of cos x and one of sin x, which do not vanish together, times what never does."""
    found = set()
    for _, powers in polynomial.each_term():
        varying = [n for n, _ in powers if (signs.get(n) or _sign_of_undeclared(n, signs)) not in _NEVER_ZERO]
        function = function_named(varying[0]) if len(varying) == 1 else None
        if function is not None:
            found.add((function.kind, function.argument))
    return any(("cos", argument) in found for kind, argument in found if kind == "sin")


def _signed_terms(polynomial: Scalar) -> Iterator[tuple[str, tuple[tuple[str, int], ...]]]:
    """Yield the sign of the coefficient of each monomial, and its powers; roots of numbers belong to the coefficients."""
    if not polynomial.field.roots:
        for coefficient, powers in polynomial.each_term():
            yield ("positive" if coefficient > 0 else "negative"), powers
        return
    roots = {polynomial.field.names[index] for index, _ in polynomial.field.roots}
    for monomial, number in by_monomial(polynomial, roots).items():
        yield sign_of_number(number), monomial


def _sign_of_factor(factor: Scalar, signs: Mapping[str, str]) -> str:
    """Return the certain sign of an irreducible polynomial."""
    found = _sum_of_terms(factor, signs)
    if found == "real":
        found = sign_of_number(factor)
    if found == "real":
        found = _sign_beyond_one(factor, signs)
    if found == "real":
        found = _sign_without_roots(factor, signs)
    if found in {"real", "nonnegative", "nonpositive"} and 1 < factor.size <= _BY_LETTER_UP_TO:
        known = tuple((name, signs.get(name) or _sign_of_undeclared(name, signs)) for name in sorted(factor.names))
        found = _sign_by_letters(factor, known, found)
    return found


def _sign_beyond_one(factor: Scalar, signs: Mapping[str, str]) -> str:
    """Return the sign that follows from eˣ = 1 + w with w > 0, for each exponential whose x is positive."""
    found = ((name, function_named(name)) for name in factor.names)
    above = [
        name for name, f in found if f is not None and f.kind == "exp" and sign_of(f.argument, signs) == "positive"
    ]
    beyond = {name: f"w_{place}" for place, name in enumerate(above)}
    if not beyond or factor.names & {*beyond.values()}:
        return "real"
    moved = factor.substitute({name: 1 + Scalar.symbol(w) for name, w in beyond.items()})
    return _sum_of_terms(moved, {**signs, **dict.fromkeys(beyond.values(), "positive")})


def _sign_without_roots(factor: Scalar, signs: Mapping[str, str]) -> str:
    """Return the sign of an irreducible polynomial in one parameter that has no root where its sign lets the parameter be."""
    names = factor.names
    (name,) = names if len(names) == 1 else ("",)
    if name not in signs or factor.degree(name) < 2:
        return "real"
    side = _SIDE.get(signs[name], 0)
    polynomial = integer_factor(factor, name)
    at_the_end = polynomial[polynomial.degree()] * (side or 1) ** polynomial.degree()
    if (polynomial.degree() % 2 and not side) or (at_the_end > 0) != (polynomial[0] > 0):
        return "real"
    if any(not side or root.sign == side for root in real_roots(polynomial)):
        return "real"
    return "positive" if polynomial(side or 1) > 0 else "negative"


@lru_cache(maxsize=10_000)
def _sign_by_letters(factor: Scalar, declared: tuple[tuple[str, str], ...], known: str) -> str:
    """Return the sign of a polynomial that its coefficients as a polynomial in one of its letters show.

    Nothing is found beside an eigenvalue, or a root of which nothing is known: they may be complex.
    """
    signs = dict(declared)
    if (
        EIGENVALUE in signs
        or len(signs) > _BY_LETTERS
        or any(function_named(name) and sign not in _KNOWN for name, sign in declared)
    ):
        return known
    for name in factor.names:
        found = _sign_in_letter(factor.coefficients(name), name, signs)
        if found in _NEVER_ZERO:
            return found
        known = found if known == "real" else known
    names = factor.names if factor.size <= _BY_DISCRIMINANT_UP_TO else ()
    beside = (_sign_beside(factor, name, signs) for name in names)
    return next((sign for sign in beside if sign != "real"), known)


def _sign_beside(factor: Scalar, name: str, signs: Mapping[str, str]) -> str:
    """Return the sign of a polynomial that has no root in one letter x at a point, and so none at any other.

    Where neither its leading coefficient nor its discriminant vanishes, nor its value at an end x = 0 of the values of x,
    the number of its roots in x is the same at all values of the other letters, whose signs leave a connected set.
    """
    others = {n: "real" if sign == "nonzero" else sign for n, sign in signs.items() if n != name}
    if not 2 < factor.degree(name) <= _DISCRIMINANT_OF_DEGREE or not others:
        return "real"
    lead, *_, last = factor.coefficients(name)
    ends = (lead, last) if signs[name] in _SIDE else (lead,)
    if not all(never_zero(end, others) for end in ends) or not never_zero(discriminant(factor, name), others):
        return "real"
    found = sign_of(factor.substitute({n: Scalar.of(_SIDE.get(sign, 1)) for n, sign in others.items()}), signs)
    return found if found in {"positive", "negative"} else "real"


def _sign_in_letter(coefficients: Sequence[Scalar], name: str, signs: Mapping[str, str]) -> str:
    """Return the sign of Σ cᵢ xⁱ, the highest first, from the signs of the cᵢ, or by completing the square.

    With y = xᵏ and s = 4γ − β²/α the value times 4α is (2αy + β)² + α s: where α and γ are not negative and s is
    positive wherever it stands, the value is not negative, and 0 at most where α = 0 and so β = 0, as γ.
    """
    total, degree = "zero", len(coefficients) - 1
    there = [(degree - place, c) for place, c in enumerate(coefficients) if not c.is_zero]
    by_power = {power: _power_sign(signs[name], power) for power, _ in there if power}
    if by_power and not _KNOWN.issuperset(by_power.values()):  # an odd power of a letter of any sign
        total = "real"
    for power, coefficient in there if total != "real" else ():
        part = sign_of(coefficient, signs)
        total = _sum_sign(total, _product_sign(part, by_power[power]) if power else part)
        if total == "real":
            break
    if total != "real" or degree % 2:
        return total
    lead, middle, last = coefficients[0], coefficients[degree // 2], coefficients[-1]
    if any(c for power, c in enumerate(coefficients) if power not in {0, degree // 2, degree}):
        return total
    outer = {sign_of(lead, signs), sign_of(last, signs)}
    side = next((s for s in ("nonnegative", "nonpositive") if outer <= {s, _WEAK[s]}), None)
    if side is None:
        return total
    rest = 4 * last - middle**2 / lead
    if not never_zero(rest.denominator, signs):
        return total
    of_rest = sign_of(rest, signs)
    if of_rest == _WEAK[side] and sign_of(last, signs) == _WEAK[side]:
        return _WEAK[side]
    return side if of_rest in {side, _WEAK[side], "zero"} else total


def sign_of(value: Scalar, signs: Mapping[str, str]) -> str:
    """Return the certain sign of a value: one of `SIGNS`, or `zero`.

    `real` means nothing is certain.  Read off the terms of the value, or of its factors where those say more.
    """
    if value.is_zero:
        return "zero"
    whole = _product_sign(_sum_of_terms(value.numerator, signs), _sum_of_terms(value.denominator, signs))
    if whole not in {"real", "nonnegative", "nonpositive"} or value.size > FACTORED_UP_TO:
        return whole
    unit, factors = value.factors()
    sign = sign_of_number(unit)
    for factor, power in factors:
        sign = _product_sign(sign, _power_sign(_sign_of_factor(factor, signs), power))
    return whole if sign == "real" else sign


def sign_where(value: Scalar, signs: Mapping[str, str], above: Iterable[Scalar]) -> str:
    """Return the certain sign of a value where some polynomials are positive: of its quotient by one, or by all of them."""
    found, known = sign_of(value, signs), tuple(above)
    if found in {"positive", "negative", "zero"}:
        return found
    beside = (
        sign_of(value / polynomial, signs) for polynomial in (*known, *([product_of(known)] if known[1:] else []))
    )
    return next((sign for sign in beside if sign != "real"), found)


def never_zero(value: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether the declared signs alone imply that the value is nonzero."""
    return sign_of(value, signs) in _NEVER_ZERO


def vanishing_factors(values: Iterable[Scalar], signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return the distinct irreducible factors of numerators that can be 0 under the declared signs.

    A numerator of more than `FACTORED_UP_TO` terms is returned as it is: factoring it might not end.
    """
    found: dict[Scalar, None] = {}
    for value in values:
        if value.is_constant or _sum_of_terms(value.numerator, signs) in _NEVER_ZERO:
            continue
        if value.numerator.size > FACTORED_UP_TO or isinstance(value, SumOfSquares):
            found[value.numerator] = None
            continue
        for factor, _ in value.numerator.factors()[1]:
            if _sign_of_factor(factor, signs) not in _NEVER_ZERO:
                found[factor] = None
    return tuple(found)


def of_open_sign(value: Scalar, signs: Mapping[str, str]) -> Scalar:
    """Return a polynomial with the sign of a value: its factors of known sign left out, ζ − 1 for ω²ζ² − ω²."""
    if value.size > FACTORED_UP_TO or isinstance(value, SumOfSquares):
        return value
    unit, factors = value.factors()
    rest = Scalar.of(-1 if sign_of_number(unit) == "negative" else 1)
    for factor, power in factors:
        known = _power_sign(_sign_of_factor(factor, signs), power)
        if known == "negative":
            rest = -rest
        elif known != "positive":
            rest = rest * factor ** (power % 2 or 2)
    return value if rest.is_constant or sign_of_number(unit) not in {"positive", "negative"} else rest


def joined(own: Iterable[Condition], others: Iterable[Condition]) -> tuple[Condition, ...]:
    """Return conditions, and those of the others whose expressions are not among theirs."""
    first = tuple(own)
    known = {condition.expression for condition in first}
    return (*first, *(condition for condition in others if condition.expression not in known))


def nonzero(kind: str, factors: Iterable[Scalar]) -> Iterator[Condition]:
    """Yield the conditions of a kind that factors are not 0."""
    return (Condition(kind, factor) for factor in factors)


def real_consequences(polynomial: Scalar, signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return polynomials that vanish at all real zeros of `polynomial` with these signs.

    a² + b² = 0 only where a = b = 0: where no two terms have opposite signs, all of them vanish.  α x² + β x + γ = 0
    with 4αγ − β² ≥ 0 and α ≠ 0 only where 2αx + β = 0 and 4αγ − β² = 0.  Nothing is returned where neither applies.
    """
    if polynomial.size > FACTORED_UP_TO or EIGENVALUE in polynomial.names:
        return ()
    monomials = [powers for _, powers in _signed_terms(polynomial)]
    if len(monomials) > 1 and _sum_of_terms(polynomial, signs) != "real":
        return tuple(_radical(powers, signs) for powers in monomials)
    for name in sorted(polynomial.names):
        if polynomial.degree(name) != 2:
            continue
        lead, linear, constant = polynomial.coefficients(name)
        rest = 4 * lead * constant - linear**2
        if not rest.is_zero and never_zero(lead, signs) and sign_of(rest, signs) in {"positive", "nonnegative"}:
            return 2 * lead * Scalar.symbol(name) + linear, rest
    return ()


def _radical(powers: tuple[tuple[str, int], ...], signs: Mapping[str, str]) -> Scalar:
    """Return the product of those generators of a monomial that can be 0."""
    product = Scalar.of(1)
    for name, _ in powers:
        generator = Scalar.symbol(name)
        product = product if never_zero(generator, signs) else product * generator
    return product


def opposite(sign: str) -> str:
    """Return the sign of −x for the sign of x."""
    return _OPPOSITE.get(sign, sign)


#: A right-hand side of more terms is no solution that can be read.
_SOLVED_UP_TO = 3


def solved(value: Scalar, operator: str = "!=") -> tuple[Scalar, Scalar]:
    """Return the sides of p = 0 or p ≠ 0 solved for a parameter that stands in it alone, c and 2b of c − 2b.

    Of two terms with different signs each is a side, whatever the operator.
    """
    if operator in {"=", "!="} and value.denominator.is_constant:
        for name in sorted(name for name in value.names - {EIGENVALUE} if not function_named(name)):
            lead, *rest = value.coefficients(name)
            if len(rest) == 1 and lead.is_constant and rest[0].size - 1 <= _SOLVED_UP_TO:
                return Scalar.symbol(name), -rest[0] / lead
    terms = value.terms()
    if [coefficient > 0 for coefficient, _ in terms] in ([True, False], [False, True]):
        first, second = (
            prod((Scalar.symbol(name) ** power for name, power in powers), start=Scalar.of(abs(coefficient)))
            for coefficient, powers in sorted(terms, key=lambda term: term[0] < 0)
        )
        return first, second
    return value, Scalar.of(0)
