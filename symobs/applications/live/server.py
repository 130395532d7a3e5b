"""The server of `symobs serve`: the page, and the protocol, for this machine and this browser alone.

Guards, in this order: the host name (another name for this address is another site), the method, the path (a dictionary,
never the file system), the origin, the token, the size.  All mathematics is done by children.
"""

from __future__ import annotations

import gzip
import hmac
import json
import re
import secrets
import select
import socket
import sys
import threading
import time
from contextlib import suppress
from html import escape
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from typing import TYPE_CHECKING, Any

from symobs.applications.live.assets import ASSETS, MOST_BYTES, SCHEMA, language_asked, script, style
from symobs.ground.child_processes.child import Died, Ended, Kept
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable


# The children of the server, under a limit of time and of memory: all its mathematics is done by them.


#: A whole page may take as many times the seconds of an answer.
PAGE_FACTOR = 6
#: So many questions are answered at a time; a further one waits until a child is free.
_CHILDREN = 2
_LOOK_EVERY, _MOST_SECONDS = 0.02, 600
_LONG = {"page", "view", "export"}


@dataclass
class AnswerBudget:
    """Seconds an answer may take, megabytes a child may use."""

    seconds: float = 5.0
    megabytes: int = 1000


class Gone(Exception):
    """Whoever asked has left."""


class Children:
    """The children of a server, each replaced as soon as it has ended."""

    def __init__(self, budget: AnswerBudget, module: str = "symobs.applications.live.child") -> None:
        """Start the first; it is ready a moment later, or when it is asked."""
        self.budget, self.kept = budget, Kept(module)
        self.free = threading.BoundedSemaphore(_CHILDREN)
        self.kept.add(1, megabytes=budget.megabytes)

    def answer(self, body: bytes, has_left: Callable[[], bool] = lambda: False) -> bytes:
        """Return the response to a request; raises `Gone`."""

        def look() -> None:
            if has_left():
                raise Gone

        asked = _read(body)
        seconds = self.budget.seconds * (PAGE_FACTOR if asked.get("want") in _LONG else 1)
        with self.free:
            try:
                with self.kept.one(megabytes=self.budget.megabytes) as child:
                    response: bytes = child.ask(body, min(seconds, _MOST_SECONDS), look=look, every=_LOOK_EVERY)
                    return response
            except TimeoutError:
                language = language_asked(asked)
                message = language.phrases["live_late"].format(seconds=language.decimal(f"{seconds:g}"))
            except (Died, Ended):
                message = language_asked(asked).phrases["said_memory"].format(megabytes=self.budget.megabytes)
            finally:
                self.kept.add(_CHILDREN, megabytes=self.budget.megabytes)
        undecided = {"schema": SCHEMA, "id": asked.get("id"), "status": "undecided", "message": message}
        return json.dumps(undecided).encode()

    def close(self) -> None:
        """End all, also those at work."""
        self.kept.close()


def _read(body: bytes) -> dict[str, Any]:
    """Return what a request says, as far as it can be read."""
    with suppress(ValueError, RecursionError):
        asked = json.loads(body)
        return asked if isinstance(asked, dict) else {}
    return {}


HOSTS = ("127.0.0.1", "::1", "localhost")
_MOST_CONNECTIONS, _MOST_HEADERS, _TIMEOUT, _LINE = 16, 16 * 1024, 10.0, 65537
#: What fits into one packet is sent as it is.
_LEAST_COMPRESSED = 1400
#: A header `Accept-Encoding` that takes gzip.
_GZIP = re.compile(r"(?:^|,)\s*gzip\s*(?:,|$|;\s*q=(?!0(?:\.0*)?\s*(?:,|$)))", re.IGNORECASE)


_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; img-src data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


_HEADERS = {
    "Content-Security-Policy": _POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


def routes(share: str = "") -> dict[str, tuple[str, bytes]]:
    """Return every path there is, with its kind and its content; copied links lead to `share` where that is given."""
    javascript = "text/javascript; charset=utf-8"
    page = (ASSETS / "http.html").read_text(encoding="utf-8")
    return {
        "/": ("text/html; charset=utf-8", page.replace("<main>", f'<main data-share="{escape(share)}">').encode()),
        "/symobs-live.js": (javascript, script().encode()),
        "/start-http.js": (javascript, (ASSETS / "start-http.js").read_bytes()),
        "/live.css": ("text/css; charset=utf-8", style().encode()),
    }


class Server(ThreadingHTTPServer):
    """A server on this machine's own address."""

    daemon_threads = True
    allow_reuse_address = sys.platform != "win32"

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = 0,
        budget: AnswerBudget | None = None,
        token: str = "",
        share: str = "",
    ) -> None:
        """Bind the address, choose a token where none is given, read the files."""
        self.address_family = socket.AF_INET6 if host == "::1" else socket.AF_INET
        super().__init__((host, port), Handler)
        self.children = Children(budget or AnswerBudget())  # the first gets ready while the page is put together
        self.token = token or secrets.token_urlsafe(24)
        self.routes = routes(share)
        self.connections = threading.BoundedSemaphore(_MOST_CONNECTIONS)
        number = self.server_address[1]
        self.names = frozenset({f"127.0.0.1:{number}", f"localhost:{number}", f"[::1]:{number}"})
        shown = f"[{host}]" if ":" in host else host
        self.url = f"http://{shown}:{number}/#token={self.token}"

    def server_bind(self) -> None:
        """Bind the address, and ask nobody for its name."""
        TCPServer.server_bind(self)
        self.server_name, self.server_port = "localhost", self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection, unless there are too many."""
        if not self.connections.acquire(blocking=False):
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve it in its thread, and count it."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.connections.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of a connection that broke."""

    def server_close(self) -> None:
        """Close, and end the children."""
        super().server_close()
        self.children.close()


