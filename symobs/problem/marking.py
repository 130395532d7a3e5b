"""The table `[marking]` of a problem file: what of an answer counts, and how much."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field
from difflib import get_close_matches
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import SymobsError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    #: Takes the message, the place and the repair of an error.
    Note = Callable[[str, str, str], None]

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
    "no_feedback",
    "no_observer",
    "not_subtracted",
    "not_transformed",
    "one_coefficient",
    "only_positive_coefficients",
    "order_of_products",
    "other_matrix",
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
_MOST_MILESTONES = 50
_CHOICES = {"decimals": ("exact", "accept"), "sign_of_F": ("convention", "either")}

_NUMBER = {"type": ["number", "string"]}
_PARTS = {"type": "object", "additionalProperties": _NUMBER}
#: The schema of the table.
MARKING: dict[str, dict[str, Any]] = {
    "total": {"description": "the marks of an answer that is right; one a part where it is left out", **_NUMBER},
    "asked": {
        "description": "the parts that count, each as task.field",
        "type": "array",
        "items": {"type": "string", "pattern": f"^{_PART.pattern}$"},
    },
    "parts": {"description": "the weights of parts, 1 each where nothing is said", **_PARTS},
    "follow_through": {"description": "the credit of a part that is right from an earlier wrong one", **_NUMBER},
    "guard": {"description": "no such credit where the wrong one makes the part easy", "type": "boolean"},
    "credit": {"description": "the credit of a part by its slip", **_PARTS},
    "decimals": {"description": "whether a rounded value is right", "enum": list(_CHOICES["decimals"])},
    "sign_of_F": {"description": "whether -F is right, too", "enum": list(_CHOICES["sign_of_F"])},
    "milestone": {
        "description": "a relation on the way, and its marks",
        "type": "array",
        "items": {
            "type": "object",
            "properties": {"relation": {"type": "string"}, "points": _NUMBER},
            "required": ["relation", "points"],
            "additionalProperties": False,
        },
    },
}


@dataclass(frozen=True)
class Milestone:
    """A relation on the way to the answer, and the marks of a derivation that contains it."""

    relation: str
    points: Fraction


@dataclass(frozen=True)
class Marking:
    """The marking scheme of a problem: parts and exact points."""

    total: Fraction | None = None
    asked: tuple[str, ...] = ()
    parts: Mapping[str, Fraction] = field(default_factory=dict)
    follow_through: Fraction = Fraction(1)
    guard: bool = True
    credit: Mapping[str, Fraction] = field(default_factory=lambda: dict(CREDIT))
    decimals: str = "exact"
    sign_of_F: str = "convention"  # noqa: N815 - the key of the file
    milestones: tuple[Milestone, ...] = ()


def read_marking(table: object, tasks: Collection[str], note: Note) -> Marking:
    """Return the marking of a file; every error is noted."""
    if not isinstance(table, Mapping):
        note("a table is expected", "marking", "write [marking] and its keys below")
        return Marking()
    for key in table:
        if key not in MARKING:
            note("unknown key", f"marking.{shown(key, 40)}", f"known keys are {', '.join(MARKING)}")
    given = {key: value for key, value in table.items() if key in MARKING}
    found: dict[str, Any] = {}
    for key, value in given.items():
        where = f"marking.{key}"
        match key:
            case "total":
                found[key] = _number(value, where, note, most=None)
            case "follow_through":
                found[key] = _number(value, where, note)
            case "guard":
                found[key] = value
                if not isinstance(value, bool):
                    note("true or false is expected", where, "write guard = false")
            case "decimals" | "sign_of_F":
                found[key] = value
                if value not in _CHOICES[key]:
                    note("this is no choice", where, f"write one of {', '.join(_CHOICES[key])}")
            case "asked":
                parts = value if isinstance(value, list) else [value]
                found[key] = tuple(_part(part, f"{where}[{i}]", tasks, note) for i, part in enumerate(parts))
            case "milestone":
                found["milestones"] = _milestones(value, note)
            case _:
                found[key] = _by_name(key, value, where, tasks, note)
    return Marking(**found)


def _by_name(key: str, value: object, where: str, tasks: Collection[str], note: Note) -> dict[str, Fraction]:
    """Return a table of numbers by part, or by slip."""
    if not isinstance(value, Mapping):
        note("a table is expected", where, f"write [{where}] and its keys below")
        return {}
    found = dict(CREDIT) if key == "credit" else {}
    for name, entry in value.items():
        place = f"{where}.{shown(name, 40)}"
        if key != "credit":
            _part(name, place, tasks, note)
        elif name not in SLIPS:
            near = get_close_matches(str(name), SLIPS, 1)
            question = f"did you mean {near[0]}? " if near else ""
            note("no slip has this name", place, f"{question}known: {', '.join(SLIPS)}")
        found[name] = _number(entry, place, note, most=1 if key == "credit" else None)
    return found


def _milestones(value: object, note: Note) -> tuple[Milestone, ...]:
    entries = value if isinstance(value, list) else [value]
    if len(entries) > _MOST_MILESTONES:
        note(f"more than {_MOST_MILESTONES} milestones", "marking.milestone", "keep those that count")
    found = []
    for i, entry in enumerate(entries[:_MOST_MILESTONES]):
        where = f"marking.milestone[{i}]"
        if not isinstance(entry, Mapping) or set(entry) != {"relation", "points"}:
            note("relation and points are expected", where, 'write relation = "L = [19; 81]" and points = 1')
        elif not isinstance(entry["relation"], str):
            note("a text is expected", f"{where}.relation", "write it in quotes")
        else:
            found.append(Milestone(entry["relation"], _number(entry["points"], f"{where}.points", note, most=None)))
    return tuple(found)


def _part(name: object, where: str, tasks: Collection[str], note: Note) -> str:
    """Return the name of a part, whose task must be one of the file's."""
    if not isinstance(name, str) or not _PART.fullmatch(name):
        note("a part is expected", where, 'write task.field, for example "observer.L"')
        return ""
    if (task := name.partition(".")[0]) not in tasks:
        note(f"{task} is not a task of this file", where, f"its tasks are {', '.join(tasks)}")
    return name


def _number(value: object, where: str, note: Note, most: int | None = 1) -> Fraction:
    """Return an exact number that is not negative, and not above `most`."""
    try:
        number = parse_scalar(value, {}, where=where).fraction()
    except (SymobsError, ArithmeticError, ValueError):
        note("a number is expected", where, 'write for example "1/2"')
        return Fraction(0)
    if number < 0 or (most is not None and number > most):
        note(f"{number} is not between 0 and {most}" if most else f"{number} is negative", where, 'write "1/2"')
    return number
