"""Output to standard output or to files: complete or not at all, several results all or none."""

from __future__ import annotations

import errno
import os
import sys
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.ground.errors import InputError, SymobsError, UsageError, reason_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    #: A complete file, the place it waits for, and how that was named.
    Prepared = tuple[Path, Path, str]

_ELSEWHERE = "name a file in a folder that can be written"
#: What helps against reasons of the system; the others are helped by another file.
_REPAIRS = {
    errno.ENOSPC: "make room there, or name a file elsewhere with -o",
    errno.EDQUOT: "make room there, or name a file elsewhere with -o",
    errno.EFBIG: "raise the limit on the size of files (ulimit -f), or name a file elsewhere with -o",
}


def write(content: str | bytes, target: str | None = None) -> None:
    """Write the whole result or nothing; without a target, or to `-`, to standard output."""
    write_all(((content, target),))


def write_all(outputs: Sequence[tuple[str | bytes, str | None]]) -> None:
    """Write all results or none: files take their places when each is complete and the streams are served."""
    files: list[Prepared] = []
    try:
        for content, target in outputs:
            if _is_file(target):
                files.append(_prepared(_bytes(content), str(target)))
        for content, target in outputs:
            if not _is_file(target):
                _send(content, target)
        _put_in_place(files)
    finally:
        for temporary, _, _ in files:
            temporary.unlink(missing_ok=True)


def copied(paths: Sequence[Path], folder: str) -> None:
    """Copy files into a folder; raises `InputError` where one of their names is taken there."""
    target = Path(folder)
    taken = [path.name for path in paths if (target / path.name).exists()]
    if taken:
        message = f"{taken[0]} is already there"
        raise InputError(message, where=_shown(folder), repair="name another folder, or move the file away")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        repair = "name a folder that can be written"
        raise InputError(reason_of(error), where=_shown(folder), repair=repair) from None
    write_all([(path.read_bytes(), str(target / path.name)) for path in paths])


def check_target(target: str | None) -> None:
    """Raise `InputError`, before any work, if a result cannot be written."""
    if target is None or target == "-":
        return
    with _explained(target):
        path = Path(os.path.realpath(target))
        folder = path.parent
        if path.is_dir():
            raise InputError("this is a folder", where=_shown(target), repair=_ELSEWHERE)
        if not folder.is_dir():
            repair = f"make it, or {_ELSEWHERE}"
            raise InputError(f"there is no folder {_shown(str(folder))}", where=_shown(target), repair=repair)
        if path.exists() and not os.access(path, os.W_OK):
            repair = f"make it writable (chmod u+w), or {_ELSEWHERE}"
            raise InputError("the file is read-only", where=_shown(target), repair=repair)
        if (path.is_file() or not path.exists()) and not os.access(folder, os.W_OK | os.X_OK):
            raise InputError("the folder cannot be written", where=_shown(target), repair=_ELSEWHERE)


def make_folder(folder: Path) -> None:
    """Make a folder for results, unless it is there; raises `InputError` where it cannot be made."""
    with _explained(str(folder)):
        folder.mkdir(exist_ok=True)


def binary(stream: Any) -> Any:
    """Return the binary stream of a standard stream, which is None if it was closed."""
    if stream is None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))
    return stream.buffer if hasattr(stream, "buffer") else _Text(stream)


class _Text:
    """The binary stream of one that has text alone, such as an `io.StringIO` in place of standard output."""

    def __init__(self, stream: Any) -> None:
        self.stream = stream

    def write(self, content: bytes) -> int:
        """Write bytes of UTF-8."""
        self.stream.write(bytes(content).decode(errors="replace"))
        return len(content)

    def flush(self) -> None:
        """Flush the text."""
        self.stream.flush()

    def read(self, size: int = -1) -> bytes:
        """Return text as bytes of UTF-8."""
        return str(self.stream.read(size)).encode()


# -- streams ----------------------------------------------------------------------------------------------------------


def _is_file(target: str | None) -> bool:
    """Return whether a target is or will be a regular file, not a stream (/dev/stdout, a pipe)."""
    if target is None or target == "-":
        return False
    with _explained(target):
        path = Path(os.path.realpath(target))
        return path.is_file() or not path.exists()


def _send(content: str | bytes, target: str | None) -> None:
    """Write to a stream; a closed pipe ends the output without an error."""
    try:
        with _explained(target):
            if target is not None and target != "-":
                check_target(target)
                Path(target).write_bytes(_bytes(content))
                return
            stream = binary(sys.stdout)
            if isinstance(content, bytes) and stream.isatty():
                raise UsageError("this format is not text", repair="name a file with -o")
            stream.write(_bytes(content))
            stream.flush()
    except BrokenPipeError:  # what is left in the buffer goes nowhere
        if target is None or target == "-":
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


# -- files ------------------------------------------------------------------------------------------------------------


def _prepared(data: bytes, target: str) -> Prepared:
    """Write a file beside its place."""
    import tempfile  # noqa: PLC0415 - only with -o

    check_target(target)
    place = Path(os.path.realpath(target))
    with _explained(target):
        mode = place.stat().st_mode & 0o777 if place.exists() else 0o666 & ~_umask()
        with tempfile.NamedTemporaryFile(dir=place.parent, prefix=".symobs-", delete=False) as stream:
            temporary = Path(stream.name)
            try:
                stream.write(data)
                stream.close()
                temporary.chmod(mode)
            except BaseException:
                temporary.unlink(missing_ok=True)
                raise
    return temporary, place, target


def _put_in_place(files: Sequence[Prepared]) -> None:
    """Move complete files to their places; if one fails, undo those before it."""
    new = {place for _, place, _ in files if not place.exists()}
    kept: dict[Path, Path] = {}
    moved: list[Path] = []
    try:
        for temporary, place, name in files:
            if len(files) > 1 and place not in new:
                kept |= _kept(temporary, place)
            with _explained(name):
                temporary.replace(place)
            moved.append(place)
    except BaseException:
        for place in moved:
            if place in new:
                place.unlink(missing_ok=True)
            elif place in kept:
                kept[place].replace(place)
        raise
    finally:
        for before in kept.values():
            before.unlink(missing_ok=True)


def _kept(temporary: Path, place: Path) -> dict[Path, Path]:
    """Link an existing file to a second name; return that, or nothing if the file system has no links."""
    before = temporary.with_suffix(".before")
    with suppress(OSError):
        before.hardlink_to(place)
        return {place: before}
    return {}


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


# -- reasons ----------------------------------------------------------------------------------------------------------


@contextmanager
def _explained(target: str | None) -> Iterator[None]:
    """Raise a refusal of the system as an `InputError`; a closed pipe is none."""
    try:
        yield
    except (BrokenPipeError, SymobsError):
        raise
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte, a closed stream
        reason = reason_of(error)
        is_stream = target is None or target == "-"
        where, other = ("standard output", "name a file with -o") if is_stream else (_shown(target), _ELSEWHERE)
        repair = _REPAIRS.get(getattr(error, "errno", 0) or 0, other)
        raise InputError(reason, where=where, repair=repair) from None


def _shown(target: str | None) -> str:
    from symobs.formula.expression.source import shown  # noqa: PLC0415 - needed for messages only

    return shown(str(target), 200)
