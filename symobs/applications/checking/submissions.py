"""The submissions of a class, a CSV table, JSON Lines, or a folder of files, and the problems that they answer."""

from __future__ import annotations

import csv
import io
import json
import re
from dataclasses import field, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import Job, canonical, digest, job
from symobs.applications.checking.answers import MAX_BYTES, Answer, read_answer
from symobs.applications.checking.checker import Checked
from symobs.applications.checking.folders import counting, decoded, files_of, written_place
from symobs.applications.checking.report import CheckReport
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, reason_of
from symobs.problem import parse, read

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence


MAX_TABLE_BYTES = 64 * 1024 * 1024
#: Columns with a meaning of their own; every other one is a part, or is left alone.
OWN = ("student", "convention", "variant", "steps", "answer")
#: The line above the header with which spreadsheets say what sets cells apart.
_SEPARATOR = re.compile(r'"?sep=([;,\t])"?')


@dataclass
class Submission:
    """What one student handed in: the text of an answer file, or values by field and the lines of the derivation.

    note     how the file was read, where that is worth a word
    unread   why there is no text to be read at all
    """

    student: str
    variant: str | None = None
    text: str | None = None
    values: Mapping[str, Any] | None = None
    convention: str = ""
    steps: str = ""
    note: str = ""
    unread: str = ""


@dataclass
class Submissions:
    """The submissions that count, in the order of the input, and the places of those that another one replaced.

    columns   the names of the columns of a table, as they were mapped
    places    where the submission of each student stands that counts
    left_out  files that could not be read: the student, the place, and why
    note      how the table was read, where that is worth a word
    """

    entries: tuple[Submission, ...]
    superseded: tuple[tuple[str, str], ...] = ()
    columns: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict)
    left_out: tuple[tuple[str, str, str], ...] = ()
    note: str = ""


def read_submissions(path: Path, known: Collection[str], columns: Mapping[str, str]) -> Submissions:
    """Return the submissions of a file or of a folder; raises `ProblemErrors` with every error of the table.

    `known` are the names of parts that a column may have, `columns` name a column's field.
    """
    if path.is_dir():
        return _of_folder(path)
    names: tuple[str, ...] = ()
    text, note = _text_and_note(path, "give a CSV or JSON Lines file in UTF-8, or a folder")
    if path.suffix.lower() in {".jsonl", ".ndjson"}:
        found = _of_json_lines(text, path)
    else:
        names, found = _of_csv(text, path, known, columns)
    if not found:
        raise _wrong(str(path), f"no student in {shown(path.name, 60)}", "write a line for each below the header")
    return replace(_last(found), columns=names, note=note)


def _of_folder(path: Path) -> Submissions:
    """Return the submissions of a folder: a file of each student, or a folder of each; no file is passed over."""
    entries: list[Submission] = []
    superseded: list[tuple[str, str]] = []
    places: dict[str, str] = {}
    left_out: list[tuple[str, str, str]] = []
    for files in files_of(path):
        student, chosen = files[0].student, counting(files)
        left_out += [(student, file.place, file.reason) for file in files if file.reason]
        if chosen is None:
            why = "; ".join(f"{written_place(file.place)}: {file.reason}" for file in files)
            entries.append(Submission(student, unread=why))
            continue
        entries.append(Submission(student, text=chosen.text, note=chosen.note))
        places[student] = chosen.place
        superseded += [(student, file.place) for file in files if not file.reason and file is not chosen]
    if not entries:
        raise _wrong(str(path), "this folder is empty", "give one with a file, or a folder, of each student")
    return Submissions(tuple(entries), tuple(superseded), places=places, left_out=tuple(left_out))


