"""Equality of values with roots and functions of letters whose signs are declared: it holds, it does not, or it is open.

√a √b and √(a b), √(1/r + 2/√r) and √(r + 2 r^(3/2))/r are equal where the letters are positive, although they are written
with roots that no polynomial relation connects.  There are three answers, and none is guessed.

- *Equal by form*: the difference vanishes modulo the relations of the roots and functions (`identities`).
- *Different*: at one point with the declared signs an enclosure of the difference keeps clear of 0.
- *Equal*: at random rational points with the declared signs the difference is 0 (`zero_at_point`).  A difference that is
  not 0 everywhere has a norm that is not, a rational function, which is 0 at a random point with small probability
  (Schwartz and Zippel); and what is 0 near a point is 0 as far as no radicand vanishes, which the signs have to show.

Where it is open `TooLarge` is raised.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from itertools import product
from random import Random
from typing import TYPE_CHECKING, Any, TypeVar, cast

from symobs.exact import Matrix, Scalar, TooLarge
from symobs.exact.algebraic.rounded_decimals import decimals_in, rounds_to
from symobs.exact.algebraic.zero_at_point import Outside, is_apart, vanishes_at
from symobs.exact.core.generators import (
    PI,
    NotWritten,
    all_roots,
    functions_in,
    identities,
    roots_in,
    substitute,
    symbols_in,
)
from symobs.exact.time_functions.matrix_power import PowerOf, by_factors
from symobs.formula.tree import Environment, Literal, Relation
from symobs.proof.certificate.claims import verify
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


Value = TypeVar("Value", bound="Scalar | Matrix")

#: So many letters of open sign are looked at on both sides of 0, and at so many points on each.
_MOST_OPEN, _POINTS = 5, 5
#: So many points are drawn for one at which a value is real.
_DRAWN = 60
#: At so many instants sequences are held against each other that are not equal by their form.
_INSTANTS = 12
#: The side of 0 on which a declared letter lies but for 0 itself.
_SIDES = {"positive": (1,), "nonnegative": (1,), "negative": (-1,), "nonpositive": (-1,)}
_NAMED = {1: "positive", -1: "negative"}


def agrees(expected: Scalar | Matrix, found: Scalar | Matrix, signs: Mapping[str, str] | None = None) -> bool:
    """Return whether the value found equals the expected one, or rounds to its decimals; raises `TooLarge` where it is open."""
    if not decimals_in(expected):
        return bool(expected == found) or functions_agree(expected, found, signs)
    pairs = [(expected, found)]
    if isinstance(expected, Matrix) and isinstance(found, Matrix):
        if expected.shape != found.shape:
            return False
        pairs = list(zip(expected.entries, found.entries, strict=True))
    return all(rounds_to(one, other) for one, other in pairs)  # type: ignore[arg-type]


def functions_agree(left: Scalar | Matrix, right: Scalar | Matrix, signs: Mapping[str, str] | None = None) -> bool:
    """Return whether two values are equal as functions of letters with these signs.

    Decimals of the one on the left may be rounded.  Raises `TooLarge` where it is open.
    """
    if decimals_in(left):
        return agrees(left, right)
    if not functions_in([left, right]):
        return bool(left == right)
    if any(isinstance(function, PowerOf) for function in functions_in([left, right])):
        return _sequences_agree(left, right, signs)
    if equal_by_form(left, right):
        return True
    _, known, reason = in_form_of(left, right, signs or {})
    if known == OPEN:
        raise TooLarge(reason)
    return known == EQUAL


#: What is known of two values.
EQUAL, DIFFERENT, OPEN = "equal", "different", "open"


def in_form_of(value: Value, right: object, signs: Mapping[str, str]) -> tuple[Value, str, str]:
    """Return a value in the form of the right one as far as they are equal; whether they are; and why that is open."""
    if isinstance(value, Scalar) and isinstance(right, Scalar):
        known, reason = _compared(value, right, signs)
        return cast("Value", right if known == EQUAL else value), known, reason
    if not isinstance(value, Matrix) or not isinstance(right, Matrix) or value.shape != right.shape:
        return value, DIFFERENT, ""
    found = [
        [_compared(mine, its, signs) for mine, its in zip(*rows, strict=True)]
        for rows in zip(value.rows, right.rows, strict=True)
    ]
    rows = [
        [(right if known == EQUAL else value)[i, j] for j, (known, _) in enumerate(row)] for i, row in enumerate(found)
    ]
    entries = {known for row in found for known, _ in row}
    whole = next((known for known in (DIFFERENT, OPEN) if known in entries), EQUAL)
    why = next((why for row in found for _, why in row if why), "")
    return cast("Value", Matrix.of(rows, right.shape[1])), whole, why


def _compared(left: Scalar, right: Scalar, signs: Mapping[str, str]) -> tuple[str, str]:
    if left == right:
        return EQUAL, ""
    if not functions_in([left, right]):
        return DIFFERENT, ""
    try:
        return (EQUAL if equal_by_form(left, right) or _agree(left, right, signs) else DIFFERENT), ""
    except TooLarge as error:
        return OPEN, str(error)


def equal_by_form(left: Scalar | Matrix, right: Scalar | Matrix) -> bool:
    """Return whether the difference vanishes modulo the relations of roots, exponentials, cosines and sines."""
    try:
        meanings, relations = identities([left, right])
    except NotWritten as error:
        raise TooLarge(str(error)) from error
    environment = Environment(coefficients=meanings, relations=relations)
    return bool(verify(Relation((Literal(left), Literal(right)), ("=",)), environment)[0])


def _sequences_agree(left: Any, right: Any, signs: Mapping[str, str] | None) -> bool:
    """Return whether two functions of k with powers λᵏ are equal at all k ≥ 0."""
    if by_factors(left) == by_factors(right):
        return True
    for k in range(_INSTANTS):
        try:
            one, other = (substitute(value, {"k": Scalar.of(k)}) for value in (left, right))
        except ZeroDivisionError:
            return False
        if not functions_agree(one, other, signs):
            return False
    message = f"the sequences are equal at the first {_INSTANTS} instants"
    raise TooLarge(message)


# Values that are not equal by their form.


def _agree(left: Scalar, right: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether two values are equal wherever the one on the right is real."""
    draw = Random(f"{left} {right}")  # noqa: S311 - points, no secrets
    names = sorted(symbols_in(left) | symbols_in(right))
    difference, is_open, seen = left - right, False, 0
    for sides in _sides(names, signs, draw):
        there = {name: _NAMED[side] for name, side in sides.items()}
        walls = [_strict_sign(root.argument, there) for root in all_roots(right)]
        if "negative" in walls:
            continue
        found = _points(left, right, sides, draw)
        seen += len(found)
        if any(apart for _, apart in found):
            return False
        is_open = (
            is_open or not _same_walls(left, right, there) or not all(_vanishes(difference, at) for at, _ in found)
        )
    if is_open or not seen:
        raise TooLarge("whether the two are equal for all values of the letters is not decided")
    return True


