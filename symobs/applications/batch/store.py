"""The store of a run: a folder that holds every chunk of rows whole or not at all, and from which a run goes on.

manifest.json              what the folder holds; written last
rows/KK/CHUNK.jsonl        the rows of a chunk, named by the hash of their keys
files/KK/KEY.SUFFIX        the pages of a job
rows/KK/CHUNK.jsonl.damaged   a chunk that was not whole any more, set aside; its jobs are done again
keys.bin                   the keys of all rows, to begin again quickly; made anew where it does not fit the rows
log.jsonl                  times
lock                       held while a run writes here
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import socket
import struct
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import SCHEMA, fingerprint
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import CertificateRejected, InputError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from symobs.applications.batch.jobs import Job

#: What a job comes to that is not to be tried again.
FINAL = ("done", "no", "unreadable")
STATUSES = (*FINAL, "undecided", "failed")
_RECORD = struct.Struct("<16sBff")
_HEAD = re.compile(rb'\{"key":"([0-9a-f]{64})","status":"(%s)"' % "|".join(STATUSES).encode())
_BUDGET = re.compile(rb'"budget":\{"seconds":([^,}]*),"megabytes":([^,}]*)\}')


class Damaged(InputError):
    """A stored row that is not what was written."""

    exit_code = 4


class Store:
    """The rows of a run in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.final: dict[bytes, str] = {}
        self.others: dict[bytes, tuple[str, Budget]] = {}
        self.counts = dict.fromkeys(STATUSES, 0)
        #: The chunks that are not whole.
        self.torn: list[Path] = []
        self._is_indexed = False

    # -- reading -----------------------------------------------------------------------------------------------------

    def chunks(self) -> list[Path]:
        """Return the files of rows, sorted by name."""
        return sorted(self.folder.glob("rows/*/*.jsonl"))

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield the row of every job; of one that was tried again its last outcome.

        Raises `Damaged` for what is no row, and `CertificateRejected` where two results of one job contradict each other.
        """
        several: dict[str, list[dict[str, Any]]] = {key: [] for key in self._keys_met_again()}
        for path in self.chunks():
            if not path.stat().st_size:
                raise _damaged(path, 1)
            with path.open("rb") as stream:
                for number, line in enumerate(stream, 1):
                    row = _row(line, path, number)
                    if row["key"] in several:
                        several[row["key"]].append(row)
                    else:
                        yield row
        for key in sorted(several):
            yield _settled(several[key], self.folder)

    def in_order(self, jobs: Iterable[Job]) -> Iterator[tuple[int, Any]]:
        """Yield the first index and the result of blocks, in the order of their jobs; one chunk is in memory at a time.

        Raises `InputError` where one is missing, `Damaged` where it is no row.
        """
        places = dict(self._places())
        for job in jobs:
            if job.key not in places:
                raise InputError(f"{job.name} are missing", where=str(self.folder), repair="run the same command again")
            path, number, start = places[job.key]
            with path.open("rb") as stream:
                stream.seek(start)
                row = _row(stream.readline(), path, number)
            if "result" not in row:
                raise InputError(
                    f"{job.name}: {'; '.join(row['error'])}",
                    where=str(self.folder),
                    repair="run again with more --timeout",
                )
            yield json.loads(job.payload)["first"], row["result"]

    def _places(self) -> Iterator[tuple[str, tuple[Path, int, int]]]:
        """Yield where the row of each key stands: the file, the number of the line, and where it begins."""
        for path in self.chunks():
            start = 0
            with path.open("rb") as stream:
                for number, line in enumerate(stream, 1):
                    if head := _HEAD.match(line):
                        yield head[1].decode(), (path, number, start)
                    start += len(line)

    def _keys_met_again(self) -> set[str]:
        """Return the keys that stand in more than one row."""
        seen: set[bytes] = set()
        again: set[str] = set()
        for path in self.chunks():
            for head in filter(None, map(_HEAD.match, path.read_bytes().splitlines())):
                if head[1] in seen:
                    again.add(head[1].decode())
                seen.add(head[1])
        return again

    def load(self) -> None:
        """Read which jobs have rows; those of a chunk that is not whole have none."""
        index, chunks = self.folder / "keys.bin", self.chunks()
        with suppress(OSError, struct.error):
            head, _, records = index.read_bytes().partition(b"\n")
            if head == _head_of_index(chunks, records):
                for key, status, seconds, megabytes in _RECORD.iter_unpack(records):
                    self._note(key, STATUSES[status], Budget(seconds or None, megabytes or None))
                self._is_indexed = True
                return
        for path in chunks:
            data = path.read_bytes()
            lines = data.splitlines()
            heads = [_HEAD.match(line) if line.endswith(b"}") else None for line in lines]
            if not data.endswith(b"\n") or None in heads:
                self.torn.append(path)
                continue
            for line, found in zip(lines, filter(None, heads), strict=True):
                key, status = bytes.fromhex(found[1].decode())[:16], found[2].decode()
                self._note(key, status, Budget(None, None) if status in FINAL else _budget_of(line))

    def _note(self, key: bytes, status: str, budget: Budget) -> None:
        """Take note of a row; a later outcome of an open job takes the place of the earlier one."""
        if key in self.final:
            return
        if key in self.others:
            if status not in FINAL and self.others[key][1].exceeds(budget):
                return
            self.counts[self.others.pop(key)[0]] -= 1
        self.counts[status] += 1
        if status in FINAL:
            self.final[key] = status
        else:
            self.others[key] = status, budget

    def outcome(self, key: str, budget: Budget, retry: Sequence[str] = ()) -> str | None:
        """Return what a job came to, None where it is to be done: it has no row, or met a smaller budget than this one."""
        short = bytes.fromhex(key[:32])
        if short in self.final:
            return self.final[short]
        if short not in self.others:
            return None
        status, allowed = self.others[short]
        return None if status in retry or (status == "undecided" and budget.exceeds(allowed)) else status

    # -- writing -----------------------------------------------------------------------------------------------------

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Hold the folder for one run; raises `InputError` if another run holds it."""
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with (self.folder / "lock").open("a+", encoding="utf-8") as stream:
                self._take(stream)
                for left in self.folder.glob("*/*/*.tmp"):
                    left.unlink(missing_ok=True)
                self.load()
                for path in self.torn:
                    path.replace(_aside(path))
                yield
        except OSError as error:
            raise _refused(error, self.folder) from None

    def _take(self, stream: Any) -> None:
        if not _locked(stream):
            stream.seek(0)
            repair = "wait for its end, or name another folder with --out"
            raise InputError(
                f"another run is at work here ({stream.read()[:100].strip()})", where=str(self.folder), repair=repair
            )
        stream.truncate(0)
        stream.write(f"process {os.getpid()} on {socket.gethostname()}\n")
        stream.flush()

    def add(self, rows: Sequence[dict[str, Any]], seconds: float) -> None:
        """Write a chunk of rows, and the pages that came with them: whole or not at all."""
        self._is_indexed = False
        try:
            for row in rows:
                for name, content in row.pop("files", {}).items():
                    row.setdefault("files", {})[name] = self._page(row["key"], name, content)
            name = _name(sorted(row["key"] for row in rows))[:16]
            lines = [json.dumps(row, ensure_ascii=False, separators=(",", ":")) + "\n" for row in rows]
            write_whole(
                self.folder / "rows" / name[:2] / f"{name}.jsonl", "".join(lines).encode("utf-8", "surrogatepass")
            )
            with (self.folder / "log.jsonl").open("a", encoding="utf-8") as log:
                log.write(
                    json.dumps({"time": time.time(), "chunk": name, "rows": len(rows), "seconds": seconds}) + "\n"
                )
        except OSError as error:
            raise _refused(error, self.folder) from None
        for row in rows:
            self._note(bytes.fromhex(row["key"][:32]), row["status"], _budget_in(row))

    def _page(self, key: str, name: str, content: str) -> str:
        """Write a page and return its place in the folder."""
        from symobs.tasks.result import format_named  # noqa: PLC0415 - only with pages

        place = f"files/{key[:2]}/{key}{format_named(name).suffix}"
        write_whole(self.folder / place, content.encode("utf-8", "surrogatepass"))
        return place

    def close(self, kinds: Sequence[str], counts: dict[str, int], aliases: dict[str, list[str]]) -> None:
        """Write the index of keys where it is not there, and last the manifest: what the jobs of this run came to."""
        manifest = {
            "schema": SCHEMA,
            "fingerprint": fingerprint(),
            "kinds": sorted(kinds),
            "counts": counts,
            "names": aliases,
            "index": "keys.bin",
        }
        try:
            if not self._is_indexed:
                write_whole(self.folder / "keys.bin", self._index())
            text = json.dumps(manifest, indent=2, sort_keys=True, ensure_ascii=False) + "\n"
            write_whole(self.folder / "manifest.json", text.encode())
        except OSError as error:
            raise _refused(error, self.folder) from None

    def _index(self) -> bytes:
        """Return the index of keys: what says which chunks it is of, and a record of each key."""
        records = [_RECORD.pack(key, STATUSES.index(status), 0, 0) for key, status in sorted(self.final.items())]
        for key, (status, budget) in sorted(self.others.items()):
            records.append(_RECORD.pack(key, STATUSES.index(status), budget.seconds or 0, budget.megabytes or 0))
        joined = b"".join(records)
        return _head_of_index(self.chunks(), joined) + b"\n" + joined


