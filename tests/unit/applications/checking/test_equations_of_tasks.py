"""The defining equations of a task as lines: true ones are true, with one sign changed they are false."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from symobs.applications.checking import Checked

EQUATIONS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


@pytest.mark.parametrize("name", EQUATIONS)
def test_equations_are_true_and_false(name: str) -> None:
    checked, wrong = Checked.of(EQUATIONS[name]["problem"]), []
    for expected in ("true", "false"):
        for line in EQUATIONS[name][expected]:
            found = [(each.verdict, each.reason) for each in checked.report(line).lines]
            if [verdict for verdict, _ in found] != [expected]:
                wrong.append((line, expected, found))
    assert not wrong


def test_a_formula_gives_no_value() -> None:
    checked = Checked.of(EQUATIONS["lqr"]["problem"])
    (part,) = (part for part in checked.report("K = [2 3]\nK = R^-1 B' P").parts if part.weight)
    assert (part.verdict, part.given) == ("right", "[2 3]")
    (part,) = (part for part in checked.report("K = R^-1 B' P").parts if part.weight)
    assert part.verdict == "missing"
