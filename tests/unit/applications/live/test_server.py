"""The server of `symobs serve`: who is answered, who is refused, and that a child can always be replaced."""

from __future__ import annotations

import gzip
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import tomllib
from contextlib import closing
from decimal import Decimal
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qsl

import pytest

from symobs.applications.live.request import SHORT, link_of
from symobs.applications.live.server import AnswerBudget, Children, Gone, Server, routes
from symobs.tasks.result import tasks
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.batches import eventually
from tests.support.tools.command_line import SAFETY, SERVO, environment

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

OBEDIENT = "tests.support.tools.live_children"
QUESTION = json.dumps(
    {
        "schema": "symobs-live/1",
        "id": 3,
        "problem": {
            "task": "observer",
            "plant": {"A": "[0 1; 0 -1]", "C": "[1 0]"},
            "specification": {"poles": "-10, -10"},
        },
    }
).encode()


@pytest.fixture(name="server", scope="module")
def running_server() -> Iterator[Server]:
    server = Server(budget=AnswerBudget(60, 1000))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


def sent(server: Server, raw: bytes) -> tuple[int, dict[str, str], bytes]:
    """What comes back for the bytes of a request: status, headers, content."""
    with closing(socket.create_connection(("127.0.0.1", server.server_address[1]), SAFETY)) as connection:
        connection.sendall(raw)
        stream = connection.makefile("rb")
        line = stream.readline()
        headers = {}
        while (each := stream.readline().strip()) != b"":
            name, _, value = each.decode().partition(": ")
            headers[name.lower()] = value
        return int(line.split()[1]), headers, stream.read(int(headers["content-length"]))


def request(server: Server, line: str = "POST /api HTTP/1.1", body: bytes = QUESTION, **changed: str | None) -> bytes:
    """A request as the page sends it; `changed` headers are others, or none."""
    place = f"127.0.0.1:{server.server_address[1]}"
    headers: dict[str, str | None] = {
        "Host": place,
        "Origin": f"http://{place}",
        "Content-Type": "application/json",
        "X-Symobs-Token": server.token,
        "Content-Length": str(len(body)),
    }
    headers |= {name.replace("_", "-"): value for name, value in changed.items()}
    lines = [line, *(f"{name}: {value}" for name, value in headers.items() if value is not None), "", ""]
    return "\r\n".join(lines).encode() + body


def test_a_question_of_the_page_is_answered(server: Server) -> None:
    status, headers, content = sent(server, request(server))
    found = json.loads(content)
    assert (status, found["id"], found["status"]) == (200, 3, "done")
    assert found["result"]["L"] == [["19"], ["81"]]
    assert headers["content-security-policy"].startswith("default-src 'none'; script-src 'self'")
    assert headers["cache-control"] == "no-store"
    assert headers["x-content-type-options"] == "nosniff"
    assert "server" not in headers
    for name in ("localhost", "[::1]"):
        place = f"{name}:{server.server_address[1]}"
        assert sent(server, request(server, Host=place, Origin=f"http://{place}"))[0] == 200


@tabled
def test_whoever_is_not_the_page_is_refused(server: Server, case: str, change: dict[str, Any], status: int) -> None:
    assert case
    if "body" in change:
        change = change | {"body": change["body"].encode()}
    assert_refused(server, {name: value if value is not False else None for name, value in change.items()}, status)


@pytest.mark.parametrize("change", [{"X_Long": "a" * 17_000}, {f"X_{k}": "a" * 100 for k in range(200)}])
def test_headers_that_are_too_long_or_too_many_are_refused(server: Server, change: dict[str, Any]) -> None:
    assert_refused(server, change, 431)


def assert_refused(server: Server, change: dict[str, Any], status: int) -> None:
    found, headers, content = sent(server, request(server, **change))
    assert found == status
    assert headers["connection"] == "close"
    assert server.token.encode() not in content
    assert len(content) < 10


