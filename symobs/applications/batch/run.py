"""Runs: many problems, or jobs of any kind, worked on by many processes, with nothing lost and nothing done twice."""

from __future__ import annotations

from contextlib import ExitStack, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from symobs.applications.batch.engine import Settings, Unfinished, examined, rejected, work, workforce
from symobs.applications.batch.jobs import Job, digest, key_of, solve_job, unread_job
from symobs.applications.batch.store import STATUSES, Store
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import InputError, UsageError, reason_of
from symobs.tasks.result.output_methods import digits_asked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from concurrent.futures import Executor

    Row = dict[str, Any]

#: More workers than any machine of today has processors.
MOST_WORKERS = 1024


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
        """Take what makes the jobs, where their rows are stored, and who does the work.

        Raises `UsageError` for a number of workers that is none.
        """
        if workers is not None and (type(workers) is not int or not 1 <= workers <= MOST_WORKERS):
            repair = (
                f"give a whole number from 1 to {MOST_WORKERS}, or leave it out for as many as there are processors"
            )
            raise UsageError(f"{str(workers)[:40]!r} is no number of workers", where="workers", repair=repair)
        self._jobs, self.folder, self.settings = jobs, out, settings or Settings()
        self._who = {"workers": workers, "scheduler": scheduler, "executor": executor}
        self._how = {"in_process": in_process, "worker_timeout": worker_timeout}
        self._retry, self._fail_fast = tuple(retry), fail_fast
        self.store = None if out is None else Store(out)
        #: What the jobs of this run have come to so far, those that were done before among them.
        self.counts = dict.fromkeys(STATUSES, 0)
        #: The further names of jobs that stand twice in the input.
        self.names: dict[str, list[str]] = {}
        self._seen: set[str] = set()
        self.kept = 0

    def __iter__(self) -> Iterator[Row]:
        """Do what is to be done; yield every row when it has come, and is stored where there is a folder.

        Raises `Unfinished` (run again to go on) and `CertificateRejected` for a row that does not hold.
        """
        with ExitStack() as held:
            if self.store is not None:
                held.enter_context(self.store.writing())
            force = held.enter_context(workforce(**self._who, **self._how))  # type: ignore[arg-type]
            kinds: set[str] = set()
            try:
                for chunk in work(self._wanted(kinds), force, self.settings):
                    if self.store is not None:
                        self.store.add(chunk.rows, chunk.seconds)
                    for row in chunk.rows:
                        self.counts[row["status"]] += 1
                    yield from chunk.rows
                    if self._fail_fast and any(row["status"] in {"failed", "unreadable"} for row in chunk.rows):
                        return
            finally:
                if self.store is not None:
                    self.store.close(sorted(kinds), self.counts, self.names)

    def _wanted(self, kinds: set[str]) -> Iterator[Job]:
        """Yield the jobs that are not done yet, each once; the names of those that stand twice are kept."""
        for job in self._jobs():
            kinds.add(job.kind)
            if job.key in self._seen:
                self.names.setdefault(job.key, []).append(job.name)
                continue
            self._seen.add(job.key)
            before = None if self.store is None else self.store.outcome(job.key, self.settings.budget, self._retry)
            if before is None:
                yield job
            else:
                self.kept += 1
                self.counts[before] += 1

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
        with nullcontext() if self.store is None else self.store.reading():
            count = sum(1 for _ in self._wanted(set()))
        return f"{total} problems, {count} to be done, {self.kept} done already{self.told_of_equals()}"

    def told_of_equals(self) -> str:
        """Return how many problems are not counted, since they are equal to others."""
        count = sum(map(len, self.names.values()))
        return f", {count} equal to others" if count else ""

    @property
    def stored(self) -> int:
        """How many jobs have a row: more than this run has come to where it has not met all that were done before."""
        return sum(self.counts.values()) if self.store is None else self.store.count

    @property
    def failed(self) -> list[Row]:
        """The rows of what failed and of what could not be read, among the jobs of this run."""
        wrong = (row for row in self.rows() if row["status"] in {"failed", "unreadable"})
        return [row for row in wrong if row["key"] in self._seen]

    def retry(self, *statuses: str) -> Self:
        """Try the jobs again that came to this: `failed`, `undecided`."""
        if self.folder is None:
            raise UsageError("nothing is stored", where="out", repair="give a folder as out")
        self._retry, self.store, self.names, self.kept = statuses, Store(self.folder), {}, 0
        self._seen, self.counts = set(), dict.fromkeys(STATUSES, 0)
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
    folder = None if out is None else Path(out)
    if folder is not None and isinstance(problems, (str, Path)) and not _is_text(problems):
        files_of(Path(problems))
        require_own_folder(folder, [Path(problems)])
    options: dict[str, Any] = {"formats": tuple(formats), "fields": fields, "digits": asked}
    settings = Settings(Budget(timeout, memory), recheck=recheck)
    jobs = partial(jobs_of, problems, **options)
    run = Batch(jobs, folder, workers=workers, scheduler=scheduler, executor=executor, settings=settings)
    return run if out is None else run.finish()


