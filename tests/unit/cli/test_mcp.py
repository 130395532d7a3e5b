"""The command `mcp` with the client of the protocol's own library, over standard input."""

from __future__ import annotations

import sys
from typing import Any

import anyio
import pytest
import sympy
from mcp import Client, StdioServerParameters

from symobs.tasks.result import tasks

pytestmark = pytest.mark.process

PROBLEM = """
[plant]
A = "[0 1; -2 -3]"
B = "[0; 1]"
C = "[1 0]"
[specification]
poles = "-2+j2, -2-j2"
"""
ANSWER = 'K = "[6 2]"'


def test_every_task_is_a_tool_and_answers_with_certificates_and_a_page() -> None:
    async def call() -> dict[str, Any]:
        server = StdioServerParameters(command=sys.executable, args=["-m", "symobs", "mcp", "--timeout", "30"])
        async with Client(server) as client:
            listed = (await client.list_tools()).tools
            found: dict[str, Any] = {"names": {tool.name: tool.description for tool in listed}}
            for name, tool, text in (
                ("gain", "state_feedback", {"problem": PROBLEM}),
                ("german", "observer", {"problem": PROBLEM, "language": "de"}),
                ("bad", "observer", {"problem": PROBLEM.replace("-3", "q")}),
                ("wrong", "check", {"problem": f'task = "state_feedback"{PROBLEM}', "answer": ANSWER}),
                (
                    "audited",
                    "audit",
                    {"problem": f'task = "observer"{PROBLEM}\n[[printed]]\nrelation = "det(O) = 2"\n'},
                ),
            ):
                found[name] = (await client.call_tool(tool, text)).structured_content
            return found

    found = anyio.run(call)
    assert {*tasks(), "check", "audit"} == {*found["names"]}
    assert "poles" in found["names"]["observer"]
    (result,) = found["gain"]["result"]["results"]
    A, B, K = sympy.Matrix([[0, 1], [-2, -3]]), sympy.Matrix([0, 1]), sympy.Matrix(result["K"])
    s = sympy.Symbol("s")
    assert sympy.expand((s * sympy.eye(2) - A + B * K).det() - (s**2 + 4 * s + 8)) == 0  # (s + 2)² + 2²
    assert result["certificates"]
    assert "State feedback" in found["gain"]["page"]
    assert "Beobachter" in found["german"]["page"]
    assert found["bad"]["exit_code"] == 3
    assert 'the name "q" is not declared' in found["bad"]["messages"][0]
    assert (found["wrong"]["exit_code"], found["wrong"]["result"]["verdict"]) == (4, "wrong")
    (finding,) = found["audited"]["result"]["files"][0]["findings"]
    assert (found["audited"]["exit_code"], finding["right"]) == (4, "det(O) = 1")
