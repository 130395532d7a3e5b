"""Bad input: an exit code, a message with place and repair for every error, and nothing else happens."""

from __future__ import annotations

import re
from contextlib import suppress
from time import process_time
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.applications.checking.answers import read_answer
from symobs.formula.expression import comma_between_digits, parse_matrix, parse_poles, parse_polynomial, parse_scalar
from symobs.ground.errors import SymobsError
from symobs.problem.expect import read_roots, relation
from symobs.problem.sheet_file import is_sheet
from tests.kit import tabled
from tests.support.tools.command_line import Run, fresh, inside

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

SERVO = {"A": '"[0 1; 0 -1]"', "B": '"[0; 1]"', "C": '"[1 0]"'}
POLES = "poles = [-10, -10]"
CODE = "__import__('pathlib').Path('canary').touch()"


def problem(
    specification: str = POLES,
    top: str = 'task = "observer"',
    symbols: str = "",
    without: Sequence[str] = (),
    **plant: str | None,
) -> str:
    """A problem file: the observer of the servo with both poles at -10, as far as nothing else is said."""
    entries = "".join(f"{name} = {value}\n" for name, value in (SERVO | plant).items() if value and name not in without)
    return f"{top}\n[symbols]\n{symbols}\n[plant]\n{entries}[specification]\n{specification}\n"


def solved(folder: Path, text: str, run: Callable[..., Run] = inside) -> Run:
    file = folder / "problem.toml"
    file.write_text(text, "utf-8")
    found = run("solve", file.name, "--format", "json", folder=folder)
    assert [path.name for path in folder.iterdir()] == [file.name], "something was executed"
    return found


def assert_refused(run: Run, *expected: tuple[str, str]) -> None:
    """Every line names its place and a repair; the lines say, in order, the places and the words expected."""
    assert (run.code, run.out) == (3, ""), run.err
    assert "Traceback" not in run.err
    for line in run.lines:
        assert re.fullmatch(r"\S[^;]*?: .+; .+", line), line
    assert len(run.lines) == len(expected), run.err
    for line, (place, words) in zip(run.lines, expected, strict=True):
        assert line.startswith(f"{place}: "), line
        for word in words.split(" … "):
            assert word in line, line


# -- one mistake ----------------------------------------------------------------------------------------------------


@tabled
def test_one_mistake_is_one_line(tmp_path: Path, case: str, given: dict[str, Any], place: str, words: str) -> None:
    assert case
    assert_refused(solved(tmp_path, given.get("text") or problem(**given)), (place, words))


# -- many mistakes --------------------------------------------------------------------------------------------------


def test_all_mistakes_of_a_file_come_together(tmp_path: Path) -> None:
    text = """
        tasks = ["observer", "hug"]
        titel = "x"
        source = 5
        convention = "S9"
        [symbols]
        omega = "plus"
        lambda = "real"
        b = { sgn = "real" }
        [plant]
        A = [["x", 1], ["y", 1979-05-27]]
        B = "[0; 1"
        E = 3
        dt = -1
        [specification]
        poles = ["-1", "omga", true]
        polynomial = "1/s"
        pole = 3
        method = 5
        [expect]
        L = "[19; 81"
    """
    assert_refused(
        solved(tmp_path, text),
        ("titel", "unknown key"),
        ("source", "a text is expected"),
        ("convention", "S9"),
        ("tasks[1]", "hug"),
        ("symbols.omega", "plus"),
        ("symbols.lambda", "lam"),
        ("symbols.b", "sgn"),
        ("plant.dt", "-1"),
        ("plant.E", "unknown key"),
        ("plant.A[0][0]", '"x" is not declared'),
        ("plant.B", "never closed"),
        ("plant.A[1][0]", '"y" is not declared'),
        ("plant.A[1][1]", "date"),
        ("specification.pole", "did you mean poles?"),
        ("specification.method", "a number came"),
        ("specification.poles[1]", 'did you mean "omega"?'),
        ("specification.poles[2]", "not an exact number"),
        ("specification.polynomial", "denominator"),
        ("expect.L", "never closed"),
    )


def test_shapes_are_checked_beside_a_matrix_that_cannot_be_read(tmp_path: Path) -> None:
    run = solved(tmp_path, problem(B='"[0; 1; 2]"', C='"[1 x]"'))
    assert_refused(run, ("plant.C", '"x" is not declared'), ("plant.B", "3×1"))


def test_thousands_of_mistakes_are_cut_short(tmp_path: Path) -> None:
    unknown = solved(tmp_path, problem(top="\n".join(f"k{i} = 1" for i in range(20_000))))
    assert len(unknown.lines) < 30
    assert "more unknown keys" in unknown.err
    names = ", ".join(["1"] * 10_000)
    assert solved(tmp_path, problem(top=f"tasks = [{names}]")).lines[-1] == "… and 9900 more"


# -- hostile files; the costliest in a process of its own, with bounded memory -----------------------------------------

