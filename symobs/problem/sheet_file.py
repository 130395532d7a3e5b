"""The file of a sheet: its head, its problems with their points and hints, and how it is to be handed out."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from datetime import date
from difflib import get_close_matches
from fractions import Fraction
from os.path import normpath
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from symobs.formula.expression import parse_scalar
from symobs.formula.expression.source import shown
from symobs.formula.phrases.languages import languages
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, reason_of
from symobs.pages.page.blocks import AnswerSpace
from symobs.pages.page.sheet import Header, Logo
from symobs.problem.file_tables import Decimal, came, parse
from symobs.problem.noted_errors import Errors, check_text
from symobs.problem.validation import read_convention

if TYPE_CHECKING:
    from symobs.formula.convention import Convention

#: The keys of the file, each with what it is for.
SHEET: dict[str, str] = {
    "title": "the title of the sheet",
    "course": "the name of the course",
    "term": "the term",
    "number": "the number of the sheet",
    "due": "when the answers are due",
    "instructor": "who gives the sheet out",
    "logo": "a picture at its head: the path of a png, jpg or pdf beside the file",
    "text": "words below the head, for all problems",
    "language": "the language of the sheet",
    "convention": "the convention of all its pages; that of each problem where nothing is said",
    "style": "exercise: all questions, then all solutions; exam: a page a problem, its solution right after it",
    "name": "true: a line for name and student number",
    "answers": "none, space, or lines: room for answers on questions that are handed out alone",
    "space": "the room for the answer of one part, in centimetres",
    "final_answers": "true: the answers alone at the end, after the hints",
    "problem": "the problems: [[problem]], one an entry",
}
#: The keys of one entry.
PROBLEM: dict[str, str] = {
    "file": "the path of the problem file, from the folder of the sheet",
    "points": "a number for the problem, or a list with one for each of its parts",
    "hint": "words for the end of the sheet",
    "space": "as for the sheet",
}
_CHOICES = {"style": ("exercise", "exam"), "answers": ("none", "space", "lines")}
_TEXTS = ("title", "course", "term", "instructor", "text")
_MOST_PROBLEMS = 200
_MOST_POINTS = 1000
_SPACE = (4, 25)  # centimetres: where nothing is said, and at most
_MOST_OF_LOGO = 2 << 20  # bytes
_BEGINNINGS = {"png": b"\x89PNG\r\n\x1a\n", "jpg": b"\xff\xd8\xff", "pdf": b"%PDF-"}
_SAFE_PATH = re.compile(r"[A-Za-z0-9._/-]+")
_OWN = "|".join(key for key in SHEET if key not in {"title", "text", "language", "convention"})
_SHEET_KEY = re.compile(rf"""^[^\S\n]*(?:\[\[\s*"?problem"?\s*\]\]|"?(?:{_OWN})"?\s*=)""", re.MULTILINE)
_PROBLEM_KEY = re.compile(
    r"""^[^\S\n]*(?:"?tasks?"?\s*=|\[\s*"?(?:plant|specification|symbols)"?\s*\])""", re.MULTILINE
)
_IN_JSON = re.compile(rf'"(?:{_OWN})"\s*:'), re.compile(r'"(?:tasks?|plant|specification)"\s*:')


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file of a sheet."""
    text: dict[str, Any] = {"type": "string"}
    points = {"anyOf": [{"type": "number", "minimum": 0, "maximum": _MOST_POINTS}, text]}
    space = {"type": "integer", "minimum": 1, "maximum": _SPACE[1]}
    entry: dict[str, Any] = {
        "file": {**text, "minLength": 1},
        "points": {"anyOf": [*points["anyOf"], {"type": "array", "minItems": 1, "items": points}]},
        "hint": text,
        "space": space,
    }
    own: dict[str, Any] = {
        **dict.fromkeys((*_TEXTS, "due", "logo", "convention"), text),
        "number": {"anyOf": [{"type": "integer", "minimum": 0, "maximum": _MOST_POINTS}, text]},
        "language": {"enum": list(languages())},
        **{key: {"enum": list(known)} for key, known in _CHOICES.items()},
        **{key: {"type": "boolean"} for key in ("name", "final_answers")},
        "space": space,
        "problem": {
            "type": "array",
            "minItems": 1,
            "maxItems": _MOST_PROBLEMS,
            "items": _table(PROBLEM, entry, "file"),
        },
    }
    whole = _table(SHEET, own, "problem")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs sheet", **whole}


def _table(about: Mapping[str, str], kinds: Mapping[str, Any], required: str) -> dict[str, Any]:
    """Return the schema of a table, each key with what it is for."""
    properties = {key: {"description": words, **kinds[key]} for key, words in about.items()}
    return {"type": "object", "properties": properties, "required": [required], "additionalProperties": False}


@dataclass(frozen=True)
class SheetProblem:
    """A problem of a sheet: file, points, hint, and room for the answer."""

    file: str
    points: tuple[Fraction, ...] = ()
    hint: str = ""
    space: AnswerSpace | None = None


