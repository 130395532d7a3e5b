"""What may stand under the keys of a file: the schema of a value and its reading, of which neither is written twice.

A reading notes every error of the value and returns None for what is wrong; a table leaves such keys out, and has no
others than those that stand in the file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeGuard

from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import SymobsError
from symobs.problem.file_tables import Errors, came, check_text, is_table, nearest, report_unknown

if TYPE_CHECKING:
    from collections.abc import Collection


Reading = Callable[[Any, str, Errors], Any]


class Field(NamedTuple):
    """The schema of a value and its reading, which takes the value, its place, and the errors."""

    schema: dict[str, Any]
    read: Reading

    def about(self, words: str) -> Field:
        """Return the same with what it is for."""
        return self._replace(schema={"description": words, **self.schema})


def single(schema: dict[str, Any], is_right: Callable[[Any], bool], expected: str, repair: str) -> Field:
    """Return a value that is right or not; `{came}` in what is expected is the kind that came, `{key}` its key."""

    def read(value: object, where: str, errors: Errors) -> Any:
        if is_right(value):
            return value
        errors.note(expected.format(came=came(value)), where, repair.format(key=where.rpartition(".")[2]))
        return None

    return Field(schema, read)


FLAG = single(
    {"type": "boolean"},
    lambda value: isinstance(value, bool),
    "true or false is expected, but {came} came",
    "write {key} = true",
)


def whole(least: int, most: int, expected: str, repair: str) -> Field:
    """Return a whole number between two."""
    schema = {"type": "integer", "minimum": least, "maximum": most}
    return single(schema, lambda value: is_integer(value) and least <= value <= most, expected, repair)


def is_integer(value: object) -> TypeGuard[int]:
    """Return whether a value of a file is a whole number."""
    return isinstance(value, int) and not isinstance(value, bool)


def one_of(*known: str) -> Field:
    """Return one of these words."""

    def read(value: object, where: str, errors: Errors) -> str | None:
        if isinstance(value, str) and value in known:
            return value
        given = f'"{shown(value, 40)}"' if isinstance(value, str) else came(value)
        errors.note(f"{given} is no choice", where, f"write one of {', '.join(known)}")
        return None

    return Field({"enum": list(known)}, read)


def _text(value: object, where: str, errors: Errors) -> str | None:
    before = len(errors.found)
    check_text(value, where, errors)
    return str(value) if len(errors.found) == before else None


TEXT = Field({"type": "string"}, _text)


def number(most: int | None = None) -> Field:
    """Return an exact number that is not negative, and not above `most`."""

    def read(value: object, where: str, errors: Errors) -> Any:
        found = fraction_of(value, where)
        if found is None:
            errors.note("a number is expected", where, 'write for example "1/2"')
        elif found < 0 or (most is not None and found > most):
            message = f"{found} is not between 0 and {most}" if most else f"{found} is negative"
            errors.note(message, where, 'write "1/2"')
        else:
            return found
        return None

    return Field({"type": ["number", "string"]}, read)


def fraction_of(value: Any, where: str) -> Any:
    """Return a value of a file as a fraction, None where it is none."""
    try:
        return None if isinstance(value, bool) else parse_scalar(value, {}, where=where).fraction()
    except (SymobsError, ArithmeticError, ValueError):
        return None


def list_of(
    entry: Field, most: int | None = None, *, of: str = "entries", repair: str = "keep those that count"
) -> Field:
    """Return a list, for which a single entry may stand."""

    def read(value: object, where: str, errors: Errors) -> tuple[Any, ...]:
        entries = value if isinstance(value, list) else [value]
        if most is not None and len(entries) > most:
            errors.note(f"{len(entries)} {of}, more than {most}", where, repair)
        found = (entry.read(each, f"{where}[{i}]", errors) for i, each in enumerate(entries[:most]))
        return tuple(each for each in found if each is not None)

    limit = {} if most is None else {"maxItems": most}
    return Field({"type": "array", **limit, "items": entry.schema}, read)


def by_name(entry: Field, check: Reading = lambda name, *_: name) -> Field:
    """Return a table from names, which are checked, to values."""

    def read(value: object, where: str, errors: Errors) -> dict[str, Any] | None:
        if not is_table(value, where, errors):
            return None
        found = {}
        for name, each in value.items():
            place = f"{where}.{shown(name, 40)}"
            check(name, place, errors)
            found[name] = entry.read(each, place, errors)
        return {name: each for name, each in found.items() if each is not None}

    return Field({"type": "object", "additionalProperties": entry.schema}, read)


ANY_TABLE = by_name(Field({}, lambda value, *_: value))._replace(schema={"type": "object"})


def table(fields: Mapping[str, Field], *required: str) -> Field:
    """Return a table that has these keys and no others."""

    def read(value: object, where: str, errors: Errors) -> dict[str, Any] | None:
        if not is_table(value, where, errors):
            return None
        report_unknown(value, fields, where, errors)
        if missing := [key for key in required if key not in value]:
            are = "are" if len(missing) > 1 else "is"
            errors.note(f"{' and '.join(missing)} {are} missing", where, f"write {' and '.join(required)}")
        there = {key: field for key, field in fields.items() if key in value}
        found = {key: field.read(value[key], f"{where}.{key}".lstrip("."), errors) for key, field in there.items()}
        return {key: each for key, each in found.items() if each is not None}

    properties = {key: field.schema for key, field in fields.items()}
    needed = {"required": list(required)} if required else {}
    return Field({"type": "object", "properties": properties, **needed, "additionalProperties": False}, read)


# The table `[marking]` of a problem file: what of an answer counts, and how much.


#: The credit of a part that is wrong by one of these slips; any other slip has none.
CREDIT = {
    "sign": Fraction(1, 2),
    "sign_convention": Fraction(1, 2),
    "transposed": Fraction(1, 2),
    "entry": Fraction(1, 2),
    "rounded": Fraction(1, 2),
    "other_half": Fraction(1, 4),
    "boundary": Fraction(3, 4),
}


#: The slips that a wrong part may have.
SLIPS = (
    *CREDIT,
    "ambiguous",
    "condition_missing",
    "condition_wrong",
    "discrete",
    "dual_untransposed",
    "entry_misread",
    "exchanged",
    "factor",
    "forgot_D",
    "half_plane",
    "inverse",
    "margin_forgotten",
    "mirrored",
    "no_equilibrium",
    "no_feedback",
    "no_observer",
    "not_subtracted",
    "not_transformed",
    "one_coefficient",
    "only_positive_coefficients",
    "order_of_products",
    "other_matrix",
    "point_missing",
    "pole_dropped",
    "pole_repeated",
    "positive_feedback",
    "reversed",
    "sign_entries",
    "sign_of_one",
    "specialised",
    "wrong_direction",
)


_PART = re.compile(r"[a-z_]+\.[A-Za-z][A-Za-z0-9_]*")


def _part(name: object, where: str, errors: Errors) -> str | None:
    if isinstance(name, str) and _PART.fullmatch(name):
        return name
    errors.note("a part is expected", where, 'write task.field, for example "observer.L"')
    return None


def _slip(name: str, where: str, errors: Errors) -> None:
    if name not in SLIPS:
        near = nearest(name, SLIPS)
        question = f"did you mean {near}? " if near else ""
        errors.note("no slip has this name", where, f"{question}known: {', '.join(SLIPS)}")


_PARTS = list_of(Field({"type": "string", "pattern": f"^{_PART.pattern}$"}, _part))
_MILESTONE = {"relation": TEXT, "points": number()}


#: The table of the file.
MARKING = table(
    {
        "total": number().about("the marks of an answer that is right; one a part where it is left out"),
        "asked": _PARTS.about("the parts that count, each as task.field"),
        "parts": by_name(number(), _part).about("the weights of parts, 1 each where nothing is said"),
        "follow_through": number(most=1).about("the credit of a part that is right from an earlier wrong one"),
        "guard": FLAG.about("no such credit where the wrong one makes the part easy"),
        "credit": by_name(number(most=1), _slip).about("the credit of a part by its slip"),
        "by_entry": FLAG.about("whether a wrong matrix is credited with the share of its right entries"),
        "decimals": one_of("exact", "accept").about("whether a rounded value is right"),
        "digits": whole(1, 15, "a whole number from 1 to 15 is expected", "write {key} = 3").about(
            "the significant digits to which a rounded gain, or the poles that it places, are to be right"
        ),
        "sign_of_F": one_of("convention", "either").about("whether -F is right, too"),
        "milestone": list_of(table(_MILESTONE, *_MILESTONE), 50).about("a relation on the way, and its marks"),
    }
)


@dataclass
class Milestone:
    """A relation on the way to the answer, and the marks of a derivation that contains it."""

    relation: str
    points: Fraction


@dataclass
class Marking:
    """The marking scheme of a problem: parts and exact points."""

    total: Fraction | None = None
    asked: tuple[str, ...] = ()
    parts: Mapping[str, Fraction] = field(default_factory=dict)
    follow_through: Fraction = Fraction(1)
    guard: bool = True
    credit: Mapping[str, Fraction] = field(default_factory=lambda: dict(CREDIT))
    by_entry: bool = False
    decimals: str = "exact"
    digits: int | None = None
    sign_of_F: str = "convention"  # noqa: N815 - the key of the file
    milestones: tuple[Milestone, ...] = ()


def read_marking(value: object, tasks: Collection[str], errors: Errors) -> Marking:
    """Return the marking of a file; every error is noted."""
    found = MARKING.read(value, "marking", errors) or {}
    places = {f"asked[{i}]": part for i, part in enumerate(found.get("asked", ()))}
    for place, part in [*places.items(), *((f"parts.{part}", part) for part in found.get("parts", ()))]:
        if (task := part.partition(".")[0]) not in tasks and _PART.fullmatch(part):
            message = f"{task} is not a task of this file"
            errors.note(message, f"marking.{place}", f"its tasks are {', '.join(tasks)}")
    if "digits" in found and found.get("decimals") != "accept":
        errors.note("nothing rounded is accepted", "marking.digits", 'write decimals = "accept" beside it')
    found["milestones"] = tuple(Milestone(**each) for each in found.pop("milestone", ()) if len(each) == 2)
    points = sum(each.points for each in found["milestones"])
    if (total := found.get("total")) is not None and points > total:
        message = f"the milestones have {points} points, the whole answer {total}"
        errors.note(message, "marking.total", "give a larger total, or fewer points")
    found["credit"] = {**CREDIT, **found.get("credit", {})}
    return Marking(**found)
