"""The address of the page: port and token stay the same from start to start, so that a link opens in any tab, also later.

They lie in a file of the user's own, which nobody else may read.
"""

from __future__ import annotations

import json
import os
import secrets
import sys
from contextlib import suppress
from pathlib import Path

_TOKEN_BYTES = 24


def known_address() -> tuple[int, str]:
    """Return the port and the token of the last start; any free port, 0, and a new token where none is known."""
    with suppress(OSError, ValueError, KeyError, TypeError):
        path = _file()
        if sys.platform == "win32" or (path.stat().st_uid == os.getuid() and not path.stat().st_mode & 0o077):
            kept = json.loads(path.read_text(encoding="ascii"))
            port, token = kept["port"], kept["token"]
            if isinstance(port, int) and 1024 <= port <= 65535 and len(token) >= _TOKEN_BYTES and token.isascii():
                return port, token
    return 0, secrets.token_urlsafe(_TOKEN_BYTES)


def keep_address(port: int, token: str) -> None:
    """Keep port and token for the next start, if there is a place for them."""
    with suppress(OSError):
        path = _file()
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as stream:
            json.dump({"port": port, "token": token}, stream)


def _file() -> Path:
    """Return where the state of programs lies on this system."""
    own = os.environ.get("LOCALAPPDATA" if sys.platform == "win32" else "XDG_STATE_HOME")
    return (Path(own) if own else Path.home() / ".local" / "state") / "symobs" / "serve.json"