@dataclass(frozen=True)
class SheetFile:
    """A validated sheet: its head, and its problems with the texts of their files."""

    title: str
    header: Header
    problems: tuple[SheetProblem, ...]
    texts: tuple[str, ...]
    has_final_answers: bool = False
    convention: Convention | None = None
    #: The code of the language of the sheet and all its pages; empty where the file names none.
    language: str = ""


def is_sheet(text: str) -> bool:
    """Return whether a file is that of a sheet, by its keys: also where it cannot be parsed."""
    own, other = _IN_JSON if text.lstrip().startswith("{") else (_SHEET_KEY, _PROBLEM_KEY)
    return bool(own.search(text)) and not other.search(text)


def read_sheet(text: str, where: str, folder: Path, read: Callable[[str], str]) -> SheetFile:
    """Return the sheet a file describes, whose problems `read` reads.  Raises `ProblemErrors` with all its errors."""
    data, errors = parse(text, where), Errors()
    _report_unknown(data, SHEET, "", errors)
    words = {key: _text(data.get(key, ""), key, errors) for key in _TEXTS}
    language = _choice(data["language"], languages(), "language", errors) if "language" in data else ""
    chosen = {key: _choice(data.get(key, known[0]), known, key, errors) for key, known in _CHOICES.items()}
    is_exam = chosen["style"] == "exam"
    header = Header(
        course=words["course"],
        term=words["term"],
        number=_number(data.get("number", ""), errors),
        due=_date(data.get("due", ""), errors),
        instructor=words["instructor"],
        text=words["text"],
        logo=_logo(data["logo"], folder, errors) if "logo" in data else None,
        has_name=_flag(data, "name", errors, default=is_exam),
        is_exam=is_exam,
    )
    room = chosen["answers"] if "answers" in data or not is_exam else "space"
    space = _space(data.get("space", _SPACE[0]), room, "space", errors)
    problems, texts = [], []
    for place, entry in _entries(data, errors):
        asked, problem_text = _asked(entry, place, folder, space, room, read, errors)
        problems.append(asked)
        texts.append(problem_text)
    final = _flag(data, "final_answers", errors, default=False)
    convention = read_convention(data, folder, errors) if "convention" in data else None
    if errors.found:
        raise _placed(errors, where)
    return SheetFile(words["title"], header, tuple(problems), tuple(texts), final, convention, language)


def _placed(errors: Errors, where: str) -> ProblemErrors:
    """Return all errors, each with the file before its place."""
    for error in errors.found:
        error.where = f"{shown(where, 200)}, {error.where}"
    return errors.together()


def _report_unknown(table: Mapping[str, Any], known: Collection[str], where: str, errors: Errors) -> None:
    for key in table:
        if key not in known:
            near = get_close_matches(key[:64], known, 1)
            repair = f"did you mean {near[0]}?" if near else f"known keys are {', '.join(known)}"
            errors.note("unknown key", f"{where}.{shown(key, 40)}".lstrip("."), repair)


# -- single values ----------------------------------------------------------------------------------------------------


def _text(value: object, where: str, errors: Errors) -> str:
    check_text(value, where, errors)
    return value if isinstance(value, str) else ""


def _choice(value: object, known: Collection[str], where: str, errors: Errors) -> str:
    if value not in known or not isinstance(value, str):
        given = f'"{shown(value, 40)}"' if isinstance(value, str) else came(value)
        errors.note(f"{given} is no choice", where, f"write one of {', '.join(known)}")
        return next(iter(known))
    return value


def _flag(table: Mapping[str, Any], key: str, errors: Errors, *, default: bool) -> bool:
    value = table.get(key, default)
    if not isinstance(value, bool):
        errors.note(f"true or false is expected, but {came(value)} came", key, f"write {key} = true")
    return value is True


def _number(value: object, errors: Errors) -> str:
    """Return the number of a sheet, which may have a letter."""
    if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= _MOST_POINTS:
        return str(value)
    if isinstance(value, int | Decimal):
        errors.note("this is no number of a sheet", "number", 'write number = 3, or number = "3a"')
        return ""
    return _text(value, "number", errors)


def _date(value: object, errors: Errors) -> str | date:
    """Return when the answers are due: words, or a date, which the language of the sheet writes."""
    if isinstance(value, date):
        return value
    if isinstance(value, str) and not isinstance(value, Decimal):
        return _text(value, "due", errors)
    errors.note(
        f"a date or a text is expected, but {came(value)} came", "due", 'write due = 2026-12-08 or due = "Monday"'
    )
    return ""


def _space(value: object, room: str, where: str, errors: Errors) -> AnswerSpace | None:
    """Return the room for an answer, None where there is none."""
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= _SPACE[1]:
        message = f"a whole number of centimetres from 1 to {_SPACE[1]} is expected"
        errors.note(message, where, f"write space = {_SPACE[0]}")
        return None
    return AnswerSpace(value, room == "lines") if room != "none" else None


