"""Equilibria as students write them, in any order and form, held against those of the result.

A point is read from a mapping, from a tuple, (0, 0), or from equations, x1 = ±1, x2 = 0; several values of one name are
several points.  Behind it may stand where it is one, and whether it is stable.  Angles count modulo 2π.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.checking.answers import as_conditions, exact, typed
from symobs.applications.checking.handwriting import in_letters, readable, squashed, without_drawings, without_marks
from symobs.applications.checking.wording import in_inequalities
from symobs.exact import Scalar
from symobs.exact.core.generators import symbols_in
from symobs.formula.expression import parse_scalar, without_latex
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError
from symobs.problem.expect import names_of
from symobs.system.motion import typed_derivatives, with_primes

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.problem.fields import Marking
    from symobs.tasks.result.in_convention import ResultInConvention

#: So many points, and so long a text of them, are read.
_MOST, _LONGEST = 60, 5_000


class Point(NamedTuple):
    """A point as it was read: texts of its values by name, of its conditions, and what is said of its stability."""

    values: dict[str, str]
    conditions: tuple[str, ...] = ()
    stable: str = ""
    stable_if: tuple[str, ...] = ()

    def __str__(self) -> str:
        names, values = (", ".join(each) for each in (map(with_primes, self.values), self.values.values()))
        text = f"({names}) = ({values})" if len(self.values) > 1 else f"{names} = {values}"
        return text + (f" where {' and '.join(self.conditions)}" if self.conditions else "")


# -- reading -----------------------------------------------------------------------------------------------------------


_EQUILIBRIA = r"(?:equilibri(?:a|um)|ruhelagen?|gleichgewicht\w*)"
#: What a list of points is called.
_CALLED = re.compile(
    rf"(?:points|(?:the\s+)?{_EQUILIBRIA}(?:\s+points?)?|rest points?)\s*(?:are|is|sind|ist)?\s*[:=]?\s*",
    re.IGNORECASE,
)
_NONE = re.compile(
    rf"(?:(?:there (?:is|are)|es gibt)\s+)?(?:no|none|keine?)(?:\s+{_EQUILIBRIA})?\.?|\[\s*\]|\{{\s*\}}|∅",
    re.IGNORECASE,
)
_SAID = re.compile(
    r"(?:\b(?:is|ist|are|sind)\s+)?(?:(?:an?|ein)\s+)?(?:\b(?:not|nicht)\s+)?(?:\b(?:asymptotically|asymptotisch|locally|lokal)\s+)*"
    r"\b(?:(?:un|in)?stab(?:le|il)\b(?:\s+(?:node|focus|spiral|cent(?:er|re)|knoten|fokus|strudel|zentrum))?"
    r"|saddle(?:\s+point)?|sattel(?:punkt)?|cent(?:er|re)|zentrum|wirbel|marginally stable|grenzstabil|conditional)",
    re.IGNORECASE,
)
_NOT_STABLE = re.compile(r"not|nicht|unstab|instab|saddle|sattel|cent|zentrum|wirbel|marginal|grenz", re.IGNORECASE)
_WHERE = re.compile(
    r"(?:\b(?:where|for|if|when|provided(?: that)?|only|exists?|falls|für|wenn|wo|nur|existiert)\b[\s,]*)+"
)
_REMARK = re.compile(rf"{_WHERE.pattern}|\s*[:→–—]\s*(?!=)|{_SAID.pattern}", re.IGNORECASE)
_AND = re.compile(
    r"^(?:\s|,|;|\.|\band\b|\bund\b|\bor\b|\boder\b|[:–—→])+|(?:\s|,|;|\.|\band\b|\bund\b|\bor\b|\boder\b|[:–—→])+$"
)
_APART = re.compile(r",|\band\b|\bund\b|\bor\b|\boder\b|;")
_WHOLE = re.compile(
    r",?\s*(?:\b([kn])\s*(?:∈|in\b)\s*(?:mathbb\s*)?\{?(?:ℤ|Z)\}?|\(?\b([kn])\s+(?:integer|ganz(?:zahlig)?)\)?)"
)
_MEMBER = r"(?::?=(?![=<>])|∈|\bin\b)"
#: An entry of a table, with its quotes.
_ENTRY = re.compile(r"""(["'])(.+?)\1\s*:\s*(["']?)(.*?)\3\s*(?:,|$)""")
#: What stands between two points: a sign, and the name of the second one, P1(0, 0), x_e = (0, 0).
_LABEL = re.compile(
    r"(?:[,;]|\band\b|\bund\b)?\s*(?:(?<![A-Za-z])(?:[A-Z]_?\w?|[A-Za-z]\w{0,4}(?:\^?\{?\*\}?)?\s*[=:])|∪|\{)?\s*$"
)
#: What may stand before the first point.
_BEGIN = re.compile(
    r"\s*(?:[A-Za-z][A-Za-z ]{3,}\b(?:at|bei|in)\s*:?\s*)?"
    r"(?:(?:[xXq]|[PEGR](?=_?\d)|EP|GP)_?\{?\w{0,3}\}?\s*(?:\^?\{?\*\}?)?\s*[=:]?)?\s*\{?\s*"
)
_ANY = re.compile(r"any|arbitrary|free|beliebig|frei|(?:real|ℝ|mathbb \{R\}|R)", re.IGNORECASE)


class Reader:
    """Reads points in the names of one plant."""

    def __init__(self, view: ResultInConvention) -> None:
        result: Any = view.result
        self.given = result.given
        self.names: tuple[str, ...] = (*self.given.states, *self.given.inputs)
        self.symbols = {*view.plant.symbols.signs}
        self.points: list[dict[str, Scalar]] = [
            dict(zip(self.names, map(_as_scalar, point.values()), strict=True)) for point in result.fields["points"]
        ]
        #: Whether a point is known by numbers, so that nobody could write it exactly.
        self.are_rounded = any(point.within is not None for point in result.found.points)
        self.common = self._common()
        self.known = {squashed(name).replace("_", ""): name for name in self.names}

    def _common(self) -> dict[str, Scalar]:
        """Return what need not be said: values that every point has, and what is free at each."""
        common = {}
        for name in self.names:
            values = {str(point[name]): point[name] for point in self.points}
            is_held = name in dict(self.given.held) or all(key in {"0", name} for key in values)
            if values and is_held and len(values) == 1:
                (common[name],) = values.values()
        return common

    @property
    def essential(self) -> list[str]:
        """The names whose values tell the points apart; all states where none do."""
        return [name for name in self.names if name not in self.common] or [*self.given.states]

    def read(self, given: Any) -> list[list[Point]]:
        """Return the ways to read points, one or two; raises `InputError` for what is none."""
        if isinstance(given, Mapping):
            given = [given]
        if isinstance(given, str) and (tables := _tables(given)) is not None:
            given = tables
        if isinstance(given, str):
            ways = self._of_text(given)
        elif isinstance(given, (list, tuple)):
            each = [self._of_entry(entry) for entry in given]
            ways = [
                [point for way in each for point in way[min(k, len(way) - 1)]]
                for k in range(max(map(len, each), default=1))
            ]
        else:
            raise self._unread(given)
        if any(len(way) > _MOST for way in ways):
            raise InputError(f"more than {_MOST} points", repair="write fewer")
        return ways

    def _of_entry(self, entry: Any) -> list[list[Point]]:
        if isinstance(entry, Mapping):
            return self._with_signs([Point({self._named(str(key)): str(value) for key, value in entry.items()})])
        if isinstance(entry, (list, tuple)):
            flat = [str(part[0]) if isinstance(part, list) and len(part) == 1 else str(part) for part in entry]
            return self._with_signs([self._of_tuple(flat)])
        if isinstance(entry, (str, int)):
            return self.read(str(entry))
        raise self._unread(entry)

    def _unread(self, given: Any) -> InputError:
        message = f'"{shown(str(given), 60)}" is no list of points'
        return InputError(message, where="points", repair=f"write for example {self.example}")

    @property
    def example(self) -> str:
        """A line of the form that points have."""
        names = self.essential
        if len(names) == 1:
            return f"{with_primes(names[0])} = 1, 2"
        return (
            f"({', '.join(map(with_primes, names))}) = ({', '.join('1' * len(names))}), ({', '.join('2' * len(names))})"
        )

    def _named(self, text: str) -> str:
        name = self._name_of(text)
        if name is None:
            known = ", ".join(map(with_primes, self.names))
            raise InputError(f'"{shown(text, 40)}" is no state or input', where="points", repair=f"they are {known}")
        return name

    def _name_of(self, text: str) -> str | None:
        """Return the state or input that a text names, also as the value at rest: x1*, x_1e, theta_0."""
        text = squashed(self._with_rates(readable(text)).strip().lstrip("{").rstrip("}")).replace("_", "")
        for ending in ("", r"\^?(?:\{\})?", "(?:e|eq|s|r|ss|ref)", r"(?:e|[0-9])\^?"):
            for squeezed, name in self.known.items():
                if re.fullmatch(rf"{re.escape(squeezed)}{ending}", text, 0 if not ending else re.IGNORECASE):
                    return name
        return None

    def _with_rates(self, text: str) -> str:
        motion = self.given.motion
        return text if motion is None else typed_derivatives(text, motion.coordinates, "points")

    def lines_of(self, text: str) -> tuple[list[str], str]:
        """Return the lines of a text that hold points, and the other lines."""
        held, rest = list[str](), list[str]()
        for line in text.splitlines():
            if len(line) > _LONGEST:
                rest.append(line)
                continue
            if _CALLED.match(line) and _tables(line) is not None:
                held.append(line)
                continue
            plain = self._plain(line)
            is_listed = bool(plain) and ("=" not in plain or bool(_CALLED.match(plain)))
            try:
                is_of_points = (
                    _NONE.fullmatch(plain) or self._is_list(_CALLED.sub("", plain, count=1))
                    if is_listed
                    else plain and self._are_values(self._of_text(plain)[0])
                )
                (held if is_of_points else rest).append(plain if is_of_points else line)
            except InputError:
                rest.append(line)
        return held, "\n".join(rest)

    def _is_list(self, text: str) -> bool:
        """Return whether a line without an equation is a list of points."""
        return bool(self._of_text(text)) and not re.search(r"[A-Za-z]{3,}\s+[a-z]{2,}", _REMARK.split(text)[0])

    def _are_values(self, points: list[Point]) -> bool:
        """Return whether an equation of a line gives values of states, and is no law or equation of motion."""
        words = {
            name: set(re.findall(r"[A-Za-z_]\w*", value)) for point in points for name, value in point.values.items()
        }
        states = {*self.given.states}
        return bool(states & {*words}) and not any(states & (words[name] - {name}) for name in states & {*words})

    def _plain(self, line: str) -> str:
        """Return a line without marks, its derivatives by name, as one of points has it."""
        motion = self.given.motion
        if motion is not None and re.search(r"['\u2019′\u0307]|dot", line):
            line = self._with_rates(line)
        text = without_latex(without_drawings(without_marks(typed(line)))).strip()
        text = re.sub(r"(?<![A-Za-z])(?:pm|±|\+/-|\+-)(?![A-Za-z])", "±", text).replace("∓", "±")
        text = re.sub(r"(?<![A-Za-z])(?:cos|arc\s*cos)\s*\^\s*\(?\s*-\s*1\s*\)?", "acos", text)
        text = re.sub(r"(?<![A-Za-z])(?:sin|arc\s*sin)\s*\^\s*\(?\s*-\s*1\s*\)?", "asin", text)
        text = re.sub(r"_[{(]?\d\s*,\s*\d[)}]?(?=\s*=)", "", text)
        return re.sub(r"\s+", " ", re.sub(r"(?<![A-Za-z])(arc(?:cos|sin|tan))\s+\(", r"\1(", text)).strip(" .")

    def _of_text(self, text: str) -> list[list[Point]]:
        """Return the points of a line."""
        text = self._plain(text)
        text = _CALLED.sub("", text, count=1) if _CALLED.match(text) else text
        if _NONE.fullmatch(text):
            return [[]]
        text = _WHOLE.sub("", text)
        for name in self.common:
            text = re.sub(
                rf"[,;]?\s*(?:\b(?:with|and|mit|und)\s+)?\b{name}\s+(?:is |ist )?(?:arbitrary|free|beliebig|frei)\b",
                "",
                text,
            )
        if "=" not in text and re.match(r"\[?\s*\{\s*\w+\s*:", text):
            text = re.sub(r"\}\s*,?\s*\{", "; ", text).strip("[]{} ").replace(":", "=")
        inside = text[1:-1].strip() if re.fullmatch(r"[{\[]\s*[\[({].*[\])}]\s*[}\]]", text) else text
        return self._with_signs(self._of_tuples(inside) or self._of_equations(inside) or self._of_values(inside))

    def _of_tuples(self, text: str) -> list[Point]:
        """Return the points that stand in brackets, each with what is said behind it; none where there are no brackets."""
        groups = [each for each in _groups(text) if self._is_tuple(text, *each)]
        if not groups:
            return []
        start, end = groups[0]
        if not _BEGIN.fullmatch(text[:start]):
            return []
        names: list[str] | None = None
        listed = [self._name_of(part) for part in _parts(text[start + 1 : end])]
        if all(listed) and re.match(rf"\s*(?:\^\s*\(?T\)?|')?\s*{_MEMBER}", text[end + 1 :]):
            names = [name for name in listed if name]
            groups = groups[1:]
        found = []
        for k, (start, end) in enumerate(groups):
            behind = text[end + 1 : groups[k + 1][0] if k + 1 < len(groups) else len(text)]
            behind = re.sub(r"^\s*(?:\^\s*\(?T\)?(?!\w)|'|ᵀ)", "", behind)
            behind = _LABEL.sub("", behind)
            point = self._of_tuple(_parts(text[start + 1 : end]), names)
            found.append(_with_remark(point, behind))
        return found

    def _is_tuple(self, text: str, start: int, end: int) -> bool:
        """Return whether a bracket is a point: several entries, or one where one name tells the points apart."""
        before = re.search(r"([A-Za-z_]\w*)\s*$", text[:start])
        if (
            before
            and text[start] == "("
            and before[1].lower()
            in {"acos", "asin", "atan", "sqrt", "arccos", "arcsin", "arctan", "cos", "sin", "log", "exp", "abs", "ln"}
        ):
            return False
        inside = text[start + 1 : end]
        if _REMARK.search(text[:start]) and re.search(r"[<>!≠]", inside):
            return False
        return len(_parts(inside)) > 1

    def _of_tuple(self, entries: Sequence[str], names: Sequence[str] | None = None) -> Point:
        states = [*self.given.states]
        coordinates = [name for name in states if self.given.motion is None or name in self.given.motion.coordinates]
        inputs = [*self.given.inputs]
        ways = [names] if names else [[*self.names], states, self.essential, [*coordinates, *inputs], coordinates]
        chosen = next((way for way in ways if len(way) == len(entries)), None)
        if chosen is None:
            message = f"({shown(', '.join(entries), 60)}) has {len(entries)} entries"
            expected = ", ".join(map(with_primes, names or self.names))
            raise InputError(message, where="points", repair=f"write the values of {expected}")
        return Point(dict(zip(chosen, (entry.strip() for entry in entries), strict=True)))

    def _of_equations(self, text: str) -> list[Point]:
        """Return the points of equations: a name that comes again begins a new point, several values are several points."""
        starts = [
            (found.start(), found.end(), name)
            for found in re.finditer(rf"(?<![\w.])([A-Za-z\u0391-\u03c9][\w'\u0307*^{{}}]*)\s*{_MEMBER}", text)
            if not _depth(text, found.start()) and (name := self._name_of(found[1])) is not None
        ]
        if not starts or _AND.sub("", text[: starts[0][0]]).strip("{( "):
            return []
        found: list[Point] = []
        open_values: dict[str, list[str]] = {}
        for k, (_, end, name) in enumerate(starts):
            value = text[end : starts[k + 1][0] if k + 1 < len(starts) else len(text)]
            remark = _first_remark(value)
            behind, value = value[remark:], value[:remark]
            if name in open_values:
                found += _product(open_values)
                open_values = {}
            open_values[name] = [
                entry for entry in _parts(_AND.sub("", value).strip().lstrip("{[").rstrip("}]")) if entry
            ]
            if behind:
                found += [_with_remark(point, behind) for point in _product(open_values)]
                open_values = {}
        return found + _product(open_values)

    def _of_values(self, text: str) -> list[Point]:
        """Return the values of the one name that tells the points apart."""
        if len(self.essential) != 1:
            raise self._unread(text)
        remark = _first_remark(text)
        values = [part for part in _parts(text[:remark].strip().lstrip("{[").rstrip("}]")) if part]
        if not values or any("=" in value for value in values):
            raise self._unread(text)
        return [_with_remark(Point({self.essential[0]: value}), text[remark:]) for value in values]

    def _with_signs(self, points: list[Point]) -> list[list[Point]]:
        """Return the points with both signs of ±: those of one point together, and else each for itself."""
        together, apart = list[Point](), list[Point]()
        for point in points:
            count = sum(value.count("±") for value in point.values.values())
            if count > 4:
                raise self._unread(point)
            for signs in product("+-", repeat=count):
                chosen = iter(signs)
                values = {
                    name: re.sub("±", lambda _, chosen=chosen: next(chosen), value).removeprefix("+").strip()  # type: ignore[misc]
                    for name, value in point.values.items()
                }
                apart.append(point._replace(values=values))
                if len({*signs}) < 2:
                    together.append(apart[-1])
        return [together] if len(together) == len(apart) else [together, apart]

    # -- values --------------------------------------------------------------------------------------------------------

    def values_of(self, point: Point, view: ResultInConvention, marking: Marking) -> Iterator[dict[str, Scalar]]:
        """Yield the values of a point, several where a whole number k stands in them; raises `InputError`."""
        own = names_of(view)
        names = None if own is None else {**own, **dict.fromkeys(self.names, "real")}
        free = {
            letter.strip(): name
            for name, letter in point.values.items()
            if _ANY.fullmatch(letter.strip()) or (letter.strip().isidentifier() and letter.strip() not in self.symbols)
        }
        free = {letter: name for letter, name in free.items() if letter not in {"pi", "π", *self.names}}
        whole = next(
            (
                k
                for k in "kn"
                if k not in self.symbols
                and any(re.search(rf"(?<![A-Za-z_]){k}(?![\w])", v) for v in point.values.values())
            ),
            "",
        )
        if whole in free:
            whole = ""
        rounding = marking.decimals == "accept" or self.are_rounded
        for k in range(-1, 3) if whole else (0,):
            found = dict(self.common)
            for name, text in point.values.items():
                letter = text.strip()
                if letter in free or letter == name:
                    found[name] = Scalar.symbol(name)
                    continue
                entry = re.sub(rf"(?<![A-Za-z_]){whole}(?![\w])", f"({k})", text) if whole else text
                entry = re.sub(r"(?<=\))\s*(?=pi\b)", "*", readable(entry))
                entry = in_letters(entry, {*self.symbols, *self.names, *free}, view.argument)
                told = None if names is None else {**names, **dict.fromkeys(free, "real")}
                value = parse_scalar(
                    entry if rounding else exact(entry),
                    told,
                    where="points",
                    functions=True,
                    rounding=rounding,
                    nonlinear=True,
                )
                found[name] = value.substitute(
                    {letter: Scalar.symbol(own) for letter, own in free.items() if letter in symbols_in(value)}
                )
            if left := [name for name in self.names if name not in found]:
                message = f"{with_primes(left[0])} has no value at {point}"
                raise InputError(message, where="points", repair=f"write for example {self.example}")
            yield found


def _tables(text: str) -> list[dict[str, str]] | None:
    """Return the tables of a text that is a list of them, as JSON or Python write it; None for any other."""
    inside = _CALLED.sub("", text.strip(), count=1)
    if len(inside) > _LONGEST or not re.match(r"\[?\s*\{\s*[\"']", inside):
        return None
    tables = [[(key[2], key[4]) for key in _ENTRY.finditer(table)] for table in re.findall(r"\{([^{}]*)\}", inside)]
    return [dict(table) for table in tables] if all(tables) else None


def _as_scalar(value: Scalar | str) -> Scalar:
    """Return a value, that of certain digits as a fraction."""
    return value if isinstance(value, Scalar) else Scalar.of(Fraction(value))


def _groups(text: str) -> list[tuple[int, int]]:
    """Return the places of the outermost round and square brackets."""
    found, depth, start = [], 0, 0
    for place, character in enumerate(text):
        if character in "([":
            start = place if not depth else start
            depth += 1
        elif character in ")]":
            depth -= 1
            if not depth:
                found.append((start, place))
    return found


def _depth(text: str, place: int) -> int:
    return sum(text[:place].count(c) for c in "([") - sum(text[:place].count(c) for c in ")]")


def _parts(text: str) -> list[str]:
    """Return what commas, semicolons or words set apart outside of brackets; else what blanks do between numbers."""
    parts, start = [], 0
    for found in _APART.finditer(text):
        if not _depth(text, found.start()):
            parts.append(text[start : found.start()].strip())
            start = found.end()
    parts.append(text[start:].strip())
    if len(parts) == 1 and re.fullmatch(r"\s*[-+]?[\w./]+(?:\s+[-+]?[\d][\d./]*)+\s*", text):
        return text.split()
    return [part for part in parts if part]


def _first_remark(text: str) -> int:
    """Return where a remark begins behind values, outside of brackets."""
    for found in _REMARK.finditer(text):
        if not _depth(text, found.start()):
            return found.start()
    return len(text)


def _product(values: Mapping[str, list[str]]) -> list[Point]:
    return [Point(dict(zip(values, each, strict=True))) for each in product(*values.values())] if values else []


def _with_remark(point: Point, behind: str) -> Point:
    """Return a point with the conditions and the stability that are said behind it; raises `InputError` for other words."""
    said = _SAID.search(behind)
    before, after = (behind, "") if said is None else (behind[: said.start()], behind[said.end() :])
    word = ""
    if said is not None:
        is_open = "conditional" in said[0].lower()
        word = "conditional" if is_open else "no" if _NOT_STABLE.search(said[0]) else "yes"
    conditions, stable_if = _conditions(before), _conditions(after)
    if stable_if and word in {"yes", "no"}:
        word, stable_if = "conditional", stable_if if word == "yes" else ()
    return point._replace(conditions=conditions, stable=word, stable_if=stable_if)


def _conditions(text: str) -> tuple[str, ...]:
    plain = _AND.sub("", _WHERE.sub("", _AND.sub("", text))).strip()
    if plain.startswith("(") and plain.endswith(")"):
        plain = _WHERE.sub("", plain[1:-1]).strip()
    if not plain:
        return ()
    if not re.search(r"[<>≠≥≤]|!=", plain):
        message = f'"{shown(plain, 60)}" is no condition'
        raise InputError(message, where="points", repair='write for example "where a > 1"')
    return tuple(as_conditions(in_inequalities(plain)))
