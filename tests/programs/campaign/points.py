"""Parameters at rational points, and which case of an answer holds there.

The relations of an answer are evaluated here in fractions, by Python's own grammar of expressions.
"""

from __future__ import annotations

import ast
import operator
import re
from collections import Counter
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from itertools import combinations, islice, product
from random import Random
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from tests.programs.campaign.asked import Asked, Tables

Point: TypeAlias = Mapping[str, Fraction]

_OPERATIONS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
_RELATION = re.compile(r"(.*?)\s*(!=|==|>=|<=|>|<)\s*(.*)")
_COMPARED = {
    "!=": operator.ne,
    "==": operator.eq,
    ">": operator.gt,
    ">=": operator.ge,
    "<": operator.lt,
    "<=": operator.le,
}
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_VALUES = [
    Fraction(p, q) for p, q in ((1, 1), (2, 1), (3, 1), (-1, 1), (-2, 1), (-3, 1), (0, 1), (1, 2), (-3, 2), (5, 3))
]


#: What an answer holds beside its fields.
_NOT_FIELDS = {"certificates", "in_convention", "cases", "conditions"}


class NotRational(ValueError):
    """A text that has no rational value: it contains a root, a function, or a name without a value."""


@cache
def _tree(text: str) -> ast.expr:
    return ast.parse(text.replace("^", "**").strip(), mode="eval").body


def value(text: str, point: Point) -> Fraction:
    """Return the rational value of an expression; raises ZeroDivisionError or NotRational."""
    try:
        return _value(_tree(text), point)
    except SyntaxError as error:
        raise NotRational(text) from error


def _value(node: ast.expr, point: Point) -> Fraction:
    match node:
        case ast.Constant(value=int(number)):
            return Fraction(number)
        case ast.Name(id=name) if name in point:
            return point[name]
        case ast.UnaryOp(op=sign, operand=inner):
            return Fraction(_OPERATIONS[type(sign)](_value(inner, point)))
        case ast.BinOp(left=left, op=operation, right=right):
            found = _OPERATIONS[type(operation)](_value(left, point), _value(right, point))
            if isinstance(found, Fraction):
                return found
    raise NotRational(ast.unparse(node))


def holds(relation: str, point: Point) -> bool:
    """Tell whether a relation of an answer holds at a point."""
    if relation in {"True", "False"}:
        return relation == "True"
    parts = _RELATION.fullmatch(relation)
    if parts is None:
        raise NotRational(relation)
    left, sign, right = parts.groups()
    return bool(_COMPARED[sign](value(left, point), value(right, point)))


def has_sign(number: Fraction, sign: str) -> bool:
    """Tell whether a number has a declared sign."""
    match sign:
        case "positive":
            return number > 0
        case "negative":
            return number < 0
        case "nonnegative":
            return number >= 0
        case "nonpositive":
            return number <= 0
        case "nonzero":
            return number != 0
    return True


# -- the answer at a point ---------------------------------------------------------------------------------------------


class Uncovered(Exception):
    """No case of an answer holds at a point where the plant is defined."""


def answer_at(answer: Tables, point: Point) -> Tables | None:
    """Return the fields of an answer that hold at a point, with the verdict; None where there is no plant.

    Raises `Uncovered` where a condition fails and no case takes its place.
    """
    if any(not holds(condition, point) for kind, condition in _conditions(answer) if kind == "domain"):
        return None
    branch = _deeper(answer, point)
    asked = [(kind, condition) for kind, condition in _conditions(branch) if kind != "domain"]
    broken = [(kind, condition) for kind, condition in asked if not holds(condition, point)]
    if branch["verdict"] != "conditional":
        if broken and branch is answer:
            raise Uncovered(f"{broken[0][1]} fails and no case holds")
        return branch
    # Where its conditions hold, and no deeper case does, what is said under conditions is said.
    if all(kind == "existence" and "!=" not in condition for kind, condition in broken):
        return branch | {"verdict": "no" if broken else "yes"}
    raise Uncovered(f"{broken[0][1]} fails and no case holds")


def _conditions(branch: Tables) -> list[tuple[str, str]]:
    return list(zip(branch.get("condition_kinds", []), branch.get("conditions", []), strict=True))