def not_held(columns: Sequence[str], asked: Collection[Collection[str]], known: Collection[str]) -> str:
    """Return a line on the parts that no column of a table holds, each by the names it may have; none: an empty one."""
    whole = not columns or "answer" in columns
    lacking = [next(iter(names)) for names in asked if not whole and not {*names} & {*columns}]
    unused = [name for name in columns if name and name not in known and name not in OWN]
    if not lacking:
        return ""
    meant = f" (did you mean {lacking[0]}?)" if len(lacking) == len(unused) == 1 else ""
    other = f"; unused: {shown(', '.join(unused), 200)}{meant}" if unused else ""
    return f"no column holds {', '.join(lacking)}{other}"


def _wrong(where: str, message: str, repair: str) -> ProblemErrors:
    return ProblemErrors((InputError(message, where=shown(where, 200), repair=repair),))


def text_of_file(path: Path, repair: str) -> str:
    """Return the text of a table; raises `ProblemErrors` where it cannot be read."""
    return _text_and_note(path, repair)[0]


def _text_and_note(path: Path, repair: str) -> tuple[str, str]:
    """Return the text of a table and a note on its encoding; raises `ProblemErrors` where it cannot be read."""
    try:
        with path.open("rb") as stream:
            raw = stream.read(MAX_TABLE_BYTES + 1)
        if len(raw) > MAX_TABLE_BYTES:
            raise _wrong(str(path), "the file is larger than 64 MB", "hand in fewer answers at once")
        return decoded(raw)
    except OSError as error:
        raise _wrong(str(path), reason_of(error), repair) from None
    except ProblemErrors:
        raise
    except InputError as error:
        raise _wrong(str(path), error.message, repair) from None


def _last(found: Sequence[tuple[str, Submission]]) -> Submissions:
    """Return the last submission of each student."""
    last = {submission.student: i for i, (_, submission) in enumerate(found)}
    kept = tuple(submission for i, (_, submission) in enumerate(found) if last[submission.student] == i)
    gone = tuple((s.student, place) for i, (place, s) in enumerate(found) if last[s.student] != i)
    return Submissions(kept, gone, places={student: found[i][0] for student, i in last.items()})


# -- CSV --------------------------------------------------------------------------------------------------------------


def _of_csv(
    text: str, path: Path, known: Collection[str], columns: Mapping[str, str]
) -> tuple[tuple[str, ...], list[tuple[str, Submission]]]:
    """Return header and rows of a table whose header names students and parts; its delimiter is that of the header."""
    rows = _rows(text, path)
    if not rows:
        raise _wrong(str(path), "the table is empty", "the first line names the columns: student,K,L")
    (first, header), *body = rows
    names = [columns.get(name.strip(), name.strip()) for name in header]
    errors = _of_header(names, header, known, columns, first)
    used = [name for name in names if name in OWN or name in known]
    found: list[tuple[str, Submission]] = []
    for number, row in body:
        place = f"line {number}"
        if len(row) != len(names):
            message = f"{len(row)} cells, but {len(names)} columns"
            errors.append(InputError(message, where=place, repair="put cells that hold the separator in quotes"))
        elif "student" in names:
            submission = _of_cells({name: cell for name, cell in zip(names, row, strict=True) if name in used})
            if not submission.student:
                errors.append(
                    InputError("no student is named", where=place, repair="fill in the cell, or take out the row")
                )
            found.append((place, submission))
    if errors:
        for wrong in errors:
            wrong.where = f"{shown(str(path), 200)}, {wrong.where}"
        raise ProblemErrors(tuple(errors))
    return tuple(names), found


def _rows(text: str, path: Path) -> list[tuple[int, list[str]]]:
    """Return the rows that are not empty, each with the number of its first line."""
    first, _, rest = text.partition("\n")
    named = _SEPARATOR.fullmatch(first.strip(" \r"))  # what spreadsheets write above the header
    delimiter = named[1] if named else max(";\t,", key=text.lstrip().partition("\n")[0].count)
    csv.field_size_limit(MAX_TABLE_BYTES)
    reader = csv.reader(io.StringIO(f"\n{rest}" if named else text, newline=""), delimiter=delimiter, strict=True)
    found, number = [], 1
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                found.append((number, row))
            number = reader.line_num + 1
    except csv.Error as error:
        raise _wrong(str(path), f"this is not CSV: {error}", "save the table as CSV, texts in quotes") from None
    return found