def test_a_head_that_does_not_come_ends(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("symobs.applications.live.server._TIMEOUT", 0.2)
    with closing(socket.create_connection(("127.0.0.1", server.server_address[1]), SAFETY)) as connection:
        connection.sendall(b"GET / HTTP/1.1\r\nX: ")
        assert connection.makefile("rb").read().startswith(b"HTTP/1.1 408")


def test_only_the_files_of_the_page_are_there(server: Server) -> None:
    for path, (kind, content) in routes().items():
        status, headers, found = sent(server, request(server, f"GET {path} HTTP/1.1", b""))
        assert (status, headers["content-type"], found) == (200, kind, content)
    assert set(routes()) == {"/", "/symobs-live.js", "/start-http.js", "/live.css"}


def test_no_other_page_can_frame_it(server: Server) -> None:
    for line in ("GET / HTTP/1.1", "GET /elsewhere HTTP/1.1"):
        policy = sent(server, request(server, line, b""))[1]["content-security-policy"]
        assert "frame-ancestors 'none'" in policy.split("; ")


@pytest.mark.parametrize("accepted", ["gzip", "deflate, GZIP;q=0.5 , br"])
def test_what_is_long_is_compressed(server: Server, accepted: str) -> None:
    derivation = json.dumps(json.loads(QUESTION) | {"want": "page"}).encode()
    status, headers, content = sent(server, request(server, body=derivation, Accept_Encoding=accepted))
    whole = gzip.decompress(content)
    assert (status, headers["content-encoding"]) == (200, "gzip")
    assert json.loads(whole)["html"].endswith("</div>\n")
    assert len(whole) > 5 * len(content)


@pytest.mark.parametrize("accepted", [None, "", "br, deflate", "gzip;q=0", "gzip;q=0.0, br", "xgzip"])
def test_it_is_sent_as_it_is_to_who_does_not_take_that(server: Server, accepted: str | None) -> None:
    _, headers, content = sent(server, request(server, "GET /live.css HTTP/1.1", b"", Accept_Encoding=accepted))
    assert "content-encoding" not in headers
    assert content == routes()["/live.css"][1]


def test_what_is_short_is_sent_as_it_is(server: Server) -> None:
    _, headers, content = sent(server, request(server, "GET / HTTP/1.1", b"", Accept_Encoding="gzip"))
    assert "content-encoding" not in headers
    assert content == routes()["/"][1]


def test_what_is_no_request_of_the_protocol_is_an_answer(server: Server) -> None:
    for body in (b"", b"[" * 9000, b"\xff", b'{"schema": "symobs-live/1", "at": {"x": NaN}}', b"[]"):
        status, _, content = sent(server, request(server, body=body))
        assert (status, json.loads(content)["status"]) == (200, "bad")


def ask(children: Children, **what: object) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(children.answer(json.dumps(what).encode()))
    return found


def test_a_child_that_sleeps_or_swells_is_replaced() -> None:
    children = Children(AnswerBudget(60, 300), OBEDIENT)
    try:
        first = ask(children)["process"]
        assert ask(children)["process"] == first
        swollen = ask(children, do="swell", id=5)
        assert (swollen["status"], swollen["id"]) == ("undecided", 5)
        assert "300 MB" in swollen["message"]
        second = ask(children)["process"]
        assert second != first
        children.budget = AnswerBudget(0.2, 300)
        assert "not decided within 0.2 s" in ask(children, do="sleep")["message"]
        german = ask(children, do="sleep", problem={"language": "de"})
        assert german["message"] == "nicht innerhalb von 0,2 s entschieden"
        children.budget = AnswerBudget(60, 300)
        third = ask(children)["process"]
        assert third not in {first, second}
        with pytest.raises(Gone):
            children.answer(b'{"do": "sleep"}', lambda: True)
        assert ask(children)["process"] != third
        for process in (first, second, third):
            with pytest.raises(ProcessLookupError):
                os.kill(process, 0)
    finally:
        children.close()


def test_a_child_at_work_ends_with_the_server() -> None:
    children = Children(AnswerBudget(600, 300), OBEDIENT)
    process = ask(children)["process"]
    found: list[dict[str, Any]] = []
    is_asked = threading.Event()

    def has_left() -> bool:
        is_asked.set()
        return False

    thread = threading.Thread(target=lambda: found.append(json.loads(children.answer(b'{"do": "sleep"}', has_left))))
    thread.start()
    assert is_asked.wait(SAFETY)
    children.close()
    thread.join(SAFETY)
    assert [each["status"] for each in found] == ["undecided"]
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)