class Handler(BaseHTTPRequestHandler):
    """One connection."""

    server: Server
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    wbufsize = 65536
    timeout = _TIMEOUT

    def setup(self) -> None:
        """Note when the connection was opened."""
        super().setup()
        self.connection.settimeout(_TIMEOUT)

    def handle_one_request(self) -> None:
        """Read one request and answer it; the whole of its head has to come within ten seconds."""
        limited = _Limited(self.rfile, time.monotonic() + _TIMEOUT, self.connection)
        usual, self.rfile = self.rfile, limited  # type: ignore[assignment]
        try:
            self.raw_requestline = limited.readline(_LINE)
            if not self.raw_requestline:
                self.close_connection = True
                return
            if len(self.raw_requestline) >= _LINE - 1:
                self.requestline, self.request_version, self.command = "", "", ""
                self._refuse(414)
            elif self.parse_request():
                self.rfile = usual
                self._serve()
            self.wfile.flush()
        except TimeoutError:
            self.requestline, self.request_version = "", "HTTP/1.1"
            self.close_connection = True
            with suppress(OSError):
                self._refuse(408)
                self.wfile.flush()
        except _TooLong:
            self.request_version = "HTTP/1.1"
            with suppress(OSError):
                self._refuse(431)
                self.wfile.flush()
        except OSError:
            self.close_connection = True
        finally:
            self.rfile = usual

    def _serve(self) -> None:
        hosts = self.headers.get_all("Host") or []
        if len(hosts) != 1 or hosts[0] not in self.server.names:
            self._refuse(421)
        elif self.command == "POST" and self.path == "/api":
            self._ask()
        elif self.command not in {"GET", "HEAD"} or self.path == "/api":
            self._refuse(405)
        elif self.path in self.server.routes:
            kind, content = self.server.routes[self.path]
            self._send(200, kind, content)
        else:
            self._refuse(404)

    def _ask(self) -> None:
        """Answer a question of the protocol."""
        headers = self.headers
        origins, lengths = headers.get_all("Origin") or [], headers.get_all("Content-Length") or []
        given = headers.get("X-Symobs-Token", "")
        own = {f"http://{name}" for name in self.server.names}
        same = len(origins) == 1 and origins[0] in own and headers.get("Sec-Fetch-Site", "same-origin") == "same-origin"
        if not (same and hmac.compare_digest(given.encode("utf-8", "replace"), self.server.token.encode())):
            self._refuse(403)
        elif headers.get_content_type() != "application/json":
            self._refuse(415)
        elif "Transfer-Encoding" in headers or len(lengths) != 1 or not (lengths[0].isascii() and lengths[0].isdigit()):
            self._refuse(411)
        elif len(lengths[0]) > 9 or int(lengths[0]) > MOST_BYTES:
            self._refuse(413)
        else:
            body = _Limited(self.rfile, time.monotonic() + _TIMEOUT, self.connection).read(int(lengths[0]))
            if len(body) < int(lengths[0]):
                self.close_connection = True
                return
            try:
                found = self.server.children.answer(body, self._has_left)
            except Gone:
                self.close_connection = True
                return
            self._send(200, "application/json; charset=utf-8", found)

    def _has_left(self) -> bool:
        """Return whether the browser has closed the connection: what it asked for is not wanted any more."""
        if not select.select([self.connection], [], [], 0)[0]:
            return False
        with suppress(OSError):
            return not self.connection.recv(1, socket.MSG_PEEK)
        return True

    def _refuse(self, code: int) -> None:
        """Answer with a status alone, and hear no more of this connection."""
        self.close_connection = True
        self._send(code, "text/plain; charset=utf-8", f"{code}\n".encode())

    def _send(self, code: int, kind: str, content: bytes) -> None:
        self.send_response_only(code)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", kind)
        if len(content) > _LEAST_COMPRESSED and _GZIP.search(self.headers.get("Accept-Encoding", "")):
            content = gzip.compress(content)
            self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Length", str(len(content)))
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:  # noqa: ARG002
        """Refuse what is no HTTP, without repeating it."""
        self.command = getattr(self, "command", None) or ""
        self.request_version = "HTTP/1.1"
        self._refuse(int(code))

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002 - the name in the base class
        """Log nothing: a request holds what a user typed."""


class _TooLong(Exception):
    """The head of a request is longer than allowed."""


class _Limited:
    """A stream of which only so much is read, and only until an instant."""

    def __init__(self, stream: Any, end: float, connection: socket.socket) -> None:
        """Read from `stream`."""
        self.stream, self.end, self.connection, self.size = stream, end, connection, 0

    def _allow(self) -> None:
        left = self.end - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self.connection.settimeout(left)

    def readline(self, most: int = -1) -> bytes:
        """Return a line, read byte by byte from the buffer so that the instant is kept."""
        line = bytearray()
        while not line.endswith(b"\n") and (most < 0 or len(line) < most):
            self._allow()
            piece: bytes = self.stream.read1(1)
            if not piece:
                break
            line += piece
            self.size += 1
            if self.size > _MOST_HEADERS:
                raise _TooLong
        return bytes(line)

    def read(self, count: int) -> bytes:
        """Return so many bytes."""
        found = bytearray()
        while len(found) < count:
            self._allow()
            piece: bytes = self.stream.read1(count - len(found))
            if not piece:
                break
            found += piece
        return bytes(found)


def serve(server: Server) -> None:
    """Serve until interrupted."""
    try:
        server.serve_forever(poll_interval=0.1)
    finally:
        server.server_close()