def _of_header(
    names: Sequence[str], written: Sequence[str], known: Collection[str], columns: Mapping[str, str], number: int
) -> list[SymobsError]:
    errors: list[SymobsError] = []

    def note(message: str, repair: str) -> None:
        errors.append(InputError(message, where=f"line {number}", repair=repair))

    used = [name for name in names if name in OWN or name in known]
    for column in columns:
        if column not in [name.strip() for name in written]:
            note(f'there is no column "{shown(column, 40)}"', f"its columns are {shown(', '.join(written), 200)}")
    for column, name in columns.items():
        if name not in OWN and name not in known:
            note(f"{shown(name, 40)} is no part", f'map "{shown(column, 40)}" to one of {", ".join([*OWN, *known])}')
    if "student" not in names:
        note("there is no column student", 'name one so, or write --map "Email address=student"')
    whole = {"steps", "answer"}
    if not any(name in known or name in whole for name in used):
        columns_there = [name.strip() for name in written if name.strip() and name.strip() not in OWN]
        example = shown(columns_there[0], 40) if columns_there else "Response 1"
        repair = f'name one of {", ".join(known)}, or write --map "{example}=answer" for a column of whole answers'
        note("no column is a part of the answer", repair)
    if "answer" in used and any(name in known or name == "steps" for name in used):
        note("a column answer holds whole answers, and others hold parts", "keep that column, or the others")
    for name in {name for name in used if used.count(name) > 1}:
        note(f"the column {name} stands twice", "keep one of them")
    for name in used:
        if "." in name and name.rpartition(".")[2] in used:
            note(f"the columns {name.rpartition('.')[2]} and {name} are one part", "keep one of them")
    return errors


def _of_cells(cells: Mapping[str, str]) -> Submission:
    """Return the submission of a row; an empty cell is a part that is missing."""
    values = {name: cell.strip() for name, cell in cells.items() if name not in OWN and cell.strip()}
    variant = cells.get("variant", "").strip() or None
    convention, steps = cells.get("convention", "").strip(), cells.get("steps", "")
    if "answer" in cells:
        return Submission(cells["student"].strip(), variant, cells["answer"], None, convention)
    return Submission(cells["student"].strip(), variant, None, values, convention, steps)


# -- JSON Lines -------------------------------------------------------------------------------------------------------


def _of_json_lines(text: str, path: Path) -> list[tuple[str, Submission]]:
    """Return the submissions of JSON Lines: an answer file a line, or a student with values by field."""
    found: list[tuple[str, Submission]] = []
    errors: list[SymobsError] = []
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        place = f"{shown(str(path), 200)}, line {number}"
        try:
            table = json.loads(line, parse_float=str)
        except (ValueError, RecursionError):
            table = None
        if not isinstance(table, dict) or not isinstance(table.get("student"), str) or not table["student"].strip():
            errors.append(
                InputError(
                    "an object with a student is expected",
                    where=place,
                    repair='write {"student": "s1", "text": "…"}, or the parts by their names',
                )
            )
        elif isinstance(whole := table.get("text", table.get("answer")), str):
            chosen, convention = _word(table.get("variant")), _word(table.get("convention")) or ""
            found.append((f"line {number}", Submission(table["student"], chosen, whole, None, convention)))
        elif {"answer", "step"} & table.keys():
            variant = _word(table.pop("variant", None))
            found.append((f"line {number}", Submission(table["student"], variant, line_of(table))))
        else:
            values = {name: value for name, value in table.items() if name not in OWN}
            own = [_word(table.get(name)) or "" for name in ("convention", "steps")]
            found.append(
                (f"line {number}", Submission(table["student"], _word(table.get("variant")), None, values, *own))
            )
    if errors:
        raise ProblemErrors(tuple(errors))
    return found


