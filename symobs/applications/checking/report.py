"""The report on an answer, and how it is written."""

from __future__ import annotations

import json
import re
from dataclasses import field, replace
from fractions import Fraction
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Self

from symobs.formula.expression import parse_matrix
from symobs.formula.expression.source import shown
from symobs.formula.tree import Literal
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import SymobsError
from symobs.pages.formats.html import page, plain
from symobs.pages.printers.mathml import MathmlPrinter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


# The report on an answer: verdicts, marks, and reasons, as data.


#: Verdicts on parts that have no marks before a human has read them.
TO_BE_READ = ("unreadable", "undecided")
#: What a report gives away, the least first: right or wrong; where; why, and what the value does; the solution.
SHOW = ("verdict", "place", "reason", "solution")


@dataclass
class Part:
    """What is asked for, and what became of it.

    verdict   right, follows (right from an earlier part that is wrong), wrong, missing, unreadable or undecided
    credit    of the weight, None where a human has to decide
    effect    what a gain does: its polynomial, and whether that is stable
    right     the right value, in a report that shows the solution
    read      how the value was read: K = [10 32], one row
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
    read: str = ""


@dataclass
class Line:
    """A line of a derivation: true, follows (from earlier lines that are wrong), false, unreadable or undecided."""

    where: str
    relation: str
    verdict: str
    origins: tuple[str, ...] = ()
    right: str | None = None
    reason: str = ""


@dataclass
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
        """The marks of an answer that is right, those of its milestones among them."""
        return self._weights + self._points if self.marks is None else self.marks

    @property
    def _weights(self) -> Fraction:
        return sum((part.weight for part in self.parts), Fraction(0))

    @property
    def _points(self) -> Fraction:
        return sum((points for _, points, _ in self.milestones), Fraction(0))

    @property
    def by_hand(self) -> list[Part]:
        """The parts that count and cannot be read, or are undecided: a human has to look at them."""
        return [part for part in self.parts if part.weight and part.verdict in TO_BE_READ]

    @property
    def score(self) -> Fraction | None:
        """The marks of this answer; None while a part is to be looked at by hand."""
        if self.by_hand or not self._weights + self._points:
            return None
        got = sum((part.weight * (part.credit or 0) for part in self.parts), Fraction(0))
        met = sum((points for _, points, is_met in self.milestones if is_met), Fraction(0))
        return met + (got / self._weights * (self.total - self._points) if self._weights else 0)

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
        "read": part.read,
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


# The report on an answer with the formats that it can be written in.


class CheckReport(ReportData):
    """The report on an answer: `.verdict`, `.score`, `.total`, `.parts`, `.lines`, `.first_false`."""

    def echo(self) -> str:
        """Return how each part of the answer was read, with no word on whether it is right."""
        return echo(self)

    def to_text(self) -> str:
        """Return the report as plain text, one line a part."""
        return text(self)

    def to_markdown(self) -> str:
        """Return the report as Markdown."""
        return markdown(self)

    def to_html(self) -> str:
        """Return the report as an HTML page of its own."""
        return html(self)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        return {"text/plain": self.to_text(), "text/markdown": self.to_markdown(), "text/html": self.to_html()}


# The JSON schema of a report.


_TEXT: dict[str, Any] = {"type": "string"}
_TEXT_OR_NULL: dict[str, Any] = {"type": ["string", "null"]}
_TEXTS: dict[str, Any] = {"type": "array", "items": _TEXT}
_NUMBER = {"type": "string", "pattern": "^[0-9]+(/[0-9]+)?$"}
_NUMBER_OR_NULL = {"anyOf": [_NUMBER, {"type": "null"}]}


def _table(**properties: Any) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _named(names: dict[str, Any], **others: Any) -> dict[str, Any]:
    return _table(**{**others, **names})


def schema() -> dict[str, Any]:
    """Return the JSON schema of the report of `symobs check`."""
    part = _named(
        {"from": _TEXTS},
        part=_TEXT,
        letter=_TEXT,
        verdict={"enum": ["right", "follows", "wrong", "missing", "unreadable", "undecided"]},
        weight=_NUMBER,
        credit=_NUMBER_OR_NULL,
        given=_TEXT,
        slip=_TEXT_OR_NULL,
        place={"type": ["array", "object", "null"]},
        reason=_TEXT,
        alternatives=_TEXTS,
        effect={"type": ["object", "null"], "additionalProperties": _TEXT},
        hints=_TEXTS,
        right=_TEXT_OR_NULL,
        read=_TEXT,
    )
    line = _named(
        {"from": _TEXTS},
        where=_TEXT,
        relation=_TEXT,
        verdict={"enum": ["true", "follows", "false", "unreadable", "undecided"]},
        right=_TEXT_OR_NULL,
        reason=_TEXT,
    )
    whole = _table(
        schema={"const": "symobs-check/1"},
        title=_TEXT,
        student=_TEXT,
        variant=_TEXT_OR_NULL,
        convention=_TEXT,
        show={"enum": list(SHOW)},
        verdict={"enum": ["right", "wrong", "incomplete", "unreadable", "undecided"]},
        score=_NUMBER_OR_NULL,
        score_decimal=_TEXT_OR_NULL,
        total=_NUMBER,
        parts={"type": "array", "items": part},
        lines={"type": "array", "items": line},
        first_false=_TEXT_OR_NULL,
        milestones={"type": "array", "items": _table(relation=_TEXT, points=_NUMBER, met={"type": "boolean"})},
        certificates={"type": "array", "items": _table(claim=_TEXT, holds={"type": "boolean"}, how=_TEXT)},
        hints=_TEXTS,
    )
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs check", **whole}


# Reports as plain text and as Markdown.


_WIDTH = 100
#: Longer lines of an answer are shown by their beginning.
LONGEST = 300


def text(report: ReportData) -> str:
    """Return a report as plain text of at most 100 columns."""
    from symobs.pages.formats.text import printable  # noqa: PLC0415 - each format pays for its own

    lines: list[str] = []
    names = names_of(report)
    width = max(map(len, names.values()), default=1)
    for part in report.parts:
        head = f"{names[part.part]:<{width}}  {part.verdict}"
        credit = f"  {part.credit}" if part.weight and part.credit is not None and 0 < part.credit < 1 else ""
        lines += _wrapped(
            printable("  ".join(filter(None, (head + credit, of_numbers("; ".join(sentences(part, names))))))),
            width + 2,
        )
    for line in shown_lines(report):
        said = f": {of_numbers(line.reason)}" if line.reason else ""
        right = f" (right: {of_numbers(line.right)})" if line.right else ""
        lines += _wrapped(printable(f"{line.where} is {line.verdict}: {line.relation}{said}{right}"), 2)
    lines += [line for hint in remarks(report) for line in _wrapped(printable(hint), 2)]
    lines += _wrapped(printable(result(report)), 2)
    return "\n".join([*lines, ""])


def echo(report: ReportData) -> str:
    """Return how each part was read, one line a part, and why where it cannot be read; nothing is said on what is right."""
    from symobs.pages.formats.text import printable  # noqa: PLC0415 - each format pays for its own

    names, lines = names_of(report), list[str]()
    for part in report.parts:
        if part.verdict == "unreadable":
            lines += _wrapped(printable(f"{names[part.part]} cannot be read: {part.given}: {part.reason}"), 2)
        elif part.given:
            lines += _wrapped(printable(of_numbers(part.read)), 2)
    lines += [f"{line.where} cannot be read: {line.relation}" for line in report.lines if line.verdict == "unreadable"]
    lacking = [names[part.part] for part in report.parts if part.weight and part.verdict == "missing"]
    lines += [f"no value for {', '.join(lacking)}"] if lacking else []
    return "\n".join([*lines, ""])


def markdown(report: ReportData) -> str:
    """Return a report as Markdown."""
    from symobs.pages.formats.markdown import plain  # noqa: PLC0415 - each format pays for its own

    names = names_of(report)
    lines = [f"**{plain(report.title)}**", ""] if report.title else []
    lines += ["| part | verdict | credit | |", "|---|---|---|---|"]
    for part in report.parts:
        credit = "" if part.credit is None else str(part.credit)
        said = plain(of_numbers("; ".join(sentences(part, names))))
        lines.append(f"| {plain(names[part.part])} | {part.verdict} | {credit} | {said} |")
    for line in shown_lines(report):
        said = f": {of_numbers(line.reason)}" if line.reason else ""
        lines += ["", plain(f"{line.where} is {line.verdict}: {line.relation}{said}")]
    for hint in remarks(report):
        lines += ["", plain(hint)]
    return "\n".join([*lines, "", plain(result(report)), ""])


def _wrapped(line: str, indent: int) -> list[str]:
    return wrap(line, _WIDTH, subsequent_indent=" " * indent, break_on_hyphens=False) or [""]


def names_of(report: ReportData) -> dict[str, str]:
    """Return what each part is called: its letter, with the task where several have that one."""
    letters = [part.letter for part in report.parts]
    return {
        part.part: part.letter if letters.count(part.letter) == 1 else f"{part.part.partition('.')[0]}.{part.letter}"
        for part in report.parts
    }


def sentences(part: Part, names: Mapping[str, str], *, effect: bool = True) -> Iterator[str]:
    """Yield what is said of a part, others having these `names`; with `effect` also what its value does, and what is right."""
    if part.reason and (effect or not part.effect or part.slip is not None):
        yield part.reason
    yield from part.alternatives
    if part.origins:
        named = " and ".join(names.get(origin, origin.partition(".")[2]) for origin in part.origins)
        yield f"it follows from your {named}, which {'are' if len(part.origins) > 1 else 'is'} wrong"
    if part.place and not part.reason:
        yield f"look at {_place(part.place)}"
    if effect and part.effect and part.verdict == "wrong":
        if part.effect["polynomial"] not in part.reason:
            yield f"with yours the polynomial is {part.effect['polynomial']}"
        if part.effect.get("stable") == "no":
            yield "it is not stable"
    yield from part.hints
    if part.verdict != "unreadable" and effect and is_read_otherwise(part):
        yield f"read as {of_numbers(part.read)}"
    if effect and part.right is not None and part.verdict != "right":
        yield f"right: {part.right}"


def is_read_otherwise(part: Part) -> bool:
    """Return whether a value was rewritten to be read, by more than blanks, commas, stars and decimals."""
    letter, _, read = part.read.partition(" = ")
    shapes = (
        re.sub(r"[\s,;*\[\]()'\"]|one (?:row|column|number)|\d+ rows and \d+ columns", "", each)
        for each in (part.given, read)
    )
    mine, value = (each.replace("**", "^").removeprefix(letter).lstrip("=") for each in shapes)
    return bool(part.given) and part.verdict == "wrong" and sorted(mine) != sorted(value) and len(part.read) < _WIDTH


def _place(place: Any) -> str:
    """Return a place in words."""
    if isinstance(place, list):
        return f"entry ({place[0]},{place[1]})"
    if "coefficient" in place:
        return f"the coefficient of the power {place['coefficient']}"
    return "the point " + ", ".join(f"{name} = {value}" for name, value in place.items())


def of_numbers(text: str) -> str:
    """Return a sentence with powers as one writes them by hand: s^2 + 3 s in place of s**2 + 3*s."""
    return re.sub(r"(?<=[0-9A-Za-z)])\*(?=[A-Za-z(])", " ", text.replace("**", "^"))


def shown_lines(report: ReportData) -> list[Line]:
    """Return the lines that need a word: false, unreadable and undecided ones."""
    said = [line for line in report.lines if line.verdict not in {"true", "follows"}]
    return [replace(line, relation=beginning(line.relation)) for line in said]


def beginning(written: str) -> str:
    """Return what a student wrote on one line, a long one by its beginning."""
    return shown(" ".join(written.split()), LONGEST)


def remarks(report: ReportData) -> Iterator[str]:
    """Yield what is said of the answer as a whole: hints, and the marks of milestones that are not met."""
    yield from report.hints
    for number, (relation, points, is_met) in enumerate(report.milestones, start=1):
        if not is_met:
            name = f"the line {of_numbers(relation)}" if relation else f"step {number} of the derivation"
            yield f"{name} is not shown: {decimal(points)} of the marks"


def result(report: ReportData) -> str:
    """Return the verdict and the score in one sentence."""
    if report.score is None:
        return f"{report.verdict}: not yet marked, to be marked by hand"
    return f"{report.verdict}: {decimal(report.score)} of {decimal(report.total)}"


# The page of feedback: what a student sees, as HTML with MathML and without any script.


_STYLE = """<style>
.judged { border-left: 0.3rem solid var(--pale); padding: 0.1rem 0 0.1rem 1rem; margin: 1.2rem 0; }
.judged.right { border-color: #2c7a3f; } .judged.wrong, .judged.unreadable { border-color: #b3372b; }
.judged.follows { border-color: #b07d12; }
.judged h2 { margin: 0; font-size: 1.15rem; } .judged p { margin: 0.35rem 0; overflow-x: auto; }
.derivation { padding-left: 0; list-style: none; } .derivation li { margin: 0.6rem 0; }
.derivation code { overflow-wrap: anywhere; } .derivation .false .word, .derivation .unreadable .word { font-weight: bold; }
.score { font-size: 1.1rem; }
</style>"""


#: The words for the verdicts on parts and lines: colour alone says nothing.
_WORDS = {
    "right": "✓ right",
    "follows": "✓ follows from your earlier result",
    "wrong": "✗ wrong",
    "missing": "– missing",
    "unreadable": "? cannot be read, not yet marked",
    "undecided": "? not yet marked, to be marked by hand",
    "true": "✓",
    "false": "✗ false",
}


def html(report: ReportData) -> str:
    """Return a report as a page of its own."""
    title = report.title or "Feedback"
    head = [f"<h1>{plain(title)}</h1>"]
    head += [f"<p>{plain(report.student)}</p>"] if report.student else []
    head += [f'<p class="score"><strong>{plain(result(report))}</strong></p>']
    names = names_of(report)
    parts = [line for part in report.parts for line in _section(part, names)]
    hints = [f"<p>{plain(_sentence(hint))}</p>" for hint in remarks(report)]
    lines = ["<h2>Your derivation</h2>", '<ol class="derivation">', *map(_line, report.lines), "</ol>"]
    solution = ["<h2>Solution</h2>", report.page] if report.page else []
    return page(title, "\n".join([_STYLE, *head, *parts, *hints, *(lines if report.lines else []), *solution]))


def _section(part: Part, names: Mapping[str, str]) -> Iterator[str]:
    """Yield the section of a part."""
    yield f'<section class="judged {part.verdict}">'
    credit = part.credit is not None and part.weight > 0 and 0 < part.credit < 1
    extra = f", {part.credit} of its marks" if credit else ""
    yield f"<h2>{plain(names[part.part])}: {_WORDS[part.verdict]}{extra}</h2>"
    if part.given:
        yield f"<p>You wrote <code>{plain(beginning(part.given))}</code></p>"
    if part.read and part.verdict not in {"unreadable", "missing"}:
        read = re.fullmatch(
            r"(\S+) = (.*?)((?:, (?:one (?:row|column|number)|\d+ rows and \d+ columns))?)", part.read, re.DOTALL
        )
        yield (
            f"<p>This was read as {_math(read[2])}{plain(read[3])}</p>"
            if read
            else f"<p>This was read as {plain(part.read)}</p>"
        )
    for said in sentences(part, names, effect=False):
        yield f"<p>{plain(_sentence(said))}</p>"
    if part.effect and part.verdict == "wrong":
        stable = {"no": ", and not stable", "yes": ""}.get(part.effect.get("stable", ""), "")
        polynomial = _math(part.effect["polynomial"]) + (", not the one asked for" if part.slip is None else "")
        yield f"<p>With your {plain(part.letter)} the characteristic polynomial is {polynomial}{stable}.</p>"
    if part.right is not None and part.verdict != "right":
        yield f"<p>Right is {_math(part.right)}</p>"
    yield "</section>"


def _line(line: Line) -> str:
    """Return a line of the derivation as an item of the list."""
    said = f"<br/>{plain(_sentence(line.reason))}" if line.reason else ""
    origins = f" {plain(' and '.join(line.origins))}" if line.origins else ""
    word = f"✓ follows from{origins}" if line.verdict == "follows" else _WORDS[line.verdict]
    right = f"<br/>right: <code>{plain(of_numbers(line.right))}</code>" if line.right else ""
    code = f"<code>{plain(beginning(line.relation))}</code>"
    return f'<li class="{line.verdict}">{plain(line.where)}: {code} <span class="word">{word}</span>{said}{right}</li>'


def _sentence(said: str) -> str:
    """Return what is said as a sentence; one that begins with a letter of mathematics keeps it."""
    text = of_numbers(said)
    return (text[0].upper() if len(text) > 1 and text[1].isalpha() else text[0]) + text[1:] + "."


def _math(text: str) -> str:
    """Return a value as MathML, or as it was written where it is no expression."""
    if len(text) > LONGEST:
        return f"<code>{plain(beginning(text))}</code>"
    try:
        value = parse_matrix(text, None, functions=True)
    except SymobsError:
        return f"<code>{plain(beginning(text))}</code>"
    return MathmlPrinter().inline(Literal(value[0, 0] if value.shape == (1, 1) else value))
