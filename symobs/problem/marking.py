"""The table `[marking]` of a problem file: what of an answer counts, and how much."""

from __future__ import annotations

import re
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.problem.fields import FLAG, TEXT, Field, by_name, list_of, number, one_of, table
from symobs.problem.noted_errors import Errors, nearest

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

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
        "decimals": one_of("exact", "accept").about("whether a rounded value is right"),
        "sign_of_F": one_of("convention", "either").about("whether -F is right, too"),
        "milestone": list_of(table(_MILESTONE, *_MILESTONE), 50).about("a relation on the way, and its marks"),
    }
)


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


def read_marking(value: object, tasks: Collection[str], errors: Errors) -> Marking:
    """Return the marking of a file; every error is noted."""
    found = MARKING.read(value, "marking", errors) or {}
    places = {f"asked[{i}]": part for i, part in enumerate(found.get("asked", ()))}
    for place, part in [*places.items(), *((f"parts.{part}", part) for part in found.get("parts", ()))]:
        if (task := part.partition(".")[0]) not in tasks and _PART.fullmatch(part):
            message = f"{task} is not a task of this file"
            errors.note(message, f"marking.{place}", f"its tasks are {', '.join(tasks)}")
    found["milestones"] = tuple(Milestone(**each) for each in found.pop("milestone", ()) if len(each) == 2)
    found["credit"] = {**CREDIT, **found.get("credit", {})}
    return Marking(**found)
