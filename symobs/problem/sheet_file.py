"""The file of a sheet: its head, its problems with their points and hints, and how it is to be handed out."""

from __future__ import annotations

import re
from datetime import date
from os.path import normpath
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from symobs.formula.expression.source import shown
from symobs.formula.phrases.languages import languages
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, reason_of
from symobs.pages.page.blocks import AnswerSpace
from symobs.pages.page.sheet import Header, Logo
from symobs.problem.fields import FLAG, TEXT, Field, fraction_of, is_integer, list_of, one_of, single, table, whole
from symobs.problem.file_tables import Decimal, Errors, parse
from symobs.problem.validation import read_convention

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from fractions import Fraction

    from symobs.formula.convention import Convention

_MOST_PROBLEMS = 200
_MOST_POINTS = 1000
_SPACE = (4, 25)  # centimetres: where nothing is said, and at most
_MOST_OF_LOGO = 2 << 20  # bytes
_BEGINNINGS = {"png": b"\x89PNG\r\n\x1a\n", "jpg": b"\xff\xd8\xff", "pdf": b"%PDF-"}
_SAFE_PATH = re.compile(r"[A-Za-z0-9._/-]+")
# -- single values ----------------------------------------------------------------------------------------------------


def _number(value: object, where: str, errors: Errors) -> str | None:
    """Return the number of a sheet, which may have a letter."""
    if is_integer(value) and 0 <= value <= _MOST_POINTS:
        return str(value)
    if isinstance(value, int | Decimal):
        errors.note("this is no number of a sheet", where, 'write number = 3, or number = "3a"')
        return None
    return TEXT.read(value, where, errors)  # type: ignore[no-any-return]


def _points(value: object, where: str, errors: Errors) -> tuple[Fraction, ...]:
    """Return points as they are given: one value, or a list with one for each part."""
    values = value if isinstance(value, list) else [value]
    found = [fraction_of(each, where) for each in values]
    for place, points in enumerate(found):
        if points is None or not 0 <= points <= _MOST_POINTS or (points * 100).denominator != 1:
            message = f"a number from 0 to {_MOST_POINTS} with at most two decimals is expected"
            at = f"{where}[{place}]" if isinstance(value, list) else where
            errors.note(message, at, "write points = 10, or points = [4, 6] for two parts")
    if not found:
        errors.note("the list is empty", where, "write points = 10, or leave it out")
    return tuple(found)


def _problems(value: object, where: str, errors: Errors) -> tuple[Any, ...]:
    if value == []:
        errors.note("no problem is named", where, 'write [[problem]] and below it file = "problem.toml"')
    return _LISTED.read(value, where, errors)  # type: ignore[no-any-return]


# -- the tables -------------------------------------------------------------------------------------------------------

_SOME_POINTS = {"anyOf": [{"type": "number", "minimum": 0, "maximum": _MOST_POINTS}, TEXT.schema]}
_POINTS = {"anyOf": [*_SOME_POINTS["anyOf"], {"type": "array", "minItems": 1, "items": _SOME_POINTS}]}
_ROOM = whole(
    1,
    _SPACE[1],
    f"a whole number of centimetres from 1 to {_SPACE[1]} is expected",
    f"write space = {_SPACE[0]}",
)
#: The keys of one entry.
PROBLEM = {
    "points": Field(_POINTS, _points).about("a number for the problem, or a list with one for each of its parts"),
    "hint": TEXT.about("words for the end of the sheet"),
    "space": _ROOM.about("as for the sheet"),
    "file": TEXT._replace(schema={**TEXT.schema, "minLength": 1}).about(
        "the path of the problem file, from the folder of the sheet"
    ),
}
_LISTED = list_of(table(PROBLEM), _MOST_PROBLEMS, of="problems", repair="make several sheets")
_ENTRY = {**_LISTED.schema["items"], "required": ["file"]}
_DUE = single(
    TEXT.schema,
    lambda value: isinstance(value, date | str) and not isinstance(value, Decimal),
    "a date or a text is expected, but {came} came",
    'write due = 2026-12-08 or due = "Monday"',
)
_LOGO = single(
    TEXT.schema,
    lambda value: isinstance(value, str) and not isinstance(value, Decimal),
    "the path of a picture is expected, but {came} came",
    'write logo = "logo.png"',
)
#: The keys of the file.
SHEET = {
    "title": TEXT.about("the title of the sheet"),
    "course": TEXT.about("the name of the course"),
    "term": TEXT.about("the term"),
    "instructor": TEXT.about("who gives the sheet out"),
    "text": TEXT.about("words below the head, for all problems"),
    "language": one_of(*languages()).about("the language of the sheet"),
    "style": one_of("exercise", "exam").about(
        "exercise: all questions, then all solutions; exam: a page a problem, its solution right after it"
    ),
    "answers": one_of("none", "space", "lines").about(
        "none, space, or lines: room for answers on questions that are handed out alone"
    ),
    "number": Field(
        {"anyOf": [{"type": "integer", "minimum": 0, "maximum": _MOST_POINTS}, TEXT.schema]}, _number
    ).about("the number of the sheet"),
    "due": _DUE.about("when the answers are due"),
    "logo": _LOGO.about("a picture at its head: the path of a png, jpg or pdf beside the file"),
    "convention": Field(TEXT.schema, lambda value, *_: value).about(
        "the convention of all its pages; that of each problem where nothing is said"
    ),
    "name": FLAG.about("true: a line for name and student number"),
    "space": _ROOM.about("the room for the answer of one part, in centimetres"),
    "final_answers": FLAG.about("true: the answers alone at the end, after the hints"),
    "problem": Field({**_LISTED.schema, "minItems": 1, "items": _ENTRY}, _problems).about(
        "the problems: [[problem]], one an entry"
    ),
}
_FILE = table(SHEET)
_OWN = "|".join(key for key in SHEET if key not in {"title", "text", "language", "convention"})
_SHEET_KEY = re.compile(rf"""^[^\S\n]*(?:\[\[\s*"?problem"?\s*\]\]|"?(?:{_OWN})"?\s*=)""", re.MULTILINE)
_PROBLEM_KEY = re.compile(
    r"""^[^\S\n]*(?:"?tasks?"?\s*=|\[\s*"?(?:plant|specification|symbols)"?\s*\])""", re.MULTILINE
)
_IN_JSON = re.compile(rf'"(?:{_OWN})"\s*:'), re.compile(r'"(?:tasks?|plant|specification)"\s*:')


