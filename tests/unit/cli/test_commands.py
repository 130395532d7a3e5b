"""The command line: its commands, what they write where, and the exit codes other programs rely on."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

from symobs.cli.commands import solve
from symobs.ground.errors import CertificateRejected
from symobs.tasks.result import tasks
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import EXAMPLES, SAFETY, SERVO, environment, inside

if TYPE_CHECKING:
    import pytest

PLANT = '[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
OBSERVER = f'task = "observer"\n{PLANT}[specification]\npoles = [-10, -10]\n'
NOT_OBSERVABLE = OBSERVER.replace("[1 0]", "[0 1]")


def results(text: str) -> list[dict[str, Any]]:
    found: dict[str, Any] = json.loads(text)
    assert found["schema"] == "symobs/1"
    listed: list[dict[str, Any]] = found["results"]
    return listed


# -- exit codes -----------------------------------------------------------------------------------------------------


@tabled
def test_verdict_or_expectation_decides(text: str, code: int, said: str) -> None:
    run = inside("solve", "-", "--format", "json", stdin=text.encode())
    assert (run.code, run.err) == (code, said)
    assert len(results(run.out)) == 1


def test_a_bug_is_said_as_such(monkeypatch: pytest.MonkeyPatch) -> None:
    def stumble(*_: object, **__: object) -> None:
        raise KeyError("x")

    monkeypatch.setattr(solve, "run_work", stumble)
    run = inside("solve", str(SERVO))
    assert (run.code, run.out) == (1, "")
    assert run.err == "internal error: KeyError: 'x'; please report this\n"

    def lie(*_: object, **__: object) -> None:
        raise CertificateRejected("does not hold", where="det(sI - A + LC) = phi")

    monkeypatch.setattr(solve, "run_work", lie)
    assert inside("solve", str(SERVO)).code == 1


@tabled
def test_wrong_usage_is_2(arguments: list[str], tmp_path: Path) -> None:
    run = inside(*arguments, folder=tmp_path)
    assert (run.code, run.out) == (2, "")
    assert run.err
    assert "Traceback" not in run.err
    assert not any(tmp_path.iterdir())


@tabled
def test_what_may_have_been_meant_is_said(arguments: list[str], said: str, tmp_path: Path) -> None:
    run = inside(*arguments, folder=tmp_path)
    assert (run.code, run.out) == (2, "")
    assert said in run.err


# -- where the result goes ------------------------------------------------------------------------------------------


def test_the_suffix_names_the_format(tmp_path: Path) -> None:
    for suffix, beginning in {
        ".json": '{\n  "schema"',
        ".tex": "\\documentclass",
        ".txt": "Output",
        "": "\\documentclass",
    }.items():
        target = tmp_path / f"page{suffix}"
        run = inside("solve", str(SERVO), "-o", str(target))
        assert run == (0, "", "")
        assert target.read_text("utf-8").startswith(beginning)
    given = tmp_path / "given.tex"
    assert inside("solve", str(SERVO), "--format", "json", "-o", str(given)).code == 0
    assert results(given.read_text("utf-8"))
    assert inside("solve", str(SERVO), "--format", "json", "-o", "-").out == given.read_text("utf-8")


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "page.tex"
    target.write_text("before", "utf-8")
    target.chmod(0o600)

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", fail)
        run = inside("solve", str(SERVO), "-o", str(target))
    assert (run.code, run.out) == (3, "")
    assert "No space left on device; make room there, or name a file elsewhere with -o" in run.err
    assert [path.name for path in tmp_path.iterdir()] == ["page.tex"]
    assert target.read_text("utf-8") == "before"

    for text in (NOT_OBSERVABLE.replace("-10]", "x]"), "", "a: b"):
        assert inside("solve", "-", "-o", str(target), stdin=text.encode()).code == 3
    assert target.read_text("utf-8") == "before"

    assert inside("solve", "-", "-o", str(target), stdin=NOT_OBSERVABLE.encode()).code == 4
    assert target.read_text("utf-8").startswith("\\documentclass")
    assert target.stat().st_mode & 0o777 == 0o600


def writing_to(stdout: int, *arguments: str) -> tuple[int, str]:
    """Exit code and messages of a run whose standard output is this file descriptor."""
    command = [sys.executable, "-m", "symobs", *arguments]
    run = subprocess.run(
        command, env=environment(), stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=SAFETY, check=False
    )
    return run.returncode, run.stderr


# -- ends that come early -------------------------------------------------------------------------------------------


@tabled
def test_a_reader_may_stop_reading(arguments: list[str]) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    try:
        assert writing_to(writing, *arguments) == (0, "")
    finally:
        os.close(writing)


# -- one command a task ---------------------------------------------------------------------------------------------


def test_a_task_without_a_file() -> None:
    run = inside("observer", "--A", "[0 1; 0 -1]", "--C", "[1 0]", "--poles", "-10, -10", "--format", "json")
    assert (run.code, run.err) == (0, "")
    assert results(run.out)[0]["L"] == [["19"], ["81"]]
    free = inside(
        "state_feedback", "--A", "[0 1; 0 -b]", "--B", "[0; 1]", "--polynomial", "s^2 + p s + q", "--format", "json"
    )
    assert results(free.out)[0]["K"] == [["q", "-b + p"]] or results(free.out)[0]["K"] == [["q", "p - b"]]
    closed = inside("observability", "--A", "[0 1; 0 -b]", "--C", "[1 0]", "--symbol", "c=positive")
    assert closed.code == 3
    assert closed.err.startswith('--A: the name "b" is not declared')
    discrete = inside("characteristic-polynomial", "--A", "[1 1; 0 1]", "--dt", "true", "--format", "json")
    assert results(discrete.out)[0]["polynomial"] == "z**2 - 2*z + 1"
    function = inside("transfer_function", "--transfer-function", "1/(s (s + 1))", "--format", "json")
    assert results(function.out)[0]["poles"] == ["0", "-1"] or results(function.out)[0]["poles"] == ["-1", "0"]


def test_a_task_and_its_file_give_the_same_page() -> None:
    """Poles are written as text or as a list: JSON repeats what was asked for as it was given, and differs nowhere else."""
    options = ["--A", "[0 1; 0 -1]", "--B", "[0; 1]", "--C", "[1 0]", "--poles", "-10, -10"]
    as_text = OBSERVER.replace("[-10, -10]", '"-10, -10"')
    for form in ("latex", "text", "json"):
        of_command = inside("observer", *options, "--format", form)
        assert of_command.code == 0
        assert of_command == inside("solve", "-", "--format", form, stdin=as_text.encode())
        of_list = inside("solve", "-", "--format", form, stdin=OBSERVER.encode())
        if form != "json":
            assert of_command == of_list
            continue
        (own,), (other,) = results(of_command.out), results(of_list.out)
        assert own == other | {"specification": {"poles": "-10, -10"}}
        assert other["specification"] == {"poles": [-10, -10]}


@tabled
def test_wrong_values_are_3_and_name_the_option(options: list[str], said: str) -> None:
    run = inside("observer", *options)
    assert (run.code, run.out) == (3, "")
    assert run.err.startswith(said)


# -- lists ----------------------------------------------------------------------------------------------------------


def test_the_schema_is_one_and_fits_the_worked_examples() -> None:
    run = inside("schema")
    assert run.code == 0
    schema = json.loads(run.out)
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    for path in EXAMPLES:
        assert list(validator.iter_errors(tomllib.loads(path.read_text("utf-8")))) == []
    tables = tomllib.loads(OBSERVER)
    changes: tuple[dict[str, Any], ...] = (
        {"titel": "x"},
        {"task": "observe"},
        {"tasks": ["observer"]},
        {"plant": {"C": "[1]"}},
        {"plant": {"A": 5}},
        {"plant": {"A": [1, 2]}},
        {"plant": {"A": "[1]", "Q": 1}},
        {"specification": {"pole": [-1]}},
        {"specification": {"poles": True}},
        {"symbols": {"b": "plus"}},
        {"symbols": {"b": {"sgn": "real"}}},
        {"convention": "../S9"},
        {"expect": []},
    )
    for change in changes:
        assert list(validator.iter_errors({**tables, **change})), change
    assert set(tasks()["compensator"].keywords) <= set(schema["properties"]["specification"]["properties"])


def test_templates_are_listed_and_copied_once(tmp_path: Path) -> None:
    names = sorted(path.name for path in (ROOT / "latex_templates").iterdir())
    assert inside("templates") == (0, "".join(f"{name}\n" for name in names), "")
    mine = tmp_path / "a" / "mine"
    assert inside("templates", "copy", str(mine)) == (0, "", "")
    for name in names:
        assert (mine / name).read_bytes() == (ROOT / "latex_templates" / name).read_bytes()
    (mine / "article.tex").write_text("my own", "utf-8")
    again = inside("templates", "copy", str(mine))
    assert again.code == 3
    assert "article.tex is already there" in again.err
    assert (mine / "article.tex").read_text("utf-8") == "my own"
    assert inside("templates", "copy", str(mine / "article.tex")).code == 3


def test_what_is_beyond_the_limits_of_a_check_is_undecided_with_its_reason(tmp_path: Path) -> None:
    """Seven decay rates of eight digits are related by small whole numbers: one measure, with multiples of ten digits."""
    rates = ("8.1051234", "4.2329123", "3.1234561", "7.7654321", "1.0541699", "5.8731139", "2.2222223")
    rows = ("[" + ", ".join(f'"-{rate}"' if i == j else "0" for j in range(7)) + "]" for i, rate in enumerate(rates))
    plant = f'[symbols]\nT = "positive"\n[plant]\nA = [{", ".join(rows)}]\nC = "[1 1 1 1 1 1 1]"\n'
    text = f'tasks = ["gramian", "observability"]\n{plant}[specification]\nhorizon = "T"\n'
    (tmp_path / "rates.toml").write_text(text, "utf-8")
    run = inside("solve", "rates.toml", "--format", "json", folder=tmp_path)
    results = json.loads(run.out)["results"]
    assert (run.code, [result["verdict"] for result in results]) == (5, ["undecided", "yes"])
    assert "too far from the other exponents" in results[0]["reason"]
    assert "bug" not in run.err
    page = inside("solve", "rates.toml", "--format", "text", folder=tmp_path)
    assert (page.code, "observable" in page.out, page.err) == (5, True, run.err)