#: Whoever imports what answers tells so, and goes on when the server has ended.
_SLOW_START = """
import os, sys

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name in {"symobs.applications.live.child", "symobs.applications.live.warm"}:
            parent = os.getppid()
            open(os.environ["BEGUN"], "w").close()
            while os.getppid() == parent:
                pass

sys.meta_path.insert(0, Finder())
"""


def test_an_interrupt_while_the_first_child_is_started_is_all_that_is_said(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(_SLOW_START, "utf-8")
    begun = tmp_path / "begun"
    paths = {"BEGUN": str(begun), "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    with subprocess.Popen(
        [sys.executable, "-m", "symobs", "serve", "--no-browser", "--language", "de", str(SERVO)],
        env=environment() | paths,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as run:
        assert run.stdout is not None
        url = run.stdout.readline().strip()
        assert eventually(begun.exists)
        os.killpg(run.pid, signal.SIGINT)  # as a terminal does
        out, err = run.communicate(timeout=SAFETY)
    assert run.returncode == 130
    assert (out, err.strip()) == ("", "interrupted")
    given = dict(parse_qsl(url.partition("#")[2]))
    assert len(given.pop("token")) >= 32
    assert given == {
        "v": "1",
        "task": "compensator",
        "transfer_function": "1/(s*(s + 1))",
        "control": "-2, -2",
        "observer": "-10, -10",
        "language": "de",
    }


def test_the_address_is_that_of_the_last_start(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "symobs", "serve", "--no-browser", "--share", "https://example.org/live/"]
    own = environment() | {"XDG_STATE_HOME": str(tmp_path)}

    def started() -> subprocess.Popen[str]:
        return subprocess.Popen(command, env=own, stdout=subprocess.PIPE, text=True)

    def ended(run: subprocess.Popen[str]) -> None:
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=SAFETY)

    urls = []
    for _ in range(2):
        with started() as run:
            assert run.stdout is not None
            urls.append(run.stdout.readline())
            with started() as other:  # while the first one has the port
                assert other.stdout is not None
                assert other.stdout.readline().partition("#")[0] != urls[-1].partition("#")[0]
                ended(other)
            ended(run)
    assert urls[0] == urls[1]
    kept = tmp_path / "symobs" / "serve.json"
    assert kept.stat().st_mode & 0o777 == 0o600
    kept.chmod(0o644)  # anybody may have read the token
    with started() as run:
        assert run.stdout is not None
        assert run.stdout.readline().partition("token=")[2] != urls[0].partition("token=")[2]
        ended(run)


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.0.1", "::", "example.org"])  # noqa: S104 - what must be refused
def test_no_other_address_is_served(host: str) -> None:
    command = [sys.executable, "-m", "symobs", "serve", "--no-browser", "--host", host]
    run = subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=SAFETY, check=False)
    assert run.returncode == 2
    assert "SSH tunnel" in run.stderr


def test_a_link_holds_a_problem() -> None:
    data = {
        "task": "observer",
        "plant": {"A": [["0", "1"], ["-omega^2", "- b"]], "C": [[1, 0]], "dt": 0},
        "specification": {"poles": ["-p", "-1/2"]},
        "symbols": {"omega": "positive", "p": {"sign": "positive", "latex": "p"}},
        "convention": "S1",
        "language": "de",
    }
    assert dict(parse_qsl(link_of(data))) == {
        "v": "1",
        "task": "observer",
        "A": "[0 1; -omega^2 (- b)]",
        "C": "[1 0]",
        "dt": "0",
        "poles": "-p, -1/2",
        "symbols": "omega:positive,p:positive",
        "convention": "S1",
        "language": "de",
    }


def test_a_link_calls_every_key_by_a_name_of_its_own() -> None:
    long = {short: name for name, short in SHORT.items()}
    for task in tasks().values():
        for name in task.keywords:
            short = SHORT.get(name, name)
            assert long.get(short, short) == name, (task.name, name)


def test_a_link_holds_poles_by_what_they_are_to_do() -> None:
    poles = tomllib.loads(
        'poles = { others = ["-5", "-w"], damping = 0.7, natural_frequency = "w" }', parse_float=Decimal
    )
    found = dict(parse_qsl(link_of({"task": "observer", "specification": poles})))
    assert found["poles"] == "damping = 0.7, natural_frequency = w, others = -5, -w"