def _sides(names: list[str], signs: Mapping[str, str], draw: Random) -> Iterator[dict[str, int]]:
    """Yield on which side of 0 each letter is, in all ways that its sign allows; of many letters, some of them."""
    allowed = {name: (1,) if name == PI else _SIDES.get(signs.get(name, ""), (1, -1)) for name in names}
    if sum(len(sides) > 1 for sides in allowed.values()) > _MOST_OPEN:
        for _ in range(2**_MOST_OPEN):
            yield {name: draw.choice(sides) for name, sides in allowed.items()}
        return
    for chosen in product(*allowed.values()):
        yield dict(zip(names, chosen, strict=True))


def _points(
    left: Scalar, right: Scalar, sides: Mapping[str, int], draw: Random
) -> list[tuple[dict[str, Fraction], bool]]:
    """Return random points at which both are defined and the right value is real, and whether they are apart there."""
    found: list[tuple[dict[str, Fraction], bool]] = []
    for _ in range(_DRAWN):
        at = {
            name: side * Fraction(draw.getrandbits(20) | 1, 2 ** draw.randint(16, 22)) for name, side in sides.items()
        }
        try:
            apart = is_apart(left, right, {name: value for name, value in at.items() if name != PI})
        except Outside:
            continue
        found.append((at, apart))
        if apart or len(found) == _POINTS:
            break
    return found


def _vanishes(difference: Scalar, at: Mapping[str, Fraction]) -> bool:
    try:
        return vanishes_at(difference, at)
    except Outside:
        return False


def _same_walls(left: Scalar, right: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether no root of the left value branches where the right one is real, as far as signs show."""
    own = {root.argument for root in all_roots(right)}
    others = (root.argument for root in all_roots(left))
    return all(argument in own or _strict_sign(argument, signs) == "positive" for argument in others)


@lru_cache(maxsize=4096)
def _strict_sign_of(value: Scalar, signs: tuple[tuple[str, str], ...]) -> str:
    known = dict(signs)
    found = sign_of(value, {**known, **{root.name: "positive" for root in all_roots(value)}})
    if found in {"positive", "negative", "zero"}:
        return found
    polynomial = value.numerator * value.denominator
    for root in reversed(roots_in(polynomial)):
        if root.square:
            continue
        coefficients = polynomial.coefficients(root.name)
        parts = [Scalar.of(0), Scalar.of(0)]
        for power, coefficient in enumerate(reversed(coefficients)):
            parts[power % 2] = parts[power % 2] + coefficient * root.argument ** (power // 2)
        alone, beside = (_strict_sign_of(part, signs) for part in parts)
        if "real" in (alone, beside):
            continue
        if "zero" in (alone, beside) or alone == beside:
            return beside if alone == "zero" else alone
        larger = _strict_sign_of(parts[0] ** 2 - parts[1] ** 2 * root.argument, signs)  # of x² - y² u for x + y √u
        if larger != "real":
            return {"positive": alone, "negative": beside}.get(larger, "zero")
    return "real"


def _strict_sign(value: Scalar, signs: Mapping[str, str]) -> str:
    """Return the sign that a value has for certain where its roots and letters are not 0: `real` where it is not seen.

    Of x + y √u with x and y of different signs it is that of x where x² - y² u is positive, else that of y.
    """
    return _strict_sign_of(value, tuple(sorted(signs.items())))
