"""The store of a run: a folder from which the run goes on, whatever ended it.

rows.sqlite           the row of each job; a chunk is one transaction
rows/all/rows.jsonl   the same rows as lines of JSON; written when a run ends
files/KK/KEY.SUFFIX   the pages of a job
manifest.json         what the jobs of the last run came to; written last
log.jsonl             times
lock                  a database that is locked while a run writes here
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import sqlite3
import time
from contextlib import ExitStack, closing, contextmanager, suppress
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import SCHEMA, fingerprint
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import InputError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from symobs.applications.batch.jobs import Job

#: What a job comes to that is not to be tried again.
FINAL = ("done", "no", "unreadable")
STATUSES = (*FINAL, "undecided", "failed")
#: How often the change to a log is tried, twenty times a second.
_MOST_TRIES = 200
_ROWS = "rows.sqlite"
_TABLES = """
CREATE TABLE IF NOT EXISTS rows(
    key TEXT PRIMARY KEY, status TEXT, seconds REAL, megabytes REAL, row BLOB
);
CREATE TABLE IF NOT EXISTS writer(name TEXT);
"""
_WORK = ".work"


class Damaged(InputError):
    """A stored row that is not what was written."""

    exit_code = 4


class Store:
    """The rows of a run in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._listing = folder / "rows" / "all" / "rows.jsonl"
        #: The connection that is held open, if one is.
        self._held: sqlite3.Connection | None = None
        #: What the jobs had come to when it was opened.
        self._statuses: dict[str, str] = {}

    @contextmanager
    def _refusing(self) -> Iterator[None]:
        """Raise what the folder or a database in it refuses as an error of the user."""
        try:
            yield
        except (OSError, sqlite3.OperationalError) as error:
            repair = "make room there, or name a folder that can be written with --out; what is stored stays"
            raise InputError(reason_of(error), where=str(self.folder), repair=repair) from None
        except sqlite3.DatabaseError as error:
            raise self._damaged(str(error)) from None

    @contextmanager
    def _rows(self) -> Iterator[sqlite3.Connection]:
        """Give the connection that is held, else one of its own; where nothing is stored, one to no rows."""
        if self._held is not None:
            yield self._held
            return
        place = self.folder / _ROWS
        with self._refusing(), ExitStack() as held:
            rows = held.enter_context(closing(_connected(place if place.exists() else ":memory:")))
            if not rows.execute("SELECT count(*) FROM sqlite_master WHERE name = 'rows'").fetchone()[0]:
                rows = held.enter_context(closing(_connected(":memory:")))  # who reads writes nothing, not even tables
                rows.executescript(_TABLES)
            yield rows

    @contextmanager
    def _holding(self, rows: sqlite3.Connection) -> Iterator[None]:
        self._held, self._statuses = rows, dict(rows.execute("SELECT key, status FROM rows"))
        try:
            yield
        finally:
            self._held = None

    # -- reading -----------------------------------------------------------------------------------------------------

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Hold the rows open while many questions are asked."""
        with self._rows() as rows, self._holding(rows):
            yield

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the row of every job; raises `Damaged` for what is no row."""
        with self._rows() as rows:
            for key, text in rows.execute("SELECT key, row FROM rows"):
                yield self._row(key, text)

    def in_order(self, jobs: Iterable[Job]) -> Iterator[tuple[int, Any]]:
        """Yield the first index and the result of blocks, in the order of their jobs; one is in memory at a time.

        Raises `InputError` where one is missing, `Damaged` where it is no row.
        """
        with self._rows() as rows:
            for job in jobs:
                found = rows.execute("SELECT row FROM rows WHERE key = ?", (job.key,)).fetchone()
                if found is None:
                    message = f"{job.name} are missing"
                    raise InputError(message, where=str(self.folder), repair="run the same command again")
                row = self._row(job.key, found[0])
                if "result" not in row:
                    message = f"{job.name}: {'; '.join(row['error'])}"
                    raise InputError(message, where=str(self.folder), repair="run again with more --timeout")
                yield json.loads(job.payload)["first"], row["result"]

    def outcome(self, key: str, budget: Budget, retry: Sequence[str] = ()) -> str | None:
        """Return what a job came to, None where it is to be done: it has no row, or met a smaller budget than this one.

        It is asked while the rows are held open.
        """
        status = self._statuses.get(key)
        if status is None or status in FINAL:
            return status
        if status == "undecided":
            with self._rows() as rows:
                met = rows.execute("SELECT seconds, megabytes FROM rows WHERE key = ?", (key,)).fetchone()
            if budget.exceeds(Budget(*met)):
                return None
        return None if status in retry else status

    @property
    def count(self) -> int:
        """How many jobs have a row."""
        with self._rows() as rows:
            return int(rows.execute("SELECT count(*) FROM rows").fetchone()[0])

    def _row(self, key: str, text: bytes) -> dict[str, Any]:
        row: Any = None
        with suppress(ValueError, RecursionError):
            row = json.loads(text)
        parts = ("key", "status", "kind", "name", "job")
        if not isinstance(row, dict) or not all(isinstance(row.get(part), str) for part in parts):
            raise self._damaged(f"what is stored of {str(key)[:16]} is no whole row")
        return row

    def _damaged(self, reason: str) -> Damaged:
        repair = f"rename it to {_ROWS}.damaged and run the same command again: what it held is done again"
        return Damaged(f"this file was damaged: {reason}", where=str(self.folder / _ROWS), repair=repair)

    # -- writing -----------------------------------------------------------------------------------------------------

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the folder for one run; raises `InputError` if another run holds it."""
        with self._refusing(), ExitStack() as held:
            self.folder.mkdir(parents=True, exist_ok=True)
            (self.folder / "log.jsonl").touch()  # a folder that cannot be written says so better than a database
            lock, rows = (held.enter_context(closing(_connected(self.folder / name))) for name in ("lock", _ROWS))
            _log_ahead(rows)
            rows.executescript(_TABLES)
            self._lock(lock, rows)
            with self._holding(rows):
                yield
            with suppress(sqlite3.OperationalError):  # somebody reads
                rows.execute("PRAGMA journal_mode = DELETE")  # one file, which needs no writing to be read

    def _lock(self, lock: sqlite3.Connection, rows: sqlite3.Connection) -> None:
        """Lock the folder until the connection, or its process, ends."""
        lock.execute("PRAGMA busy_timeout = 0")
        try:
            lock.execute("BEGIN IMMEDIATE")
        except sqlite3.OperationalError:
            writer = next(rows.execute("SELECT name FROM writer"), ("",))[0]
            repair = "wait for its end, or name another folder with --out"
            raise InputError(f"another run is at work here ({writer})", where=str(self.folder), repair=repair) from None
        with rows:
            rows.execute("DELETE FROM writer")
            rows.execute("INSERT INTO writer VALUES (?)", (f"process {os.getpid()} on {socket.gethostname()}",))

    def add(self, chunk: Sequence[dict[str, Any]], seconds: float) -> None:
        """Store the rows of a chunk, all or none, and the pages that came with them."""
        for row in chunk:
            for name, content in row.pop("files", {}).items():
                row.setdefault("files", {})[name] = self._page(row["key"], name, content)
        self._listing.unlink(missing_ok=True)
        with self._rows() as rows, rows:
            rows.executemany("INSERT OR REPLACE INTO rows VALUES (?, ?, ?, ?, ?)", map(_record, chunk))
        with (self.folder / "log.jsonl").open("a", encoding="utf-8") as log:
            log.write(json.dumps({"time": time.time(), "rows": len(chunk), "seconds": seconds}) + "\n")

    def _page(self, key: str, name: str, content: str) -> str:
        """Write a page and return its place in the folder."""
        from symobs.tasks.result import format_named  # noqa: PLC0415 - only with pages

        place = f"files/{key[:2]}/{key}{format_named(name).suffix}"
        write_whole(self.folder / place, [content.encode("utf-8", "surrogatepass")])
        return place

    def close(self, kinds: Sequence[str], counts: dict[str, int], aliases: dict[str, list[str]]) -> None:
        """Write the rows as lines for other programs, and last the manifest: what the jobs of this run came to."""
        manifest = {
            "schema": SCHEMA,
            "fingerprint": fingerprint(),
            "kinds": sorted(kinds),
            "counts": counts,
            "names": aliases,
            "index": _ROWS,
        }
        if self.folder.suffix != _WORK and not self._listing.exists():
            with self._rows() as rows:
                found = rows.execute("SELECT row FROM rows")
                write_whole(self._listing, (text + b"\n" for (text,) in found))
        text = json.dumps(manifest, indent=2, sort_keys=True, ensure_ascii=False) + "\n"
        write_whole(self.folder / "manifest.json", [text.encode()])


def _log_ahead(rows: sqlite3.Connection) -> None:
    """Let nobody who reads keep this run from writing; the change itself waits for them, which SQLite does not."""
    for _ in range(_MOST_TRIES):
        with suppress(sqlite3.OperationalError):
            rows.execute("PRAGMA journal_mode = WAL")
            return
        time.sleep(0.05)
    rows.execute("PRAGMA journal_mode = WAL")


def _connected(place: Path | str) -> sqlite3.Connection:
    return sqlite3.connect(place, check_same_thread=False)  # a run may be iterated over by any thread


def _record(row: dict[str, Any]) -> tuple[str, str, float | None, float | None, bytes]:
    budget = row.get("budget") or {}
    text = json.dumps(row, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "surrogatepass")
    return row["key"], row["status"], budget.get("seconds"), budget.get("megabytes"), text


def work_folder(out: Path) -> Path:
    """Return where the rows of a run wait for what is made of them: beside it, so that a run that was ended goes on."""
    return out.with_name(f"{out.name}{_WORK}")


def discard_work(out: Path) -> None:
    """Remove the rows once what is made of them is whole."""
    with suppress(OSError):
        shutil.rmtree(work_folder(out))


def write_whole(place: Path, parts: Iterable[bytes]) -> None:
    """Write a file that is there whole or not at all, also after a loss of power."""
    place.parent.mkdir(parents=True, exist_ok=True)
    temporary = place.with_name(f"{place.name}.tmp")
    try:
        with temporary.open("wb") as stream:
            stream.writelines(parts)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.replace(place)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise
    if os.name == "posix":
        folder = os.open(place.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
