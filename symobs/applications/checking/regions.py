"""Equality of regions: the conditions of a student and the exact region of the result.

With one parameter the line is divided at every critical point of both, with two the plane by the curves of both; then both are
asked at a point of every piece.  A difference always comes with a rational point, unless it lies on boundaries only.
"""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import product
from math import prod
from random import Random
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.audit.differences import single
from symobs.applications.checking.answers import exact, has_decimals
from symobs.applications.checking.rounded import has_digits, in_enough_digits
from symobs.exact import Complex, Scalar, TooLarge
from symobs.exact.algebraic.enclosure import near
from symobs.exact.algebraic.real_algebraic import (
    RealNumber,
    RealRoot,
    integer_factor,
    rational_between,
    roots_of_scalar,
)
from symobs.exact.algebraic.root_location import value_at
from symobs.exact.algebraic.rounded_decimals import PrintedDecimal, conjugates, product_of_linear, written_out
from symobs.exact.core.generators import function_named
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, NotShown
from symobs.problem.expect import conditions_agree
from symobs.stability.criteria.critical_polynomials import irreducible
from symobs.stability.regions.region import LineRegion, PlaneRegion
from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from symobs.problem.fields import Marking
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials, StabilityBoundary

    Height = Fraction | RealNumber


# Conditions as students write them: chains, conjunctions and unions of inequalities.


_OPERATOR = re.compile(r"(!=|>=|<=|>|<|==|=)")
_AND = re.compile(r"\band\b|&&?|[,;]")
_OR = re.compile(r"\bor\b|\|\|?")
#: What stands behind digits that are not all there are.
_CUT_OFF = re.compile(r"(?<=\d)(?:…|\.\.\.)")
_MOST, _DEEPEST = 40, 10
#: The bits of approximations of ends.
_BITS = 256
#: A union of conjunctions.
Union = tuple[tuple["Inequality", ...], ...]


class Inequality(NamedTuple):
    """value > 0, value >= 0 or value != 0, and how it was written.

    Of one with an irrational `end` the value is a number times the distance of its only letter from that.
    """

    value: Scalar
    operator: str
    text: str
    end: RealNumber | None = None

    def holds(self, sign: int) -> bool:
        """Return whether it holds where the value has this sign."""
        return sign > 0 if self.operator == ">" else sign >= 0 if self.operator == ">=" else sign != 0


#: What says that nothing is stable, and that everything is, as people answer whether it is.
_NEVER = re.compile(r"false|no|nein|never|nie|(not|nicht) (stable|stabil)|unstable|instabil", re.IGNORECASE)
_ALWAYS = re.compile(r"true|yes|ja|always|immer|((always|immer) )?(stable|stabil)", re.IGNORECASE)


def read_conditions(given: Any, names: Any, where: str = "stable_if", *, rounding: bool = False) -> Union:
    """Return the conditions of a text, of a list (all of them hold) or of a list of lists (one of them holds).

    With `rounding` decimals stay what was printed, else they are fractions. Raises `InputError` for what is no condition.
    """
    given = _unpacked(given)
    read = partial(_conjunction, names=names, where=where, rounding=rounding)
    if isinstance(given, str):
        union = [read(parts) for parts in _disjuncts(given, where)]
    elif isinstance(given, list) and any(isinstance(part, list) for part in given):
        union = [read(part if isinstance(part, list) else [part]) for part in given]
    elif isinstance(given, list) and len(given) > 1 and any(map(_OR.search, map(str, given))):
        raise InputError('a list with "or" has two readings', where=where, repair="write a list of lists")
    elif isinstance(given, list) and len(given) == 1:
        return read_conditions(given[0], names, where, rounding=rounding)
    elif isinstance(given, list):
        union = [read(given)]
    else:
        raise InputError("conditions are expected", where=where, repair='write "h1 > 3 and h2 > 0"')
    found = tuple(part for part in union if part is not None)
    if sum(map(len, found)) > _MOST:
        raise InputError(f"more than {_MOST} conditions", where=where, repair="write fewer")
    return found


def _unpacked(given: Any) -> Any:
    """Return the conditions in a text that is a list, of texts in quotes or of conditions; another value as it is."""
    if not isinstance(given, str):
        return given
    text = given.strip()
    if '"' in text or "'" in text:
        inside = text.replace("'", '"')
        with suppress(ValueError, RecursionError):
            return json.loads(inside if inside.startswith("[") else f"[{inside}]")
    return text[1:-1] if text[:1] + text[-1:] in {"[]", "{}"} else text


