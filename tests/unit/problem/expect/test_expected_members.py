"""An expected answer that is one of many is met where its own claim holds."""

from __future__ import annotations

import pytest

from symobs.problem import read
from symobs.problem.expect import mismatches

LYAPUNOV = 'task = "lyapunov"\n[plant]\nA = "[0 1; -1 0]"\n[specification]\nQ = "[0 0; 0 0]"\n[expect]\nP = "{}"\n'
REGULATION = """task = "output_regulation"
[plant]
A = "[0 1; 0 0]"
B = "[1 0; 0 1]"
C = "[1 0]"
[specification]
S = "[0]"
reference = "[1]"
poles = [-1, -2]
[expect]
Pi = "{}"
Gamma = "{}"
"""


@pytest.mark.parametrize(
    ("text", "met"),
    [
        (LYAPUNOV.format("[3 0; 0 3]"), True),  # every multiple of I
        (LYAPUNOV.format("[3 0; 0 2]"), False),
        (REGULATION.format("[1; 3]", "[-3; 0]"), True),  # x2 = -u1 is free
        (REGULATION.format("[1; 3]", "[3; 0]"), False),
        (REGULATION.format("[2; 3]", "[-3; 0]"), False),
    ],
)
def test_a_member_meets_what_is_expected(text: str, met: bool) -> None:  # noqa: FBT001
    problem = read(text)
    assert bool(mismatches(problem.solve(), problem.expect)) != met