def work_folder(out: Path) -> Path:
    """Return where the rows of a run wait for what is made of them: beside it, so that a run that was ended goes on."""
    return out.with_name(f"{out.name}.work")


def discard_work(out: Path) -> None:
    """Remove the rows once what is made of them is whole."""
    with suppress(OSError):
        shutil.rmtree(work_folder(out))


def write_whole(place: Path, data: bytes) -> None:
    """Write a file that is there whole or not at all, also after a loss of power."""
    place.parent.mkdir(parents=True, exist_ok=True)
    temporary = place.with_name(f"{place.name}.tmp")
    try:
        with temporary.open("wb") as stream:
            stream.write(data)
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


def _locked(stream: Any) -> bool:
    """Lock a file until its process ends, however it does; return whether nobody else holds it."""
    try:
        if os.name == "posix":
            import fcntl  # noqa: PLC0415 - not on every system

            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        else:
            import msvcrt  # noqa: PLC0415 - on Windows only

            lock: Any = msvcrt
            lock.locking(stream.fileno(), lock.LK_NBLCK, 1)
    except OSError:
        return False
    return True


def _settled(rows: Sequence[dict[str, Any]], folder: Path) -> dict[str, Any]:
    """Return the outcome of a job that was tried several times."""
    final = [row for row in rows if row["status"] in FINAL]
    texts = {json.dumps([row["status"], row.get("result"), row.get("error")], sort_keys=True) for row in final}
    if len(texts) > 1:
        first, second, *_ = sorted(texts)
        message = f"two results of one job: {first[:200]} and {second[:200]}"
        raise CertificateRejected(message, where=str(folder), repair="please report this: it is a bug of symobs")
    return (final or sorted(rows, key=lambda row: json.dumps(row.get("budget"))))[-1]