def _conjunction(parts: Sequence[Any], names: Any, where: str, *, rounding: bool) -> tuple[Inequality, ...] | None:
    """Return the inequalities that hold together; None where one of them is False."""
    found: list[Inequality] = []
    for part in parts:
        if not isinstance(part, str):
            raise InputError("a condition is a text", where=where, repair='write "h1 > 3"')
        together = _disjuncts(part, where)
        if len(together) > 1:
            raise InputError('a list with "or" has two readings', where=where, repair="write a list of lists")
        for text in together[0]:
            if _NEVER.fullmatch(text):
                return None
            if text and not _ALWAYS.fullmatch(text):
                found += _chain(text, names, where, rounding=rounding)
    return tuple(found)


def _disjuncts(text: str, where: str, depth: int = 0) -> list[list[str]]:
    """Return the conditions of a text with "and", "or" and brackets: one of the lists holds, all of its conditions do."""
    if depth > _DEEPEST:
        raise InputError("brackets are nested too deeply", where=where, repair="write the conditions as a list")
    inner = _without_brackets(text)
    if len(pieces := _outside_brackets(inner, _OR)) > 1:
        found = [each for piece in pieces for each in _disjuncts(piece, where, depth + 1)]
    elif len(pieces := _outside_brackets(inner, _AND)) > 1:
        parts = [_disjuncts(piece, where, depth + 1) for piece in pieces]
        if prod(map(len, parts)) > _MOST:
            raise InputError(f"more than {_MOST} conditions", where=where, repair="write fewer")
        found = [[text for part in each for text in part] for each in product(*parts)]
    else:
        return [[inner]] if inner == text.strip() else _disjuncts(inner, where, depth + 1)
    if len(found) > _MOST:
        raise InputError(f"more than {_MOST} conditions", where=where, repair="write fewer")
    return found


def _outside_brackets(text: str, separator: re.Pattern[str]) -> list[str]:
    """Return the parts of a text between separators that stand in no bracket."""
    found, depth, start, seen = [], 0, 0, 0
    for place in separator.finditer(text):
        between, seen = text[seen : place.start()], place.start()
        depth += between.count("(") - between.count(")")
        if depth == 0:
            found.append(text[start : place.start()])
            start = place.end()
    return [*found, text[start:]]


def _without_brackets(text: str) -> str:
    """Return a text without the brackets around all of it."""
    inner = text.strip()
    if not inner.startswith("(") or not inner.endswith(")"):
        return inner
    depth = 0
    for place, character in enumerate(inner):
        depth += (character == "(") - (character == ")")
        if not depth and place < len(inner) - 1:
            return inner
    return inner[1:-1] if _OPERATOR.search(inner) else inner


def _chain(text: str, names: Any, where: str, *, rounding: bool) -> list[Inequality]:
    """Return the inequalities of a chain: 3 < h1 < 8."""
    pieces = _OPERATOR.split(text)
    if len(pieces) < 3 or any(operator in {"=", "=="} for operator in pieces[1::2]):
        repair = 'write for example "h1 > 3" or "3 < h1 < 8"'
        raise InputError(f'"{shown(text, 60)}" is no condition', where=where, repair=repair)
    options: dict[str, Any] = {"where": where, "functions": True, "rounding": rounding}
    told = [_CUT_OFF.sub("", side) for side in pieces[::2]]
    sides = [parse_scalar(side if rounding else exact(side), names, **options) for side in told]
    found: list[Inequality] = []
    for i, operator in enumerate(pieces[1::2]):
        value = sides[i] - sides[i + 1] if operator in {">", ">=", "!="} else sides[i + 1] - sides[i]
        plain = operator.replace("<", ">")
        below = value.denominator
        written = f"{pieces[2 * i].strip()} {operator} {pieces[2 * i + 2].strip()}"
        found.append(Inequality(value.numerator * below, plain, written))
        if plain != ">" and not below.is_constant:
            found.append(Inequality(below, "!=", written))
    return found


#: So many points are tried where there is no exact region, before the question is left open.
_MOST_TRIED = 4000
_TRIED = tuple(map(Fraction, ["1", "2", "-1", "3", "1/2", "-2", "5", "10", "1/10", "-5", "20", "100"]))


