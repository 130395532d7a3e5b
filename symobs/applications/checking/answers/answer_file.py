"""The file of an answer: TOML, JSON, or a text of lines; nothing of it is executed."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import field
from itertools import takewhile
from typing import Any

from symobs.applications.checking.answers.definitions import definition, is_of_conditions, statements
from symobs.applications.checking.answers.values import VERDICTS, as_value, plain, typed
from symobs.formula.expression import declared_name
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import parse

MAX_BYTES, MAX_LINES = 64 * 1024, 200
MAX_NAME = 200
#: The keys of an answer file.
KEYS = ("student", "convention", "symbols", "let", "answer", "step")
_STEP = ("relation", "where", "let")
#: What tells a file of tables from a text of lines.
_TABLES = re.compile(r"(?m)^[ \t]*(\[\[?[ \t]*(answer|step)\b|(student|convention|symbols|let)[ \t]*=[ \t]*[\"'\[{])")
#: What begins a remark.
_REMARK = re.compile(r"[#%]")
_RELATION = re.compile(r"[=<>]|!=")
#: Several numbers in a row, and the bar of a quotient, as MATLAB displays them below a name.
_NUMBERS, _BAR = re.compile(r"[-+]?[\d.][\d.eE/+-]*(?:\s+[-+]?[\d.][\d.eE/+-]*)+"), re.compile(r"-{3,}")


@dataclass(frozen=True)
class Step:
    """One line of a derivation, its place, and what letters stand for in it."""

    relation: str
    where: str
    let: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Answer:
    """What a student hands in.

    values    by field, or by task a table by field; `loose` where some may be lines of a derivation only
    symbols   letters of the student's own, which are real
    """

    student: str = ""
    convention: str = ""
    symbols: tuple[str, ...] = ()
    let: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    steps: tuple[Step, ...] = ()
    loose: bool = False


def read_answer(given: str | Mapping[str, Any], where: str = "answer") -> Answer:
    """Return the answer of a text, or of a mapping from fields to values; raises `ProblemErrors` with every error."""
    if isinstance(given, Mapping):
        tables = set(given) & {"answer", "step"}
        return _of_tables(given if tables else {"answer": given})
    if len(given.encode(errors="surrogatepass")) > MAX_BYTES:
        message = f"the answer is larger than {MAX_BYTES // 1024} kB"
        raise ProblemErrors((InputError(message, where=where, repair="hand in the answer alone"),))
    text = typed(given)
    if text.lstrip().startswith("{") or _TABLES.search(text):
        return _of_tables(parse(text, where))
    return _of_lines(text, where)


def _of_lines(text: str, where: str) -> Answer:
    """Return the answer of lines: the last `NAME = value` of a name is the answer, and every line is a step.

    Lines of conditions are the answer to a region that none names.  What is no relation is a line that cannot be read;
    raises `ProblemErrors` where there are no others.
    """
    kept = _lines(text, where)
    values: dict[str, Any] = {}
    steps: list[Step] = []
    conditions: list[str] = []
    errors: list[SymobsError] = []
    for number, line in kept:
        place = f"line {number}"
        defined = definition(line)
        if not defined:
            steps.append(Step(line, place))
            if not _RELATION.search(line):
                message = f'"{shown(line, 60)}" is no relation'
                errors.append(InputError(message, where=place, repair="write for example L = [19; 81]"))
            elif is_of_conditions(line):
                conditions.append(line)
            continue
        value = as_value(defined.value)
        task, _, name = defined.name.rpartition(".")
        if value:
            (values.setdefault(task, {}) if task else values)[name] = value
        if not task and isinstance(value, str) and _is_relation(name, value):
            steps.append(Step(line if defined.is_chain else f"{name}{defined.argument} = {value}", place))
    if errors and len(errors) == len(kept):
        raise ProblemErrors(tuple(errors))
    if conditions and not any("stable_if" in table for table in (values, values.get("stability_region", {}))):
        values["stable_if"] = conditions
    return Answer(values=values, steps=tuple(steps), loose=True)


def _is_relation(name: str, value: str) -> bool:
    """Return whether a definition is a relation of a derivation, as a verdict and a region are not."""
    return name != "stable_if" and value.lower() not in VERDICTS


def _lines(text: str, where: str) -> list[tuple[int, str]]:
    """Return the lines that say something, with their numbers; a matrix that is not closed goes on in the lines below it."""
    split = [(i, _REMARK.split(line, maxsplit=1)[0].strip()) for i, line in enumerate(text.splitlines(), start=1)]
    written = [(i, line) for i, line in split if line]
    _at_most(len(written), where)
    found: list[tuple[int, str]] = []
    while written:
        number, line = written.pop(0)
        if (named := definition(line)) and not named.value:
            line = f"{line} {_displayed(written)}"
        below, is_open = 0, _opened(line)
        while is_open > 0 and below < len(written) and not _RELATION.search(written[below][1]):
            is_open += _opened(written[below][1])
            below += 1
        if is_open == 0:
            line = "\n".join([line, *(part for _, part in written[:below])])
            del written[:below]
        while written and written[0][1].startswith("="):  # a chain goes on
            line = f"{line} {written.pop(0)[1]}"
        found += [(number, part.strip()) for part in statements(line)]
    _at_most(len(found), where)
    return found


def _displayed(written: list[tuple[int, str]]) -> str:
    """Take what is displayed below its name: a quotient over its bar, the rows of a matrix, or one expression."""
    lines = [line for _, line in takewhile(lambda each: not _RELATION.search(each[1]), written)]
    if len(lines) > 2 and _BAR.fullmatch(lines[1]):
        del written[:3]
        return f"({lines[0]})/({lines[2]})"
    del written[: len(lines)]
    if len(lines) == 1 and not _NUMBERS.fullmatch(lines[0]):
        return lines[0]
    return f"[{'; '.join(line.strip('[] ') for line in lines)}]" if lines else ""


def _at_most(lines: int, where: str) -> None:
    if lines > MAX_LINES:
        message = f"{lines} lines, more than {MAX_LINES}"
        raise ProblemErrors((InputError(message, where=where, repair="hand in what leads to the answer"),))


def _opened(line: str) -> int:
    """Return how many brackets a line leaves open."""
    return line.count("[") - line.count("]")


def _of_tables(data: Mapping[str, Any]) -> Answer:
    """Return the answer of the tables of a file."""
    errors: list[SymobsError] = []

    def note(message: str, where: str, repair: str) -> None:
        errors.append(InputError(message, where=where, repair=repair))

    def table(source: Mapping[str, Any], name: str, where: str) -> Mapping[str, Any]:
        value = source.get(name, {})
        if isinstance(value, Mapping):
            return value
        note("a table is expected", where, f"write [{name}] and its keys below")
        return {}

    def text(source: Mapping[str, Any], name: str, where: str, most: int = MAX_NAME) -> str:
        value = source.get(name, "")
        if isinstance(value, str) and len(value) <= most:
            return typed(value)
        note(f"a text of at most {most} characters is expected", where, "write it in quotes")
        return ""

    def letters(source: Mapping[str, Any], where: str) -> dict[str, str]:
        found = table(source, "let", where)
        for name, meaning in found.items():
            if not isinstance(meaning, str):
                note("a text is expected", f"{where}.{shown(name, 40)}", 'write let = { M = "[m1; m2]" }')
        return {name: typed(str(meaning)) for name, meaning in found.items()}

    for key in data:
        if key not in KEYS:
            note("unknown key", shown(str(key), 40), f"known keys are {', '.join(KEYS)}; answers belong to [answer]")
    symbols = data.get("symbols", [])
    if not isinstance(symbols, list) or not all(isinstance(name, str) for name in symbols):
        note("a list of names is expected", "symbols", 'write symbols = ["m1", "m2"]')
        symbols = []
    for i, name in enumerate(symbols):
        try:
            declared_name(name, f"symbols[{i}]")
        except SymobsError as error:
            errors.append(error)
    steps = data.get("step", [])
    if not isinstance(steps, list) or len(steps) > MAX_LINES:
        note(f"a list of at most {MAX_LINES} steps is expected", "step", "write [[step]], one a line")
        steps = []
    read: list[Step] = []
    for i, step in enumerate(steps, start=1):
        place = f"step[{i - 1}]"
        if not isinstance(step, Mapping) or not set(step) <= set(_STEP) or not isinstance(step.get("relation"), str):
            note("a table with relation is expected", place, f"known keys are {', '.join(_STEP)}")
            continue
        said = text(step, "where", f"{place}.where") or f"line {i}"
        relation = text(step, "relation", f"{place}.relation", MAX_BYTES)
        read.append(Step(relation, said, letters(step, f"{place}.let")))
    student, convention = text(data, "student", "student"), text(data, "convention", "convention")
    values = {str(key): plain(value) for key, value in table(data, "answer", "answer").items()}
    let = letters(data, "let")
    if errors:
        raise ProblemErrors(tuple(errors))
    return Answer(student, convention, tuple(symbols), let, values, tuple(read))
