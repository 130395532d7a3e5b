"""Runs: many problems, or jobs of any kind, worked on by many processes, with nothing lost and nothing done twice."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from symobs.batching.engine import Settings, examined, rejected, work
from symobs.batching.executors import Unfinished, workforce
from symobs.batching.jobs import Budget, Job, digest, key_of, solve_job
from symobs.batching.store import STATUSES, Store
from symobs.errors import InputError, UsageError, reason_of
from symobs.result.digits_of_page import digits_asked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from concurrent.futures import Executor

    Row = dict[str, Any]


class Batch:
    """A run: iterate over it for the rows as they come, or ask for all once they are stored."""

    def __init__(
        self,
        jobs: Callable[[], Iterable[Job]],
        out: Path | None = None,
        *,
        workers: int | None = None,
        scheduler: str | None = None,
        executor: Executor | None = None,
        in_process: bool = False,
        worker_timeout: float = 60.0,
        settings: Settings | None = None,
        retry: Sequence[str] = (),
        fail_fast: bool = False,
    ) -> None:
        """Take what makes the jobs, where their rows are stored, and who does the work."""
        self._jobs, self.folder, self.settings = jobs, out, settings or Settings()
        self._who = {"workers": workers, "scheduler": scheduler, "executor": executor}
        self._how = {"in_process": in_process, "worker_timeout": worker_timeout}
        self._retry, self._fail_fast = tuple(retry), fail_fast
        self.store = None if out is None else Store(out)
        self.counts = dict.fromkeys(STATUSES, 0)
        #: The further names of jobs that stand twice in the input.
        self.names: dict[str, list[str]] = {}
        self._seen: set[bytes] = set()
        self.kept = 0

    def __iter__(self) -> Iterator[Row]:
        """Do what is to be done; yield every row when it has come, and is stored where there is a folder.

        Raises `Unfinished` (run again to go on) and `CertificateRejected` for a row that does not hold.
        """
        with ExitStack() as held:
            if self.store is not None:
                held.enter_context(self.store.writing())
                self.counts = self.store.counts
            force = held.enter_context(workforce(**self._who, **self._how))  # type: ignore[arg-type]
            kinds: set[str] = set()
            try:
                for chunk in work(self._wanted(kinds), force, self.settings):
                    if self.store is not None:
                        self.store.add(chunk.rows, chunk.seconds)
                    else:
                        for row in chunk.rows:
                            self.counts[row["status"]] += 1
                    yield from chunk.rows
                    if self._fail_fast and any(row["status"] in {"failed", "unreadable"} for row in chunk.rows):
                        return
            finally:
                if self.store is not None:
                    self.store.close(sorted(kinds), self.names)

    def _wanted(self, kinds: set[str]) -> Iterator[Job]:
        """Yield the jobs that are not done yet, each once; the names of those that stand twice are kept."""
        for job in self._jobs():
            kinds.add(job.kind)
            short = bytes.fromhex(job.key[:32])
            if short in self._seen:
                self.names.setdefault(job.key, []).append(job.name)
                continue
            self._seen.add(short)
            if self.store is not None and self.store.has(job.key, self.settings.budget, self._retry):
                self.kept += 1
                continue
            yield job

    def finish(self) -> Self:
        """Do all that is to be done."""
        for _ in self:
            pass
        return self

    def rows(self) -> Iterator[Row]:
        """Yield every row that is stored."""
        if self.store is None:
            raise UsageError("nothing is stored", where="out", repair="give a folder as out, or iterate over the run")
        return self.store.rows()

    def told(self, total: int) -> str:
        """Return what would be done."""
        if self.store is not None and self.store.folder.is_dir():
            self.store.load()
        kinds: set[str] = set()
        count = sum(1 for _ in self._wanted(kinds))
        return f"{total} problems, {count} to be done, {self.kept} done already"

    @property
    def failed(self) -> list[Row]:
        """The rows of what failed and of what could not be read."""
        return [row for row in self.rows() if row["status"] in {"failed", "unreadable"}]

    def retry(self, *statuses: str) -> Self:
        """Try the jobs again that came to this: `failed`, `undecided`."""
        if self.folder is None:
            raise UsageError("nothing is stored", where="out", repair="give a folder as out")
        self._retry, self.store, self.names, self.kept = statuses, Store(self.folder), {}, 0
        self._seen = set()
        return self.finish()


def batch(
    problems: str | Path | Iterable[str | Path],
    *,
    out: str | Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    executor: Executor | None = None,
    timeout: float | None = 60.0,
    memory: float | None = 2000.0,
    formats: Sequence[str] = (),
    fields: str = "all",
    digits: int | None = None,
    exact: bool = False,
    recheck: float = 0.01,
) -> Batch:
    """Solve many problems in processes of their own, on this machine or a cluster.

    problems   paths of problem files, folders of them, or texts of problems; any iterable, which is read as it is worked on
    out        the folder that keeps the results, and from which a run that was ended goes on; without it nothing is done
               until the value is iterated over, and nothing is stored
    workers    how many processes of this machine; as many as it has processors
    scheduler  the address of a dask scheduler, whose workers do the work instead; or `executor`, any executor
    timeout, memory   seconds and megabytes of one problem: one that takes more is `undecided` and loses no other
    formats    pages to be written beside the results: latex, html, markdown, text
    fields     `answer`: only what was asked for, not what follows from it
    digits, exact   how the pages write their numbers: with so many significant digits, or exactly
    recheck    the share of results that is checked again by other code; of the first 200 all are

    Raises `InputError` for a folder in use, a scheduler that does not answer or other versions there, `Unfinished`
    (exit code 5) when nobody is left to do the work, and `CertificateRejected` for a result that does not hold.
    """
    if fields not in {"all", "answer"}:
        raise UsageError(f"{fields[:40]!r} names no fields", where="fields", repair="write all or answer")
    require_texts(formats)
    asked = digits_asked(digits, exact=exact)

    def jobs() -> Iterator[Job]:
        for text, name, folder in texts_of(problems):
            yield solve_job(text, name, folder, formats=tuple(formats), fields=fields, digits=asked)

    settings = Settings(Budget(timeout, memory), recheck=recheck)
    folder = None if out is None else Path(out)
    run = Batch(jobs, folder, workers=workers, scheduler=scheduler, executor=executor, settings=settings)
    return run if out is None else run.finish()


def require_texts(formats: Iterable[str]) -> None:
    """Raise `UsageError` for a format whose pages are no texts."""
    from symobs.result import format_named  # noqa: PLC0415 - only with pages

    for name in formats:
        if format_named(name).name == "pdf":
            repair = "write latex, and typeset what you need"
            raise UsageError(f"pages in {name} are not written by a batch", where="--format", repair=repair)


def texts_of(problems: str | Path | Iterable[str | Path]) -> Iterator[tuple[str, str, Path | None]]:
    """Yield the text of every problem, its name and its folder; raises `InputError` for a file that cannot be read."""
    listed = [problems] if isinstance(problems, (str, Path)) else problems
    for number, each in enumerate(listed, 1):
        if isinstance(each, str) and ("\n" in each or each.lstrip().startswith("{")):
            yield each, f"problem {number}", None
            continue
        for path in files_of(Path(each)):
            try:
                yield path.read_text(encoding="utf-8-sig"), path.name, path.parent
            except (OSError, UnicodeDecodeError) as error:
                repair = "give a problem file, a folder of them, or the text of a problem"
                raise InputError(reason_of(error), where=str(path), repair=repair) from None


def files_of(path: Path) -> list[Path]:
    """Return the problem files of a folder, or the file itself."""
    return sorted(p for p in path.iterdir() if p.suffix in {".toml", ".json"}) if path.is_dir() else [path]


def verified(folder: Path) -> int:
    """Return how many stored rows hold: key, hash, and the claims by other code than that which made them.

    Raises `CertificateRejected` for the first one that does not.
    """
    if not (folder / "manifest.json").is_file():
        raise InputError("there is no manifest.json", where=str(folder), repair="name the folder of a run")
    count = 0
    for row in Store(folder).rows():
        job = Job(row["kind"], row["job"], row["name"], key_of(row["kind"], row["job"]))
        if job.key != row["key"]:
            raise rejected(row["name"], "its key is that of another job, or of another version of symobs")
        if "result" in row and row.get("sha256") != digest(row["result"]):
            raise rejected(row["name"], "its hash is another one")
        examined(row, job)
        count += 1
    return count


__all__ = ["Batch", "Unfinished", "batch", "files_of", "require_texts", "texts_of", "verified"]
