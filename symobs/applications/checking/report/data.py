"""The report on an answer: verdicts, marks, and reasons, as data."""

from __future__ import annotations

import json
from dataclasses import field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Self

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

#: What a report gives away, the least first: right or wrong; where; why, and what the value does; the solution.
SHOW = ("verdict", "place", "reason", "solution")


@dataclass(frozen=True)
class Part:
    """What is asked for, and what became of it.

    verdict   right, follows (right from an earlier part that is wrong), wrong, missing, unreadable or undecided
    credit    of the weight, None where a human has to decide
    effect    what a gain does: its polynomial, and whether that is stable
    right     the right value, in a report that shows the solution
    """

    part: str
    letter: str
    verdict: str
    weight: Fraction
    credit: Fraction | None
    given: str = ""
    slip: str | None = None
    place: Any = None
    reason: str = ""
    alternatives: tuple[str, ...] = ()
    origins: tuple[str, ...] = ()
    effect: Mapping[str, str] = field(default_factory=dict)
    hints: tuple[str, ...] = ()
    right: str | None = None


@dataclass(frozen=True)
class Line:
    """A line of a derivation: true, follows (from earlier lines that are wrong), false, unreadable or undecided."""

    where: str
    relation: str
    verdict: str
    origins: tuple[str, ...] = ()
    right: str | None = None
    reason: str = ""


@dataclass(frozen=True)
class ReportData:
    """The verdict on an answer: right, wrong, incomplete, unreadable or undecided, with its score and its parts.

    The score is an exact fraction of the total, None where a part is undecided.  `page` is the solution as HTML, in a report
    that shows it.
    """

    title: str
    student: str
    variant: str | None
    convention: str
    show: str
    parts: tuple[Part, ...]
    lines: tuple[Line, ...] = ()
    milestones: tuple[tuple[str, Fraction, bool], ...] = ()
    marks: Fraction | None = None
    certificates: tuple[tuple[str, bool, str], ...] = ()
    hints: tuple[str, ...] = ()
    page: str = field(default="", kw_only=True)

    @property
    def verdict(self) -> str:
        """The verdict on the whole answer."""
        verdicts = [part.verdict for part in self.parts]
        if all(verdict == "right" for verdict in verdicts):
            return "right"
        for found, verdict in (("unreadable", "unreadable"), ("wrong", "wrong"), ("follows", "wrong")):
            if found in verdicts:
                return verdict
        return "undecided" if "undecided" in verdicts else "incomplete"

    @property
    def total(self) -> Fraction:
        """The marks of an answer that is right."""
        return self._weights if self.marks is None else self.marks

    @property
    def _weights(self) -> Fraction:
        return sum((part.weight for part in self.parts), Fraction(0)) + sum(
            (m[1] for m in self.milestones), Fraction(0)
        )

    @property
    def score(self) -> Fraction | None:
        """The marks of this answer."""
        if any(part.credit is None for part in self.parts) or not self._weights:
            return None
        got = sum((part.weight * (part.credit or 0) for part in self.parts), Fraction(0))
        return (got + sum((m[1] for m in self.milestones if m[2]), Fraction(0))) / self._weights * self.total

    @property
    def first_false(self) -> str | None:
        """The place of the first line that is false."""
        return next((line.where for line in self.lines if line.verdict == "false"), None)

    @property
    def exit_code(self) -> int:
        """The exit code of the command: 0 right, 4 wrong or incomplete, 3 unreadable, 5 undecided."""
        return {"right": 0, "unreadable": 3, "undecided": 5}.get(self.verdict, 4)

    def as_data(self) -> dict[str, Any]:
        """Return the report as JSON holds it."""
        return {
            "schema": "symobs-check/1",
            "title": self.title,
            "student": self.student,
            "variant": self.variant,
            "convention": self.convention,
            "show": self.show,
            "verdict": self.verdict,
            "score": None if self.score is None else str(self.score),
            "score_decimal": None if self.score is None else decimal(self.score),
            "total": str(self.total),
            "parts": [_part(part) for part in self.parts],
            "lines": [
                {
                    "where": line.where,
                    "relation": line.relation,
                    "verdict": line.verdict,
                    "from": list(line.origins),
                    "right": line.right,
                    "reason": line.reason,
                }
                for line in self.lines
            ],
            "first_false": self.first_false,
            "milestones": [
                {"relation": text, "points": str(points), "met": met} for text, points, met in self.milestones
            ],
            "certificates": [{"claim": claim, "holds": holds, "how": how} for claim, holds, how in self.certificates],
            "hints": list(self.hints),
        }

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> Self:
        """Return the report that `as_data` has written; `page` may stand beside its data."""
        parts = [
            {
                **{name: value for name, value in part.items() if name != "from"},
                "weight": Fraction(part["weight"]),
                "credit": None if part["credit"] is None else Fraction(part["credit"]),
                "effect": part["effect"] or {},
                "origins": tuple(part["from"]),
                "alternatives": tuple(part["alternatives"]),
                "hints": tuple(part["hints"]),
            }
            for part in data["parts"]
        ]
        lines = [
            {**{name: value for name, value in line.items() if name != "from"}, "origins": tuple(line["from"])}
            for line in data["lines"]
        ]
        return cls(
            data["title"],
            data["student"],
            data["variant"],
            data["convention"],
            data["show"],
            tuple(Part(**part) for part in parts),
            tuple(Line(**line) for line in lines),
            tuple((each["relation"], Fraction(each["points"]), each["met"]) for each in data["milestones"]),
            Fraction(data["total"]),
            tuple((each["claim"], each["holds"], each["how"]) for each in data["certificates"]),
            tuple(data["hints"]),
            page=data.get("page", ""),
        )

    def to_json(self) -> str:
        """Return the report as JSON."""
        return json.dumps(self.as_data(), indent=2, ensure_ascii=False) + "\n"

    def bounded(self, show: str) -> Self:
        """Return the report without what it may not give away."""
        level = SHOW.index(show)
        parts = tuple(_bounded(part, level) for part in self.parts)
        lines = tuple(
            replace(line, right=line.right if level > 2 else None, reason=line.reason if _may_say(line, level) else "")
            for line in self.lines
        )
        if level < 1:
            lines = ()
        return replace(
            self,
            show=show,
            parts=parts,
            lines=lines,
            hints=self.hints if level else (),
            certificates=self.certificates if level > 1 else (),
            milestones=tuple((text if level > 2 else "", points, met) for text, points, met in self.milestones),
            page=self.page if level > 2 else "",
        )