def line_of(table: Mapping[str, Any]) -> str:
    """Return a table as JSON."""
    return json.dumps(table, ensure_ascii=False)


def _word(value: Any) -> str | None:
    return None if value is None else str(value)


# The variants that a class works on: which one is whose, and the problem of each.


SCHEMA = "symobs-variants/1"
_MANIFEST, _ASSIGNMENT = "manifest.json", "assignment.csv"
_MADE = "name what `symobs variants -o FOLDER` wrote"


@dataclass
class ClassProblems:
    """The problems of a class: the text of each variant by its name, and who has which; one text where all have the same.

    names   what a submission may call a variant: its number, its name, its file, its id
    """

    texts: Mapping[str, str]
    names: Mapping[str, str]
    shares: Mapping[str, str]
    title: str = ""

    @property
    def first(self) -> str:
        """The text of a problem that has the parts of all."""
        return next(iter(self.texts.values()))

    def text_of(self, variant: str | None) -> str:
        """Return the text of a variant, or of the one problem."""
        return self.texts[variant or ""] if self.names else self.first

    def variant_of(self, submission: Submission) -> str | None:
        """Return the name of the variant of a submission; raises `InputError` where that is not known."""
        if not self.names:
            return submission.variant
        given = (submission.variant or self.shares.get(submission.student, "")).strip()
        name = self.names.get(given.lower().removeprefix("variants/").removesuffix(".toml"))
        if name is None:
            message = f"there is no variant {shown(given, 40)}" if given else "it is not said which variant this is"
            raise InputError(message, where="variant", repair=f"write {next(iter(self.texts))} to {[*self.texts][-1]}")
        return name


def one_problem(text: str) -> ClassProblems:
    """Return the problem of a class that all students have in common."""
    return ClassProblems({"": text}, {}, {})


