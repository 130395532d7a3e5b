"""The second look at answers: plain fractions that accept what is right and see every answer that was changed."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from symobs.applications.batch.jobs import solve_job
from symobs.applications.batch.recheck import CLAIMS, Beyond, fault, value
from symobs.applications.batch.solving import given_for, problem_of, run
from tests.kit import tabled, tables
from tests.support.tools.command_line import EXAMPLES

QUICK = [path for path in EXAMPLES if path.stem != "cart_pole"]


def answered(text: str, name: str = "p") -> list[tuple[str, dict[str, Any], dict[str, Any]]]:
    """The tasks of a problem with their data and answers, as texts."""
    payload = json.loads(solve_job(text, name).payload)
    problem, row = problem_of(payload), run(payload)
    results = json.loads(json.dumps(row["result"]))
    return [(task.name, given_for(problem, task), answer) for task, answer in zip(problem.tasks, results, strict=True)]


def spoilt(answer: Any) -> Any:
    """An answer with 1 added to its last entry, None where there is none."""
    if isinstance(answer, str):
        return f"{answer} + 1"
    if isinstance(answer, list) and answer and (changed := spoilt(answer[-1])) is not None:
        return [*answer[:-1], changed]
    return None


def test_the_worked_examples_hold_and_changed_ones_do_not() -> None:
    looked_at: dict[str, int] = {}
    for path in QUICK:
        text = path.read_text("utf-8")
        if not any(f'"{task}"' in text for task in CLAIMS) or "minimal" in text or "sqrt" in text:
            continue
        for task, given, answer in answered(text):
            assert fault(task, given, answer, path.stem) is None, (path.stem, task)
            for field in _CHECKED.get(task, ()):
                changed = spoilt(answer.get(field))
                if changed is None or changed == answer[field] or "zero" in given or answer.get("family"):
                    continue
                seen = fault(task, given, {**answer, field: changed}, path.stem)
                assert seen is not None, (path.stem, task, field, changed)
                looked_at[task] = looked_at.get(task, 0) + 1
    assert looked_at.keys() >= {"observer", "state_feedback", "compensator", "observability", "canonical_form"}
    assert sum(looked_at.values()) > 50


#: Fields every digit of which matters.
_CHECKED = tables(Path(__file__))["checked"]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("-2**2", -4),
        ("(a - 1)/(2*b)", Fraction(1, 3)),
        ("2*-3", -6),
        ("a**-2*b", Fraction(3, 8)),
        ("-a**2/3 + 1", Fraction(-1, 3)),
    ],
)
def test_texts_mean_what_they_mean_in_sympy(text: str, wanted: Fraction) -> None:
    names = {"a": Fraction(2), "b": Fraction(3, 2)}
    assert value(text, names) == wanted


@tabled
def test_texts_beyond_fractions_are_left_out(text: str) -> None:
    with pytest.raises((Beyond, IndexError)) as left:
        value(text, {"a": Fraction(2), "b": Fraction(1, 2)})
    assert left.type is Beyond


@pytest.mark.parametrize("dt", ["", "dt = 1\n"])
def test_the_gains_of_integral_action_are_looked_at(dt: str) -> None:
    plant = f'[plant]\nA = "[0 1; 0 -a]"\nB = "[0; 1]"\nC = "[1 0]"\nD = "1"\n{dt}[symbols]\na = "real"\n'
    ((task, given, answer),) = answered(
        f'task = "integral_action"\n{plant}[specification]\npoles = "-1/2, -1/3, -1/5"\n'
    )
    assert fault(task, given, answer, "p") is None
    for field in ("K", "k_I", "closed_loop_matrix"):
        assert fault(task, given, {**answer, field: spoilt(answer[field])}, "p") is not None