def decimal(score: Fraction) -> str:
    """Return a score with two places, halves rounded up."""
    cents = (score * 100 + Fraction(1, 2)).__floor__()
    return f"{cents // 100}.{cents % 100:02d}"


def _part(part: Part) -> dict[str, Any]:
    return {
        "part": part.part,
        "letter": part.letter,
        "verdict": part.verdict,
        "weight": str(part.weight),
        "credit": None if part.credit is None else str(part.credit),
        "given": part.given,
        "slip": part.slip,
        "place": part.place,
        "reason": part.reason,
        "alternatives": list(part.alternatives),
        "from": list(part.origins),
        "effect": dict(part.effect) or None,
        "hints": list(part.hints),
        "right": part.right,
    }


def _may_say(judged: Part | Line, level: int) -> bool:
    """Return whether a level of feedback may give a reason: why something cannot be read is always said."""
    return level > 1 or judged.verdict == "unreadable"


def _bounded(part: Part, level: int) -> Part:
    """Return a part without what a level of feedback may not give away."""
    said = part.reason if _may_say(part, level) else ""
    found = replace(part, right=part.right if level > 2 else None, reason=said)
    if level < 2:
        found = replace(found, slip=None, alternatives=(), effect={}, hints=())
    if level < 2 and part.slip == "entry_misread":  # its place is one of the data, which only the reason names
        found = replace(found, place=None)
    if level < 1:
        found = replace(found, place=None, origins=())
    return found