def schema() -> dict[str, Any]:
    """Return the JSON schema of the file of a sheet."""
    own = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "symobs sheet"}
    return {**own, **_FILE.schema, "required": ["problem"]}


@dataclass
class SheetProblem:
    """A problem of a sheet: file, points, hint, room for the answer, and the letter of its version if there are any."""

    file: str
    points: tuple[Fraction, ...] = ()
    hint: str = ""
    space: AnswerSpace | None = None
    version: str = ""


@dataclass
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
    given = _FILE.read({"problem": [], **data}, "", errors)
    is_exam = given.get("style") == "exam"
    header = Header(
        **{key: given.get(key, "") for key in ("course", "term", "number", "due", "instructor", "text")},
        logo=_logo(given["logo"], folder, errors) if "logo" in given else None,
        has_name=given.get("name", is_exam),
        is_exam=is_exam,
    )
    room = given.get("answers", "space" if is_exam else "none")
    problems, texts = [], []
    for i, entry in enumerate(given["problem"]):
        space = entry.get("space", given.get("space", _SPACE[0]))
        room_of_part = AnswerSpace(space, room == "lines") if room != "none" else None
        file, problem_text = _file(entry, f"problem[{i}]", folder, read, errors)
        problems.append(SheetProblem(file, entry.get("points", ()), entry.get("hint", ""), room_of_part))
        texts.append(problem_text)
    convention = read_convention(data, folder, errors) if "convention" in data else None
    if errors.found:
        errors.found.sort(key=lambda error: _order(error.where))
        for error in errors.found:
            error.where = f"{shown(where, 200)}, {error.where}"
        raise errors.together()
    final, language = given.get("final_answers", False), given.get("language", "")
    return SheetFile(given.get("title", ""), header, tuple(problems), tuple(texts), final, convention, language)


def _order(place: str) -> tuple[int, int]:
    """Return where a place stands among the keys of the file, and among its problems."""
    key, number = re.findall(r"^(\w*)\[?([0-9]*)", place)[0]
    return [*SHEET].index(key) if key in SHEET else -1, int(number or 0)


def _file(
    entry: Mapping[str, Any], where: str, folder: Path, read: Callable[[str], str], errors: Errors
) -> tuple[str, str]:
    """Return the path of the file of a problem, and its text."""
    name, text, points = entry.get("file", ""), "", entry.get("points", ())
    path = normpath(folder / name)
    if not name:
        errors.note("no file is named", f"{where}.file", 'write file = "problem.toml"')
        return path, text
    try:
        text = read(path)
    except InputError as error:
        repair = f"give the path of a problem file, from {shown(str(folder), 200)}"
        errors.note(f"{shown(name, 100)}: {error.message}", f"{where}.file", repair)
    parts = _parts(text)
    if parts is not None and len(points) > 1 and len(points) != parts:
        message = f"{len(points)} values for {parts} part{'s' * (parts != 1)}"
        errors.note(message, f"{where}.points", "give one value for each task of the problem, or one for all")
    return path, text


def _parts(text: str) -> int | None:
    """Return the number of parts of a problem, None where its file says none that can be read."""
    try:
        tasks = parse(text).get("tasks", "")
    except ProblemErrors:
        return None
    return len(tasks) if isinstance(tasks, list) else 1 if text else None


# -- the logo ---------------------------------------------------------------------------------------------------------


def _logo(value: str, folder: Path, errors: Errors) -> Logo | None:
    """Return the picture at the head; None, and a note of why, where it cannot be one."""
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
