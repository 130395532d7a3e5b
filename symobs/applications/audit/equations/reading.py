"""A reading of an equation: its letters, its conditions, and where it is undefined or different."""

from __future__ import annotations

import re
from dataclasses import field
from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Scalar, TooLarge
from symobs.exact.core.generators import roots_in
from symobs.exact.core.polynomial import coefficients_over, product_of
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.system.conditions import sign_of, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from symobs.formula.expression.syntax_tree import SyntaxNode
    from symobs.formula.tree import Environment

    #: A part of an equation, and its value.
    Kept = dict[int | str, tuple[SyntaxNode, Any]]

_CONDITION = re.compile(r"(.+?)(!=|>=|<=|>|<)(.+)")
_STRICT = {"positive", "negative", "nonzero"}
_STRICT_OF = {"nonnegative": "positive", "nonpositive": "negative", "real": "nonzero"}
_NOT_NEGATIVE, _NOT_POSITIVE = {"positive", "nonnegative", "zero"}, {"negative", "nonpositive"}


@dataclass(frozen=True)
class EquationConditions:
    """The conditions of an equation, and the signs of the symbols with them.

    apart   of each group one is not 0
    above   what is not negative
    """

    text: str = ""
    signs: Mapping[str, str] = field(default_factory=dict)
    apart: tuple[tuple[Scalar, ...], ...] = ()
    above: tuple[Scalar, ...] = ()

    @staticmethod
    def of(text: str, signs: Mapping[str, str], place: str) -> EquationConditions:
        """Return the conditions of a text such as `c != 0, d > 0`; raises InputError for any other text."""
        apart, above = [], []
        for part in re.split(r",|\band\b", text):
            group = [_condition(each, signs, place) for each in re.split(r"\bor\b", part)]
            if len(group) > 1 and any(operator != "!=" for _, operator in group):
                raise InputError(
                    f'"{shown(part)}" has no plain meaning', where=place, repair='write "or" between != only'
                )
            if group[0][1] != ">=":
                apart.append(tuple(value for value, _ in group))
            if group[0][1] != "!=":
                above.append(group[0][0])
        return EquationConditions(text.strip(), _stronger(signs, apart, above), tuple(apart), tuple(above))

    def sign(self, value: Scalar) -> str:
        """Return the certain sign of a value."""
        found = sign_of(value, self.signs)
        ratios = [value / other for other in self.above]
        known = next((ratio.fraction() for ratio in ratios if ratio.is_constant and not ratio.is_zero), None)
        if known is None or found not in {"real", "nonzero"}:
            return found
        return "nonnegative" if known > 0 else "nonpositive"

    def excludes(self, values: Sequence[Scalar], nonzero: tuple[Scalar, ...]) -> bool:
        """Return whether values are seen not to vanish together here, where factors in `nonzero` do not vanish."""
        single = [value for group in self.apart if len(group) == 1 for value in group]
        try:
            if never_together_zero(values, (), self.signs, (*nonzero, *vanishing_factors(single, self.signs))):
                return True
            ideal = Ideal.of(values)
            return any(all(value in ideal for value in group) for group in self.apart)
        except TooLarge:
            return False


def _condition(text: str, signs: Mapping[str, str], place: str) -> tuple[Scalar, str]:
    """Return (value, operator): it is != 0, > 0 or >= 0."""
    match = _CONDITION.fullmatch(text.strip())
    if match is None:
        repair = 'write for example "where c != 0, d > 0"'
        raise InputError(f'a condition is expected, but "{shown(text.strip())}" came', where=place, repair=repair)
    left, right = (parse_scalar(side, signs, where=place) for side in (match[1], match[3]))
    difference, operator = left - right, match[2]
    return (-difference, operator.replace("<", ">")) if "<" in operator else (difference, operator)


def _stronger(signs: Mapping[str, str], apart: Sequence[tuple[Scalar, ...]], above: Sequence[Scalar]) -> dict[str, str]:
    """Return the signs strengthened by conditions on single symbols."""
    found = {}
    for name, declared in signs.items():
        symbol = Scalar.symbol(name)
        sign = "nonnegative" if symbol in above else "nonpositive" if -symbol in above else declared
        strict = declared in _STRICT or any(group in {(symbol,), (-symbol,)} for group in apart)
        found[name] = (
            declared if declared in {"positive", "negative"} else _STRICT_OF.get(sign, sign) if strict else sign
        )
    return found


