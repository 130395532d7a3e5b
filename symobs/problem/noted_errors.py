"""The errors of a file, noted at their places until all are known, and the reading of its tables and texts."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from difflib import get_close_matches
from typing import Any, TypeGuard
from unicodedata import category

from symobs.formula.convention import STANDARD, Convention
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem.file_tables import Decimal, came
from symobs.tasks.result.in_convention import names_in

_MAX_TEXT = 2000
_MAX_UNKNOWN = 20


class Errors:
    """Collects errors: `with errors:` keeps what its block raises and goes on behind it."""

    def __init__(self) -> None:
        self.found: list[SymobsError] = []

    def note(self, message: str, where: str, repair: str) -> None:
        """Keep an error that was not raised."""
        self.found.append(InputError(message, where=where, repair=repair))

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _traceback: object) -> bool:
        self.found += error.errors if isinstance(error, ProblemErrors) else ()
        if isinstance(error, SymobsError) and not isinstance(error, ProblemErrors):
            self.found.append(error)
        return isinstance(error, SymobsError)

    def add_elsewhere(self, others: Errors) -> None:
        """Add errors of the others at places without an error."""
        taken = {error.where for error in self.found}
        self.found += [error for error in others.found if error.where not in taken]

    def move(self, places: Mapping[str, str]) -> None:
        """Say of every error where it stands in the file."""
        for error in self.found:
            whole, cell = re.fullmatch(r"([^\[]*)(.*)", error.where, re.DOTALL).groups()  # type: ignore[union-attr]
            error.where = places.get(whole, whole) + cell

    def together(self, convention: Convention = STANDARD) -> ProblemErrors:
        """Return all of them, each once, at places named as the convention names them."""
        for own, (name, _) in names_in(convention).items():
            for error in self.found:
                error.where = re.sub(rf"^specification\.{name}\b", f"specification.{own}", error.where)
        return ProblemErrors(tuple({str(error): error for error in self.found}.values()))


def nearest(key: str, known: Collection[str]) -> str | None:
    """Return the known name that a key may have meant."""
    return next(iter(get_close_matches(key[:64], known, 1)), None)


def _meant(key: str, known: Collection[str], _where: str) -> str:
    near = nearest(key, known)
    return f"did you mean {near}?" if near else f"known keys are {', '.join(known)}"


def report_unknown(
    table: Mapping[str, Any],
    known: Collection[str],
    where: str,
    errors: Errors,
    repair: Callable[[str, Collection[str], str], str] = _meant,
) -> None:
    """Note every key that is not known, with the key or the place that was meant."""
    unknown = [key for key in table if key not in known]
    for key in unknown[:_MAX_UNKNOWN]:
        errors.note("unknown key", f"{where}.{shown(key, 40)}".lstrip("."), repair(key, known, where))
    if len(unknown) > _MAX_UNKNOWN:
        errors.note(f"{len(unknown) - _MAX_UNKNOWN} more unknown keys", where or "the file", "leave them out")


def table_of(data: Mapping[str, Any], name: str, errors: Errors) -> Mapping[str, Any]:
    """Return a table of the file, an empty one where it is missing or no table."""
    value = data.get(name, {})
    return value if is_table(value, name, errors) else {}


def is_table(value: object, where: str, errors: Errors) -> TypeGuard[Mapping[str, Any]]:
    """Return whether a value is a table, and note it if not."""
    if isinstance(value, Mapping):
        return True
    header = re.sub(r"^(.*)\[[0-9]+\]$", r"[\1]", where)
    repair = "write { … }" if "]." in header else f"write [{header}] and its keys below"
    errors.note(f"a table is expected, but {came(value)} came", where, repair)
    return False


def text_of(table: Mapping[str, Any], name: str, errors: Errors) -> str:
    """Return a text of the file, an empty one where it is missing."""
    value = table.get(name, "")
    check_text(value, name, errors)
    return value if isinstance(value, str) and not isinstance(value, Decimal) else ""


def check_text(value: object, where: str, errors: Errors) -> None:
    """Note a value that is no text, too long, or not printable."""
    if not isinstance(value, str) or isinstance(value, Decimal):
        errors.note(f"a text is expected, but {came(value)} came", where, "write it in quotes")
        return
    if len(value) > _MAX_TEXT:
        errors.note(f"the text has more than {_MAX_TEXT} characters", where, "shorten it")
    for character in value[:_MAX_TEXT]:
        if category(character) in {"Cc", "Cs"} and character not in "\t\n":
            errors.note(f"the character U+{ord(character):04X} cannot be printed", where, "leave it out")
            break
