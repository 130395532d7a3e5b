"""The steps by which f = 0 is solved, each an equivalence.

A product is 0 where a factor is; an unknown that stands linearly is solved for; an angle follows from its cosine, its
sine or its tangent, modulo 2π; a root, an exponential or a logarithm from its inverse function; a polynomial of second
degree by its formula, one with numbers by its real roots; what is left in one unknown and numbers is enclosed.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Ideal, Scalar
from symobs.exact.algebraic.isolation import isolated, sign_on
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.core.generators import (
    PI,
    Function,
    NotWritten,
    all_roots,
    function,
    function_named,
    functions_in,
    identities,
    root_of,
    symbols_in,
)
from symobs.ground.dataclass import dataclass
from symobs.system.conditions import Condition, never_zero, sign_of
from symobs.system.decided_signs import by_signs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

ZERO, ONE, _PI = Scalar.of(0), Scalar.of(1), Scalar.symbol(PI)
#: A search of more steps than these, or of longer equations, is given up.
_MOST_STEPS, _LONGEST = 400, 2_000
#: The side of 0 that a sign leaves to a letter.
SIDES = {"positive": 1, "nonnegative": 1, "negative": -1, "nonpositive": -1}
_WAVES = {"cos", "sin"}
_POSITIVE, _NEGATIVE = {"positive"}, {"negative"}


@dataclass
class Enclosure:
    """A narrow interval in which an equation has one zero in an unknown."""

    name: str
    low: Fraction
    high: Fraction
    equation: Scalar

    @property
    def interval(self) -> tuple[Fraction, Fraction]:
        """Its ends."""
        return self.low, self.high


@dataclass
class Branch:
    """What is left to solve, what is found, and what must hold: > 0, ≥ 0, ≠ 0 or = 0."""

    equations: tuple[Scalar, ...]
    values: Mapping[str, Scalar]
    conditions: tuple[Condition, ...]
    #: Angles w of which sin w = 0 is a branch of its own: where cos w = ±1 nothing is told twice.
    told: tuple[Scalar, ...] = ()
    #: Where the last unknown is known by numbers alone.
    within: Enclosure | None = None

    def where(self, name: str, value: Scalar) -> Branch:
        """Return the branch in which an unknown has a value."""
        at = {name: value}
        values = {key: known.substitute(at) for key, known in self.values.items()}
        equations = tuple(equation.substitute(at) for equation in self.equations)
        conditions = tuple(replace(c, expression=c.expression.substitute(at)) for c in self.conditions)
        return replace(self, equations=equations, values={**values, **at}, conditions=conditions)

    def without(self, equation: Scalar, *instead: Scalar) -> Branch:
        """Return the branch with other equations in place of one."""
        return replace(self, equations=(*(e for e in self.equations if e is not equation), *instead))

    def beside(self, equation: Scalar) -> Branch:
        """Return the branch with a further equation."""
        return replace(self, equations=(*self.equations, equation))

    def under(self, *conditions: tuple[Scalar, str]) -> Branch:
        """Return the branch under further conditions, each an expression and its relation to 0."""
        return replace(self, conditions=(*self.conditions, *(Condition("claim", e, sign) for e, sign in conditions)))


class Search:
    """The search for the solutions of equations; `open` collects the equations at which a branch stops."""

    def __init__(self, unknowns: Sequence[str], signs: Mapping[str, str]) -> None:
        self.unknowns, self.signs = tuple(unknowns), signs
        self.open: list[Scalar] = []
        self.steps = 0

    def solutions(self, branch: Branch) -> Iterator[Branch]:
        """Yield the branches in which nothing is left to solve."""
        self.steps += 1
        try:
            cleared = self.cleared(branch)
        except ZeroDivisionError:  # a value is not defined here: there is no solution
            return
        if cleared is None:
            return
        if not cleared.equations:
            yield cleared
            return
        if self.steps > _MOST_STEPS or any(equation.size > _LONGEST for equation in cleared.equations):
            self.open += cleared.equations
            return
        for step in (
            self._alone,
            self._by_factors,
            self._linearly,
            self._by_function,
            self._by_polynomial,
            self._by_quotient,
        ):
            for equation in sorted(cleared.equations, key=self._rank):
                try:
                    found = step(cleared, equation)
                except (NotWritten, ZeroDivisionError):
                    found = None
                if found is not None:
                    for each in found:
                        yield from self.solutions(each)
                    return
        yield from self._by_numbers(cleared)

    def _by_numbers(self, branch: Branch) -> Iterator[Branch]:
        """One equation of one unknown and numbers: an interval for each of its zeros, as far as the unknown's sign allows."""
        (equation, *others), known = branch.equations, [c.expression for c in branch.conditions]
        names = set[str]().union(*map(symbols_in, (equation, *known))) - {PI}
        if others or len(names) != 1 or not names <= {*self.unknowns}:
            self.open += branch.equations
            return
        (name,) = names
        side = SIDES.get(self.signs.get(name, "real"), 0)
        ends = (Fraction(0) if side > 0 else None, Fraction(0) if side < 0 else None)
        found, is_complete = isolated(equation.numerator, name, *ends)
        if not is_complete:
            self.open.append(equation)
        for low, high in found:
            conditions = [(c, _holds_on(c, name, (low, high))) for c in branch.conditions]
            if any(holds is False for _, holds in conditions):
                continue
            if any(holds is None for _, holds in conditions):
                self.open.append(equation)
                continue
            yield replace(branch, equations=(), conditions=(), within=Enclosure(name, low, high, equation))

    def _rank(self, equation: Scalar) -> tuple[int, int]:
        return len(self._unknown_in(equation)), equation.size

    def _unknown_in(self, value: Scalar) -> list[str]:
        inside = symbols_in(value)
        return [name for name in self.unknowns if name in inside]

    def cleared(self, branch: Branch) -> Branch | None:
        """Return a branch without what is true anyway; None where it contradicts itself."""
        equations, conditions = [], []
        for equation in branch.equations:
            below, value = equation.denominator, self.simplified(equation.numerator)
            if not below.is_constant and not never_zero(below, self.signs):
                conditions.append(Condition("domain", below))
            if value.is_zero:
                continue
            if self._unknown_in(value):
                equations.append(value)
            elif never_zero(value, self.signs):
                return None
            else:
                conditions.append(Condition("claim", value, "=="))
        for condition in branch.conditions:
            value = self.simplified(condition.expression)
            holds = _holds(condition.operator, self._sign(value))
            if holds is False:
                return None
            if holds is None:
                conditions.append(self._plain(replace(condition, expression=value)))
        return replace(branch, equations=tuple(equations), conditions=tuple(dict.fromkeys(conditions)))

    def simplified(self, value: Scalar) -> Scalar:
        """Return a value by the identities of its functions, with signs decided under roots and in |x|."""
        value = by_signs(value, self.signs)
        meanings, vanishing = identities([value])
        if not vanishing and not meanings:
            return value
        ideal = Ideal.of(vanishing)
        found = ideal.simplified(value.substitute(meanings) if meanings else value)
        return found if found.is_zero or found.size < value.size else value

    # -- the steps --------------------------------------------------------------------------------------------------

    def _alone(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """The one unknown of an equation, where it stands linearly."""
        return self._linearly(branch, equation) if len(self._unknown_in(equation)) == 1 else None

    def _by_factors(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """A product is 0 where one of its factors is; those that cannot vanish are left out."""
        _, factors = equation.factors()
        left = [factor for factor, _ in factors if not never_zero(factor, self.signs)]
        if len(left) == 1 and left[0] == equation:
            return None
        moving = [factor for factor in left if self._unknown_in(factor)]
        fixed = [(factor, "!=") for factor in left if factor not in moving]
        turned = [f.argument for factor in moving if (f := _alone(factor, {"sin"}))]
        found = [branch.without(equation, factor).under(*fixed) for factor in moving]
        return [
            *(
                each if _alone(factor, {"sin"}) else replace(each, told=(*each.told, *turned))
                for factor, each in zip(moving, found, strict=True)
            ),
            *(branch.without(equation).under((factor, "==")) for factor, _ in fixed),
        ]

    def _linearly(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """An unknown that stands outside of functions, once, with a coefficient without unknowns."""
        for name in self._unknown_in(equation):
            if self._is_inside(equation, name) or equation.degree(name) != 1:
                continue
            lead, rest = equation.coefficients(name)
            if not self._unknown_in(lead):
                there = branch.without(equation).where(name, -rest / lead)
                if never_zero(lead, self.signs):
                    return [there]
                return [there.under((lead, "!=")), branch.without(equation, rest).under((lead, "=="))]
        return None

    def _by_quotient(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """An unknown that stands linearly with a coefficient that may vanish: where it does, and where it does not."""
        for name in self._unknown_in(equation):
            if self._is_inside(equation, name) or equation.degree(name) != 1:
                continue
            lead, rest = equation.coefficients(name)
            return [
                branch.without(equation).where(name, -rest / lead).under((lead, "!=")),
                branch.without(equation, lead, rest),
            ]
        return None

    def _is_inside(self, value: Scalar, name: str) -> bool:
        return any(name in f.symbols for f in functions_in([value]))

    def _by_function(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """An unknown inside of one function, or of the cosine and the sine of one angle."""
        inside = [f for f in functions_in([equation]) if f.symbols & set(self.unknowns)]
        kinds = {f.kind for f in inside}
        outside = {name for name in self._unknown_in(equation) if name in equation.names}
        if kinds and kinds <= _WAVES:
            return self._by_angle(branch, equation, inside, outside)
        for f in sorted(inside, key=lambda f: f.text):
            if equation.degree(f.name) != 1 or (len(inside) > 1 and f.kind != "sqrt"):
                continue
            lead, rest = equation.coefficients(f.name)
            if never_zero(lead, self.signs) and (not self._unknown_in(rest) or f.kind in {"sqrt", "abs"}):
                return self._inverted(branch.without(equation), f, -rest / lead)
        return None

    def _inverted(self, branch: Branch, f: Function, value: Scalar) -> list[Branch] | None:
        """f(w) = value as equations for w."""
        w = f.argument
        match f.kind:
            case "sqrt":
                return [branch.beside(w - value * value).under((value, ">="))]
            case "abs":
                return [branch.beside(w - side).under((value, ">=")) for side in (value, -value)]
            case "exp":
                return [branch.beside(w - function("log", value)).under((value, ">"))]
            case "log":
                return [branch.beside(w - function("exp", value))]
            case "atan":
                tangent = function("sin", value) / function("cos", value)
                half = _PI / 2
                return [branch.beside(w - tangent).under((half - value, ">"), (half + value, ">"))]
        return None

    def _by_angle(
        self, branch: Branch, equation: Scalar, inside: Sequence[Function], outside: set[str]
    ) -> list[Branch] | None:
        """p(cos w) + q(cos w) sin w = 0 for one angle w."""
        if len({f.argument for f in inside}) > 1:
            meanings, _ = identities([equation])
            in_base = equation.substitute(meanings)
            base = [f for f in functions_in([in_base]) if f.symbols & set(self.unknowns)]
            if len({f.argument for f in base}) == 1:
                branch, equation, inside = branch.without(equation, in_base), in_base, base
        for w in sorted({f.argument for f in inside}, key=str):
            others = outside.union(*(f.symbols for f in inside if f.argument != w))
            solved = self._solved_for(w, others)
            if solved is not None:
                return self._of_angle(branch, equation, w, solved)
        return None

    def _of_angle(
        self, branch: Branch, equation: Scalar, w: Scalar, solved: tuple[str, Callable[[Scalar], Scalar]]
    ) -> list[Branch] | None:
        """Return the branches of an equation in cos w and sin w, with an unknown that follows from w."""
        name, of_angle = solved
        c, s = (Function(kind, w).name for kind in ("cos", "sin"))
        p, q = _split_in_sine(equation.numerator, c, s)
        rest = branch.without(equation)
        found: list[tuple[Scalar, list[tuple[Scalar, str]]]] = []
        strict = ">" if w in branch.told else ">="
        if q.is_zero:
            for root, conditions in self._roots_in(p, c, name) or ():
                for side, bound in self._angles(root, strict, "acos"):
                    found.append((side, [*conditions, *bound]))
        elif c not in p.names | q.names and name not in self._unknown_in(p / q):
            apart = [] if never_zero(q, self.signs) else [(q, "!=")]
            for side, bound in self._angles(-p / q, ">=", "asin"):
                found.append((side, [*apart, *bound]))
        else:
            found = self._by_tangent(p, q, c)
        if not found and not self._is_beyond(p, q, c):
            return None
        return [rest.where(name, of_angle(angle)).under(*conditions) for angle, conditions in found]

    def _is_beyond(self, p: Scalar, q: Scalar, c: str) -> bool:
        """Return whether an equation of one cosine or one sine has no solution, not whether none was found."""
        if not q.is_zero:
            return c not in p.names | q.names
        return self._roots_in(p, c) is not None

    def _solved_for(self, w: Scalar, others: set[str]) -> tuple[str, Callable[[Scalar], Scalar]] | None:
        """Return an unknown that stands linearly in an angle and nowhere else, and its value for that of the angle."""
        for name in self._unknown_in(w):
            if name in others or self._is_inside(w, name) or w.degree(name) != 1 or not w.denominator.is_constant:
                continue
            lead, rest = w.coefficients(name)
            if lead.is_constant and abs(lead.fraction()) == 1:
                return name, lambda angle, rest=rest, lead=lead: turned_back((angle - rest) / lead)
        return None

    def _angles(self, value: Scalar, strict: str, inverse: str) -> list[tuple[Scalar, list[tuple[Scalar, str]]]]:
        """Return the angles w in (−π, π] with cos w = value, or sin w = value, each with its conditions."""
        value = self.simplified(value)
        if value.is_constant and abs(value.fraction()) > 1:
            return []
        if value.is_constant and value.fraction() in {-1, 0, 1}:
            number = value.fraction()
            table = {1: (ZERO,), 0: (_PI / 2, -_PI / 2), -1: (_PI,)}
            if inverse == "asin":
                table = {1: (_PI / 2,), 0: (ZERO, _PI), -1: (-_PI / 2,)}
            return [(angle, []) for angle in table[int(number)]]
        bounds = self._within_one(value, strict)
        if bounds is None:
            return []
        first = function(inverse, value)
        second = -first if inverse == "acos" else _PI - first
        return [(first, bounds), (second, bounds)]

    def _within_one(self, value: Scalar, strict: str) -> list[tuple[Scalar, str]] | None:
        """Return the conditions of |value| ≤ 1; None where it cannot be."""
        conditions = []
        for bound in (1 - value, 1 + value):
            sign = sign_of(bound, self.signs)
            if sign in _NEGATIVE:
                return None
            if _holds(strict, sign):
                continue
            conditions.append((bound, strict))
        return conditions

    def _by_tangent(self, p: Scalar, q: Scalar, c: str) -> list[tuple[Scalar, list[tuple[Scalar, str]]]]:
        """A cos w + C + B sin w = 0: by tan w where C = 0, else by tan w/2."""
        if c in q.names or p.degree(c) > 1 or self._unknown_in(q):
            return []
        A, C = p.coefficients(c) if p.degree(c) == 1 else (ZERO, p)
        if self._unknown_in(A) or self._unknown_in(C) or not never_zero(q, self.signs):
            return []
        if C.is_zero:
            first = -function("atan", A / q)
            return [(first, []), (_PI + first if sign_of(A / q, self.signs) != "negative" else first - _PI, [])]
        if not never_zero(C - A, self.signs):
            return []
        root = by_signs(root_of(A * A + q * q - C * C), self.signs)
        bound = [(A * A + q * q - C * C, ">=")]
        return [(2 * function("atan", (-q + side * root) / (C - A)), bound) for side in (1, -1)]

    def _by_polynomial(self, branch: Branch, equation: Scalar) -> list[Branch] | None:
        """A polynomial in an unknown that stands in no function."""
        for name in reversed(self._unknown_in(equation)):
            if self._is_inside(equation, name):
                continue
            roots = self._roots_in(equation, name)
            if roots is not None:
                rest = branch.without(equation)
                return [rest.where(name, root).under(*conditions) for root, conditions in roots]
        return None

    def _roots_in(
        self, polynomial: Scalar, name: str, unknown: str = ""
    ) -> list[tuple[Scalar, list[tuple[Scalar, str]]]] | None:
        """Return the real roots of a polynomial in a name, each with its conditions; None where they have no closed form.

        The roots may depend on other unknowns than the one that is solved for.
        """
        found: list[tuple[Scalar, list[tuple[Scalar, str]]]] = []
        for factor, _ in polynomial.factors()[1]:
            if name not in factor.names:
                if self._unknown_in(factor):
                    return None
                continue
            if any(unknown in self._unknown_in(c) for c in factor.coefficients(name)):
                return None
            roots = self._roots_of_factor(factor, name)
            if roots is None:
                return None
            found += roots
        return found

    def _roots_of_factor(self, factor: Scalar, name: str) -> list[tuple[Scalar, list[tuple[Scalar, str]]]] | None:
        coefficients = factor.coefficients(name)
        lead, degree = coefficients[0], len(coefficients) - 1
        apart = [] if never_zero(lead, self.signs) else [(lead, "!=")]
        if degree == 1:
            return [(-coefficients[1] / lead, apart)]
        if all(c.is_constant for c in coefficients) and degree > 2:
            return [(root.scalar(), []) for root in roots_of_scalar(factor, name)]
        if degree == 2:
            half, square = -coefficients[1] / (2 * lead), coefficients[2] / lead
            return self._pair(half, half * half - square, apart)
        if degree == 4 and coefficients[1].is_zero and coefficients[3].is_zero:
            half, square = -coefficients[2] / (2 * lead), coefficients[4] / lead
            return [
                (side, [*conditions, *more])
                for inner, conditions in self._pair(half, half * half - square, apart)
                for side, more in self._pair(ZERO, inner, [])
            ]
        return None

    def _pair(
        self, half: Scalar, radicand: Scalar, apart: list[tuple[Scalar, str]]
    ) -> list[tuple[Scalar, list[tuple[Scalar, str]]]]:
        """Return half ± √radicand where the radicand is not negative."""
        sign = sign_of(radicand, self.signs)
        if sign == "negative":
            return []
        if sign == "zero":
            return [(half, apart)]
        bound = [*apart] if sign in {"positive", "nonnegative"} else [*apart, (radicand, ">=")]
        root = by_signs(root_of(radicand), self.signs)
        return [(half + root, bound), (half - root, bound)]

    def _sign(self, value: Scalar) -> str:
        """Return the certain sign of a value; a root is not negative wherever it is real."""
        open_roots = (root for root in all_roots(value) if sign_of(root.argument, self.signs) != "positive")
        return sign_of(value, {**{root.name: "nonnegative" for root in open_roots}, **self.signs})

    def _plain(self, condition: Condition) -> Condition:
        """Return an equivalent condition without the factors that have a sign; √a > 0 is a > 0."""
        unit, factors = condition.expression.factors()
        left, side = ONE, 1 if sign_of(unit, self.signs) != "negative" else -1
        for factor, power in factors:
            sign, is_odd = self._sign(factor), power % 2
            if sign in {"positive", "negative"}:
                side = -side if sign == "negative" and is_odd else side
            elif (inner := _alone(factor, {"sqrt", "acos"})) is not None and condition.operator in {">", "!="}:
                instead = inner.argument if inner.kind == "sqrt" else 1 - inner.argument
                return self._plain(replace(condition, expression=condition.expression / factor**power * instead))
            elif is_odd or condition.operator != ">=":
                left = left * factor if is_odd else left * factor**2
        is_told = condition.operator in {"!=", "=="}
        return replace(condition, expression=left if is_told else left * side)


_TRUE = {
    ">": _POSITIVE,
    ">=": {"positive", "nonnegative", "zero"},
    "!=": {"positive", "negative", "nonzero"},
    "==": {"zero"},
}
_FALSE = {
    ">": {"negative", "nonpositive", "zero"},
    ">=": _NEGATIVE,
    "!=": {"zero"},
    "==": {"positive", "negative", "nonzero"},
}


def _holds_on(condition: Condition, name: str, interval: tuple[Fraction, Fraction]) -> bool | None:
    """Return whether a condition holds on an interval; None where that is not seen."""
    signs = {1: "positive", -1: "negative", 0: "real"}
    return _holds(condition.operator, signs[sign_on(condition.expression, name, interval)])


def _holds(operator: str, sign: str) -> bool | None:
    """Return whether a value of this sign stands in a relation to 0; None where the sign leaves it open."""
    return True if sign in _TRUE[operator] else False if sign in _FALSE[operator] else None


def _alone(factor: Scalar, kinds: set[str]) -> Function | None:
    """Return the function of one of the kinds that a factor is."""
    if len(factor.names) != 1:
        return None
    found = function_named(next(iter(factor.names)))
    return found if found is not None and found.kind in kinds and factor == found.value else None


def _split_in_sine(value: Scalar, c: str, s: str) -> tuple[Scalar, Scalar]:
    """Return (p, q) with value = p + q sin w, neither with the sine: sin² is 1 − cos²."""
    parts = [ZERO, ZERO]
    if s not in value.names:
        return value, ZERO
    square = 1 - Scalar.symbol(c) ** 2
    for power, coefficient in enumerate(reversed(value.coefficients(s))):
        parts[power % 2] = parts[power % 2] + coefficient * square ** (power // 2)
    return parts[0], parts[1]


def turned_back(angle: Scalar) -> Scalar:
    """Return an angle with its multiple of π in (−π, π]."""
    if PI not in angle.names or not angle.is_polynomial_in(PI) or angle.degree(PI) != 1:
        return angle
    turns, rest = angle.coefficients(PI)
    if not turns.is_constant:
        return angle
    number = turns.fraction()
    within = number - 2 * ((number + 1) // 2)
    return (Fraction(1) if within == -1 and rest.is_zero else within) * _PI + rest