@dataclass
class Separation:
    """The verdict on a region; where it is `wrong`, a point that lies in one of both only, or the boundary alone differs.

    slip and reason where one change of the conditions makes both equal.
    """

    verdict: str
    point: Mapping[str, Fraction] | None = None
    inside: bool = False
    boundary: bool = False
    slip: str = ""
    reason: str = ""
    polynomial: str = ""


def region_verdict(result: Any, given: Any, names: Any, marking: Marking) -> Separation:
    """Return whether conditions describe the region of a result, with the slip `rounded` where their decimals round its ends.

    Raises `InputError` where they cannot be read, and `NotShown` where they have functions, or roots beside two parameters.
    """
    known = {**dict.fromkeys(result.question.parameters, "real"), **names}
    union = conditions_on(result, given, known)
    found = compare(result, union)
    if found.verdict != "wrong":
        return found
    if has_decimals(given) and compare(result, rounded_on(result, given, known, marking.digits)).verdict == "right":
        if marking.decimals == "accept":
            return Separation("right", slip="rounded")
        return replace(found, slip="rounded", reason="its ends are rounded, and exact values are asked for")
    return _explained(result, union, found)


def conditions_on(result: StabilityRegion, given: Any, names: Any, where: str = "stable_if") -> Union:
    """Return conditions on a region; on one parameter with their irrational ends. Raises `InputError` for what is none."""
    union = read_conditions(given, names, where)
    return _with_ends(union, result.region.name) if isinstance(result.region, LineRegion) else union


def rounded_on(result: StabilityRegion, given: Any, names: Any, digits: int | None, where: str = "stable_if") -> Union:
    """Return conditions on a region, those on one parameter with its ends where their decimals round them."""
    if not isinstance(result.region, LineRegion):
        return read_conditions(given, names, where)
    union = read_conditions(in_enough_digits(given, digits), names, where, rounding=True)
    return _with_ends(_with_rounded_ends(result.region, union, digits), result.region.name)


def is_implied(result: StabilityRegion, union: Union) -> bool:
    """Return whether conditions hold in all of a region with exact pieces; raises `TooLarge` where these are not known."""
    assert result.region is not None  # noqa: S101 - asked only where there is one
    _require_rational(union)
    return all(
        _holds(union, fixed, name, height) for fixed, name, height, right in _pieces(result.region, union) if right
    )


def _with_rounded_ends(region: LineRegion, union: Union, digits: int | None) -> Union:
    """Return conditions in which decimals that round an end of the region, or cut it off, are that end."""
    ends = [
        root for factor in region.critical.factors for root in roots_of_scalar(_restricted(factor, {}), region.name)
    ]

    def at_end(condition: Inequality) -> Inequality:
        decimal = single(-_linear(condition.value, region.name)[1])
        plain = condition._replace(value=written_out(condition.value))
        if decimal is None:
            return plain
        found = (
            end for end in ends if has_digits(decimal, end.interval(_BITS)[0], digits) or _is_cut_off(decimal, end)
        )
        return plain._replace(end=next(found, None))

    return tuple(tuple(map(at_end, part)) for part in union)


def _is_cut_off(decimal: PrintedDecimal, end: RealNumber) -> bool:
    """Return whether a decimal has the first digits of an irrational number, as a page prints them."""
    return not end.is_rational and decimal == PrintedDecimal.of(end.truncated())


def _linear(value: Scalar, name: str) -> tuple[Scalar, Scalar]:
    """Return a and b where a value is a·(name + b), 0 and 0 where it is no such value."""
    coefficients = value.coefficients(name) if value.is_polynomial_in(name) else ()
    if len(coefficients) != 2 or not coefficients[0].is_constant:
        return Scalar.of(0), Scalar.of(0)
    return coefficients[0], coefficients[1] / coefficients[0]


def _with_ends(union: Union, name: str) -> Union:
    """Return conditions on one parameter whose ends are roots of numbers with these ends; others are as they were."""

    def at_end(condition: Inequality) -> Inequality:
        slope, shift = _linear(condition.value, name)
        if slope.is_zero or shift.is_constant or condition.end is not None:
            return condition
        return condition._replace(end=_real_number(-shift))

    return tuple(tuple(map(at_end, part)) for part in union)


