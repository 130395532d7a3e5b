"""Jobs: pure functions of their content, each with a key that says what its result depends on, and nothing else."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.formula.convention.convention import PROFILES
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import ProblemErrors
from symobs.problem import Decimal, parse
from symobs.tasks.result import tasks

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.ground.errors import InputError


SCHEMA = "symobs-batch/1"
#: What of a problem file changes no answer, and what only its page shows.
_SAYS_NOTHING = {"id", "printed"}
#: What one job is allowed where nothing else is said.
USUAL_BUDGET = Budget(60.0, 2000.0)
_ON_A_PAGE = {"title", "source", "text", "digits", "exact"}
_JSON_NUMBER = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?")


class Job(NamedTuple):
    """What is to be done: the kind of work, the canonical text of its data, and a name for people."""

    kind: str
    payload: str
    name: str
    key: str


@cache
def fingerprint() -> str:
    """Return the versions on which results depend."""
    return f"symobs {_version('symobs')}, python-flint {_version('python-flint')}, {SCHEMA}"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


def job(kind: str, payload: Mapping[str, Any], name: str = "") -> Job:
    """Return the job of a kind with these data: texts, numbers, lists and tables of them."""
    text = canonical(payload)
    return Job(kind, text, name, key_of(kind, text))


def key_of(kind: str, payload: str) -> str:
    """Return the key of a job."""
    return hashlib.sha256(
        f"symobs-job/1\n{kind}\n{fingerprint()}\n{payload}".encode("utf-8", "surrogatepass")
    ).hexdigest()


def canonical(value: Any) -> str:
    """Return the one JSON text of a value: keys sorted, no spaces, decimals as they were written."""
    if isinstance(value, Mapping):
        return "{" + ",".join(f"{_quoted(str(key))}:{canonical(value[key])}" for key in sorted(value, key=str)) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ",".join(map(canonical, value)) + "]"
    if isinstance(value, Decimal) and _JSON_NUMBER.fullmatch(value):
        return str(value)
    return _quoted(value)


def read_payload(text: str) -> dict[str, Any]:
    """Return the data of a job, decimals as they were written."""
    data: dict[str, Any] = json.loads(text, parse_float=Decimal)
    return data


def digest(result: Any) -> str:
    """Return the hash of a result as JSON."""
    text = json.dumps(result, ensure_ascii=False, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def row_text(key: str, kind: str, row: dict[str, Any]) -> str:
    """Return a row as JSON; its key and its status stand first, where an index is read from."""
    whole = {"key": key, "status": row.pop("status"), "kind": kind, **row}
    return json.dumps(whole, ensure_ascii=False, separators=(",", ":"))


_quoted = json.JSONEncoder(ensure_ascii=False).encode


def solve_job(
    text: str,
    name: str,
    folder: Path | None = None,
    *,
    formats: tuple[str, ...] = (),
    fields: str = "all",
    digits: int | None = None,
) -> Job:
    """Return the job of solving a problem, given as the text of its file.

    What changes neither an answer nor a page that is asked for does not enter the key: comments, spaces, order, ids.
    """
    options: dict[str, Any] = {"fields": fields, "formats": sorted(set(formats))}
    if formats and digits is not None:
        options["digits"] = digits
    try:
        tables = parse(text, name)
        left_out = _SAYS_NOTHING if formats else _SAYS_NOTHING | _ON_A_PAGE
        problem = {key: value for key, value in tables.items() if key not in left_out}
        return job("solve", {**options, "problem": problem, **own_convention(tables, folder)}, name)
    except (ProblemErrors, TypeError):  # not TOML, or a date in it: whoever works on it says what is wrong
        return job("solve", {**options, "text": text}, name)


def unread_job(reason: InputError, name: str) -> Job:
    """Return the job of a problem whose file cannot be read: its row says why."""
    return job("solve", {"unread": str(reason)}, name)


def own_convention(tables: Mapping[str, Any], folder: Path | None) -> dict[str, str]:
    """Return the text of the convention file that lies beside the problem, where it is written in one."""
    name = str(tables.get("convention", ""))
    stem = re.sub(r"(\.toml)+\Z", "", name)
    if folder is None or not re.fullmatch("[A-Za-z][A-Za-z0-9_-]{0,39}", stem) or (PROFILES / f"{stem}.toml").is_file():
        return {}
    try:
        return {"convention_file": (folder / f"{stem}.toml").read_text("utf-8")}
    except (OSError, UnicodeDecodeError):
        return {}


# The kinds of work there are: each is a function from its data to a row, in a module of its own.
#
# A kind is one line of the table. Its module has
#
# run(payload) -> row status (done, no, undecided, unreadable, failed), result, and error where there is one; `files`,
# by format, where texts are to be stored beside the row recheck(payload, row) what does not hold of a row, by other
# code than that which made it; None where it all does
#
# Rows are plain JSON. A row is a function of the payload alone: no times, names of machines or random numbers.


KINDS = {
    "check": "symobs.applications.checking.submissions",
    "sheet-entry": "symobs.cli.shared.sheet_entries",
    "solve": "symobs.applications.batch.solving",
    "variant": "symobs.applications.variants.acceptance",
    "sweep-block": "symobs.applications.batch.sweep.points",
}


def prepare(kind: str) -> None:
    """Import what jobs of a kind need."""
    tasks()
    import_module(KINDS[kind])


def run(kind: str, payload: dict[str, Any]) -> dict[str, Any]:
    """Do a piece of work and return its row."""
    row: dict[str, Any] = import_module(KINDS[kind]).run(payload)
    return row


def recheck(kind: str, payload: dict[str, Any], row: dict[str, Any]) -> str | None:
    """Return what does not hold of a row, None where all that is looked at does."""
    found: str | None = import_module(KINDS[kind]).recheck(payload, row)
    return found