def _deeper(outer: Tables, point: Point) -> Tables:
    """Return the branch that holds at a point: a case has the fields around it where it does not say otherwise."""
    for case in outer.get("cases", []):
        if all(holds(relation, point) for relation in case["when"]):
            return _deeper({**outer, "cases": [], "conditions": [], "condition_kinds": [], **case}, point)
    return outer


def texts_at(thing: Any, point: Point) -> Any:
    """Put the numbers of a point in place of the names in every text of a value."""
    if not point:
        return thing
    if isinstance(thing, str):
        return _NAME.sub(lambda name: f"({point[name.group()]})" if name.group() in point else name.group(), thing)
    if isinstance(thing, list):
        return [texts_at(entry, point) for entry in thing]
    if isinstance(thing, Mapping):
        return {key: texts_at(entry, point) for key, entry in thing.items() if key not in _NOT_FIELDS}
    return thing


# -- points ------------------------------------------------------------------------------------------------------------


def points_for(asked: Asked, most: int = 5) -> Iterator[Point]:
    """Yield points: some anywhere, and one in each pattern of equations that the answer speaks of, as far as found."""
    signs = asked.problem["symbols"]
    if not signs:
        yield {}
        return
    random = Random(f"points {asked.seed}")  # noqa: S311 - test points, no secrets
    equations = sorted({side for text in _relations(asked.answer) for side in _sides(text)} | _meetings(asked.answer))
    seen: Counter[tuple[bool, ...]] = Counter()
    for point in islice(_candidates(signs, equations, random), 60):
        pattern = tuple(_vanishes(equation, point) for equation in equations)
        if seen[pattern] < (1 if any(pattern) else 2):
            seen[pattern] += 1
            yield point
            if seen.total() >= most:
                return


def _vanishes(text: str, point: Point) -> bool:
    try:
        return value(text, point) == 0
    except (ZeroDivisionError, NotRational):
        return False


def _relations(answer: Tables) -> Iterator[str]:
    yield from answer.get("conditions", [])
    for case in answer.get("cases", []):
        yield from case["when"]
        yield from _relations(case)


def _meetings(answer: Tables) -> set[str]:
    """Return what is 0 where two of the modes are one, whether the answer speaks of that or not."""
    values = sorted({mode["eigenvalue"] for mode in answer.get("modes", []) if "CRootOf" not in mode["eigenvalue"]})
    return {f"({one})-({other})" for one, other in combinations(values, 2)}


def _sides(relation: str) -> list[str]:
    parts = _RELATION.fullmatch(relation)
    return [f"({parts.group(1)})-({parts.group(3)})"] if parts else []


def _candidates(signs: Mapping[str, str], equations: Sequence[str], random: Random) -> Iterator[Point]:
    """Yield a few points anywhere, points on every equation that is linear in a name, and then a grid."""
    names = sorted(signs)
    allowed = {name: [v for v in _VALUES if has_sign(v, signs[name])] for name in names}

    def anywhere() -> dict[str, Fraction]:
        return {name: random.choice(allowed[name]) for name in names}

    for _ in range(2):
        yield anywhere()
    for equation in equations:
        for name in names:
            for _ in range(3):
                yield from _solved(equation, name, anywhere(), signs)
    grid: Iterable[tuple[Fraction, ...]] = product(*(allowed[name] for name in names))
    if len(names) < 3:
        yield from (dict(zip(names, values, strict=True)) for values in grid)
    while True:
        yield anywhere()


def _solved(equation: str, name: str, point: dict[str, Fraction], signs: Mapping[str, str]) -> Iterator[Point]:
    """Yield the point moved along one name to where the equation holds, where that is linear in the name."""
    try:
        zero, one, two = (value(equation, {**point, name: Fraction(k)}) for k in (0, 1, 2))
    except (ZeroDivisionError, NotRational):
        return
    if one != zero and two - one == one - zero:
        found = -zero / (one - zero)
        if has_sign(found, signs[name]) and max(abs(found.numerator), found.denominator) < 10**6:
            yield {**point, name: found}
