"""The command `mcp`: the tasks, `check` and `audit` as tools of an assistant, by the Model Context Protocol.

Every call is a command in a process of its own, with its time and memory: what ends it ends neither the server nor
another call.
"""

from __future__ import annotations

import inspect
import json
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import click

from symobs.cli.commands.audit import command as audit_command
from symobs.cli.commands.check import command as check_command
from symobs.ground.errors import UsageError
from symobs.tasks.result import tasks

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.tasks.result.registry import Task

#: Seconds beyond those of the work that a command has to start and to write.
_GRACE = 20.0

_INSTRUCTIONS = """\
symobs designs observers, state feedback and compensators exactly and checks every claim and every line of a page.
A problem is a file in TOML:
[symbols]        # every free name: real, positive, negative, nonzero, …
b = "positive"
[plant]          # A, B, C, D as in MATLAB, or transfer_function = "1/(s*(s+1))"; dt = true in discrete time
A = "[0 1; 0 -b]"
B = "[0; 1]"
C = "[1 0]"
[specification]  # the keywords of the task
poles = "-2+j2, -2-j2"
Numbers and parameters are exact; floats are not needed. Quote verdict, conditions and cases with every answer."""


@click.command("mcp")
@click.option(
    "--timeout", type=click.FloatRange(0, min_open=True), default=60.0, metavar="SECONDS", help="What a call may take."
)
@click.option("--memory", type=click.IntRange(100), default=2000, metavar="MB", help="What a call may use.")
def command(timeout: float, memory: int) -> None:
    """Serve the tasks, `check` and `audit` to an assistant over standard input (Model Context Protocol)."""
    try:
        server_class = import_module("mcp.server.mcpserver").MCPServer
    except ImportError:
        message = "the package mcp is not there, or older than 2"
        raise UsageError(message, where="mcp", repair="install it with pip install 'symobs[mcp]'") from None
    limits = ("--timeout", f"{timeout:g}", "--memory", str(memory))
    server = server_class("symobs", instructions=_INSTRUCTIONS, log_level="WARNING")
    for _, task in sorted(tasks().items()):
        server.add_tool(_solving(task, limits, timeout), name=task.name, description=_description(task))

    async def check(problem: str, answer: str) -> dict[str, Any]:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "answer.toml"
            path.write_text(answer, "utf-8")
            done = await _run(("check", "-", str(path), "--format", "json", *limits), problem, timeout)
        return _with_json(done)

    async def audit(problem: str) -> dict[str, Any]:
        return _with_json(await _run(("audit", "-", "--format", "json", *limits), problem, timeout))

    answer_file = '`problem` is the text of the file, `answer` that of an answer file, as `K = "[9 5]"`.'
    server.add_tool(check, description=f"{check_command.help}\n\n{answer_file}")
    server.add_tool(audit, description=f"{audit_command.help}\n\n`problem` is the text of the file.")
    server.run("stdio")


def _description(task: Task) -> str:
    """Return what a task is, from its docstring, and its keywords."""
    keywords = ", ".join(task.keywords) or "none"
    return f"{inspect.getdoc(task.function) or task.summary}\n\nKeywords of [specification]: {keywords}."


def _solving(task: Task, limits: tuple[str, ...], timeout: float) -> Callable[..., Any]:
    """Return the tool of a task: the problem is solved once for the JSON, and once for the page."""

    async def solve(problem: str, language: str = "en") -> dict[str, Any]:
        asked = ("solve", "-", "--task", task.name, *limits)
        found = _with_json(await _run((*asked, "--format", "json"), problem, timeout))
        if "result" in found:
            page = await _run((*asked, "--format", "text", "--language", language), problem, timeout)
            found["page"] = page["output"]
            if not page["output"]:
                found |= {"exit_code": page["exit_code"], "messages": page["messages"]}
        return found

    return solve


async def _run(arguments: tuple[str, ...], text: str, seconds: float) -> dict[str, Any]:
    """Run a command with a text as its standard input; return its exit code, messages and output."""
    import anyio  # noqa: PLC0415 - a part of the extra

    with anyio.move_on_after(seconds + _GRACE) as limit:
        call = [sys.executable, "-m", "symobs", *arguments]
        done = await anyio.run_process(call, input=text.encode(), check=False)
    if limit.cancelled_caught:
        return {"exit_code": 5, "messages": [f"undecided: {seconds:g} seconds were not enough"], "output": ""}
    messages = done.stderr.decode(errors="replace").splitlines()
    return {"exit_code": done.returncode, "messages": messages, "output": done.stdout.decode(errors="replace")}


def _with_json(done: dict[str, Any]) -> dict[str, Any]:
    """Return an outcome with its output as JSON, where there is any."""
    output = done.pop("output")
    return {**done, "result": json.loads(output)} if output else done