def require_texts(formats: Iterable[str]) -> None:
    """Raise `UsageError` for a format whose pages are no texts."""
    from symobs.tasks.result import format_named  # noqa: PLC0415 - only with pages

    for name in formats:
        if format_named(name).name == "pdf":
            repair = "write latex, and typeset what you need"
            raise UsageError(f"pages in {name} are not written by a batch", where="--format", repair=repair)


def jobs_of(problems: str | Path | Iterable[str | Path], **options: Any) -> Iterator[Job]:
    """Yield the job of every problem: a text, a file, or one of a folder; `options` are those of `solve_job`.

    A file whose text cannot be had has a job as well, whose row says why: it loses no other.
    """
    listed = [problems] if isinstance(problems, (str, Path)) else problems
    for number, each in enumerate(listed, 1):
        if _is_text(each):
            yield solve_job(str(each), f"problem {number}", **options)
            continue
        place = Path(each)
        for path in files_of(place) if place.is_dir() else [place]:
            try:
                text = text_of(path)
            except InputError as error:
                yield unread_job(error, path.name)
            else:
                yield solve_job(text, path.name, path.parent, **options)


def _is_text(problem: str | Path) -> bool:
    """Return whether this is the text of a problem, not the path of one."""
    return isinstance(problem, str) and ("\n" in problem or problem.lstrip().startswith("{"))


def one_problem(problem: str | Path) -> tuple[str, str, Path | None]:
    """Return the text of a problem, its name and its folder; raises `InputError` for a file that cannot be read."""
    if _is_text(problem):
        return str(problem), "problem", None
    path = Path(problem)
    return text_of(path), path.name, path.parent


def text_of(path: Path) -> str:
    """Return the text of a file; raises `InputError` where it cannot be read."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(reason_of(error), where=str(path), repair="give a problem file") from None


def files_of(path: Path) -> list[Path]:
    """Return the problem files of a folder, or the file itself.

    Raises `InputError` where there is neither: a folder without problems is not the one that was meant.
    """
    if not path.is_dir():
        if not path.exists():
            raise InputError(
                "No such file or directory", where=str(path), repair="give a problem file, or a folder of them"
            )
        return [path]
    try:
        found = sorted(each for each in path.iterdir() if each.suffix in {".toml", ".json"} and not each.is_dir())
    except OSError as error:
        raise InputError(reason_of(error), where=str(path), repair="name a folder that can be read") from None
    if not found:
        repair = "name a folder of problem files: .toml or .json"
        raise InputError("there is no problem file in this folder", where=str(path), repair=repair)
    return found


def require_own_folder(out: Path, problems: Iterable[Path]) -> None:
    """Raise `UsageError` where results would lie among the problems, and be taken for problems the next time."""
    if any(each.is_dir() and out.exists() and each.samefile(out) for each in problems):
        raise UsageError(f"{out} is the folder of the problems", where="--out", repair="name a folder of its own")


def verified(folder: Path) -> int:
    """Return how many stored rows hold: key, hash, and the claims by other code than that which made them.

    Raises `CertificateRejected` for the first one that does not, `Damaged` for what is no whole row.
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


__all__ = ["Batch", "Unfinished", "batch", "files_of", "jobs_of", "one_problem", "require_texts", "verified"]
