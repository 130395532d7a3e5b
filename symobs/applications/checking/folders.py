"""The files that students hand in: which of a folder are whose, which can be read, and what text they hold."""

from __future__ import annotations

import codecs
import html
import json
import re
from typing import TYPE_CHECKING

from symobs.applications.checking.answers import MAX_BYTES, read_answer
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, SymobsError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path


# -- texts -------------------------------------------------------------------------------------------------------------


#: More of a file is not read: a notebook with its pictures is larger than the answer in it.
MOST_BYTES = 8 * 1024 * 1024
_MARKS = ((codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"))
#: Kinds of files that are no text, by what they begin with.
_KINDS = {
    b"%PDF": "a PDF",
    b"PK\x03\x04": "a ZIP archive or an office document",
    b"{\\rtf": "a rich text",
    b"\x89PNG": "a picture",
    b"\xff\xd8\xff": "a picture",
    b"\xd0\xcf\x11\xe0": "an office document",
}
_CONTROL = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
SAVE_AS_TEXT = "save the answer as plain text in UTF-8"


def decoded(raw: bytes) -> tuple[str, str]:
    """Return the text of bytes, and a note on its encoding where that is not UTF-8; raises `InputError` for no text."""
    for beginning, kind in _KINDS.items():
        if raw.startswith(beginning):
            raise InputError(f"this is {kind}, no text", repair=SAVE_AS_TEXT)
    for mark, encoding in _MARKS:
        if raw.startswith(mark):
            return _as(raw, encoding), "read as UTF-16"
    low, high = raw[::2].count(0), raw[1::2].count(0)
    if len(raw) > 1 and 5 * max(low, high) > 2 * len(raw) and not min(low, high):  # most of it is ASCII
        return _as(raw, "utf-16-be" if low else "utf-16-le"), "read as UTF-16"
    if _CONTROL.search(raw):
        raise InputError("this is no text", repair=SAVE_AS_TEXT)
    try:
        return raw.decode("utf-8-sig"), ""
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace"), "read as Latin-1"


def _as(raw: bytes, encoding: str) -> str:
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as error:
        raise InputError(reason_of(error), repair=SAVE_AS_TEXT) from None


def text_of_answer(raw: bytes, name: str) -> tuple[str, str]:
    """Return the answer in the bytes of a file of this name, and a note on its encoding.

    Of a notebook these are its cells, of a page of HTML its text.  Raises `InputError` for no text.
    """
    text, note = decoded(raw)
    suffix = name.rpartition(".")[2].lower()
    if suffix == "ipynb":
        text = _of_notebook(text)
    elif suffix in {"html", "htm"}:
        text = html.unescape(re.sub(r"<[^>]*>", "", re.sub(r"(?i)</(?:p|div|li|tr|h\d)>|<br\s*/?>", "\n", text)))
    if len(text.encode(errors="surrogatepass")) > MAX_BYTES:
        raise InputError(f"the answer is larger than {MAX_BYTES // 1024} kB", repair="hand in the answer alone")
    return text, note


def text_of_path(path: Path) -> tuple[str, str]:
    """Return the answer in a file, and a note on its encoding; raises `InputError` where it cannot be read."""
    try:
        with path.open("rb") as stream:
            raw = stream.read(MOST_BYTES)
    except (OSError, ValueError) as error:
        repair = "give the path of a file, or its text"
        raise InputError(reason_of(error), where=shown(str(path), 200), repair=repair) from None
    return text_of_answer(raw, path.name)


def _of_notebook(text: str) -> str:
    """Return the sources of the cells of a notebook, one below the other."""
    try:
        cells = json.loads(text)["cells"]
        sources = [cell["source"] for cell in cells if cell["cell_type"] in {"code", "markdown", "raw"}]
        return "\n".join(source if isinstance(source, str) else "".join(source) for source in sources)
    except (ValueError, LookupError, TypeError, RecursionError):
        raise InputError("this is no notebook", repair=SAVE_AS_TEXT) from None


# -- folders -----------------------------------------------------------------------------------------------------------


#: Files that programs lay beside those of a student.
_OF_PROGRAMS = re.compile(r"\..*|__.*|thumbs\.db|desktop\.ini", re.IGNORECASE)
#: What Moodle adds to the name of a student's folder.
_OF_MOODLE = re.compile(r"_assignsubmission_\w+?_?$")
#: Endings that belong to a file and not to the name of a student.
_ENDING = re.compile(r"\.[A-Za-z]\w{0,5}$")


@dataclass
class AnswerFile:
    """A file of a student: its place in the folder and its text, or the reason why it has none."""

    student: str
    place: str
    text: str = ""
    note: str = ""
    reason: str = ""


def files_of(folder: Path) -> Iterator[list[AnswerFile]]:
    """Yield the files of each student in a folder: those with one name, or those of a folder of the student's own."""
    students: dict[str, list[AnswerFile]] = {}
    for path in sorted(folder.iterdir()):
        if _OF_PROGRAMS.fullmatch(path.name):
            continue
        student = _OF_MOODLE.sub("", path.name) if path.is_dir() else _ENDING.sub("", path.name)
        files = sorted(_below(path)) if path.is_dir() else [path]
        own = students.setdefault(student, [])
        own += [_read(file, student, file.relative_to(folder).as_posix()) for file in files]
        if not files:
            own.append(AnswerFile(student, f"{path.name}/", reason="this folder has no file"))
    yield from students.values()


def _below(folder: Path) -> Iterator[Path]:
    """Yield the files in a folder and in those below it, without what programs lay there."""
    for path in folder.iterdir():
        if _OF_PROGRAMS.fullmatch(path.name):
            continue
        if path.is_dir():
            yield from _below(path)
        else:
            yield path


def _read(path: Path, student: str, place: str) -> AnswerFile:
    try:
        text, note = text_of_path(path)
    except InputError as error:
        return AnswerFile(student, place, reason=f"{error.message}; {error.repair}")
    return AnswerFile(student, place, text, note)


def counting(files: Sequence[AnswerFile]) -> AnswerFile | None:
    """Return the file that counts: the last in which an answer can be read, else the last text; None without one."""
    texts = [file for file in files if not file.reason]
    return next((file for file in reversed(texts) if _says_something(file.text)), texts[-1] if texts else None)


def _says_something(text: str) -> bool:
    try:
        answer = read_answer(text)
    except SymobsError:
        return False
    return bool(answer.values)


def written_place(place: str) -> str:
    """Return the place of a file for messages."""
    return shown(place, 120)