def _real_number(value: Scalar) -> RealNumber | None:
    """Return a number with square roots, or one root of another kind, as a root of its polynomial."""
    (generator, *others) = (function_named(name) for name in value.names)
    if isinstance(generator, RealRoot) and not others and value == generator.value:
        return generator.number
    approximation = near(value, _BITS)
    polynomial = product_of_linear("x", conjugates(Complex.of(value), of_numbers=True))
    if polynomial is None or polynomial.names != {"x"} or approximation is None:
        return None
    return min(roots_of_scalar(polynomial, "x"), key=lambda root: abs(root.interval(_BITS)[0] - approximation))


def _require_rational(union: Union) -> None:
    """Raise `NotShown` where a condition has roots or functions that are no end."""
    conditions = [condition for part in union for condition in part if condition.end is None]
    if any(function_named(name) for condition in conditions for name in condition.value.names):
        raise NotShown("conditions with roots or functions are not compared")


def compare(result: StabilityRegion, union: Union) -> Separation:
    """Return whether a union of conjunctions is the region; raises `NotShown` where it has functions, or roots within."""
    _require_rational(union)
    region = result.region
    if region is None:
        return _without_region(result, union)
    off: list[tuple[Mapping[str, Fraction], bool]] = []
    boundary = inside = False
    try:
        for fixed, name, height, right in _pieces(region, union):
            mine = _holds(union, fixed, name, height)
            if mine == right:
                continue
            if isinstance(height, Fraction) and not _on_a_curve(region, union, fixed, name, height):
                off.append(({**fixed, name: height}, mine))
            else:
                boundary, inside = True, mine
    except TooLarge:
        if not off:
            raise
    if off:
        found, inside = min(off, key=lambda entry: _length(entry[0]))
        point = {name: found[name] for name in sorted(found)}
        return Separation("wrong", point, inside, polynomial=_at(result, point))
    if boundary:
        return Separation("wrong", inside=inside, boundary=True)
    return Separation("right")


def _pieces(region: LineRegion | PlaneRegion, union: Union) -> Iterator[tuple[dict[str, Fraction], str, Height, bool]]:
    """Yield points of all pieces: the other coordinate, the name and value of this one, and whether it is stable there."""
    further = irreducible(condition.value for part in union for condition in part if condition.end is None)
    if not isinstance(region, PlaneRegion):
        ends = {condition.end for part in union for condition in part if condition.end is not None}
        yield from _along(region.critical, further, {}, region.name, ends)
        return
    plane = region.divided(further)
    x, y = region.names
    for cylinder in plane.cylinders:
        yield from _along(region.critical, further, {x: cylinder.x}, y)
    for wall in plane.critical_lines:
        if wall.x.is_rational:
            yield from _along(region.critical, further, {x: wall.x.fraction}, y)
        elif plane.vertical_at(wall):
            raise TooLarge("a boundary lies at an irrational value of one parameter")


def _along(
    critical: CriticalPolynomials,
    further: Sequence[Scalar],
    fixed: dict[str, Fraction],
    name: str,
    own: Collection[RealNumber] = (),
) -> Iterator[tuple[dict[str, Fraction], str, Height, bool]]:
    """Yield the same along a line parallel to an axis."""
    lines = [_restricted(factor, fixed) for factor in critical.factors]
    others = [_restricted(factor, fixed) for factor in further]
    nowhere = any(line.is_zero for line in lines)
    ends = {root for line in lines for root in roots_of_scalar(line, name)}
    points = sorted(ends.union(own, (root for line in others for root in roots_of_scalar(line, name))))
    for low, high in zip([None, *points], [*points, None], strict=True):
        sample = rational_between(low, high)
        stable = not nowhere and critical.is_stable({**fixed, name: sample})
        if critical.allows({**fixed, name: sample}):
            yield fixed, name, sample, stable
            if high is not None and (high in ends or nowhere):
                yield from _allowed(critical, fixed, name, high, stable=False)
            elif high is not None:
                yield fixed, name, high, stable


def _allowed(
    critical: CriticalPolynomials, fixed: dict[str, Fraction], name: str, at: RealNumber, *, stable: bool
) -> Iterator[tuple[dict[str, Fraction], str, Height, bool]]:
    """Yield a critical point unless the declared sign excludes it."""
    if critical.signs.get(name, "real") == "real" or not (at.is_rational and at.fraction == 0):
        yield fixed, name, at, stable


