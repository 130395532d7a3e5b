"""The files of variants: a problem file each, a manifest, a report, and who gets which variant."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from contextlib import contextmanager, suppress
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.drawing import VERSION
from symobs.applications.variants.parameters import toml_text
from symobs.ground.errors import InputError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path


SCHEMA = "symobs-variants/1"
#: Cells that a spreadsheet would take for formulas begin with one of these.
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


LIMIT = (
    "Equal load is not equal difficulty: it says how much there is to write, and the answers of students alone say "
    "how hard that is."
)


class About(NamedTuple):
    """Where variants come from: the hash of the problem file, the seed, and the candidates left out by reason."""

    problem: str
    seed: int
    rejected: Mapping[str, int]


def manifest(about: About, listed: Sequence[Variant]) -> dict[str, Any]:
    """Return what was made, as JSON."""
    return {
        "schema": SCHEMA,
        "engine": f"symobs {_version()}",
        "problem": about.problem,
        "version": VERSION,
        "seed": about.seed,
        "count": len(listed),
        "variants": [each.as_data() for each in listed],
        "rejected": dict(about.rejected),
    }


def write_folder(folder: Path, about: About, listed: Sequence[Variant], *, report: bool) -> None:
    """Write the variants that were found into a folder: all files or none, the manifest last.

    Raises `InputError` where the folder cannot be written, or holds variants of other numbers.
    """
    files = files_of(about, listed, report=report)
    with _explained(folder):
        others = {f"variants/{path.name}" for path in (folder / "variants").glob("*.toml")} - files.keys()
        if others:
            message = f"there are variants already, {min(others)} among them"
            raise InputError(message, where=str(folder), repair="name another folder")
        made = [path for path in (folder, folder / "variants") if not path.exists()]
        for path in made:
            path.mkdir()
        prepared: list[tuple[Path, Path]] = []
        try:
            for name, text in files.items():
                place = folder / name
                temporary = place.with_name(f".symobs-{place.name}")
                prepared.append((temporary, place))
                temporary.write_text(text, encoding="utf-8", newline="\n")
            for temporary, place in prepared:
                temporary.replace(place)
        except BaseException:
            for temporary, _ in prepared:
                temporary.unlink(missing_ok=True)
            for path in reversed(made):
                with suppress(OSError):
                    path.rmdir()
            raise


@contextmanager
def _explained(folder: Path) -> Iterator[None]:
    """Raise a refusal of the system as an `InputError`."""
    try:
        yield
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        repair = "name a folder that can be written"
        raise InputError(reason_of(error), where=str(folder)[:200], repair=repair) from None


def _version() -> str:
    try:
        return version("symobs")
    except PackageNotFoundError:
        return "unknown"


def files_of(about: About, listed: Sequence[Variant], *, report: bool) -> dict[str, str]:
    """Return the files by name, the manifest last."""
    files = {f"variants/{each.name}.toml": each.text for each in listed}
    files["sheet.toml"] = sheet_of(listed)
    if report:
        files["report.md"] = report_of(about, listed)
    text = json.dumps(manifest(about, listed), indent=1, ensure_ascii=False)
    return {**files, "manifest.json": f"{text}\n"}


def sheet_of(listed: Sequence[Variant]) -> str:
    """Return the file by which `symobs sheet` sets all variants, each on pages of its own."""
    return "\n".join(['style = "exam"', *(f'\n[[problem]]\nfile = "variants/{each.name}.toml"' for each in listed), ""])


def report_of(about: About, listed: Sequence[Variant]) -> str:
    """Return the report: data, answers, load and peak of each, and why candidates were left out."""
    lines = ["# Variants", "", f"Seed {about.seed}.", "", "| file | data | answers | load | longest number |"]
    lines.append("|---|---|---|---:|---:|")
    for each in listed:
        plant = each.data.get("plant") or each.data.get("specification", {})
        data = ", ".join(f"{name} = {value}" for name, value in plant.items())
        cells = (each.name, data, _short(each.expect), each.profile["load"], f"{each.profile['peak']} digits")
        lines.append(f"| {' | '.join(_cell(cell) for cell in cells)} |")
    lines += ["", "## Candidates left out", "", "| reason | candidates |", "|---|---:|"]
    lines += [f"| {_cell(reason)} | {count} |" for reason, count in about.rejected.items()]
    return "\n".join([*lines, "", LIMIT, ""])


def _short(answers: Any) -> str:
    found = ", ".join(f"{name} = {json.dumps(value, ensure_ascii=False)}" for name, value in answers.items())
    return found.replace('"', "")[:200]


def _cell(value: object) -> str:
    return str(value).replace("|", "\\|").replace("\n", " ")


# -- students ---------------------------------------------------------------------------------------------------------


def assignment(table: str, seed: int, count: int, where: str) -> str:
    """Return a CSV with a variant for each student of a CSV: by SHA-256 of the student's id and the seed."""
    text = table.removeprefix("\ufeff")
    delimiter = max(";\t,", key=text.partition("\n")[0].count)
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True))
    except csv.Error as error:
        repair = "save the table as CSV, texts in quotes"
        raise InputError(f"this is not CSV: {error}", where=where, repair=repair) from None
    header = [name.strip().lower() for name in rows[0]] if rows else []
    if "student" not in header:
        repair = "name the column of the ids student in its first row"
        raise InputError("there is no column student", where=where, repair=repair)
    column = header.index("student")
    ids = [row[column].strip() if len(row) > column else "" for row in rows[1:] if any(cell.strip() for cell in row)]
    if "" in ids:
        message = f"student {ids.index('') + 1} of {len(ids)} has no id"
        raise InputError(message, where=where, repair="fill in the cell, or take out the row")
    students = dict.fromkeys(ids)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["student", "variant"])
    for student in students:
        shown = f"'{student}" if student.startswith(_FORMULA) and not _is_number(student) else student
        writer.writerow([shown, f"v{1 + place_of(student, seed, count):03d}"])
    return out.getvalue()


def place_of(student: str, seed: int, count: int) -> int:
    """Return which of so many variants a student gets."""
    data = hashlib.sha256(f"{student}\n{seed}".encode(errors="surrogatepass")).digest()
    return int.from_bytes(data, "big") % count


def _is_number(text: str) -> bool:
    return text.removeprefix("-").replace(".", "", 1).isdecimal()


# One variant: a problem of its own, with its answers and its profile.


class Variant(NamedTuple):
    """A problem of its own: solved, checked, and like the others in what it takes to work it out."""

    number: int
    id: str
    candidate: int
    data: Mapping[str, Any]
    answers: list[Any]
    profile: Mapping[str, Any]
    expect: Mapping[str, Any]
    #: The title without the number of the variant.
    own_title: str = ""

    @property
    def name(self) -> str:
        """The name of its file."""
        return f"v{self.number:03d}"

    @property
    def text(self) -> str:
        """The problem file: numbers in place, and the checked answers as what is expected."""
        return toml_text({**self.data, "variant": self.id, "expect": self.expect})

    @property
    def untitled(self) -> str:
        """The same under its title without the number: the problem file for a page that says which variant it is."""
        return self._replace(data={**self.data, "title": self.own_title}).text

    @property
    def certificates(self) -> int:
        """How many claims were checked for it."""
        return sum(len(answer["certificates"]) for answer in self.answers)

    def as_data(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "id": self.id,
            "file": f"variants/{self.name}.toml",
            "candidate": self.candidate,
            "data": dict(self.data),
            "answers": dict(self.expect),
            "profile": {key: self.profile[key] for key in ("load", "peak", "fractions", "lines")},
            "certificates": self.certificates,
        }