def _row(line: bytes, path: Path, number: int) -> dict[str, Any]:
    """Return the row that a line of a chunk holds; raises `Damaged` where it holds none."""
    row: Any = None
    with suppress(ValueError, RecursionError):
        row = json.loads(line)
    parts = ("key", "status", "kind", "name", "job")
    if not isinstance(row, dict) or not all(isinstance(row.get(part), str) for part in parts):
        raise _damaged(path, number)
    return row


def _damaged(path: Path, number: int) -> Damaged:
    repair = f"rename it to {_aside(path).name} and run the same command again: what it held is done again"
    return Damaged("this line is no whole row, the file was damaged", where=f"{path}, line {number}", repair=repair)


def _aside(path: Path) -> Path:
    """Return where a damaged chunk is kept."""
    return path.with_name(f"{path.name}.damaged")


def _head_of_index(chunks: Iterable[Path], records: bytes) -> bytes:
    """Return what an index fits: the names and the sizes of its chunks, and its own records."""
    sizes = [f"{chunk.stem} {chunk.stat().st_size}" for chunk in chunks]
    return f"{_name(sizes)} {hashlib.sha256(records).hexdigest()}".encode()


def _name(parts: Any) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _budget_of(line: bytes) -> Budget:
    """Return the budget that a row's text tells."""
    found = _BUDGET.search(line)
    return (
        Budget(None, None)
        if found is None
        else Budget(*(None if part == b"null" else float(part) for part in found.groups()))
    )


def _budget_in(row: dict[str, Any]) -> Budget:
    told = row.get("budget")
    return Budget(None, None) if told is None else Budget(told["seconds"], told["megabytes"])


def _refused(error: OSError, folder: Path) -> InputError:
    repair = "make room there, or name a folder that can be written with --out; what is stored stays"
    return InputError(reason_of(error), where=str(folder), repair=repair)