def _restricted(value: Scalar, fixed: Mapping[str, Fraction]) -> Scalar:
    found = value.substitute({name: Scalar.of(number) for name, number in fixed.items()})
    return found.numerator * found.denominator


def _sign(value: Scalar, fixed: Mapping[str, Fraction], name: str, height: Height) -> int:
    """Return the sign of a value at a point."""
    found = _restricted(value, fixed)
    return (
        _number_sign(found, {name: height})
        if isinstance(height, Fraction)
        else height.sign_of(integer_factor(found, name))
    )


def _sign_of(condition: Inequality, fixed: Mapping[str, Fraction], name: str, height: Height) -> int:
    """Return the sign of the value of a condition at a point."""
    if condition.end is None:
        return _sign(condition.value, fixed, name, height)
    at = RealNumber.of(height) if isinstance(height, Fraction) else height
    upwards = 1 if _linear(condition.value, name)[0].fraction() > 0 else -1
    return upwards * ((at > condition.end) - (at < condition.end))


def _holds(union: Union, fixed: Mapping[str, Fraction], name: str, height: Height) -> bool:
    return any(all(c.holds(_sign_of(c, fixed, name, height)) for c in part) for part in union)


def _on_a_curve(
    region: LineRegion | PlaneRegion, union: Union, fixed: Mapping[str, Fraction], name: str, height: Fraction
) -> bool:
    """Return whether a point lies on a curve of either side."""
    on_ours = any(_sign(factor, fixed, name, height) == 0 for factor in region.critical.factors)
    return on_ours or any(_sign_of(condition, fixed, name, height) == 0 for part in union for condition in part)


def _length(point: Mapping[str, Fraction]) -> Fraction:
    """Return what orders points by simplicity: whole numbers first."""
    return sum((3 * value.denominator + abs(value) for value in point.values()), Fraction())


def _at(result: StabilityRegion, point: Mapping[str, Fraction]) -> str:
    """Return the polynomial at a point."""
    return str(result.answer["polynomial"].substitute({name: Scalar.of(value) for name, value in point.items()}))


# -- more parameters, or other symbols --------------------------------------------------------------------------------


def _without_region(result: StabilityRegion, union: Union) -> Separation:
    """Return whether a proof shows both equal, or a point parts them; else the question is open."""
    if result.empty and not union:
        return Separation("right")
    if len(union) == 1 and all(condition.operator != ">=" for condition in union[0]):
        texts = [f"{condition.value} {condition.operator} 0" for condition in union[0]]
        if conditions_agree(result.stable_if, texts, None, "stable_if", result.signs):
            return Separation("right")
    return _somewhere(result, union)


def _somewhere(result: StabilityRegion, union: Union) -> Separation:
    """Return a point that parts both, among simple ones; `undecided` where there is none."""
    critical = result.critical
    used = {name for part in union for condition in part for name in condition.value.names}
    names, drawn = sorted({*critical.parameters, *used}), Random(0)  # noqa: S311 - the same points every time
    points = (dict(zip(names, drawn.choices(_TRIED, k=len(names)), strict=True)) for _ in range(_MOST_TRIED))
    for point in sorted(points, key=_length):
        if not critical.allows(point):
            continue
        mine = any(all(c.holds(_number_sign(c.value, point)) for c in part) for part in union)
        off = any(value_at(c.value, point) == 0 for part in union for c in part)
        if not off and mine != critical.is_stable(point) and all(value_at(f, point) for f in critical.factors):
            return Separation("wrong", point, mine, polynomial=_at(result, point))
    return Separation("undecided")


def _number_sign(value: Scalar, point: Mapping[str, Fraction]) -> int:
    number = value_at(value, point)
    return (number > 0) - (number < 0)


# -- why --------------------------------------------------------------------------------------------------------------


def _explained(result: StabilityRegion, union: Union, found: Separation) -> Separation:
    """Return the separation with the slip that makes both equal, and what is wrong at the point."""
    if found.boundary:
        lies = "includes its boundary, where a root is not stable" if found.inside else "leaves out a part of no width"
        return replace(found, slip="boundary", reason=f"the region is right, but yours {lies}")
    for slip, reason in _slips(result, union):
        return replace(found, slip=slip, reason=f"{reason}; {_at_point(result, found)}")
    return replace(found, reason="; ".join(filter(None, (_at_point(result, found), part_described(result, union)))))