HOSTILE = {
    "tower": (problem(A='"[0 1; 0 9^9^9^9]"'), "plant.A", "exponent is beyond 1000"),
    "power": (problem(A='"[0 1; 0 ((10^64)^64)^64]"'), "plant.A", "more than 10000 bits"),
    "brackets in a text": (problem(A=f'"{"(" * 20_000}1{")" * 20_000}"'), "plant.A", "more than 10000"),
    "brackets of lists": (problem(A="[" * 20_000 + "]" * 20_000), "problem.toml, line 5", "nested more than 100"),
    "brackets of JSON": ('{"plant":' + "[" * 100_000, "problem.toml, line 1", "nested more than 100"),
    "tables of JSON": ('{"a":' * 20_000 + "1" + "}" * 20_000, "problem.toml, line 1", "nested more than 100"),
    "digits": (problem(A=f"[[0, 1], [0, {'9' * 100_000}]]"), "problem.toml, line 5", "more than 1000"),
    "digits of JSON": (f'{{"a": {"9" * 100_000}}}', "problem.toml, line 1", "more than 1000"),
    "digits in a text": (problem(A=f'"[0 1; 0 {"9" * 5_000}]"'), "plant.A", "more than 1000 digits"),
    "digits in base 16": (problem(dt=f"0x{'f' * 100_000}"), "problem.toml, line 8", "more than 1000"),
    "dotted key": ("a." * 20_000 + "a = 1", "problem.toml, line 1", "dotted key"),
    "dotted header": (f"[{'a.' * 20_000}a]", "problem.toml, line 1", "dotted key"),
    "dotted key in a table": (f"x = {{{'a.' * 20_000}a = 1}}", "problem.toml, line 1", "dotted key"),
    "dotted key behind quotes": (f'x = [""" """", {{{"a." * 20_000}a = 1}}]', "problem.toml, line 1", "dotted key"),
    "dotted key of texts": ('"a" . ' * 9_000 + "a = 1", "problem.toml, line 1", "dotted key"),
    "headers": ("\n".join(f"[a.b{i}.c.d.e.f]" for i in range(10_000)), "problem.toml", "more than 1000 tables"),
    "size": ("#" * 300_000, "problem.toml", "larger than 256 kB"),
    "quotes": ('"""\n' + '\\"""\n' * 50_000, "problem.toml, line 1, column 3", "not TOML"),
    "semicolons": ("a = [" + ";" * 250_000, "problem.toml, line 1, column 6", "not TOML"),
    "empty lines": ("\n" * 250_000 + "#\n]", "problem.toml, line 250002, column 1", "not TOML"),
    "code for an entry": (problem(A=f'[["{CODE}", 1], [0, -1]]'), "plant.A[0][0]", '"_" belongs to no expression'),
    "code for poles": (problem(f'poles = "{CODE}"'), "specification.poles", '"_" belongs to no expression'),
    "code for a name": (problem(symbols=f'"{CODE}" = "real"'), f"symbols.{CODE[:39]}…", "is not a name"),
    "code for a call": (problem(A='"[0 1; 0 exec(1)]"'), "plant.A", '"exec" is not declared'),
    "code for what is expected": (problem(f'{POLES}\n[expect]\nL = "{CODE}"'), "expect.L", "belongs to no expression"),
    "code for an attribute": (problem(A='"[0 1; 0 ().__class__]"'), "plant.A", '"." belongs to no expression'),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_files_are_refused(tmp_path: Path, case: str) -> None:
    text, place, words = HOSTILE[case]
    costly = {"power", "brackets of lists", "digits", "headers", "quotes", "code for an entry", "code for a name"}
    run = fresh if case in costly or case.startswith("dotted") else inside
    assert_refused(solved(tmp_path, text, run), (place, words))


# -- long texts -----------------------------------------------------------------------------------------------------

READERS: dict[str, Callable[[str], object]] = {
    "scalar": parse_scalar,
    "matrix": parse_matrix,
    "poles": parse_poles,
    "list of poles": lambda text: parse_poles([text]),
    "polynomial": lambda text: parse_polynomial(text, "s"),
    "decimal comma": comma_between_digits,
    "plant": lambda text: symobs.StateSpace(text, "[1]", symbols={"a": text}),
    "sheet": is_sheet,
    "answer": read_answer,
    "value of an answer": lambda text: read_answer(f"K = {text}"),
    "relation": lambda text: relation(text, None, ""),
    "roots": lambda text: read_roots([text], None, "s", ""),
}


def seconds(read: Callable[[str], object], text: str) -> float:
    begin = process_time()
    with suppress(SymobsError):
        read(text)
    return process_time() - begin


@tabled
@pytest.mark.parametrize("read", READERS.values(), ids=READERS)
def test_the_time_to_read_a_text_grows_no_faster_than_its_length(read: Callable[[str], object], piece: str) -> None:
    short, long = (piece * (length // len(piece)) for length in (7_500, 60_000))  # an answer has 64 kB at most
    spent = min(seconds(read, short) for _ in range(2))
    assert any(seconds(read, long) < 25 * max(spent, 0.001) for _ in range(3)), "quadratic time would be 64 times that"
