"""The variants that a class works on: which one is whose, and the problem of each."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import canonical, digest
from symobs.applications.checking.classes.submissions import text_of_file
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors
from symobs.problem import parse

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.applications.checking.classes.submissions import Submission

SCHEMA = "symobs-variants/1"
_MANIFEST, _ASSIGNMENT = "manifest.json", "assignment.csv"
_MADE = "name what `symobs variants -o FOLDER` wrote"


@dataclass(frozen=True)
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
        raise _wrong(path, "this is no manifest of variants", _MADE)
    tables = parse(problem, where)
    if data["problem"] != digest(canonical(tables)):
        repair = "name the file that they were made from, or make them again with the same seed"
        raise _wrong(path, "these are variants of another problem file, or it has changed since", repair)
    texts: dict[str, str] = {}
    names: dict[str, str] = {}
    for number, (file, key, variant) in enumerate(entries, start=1):
        name = Path(file).stem
        texts[name] = json.dumps({**variant, "variant": key}, ensure_ascii=False)
        names |= dict.fromkeys((name.lower(), key, str(number)), name)
    return ClassProblems(texts, names, _shares(path.with_name(_ASSIGNMENT)), str(tables.get("title", "")))


def _wrong(path: Path, message: str, repair: str) -> ProblemErrors:
    return ProblemErrors((InputError(message, where=shown(str(path), 200), repair=repair),))


def _shares(path: Path) -> dict[str, str]:
    """Return who has which variant, where an assignment lies beside the manifest."""
    if not path.is_file():
        return {}
    rows: list[dict[str, Any]] = list(csv.DictReader(io.StringIO(text_of_file(path, _MADE))))
    if rows and not {"student", "variant"} <= rows[0].keys():
        raise _wrong(
            path, "the columns student and variant are expected", "take the file that `symobs variants --assign` wrote"
        )
    return {_typed(row["student"] or ""): row["variant"] or "" for row in rows}


def _typed(cell: str) -> str:
    """Return a cell as it was before a spreadsheet was kept from taking it for a formula."""
    return cell[1:] if cell[:1] == "'" and cell[1:2] in set("=+-@\t\r") else cell