#: What conditions describe that hold in some of the intervals of a region of one parameter, in these throughout.
SOME_PIECES = "the conditions describe some of the pieces of the region, not all of them"


def part_described(result: StabilityRegion, union: Union) -> str:
    """Return that conditions describe a part of the region; nothing where they hold elsewhere too, or nowhere."""
    if result.region is None:
        return ""
    pieces: list[set[bool]] = [set()]
    before: Height | None = None
    try:
        for fixed, name, height, right in _pieces(result.region, union):
            mine = _holds(union, fixed, name, height)
            if not isinstance(height, RealNumber) and not isinstance(before, RealNumber):
                pieces.append(set())  # the value between them is excluded by the declared sign
            before = height
            if right:
                pieces[-1].add(mine)
            elif mine:
                return ""
            else:
                pieces.append(set())
    except TooLarge:
        return ""
    held = set[bool]().union(*pieces)
    if held != {True, False}:
        return ""
    if isinstance(result.region, PlaneRegion) or {True, False} in pieces:
        return "the conditions describe a part of the region only"
    return SOME_PIECES


def _at_point(result: StabilityRegion, found: Separation) -> str:
    assert found.point is not None  # noqa: S101 - asked only where both differ off the boundary
    where = ", ".join(f"{name} = {value}" for name, value in found.point.items())
    boundary = result.question.boundary
    at = f"|z| >= {boundary.radius}" if boundary.discrete else f"real part >= {-boundary.margin}"
    if found.inside:
        return f"at {where} your conditions hold, but {found.polynomial} has roots with {at}"
    return f"at {where} your conditions fail, but all roots of {found.polynomial} are as asked for"


def _slips(result: StabilityRegion, union: Union) -> Iterator[tuple[str, str]]:
    """Yield the slips that turn the right region into the given one, the simplest first."""
    boundary = result.question.boundary
    if not boundary.margin.is_zero and _same(_within(result, replace(boundary, margin=Scalar.of(0))), union):
        yield "margin_forgotten", f"these are the conditions without the margin {boundary.margin}"
    if len(union) == 1:
        yield from _slips_of_one(result, union)
    has_other = bool(union) and boundary.margin.is_zero
    other = _within(result, replace(boundary, discrete=not boundary.discrete)) if has_other else None
    if other is not None and not other.empty and _same(other, union):
        stable = "all real parts < 0" if boundary.discrete else "all |z| < 1"
        yield "discrete", f"these are the conditions for {stable}, which is stability in the other kind of time"


def _within(result: StabilityRegion, boundary: StabilityBoundary) -> StabilityRegion:
    """Return the region of the same question with another boundary."""
    asked = result.question
    return StabilityRegion.of(replace(asked, boundary=boundary), result.method)


def _slips_of_one(result: StabilityRegion, union: Union) -> Iterator[tuple[str, str]]:
    """Yield the slips of a single list of conditions."""
    (part,) = union
    lead, *rest = result.critical.coefficients
    if _equal(result, union, (tuple(Inequality(c * lead, ">", "") for c in rest),)):
        yield "only_positive_coefficients", "positive coefficients are necessary only, not sufficient"
    for text in result.stable_if:
        try:
            further = conditions_on(result, text, None)
        except InputError:  # a root of a polynomial stands in it
            continue
        for missing in further:  # there is none in False
            if _same(result, ((*part, *missing),)):
                yield "condition_missing", f"the condition {text} is missing"
                return
    for i, condition in enumerate(part):
        turned = condition._replace(value=-condition.value)
        if condition.operator != "!=" and _same(result, ((*part[:i], turned, *part[i + 1 :]),)):
            yield "half_plane", f"{condition.text} is the wrong half"
            return


def _same(result: StabilityRegion, union: Union) -> bool:
    """Return whether a union is the region, up to its boundary."""
    try:
        found = compare(result, union)
    except TooLarge:
        return False
    return found.verdict == "right" or found.boundary


def _equal(result: StabilityRegion, one: Union, other: Union) -> bool:
    """Return whether two unions agree off their curves, in the exact region's pieces."""
    region = result.region
    if region is None:
        return False
    try:
        pieces = list(_pieces(region, (*one, *other)))
    except TooLarge:
        return False
    return all(
        _holds(one, fixed, name, height) == _holds(other, fixed, name, height)
        for fixed, name, height, _ in pieces
        if isinstance(height, Fraction)
    )