@dataclass(frozen=True)
class Gap:
    """An exception: the common zeros of the values, or (`below`) negative values of a radicand."""

    values: tuple[Scalar, ...]
    says: str
    below: bool = False


@dataclass()
class Reading:
    """Letters and conditions of an equation; with `rounding`, decimals are read as generators.

    `gaps` are found as the equation is evaluated.  So are `squares`, f of a root of f² where the sign of f is open: its value
    is f, and for those in `turned` it is -f.  Where only the value is asked for, `kept` holds those of parts that were
    evaluated before in the same environment, by the letter or the identity of the part, which is held with it.
    """

    environment: Environment
    where: EquationConditions = field(default_factory=EquationConditions)
    rounding: bool = False
    turned: frozenset[Scalar] = frozenset()
    gaps: list[Gap] = field(default_factory=list)
    squares: list[Scalar] = field(default_factory=list)
    kept: Kept | None = None

    def fails_where(self, values: Iterable[Scalar], says: str) -> None:
        """Note that something fails where all these values are 0."""
        names = self.environment.signs.keys()
        found = [part for value in values for part in coefficients_over(_norm(value), names)]
        if not any(part.is_constant and not part.is_zero for part in found):
            self.gaps.append(Gap(tuple(found), says))

    def real_where(self, value: Scalar, root: str) -> None:
        """Note that a root is real only where a value is not negative."""
        if value.names <= self.environment.signs.keys() and self.where.sign(value) not in _NOT_NEGATIVE:
            self.gaps.append(Gap((value,), f"{root} is not real", below=True))

    def sign_of_square(self, factor: Scalar) -> int:
        """Return 1 or -1, the sign that is read for a factor."""
        sign = self.where.sign(factor)
        if sign in _NOT_NEGATIVE:
            return 1
        if sign in _NOT_POSITIVE:
            return -1
        if factor not in self.squares:
            self.squares.append(factor)
        return -1 if factor in self.turned else 1


def _norm(value: Scalar) -> Scalar:
    """Return a value without square roots that vanishes where this one does."""
    value = value.numerator
    for root in roots_in(value):
        q = Scalar.symbol(root.name)
        both = value * value.substitute({root.name: -q})
        even = list(reversed(both.coefficients(root.name)))[::2]
        value = sum((part * root.argument**power for power, part in enumerate(even)), Scalar.of(0)).numerator
    return value


def exceptions(reading: Reading, nonzero: tuple[Scalar, ...]) -> tuple[list[str], list[str]]:
    """Return the further conditions of an equation, and the failures where they are violated.

    Letters have no value where one of `nonzero` vanishes, so that nothing is said of that.
    """
    needed: dict[str, None] = {}
    reasons: dict[str, None] = {}
    for gap in reading.gaps:
        if gap.below:
            needed[f"{text_of_value(gap.values[0])} >= 0"] = None
            reasons[f"{gap.says} where {text_of_value(gap.values[0])} < 0"] = None
        elif not reading.where.excludes(gap.values, nonzero):
            groups = _parts(gap.values, reading.where, nonzero)
            needed |= dict.fromkeys(" or ".join(f"{text_of_value(value)} != 0" for value in group) for group in groups)
            places = " or ".join(" and ".join(f"{text_of_value(value)} = 0" for value in group) for group in groups)
            reasons[f"{gap.says} where {places}"] = None
    return list(needed), list(reasons)


def _parts(values: Sequence[Scalar], where: EquationConditions, nonzero: tuple[Scalar, ...]) -> list[list[Scalar]]:
    """Return the components of the common zeros: each common factor, and the cofactors together."""
    factored: list[dict[Scalar, int]] = [dict(value.factors()[1]) for value in values if not value.is_zero]
    common = [factor for factor in factored[0] if all(factor in other for other in factored)]
    groups = [[factor] for factor in common if not where.excludes([factor], nonzero)]
    rest = [product_of([factor for factor in each if factor not in common]) for each in factored]
    if not any(value.is_constant for value in rest) and not where.excludes(rest, nonzero):
        try:
            groups.append(list(Ideal.of(rest).generators))
        except TooLarge:
            groups.append(rest)
    return groups


def text_of_value(value: Any) -> str:
    """Return a value in the grammar of printed equations."""
    return str(value).replace("**", "^")
