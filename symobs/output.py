"""Writing what was asked for: whole or not at all, to standard output or to a file."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path
from typing import Any

from symobs.errors import InputError, UsageError


def write(content: str | bytes, target: str | None = None) -> None:
    """Write the whole result or nothing; without a target, or to `-`, to standard output."""
    data = content.encode() if isinstance(content, str) else content
    try:
        if target is not None and target != "-":
            _write_file(data, Path(os.path.realpath(target)))
            return
        stream = binary(sys.stdout)
        if isinstance(content, bytes) and stream.isatty():
            raise UsageError("this format is not text", repair="name a file with -o")
        stream.write(data)
        stream.flush()
    except BrokenPipeError:  # whoever read this has read enough; what is left in the buffer goes nowhere
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        where = "standard output" if target is None else target[:200]
        raise InputError(reason, where=where, repair="name a file in a folder that can be written") from None


def _write_file(data: bytes, target: Path) -> None:
    """Put a file in its place when it is complete; what is no regular file (/dev/stdout) is written to directly."""
    import tempfile  # noqa: PLC0415 - only with -o

    if target.exists() and not target.is_file():
        target.write_bytes(data)
        return
    mode = target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask()
    with tempfile.NamedTemporaryFile(dir=target.parent, prefix=".symobs-", delete=False) as stream:
        temporary = Path(stream.name)
        try:
            stream.write(data)
            stream.close()
            temporary.chmod(mode)
            temporary.replace(target)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def binary(stream: Any) -> Any:
    """Return the bytes below a standard stream; it is None where it was closed before we began."""
    if stream is None:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF))
    return stream.buffer


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