def class_variants(problem: str, where: str, path: Path) -> ClassProblems:
    """Return the variants of a manifest, or of its folder, with the shares of the `assignment.csv` beside it.

    The manifest has to be one of this problem file.  Raises `ProblemErrors` where it cannot be used.
    """
    path = path / _MANIFEST if path.is_dir() else path
    entries: list[tuple[str, str, Any]] = []
    try:
        data = json.loads(text_of_file(path, _MADE))
        entries = [(str(entry["file"]), str(entry["id"]), entry["data"]) for entry in data["variants"]]
        usable = data["schema"] == SCHEMA and bool(entries) and all(isinstance(entry[2], dict) for entry in entries)
    except (ValueError, RecursionError, LookupError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        data, usable = {}, False
    if not usable:
        raise _wrong_file(path, "this is no manifest of variants", _MADE)
    tables = parse(problem, where)
    if data["problem"] != digest(canonical(tables)):
        repair = "name the file that they were made from, or make them again with the same seed"
        raise _wrong_file(path, "these are variants of another problem file, or it has changed since", repair)
    texts: dict[str, str] = {}
    names: dict[str, str] = {}
    for number, (file, key, variant) in enumerate(entries, start=1):
        name = Path(file).stem
        texts[name] = json.dumps({**variant, "variant": key}, ensure_ascii=False)
        names |= dict.fromkeys((name.lower(), key, str(number)), name)
    return ClassProblems(texts, names, _shares(path.with_name(_ASSIGNMENT)), str(tables.get("title", "")))


def _wrong_file(path: Path, message: str, repair: str) -> ProblemErrors:
    return ProblemErrors((InputError(message, where=shown(str(path), 200), repair=repair),))


def _shares(path: Path) -> dict[str, str]:
    """Return who has which variant, where an assignment lies beside the manifest."""
    if not path.is_file():
        return {}
    rows: list[dict[str, Any]] = list(csv.DictReader(io.StringIO(text_of_file(path, _MADE))))
    if rows and not {"student", "variant"} <= rows[0].keys():
        raise _wrong_file(
            path, "the columns student and variant are expected", "take the file that `symobs variants --assign` wrote"
        )
    return {_typed(row["student"] or ""): row["variant"] or "" for row in rows}


def _typed(cell: str) -> str:
    """Return a cell as it was before a spreadsheet was kept from taking it for a formula."""
    return cell[1:] if cell[:1] == "'" and cell[1:2] in set("=+-@\t\r") else cell


# From the text of a problem and what a student handed in to a report: the unit of work of a class.


#: What of a submission decides its report.
_HANDED_IN = ("text", "values", "convention", "steps")
DAMAGED = "this answer could not be checked: please report it"


@lru_cache(maxsize=32)
def solved(problem: str, folder: str = "") -> Checked:
    """Return the solved problem of a file's text; a process solves each problem once."""
    return Checked.of(read(problem, "problem", Path(folder) if folder else None))


def job_of(problem: str, folder: str, submission: Submission, show: str) -> Job:
    """Return the job of checking a submission: whoever hands in the same has the same one, and it is done once."""
    handed_in = {name: getattr(submission, name) for name in _HANDED_IN}
    data = {"problem": problem, "folder": folder, "show": show, "submission": handed_in}
    return job("check", data, submission.student)


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a submission: its report, which names no student."""
    submission = Submission("", **payload["submission"])
    report = report_of(payload["problem"], payload["folder"], submission, payload["show"])
    return {"status": "done", "result": {**report.as_data(), "page": report.page}}


def recheck(_payload: Mapping[str, Any], _row: Mapping[str, Any]) -> None:
    """Return that nothing is looked at again: a verdict is the check."""


def report_of_row(row: Mapping[str, Any], problem: str, folder: str, show: str) -> CheckReport:
    """Return the report of a row: `undecided` where time, memory or the process came to an end."""
    if "result" in row:
        return CheckReport.from_data(row["result"])
    return solved(problem, folder).without_answer("", None, "undecided", "; ".join(row["error"]), show)


def report_of(problem: str, folder: str, submission: Submission, show: str) -> CheckReport:
    """Return the report on a submission: an answer that cannot be read harms no other one, nor does a bug of ours."""
    checked = solved(problem, folder)
    try:
        return checked.report(answer_of(submission, checked), show, None, submission.variant)
    except SymobsError as error:
        return checked.without_answer(submission.student, submission.variant, "unreadable", str(error), show)
    except (ArithmeticError, AssertionError, AttributeError, LookupError, RuntimeError, TypeError, ValueError):
        return checked.without_answer(submission.student, submission.variant, "undecided", DAMAGED, show)


def answer_of(submission: Submission, checked: Checked) -> Answer:
    """Return what a submission says; raises `ProblemErrors` where it cannot be read."""
    if submission.text is not None:
        found = checked.read(submission.text)
        return replace(found, student=submission.student, convention=submission.convention or found.convention)
    values: dict[str, Any] = {}
    size = len(submission.steps)
    for name, value in (submission.values or {}).items():
        size += len(str(value))
        task, _, field = name.rpartition(".")
        _within(values, task)[field] = value
    if size > MAX_BYTES:
        message = f"the answer is larger than {MAX_BYTES // 1024} kB"
        raise ProblemErrors((InputError(message, where="answer", repair="hand in the answer alone"),))
    lines = read_answer(submission.steps, "steps") if submission.steps.strip() else Answer()
    read_as = read_answer({"answer": values})
    return Answer(submission.student, submission.convention, (), {}, read_as.values, lines.steps)


def _within(values: dict[str, Any], task: str) -> dict[str, Any]:
    """Return the table of a task, or the whole one."""
    if not task:
        return values
    found = values.setdefault(task, {})
    return found if isinstance(found, dict) else {}