def _points(value: object, where: str, errors: Errors) -> tuple[Fraction, ...]:
    """Return points as they are given: one value, or a list with one for each part."""
    values = value if isinstance(value, list) else [value]
    found = []
    for place, each in enumerate(values):
        try:
            points = parse_scalar(each, {}, where=where).fraction()
        except (SymobsError, ArithmeticError, ValueError):
            points = Fraction(-1)
        if isinstance(each, bool) or not 0 <= points <= _MOST_POINTS or (points * 100).denominator != 1:
            message = f"a number from 0 to {_MOST_POINTS} with at most two decimals is expected"
            at = f"{where}[{place}]" if isinstance(value, list) else where
            errors.note(message, at, "write points = 10, or points = [4, 6] for two parts")
        found.append(points)
    if not found:
        errors.note("the list is empty", where, "write points = 10, or leave it out")
    return tuple(found)


# -- the problems -----------------------------------------------------------------------------------------------------


def _entries(data: Mapping[str, Any], errors: Errors) -> list[tuple[str, Mapping[str, Any]]]:
    """Return the entries of the problems, each with its place."""
    value = data.get("problem", [])
    entries = value if isinstance(value, list) else [value]
    if not entries:
        errors.note("no problem is named", "problem", 'write [[problem]] and below it file = "problem.toml"')
    if len(entries) > _MOST_PROBLEMS:
        message = f"{len(entries)} problems, more than {_MOST_PROBLEMS}"
        errors.note(message, "problem", "make several sheets")
    found = []
    for number, entry in enumerate(entries[:_MOST_PROBLEMS]):
        where = f"problem[{number}]"
        if isinstance(entry, Mapping):
            found.append((where, entry))
        else:
            errors.note(f"a table is expected, but {came(entry)} came", where, "write [[problem]] and its keys below")
    return found


def _asked(
    entry: Mapping[str, Any],
    where: str,
    folder: Path,
    usual: AnswerSpace | None,
    room: str,
    read: Callable[[str], str],
    errors: Errors,
) -> tuple[SheetProblem, str]:
    """Return the entry of a problem, and the text of its file."""
    _report_unknown(entry, PROBLEM, where, errors)
    points = _points(entry["points"], f"{where}.points", errors) if "points" in entry else ()
    hint = _text(entry.get("hint", ""), f"{where}.hint", errors)
    space = _space(entry["space"], room, f"{where}.space", errors) if "space" in entry else usual
    name, text = _text(entry.get("file", ""), f"{where}.file", errors), ""
    path = normpath(folder / name)
    if not name and isinstance(entry.get("file", ""), str):
        errors.note("no file is named", f"{where}.file", 'write file = "problem.toml"')
    elif name:
        try:
            text = read(path)
        except InputError as error:
            repair = f"give the path of a problem file, from {shown(str(folder), 200)}"
            errors.note(f"{shown(name, 100)}: {error.message}", f"{where}.file", repair)
        parts = _parts(text)
        if parts is not None and len(points) > 1 and len(points) != parts:
            message = f"{len(points)} values for {parts} part{'s' * (parts != 1)}"
            errors.note(message, f"{where}.points", "give one value for each task of the problem, or one for all")
    return SheetProblem(path, points, hint, space), text


def _parts(text: str) -> int | None:
    """Return the number of parts of a problem, None where its file says none that can be read."""
    try:
        tasks = parse(text).get("tasks", "")
    except ProblemErrors:
        return None
    return len(tasks) if isinstance(tasks, list) else 1 if text else None


# -- the logo ---------------------------------------------------------------------------------------------------------


def _logo(value: object, folder: Path, errors: Errors) -> Logo | None:
    """Return the picture at the head; None, and a note of why, where it cannot be one."""
    if not isinstance(value, str) or isinstance(value, Decimal):
        errors.note(f"the path of a picture is expected, but {came(value)} came", "logo", 'write logo = "logo.png"')
        return None
    kind = PurePosixPath(value).suffix.lower().removeprefix(".").replace("jpeg", "jpg")
    if kind not in _BEGINNINGS:
        errors.note(f'"{shown(value, 60)}" is no picture that pages can show', "logo", "give a png, jpg or pdf")
        return None
    if not _SAFE_PATH.fullmatch(value):
        message = f'"{shown(value, 60)}" has characters that TeX cannot find a file by'
        errors.note(message, "logo", "name it with letters, digits, - and _ alone")
        return None
    path = (folder / value).resolve()
    if not path.is_relative_to(folder.resolve()):
        errors.note(f'"{value}" lies outside the folder of the sheet', "logo", "copy it there")
        return None
    try:
        with path.open("rb") as stream:
            content = stream.read(_MOST_OF_LOGO + 1)
    except OSError as error:
        errors.note(f"{value}: {reason_of(error)}", "logo", f"give its path from {shown(str(folder), 200)}")
        return None
    if len(content) > _MOST_OF_LOGO:
        errors.note(f"the picture is larger than {_MOST_OF_LOGO >> 20} MB", "logo", "make it smaller")
    elif not content.startswith(_BEGINNINGS[kind]):
        errors.note(f"{value} is not a {kind}, whatever it is called", "logo", "give a png, jpg or pdf")
    return Logo(kind, content, str(path))
